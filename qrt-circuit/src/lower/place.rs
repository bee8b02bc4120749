//! Placing registers on qubits.

use super::super::{Circuit, Gate, Op, Program, Qubit, RegisterId};
use super::Lowering;
use super::figures::Shape;
use std::cell::RefCell;
use std::convert::Infallible;

/// The pool of qubits that nobody owns, and from which ancillas are allocated.
#[derive(Default)]
pub(super) struct Pool {
    idle: Vec<Qubit>,
    made: u32,
    /// Qubits that were allocated and not freed, and the most of them.
    lent: u32,
    most_lent: u32,
    /// The most qubits that have been in use since this was last set.
    pub(super) peak: u32,
}

impl Pool {
    /// Allocates a qubit, which is zero.
    pub(super) fn allocate(&mut self) -> Qubit {
        let qubit = self.idle.pop().unwrap_or_else(|| self.make());
        self.lent += 1;
        self.most_lent = self.most_lent.max(self.lent);
        self.peak = self.peak.max(self.in_use());
        qubit
    }

    /// Makes a qubit that has not been in use before.
    pub(super) fn make(&mut self) -> Qubit {
        self.made += 1;
        let in_use = self.in_use();
        if in_use > self.peak {
            self.peak = in_use;
        }
        self.made - 1
    }

    /// Frees a qubit, which is zero.
    pub(super) fn free(&mut self, qubit: Qubit) {
        self.lent -= 1;
        self.idle.push(qubit);
    }

    /// The qubits that are free, in the order in which they were freed.
    pub(super) fn idle(&self) -> &[Qubit] {
        &self.idle
    }

    /// How many qubits there are.
    pub(super) fn made(&self) -> u32 {
        self.made
    }

    /// The most qubits that were allocated at a time, beside those of registers that were placed
    /// before.
    pub(super) fn most_lent(&self) -> u32 {
        self.most_lent
    }

    pub(super) fn in_use(&self) -> u32 {
        self.made - self.idle.len() as u32
    }
}

impl Lowering {
    /// A lowering with the program's inputs placed.
    pub(super) fn on(program: &Program) -> Self {
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
        self.place_fresh(program, op);
        self.pool.peak = self.pool.in_use();
        let scratch = op.scratch().map(|id| self.register(id));
        self.scratch = Some(scratch.unwrap_or_default());
        let start = self.gates.len();
        self.lower(op);
        if inverse {
            self.gates[start..].reverse();
            self.displace_fresh(op);
        }
        self.pool.peak
    }

    /// Allocates the qubits of what an operation computes, as far as they are not there.
    pub(super) fn place_fresh(&mut self, program: &Program, op: &Op) {
        for register in op.fresh() {
            self.place(register, program.width(register));
        }
    }

    /// Frees them.
    pub(super) fn displace_fresh(&mut self, op: &Op) {
        for register in op.fresh().into_iter().rev() {
            self.displace(register);
        }
    }
}

/// Width in qubits of the garbage register that `op` needs, given the widths of its other
/// registers.
pub fn scratch_width(op: &Op, width: impl Fn(RegisterId) -> u32) -> u32 {
    if op.scratch().is_none() {
        return 0;
    }
    let (op, widths) = canonical(op, width);
    let mut lowering = placed(&widths);
    lowering.lower(&op);
    lowering.garbage.len() as u32
}

/// An operation on registers that are numbered in the order in which it names them, and the widths of
/// these; that of its garbage register, which is still to be found, is 0.
pub(super) fn canonical(op: &Op, width: impl Fn(RegisterId) -> u32) -> Shape {
    let scratch = op.scratch();
    let (op, registers) = numbered(op);
    let width = |id: RegisterId| if Some(id) == scratch { 0 } else { width(id) };
    (op, registers.into_iter().map(width).collect())
}

/// An operation on registers that are numbered in the order in which it names them, and these.
pub(super) fn numbered(op: &Op) -> (Op, Vec<RegisterId>) {
    // Shared by what is read and what is written.
    let known = RefCell::new(Vec::new());
    let number = |id: RegisterId| {
        let ids = &mut *known.borrow_mut();
        let place = ids.iter().position(|known| *known == id);
        let place = place.unwrap_or_else(|| {
            ids.push(id);
            ids.len() - 1
        });
        RegisterId(place as u32)
    };
    let op = op.clone().map(number, number);
    (op, known.into_inner())
}

/// A lowering with registers of these widths on qubits of their own.
pub(super) fn placed(widths: &[u32]) -> Lowering {
    let mut lowering = Lowering {
        registers: vec![Vec::new(); widths.len()],
        ..Lowering::default()
    };
    for (place, width) in widths.iter().enumerate() {
        lowering.place(RegisterId(place as u32), *width);
    }
    (lowering.pool.lent, lowering.pool.most_lent) = (0, 0);
    lowering
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
