//! Why pixels are not summed.

use crate::machines::Defect;

/// Why the paths of a sample of pixels are not summed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The circuit does not do what an oracle must: a defect of qrt.
    #[error("{0}: a defect of qrt; the picture would prove nothing, so there is none")]
    Defect(#[from] Defect),
    /// The sampling was cancelled before it was finished.
    #[error("interrupted after 0 of {pixels} pixels")]
    Interrupted {
        /// Pixels of the sample.
        pixels: u64,
    },
}
