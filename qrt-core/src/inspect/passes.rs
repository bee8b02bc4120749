//! What each pass takes away.

use super::Inspection;
use crate::compile::Passes;
use crate::oracle::{Options, Oracle, OracleError};
use crate::valid::ValidScene;
use qrt_circuit::lower::{self, Cost};

/// The call after a pass was added to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassFigures {
    /// The pass: `none`, `share`, `tabulate`, `needed`, `merge`.
    pub name: &'static str,
    /// Toffolis of the call.
    pub toffoli: u64,
    /// Operations of the compute part.
    pub ops: u64,
    /// Qubits of the call.
    pub qubits: u32,
}

/// The figures without any pass, and with one after the other added. The last are those of
/// `inspection`, which has them all.
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
    let steps = [
        ("none", Passes::NONE),
        ("share", share),
        ("tabulate", tabulate),
        ("needed", needed),
    ];
    let mut figures = Vec::with_capacity(steps.len() + 1);
    for (name, passes) in steps {
        let options = Options {
            passes,
            ..Options::default()
        };
        let oracle = Oracle::new(scene, inspection.channel, options)?;
        let whole = oracle.whole(0);
        figures.push(PassFigures {
            name,
            toffoli: lower::tally(&whole).into_iter().sum::<Cost>().toffoli,
            ops: oracle.program.ops.len() as u64,
            qubits: lower::size(&whole).qubits,
        });
    }
    figures.push(PassFigures {
        name: "merge",
        toffoli: inspection.total().toffoli,
        ops: inspection.oracle.program.ops.len() as u64,
        qubits: inspection.qubits,
    });
    Ok(figures)
}
