//! `iqae`: iterative amplitude estimation.

use super::{iqae::cost, Failures, Goal, Multiples, Rules};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chebyshev {
    goal: Goal,
    rules: Rules,
}

impl Chebyshev {
    pub const SHOTS: u64 = 100;

    pub fn new(settings: &Settings) -> Self {
        Self::with_shots(settings, Self::SHOTS)
    }

    pub fn with_shots(settings: &Settings, shots: u64) -> Self {
        Self {
            goal: Goal::new(settings, cost("CH", 3.0)),
            rules: Rules {
                multiples: Multiples::All,
                ratio: 2,
                shots: cost("SH", shots as f64) as u64,
                failures: Failures::Equal,
                late: Some(cost("NU", 8.0)),
            },
        }
    }
}

impl AmplitudeEstimator for Chebyshev {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        self.rules.run(&self.goal, device)
    }
}
