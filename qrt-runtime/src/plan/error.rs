//! Why no parameters are chosen.

use crate::counting::CountingError;
use crate::estimators::EstimatorError;
use crate::sample::SampleError;
use crate::workers::ThreadsError;
use qrt_core::sampling::SamplingError;

/// Why no parameters are chosen for an asked accuracy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The scene asks for an accuracy that no parameters keep, or that cannot be shown: why.
    #[error("the scene's `accuracy` cannot be kept: {0}")]
    Unreachable(String),
    /// The sequence of paths can't be made.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The pixels can't be counted as asked.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The estimator can't do what it is asked.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The sample of pixels is not summed, or was interrupted.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}

impl PlanError {
    /// Whether it is the request that can't be met, rather than the job that failed: another
    /// attempt will fail alike.
    pub fn is_refusal(&self) -> bool {
        !matches!(self, Self::Sample(_) | Self::Threads(_))
    }
}
