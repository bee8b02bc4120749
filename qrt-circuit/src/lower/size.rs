//! Number of qubits and Toffoli depth of circuits.

use super::super::{Gate, GateCircuit, Op, Program, Qubit, Register, RegisterId};
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
    let mut held = HeldQubits::new(&program.registers, &program.inputs);
    for instruction in &program.instructions {
        let number = instruction.op as usize;
        held.step(&program.ops[number], instruction.inverse, borrowed(number));
    }
    held.most()
}

/// The qubits of registers that hold a value, counted while the steps of a program run.
///
/// ```
/// use qrt_circuit::lower::{HeldQubits, most_qubits};
/// use qrt_circuit::{Declaration, Machine, Recorder, Style, Type, Word};
///
/// let mut m = Recorder::new(Style::InPlace);
/// let x = m.input(&Declaration::work("x", Type::UInt, 3));
/// m.copy(&Declaration::work("copy", Type::UInt, 3), Word::unsigned(&x, 0, 3));
/// let program = m.finish();
/// let mut held = HeldQubits::new(&program.registers, &program.inputs);
/// held.step(&program.ops[0], false, 0);
/// assert_eq!(held.most(), most_qubits(&program));
/// ```
#[derive(Clone, Debug)]
pub struct HeldQubits<'a> {
    registers: &'a [Register],
    held: Vec<bool>,
    in_use: u32,
    most: u32,
}

impl<'a> HeldQubits<'a> {
    /// Begins with values in `inputs`, which are some of `registers`.
    pub fn new(registers: &'a [Register], inputs: &[RegisterId]) -> Self {
        let mut all = Self {
            registers,
            held: vec![false; registers.len()],
            in_use: 0,
            most: 0,
        };
        for input in inputs {
            all.hold(*input);
        }
        all.most = all.in_use;
        all
    }

    fn hold(&mut self, register: RegisterId) {
        let place = register.index();
        if !std::mem::replace(&mut self.held[place], true) {
            self.in_use += self.registers[place].width;
        }
    }

    fn free(&mut self, register: RegisterId) {
        let place = register.index();
        if std::mem::replace(&mut self.held[place], false) {
            self.in_use -= self.registers[place].width;
        }
    }

    /// Runs an operation, or its inverse, that borrows this number of qubits.
    pub fn step(&mut self, op: &Op, inverse: bool, borrowed: u32) {
        op.each_target(|register| self.hold(register));
        if let Some(register) = op.scratch() {
            self.hold(register);
        }
        self.most = self.most.max(self.in_use + borrowed);
        if inverse {
            op.each_target(|register| self.free(register));
            if let Some(register) = op.scratch() {
                self.free(register);
            }
        }
    }

    /// The most qubits in use so far.
    pub fn most(&self) -> u32 {
        self.most
    }
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
