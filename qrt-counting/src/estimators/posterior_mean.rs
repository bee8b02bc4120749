//! `posterior-mean`: repeated quantum counting, and the posterior's mean.

use super::interval::credible_content;
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings, WindowedCounting};
use crate::posterior_mean;
use qrt_scene::Estimator;

/// `posterior-mean`: the posterior's mean of S/N after B runs of the counting circuit.
///
/// The runs are those of `paper`, with the window of the scene. The prior is uniform over S in
/// `0 ..= N`. Of all estimates, this one has the least mean square error over that prior.
///
/// It is biased if the amplitude is near 0 or 1: at amplitudes below `1/Q^2` it is too bright by
/// about the error of a pixel. Averaging pixels does not lessen the bias. `adaptive-bayes` is
/// nearly without bias.
///
/// Interval: the range of the amplitudes of highest posterior density that hold the requested
/// posterior mass, with a margin. It is extended to the interval of `paper`, whose coverage is the
/// requested confidence at every amplitude; the coverage of a posterior's interval is so only on
/// average.
///
/// Takes B (T - 1) queries and ignores `queries`. Its likelihood ignores known noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosteriorMean {
    counting: WindowedCounting,
}

impl PosteriorMean {
    /// Creates the estimator from `settings`.
    ///
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
