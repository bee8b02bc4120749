//! Costs and other figures of operations. Their gates are counted and not kept.

use super::super::{Gate, Op, RegisterId};
use super::place::{canonical, placed};
use std::iter::Sum;
use std::ops::Add;

/// Number of gates of each kind in an operation or a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cost {
    /// Toffolis, if everything is undone unitarily.
    pub toffoli: u64,
    /// ANDs that remain if measurement undoes those that were computed into clean bits.
    pub and_measured: u64,
    /// CNOT gates.
    pub cnot: u64,
    /// X gates, including those that a pixel's classical parameters may need.
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

/// The figures that the lowering of an operation yields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpFigures {
    /// The costs of the operation and of its inverse: [`super::costs`].
    pub costs: [Cost; 2],
    /// The width in qubits of its garbage register: [`super::scratch_width`].
    pub scratch: u32,
    /// The most qubits that it borrows at a time, beside its registers, and returns.
    pub borrowed: u32,
}

/// Returns the costs of an operation and of its inverse, given the widths of its registers.
///
/// Some ANDs into clean bits are returned by the operation itself: measurement undoes them within
/// it. The others stay, and measurement undoes them within its inverse.
pub fn costs(op: &Op, width: impl Fn(RegisterId) -> u32) -> [Cost; 2] {
    let (op, widths) = canonical(op, width);
    counted(&op, &widths).costs
}

/// Returns the figures of an operation on registers of these `widths`, indexed by register number.
pub(super) fn counted(op: &Op, widths: &[u32]) -> OpFigures {
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
    // A plain loop: in unoptimised code, as in a macro, an iterator takes the time of all the rest.
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
    OpFigures {
        costs,
        scratch: lowering.garbage.len() as u32,
        borrowed: lowering.pool.most_lent(),
    }
}

/// The known state of a qubit, as far as it matters to Toffolis.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Clean {
    /// The qubit holds a value.
    No,
    /// The qubit is zero, and the result of a Toffoli into it stays.
    Kept,
    /// The qubit is zero, and the result of a Toffoli into it is uncomputed.
    Borrowed,
    /// The qubit holds a result that the next Toffoli on it uncomputes.
    Lent,
}

/// Returns the cost of an operation, or of its inverse, given the widths of its registers.
pub fn cost(op: &Op, inverse: bool, width: impl Fn(RegisterId) -> u32) -> Cost {
    costs(op, width)[usize::from(inverse)]
}
