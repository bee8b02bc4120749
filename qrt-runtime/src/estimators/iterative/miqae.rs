//! `iqae`: iterative amplitude estimation.

use super::{iqae::cost, Failures, Goal, Multiples, Rules};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miqae {
    goal: Goal,
    rules: Rules,
}

impl Miqae {
    pub const SHOTS: u64 = 20;

    pub fn new(settings: &Settings) -> Self {
        Self::with_shots(settings, Self::SHOTS)
    }

    pub fn with_shots(settings: &Settings, shots: u64) -> Self {
        Self {
            goal: Goal::new(settings, cost("MI", 6.0)),
            rules: Rules {
                multiples: Multiples::Odd,
                ratio: 3,
                shots: cost("SH", shots as f64) as u64,
                failures: Failures::ByMultiple,
                late: None,
            },
        }
    }
}

impl AmplitudeEstimator for Miqae {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        self.rules.run(&self.goal, device)
    }
}
