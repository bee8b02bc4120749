//! Gates, and circuits of them.

use super::{Parameter, RegisterId};
use std::ops::Range;

/// The index of a qubit of a [`Circuit`].
pub type Qubit = u32;

/// A gate on basis states. All are their own inverses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gate {
    /// Flips a qubit.
    X(Qubit),
    /// Flips the second where the first holds.
    Cx(Qubit, Qubit),
    /// Flips the third where the first and the second hold: a Toffoli.
    Ccx(Qubit, Qubit, Qubit),
    /// Flips the qubit where bit `bit` of classical parameter `parameter` is set: an X, or nothing, in
    /// the circuit of a pixel.
    Load {
        /// The parameter's index in [`Circuit::parameters`].
        parameter: u32,
        /// The parameter's bit, 0 the least significant.
        bit: u32,
        /// The qubit that is flipped.
        target: Qubit,
    },
    /// Flips the phase where the qubit holds.
    Z(Qubit),
}

/// What receives gates one after another.
pub trait Gates {
    /// Receives the next gate.
    fn gate(&mut self, gate: Gate);

    /// Flips a qubit.
    #[inline(always)]
    fn x(&mut self, target: Qubit) {
        self.gate(Gate::X(target));
    }
    /// Flips `target` where `control` holds.
    #[inline(always)]
    fn cx(&mut self, control: Qubit, target: Qubit) {
        self.gate(Gate::Cx(control, target));
    }
    /// Flips `target` where both controls hold.
    #[inline(always)]
    fn ccx(&mut self, a: Qubit, b: Qubit, target: Qubit) {
        self.gate(Gate::Ccx(a, b, target));
    }
}

impl Gates for Vec<Gate> {
    fn gate(&mut self, gate: Gate) {
        self.push(gate);
    }
}

/// A program lowered to gates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Circuit {
    /// The gates, in the order in which they run.
    pub gates: Vec<Gate>,
    /// The range of [`Circuit::gates`] of each instruction of the program.
    pub ranges: Vec<Range<usize>>,
    /// How many qubits there are: the most that are in use at any time.
    pub qubits: u32,
    /// How many qubits are in use while each instruction of the program runs, its own ancillas
    /// included.
    pub in_use: Vec<u32>,
    /// Registers that hold something before the first gate, and their qubits, bit 0 first. All
    /// other qubits are zero then.
    pub inputs: Vec<(RegisterId, Vec<Qubit>)>,
    /// Registers that hold something after the last gate, and their qubits. All other qubits are
    /// zero then.
    pub outputs: Vec<(RegisterId, Vec<Qubit>)>,
    /// The classical parameters that loads read.
    pub parameters: Vec<Parameter>,
}
