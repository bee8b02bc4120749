//! Exact intervals of a binomial share.
//!
//! Clopper & Pearson, *The use of confidence or fiducial limits illustrated in the case of the
//! binomial* (1934): the shares under which what was seen, or more of it, has probability at least
//! half of what may fail, on either side. They hold for every number of shots.

use crate::counting::binomial::ln_probability;
use super::normal::normal_quantile;

/// The interval of the share of hits, that fails with probability at most `failure`.
pub(super) fn clopper_pearson(hits: u64, shots: u64, failure: f64) -> (f64, f64) {
    let low = lower_limit(hits, shots, 0.5 * failure);
    let high = 1.0 - lower_limit(shots - hits, shots, 0.5 * failure);
    (low, high)
}

/// The share under which `hits` or more among `shots` have probability `failure` < 1/2.
fn lower_limit(hits: u64, shots: u64, failure: f64) -> f64 {
    if hits == 0 {
        return 0.0;
    }
    let (h, n) = (hits as f64, shots as f64);
    let target = libm::log(failure);
    if hits == shots {
        return libm::exp(target / n);
    }
    // Newton's iteration in the logit, in which the logarithm of the tail is concave and nearly
    // linear; from Wilson's limit.
    let z = normal_quantile(failure);
    let centre = (h + 0.5 * z * z) / (n + z * z);
    let reach = z / (n + z * z) * (h * (n - h) / n + 0.25 * z * z).sqrt();
    let start = (centre - reach).clamp(0.01 * h / n, h / n);
    let mut p = start;
    let mut logit = libm::log(p / (1.0 - p));
    let mut ln_mass = ln_probability(n, p, h);
    for _ in 0..50 {
        // P(X >= h) = P(X = h) (1 - p) F, and d ln P(X >= h) / d logit = h / F.
        let fraction = continued_fraction(h, n, p);
        let ln_tail = ln_mass + libm::log((1.0 - p) * fraction);
        let step = ((target - ln_tail) * fraction / h).clamp(-3.0, 3.0);
        logit += step;
        let next = 1.0 / (1.0 + libm::exp(-logit));
        ln_mass += h * step + n * libm::log1p((p - next) / (1.0 - p));
        p = next;
        // The error that is left is of the order of its square.
        if step.abs() < 1e-7 {
            break;
        }
    }
    p
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
