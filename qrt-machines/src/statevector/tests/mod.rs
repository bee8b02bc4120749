//! Tests of the machines that compute amplitudes.

mod gates;
mod outside;

use super::*;
use crate::fixed::tests::maker::Dice;
use qrt_circuit::quantum::{QuantumGate, Turns};

/// A gate that owns its qubits.
#[derive(Clone, Debug)]
pub(super) enum Owned {
    X(Qubit),
    Cx(Qubit, Qubit),
    Ccx(Qubit, Qubit, Qubit),
    H(Qubit),
    Ry(f64, Qubit),
    Phase(Turns, Vec<Qubit>),
}

impl Owned {
    pub(super) fn gate(&self) -> QuantumGate<'_> {
        match *self {
            Self::X(t) => QuantumGate::X(t),
            Self::Cx(a, t) => QuantumGate::Cx(a, t),
            Self::Ccx(a, b, t) => QuantumGate::Ccx(a, b, t),
            Self::H(t) => QuantumGate::H(t),
            Self::Ry(angle, target) => QuantumGate::Ry { angle, target },
            Self::Phase(turns, ref on) => QuantumGate::Phase { turns, on },
        }
    }

    pub(super) fn inverse(&self) -> Self {
        match self {
            Self::Ry(angle, target) => Self::Ry(-angle, *target),
            Self::Phase(turns, on) => Self::Phase(turns.inverse(), on.clone()),
            gate => gate.clone(),
        }
    }
}
