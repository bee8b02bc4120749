//! The parts that the readers of mesh files share: limits, libraries, and the faces read so far.

mod collect;
mod polygon;
pub(super) mod surface;

use super::{Files, Unread};
use crate::Rgb;
use crate::scene::meshes::MOST_FACES;
pub(super) use collect::{Collector, Corners, Normals};
use qrt_syntax::MeshFile;
use std::path::Path;
use std::rc::Rc;

/// The largest file that is read, in bytes: about five million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

/// The maximum number of triangles of a scene's meshes, and the number that no mesh has taken yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faces {
    pub(super) most: usize,
    pub(super) left: usize,
}

impl Faces {
    pub(super) fn new(most: usize) -> Self {
        Self { most, left: most }
    }
}

impl Default for Faces {
    fn default() -> Self {
        Self::new(MOST_FACES)
    }
}

/// A function that reads the bytes of a file that a mesh file names.
pub(super) type Library<'a> = &'a mut dyn FnMut(&Path) -> Result<Rc<[u8]>, MeshFile>;

/// Reads a whole file.
pub(super) fn bytes_of(
    files: Files<'_>,
    path: &Path,
    is_library: bool,
) -> Result<Rc<[u8]>, MeshFile> {
    let bytes = files.read(path, MAX_BYTES).map(Rc::from);
    bytes.map_err(|why| unread(files, path, is_library, why))
}

pub(super) fn unread(files: Files<'_>, path: &Path, is_library: bool, why: Unread) -> MeshFile {
    let file = path.to_owned();
    match why {
        Unread::TooLarge => MeshFile::ManyBytes { most: MAX_BYTES },
        Unread::Outside if files.are_of_crate() => MeshFile::OutsideCrate { file },
        Unread::Outside => MeshFile::OutsideScene { file },
        Unread::Irregular { .. } => MeshFile::Irregular { file, is_library },
        Unread::Failed(error) if error.kind() == std::io::ErrorKind::NotFound => {
            MeshFile::Missing { file, is_library }
        }
        Unread::Failed(error) => MeshFile::Failed {
            file,
            is_library,
            why: error.to_string(),
        },
    }
}

/// Returns a vertex's colour.
///
/// # Errors
/// A number that is not in [0, 1].
pub(super) fn colour(colour: Rgb) -> Result<Rgb, MeshFile> {
    match colour
        .into_iter()
        .find(|value| !(0.0..=1.0).contains(value))
    {
        Some(value) => Err(MeshFile::ColourRange { value }),
        None => Ok(colour),
    }
}
