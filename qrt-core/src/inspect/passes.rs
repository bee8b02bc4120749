//! The saving of each pass in a call of the oracle.

use super::Inspection;
use crate::compile::Passes;
use crate::oracle::{Options, Oracle, OracleError};
use qrt_circuit::lower::{self, Cost};
use qrt_scene::valid::ValidScene;

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
}

/// The figures without any pass, and with the passes added one after the other. The last figures
/// are those of `inspection`, which has all passes.
///
/// # Errors
/// As [`Oracle::new`].
pub fn pass_figures(
    scene: &ValidScene,
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
    for (name, passes) in steps {
        let options = Options {
            passes,
            strategy: Some(inspection.strategy),
            class: inspection.name.class,
        };
        let oracle = Oracle::new(scene, inspection.name.channel, options)?;
        let whole = oracle.whole(0);
        figures.push(PassFigures {
            name,
            toffoli: lower::tally(&whole).into_iter().sum::<Cost>().toffoli,
            ops: oracle.program.ops.len() as u64,
            qubits: lower::size(&whole).qubits,
        });
    }
    figures.push(PassFigures {
        name: "multiples",
        toffoli: inspection.total().toffoli,
        ops: inspection.oracle.program.ops.len() as u64,
        qubits: inspection.qubits,
    });
    Ok(figures)
}
