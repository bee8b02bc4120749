//! `phase-mean` and `auto`: estimators that go on with the mean-phase circuit.

use super::run::Depths;
use super::{Goal, ways};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `phase-mean`: measures the mean itself as a phase, in units of the standard deviation of the
/// paths' colours.
///
/// The run begins with 12 to 24 paths drawn at random: with 12 if it has fewer than 240 queries, and
/// with none if it has fewer than 60. If their colours favour the mean phase, it draws 2 % of its
/// queries in all, and goes on with the mean-phase circuit. If not, it counts the whole comparator, as
/// `adaptive-bayes` can. Counting measures good indices, which have the paths that bring light: once it
/// has measured six of them and six others, and before a sixth of the queries is used, the run decides
/// again, from the colours of all paths that it has measured. `auto` is the same, except that both decisions
/// look at strata of the comparator, too: the first goes on counting where they are clearly better than
/// the mean phase, and the second may count them one by one.
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
        Self::auto(&settings.of_whole())
    }

    /// Creates `auto` from `settings`.
    ///
    /// # Errors
    /// A setting out of range.
    pub fn auto(settings: &Settings) -> Result<Self, EstimatorError> {
        let mut goal = Goal::from_settings(settings)?;
        goal.allowed.mean_phase = true;
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

    /// A histogram of 2^10 thresholds.
    fn histogram(levels: &[(u64, u32)]) -> Histogram {
        let mut histogram = Histogram::new(10);
        for &(level, paths) in levels {
            histogram.add_all((0..paths).map(|_| level));
        }
        histogram
    }

    /// Dark pixels, of whose paths few random ones show the colours: the good indices that counting measures do.
    #[test]
    fn counting_shows_the_colours_of_dark_pixels() {
        let dark = [
            (0, 1299),
            (1, 510),
            (2, 313),
            (3, 313),
            (4, 346),
            (5, 352),
            (6, 324),
            (7, 257),
            (8, 187),
            (9, 94),
            (10, 28),
            (11, 27),
            (12, 18),
            (13, 11),
            (14, 6),
            (16, 7),
            (24, 2),
            (30, 2),
        ];
        let darker = [(0, 3600), (3, 300), (7, 100), (12, 80), (60, 16)];
        let settings = settings(12);
        for levels in [&dark[..], &darker] {
            let histogram = histogram(levels);
            let [mean, auto] = [PhaseMean::new(&settings), PhaseMean::auto(&settings)];
            let counting = AdaptiveBayes::new(&settings).unwrap();
            let found = |estimator: &dyn AmplitudeEstimator| {
                errors(estimator, &settings, &histogram, Noise::NONE)
            };
            let [mean, auto, counting] = [
                &mean.unwrap() as &dyn AmplitudeEstimator,
                &auto.unwrap(),
                &counting,
            ]
            .map(found);
            let rms = [mean.rms, auto.rms, counting.rms];
            assert!(
                rms[0] < 6.0 && rms[1] < 6.0 && rms[1] < 0.9 * rms[2],
                "{rms:?}"
            );
            assert!(mean.covered > 0.93 && auto.covered > 0.93);
        }
    }

    /// A seventh of the paths has one colour near the end of a stratum, and the others are black: counting this stratum
    /// is expected to have less error than the mean phase, which has less than counting the whole.
    #[test]
    fn auto_counts_strata_where_they_are_better_than_the_mean_phase() {
        let histogram = histogram(&[(0, 3482), (200, 614)]);
        let settings = settings(12);
        let strata = (0..50).filter(|&run| {
            let mut stream = Stream::new(5, run, 0, 0);
            let mut device = Device::of_histogram(&histogram, Noise::NONE, &mut stream).unwrap();
            let found = PhaseMean::auto(&settings).unwrap().estimate(&mut device);
            found.unwrap().strata == 3
        });
        let strata = strata.count();
        assert!(strata >= 40, "{strata}");
        let error =
            |estimator: &PhaseMean| errors(estimator, &settings, &histogram, Noise::NONE).rms;
        let [auto, mean] = [PhaseMean::auto(&settings), PhaseMean::new(&settings)]
            .map(|made| error(&made.unwrap()));
        assert!(auto < mean, "{auto} and {mean}");
    }

    /// Rare paths of two colours: one eigenphase explains the shots badly, and one run in a thousand would end at a
    /// mean that is 4 to 80 times too large.
    #[test]
    fn runs_at_a_wrong_mode_begin_anew() {
        let settings = settings(12);
        let estimator = PhaseMean::auto(&settings).unwrap();
        for levels in [
            &[(0, 4045), (5, 3), (35, 17), (51, 29), (696, 2)][..],
            &[(0, 4079), (30, 5), (47, 8), (67, 4)],
        ] {
            let histogram = histogram(levels);
            let mean = histogram.good() as f64 / f64::from(1 << 22);
            for run in 0..1000 {
                let mut stream = Stream::new(settings.queries, run, 0, 0);
                let mut device =
                    Device::of_histogram(&histogram, Noise::NONE, &mut stream).unwrap();
                let found = estimator.estimate(&mut device).unwrap().amplitude;
                assert!(found < 2.0 * mean, "{run}: {found}, {mean}");
            }
        }
    }

    /// Few indices, of which a run soon knows each: it ends with numbers, and says S if it knows it.
    #[test]
    fn runs_over_few_indices_end_with_numbers() {
        let mut known = 0;
        for (bits, paths) in [(1, 3), (2, 5), (2, 16), (3, 7), (3, 16)] {
            for seed in 0..60 {
                let mut stream = Stream::new(seed, bits, 1, 0);
                let mut histogram = Histogram::new(bits);
                histogram.add_all((0..paths).map(|_| stream.below((1 << bits) + 1)));
                let mean = histogram.good() as f64 / (histogram.paths() << bits) as f64;
                for error in [None, Some(0.01)] {
                    let settings = Settings {
                        error,
                        ..settings(12)
                    };
                    let auto = PhaseMean::auto(&settings).unwrap();
                    let mut device =
                        Device::of_histogram(&histogram, Noise::NONE, &mut stream).unwrap();
                    let found = auto.estimate(&mut device).unwrap();
                    let (low, high) = found.interval;
                    assert!(
                        low <= found.amplitude && found.amplitude <= high,
                        "{found:?}"
                    );
                    assert!((found.amplitude - mean).abs() < 0.2, "{found:?} {mean}");
                    known += u32::from(found.good == Some(histogram.good()));
                }
            }
        }
        assert!(known > 100, "{known}");
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
        let counted = AdaptiveBayes::new(&settings.of_whole())
            .unwrap()
            .estimate(&mut device);
        assert_eq!(found, counted);
    }
}
