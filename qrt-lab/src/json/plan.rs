//! The plan of a scene that asks for an accuracy.

use qrt_runtime::plan::PlanFigures;
use serde_json::{Value, json};

/// Returns the chosen parameters and the expected errors.
pub fn plan(figures: &PlanFigures) -> Value {
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
