//! Parameters of a scene that asks for an accuracy.

use super::failure::Failure;
use super::terminal;
use qrt_runtime::plan::{Figures, Options, Plan, plan};
use qrt_scene::valid::ValidScene;
use serde_json::{Value, json};

/// Chooses the parameters of a scene that asks for an accuracy, and prints the plan on standard error
/// unless `quiet`.
///
/// # Errors
/// No parameters keep the accuracy.
pub(crate) fn choose(
    scene: &ValidScene,
    options: &Options<'_>,
    quiet: bool,
) -> Result<Option<Plan>, Failure> {
    let planned = plan(scene, options)?;
    if let Some(plan) = planned.as_ref().filter(|_| !quiet) {
        terminal::note(plan.figures.to_string().trim_end());
    }
    Ok(planned)
}

/// Returns the chosen parameters and the expected errors.
pub(crate) fn json(figures: &Figures) -> Value {
    let parts = figures.parts;
    json!({
        "error": figures.accuracy.error,
        "confidence": figures.accuracy.confidence,
        "mean_radiance": figures.mean,
        "pixels": figures.pixels[0],
        "path_bits": figures.path_bits,
        "fraction": figures.fraction,
        "comparator_bits": figures.comparator_bits,
        "estimator": figures.estimator.name(),
        "phase_bits": figures.phase_bits,
        "repetitions": figures.repetitions,
        "counting_error": figures.error,
        "within": figures.within,
        "errors": {
            "paths": parts.paths,
            "comparators": parts.comparators,
            "width": parts.width,
            "counting": parts.counting,
            "total": parts.total,
        },
        "queries": figures.queries,
        "channel_queries": figures.channel_queries,
        "toffoli": figures.cost.map(|cost| cost.toffoli),
        "qubits": figures.cost.map(|cost| cost.qubits),
    })
}
