//! Where the files come from that a scene names: a folder on disk, or bytes that a program holds.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// A scene's own files: its meshes and their material libraries.
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
        let origin = Origin::Disk(root);
        Self { folder, origin }
    }

    /// The files of these names and contents, and no others.
    pub fn held(files: &'a [(&'a str, &'a [u8])]) -> Self {
        Self {
            folder: Path::new(""),
            origin: Origin::Held(files),
        }
    }

    /// What errors call the file that the scene calls `name`.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The bytes at `path`, at most `most`. Only of a regular file: anything else (a pipe, a
    /// device) might never end. Whatever a front end reads, it reads here.
    pub(crate) fn read(&self, path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
        let bytes = match self.origin {
            Origin::Disk(root) => {
                let path = root.join(path);
                let kind = std::fs::metadata(&path)?;
                if !kind.is_file() {
                    let is_folder = kind.is_dir();
                    return Err(Unread::Irregular { is_folder });
                }
                let mut bytes = Vec::new();
                File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
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

/// Why a file cannot be read.
pub(crate) enum Unread {
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
