//! The estimate of the amplitude from a posterior, nearly without bias.
//!
//! Let `x = asin(sqrt(a))`. The shots measure x to a deviation s that hardly depends on x. Under a
//! prior with density p in x, the bias of the posterior mean of a, on average over outcomes, is
//!
//! ```text
//! s^2 (a'' + a' p'/p),    a = sin^2 x,
//! ```
//!
//! to second order in s. The bias is zero for `p ~ 1/a' = 1/sin 2x`: in a, for the prior
//! `1/(a (1 - a))` (Haldane, *A note on inverse probability*, 1932). Shots without iterations, h of
//! n of them good, then give h/n. A prior that is even in a gives `2 s^2` too much at small a. That
//! is little compared with one pixel's error, but it stays in the mean over a picture.
//!
//! Haldane's prior has infinite mass at 0 and at 1. A run without a good index therefore gives 0,
//! and a run without a bad index gives 1.
//!
//! Below the resolution `1/I`, I the sum of `(2k + 1)^2` over all shots, the formula does not hold.
//! There a single good index gives about 1/I, which has no bias if I is the same for all outcomes.
//! But an adaptive run that measures a good index early chooses shallower shots afterwards: I is
//! smaller, and the mean estimate too large. [`EXTRA`] adds mass near the ends to compensate.

/// Unit and power of the factor `(1 + unit/(I a (1 - a)))^power` by which the density exceeds Haldane's.
///
/// Measured on the Cornell box at 63 queries, to 0.25 % of the mean: powers of 0.5, 0.6 and 0.7
/// leave a bias of 0.6 %, 0.1 % and -0.4 %; Haldane's prior leaves 2.7 %. The error of a pixel is
/// the same to 1 %.
const EXTRA: (f64, f64) = (3.0, 0.6);

/// Summary of all shots of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Evidence {
    /// Number of good indices that were measured.
    pub(super) good: u64,
    /// Number of other indices that were measured.
    pub(super) bad: u64,
    /// I, the expected number of good indices divided by a, for an a near 0. If noise leaves a
    /// fraction r of shots intact, it is the sum of `r (2k + 1)^2 + 1 - r` over all shots.
    pub(super) resolution: f64,
}

impl Evidence {
    /// Adds the numbers of good and bad shots after k iterations, with `multiple = 2k + 1`.
    ///
    /// `intact` is the fraction of shots that noise leaves intact.
    pub(super) fn note(&mut self, multiple: u64, [good, bad]: [u64; 2], intact: f64) {
        self.good = self.good.saturating_add(good);
        self.bad = self.bad.saturating_add(bad);
        let multiple = multiple as f64;
        let each = intact * multiple * multiple + 1.0 - intact;
        self.resolution += each * (good as f64 + bad as f64);
    }
}

/// Returns the estimate for a posterior under the even prior; `points` are `(mass, amplitude)`.
///
/// The result is `None` if all mass is at 0 and 1 although the evidence excludes both.
pub(super) fn amplitude(
    points: impl Iterator<Item = (f64, f64)>,
    evidence: Evidence,
) -> Option<f64> {
    if evidence.good == 0 {
        return Some(0.0);
    }
    if evidence.bad == 0 {
        return Some(1.0);
    }
    let (unit, power) = EXTRA;
    let (mut sum, mut first) = (0.0, 0.0);
    for (mass, a) in points {
        let product = a * (1.0 - a);
        if product > 0.0 {
            let near = 1.0 + unit / (evidence.resolution * product);
            let weight = mass / product * libm::pow(near, power);
            sum += weight;
            first += weight * a;
        }
    }
    let mean = first / sum;
    mean.is_finite().then(|| mean.clamp(0.0, 1.0))
}
