//! Errors of an export.

use std::{fmt, io};

/// The reason why a circuit is not written.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExportError {
    /// The index has fewer qubits than the parts that the caller names.
    IndexBits {
        /// Sum of the bits of the parts.
        parts: u32,
        /// Qubits of the index.
        index: u32,
    },
    /// A gate reads a bit of a classical parameter for which no word was given.
    MissingWord {
        /// The parameter's index in the program's list.
        parameter: u32,
        /// The bit that the gate reads, 0 the least significant.
        bit: u32,
    },
    /// The libraries have no gate for a phase on this number of qubits.
    TooManyQubits(usize),
    /// The flag of [`Export::with_cancel`](super::Export::with_cancel) ended the writing.
    Interrupted,
    /// The output cannot be written to.
    Io(io::Error),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IndexBits { parts, index } => {
                write!(f, "parts of {parts} bits in an index of {index}")
            }
            Self::MissingWord { parameter, bit } => {
                write!(
                    f,
                    "no word was given for bit {bit} of parameter {parameter}"
                )
            }
            Self::TooManyQubits(qubits) => write!(
                f,
                "a phase on {qubits} qubits has no gate in OpenQASM's libraries; \
                 `Conjunction::Toffolis` writes O_0's sign without it"
            ),
            Self::Interrupted => f.write_str("interrupted"),
            Self::Io(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ExportError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for ExportError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
