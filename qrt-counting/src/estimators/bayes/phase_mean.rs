//! `phase-mean` and `auto`: estimators that go on with the mean-phase circuit.

use super::run::Depths;
use super::{Goal, ways};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `phase-mean`: measures the mean itself as a phase, in units of the standard deviation of the
/// paths' colours.
///
/// The run begins with 12 to 24 paths drawn at random: with 12 if it has fewer than 240 queries, and
/// with none if it has fewer than 60. If their colours favour the mean phase, it draws 2 % of its
/// queries in all, and goes on with the mean-phase circuit. If not, it counts, as `adaptive-bayes`
/// without strata.
/// `auto` is the same, except that it then chooses the number of strata, too.
///
/// The error of the mean phase is about 3.4 sigma over the queries, sigma the standard deviation of
/// the paths' colours (`cargo bench --bench estimators -- mean`). Counting has about
/// `2.2 sqrt(a (1 - a))` over the queries, a the amplitude: 2 to 10 times as much where all paths
/// find light. Where few paths do, counting has less.
///
/// The mean phase needs a device that knows the levels of its paths, [`Device::of_histogram`], and a
/// comparator of at most 12 bits. On other devices the run counts, and where noise keeps shots so short
/// that they would be more than some 64: the model of one eigenphase holds for no more.
///
/// The likelihood of the mean-phase circuit has one eigenphase and a visibility, both from the
/// measured colours. The depth and the angle of each shot follow from the whole posterior.
///
/// Interval: mean plus and minus the normal quantile of the confidence times the posterior's standard
/// deviation.
///
/// Stops early if the requested error is reached. Never uses more queries than allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseMean {
    goal: Goal,
}

impl PhaseMean {
    /// Creates `phase-mean` from `settings`.
    ///
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        let goal = Goal {
            strata: Some(1),
            ..Self::auto(settings)?.goal
        };
        Ok(Self { goal })
    }

    /// Creates `auto` from `settings`.
    ///
    /// # Errors
    /// A setting out of range.
    pub fn auto(settings: &Settings) -> Result<Self, EstimatorError> {
        let goal = Goal {
            mean_phase: true,
            ..Goal::from_settings(settings)?
        };
        Ok(Self { goal })
    }
}

impl AmplitudeEstimator for PhaseMean {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        ways::estimate(&self.goal, Depths::Adaptive, device)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Histogram;
    use crate::estimators::{AdaptiveBayes, Noise};
    use crate::random::Stream;
    use qrt_circuit::quantum::LevelPhases;

    const RUNS: u32 = 200;

    /// 2^12 paths under 2^10 thresholds: dim ones around `dim`, `bright` of them 15 times as bright.
    fn pixel(dim: u64, bright: u64) -> Histogram {
        let mut histogram = Histogram::new(10);
        let mut stream = Stream::new(dim, 0, 0, 0);
        histogram.add_all((0..4096).map(|path| {
            let level = dim / 2 + stream.below(dim + 1);
            (if path < bright { 15 * level } else { level }).min(1024)
        }));
        histogram
    }

    struct Errors {
        /// Root of the mean square error, times queries over sigma.
        rms: f64,
        covered: f64,
        queries: f64,
    }

    fn errors(
        estimator: &dyn AmplitudeEstimator,
        settings: &Settings,
        histogram: &Histogram,
        noise: Noise,
    ) -> Errors {
        let all = (histogram.paths() << histogram.bits()) as f64;
        let mean = histogram.good() as f64 / all;
        let square = |(level, paths): (u64, u64)| {
            let distance = level as f64 / 1024.0 - mean;
            distance * distance * paths as f64 / histogram.paths() as f64
        };
        let deviation = histogram.levels().map(square).sum::<f64>().sqrt();
        let (mut sum, mut covered, mut queries) = (0.0, 0, 0);
        for run in 0..RUNS {
            let mut stream = Stream::new(17, run, 0, 0);
            let mut device = Device::of_histogram(histogram, noise, &mut stream).unwrap();
            let found = estimator.estimate(&mut device).unwrap();
            assert!(found.queries <= settings.queries);
            assert_eq!(found.queries, device.usage().queries);
            assert!((0.0..=1.0).contains(&found.amplitude));
            sum += (found.amplitude - mean).powi(2);
            covered += u32::from((found.interval.0..=found.interval.1).contains(&mean));
            queries += found.queries;
        }
        let rms = (sum / f64::from(RUNS)).sqrt();
        Errors {
            rms: rms * settings.queries as f64 / deviation,
            covered: f64::from(covered) / f64::from(RUNS),
            queries: queries as f64 / f64::from(RUNS),
        }
    }

    fn settings(phase_bits: u32) -> Settings {
        let counting = qrt_scene::Counting {
            phase_bits,
            ..qrt_scene::Counting::default()
        };
        Settings::from_counting(&counting).unwrap()
    }

    #[test]
    fn the_error_is_that_of_the_colours_spread() {
        let mut ratios = Vec::new();
        for (phase_bits, most) in [(8, 9.0), (10, 7.0), (12, 5.5)] {
            let settings = settings(phase_bits);
            let mean = PhaseMean::new(&settings).unwrap();
            let auto = PhaseMean::auto(&settings).unwrap();
            let counting = AdaptiveBayes::new(&settings).unwrap();
            for histogram in [pixel(50, 0), pixel(30, 400), pixel(200, 40)] {
                let [mean, auto, counting]: [Errors; 3] =
                    [&mean as &dyn AmplitudeEstimator, &auto, &counting]
                        .map(|estimator| errors(estimator, &settings, &histogram, Noise::NONE));
                assert!(mean.rms < most, "{phase_bits}: {}", mean.rms);
                let rms = [auto.rms, counting.rms];
                assert!(
                    auto.rms < most && auto.rms < 1.3 * counting.rms,
                    "{phase_bits}: {rms:?}"
                );
                ratios.push(auto.rms / counting.rms);
                assert!(
                    mean.covered > 0.93 && auto.covered > 0.93,
                    "{}",
                    mean.covered
                );
            }
        }
        let logarithms: f64 = ratios.iter().map(|ratio: &f64| libm::log(*ratio)).sum();
        let ratio = libm::exp(logarithms / ratios.len() as f64);
        assert!(ratio < 0.6, "{ratio}");
    }

    /// Light that one path in a thousand finds: the run counts, and is as good as one that only counts.
    #[test]
    fn rare_light_is_counted() {
        let mut histogram = Histogram::new(10);
        histogram.add_all((0..4096).map(|path| if path < 4 { 1024 } else { 0 }));
        let settings = settings(10);
        let auto = PhaseMean::auto(&settings).unwrap();
        let counting = AdaptiveBayes::new(&settings).unwrap();
        let found = errors(&auto, &settings, &histogram, Noise::NONE);
        let counted = errors(&counting, &settings, &histogram, Noise::NONE);
        assert!(
            found.rms < 1.25 * counted.rms,
            "{} {}",
            found.rms,
            counted.rms
        );
        assert!(found.covered > 0.93);
    }

    #[test]
    fn pixels_of_one_colour_are_found() {
        let settings = settings(10);
        for level in [0, 1, 300, 1024] {
            let mut histogram = Histogram::new(10);
            histogram.add_all((0..4096).map(|_| level));
            let mut stream = Stream::new(5, 0, 0, 0);
            let mut device = Device::of_histogram(&histogram, Noise::NONE, &mut stream).unwrap();
            let found = PhaseMean::new(&settings).unwrap().estimate(&mut device);
            let off = found.unwrap().amplitude - level as f64 / 1024.0;
            assert!(off.abs() < 1e-4, "{level}: {off}");
        }
    }

    #[test]
    fn an_asked_error_takes_fewer_queries_and_known_noise_is_taken_into_account() {
        let histogram = pixel(100, 40);
        let all = settings(14);
        let asked = Settings {
            error: Some(1e-3),
            ..all
        };
        let estimator = PhaseMean::new(&asked).unwrap();
        let found = errors(&estimator, &asked, &histogram, Noise::NONE);
        assert!(found.covered > 0.94);
        assert!(
            found.queries < 0.15 * all.queries as f64,
            "{}",
            found.queries
        );
        let noise = Noise {
            depolarising: 2e-3,
            readout: 1e-3,
        };
        let noisy = Settings {
            known_noise: noise,
            ..settings(12)
        };
        let estimator = PhaseMean::new(&noisy).unwrap();
        let found = errors(&estimator, &noisy, &histogram, noise);
        assert!(found.covered > 0.93, "{}", found.covered);
        assert!(found.rms < 40.0, "{}", found.rms);
    }

    /// Single paths, no comparator, black, white and mixed pixels, all budgets, and noise up to complete
    /// noise: runs end within their queries and in [0, 1].
    #[test]
    fn extremes_end_within_their_queries() {
        let pixels: [(u32, &[u64]); 7] = [
            (0, &[0]),
            (0, &[1, 0]),
            (4, &[16]),
            (4, &[0, 0, 0]),
            (12, &[4096, 4096, 4095]),
            (12, &[1; 100]),
            (12, &[0, 1, 4096, 7, 2000]),
        ];
        let noises = [
            (0.0, 0.0),
            (1e-3, 0.0),
            (0.3, 0.0),
            (1.0, 0.0),
            (0.0, 0.5),
            (0.0, 1.0),
        ];
        for (bits, levels) in pixels {
            let mut histogram = Histogram::new(bits);
            histogram.add_all(levels.iter().copied());
            for (depolarising, readout) in noises {
                let noise = Noise {
                    depolarising,
                    readout,
                };
                for queries in [1, 2, 12, 13, 59, 60, 300, 5000, 1 << 30, 1 << 50] {
                    if noise != Noise::NONE && queries > 5000 {
                        continue;
                    }
                    let settings = Settings {
                        queries,
                        known_noise: noise,
                        ..settings(8)
                    };
                    let estimator = PhaseMean::auto(&settings).unwrap();
                    let mut stream = Stream::new(queries, bits, 0, 0);
                    let mut device = Device::of_histogram(&histogram, noise, &mut stream).unwrap();
                    let found = estimator.estimate(&mut device).unwrap();
                    let (low, high) = found.interval;
                    assert!(found.queries <= queries, "{levels:?} {noise} {queries}");
                    assert!(0.0 <= low && low <= found.amplitude && found.amplitude <= high);
                    assert!(high <= 1.0 && found.depth <= queries);
                }
            }
        }
    }

    /// With noise the error falls as the root of the queries, and does not stay.
    #[test]
    fn noise_slows_the_error_and_does_not_hold_it() {
        let noise = Noise {
            depolarising: 0.02,
            readout: 0.0,
        };
        let histogram = pixel(100, 40);
        let [few, many] = [10, 16].map(|phase_bits| {
            let noisy = Settings {
                known_noise: noise,
                ..settings(phase_bits)
            };
            let estimator = PhaseMean::new(&noisy).unwrap();
            let found = errors(&estimator, &noisy, &histogram, noise);
            assert!(found.covered > 0.93, "{phase_bits}: {}", found.covered);
            found.rms / noisy.queries as f64
        });
        assert!(many < 0.3 * few, "{few} {many}");
    }

    #[test]
    fn levels_that_are_not_known_are_counted() {
        let settings = settings(8);
        let mut many = Histogram::new(13);
        many.add_all([0, 5, 8192]);
        let mut stream = Stream::new(5, 0, 0, 0);
        let mut device = Device::of_histogram(&many, Noise::NONE, &mut stream).unwrap();
        let phases = LevelPhases::new(1.0, 0.5, 12, 8).unwrap();
        let refused = device.mean_phase(phases, 1, 0.0);
        let other = EstimatorError::OtherLevels {
            device: 13,
            phases: 12,
        };
        assert_eq!(refused, Err(other));
        let found = PhaseMean::new(&settings).unwrap().estimate(&mut device);
        let mut stream = Stream::new(5, 0, 0, 0);
        let mut device = Device::of_histogram(&many, Noise::NONE, &mut stream).unwrap();
        let whole = Settings {
            strata: Some(1),
            ..settings
        };
        let counted = AdaptiveBayes::new(&whole).unwrap().estimate(&mut device);
        assert_eq!(found, counted);
    }
}
