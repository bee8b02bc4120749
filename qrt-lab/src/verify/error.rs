//! Errors of comparing the models.

use qrt_core::oracle::OracleError;
use qrt_counting::CountingError;
use qrt_runtime::models::MachineError;
use qrt_runtime::path_machines::Defect;
use qrt_runtime::prepared::PrepareError;
use qrt_runtime::workers::ThreadsError;
use qrt_scene::sampling::SamplingError;

/// An error that prevents a comparison of the models. Differences between models are in the report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// There are more portions than pixels to check.
    #[error("{pixels} pixels can't be dealt out to {count} portions: ask for fewer")]
    Portions {
        /// Number of portions.
        count: u32,
        /// Number of pixels to check.
        pixels: u64,
    },
    /// The scene cannot be prepared: no parameters keep its accuracy, or its circuit does not fit.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// The machine of a model cannot be made.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The sequence of paths cannot be created.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The number of paths overflows 64 bits.
    #[error(
        "{pixels} pixels of 2^{path_bits} paths are more than 2^64 paths, which no machine traces \
         in a lifetime: lower `sampling.path_bits`, or the pixels"
    )]
    TooManyPaths {
        /// Number of pixels to compare.
        pixels: u64,
        /// Number of paths of a pixel, as a power of two.
        path_bits: u32,
    },
    /// The colours of a pixel cannot be compared with thresholds.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The program of a pixel shows a defect.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The check was cancelled before it was finished.
    #[error("interrupted after {finished} of {pixels} pixels")]
    Interrupted {
        /// Number of pixels compared so far.
        finished: u64,
        /// Number of pixels to compare.
        pixels: u64,
    },
}

impl VerifyError {
    /// Returns true if the request can't be met; false if the job failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Prepare(error) => error.is_refusal(),
            Self::Machine(MachineError::Defect(_))
            | Self::Defect(_)
            | Self::Threads(_)
            | Self::Interrupted { .. } => false,
            Self::Machine(_)
            | Self::Oracle(_)
            | Self::Counting(_)
            | Self::Sampling(_)
            | Self::TooManyPaths { .. }
            | Self::Portions { .. } => true,
        }
    }
}
