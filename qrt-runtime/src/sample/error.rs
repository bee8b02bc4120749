//! Errors of summing the paths of pixels.

use crate::path_machines::Defect;

/// An error of summing the paths of a sample of pixels.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The circuit is not a valid oracle: a defect of qrt.
    #[error("{0}: a defect of qrt; the picture would prove nothing, so there is none")]
    Defect(#[from] Defect),
    /// The sampling was cancelled before it was finished.
    #[error("interrupted after 0 of {pixels} pixels")]
    Interrupted {
        /// Number of pixels of the sample.
        pixels: u64,
    },
}
