//! The source of the files that a scene names: a folder on disk, or bytes in memory.

use crate::scene::meshes::MOST_FACES;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};

/// A scene's own files: its meshes and their material libraries.
///
/// A scene may be untrusted. So only regular files below the scene's folder are read from a disk,
/// links followed, unless [`Files::allowing`] names other folders.
///
/// ```
/// use qrt_scene::front::{Files, parse_with};
/// let text = "
/// name: lamp
/// camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
/// film: { width: 8, height: 8 }
/// materials: { lamp: { emitter: { radiance: [1, 1, 1] } } }
/// geometry: [{ mesh: { obj: lamp.obj, material: lamp } }]
/// ";
/// let held: &[(&str, &[u8])] = &[("lamp.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")];
/// let scene = parse_with(text, "lamp.yaml", &[], Files::held(held))?.valid;
/// assert_eq!(scene.polygons().len(), 1);
/// assert!(scene.files()[0].ends_with("lamp.obj"));
/// # Ok::<(), qrt_syntax::Report>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Files<'a> {
    folder: &'a Path,
    origin: Origin<'a>,
    allowed: &'a [PathBuf],
    most_faces: usize,
}

#[derive(Clone, Copy, Debug)]
enum Origin<'a> {
    /// The files below a folder on disk.
    Disk(&'a Path),
    /// Files in memory, by name and contents.
    Held(&'a [(&'a str, &'a [u8])]),
}

impl<'a> Files<'a> {
    /// Gives access to the files of `folder` on disk, from which relative names start.
    pub fn of_folder(folder: &'a Path) -> Self {
        Self::below(Path::new(""), folder)
    }

    /// Gives access to the files of `folder`, itself relative to `root`. Errors name files relative
    /// to `root`.
    pub fn below(root: &'a Path, folder: &'a Path) -> Self {
        Self::new(folder, Origin::Disk(root))
    }

    fn new(folder: &'a Path, origin: Origin<'a>) -> Self {
        Self {
            folder,
            origin,
            allowed: &[],
            most_faces: MOST_FACES,
        }
    }

    /// Also allows files below `folders` on disk, which are relative to the current folder.
    pub fn allowing(self, folders: &'a [PathBuf]) -> Self {
        Self {
            allowed: folders,
            ..self
        }
    }

    /// Limits the number of triangles of all meshes, each placement counted, to `most_faces`. The
    /// default is [`MOST_FACES`].
    pub fn most_faces(self, most_faces: usize) -> Self {
        Self { most_faces, ..self }
    }

    /// Gives access to `files`, by name and contents, and to no others.
    pub fn held(files: &'a [(&'a str, &'a [u8])]) -> Self {
        Self::new(Path::new(""), Origin::Held(files))
    }

    /// Returns the path by which errors name the file that the scene calls `name`.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub(crate) fn faces_allowed(&self) -> usize {
        self.most_faces
    }

    /// True if the scene belongs to a crate, whose files alone are read.
    pub(crate) fn are_of_crate(&self) -> bool {
        matches!(self.origin, Origin::Disk(root) if root != Path::new(""))
    }

    /// True if `path` leads to a place below the scene's folder, or below an allowed one.
    fn is_inside(&self, root: &Path, path: &Path) -> bool {
        let path = real(&root.join(path), MOST_LINKS);
        let folder = root.join(self.folder);
        let mut folders = std::iter::once(&folder).chain(self.allowed);
        path.is_absolute()
            && folders.any(|folder| {
                let folder = real(folder, MOST_LINKS);
                folder.is_absolute() && path.starts_with(folder)
            })
    }

    /// Reads the bytes at `path`, at most `most`, if it is inside. Front ends read all files by
    /// this method or by [`Files::read_named`].
    pub(crate) fn read(&self, path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
        match self.origin {
            Origin::Disk(root) if !self.is_inside(root, path) => Err(Unread::Outside),
            _ => self.read_named(path, most),
        }
    }

    /// Reads the bytes at `path`, at most `most`, wherever it is: the caller has the right to name
    /// it. Reads regular files only, because a pipe or a device might never end.
    pub(crate) fn read_named(&self, path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
        let bytes = match self.origin {
            Origin::Disk(root) => {
                let path = root.join(path);
                let regular = |kind: std::fs::Metadata| {
                    let is_folder = kind.is_dir();
                    kind.is_file()
                        .then_some(())
                        .ok_or(Unread::Irregular { is_folder })
                };
                // Check before opening, because a pipe would block, and after, because the file may
                // have been replaced.
                regular(std::fs::metadata(&path)?)?;
                let file = File::open(path)?;
                regular(file.metadata()?)?;
                let mut bytes = Vec::new();
                file.take(most + 1).read_to_end(&mut bytes)?;
                bytes
            }
            Origin::Held(files) => {
                let found = files.iter().find(|(name, _)| Path::new(name) == path);
                let (_, bytes) = found.ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?;
                bytes.to_vec()
            }
        };
        if bytes.len() as u64 > most {
            return Err(Unread::TooLarge);
        }
        Ok(bytes)
    }
}

/// Maximum number of dangling links that are followed one after another: more may form a cycle.
const MOST_LINKS: u32 = 40;

/// Resolves `path`, following at most `links` dangling links; parts that do not exist are resolved
/// lexically. The result is not absolute, and so below no folder, if `path` cannot be resolved.
fn real(path: &Path, links: u32) -> PathBuf {
    let here = Path::new(".");
    let path = if path == Path::new("") { here } else { path };
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let above = path.parent().filter(|_| path != here);
    let above = above.map(|above| real(above, links)).unwrap_or_default();
    if let Ok(target) = path.read_link() {
        let left = links.checked_sub(1);
        return left.map_or_else(PathBuf::new, |left| real(&above.join(target), left));
    }
    match path.components().next_back() {
        Some(Component::Normal(name)) => above.join(name),
        Some(Component::ParentDir) => above.parent().map(Path::to_path_buf).unwrap_or_default(),
        _ => above,
    }
}

/// The reason that a file cannot be read.
pub(crate) enum Unread {
    /// It lies outside the folders that may be read.
    Outside,
    /// It is not a regular file, but perhaps a folder.
    Irregular { is_folder: bool },
    /// It has more bytes than allowed.
    TooLarge,
    /// The error of the operating system.
    Failed(io::Error),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        Self::Failed(error)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;

    /// Checks that a link that leads outside is refused, whether its target exists or not.
    #[test]
    fn links_lead_outside_whether_there_is_something_or_not() {
        let name = format!("qrt-links-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let inside = folder.join("inside");
        fs::create_dir_all(&inside).unwrap();
        fs::write(folder.join("secret"), "").unwrap();
        let links = [
            ("to_secret", "../secret", false),
            ("to_nothing", "../nothing", false),
            ("to_absolute", "/no/such/file", false),
            ("to_own", "own", true),
            ("to_link", "to_nothing", false),
            ("first", "second", false),
            ("second", "first", false),
        ];
        for (link, target, _) in links {
            symlink(target, inside.join(link)).unwrap();
        }
        let files = Files::of_folder(&inside);
        for (link, _, is_inside) in links {
            let path = files.path(link);
            let read = files.read(&path, 1);
            let outside = matches!(read, Err(Unread::Outside));
            assert_eq!(outside, !is_inside, "{link}");
        }
        for (name, is_inside) in [
            ("none", true),
            ("none/../../secret", false),
            ("../none", false),
        ] {
            let outside = matches!(files.read(&files.path(name), 1), Err(Unread::Outside));
            assert_eq!(outside, !is_inside, "{name}");
        }
        fs::remove_dir_all(folder).unwrap();
    }
}
