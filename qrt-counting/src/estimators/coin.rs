//! Tosses of the shifted circuit, and the inference of the mean from them.

use super::clopper_pearson::clopper_pearson;
use super::{Device, EstimatorError, MAX_ITERATIONS, Noise};
use std::f64::consts::FRAC_PI_2;

/// Parameters of the circuit of [`Device::shifted`]: the reference E and the number of queries m.
///
/// E is an end of the interval that is known to contain a, so the angle omega determines a
/// uniquely. m is small enough that `m omega` does not exceed a quarter of a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coin {
    pub(super) reference: f64,
    pub(super) queries: u64,
    /// a - E is `slope sin(omega)`; the slope is negative if E is the interval's upper end.
    slope: f64,
}

/// The outcome of several tosses of a [`Coin`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tosses {
    pub(super) heads: u64,
    pub(super) shots: u64,
    /// The probability of heads is `right` times that without noise, plus `1 - right` times `any`.
    right: f64,
    any: f64,
}

impl Coin {
    /// Creates the coin with the most queries, up to `most`, for an interval `(low, high)` of
    /// fractions.
    ///
    /// The number of queries is limited so that tosses distinguish any two fractions in the
    /// interval. The reference is the end nearer to 1/2, where the circuit's slope is larger. If 0
    /// or 1 is an end, that end is the reference instead. There are no heads at the reference, so
    /// tosses distinguish it from all other fractions with certainty.
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

    /// Number of tosses that give an interval of half-width about `error`, except with probability
    /// `failure`.
    ///
    /// It is twice the number of Hoeffding's inequality, on a device with `noise` and `total`
    /// indices.
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

    /// The fraction whose angle `m omega` is `turned`.
    fn amplitude(&self, turned: f64) -> f64 {
        self.reference + self.slope * libm::sin(turned / self.queries as f64)
    }

    /// The fraction of good indices under which the measured fraction of heads is likeliest.
    pub(super) fn estimate(&self, tosses: &Tosses) -> f64 {
        self.amplitude(tosses.angle(tosses.heads as f64 / tosses.shots as f64))
    }

    /// The range of fractions whose angles are within `reach` of the estimate's angle.
    pub(super) fn around(&self, tosses: &Tosses, reach: f64) -> (f64, f64) {
        let middle = tosses.angle(tosses.heads as f64 / tosses.shots as f64);
        let near = self.amplitude((middle - reach).max(0.0));
        let far = self.amplitude((middle + reach).min(FRAC_PI_2));
        (near.min(far), near.max(far))
    }

    /// The range of fractions that the tosses do not exclude, at failure probability `failure`.
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
        // If noise leaves nothing of the state, the quotient is 0/0, NaN, and every angle is
        // possible.
        let ideal = if ideal.is_nan() {
            0.5
        } else {
            ideal.clamp(0.0, 1.0)
        };
        libm::asin(ideal.sqrt())
    }
}

/// The largest number of queries per shot that is worth its noise.
///
/// The information of a shot is the square of `m (1 - p)^m`. For a given total of queries it is
/// largest at m = 1/(2p). The result is odd: the reference of a coin is an end of the known
/// interval, where heads are rare, and destroyed states show heads often only after an even number
/// of queries.
pub(super) fn most_queries(noise: Noise) -> u64 {
    // A float beyond 2^64, or infinity, becomes the largest integer.
    let most = ((0.5 / noise.depolarising) as u64).clamp(2, MAX_ITERATIONS);
    (most - 1) | 1
}

/// The intersection of both intervals; `known` if they do not overlap.
pub(super) fn intersection(known: (f64, f64), found: (f64, f64)) -> (f64, f64) {
    let (low, high) = (known.0.max(found.0), known.1.min(found.1));
    if low < high { (low, high) } else { known }
}
