//! A path, in the words of a message.

use qrt_core::valid::ValidScene;
use qrt_runtime::predicates::trace_path_of;
use qrt_runtime::render::Model;

/// A line on what the rays of a path meet, by model, seed, pixel and index; empty if it can't be traced.
pub(super) fn in_words(
    scene: &ValidScene,
    (model, seed, pixel, id): (Model, u64, [u32; 2], u64),
) -> String {
    let path = trace_path_of(scene, model, seed, pixel, id);
    path.map_or_else(|_| String::new(), |path| format!("\nof this path, {path}"))
}
