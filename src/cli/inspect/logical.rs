//! `qrt inspect --logical-counts`: the input of estimators of physical resources, for a picture.

use crate::cli::failure::Failure;
use crate::cli::prepare::without_circuit;
use qrt_circuit::quantum::LogicalCounts;
use qrt_core::inspect::Inspection;
use qrt_core::oracle::Oracles;
use qrt_lab::physical::{Counts, PhysicalError, PictureCounts};
use qrt_runtime::plan::PlanFigures;
use qrt_scene::front::Loaded;
use serde_json::{Map, Value, json};

/// Returns the logical counts of a call of the oracle, of a pixel's run of the inspected channel, of a
/// pixel and of the film, under the two keys `unitary` and `measured`, with a description of the counts.
///
/// # Errors
/// Same as [`PictureCounts::for_scene`].
pub(super) fn json(
    loaded: &Loaded,
    oracles: &Oracles<'_>,
    inspection: &Inspection,
    plan: Option<&PlanFigures>,
) -> Result<Value, Failure> {
    let planned = plan.map(|figures| figures.channel_queries);
    let picture =
        PictureCounts::for_scene(oracles, inspection.name, planned).map_err(
            |error| match error {
                PhysicalError::Oracle(error) => without_circuit(&error, loaded),
                PhysicalError::Estimator(_) | PhysicalError::TooMany => {
                    Failure::Usage(error.to_string())
                }
                other => Failure::Job(other.to_string()),
            },
        )?;
    let one = picture.channels[inspection.name.channel];
    let of = |kind: fn(&Counts) -> LogicalCounts| {
        let parts = [
            ("oracle", one.oracle),
            ("channel", one.pixel),
            ("pixel", picture.pixel),
            ("film", picture.film),
        ];
        let parts = parts.map(|(name, counts)| (name.to_owned(), for_qsharp(kind(&counts))));
        Map::from_iter(parts)
    };
    let scene = oracles.scene();
    let written = scene.scene();
    let counting = written.counting;
    let film = picture.queries.saturating_mul(picture.pixels);
    Ok(json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": written.name,
        "scene_hash": scene.fingerprint().to_string(),
        "channel": inspection.name.channel_name(),
        "class": inspection.name.class_name(),
        "strategy": written.circuit.uncompute.name(),
        "estimator": counting.estimator().name(),
        "phase_bits": counting.phase_bits,
        "repetitions": counting.repetitions,
        "pixels": picture.pixels,
        "queries": { "channel": one.queries, "pixel": picture.queries, "film": film },
        "plan": plan.map(qrt_lab::json::plan),
        "assumed": {
            "queries": if plan.is_some() && !counting.estimator().has_register() {
                "as many as are planned of a pixel on average"
            } else {
                "as many as the scene's counting may use"
            },
            "circuit": if counting.estimator().has_register() {
                "quantum counting with its phase register, repeated"
            } else {
                "iterates without a control; after each the index is measured"
            },
            "oracle": format!(
                "that of {}, in every pixel; strata of the comparator save nothing",
                inspection.name.pixels()
            ),
            "order": "channels and pixels one after another, on the same qubits",
            "unitary": "everything is undone by gates",
            "measured": "ANDs into clean qubits are undone by measurement",
        },
        "unitary": of(|counts| counts.unitary),
        "measured": of(|counts| counts.measured),
    }))
}

/// Returns the counts under the names of Q#'s `LogicalCounts`.
fn for_qsharp(counts: LogicalCounts) -> Value {
    json!({
        "numQubits": counts.qubits,
        "cczCount": counts.toffoli,
        "ccixCount": counts.and,
        "tCount": counts.t,
        "rotationCount": counts.rotations,
        "rotationDepth": counts.rotation_depth,
        "measurementCount": counts.measurements,
    })
}
