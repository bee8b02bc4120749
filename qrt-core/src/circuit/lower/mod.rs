//! Operations as gates: X, CNOT and Toffoli, without measurement.
//!
//! Every operation is lowered forward; its inverse is the same list backwards, for every gate is
//! its own inverse. Qubits come from a pool: a register's from the instruction that computes it to
//! the one that undoes it, an ancilla's for the length of an operation.

mod adder;
mod divide;
mod multiply;
mod table;
#[cfg(test)]
mod tests;
mod wires;

use super::{Bit, Circuit, Gate, Op, Operand, Program, Qubit, RegisterId, When, Word};
use multiply::Product;
use std::ops::Range;
use wires::{Bit as Wire, ONE, Wires, ZERO, bit_at};

/// What an operation costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Toffolis, without measurement.
    pub toffoli: u64,
    /// ANDs, where they may be undone by measurement (Gidney 2018).
    pub and_measured: u64,
    /// CNOTs.
    pub cnot: u64,
    /// Xs; those that load a classical bit are counted as if it were set.
    pub x: u64,
}

impl std::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.toffoli += other.toffoli;
        self.and_measured += other.and_measured;
        self.cnot += other.cnot;
        self.x += other.x;
    }
}

/// The qubits of registers, while an operation is lowered.
trait Places {
    fn of(&self, register: RegisterId) -> Vec<Qubit>;
}

/// Qubits that stand for registers whose places do not matter.
struct Counted<F>(F);

impl<F: Fn(RegisterId) -> u32> Places for Counted<F> {
    fn of(&self, register: RegisterId) -> Vec<Qubit> {
        let first = register.0.wrapping_mul(64) & 0x3fff_ffff;
        (first..first + (self.0)(register)).collect()
    }
}

/// Width of the scratch register that an operation needs; `width` tells its targets'.
pub fn scratch_width(op: &Op, width: impl Fn(RegisterId) -> u32) -> u32 {
    let mut ancilla = 1 << 30;
    let mut next = || {
        ancilla += 1;
        ancilla
    };
    let mut wires = Wires::new(&[], &mut next);
    forward(op, &Counted(width), &mut wires);
    wires.taken() as u32
}

/// The number of low address bits that makes a table cheapest: see [`Op::Table`].
pub fn best_low(address: u32, columns: &[Box<[i64]>]) -> u32 {
    table::best(address, columns)
}

/// What an operation, or its inverse, costs.
pub fn cost(op: &Op, inverse: bool, width: impl Fn(RegisterId) -> u32) -> Cost {
    let mut ancilla = 1 << 30;
    let mut next = || {
        ancilla += 1;
        ancilla
    };
    let mut wires = Wires::new(&[], &mut next);
    forward(op, &Counted(width), &mut wires);
    let returned = wires.returned;
    let mut cost = Cost::default();
    for gate in &wires.gates {
        match gate {
            Gate::Ccx(..) => cost.toffoli += 1,
            Gate::Cx(..) => cost.cnot += 1,
            Gate::X(_) | Gate::Load { .. } => cost.x += 1,
            Gate::Z(_) => {}
        }
    }
    let in_place = op.targets().is_empty();
    cost.and_measured = if inverse && !in_place {
        // What was computed out of place is measured away; what is computed and returned on the
        // way is computed again.
        returned
    } else {
        cost.toffoli - returned
    };
    cost
}

/// What each instruction of a program costs.
pub fn tally(program: &Program) -> Vec<Cost> {
    let mut known: Vec<[Option<Cost>; 2]> = vec![[None; 2]; program.ops.len()];
    let steps = program.instructions.iter();
    steps
        .map(|step| {
            let slot = &mut known[step.op as usize][usize::from(step.inverse)];
            *slot.get_or_insert_with(|| {
                let op = &program.ops[step.op as usize];
                cost(op, step.inverse, |register| program.width(register))
            })
        })
        .collect()
}

/// Toffolis one after another on the longest way through a circuit.
pub fn depth(circuit: &Circuit) -> u64 {
    let mut reached = vec![0_u64; circuit.qubits as usize];
    for gate in &circuit.gates {
        match *gate {
            Gate::Cx(control, target) => {
                let both = reached[control as usize].max(reached[target as usize]);
                reached[control as usize] = both;
                reached[target as usize] = both;
            }
            Gate::Ccx(a, b, target) => {
                let all = [a, b, target].map(|qubit| reached[qubit as usize]);
                let after = all[0].max(all[1]).max(all[2]) + 1;
                for qubit in [a, b, target] {
                    reached[qubit as usize] = after;
                }
            }
            Gate::X(_) | Gate::Load { .. } | Gate::Z(_) => {}
        }
    }
    reached.into_iter().max().unwrap_or(0)
}

/// The circuit of a program.
pub fn circuit(program: &Program) -> Circuit {
    parts(program, &[]).into_iter().next().unwrap_or_default()
}

/// The circuit of a program, cut before the instructions `cuts`: parts that share their qubits.
pub fn parts(program: &Program, cuts: &[usize]) -> Vec<Circuit> {
    let mut pool = Pool::default();
    let mut places = Placed(vec![Vec::new(); program.registers.len()]);
    for &input in &program.inputs {
        places.0[input.index()] = pool.take(program.width(input));
    }
    let mut ends = cuts.to_vec();
    ends.push(program.instructions.len());
    let mut circuits = Vec::new();
    let mut start = 0;
    for end in ends {
        let mut part = Circuit {
            inputs: places.held(),
            parameters: program.parameters.clone(),
            ..Circuit::default()
        };
        for step in &program.instructions[start..end] {
            let op = &program.ops[step.op as usize];
            lower(program, op, step.inverse, &mut places, &mut pool, &mut part);
        }
        part.outputs = places.held();
        circuits.push(part);
        start = end;
    }
    for part in &mut circuits {
        part.qubits = pool.made;
    }
    circuits
}

fn lower(
    program: &Program,
    op: &Op,
    inverse: bool,
    places: &mut Placed,
    pool: &mut Pool,
    part: &mut Circuit,
) {
    let fresh = op.fresh();
    if !inverse {
        for &register in &fresh {
            places.0[register.index()] = pool.take(program.width(register));
        }
    }
    let scratch = op.scratch().map_or_else(Vec::new, |s| places.of(s));
    let in_use = pool.in_use();
    let mut lent = 0;
    let mut next = || {
        lent += 1;
        pool.one()
    };
    let mut wires = Wires::new(&scratch, &mut next);
    forward(op, places, &mut wires);
    let (gates, borrowed) = wires.lent();
    let start = part.gates.len();
    if inverse {
        part.gates.extend(gates.into_iter().rev());
    } else {
        part.gates.extend(gates);
    }
    part.ranges.push(start..part.gates.len());
    part.in_use.push(in_use + lent);
    pool.give_back(borrowed);
    if inverse {
        for register in fresh {
            let qubits = std::mem::take(&mut places.0[register.index()]);
            pool.give_back(qubits);
        }
    }
}

/// By register: its qubits, none where it is not computed.
struct Placed(Vec<Vec<Qubit>>);

impl Places for Placed {
    fn of(&self, register: RegisterId) -> Vec<Qubit> {
        self.0[register.index()].clone()
    }
}

impl Placed {
    fn held(&self) -> Vec<(RegisterId, Vec<Qubit>)> {
        let all = self.0.iter().enumerate();
        all.filter(|(_, qubits)| !qubits.is_empty())
            .map(|(register, qubits)| (RegisterId(register as u32), qubits.clone()))
            .collect()
    }
}

/// Qubits that are zero and nobody's.
#[derive(Default)]
struct Pool {
    free: Vec<Qubit>,
    made: u32,
}

impl Pool {
    fn one(&mut self) -> Qubit {
        self.free.pop().unwrap_or_else(|| {
            self.made += 1;
            self.made - 1
        })
    }

    fn take(&mut self, count: u32) -> Vec<Qubit> {
        (0..count).map(|_| self.one()).collect()
    }

    fn give_back(&mut self, qubits: Vec<Qubit>) {
        self.free.extend(qubits.into_iter().rev());
    }

    fn in_use(&self) -> u32 {
        self.made - self.free.len() as u32
    }
}

fn word(word: Word, places: &dyn Places) -> Vec<Wire> {
    let qubits = places.of(word.register);
    let range = word.offset as usize..(word.offset + word.width) as usize;
    let mut bits = vec![ZERO; word.shift as usize];
    bits.extend(qubits[range].iter().map(|&qubit| Wire::of(qubit)));
    if !word.signed {
        bits.push(ZERO);
    }
    bits
}

/// A number's bits, the last one its sign or a zero.
fn operand(operand: Operand, places: &dyn Places) -> Vec<Wire> {
    match operand {
        Operand::Word(w) => word(w, places),
        Operand::Constant(value) => {
            let bits = 65 - (if value < 0 { !value } else { value }).leading_zeros();
            (0..bits)
                .map(|place| Wire::Constant(value >> place.min(63) & 1 == 1))
                .collect()
        }
    }
}

fn bit(bit: Bit, places: &dyn Places) -> Wire {
    Wire::of(places.of(bit.register)[bit.index as usize]).xor(bit.inverted)
}

fn without_sign(mut bits: Vec<Wire>) -> Vec<Wire> {
    if bits.last() == Some(&ZERO) {
        bits.pop();
    }
    bits
}

/// The gates of an operation.
fn forward(op: &Op, places: &dyn Places, wires: &mut Wires<'_>) {
    match op {
        Op::Copy { a, target } => wires.copy(&word(*a, places), &places.of(*target)),
        Op::Load { parameter, target } => load(*parameter, &places.of(*target), wires),
        Op::Parity {
            source,
            columns,
            parameter,
            target,
        } => {
            let (source, target) = (places.of(*source), places.of(*target));
            if let Some(parameter) = parameter {
                load(*parameter, &target, wires);
            }
            for (column, &control) in columns.iter().zip(&source) {
                for (place, &qubit) in target.iter().enumerate() {
                    if column >> place & 1 == 1 {
                        wires.cx(control, qubit);
                    }
                }
            }
        }
        Op::And { a, b, target } => {
            let (a, b) = (bit(*a, places), bit(*b, places));
            wires.and(a, b, places.of(*target)[0]);
        }
        Op::Xor { a, b, target } => {
            let target = places.of(*target)[0];
            wires.add_bit(bit(*a, places), target);
            wires.add_bit(bit(*b, places), target);
        }
        Op::Add {
            a,
            b,
            subtract,
            target,
        } => {
            let (a, b) = (operand(*a, places), operand(*b, places));
            let minus = Wire::Constant(*subtract);
            wires.sum(&a, &b, minus, minus, &places.of(*target));
        }
        Op::Negate { a, when, target } => {
            let when = bit(*when, places);
            wires.sum(&[ZERO], &word(*a, places), when, when, &places.of(*target));
        }
        Op::Select { when, a, b, target } => {
            let (a, b) = (operand(*a, places), operand(*b, places));
            select(bit(*when, places), &a, &b, &places.of(*target), wires);
        }
        Op::Less { a, b, target } => {
            let (a, b) = (operand(*a, places), operand(*b, places));
            wires.less(&a, &b, places.of(*target)[0]);
        }
        Op::Multiply {
            a,
            b,
            drop,
            style,
            target,
            ..
        } => {
            let product = Product {
                drop: *drop as usize,
                target: &places.of(*target),
            };
            wires.product(&word(*a, places), &word(*b, places), *style, &product);
        }
        Op::Square {
            a,
            drop,
            style,
            target,
            ..
        } => {
            let product = Product {
                drop: *drop as usize,
                target: &places.of(*target),
            };
            wires.square(&word(*a, places), *style, &product);
        }
        Op::Scale {
            a,
            factor,
            drop,
            style,
            target,
            ..
        } => {
            let product = Product {
                drop: *drop as usize,
                target: &places.of(*target),
            };
            wires.scale(&word(*a, places), *factor, *style, &product);
        }
        Op::Divide {
            a,
            b,
            style,
            quotient,
            fits,
            ..
        } => {
            let a = without_sign(word(*a, places));
            let b = without_sign(word(*b, places));
            let (quotient, fits) = (places.of(*quotient), places.of(*fits));
            wires.divide(&a, &b, *style, &quotient, fits[0]);
        }
        Op::SquareRoot { a, target, .. } => {
            wires.root(&without_sign(word(*a, places)), &places.of(*target));
        }
        Op::Table {
            address,
            columns,
            low,
            targets,
            ..
        } => {
            let address: Vec<Wire> = address.iter().map(|&b| bit(b, places)).collect();
            let targets: Vec<Vec<Qubit>> = targets.iter().map(|&t| places.of(t)).collect();
            wires.table(&address, columns, *low as usize, &targets);
        }
        Op::XorInto { a, when, target } => {
            let a = operand(*a, places);
            let when = when.map_or(ONE, |when| bit(when, places));
            for (place, &qubit) in places.of(*target).iter().enumerate() {
                wires.and(when, bit_at(&a, place), qubit);
            }
        }
        Op::AddInto {
            a,
            subtract,
            when,
            target,
        } => {
            let minus = Wire::Constant(*subtract);
            let (turn, gate) = match when {
                When::Always => (minus, ONE),
                When::If(when) => (minus, bit(*when, places)),
                When::Reversed(when) => (bit(*when, places).xor(*subtract), ONE),
            };
            let a = operand(*a, places);
            wires.sum_into(&a, turn, turn, gate, &places.of(*target));
        }
        Op::Swap { a, b, when } => {
            let when = when.map_or(ONE, |when| bit(when, places));
            for (&p, &q) in places.of(*a).iter().zip(&places.of(*b)) {
                wires.cx(q, p);
                wires.and(when, Wire::of(p), q);
                wires.cx(q, p);
            }
        }
        Op::Phase { bit: b } => {
            if let Wire::Qubit { qubit, inverted } = bit(*b, places) {
                let turns = 0..usize::from(inverted);
                turns.clone().for_each(|_| wires.x(qubit));
                wires.gates.push(Gate::Z(qubit));
                turns.for_each(|_| wires.x(qubit));
            }
        }
    }
}

fn load(parameter: u32, target: &[Qubit], wires: &mut Wires<'_>) {
    let bits: Range<u32> = 0..target.len() as u32;
    for (bit, &target) in bits.zip(target) {
        wires.gates.push(Gate::Load {
            parameter,
            bit,
            target,
        });
    }
}

/// `t = b ^ when (a ^ b)`, bit by bit.
fn select(when: Wire, a: &[Wire], b: &[Wire], t: &[Qubit], wires: &mut Wires<'_>) {
    // Where the condition is one of the bits, that bit is known on its side.
    let known = |bit: Wire, holds: bool| {
        if bit.qubit().is_some() && bit.qubit() == when.qubit() {
            Wire::Constant((bit == when) == holds)
        } else {
            bit
        }
    };
    for (place, &target) in t.iter().enumerate() {
        let p = known(bit_at(a, place), true);
        let q = known(bit_at(b, place), false);
        wires.add_bit(q, target);
        match (p, q) {
            _ if p == q => {}
            (p, Wire::Constant(value)) => wires.and(when, p.xor(value), target),
            (Wire::Constant(value), q) => wires.and(when, q.xor(value), target),
            (
                Wire::Qubit { qubit, inverted },
                Wire::Qubit {
                    qubit: other,
                    inverted: i,
                },
            ) => {
                if qubit == other {
                    // Opposites.
                    wires.add_bit(when, target);
                } else {
                    wires.cx(qubit, other);
                    wires.and(when, Wire::of(other).xor(inverted != i), target);
                    wires.cx(qubit, other);
                }
            }
        }
    }
}
