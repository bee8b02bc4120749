//! The cost of one call of an oracle.

use super::Oracle;
use crate::compile;
use qrt_circuit::lower::{self, OpFigures};

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

/// The cost of a call, by the figures of its operations.
pub(super) fn cost_by(oracle: &Oracle, figures: &[OpFigures]) -> CallCost {
    let qubits = lower::most_qubits_by(&oracle.upto_flip(), |op| figures[op].borrowed);
    CallCost {
        qubits: u64::from(qubits),
        toffoli: toffoli(oracle, figures),
    }
}

fn toffoli(oracle: &Oracle, figures: &[OpFigures]) -> u64 {
    let program = &oracle.program;
    let toffoli = |op: usize| figures[op].costs[0].toffoli;
    let once = program.instructions.iter();
    let once: u64 = once
        .map(|instruction| toffoli(instruction.op as usize))
        .sum();
    let flip = oracle.flip_steps(0);
    let steps = flip.order.iter();
    let steps = steps.map(|(step, _)| toffoli(program.ops.len() + *step as usize));
    2 * once + steps.sum::<u64>()
}
