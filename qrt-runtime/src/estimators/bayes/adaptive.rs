//! `adaptive-bayes`: every query depth is chosen from what is known.

use super::run::Depths;
use super::{Goal, strata};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `adaptive-bayes`: single shots, each at the query depth that is expected to sharpen the
/// posterior most per query. The default, and the most accurate here where amplitudes are spread evenly or
/// queries are a thousand and more. In dark pixels with fewer, `sine` has less error: now and then a run of
/// this one ends at another mode.
///
/// The estimate is the posterior mean under a prior of about `1/(a (1 - a))`, a the amplitude. It is 0 if
/// no index was good, and 1 if all were. Over the pixels of the Cornell box its bias is below the standard
/// error of a 64 x 64 picture's mean (a pixel's RMSE over 64) from 63 queries on
/// (`cargo bench --bench estimators -- bias`). Where an error is asked for, the estimate is the mean under
/// the uniform prior, which lies nearer the interval's middle.
///
/// Query depths and interval follow from a prior that is uniform in the amplitude. The likelihood is that
/// of the device, with the noise that is known. Query depth is chosen greedily from the whole posterior, multimodal as it is, as in
/// adaptive phase estimation (Wiebe & Granade, *Efficient Bayesian phase estimation*, 2016) and
/// Bayesian amplitude estimation (Ramôa & Santos, *Bayesian quantum amplitude estimation*, 2024),
/// with the expected variance computed, not sampled; the posterior is a quadrature, not a cloud of
/// particles, which could lose a mode.
///
/// Interval: the amplitudes of highest posterior density that leave out 2/5 of the failure
/// probability at the asked confidence, and what lies between them. On average over the prior its
/// coverage is above the asked confidence, whatever was measured and whenever it stopped; at an
/// amplitude of 1/2, where the coverage is least, it is about the asked confidence.
///
/// Stops early where the asked error is reached or a single S is left (all others together below
/// 10^-12). Never uses more queries than allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveBayes {
    goal: Goal,
}

impl AdaptiveBayes {
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        let goal = Goal::of(settings)?;
        Ok(Self { goal })
    }
}

impl AmplitudeEstimator for AdaptiveBayes {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        strata::estimate(&self.goal, Depths::Adaptive, device)
    }
}
