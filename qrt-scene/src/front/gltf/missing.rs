//! The error of a build without the feature `gltf`.

use crate::front::meshes::{Faces, Library};
use crate::scene::meshes::{FileError, FileMesh, FilePlace, Wanted};
use qrt_syntax::MeshFile;
use std::path::Path;

/// Refuses the file at `path`.
pub(in crate::front) fn parse(
    path: &Path,
    _: &[u8],
    _: Wanted,
    _: Faces,
    _: Library<'_>,
) -> Result<FileMesh, FileError> {
    Err(FileError::new(MeshFile::NoGltf, path, FilePlace::Whole))
}
