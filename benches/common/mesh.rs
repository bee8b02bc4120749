//! A mesh of 65,536 triangles, and its views.

use super::knot;
use super::load::load;
use qrt::scene::valid::ValidScene;
use std::path::Path;

/// Pixels along each side of the film.
pub(crate) const SIDE: u32 = 32;

/// A scene with a knot, and the rotation and translation of this mesh in it: the view of the independent
/// renderer's own mesh scene, whose throughput relative to its box is the one to compare with, and a close one.
pub(crate) const VIEW: [&str; 3] = [
    "tests/references/torusknot8k.yaml",
    "[90, 0, 0]",
    "[0, 0.6, -0.2]",
];
pub(crate) const CLOSE: [&str; 3] = ["scenes-yaml/knot.yaml", "[0, 30, 0]", "[0, 0, 0]"];

/// Corners of a section of the knot's tube, and sections, of the whole mesh.
pub(crate) const WHOLE: [u32; 2] = [32, 1024];

pub(crate) fn sets(depth: usize, path_bits: u32) -> Vec<String> {
    let depths = vec!["{ bits: [8, 8] }"; depth].join(", ");
    vec![
        format!("film.width={SIDE}"),
        format!("film.height={SIDE}"),
        format!("sampling.path_bits={path_bits}"),
        format!("sampling.depths=[{depths}]"),
    ]
}

/// Returns a knot of `2 * around * along` triangles, traced along paths of four rays, under `keep`.
pub(crate) fn mesh(
    root: &Path,
    view: [&str; 3],
    [around, along]: [u32; 2],
    path_bits: u32,
) -> ValidScene {
    let [scene, rotate, translate] = view;
    let mut sets = sets(4, path_bits);
    sets.push(format!("geometry[2].mesh.rotate={rotate}"));
    sets.push(format!("geometry[2].mesh.translate={translate}"));
    sets.push("circuit.uncompute=keep".to_owned());
    with_obj(root, scene, &knot::torus_knot(around, along), sets)
}

/// Loads the scene at `path` with this mesh in the knot's place.
pub(crate) fn with_obj(root: &Path, path: &str, mesh: &str, mut sets: Vec<String>) -> ValidScene {
    let folder = std::env::temp_dir().join(format!("qrt-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let obj = folder.join("mesh.obj");
    std::fs::write(&obj, mesh).expect("a mesh file");
    sets.push(format!("geometry[2].mesh.obj={}", obj.display()));
    let scene = load(root, path, &sets);
    std::fs::remove_dir_all(&folder).expect("the folder is ours");
    scene
}
