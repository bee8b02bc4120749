//! `qrt inspect --pareto`: qubits against gates.

use super::{InspectArgs, write};
use crate::cli::failure::Failure;
use crate::cli::files::Output;
use crate::cli::progress::Bar;
use crate::cli::{interrupt, terminal};
use qrt_core::compile::Strategy;
use qrt_core::front::Loaded;
use qrt_core::inspect::{CHANNELS, grouped};
use qrt_core::oracle::Layout;
use qrt_core::valid::ValidScene;
use qrt_runtime::layouts::{LayoutsError, drawing, front};
use qrt_runtime::workers::Workers;
use serde_json::{Value, json};
use std::fmt::Write;

pub(super) fn run(
    args: &InspectArgs,
    loaded: &Loaded,
    scene: &ValidScene,
    plot: Option<&Output>,
) -> Result<(), Failure> {
    let refused = |error: qrt_core::oracle::OracleError| loaded.report(vec![error.problem()]);
    let channel = match args.channel {
        Some(channel) => channel,
        None => {
            Layout::of_most_expensive(scene, Strategy::KEEP)
                .map_err(refused)?
                .0
        }
    };
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::settings(!args.json);
    let show = |progress| bar.show(progress);
    let workers = Workers {
        threads: args.threads.count(),
        cancel: Some(&cancel),
        progress: Some(&show),
    };
    let found = front(scene, channel, &workers);
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
        format!("{:#}\n", to_json(name, channel, &front))
    } else {
        text(name, channel, &front)
    };
    terminal::print(&out)
}

fn text(name: &str, channel: usize, front: &[Layout]) -> String {
    let mut out = format!(
        "{name}, channel {}: one oracle call under {} strategies; those that no other beats\n\n",
        CHANNELS[channel],
        Strategy::all().len()
    );
    let _ = writeln!(
        out,
        "{:>9}  {:>13}  {:>13}  {:>13}  what is undone at the end of its part",
        "qubits", "Toffoli", "measured AND", "with ghosts*"
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
        "\n* an estimate: the ANDs that are left if what is undone early is measured as a whole, and its\n  \
         signs are repaired when it is computed again; qrt has no such circuit\n",
    );
    out
}

fn to_json(name: &str, channel: usize, front: &[Layout]) -> Value {
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
        "channel": CHANNELS[channel],
        "front": layouts.collect::<Vec<_>>(),
    })
}
