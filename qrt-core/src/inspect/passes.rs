//! The saving of each pass in a call of the oracle.

use super::Inspection;
use crate::compile::Passes;
use crate::oracle::{OracleError, Oracles};
use qrt_circuit::lower::{self, KnownFigures};
use qrt_circuit::{Cores, Instruction, Op};

/// The cost of a call of the oracle after a pass was added to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassFigures {
    /// The name of the pass: `none`, `share`, `tabulate`, `needed`, `merge`, `multiples`.
    pub name: &'static str,
    /// Number of Toffolis of the call.
    pub toffoli: u64,
    /// Number of operations of the compute part.
    pub ops: u64,
    /// Number of qubits that the call needs.
    pub qubits: u32,
    /// Number of operations that the tracer requested of the channel by itself, and number of these
    /// that reused an earlier one.
    pub requested: [u64; 2],
}

/// The figures without any pass, and with the passes added one after the other. The last figures
/// are those of `inspection`, which has all passes.
pub(super) fn figures(
    oracles: &Oracles<'_>,
    inspection: &Inspection,
) -> Result<Vec<PassFigures>, OracleError> {
    let share = Passes {
        share: true,
        ..Passes::NONE
    };
    let tabulate = Passes {
        tabulate: true,
        ..share
    };
    let needed = Passes {
        needed: true,
        ..tabulate
    };
    let merge = Passes {
        merge: true,
        ..needed
    };
    let steps = [
        ("none", Passes::NONE),
        ("share", share),
        ("tabulate", tabulate),
        ("needed", needed),
        ("merge", merge),
    ];
    let mut figures = Vec::with_capacity(steps.len() + 1);
    let mut requested = [0; 2];
    let passes = steps.map(|(_, passes)| passes);
    let by_passes = match inspection.oracle.pixel {
        Some(pixel) => oracles.of_pixel(pixel).by_passes(inspection.name, &passes),
        None => oracles.by_passes(inspection.name, &passes),
    };
    let mut known = KnownFigures::default();
    for ((name, _), oracle) in steps.iter().zip(by_passes?) {
        let whole = oracle.whole(0);
        requested = oracle.sharing;
        let ops: Vec<&Op> = whole.ops.iter().collect();
        let of_ops = known.all(&ops, |register| whole.width(register), Cores::All);
        let toffoli = |instruction: &Instruction| {
            let costs = &of_ops[instruction.op as usize].costs;
            costs[usize::from(instruction.inverse)].toffoli
        };
        figures.push(PassFigures {
            name,
            toffoli: whole.instructions.iter().map(toffoli).sum(),
            ops: oracle.program.ops.len() as u64,
            qubits: lower::most_qubits_by(&whole, |op| of_ops[op].borrowed),
            requested,
        });
    }
    figures.push(PassFigures {
        name: "multiples",
        toffoli: inspection.total().toffoli,
        ops: inspection.oracle.program.ops.len() as u64,
        qubits: inspection.qubits,
        // The last pass works on the recording of the one before.
        requested,
    });
    Ok(figures)
}
