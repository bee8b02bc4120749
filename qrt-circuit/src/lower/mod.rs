//! Lowering of operations to X, CNOT and Toffoli, and its costs.
//!
//! All gates are their own inverses, so an inverse is the reversed list. Nothing is measured.
//!
//! # Wires
//!
//! An operation's operands become lists of wires. A wire is a qubit, its negation, or a constant.
//! Shifts, zeros above and sign extension cost nothing. A value that follows from the wires alone
//! costs no gate: a carry of two equal bits is that bit. Two operands may share qubits.
//!
//! # Ancillas
//!
//! Garbage bits come from the operation's garbage register, in the order in which the lowering
//! allocates them. The same lowering, run on an unlimited supply, yields the number of qubits of
//! that register. Bits that are returned to zero within the operation are borrowed from the free
//! qubits.
//!
//! # Counts
//!
//! [`cost`] counts the gates that the lowering emits. Tests compare these counts with the published
//! formulas. If measurement undoes the ANDs into clean bits (Gidney, *Halving the cost of quantum
//! addition*, 2018), `and_measured` of them remain.

mod adder;
mod choose;
mod cost;
mod divide;
mod encode;
mod figures;
mod ghosts;
mod multiply;
mod place;
mod root;
mod scale;
mod size;
mod square;
mod table;
mod template;
#[cfg(test)]
mod tests;
mod walk;
mod wire;

pub use cost::{Cost, OpFigures, cost, costs};
pub use figures::{KnownFigures, tally, toffoli};
#[doc(hidden)]
pub use figures::{Quick, QuickMap};
pub use ghosts::{steps_with_ghosts, with_ghosts};
pub use place::{
    circuit, each_instruction, parts, parts_between, scratch_width, try_each_instruction,
};
pub use scale::least_toffoli;
pub use size::{HeldQubits, Size, depth, most_qubits, most_qubits_by, size};
pub use table::best_low;
pub use template::{Templates, try_each_template};

use super::{Bit, Gate, GateSink, Op, Operand, Qubit, RegisterId, Style, When, Word};
use place::Pool;
use wire::Wire;

/// Lowers operations, one after another, onto qubits that have been placed.
#[derive(Default)]
struct Lowering {
    /// The gates that have been emitted.
    gates: Vec<Gate>,
    /// The free qubits.
    pool: Pool,
    /// The qubits of each register; empty if it has none.
    registers: Vec<Vec<Qubit>>,
    /// The allocated bits of the current operation's garbage register.
    garbage: Vec<Qubit>,
    /// Indices of the gates that compute a carry in the place of a qubit that holds a value, and of
    /// the gates that uncompute the carry afterwards.
    carried: Vec<usize>,
    /// The current operation's garbage register; `None` if bits are made on demand.
    scratch: Option<Vec<Qubit>>,
    /// The plans of tables.
    plans: table::Plans,
}

impl GateSink for Lowering {
    #[inline(always)]
    fn gate(&mut self, gate: Gate) {
        self.gates.push(gate);
    }
}

impl Lowering {
    fn register(&self, id: RegisterId) -> Vec<Qubit> {
        self.registers[id.index()].clone()
    }

    /// Returns the lowest `bits` bits of a word.
    fn word(&self, word: Word, bits: usize) -> Vec<Wire> {
        let register = &self.registers[word.register.index()];
        let (shift, offset) = (word.shift as usize, word.offset as usize);
        let own = &register[offset..offset + word.width as usize];
        let top = own[own.len() - 1];
        let above = if word.signed {
            Wire::qubit(top)
        } else {
            Wire::ZERO
        };
        let mut wires = vec![Wire::ZERO; shift.min(bits)];
        for qubit in &own[..(bits - wires.len()).min(own.len())] {
            wires.push(Wire::qubit(*qubit));
        }
        wires.resize(bits, above);
        wires
    }

    fn operand(&self, operand: Operand, bits: usize) -> Vec<Wire> {
        match operand {
            Operand::Word(word) => self.word(word, bits),
            Operand::Constant(value) => constant(value, bits),
        }
    }

    fn bit(&self, bit: Bit) -> Wire {
        let qubit = self.registers[bit.register.index()][bit.index as usize];
        Wire::qubit(qubit).xor(bit.inverted)
    }

    /// Allocates the next garbage bit.
    fn garbage_bit(&mut self) -> Qubit {
        let next = self.garbage.len();
        let qubit = match &self.scratch {
            Some(scratch) if next < scratch.len() => scratch[next],
            _ => self.pool.make(),
        };
        self.garbage.push(qubit);
        qubit
    }

    fn allocate_garbage(&mut self, bits: usize) -> Vec<Qubit> {
        let mut qubits = Vec::with_capacity(bits);
        // A plain loop: in unoptimised code, as in a macro, an iterator takes longer.
        while qubits.len() < bits {
            qubits.push(self.garbage_bit());
        }
        qubits
    }

    /// Emits the gates from `start` to `end` again, in reverse order.
    fn undo(&mut self, start: usize, end: usize) {
        self.gates.reserve(end - start);
        for place in (start..end).rev() {
            let gate = self.gates[place];
            self.gates.push(gate);
        }
    }

    /// Copies wires into borrowed bits, if their qubits are among `others` or earlier in `wires`.
    /// [`Self::attach`] returns these bits.
    fn detach(&mut self, wires: &mut [Wire], others: &[Wire]) -> Vec<(Wire, Qubit)> {
        let mut copies = Vec::new();
        for place in 0..wires.len() {
            let wire = wires[place];
            let mut taken = others.iter().chain(&wires[..place]);
            if wire.source().is_some() && taken.any(|other| other.source() == wire.source()) {
                let copy = self.pool.allocate();
                self.copy(wire, copy);
                wires[place] = Wire::qubit(copy);
                copies.push((wire, copy));
            }
        }
        copies
    }

    fn attach(&mut self, copies: Vec<(Wire, Qubit)>) {
        for (wire, copy) in copies.into_iter().rev() {
            self.copy(wire, copy);
            self.pool.free(copy);
        }
    }

    /// Emits an operation. The registers of its results have been placed.
    fn lower(&mut self, op: &Op) {
        self.garbage.clear();
        self.carried.clear();
        match op {
            Op::Copy { a, target } => {
                let target = self.register(*target);
                let a = self.word(*a, target.len());
                self.copies(&a, &target);
            }
            Op::Load { parameter, target } => self.load(*parameter, &self.register(*target)),
            Op::Parity {
                source,
                columns,
                parameter,
                target,
            } => {
                let (source, target) = (self.register(*source), self.register(*target));
                if let Some(parameter) = parameter {
                    self.load(*parameter, &target);
                }
                for (bit, column) in source.iter().zip(columns.iter()) {
                    for (place, t) in target.iter().enumerate() {
                        if column.checked_shr(place as u32).unwrap_or(0) & 1 == 1 {
                            self.cx(*bit, *t);
                        }
                    }
                }
            }
            Op::And { a, b, target } => {
                let t = self.register(*target)[0];
                self.and(self.bit(*a), self.bit(*b), t);
            }
            Op::Xor { a, b, target } => {
                let t = self.register(*target)[0];
                let (a, b) = (self.bit(*a), self.bit(*b));
                self.copy_two(a, b, t);
            }
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => {
                let target = self.register(*target);
                let a = self.operand(*a, target.len());
                let mut b = self.operand(*b, target.len());
                invert(&mut b, *subtract);
                self.add(&a, &b, Wire::constant(*subtract), &target);
            }
            Op::Negate { a, when, target } => {
                let target = self.register(*target);
                let a = self.word(*a, target.len());
                self.negate(&a, self.bit(*when), &target);
            }
            Op::Select { when, a, b, target } => {
                let target = self.register(*target);
                let a = self.operand(*a, target.len());
                let b = self.operand(*b, target.len());
                self.select(self.bit(*when), &a, &b, &target);
            }
            Op::Less { a, b, target } => {
                let (a, b) = self.compared(*a, *b);
                let target = self.register(*target)[0];
                self.less(&a, &b, target, false);
            }
            Op::Multiply {
                a,
                b,
                drop,
                style,
                target,
                ..
            } => self.multiply(*a, *b, *drop, *style, &self.register(*target)),
            Op::Square {
                a,
                drop,
                style,
                target,
                ..
            } => self.square(*a, *drop, *style, &self.register(*target)),
            Op::Scale {
                a,
                factor,
                drop,
                style,
                target,
                ..
            } => self.scale(*a, *factor, *drop, *style, &self.register(*target)),
            Op::Multiples {
                a,
                products,
                targets,
                ..
            } => {
                let targets: Vec<_> = targets.iter().map(|id| self.register(*id)).collect();
                self.multiples(*a, products, &targets);
            }
            Op::Divide {
                a,
                b,
                style,
                quotient,
                fits,
                ..
            } => {
                let (quotient, fits) = (self.register(*quotient), self.register(*fits)[0]);
                self.divide(*a, *b, *style, &quotient, fits);
            }
            Op::SquareRoot {
                a, style, target, ..
            } => self.root(*a, *style, &self.register(*target)),
            Op::Table {
                address,
                columns,
                low,
                style,
                targets,
                ..
            } => {
                let targets: Vec<_> = targets.iter().map(|id| self.register(*id)).collect();
                let address: Vec<_> = address.iter().map(|bit| self.bit(*bit)).collect();
                match style {
                    Style::OutOfPlace => self.table(address, columns, *low, &targets),
                    Style::InPlace => self.walk(address, columns, &targets),
                }
            }
            Op::Encode {
                bits,
                entries,
                targets,
                ..
            } => {
                let targets: Vec<_> = targets.iter().map(|id| self.register(*id)).collect();
                let bits: Vec<_> = bits.iter().map(|bit| self.bit(*bit)).collect();
                self.encode(&bits, entries, &targets);
            }
            Op::XorInto { a, when, target } => {
                let target = self.register(*target);
                let a = self.operand(*a, target.len());
                match when {
                    None => self.copies(&a, &target),
                    Some(when) => self.xor_into(&a, self.bit(*when), &target),
                }
            }
            Op::AddInto {
                a,
                subtract,
                when,
                target,
            } => self.add_into_when(*a, *subtract, *when, &self.register(*target)),
            Op::Swap { a, b, when } => {
                let (a, b) = (self.register(*a), self.register(*b));
                let when = when.map_or(Wire::ONE, |bit| self.bit(bit));
                for (a, b) in a.into_iter().zip(b) {
                    self.cx(b, a);
                    self.and(when, Wire::qubit(a), b);
                    self.cx(b, a);
                }
            }
            Op::Phase { bit } => {
                let bit = self.bit(*bit);
                if let Some(qubit) = bit.source() {
                    self.flip(bit, qubit);
                    self.gate(Gate::Z(qubit));
                    self.flip(bit, qubit);
                }
            }
        }
    }

    fn load(&mut self, parameter: u32, target: &[Qubit]) {
        for (bit, target) in target.iter().enumerate() {
            self.gate(Gate::Load {
                parameter,
                bit: bit as u32,
                target: *target,
            });
        }
    }

    fn add_into_when(&mut self, a: Operand, subtract: bool, when: When, target: &[Qubit]) {
        let (a, sign, control) = self.addend(a, subtract, when, target.len());
        self.flips(sign, target);
        let mut control = [control];
        let copies = self.detach(&mut control, &a);
        self.add_into(&a, false, control[0], target);
        self.attach(copies);
        self.flips(sign, target);
    }

    /// Returns the addend of an in-place addition, the wire on which it is subtracted, and the wire
    /// that controls the addition.
    fn addend(
        &self,
        a: Operand,
        subtract: bool,
        when: When,
        bits: usize,
    ) -> (Vec<Wire>, Wire, Wire) {
        match (a, when) {
            (Operand::Constant(value), When::Always) => {
                let value = if subtract {
                    value.wrapping_neg()
                } else {
                    value
                };
                (constant(value, bits), Wire::ZERO, Wire::ONE)
            }
            (Operand::Constant(value), When::If(bit)) => {
                let value = if subtract {
                    value.wrapping_neg()
                } else {
                    value
                };
                let bit = self.bit(bit);
                let some = |wire: Wire| if wire == Wire::ONE { bit } else { wire };
                let a = constant(value, bits).into_iter().map(some).collect();
                (a, Wire::ZERO, Wire::ONE)
            }
            (a, When::Reversed(bit)) => {
                let sign = self.bit(bit).xor(subtract);
                (self.operand(a, bits), sign, Wire::ONE)
            }
            (a, When::Always) => (self.operand(a, bits), Wire::constant(subtract), Wire::ONE),
            (a, When::If(bit)) => {
                let sign = Wire::constant(subtract);
                (self.operand(a, bits), sign, self.bit(bit))
            }
        }
    }

    /// Converts two operands to unsigned numbers of the same width; their order is preserved.
    fn compared(&self, a: Operand, b: Operand) -> (Vec<Wire>, Vec<Wire>) {
        let ([a_bits, a_signed], [b_bits, b_signed]) = (extent(a), extent(b));
        let signed = a_signed + b_signed > 0;
        let bits = if signed {
            (a_bits + 1 - a_signed).max(b_bits + 1 - b_signed)
        } else {
            a_bits.max(b_bits)
        };
        let (mut a, mut b) = (self.operand(a, bits), self.operand(b, bits));
        if signed {
            a[bits - 1] = a[bits - 1].xor(true);
            b[bits - 1] = b[bits - 1].xor(true);
        }
        (a, b)
    }
}

/// Returns the number of bits of an operand, and 1 if the top one is a sign.
fn extent(operand: Operand) -> [usize; 2] {
    match operand {
        Operand::Word(word) => [word.bits() as usize, usize::from(word.signed)],
        Operand::Constant(value) if value < 0 => [65 - value.leading_ones() as usize, 1],
        Operand::Constant(value) => [(64 - value.leading_zeros() as usize).max(1), 0],
    }
}

fn constant(value: i64, bits: usize) -> Vec<Wire> {
    let wire = |place: usize| Wire::constant(value >> place.min(63) & 1 == 1);
    (0..bits).map(wire).collect()
}

fn invert(wires: &mut [Wire], inverted: bool) {
    if inverted {
        for wire in wires {
            *wire = wire.xor(true);
        }
    }
}

/// Returns the lowest `bits` bits of a number whose own bits are `wires`, with copies of `above`
/// above them.
fn extended(wires: &[Wire], above: Wire, bits: usize) -> Vec<Wire> {
    let mut extended = Vec::with_capacity(bits);
    extended.extend_from_slice(&wires[..bits.min(wires.len())]);
    extended.resize(bits, above);
    extended
}

fn qubits(qubits: &[Qubit]) -> Vec<Wire> {
    qubits.iter().map(|qubit| Wire::qubit(*qubit)).collect()
}
