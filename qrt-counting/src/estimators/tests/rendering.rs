//! Short tests of the estimators of quantum rendering; `benches/estimators/rendering.rs` has the
//! long ones.

use crate::PhaseDistribution;
use crate::estimators::{CountingProblem, Device, Estimate, Noise, Settings, estimator};
use crate::random::Stream;
use qrt_circuit::quantum::Window;
use qrt_scene::{Counting, Estimator};

const ESTIMATORS: [Estimator; 3] = [Estimator::Qss, Estimator::Qcoin, Estimator::AbramsWilliams];
const COINS: [Estimator; 2] = [Estimator::Qcoin, Estimator::AbramsWilliams];

fn settings(phase_bits: u32) -> Settings {
    let counting = Counting {
        phase_bits,
        repetitions: 1,
        window: Window::Rect,
        estimator: Some(Estimator::Qss),
        strata: None,
        error: None,
    };
    Settings::from_counting(&counting).unwrap()
}

fn run(
    name: Estimator,
    settings: &Settings,
    problem: CountingProblem,
    noise: Noise,
    run: u32,
) -> Estimate {
    let mut stream = Stream::new(41, run, 0, 0);
    let mut device = Device::new(problem, noise, &mut stream).unwrap();
    estimator(name, settings)
        .unwrap()
        .estimate(&mut device)
        .unwrap()
}

/// The coverage: the fraction of runs whose interval contains S/N.
fn coverage(name: Estimator, settings: &Settings, amplitude: Option<f64>, noise: Noise) -> f64 {
    let (runs, total) = (500, 1_u64 << 40);
    let estimator = estimator(name, settings).unwrap();
    let mut covered = 0;
    for run in 0..runs {
        let mut stream = Stream::new(43, run, 0, 0);
        let amplitude = amplitude.unwrap_or_else(|| stream.uniform());
        let problem = CountingProblem {
            good: (amplitude * total as f64) as u64,
            total,
        };
        let mut device = Device::new(problem, noise, &mut stream).unwrap();
        let (low, high) = estimator.estimate(&mut device).unwrap().interval;
        let truth = problem.good as f64 / total as f64;
        covered += u32::from(low - 1e-15 <= truth && truth <= high + 1e-15);
    }
    f64::from(covered) / f64::from(runs)
}

#[test]
fn intervals_have_their_coverage() {
    for name in ESTIMATORS {
        for amplitude in [None, Some(0.0), Some(1e-6), Some(0.5), Some(1.0)] {
            let fraction = coverage(name, &settings(9), amplitude, Noise::NONE);
            // Four standard deviations of 500 runs.
            assert!(fraction > 0.95 - 0.039, "{name} {amplitude:?}: {fraction}");
        }
    }
}

#[test]
fn known_noise_leaves_coins_their_intervals() {
    let noise = Noise {
        depolarising: 3e-3,
        readout: 1e-3,
    };
    let settings = Settings {
        known_noise: noise,
        ..settings(11)
    };
    for name in COINS {
        for amplitude in [None, Some(0.02)] {
            let fraction = coverage(name, &settings, amplitude, noise);
            assert!(fraction > 0.95 - 0.039, "{name} {amplitude:?}: {fraction}");
        }
    }
}

/// Checks that every budget and S give an estimate within [0, 1] and the budget, and the same
/// again.
#[test]
fn every_budget_gives_an_answer() {
    let noisy = Noise {
        depolarising: 1e-2,
        readout: 1e-2,
    };
    for name in COINS {
        for queries in [1, 2, 3, 9, 10, 41, 1000, 1 << 30, 1 << 50, u64::MAX] {
            for total in [1, 2, 16, 1 << 60] {
                for good in [0, 1, total / 2, total - 1, total] {
                    for noise in [Noise::NONE, noisy] {
                        for known_noise in [Noise::NONE, noisy] {
                            let settings = Settings {
                                queries,
                                known_noise,
                                ..settings(5)
                            };
                            let problem = CountingProblem { good, total };
                            let found = run(name, &settings, problem, noise, 0);
                            let (low, high) = found.interval;
                            assert!(found.queries <= queries && found.queries > 0);
                            assert!(0.0 <= low && low <= found.amplitude, "{name} {found:?}");
                            assert!(found.amplitude <= high && high <= 1.0, "{name} {found:?}");
                            assert_eq!(found, run(name, &settings, problem, noise, 0));
                            if noise == Noise::NONE && (good == 0 || good == total) {
                                assert_eq!(found.amplitude, (good / total) as f64);
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn an_asked_error_is_reached_and_not_much_more_is_spent() {
    for name in COINS {
        for error in [0.1, 1e-2, 1e-4, 1e-8] {
            for good in [0, 1 << 39, 123_456_789_012, 1 << 40] {
                let settings = Settings {
                    queries: 1 << 50,
                    error: Some(error),
                    ..settings(5)
                };
                let problem = CountingProblem {
                    good,
                    total: 1 << 40,
                };
                let found = run(name, &settings, problem, Noise::NONE, 7);
                let half_width = 0.5 * (found.interval.1 - found.interval.0);
                assert!(half_width <= error, "{name} {error}: {half_width}");
                let spent = found.queries as f64 * error;
                assert!(spent < 400.0, "{name} {error}: {spent}");
            }
        }
    }
}

/// Checks the cost under noise, which limits the queries per toss, so that many tosses are
/// necessary.
#[test]
fn an_asked_error_is_reached_in_spite_of_known_noise() {
    let noise = Noise {
        depolarising: 1e-2,
        readout: 0.0,
    };
    for name in COINS {
        for good in [0, 1 << 19, 54_321, 1 << 20] {
            let settings = Settings {
                queries: 1 << 50,
                error: Some(1e-3),
                known_noise: noise,
                ..settings(5)
            };
            let problem = CountingProblem {
                good,
                total: 1 << 20,
            };
            let found = run(name, &settings, problem, noise, 3);
            let half_width = 0.5 * (found.interval.1 - found.interval.0);
            assert!(half_width <= 1e-3, "{name} {good}: {half_width}");
            assert!(found.queries < 1 << 26, "{name} {good}: {}", found.queries);
        }
    }
}

/// Checks that the table and the paper's inference find the same S for a single reading.
#[test]
fn supersampling_looks_up_what_is_likeliest() {
    for (total, bits) in [(16, 4), (1000, 7), (1 << 30, 12), (1 << 60, 40)] {
        for index in 0..50 {
            let problem = CountingProblem {
                good: total / 50 * index,
                total,
            };
            let (paper, table) = (Estimator::Paper, Estimator::Qss);
            let [paper, table] = [paper, table]
                .map(|name| run(name, &settings(bits), problem, Noise::NONE, index as u32));
            assert_eq!((table.good, table.queries), (paper.good, paper.queries));
        }
    }
}

/// Checks that intervals of 95 % have a coverage of 0.90 halfway between two readings.
///
/// The coverage is a sum over all readings, not over random runs.
#[test]
fn supersampling_covers_least_between_its_readings() {
    let (total, bits) = (1_u64 << 40, 8);
    let supersampling = crate::estimators::Supersampling::new(&settings(bits)).unwrap();
    let table = supersampling.table(total).unwrap();
    let covered = |steps: f64| {
        let amplitude = libm::sin(std::f64::consts::PI * steps / 256.0).powi(2);
        let good = (amplitude * total as f64) as u64;
        let distribution = PhaseDistribution::new(good, total, bits, Window::Rect).unwrap();
        let holds = |y: &u64| {
            let (low, high) = table.column(*y).unwrap().interval;
            low <= amplitude && amplitude <= high
        };
        let readings = (0..=distribution.largest_outcome()).filter(holds);
        readings.map(|y| distribution.probability(y)).sum::<f64>()
    };
    for cell in [20.0, 50.0, 64.0] {
        assert!(
            (covered(cell + 0.5) - 0.90).abs() < 0.01,
            "{}",
            covered(cell + 0.5)
        );
        assert!(covered(cell + 0.01) > 0.999);
    }
}
