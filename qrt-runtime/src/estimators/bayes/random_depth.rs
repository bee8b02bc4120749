//! `random-depth`: query depths drawn at random from a growing range.

use super::run::Depths;
use super::{Goal, strata};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `random-depth`: single shots after a number of iterations drawn uniformly from a range that
/// grows from shot to shot, and the estimate of `adaptive-bayes`.
///
/// After Lu & Lin, *Random-depth quantum amplitude estimation* (2023): with the fixed query depths
/// of MLAE there are critical amplitudes, at which a query depth tells nothing and the likelihood
/// has two equal peaks; random query depths have none. Theirs maximise the likelihood of many shots
/// per range; here every shot has a query depth of its own, the range grows by a factor of 1.09
/// with each, and the estimate is a mean of the whole posterior. What was measured does not decide
/// what is measured next, except when to stop, and that the range does not grow while more modes are
/// left than can be held.
///
/// With a few hundred queries the posterior often has several modes, and the estimate lies between them.
/// On the Cornell box with 255 queries the RMSE is a quarter of the mean, that of sampling half of it
/// (`cargo bench --bench estimators -- bias`).
///
/// Interval and stopping as with `adaptive-bayes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomDepth {
    goal: Goal,
}

impl RandomDepth {
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        let goal = Goal::of(settings)?;
        Ok(Self { goal })
    }
}

impl AmplitudeEstimator for RandomDepth {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        strata::estimate(&self.goal, Depths::RANDOM, device)
    }
}
