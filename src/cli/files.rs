//! What can be known of files before the work that fills them.

use super::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Finds out before the work what can be known of it: that there is a folder to write to, and no
/// folder in the file's place.
pub(crate) fn can_be_written(file: &Path) -> Result<(), Failure> {
    if file.is_dir() {
        let message = format!("`{}` is a folder", file.display());
        return Err(Failure::Usage(message));
    }
    match file.parent() {
        Some(folder) if folder != Path::new("") && !folder.is_dir() => Err(Failure::Job(format!(
            "`{}`: there is no folder `{}`",
            file.display(),
            folder.display()
        ))),
        _ => Ok(()),
    }
}

/// A scene's result in the current folder: `folder/box.yaml` and `png` make `box.png`.
pub(crate) fn named_after(scene: &Path, extension: &str) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("scene".as_ref()).to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}

/// Whether `path` is a device or a pipe: it exists and is no ordinary file.
pub(crate) fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| !found.is_file())
}

/// Refuses to write one file over another, or over the scene. Devices take what is written to them
/// one after another.
pub(crate) fn keep_apart<'a>(files: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut known: Vec<PathBuf> = Vec::new();
    for file in files {
        // A file that isn't there yet is told by its name.
        let real = fs::canonicalize(file).unwrap_or_else(|_| file.to_path_buf());
        if !is_device(&real) && known.contains(&real) {
            let message = format!("`{}` is used for two different things", file.display());
            return Err(Failure::Usage(message));
        }
        known.push(real);
    }
    Ok(())
}
