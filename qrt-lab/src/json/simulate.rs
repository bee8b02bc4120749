//! A pixel's complete counting circuit, run as amplitudes.

use crate::simulate::{MeanPhaseSimulation, Simulation};
use qrt_core::inspect::OraclePixel;
use qrt_core::oracle::OracleName;
use qrt_scene::valid::ValidScene;
use serde_json::{Value, json};

/// Returns the outcomes of a pixel's simulated counting circuit, beside theory, and the estimate.
pub fn simulate(scene: &ValidScene, one: &Simulation) -> Value {
    let outcomes: Vec<Value> = one
        .outcomes
        .iter()
        .map(|o| json!({ "y": o.y, "simulated": o.simulated, "theory": o.theory }))
        .collect();
    let drawn: Vec<Value> = one
        .tally()
        .iter()
        .map(|(y, count)| json!({ "y": y, "count": count }))
        .collect();
    let (report, estimate) = (&one.report, &one.estimate);
    let found = json!({
        "window": one.window.name(),
        "good": one.good,
        "total": one.total,
        "scale": one.scale,
        "qubits": {
            "all": report.qubits,
            "path": one.path_bits,
            "comparator": one.comparator_bits,
            "phase": one.phase_bits,
            "work": one.work_qubits(),
        },
        "gates": report.gates,
        "queries": report.queries,
        "most_states": report.most_states,
        "checks": report.checks,
        "norm": report.norm,
        "dropped": report.dropped,
        "outcomes": outcomes,
        "largest_difference": one.largest_difference(),
        "drawn": drawn,
        "estimate": {
            "good": estimate.good,
            "amplitude": estimate.amplitude,
            "interval": [estimate.interval.0, estimate.interval.1],
            "confidence": estimate.confidence,
            "queries": estimate.queries,
            "shots": estimate.shots,
            "radiance": one.radiance(),
        },
    });
    of_pixel(scene, one.name, one.pixel, found)
}

/// Returns the result of `qrt simulate --mean-phase`.
pub fn simulate_mean_phase(scene: &ValidScene, one: &MeanPhaseSimulation) -> Value {
    let levels: Vec<Value> = (one.levels.iter())
        .map(|o| {
            json!({
                "level": o.level,
                "paths": o.paths,
                "simulated": o.simulated,
                "theory": o.theory,
            })
        })
        .collect();
    let [simulated, theory] = one.zero();
    let found = json!({
        "iterates": one.iterates,
        "slope": one.phases.slope(),
        "reference": one.phases.reference(),
        "basis_turns": one.basis.as_f64(),
        "mean": one.mean,
        "deviation": one.deviation,
        "qubits": one.qubits,
        "path_bits": one.path_bits,
        "gates": one.gates,
        "queries": one.queries,
        "zero": { "simulated": simulated, "theory": theory },
        "levels": levels,
        "largest_difference": one.largest_difference(),
    });
    of_pixel(scene, one.name, one.pixel, found)
}

/// Puts the names of the scene, the oracle and the pixel before what was `found`.
fn of_pixel(scene: &ValidScene, name: OracleName, pixel: OraclePixel, found: Value) -> Value {
    let mut all = json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": scene.scene().name,
        "scene_hash": scene.fingerprint().to_string(),
        "channel": name.channel_name(),
        "class": name.class_name(),
        "pixel": pixel.place,
        "seed": pixel.seed,
    });
    if let (Value::Object(all), Value::Object(found)) = (&mut all, found) {
        all.extend(found);
    }
    all
}
