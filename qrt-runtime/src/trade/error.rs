//! Why there is no table.

use crate::render::RenderError;
use qrt_core::syntax::Problem;
use std::path::PathBuf;
use std::{fmt, io};

/// Why there is no table.
#[derive(Debug)]
#[non_exhaustive]
pub enum TradeError {
    /// What is measured cannot be rendered, or was interrupted: rows that are finished stay.
    Render(RenderError),
    /// Every pixel is black: nothing can be relative to their mean.
    Black,
    /// The knobs of the scene cannot be turned.
    Knobs(Vec<Problem>),
    /// A file cannot be written or read.
    File(PathBuf, io::Error),
    /// The table that is there is another's.
    Differs {
        /// The table.
        path: PathBuf,
        /// What differs.
        what: String,
        /// What the table says of it.
        found: String,
        /// What was asked for.
        asked: String,
    },
    /// The table that is there cannot be read.
    Unreadable {
        /// The table.
        path: PathBuf,
        /// From 1.
        line: usize,
    },
}

impl TradeError {
    /// Whether it is the request that can't be met, rather than the job that failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Render(error) => error.is_refusal(),
            Self::Black | Self::Knobs(_) | Self::Differs { .. } | Self::Unreadable { .. } => true,
            Self::File(..) => false,
        }
    }
}

impl fmt::Display for TradeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Render(error) => error.fmt(f),
            Self::Black => write!(
                f,
                "every pixel that was tried is black: errors are relative to the picture's mean \
                 radiance, which is 0"
            ),
            Self::Knobs(problems) => {
                let first = problems.first().map(|problem| problem.words().message);
                let first = first.unwrap_or_default();
                write!(f, "the scene's knobs cannot be turned: {first}")
            }
            Self::File(path, error) => write!(f, "`{}`: {error}", path.display()),
            Self::Differs {
                path,
                what,
                found,
                asked,
            } => write!(
                f,
                "`{}` is the table of another {what}: {found}, not {asked}; remove it, or name \
                 another folder",
                path.display()
            ),
            Self::Unreadable { path, line } => write!(
                f,
                "`{}`: line {line} is no row of this table; remove the file, or name another folder",
                path.display()
            ),
        }
    }
}

impl std::error::Error for TradeError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Render(error) => Some(error),
            Self::File(_, error) => Some(error),
            _ => None,
        }
    }
}

impl From<RenderError> for TradeError {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}
