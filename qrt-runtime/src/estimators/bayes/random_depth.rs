//! `random-depth`: query depths drawn at random from a growing range.

use super::posterior::Posterior;
use super::{Goal, depth};
use crate::estimators::{
    AmplitudeEstimator, Device, Estimate, EstimatorError, MAX_ITERATIONS, Settings,
};

/// `random-depth`: single shots after a number of iterations drawn uniformly from a range that
/// grows from shot to shot, and the posterior mean.
///
/// After Lu & Lin, *Random-depth quantum amplitude estimation* (2023): with the fixed query depths
/// of MLAE there are critical amplitudes, at which a query depth tells nothing and the likelihood
/// has two equal peaks; random query depths have none. Theirs maximise the likelihood of many shots
/// per range; here every shot has a query depth of its own, the range grows by a factor of 1.09
/// with each, and the estimate is the mean of the whole posterior under a prior uniform in the
/// amplitude. What was measured does not decide what is measured next, except when to stop, and
/// that the range does not grow while more modes are left than can be held.
///
/// Interval and stopping as with `adaptive-bayes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomDepth {
    goal: Goal,
}

/// What the range of query depths grows by with each shot.
const GROWTH: f64 = 1.09;

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
        let start = device.usage();
        let mut posterior = Posterior::new(device.total(), self.goal.noise);
        let most = (MAX_ITERATIONS as f64).min(2.0 * depth::useful(&self.goal.noise));
        let mut left = self.goal.queries;
        let (mut range, mut shots) = (1.0_f64, 0);
        while left > 0 && !self.goal.is_reached(&posterior) {
            let limit = most.min(posterior.deepest()).min(left as f64);
            let held_back = range > limit;
            let deepest = range.min(limit) as u64;
            // A product of 64 random bits and a range below 2^45: its upper half is uniform.
            let draw = u128::from(device.stream().next_u64()) * u128::from(deepest + 1);
            let iterations = (draw >> 64) as u64;
            // Where the range may not grow, the shots do.
            let batch = if held_back && range > most {
                (shots as f64 * (GROWTH - 1.0)) as u64
            } else {
                1
            };
            let batch = batch.clamp(1, left / iterations.max(1));
            let good = device.iterated(iterations, batch)?;
            posterior.observe(iterations, good, batch - good);
            left -= batch * iterations.max(1);
            shots += batch;
            if !held_back {
                range *= GROWTH;
            }
        }
        Ok(posterior
            .sharpened()
            .estimate(device, start, self.goal.confidence))
    }
}
