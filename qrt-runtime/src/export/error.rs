//! What an export refuses.

use std::io;

/// Why a circuit is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The id has fewer bits than its path is said to have.
    #[error("a path of {path_bits} bits in an id of {id}")]
    PathBits {
        /// What the path is said to have.
        path_bits: u32,
        /// Bits of the id.
        id: u32,
    },
    /// A sign or phase on so many qubits has no gate in the libraries.
    #[error(
        "a phase on {0} qubits has no gate in OpenQASM's libraries; `Conjunction::Toffolis` writes \
         O_0's sign without it"
    )]
    TooManyQubits(usize),
    /// It was asked to end.
    #[error("interrupted")]
    Interrupted,
    /// It cannot be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}
