//! Tests of every estimator that has a query budget, on many kinds of problems.

use crate::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use crate::random::Stream;
use qrt_scene::{Counting, Estimator};

/// The estimators that choose their own measurements.
fn deciding() -> [Estimator; 7] {
    use Estimator::{AdaptiveBayes, Chebyshev, Iqae, Miqae, Mlae, MonteCarlo, RandomDepth};
    [
        MonteCarlo,
        AdaptiveBayes,
        RandomDepth,
        Mlae,
        Iqae,
        Miqae,
        Chebyshev,
    ]
}

fn settings(queries: u64) -> Settings {
    Settings {
        queries,
        ..Settings::from_counting(&Counting::default()).unwrap()
    }
}

/// Checks budgets of 1 to 2^50 queries for 1 to 2^60 indices, with and without a requested error.
///
/// The devices are with and without noise.
#[test]
fn no_estimate_leaves_its_bounds_or_its_queries() {
    let noises = ["depolarising=0", "depolarising=0.1", "readout=0.3"];
    for name in deciding() {
        for total in [1, 2, 16, 1000, 1 << 40, 1 << 60] {
            for good in [0, 1, total / 3, total / 2, total - 1, total] {
                for (index, queries) in [1, 2, 3, 7, 30, 100, 1000, 1 << 20, 1 << 50]
                    .into_iter()
                    .enumerate()
                {
                    let mut settings = settings(queries);
                    if index % 2 == 1 {
                        settings.error = Some(1e-2);
                    }
                    let estimator = estimator(name, &settings).unwrap();
                    let problem = CountingProblem { good, total };
                    let noise: Noise = noises[index % 3].parse().unwrap();
                    let mut stream = Stream::new(queries, 0, 0, 0);
                    let mut device = Device::new(problem, noise, &mut stream).unwrap();
                    let found = estimator.estimate(&mut device).unwrap();
                    let about = format!("{name}, {good} of {total}, {queries}: {found:?}");
                    assert!(found.queries <= queries, "{about}");
                    assert!(found.queries >= 1 && found.shots >= 1, "{about}");
                    assert_eq!(found.queries, device.usage().queries, "{about}");
                    let (low, high) = found.interval;
                    assert!(0.0 <= low && low <= found.amplitude, "{about}");
                    assert!(found.amplitude <= high && high <= 1.0, "{about}");
                    assert!(found.ln_likelihood.is_none_or(f64::is_finite), "{about}");
                    // The same random stream gives the same estimate.
                    let mut stream = Stream::new(queries, 0, 0, 0);
                    let mut again = Device::new(problem, noise, &mut stream).unwrap();
                    assert_eq!(estimator.estimate(&mut again).unwrap(), found);
                }
            }
        }
    }
}

/// Checks the coverage with few runs; the bench makes 10,000.
#[test]
fn intervals_hold_the_amplitude() {
    for name in deciding() {
        for (queries, total) in [(20, 16_u64), (500, 1 << 40), (1 << 20, 1 << 40)] {
            let estimator = estimator(name, &settings(queries)).unwrap();
            for amplitude in [
                None,
                Some(0.0),
                Some(1e-6),
                Some(0.5),
                Some(1.0 - 1e-6),
                Some(1.0),
            ] {
                let runs = 200;
                let mut held = 0;
                for run in 0..runs {
                    let mut stream = Stream::new(17, run, queries as u32, 0);
                    let amplitude = amplitude.unwrap_or_else(|| stream.uniform());
                    let good = (amplitude * total as f64) as u64;
                    let truth = good as f64 / total as f64;
                    let problem = CountingProblem { good, total };
                    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                    let found = estimator.estimate(&mut device).unwrap();
                    let (low, high) = found.interval;
                    held += u32::from(low <= truth + 1e-15 && truth - 1e-15 <= high);
                }
                // Three and a half deviations below 95 %.
                assert!(
                    held >= 179,
                    "{name} {queries} {amplitude:?}: {held} of {runs}"
                );
            }
        }
    }
}

/// Checks that noise unknown to the estimator does not keep it from terminating.
#[test]
fn no_device_is_bad_enough_to_loop() {
    for name in deciding() {
        for noise in ["depolarising=1", "depolarising=0.001", "readout=1"] {
            for good in [0, 1, 77, 128, 255, 256] {
                let estimator = estimator(name, &settings(1 << 45)).unwrap();
                let problem = CountingProblem { good, total: 256 };
                let mut stream = Stream::new(5, 0, 0, 0);
                let mut device = Device::new(problem, noise.parse().unwrap(), &mut stream).unwrap();
                let found = estimator.estimate(&mut device).unwrap();
                assert!((0.0..=1.0).contains(&found.amplitude));
                assert!(found.rounds < 100_000, "{name} {noise} {good}: {found:?}");
            }
        }
    }
}
