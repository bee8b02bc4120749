//! Settings of estimators.

use super::{EstimatorError, Noise};
use crate::{CountingError, MAX_PHASE_BITS, MAX_REPETITIONS};
use qrt_circuit::quantum::Window;
use qrt_scene::{Counting, Estimator};

/// The default confidence of intervals.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;

/// Settings of estimators. Each estimator uses those that apply to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// t, of T = 2^t: the number of phase bits, in `1..=40`.
    pub phase_bits: u32,
    /// B, the number of runs of the counting circuit, in `1..=1000000`.
    pub repetitions: u32,
    /// The phase register's window, for `posterior-mean`, which accepts either window.
    pub window: Window,
    /// The query budget, at least 1, for estimators that choose their own measurements. In a scene
    /// it is (T - 1) B, so that all estimators cost the same.
    pub queries: u64,
    /// The error at which those estimators stop, as the interval's half-width, in (0, 1). With
    /// `None`, they stop at the end of the budget.
    pub error: Option<f64>,
    /// The requested coverage: the probability with which the interval contains S/N, in (0, 1).
    pub confidence: f64,
    /// Number of strata of the comparator to count on their own, on a device that can. With `None`,
    /// the first measurements determine the number.
    pub strata: Option<u32>,
    /// Noise that an estimator's likelihood assumes. The actual noise is a property of the device,
    /// and may differ.
    pub known_noise: Noise,
}

impl Settings {
    /// The settings of a scene's counting block, except its error.
    ///
    /// `queries` is the cost of B runs of the block's counting circuit.
    ///
    /// # Errors
    /// A register or repetitions out of range.
    pub fn from_counting(counting: &Counting) -> Result<Self, EstimatorError> {
        check_register(counting.phase_bits, counting.repetitions)?;
        Ok(Self {
            phase_bits: counting.phase_bits,
            repetitions: counting.repetitions,
            window: counting.window,
            // Below 2^40 * 10^6 < 2^60.
            queries: ((1_u64 << counting.phase_bits) - 1) * u64::from(counting.repetitions),
            error: None,
            confidence: DEFAULT_CONFIDENCE,
            strata: counting.strata,
            known_noise: Noise::NONE,
        })
    }

    /// The settings for a channel whose colours are `scale` times an amplitude; `scale` is above 0.
    ///
    /// `counting.error` is in radiance.
    ///
    /// # Errors
    /// A register or repetitions out of range.
    pub fn of_channel(counting: &Counting, scale: f64) -> Result<Self, EstimatorError> {
        // Every interval is narrow enough for this error.
        const ANY: f64 = 0.499;
        let error = counting.error.map(|error| (error / scale).min(ANY));
        Ok(Self {
            error,
            ..Self::from_counting(counting)?
        })
    }

    /// These settings, for counting the whole comparator at once, or good indices without one.
    #[must_use]
    pub fn of_whole(self) -> Self {
        Self {
            strata: Some(1),
            ..self
        }
    }

    /// Checks the settings for the estimator called `name`.
    pub(super) fn check_for(&self, name: Estimator) -> Result<(), EstimatorError> {
        self.check()?;
        match self.strata {
            Some(strata @ 2..) if !name.counts_strata() && name != Estimator::Exact => {
                Err(EstimatorError::Strata {
                    estimator: name,
                    strata,
                })
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn check(&self) -> Result<(), EstimatorError> {
        check_register(self.phase_bits, self.repetitions)?;
        if self.queries == 0 {
            return Err(EstimatorError::NoQueries);
        }
        let inside = |value: f64| value > 0.0 && value < 1.0;
        if let Some(error) = self.error.filter(|&error| !inside(error)) {
            return Err(EstimatorError::AskedError(error));
        }
        if !inside(self.confidence) {
            return Err(EstimatorError::Confidence(self.confidence));
        }
        self.known_noise.check()
    }
}

fn check_register(phase_bits: u32, repetitions: u32) -> Result<(), EstimatorError> {
    if !(1..=MAX_PHASE_BITS).contains(&phase_bits) {
        return Err(CountingError::PhaseBitsOutOfRange(phase_bits).into());
    }
    if !(1..=MAX_REPETITIONS).contains(&repetitions) {
        return Err(CountingError::RepetitionsOutOfRange(repetitions).into());
    }
    Ok(())
}
