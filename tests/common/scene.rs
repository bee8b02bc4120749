//! Scenes from texts and from files.

use qrt::scene::front::{load_with, parse};
use qrt::scene::valid::ValidScene;
use std::path::{Path, PathBuf};

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|&set| set.to_owned()).collect()
}

/// Parses a scene from a text.
pub(crate) fn written(text: &str, sets: &[&str]) -> ValidScene {
    let parsed = parse(text, "test.yaml", &owned(sets), "".as_ref());
    parsed.unwrap_or_else(|report| panic!("{report}")).valid
}

/// Loads a scene from a file of this repository.
pub(crate) fn from_file(file: &str, sets: &[&str]) -> ValidScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    // Sets may name a mesh from anywhere in the repository.
    let allowed = [PathBuf::from(env!("CARGO_MANIFEST_DIR"))];
    let loaded = load_with(&path, &owned(sets), |files| files.allowing(&allowed));
    loaded.unwrap_or_else(|report| panic!("{report}")).valid
}
