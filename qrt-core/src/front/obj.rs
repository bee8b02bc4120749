//! Meshes from Wavefront OBJ files, with the materials of their MTL files.
//!
//! `tobj` reads the shape, but it accepts what is no mesh (NaN vertices, faces of two corners),
//! knows no continued lines and no comment after a statement, and names no line. So it reads
//! through a `Scanner`, which checks each statement and hands on vertices and faces; the faces are
//! then cut into triangles (`polygon`).
//!
//! Of a material, `Kd` is the albedo of a Lambertian surface and `Ke` its radiance; what an MTL
//! file says about highlights and transparency has no part in a scene. `tobj` panics on a colour
//! of one number, which is a grey, or of two: `mtl` reads them.

mod mtl;
mod polygon;
mod scan;
#[cfg(test)]
mod tests;

use super::{Files, Unread};
use crate::scene::meshes::{MOST_FACES, Meshes, ObjError, ObjFace, ObjMesh};
use crate::scene::{Geometry, Scene};
use crate::syntax::codes;
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

/// Bytes that a scene's meshes and material libraries may have for each face that it may have: 1 GiB in all,
/// unless memory allows fewer faces.
const BYTES_OF_FACE: u64 = 256;

/// The meshes that a scene names. Each file is read once, however many entries name it.
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
    let counted = |path: &Path, bytes: Rc<[u8]>| {
        let left = bytes_left.get().checked_sub(bytes.len() as u64);
        bytes_left.set(left.ok_or_else(|| {
            let most = most_bytes >> 20;
            let message = format!("with this file the scene's meshes exceed {most} MiB");
            too_large(message).at(path, None)
        })?);
        Ok(bytes)
    };
    let mut read = BTreeMap::new();
    let mut library = |path: &Path| {
        let bytes =
            || bytes_of(files, path, codes::MTL_UNREADABLE).and_then(|it| counted(path, it));
        read.entry(path.to_owned()).or_insert_with(bytes).clone()
    };
    let mut meshes = Meshes::of_most(files.faces_allowed());
    let mut faces = Faces::of(files.faces_allowed());
    for (name, kinds) in wanted {
        let path = files.path(name);
        let bytes = bytes_of(files, &path, codes::OBJ_UNREADABLE).and_then(|it| counted(&path, it));
        for wants_materials in kinds {
            let parsed = bytes
                .as_ref()
                .map_err(ObjError::clone)
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
/// use qrt_core::front::obj;
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
        .map_err(|why| unread(files, path, codes::OBJ_UNREADABLE, why))?
        .into();
    let mut library = |path: &Path| bytes_of(files, path, codes::MTL_UNREADABLE);
    parse(
        path,
        &bytes,
        wants_materials,
        Faces::of(MOST_FACES),
        &mut library,
    )
}

/// The triangles that a scene's meshes may have, and as many of them that none has taken yet.
#[derive(Clone, Copy, Debug)]
struct Faces {
    most: usize,
    left: usize,
}

impl Faces {
    fn of(most: usize) -> Self {
        Self { most, left: most }
    }
}

fn too_large(message: String) -> ObjError {
    ObjError::new(codes::OBJ_TOO_LARGE, message).help("use a coarser mesh")
}

/// The whole of a file.
fn bytes_of(files: Files<'_>, path: &Path, code: &'static str) -> Result<Rc<[u8]>, ObjError> {
    let bytes = files.read(path, MAX_BYTES).map(Rc::from);
    bytes.map_err(|why| unread(files, path, code, why))
}

/// Why a file was not read, in words.
fn unread(files: Files<'_>, path: &Path, code: &'static str, why: Unread) -> ObjError {
    let error = match why {
        Unread::TooLarge => too_large(format!("the file is larger than {} MiB", MAX_BYTES >> 20)),
        Unread::Outside => {
            let [boundary, help] = files.boundary();
            let message = format!("`{}` is outside {boundary}", path.display());
            ObjError::new(codes::OUTSIDE, message).help(help)
        }
        Unread::Irregular { .. } => {
            ObjError::new(code, format!("`{}` is not a regular file", path.display()))
        }
        Unread::Failed(error) => {
            let why = match error.kind() {
                std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
                _ => error.to_string(),
            };
            ObjError::new(code, format!("cannot read `{}`: {why}", path.display()))
                .help("relative names are looked up beside the file that names them")
        }
    };
    error.at(path, None)
}

/// The bytes of a material library.
type Library<'a> = &'a mut dyn FnMut(&Path) -> Result<Rc<[u8]>, ObjError>;

/// As [`load`], of the bytes themselves.
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
    // The scanner hands on no `mtllib`.
    let no_library = |_: &Path| tobj::load_mtl_buf(&mut std::io::empty());
    let read = tobj::load_obj_buf(&mut shape, &tobj::LoadOptions::default(), no_library);
    let (models, _) = read.map_err(|error| {
        scanner.fault.take().unwrap_or_else(|| {
            let message = format!("the file cannot be read as an OBJ mesh: {error}");
            ObjError::new(codes::OBJ_REFUSED, message).at(path, None)
        })
    })?;
    let mut files = vec![path.to_owned()];
    let materials = Materials::read(path, &scanner.libraries, library, &mut files)?;
    let uses = scanner.uses.iter().map(|(name, line)| {
        let found = materials.find(name, scanner.libraries.is_empty());
        found.map_err(|error| error.at(path, *line))
    });
    let uses: Vec<usize> = uses.collect::<Result<_, _>>()?;

    // It hands on no groups either: all is one model.
    let mesh = models.into_iter().next().map(|model| model.mesh);
    let mesh = mesh.unwrap_or_default();
    let corner = |index: &u32| DVec3::from_slice(&mesh.positions[3 * *index as usize..]);
    let mut corners = mesh.indices.iter().map(corner);
    let mut faces = Vec::with_capacity(scanner.triangles);
    for (number, (line, use_before)) in scanner.faces.iter().enumerate() {
        // Without arities, every face is a triangle.
        let arity = mesh.face_arities.get(number).map_or(3, |n| *n as usize);
        let face: Vec<DVec3> = corners.by_ref().take(arity).collect();
        let triangles = polygon::triangles(&face).map_err(|error| error.at(path, *line))?;
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

/// A file as text. Bytes that are not UTF-8 do no harm in a comment.
fn text_of<'a>(path: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, ObjError> {
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        let line = bytes[..at].split(|byte| *byte == b'\n').count();
        return Err(ObjError::new(codes::OBJ_NOT_TEXT, "this is not a text file").at(path, line));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    Ok(String::from_utf8_lossy(bytes))
}

/// The statements of a text, each with the line it starts in: comments and blank lines left out,
/// continued lines joined, no blanks around them.
fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = (1..).zip(text.split('\n').map(str::trim));
    let next = move || {
        let (line, first) = lines.find(|(_, text)| !text.is_empty() && !text.starts_with('#'))?;
        let mut text = Cow::Borrowed(first);
        while text.ends_with('\\')
            && let Some((_, next)) = lines.next()
        {
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
    std::iter::from_fn(next).filter(|(_, text)| !text.is_empty())
}

/// The keyword of a statement, and what follows it.
fn split(statement: &str) -> Result<(&str, &str), ObjError> {
    if statement.ends_with('\\') {
        let message = "the file ends within a continued line";
        return Err(ObjError::new(codes::OBJ_CONTINUATION, message).help("is the file whole?"));
    }
    let parts = statement.split_once(char::is_whitespace);
    let (keyword, rest) = parts.unwrap_or((statement, ""));
    Ok((keyword, rest.trim_start()))
}

/// The words of a statement up to a comment.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// The finite numbers of a statement, the first `most` of them.
fn numbers(text: &str, most: usize) -> Result<Vec<f64>, ObjError> {
    let number = |word: &str| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err((
            codes::OBJ_NOT_FINITE,
            format!("`{word}` is not a finite number"),
        )),
        Err(_) => Err((codes::OBJ_NUMBER, format!("`{word}` is not a number"))),
    };
    let numbers = words(text).take(most).map(number).collect::<Result<_, _>>();
    numbers.map_err(|(code, message)| ObjError::new(code, message))
}

/// The name after a keyword, which must be there and be text.
fn name(keyword: &str, name: &str, nameless: &'static str) -> Result<String, ObjError> {
    if name.is_empty() {
        return Err(ObjError::new(
            nameless,
            format!("`{keyword}` without a name"),
        ));
    }
    if name.contains(char::REPLACEMENT_CHARACTER) {
        let message = format!("the name after `{keyword}` is not UTF-8 text");
        return Err(ObjError::new(codes::OBJ_NOT_TEXT, message));
    }
    Ok(name.to_owned())
}
