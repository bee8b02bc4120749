//! Why there is no table.

use crate::counting::CountingError;
use crate::estimators::EstimatorError;
use crate::sample::SampleError;
use crate::workers::ThreadsError;
use qrt_core::oracle::OracleError;
use qrt_core::sampling::SamplingError;
use qrt_core::syntax::Problem;
use std::io;
use std::path::PathBuf;

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeError {
    /// The sample of pixels is not summed, or was interrupted: rows that are finished stay.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The sequence of paths can't be made.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The pixels can't be counted as asked.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The estimator can't do what it is asked.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// Every pixel is black: nothing can be relative to their mean.
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
        /// What the file system says.
        source: io::Error,
    },
    /// Another process measures into the same table.
    #[error("`{}` is being written by another `qrt trade`", .path.display())]
    InUse {
        /// The table's file.
        path: PathBuf,
    },
    /// The table that is there is another's.
    #[error(
        "`{}` is the table of another {what}: {found}, not {asked}; remove it, or name another \
         folder",
        .path.display()
    )]
    Differs {
        /// The table's file.
        path: PathBuf,
        /// What differs, such as the scene.
        what: String,
        /// The value that the table has of it.
        found: String,
        /// The value that was asked for.
        asked: String,
    },
    /// Two tables have different rows of one setting: at least one of them is no measurement of it.
    #[error(
        "`{}` and `{}` disagree about a setting that both have: {setting}; remove one of the two",
        .path.display(), .first.display()
    )]
    Disagree {
        /// A table's file.
        path: PathBuf,
        /// The other's.
        first: PathBuf,
        /// The setting, by its columns.
        setting: String,
    },
    /// The table that is there cannot be read.
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
    let first = problems.first().map(|problem| problem.words().message);
    first.unwrap_or_default()
}

impl TradeError {
    /// Whether it is the request that can't be met, rather than the job that failed.
    pub fn is_refusal(&self) -> bool {
        !matches!(
            self,
            Self::Sample(_) | Self::Threads(_) | Self::File { .. } | Self::InUse { .. }
        )
    }
}
