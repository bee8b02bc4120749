//! The cost of one call of an oracle.

use super::{FlipSteps, Oracle};
use crate::compile::{self, PricedProgram};
use qrt_circuit::lower::{HeldQubits, OpFigures};
use qrt_circuit::{BlockId, Instruction, Op, RegisterId};

/// Costs of one call of an oracle: compute, compare and flip, uncompute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CallCost {
    /// Number of qubits that a call needs: the maximum in use at any time.
    pub qubits: u64,
    /// Number of Toffoli gates of a call.
    pub toffoli: u64,
}

impl CallCost {
    /// The Pareto front of `costs`, the one with the fewest Toffolis first. No other beats one of
    /// these in qubits without more Toffolis, or in Toffolis without more qubits.
    pub fn front<T>(mut costs: Vec<(Self, T)>) -> Vec<(Self, T)> {
        costs.sort_by_key(|(cost, _)| (cost.toffoli, cost.qubits));
        let mut least = u64::MAX;
        costs.retain(|(cost, _)| {
            let fewer = cost.qubits < least;
            least = least.min(cost.qubits);
            fewer
        });
        costs
    }
}

/// The cost of a call of the most expensive oracle in `channels`, each of which is of one channel.
pub fn call_cost(channels: &[Oracle]) -> CallCost {
    let known = &mut compile::Known::default();
    let priced = channels.iter().map(|oracle| {
        let figures = op_figures(oracle, known);
        (toffoli(oracle, &figures), oracle, figures)
    });
    // The first of equals.
    let dearest = priced.reduce(|most, next| if most.0 < next.0 { next } else { most });
    let none = CallCost {
        qubits: 0,
        toffoli: 0,
    };
    dearest.map_or(none, |(_, oracle, figures)| cost_by(oracle, &figures))
}

/// The figures of an oracle's operations, followed by those of [`Oracle::flip`] of channel number
/// 0.
pub(super) fn op_figures(oracle: &Oracle, known: &mut compile::Known) -> Vec<OpFigures> {
    let program = &oracle.program;
    let mut figures = known.figures(program.ops.iter(), &program.registers);
    // Each channel compares a number of its own, into the same flag.
    let flip = oracle.flip_steps(0);
    let width = |register| program.width(register);
    figures.extend(flip.ops.iter().map(|op| known.alike.figures(op, width)));
    figures
}

/// The cost of a call, by the figures of its operations and of its flip.
pub(super) fn cost_by(oracle: &Oracle, figures: &[OpFigures]) -> CallCost {
    let program = &oracle.program;
    let mut held = HeldQubits::new(&program.registers, &program.inputs);
    for instruction in &program.instructions {
        let place = instruction.op as usize;
        held.step(
            &program.ops[place],
            instruction.inverse,
            figures[place].borrowed,
        );
    }
    let flip = oracle.flip_steps(0);
    cost_upto(
        held,
        sum(&program.instructions, figures),
        &flip,
        &figures[program.ops.len()..],
    )
}

/// A call of a channel for its cost alone.
pub(super) struct PricedCall {
    program: PricedProgram,
    inputs: Vec<RegisterId>,
    flip: FlipSteps,
    /// By step of the flip.
    flip_figures: Vec<OpFigures>,
}

impl PricedCall {
    pub(super) fn new(
        program: PricedProgram,
        inputs: Vec<RegisterId>,
        flip: FlipSteps,
        known: &mut compile::Known,
    ) -> Self {
        let width = |id: RegisterId| program.registers()[id.index()].width;
        let figures = flip.ops.iter().map(|op| known.alike.figures(op, width));
        Self {
            flip_figures: figures.collect(),
            program,
            inputs,
            flip,
        }
    }

    pub(super) fn cost(&self) -> CallCost {
        let program = &self.program;
        let mut held = HeldQubits::new(program.registers(), &self.inputs);
        for instruction in &program.instructions {
            let place = instruction.op as usize;
            let borrowed = program.figures[place].borrowed;
            held.step(program.op(place), instruction.inverse, borrowed);
        }
        let once = sum(&program.instructions, &program.figures);
        cost_upto(held, once, &self.flip, &self.flip_figures)
    }

    /// Number of registers.
    pub(super) fn registers(&self) -> usize {
        self.program.registers().len()
    }

    /// The operations, those of the flip last.
    pub(super) fn ops(&self) -> Vec<&Op> {
        self.program.ops().chain(&self.flip.ops).collect()
    }

    /// The instructions of the whole call, and the figures of its operations.
    pub(super) fn whole(&self) -> (Vec<Instruction>, Vec<OpFigures>) {
        let compute = &self.program.instructions;
        let mut figures = self.program.figures.clone();
        let first = figures.len() as u32;
        figures.extend(&self.flip_figures);
        let mut whole = Vec::with_capacity(2 * compute.len() + self.flip.order.len());
        whole.extend_from_slice(compute);
        whole.extend(self.flip.order.iter().map(|&(step, inverse)| Instruction {
            op: first + step,
            inverse,
            block: BlockId::ROOT,
        }));
        whole.extend(compute.iter().rev().map(|instruction| Instruction {
            inverse: !instruction.inverse,
            ..*instruction
        }));
        (whole, figures)
    }
}

/// The cost of a call whose compute needs `once` Toffolis and leaves these qubits, with the figures of its flip.
fn cost_upto(
    mut held: HeldQubits<'_>,
    once: u64,
    flip: &FlipSteps,
    figures: &[OpFigures],
) -> CallCost {
    let mut toffoli = 2 * once;
    for &(step, inverse) in flip.order {
        let step = step as usize;
        held.step(&flip.ops[step], inverse, figures[step].borrowed);
        toffoli += figures[step].costs[0].toffoli;
    }
    CallCost {
        qubits: u64::from(held.most()),
        toffoli,
    }
}

/// The Toffolis of instructions, by the figures of their operations.
fn sum(instructions: &[Instruction], figures: &[OpFigures]) -> u64 {
    let all = instructions.iter();
    all.map(|instruction| figures[instruction.op as usize].costs[0].toffoli)
        .sum()
}

fn toffoli(oracle: &Oracle, figures: &[OpFigures]) -> u64 {
    let program = &oracle.program;
    let flip = oracle.flip_steps(0);
    let steps = flip.order.iter();
    let steps = steps.map(|(step, _)| {
        let place = program.ops.len() + *step as usize;
        figures[place].costs[0].toffoli
    });
    2 * sum(&program.instructions, figures) + steps.sum::<u64>()
}
