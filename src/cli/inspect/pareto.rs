//! `qrt inspect --pareto`: the front of qubits against gates.

use super::{InspectArgs, write};
use crate::cli::failure::Failure;
use crate::cli::files::Output;
use crate::cli::interrupt;
use crate::cli::prepare::without_circuit;
use crate::cli::progress::Bar;
use qrt_core::compile::Strategy;
use qrt_core::inspect::{OraclePixel, grouped};
use qrt_core::oracle::{OracleName, Oracles, StrategyCost};
use qrt_lab::json;
use qrt_lab::layouts::{LayoutsError, drawing, front_of_most_expensive};
use qrt_runtime::workers::Workers;
use qrt_scene::front::Loaded;
use std::fmt::Write;

/// Returns the front as text or JSON; writes its drawing to `plot`.
pub(super) fn report(
    args: &InspectArgs,
    pixel: Option<OraclePixel>,
    loaded: &Loaded,
    oracles: &Oracles<'_>,
    plot: Option<&Output>,
) -> Result<String, Failure> {
    // A pixel's own oracles have its position built in.
    let alone = pixel.map(|pixel| oracles.of_pixel(pixel.place));
    let oracles = alone.as_ref().unwrap_or(oracles);
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::settings(!args.json);
    let show = |progress| bar.show(progress);
    let workers = Workers {
        threads: args.threads.count(),
        cancel: Some(&cancel),
        progress: Some(&show),
    };
    let found = front_of_most_expensive(oracles, args.channel, &workers);
    bar.clear();
    let (oracle, front) = found.map_err(|error| match error {
        LayoutsError::Oracle(error) => without_circuit(&error, loaded),
        other => Failure::Job(other.to_string()),
    })?;
    let name = &oracles.scene().scene().name;
    if let Some(file) = plot {
        write(file, &drawing(&front, name).svg())?;
    }
    let out = if args.json {
        format!("{:#}\n", json::pareto(name, oracle, pixel, &front))
    } else {
        text(name, oracle, pixel, &front)
    };
    Ok(out)
}

fn text(
    name: &str,
    oracle: OracleName,
    pixel: Option<OraclePixel>,
    front: &[StrategyCost],
) -> String {
    let which = match pixel {
        Some(pixel) => pixel.which(oracle),
        None => oracle.to_string(),
    };
    let mut out = format!(
        "{name}, {which}: one oracle call under {} strategies; those that no other beats\n\n",
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
