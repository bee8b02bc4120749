//! Why the models are not compared.

use crate::plan::PlanError;
use crate::workers::ThreadsError;
use qrt_core::oracle::OracleError;
use qrt_core::sampling::SamplingError;

/// Why the models are not compared. What they do wrong is no error, but in the report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// More portions than there are pixels to check.
    #[error("{pixels} pixels can't be dealt out to {count} portions: ask for fewer")]
    Portions {
        /// How many portions.
        count: u32,
        /// Pixels that are checked.
        pixels: u64,
    },
    /// No parameters keep the accuracy that the scene asks for.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The sequence of paths can't be made.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// More paths than a 64-bit word counts.
    #[error(
        "{pixels} pixels of 2^{path_bits} paths are more than 2^64 paths, which no machine traces \
         in a lifetime: lower `sampling.path_bits`, or the pixels"
    )]
    TooManyPaths {
        /// Pixels to be compared.
        pixels: u64,
        /// Paths of each, as a power of two.
        path_bits: u32,
    },
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The check was cancelled before it was finished.
    #[error("interrupted after {finished} of {pixels} pixels")]
    Interrupted {
        /// Pixels that were compared.
        finished: u64,
        /// Pixels that were to be.
        pixels: u64,
    },
}

impl VerifyError {
    /// Whether it is the request that can't be met, rather than the job that failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Plan(error) => error.is_refusal(),
            Self::Threads(_) | Self::Interrupted { .. } => false,
            Self::Oracle(_)
            | Self::Sampling(_)
            | Self::TooManyPaths { .. }
            | Self::Portions { .. } => true,
        }
    }
}
