//! The check of an OBJ file's text, statement by statement, and its plain form.

use super::{Library, ObjError, Statement, Statements, mtl, number, words};
use crate::syntax::nearest;
use std::fmt::Write;
use std::path::Path;

/// What a checked file says.
pub(super) struct Scan {
    /// The mesh, as only `mtllib`, `v x y z [w]`, `f` with positive vertex indices and `usemtl`
    /// with a material's number.
    pub(super) plain: String,
    /// All materials in use or not, as only `newmtl` with their numbers, `Kd` and `Ke`.
    pub(super) library: String,
    /// `FILE.mtl:NAME` of each material.
    pub(super) names: Vec<String>,
    /// The line of each face.
    pub(super) face_lines: Vec<usize>,
}

/// Statements that have no part in a mesh's shape.
const IGNORED: [&str; 14] = [
    "o",
    "g",
    "s",
    "mg",
    "vp",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "usemap",
    "maplib",
    "end",
];
/// Statements whose shapes would be missing.
const CURVED: [&str; 16] = [
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
    "con", "ctech", "stech", "call",
];
const READ: [&str; 6] = ["v", "vt", "vn", "f", "mtllib", "usemtl"];

struct Scanner<'a> {
    path: &'a Path,
    wants_materials: bool,
    vertices: usize,
    texture: usize,
    normals: usize,
    /// `v` statements.
    points: String,
    /// `f` and `usemtl` statements.
    faces: String,
    face_lines: Vec<usize>,
    /// The greatest index of each kind so far, and its line: a vertex may follow its face.
    greatest: [(usize, usize); 3],
    /// Names after `usemtl`, with their lines.
    uses: Vec<(String, usize)>,
    /// Names after `mtllib`, with their lines.
    libraries: Vec<(String, usize)>,
}

pub(super) fn scan(
    path: &Path,
    bytes: &[u8],
    wants_materials: bool,
    library: Library<'_>,
) -> Result<Scan, ObjError> {
    let mut scanner = Scanner {
        path,
        wants_materials,
        vertices: 0,
        texture: 0,
        normals: 0,
        points: String::new(),
        faces: String::new(),
        face_lines: Vec::new(),
        greatest: [(0, 0); 3],
        uses: Vec::new(),
        libraries: Vec::new(),
    };
    let mut statements = Statements::new(path, bytes);
    while let Some(statement) = statements.next()? {
        scanner.statement(&statement)?;
    }
    scanner.finish(library)
}

impl Scanner<'_> {
    fn error(&self, code: &'static str, line: usize, message: impl Into<String>) -> ObjError {
        ObjError::new(code, self.path, message).at(line)
    }

    fn statement(&mut self, statement: &Statement<'_>) -> Result<(), ObjError> {
        let line = statement.line;
        let (keyword, rest) = statement.split();
        match keyword {
            "v" => self.vertex(line, rest),
            "vt" => {
                self.texture += 1;
                self.numbers(line, keyword, rest, 1, 3).map(drop)
            }
            "vn" => {
                self.normals += 1;
                self.numbers(line, keyword, rest, 3, 3).map(drop)
            }
            "f" | "fo" => self.face(line, rest),
            "mtllib" | "usemtl" => self.name(line, keyword, rest),
            "l" | "p" => {
                let what = if keyword == "l" { "lines" } else { "points" };
                Err(self
                    .error(
                        "QRT0324",
                        line,
                        format!("{what} have no area, so no light meets them"),
                    )
                    .help(format!("leave out the `{keyword}` statements")))
            }
            _ if IGNORED.contains(&keyword) => Ok(()),
            _ if CURVED.contains(&keyword) => Err(self
                .error(
                    "QRT0324",
                    line,
                    format!("`{keyword}`: free-form shapes are not read"),
                )
                .help("export the mesh as polygons")),
            _ => {
                let message = format!("`{}` is no OBJ statement", shown(keyword));
                let error = self.error("QRT0323", line, message);
                let known = READ.into_iter().chain(IGNORED).chain(["l", "p"]);
                Err(match nearest(keyword, known.filter(|k| k.len() > 2)) {
                    Some(near) => error.help(format!("did you mean `{near}`?")),
                    None => error,
                })
            }
        }
    }

    fn numbers(
        &self,
        line: usize,
        keyword: &str,
        rest: &str,
        least: usize,
        most: usize,
    ) -> Result<Vec<f64>, ObjError> {
        let numbers = words(rest)
            .take(most + 1)
            .map(|word| number(self.path, line, word))
            .collect::<Result<Vec<f64>, _>>()?;
        if (least..=most).contains(&numbers.len()) {
            return Ok(numbers);
        }
        let count = if least == most {
            least.to_string()
        } else {
            format!("{least} to {most}")
        };
        let given = words(rest).count();
        Err(self.error(
            "QRT0325",
            line,
            format!("`{keyword}` takes {count} numbers, not {given}"),
        ))
    }

    /// `v x y z`, `v x y z w` or `v x y z r g b`, whose colours are dropped.
    fn vertex(&mut self, line: usize, rest: &str) -> Result<(), ObjError> {
        let numbers = self.numbers(line, "v", rest, 3, 6)?;
        if numbers.len() == 5 {
            let message = "`v` takes 3 numbers, or 4 with a weight, or 6 with a colour, not 5";
            return Err(self.error("QRT0325", line, message));
        }
        if numbers.len() == 4 && !numbers[..3].iter().all(|x| (x / numbers[3]).is_finite()) {
            let message = format!("the weight {} takes the vertex to infinity", numbers[3]);
            return Err(self.error("QRT0326", line, message));
        }
        self.vertices += 1;
        self.points.push('v');
        for word in words(rest).take(if numbers.len() == 4 { 4 } else { 3 }) {
            self.points.push(' ');
            self.points.push_str(word);
        }
        self.points.push('\n');
        Ok(())
    }

    fn face(&mut self, line: usize, rest: &str) -> Result<(), ObjError> {
        let corners = words(rest).count();
        if corners < 3 {
            let s = if corners == 1 { "" } else { "s" };
            let message = format!("a face of {corners} corner{s}");
            return Err(self
                .error("QRT0327", line, message)
                .help("a face has three or more"));
        }
        if self.wants_materials && self.uses.is_empty() {
            return Err(self
                .error(
                    "QRT0336",
                    line,
                    "this face has no material: no `usemtl` stands before it",
                )
                .help("give the mesh a `material` in the scene, or the face one in the file"));
        }
        self.faces.push('f');
        for corner in words(rest) {
            let vertex = self.corner(line, corner)?;
            // Writing to a string cannot fail.
            let _ = write!(self.faces, " {vertex}");
        }
        self.faces.push('\n');
        self.face_lines.push(line);
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 1, or backwards from -1: the vertex, from 1.
    fn corner(&mut self, line: usize, corner: &str) -> Result<usize, ObjError> {
        let counts = [self.vertices, self.texture, self.normals];
        let mut vertex = None;
        for (kind, part) in corner.split('/').enumerate() {
            if part.is_empty() && (1..3).contains(&kind) {
                continue;
            }
            let index = part.parse::<i64>().ok().filter(|_| kind < 3);
            let Some(index) = index else {
                let message = format!("`{}` is not a corner of a face", shown(corner));
                return Err(self
                    .error("QRT0328", line, message)
                    .help("a corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`, with whole numbers"));
            };
            let what = ["vertex", "texture coordinate", "normal"][kind];
            let before = counts[kind];
            let absolute = match index {
                1.. => usize::try_from(index).ok(),
                0 => {
                    let message = format!("there is no {what} 0");
                    return Err(self
                        .error("QRT0328", line, message)
                        .help("indices start at 1"));
                }
                _ => usize::try_from(index.unsigned_abs())
                    .ok()
                    .and_then(|back| (before + 1).checked_sub(back))
                    .filter(|index| *index > 0),
            };
            let Some(absolute) = absolute else {
                let message = format!("there is no {what} {index}: {before} stand before it");
                return Err(self.error("QRT0329", line, message));
            };
            if absolute > self.greatest[kind].0 {
                self.greatest[kind] = (absolute, line);
            }
            if kind == 0 {
                vertex = Some(absolute);
            }
        }
        vertex.ok_or_else(|| {
            let message = format!("`{}` is not a corner of a face", shown(corner));
            self.error("QRT0328", line, message)
        })
    }

    fn name(&mut self, line: usize, keyword: &str, name: &str) -> Result<(), ObjError> {
        if !self.wants_materials {
            return Ok(());
        }
        if name.is_empty() {
            let code = if keyword == "mtllib" {
                "QRT0333"
            } else {
                "QRT0335"
            };
            return Err(self.error(code, line, format!("`{keyword}` without a name")));
        }
        if name.contains(char::REPLACEMENT_CHARACTER) {
            let message = format!("the name after `{keyword}` is not UTF-8 text");
            return Err(self.error("QRT0322", line, message));
        }
        if keyword == "mtllib" {
            self.libraries.push((name.to_owned(), line));
        } else {
            let _ = writeln!(self.faces, "usemtl {}", self.uses.len());
            self.uses.push((name.to_owned(), line));
        }
        Ok(())
    }

    fn finish(self, library: Library<'_>) -> Result<Scan, ObjError> {
        let counts = [self.vertices, self.texture, self.normals];
        let kinds = ["vertex", "texture coordinate", "normal"];
        for ((count, kind), (index, line)) in counts.iter().zip(kinds).zip(self.greatest) {
            if index > *count {
                let message = format!("there is no {kind} {index}: the file has {count}");
                return Err(self
                    .error("QRT0329", line, message)
                    .help("is the file whole?"));
            }
        }
        if self.face_lines.is_empty() {
            return Err(ObjError::new("QRT0331", self.path, "the mesh has no faces"));
        }
        let materials = self.materials(library)?;
        let mut plain = String::new();
        if self.wants_materials {
            plain.push_str("mtllib all\n");
        }
        plain.push_str(&self.points);
        // Now that all libraries are known, names after `usemtl` become numbers.
        for statement in self.faces.lines() {
            let used = statement
                .strip_prefix("usemtl ")
                .and_then(|n| n.parse::<usize>().ok());
            match used.and_then(|n| self.uses.get(n)) {
                None => plain.push_str(statement),
                Some((name, line)) => {
                    let Some(number) = materials.find(name) else {
                        return Err(self.unknown(name, *line, &materials));
                    };
                    // Writing to a string cannot fail.
                    let _ = write!(plain, "usemtl {number}");
                }
            }
            plain.push('\n');
        }
        let library = materials.plain();
        Ok(Scan {
            plain,
            library,
            names: materials.full_names(),
            face_lines: self.face_lines,
        })
    }

    fn materials(&self, library: Library<'_>) -> Result<mtl::Materials, ObjError> {
        let mut materials = mtl::Materials::default();
        let mut files: Vec<&str> = Vec::new();
        for (name, line) in &self.libraries {
            // A statement may name several files, and a file's name may hold blanks.
            let whole = files.contains(&name.as_str()) || library(&self.beside(name)).is_ok();
            let names: Vec<&str> = if whole {
                vec![name]
            } else {
                name.split_whitespace().collect()
            };
            for name in names {
                if files.contains(&name) {
                    continue;
                }
                files.push(name);
                let path = self.beside(name);
                let bytes = library(&path).map_err(|error| ObjError {
                    file: self.path.to_owned(),
                    line: Some(*line),
                    ..error
                })?;
                materials.read(&path, name, &bytes)?;
            }
        }
        Ok(materials)
    }

    fn beside(&self, name: &str) -> std::path::PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name)
    }

    fn unknown(&self, name: &str, line: usize, materials: &mtl::Materials) -> ObjError {
        let error = self.error("QRT0335", line, format!("no material `{}`", shown(name)));
        if self.libraries.is_empty() {
            return ObjError {
                code: "QRT0333",
                ..error
            }
            .help("the file names no material library: a `mtllib` statement is missing");
        }
        match nearest(name, materials.names()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help("`newmtl` in a material library names it"),
        }
    }
}

/// A word for a message: not longer than a person reads.
pub(super) fn shown(word: &str) -> String {
    if word.chars().count() <= 40 {
        return word.to_owned();
    }
    word.chars().take(40).chain(['.', '.', '.']).collect()
}
