//! Errors of the state vectors.

use qrt_circuit::Qubit;
use qrt_circuit::quantum::QuantumError;

/// Reason for which amplitudes cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateVectorError {
    /// More qubits than the dense machine holds.
    #[error(
        "a state vector of {qubits} qubits; at most {most}: the sparse machine has no limit of \
         qubits"
    )]
    TooManyQubits {
        /// The circuit's qubits.
        qubits: u32,
        /// The most qubits that the dense machine holds.
        most: u32,
    },
    /// More basis states with amplitude than the sparse machine may hold.
    #[error("{states} basis states with amplitude; at most {most} are allowed")]
    TooManyStates {
        /// Number of states that the gates need, at least.
        states: u64,
        /// The most basis states that are allowed.
        most: u64,
    },
    /// There is not enough memory.
    #[error("no {bytes} bytes of memory for amplitudes")]
    Memory {
        /// Number of bytes that are needed.
        bytes: u64,
    },
    /// A gate or a register names a qubit that the machine does not have, or one twice.
    #[error("qubit {0} is used twice by one gate or register, or is none of the machine's")]
    InvalidQubit(Qubit),
    /// No state can be measured, because all have been dropped.
    #[error("no state carries amplitude: all have been dropped")]
    NoStates,
    /// An angle that is not finite.
    #[error("a rotation by {0}")]
    Angle(f64),
    /// A register with too many outcomes to list.
    #[error("a register of {bits} qubits has too many outcomes to list; at most {most} qubits")]
    RegisterTooWide {
        /// The register's qubits.
        bits: u32,
        /// The most qubits of a register whose outcomes are listed.
        most: u32,
    },
    /// The caller cancelled the run.
    #[error("cancelled")]
    Cancelled,
    /// An ancilla that is not zero when it must be: a defect of the circuit.
    #[error(
        "ancilla {qubit} is not returned to zero: with probability {probability:.3e} ancillas are \
         read as 1"
    )]
    Dirty {
        /// The first ancilla that is not zero.
        qubit: Qubit,
        /// The probability that one of the ancillas is read as 1.
        probability: f64,
    },
    /// The circuit cannot be made.
    #[error(transparent)]
    Circuit(#[from] QuantumError),
}

/// Checks that all `qubits` are different and among `0..count`.
pub(super) fn check_qubits(qubits: &[Qubit], count: u32) -> Result<(), StateVectorError> {
    for (place, qubit) in qubits.iter().enumerate() {
        if *qubit >= count || qubits[..place].contains(qubit) {
            return Err(StateVectorError::InvalidQubit(*qubit));
        }
    }
    Ok(())
}

/// A vector of `len` copies of `value`.
///
/// # Errors
/// No memory for it.
pub fn filled<T: Clone>(value: T, len: usize) -> Result<Vec<T>, StateVectorError> {
    let mut all = Vec::new();
    let bytes = (len as u64).saturating_mul(size_of::<T>() as u64);
    all.try_reserve_exact(len)
        .map_err(|_| StateVectorError::Memory { bytes })?;
    all.resize(len, value);
    Ok(all)
}
