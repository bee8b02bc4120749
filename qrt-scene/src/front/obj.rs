//! Meshes from Wavefront OBJ files, with the materials of their MTL files.
//!
//! `tobj` reads the shape, but it accepts invalid meshes (NaN vertices, faces of two corners),
//! supports neither continued lines nor comments after a statement, and reports no line. So it
//! reads through a `Scanner`, which checks each statement and passes vertices and faces on. The
//! module `polygon` then cuts the faces into triangles.
//!
//! A material's `Kd` is the albedo of a Lambertian surface, and `Ke` its radiance. Highlights and
//! transparency of an MTL file are ignored. `tobj` panics on a colour of one number, which is a
//! grey, or of two, so `mtl` reads colours.

mod mtl;
mod polygon;
mod scan;
#[cfg(test)]
mod tests;

use super::{Files, Unread};
use crate::scene::meshes::{MOST_FACES, Meshes, ObjError, ObjFace, ObjMesh};
use crate::scene::{Geometry, Scene};
use crate::syntax::{MeshFile, line_after, line_starts};
use glam::DVec3;
use mtl::Materials;
use scan::Scanner;
use std::borrow::Cow;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use std::path::Path;
use std::rc::Rc;

/// The largest file that is read, in bytes: about five million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

/// Maximum number of bytes of a scene's meshes and material libraries for each allowed face: 1 GiB
/// in all, unless memory allows fewer faces.
const BYTES_OF_FACE: u64 = 256;

/// Reads the meshes that a scene names. Each file is read once, even if several entries name it.
pub fn load_all(scene: &Scene, files: Files<'_>) -> Meshes {
    let mut wanted = BTreeMap::<&str, BTreeSet<bool>>::new();
    for primitive in &scene.geometry {
        if let Geometry::Mesh(mesh) = primitive {
            let kinds = wanted.entry(&mesh.obj).or_default();
            kinds.insert(mesh.material.is_none());
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
    for (name, kinds) in wanted {
        let path = files.path(name);
        let bytes = bytes_of(files, &path, false).and_then(counted);
        for wants_materials in kinds {
            let parsed = bytes
                .as_ref()
                .map_err(|what| ObjError::new(what.clone(), &path, None))
                .and_then(|bytes| parse(&path, bytes, wants_materials, faces, &mut library));
            let mesh = parsed.inspect(|mesh| faces.left -= mesh.faces.len());
            meshes.insert(name, wants_materials, mesh);
        }
    }
    meshes
}

/// Reads a mesh, and with `wants_materials` the libraries that it names, which stand beside it or below
/// its folder.
///
/// ```
/// use qrt_scene::front::obj;
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.obj", std::process::id()));
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let square = obj::load(&path, false)?;
/// assert_eq!(square.faces.len(), 2);
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first problem of the file: see [`ObjError`].
pub fn load(path: &Path, wants_materials: bool) -> Result<ObjMesh, ObjError> {
    let files = Files::of_folder(path.parent().unwrap_or(Path::new("")));
    let bytes = files.read_named(path, MAX_BYTES);
    let bytes: Rc<[u8]> = bytes
        .map_err(|why| ObjError::new(unread(files, path, false, why), path, None))?
        .into();
    let mut library = |path: &Path| bytes_of(files, path, true);
    parse(
        path,
        &bytes,
        wants_materials,
        Faces::new(MOST_FACES),
        &mut library,
    )
}

/// The maximum number of triangles of a scene's meshes, and the number that no mesh has taken yet.
#[derive(Clone, Copy, Debug)]
struct Faces {
    most: usize,
    left: usize,
}

impl Faces {
    fn new(most: usize) -> Self {
        Self { most, left: most }
    }
}

/// Reads a whole file.
fn bytes_of(files: Files<'_>, path: &Path, is_library: bool) -> Result<Rc<[u8]>, MeshFile> {
    let bytes = files.read(path, MAX_BYTES).map(Rc::from);
    bytes.map_err(|why| unread(files, path, is_library, why))
}

fn unread(files: Files<'_>, path: &Path, is_library: bool, why: Unread) -> MeshFile {
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

/// A function that reads the bytes of a material library.
type Library<'a> = &'a mut dyn FnMut(&Path) -> Result<Rc<[u8]>, MeshFile>;

/// Reads a mesh as [`load`] does, from its bytes.
fn parse(
    path: &Path,
    bytes: &[u8],
    wants_materials: bool,
    faces: Faces,
    library: Library<'_>,
) -> Result<ObjMesh, ObjError> {
    let text = text_of(path, bytes)?;
    let mut scanner = Scanner::new(path, &text, wants_materials, faces);
    let mut shape = BufReader::new(&mut scanner);
    // The scanner passes no `mtllib` on.
    let no_library = |_: &Path| tobj::load_mtl_buf(&mut std::io::empty());
    let read = tobj::load_obj_buf(&mut shape, &tobj::LoadOptions::default(), no_library);
    let (models, _) = read.map_err(|error| {
        scanner.fault.take().unwrap_or_else(|| {
            let why = error.to_string();
            ObjError::new(MeshFile::Refused { why }, path, None)
        })
    })?;
    let mut files = vec![path.to_owned()];
    let materials = Materials::read(path, &scanner.libraries, library, &mut files)?;
    let uses = scanner.uses.iter().map(|(name, line)| {
        let found = materials.find(name, scanner.libraries.is_empty());
        found.map_err(|what| ObjError::new(what, path, *line))
    });
    let uses: Vec<usize> = uses.collect::<Result<_, _>>()?;

    // The scanner passes no groups on either, so there is one model.
    let mesh = models.into_iter().next().map(|model| model.mesh);
    let mesh = mesh.unwrap_or_default();
    let corner = |index: &u32| DVec3::from_slice(&mesh.positions[3 * *index as usize..]);
    let mut corners = mesh.indices.iter().map(corner);
    let mut faces = Vec::with_capacity(scanner.triangles);
    for (number, (line, use_before)) in scanner.faces.iter().enumerate() {
        // Without arities, every face is a triangle.
        let arity = mesh.face_arities.get(number).map_or(3, |n| *n as usize);
        let face: Vec<DVec3> = corners.by_ref().take(arity).collect();
        let triangles = polygon::triangles(&face);
        let triangles = triangles.map_err(|what| ObjError::new(what, path, *line))?;
        let material = use_before.map(|number| uses[number]);
        faces.extend(
            triangles
                .into_iter()
                .map(|vertices| ObjFace { vertices, material }),
        );
    }
    Ok(ObjMesh {
        faces,
        materials: materials.into_list(),
        files,
    })
}

/// Returns a file as text. Bytes that are not UTF-8 do no harm in a comment.
fn text_of<'a>(path: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, ObjError> {
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        let line = line_after(&bytes[..at]);
        return Err(ObjError::new(MeshFile::NotText, path, line));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    Ok(String::from_utf8_lossy(bytes))
}

/// Iterates over the statements of a text, each with the line it starts in. Comment lines and blank
/// lines are left out, continued lines joined, and surrounding blanks trimmed.
///
/// A backslash at the end of a line continues it, unless it belongs to a comment, which ends with its line.
fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = (1..).zip(lines(text).map(str::trim));
    let next = move || {
        let (line, first) = lines.next()?;
        let mut text = Cow::Borrowed(first);
        // None of the lines before the last has a comment: it would have ended the statement.
        let mut commented = has_comment(first);
        while !commented
            && text.ends_with('\\')
            && let Some((_, next)) = lines.next()
        {
            commented = has_comment(next);
            let joined = text.to_mut();
            joined.pop();
            joined.truncate(joined.trim_end().len());
            if !(joined.is_empty() || next.is_empty()) {
                joined.push(' ');
            }
            joined.push_str(next);
        }
        Some((line, text))
    };
    std::iter::from_fn(next).filter(|(_, text)| !(text.is_empty() || text.starts_with('#')))
}

/// Iterates over the lines of a text, without their terminators except perhaps a CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let ends = line_starts(text.as_bytes()).map(Some).chain([None]);
    let mut start = 0;
    ends.map(move |end| {
        let line = &text[start..end.map_or(text.len(), |end| end - 1)];
        start = end.unwrap_or(text.len());
        line
    })
}

/// True if a statement goes on in the next line.
fn is_continued(text: &str) -> bool {
    text.ends_with('\\') && !has_comment(text)
}

/// True if there is a comment in a text.
fn has_comment(text: &str) -> bool {
    text.split_whitespace().any(|word| word.starts_with('#'))
}

/// Splits a statement into its keyword and the rest.
fn split(statement: &str) -> Result<(&str, &str), MeshFile> {
    if is_continued(statement) {
        return Err(MeshFile::Continued);
    }
    let parts = statement.split_once(char::is_whitespace);
    let (keyword, rest) = parts.unwrap_or((statement, ""));
    Ok((keyword, rest.trim_start()))
}

/// The words of a statement up to a comment.
fn tokens(text: &str) -> impl Iterator<Item = &str> {
    text.split_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// The finite numbers of a statement, the first `most` of them.
fn numbers(text: &str, most: usize, is_library: bool) -> Result<Vec<f64>, MeshFile> {
    let number = |text: &str| {
        let (value, word) = (text.parse::<f64>(), text.to_owned());
        match value {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(MeshFile::NotFinite { word, is_library }),
            Err(_) => Err(MeshFile::NotANumber { word, is_library }),
        }
    };
    tokens(text).take(most).map(number).collect()
}

/// Returns the name after `keyword`, which must not be empty and must be UTF-8.
fn name(keyword: &str, name: &str, nameless: MeshFile) -> Result<String, MeshFile> {
    if name.is_empty() {
        return Err(nameless);
    }
    if name.contains(char::REPLACEMENT_CHARACTER) {
        let keyword = keyword.to_owned();
        return Err(MeshFile::NameNotText { keyword });
    }
    Ok(name.to_owned())
}
