//! Tosses of the shifted circuit, and what they say of the mean.

use super::clopper_pearson::clopper_pearson;
use super::{Device, EstimatorError, MAX_ITERATIONS, Noise};
use std::f64::consts::FRAC_PI_2;

/// One choice of the circuit of [`Device::shifted`]: its reference E at an end of the interval in
/// which a is known to lie, so that the angle omega tells a without doubt, and m queries, so few
/// that `m omega` does not exceed a quarter of a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coin {
    pub(super) reference: f64,
    pub(super) queries: u64,
    /// a - E is `slope sin(omega)`: negative for an E above the interval.
    slope: f64,
}

/// What some tosses of a [`Coin`] showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tosses {
    pub(super) heads: u64,
    pub(super) shots: u64,
    /// Probabilities of heads are `right` times those without noise, and the rest times `any`.
    right: f64,
    any: f64,
}

impl Coin {
    /// The coin with the most queries, but no more than `most`, of which the tosses tell any two
    /// fractions in `interval` apart. The reference is the end nearer to 1/2, where the circuit's
    /// slope is larger; but if 0 or 1 is an end, that, so that it is told from all others for
    /// certain: there are no heads at the reference.
    pub(super) fn new((low, high): (f64, f64), most: u64) -> Self {
        let upper = low > 0.0 && (high >= 1.0 || high - 0.5 < 0.5 - low);
        let reference = if upper { high } else { low };
        let scale = f64::max(reference, 1.0 - reference);
        let widest = libm::asin(((high - low) / scale).min(1.0));
        // A float beyond 2^64 becomes the largest integer.
        let unambiguous = (FRAC_PI_2 / widest * (1.0 + 1e-12)) as u64;
        Self {
            reference,
            queries: unambiguous.min(most).max(1),
            slope: if upper { -scale } else { scale },
        }
    }

    /// The same coin with fewer queries.
    pub(super) fn with_queries(self, queries: u64) -> Self {
        Self { queries, ..self }
    }

    /// Tosses that leave an interval of some half-width `error`, but for a probability of
    /// `failure`, on a device with `noise` and `total` indices: Hoeffding's, twice.
    pub(super) fn tosses_for(&self, error: f64, failure: f64, noise: Noise, total: u64) -> u64 {
        let reach = noise.coin_intact(self.queries, total) * self.queries as f64 * error;
        // A float beyond 2^64, or infinity, becomes the largest integer.
        (libm::log(2.0 / failure) / (reach * reach)).ceil() as u64
    }

    pub(super) fn toss(
        &self,
        device: &mut Device<'_>,
        shots: u64,
        noise: Noise,
    ) -> Result<Tosses, EstimatorError> {
        let heads = device.shifted(self.reference, self.queries, shots)?;
        let zeros = 0.5 / device.total() as f64;
        Ok(Tosses {
            heads,
            shots,
            right: noise.coin_intact(self.queries, device.total()),
            any: if self.queries % 2 == 1 {
                zeros
            } else {
                1.0 - zeros
            },
        })
    }

    /// The fraction at the angle `m omega`.
    fn amplitude(&self, turned: f64) -> f64 {
        self.reference + self.slope * libm::sin(turned / self.queries as f64)
    }

    /// The fraction of good indices under which the measured fraction of heads is the likeliest.
    pub(super) fn estimate(&self, tosses: &Tosses) -> f64 {
        self.amplitude(tosses.angle(tosses.heads as f64 / tosses.shots as f64))
    }

    /// The fractions within `reach` of the estimate's angle.
    pub(super) fn around(&self, tosses: &Tosses, reach: f64) -> (f64, f64) {
        let middle = tosses.angle(tosses.heads as f64 / tosses.shots as f64);
        let near = self.amplitude((middle - reach).max(0.0));
        let far = self.amplitude((middle + reach).min(FRAC_PI_2));
        (near.min(far), near.max(far))
    }

    /// The fractions that the tosses do not exclude, but for a probability of `failure`.
    pub(super) fn interval(&self, tosses: &Tosses, failure: f64) -> (f64, f64) {
        let (low, high) = clopper_pearson(tosses.heads, tosses.shots, failure);
        let near = self.amplitude(tosses.angle(low));
        let far = self.amplitude(tosses.angle(high));
        (near.min(far), near.max(far))
    }
}

impl Tosses {
    /// The angle in [0, pi/2] at which heads are measured with the probability `heads`.
    fn angle(&self, heads: f64) -> f64 {
        let ideal = (heads - (1.0 - self.right) * self.any) / self.right;
        // Without anything left of the state, every angle is possible: 0/0 is not a number.
        let ideal = if ideal.is_nan() {
            0.5
        } else {
            ideal.clamp(0.0, 1.0)
        };
        libm::asin(ideal.sqrt())
    }
}

/// The most queries of a shot that are worth their noise: what a shot tells is the square of
/// `m (1 - p)^m`, which for a given number of queries in all is largest at m = 1/(2p). An odd
/// number: such coins are at an end of what is possible, where heads are rare, and of destroyed
/// states only those of an even number show heads.
pub(super) fn most_queries(noise: Noise) -> u64 {
    // A float beyond 2^64, or infinity, becomes the largest integer.
    let most = ((0.5 / noise.depolarising) as u64).clamp(2, MAX_ITERATIONS);
    (most - 1) | 1
}

/// The fractions that are in both intervals; `known`, if none is in both.
pub(super) fn intersection(known: (f64, f64), found: (f64, f64)) -> (f64, f64) {
    let (low, high) = (known.0.max(found.0), known.1.min(found.1));
    if low < high { (low, high) } else { known }
}
