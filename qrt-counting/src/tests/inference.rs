//! Tests of inference: the true maximum, and the bounds of the literature.

use std::f64::consts::PI;

use proptest::prelude::*;
use qrt_circuit::quantum::Window;

use crate::random::Stream;
use crate::{CountingError, PhaseDistribution, ln_likelihood, maximum_likelihood, posterior};

fn outcomes(
    good: u64,
    total: u64,
    bits: u32,
    window: Window,
    shots: u32,
    stream: &mut Stream,
) -> Vec<u64> {
    let sampler = PhaseDistribution::new(good, total, bits, window)
        .unwrap()
        .sampler();
    (0..shots).map(|_| sampler.sample(stream)).collect()
}

fn window() -> impl Strategy<Value = Window> {
    prop_oneof![Just(Window::Rect), Just(Window::Sine)]
}

/// The likeliest S and its ln likelihood, by trying every S.
fn brute(outcomes: &[u64], total: u64, bits: u32, window: Window) -> (u64, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    for good in 0..=total {
        let value = ln_likelihood(outcomes, good, total, bits, window).unwrap();
        if value > best.1 {
            best = (good, value);
        }
    }
    best
}

fn same_maximum(outcomes: &[u64], total: u64, bits: u32, window: Window) {
    let (good, value) = brute(outcomes, total, bits, window);
    let Ok(found) = maximum_likelihood(outcomes, total, bits, window) else {
        assert_eq!(value, f64::NEG_INFINITY);
        return;
    };
    // If rounding makes two values of S equal, either is accepted.
    assert!(
        found.good == good || (found.ln_likelihood - value).abs() <= 1e-12 * (1.0 + value.abs()),
        "{found:?}, not S = {good} with {value}: {outcomes:?} N={total} t={bits} {window:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn the_likeliest_count_is_found_without_trying_them_all(
        total in 1..=4096_u64, fraction in 0.0..=1.0_f64, bits in 1..=14_u32, shots in 1..24_u32,
        window in window(), seed in any::<u64>(),
    ) {
        let good = (fraction * total as f64).round() as u64;
        let mut stream = Stream::new(seed, 0, 0, 0);
        let outcomes = outcomes(good, total, bits, window, shots, &mut stream);
        same_maximum(&outcomes, total, bits, window);
    }

    /// Outcomes that no single theta would give, with several peaks, gaps and ties.
    #[test]
    fn the_likeliest_count_is_found_for_arbitrary_outcomes(
        total in 1..=600_u64, bits in 1..=9_u32,
        outcomes in proptest::collection::vec(0.0..=1.0_f64, 1..8),
    ) {
        let half = (1_u64 << bits) / 2;
        let outcomes: Vec<u64> =
            outcomes.into_iter().map(|y| (y * half as f64).round() as u64).collect();
        same_maximum(&outcomes, total, bits, Window::Rect);
        same_maximum(&outcomes, total, bits, Window::Sine);
    }

    #[test]
    fn no_neighbour_of_the_likeliest_count_is_likelier_at_any_size(
        total in 1..=(1_u64 << 60), power in 0..60_u32, fraction in 0.0..=1.0_f64,
        bits in 1..=40_u32, shots in 1..9_u32, window in window(), seed in any::<u64>(),
    ) {
        let total = (total >> power).max(1);
        let good = ((fraction * total as f64) as u64).min(total);
        let mut stream = Stream::new(seed, 1, 0, 0);
        let outcomes = outcomes(good, total, bits, window, shots, &mut stream);
        let found = maximum_likelihood(&outcomes, total, bits, window).unwrap();
        let value = |good| ln_likelihood(&outcomes, good, total, bits, window).unwrap();
        let slack = 1e-9 * (1.0 + found.ln_likelihood.abs());
        // The true S is a candidate, too.
        prop_assert!(value(good) <= found.ln_likelihood + slack);
        let step = (total >> bits).max(1);
        for distance in [1, 2, 3, step, 3 * step, 10 * step] {
            for other in [found.good.saturating_sub(distance), found.good.saturating_add(distance)] {
                prop_assert!(value(other.min(total)) <= found.ln_likelihood + slack);
            }
        }
    }
}

/// A walk down from the last outcome, past cells without an integer.
#[test]
fn the_walk_from_the_last_outcome_goes_down() {
    same_maximum(&[0, 32, 15, 32], 478, 6, Window::Rect);
}

/// Two peaks of the sine window's likelihood within one step of the register.
#[test]
fn neighbouring_peaks_of_one_cell_are_told_apart() {
    same_maximum(&[4, 2, 2, 2, 0, 0], 591, 3, Window::Sine);
}

/// Compares with Bayes' rule for a uniform prior: ratios of products of probabilities.
#[test]
fn posteriors_are_normalised_products_of_probabilities() {
    let outcomes = [3, 3, 2, 5];
    for window in [Window::Rect, Window::Sine] {
        let found = posterior(&outcomes, 40, 5, window).unwrap();
        let product = |good| -> f64 {
            let distribution = PhaseDistribution::new(good, 40, 5, window).unwrap();
            outcomes
                .iter()
                .map(|&y| distribution.probability(y))
                .product()
        };
        let evidence: f64 = (0..=40).map(product).sum();
        assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (good, p) in (0..=40).zip(&found) {
            assert!((p - product(good) / evidence).abs() < 1e-12);
        }
    }
    let error = posterior(&[1], 1 << 40, 5, Window::Rect).unwrap_err();
    assert!(error.to_string().contains("at most 16777216"));
}

/// Checks the bound |S~ - S| <= 2 pi sqrt(S (N-S))/T + pi^2 N/T^2, with probability at least
/// 8/pi^2.
///
/// The probability is exact, from the distribution, for S~ = N sin^2(pi y/T). The paper's bound has
/// no N in its second term. If S is small or nearly N, the paper's bound holds with probability
/// 0.55 or less.
#[test]
fn the_bound_on_the_count_holds_with_its_n_and_fails_without() {
    let least = 8.0 / (PI * PI);
    let mut stream = Stream::new(8, 0, 0, 0);
    let (mut fails_without, mut least_without) = (0, 1.0_f64);
    for case in 0..100_000 {
        let total = 1 + stream.next_u64() % (2 << (stream.next_u64() % 40));
        // Any S, or one of the first or last eight, which have amplitudes near 0 or 1.
        let good = match case % 4 {
            0 | 1 => stream.next_u64() % (total + 1),
            2 => (stream.next_u64() % 8).min(total),
            _ => total - (stream.next_u64() % 8).min(total),
        };
        let bits = 1 + (stream.next_u64() % 20) as u32;
        let size = f64::from(1_u32 << bits);
        let (a, b) = (
            good as f64 / total as f64,
            (total - good) as f64 / total as f64,
        );
        let first = 2.0 * PI * (a * b).sqrt() / size;
        for window in [Window::Rect, Window::Sine] {
            let found = PhaseDistribution::new(good, total, bits, window).unwrap();
            let within = |bound: f64| -> f64 {
                // The outcomes between the bound's ends, and one more on either side to try.
                let angle = |share: f64| size / PI * share.clamp(0.0, 1.0).sqrt().asin();
                let low = (angle(a - bound) as u64).saturating_sub(1);
                let high = (angle(a + bound) as u64 + 2).min(found.largest_outcome());
                (low..=high)
                    .filter(|&y| {
                        let (sine, cosine) = (PI * y as f64 / size).sin_cos();
                        let off = if a < b {
                            sine * sine - a
                        } else {
                            cosine * cosine - b
                        };
                        off.abs() <= bound * (1.0 + 1e-9)
                    })
                    .map(|y| found.probability(y))
                    .sum()
            };
            let with = within(first + PI * PI / (size * size));
            assert!(
                with >= least - 1e-9,
                "{good} of {total}, {bits} bits, {window:?}: {with}"
            );
            let without = within(first + PI * PI / (size * size) / total as f64);
            fails_without += u32::from(without < least - 1e-9);
            least_without = least_without.min(without);
        }
    }
    assert!(
        fails_without > 5000 && least_without < 0.6,
        "{fails_without} {least_without}"
    );
}

/// Checks phases on a grid finer than any feature of the kernel.
#[test]
fn one_outcome_is_within_a_step_with_the_stated_probability() {
    for bits in [1, 2, 3, 4, 7, 12] {
        for window in [Window::Rect, Window::Sine] {
            for i in 0..=2000 {
                let theta = f64::from(i) / 4000.0;
                let sine = libm::sin(PI * theta);
                let found = PhaseDistribution::from_amplitude(sine * sine, bits, window).unwrap();
                let steps = found.theta() * f64::from(1_u32 << bits);
                let sum: f64 = (0..=found.largest_outcome())
                    .filter(|&y| (y as f64 - steps).abs() <= 1.0 + 1e-9)
                    .map(|y| found.probability(y))
                    .sum();
                assert!(
                    sum >= 8.0 / (PI * PI) - 1e-9,
                    "{bits} {window:?} {theta}: {sum}"
                );
            }
        }
    }
}

/// Compares with root mean square errors measured elsewhere, for a uniform in [0, 1].
///
/// They are 0.50/sqrt(T) for single-shot counting, 1.28/T for the sine window, and 0.41/sqrt(n) for
/// Monte Carlo. The mean over outcomes is exact here: draws from a tail this heavy converge too
/// slowly.
#[test]
fn single_shot_errors_scale_as_the_literature_says() {
    let total = 1_u64 << 40;
    let truths = 500;
    for bits in [6, 8] {
        let size = f64::from(1_u32 << bits);
        for (window, scaled, expected, slack) in [
            (Window::Rect, size.sqrt(), 0.50, 0.02),
            (Window::Sine, size, 1.28, 0.04),
        ] {
            let estimates: Vec<f64> = (0..=1_u64 << (bits - 1))
                .map(|y| maximum_likelihood(&[y], total, bits, window).unwrap().good as f64)
                .collect();
            let mut sum = 0.0;
            for i in 0..truths {
                let amplitude = (f64::from(i) + 0.5) / f64::from(truths);
                let found = PhaseDistribution::from_amplitude(amplitude, bits, window).unwrap();
                for (y, good) in estimates.iter().enumerate() {
                    let error = good / total as f64 - amplitude;
                    sum += found.probability(y as u64) * error * error;
                }
            }
            let rmse = (sum / f64::from(truths)).sqrt() * scaled;
            assert!((rmse - expected).abs() < slack, "{bits} {window:?}: {rmse}");
        }
    }
}

#[test]
fn what_cannot_be_inferred_is_refused() {
    let ml = |outcomes: &[u64], total| maximum_likelihood(outcomes, total, 3, Window::Rect);
    assert_eq!(ml(&[], 5), Err(CountingError::NoOutcomes));
    assert_eq!(
        ml(&[5], 5),
        Err(CountingError::OutcomeOutOfRange {
            outcome: 5,
            largest: 4
        })
    );
    assert_eq!(ml(&[3], 1), Err(CountingError::ImpossibleOutcomes));
    assert_eq!(ml(&[0, 4], 1), Err(CountingError::ImpossibleOutcomes));
}
