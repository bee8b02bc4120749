//! Writing generated files so that what has not changed is not touched.

use anyhow::{Context as _, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Makes a folder hold these files and no others. A file that holds them already keeps its time.
pub(crate) fn write_all<T: AsRef<[u8]>>(folder: &Path, wanted: &BTreeMap<String, T>) -> Result<()> {
    for file in all(folder)? {
        let name = relative(folder, &file);
        if !wanted.contains_key(&name) {
            std::fs::remove_file(&file)
                .with_context(|| format!("cannot remove {}", file.display()))?;
        }
    }
    for (name, content) in wanted {
        let file = folder.join(name);
        if std::fs::read(&file).is_ok_and(|old| old == content.as_ref()) {
            continue;
        }
        if let Some(parent) = file.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(&file, content)
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

/// All files below a folder, in order of their names; none if there is no such folder.
pub(crate) fn all(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        if !folder.is_dir() {
            continue;
        }
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

/// A file's path from a folder, with `/` between its parts.
pub(crate) fn relative(folder: &Path, file: &Path) -> String {
    file.strip_prefix(folder)
        .unwrap_or(file)
        .components()
        .map(|part| part.as_os_str().to_string_lossy())
        .collect::<Vec<_>>()
        .join("/")
}
