//! Placing registers on qubits.

use super::super::{Gate, GateCircuit, Op, Program, Qubit, RegisterId};
use super::Lowering;
use std::cell::RefCell;
use std::collections::HashMap;
use std::convert::Infallible;

/// The pool of free qubits, from which ancillas are allocated.
#[derive(Default)]
pub(super) struct Pool {
    idle: Vec<Qubit>,
    made: u32,
    /// Number of qubits that are allocated and not yet freed, and its maximum.
    lent: u32,
    most_lent: u32,
    /// The most qubits in use since this field was last set.
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

    /// Makes a new qubit, which has not been in use before.
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

    /// Returns the free qubits, in the order in which they were freed.
    pub(super) fn idle(&self) -> &[Qubit] {
        &self.idle
    }

    /// Number of qubits made.
    pub(super) fn made(&self) -> u32 {
        self.made
    }

    /// The most qubits allocated at a time, without those of registers that were placed before.
    pub(super) fn most_lent(&self) -> u32 {
        self.most_lent
    }

    pub(super) fn in_use(&self) -> u32 {
        self.made - self.idle.len() as u32
    }
}

impl Lowering {
    /// Creates a lowering with the program's inputs placed.
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

    /// Returns the registers that have qubits.
    fn held(&self) -> Vec<(RegisterId, Vec<Qubit>)> {
        let all = self.registers.iter().enumerate();
        all.filter(|(_, qubits)| !qubits.is_empty())
            .map(|(register, qubits)| (RegisterId(register as u32), qubits.clone()))
            .collect()
    }

    /// Emits an operation or its inverse, and returns the number of qubits in use meanwhile.
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

    /// Allocates the qubits of an operation's results, unless they are placed already.
    pub(super) fn place_fresh(&mut self, program: &Program, op: &Op) {
        for register in op.fresh() {
            self.place(register, program.width(register));
        }
    }

    /// Frees the qubits of an operation's results.
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

/// An operation whose registers are numbered in the order in which it names them, and their widths.
pub(super) type Shape = (Op, Box<[u32]>);

/// Number of registers from which a map finds them.
const SEARCHED: usize = 32;

/// Returns an operation whose registers are numbered in the order in which it names them, and their
/// widths. The width of its garbage register, which is still unknown, is 0.
pub(super) fn canonical(op: &Op, width: impl Fn(RegisterId) -> u32) -> Shape {
    let scratch = op.scratch();
    let (op, registers) = numbered(op);
    let width = |id: RegisterId| if Some(id) == scratch { 0 } else { width(id) };
    (op, registers.into_iter().map(width).collect())
}

/// Returns an operation whose registers are numbered in the order in which it names them, and those
/// registers.
pub(super) fn numbered(op: &Op) -> (Op, Vec<RegisterId>) {
    // Registers that are read and registers that are written share one numbering. Most operations name so
    // few that a search is quicker than a map.
    let known: RefCell<(Vec<RegisterId>, HashMap<RegisterId, usize>)> = RefCell::default();
    let number = |id: RegisterId| {
        let (ids, places) = &mut *known.borrow_mut();
        let found = if places.is_empty() {
            ids.iter().position(|known| *known == id)
        } else {
            places.get(&id).copied()
        };
        let place = found.unwrap_or_else(|| {
            ids.push(id);
            if ids.len() == SEARCHED {
                places.extend(ids.iter().enumerate().map(|(place, id)| (*id, place)));
            } else if ids.len() > SEARCHED {
                places.insert(id, ids.len() - 1);
            }
            ids.len() - 1
        });
        RegisterId(place as u32)
    };
    let op = op.clone().map(number, number);
    (op, known.into_inner().0)
}

/// Creates a lowering with registers of these `widths` on qubits of their own.
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

impl Program {
    /// Lowers the program to gates: [`circuit`]. If the gates exceed the memory, see
    /// [`each_instruction`].
    pub fn circuit(&self) -> GateCircuit {
        circuit(self)
    }
}

/// Lowers a program. A register's qubits are allocated when it is computed, and freed, zero again,
/// when it is undone.
pub fn circuit(program: &Program) -> GateCircuit {
    parts(program, &[]).into_iter().next().unwrap_or_default()
}

/// Lowers a program in parts that share their qubits. It is cut before the instructions `cuts`,
/// which ascend.
pub fn parts(program: &Program, cuts: &[usize]) -> Vec<GateCircuit> {
    let mut lowering = Lowering::on(program);
    let ends = cuts.iter().copied().chain([program.instructions.len()]);
    let mut parts = Vec::with_capacity(cuts.len() + 1);
    let mut begin = 0;
    for end in ends {
        let mut part = GateCircuit {
            inputs: lowering.held(),
            parameters: program.parameters.clone(),
            ..GateCircuit::default()
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

/// Lowers a program as [`parts`] does, but keeps only the gates of the parts between the first and
/// the last. The gates of these two may be too many to be kept.
///
/// Returns the parts, and the number of gates of the first and the last. The first part also has
/// its `outputs`; all parts have `qubits` and `parameters`. Nothing else is set.
pub fn parts_between(program: &Program, cuts: &[usize]) -> (Vec<GateCircuit>, usize) {
    let mut parts: Vec<GateCircuit> = vec![GateCircuit::default(); cuts.len() + 1];
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

/// Lowers a program instruction by instruction, and returns the number of qubits in all.
///
/// `each` receives the gates of an instruction, which are not kept, and the number of qubits in use
/// meanwhile.
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

/// Lowers a program as [`each_instruction`] does, until `each` fails.
///
/// # Errors
/// An error of `each`.
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
