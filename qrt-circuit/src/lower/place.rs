//! Placing registers on qubits.

use super::super::{Circuit, Gate, Op, Program, Qubit, RegisterId};
use super::Lowering;
use std::convert::Infallible;

/// The pool of qubits that nobody owns, and from which ancillas are allocated.
#[derive(Default)]
pub(super) struct Pool {
    idle: Vec<Qubit>,
    made: u32,
    /// The most qubits that have been in use since this was last set.
    pub(super) peak: u32,
}

impl Pool {
    /// Allocates a qubit, which is zero.
    pub(super) fn allocate(&mut self) -> Qubit {
        let qubit = self.idle.pop().unwrap_or_else(|| self.make());
        self.peak = self.peak.max(self.in_use());
        qubit
    }

    /// Makes a qubit that has not been in use before.
    pub(super) fn make(&mut self) -> Qubit {
        self.made += 1;
        self.peak = self.peak.max(self.in_use());
        self.made - 1
    }

    /// Frees a qubit, which is zero.
    pub(super) fn free(&mut self, qubit: Qubit) {
        self.idle.push(qubit);
    }

    /// How many qubits there are.
    pub(super) fn made(&self) -> u32 {
        self.made
    }

    pub(super) fn in_use(&self) -> u32 {
        self.made - self.idle.len() as u32
    }
}

impl Lowering {
    /// A lowering with the program's inputs placed.
    fn on(program: &Program) -> Self {
        let mut lowering = Self {
            registers: vec![Vec::new(); program.registers.len()],
            ..Self::default()
        };
        for input in &program.inputs {
            lowering.place(*input, program.width(*input));
        }
        lowering
    }

    /// Allocates the qubits of a register.
    pub(super) fn place(&mut self, register: RegisterId, width: u32) {
        if self.registers[register.index()].is_empty() {
            let qubits = (0..width).map(|_| self.pool.allocate()).collect();
            self.registers[register.index()] = qubits;
        }
    }

    fn displace(&mut self, register: RegisterId) {
        let qubits = std::mem::take(&mut self.registers[register.index()]);
        for qubit in qubits.into_iter().rev() {
            self.pool.free(qubit);
        }
    }

    /// Registers that have qubits.
    fn held(&self) -> Vec<(RegisterId, Vec<Qubit>)> {
        let all = self.registers.iter().enumerate();
        all.filter(|(_, qubits)| !qubits.is_empty())
            .map(|(register, qubits)| (RegisterId(register as u32), qubits.clone()))
            .collect()
    }

    /// Emits an operation or its inverse, and says how many qubits are in use meanwhile.
    fn instruction(&mut self, program: &Program, op: &Op, inverse: bool) -> u32 {
        let fresh = op.fresh();
        for register in &fresh {
            self.place(*register, program.width(*register));
        }
        self.pool.peak = self.pool.in_use();
        let scratch = op.scratch().map(|id| self.register(id));
        self.scratch = Some(scratch.unwrap_or_default());
        let start = self.gates.len();
        self.lower(op);
        if inverse {
            self.gates[start..].reverse();
            for register in fresh.iter().rev() {
                self.displace(*register);
            }
        }
        self.pool.peak
    }
}

/// Width in qubits of the garbage register that `op` needs, given the widths of its other
/// registers.
pub fn scratch_width(op: &Op, width: impl Fn(RegisterId) -> u32) -> u32 {
    if op.scratch().is_none() {
        return 0;
    }
    let (op, mut lowering) = alone(op, width);
    lowering.lower(&op);
    lowering.garbage.len() as u32
}

/// How many ancillas `op` borrows beyond its own registers, at most, given their widths.
pub(super) fn ancillas(op: &Op, width: impl Fn(RegisterId) -> u32) -> u32 {
    let (op, mut lowering) = placed(op, width);
    let scratch = op.scratch().map(|id| lowering.register(id));
    lowering.scratch = Some(scratch.unwrap_or_default());
    let own = lowering.pool.in_use();
    lowering.pool.peak = own;
    lowering.lower(&op);
    lowering.pool.peak - own
}

/// An operation with its registers, other than its garbage, placed on qubits of its own.
pub(super) fn alone(op: &Op, width: impl Fn(RegisterId) -> u32) -> (Op, Lowering) {
    let scratch = op.scratch();
    placed(op, |id| if Some(id) == scratch { 0 } else { width(id) })
}

/// An operation with its registers placed on qubits of its own.
fn placed(op: &Op, width: impl Fn(RegisterId) -> u32) -> (Op, Lowering) {
    let mut lowering = Lowering::default();
    let mut ids: Vec<RegisterId> = Vec::new();
    for id in op.reads().into_iter().chain(op.fresh()) {
        if !ids.contains(&id) {
            lowering.registers.push(Vec::new());
            lowering.place(RegisterId(ids.len() as u32), width(id));
            ids.push(id);
        }
    }
    let own = |id| {
        let place = ids.iter().position(|known| *known == id);
        RegisterId(place.unwrap_or_default() as u32)
    };
    let op = op.clone().map(own, own);
    (op, lowering)
}

/// Lowers a program. The qubits of a register are allocated when it is computed, and freed, zero
/// again, when it is undone.
pub fn circuit(program: &Program) -> Circuit {
    parts(program, &[]).into_iter().next().unwrap_or_default()
}

/// Lowers a program, cut before the instructions `cuts`, which ascend: parts that share their
/// qubits.
pub fn parts(program: &Program, cuts: &[usize]) -> Vec<Circuit> {
    let mut lowering = Lowering::on(program);
    let ends = cuts.iter().copied().chain([program.instructions.len()]);
    let mut parts = Vec::with_capacity(cuts.len() + 1);
    let mut begin = 0;
    for end in ends {
        let mut part = Circuit {
            inputs: lowering.held(),
            parameters: program.parameters.clone(),
            ..Circuit::default()
        };
        for instruction in &program.instructions[begin..end] {
            let op = &program.ops[instruction.op as usize];
            let start = lowering.gates.len();
            part.in_use
                .push(lowering.instruction(program, op, instruction.inverse));
            part.ranges.push(start..lowering.gates.len());
        }
        part.gates = std::mem::take(&mut lowering.gates);
        part.outputs = lowering.held();
        parts.push(part);
        begin = end;
    }
    for part in &mut parts {
        part.qubits = lowering.pool.made;
    }
    parts
}

/// The gates of the parts between the first and the last of those that [`parts`] makes, where these two are too
/// large to be kept. Their gates are counted; of the first there are its `outputs`, and of all parts `qubits` and
/// `parameters`, and nothing else.
pub fn parts_between(program: &Program, cuts: &[usize]) -> (Vec<Circuit>, usize) {
    let mut parts: Vec<Circuit> = vec![Circuit::default(); cuts.len() + 1];
    let mut lowering = Lowering::on(program);
    let mut left_out = 0;
    let mut computed = false;
    for (place, instruction) in program.instructions.iter().enumerate() {
        let number = cuts.partition_point(|cut| *cut <= place);
        if number >= 1 && !std::mem::replace(&mut computed, true) {
            parts[0].outputs = lowering.held();
        }
        let op = &program.ops[instruction.op as usize];
        lowering.instruction(program, op, instruction.inverse);
        if number == 0 || number == cuts.len() {
            left_out += lowering.gates.len();
            lowering.gates.clear();
        } else {
            parts[number].gates.append(&mut lowering.gates);
        }
    }
    for part in &mut parts {
        part.parameters.clone_from(&program.parameters);
        part.qubits = lowering.pool.made;
    }
    (parts, left_out)
}

/// Lowers a program instruction by instruction: `each` gets its gates, which are not kept, and how
/// many qubits are in use meanwhile. The number of qubits in all is returned.
pub fn each_instruction(program: &Program, mut each: impl FnMut(&[Gate], u32)) -> u32 {
    let every = try_each_instruction(program, |gates, in_use| {
        each(gates, in_use);
        Ok::<(), Infallible>(())
    });
    match every {
        Ok(qubits) => qubits,
        Err(never) => match never {},
    }
}

/// As [`each_instruction`], until `each` fails.
///
/// # Errors
/// That of `each`.
pub fn try_each_instruction<E>(
    program: &Program,
    mut each: impl FnMut(&[Gate], u32) -> Result<(), E>,
) -> Result<u32, E> {
    let mut lowering = Lowering::on(program);
    for instruction in &program.instructions {
        let op = &program.ops[instruction.op as usize];
        let in_use = lowering.instruction(program, op, instruction.inverse);
        each(&lowering.gates, in_use)?;
        lowering.gates.clear();
    }
    Ok(lowering.pool.made)
}
