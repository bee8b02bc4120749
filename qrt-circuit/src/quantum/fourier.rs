//! The inverse quantum Fourier transform.
//!
//! `|j>` with amplitudes `exp(2 pi i j y / T) / sqrt(T)` becomes `|y>` (Nielsen & Chuang, section
//! 5.1, backwards): swaps that reverse the register, then, from qubit 0 up, the phases that the
//! qubits below control, and a Hadamard.

use super::QuantumGate::{Cx, H, Phase};
use super::{QuantumGate, Turns};
use crate::Qubit;

/// Number of gates of the transform of `bits` qubits.
pub(super) fn gates(bits: u32) -> u64 {
    let bits = u64::from(bits);
    3 * (bits / 2) + bits + bits * bits.saturating_sub(1) / 2
}

/// Emits the inverse transform of `register`, bit 0 first. A swap is three CNOTs.
pub(super) fn inverse<E>(
    register: &[Qubit],
    sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let bits = register.len();
    for low in 0..bits / 2 {
        let (a, b) = (register[low], register[bits - 1 - low]);
        for gate in [Cx(a, b), Cx(b, a), Cx(a, b)] {
            sink(gate)?;
        }
    }
    for (place, qubit) in register.iter().enumerate() {
        for (below, other) in register[..place].iter().enumerate() {
            sink(Phase {
                turns: Turns::new(-1, (place - below + 1) as u32),
                on: &[*other, *qubit],
            })?;
        }
        sink(H(*qubit))?;
    }
    Ok(())
}
