//! Compares the posterior's mean with sums over every S, and with closed forms.

use crate::random::Stream;
use crate::{PhaseDistribution, posterior, posterior_mean};
use qrt_circuit::quantum::Window;

/// Compares the mean and the mass of the interval with sums over every S.
#[test]
fn means_and_intervals_equal_sums_over_every_count() {
    for case in 0..30_u32 {
        let mut stream = Stream::new(5, case, 0, 0);
        // Tests both methods: sums over every S, and sums over cells.
        let total = if case % 6 == 0 {
            600
        } else {
            4097 + stream.next_u64() % 8_000
        };
        let good = (stream.uniform() * total as f64) as u64;
        let good = match case % 5 {
            0 => good / 1000,
            1 => total - good / 10_000,
            _ => good,
        };
        let bits = 1 + (stream.next_u64() % 14) as u32;
        let shots = 1 + stream.next_u64() % 6;
        let window = if case % 2 == 0 {
            Window::Rect
        } else {
            Window::Sine
        };
        let drawn = PhaseDistribution::new(good, total, bits, window).unwrap();
        let outcomes: Vec<u64> = (0..shots).map(|_| drawn.sample(&mut stream)).collect();
        let masses = posterior(&outcomes, total, bits, window).unwrap();
        let amplitude = |i: usize| i as f64 / total as f64;
        let mean: f64 = masses
            .iter()
            .enumerate()
            .map(|(i, p)| p * amplitude(i))
            .sum();
        let variance: f64 = (masses.iter().enumerate())
            .map(|(i, p)| p * (amplitude(i) - mean).powi(2))
            .sum();
        let found = posterior_mean(&outcomes, total, bits, window, 0.95).unwrap();
        let case = format!("N={total} t={bits} {window:?} {outcomes:?}: {found:?}, {mean}");
        assert!(
            (found.mean - mean).abs() < 1e-4 * variance.sqrt() + 1e-15,
            "{case}"
        );
        let (low, high) = found.interval;
        let held: f64 = (masses.iter().enumerate())
            .filter(|&(i, _)| low <= amplitude(i) && amplitude(i) <= high)
            .map(|(_, p)| p)
            .sum();
        assert!(held >= 0.949, "{case}: {held}");
        assert!(low <= found.mean && found.mean <= high, "{case}");
    }
}

/// Checks a register with T = 2, which reads 0 with probability 1 - a: posteriors are beta
/// distributions.
#[test]
fn means_are_those_of_beta_distributions() {
    for (outcomes, mean) in [
        (vec![0], 1.0 / 3.0),
        (vec![0; 3], 0.2),
        (vec![1], 2.0 / 3.0),
        (vec![0, 1], 0.5),
    ] {
        let found = posterior_mean(&outcomes, 1 << 50, 1, Window::Rect, 0.9).unwrap();
        assert!((found.mean - mean).abs() < 1e-12, "{outcomes:?}: {found:?}");
    }
    // The likeliest 90 % of the density 2 (1 - a) reach to 1 - 0.1^(1/2). The interval goes on to
    // the end of a panel.
    let found = posterior_mean(&[0], 1 << 50, 1, Window::Rect, 0.9).unwrap();
    assert_eq!(found.interval.0, 0.0);
    let end = 1.0 - 0.1_f64.sqrt();
    assert!((end..end + 0.25).contains(&found.interval.1), "{found:?}");
}

/// Checks registers of up to 40 bits, up to 100,000 repetitions, and 2^60 indices.
#[test]
fn extremes_have_means_near_the_truth() {
    let total = 1_u64 << 60;
    for (good, bits, shots) in [
        (total / 7 * 2, 40, 1),
        (total / 7 * 2, 40, 3),
        (total / 7 * 2, 6, 100_000),
        (total / 3, 40, 2_000),
        (0, 40, 1),
        (1, 40, 3),
        (total, 20, 2),
        (total - 1, 12, 1),
    ] {
        for window in [Window::Rect, Window::Sine] {
            let mut stream = Stream::new(2, 0, 0, 0);
            let sampler = PhaseDistribution::new(good, total, bits, window)
                .unwrap()
                .sampler();
            let outcomes: Vec<u64> = (0..shots).map(|_| sampler.sample(&mut stream)).collect();
            let found = posterior_mean(&outcomes, total, bits, window, 0.999).unwrap();
            let truth = good as f64 / total as f64;
            let (low, high) = found.interval;
            let case = format!("{good} {bits} {shots} {window:?}: {found:?}");
            assert!(
                0.0 <= low && low <= found.mean && found.mean <= high && high <= 1.0,
                "{case}"
            );
            assert!(low <= truth && truth <= high, "{case}");
            let size = (1_u64 << bits) as f64;
            assert!(
                shots == 1 || (found.mean - truth).abs() < 10.0 / size,
                "{case}"
            );
        }
    }
}
