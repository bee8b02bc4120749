//! Exact intervals of a probability.

use super::monte_carlo::chernoff_interval;

/// Beyond this many shots Chernoff's bound serves, which is wider by a fifth or so.
const MANY: u64 = 1 << 16;

/// All p under which `hits` of `shots` or fewer, and or more, have a probability of at least
/// `failure`/2 (Clopper & Pearson, *The use of confidence or fiducial limits*, 1934). Holds the true
/// p with probability `1 - failure` or more, whatever p is.
pub(super) fn clopper_pearson(hits: u64, shots: u64, failure: f64) -> (f64, f64) {
    if shots > MANY {
        return chernoff_interval(hits, shots, failure);
    }
    let low = if hits == 0 {
        0.0
    } else {
        // P(X >= hits) = I_p(hits, shots - hits + 1).
        inverse(hits as f64, (shots - hits + 1) as f64, 0.5 * failure)
    };
    let high = if hits == shots {
        1.0
    } else {
        1.0 - inverse((shots - hits) as f64, (hits + 1) as f64, 0.5 * failure)
    };
    (low, high)
}

/// The x with `I_x(a, b) = value`, from below.
///
/// ln I is concave in ln x, for the beta distribution's logarithm is log-concave: a tangent meets
/// `ln value` to the left of the curve, and Newton's steps approach from there.
fn inverse(a: f64, b: f64, value: f64) -> f64 {
    let target = libm::log(value);
    // ln (a B(a, b)).
    let scale = libm::lgamma(a + 1.0) + libm::lgamma(b) - libm::lgamma(a + b);
    let mut x = a / (a + b);
    for _ in 0..50 {
        let ln_front = a * libm::log(x) + b * libm::log1p(-x) - scale;
        let ln_beta = ln_incomplete_beta(a, b, x, ln_front);
        // d ln I / d ln x = front a / ((1 - x) I).
        let step = (target - ln_beta) * libm::exp(ln_beta - ln_front) * (1.0 - x) / a;
        x *= libm::exp(step);
        if step.abs() < 1e-12 {
            break;
        }
    }
    x
}

/// ln of `I_x(a, b)`, the regularised incomplete beta function, for 0 < x < 1, where `ln_front` is
/// ln of `x^a (1-x)^b / (a B(a, b))`.
fn ln_incomplete_beta(a: f64, b: f64, x: f64, ln_front: f64) -> f64 {
    if x > (a + 1.0) / (a + b + 2.0) {
        // The same front, but for b in the place of a.
        let rest = a / b * libm::exp(ln_front) * continued_fraction(b, a, 1.0 - x);
        return libm::log1p(-rest);
    }
    ln_front + libm::log(continued_fraction(a, b, x))
}

/// Lentz's evaluation of the incomplete beta function's continued fraction (Press et al.,
/// *Numerical recipes*, section 6.4).
fn continued_fraction(a: f64, b: f64, x: f64) -> f64 {
    let away = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let (mut c, mut d) = (1.0, 1.0 / away(1.0 - (a + b) * x / (a + 1.0)));
    let mut fraction = d;
    for m in 1..10_000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / away(1.0 + term * d);
            c = away(1.0 + term / c);
            factor = c * d;
            fraction *= factor;
        }
        if (factor - 1.0).abs() < 1e-15 {
            break;
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::counting::binomial;

    /// At the ends of the interval the tails are what may fail, summed term by term.
    #[test]
    fn tails_at_the_ends_are_half_of_what_may_fail() {
        let tail = |n: u64, p: f64, range: std::ops::RangeInclusive<u64>| -> f64 {
            range
                .map(|k| libm::exp(binomial::ln_probability(n as f64, p, k as f64)))
                .sum()
        };
        for n in [1, 2, 7, 16, 40, 300, 5000] {
            for hits in [0, 1, n / 3, n / 2, n - 1, n] {
                for failure in [0.3, 0.05, 1e-3, 1e-6, 1e-9] {
                    let (low, high) = clopper_pearson(hits, n, failure);
                    assert!(
                        low <= hits as f64 / n as f64 && hits as f64 / n as f64 <= high,
                        "{hits}/{n} {failure}: {low} {high}"
                    );
                    if hits > 0 {
                        let found = tail(n, low, hits..=n);
                        assert!((found / failure - 0.5).abs() < 1e-6, "{hits}/{n}: {found}");
                    }
                    if hits < n {
                        let found = tail(n, high, 0..=hits);
                        // 1 - high has lost the bits that 1 is too large for.
                        let lost = (n - hits) as f64 * f64::EPSILON / (1.0 - high);
                        let off = (found / failure - 0.5).abs();
                        assert!(off < 1e-6 + lost, "{hits}/{n}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn many_shots_give_narrow_intervals_and_end() {
        for shots in [MANY, MANY + 1, 1 << 60] {
            for hits in [0, 1, shots / 2, shots] {
                let (low, high) = clopper_pearson(hits, shots, 0.05);
                let deviation = 0.5 / (shots as f64).sqrt();
                assert!(low >= 0.0 && high <= 1.0 && high - low < 6.0 * deviation);
            }
        }
    }
}
