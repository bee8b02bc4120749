//! What counting refuses.

use std::fmt;

/// The largest counting register.
pub const MAX_PHASE_BITS: u32 = 40;
/// The most repetitions of one estimate.
pub const MAX_REPETITIONS: u32 = 1_000_000;

/// Why counting cannot be done as asked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CountingError {
    /// There are no ids.
    NoIds,
    /// More good ids than ids.
    MoreGoodThanTotal {
        /// Good ids.
        good: u64,
        /// All ids.
        total: u64,
    },
    /// The amplitude is not in [0, 1].
    AmplitudeOutOfRange(f64),
    /// The counting register has no size in `1..=40` bits.
    PhaseBitsOutOfRange(u32),
    /// The repetitions are not in `1..=1000000`.
    RepetitionsOutOfRange(u32),
    /// An outcome beyond T/2.
    OutcomeOutOfRange {
        /// The outcome.
        outcome: u64,
        /// The largest outcome, T/2.
        largest: u64,
    },
    /// Nothing was measured, so nothing can be inferred.
    NoOutcomes,
    /// No number of good ids could have given these outcomes.
    ImpossibleOutcomes,
    /// More ids than can be gone through one by one.
    TooManyIds {
        /// All ids.
        total: u64,
        /// The most that can be.
        most: u64,
    },
    /// A comparator register that is not in `0..=30` bits.
    ComparatorBitsOutOfRange(u32),
    /// A colour scale that is negative, not finite, or too small for its comparators.
    ScaleOutOfRange(f64),
}

impl fmt::Display for CountingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoIds => write!(f, "the total number of ids is 0; it must be at least 1"),
            Self::MoreGoodThanTotal { good, total } => {
                write!(
                    f,
                    "{good} good ids out of {total}: there cannot be more good ids than ids"
                )
            }
            Self::AmplitudeOutOfRange(amplitude) => {
                write!(f, "an amplitude of {amplitude} is not in [0, 1]")
            }
            Self::PhaseBitsOutOfRange(bits) => {
                write!(f, "{bits} phase bits are not in 1..={MAX_PHASE_BITS}")
            }
            Self::RepetitionsOutOfRange(count) => {
                write!(f, "{count} repetitions are not in 1..={MAX_REPETITIONS}")
            }
            Self::OutcomeOutOfRange { outcome, largest } => write!(
                f,
                "outcome {outcome} is beyond T/2 = {largest}; outcomes y and T - y are folded \
                 onto 0..={largest}"
            ),
            Self::NoOutcomes => write!(f, "no outcome to infer anything from"),
            Self::ImpossibleOutcomes => {
                write!(f, "no number of good ids could have given these outcomes")
            }
            Self::TooManyIds { total, most } => {
                write!(
                    f,
                    "{total} ids are too many to go through one by one; at most {most}"
                )
            }
            Self::ComparatorBitsOutOfRange(bits) => {
                write!(f, "{bits} comparator bits are not in 0..=30")
            }
            Self::ScaleOutOfRange(scale) => write!(
                f,
                "a colour scale of {scale} is negative, not finite, or too small to be divided \
                 among its comparators"
            ),
        }
    }
}

impl std::error::Error for CountingError {}
