//! `exact`: the true count, without an estimate.

use super::{AmplitudeEstimator, Device, Estimate, EstimatorError};

/// `exact`: S itself.
///
/// Counts every index, with N queries and without error. The picture then has no counting noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact;

impl AmplitudeEstimator for Exact {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let good = device.every_id();
        let total = device.total();
        let amplitude = good as f64 / total as f64;
        Ok(Estimate {
            good: Some(good),
            ..device.estimate(start, amplitude, (amplitude, amplitude), 1.0)
        })
    }
}
