//! What is wanted of an estimator.

use super::{EstimatorError, Noise};
use crate::counting::{CountingError, MAX_PHASE_BITS, MAX_REPETITIONS};
use qrt_core::scene::{Counting, Window};

/// The confidence of intervals where none is asked.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;

/// What is wanted of an estimator. Each takes from it what it has a use for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// t, of T = 2^t: the phase register, in `1..=40`.
    pub phase_bits: u32,
    /// B, the runs of the counting circuit, in `1..=1000000`.
    pub repetitions: u32,
    /// The phase register's window, for `posterior-mean`, which leaves it open.
    pub window: Window,
    /// The most queries that may be used, for estimators that decide themselves what they measure;
    /// at least 1. (T - 1) B in a scene, so that all estimators cost the same.
    pub queries: u64,
    /// The error at which they stop, as the interval's half-width, in (0, 1); none: when the
    /// queries are used.
    pub error: Option<f64>,
    /// The asked coverage: the probability with which the interval contains S/N, in (0, 1).
    pub confidence: f64,
    /// Strata of the comparator to count one by one, on a device that can; none: as many as what is
    /// measured first suggests.
    pub strata: Option<u32>,
    /// Noise that an estimator with a likelihood reckons with. What a device suffers is said where
    /// it is made, and may differ.
    pub known_noise: Noise,
}

impl Settings {
    /// The settings of a scene's counting block, but for its error: `queries` is what B runs of its
    /// counting circuit take.
    ///
    /// # Errors
    /// A register or repetitions out of range.
    pub fn of(counting: &Counting) -> Result<Self, EstimatorError> {
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

    /// The same for a channel whose colours are `scale`, above 0, times an amplitude: its
    /// `counting.error` is in radiance.
    ///
    /// # Errors
    /// A register or repetitions out of range.
    pub fn of_channel(counting: &Counting, scale: f64) -> Result<Self, EstimatorError> {
        // Every interval is that narrow.
        const ANY: f64 = 0.499;
        let error = counting.error.map(|error| (error / scale).min(ANY));
        Ok(Self {
            error,
            ..Self::of(counting)?
        })
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
