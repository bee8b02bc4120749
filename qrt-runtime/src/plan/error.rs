//! The errors of choosing parameters.

use crate::models::MachineError;
use crate::sample::SampleError;
use crate::workers::ThreadsError;
use qrt_counting::CountingError;
use qrt_counting::estimators::EstimatorError;
use qrt_scene::sampling::SamplingError;

/// An error of choosing parameters for an accuracy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// No parameters keep the scene's accuracy, or the sample cannot show that they do; the text
    /// says why.
    #[error("the scene's `accuracy` cannot be kept: {0}")]
    Unreachable(String),
    /// The sequence of paths cannot be created.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The pixels cannot be counted with these parameters.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The estimator does not support the request.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// Summing the sample of pixels failed, or was interrupted.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}

impl From<MachineError> for PlanError {
    fn from(error: MachineError) -> Self {
        match error {
            MachineError::Sampling(error) => error.into(),
            MachineError::Defect(defect) => SampleError::from(defect).into(),
            error => Self::Unreachable(error.to_string()),
        }
    }
}

impl PlanError {
    /// Returns true if the request can't be met, so that another attempt will fail alike; false if
    /// the job failed.
    pub fn is_refusal(&self) -> bool {
        !matches!(self, Self::Sample(_) | Self::Threads(_))
    }
}
