//! Meshes from Wavefront OBJ files, with the materials of their MTL files.
//!
//! `tobj` reads the shape, but it accepts what is no mesh (NaN vertices, faces of two corners),
//! knows no continued lines and no comment behind a statement, and names no line. So it reads
//! through a [`Scanner`], which checks statement by statement and hands on the vertices and faces;
//! the faces are then cut into triangles (`polygon`).
//!
//! Of a material, `Kd` is the albedo of a Lambertian surface and `Ke` its radiance; what an MTL
//! file says about highlights and transparency has no part in a scene. (`tobj` reads no grey in a
//! single number, and panics on two, so that `mtl` reads these colours.)

mod mtl;
mod polygon;
mod scan;
#[cfg(test)]
mod tests;

use super::Files;
use super::files::Unread;
use crate::codes;
use crate::scene::meshes::{Meshes, ObjError, ObjFace, ObjMesh};
use crate::scene::{Geometry, Scene};
use glam::DVec3;
use mtl::{Libraries, Materials};
use scan::Scanner;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The largest file that is read, in bytes: about five million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

/// The meshes that a scene names. Each file is read once, however many entries name it.
pub fn load_all(scene: &Scene, files: Files<'_>) -> Meshes {
    let mut wanted = BTreeMap::<&str, BTreeSet<bool>>::new();
    for primitive in &scene.geometry {
        if let Geometry::Mesh(mesh) = primitive {
            let kinds = wanted.entry(&mesh.obj).or_default();
            kinds.insert(mesh.material.is_none());
        }
    }
    let mut libraries = Libraries::of(files);
    let mut meshes = Meshes::default();
    for (name, kinds) in wanted {
        let path = files.path(name);
        let bytes = bytes_of(files, &path, codes::OBJ_UNREADABLE);
        for wants_materials in kinds {
            let read = bytes.as_ref().map_err(ObjError::clone);
            let mesh = read.and_then(|bytes| parse(&path, bytes, wants_materials, &mut libraries));
            meshes.insert(name, wants_materials, mesh);
        }
    }
    meshes
}

/// Reads a mesh, and with `wants_materials` the libraries that it names, which stand beside it.
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
    let files = Files::of_folder("".as_ref());
    let bytes = bytes_of(files, path, codes::OBJ_UNREADABLE)?;
    parse(path, &bytes, wants_materials, &mut Libraries::of(files))
}

/// The whole of a file.
fn bytes_of(files: Files<'_>, path: &Path, code: &'static str) -> Result<Vec<u8>, ObjError> {
    let unreadable = |why| {
        let path = path.display();
        match why {
            Unread::TooLarge(_) => {
                ObjError::new(codes::OBJ_TOO_LARGE, why.to_string()).help("use a coarser mesh")
            }
            Unread::Irregular { .. } => {
                ObjError::new(code, format!("`{path}` is not a regular file"))
            }
            Unread::Failed(_) => ObjError::new(code, format!("cannot read `{path}`: {why}"))
                .help("relative names are looked up beside the file that names them"),
        }
    };
    let read = files.read(path, MAX_BYTES);
    read.map_err(|why| unreadable(why).at(path, None))
}

/// As [`load`], of the bytes themselves.
fn parse(
    path: &Path,
    bytes: &[u8],
    wants_materials: bool,
    libraries: &mut Libraries<'_>,
) -> Result<ObjMesh, ObjError> {
    let text = String::from_utf8_lossy(bytes);
    let mut scanner = Scanner::new(path, &text, wants_materials);
    let options = tobj::LoadOptions::default();
    // The scanner hands on no `mtllib`.
    let no_library = |_: &Path| tobj::load_mtl_buf(&mut std::io::empty());
    let models = match tobj::load_obj_buf(&mut scanner, &options, no_library) {
        Ok((models, _)) => models,
        Err(error) => {
            return Err(scanner.fault.unwrap_or_else(|| {
                let message = format!("the file cannot be read as an OBJ mesh: {error}");
                ObjError::new(codes::OBJ_REFUSED, message).at(path, None)
            }));
        }
    };
    let mut materials = Materials::default();
    let mut files = vec![path.to_owned()];
    materials.read_all(path, &scanner.libraries, libraries, &mut files)?;
    let find = |(name, line): &(String, usize)| {
        let found = materials.find(name).map_err(|error| {
            if !scanner.libraries.is_empty() {
                return error;
            }
            let help = "the file names no material library: a `mtllib` statement is missing";
            ObjError::new(codes::OBJ_NO_LIBRARY, error.message).help(help)
        });
        found.map_err(|error| error.at(path, *line))
    };
    let uses: Vec<usize> = scanner.uses.iter().map(find).collect::<Result<_, _>>()?;

    let mut faces = Vec::new();
    let mut lines = scanner.faces.iter();
    for mesh in models.iter().map(|model| &model.mesh) {
        // Without arities, every face is a triangle.
        let triangles = mesh.indices.len() / 3 * usize::from(mesh.face_arities.is_empty());
        let arities = mesh.face_arities.iter().map(|n| *n as usize);
        let mut rest = &mesh.indices[..];
        for arity in arities.chain(std::iter::repeat_n(3, triangles)) {
            let (face, others) = rest.split_at(arity);
            rest = others;
            let corner = |index: &u32| DVec3::from_slice(&mesh.positions[*index as usize * 3..]);
            let corners: Vec<DVec3> = face.iter().map(corner).collect();
            let (line, use_before) = lines.next().copied().unwrap_or_default();
            let triangles = polygon::triangles(&corners).map_err(|error| error.at(path, line))?;
            let material = use_before.map(|number| uses[number]);
            faces.extend(
                triangles
                    .into_iter()
                    .map(|vertices| ObjFace { vertices, material }),
            );
        }
    }
    Ok(ObjMesh {
        faces,
        materials: materials.into_list(),
        files,
    })
}

/// Lines as statements: comments and blank lines left out, continued lines joined.
struct Statements<'a> {
    path: &'a Path,
    lines: std::iter::Enumerate<std::str::Split<'a, char>>,
}

/// One statement: the line it starts in, and its text without blanks around it.
struct Statement<'a> {
    line: usize,
    text: Cow<'a, str>,
}

impl<'a> Statements<'a> {
    fn new(path: &'a Path, text: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = text.split('\n').enumerate();
        Self { path, lines }
    }

    fn next(&mut self) -> Result<Option<Statement<'a>>, ObjError> {
        while let Some((line, text)) = self.line()? {
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let mut text = Cow::Borrowed(text);
            while text.ends_with('\\') {
                let Some((_, next)) = self.line()? else {
                    let message = "the file ends within a continued line";
                    return Err(ObjError::new(codes::OBJ_CONTINUATION, message)
                        .help("is the file whole?")
                        .at(self.path, line));
                };
                let joined = text.to_mut();
                joined.pop();
                joined.truncate(joined.trim_end().len());
                if !(joined.is_empty() || next.is_empty()) {
                    joined.push(' ');
                }
                joined.push_str(next);
            }
            if !text.is_empty() {
                return Ok(Some(Statement { line, text }));
            }
        }
        Ok(None)
    }

    /// A line's number and its text without blanks around it.
    fn line(&mut self) -> Result<Option<(usize, &'a str)>, ObjError> {
        let Some((index, text)) = self.lines.next() else {
            return Ok(None);
        };
        if text.contains('\0') {
            let error = ObjError::new(codes::OBJ_NOT_TEXT, "this is not a text file");
            return Err(error.at(self.path, index + 1));
        }
        Ok(Some((index + 1, text.trim())))
    }
}

impl Statement<'_> {
    /// The keyword and what follows it.
    fn split(&self) -> (&str, &str) {
        let parts = self.text.split_once(char::is_whitespace);
        let (keyword, rest) = parts.unwrap_or((&self.text, ""));
        (keyword, rest.trim_start())
    }
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
        Ok(_) => {
            let message = format!("`{word}` is not a finite number");
            Err(ObjError::new(codes::OBJ_NOT_FINITE, message))
        }
        Err(_) => {
            let message = format!("`{word}` is not a number");
            Err(ObjError::new(codes::OBJ_NUMBER, message))
        }
    };
    words(text).take(most).map(number).collect()
}

/// A name after `keyword`, which is not empty and is text.
fn name<'a>(keyword: &str, name: &'a str, nameless: &'static str) -> Result<&'a str, ObjError> {
    if name.is_empty() {
        return Err(ObjError::new(
            nameless,
            format!("`{keyword}` without a name"),
        ));
    }
    // Bytes that are not UTF-8 do no harm in a comment.
    if name.contains(char::REPLACEMENT_CHARACTER) {
        let message = format!("the name after `{keyword}` is not UTF-8 text");
        return Err(ObjError::new(codes::OBJ_NOT_TEXT, message));
    }
    Ok(name)
}
