//! Resolves a path to the file it leads to.

use std::fs::{self, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The largest number of links followed one after another.
const LINKS: usize = 40;

/// The identity of a file, independent of its names; `None` where the system has no identities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Identity(Option<[u64; 2]>);

impl Identity {
    #[cfg(unix)]
    pub(super) fn from_metadata(found: &Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self(Some([found.dev(), found.ino()]))
    }

    #[cfg(not(unix))]
    pub(super) fn from_metadata(_: &Metadata) -> Self {
        Self(None)
    }
}

/// A path resolved through all links, for files that exist and files that don't exist yet.
///
/// ```
/// use qrt_runtime::disk::ResolvedPath;
/// use std::path::Path;
/// let one = ResolvedPath::resolve("new.png".as_ref())?;
/// let other = ResolvedPath::resolve("./new.png".as_ref())?;
/// assert!(one.is_same_as(&other));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ResolvedPath {
    path: PathBuf,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// There is no file yet.
    New,
    File(Identity),
    Folder,
    /// A device, a pipe, or any file that the process has open.
    Device,
}

impl ResolvedPath {
    /// Resolves `path`.
    ///
    /// # Errors
    /// If the path names no file, its folder does not exist, or the file system returns an error.
    pub fn resolve(path: &Path) -> io::Result<Self> {
        let mut path = path.to_path_buf();
        if is_open(&path) {
            let kind = Kind::Device;
            return Ok(Self { path, kind });
        }
        for _ in 0..LINKS {
            match fs::metadata(&path) {
                Ok(found) => return Self::found(path, &found),
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
                Err(_) => {}
            }
            let Some(name) = path.file_name() else {
                return Err(io::Error::new(ErrorKind::InvalidInput, "names no file"));
            };
            let below = folder(&path);
            let whole = fs::canonicalize(below).map_err(|error| match error.kind() {
                ErrorKind::NotFound => {
                    let message = format!("there is no folder `{}`", below.display());
                    io::Error::new(ErrorKind::NotFound, message)
                }
                _ => error,
            })?;
            let Ok(target) = fs::read_link(&path) else {
                let path = whole.join(name);
                let kind = Kind::New;
                return Ok(Self { path, kind });
            };
            // The link dangles: continue with its target.
            path = whole.join(target);
        }
        Err(io::Error::other("too many links, one after another"))
    }

    /// The standard output of the process. Use [`std::io::stdout`] to write to it.
    pub fn standard_output() -> Self {
        let (path, kind) = (PathBuf::from("-"), Kind::Device);
        Self { path, kind }
    }

    fn found(path: PathBuf, found: &Metadata) -> io::Result<Self> {
        if !found.is_file() && !found.is_dir() {
            // A device may have no path without links: `/dev/stdout` may be a pipe.
            let kind = Kind::Device;
            return Ok(Self { path, kind });
        }
        let kind = if found.is_dir() {
            Kind::Folder
        } else {
            Kind::File(Identity::from_metadata(found))
        };
        let path = fs::canonicalize(path)?;
        Ok(Self { path, kind })
    }

    /// The path without links; for a device, the path as given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether a file is there.
    pub(crate) fn is_file(&self) -> bool {
        matches!(self.kind, Kind::File(_))
    }

    /// Returns whether a folder is there.
    pub fn is_folder(&self) -> bool {
        matches!(self.kind, Kind::Folder)
    }

    /// Returns whether the path is a device, a pipe or a file that the process has open, like
    /// `/dev/stdout`.
    pub fn is_device(&self) -> bool {
        matches!(self.kind, Kind::Device)
    }

    /// Returns whether both places are, or will be, the same file, so that a write to one changes
    /// the other. A device is the same as no other place: it takes all writes one after another.
    pub fn is_same_as(&self, other: &Self) -> bool {
        match (&self.kind, &other.kind) {
            (Kind::Device, _) | (_, Kind::Device) => false,
            (Kind::File(Identity(Some(one))), Kind::File(Identity(Some(another)))) => {
                one == another
            }
            _ => self.path == other.path,
        }
    }
}

/// Returns whether the path is, or leads by links to, a file that this process has open:
/// `/dev/stdout`, `/dev/fd/3`. If that is a regular file, other processes write to it before and
/// after, so it must not be replaced.
fn is_open(path: &Path) -> bool {
    let own = fs::canonicalize("/proc/self/fd").ok();
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        let within = fs::canonicalize(folder(&path)).ok();
        if within.is_some() && (within == own || within.as_deref() == Some("/dev/fd".as_ref())) {
            return true;
        }
        let Ok(target) = fs::read_link(&path) else {
            return false;
        };
        path = folder(&path).join(target);
    }
    false
}

/// The folder that a file is in.
pub(crate) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use std::os::unix::fs::symlink;

    fn same(one: &Path, other: &Path) -> bool {
        let [one, other] = [one, other].map(|path| ResolvedPath::resolve(path).unwrap());
        assert_eq!(one.is_same_as(&other), other.is_same_as(&one));
        one.is_same_as(&other)
    }

    #[test]
    fn a_file_is_the_same_by_all_its_names() {
        let folder = Scratch::new();
        let path = |name: &str| folder.path(name);
        fs::write(path("file"), "").unwrap();
        fs::write(path("other"), "").unwrap();
        fs::hard_link(path("file"), path("hard")).unwrap();
        symlink("file", path("soft")).unwrap();
        symlink(".", path("here")).unwrap();
        for name in ["file", "./file", "hard", "soft", "here/file", "here/hard"] {
            assert!(same(&path("file"), &path(name)), "{name}");
            assert!(!same(&path("other"), &path(name)), "{name}");
        }
        assert!(!same(Path::new("/dev/null"), Path::new("/dev/null")));
    }

    #[test]
    fn what_is_not_there_yet_is_known_by_where_it_will_be() {
        let folder = Scratch::new();
        let path = |name: &str| folder.path(name);
        fs::create_dir(path("below")).unwrap();
        symlink(".", path("here")).unwrap();
        symlink("new", path("dangling")).unwrap();
        symlink("../dangling", path("below/twice")).unwrap();
        for name in [
            "new",
            "./new",
            "below/../new",
            "here/new",
            "dangling",
            "below/twice",
        ] {
            assert!(same(&path("new"), &path(name)), "{name}");
            assert!(!same(&path("below/new"), &path(name)), "{name}");
        }
        symlink("loop", path("loop")).unwrap();
        for name in ["loop", "none/new", "below/none/new"] {
            assert!(ResolvedPath::resolve(&path(name)).is_err(), "{name}");
        }
        symlink("none/new", path("lost")).unwrap();
        let error = ResolvedPath::resolve(&path("lost"))
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("there is no folder `"), "{error}");
        for name in ["", "..", "/"] {
            let place = ResolvedPath::resolve(Path::new(name));
            assert!(place.is_err() || place.unwrap().is_folder(), "{name}");
        }
    }
}
