//! Errors of quantum circuits.

use super::{MAX_LEVEL_BITS, MAX_PHASE_BITS};
use crate::Qubit;
use std::fmt;

/// The reason why a circuit cannot be built.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuantumError {
    /// The oracle has no qubits in superposition, so there is nothing to count.
    NoIndex,
    /// A truth table has more entries than can be listed.
    TableBits {
        /// Address bits of the requested table.
        bits: u32,
        /// The most address bits that a table may have.
        most: u32,
    },
    /// A gate reads a bit that the pixel's classical parameters do not have.
    MissingWord {
        /// The parameter's index in the program's list.
        parameter: u32,
        /// The bit that the gate reads, 0 the least significant.
        bit: u32,
    },
    /// A gate names a qubit that the circuit does not have, or one qubit twice.
    InvalidQubit(Qubit),
    /// A phase is flipped in the part of an oracle that computes or uncomputes.
    SignOutsideFlip(Qubit),
    /// The oracle has no channel of this number.
    NoChannel(usize),
    /// The phase register's size is not in `1..=40` qubits.
    PhaseBitsOutOfRange(u32),
    /// The slope of levels' phases is not positive and finite, or their reference not in [0, 1].
    Slope,
    /// An oracle of a mean-phase circuit flips another number of signs than a phase has bits, or one of
    /// several qubits, or it has fixed qubits.
    PhaseSigns {
        /// Number of phase flips of a call of the oracle.
        signs: u64,
        /// Number of bits of a phase.
        bits: u32,
    },
    /// Levels or their phases have too few or too many bits.
    LevelBits,
}

impl fmt::Display for QuantumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoIndex => f.write_str("an oracle without qubits in superposition has no index"),
            Self::TableBits { bits, most } => {
                write!(
                    f,
                    "a truth table of an index of {bits} bits; at most {most}"
                )
            }
            Self::MissingWord { parameter, bit } => write!(
                f,
                "bit {bit} of classical parameter {parameter} is loaded, and the pixel has no such bit"
            ),
            Self::InvalidQubit(qubit) => write!(
                f,
                "qubit {qubit} is used twice by one gate, or is none of the circuit's"
            ),
            Self::SignOutsideFlip(qubit) => write!(
                f,
                "a phase is flipped on qubit {qubit} outside of the oracle's flip"
            ),
            Self::NoChannel(channel) => write!(f, "the oracle has no channel {channel}"),
            Self::PhaseBitsOutOfRange(bits) => write!(
                f,
                "a phase register of {bits} bits; it has 1 to {MAX_PHASE_BITS}"
            ),
            Self::PhaseSigns { signs, bits } => write!(
                f,
                "an oracle with {signs} phase flips; phases have {bits} bits, each of which needs a flip of \
                 one qubit, and no qubit of the index is fixed"
            ),
            Self::Slope => f.write_str(
                "phases of levels need a positive, finite slope and a reference from 0 to 1",
            ),
            Self::LevelBits => write!(
                f,
                "phases of levels have 2 to 51 bits, and levels at most {MAX_LEVEL_BITS}"
            ),
        }
    }
}

impl std::error::Error for QuantumError {}
