//! Prints the result of a check as JSON.

use super::{CIRCUIT, Found, VerifyArgs};
use crate::cli::inspect::oracle_cost;
use qrt_core::oracle::PARTS_OF_A_CALL;
use qrt_runtime::path_machines::Defect;
use qrt_runtime::render::Model;
use qrt_scene::valid::ValidScene;
use serde_json::{Value, json};

/// Returns the result of a check as JSON.
pub(super) fn answer(args: &VerifyArgs, scene: &ValidScene, found: &Found) -> Value {
    let report = &found.report;
    let mismatches = report.mismatches.iter().map(|mismatch| {
        json!({
            "pixel": mismatch.pixel,
            "id": mismatch.id,
            "channel": mismatch.channel,
            "colour": { "fixed": mismatch.fixed[0], "gates": mismatch.gates[0] },
            "count": {
                "fixed": mismatch.fixed[1],
                "gates": mismatch.gates[1],
                "thresholds": mismatch.thresholds,
            },
        })
    });
    let measured = found.defect.is_none();
    json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": scene.scene().name,
        "scene_hash": scene.fingerprint().to_string(),
        "seed": args.seed,
        "tile": args.tile.map(|portion| [portion.index(), portion.count()]),
        "holds": found.holds(),
        "pixels": report.pixels,
        "paths": report.paths,
        "oracles": report.oracles.iter().map(oracle_cost).collect::<Vec<_>>(),
        "includes": PARTS_OF_A_CALL,
        "circuit": CIRCUIT,
        "qubits": report.qubits,
        "gates": report.gates,
        "fraction_bits": report.fraction,
        "mismatched": report.mismatched,
        "mismatches": mismatches.collect::<Vec<_>>(),
        "defect": found.defect,
        "mean_rgb": measured.then_some(report.mean),
        "width_error": measured.then(|| json!({
            "rmse_rgb": report.width_error,
            "relative": report.relative_error(),
            "greatest_rgb": report.greatest,
        })),
        "parted": measured.then_some(report.parted),
        "seconds": found.seconds,
    })
}

/// Returns a defect of the circuit, or a path whose colour exceeds its bound in `model`.
pub(super) fn defect(defect: &Defect, model: Option<Model>) -> Value {
    let mut value = json!({ "message": defect.to_string() });
    match defect {
        Defect::Dirty {
            dirty,
            pixel,
            id,
            register,
        } => {
            value["qubit"] = json!(dirty.qubit);
            value["pixel"] = json!(pixel);
            value["id"] = json!(id);
            value["register"] = json!(register);
        }
        Defect::Id { pixel, id } => {
            value["pixel"] = json!(pixel);
            value["id"] = json!(id);
            value["register"] = json!("id");
        }
        Defect::OutOfBounds {
            pixel,
            id,
            channel,
            count,
            most,
        } => {
            value["model"] = json!(model.map(Model::name));
            value["pixel"] = json!(pixel);
            value["id"] = json!(id);
            value["channel"] = json!(channel);
            value["count"] = json!(count);
            value["most"] = json!(most);
        }
        Defect::Flip {
            channel,
            count,
            comparator,
        } => {
            value["channel"] = json!(channel);
            value["count"] = json!(count);
            value["comparator"] = json!(comparator);
        }
        _ => {}
    }
    value
}
