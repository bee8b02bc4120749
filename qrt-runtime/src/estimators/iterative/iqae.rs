//! `iqae`: iterative amplitude estimation.

use super::{Failures, Goal, Multiples, Rules};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iqae {
    goal: Goal,
    rules: Rules,
}

impl Iqae {
    pub const SHOTS: u64 = 20;

    pub fn new(settings: &Settings) -> Self {
        Self::with_shots(settings, Self::SHOTS)
    }

    pub fn with_shots(settings: &Settings, shots: u64) -> Self {
        Self {
            goal: Goal::new(settings, cost("IQ", 6.0)),
            rules: Rules {
                multiples: Multiples::Odd,
                ratio: 2,
                shots: cost("SH", shots as f64) as u64,
                failures: Failures::Equal,
                late: None,
            },
        }
    }
}
pub fn cost(name: &str, d: f64) -> f64 { std::env::var(name).ok().map_or(d, |v| v.parse().unwrap()) }

impl AmplitudeEstimator for Iqae {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        self.rules.run(&self.goal, device)
    }
}
