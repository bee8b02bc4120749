//! The colours of paths behind a device, and the strata of its comparator.
//!
//! A circuit whose comparator has some bits fixed counts the good indices of a [`Stratum`] alone.
//! Fixed bits are constants, not qubits, so noise cannot reach them: noise affects a shot as it
//! would affect one over the remaining indices.
//!
//! A measured index is also a path, whose colour is evaluated classically to find out if the index
//! is good. Neither query depth nor noise prefers one good index to another, or one bad index to
//! another. A path with a count of x is therefore among the good with probability `x/S`, and among
//! the others with `(C - x)/(N - S)`. The outcomes of a run show how colours are spread, at no
//! further queries.

use super::{CountingProblem, Device, Usage};
use crate::estimators::{EstimatorError, Noise};
use crate::random::Stream;
use crate::strata::length_of;
use crate::{Angle, Octaves, Stratum, binomial};

/// The distribution of colours behind a device, and the part of it that has been measured.
#[derive(Clone, Debug)]
pub(super) struct Known {
    bits: u32,
    /// Numbers of indices by the octave of their comparator: good ones and others.
    octaves: Vec<[u64; 2]>,
    /// Numbers of indices by the length in bits of their path's count: good ones and others.
    lengths: Vec<[u64; 2]>,
    /// Numbers of those that have been measured.
    measured: Vec<[u64; 2]>,
    /// A stream beside the device's own, so that these draws do not change the device's.
    stream: Stream,
    counted: Vec<CountedStratum>,
    /// The strata that have been measured on their own.
    parts: Vec<(Stratum, CountingProblem, Angle)>,
    /// The levels of the paths and their numbers of paths, if they are known one by one.
    pub(super) levels: Vec<(u64, u64)>,
    /// Numbers of good indices and of others that have been measured, by these levels.
    pub(super) measured_levels: Vec<[u64; 2]>,
}

impl Known {
    /// The problem of a stratum, and its angle.
    fn part(&mut self, stratum: Stratum) -> Result<(CountingProblem, Angle), EstimatorError> {
        if let Some(&(_, problem, theta)) = self.parts.iter().find(|part| part.0 == stratum) {
            return Ok((problem, theta));
        }
        let octaves = self.octaves.get(stratum.octaves());
        let octaves = octaves.ok_or(EstimatorError::NotByStrata)?;
        let sum = |which: usize| octaves.iter().map(|indices| indices[which]).sum::<u64>();
        let problem = CountingProblem {
            good: sum(0),
            total: sum(0) + sum(1),
        };
        let theta = Angle::from_counts(problem.good, problem.total)?;
        self.parts.push((stratum, problem, theta));
        Ok((problem, theta))
    }
}

/// A stratum that an estimator has counted on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountedStratum {
    /// The stratum's thresholds.
    pub stratum: Stratum,
    /// The stratum's contribution to the amplitude of the whole.
    pub amplitude: f64,
    /// Number of good indices that were measured in the stratum.
    pub good_ids: u64,
    /// Number of queries that the stratum took.
    pub queries: u64,
}

impl<'a> Device<'a> {
    /// Creates a device for a pixel whose strata can be counted on their own.
    ///
    /// It draws its measurements from `stream`. Over the whole comparator, it measures the same as
    /// a device of [`Device::new`].
    ///
    /// # Errors
    /// No paths, or noise out of range.
    ///
    /// ```
    /// use qrt_counting::{Octaves, Stratum};
    /// use qrt_counting::estimators::{Device, Noise};
    /// use qrt_counting::random::Stream;
    /// // Two paths under four thresholds, which exceed one and three of them.
    /// let mut octaves = Octaves::new(2);
    /// octaves.add(1);
    /// octaves.add(3);
    /// let mut stream = Stream::new(1, 0, 0, 0);
    /// let mut device = Device::of_octaves(&octaves, Noise::NONE, &mut stream)?;
    /// let upper = Stratum::halving(2, 2).last().unwrap();
    /// assert_eq!(device.within(upper, |device| device.every_id())?, 1);
    /// assert_eq!(device.usage().queries, 4);
    /// # Ok::<(), qrt_counting::estimators::EstimatorError>(())
    /// ```
    pub fn of_octaves(
        octaves: &Octaves,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Self, EstimatorError> {
        let (bits, paths, good) = (octaves.bits(), octaves.paths(), octaves.good());
        let problem = CountingProblem {
            good: good.iter().sum(),
            total: paths << bits,
        };
        let all = |octave: usize| paths * ((1_u64 << octave) - ((1_u64 << octave) >> 1));
        let lengths = octaves.by_length();
        let lengths: Vec<[u64; 2]> = lengths
            .map(|(paths, good)| [good, (paths << bits) - good])
            .collect();
        let good = good.iter().enumerate();
        let known = Known {
            bits,
            octaves: good.map(|(o, &good)| [good, all(o) - good]).collect(),
            measured: vec![[0; 2]; lengths.len()],
            lengths,
            stream: stream.beside(),
            counted: Vec::new(),
            parts: Vec::new(),
            levels: Vec::new(),
            measured_levels: Vec::new(),
        };
        let mut device = Self::new(problem, noise, stream)?;
        device.known = Some(Box::new(known));
        Ok(device)
    }

    /// Number of the comparator's bits, if its strata can be counted on their own.
    pub fn comparator_bits(&self) -> Option<u32> {
        self.known.as_ref().map(|known| known.bits)
    }

    /// Numbers of indices that circuits over the whole comparator have measured: good ones and
    /// others.
    ///
    /// They are listed by the length in bits of the number of thresholds that the index's path
    /// exceeds.
    pub(crate) fn measured_paths(&self) -> &[[u64; 2]] {
        self.known.as_ref().map_or(&[], |known| &known.measured)
    }

    /// Lets `run` measure on the circuits of `stratum`, and adds its usage to that of this device.
    ///
    /// # Errors
    /// An error if this device cannot count strata on their own, or does not have `stratum`.
    pub fn within<T>(
        &mut self,
        stratum: Stratum,
        run: impl FnOnce(&mut Device<'_>) -> T,
    ) -> Result<T, EstimatorError> {
        let known = self.known.as_mut().ok_or(EstimatorError::NotByStrata)?;
        let (problem, theta) = known.part(stratum)?;
        let mut part = Device {
            problem,
            theta,
            noise: self.noise,
            stream: self.stream,
            usage: Usage::default(),
            known: None,
        };
        let value = run(&mut part);
        let used = part.usage;
        self.usage.add(&used);
        Ok(value)
    }

    /// Records an estimator's result for a stratum.
    pub(in crate::estimators) fn report(&mut self, counted: CountedStratum) {
        if let Some(known) = &mut self.known {
            known.counted.push(counted);
        }
    }

    /// The strata that were counted on their own; empty if the whole was counted at once.
    pub fn counted_strata(&self) -> &[CountedStratum] {
        self.known.as_ref().map_or(&[], |known| &known.counted)
    }

    /// Records the paths of measured indices, `found[0]` good ones and `found[1]` others.
    pub(super) fn read_paths(&mut self, found: [u64; 2]) {
        let Some(known) = &mut self.known else {
            return;
        };
        let Known {
            bits,
            lengths,
            measured,
            levels,
            measured_levels,
            stream,
            ..
        } = &mut **known;
        if levels.is_empty() {
            let indices = lengths.iter().copied();
            share(found, &indices, stream, |length, which, here| {
                measured[length][which] += here;
            });
        } else {
            let indices = levels.iter().map(|&(level, paths)| {
                let good = level * paths;
                [good, (paths << *bits) - good]
            });
            share(found, &indices, stream, |place, which, here| {
                measured_levels[place][which] += here;
                measured[length_of(levels[place].0)][which] += here;
            });
        }
    }
}

/// Draws to which of the `indices`, good ones and others by place, the `found` ones belong. Passes
/// the place, 0 for good ones or 1, and the number to `add`.
fn share(
    found: [u64; 2],
    indices: &(impl Iterator<Item = [u64; 2]> + Clone),
    stream: &mut Stream,
    mut add: impl FnMut(usize, usize, u64),
) {
    for (which, mut found) in found.into_iter().enumerate() {
        let mut rest: u64 = indices.clone().map(|indices| indices[which]).sum();
        for (place, indices) in indices.clone().enumerate() {
            if found == 0 || rest == 0 {
                break;
            }
            let here = binomial::draw(found, indices[which], rest, stream);
            add(place, which, here);
            found -= here;
            rest -= indices[which];
        }
    }
}

impl Usage {
    fn add(&mut self, other: &Self) {
        self.queries = self.queries.saturating_add(other.queries);
        self.shots = self.shots.saturating_add(other.shots);
        self.depth = self.depth.max(other.depth);
        self.rounds += other.rounds;
        self.good_ids += other.good_ids;
    }
}
