//! Loads scenes from files.

use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use std::path::Path;

/// Loads the scene at `path` in the repository `root`, with the overrides `sets`.
pub(crate) fn load(root: &Path, path: &str, sets: &[String]) -> ValidScene {
    // A bench writes its meshes to the temporary folder.
    let allowed = [std::env::temp_dir()];
    front::load_with(&root.join(path), sets, |files| files.allowing(&allowed))
        .unwrap_or_else(|report| panic!("{report}"))
        .valid
}
