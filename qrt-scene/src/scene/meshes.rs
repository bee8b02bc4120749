//! The contents of a scene's mesh files, as plain data. The front end reads them
//! ([`crate::front::obj`]); [`crate::valid::validate`] checks them along with the scene.

use super::{Mesh, Rgb};
use crate::syntax::{MeshFile, What};
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The meshes of a scene, or the errors of files that cannot be read. Entries that name the same
/// file share its mesh, and so do clones of this value.
#[derive(Clone, Debug)]
pub struct Meshes {
    read: BTreeMap<Key, Result<Arc<ObjMesh>, ObjError>>,
    most_faces: usize,
}

/// Maximum number of triangles of a scene's meshes, each placement counted, unless memory allows
/// fewer.
pub const MOST_FACES: usize = 1 << 22;

/// A file name as the scene writes it, and true if the file's own materials are read.
type Key = (String, bool);

impl Default for Meshes {
    fn default() -> Self {
        Self::of_most(MOST_FACES)
    }
}

impl Meshes {
    /// Creates an empty set of meshes, for a scene of at most `most_faces` faces.
    pub fn of_most(most_faces: usize) -> Self {
        let read = BTreeMap::new();
        Self { read, most_faces }
    }

    /// Maximum number of faces of the scene, meshes included.
    pub fn most_faces(&self) -> usize {
        self.most_faces
    }

    /// Returns the mesh that the entry `mesh` of the scene places.
    ///
    /// # Errors
    /// The error of its file, or [`MeshFile::NotRead`] if the file was not read.
    pub fn get(&self, mesh: &Mesh) -> Result<&ObjMesh, ObjError> {
        let key = (mesh.obj.clone(), mesh.material.is_none());
        let Some(read) = self.read.get(&key) else {
            let name = mesh.obj.clone();
            return Err(ObjError::new(MeshFile::NotRead { name }, "".as_ref(), None));
        };
        read.as_deref().map_err(ObjError::clone)
    }

    /// Adds the result of reading the file that a scene names `obj`, with its own materials or
    /// without.
    pub fn insert(&mut self, obj: &str, own_materials: bool, read: Result<ObjMesh, ObjError>) {
        let key = (obj.to_owned(), own_materials);
        self.read.insert(key, read.map(Arc::new));
    }
}

/// A mesh as it is in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMesh {
    /// Triangles in the order of the file; a polygon becomes several.
    pub faces: Vec<ObjFace>,
    /// The materials of all its libraries; empty if they were not wanted.
    pub materials: Vec<ObjMaterial>,
    /// The files that were read: the OBJ file itself, then its libraries.
    pub files: Vec<PathBuf>,
}

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjFace {
    /// Its corners, in the file's units.
    pub vertices: [DVec3; 3],
    /// The triangle's material, as an index into [`ObjMesh::materials`]; `None` if materials were
    /// not wanted.
    pub material: Option<usize>,
}

/// A material of an MTL file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMaterial {
    /// `FILE.mtl:NAME`.
    pub name: String,
    /// `Ke`, or black.
    pub radiance: Rgb,
    /// `Kd`, or black.
    pub albedo: Rgb,
}

/// An error of a mesh file; codes are `QRT0319` to `QRT0344`.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjError {
    /// The problem.
    pub what: MeshFile,
    /// The file: the OBJ itself or one of its libraries.
    pub file: PathBuf,
    /// The line of the file, counted from 1; `None` if the error concerns no single line.
    pub line: Option<usize>,
}

impl ObjError {
    /// Creates an error in `file`, at `line` if it concerns one.
    pub(crate) fn new(what: MeshFile, file: &Path, line: impl Into<Option<usize>>) -> Self {
        let (file, line) = (file.to_owned(), line.into());
        Self { what, file, line }
    }

    /// Converts the error to a problem of the scene that names the file.
    pub(crate) fn problem(self) -> What {
        let place = self.line.map_or_else(String::new, |line| {
            format!("{}:{line}", self.file.display())
        });
        let what = Box::new(self.what.into());
        What::OfFile { what, place }
    }
}

impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        let words = self.what.description();
        write!(f, ": {} ({})", words.message, words.code)
    }
}

impl std::error::Error for ObjError {}
