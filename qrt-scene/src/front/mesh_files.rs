//! The mesh files of a scene: which of them are read, and within which limits.

use super::meshes::{Faces, bytes_of};
use super::{Files, gltf, obj, ply};
use crate::scene::meshes::{FileError, FilePlace, Meshes, Wanted};
use crate::scene::{Geometry, MeshFormat, Scene};
use qrt_syntax::MeshFile;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::rc::Rc;

/// Maximum number of bytes of a scene's meshes and the files that they name, for each allowed face:
/// 1 GiB in all, unless memory allows fewer faces.
const BYTES_OF_FACE: u64 = 256;

/// Reads the meshes that a scene names. Each file is read once, even if several entries name it.
pub fn load_all(scene: &Scene, files: Files<'_>) -> Meshes {
    let mut wanted = BTreeMap::<(MeshFormat, &str), BTreeSet<Wanted>>::new();
    for primitive in &scene.geometry {
        if let Geometry::Mesh(mesh) = primitive {
            let Some(file) = mesh.file() else { continue };
            let kinds = wanted.entry(file).or_default();
            kinds.insert(Wanted::of_mesh(mesh));
        }
    }
    let most_bytes = files.faces_allowed() as u64 * BYTES_OF_FACE;
    let bytes_left = Cell::new(most_bytes);
    let counted = |bytes: Rc<[u8]>| {
        let left = bytes_left.get().checked_sub(bytes.len() as u64);
        bytes_left.set(left.ok_or_else(|| {
            let most = most_bytes;
            MeshFile::ManyBytesInAll { most }
        })?);
        Ok(bytes)
    };
    let mut read = BTreeMap::new();
    let mut library = |path: &Path| {
        let bytes = || bytes_of(files, path, true).and_then(counted);
        read.entry(path.to_owned()).or_insert_with(bytes).clone()
    };
    let mut meshes = Meshes::of_most(files.faces_allowed());
    let mut faces = Faces::new(files.faces_allowed());
    for ((format, name), kinds) in wanted {
        let path = files.path(name);
        let bytes = bytes_of(files, &path, false).and_then(counted);
        for parts in kinds {
            let parsed = bytes
                .as_ref()
                .map_err(|what| FileError::new(what.clone(), &path, FilePlace::Whole))
                .and_then(|bytes| {
                    let library = &mut library;
                    match format {
                        MeshFormat::Obj => obj::parse(&path, bytes, parts, faces, library),
                        MeshFormat::Ply => ply::parse(&path, bytes, parts, faces),
                        MeshFormat::Gltf => gltf::parse(&path, bytes, parts, faces, library),
                    }
                });
            let mesh = parsed.inspect(|mesh| faces.left -= mesh.faces.len());
            meshes.insert(format, name, parts, mesh);
        }
    }
    meshes
}
