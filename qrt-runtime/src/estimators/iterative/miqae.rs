//! `miqae`: modified iterative amplitude estimation.

use super::{Failures, Goal, Multiples, Rules};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `miqae`: modified iterative quantum amplitude estimation (Fukuzawa, Ho, Irani & Zion, *Modified
/// iterative quantum amplitude estimation is asymptotically optimal*, 2022), with Clopper-Pearson
/// intervals.
///
/// Odd multiples of theta, each at least three times the one before. What may fail at a multiple m
/// is `(2/3) m / m_max` of what may fail at all, `m_max = pi / (4 error)`: errors at shallow depths,
/// which would be large, are made rare, and cost little. The logarithm of the logarithm in the
/// cost of [`Iqae`](super::Iqae) is gone, and the root mean square error falls with 1/queries.
///
/// Interval: the last arc; at 95 % asked, 98 to 99 % are held.
///
/// Noise is not reckoned with: shares are taken for those of a perfect device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miqae {
    goal: Goal,
    rules: Rules,
}

impl Miqae {
    /// Shots taken at once; chosen as [`Iqae::SHOTS`](super::Iqae::SHOTS).
    pub const SHOTS: u64 = 12;

    /// Queries times the error that is aimed at where only queries are given: about what most runs
    /// take.
    const COST: f64 = 5.5;

    pub(crate) fn new(settings: &Settings) -> Self {
        Self::with_shots(settings, Self::SHOTS)
    }

    /// With another number of shots at once, at least one.
    pub fn with_shots(settings: &Settings, shots: u64) -> Self {
        Self {
            goal: Goal::new(settings, Self::COST),
            rules: Rules {
                multiples: Multiples::Odd,
                ratio: 3,
                shots: shots.max(1),
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
