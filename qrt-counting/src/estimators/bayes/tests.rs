//! Tests of the Bayesian estimators.

use super::posterior::Posterior;
use super::support::Prior;
use crate::Angle;
use crate::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use crate::random::Stream;
use qrt_circuit::quantum::Window;
use qrt_scene::{Counting, Estimator};

fn settings(queries: u64) -> Settings {
    let counting = Counting {
        phase_bits: 8,
        repetitions: 1,
        window: Window::Sine,
        estimator: Some(Estimator::AdaptiveBayes),
        strata: None,
        error: None,
    };
    Settings {
        queries,
        ..Settings::from_counting(&counting).unwrap()
    }
}

/// Mean of S/N and standard deviation of pi theta by a sum over every S, with probabilities from
/// double-double angles.
fn over_every_count(total: u64, noise: Noise, shots: &[(u64, u64, u64)]) -> (f64, f64) {
    let bits = u64::BITS - (total - 1).leading_zeros();
    let weight = |good: u64| {
        let angle = Angle::from_counts(good, total).unwrap();
        let (any, other) = angle.sine_squared(1);
        let mut product = 1.0;
        for &(iterations, hits, misses) in shots {
            let (p, q) = angle.sine_squared(2 * iterations + 1);
            let right = if iterations == 0 {
                1.0
            } else {
                noise.intact(iterations) * noise.read_rightly(bits)
            };
            let (p, q) = (
                right * p + (1.0 - right) * any,
                right * q + (1.0 - right) * other,
            );
            product *= p.powi(hits as i32) * q.powi(misses as i32);
        }
        product
    };
    let (mut mass, mut amplitude, mut first, mut second) = (0.0, 0.0, 0.0, 0.0);
    for good in 0..=total {
        let (m, a) = (weight(good), good as f64 / total as f64);
        let x = libm::asin(a.sqrt());
        mass += m;
        amplitude += m * a;
        first += m * x;
        second += m * x * x;
    }
    let x = first / mass;
    (amplitude / mass, (second / mass - x * x).sqrt())
}

/// Compares posteriors with sums over every S, at random query depths that may leave many modes.
///
/// The posterior of six thousand S is a grid. It drops points with less than 10^-8 of the mass,
/// which leaves that much of a variance out. A grid gives S = 0 and S = N half of their weight.
#[test]
fn posteriors_equal_sums_over_every_count() {
    let noisy = Noise {
        depolarising: 0.02,
        readout: 0.001,
    };
    let mut checked = 0;
    for case in 0..24 {
        let mut stream = Stream::new(8, case, 0, 0);
        let total = if case % 4 == 0 {
            3 + u64::from(case)
        } else {
            6_000
        };
        let noise = if case % 3 == 0 { noisy } else { Noise::NONE };
        let good = (stream.uniform() * (total + 1) as f64) as u64;
        let mut device = Device::new(CountingProblem { good, total }, noise, &mut stream).unwrap();
        let mut posterior = Posterior::new(total, noise, Prior::Even);
        let mut shots = Vec::new();
        for round in 0..14_u64 {
            let iterations = device.stream().next_u64() % (2 + round * round / 4);
            let count = if round % 5 == 4 { 7 } else { 1 };
            let hits = device.iterated(iterations, count).unwrap();
            posterior.observe(iterations, hits, count - hits);
            shots.push((iterations, hits, count - hits));
            if round % 4 == 1 {
                let (mean, deviation) = over_every_count(total, noise, &shots);
                let found = posterior.variance().sqrt();
                assert!(
                    (posterior.mean_amplitude() - mean).abs()
                        < 2e-4 * deviation + 1.0 / total as f64,
                    "{case} {round}: {} {mean} {deviation} {shots:?} {noise:?} {total}",
                    posterior.mean_amplitude()
                );
                assert!(
                    (found * found - deviation * deviation).abs()
                        < 1e-3 * deviation.powi(2) + 1.0 / total as f64,
                    "{case} {round}: {found} {deviation}"
                );
                checked += 1;
            }
        }
    }
    assert!(checked > 60);
}

/// Compares the variance before and after one shot with closed forms.
///
/// Before the first shot, x = pi theta has density sin 2x on [0, pi/2] and variance pi^2/16 - 1/2.
/// A good or a bad index at k = 0 makes the density `2 sin 2x sin^2 x` or its mirror image, with
/// variance 15 pi^2/256 - 1/2.
#[test]
fn expected_variances_are_those_of_the_prior_in_closed_form() {
    let mut posterior = Posterior::new(1 << 40, Noise::NONE, Prior::Even);
    let square = std::f64::consts::PI.powi(2);
    let before = square / 16.0 - 0.5;
    assert!((posterior.variance() - before).abs() < 1e-5);
    let after = 15.0 * square / 256.0 - 0.5;
    let rest = posterior.remaining_variance(0);
    assert!((rest - after / before).abs() < 1e-5, "{rest}");
    posterior.observe(0, 1, 0);
    assert!((posterior.variance() - after).abs() < 1e-5);
}

/// Checks that a run on few indices is exact and ends before its queries do.
#[test]
fn few_ids_are_counted_exactly() {
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        for total in [1, 2, 3, 16, 64] {
            for good in [0, 1, total / 2, total - 1, total] {
                let mut stream = Stream::new(3, good as u32, total as u32, 0);
                let problem = CountingProblem { good, total };
                let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                let found = estimator(name, &settings(20_000))
                    .unwrap()
                    .estimate(&mut device)
                    .unwrap();
                assert_eq!(found.good, Some(good), "{name} {good}/{total}");
                assert!(
                    found.queries < 15_000,
                    "{name} {good}/{total}: {}",
                    found.queries
                );
                let truth = good as f64 / total as f64;
                assert!((found.amplitude - truth).abs() < 1e-9);
                assert!(found.interval.0 <= truth && truth <= found.interval.1);
            }
        }
    }
}

/// Compares queries times 95th-percentile error with the stated values.
///
/// The runs are few, so the limits leave room for chance.
#[test]
fn errors_fall_with_the_queries() {
    for (name, most) in [
        (Estimator::AdaptiveBayes, 2.2),
        (Estimator::RandomDepth, 3.4),
    ] {
        for queries in [256, 4096] {
            let total = 1_u64 << 40;
            let mut errors: Vec<f64> = (0..200)
                .map(|run| {
                    let mut stream = Stream::new(6, run, 1, 0);
                    let good = (stream.uniform() * total as f64) as u64;
                    let problem = CountingProblem { good, total };
                    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                    let run = estimator(name, &settings(queries)).unwrap();
                    let found = run.estimate(&mut device).unwrap();
                    assert_eq!(found.queries, queries);
                    (found.amplitude - good as f64 / total as f64).abs()
                })
                .collect();
            errors.sort_by(f64::total_cmp);
            let scaled = errors[190] * queries as f64;
            assert!(scaled < most, "{name} {queries}: {scaled}");
        }
    }
}

/// Checks query depths of 2^40 and more, batches and known noise.
///
/// Estimates are within the budget, inside [0, 1], and near the truth.
#[test]
fn extremes_hold() {
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        for (good, total) in [
            (0, 1 << 60),
            (1, 1 << 60),
            (1 << 58, 1 << 60),
            ((1 << 60) - 1, 1 << 60),
            (12345, 1 << 40),
        ] {
            for (queries, noise) in [
                (1, Noise::NONE),
                (2, Noise::NONE),
                (1 << 20, Noise::NONE),
                (1 << 42, Noise::NONE),
                (
                    1 << 50,
                    Noise {
                        depolarising: 1e-3,
                        readout: 1e-3,
                    },
                ),
                (
                    1 << 30,
                    Noise {
                        depolarising: 1.0,
                        readout: 0.5,
                    },
                ),
            ] {
                let mut stream = Stream::new(4, 0, 0, 0);
                let problem = CountingProblem { good, total };
                let mut device = Device::new(problem, noise, &mut stream).unwrap();
                let asked = Settings {
                    known_noise: noise,
                    ..settings(queries)
                };
                let found = estimator(name, &asked)
                    .unwrap()
                    .estimate(&mut device)
                    .unwrap();
                let truth = good as f64 / total as f64;
                let (low, high) = found.interval;
                let case = format!("{name} {good}/{total} {queries} {noise:?}: {found:?}");
                assert!(found.queries <= queries && found.queries > 0, "{case}");
                assert!(0.0 <= low && low <= found.amplitude, "{case}");
                assert!(found.amplitude <= high && high <= 1.0, "{case}");
                let reach = 20.0 * (high - low);
                assert!(low - reach <= truth && truth <= high + reach, "{case}");
                if noise == Noise::NONE {
                    assert!(high - low < 20.0 / queries as f64, "{case}");
                }
            }
        }
    }
}

#[test]
fn an_asked_error_ends_the_run() {
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        let asked = Settings {
            error: Some(1e-3),
            ..settings(1 << 30)
        };
        let mut stream = Stream::new(4, 0, 0, 0);
        let problem = CountingProblem {
            good: 300,
            total: 1000,
        };
        let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
        let found = estimator(name, &asked)
            .unwrap()
            .estimate(&mut device)
            .unwrap();
        assert!(
            found.interval.1 - found.interval.0 <= 2e-3 * 1.5,
            "{found:?}"
        );
        assert!(found.queries < 8000, "{found:?}");
    }
}

/// Checks that noise unknown to the estimator still gives an estimate, although a wrong one.
#[test]
fn contradictory_outcomes_are_survived() {
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        for (good, total) in [(1, 4), (1, 3), (7, 1 << 40), (1 << 39, 1 << 40)] {
            for run in 0..20 {
                let mut stream = Stream::new(12, run, 0, 0);
                let noise = Noise {
                    depolarising: 0.1,
                    readout: 0.05,
                };
                let mut device =
                    Device::new(CountingProblem { good, total }, noise, &mut stream).unwrap();
                let found = estimator(name, &settings(3000))
                    .unwrap()
                    .estimate(&mut device)
                    .unwrap();
                assert!((0.0..=1.0).contains(&found.amplitude), "{found:?}");
                assert!(found.interval.0 <= found.interval.1);
            }
        }
    }
}
