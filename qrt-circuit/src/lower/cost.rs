//! What operations cost: Toffolis from the shapes of their operands.

use super::super::{Gate, Op, Operand, Program, RegisterId, Style, When, Word};
use super::adder::{carries, settled};
use super::choose::{chosen, turned};
use super::multiply::{Landing, Product};
use super::place::alone;
use super::scale::{Rows, operands, top};
use super::square;
use super::table::Plan;
use super::walk;
use super::{Lowering, Qubit, Wire, extended, invert};
use std::collections::HashMap;
use std::iter::Sum;
use std::ops::Add;

/// Gates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cost {
    /// Toffolis, unitary.
    pub toffoli: u64,
    /// ANDs that are left when those that computed into clean bits are undone by measurement.
    pub and_measured: u64,
    /// CNOTs.
    pub cnot: u64,
    /// Xs, those that a pixel's classical words may ask for included.
    pub x: u64,
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            toffoli: self.toffoli + other.toffoli,
            and_measured: self.and_measured + other.and_measured,
            cnot: self.cnot + other.cnot,
            x: self.x + other.x,
        }
    }
}

impl Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), Add::add)
    }
}

/// Toffolis, by what becomes of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Ands {
    pub(super) toffoli: u64,
    /// ANDs that stay, until they are measured.
    kept: u64,
    /// ANDs of either direction.
    both: u64,
}

impl Add for Ands {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            toffoli: self.toffoli + other.toffoli,
            kept: self.kept + other.kept,
            both: self.both + other.both,
        }
    }
}

impl Sum for Ands {
    fn sum<I: Iterator<Item = Self>>(ands: I) -> Self {
        ands.fold(Self::default(), Add::add)
    }
}

/// Into clean bits that stay.
fn kept(ands: u64) -> Ands {
    Ands {
        toffoli: ands,
        kept: ands,
        both: 0,
    }
}

/// Into clean bits that are returned.
fn returned(ands: u64) -> Ands {
    Ands {
        toffoli: 2 * ands,
        kept: 0,
        both: ands,
    }
}

/// Into bits that hold something.
fn onto(ands: u64) -> Ands {
    Ands {
        toffoli: ands,
        kept: 0,
        both: ands,
    }
}

/// What an operation, or its inverse, costs, given the widths of its registers.
pub fn cost(op: &Op, inverse: bool, width: impl Fn(RegisterId) -> u32) -> Cost {
    let (op, mut lowering) = alone(op, width);
    let ands = lowering.ands(&op);
    lowering.lower(&op);
    let mut cost = Cost {
        toffoli: ands.toffoli,
        and_measured: ands.both + if inverse { 0 } else { ands.kept },
        ..Cost::default()
    };
    for gate in &lowering.gates {
        match gate {
            Gate::X(_) | Gate::Load { .. } => cost.x += 1,
            Gate::Cx(..) => cost.cnot += 1,
            Gate::Ccx(..) | Gate::Z(_) => {}
        }
    }
    cost
}

/// Toffolis of an operation, and of its inverse, given the widths of its registers.
pub fn op_toffoli(op: &Op, width: impl Fn(RegisterId) -> u32) -> u64 {
    let (op, lowering) = alone(op, width);
    lowering.ands(&op).toffoli
}

/// Toffolis of a program: those of [`tally`], without the gates.
pub fn toffoli(program: &Program) -> u64 {
    let instructions = program.instructions.iter();
    let ops = instructions.map(|i| &program.ops[i.op as usize]);
    ops.map(|op| op_toffoli(op, |register| program.width(register)))
        .sum()
}

/// What each instruction of a program costs.
pub fn tally(program: &Program) -> Vec<Cost> {
    let mut known: HashMap<(u32, bool), Cost> = HashMap::new();
    let instructions = program.instructions.iter();
    let cost = |op: u32, inverse: bool| {
        let width = |register| program.width(register);
        cost(&program.ops[op as usize], inverse, width)
    };
    instructions
        .map(|instruction| {
            let (op, inverse) = (instruction.op, instruction.inverse);
            *known
                .entry((op, inverse))
                .or_insert_with(|| cost(op, inverse))
        })
        .collect()
}

/// `t = a + b + carry`, out of place.
fn sum(a: &[Wire], b: &[Wire], carry: Wire) -> u64 {
    let places = a.len().saturating_sub(1).min(settled(a, b) + 1);
    carries(a, b, carry, places).0
}

/// `t = a < b`
fn comparison(a: &[Wire], b: &[Wire], keep: bool) -> Ands {
    let mut a = a.to_vec();
    invert(&mut a, true);
    let Some(top) = a.len().checked_sub(1) else {
        return Ands::default();
    };
    let (ladder, carry) = carries(&a, b, Wire::ZERO, top);
    let last = Wire::majority(a[top], b[top], carry).is_none();
    let ladder = if keep { kept(ladder) } else { returned(ladder) };
    ladder + kept(u64::from(last))
}

/// A sum of `bits` bits of which the first carry follows from the wires, as a negation's does.
fn negation(bits: usize) -> u64 {
    bits.saturating_sub(2) as u64
}

fn ones(wires: &[Wire]) -> u64 {
    let sources = wires.iter().filter(|wire| wire.source().is_some());
    sources.count() as u64
}

/// Wires of which those that are not constants are like no others; `from` numbers them.
fn fresh(wires: &[Wire], from: Qubit) -> Vec<Wire> {
    let fresh = |(place, wire): (usize, &Wire)| match wire.source() {
        Some(_) => Wire::qubit(from + place as Qubit),
        None => *wire,
    };
    wires.iter().enumerate().map(fresh).collect()
}

/// Where numbers of qubits that aren't any begin.
const NONE: Qubit = 1 << 30;

impl Product {
    /// In plain rows.
    pub(super) fn plain(&self, style: Style) -> Ands {
        let (row, needed) = (self.row, self.needed);
        let lone = self.rows == 1;
        let first = kept(row.min(needed) as u64);
        let negated = if lone && self.a_signed {
            negation((row + 1).min(needed))
        } else {
            0
        };
        let rows = (1..self.rows.min(needed)).map(|place| {
            let bits = (row + 1).min(needed - place);
            let carries = bits as u64 - 1;
            match style {
                Style::Wide if row == 1 && place == 1 && !self.b_signed => kept(1),
                Style::Wide => kept(row.min(bits) as u64 + carries),
                Style::Lean => returned(carries) + onto(bits as u64),
            }
        });
        let negated = match style {
            Style::Wide => kept(negated),
            Style::Lean => returned(negated),
        };
        first + negated + rows.sum()
    }

    /// In rows of signed digits; there are none of a single bit.
    pub(super) fn signed(&self, style: Style) -> Ands {
        let (row, needed) = (self.row, self.needed);
        if self.digits() == 1 {
            return onto(u64::MAX);
        }
        let negated = negation((row + 1).min(needed));
        let rows = 1..self.digits().min(needed + 1);
        let carries = |place: usize| (row + 2).min(needed + 1 - place) as u64 - 1;
        let carries = negated + rows.map(carries).sum::<u64>();
        let carries = match style {
            Style::Wide => kept(carries),
            Style::Lean => returned(carries),
        };
        kept(row.min(needed) as u64) + carries
    }
}

impl Lowering {
    fn width(&self, register: RegisterId) -> usize {
        self.registers[register.index()].len()
    }

    /// Toffolis of an operation.
    fn ands(&self, op: &Op) -> Ands {
        match op {
            Op::Copy { .. }
            | Op::Load { .. }
            | Op::Parity { .. }
            | Op::Xor { .. }
            | Op::Phase { .. } => Ands::default(),
            Op::And { a, b, .. } => {
                let related = self.bit(*a).related(self.bit(*b));
                kept(u64::from(!related))
            }
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => {
                let bits = self.width(*target);
                let a = self.operand(*a, bits);
                let mut b = self.operand(*b, bits);
                invert(&mut b, *subtract);
                kept(sum(&a, &b, Wire::constant(*subtract)))
            }
            Op::Negate { a, when, target } => {
                let bits = self.width(*target);
                kept(negate_ands(&self.word(*a, bits), self.bit(*when)))
            }
            Op::Select { when, a, b, target } => {
                let bits = self.width(*target);
                let (a, b) = (self.operand(*a, bits), self.operand(*b, bits));
                let when = self.bit(*when);
                let costs = |place: &usize| {
                    let place = *place;
                    let again = place > 0 && a[place] == a[place - 1] && b[place] == b[place - 1];
                    let [a, b] = chosen(when, a[place], b[place]);
                    !again && !a.related(b)
                };
                kept((0..bits).filter(costs).count() as u64)
            }
            Op::Less { a, b, .. } => {
                let (a, b) = self.compared(*a, *b);
                comparison(&a, &b, false)
            }
            Op::Multiply {
                a,
                b,
                drop,
                style,
                target,
                ..
            } => {
                let target = self.register(*target);
                let landing = Landing::new(a.shift + b.shift, *drop, &target);
                let product = Product::new(*a, *b, &landing);
                let (plain, signed) = (product.plain(*style), product.signed(*style));
                match product.needed {
                    0 => Ands::default(),
                    _ if plain.toffoli <= signed.toffoli => plain,
                    _ => signed,
                }
            }
            Op::Square {
                a,
                drop,
                style,
                target,
                ..
            } => {
                let target = self.register(*target);
                let needed = square::needed(*a, &Landing::new(2 * a.shift, *drop, &target));
                square_ands(*a, needed, *style)
            }
            Op::Scale {
                a,
                factor,
                drop,
                style,
                target,
                ..
            } => {
                let target = self.register(*target);
                self.scale_ands(*a, *factor, *drop, *style, &target)
            }
            Op::Divide {
                a,
                b,
                style,
                quotient,
                ..
            } => self.divide_ands(*a, *b, *style, self.width(*quotient)),
            Op::SquareRoot { a, style, .. } => {
                let k = a.bits().div_ceil(2) as usize;
                let radicand = self.word(*a, 2 * k);
                let steps = (0..k).map(|step| {
                    let place = 2 * (k - 1 - step);
                    let zeros = 2 - ones(&radicand[place..place + 2]);
                    let carries = step as u64 + 1;
                    match style {
                        Style::Wide => kept(carries.saturating_sub(zeros)),
                        Style::Lean => returned(carries),
                    }
                });
                steps.sum()
            }
            Op::Table {
                address,
                columns,
                low,
                style,
                targets,
                ..
            } => {
                let width = |column: usize| self.width(targets[column]);
                match style {
                    Style::Wide => kept(Plan::new(address.len(), columns, *low, width).toffoli()),
                    Style::Lean => returned(walk::ands(address.len(), columns, width)),
                }
            }
            Op::XorInto { a, when, target } => {
                let Some(when) = when.map(|bit| self.bit(bit)) else {
                    return Ands::default();
                };
                let a = self.operand(*a, self.width(*target));
                let costs = |place: &usize| {
                    let again = *place > 0 && a[*place] == a[*place - 1];
                    !again && a[*place].source().is_some() && !a[*place].related(when)
                };
                onto((0..a.len()).filter(costs).count() as u64)
            }
            Op::AddInto {
                a,
                subtract,
                when,
                target,
            } => self.add_into_ands(*a, *subtract, *when, *target),
            Op::Swap { a, when, .. } => match when {
                Some(_) => onto(self.width(*a) as u64),
                None => Ands::default(),
            },
        }
    }

    fn add_into_ands(&self, a: Operand, subtract: bool, when: When, target: RegisterId) -> Ands {
        let t = super::qubits(&self.register(target));
        let (a, _, control) = self.addend(a, subtract, when, t.len());
        let (mut ladder, mut written) = (0, 0);
        let mut carry = Wire::ZERO;
        for (place, (a, t)) in a.iter().zip(&t).enumerate() {
            written += u64::from(control != Wire::ONE && !a.related(carry));
            if place + 1 < self.width(target) {
                carry = Wire::majority(*a, *t, carry).unwrap_or_else(|| {
                    ladder += 1;
                    Wire::qubit(u32::MAX - ladder)
                });
            }
        }
        returned(u64::from(ladder)) + onto(written)
    }

    fn scale_ands(&self, a: Word, factor: i64, drop: u32, style: Style, target: &[Qubit]) -> Ands {
        let rows = Rows::new(a, factor);
        let (bits, signed) = rows.extent();
        let needed = Landing::new(rows.shift, drop, target).needed(bits, signed);
        if needed == 0 {
            return Ands::default();
        }
        let added = rows.added.iter().take_while(|row| row.place < needed);
        if style == Style::Lean {
            let first = if rows.negative {
                negation(rows.first.0.min(needed))
            } else {
                0
            };
            let carries = |row: &super::scale::Row| {
                (row.after.0.min(needed) - row.place).saturating_sub(1) as u64
            };
            return returned(first + added.map(carries).sum::<u64>());
        }
        let own = self.word(Word { shift: 0, ..a }, a.width as usize);
        let above = if a.signed {
            own[own.len() - 1]
        } else {
            Wire::ZERO
        };
        let mut sums = own.clone();
        let mut ands = 0;
        let mut made = NONE;
        let mut make = |bits: usize| {
            made += bits as Qubit;
            (made..).take(bits).map(Wire::qubit).collect::<Vec<_>>()
        };
        if rows.negative && !rows.fused(needed) {
            let bits = rows.first.0.min(needed);
            let mut number = extended(&own, above, bits);
            invert(&mut number, true);
            ands += sum(&vec![Wire::ZERO; bits], &number, Wire::ONE);
            sums = make(bits);
        }
        for (index, row) in added.enumerate() {
            let bits = row.after.0.min(needed);
            let fused = index == 0 && rows.fused(needed);
            let (from, rest, mut number) = operands(&sums, &own, above, row, fused, bits);
            let subtract = fused || row.subtract;
            invert(&mut number, subtract);
            ands += sum(&rest, &number, Wire::constant(subtract));
            sums = extended(&sums, top(&sums, row.before.1), from);
            sums.extend(make(bits - from));
        }
        kept(ands)
    }

    fn divide_ands(&self, a: Word, b: Word, style: Style, n: usize) -> Ands {
        let keep = style == Style::Wide;
        let bits = b.bits() as usize;
        let number = self.word(a, (a.bits() as usize).max(n));
        let divisor = self.word(b, bits);
        let width = bits.max(number.len() - n);
        let high = extended(&number[n..], Wire::ZERO, width);
        let fits = comparison(&high, &extended(&divisor, Wire::ZERO, width), keep);
        if n == 0 {
            return fits;
        }
        let cut = if number.len() > n { 0 } else { bits.min(n) };
        let copied = kept(ones(&high[..bits]) + ones(&number[cut..n]));
        let steps = u64::from(b.width);
        let steps = if keep {
            let mut first = vec![number[n - 1]];
            first.extend_from_slice(&high[..bits]);
            let mut row = extended(&divisor, Wire::ZERO, bits + 1);
            invert(&mut row, true);
            kept(sum(&fresh(&first, NONE), &row, Wire::ONE) + steps * (n as u64 - 1))
        } else {
            returned(steps * n as u64)
        };
        fits + copied + steps
    }
}

fn negate_ands(a: &[Wire], when: Wire) -> u64 {
    let mut carry = when;
    let mut ands = 0;
    for place in 0..a.len().saturating_sub(1) {
        carry = turned(a, place, when, carry).unwrap_or_else(|| {
            ands += 1;
            Wire::qubit(u32::MAX - ands)
        });
    }
    u64::from(ands)
}

fn square_ands(a: Word, needed: usize, style: Style) -> Ands {
    let own = a.width as usize;
    let digits = own + usize::from(!a.signed);
    if own == 1 || needed == 0 {
        return Ands::default();
    }
    // The carry into a row's second bit is the sum's.
    let rows = (1..digits.min(needed + 1)).map(|place| negation(square::row_bits(place, needed)));
    let rows: u64 = rows.sum();
    match style {
        Style::Wide => kept(rows + negation(needed)),
        Style::Lean => returned(rows + needed as u64 - 1),
    }
}
