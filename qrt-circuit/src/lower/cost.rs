//! What operations cost: their gates, counted instead of kept.

use super::super::{Gate, Op, Program, RegisterId};
use super::figures::Figures;
use super::place::{canonical, placed};
use std::collections::HashMap;
use std::iter::Sum;
use std::ops::Add;

/// How many gates of each kind an operation, or a program, takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cost {
    /// Toffolis, where everything is undone unitarily.
    pub toffoli: u64,
    /// ANDs that are left when those that computed into clean bits are undone by measurement.
    pub and_measured: u64,
    /// CNOT gates.
    pub cnot: u64,
    /// X gates, those that a pixel's classical parameters may need included.
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

/// What an operation and its inverse cost, given the widths of its registers: its gates, counted.
///
/// Of the ANDs into clean bits, those that an operation returns itself are undone by measurement
/// within it; those that stay are undone by measurement in its inverse.
pub fn costs(op: &Op, width: impl Fn(RegisterId) -> u32) -> [Cost; 2] {
    let (op, widths) = canonical(op, width);
    counted(&op, &widths).costs
}

/// The figures of an operation on registers of these widths, by their numbers.
pub(super) fn counted(op: &Op, widths: &[u32]) -> Figures {
    let mut lowering = placed(widths);
    let own = lowering.pool.made();
    let mut clean = vec![Clean::No; own as usize];
    for fresh in op.fresh() {
        for qubit in &lowering.registers[fresh.index()] {
            clean[*qubit as usize] = Clean::Kept;
        }
    }
    lowering.lower(op);
    clean.resize(lowering.pool.made() as usize, Clean::Borrowed);
    for qubit in &lowering.garbage {
        clean[*qubit as usize] = Clean::Kept;
    }
    let mut carried = lowering.carried.iter().peekable();
    let mut carries = 0;
    let (mut cost, mut kept, mut returned) = (Cost::default(), 0, 0);
    let gates: &[Gate] = &lowering.gates;
    let clean: &mut [Clean] = &mut clean;
    // A plain loop: where nobody optimises it, as in a macro, an iterator takes as long as the rest.
    let mut next = 0;
    while next < gates.len() {
        let place = next;
        next += 1;
        match gates[place] {
            Gate::X(_) | Gate::Load { .. } => cost.x += 1,
            Gate::Cx(_, target) => {
                cost.cnot += 1;
                let state = &mut clean[target as usize];
                if *state == Clean::Kept {
                    *state = Clean::No;
                }
            }
            Gate::Z(_) => {}
            Gate::Ccx(_, _, target) => {
                cost.toffoli += 1;
                if carried.next_if_eq(&&place).is_some() {
                    carries += 1;
                    continue;
                }
                let state = &mut clean[target as usize];
                match *state {
                    Clean::Kept => {
                        kept += 1;
                        *state = Clean::No;
                    }
                    Clean::Borrowed => *state = Clean::Lent,
                    Clean::Lent => {
                        returned += 1;
                        *state = Clean::Borrowed;
                    }
                    Clean::No => {}
                }
            }
        }
    }
    let forward = cost.toffoli - returned - carries / 2;
    let costs = [forward, forward - kept].map(|and_measured| Cost {
        and_measured,
        ..cost
    });
    Figures {
        costs,
        scratch: lowering.garbage.len() as u32,
        borrowed: lowering.pool.most_lent(),
    }
}

/// What is known of a qubit, as far as Toffolis go.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Clean {
    /// The qubit holds something.
    No,
    /// The qubit is zero, and what a Toffoli computes into it stays.
    Kept,
    /// The qubit is zero, and what a Toffoli computes into it is uncomputed.
    Borrowed,
    /// The qubit holds what the next Toffoli on it uncomputes.
    Lent,
}

/// What an operation, or its inverse, costs, given the widths of its registers.
pub fn cost(op: &Op, inverse: bool, width: impl Fn(RegisterId) -> u32) -> Cost {
    costs(op, width)[usize::from(inverse)]
}

/// How many Toffolis a program has.
pub fn toffoli(program: &Program) -> u64 {
    tally(program).iter().map(|cost| cost.toffoli).sum()
}

/// What each instruction of a program costs.
pub fn tally(program: &Program) -> Vec<Cost> {
    let mut known: HashMap<u32, [Cost; 2]> = HashMap::new();
    let instructions = program.instructions.iter();
    instructions
        .map(|instruction| {
            let op = &program.ops[instruction.op as usize];
            let costs = known.entry(instruction.op);
            let costs = costs.or_insert_with(|| costs_of(op, program));
            costs[usize::from(instruction.inverse)]
        })
        .collect()
}

fn costs_of(op: &Op, program: &Program) -> [Cost; 2] {
    costs(op, |register| program.width(register))
}
