//! Errors of counting: invalid sizes and outcomes.

/// The largest number of phase bits.
pub const MAX_PHASE_BITS: u32 = 40;
/// The largest number of repetitions of one estimate.
pub const MAX_REPETITIONS: u32 = 1_000_000;

/// An error in the arguments of counting or inference.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CountingError {
    /// There are no indices.
    #[error("the total number of indices is 0; it must be at least 1")]
    NoIds,
    /// More good indices than indices.
    #[error("{good} good indices out of {total}: there cannot be more good indices than indices")]
    MoreGoodThanTotal {
        /// S, the given number of good indices.
        good: u64,
        /// N, the given number of all indices.
        total: u64,
    },
    /// The amplitude is not in [0, 1].
    #[error("an amplitude of {0} is not in [0, 1]")]
    AmplitudeOutOfRange(f64),
    /// The phase register's size is not in `1..=40` bits.
    #[error("{0} phase bits are not in 1..={MAX_PHASE_BITS}")]
    PhaseBitsOutOfRange(u32),
    /// The number of repetitions is not in `1..=1000000`.
    #[error("{0} repetitions are not in 1..={MAX_REPETITIONS}")]
    RepetitionsOutOfRange(u32),
    /// An outcome beyond T/2.
    #[error(
        "outcome {outcome} is beyond T/2 = {largest}; outcomes y and T - y are folded onto \
         0..={largest}"
    )]
    OutcomeOutOfRange {
        /// The given outcome y.
        outcome: u64,
        /// The largest outcome, T/2.
        largest: u64,
    },
    /// There are no outcomes to infer from.
    #[error("no outcome to infer anything from")]
    NoOutcomes,
    /// No number of good indices could produce the given outcomes.
    #[error("no number of good indices could have given these outcomes")]
    ImpossibleOutcomes,
    /// Too many indices to enumerate.
    #[error("{total} indices are too many to go through one by one; at most {most}")]
    TooManyIds {
        /// N, the number of all indices.
        total: u64,
        /// The largest number of indices that can be enumerated.
        most: u64,
    },
    /// A comparator register that is not in `0..=30` bits.
    #[error("{0} comparator bits are not in 0..=30")]
    ComparatorBitsOutOfRange(u32),
    /// A colour scale that is negative, not finite, or too small for its comparators.
    #[error(
        "a colour scale of {0} is negative, not finite, or too small to be divided among its \
         comparators"
    )]
    ScaleOutOfRange(f64),
}
