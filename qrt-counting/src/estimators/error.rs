//! Errors of estimators: invalid settings and problems.

use crate::CountingError;
use qrt_circuit::quantum::MAX_LEVEL_BITS;
use qrt_scene::Estimator;

/// The most bits of a comparator whose levels `phase-mean` looks up.
const MOST_LEVEL_BITS: u32 = MAX_LEVEL_BITS;

/// The largest number of Grover iterations between preparation and measurement.
pub const MAX_ITERATIONS: u64 = 1 << 44;

/// An error of an estimator or its device.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// An error of quantum counting.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The settings allow no query.
    #[error("an estimator needs at least one query")]
    NoQueries,
    /// The requested error is not in (0, 1).
    #[error("an error of {0} is not between 0 and 1")]
    AskedError(f64),
    /// The requested confidence is not in (0, 1).
    #[error("a confidence of {0} is not between 0 and 1")]
    Confidence(f64),
    /// A probability of noise that is not in [0, 1].
    #[error("noise with probability {0}; a probability is in 0..=1")]
    Noise(f64),
    /// More Grover iterations between preparation and measurement than the device can distinguish.
    #[error("{0} Grover iterations before a measurement; at most {MAX_ITERATIONS}")]
    TooManyIterations(u64),
    /// An error of a user-defined estimator, with its message.
    #[error("{0}")]
    Own(&'static str),
    /// A reference of the shifted circuit that is not in [0, 1].
    #[error("a reference of {0} is not in [0, 1]")]
    Reference(f64),
    /// Strata of the comparator, requested from an estimator that counts only the whole.
    #[error(
        "{strata} strata, and the estimator `{estimator}` counts the whole comparator at once: choose \
         `adaptive-bayes`, `auto` or `random-depth`, or `counting.strata=1`"
    )]
    Strata {
        /// The estimator.
        estimator: Estimator,
        /// The requested number of strata.
        strata: u32,
    },
    /// A stratum that the device cannot count: it lacks the distribution of good indices over the
    /// comparator, or does not have this stratum.
    #[error("this device cannot count strata of its comparator one by one")]
    NotByStrata,
    /// Levels of paths, requested from a device that knows only the number of good indices.
    #[error("this device does not know the levels of its paths")]
    NoLevels,
    /// A mean phase of levels that are not the device's.
    #[error("phases of levels of {phases} bits, and the device's comparator has {device}")]
    OtherLevels {
        /// Number of bits of the device's comparator.
        device: u32,
        /// Number of bits of the levels that have phases.
        phases: u32,
    },
    /// A comparator with more bits than a table of phases has address bits.
    #[error(
        "a comparator of {0} bits; `phase-mean` looks the phase of a path's level up, and takes at most \
         {MOST_LEVEL_BITS}: set `comparator.bits` to fewer, or choose `auto`"
    )]
    LevelBits(u32),
    /// The slope or the reference of a mean phase is out of range.
    #[error(
        "a mean phase with slope {slope} and reference {reference}; a slope is above 0 and finite, and a \
         reference in [0, 1]"
    )]
    MeanPhase {
        /// The slope, which must be positive and finite.
        slope: f64,
        /// The reference, which must be in [0, 1].
        reference: f64,
    },
}
