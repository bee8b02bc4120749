//! Tests of counting by strata.

use crate::estimators::{CountingProblem, Device, Estimate, Noise, Settings, estimator};
use crate::random::Stream;
use crate::{Octaves, Stratum};
use qrt_scene::{Counting, Estimator};

const BITS: u32 = 10;
const PATHS: u64 = 1 << 12;

/// Paths whose colours, in units of the scale, are `colour(u)` for u spread evenly.
fn paths(colour: impl Fn(f64) -> f64) -> Octaves {
    let mut octaves = Octaves::new(BITS);
    for path in 0..PATHS {
        let u = (path as f64 + 0.5) / PATHS as f64;
        octaves.add((colour(u) * f64::from(1_u32 << BITS)).round() as u64);
    }
    octaves
}

/// A pixel with light sampling: some paths are in shadow, the others spread up to a small part of
/// the scale.
fn light_sampled() -> Octaves {
    paths(|u| 0.1 * (u - 0.226).max(0.0))
}

/// Pixels of several kinds, with their names.
fn pixels() -> Vec<(&'static str, Octaves)> {
    let last = 1.0 - 1.0 / PATHS as f64;
    vec![
        ("light sampled", light_sampled()),
        ("all or nothing", paths(|u| f64::from(u < 0.03))),
        ("half of them", paths(|u| f64::from(u < 0.5))),
        (
            "long tail",
            paths(|u| (-0.03 * libm::log(1.0 - u)).min(1.0)),
        ),
        (
            "a lamp in a corner",
            paths(|u| if u < 0.01 { 1.0 } else { 0.04 * u }),
        ),
        ("even", paths(|u| u)),
        ("one colour", paths(|_| 0.3)),
        ("one dark colour", paths(|_| 0.01)),
        ("black", paths(|_| 0.0)),
        ("white", paths(|_| 1.0)),
        ("one path", paths(|u| f64::from(u > last))),
        ("all but one path", paths(|u| f64::from(u < last))),
        (
            "one index",
            paths(|u| {
                if u > last {
                    1.0 / f64::from(1_u32 << BITS)
                } else {
                    0.0
                }
            }),
        ),
    ]
}

fn settings(queries: u64, strata: Option<u32>) -> Settings {
    Settings {
        queries,
        strata,
        ..Settings::from_counting(&Counting::default()).unwrap()
    }
}

fn run(name: Estimator, settings: &Settings, octaves: &Octaves, seed: u32) -> Estimate {
    let mut stream = Stream::new(3, seed, 0, 0);
    let mut device = Device::of_octaves(octaves, Noise::NONE, &mut stream).unwrap();
    let found = estimator(name, settings)
        .unwrap()
        .estimate(&mut device)
        .unwrap();
    assert_eq!(found.queries, device.usage().queries);
    let strata = device.counted_strata();
    assert_eq!(
        strata.len(),
        if found.strata == 1 {
            0
        } else {
            found.strata as usize
        }
    );
    if found.strata > 1 {
        let sum: f64 = strata.iter().map(|stratum| stratum.amplitude).sum();
        assert!((sum - found.amplitude).abs() < 1e-12);
    }
    found
}

fn truth(octaves: &Octaves) -> f64 {
    octaves.good().iter().sum::<u64>() as f64 / (octaves.paths() << BITS) as f64
}

/// Checks how many intervals of `runs` runs on every pixel hold S/N.
///
/// The limit is three and a half deviations below 95 %.
fn intervals_hold(runs: u32, budgets: &[u64], strata: &[Option<u32>]) {
    let n = f64::from(runs);
    let least = 0.95 * n - 3.5 * (0.95 * 0.05 * n).sqrt();
    let names = [Estimator::AdaptiveBayes, Estimator::RandomDepth];
    for (about, octaves) in pixels() {
        let truth = truth(&octaves);
        for name in names {
            for (&queries, &strata) in budgets
                .iter()
                .flat_map(|q| strata.iter().map(move |s| (q, s)))
            {
                let settings = settings(queries, strata);
                let held = (0..runs).filter(|&seed| {
                    let found = run(name, &settings, &octaves, seed);
                    assert!(found.queries <= queries);
                    let (low, high) = found.interval;
                    assert!(0.0 <= low && low <= found.amplitude && found.amplitude <= high);
                    low <= truth + 1e-15 && truth - 1e-15 <= high
                });
                let held = held.count();
                assert!(
                    held as f64 >= least,
                    "{name}, {about}, {queries} queries, {strata:?} strata: {held} of {runs}"
                );
            }
        }
    }
}

#[test]
fn intervals_of_strata_hold_the_amplitude() {
    intervals_hold(100, &[15, 255], &[None, Some(2), Some(4)]);
}

/// Run it with `cargo test -p qrt-counting --lib ten_thousand -- --ignored`; `.ci/run` does not.
#[test]
#[ignore = "ten thousand runs of every kind take more than eight minutes"]
fn intervals_of_strata_hold_the_amplitude_ten_thousand_times() {
    intervals_hold(10_000, &[255], &[None, Some(4)]);
}

/// The root mean square error of `runs` runs.
fn error(octaves: &Octaves, queries: u64, strata: Option<u32>, runs: u32) -> f64 {
    let (truth, settings) = (truth(octaves), settings(queries, strata));
    let square = |seed| {
        let found = run(Estimator::AdaptiveBayes, &settings, octaves, seed);
        (found.amplitude - truth).powi(2)
    };
    ((0..runs).map(square).sum::<f64>() / f64::from(runs)).sqrt()
}

#[test]
fn strata_pay_where_colours_are_small_and_are_left_alone_where_not() {
    let (runs, queries) = (150, 2047);
    let octaves = light_sampled();
    let whole = error(&octaves, queries, Some(1), runs);
    for (strata, pays) in [(Some(2), 1.2), (Some(4), 1.9), (None, 1.7)] {
        let ratio = whole / error(&octaves, queries, strata, runs);
        assert!(ratio > pays, "{strata:?}: {ratio}");
    }
    for pixel in ["all or nothing", "half of them", "black", "white"] {
        let (_, octaves) = pixels()
            .into_iter()
            .find(|(name, _)| *name == pixel)
            .unwrap();
        for seed in 0..20 {
            let [auto, one] = [None, Some(1)].map(|strata| {
                run(
                    Estimator::AdaptiveBayes,
                    &settings(queries, strata),
                    &octaves,
                    seed,
                )
            });
            assert_eq!(auto, one, "{pixel}");
        }
    }
}

/// Checks one stratum on a device that knows the good indices by octave.
///
/// Its estimates are those of a device without that knowledge.
#[test]
fn one_stratum_is_the_whole_query_by_query() {
    for (about, octaves) in pixels() {
        let good = octaves.good().iter().sum();
        let problem = CountingProblem {
            good,
            total: PATHS << BITS,
        };
        for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
            let settings = settings(255, Some(1));
            let mut stream = Stream::new(3, 1, 0, 0);
            let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
            let found = estimator(name, &settings)
                .unwrap()
                .estimate(&mut device)
                .unwrap();
            assert_eq!(found, run(name, &settings, &octaves, 1), "{about}");
            let auto = run(name, &self::settings(255, None), &octaves, 1);
            assert!(auto.strata > 1 || auto == found, "{about}");
        }
    }
}

/// Checks budgets from one query on, with noise, several numbers of strata, and a requested error.
#[test]
fn strata_keep_their_bounds_and_their_queries() {
    for (about, octaves) in pixels() {
        for strata in [None, Some(2), Some(5), Some(BITS + 1), Some(31)] {
            for (index, queries) in [1, 2, 7, 30, 300].into_iter().enumerate() {
                let mut settings = settings(queries, strata);
                if index % 2 == 1 {
                    settings.error = Some(1e-2);
                }
                let noise = ["depolarising=0", "depolarising=0.1", "readout=0.3"][index % 3];
                let estimator = estimator(Estimator::AdaptiveBayes, &settings).unwrap();
                let mut stream = Stream::new(queries, 0, 0, 0);
                let mut device =
                    Device::of_octaves(&octaves, noise.parse().unwrap(), &mut stream).unwrap();
                let found = estimator.estimate(&mut device).unwrap();
                let about = format!("{about}, {strata:?}, {queries}: {found:?}");
                assert!(found.queries <= queries && found.queries >= 1, "{about}");
                assert!(found.strata <= BITS + 1, "{about}");
                let (low, high) = found.interval;
                assert!(0.0 <= low && low <= found.amplitude, "{about}");
                assert!(found.amplitude <= high && high <= 1.0, "{about}");
            }
        }
    }
}

#[test]
fn an_asked_error_is_reached() {
    let octaves = light_sampled();
    for strata in [Some(1), Some(4), None] {
        let settings = Settings {
            error: Some(1e-4),
            ..settings(1 << 20, strata)
        };
        let found = run(Estimator::AdaptiveBayes, &settings, &octaves, 0);
        let (low, high) = found.interval;
        assert!(high - low <= 2e-4, "{found:?}");
        assert!(found.queries < 1 << 16, "{found:?}");
    }
}

#[test]
fn a_stratum_that_is_not_there_is_refused() {
    let mut stream = Stream::new(1, 0, 0, 0);
    let upper = Stratum::halving(2, BITS).last().unwrap();
    let problem = CountingProblem { good: 1, total: 4 };
    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
    assert!(device.within(upper, |_| ()).is_err());
    let mut small = Octaves::new(2);
    small.add(3);
    let mut device = Device::of_octaves(&small, Noise::NONE, &mut stream).unwrap();
    assert!(device.within(upper, |_| ()).is_err());
    for name in [Estimator::Sine, Estimator::Mlae, Estimator::MonteCarlo] {
        assert!(estimator(name, &settings(255, Some(4))).is_err());
        assert!(estimator(name, &settings(255, None)).is_ok());
    }
}
