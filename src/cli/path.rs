//! Describes a path in the words of a message.

use qrt_runtime::render::Model;
use qrt_runtime::traced_path::trace_path_of;
use qrt_scene::valid::ValidScene;

/// Returns a line on the hits of a path's rays, by model, seed, pixel and index; empty if tracing fails.
pub(super) fn in_words(
    scene: &ValidScene,
    model: Model,
    seed: u64,
    pixel: [u32; 2],
    id: u64,
) -> String {
    let path = trace_path_of(scene, model, seed, pixel, id);
    path.map_or_else(|_| String::new(), |path| format!("\nof this path, {path}"))
}
