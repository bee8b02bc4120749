//! Binomial draws: the number of good indices among n independent ones.
//!
//! Classical Monte Carlo with n paths depends on this count alone, so one draw replaces n paths. If
//! fewer than ten successes are expected, the draw is by inversion. Otherwise it is by transformed
//! rejection (Hoermann, *The generation of binomial random variates*, 1993, algorithm BTRS). The
//! acceptance test compares exact probabilities in Loader's form (*Fast and accurate computation of
//! binomial probabilities*, 2000), which keeps its precision up to n = 2^63.

use std::f64::consts::TAU;

use crate::random::Stream;

/// Draws the number of good indices among `trials` indices, drawn with replacement from `total`.
///
/// `good` of the `total` indices are good. Requires `good <= total` and `total > 0`.
pub(crate) fn draw(trials: u64, good: u64, total: u64, stream: &mut Stream) -> u64 {
    let fraction = |part: u64| part as f64 / total as f64;
    draw_with(trials, fraction(good), fraction(total - good), stream)
}

/// Draws the number of successes among `trials` with probability `p` each.
///
/// `q = 1 - p` is a parameter because the draw uses the smaller of `p` and `q`, to full precision.
pub(crate) fn draw_with(trials: u64, p: f64, q: f64, stream: &mut Stream) -> u64 {
    if p > q {
        return trials - draw_with(trials, q, p, stream);
    }
    if p <= 0.0 || trials == 0 {
        return 0;
    }
    if trials as f64 * p < 10.0 {
        by_inversion(trials, p, stream)
    } else {
        by_rejection(trials, p, stream)
    }
}

fn by_inversion(trials: u64, p: f64, stream: &mut Stream) -> u64 {
    let n = trials as f64;
    let odds = p / (1.0 - p);
    let none = libm::exp(n * libm::log1p(-p));
    loop {
        let mut left = stream.uniform();
        let mut probability = none;
        // The mean is below 10, so more than 200 successes have a probability below 1e-150. Only
        // rounding of the sum can end the loop without a result; then the draw is repeated.
        for k in 0..=trials.min(200) {
            if left < probability {
                return k;
            }
            left -= probability;
            probability *= odds * (n - k as f64) / (k as f64 + 1.0);
        }
    }
}

fn by_rejection(trials: u64, p: f64, stream: &mut Stream) -> u64 {
    let n = trials as f64;
    let deviation = (n * p * (1.0 - p)).sqrt();
    let b = 1.15 + 2.53 * deviation;
    let a = -0.0873 + 0.0248 * b + 0.01 * p;
    let c = n * p + 0.5;
    let alpha = (2.83 + 5.1 / b) * deviation;
    let squeeze = 0.92 - 4.2 / b;
    let mode = ((n + 1.0) * p).floor();
    let peak = ln_probability(n, p, mode);
    loop {
        let u = stream.uniform() - 0.5;
        let v = stream.fine_uniform();
        let us = 0.5 - u.abs();
        let k = ((2.0 * a / us + b) * u + c).floor();
        if us >= 0.07 && v <= squeeze {
            return k as u64;
        }
        if !(0.0..=n).contains(&k) {
            continue;
        }
        if libm::log(v * alpha / (a / (us * us) + b)) <= ln_probability(n, p, k) - peak {
            return (k as u64).min(trials);
        }
    }
}

/// ln of the probability of `k` successes in `n` trials, for 0 < p < 1.
pub(crate) fn ln_probability(n: f64, p: f64, k: f64) -> f64 {
    if k == 0.0 {
        return n * libm::log1p(-p);
    }
    if k == n {
        return n * libm::log(p);
    }
    let rest = n - k;
    // k - np, computed once: n - k and n(1-p) differ by the same amount, with the opposite sign.
    let difference = k - n * p;
    stirling(n)
        - stirling(k)
        - stirling(rest)
        - deviance(k, difference)
        - deviance(rest, -difference)
        + 0.5 * libm::log(n / (TAU * k * rest))
}

/// x ln(x/m) + m - x with m = x - difference, stable where x and m are close.
pub(crate) fn deviance(x: f64, difference: f64) -> f64 {
    if x == 0.0 {
        return -difference;
    }
    let mean = x - difference;
    let ratio = difference / (x + mean);
    if ratio.abs() >= 0.1 {
        return x * libm::log(x / mean) - difference;
    }
    // ln(x/m) = 2 atanh(ratio).
    let mut sum = difference * ratio;
    let mut term = 2.0 * x * ratio;
    for j in 1..20 {
        term *= ratio * ratio;
        let next = sum + term / f64::from(2 * j + 1);
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}

/// ln(n!) - ln(sqrt(2 pi n) (n/e)^n) for an integer n > 0.
fn stirling(n: f64) -> f64 {
    if n < 16.0 {
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - 0.5 * libm::log(TAU);
    }
    let square = 1.0 / (n * n);
    (1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square / 1680.0))) / n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::chi_square_is_plausible;

    /// ln(n choose k) as a sum of logarithms.
    fn direct(n: u32, p: f64, k: u32) -> f64 {
        let choose: f64 = (1..=k)
            .map(|i| libm::log(f64::from(n - k + i) / f64::from(i)))
            .sum();
        choose + f64::from(k) * libm::log(p) + f64::from(n - k) * libm::log1p(-p)
    }

    #[test]
    fn probabilities_equal_the_product_formula() {
        for (n, p) in [
            (1_u32, 0.3),
            (7, 0.5),
            (40, 0.01),
            (1000, 0.27),
            (5000, 0.4999),
        ] {
            for k in (0..=n).step_by(1 + n as usize / 60) {
                let found = ln_probability(f64::from(n), p, f64::from(k));
                let expected = direct(n, p, k);
                assert!(
                    (found - expected).abs() < 1e-10 * (1.0 + expected.abs()),
                    "{n} {p} {k}"
                );
            }
        }
    }

    #[test]
    fn draws_follow_the_distribution() {
        for (n, good, total) in [
            (5_u64, 1_u64, 2_u64),
            (30, 1, 7),
            (30, 6, 7),
            (1000, 1, 300),
            (1000, 33, 100),
        ] {
            let p = good as f64 / total as f64;
            let mut stream = Stream::new(11, n as u32, good as u32, 0);
            let mut counts = vec![0_u64; n as usize + 1];
            for _ in 0..100_000 {
                counts[draw(n, good, total, &mut stream) as usize] += 1;
            }
            let expected: Vec<f64> = (0..=n)
                .map(|k| libm::exp(ln_probability(n as f64, p, k as f64)))
                .collect();
            chi_square_is_plausible(&counts, &expected);
        }
    }

    #[test]
    fn huge_counts_have_the_right_mean_and_variance() {
        let (n, good, total) = (1_u64 << 60, 3_u64, 10_u64);
        let mut stream = Stream::new(5, 0, 0, 0);
        let draws = 20_000;
        let deviation = (n as f64 * 0.21).sqrt();
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..draws {
            let k = draw(n, good, total, &mut stream);
            let exact = (u128::from(n) * 3 / 10) as i128;
            let z = (i128::from(k) - exact) as f64 / deviation;
            sum += z;
            square += z * z;
        }
        let m = f64::from(draws);
        assert!((sum / m).abs() < 5.0 / m.sqrt());
        assert!((square / m - 1.0).abs() < 5.0 * (2.0 / m).sqrt());
        for (good, expected) in [(0, 0), (10, n)] {
            assert_eq!(draw(n, good, 10, &mut stream), expected);
        }
    }
}
