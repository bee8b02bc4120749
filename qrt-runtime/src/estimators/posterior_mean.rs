//! `posterior-mean`: repeated quantum counting, and the posterior's mean.

use super::interval::credible_content;
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings, WindowedCounting};
use crate::counting::posterior_mean;
use qrt_core::scene::Estimator;

/// `posterior-mean`: the data of `paper`, B runs of the counting circuit with the window of the
/// scene, and the mean of S/N under a prior uniform over S in `0 ..= N`: of all estimates, the one
/// of least mean square error over that prior.
///
/// It is biased where the amplitude is near 0 or 1: too bright by about the error of a pixel at
/// amplitudes below `1/Q^2`. Averaging pixels does not lessen that. `adaptive-bayes` is nearly
/// without bias.
///
/// Interval: the amplitudes of highest posterior density that have the asked posterior mass,
/// cautiously, and what lies between them; extended to the interval of `paper`, whose coverage is
/// the asked confidence at every amplitude, where a posterior's is so on average only.
///
/// Takes B (T - 1) queries, whatever `queries` says; known noise plays no part in its likelihood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosteriorMean {
    counting: WindowedCounting,
}

impl PosteriorMean {
    /// # Errors
    /// A setting out of range.
    pub fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        let counting = WindowedCounting::new(Estimator::PosteriorMean, settings)?;
        Ok(Self { counting })
    }
}

impl AmplitudeEstimator for PosteriorMean {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let outcomes = self.counting.outcomes(device)?;
        let WindowedCounting {
            phase_bits,
            window,
            confidence,
            ..
        } = self.counting;
        let content = credible_content(confidence);
        let found = posterior_mean(&outcomes, device.total(), phase_bits, window, content)?;
        let medians = self.counting.medians_interval(&outcomes);
        let (low, high) = found.interval;
        let interval = (low.min(medians.0), high.max(medians.1));
        Ok(device.estimate(start, found.mean, interval, confidence))
    }

    fn misses(&self) -> f64 {
        self.counting.misses()
    }
}
