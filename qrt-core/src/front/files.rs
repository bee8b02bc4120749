//! Where the files come from that a scene names: a folder on disk, or bytes that a program holds.

use crate::scene::meshes::MOST_FACES;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};

/// A scene's own files: its meshes and their material libraries.
///
/// A scene may come from a stranger, so of a disk only what lies below the scene's folder is read, links
/// followed, unless [`Files::allowing`] names other folders; and only regular files.
///
/// ```
/// use qrt_core::front::{Files, parse_with};
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
/// # Ok::<(), qrt_core::syntax::Report>(())
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
    /// Files that a program holds, by name and contents.
    Held(&'a [(&'a str, &'a [u8])]),
}

impl<'a> Files<'a> {
    /// The files of a folder on disk, which relative names start from.
    pub fn of_folder(folder: &'a Path) -> Self {
        Self::below(Path::new(""), folder)
    }

    /// The files of `folder`, itself relative to `root`; errors call them as seen from `root`.
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

    /// The same, and what lies below these folders on disk, which are relative to the current one.
    pub fn allowing(self, folders: &'a [PathBuf]) -> Self {
        Self {
            allowed: folders,
            ..self
        }
    }

    /// The same, with meshes of at most so many triangles in all, each time they are placed; by itself,
    /// [`MOST_FACES`].
    pub fn most_faces(self, most_faces: usize) -> Self {
        Self { most_faces, ..self }
    }

    /// The files of these names and contents, and no others.
    pub fn held(files: &'a [(&'a str, &'a [u8])]) -> Self {
        Self::new(Path::new(""), Origin::Held(files))
    }

    /// What errors call the file that the scene calls `name`.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub(crate) fn faces_allowed(&self) -> usize {
        self.most_faces
    }

    /// What stands around the scene's files, in words.
    pub(crate) fn boundary(&self) -> [&'static str; 2] {
        match self.origin {
            Origin::Disk(root) if root != Path::new("") => [
                "the crate's folder",
                "`qrt!` reads files of the crate alone",
            ],
            _ => [
                "the scene's folder",
                "put it there, or allow its folder: `--allow-files DIR`",
            ],
        }
    }

    /// Whether `path` leads to a place below the scene's folder, or below one that is allowed.
    fn is_inside(&self, root: &Path, path: &Path) -> bool {
        let path = real(&root.join(path));
        let folder = root.join(self.folder);
        std::iter::once(&folder)
            .chain(self.allowed)
            .any(|folder| path.starts_with(real(folder)))
    }

    /// The bytes at `path`, at most `most`, if it is inside. Whatever a front end reads, it reads here or
    /// by [`Files::read_named`].
    pub(crate) fn read(&self, path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
        match self.origin {
            Origin::Disk(root) if !self.is_inside(root, path) => Err(Unread::Outside),
            _ => self.read_named(path, most),
        }
    }

    /// The bytes at `path`, at most `most`, wherever it is: somebody named it who may. Only of a regular
    /// file: anything else (a pipe, a device) might never end.
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
                // Before it is opened, for a pipe would wait; and after, for it may be another by then.
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

/// Where `path` leads, links followed as far as there are files; the rest is taken by its words.
fn real(path: &Path) -> PathBuf {
    let path = if path == Path::new("") {
        Path::new(".")
    } else {
        path
    };
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    if path == Path::new(".") {
        return path.to_path_buf();
    }
    let above = path.parent().map(real).unwrap_or_default();
    if let Ok(target) = path.read_link() {
        // It leads to nothing; and where it leads to is not known before there is something.
        return if target.is_absolute() {
            target
        } else {
            above.join("..").join("..").join(target)
        };
    }
    match path.components().next_back() {
        Some(Component::Normal(name)) => above.join(name),
        Some(Component::ParentDir) => above.parent().map(Path::to_path_buf).unwrap_or_default(),
        _ => above,
    }
}

/// Why a file cannot be read.
pub(crate) enum Unread {
    /// It lies outside the folders that may be read.
    Outside,
    /// It is not a regular file, but perhaps a folder.
    Irregular { is_folder: bool },
    /// It has more bytes than may be.
    TooLarge,
    /// What the system says.
    Failed(io::Error),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        Self::Failed(error)
    }
}
