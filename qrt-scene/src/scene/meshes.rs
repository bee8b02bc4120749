//! The contents of a scene's mesh files, as plain data. The front end reads them
//! ([`crate::front::meshes`]); [`crate::valid::validate`] checks them along with the scene.

use super::{Material, Mesh, MeshFormat, Rgb};
use glam::DVec3;
use qrt_syntax::{MeshFile, What};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The meshes of a scene, or the errors of files that cannot be read. Entries that name the same
/// file share its mesh, and so do clones of this value.
#[derive(Clone, Debug)]
pub struct Meshes {
    read: BTreeMap<Key, Result<Arc<FileMesh>, FileError>>,
    most_faces: usize,
}

/// Maximum number of triangles of a scene's meshes, each placement counted, unless memory allows
/// fewer.
pub const MOST_FACES: usize = 1 << 22;

/// A file's format, its name as the scene writes it, and the parts that are read beside the shape.
type Key = (MeshFormat, String, Wanted);

/// The parts of a mesh file that are read beside its shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Wanted {
    /// True if the file's materials are read.
    pub materials: bool,
    /// True if the normals of corners are read.
    pub normals: bool,
    /// True if the colours of vertices are read. A file in which a vertex has none is then refused.
    pub colours: bool,
}

impl Wanted {
    /// All parts except colours, which most files lack.
    pub const USUAL: Self = Self {
        materials: true,
        normals: true,
        colours: false,
    };

    /// The parts that the entry `mesh` of a scene uses.
    pub(crate) fn of_mesh(mesh: &Mesh) -> Self {
        Self {
            materials: mesh.material.is_none(),
            normals: mesh.smooth.is_none(),
            colours: mesh.is_coloured(),
        }
    }
}

impl Default for Meshes {
    fn default() -> Self {
        Self::of_most(MOST_FACES)
    }
}

impl Meshes {
    /// Creates an empty set of meshes, for a scene of at most `most_faces` faces.
    pub(crate) fn of_most(most_faces: usize) -> Self {
        let read = BTreeMap::new();
        Self { read, most_faces }
    }

    /// Maximum number of faces of the scene, meshes included.
    pub(crate) fn most_faces(&self) -> usize {
        self.most_faces
    }

    /// Returns the mesh that the entry `mesh` of the scene places.
    ///
    /// # Errors
    /// The error of its file, or [`MeshFile::NotRead`] if the file was not read.
    pub fn get(&self, mesh: &Mesh) -> Result<&FileMesh, FileError> {
        let not_read = |name: &str| {
            let name = name.to_owned();
            FileError::new(MeshFile::NotRead { name }, "".as_ref(), FilePlace::Whole)
        };
        let (format, name) = mesh.file().ok_or_else(|| not_read(""))?;
        let key = (format, name.to_owned(), Wanted::of_mesh(mesh));
        let read = self.read.get(&key).ok_or_else(|| not_read(name))?;
        read.as_deref().map_err(FileError::clone)
    }

    /// Adds the result of reading the `wanted` parts of the file that a scene calls `name`.
    pub fn insert(
        &mut self,
        format: MeshFormat,
        name: &str,
        wanted: Wanted,
        read: Result<FileMesh, FileError>,
    ) {
        let key = (format, name.to_owned(), wanted);
        self.read.insert(key, read.map(Arc::new));
    }
}

/// A mesh as it is in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMesh {
    /// Triangles in the order of the file, each with an area and none of them twice; a polygon
    /// becomes several.
    pub faces: Vec<FileFace>,
    /// For each face, the unit normals of its corners. Empty if the mesh is flat or if normals were not
    /// wanted.
    pub normals: Vec<[DVec3; 3]>,
    /// For each face, the colours of its corners, linear RGB from 0 to 1. Empty if colours were not wanted.
    pub colours: Vec<[Rgb; 3]>,
    /// The materials of the faces; empty if they were not wanted.
    pub materials: Vec<FileMaterial>,
    /// The files that were read: the mesh file itself, then the files that it names.
    pub files: Vec<PathBuf>,
    /// Warnings about parts of the files that the mesh leaves out.
    pub notes: Vec<FileError>,
}

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileFace {
    /// Its corners, in the file's units.
    pub vertices: [DVec3; 3],
    /// The triangle's material, as an index into [`FileMesh::materials`]; `None` if materials were
    /// not wanted.
    pub material: Option<usize>,
}

/// A material of a mesh file that faces are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMaterial {
    /// The material's name in its file. A material of the scene with this name replaces it.
    pub name: String,
    /// `FILE.mtl:NAME`.
    pub label: String,
    /// The material, or the error of its definition, which does not matter if the scene replaces
    /// it.
    pub material: Result<Material, FileError>,
    /// Keywords of its definition that have no counterpart.
    pub left_out: BTreeSet<String>,
    /// The file that defines it.
    pub file: PathBuf,
    /// The place of the definition.
    pub place: FilePlace,
}

/// An error of a mesh file, or a warning; codes are `QRT0319` to `QRT0354`.
#[derive(Clone, Debug, PartialEq)]
pub struct FileError {
    /// The problem.
    pub what: Box<MeshFile>,
    /// The file: the mesh file itself or one that it names.
    pub file: PathBuf,
    /// The place in the file.
    pub place: FilePlace,
}

/// A place in a mesh file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilePlace {
    /// No single place.
    Whole,
    /// A line, counted from 1.
    Line(usize),
    /// An element of a binary file.
    Element {
        /// The kind of element: `vertex`.
        kind: Box<str>,
        /// Its number, counted from 0.
        number: usize,
        /// The place in the file, in bytes from its start.
        byte: usize,
    },
    /// A part of a JSON text, such as `meshes[0].primitives[1]`.
    Part(String),
}

impl From<usize> for FilePlace {
    fn from(line: usize) -> Self {
        Self::Line(line)
    }
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Element { kind, number, byte } => write!(f, ": {kind} {number}, byte {byte}"),
            Self::Part(part) => write!(f, ": {part}"),
        }
    }
}

impl FileError {
    /// Creates an error in `file`, at `place`.
    pub(crate) fn new(what: MeshFile, file: &Path, place: impl Into<FilePlace>) -> Self {
        let (what, file, place) = (Box::new(what), file.to_owned(), place.into());
        Self { what, file, place }
    }

    /// Converts the error to a problem of the scene that names the file.
    pub(crate) fn problem(self) -> What {
        let place = match self.place {
            FilePlace::Whole => String::new(),
            place => format!("{}{place}", self.file.display()),
        };
        let what = Box::new((*self.what).into());
        What::OfFile { what, place }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, file, place } = self;
        let words = what.description();
        let file = file.display();
        write!(f, "{file}{place}: {} ({})", words.message, words.code)
    }
}

impl std::error::Error for FileError {}
