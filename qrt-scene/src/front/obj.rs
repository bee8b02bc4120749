//! Meshes from Wavefront OBJ files, with the materials of their MTL files.
//!
//! `tobj` reads the shape, but it accepts invalid meshes (NaN vertices, faces of two corners),
//! supports neither continued lines nor comments after a statement, and reports no line. So it
//! reads through a `Scanner`, which checks each statement and passes vertices and faces on. The
//! module `meshes` then cuts the faces into triangles.
//!
//! The module `mtl` turns the statements of a material library into materials of the scene
//! language. `tobj` would panic on a colour of one number, which is a grey, or of two.

mod mtl;
mod scan;
#[cfg(test)]
mod tests;

use super::Files;
use super::meshes::{Collector, Corners, Faces, Library, MAX_BYTES, Normals, bytes_of, unread};
use crate::Rgb;
use crate::scene::meshes::{FileError, FileMaterial, FileMesh, FilePlace, Wanted};
use glam::DVec3;
use mtl::Materials;
use qrt_syntax::{MeshFile, line_after, line_starts};
use scan::{OfFace, Scanner};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::BufReader;
use std::path::Path;
use std::rc::Rc;

/// Reads a mesh and its `wanted` parts. The libraries of its materials stand beside it or below its
/// folder.
///
/// ```
/// use qrt_scene::{front::obj, meshes::Wanted};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.obj", std::process::id()));
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let square = obj::load(&path, Wanted::default())?;
/// assert_eq!(square.faces.len(), 2);
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first problem of the file: see [`FileError`].
pub fn load(path: &Path, wanted: Wanted) -> Result<FileMesh, FileError> {
    let files = Files::of_folder(path.parent().unwrap_or(Path::new("")));
    let bytes = files.read_named(path, MAX_BYTES);
    let bytes: Rc<[u8]> = bytes
        .map_err(|why| FileError::new(unread(files, path, false, why), path, FilePlace::Whole))?
        .into();
    let mut library = |path: &Path| bytes_of(files, path, true);
    parse(path, &bytes, wanted, Faces::default(), &mut library)
}

/// Reads a mesh as [`load`] does, from its bytes.
pub(super) fn parse(
    path: &Path,
    bytes: &[u8],
    wanted: Wanted,
    faces: Faces,
    library: Library<'_>,
) -> Result<FileMesh, FileError> {
    let text = text_of(path, bytes)?;
    let mut scanner = Scanner::new(path, &text, wanted, faces);
    let mut shape = BufReader::new(&mut scanner);
    // The scanner passes no `mtllib` on.
    let no_library = |_: &Path| tobj::load_mtl_buf(&mut std::io::empty());
    let read = tobj::load_obj_buf(&mut shape, &tobj::LoadOptions::default(), no_library);
    let (models, _) = read.map_err(|error| {
        scanner.fault.take().unwrap_or_else(|| {
            let why = error.to_string();
            FileError::new(MeshFile::Refused { why }, path, FilePlace::Whole)
        })
    })?;

    // The scanner passes no groups on either, so there is one model.
    let mesh = models.into_iter().next().map(|model| model.mesh);
    let mesh = mesh.unwrap_or_default();
    let corner = |index: &u32| DVec3::from_slice(&mesh.positions[3 * *index as usize..]);
    let mut corners = mesh.indices.iter().map(corner);
    let mut collector = Collector::default();
    let mut corner_normals = scanner.corner_normals.iter();
    let mut corner_vertices = scanner.corner_vertices.iter();
    for (number, face) in scanner.faces.iter().enumerate() {
        // Without arities, every face is a triangle.
        let arity = mesh.face_arities.get(number).map_or(3, |n| *n as usize);
        let places: Vec<DVec3> = corners.by_ref().take(arity).collect();
        let colour = |vertex: &usize| scanner.colours.get(*vertex).copied().unwrap_or_default();
        let colours: Vec<Rgb> = corner_vertices.by_ref().take(arity).map(colour).collect();
        let normal = |place: &Option<usize>| {
            let normal = place.and_then(|place| scanner.normals.get(place));
            normal.copied().unwrap_or_default()
        };
        let normals: Vec<DVec3> = match face.normals {
            OfFace::Corners => corner_normals.by_ref().take(arity).map(normal).collect(),
            OfFace::Group(_) | OfFace::None => Vec::new(),
        };
        let normals = match face.normals {
            OfFace::None => Normals::Flat,
            OfFace::Corners => Normals::OfCorners(&normals),
            OfFace::Group(group) => Normals::OfGroup(group),
        };
        let corners = Corners {
            places: &places,
            normals,
            colours: &colours,
        };
        let added = collector.add(corners, face.material, number as u32);
        added.map_err(|what| FileError::new(what, path, face.line))?;
    }
    let line = |number: u32| FilePlace::Line(scanner.faces[number as usize].line);
    let mut read = collector.finish(path, line)?;
    if let Some((keyword, line)) = scanner.shapeless {
        let note = FileError::new(MeshFile::Shapeless { keyword }, path, line);
        read.notes.push(note);
    }

    if let Some(line) = scanner.first_coloured.filter(|_| !wanted.colours) {
        let note = FileError::new(MeshFile::ColoursUnused, path, line);
        read.notes.push(note);
    }

    let mut library = Materials::read(path, &scanner.libraries, library, &mut read.files);
    let mut materials = Vec::<FileMaterial>::new();
    let (mut by_name, mut by_use) = (HashMap::new(), vec![None; scanner.uses.len()]);
    let used = read.faces.iter_mut();
    for number in used.filter_map(|face| face.material.as_mut()) {
        let (name, line) = &scanner.uses[*number];
        *number = *by_use[*number].get_or_insert_with(|| {
            *by_name.entry(name).or_insert_with(|| {
                materials.push(library.material(name, path, *line));
                materials.len() - 1
            })
        });
    }
    read.notes.extend(library.unneeded());
    read.materials = materials;
    Ok(read)
}

/// Returns a file as text. Bytes that are not UTF-8 do no harm in a comment.
fn text_of<'a>(path: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, FileError> {
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        let line = line_after(&bytes[..at]);
        return Err(FileError::new(MeshFile::NotText, path, line));
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
    text.contains('#') && text.split_whitespace().any(|word| word.starts_with('#'))
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

/// Returns a name without the comment after it and without quotes around it.
fn bare(name: &str) -> &str {
    let comment = name.match_indices('#').find(|(at, _)| {
        let before = name[..*at].chars().next_back();
        before.is_none_or(char::is_whitespace)
    });
    let name = comment.map_or(name, |(at, _)| &name[..at]).trim_end();
    let quoted = |quote| name.strip_prefix(quote)?.strip_suffix(quote);
    let inner = quoted('"').or_else(|| quoted('\''));
    inner.filter(|inner| !inner.is_empty()).unwrap_or(name)
}

/// The words of a statement up to a comment.
fn tokens(text: &str) -> impl Iterator<Item = &str> {
    text.split_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// The finite numbers of a statement, the first `most` of them.
fn numbers(text: &str, most: usize, is_library: bool) -> Result<Vec<f64>, MeshFile> {
    let number = |text: &str| {
        let parsed = text.parse::<f64>();
        if let Ok(value) = parsed
            && value.is_finite()
        {
            return Ok(value);
        }
        let word = text.to_owned();
        Err(match parsed {
            Ok(_) => MeshFile::NotFinite { word, is_library },
            Err(_) => MeshFile::NotANumber { word, is_library },
        })
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
