//! Meshes from Wavefront OBJ files, with the materials of their MTL files.
//!
//! `tobj` reads the files, but it accepts what is no mesh (NaN vertices, faces of two corners,
//! materials that no library has), panics on a colour of two numbers, and names no lines. So the
//! text is first checked statement by statement and brought into a plain form (`scan`, `mtl`):
//! joined continuations, vertices first, positive indices. What stands in that form `tobj` reads
//! without surprises, and its faces are then cut into triangles (`polygon`).
//!
//! Of a material, `Kd` is the albedo of a Lambertian surface and `Ke` its radiance; what an MTL
//! file says about highlights and transparency has no part in a scene.

mod mtl;
mod polygon;
mod scan;
#[cfg(test)]
mod tests;

use super::{Files, Unread};
use crate::scene::Rgb;
use glam::DVec3;
use std::cell::RefCell;
use std::fmt;
use std::iter::Enumerate;
use std::path::{Path, PathBuf};

/// The largest file that is read, in bytes: about five million triangles.
pub const MAX_BYTES: u64 = 256 << 20;

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
    /// Index into [`ObjMesh::materials`]; `None` if they were not wanted.
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
    /// Stable code.
    pub code: &'static str,
    /// The file: the OBJ itself or one of its libraries.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: Option<usize>,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// The right thing to do.
    pub help: Option<String>,
}

impl ObjError {
    fn new(code: &'static str, file: &Path, message: impl Into<String>) -> Self {
        let file = file.to_owned();
        Self {
            code,
            file,
            line: None,
            message: message.into(),
            help: None,
        }
    }

    fn at(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }

    fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
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
    load_from(Files::of_folder("".as_ref()), path, wants_materials)
}

/// As [`load`], from wherever `files` says.
pub(crate) fn load_from(
    files: Files<'_>,
    path: &Path,
    wants_materials: bool,
) -> Result<ObjMesh, ObjError> {
    let bytes = bytes_of(files, path, "QRT0320")?;
    let read = RefCell::new(vec![path.to_owned()]);
    let mesh = parse(path, &bytes, wants_materials, &|library| {
        let bytes = bytes_of(files, library, "QRT0334")?;
        read.borrow_mut().push(library.to_owned());
        Ok(bytes)
    })?;
    let files = read.into_inner();
    Ok(ObjMesh { files, ..mesh })
}

/// The whole of a file.
fn bytes_of(files: Files<'_>, path: &Path, code: &'static str) -> Result<Vec<u8>, ObjError> {
    let unreadable = |why: Unread| {
        let error = match why {
            Unread::Irregular { .. } => {
                let message = format!("`{}` is not a regular file", path.display());
                return ObjError::new(code, path, message);
            }
            Unread::Failed(error) => error,
        };
        let why = match error.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
            _ => error.to_string(),
        };
        ObjError::new(
            code,
            path,
            format!("cannot read `{}`: {why}", path.display()),
        )
        .help("relative names are looked up beside the file that names them")
    };
    let bytes = files.read(path, MAX_BYTES + 1).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        let message = format!("the file is larger than {} MiB", MAX_BYTES >> 20);
        return Err(ObjError::new("QRT0321", path, message).help("use a coarser mesh"));
    }
    Ok(bytes)
}

type Library<'a> = &'a dyn Fn(&Path) -> Result<Vec<u8>, ObjError>;

/// As [`load`], of the text itself; `library` gives the bytes of a material library.
fn parse(
    path: &Path,
    bytes: &[u8],
    wants_materials: bool,
    library: Library<'_>,
) -> Result<ObjMesh, ObjError> {
    let scan = scan::scan(path, bytes, wants_materials, library)?;
    let options = tobj::LoadOptions {
        single_index: true,
        ..tobj::LoadOptions::default()
    };
    let refused = |error: tobj::LoadError| {
        ObjError::new(
            "QRT0344",
            path,
            format!("the file cannot be read as an OBJ mesh: {error}"),
        )
    };
    let (models, materials) = tobj::load_obj_buf(&mut scan.plain.as_bytes(), &options, |_| {
        tobj::load_mtl_buf(&mut scan.library.as_bytes())
    })
    .map_err(refused)?;
    let materials = materials.map_err(refused)?;

    let mut faces = Vec::new();
    let mut lines = scan.face_lines.iter();
    for model in &models {
        let mesh = &model.mesh;
        let corner = |index: &u32| {
            let at = *index as usize * 3;
            DVec3::new(
                mesh.positions[at],
                mesh.positions[at + 1],
                mesh.positions[at + 2],
            )
        };
        // Without arities, every face is a triangle.
        let triangles = mesh.indices.len() / 3 * usize::from(mesh.face_arities.is_empty());
        let arities = mesh.face_arities.iter().map(|n| *n as usize);
        let mut rest = &mesh.indices[..];
        for arity in arities.chain(std::iter::repeat_n(3, triangles)) {
            let (face, others) = rest.split_at(arity);
            rest = others;
            let corners: Vec<DVec3> = face.iter().map(corner).collect();
            let line = lines.next().copied().unwrap_or_default();
            let triangles = polygon::triangles(&corners).map_err(|fault| {
                let (code, message, help) = fault.words();
                ObjError::new(code, path, message).at(line).help(help)
            })?;
            faces.extend(triangles.into_iter().map(|vertices| ObjFace {
                vertices,
                material: mesh.material_id,
            }));
        }
    }
    let materials = std::iter::zip(scan.names, materials)
        .map(|(name, material)| ObjMaterial {
            name,
            radiance: material.emissive.unwrap_or_default(),
            albedo: material.diffuse.unwrap_or_default(),
        })
        .collect();
    let files = Vec::new();
    Ok(ObjMesh {
        faces,
        materials,
        files,
    })
}

/// Lines as statements: comments and blank lines left out, continued lines joined.
struct Statements<'a> {
    path: &'a Path,
    lines: Enumerate<Lines<'a>>,
}

type Lines<'a> = std::slice::Split<'a, u8, fn(&u8) -> bool>;

/// One statement: the line it starts in, and its text without blanks around it.
struct Statement<'a> {
    line: usize,
    text: std::borrow::Cow<'a, str>,
}

impl<'a> Statements<'a> {
    fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let is_end: fn(&u8) -> bool = |byte| *byte == b'\n';
        Self {
            path,
            lines: bytes.split(is_end).enumerate(),
        }
    }

    fn next(&mut self) -> Result<Option<Statement<'a>>, ObjError> {
        while let Some((index, bytes)) = self.lines.next() {
            let line = index + 1;
            let mut text = self.text(line, bytes)?;
            if text.starts_with('#') {
                continue;
            }
            while text.ends_with('\\') {
                let Some((index, bytes)) = self.lines.next() else {
                    let message = "the file ends within a continued line";
                    return Err(ObjError::new("QRT0332", self.path, message)
                        .at(line)
                        .help("is the file whole?"));
                };
                let next = self.text(index + 1, bytes)?;
                let joined = text.to_mut();
                joined.pop();
                joined.truncate(joined.trim_end().len());
                if !(joined.is_empty() || next.is_empty()) {
                    joined.push(' ');
                }
                joined.push_str(&next);
            }
            if !text.is_empty() {
                return Ok(Some(Statement { line, text }));
            }
        }
        Ok(None)
    }

    /// A line's text. Bytes that are not UTF-8 are kept from being anything but part of a comment
    /// or a name.
    fn text(&self, line: usize, bytes: &'a [u8]) -> Result<std::borrow::Cow<'a, str>, ObjError> {
        if bytes.contains(&0) {
            let message = "this is not a text file";
            return Err(ObjError::new("QRT0322", self.path, message).at(line));
        }
        Ok(match std::str::from_utf8(bytes) {
            Ok(text) => text.trim().into(),
            Err(_) => String::from_utf8_lossy(bytes).trim().to_owned().into(),
        })
    }
}

impl Statement<'_> {
    /// The keyword and what follows it.
    fn split(&self) -> (&str, &str) {
        let end = self
            .text
            .find(char::is_whitespace)
            .unwrap_or(self.text.len());
        (&self.text[..end], self.text[end..].trim_start())
    }
}

/// The words of a statement up to a comment.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// A finite number.
fn number(path: &Path, line: usize, word: &str) -> Result<f64, ObjError> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => {
            let message = format!("`{word}` is not a finite number");
            Err(ObjError::new("QRT0326", path, message).at(line))
        }
        Err(_) => Err(ObjError::new("QRT0325", path, format!("`{word}` is not a number")).at(line)),
    }
}
