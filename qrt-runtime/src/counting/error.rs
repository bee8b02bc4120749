//! Errors of counting: sizes and outcomes that it refuses.

/// The largest phase register.
pub const MAX_PHASE_BITS: u32 = 40;
/// The most repetitions of one estimate.
pub const MAX_REPETITIONS: u32 = 1_000_000;

/// Why counting cannot be done as asked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CountingError {
    /// There are no indices.
    #[error("the total number of indices is 0; it must be at least 1")]
    NoIds,
    /// More good indices than indices.
    #[error("{good} good indices out of {total}: there cannot be more good indices than indices")]
    MoreGoodThanTotal {
        /// S, the number of good indices that was given.
        good: u64,
        /// N, the number of all indices that was given.
        total: u64,
    },
    /// The amplitude is not in [0, 1].
    #[error("an amplitude of {0} is not in [0, 1]")]
    AmplitudeOutOfRange(f64),
    /// The phase register has no size in `1..=40` bits.
    #[error("{0} phase bits are not in 1..={MAX_PHASE_BITS}")]
    PhaseBitsOutOfRange(u32),
    /// The repetitions are not in `1..=1000000`.
    #[error("{0} repetitions are not in 1..={MAX_REPETITIONS}")]
    RepetitionsOutOfRange(u32),
    /// An outcome beyond T/2.
    #[error(
        "outcome {outcome} is beyond T/2 = {largest}; outcomes y and T - y are folded onto \
         0..={largest}"
    )]
    OutcomeOutOfRange {
        /// The outcome y that was given.
        outcome: u64,
        /// The largest outcome, T/2.
        largest: u64,
    },
    /// Nothing was measured, so nothing can be inferred.
    #[error("no outcome to infer anything from")]
    NoOutcomes,
    /// No number of good indices could have given these outcomes.
    #[error("no number of good indices could have given these outcomes")]
    ImpossibleOutcomes,
    /// More indices than can be gone through one by one.
    #[error("{total} indices are too many to go through one by one; at most {most}")]
    TooManyIds {
        /// N, the number of all indices.
        total: u64,
        /// The most that can be gone through.
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
