//! Computes a pixel's colour from its paths.

use super::one_run::OneRun;
use super::parts::Parts;
use super::stop::{Stop, ended, go_on};
use super::totals::Totals;
use super::{BoxedEstimator, Colour, RenderError, RenderOptions};
use crate::checkpoint::PixelPart;
use crate::counted_pixels::CountedPixel;
use crate::path_machines::{PathBlock, PathMachine, Traced};
use crate::workers::{Progress, Workers};
use qrt_circuit::quantum::MAX_LEVEL_BITS;
use qrt_core::oracle::luminance;
use qrt_counting::estimators::{
    AmplitudeEstimator, CountingProblem, Device, Estimate, EstimatorError, Noise, Settings,
};
use qrt_counting::random::Stream;
use qrt_counting::{Comparators, LevelCounts, Octaves};
use qrt_scene::{Counting, Estimator, Scene};
use rayon::prelude::*;
use std::ops::Range;

/// The smallest number of paths of a part of a pixel.
const LEAST: u64 = 1 << 16;
/// The largest number of parts of a pixel.
const PARTS: u64 = 1 << 12;

/// A finished pixel: its colour, its counts and its queries.
pub(super) struct Pixel {
    pub(super) colour: [f64; 3],
    pub(super) counted: CountedPixel,
}

impl Pixel {
    /// Adds the estimate of a channel.
    fn add_estimate(&mut self, channel: usize, estimate: &Estimate, radiance: impl Fn(f64) -> f64) {
        let (low, high) = estimate.interval;
        let width = radiance(high) - radiance(low);
        self.counted.add_estimate(channel, estimate, width);
    }
}

/// Traces the paths of pixels, and computes the pixels' colours.
pub(super) struct Pixels {
    machine: Box<dyn PathMachine>,
    comparator_bits: u32,
    bound: [f64; 3],
    /// The largest colour of a path by channel that rounding can explain; the bound itself for an
    /// oracle.
    limit: [f64; 3],
    seed: u64,
    paths: u64,
    counter: Option<Counter>,
}

/// Counts good indices: pairs of a path and a comparator that its colour exceeds.
struct Counter {
    comparators: [Comparators; 3],
    /// An estimator for each channel; only one, of the luminance, if the luminance is counted.
    estimators: Vec<BoxedEstimator>,
    /// The levels that the estimator reads.
    levels: Levels,
    noise: Noise,
    one_run: Option<OneRun>,
}

/// The levels of a pixel's paths, as far as an estimator reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Levels {
    /// Their sum alone.
    Sum,
    /// Sums by octave, for an estimator that reads the colours of measured paths.
    Octaves,
    /// Each of them, since it may run the mean-phase circuit.
    All,
}

impl Levels {
    fn read_by(counting: &Counting) -> Self {
        if counting.estimator().reads_levels() {
            Self::All
        } else if counting.reads_levels() {
            Self::Octaves
        } else {
            Self::Sum
        }
    }

    /// Counts of no paths.
    fn empty(self, bits: u32) -> LevelCounts {
        match self {
            Self::Sum => LevelCounts::default(),
            Self::Octaves => LevelCounts::Octaves(Octaves::new(bits)),
            Self::All => LevelCounts::new(bits),
        }
    }
}

fn report(workers: &Workers<'_>, paths: u64) {
    workers.report(Progress::Finished(paths));
}

impl Pixels {
    pub(super) fn new(
        machine: Box<dyn PathMachine>,
        scene: &Scene,
        estimate: Estimator,
        options: &RenderOptions<'_>,
    ) -> Result<Self, RenderError> {
        let (bound, paths) = (machine.bounds(), machine.paths());
        let limit = [0, 1, 2].map(|channel| machine.limit(channel));
        for (channel, bound) in bound.into_iter().enumerate() {
            let summable = bound <= f64::MAX / 2.0 / paths as f64;
            // A NaN is not summable either.
            if !summable {
                return Err(RenderError::Bound { channel, bound });
            }
        }
        if estimate == Estimator::Exact && options.noise != Noise::NONE {
            return Err(RenderError::NothingNoisy);
        }
        let bits = scene.comparator.bits;
        if estimate == Estimator::PhaseMean && bits > MAX_LEVEL_BITS {
            return Err(EstimatorError::LevelBits(bits).into());
        }
        let counting = Counting {
            estimator: Some(estimate),
            ..scene.counting
        };
        let one_run = match options.colour {
            Colour::ThreeRuns => None,
            Colour::OneRun if estimate == Estimator::Exact => {
                return Err(RenderError::NothingMeasured);
            }
            Colour::OneRun if estimate == Estimator::PhaseMean => {
                return Err(RenderError::MeanOfOneRun);
            }
            Colour::OneRun => Some(OneRun::new(&bound, scene.comparator, &counting, paths)?),
        };
        let counter = if estimate == Estimator::Exact {
            None
        } else {
            let scales = match one_run {
                None => bound.to_vec(),
                Some(_) => vec![luminance(&bound)],
            };
            // A channel with scale 0 is not counted, so its settings have no effect.
            let settings = scales.iter().map(|&scale| match scale {
                0.0 => Settings::from_counting(&scene.counting),
                scale => Settings::of_channel(&scene.counting, scale),
            });
            let estimators = settings.map(|settings| options.estimator_of(estimate, &settings?));
            Some(Counter {
                comparators: Comparators::rgb(bound, scene.comparator)?,
                estimators: estimators.collect::<Result<_, _>>()?,
                levels: Levels::read_by(&counting),
                noise: options.noise,
                one_run,
            })
        };
        Ok(Self {
            machine,
            comparator_bits: scene.comparator.bits,
            bound,
            limit,
            seed: options.seed,
            paths,
            counter,
        })
    }

    fn one_run(&self) -> Option<&OneRun> {
        self.counter.as_ref()?.one_run.as_ref()
    }

    /// Totals without any paths.
    fn empty_totals(&self) -> Totals {
        Totals {
            levels: [(); 3].map(|()| self.levels().empty(self.comparator_bits)),
            ..Totals::default()
        }
    }

    /// The levels that are kept for channels.
    fn levels(&self) -> Levels {
        let counter = self.counter.as_ref();
        let counter = counter.filter(|counter| counter.one_run.is_none());
        counter.map_or(Levels::Sum, |counter| counter.levels)
    }

    pub(super) fn bound(&self) -> [f64; 3] {
        self.bound
    }

    /// Returns whether a pixel is traced by itself: it has enough paths to occupy all threads, or
    /// more paths than a circuit runs together.
    pub(super) fn splits(&self) -> bool {
        self.paths > self.machine.most_undivided()
    }

    /// Traces the pixels number `numbers` of `pixels`, which have few paths each, and puts their
    /// totals into `all`. Several pixels run together, as far as a run has room. Reports the
    /// progress to `workers`. Pixels that `kept` has are not traced again; new ones are kept there
    /// from time to time. If the work ends early, `all` has the totals of the finished pixels.
    pub(super) fn trace_group(
        &self,
        pixels: &[[u32; 2]],
        numbers: &[usize],
        all: &mut [Option<Totals>],
        workers: &Workers<'_>,
        kept: &Parts<'_>,
    ) -> Result<(), Stop> {
        for &n in numbers {
            let before = self.before(kept, pixels[n], 0, self.paths);
            let whole = before.filter(|(paths, _)| *paths == self.paths);
            all[n] = whole.map(|(_, totals)| totals);
        }
        let open = numbers.iter().copied().filter(|&n| all[n].is_none());
        let open: Vec<usize> = open.collect();
        let mut keeper = kept.keeper();
        // Pixels that are traced but not kept yet.
        let mut new: Vec<usize> = Vec::new();
        let together = (self.machine.run_length() / self.paths).max(1) as usize;
        for numbers in open.chunks(together) {
            let group: Vec<[u32; 2]> = numbers.iter().map(|&n| pixels[n]).collect();
            let mut totals = vec![self.empty_totals(); group.len()];
            let mut first = 0;
            while first < self.paths {
                let end = (first + self.machine.run_length()).min(self.paths);
                self.trace(&group, first..end, &mut totals, workers)?;
                report(workers, (end - first) * group.len() as u64);
                first = end;
            }
            for (&n, totals) in numbers.iter().zip(totals) {
                all[n] = Some(totals);
            }
            new.extend(numbers);
            if keeper.is_due() {
                let part = |n: usize| Some(self.whole(pixels[n], all[n].as_ref()?));
                keeper.keep_parts(new.drain(..).filter_map(part))?;
            }
        }
        Ok(())
    }

    /// Encodes the totals of all paths of a pixel as a part to be kept.
    pub(super) fn whole(&self, pixel: [u32; 2], totals: &Totals) -> PixelPart {
        PixelPart {
            pixel,
            number: 0,
            paths: self.paths,
            totals: totals.encode(),
        }
    }

    /// Returns the kept paths of part `number` of a pixel, and their totals. The part has `most`
    /// paths. Only whole runs are accepted.
    fn before(
        &self,
        kept: &Parts<'_>,
        pixel: [u32; 2],
        number: u64,
        most: u64,
    ) -> Option<(u64, Totals)> {
        let (paths, words) = kept.before(pixel, number)?;
        let whole_runs = paths.is_multiple_of(self.machine.run_length()) || paths == most;
        let totals = self
            .empty_totals()
            .decode(words, self.one_run())
            .filter(|_| whole_runs && paths <= most)?;
        Some((paths, totals))
    }

    /// Adds the paths `ids` of `pixels` to their `totals`. If the work ends early, no run of paths
    /// is in `totals` in part.
    fn trace(
        &self,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        totals: &mut [Totals],
        workers: &Workers<'_>,
    ) -> Result<(), Stop> {
        go_on(workers)?;
        let machine = &*self.machine;
        let traced = machine.trace_paths(workers.cancel, pixels, ids, &mut |traced| {
            let totals = &mut totals[traced.pixel()];
            match &traced {
                Traced::Colours(block) => self.add_block(totals, block),
                Traced::Counts(finished) => {
                    totals.queries += finished.queries;
                    self.add_counts(totals, finished.good);
                }
            }
            if let Some(one_run) = self.one_run() {
                one_run.add_paths(&mut totals.segments, &traced);
            }
        });
        traced.map_err(|defect| ended(machine, defect))
    }

    /// Adds numbers of thresholds that colours exceed.
    fn add_counts(&self, totals: &mut Totals, counts: [&[i64]; 3]) {
        for (total, good) in totals.good.iter_mut().zip(counts) {
            *total += good.iter().sum::<i64>().cast_unsigned();
        }
        if self.levels() != Levels::Sum {
            for (levels, good) in totals.levels.iter_mut().zip(counts) {
                levels.add_all(good.iter().map(|good| good.cast_unsigned()));
            }
        }
    }

    /// Traces the many paths of one pixel on all threads, and returns their totals. Reports every
    /// run of paths to `workers`. The totals of its parts are kept in `kept`, and kept ones are
    /// continued.
    pub(super) fn trace_in_parts(
        &self,
        pixel: [u32; 2],
        workers: &Workers<'_>,
        kept: &Parts<'_>,
    ) -> Result<Totals, Stop> {
        let part = LEAST.max(self.paths / PARTS);
        let parts = (0..self.paths.div_ceil(part)).into_par_iter();
        let totals = parts.map(|n| {
            let ids = n * part..((n + 1) * part).min(self.paths);
            let before = self.before(kept, pixel, n, ids.end - ids.start);
            let (paths, totals) = before.unwrap_or((0, self.empty_totals()));
            let mut totals = [totals];
            let mut first = ids.start + paths;
            let mut keeper = kept.keeper();
            let part_of = |first: u64, totals: &Totals| PixelPart {
                pixel,
                number: n,
                paths: first - ids.start,
                totals: totals.encode(),
            };
            while first < ids.end {
                let end = (first + self.machine.run_length()).min(ids.end);
                if let Err(stop) = self.trace(&[pixel], first..end, &mut totals, workers) {
                    let traced = (first > ids.start).then(|| part_of(first, &totals[0]));
                    keeper.keep_parts(traced)?;
                    return Err(stop);
                }
                report(workers, end - first);
                first = end;
                if first == ids.end || keeper.is_due() {
                    keeper.keep_parts([part_of(first, &totals[0])])?;
                }
            }
            let [totals] = totals;
            Ok(totals)
        });
        // Totals are added in the order of path indices, whichever was finished first.
        let totals: Vec<Totals> = totals.collect::<Result<_, Stop>>()?;
        let mut whole = self.empty_totals();
        for later in &totals {
            whole.append(later);
        }
        Ok(whole)
    }

    fn add_block(&self, totals: &mut Totals, block: &PathBlock<'_>) {
        for (channel, colours) in block.colours.into_iter().enumerate() {
            let limit = self.limit[channel];
            let inside = |colour: f64| colour >= 0.0 && colour <= limit;
            // No early exit, so that several colours are checked at a time.
            let all = colours.iter().fold(true, |all, &c| all & inside(c));
            if !all {
                let stray = &mut totals.stray[channel];
                for &colour in colours.iter().filter(|&&colour| !inside(colour)) {
                    if stray.0 == 0 {
                        stray.1 = colour;
                    }
                    stray.0 += 1;
                }
            }
            match &self.counter {
                // The channel is proven black: values left by rounding are not added.
                None if self.bound[channel] == 0.0 => {}
                None => totals.colour[channel].add(colours),
                Some(Counter {
                    one_run: Some(_), ..
                }) => {}
                Some(counter) if counter.levels == Levels::Sum => {
                    totals.good[channel] += counter.comparators[channel].good_total(colours);
                }
                Some(counter) => {
                    let comparators = &counter.comparators[channel];
                    let levels = colours.iter().map(|&colour| comparators.good(colour));
                    totals.levels[channel].add_all(levels.map(u64::from));
                }
            }
        }
    }

    /// Returns a finished pixel: its colour, its counts and its queries. Without an estimator, the
    /// colour is the mean of its paths, without queries of a counting circuit.
    pub(super) fn finish(
        &self,
        pixel: [u32; 2],
        totals: &Totals,
        workers: &Workers<'_>,
    ) -> Result<Pixel, Stop> {
        self.check(pixel, totals, workers)?;
        let good = if self.counts_thresholds() {
            totals.good
        } else {
            [0; 3]
        };
        let mut finished = Pixel {
            colour: [0.0; 3],
            counted: CountedPixel::new(totals.queries, good),
        };
        let Some(counter) = &self.counter else {
            finished.colour = self.means(totals);
            return Ok(finished);
        };
        if let Some(one_run) = &counter.one_run {
            let estimator: &dyn AmplitudeEstimator = &*counter.estimators[0];
            let device = (estimator, counter.noise);
            let machine = (&*self.machine, self.seed);
            let segments = &totals.segments;
            let (colour, estimate) = one_run.finish(machine, device, pixel, segments, workers)?;
            finished.colour = colour;
            finished.counted = CountedPixel::default();
            if let Some(estimate) = estimate {
                finished.add_estimate(0, &estimate, |amplitude| {
                    one_run.pixel_of_amplitude(amplitude)
                });
            }
            return Ok(finished);
        }
        for channel in 0..3 {
            // A channel with bound 0 is proven black, and there is nothing to count.
            if self.bound[channel] > 0.0 {
                go_on(workers)?;
                let estimate = self.estimate(counter, pixel, channel, totals)?;
                let radiance =
                    |amplitude| counter.comparators[channel].pixel_of_amplitude(amplitude);
                finished.add_estimate(channel, &estimate, radiance);
                finished.colour[channel] = radiance(estimate.amplitude);
            }
        }
        Ok(finished)
    }

    /// Checks that all colours of a pixel's paths are within their bounds.
    fn check(&self, pixel: [u32; 2], totals: &Totals, workers: &Workers<'_>) -> Result<(), Stop> {
        let stray = totals.stray.iter().enumerate();
        let mut stray = stray.filter(|(_, (paths, _))| *paths > 0);
        let Some((channel, &(_, colour))) = stray.next() else {
            return Ok(());
        };
        Err(Stop::Failed(RenderError::OutOfBounds {
            pixel,
            id: self.first_of_colour(pixel, channel, colour, workers)?,
            channel,
            colour,
            bound: self.bound[channel],
            fraction: None,
        }))
    }

    /// Finds the first path of a pixel with this colour in a channel. It traces the pixel again,
    /// because the totals do not have path indices.
    fn first_of_colour(
        &self,
        pixel: [u32; 2],
        channel: usize,
        colour: f64,
        workers: &Workers<'_>,
    ) -> Result<u64, Stop> {
        let machine = &*self.machine;
        let run = machine.run_length();
        for first in (0..self.paths).step_by(run as usize) {
            go_on(workers)?;
            let (mut id, mut found) = (first, None);
            let ids = first..(first + run).min(self.paths);
            let traced = machine.trace_paths(workers.cancel, &[pixel], ids, &mut |traced| {
                traced.each_colour(machine, |_, other| {
                    let is_it = other[channel].to_bits() == colour.to_bits();
                    found = found.or(is_it.then_some(id));
                    id += 1;
                });
            });
            traced.map_err(|defect| ended(machine, defect))?;
            if let Some(found) = found {
                return Ok(found);
            }
        }
        Ok(0)
    }

    /// True if the machine reports numbers of thresholds, and false if it reports colours.
    fn counts_thresholds(&self) -> bool {
        self.machine.fraction().is_some()
    }

    /// The mean of a pixel's paths: of their colours, or of the thresholds that the colours exceed.
    fn means(&self, totals: &Totals) -> [f64; 3] {
        let ids = self.paths << self.comparator_bits;
        std::array::from_fn(|channel| {
            if self.counts_thresholds() {
                self.bound[channel] * (totals.good[channel] as f64 / ids as f64)
            } else {
                totals.colour[channel].value() / self.paths as f64
            }
        })
    }

    /// Estimates a pixel's channel.
    fn estimate(
        &self,
        counter: &Counter,
        [x, y]: [u32; 2],
        channel: usize,
        totals: &Totals,
    ) -> Result<Estimate, EstimatorError> {
        let mut stream = Stream::new(self.seed, x, y, channel as u8);
        let mut device = if counter.levels == Levels::Sum {
            let problem = CountingProblem {
                good: totals.good[channel],
                total: self.paths * counter.comparators[channel].count(),
            };
            Device::new(problem, counter.noise, &mut stream)?
        } else {
            Device::of_levels(&totals.levels[channel], counter.noise, &mut stream)?
        };
        counter.estimators[channel].estimate(&mut device)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path_machines::{OracleMachine, Real};
    use qrt_circuit::Operand;
    use qrt_core::oracle::Oracle;
    use qrt_scene::front::parse;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// A wall of radiance 2, 1, 0 that fills the picture, so that every path has this colour.
    const WALL: &str = "
name: wall
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 2, height: 1 }
materials: { wall: { emitter: { radiance: [2, 1, 0] } } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: wall }
sampling: { path_bits: 5 }
";

    fn wall(estimator: Estimator) -> Pixels {
        let scene = parse(WALL, "wall.yaml", &[], "".as_ref()).unwrap().valid;
        let real = Real::new(&scene, 0).unwrap();
        Pixels::new(
            Box::new(real),
            scene.scene(),
            estimator,
            &RenderOptions::default(),
        )
        .unwrap()
    }

    fn few(pixels: &Pixels) -> Vec<Totals> {
        let mut all = [None];
        let (workers, kept) = (Workers::default(), Parts::default());
        let traced = pixels.trace_group(&[[1, 0]], &[0], &mut all, &workers, &kept);
        traced.ok().unwrap();
        all.into_iter().flatten().collect()
    }

    fn finish(pixels: &Pixels, totals: &Totals) -> Result<Pixel, Stop> {
        pixels.finish([1, 0], totals, &Workers::default())
    }

    #[test]
    fn a_path_beyond_its_bound_is_reported_and_never_clamped() {
        for estimator in [Estimator::Exact, Estimator::Sine] {
            let mut pixels = wall(estimator);
            let totals = few(&pixels);
            assert!(finish(&pixels, &totals[0]).is_ok());
            pixels.limit = [2.0, 1.0, 0.0];
            assert!(finish(&pixels, &few(&pixels)[0]).is_ok());
            pixels.limit = [2.0, 1.0_f64.next_down(), 0.0];
            match finish(&pixels, &few(&pixels)[0]) {
                Err(Stop::Failed(RenderError::OutOfBounds {
                    pixel: [1, 0],
                    channel: 1,
                    id: 0,
                    colour: 1.0,
                    ..
                })) => {}
                other => panic!("{:?}", other.ok().map(|pixel| pixel.colour)),
            }
            let parts = pixels.trace_in_parts([1, 0], &Workers::default(), &Parts::default());
            let parts = parts.ok().unwrap();
            assert!(finish(&pixels, &parts).is_err());
        }
    }

    #[test]
    fn the_search_for_a_path_beyond_its_bound_can_be_cancelled() {
        let mut pixels = wall(Estimator::Exact);
        pixels.limit = [1.0; 3];
        let totals = few(&pixels);
        let cancel = AtomicBool::new(true);
        let workers = Workers {
            cancel: Some(&cancel),
            ..Workers::default()
        };
        let stopped = pixels.finish([1, 0], &totals[0], &workers);
        assert!(matches!(stopped, Err(Stop::Cancelled)));
        cancel.store(false, Ordering::Relaxed);
        let found = pixels.finish([1, 0], &totals[0], &workers);
        assert!(matches!(found, Err(Stop::Failed(_))));
    }

    #[test]
    fn a_path_of_a_circuit_beyond_its_bound_is_reported_and_never_clamped() {
        let scene = parse(WALL, "wall.yaml", &[], "".as_ref()).unwrap().valid;
        let mut oracle = Oracle::rgb(&scene, qrt_core::oracle::OracleOptions::default()).unwrap();
        // The wall is as bright as the bound. The test doubles the counts of thresholds below it.
        for channel in &mut oracle.channels {
            match &mut channel.count {
                Operand::Constant(count) => *count *= 2,
                Operand::Word(word) => word.shift += 1,
            }
        }
        let machine = OracleMachine::fixed(oracle.into(), 0, false);
        let options = RenderOptions::default();
        let pixels = Pixels::new(Box::new(machine), scene.scene(), Estimator::Exact, &options);
        let (workers, kept, mut all) = (Workers::default(), Parts::default(), [None]);
        let traced = pixels
            .unwrap()
            .trace_group(&[[1, 0]], &[0], &mut all, &workers, &kept);
        let Err(Stop::Failed(error)) = traced else {
            panic!("it was counted");
        };
        let text = error.to_string();
        let expected = "path 0 of pixel (1, 0) has a red of 4e0, outside [0, 2e0]; numbers of 16";
        assert!(text.starts_with(expected), "{text}");
    }

    #[test]
    fn what_is_not_a_colour_is_reported() {
        let pixels = wall(Estimator::Exact);
        for colour in [f64::NAN, -1e-300, f64::INFINITY] {
            let mut totals = Totals::default();
            let colours = [1.0, colour, 1.0];
            let block = PathBlock {
                pixel: 0,
                colours: [&colours; 3],
            };
            pixels.add_block(&mut totals, &block);
            assert_eq!(totals.stray[0].0, 1);
            assert_eq!(totals.stray[0].1.to_bits(), colour.to_bits());
            assert!(finish(&pixels, &totals).is_err());
        }
    }
}
