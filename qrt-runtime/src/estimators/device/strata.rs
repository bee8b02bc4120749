//! Strata of the comparator, as a device knows them.
//!
//! A circuit whose comparator has some bits fixed counts the good indices of a [`Stratum`] alone.
//! Fixed bits are constants, and no qubits that noise could reach: what noise does to a shot is
//! what it does on the indices that are left.
//!
//! A measured index is a path, too, whose colour is evaluated classically to know whether the index
//! is good. Neither query depth nor noise prefers one good index to another, or one of the others:
//! a path with a count of x is among the good with probability `x/S`, and among the others with
//! `(C - x)/(N - S)`. So what a run measures shows how colours are spread, and costs no query more.

use super::{Device, Problem, Usage};
use crate::counting::{Octaves, Stratum, binomial};
use crate::estimators::{EstimatorError, Noise};
use crate::random::Stream;

/// What a device knows of the spread of colours, and what it has measured of it.
#[derive(Clone, Debug)]
pub(super) struct Known {
    bits: u32,
    /// Indices by octave of their comparator, the good and the others.
    octaves: Vec<[u64; 2]>,
    /// Indices by the length in bits of their path's count, the good and the others.
    lengths: Vec<[u64; 2]>,
    /// Of those, the measured.
    measured: Vec<[u64; 2]>,
    /// Beside the device's own, so that what is drawn here changes nothing that is drawn there.
    stream: Stream,
    counted: Vec<CountedStratum>,
}

/// A stratum that an estimator has counted by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountedStratum {
    /// Its thresholds.
    pub stratum: Stratum,
    /// What it contributes to the amplitude of the whole.
    pub amplitude: f64,
    /// Good indices that were measured in it.
    pub good_ids: u64,
    /// Queries that it took.
    pub queries: u64,
}

impl<'a> Device<'a> {
    /// A device for a pixel whose strata can be counted one by one; what it answers is drawn from
    /// `stream`. Asked about the whole, it gives the answers of [`Device::new`].
    ///
    /// # Errors
    /// No paths, or noise out of range.
    ///
    /// ```
    /// use qrt_runtime::counting::{Octaves, Stratum};
    /// use qrt_runtime::estimators::{Device, Noise};
    /// use qrt_runtime::random::Stream;
    /// // Two paths under four thresholds, which exceed one and three of them.
    /// let mut octaves = Octaves::new(2);
    /// octaves.add(1);
    /// octaves.add(3);
    /// let mut stream = Stream::new(1, 0, 0, 0);
    /// let mut device = Device::of_octaves(&octaves, Noise::NONE, &mut stream)?;
    /// let upper = Stratum::halving(2, 2).last().unwrap();
    /// assert_eq!(device.within(upper, |device| device.every_id())?, 1);
    /// assert_eq!(device.usage().queries, 4);
    /// # Ok::<(), qrt_runtime::estimators::EstimatorError>(())
    /// ```
    pub fn of_octaves(
        octaves: &Octaves,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Self, EstimatorError> {
        let (bits, paths, good) = (octaves.bits(), octaves.paths(), octaves.good());
        let problem = Problem {
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
        };
        let mut device = Self::new(problem, noise, stream)?;
        device.known = Some(Box::new(known));
        Ok(device)
    }

    /// The comparator's bits, if its strata can be counted one by one.
    pub fn comparator_bits(&self) -> Option<u32> {
        self.known.as_ref().map(|known| known.bits)
    }

    /// Paths of the indices that were measured up to now, in circuits over the whole comparator, by
    /// the length in bits of the number of thresholds that they exceed: of good indices, and of
    /// others.
    pub fn measured_paths(&self) -> &[[u64; 2]] {
        self.known.as_ref().map_or(&[], |known| &known.measured)
    }

    /// Lets `run` measure on the circuits of one stratum. What it uses is used here.
    ///
    /// # Errors
    /// Strata cannot be counted one by one on this device, or the stratum is none of its own.
    pub fn within<T>(
        &mut self,
        stratum: Stratum,
        run: impl FnOnce(&mut Device<'_>) -> T,
    ) -> Result<T, EstimatorError> {
        let known = self.known.as_ref();
        let octaves = known.and_then(|known| known.octaves.get(stratum.octaves()));
        let octaves = octaves.ok_or(EstimatorError::NotByStrata)?;
        let sum = |which: usize| octaves.iter().map(|indices| indices[which]).sum::<u64>();
        let problem = Problem {
            good: sum(0),
            total: sum(0) + sum(1),
        };
        let mut part = Device::new(problem, self.noise, self.stream)?;
        let value = run(&mut part);
        let used = part.usage;
        self.usage.add(&used);
        Ok(value)
    }

    /// Takes note of what an estimator found in a stratum.
    pub(in crate::estimators) fn report(&mut self, counted: CountedStratum) {
        if let Some(known) = &mut self.known {
            known.counted.push(counted);
        }
    }

    /// The strata that were counted one by one; none where the whole was counted at once.
    pub fn counted_strata(&self) -> &[CountedStratum] {
        self.known.as_ref().map_or(&[], |known| &known.counted)
    }

    /// Takes note of the paths of measured indices: so many good ones, and others.
    pub(super) fn read_paths(&mut self, found: [u64; 2]) {
        let Some(known) = &mut self.known else {
            return;
        };
        let Known {
            lengths,
            measured,
            stream,
            ..
        } = &mut **known;
        for (which, mut found) in found.into_iter().enumerate() {
            let mut rest: u64 = lengths.iter().map(|indices| indices[which]).sum();
            for (indices, measured) in lengths.iter().zip(measured.iter_mut()) {
                if found == 0 || rest == 0 {
                    break;
                }
                let here = binomial::draw(found, indices[which], rest, stream);
                measured[which] += here;
                found -= here;
                rest -= indices[which];
            }
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
