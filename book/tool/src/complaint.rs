//! Faults of the book, with their places.

use std::fmt;

/// A fault that an author, or the maintainer of the build, has to mend.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Complaint {
    /// The file, as seen from the repository's root.
    pub(crate) file: String,
    /// The line, counted from 1; 0 for the whole file.
    pub(crate) line: usize,
    /// The fault, and its remedy.
    pub(crate) message: String,
}

impl Complaint {
    /// Creates a complaint about one line of a file.
    pub(crate) fn at(file: &str, line: usize, message: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line,
            message: message.into(),
        }
    }

    /// Creates a complaint about a whole file.
    pub(crate) fn about(file: &str, message: impl Into<String>) -> Self {
        Self::at(file, 0, message)
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file, self.message),
            line => write!(f, "{}:{line}: {}", self.file, self.message),
        }
    }
}
