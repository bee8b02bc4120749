//! Exact intervals of a binomial fraction.
//!
//! Clopper & Pearson, *The use of confidence or fiducial limits illustrated in the case of the
//! binomial* (1934): the interval contains the fractions under which the observed count, or a more
//! extreme one, has a probability of at least half of the failure probability, on either side.
//! These intervals are exact for every number of shots.

use super::normal::normal_quantile;
use crate::binomial::ln_probability;

/// The interval of the fraction of hits, which fails with probability at most `failure`.
///
/// For up to 2^50 shots, its ends are precise to a hundredth of its width, and mostly far better.
pub(super) fn clopper_pearson(hits: u64, shots: u64, failure: f64) -> (f64, f64) {
    let (low, _) = lower_limit(hits, shots, 0.5 * failure);
    let (_, high) = lower_limit(shots - hits, shots, 0.5 * failure);
    (low, high)
}

/// The fraction p under which `hits` or more among `shots` have probability `failure` < 1/2, and
/// 1 - p.
fn lower_limit(hits: u64, shots: u64, failure: f64) -> (f64, f64) {
    if hits == 0 {
        return (0.0, 1.0);
    }
    let (h, n) = (hits as f64, shots as f64);
    let target = libm::log(failure);
    if hits == shots {
        return (libm::exp(target / n), -libm::expm1(target / n));
    }
    // Newton's iteration, from Wilson's limit. It works in the logit, in which the logarithm of the
    // tail is concave and nearly linear.
    let z = normal_quantile(failure);
    let centre = (h + 0.5 * z * z) / (n + z * z);
    let reach = z / (n + z * z) * (h * (n - h) / n + 0.25 * z * z).sqrt();
    let start = (centre - reach).clamp(0.01 * h / n, h / n);
    let mut logit = libm::log(start / (1.0 - start));
    let (mut p, mut q) = logistic(logit);
    let mut ln_mass = if p > q {
        ln_probability(n, q, n - h)
    } else {
        ln_probability(n, p, h)
    };
    for _ in 0..50 {
        // P(X >= h) = P(X = h) q F, and d ln P(X >= h) / d logit = h / F.
        let fraction = continued_fraction(h, n, p);
        let ln_tail = ln_mass + libm::log(q * fraction);
        let step = ((target - ln_tail) * fraction / h).clamp(-3.0, 3.0);
        logit += step;
        let next = logistic(logit);
        ln_mass += h * ln_ratio(next, (p, q)) + (n - h) * ln_ratio((next.1, next.0), (q, p));
        (p, q) = next;
        // The remaining error is of the order of the step's square.
        if step.abs() < 1e-7 {
            break;
        }
    }
    (p, q)
}

/// p and 1 - p of a logit.
fn logistic(logit: f64) -> (f64, f64) {
    (
        1.0 / (1.0 + libm::exp(-logit)),
        1.0 / (1.0 + libm::exp(logit)),
    )
}

/// ln(p'/p) for two pairs (p, 1 - p), computed from the smaller member of the pair.
fn ln_ratio(next: (f64, f64), now: (f64, f64)) -> f64 {
    if now.0 < now.1 {
        libm::log(next.0 / now.0)
    } else {
        libm::log1p((now.1 - next.1) / now.0)
    }
}

/// The continued fraction of the incomplete beta function `I_p(h, n - h + 1)`, by Lentz's method;
/// it converges fast for p below h/n. (Abramowitz & Stegun, 26.5.8.)
fn continued_fraction(h: f64, n: f64, p: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let nonzero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let b = n - h + 1.0;
    let mut c = 1.0;
    let mut d = 1.0 / nonzero(1.0 - (n + 1.0) * p / (h + 1.0));
    let mut fraction = d;
    for i in 1..10_000 {
        let m = f64::from(i);
        let even = m * (b - m) * p / ((h + 2.0 * m - 1.0) * (h + 2.0 * m));
        let odd = -(h + m) * (n + 1.0 + m) * p / ((h + 2.0 * m) * (h + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / nonzero(1.0 + term * d);
            c = nonzero(1.0 + term / c);
            factor = c * d;
            fraction *= factor;
        }
        if (factor - 1.0).abs() < 1e-13 {
            break;
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P(X >= h), term by term.
    fn tail(hits: u64, shots: u64, p: f64) -> f64 {
        (hits..=shots)
            .map(|k| libm::exp(ln_probability(shots as f64, p, k as f64)))
            .sum()
    }

    #[test]
    fn limits_are_where_the_tails_have_what_may_fail() {
        for shots in [1, 2, 5, 12, 100, 1000] {
            for hits in (0..=shots).step_by(1 + shots as usize / 20) {
                for failure in [0.3, 0.05, 1e-3, 1e-6] {
                    let (low, high) = clopper_pearson(hits, shots, failure);
                    assert!(low < high && (0.0..=1.0).contains(&low) && high <= 1.0);
                    if hits > 0 {
                        let found = tail(hits, shots, low) / (0.5 * failure);
                        assert!(
                            (found - 1.0).abs() < 1e-8,
                            "{hits}/{shots} {failure}: {found}"
                        );
                    } else {
                        assert_eq!(low, 0.0);
                    }
                    if hits < shots {
                        // Rounding of 1 - high, which is raised to powers of up to `shots`.
                        let rounding = 1e-15 * shots as f64 / (1.0 - high);
                        let found = tail(shots - hits, shots, 1.0 - high) / (0.5 * failure);
                        assert!(
                            (found - 1.0).abs() < 1e-8 + rounding,
                            "{hits}/{shots}: {found}"
                        );
                    } else {
                        assert_eq!(high, 1.0);
                    }
                }
            }
        }
    }

    /// Compares with tables of quantiles of beta distributions.
    #[test]
    fn limits_are_those_of_tables() {
        for (hits, shots, failure, low, high) in [
            (10, 20, 0.05, 0.271_957_8, 0.728_042_2),
            (1, 10, 0.05, 0.002_528_6, 0.445_016_1),
            (0, 10, 0.05, 0.0, 0.308_497_1),
            (5, 100, 0.05, 0.016_431_9, 0.112_834_9),
        ] {
            let found = clopper_pearson(hits, shots, failure);
            assert!(
                (found.0 - low).abs() < 1e-6 && (found.1 - high).abs() < 1e-6,
                "{found:?}"
            );
        }
    }

    /// Checks hits numerous enough for normal limits, and seven hits in 2^40 shots.
    #[test]
    fn limits_hold_for_any_number_of_shots() {
        for (hits, shots) in [(1 << 49, 1_u64 << 50), (3_000_000, 1 << 40), (7, 1 << 40)] {
            let (low, high) = clopper_pearson(hits, shots, 0.05);
            let (h, n) = (hits as f64, shots as f64);
            let deviation = (h * (1.0 - h / n)).sqrt() / n;
            let z = [h / n - low, high - h / n].map(|distance| distance / deviation);
            if hits > 1000 {
                assert!(z.iter().all(|z| (z - 1.96).abs() < 2e-3), "{z:?}");
            } else {
                // The limits of a Poisson count of 7.
                assert!((low * n - 2.814_358).abs() < 1e-4, "{}", low * n);
                assert!((high * n - 14.422_675).abs() < 1e-4, "{}", high * n);
            }
        }
    }
}
