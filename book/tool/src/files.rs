//! Writes generated files, and leaves unchanged files untouched.

use anyhow::{Context as _, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Makes `folder` hold the files `wanted` and no others. A file that does not change keeps its time.
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
            std::fs::create_dir_all(parent)
                .with_context(|| format!("cannot make the folder {}", parent.display()))?;
        }
        std::fs::write(&file, content)
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

/// Returns all files below a folder, in order of their names; none if the folder does not exist. Links
/// to folders are not followed, because they may lead anywhere, even to a folder above.
pub(crate) fn all(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        if !folder.is_dir() {
            continue;
        }
        let cannot = || format!("cannot read the folder {}", folder.display());
        for entry in std::fs::read_dir(&folder).with_context(cannot)? {
            let entry = entry.with_context(cannot)?;
            if entry.file_type().with_context(cannot)?.is_dir() {
                folders.push(entry.path());
            } else if !entry.path().is_dir() {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Returns a file's path relative to a folder, with `/` between its parts.
pub(crate) fn relative(folder: &Path, file: &Path) -> String {
    file.strip_prefix(folder)
        .unwrap_or(file)
        .components()
        .map(|part| part.as_os_str().to_string_lossy())
        .collect::<Vec<_>>()
        .join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_or_folder_that_is_in_the_way_is_named() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a"), "").unwrap();
        let wanted = BTreeMap::from([("b/c.html".to_owned(), "")]);
        let error = write_all(&folder.path().join("a"), &wanted).unwrap_err();
        let expected = format!(
            "cannot make the folder {}",
            folder.path().join("a/b").display()
        );
        assert_eq!(error.to_string(), expected);
    }

    #[cfg(unix)]
    #[test]
    fn links_to_folders_are_not_followed() {
        let root = tempfile::tempdir().unwrap();
        let (folder, other) = (root.path().join("in"), root.path().join("out"));
        std::fs::create_dir_all(folder.join("a")).unwrap();
        std::fs::create_dir_all(&other).unwrap();
        std::fs::write(folder.join("a/file"), "").unwrap();
        std::fs::write(other.join("kept"), "").unwrap();
        let link = |to: &Path, at: &str| std::os::unix::fs::symlink(to, folder.join(at)).unwrap();
        link(&folder, "a/round");
        link(&other, "elsewhere");
        link(&other.join("kept"), "one");
        let found = all(&folder).unwrap();
        let found: Vec<String> = found.iter().map(|file| relative(&folder, file)).collect();
        assert_eq!(found, ["a/file", "one"]);
        // A file outside the folder, behind a link, stays.
        write_all::<&str>(&folder, &BTreeMap::new()).unwrap();
        assert!(other.join("kept").exists() && !folder.join("a/file").exists());
    }
}
