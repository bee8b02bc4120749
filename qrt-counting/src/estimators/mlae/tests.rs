//! Tests of maximum likelihood estimation.

use super::likelihood::{Level, Likelihood};
use super::schedule::Schedule;
use super::search::search;
use super::*;
use crate::binomial;
use crate::estimators::turns::{HALF, of_sine_squared, sine_squared};
use crate::estimators::{CountingProblem, MAX_ITERATIONS};
use crate::random::Stream;
use proptest::prelude::*;
use qrt_scene::Counting;

fn likelihood(levels: &[(u64, u64, u64)], intact: f64) -> Likelihood {
    let mut likelihood = Likelihood::default();
    for &(iterations, hits, shots) in levels {
        likelihood.add(Level {
            multiple: 2 * iterations + 1,
            hits,
            shots,
            intact: if iterations == 0 { 1.0 } else { intact },
        });
    }
    likelihood
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Compares with the values on a fine grid, for measurements that fit an angle and for others.
    #[test]
    fn no_angle_is_likelier_than_the_one_found_and_none_within_reach_is_left_out(
        seed in any::<u64>(), levels in 1..6_u32, shots in 1..20_u64, noise in any::<bool>(),
        arbitrary in any::<bool>(), truth in 0..=HALF,
    ) {
        let mut stream = Stream::new(seed, 0, 0, 0);
        let intact = if noise { 0.7 } else { 1.0 };
        let measured: Vec<_> = (0..levels)
            .map(|level| {
                let iterations = (1_u64 << level) >> 1;
                let phase = truth.wrapping_mul(2 * iterations + 1);
                let p = if arbitrary { stream.uniform() } else { sine_squared(phase).0 };
                (iterations, binomial::draw_with(shots, p, 1.0 - p, &mut stream), shots)
            })
            .collect();
        let likelihood = likelihood(&measured, intact);
        let reach = 2.0;
        let found = search(&likelihood, reach);
        let best = likelihood.at(found.angle);
        let step = HALF >> 13;
        for i in 0..=1 << 13 {
            let value = likelihood.at(i * step);
            prop_assert!(value <= best + 1e-9, "{i}: {value} > {best}");
            if value >= best - reach + 1e-9 {
                prop_assert!(found.low <= i * step + 1000 && i * step <= found.high + 1000);
            }
        }
        // At the ends, the likelihood is `reach` below its largest value.
        for end in [found.low, found.high] {
            let value = likelihood.at(end) - best + reach;
            let edge = end <= 1000 || end >= HALF - 1000;
            prop_assert!(edge || value.abs() < 1e-3 || found.ranges > 1, "{value}");
        }
    }
}

/// Checks one binomial: the fraction itself, and the ends, at which n KL(h/n, p) is the reach.
#[test]
fn paths_alone_give_their_share() {
    for (hits, shots) in [(3, 10), (0, 7), (7, 7), (1, 1_000_000), (1 << 49, 1 << 51)] {
        let found = search(&likelihood(&[(0, hits, shots)], 1.0), 1.92);
        let (h, n) = (hits as f64, shots as f64);
        let fraction = amplitude(found.angle);
        assert!(
            (fraction - h / n).abs() <= 1e-3 * (h / n).sqrt() / n.sqrt(),
            "{fraction}"
        );
        let (low, high) = (amplitude(found.low), amplitude(found.high));
        for end in [low, high] {
            if end > 1e-9 && end < 1.0 - 1e-9 {
                let part = |count: f64, fraction: f64| match count {
                    0.0 => 0.0,
                    _ => count * libm::log(count / n / fraction),
                };
                let kl = part(h, end) + part(n - h, 1.0 - end);
                assert!((kl - 1.92).abs() < 1e-3 * n.sqrt().min(100.0), "{kl}");
            }
        }
        assert_eq!(found.ranges, 1);
    }
}

/// Checks 42 levels with the expected hits at all phases.
///
/// The angle is found to far less than a section of the deepest level.
#[test]
fn the_peak_is_found_at_any_depth() {
    let truth = of_sine_squared(0.2371);
    let shots = 1 << 20;
    let levels: Vec<_> = (0..42)
        .map(|level| {
            let iterations = (1_u64 << level) >> 1;
            let phase = truth.wrapping_mul(2 * iterations + 1);
            let hits = (sine_squared(phase).0 * shots as f64).round() as u64;
            (iterations, hits, shots)
        })
        .collect();
    let found = search(&likelihood(&levels, 1.0), 1.92);
    let deviation = found.angle.abs_diff(truth);
    assert!(deviation < HALF >> 50, "{deviation}");
    assert!(found.low < truth && truth < found.high && found.ranges == 1);
}

#[test]
fn schedules_keep_to_the_queries_and_use_them() {
    let noises = [
        "depolarising=0",
        "depolarising=0.01",
        "readout=0.02",
        "readout=0.9",
    ];
    for noise in noises {
        let noise: Noise = noise.parse().unwrap();
        for bits in [0, 10, 60] {
            let schedule = Schedule::new(noise, bits);
            for power in 0..64 {
                for queries in [1 << power, (1 << power) + (1 << power) / 3] {
                    let levels = schedule.levels(queries);
                    let spent: u128 = levels
                        .iter()
                        .map(|&(k, shots)| u128::from(k.max(1)) * u128::from(shots))
                        .sum();
                    assert!(spent <= queries.into(), "{noise} {queries}: {levels:?}");
                    assert!(2 * spent > queries.into(), "{noise} {queries}: {levels:?}");
                    assert!(levels.iter().all(|&(k, n)| k <= MAX_ITERATIONS && n > 0));
                    if levels.len() > 1 {
                        assert!(levels.iter().all(|&(_, n)| n >= Mlae::SHOTS));
                    }
                }
            }
        }
    }
    // Without noise, query depths double as published.
    let levels = Schedule::new(Noise::NONE, 20).levels(1000);
    let depths: Vec<u64> = levels.iter().map(|level| level.0).collect();
    assert_eq!(depths, [0, 1, 2, 4, 8, 16, 32, 3]);
    // Query depths stop at 1 / (2 d).
    let levels = Schedule::new("depolarising=0.01".parse().unwrap(), 20).levels(1_000_000);
    assert_eq!(levels.last().map(|level| level.0), Some(49));
}

/// Checks the coverage with depolarising and readout noise, known and not.
///
/// Unknown noise is taken for a signal.
#[test]
fn known_noise_is_reckoned_with() {
    let noise: Noise = "depolarising=0.005,readout=0.01".parse().unwrap();
    let covered = |known_noise: Noise| {
        let settings = Settings {
            queries: 3000,
            known_noise,
            ..Settings::from_counting(&Counting::default()).unwrap()
        };
        let estimator = Mlae::new(&settings);
        let runs = 400;
        let within = (0..runs).filter(|&run| {
            let mut stream = Stream::new(11, run, 0, 0);
            let total = 1 << 20;
            let good = (stream.uniform() * total as f64) as u64;
            let problem = CountingProblem { good, total };
            let mut device = Device::new(problem, noise, &mut stream).unwrap();
            let found = estimator.estimate(&mut device).unwrap();
            let truth = good as f64 / total as f64;
            found.interval.0 <= truth && truth <= found.interval.1
        });
        within.count() as f64 / f64::from(runs)
    };
    assert!(covered(noise) > 0.92);
    assert!(covered(Noise::NONE) < 0.85);
}
