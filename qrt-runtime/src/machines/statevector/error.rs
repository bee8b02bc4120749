//! What amplitudes refuse.

use crate::counting::CountingError;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::QuantumError;
use qrt_core::oracle::OracleError;
use std::fmt;

/// Why amplitudes cannot be followed as asked.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum StateVectorError {
    /// More qubits than the dense machine holds.
    TooManyQubits {
        /// Of the circuit.
        qubits: u32,
        /// The most.
        most: u32,
    },
    /// More basis states with amplitude than the sparse machine may hold.
    TooManyStates {
        /// As many as a gate asks for, at least.
        states: u64,
        /// The most.
        most: u64,
    },
    /// So much memory cannot be had.
    Memory {
        /// Bytes.
        bytes: u64,
    },
    /// A gate or a register names a qubit that the machine does not have, or one twice.
    InvalidQubit(Qubit),
    /// A bound on amplitudes that is negative or no number.
    Bound(f64),
    /// Nothing can be measured: all states have been dropped.
    NoStates,
    /// An angle that is not finite.
    Angle(f64),
    /// A register whose outcomes are too many to be listed.
    RegisterTooWide {
        /// Its qubits.
        bits: u32,
        /// The most.
        most: u32,
    },
    /// An ancilla that is not zero when it must be: a defect of the circuit.
    Dirty {
        /// The first such qubit.
        qubit: Qubit,
        /// The probability that one of them is read as 1.
        probability: f64,
    },
    /// A truth table that does not have a power of two of entries.
    TableSize(usize),
    /// A counting register that is too large to be followed.
    PhaseBits {
        /// Its qubits.
        bits: u32,
        /// The most.
        most: u32,
    },
    /// The circuit cannot be made.
    Circuit(QuantumError),
    /// The scene has no oracle.
    Oracle(OracleError),
    /// The counts are none.
    Counts(CountingError),
}

impl fmt::Display for StateVectorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyQubits { qubits, most } => write!(
                f,
                "a state vector of {qubits} qubits; at most {most}: the sparse machine has no limit \
                 of qubits"
            ),
            Self::TooManyStates { states, most } => write!(
                f,
                "{states} basis states with amplitude; at most {most} are allowed"
            ),
            Self::Memory { bytes } => write!(f, "no {bytes} bytes of memory for amplitudes"),
            Self::InvalidQubit(qubit) => write!(
                f,
                "qubit {qubit} is used twice by one gate or register, or is none of the machine's"
            ),
            Self::Bound(bound) => write!(
                f,
                "a bound of {bound} on the amplitudes that are dropped; it is not negative"
            ),
            Self::NoStates => f.write_str("no state carries amplitude: all have been dropped"),
            Self::Angle(angle) => write!(f, "a rotation by {angle}"),
            Self::RegisterTooWide { bits, most } => write!(
                f,
                "a register of {bits} qubits has too many outcomes to list; at most {most} qubits"
            ),
            Self::Dirty { qubit, probability } => write!(
                f,
                "ancilla {qubit} is not returned to zero: with probability {probability:.3e} \
                 ancillas are read as 1"
            ),
            Self::TableSize(entries) => {
                write!(f, "a truth table of {entries} entries, not a power of two")
            }
            Self::PhaseBits { bits, most } => write!(
                f,
                "amplitudes of a counting register of {bits} bits; at most {most}"
            ),
            Self::Circuit(error) => error.fmt(f),
            Self::Oracle(error) => error.fmt(f),
            Self::Counts(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for StateVectorError {}

impl From<QuantumError> for StateVectorError {
    fn from(error: QuantumError) -> Self {
        Self::Circuit(error)
    }
}

impl From<OracleError> for StateVectorError {
    fn from(error: OracleError) -> Self {
        Self::Oracle(error)
    }
}

impl From<CountingError> for StateVectorError {
    fn from(error: CountingError) -> Self {
        Self::Counts(error)
    }
}

/// Are all `qubits` different and among `0..count`?
pub(super) fn check_qubits(qubits: &[Qubit], count: u32) -> Result<(), StateVectorError> {
    for (place, qubit) in qubits.iter().enumerate() {
        if *qubit >= count || qubits[..place].contains(qubit) {
            return Err(StateVectorError::InvalidQubit(*qubit));
        }
    }
    Ok(())
}

/// A vector of `len` copies, if there is memory for it.
pub(super) fn filled<T: Clone>(value: T, len: usize) -> Result<Vec<T>, StateVectorError> {
    let mut all = Vec::new();
    let bytes = (len as u64).saturating_mul(size_of::<T>() as u64);
    all.try_reserve_exact(len)
        .map_err(|_| StateVectorError::Memory { bytes })?;
    all.resize(len, value);
    Ok(all)
}
