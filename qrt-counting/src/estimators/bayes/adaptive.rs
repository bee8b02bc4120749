//! `adaptive-bayes`: chooses every query depth from the posterior.

use super::run::Depths;
use super::{Goal, ways};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `adaptive-bayes`: single shots, each at the query depth that is expected to sharpen the
/// posterior most per query.
///
/// It is the most accurate estimator that counts if amplitudes are spread evenly, or with a thousand
/// queries and more. In dark pixels with fewer queries, `sine` has less error, because a
/// run of `adaptive-bayes` occasionally ends at another mode.
///
/// The estimate is the posterior mean under a prior of about `1/(a (1 - a))`, a the amplitude. It
/// is 0 if no index was good, and 1 if all were. From 63 queries on, its bias over the pixels of
/// the Cornell box is below the standard error of a 64 x 64 picture's mean (a pixel's RMSE over 64)
/// (`cargo bench --bench estimators -- bias`). If an error is requested, the estimate is the mean
/// under the uniform prior, which lies nearer the middle of the interval.
///
/// Query depths and interval follow from a prior that is uniform in the amplitude. The likelihood
/// is that of the device with its known noise. The estimator chooses the query depth greedily from
/// the whole posterior, which may be multimodal, as in adaptive phase estimation (Wiebe & Granade,
/// *Efficient Bayesian phase estimation*, 2016) and Bayesian amplitude estimation (Ramôa & Santos,
/// *Bayesian quantum amplitude estimation*, 2024). It computes the expected variance instead of
/// sampling it. The posterior is a quadrature, not a cloud of particles, which could lose a mode.
///
/// Interval: the range of the amplitudes of highest posterior density that leave out 2/5 of the
/// failure probability at the requested confidence. On average over the prior its coverage is above
/// the requested confidence, for all outcomes and stopping times. At an amplitude of 1/2, where the
/// coverage is least, it is about the requested confidence.
///
/// Stops early if the requested error is reached or a single S is left (all others together have a
/// probability below 10^-12). Never uses more queries than allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveBayes {
    goal: Goal,
}

impl AdaptiveBayes {
    /// Creates the estimator from `settings`.
    ///
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        let goal = Goal::from_settings(settings)?;
        Ok(Self { goal })
    }
}

impl AmplitudeEstimator for AdaptiveBayes {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        ways::estimate(&self.goal, Depths::Adaptive, device)
    }
}
