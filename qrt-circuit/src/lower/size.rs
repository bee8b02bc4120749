//! Number of qubits and Toffoli depth of circuits.

use super::super::{Gate, GateCircuit, Program, Qubit};
#[cfg(doc)]
use super::cost::OpFigures;
use super::figures::KnownFigures;
use super::place::each_instruction;

/// The size of a program's circuit in qubits and in Toffoli depth.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// [`GateCircuit::qubits`]
    pub qubits: u32,
    /// [`GateCircuit::in_use`]
    pub in_use: Vec<u32>,
    /// [`depth`]
    pub depth: u64,
}

/// Returns the size of the circuit that [`super::circuit`] would return. It keeps no gates, so they
/// may exceed the memory.
pub fn size(program: &Program) -> Size {
    let mut clock = Clock::default();
    let mut in_use = Vec::with_capacity(program.instructions.len());
    let qubits = each_instruction(program, |gates, meanwhile| {
        clock.schedule(gates);
        in_use.push(meanwhile);
    });
    Size {
        qubits,
        in_use,
        depth: clock.latest(),
    }
}

/// Returns the number of qubits of [`size`] alone.
pub fn most_qubits(program: &Program) -> u32 {
    let mut known = KnownFigures::default();
    most_qubits_by(program, |op| {
        let op = &program.ops[op];
        known
            .figures(op, |register| program.width(register))
            .borrowed
    })
}

/// Returns [`most_qubits`], given the number of qubits that each operation borrows, by its index:
/// [`OpFigures::borrowed`].
pub fn most_qubits_by(program: &Program, mut borrowed: impl FnMut(usize) -> u32) -> u32 {
    let mut held = vec![false; program.registers.len()];
    let (mut in_use, mut most) = (0, 0);
    for input in &program.inputs {
        if !std::mem::replace(&mut held[input.index()], true) {
            in_use += program.width(*input);
        }
    }
    most = most.max(in_use);
    for instruction in &program.instructions {
        let number = instruction.op as usize;
        let fresh = program.ops[number].fresh();
        for register in &fresh {
            if !std::mem::replace(&mut held[register.index()], true) {
                in_use += program.width(*register);
            }
        }
        most = most.max(in_use + borrowed(number));
        if instruction.inverse {
            for register in &fresh {
                if std::mem::replace(&mut held[register.index()], false) {
                    in_use -= program.width(*register);
                }
            }
        }
    }
    most
}

/// The Toffoli depth of a circuit: each gate runs as early as its qubits allow, and only Toffolis
/// take time.
pub fn depth(circuit: &GateCircuit) -> u64 {
    let mut clock = Clock::default();
    clock.schedule(&circuit.gates);
    clock.latest()
}

/// For each qubit, the Toffoli depth at which its content is ready.
#[derive(Default)]
struct Clock {
    times: Vec<u64>,
}

impl Clock {
    fn schedule(&mut self, gates: &[Gate]) {
        for &gate in gates {
            self.gate(gate);
        }
    }

    fn gate(&mut self, gate: Gate) {
        match gate {
            Gate::X(_) | Gate::Load { .. } | Gate::Z(_) => {}
            Gate::Cx(a, b) => {
                let time = self.time(a).max(self.time(b));
                self.set(&[a, b], time);
            }
            Gate::Ccx(a, b, c) => {
                let time = 1 + self.time(a).max(self.time(b)).max(self.time(c));
                self.set(&[a, b, c], time);
            }
        }
    }

    fn time(&self, qubit: Qubit) -> u64 {
        self.times.get(qubit as usize).copied().unwrap_or(0)
    }

    fn set(&mut self, qubits: &[Qubit], time: u64) {
        for &qubit in qubits {
            let place = qubit as usize;
            if place >= self.times.len() {
                self.times.resize(place + 1, 0);
            }
            self.times[place] = time;
        }
    }

    fn latest(&self) -> u64 {
        self.times.iter().copied().max().unwrap_or(0)
    }
}
