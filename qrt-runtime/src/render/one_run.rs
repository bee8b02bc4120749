//! Colour from one run of counting instead of three.
//!
//! Only the luminance is counted. A good index that an estimator measures is a path and a
//! comparator below the path's luminance. So paths are measured with probabilities proportional to
//! their luminance. Each measured path is evaluated classically, without a query. The pixel is the
//! luminance times the mean, over these paths, of colour divided by luminance:
//!
//! ```text
//! E[rgb_i / Y_i] = sum_i (Y_i / sum_j Y_j) (rgb_i / Y_i) = mean(rgb) / mean(Y).
//! ```
//!
//! If strata of the comparator are counted one by one, the same holds for each stratum, with the
//! part of the luminance within its thresholds. The pixel is the sum over strata.
//!
//! The pixel's luminance has the error of counting. Its colour has the error of a random sample
//! whose size is the number of measured good indices; it is 0 if all paths have one colour. If no
//! good index was measured, the pixel is grey: [`RenderOptions::expected_grey`].

use super::stop::{Stop, ended, go_on};
use super::{Colour, RenderError, RenderOptions};
use crate::path_machines::{PathMachine, Traced};
use crate::workers::Workers;
use qrt_core::oracle::{LUMINANCE_CHANNEL, luminance};
use qrt_counting::estimators::{
    AmplitudeEstimator, CountedStratum, CountingProblem, Device, Estimate, EstimatorError, Noise,
    Settings,
};
use qrt_counting::random::Stream;
use qrt_counting::{Comparators, CountingError, Octaves, Stratum};
use qrt_scene::valid::ValidScene;
use qrt_scene::{Comparator, Counting};
use std::ops::Range;

/// The smallest number of paths whose counts are kept as one sum.
const SEGMENT: u64 = 256;
/// The largest number of sums that are kept.
const SEGMENTS: u64 = 1 << 12;
/// The largest number of measured indices that are evaluated. The error of the colour is then a
/// hundredth of the spread of its paths' colours.
const MEASURED: u64 = 1 << 13;

impl RenderOptions<'_> {
    /// The expected fraction of the lit pixels of `traced`, whose parameters are chosen, that have
    /// no measured path and are therefore grey. 0 if each channel is counted, or if the estimator
    /// measures until it knows enough.
    ///
    /// # Errors
    /// If a setting is out of range.
    pub fn expected_grey(&self, traced: &ValidScene) -> Result<f64, RenderError> {
        if self.colour == Colour::ThreeRuns {
            return Ok(0.0);
        }
        let counting = &traced.scene().counting;
        let known = self.counted_by(traced.scene())?;
        let estimator = self.estimator_of(known, &Settings::from_counting(counting)?)?;
        Ok(estimator.misses())
    }
}

/// The settings for counting the luminance.
#[derive(Clone, Copy, Debug)]
pub(super) struct OneRun {
    comparators: Comparators,
    comparator_bits: u32,
    segment: u64,
    /// True if strata may be counted one by one.
    by_strata: bool,
}

/// Number of good indices of a stratum in each segment of the pixel's paths.
struct GoodPaths<'a> {
    stratum: Stratum,
    good: &'a [u64],
    paths: u64,
    workers: &'a Workers<'a>,
}

/// Number of good indices of the luminance in each segment of a pixel's paths.
#[derive(Clone, Debug, Default)]
pub(super) struct Segments {
    sums: Vec<u64>,
    /// Good indices of each segment by octave, if strata may be counted one by one.
    octaves: Vec<Octaves>,
    paths: u64,
}

impl Segments {
    /// Adds the next path.
    fn add(&mut self, good: u64, one_run: &OneRun) {
        if self.paths.is_multiple_of(one_run.segment) {
            self.sums.push(0);
            if one_run.by_strata {
                self.octaves.push(Octaves::new(one_run.comparator_bits));
            }
        }
        if let Some(last) = self.sums.last_mut() {
            *last += good;
        }
        if let Some(last) = self.octaves.last_mut() {
            last.add(good);
        }
        self.paths += 1;
    }

    /// Encodes the segments, so that they can be continued later.
    pub(super) fn encode(&self, words: &mut Vec<u64>) {
        words.extend([self.paths, self.sums.len() as u64]);
        words.extend(&self.sums);
        for (paths, sum) in self.octaves.iter().flat_map(Octaves::by_length) {
            words.extend([paths, sum]);
        }
    }

    /// Decodes segments from words; `None` if the words are not those of segments.
    pub(super) fn decode(
        words: &mut impl ExactSizeIterator<Item = u64>,
        one_run: Option<&OneRun>,
    ) -> Option<Self> {
        let (paths, length) = (words.next()?, words.next()?);
        // A length beyond the number of words is rejected before memory is allocated for it.
        let length = usize::try_from(length).ok().filter(|n| *n <= words.len())?;
        let sums = (0..length).map(|_| words.next()).collect::<Option<_>>()?;
        let mut octaves = Vec::new();
        if let Some(one_run) = one_run.filter(|one_run| one_run.by_strata) {
            let none = Octaves::new(one_run.comparator_bits);
            for _ in 0..length {
                octaves.push(none.with_lengths(|| Some((words.next()?, words.next()?)))?);
            }
        }
        Some(Self {
            sums,
            octaves,
            paths,
        })
    }

    /// Returns the number of good indices within a stratum, by segment.
    fn within(&self, stratum: Stratum, whole: Stratum) -> Vec<u64> {
        if stratum == whole {
            return self.sums.clone();
        }
        let good = |octaves: &Octaves| octaves.good()[stratum.octaves()].iter().sum();
        self.octaves.iter().map(good).collect()
    }

    /// Adds the paths that follow. Segments may be appended only at segment boundaries.
    pub(super) fn append(&mut self, later: &Self) {
        self.sums.extend(&later.sums);
        self.octaves.extend_from_slice(&later.octaves);
        self.paths += later.paths;
    }
}

impl OneRun {
    pub(super) fn new(
        bound: &[f64; 3],
        comparator: Comparator,
        counting: &Counting,
        paths: u64,
    ) -> Result<Self, CountingError> {
        Ok(Self {
            comparators: Comparators::new(luminance(bound), comparator)?,
            comparator_bits: comparator.bits,
            by_strata: counting.may_count_strata(),
            segment: SEGMENT.max(paths / SEGMENTS),
        })
    }

    /// Adds the paths of a run.
    pub(super) fn add_paths(&self, segments: &mut Segments, traced: &Traced<'_>) {
        match traced {
            Traced::Colours(block) => {
                let [r, g, b] = block.colours;
                for ((r, g), b) in r.iter().zip(g).zip(b) {
                    segments.add(self.good(&[*r, *g, *b]), self);
                }
            }
            Traced::Counts(finished) => {
                for good in finished.luminance {
                    segments.add(good.cast_unsigned(), self);
                }
            }
        }
    }

    /// Converts an estimated amplitude to luminance.
    pub(super) fn pixel_of_amplitude(&self, amplitude: f64) -> f64 {
        self.comparators.pixel_of_amplitude(amplitude)
    }

    fn good(&self, colour: &[f64; 3]) -> u64 {
        u64::from(self.comparators.good(luminance(colour)))
    }

    /// Returns the colour of a pixel, and the estimate of its luminance. `machine` traces the
    /// measured paths again; `seed` is the key of the draws.
    pub(super) fn finish(
        &self,
        (machine, seed): (&dyn PathMachine, u64),
        (estimator, noise): (&dyn AmplitudeEstimator, Noise),
        [x, y]: [u32; 2],
        segments: &Segments,
        workers: &Workers<'_>,
    ) -> Result<([f64; 3], Option<Estimate>), Stop> {
        if self.comparators.step() == 0.0 {
            return Ok(([0.0; 3], None));
        }
        let mut stream = Stream::new(seed, x, y, LUMINANCE_CHANNEL as u8);
        let mut device = self.device(segments, noise, &mut stream)?;
        let estimate = estimator.estimate(&mut device)?;
        let whole = CountedStratum {
            stratum: Stratum::whole(self.comparator_bits),
            amplitude: estimate.amplitude,
            good_ids: device.usage().good_ids,
            queries: estimate.queries,
        };
        let counted = match device.counted_strata() {
            [] => vec![whole],
            strata => strata.to_vec(),
        };
        let value = self.comparators.pixel_of_amplitude(estimate.amplitude);
        let (mut sum, mut found) = ([0.0; 3], 0.0);
        for part in counted {
            let good = segments.within(part.stratum, whole.stratum);
            let all = good.iter().sum();
            let measured = part.good_ids.min(MEASURED);
            let mut ids: Vec<u64> = (0..measured).map(|_| stream.below(all)).collect();
            ids.sort_unstable();
            let (mut colours, mut paths) = ([0.0; 3], 0.0);
            let places = GoodPaths {
                stratum: part.stratum,
                good: &good,
                paths: segments.paths,
                workers,
            };
            self.paths_of(machine, [x, y], &places, &ids, |colour| {
                let luminance = luminance(&colour);
                // A colour may round to black while its luminance does not.
                if luminance > 0.0 {
                    for (sum, part) in colours.iter_mut().zip(colour) {
                        *sum += part / luminance;
                    }
                    paths += 1.0;
                }
            })?;
            if paths > 0.0 {
                // A whole comparator needs no weight relative to other strata.
                let weight = if part == whole {
                    1.0
                } else {
                    part.amplitude / paths
                };
                for (sum, colour) in sum.iter_mut().zip(colours) {
                    *sum += weight * colour;
                }
                found += weight * paths;
            }
        }
        // Without a measured path the colour is unknown, so the pixel is grey.
        let colour = sum.map(|sum| {
            if found > 0.0 {
                value * (sum / found)
            } else {
                value
            }
        });
        Ok((colour, Some(estimate)))
    }

    fn device<'a>(
        &self,
        segments: &Segments,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Device<'a>, EstimatorError> {
        if !self.by_strata {
            let problem = CountingProblem {
                good: segments.sums.iter().sum(),
                total: segments.paths * self.comparators.count(),
            };
            return Device::new(problem, noise, stream);
        }
        let mut all = Octaves::new(self.comparator_bits);
        for octaves in &segments.octaves {
            all.append(octaves);
        }
        Device::of_octaves(&all, noise, stream)
    }

    /// Calls `colour` with the colours of the paths of the good indices `ids`, which are sorted.
    fn paths_of(
        &self,
        machine: &dyn PathMachine,
        pixel: [u32; 2],
        places: &GoodPaths<'_>,
        ids: &[u64],
        mut colour: impl FnMut([f64; 3]),
    ) -> Result<(), Stop> {
        let mut ids = ids.iter().copied().peekable();
        let mut first = 0;
        for (number, &sum) in (0_u64..).zip(places.good) {
            if ids.peek().is_some_and(|&id| id < first + sum) {
                let start = number * self.segment;
                let end = (start + self.segment).min(places.paths);
                let mut before = first;
                let mut run = start;
                while run < end {
                    let next = (run + machine.run_length()).min(end);
                    self.trace(machine, pixel, run..next, places.workers, |count, rgb| {
                        let good = places.stratum.good(count);
                        while ids.next_if(|&id| id < before + good).is_some() {
                            colour(rgb);
                        }
                        before += good;
                    })?;
                    run = next;
                }
            }
            first += sum;
        }
        Ok(())
    }

    /// Traces paths again, and calls `path` with each path's good indices of luminance and its
    /// colour.
    fn trace(
        &self,
        machine: &dyn PathMachine,
        pixel: [u32; 2],
        paths: Range<u64>,
        workers: &Workers<'_>,
        mut path: impl FnMut(u64, [f64; 3]),
    ) -> Result<(), Stop> {
        go_on(workers)?;
        let traced = machine.trace_paths(workers.cancel, &[pixel], paths, &mut |traced| {
            traced.each_colour(machine, |place, colour| {
                let good = match traced {
                    Traced::Colours(_) => self.good(&colour),
                    Traced::Counts(finished) => finished.luminance[place].cast_unsigned(),
                };
                path(good, colour);
            });
        });
        traced.map_err(|defect| ended(machine, defect))
    }
}
