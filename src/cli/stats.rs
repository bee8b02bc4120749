//! The statistics that `--stats` writes.

use super::failure::Failure;
use qrt_runtime::memory::peak_resident_bytes;
use qrt_runtime::render::{Rendered, Visibility};
use qrt_runtime::replace_file::replace_file;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// Writes the statistics of a picture as JSON.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write(path: &Path, rendered: &Rendered, clipped: u64) -> Result<(), Failure> {
    let text = text(rendered, clipped);
    replace_file(path, |out| out.write_all(text.as_bytes()))
        .map_err(|error| Failure::file(path, &error))
}

/// The statistics of a picture as JSON.
pub(crate) fn text(rendered: &Rendered, clipped: u64) -> String {
    format!("{:#}\n", stats(rendered, clipped))
}

fn stats(rendered: &Rendered, clipped: u64) -> Value {
    let [width, height] = rendered.film;
    json!({
        "version": 2,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": rendered.scene_name,
        "scene_hash": rendered.scene_hash,
        "model": rendered.model.name(),
        "estimator": rendered.estimator.name(),
        "colour": rendered.colour.name(),
        "noise": { "depolarising": rendered.noise.depolarising, "readout": rendered.noise.readout },
        "visibility": rendered.primary_hits.method.name(),
        "search": search(rendered),
        "seed": rendered.seed,
        "width": width,
        "height": height,
        "crop": rendered.crop,
        "depths": rendered.parameters.sampling.depths.len(),
        "path_bits": rendered.parameters.sampling.path_bits,
        "parameters": {
            "path_bits": rendered.parameters.sampling.path_bits,
            "fraction": rendered.parameters.precision.fraction,
            "comparator_bits": rendered.parameters.comparator.bits,
            "phase_bits": rendered.parameters.counting.phase_bits,
            "repetitions": rendered.parameters.counting.repetitions,
            "strata": rendered.parameters.counting.strata,
            "counting_error": rendered.parameters.counting.error,
        },
        "strata_used": strata_used(rendered),
        "plan": rendered.plan.as_ref().map(qrt_lab::json::plan),
        "paths": rendered.paths,
        "paths_resumed": rendered.resumed_paths,
        "seconds": rendered.seconds,
        "paths_per_second": paths_per_second(rendered),
        "oracle_queries": whole(rendered.total_queries()),
        "mean_rgb": rendered.mean(),
        "bound_rgb": rendered.scales.greatest(),
        "clipped_pixels": clipped,
        "threads": rendered.threads,
        "peak_memory_bytes": peak_resident_bytes(),
    })
}

/// Returns, for each number of strata, the number of channels of pixels that were counted in that many.
fn strata_used(rendered: &Rendered) -> Value {
    let used = rendered.counted.strata_used().into_iter();
    used.map(|(strata, channels)| (strata.to_string(), json!(channels)))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

/// Returns the cost of the search for primary hits; null if there was none.
fn search(rendered: &Rendered) -> Value {
    let Some(searched) = rendered.primary_hits.searched else {
        return Value::Null;
    };
    let root = libm::sqrt(searched.faces as f64);
    let mean = rendered.total_queries() as f64 / rendered.paths as f64;
    let guess = match rendered.primary_hits.method {
        Visibility::Grover { guess, .. } => json!(guess.name()),
        Visibility::Classical | Visibility::Exhaustive => Value::Null,
    };
    json!({
        "faces": searched.faces,
        "sqrt_faces": root,
        "states": searched.states,
        "queries_per_ray": mean,
        "queries_per_sqrt_faces": mean / root,
        "queries_per_face": mean / searched.faces as f64,
        "failure_bound": searched.failure,
        "first_guess": guess,
        "toffoli_per_query": searched.toffoli,
        "qubits": searched.qubits,
    })
}

/// Returns the throughput of traced paths; paths taken from a checkpoint do not count.
pub(crate) fn paths_per_second(rendered: &Rendered) -> f64 {
    let traced = rendered.paths - rendered.resumed_paths;
    traced as f64 / rendered.seconds.max(1e-9)
}

/// A count as a JSON number: exact below 2^64; above, to 16 digits.
fn whole(value: u128) -> Value {
    u64::try_from(value).map_or_else(|_| json!(value as f64), |value| json!(value))
}
