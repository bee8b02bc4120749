//! `adaptive-bayes`: every depth is chosen from what is known.

use super::depth;
use super::posterior::Posterior;
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Noise, Settings};

/// What is left of the variance of `pi theta` when theta is known.
const KNOWN: f64 = 1e-12;

/// `adaptive-bayes`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveBayes {
    queries: u64,
    error: Option<f64>,
    confidence: f64,
    noise: Noise,
}

impl AdaptiveBayes {
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        settings.check()?;
        Ok(Self {
            queries: settings.queries,
            error: settings.error,
            confidence: settings.confidence,
            noise: settings.known_noise,
        })
    }

    fn is_done(&self, posterior: &Posterior) -> bool {
        if posterior.likeliest().is_some_and(|(_, probability)| probability > 1.0 - KNOWN) {
            return true;
        }
        let Some(error) = self.error else {
            return false;
        };
        let (low, high) = posterior.interval(self.confidence);
        high - low <= 2.0 * error
    }
}

impl AmplitudeEstimator for AdaptiveBayes {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.spent();
        let mut posterior = Posterior::new(device.total(), self.noise);
        let mut left = self.queries;
        while left > 0 && !self.is_done(&posterior) {
            let plan = depth::choose(&mut posterior, &self.noise, left);

            let good = device.iterated(plan.iterations, plan.shots)?;
            posterior.observe(plan.iterations, good, plan.shots - good);
            left -= plan.shots * plan.iterations.max(1);
        }
        Ok(posterior.sharpened().estimate(device, start, self.confidence))
    }
}
