//! Errors of `qrt trade`.

use qrt_core::oracle::OracleError;
use qrt_counting::CountingError;
use qrt_counting::estimators::EstimatorError;
use qrt_runtime::memory::MemoryError;
use qrt_runtime::models::MachineError;
use qrt_runtime::sample::SampleError;
use qrt_runtime::workers::ThreadsError;
use qrt_scene::sampling::SamplingError;
use qrt_syntax::Problem;
use std::io;
use std::path::PathBuf;

/// An error that leaves `qrt trade` without a table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeError {
    /// The sum over the sample of pixels failed or was interrupted. Finished rows stay.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The machine of a model cannot be made.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The scene's circuit would exceed the memory budget.
    #[error(transparent)]
    WouldNotFit(#[from] MemoryError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The sequence of paths can't be made.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// An error of counting the pixels.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// An error of the estimator.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// Every pixel is black, so errors cannot be relative to their mean.
    #[error(
        "every pixel that was tried is black: errors are relative to the picture's mean radiance, \
         which is 0"
    )]
    Black,
    /// The scene's parameters cannot be varied.
    #[error("the scene's parameters cannot be varied: {}", first(.0))]
    Parameters(Vec<Problem>),
    /// A file cannot be written or read.
    #[error("`{}`: {source}", .path.display())]
    File {
        /// The file that cannot be written or read.
        path: PathBuf,
        /// The error of the file system.
        source: io::Error,
    },
    /// Another process measures and writes the same table.
    #[error("`{}` is being written by another `qrt trade`", .path.display())]
    InUse {
        /// The table's file.
        path: PathBuf,
    },
    /// The existing table depends on other values, for example another scene.
    #[error(
        "`{}` is the table of another {what}: {found}, not {asked}; remove it, or name another \
         folder",
        .path.display()
    )]
    Differs {
        /// The table's file.
        path: PathBuf,
        /// The name of the value that differs, for example the scene.
        what: String,
        /// The value in the existing table.
        found: String,
        /// The requested value.
        asked: String,
    },
    /// Two tables have different rows of one setting: at least one of the rows is wrong.
    #[error(
        "`{}` and `{}` disagree about a setting that both have: {setting}; remove one of the two",
        .path.display(), .first.display()
    )]
    Disagree {
        /// A table's file.
        path: PathBuf,
        /// The other table's file.
        first: PathBuf,
        /// The setting, by its columns.
        setting: String,
    },
    /// The existing table cannot be read.
    #[error(
        "`{}`: line {line} is no row of this table; remove the file, or name another folder",
        .path.display()
    )]
    Unreadable {
        /// The table's file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
    },
}

pub(super) fn first(problems: &[Problem]) -> String {
    let first = problems
        .first()
        .map(|problem| problem.description().message);
    first.unwrap_or_default()
}

impl TradeError {
    /// True if the request can't be met; false if the job failed.
    pub fn is_refusal(&self) -> bool {
        !matches!(
            self,
            Self::Sample(_)
                | Self::Machine(MachineError::Defect(_))
                | Self::Threads(_)
                | Self::File { .. }
                | Self::InUse { .. }
        )
    }
}
