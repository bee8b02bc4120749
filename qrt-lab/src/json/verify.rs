//! The result of a check.

use super::oracle_cost;
use crate::verify::{CIRCUIT, VerifyReport};
use qrt_core::oracle::PARTS_OF_A_CALL;
use qrt_runtime::path_machines::Defect;
use qrt_runtime::render::{Model, Portion};
use qrt_scene::valid::ValidScene;
use serde_json::{Value, json};

/// The figures that `qrt verify` shows of a scene.
#[derive(Clone, Copy, Debug)]
pub struct VerifyFigures<'a> {
    /// The scene.
    pub scene: &'a ValidScene,
    /// The key of the paths' shifts.
    pub seed: u64,
    /// The portion of the pixels that was checked, if not all of them.
    pub portion: Option<Portion>,
    /// The result of the check.
    pub report: &'a VerifyReport,
    /// The defect of the circuit, as [`defect`] returns it; `None` without one.
    pub defect: Option<&'a Value>,
    /// Wall time of the check, in seconds.
    pub seconds: f64,
}

/// Returns the result of a check.
pub fn verify(figures: &VerifyFigures<'_>) -> Value {
    let VerifyFigures {
        scene,
        seed,
        portion,
        report,
        defect,
        seconds,
    } = *figures;
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
    let measured = defect.is_none();
    json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": scene.scene().name,
        "scene_hash": scene.fingerprint().to_string(),
        "seed": seed,
        "portion": portion.map(|portion| [portion.index(), portion.count()]),
        "holds": report.mismatched == 0 && defect.is_none(),
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
        "defect": defect,
        "mean_rgb": measured.then_some(report.mean),
        "width_error": measured.then(|| json!({
            "rmse_rgb": report.width_error,
            "relative": report.relative_error(),
            "greatest_rgb": report.greatest,
        })),
        "parted": measured.then_some(report.parted),
        "seconds": seconds,
    })
}

/// Returns a defect of the circuit, or a path whose colour exceeds its bound in `model`.
pub fn defect(defect: &Defect, model: Option<Model>) -> Value {
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
