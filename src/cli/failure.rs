//! Errors of a command.

use qrt_counting::CountingError;
use qrt_counting::estimators::EstimatorError;
use qrt_lab::simulate::SimulateError;
use qrt_lab::trade::TradeError;
use qrt_lab::verify::VerifyError;
use qrt_runtime::image::ImageError;
use qrt_runtime::plan::PlanError;
use qrt_runtime::render::{MergeError, RenderError};
use qrt_syntax::Report;
use std::path::Path;
use std::process::ExitCode;
use std::{fmt, io};

/// An error of a command.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The command line names what does not exist, or combines what does not go together.
    Usage(String),
    /// The scene is wrong.
    Scene(Box<Report>),
    /// The job failed; the text is the reason.
    Job(String),
}

impl Failure {
    /// The exit code: 2 for the command line and the scene, 1 for the job.
    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Usage(_) | Self::Scene(_) => 2,
            Self::Job(_) => 1,
        })
    }

    /// A failure of the file system, with the file's name.
    pub(crate) fn file(path: &Path, error: &io::Error) -> Self {
        Self::Job(format!("`{}`: {error}", path.display()))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(message) | Self::Job(message) => f.write_str(message),
            Self::Scene(report) => report.fmt(f),
        }
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::Scene(Box::new(report))
    }
}

/// Errors by whether they are refusals: then the command line is at fault, and else the job failed.
macro_rules! failures {
    ($($Error:ty: $is_refusal:expr,)+) => {
        $(impl From<$Error> for Failure {
            fn from(error: $Error) -> Self {
                let is_refusal: fn(&$Error) -> bool = $is_refusal;
                if is_refusal(&error) {
                    Self::Usage(error.to_string())
                } else {
                    Self::Job(error.to_string())
                }
            }
        })+
    };
}

failures! {
    CountingError: |_| true,
    EstimatorError: |_| true,
    MergeError: |_| false,
    PlanError: PlanError::is_refusal,
    RenderError: RenderError::is_refusal,
    SimulateError: SimulateError::is_refusal,
    TradeError: TradeError::is_refusal,
    VerifyError: VerifyError::is_refusal,
    ImageError: |error| matches!(
        error,
        ImageError::Extension { .. }
            | ImageError::Exposure { .. }
            | ImageError::ExposureOfExr
            | ImageError::Value { .. }
    ),
}
