//! `qrt inspect --pareto`: the front of qubits against gates.

use super::{InspectArgs, is_asked, write};
use crate::cli::failure::Failure;
use crate::cli::files::Output;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use qrt_core::compile::Strategy;
use qrt_core::inspect::{OraclePixel, grouped};
use qrt_core::oracle::{Layout, OracleCost, OracleName, oracle_costs_under};
use qrt_core::tracer::PixelClasses;
use qrt_runtime::layouts::{LayoutsError, drawing, front};
use qrt_runtime::workers::Workers;
use qrt_scene::front::Loaded;
use qrt_scene::valid::ValidScene;
use serde_json::{Value, json};
use std::fmt::Write;

/// Returns the front as text or JSON; writes its drawing to `plot`.
pub(super) fn report(
    args: &InspectArgs,
    pixel: Option<OraclePixel>,
    loaded: &Loaded,
    scene: &ValidScene,
    plot: Option<&Output>,
) -> Result<String, Failure> {
    let refused = |error: qrt_core::oracle::OracleError| loaded.report(vec![error.problem()]);
    let costs = oracle_costs_under(scene, Strategy::KEEP).map_err(refused)?;
    let class = pixel.map(|pixel| PixelClasses::new(scene).class(pixel.place));
    let asked = costs.into_iter();
    let asked = asked.filter(|cost| is_asked(cost, args.channel, class));
    let Some(OracleCost { name: oracle, .. }) = OracleCost::most_expensive(asked) else {
        return Err(Failure::Job("no pixel has an oracle".to_owned()));
    };
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::settings(!args.json);
    let show = |progress| bar.show(progress);
    let workers = Workers {
        threads: args.threads.count(),
        cancel: Some(&cancel),
        progress: Some(&show),
    };
    let found = front(scene, oracle.channel, oracle.class, &workers);
    bar.clear();
    let front = found.map_err(|error| match error {
        LayoutsError::Oracle(error) => refused(error).into(),
        other => Failure::Job(other.to_string()),
    })?;
    let name = &scene.scene().name;
    if let Some(file) = plot {
        write(file, &drawing(&front, name).svg())?;
    }
    let out = if args.json {
        format!("{:#}\n", to_json(name, oracle, &front))
    } else {
        text(name, oracle, &front)
    };
    Ok(out)
}

fn text(name: &str, oracle: OracleName, front: &[Layout]) -> String {
    let mut out = format!(
        "{name}, {oracle}: one oracle call under {} strategies; those that no other beats\n\n",
        Strategy::all().len()
    );
    let _ = writeln!(
        out,
        "{:>9}  {:>13}  {:>13}  {:>13}  circuit.uncompute",
        "qubits", "Toffoli", "measured AND", "estimate*"
    );
    for layout in front {
        let _ = writeln!(
            out,
            "{:>9}  {:>13}  {:>13}  {:>13}  {}",
            grouped(layout.cost.qubits),
            grouped(layout.cost.toffoli),
            grouped(layout.and_measured),
            grouped(layout.and_with_ghosts),
            layout.strategy
        );
    }
    out.push_str(
        "\n* an estimate: the ANDs that remain if the registers that are uncomputed early are measured, and\n  \
         the signs that this leaves are corrected when they are computed again; qrt has no such circuit\n\n\
         `--set circuit.uncompute=NAME` takes any of these names.\n",
    );
    out
}

fn to_json(name: &str, oracle: OracleName, front: &[Layout]) -> Value {
    let layouts = front.iter().map(|layout| {
        json!({
            "qubits": layout.cost.qubits,
            "toffoli": layout.cost.toffoli,
            "and_measured": layout.and_measured,
            "estimated_and_with_ghosts": layout.and_with_ghosts,
            "strategy": layout.strategy.to_string(),
        })
    });
    json!({
        "scene": name,
        "channel": oracle.channel_name(),
        "class": oracle.class_name(),
        "front": layouts.collect::<Vec<_>>(),
    })
}
