//! Scenes of files.

use qrt::core::front;
use qrt::core::valid::ValidScene;
use std::path::Path;

/// The scene at `path` in the repository `root`.
pub(crate) fn load(root: &Path, path: &str, sets: &[String]) -> ValidScene {
    // A mesh that a bench makes is elsewhere.
    let allowed = [std::env::temp_dir()];
    front::load_with(&root.join(path), sets, |files| files.allowing(&allowed))
        .unwrap_or_else(|report| panic!("{report}"))
        .valid
}
