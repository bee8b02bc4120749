//! What the mesh files of a scene hold, as plain data. The front end reads them
//! ([`crate::front::obj`]); [`crate::valid::validate`] checks them along with the scene.

use super::{Mesh, Rgb};
use crate::syntax::codes;
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The meshes of a scene, or why they cannot be read. Entries that name one file share its mesh, and
/// so do copies of this.
#[derive(Clone, Debug)]
pub struct Meshes {
    read: BTreeMap<Key, Result<Arc<ObjMesh>, ObjError>>,
    most_faces: usize,
}

/// As many triangles a scene's meshes may have, each time they are placed, unless memory allows fewer.
pub const MOST_FACES: usize = 1 << 22;

/// A file as the scene calls it, and whether its own materials are wanted.
type Key = (String, bool);

impl Default for Meshes {
    fn default() -> Self {
        Self::of_most(MOST_FACES)
    }
}

impl Meshes {
    /// None yet, of a scene that may have so many faces.
    pub fn of_most(most_faces: usize) -> Self {
        let read = BTreeMap::new();
        Self { read, most_faces }
    }

    /// As many faces the scene may have with them.
    pub fn most_faces(&self) -> usize {
        self.most_faces
    }

    /// What an entry of the scene places.
    ///
    /// # Errors
    /// What is wrong with its file, or that nobody read it.
    pub fn get(&self, mesh: &Mesh) -> Result<&ObjMesh, ObjError> {
        let key = (mesh.obj.clone(), mesh.material.is_none());
        let Some(read) = self.read.get(&key) else {
            let message = format!("`{}` is not among the meshes that were read", mesh.obj);
            return Err(ObjError::new(codes::OBJ_UNREADABLE, message));
        };
        read.as_deref().map_err(ObjError::clone)
    }

    /// Adds the file that a scene calls `obj`, read with its own materials or without.
    pub fn insert(&mut self, obj: &str, own_materials: bool, read: Result<ObjMesh, ObjError>) {
        let key = (obj.to_owned(), own_materials);
        self.read.insert(key, read.map(Arc::new));
    }
}

/// A mesh as it is in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMesh {
    /// Triangles in the order of the file; a polygon is several.
    pub faces: Vec<ObjFace>,
    /// The materials of all its libraries; empty if they were not wanted.
    pub materials: Vec<ObjMaterial>,
    /// What was read: the file itself, then its libraries.
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

/// What is wrong with a file; codes are `QRT0320` to `QRT0344`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjError {
    /// The stable code of the error: `QRT0320`.
    pub code: &'static str,
    /// The file: the OBJ itself or one of its libraries.
    pub file: PathBuf,
    /// The line of the file, counted from 1; `None` if the error is of no single line.
    pub line: Option<usize>,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// What to do about it; `None` if nothing can be advised.
    pub help: Option<String>,
}

impl ObjError {
    /// An error whose place is still to be said.
    pub(crate) fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            code,
            file: PathBuf::new(),
            line: None,
            message: message.into(),
            help: None,
        }
    }

    /// In this file, at this line if it is of one.
    pub(crate) fn at(self, file: &Path, line: impl Into<Option<usize>>) -> Self {
        let (file, line) = (file.to_owned(), line.into());
        Self { file, line, ..self }
    }

    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        let help = Some(help.into());
        Self { help, ..self }
    }
}

impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {} ({})", self.message, self.code)
    }
}

impl std::error::Error for ObjError {}
