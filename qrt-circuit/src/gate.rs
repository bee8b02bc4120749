//! Gates, and circuits of them.

use super::{Parameter, RegisterId};
use std::ops::Range;

/// The index of a qubit of a [`GateCircuit`].
pub type Qubit = u32;

/// A gate on basis states. Each gate is its own inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gate {
    /// Flips a qubit.
    X(Qubit),
    /// Flips the second qubit where the first is 1.
    Cx(Qubit, Qubit),
    /// Flips the third qubit where the first and the second are 1: a Toffoli.
    Ccx(Qubit, Qubit, Qubit),
    /// Flips the qubit where bit `bit` of classical parameter `parameter` is set. In the circuit of
    /// a pixel, that is an X or nothing.
    Load {
        /// The parameter's index in [`GateCircuit::parameters`].
        parameter: u32,
        /// The parameter's bit, 0 the least significant.
        bit: u32,
        /// The qubit that is flipped.
        target: Qubit,
    },
    /// Flips the phase where the qubit is 1.
    Z(Qubit),
}

/// A receiver of gates, one after another.
pub trait GateSink {
    /// Receives the next gate.
    fn gate(&mut self, gate: Gate);

    /// Flips a qubit.
    #[inline(always)]
    fn x(&mut self, target: Qubit) {
        self.gate(Gate::X(target));
    }
    /// Flips `target` where `control` is 1.
    #[inline(always)]
    fn cx(&mut self, control: Qubit, target: Qubit) {
        self.gate(Gate::Cx(control, target));
    }
    /// Flips `target` where both controls are 1.
    #[inline(always)]
    fn ccx(&mut self, a: Qubit, b: Qubit, target: Qubit) {
        self.gate(Gate::Ccx(a, b, target));
    }
}

impl GateSink for Vec<Gate> {
    fn gate(&mut self, gate: Gate) {
        self.push(gate);
    }
}

/// A program lowered to gates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GateCircuit {
    /// The gates, in the order in which they run.
    pub gates: Vec<Gate>,
    /// The range of [`GateCircuit::gates`] of each instruction of the program.
    pub ranges: Vec<Range<usize>>,
    /// Number of qubits: the most that are in use at any time.
    pub qubits: u32,
    /// Number of qubits in use during each instruction of the program, its own ancillas included.
    pub in_use: Vec<u32>,
    /// Registers that hold a value before the first gate, and their qubits, bit 0 first. All other
    /// qubits are zero then.
    pub inputs: Vec<(RegisterId, Vec<Qubit>)>,
    /// Registers that hold a value after the last gate, and their qubits. All other qubits are zero
    /// then.
    pub outputs: Vec<(RegisterId, Vec<Qubit>)>,
    /// The classical parameters that loads read.
    pub parameters: Vec<Parameter>,
}
