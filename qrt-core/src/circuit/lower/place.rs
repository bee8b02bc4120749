//! Placing registers on qubits.

use super::super::{Circuit, Gate, Op, Program, Qubit, RegisterId};
use super::Lowering;

/// Qubits that nobody owns.
#[derive(Default)]
pub(super) struct Pool {
    free: Vec<Qubit>,
    made: u32,
    /// The most that have been in use since it was last set.
    pub(super) peak: u32,
}

impl Pool {
    /// A qubit that is zero.
    pub(super) fn take(&mut self) -> Qubit {
        let qubit = self.free.pop().unwrap_or_else(|| {
            self.made += 1;
            self.made - 1
        });
        self.peak = self.peak.max(self.in_use());
        qubit
    }

    /// Takes back a qubit, which is zero.
    pub(super) fn give(&mut self, qubit: Qubit) {
        self.free.push(qubit);
    }

    pub(super) fn in_use(&self) -> u32 {
        self.made - self.free.len() as u32
    }

    pub(super) fn made(&self) -> u32 {
        self.made
    }
}

impl Lowering {
    /// Gives a register qubits.
    pub(super) fn place(&mut self, register: RegisterId, width: u32) {
        if self.registers[register.index()].is_empty() {
            let qubits = (0..width).map(|_| self.pool.take()).collect();
            self.registers[register.index()] = qubits;
        }
    }

    fn displace(&mut self, register: RegisterId) {
        let qubits = std::mem::take(&mut self.registers[register.index()]);
        for qubit in qubits.into_iter().rev() {
            self.pool.give(qubit);
        }
    }

    fn held(&self, registers: &[RegisterId]) -> Vec<(RegisterId, Vec<Qubit>)> {
        let held = |id: &RegisterId| (*id, self.register(*id));
        registers.iter().map(held).collect()
    }
}

/// Width of the scratch register that `op` needs, given the widths of its other registers.
pub fn scratch_width(op: &Op, width: impl Fn(RegisterId) -> u32) -> u32 {
    if op.scratch().is_none() {
        return 0;
    }
    let (op, mut lowering) = alone(op, width);
    lowering.lower(&op);
    lowering.drawn as u32
}

/// An operation with its registers, other than its scratch, placed on qubits of its own.
pub(super) fn alone(op: &Op, width: impl Fn(RegisterId) -> u32) -> (Op, Lowering) {
    let mut lowering = Lowering::default();
    let mut op = op.clone();
    let scratch = op.scratch();
    let mut seen: Vec<RegisterId> = Vec::new();
    op.rename(|id, _| {
        let place = seen.iter().position(|known| known == id);
        let place = place.unwrap_or_else(|| {
            let width = if Some(*id) == scratch { 0 } else { width(*id) };
            let place = RegisterId(seen.len() as u32);
            seen.push(*id);
            lowering.registers.push(Vec::new());
            lowering.place(place, width);
            place.index()
        });
        *id = RegisterId(place as u32);
    });
    (op, lowering)
}

/// Lowers a program. Registers take qubits when they are computed, and leave them, zero, to others
/// when they are undone.
pub fn circuit(program: &Program) -> Circuit {
    let mut gates = Vec::new();
    let mut ranges = Vec::with_capacity(program.instructions.len());
    let walked = walk(program, |next| {
        let start = gates.len();
        gates.append(next);
        ranges.push(start..gates.len());
    });
    Circuit {
        gates,
        ranges,
        qubits: walked.lowering.pool.made(),
        in_use: walked.in_use,
        inputs: walked.inputs,
        outputs: walked.lowering.held(&program.outputs()),
        parameters: program.parameters.clone(),
    }
}

/// What [`circuit`] would be, without keeping its gates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// [`Circuit::qubits`]
    pub qubits: u32,
    /// [`Circuit::in_use`]
    pub in_use: Vec<u32>,
    /// [`depth`]
    pub depth: u64,
}

/// The size of a program's circuit, whose gates may be more than fit into memory.
pub fn size(program: &Program) -> Size {
    let mut clock = Clock::default();
    let walked = walk(program, |next| {
        next.drain(..).for_each(|gate| clock.gate(gate));
    });
    Size {
        qubits: walked.lowering.pool.made(),
        in_use: walked.in_use,
        depth: clock.latest(),
    }
}

/// What is left of a lowering when its gates have been handed out.
struct Walked {
    lowering: Lowering,
    inputs: Vec<(RegisterId, Vec<Qubit>)>,
    in_use: Vec<u32>,
}

/// Lowers a program, instruction by instruction; `take` empties the list of each one's gates.
fn walk(program: &Program, mut take: impl FnMut(&mut Vec<Gate>)) -> Walked {
    let mut lowering = Lowering {
        registers: vec![Vec::new(); program.registers.len()],
        ..Lowering::default()
    };
    for input in &program.inputs {
        lowering.place(*input, program.width(*input));
    }
    let inputs = lowering.held(&program.inputs);
    let mut in_use = Vec::with_capacity(program.instructions.len());
    for instruction in &program.instructions {
        let op = &program.ops[instruction.op as usize];
        let fresh = op.fresh();
        lowering.pool.peak = 0;
        for register in &fresh {
            lowering.place(*register, program.width(*register));
        }
        lowering.pool.peak = lowering.pool.peak.max(lowering.pool.in_use());
        let scratch = op.scratch().map(|id| lowering.register(id));
        lowering.scratch = Some(scratch.unwrap_or_default());
        lowering.lower(op);
        if instruction.inverse {
            lowering.gates.reverse();
            for register in fresh.iter().rev() {
                lowering.displace(*register);
            }
        }
        take(&mut lowering.gates);
        in_use.push(lowering.pool.peak);
    }
    Walked {
        lowering,
        inputs,
        in_use,
    }
}

/// Toffoli depth: each gate as early as its qubits allow, and only Toffolis take time.
pub fn depth(circuit: &Circuit) -> u64 {
    let mut clock = Clock::default();
    circuit.gates.iter().for_each(|&gate| clock.gate(gate));
    clock.latest()
}

/// By qubit: Toffolis that its content has to wait for.
#[derive(Default)]
struct Clock {
    times: Vec<u64>,
}

impl Clock {
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
