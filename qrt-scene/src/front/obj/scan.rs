//! Checks an OBJ file, statement by statement, as `tobj` reads it.

use super::{Faces, FileError, name, numbers, split, statements, tokens};
use crate::Rgb;
use crate::front::meshes::colour;
use crate::scene::meshes::{FilePlace, Wanted};
use glam::DVec3;
use qrt_syntax::{MeshFile, nearest};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Read};
use std::path::Path;

const READ: &str = "v vt vn f o s mtllib usemtl";
/// Statements that have no part in a mesh's shape.
const IGNORED: &str = "g mg vp bevel c_interp d_interp lod shadow_obj trace_obj usemap maplib end";
/// Statements whose shapes are left out: lines, points, curves and curved surfaces.
const SHAPELESS: &str =
    "l p cstype deg bmat step curv curv2 surf parm trim hole scrv sp con ctech stech call";

/// The kinds of elements that corners refer to.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// A reader of the `v` and `f` statements of a file, which checks all its statements.
pub(super) struct Scanner<'a> {
    path: &'a Path,
    statements: Box<dyn Iterator<Item = (usize, Cow<'a, str>)> + 'a>,
    wanted: Wanted,
    /// Maximum number of triangles; three times that number is the maximum of vertices.
    most: Faces,
    /// The triangles of the faces so far.
    pub(super) triangles: usize,
    /// Number of elements so far of each of [`KINDS`].
    counts: [i64; 3],
    /// The greatest index of each kind so far, and its line: a vertex may follow its face.
    greatest: [(i64, usize); 3],
    /// The statements that are being read.
    pending: Vec<u8>,
    /// Number of bytes of `pending` that have been read.
    read: usize,
    /// The error: the reader of this stream sees only that there is one.
    pub(super) fault: Option<FileError>,
    pub(super) faces: Vec<Face>,
    /// The colours of the vertices so far; empty if they are not wanted.
    pub(super) colours: Vec<Rgb>,
    /// The line of the first vertex with a colour.
    pub(super) first_coloured: Option<usize>,
    /// By corner of the faces, in order: the index of its vertex, if colours are wanted.
    pub(super) corner_vertices: Vec<usize>,
    /// The normals so far; 0 for one that is not three finite numbers.
    pub(super) normals: Vec<DVec3>,
    /// By corner of the faces that name normals, in order: the index of its normal in `normals`.
    pub(super) corner_normals: Vec<Option<usize>>,
    /// The smoothing group of the next faces, as the file calls it.
    group: Option<String>,
    /// Number of objects so far. Faces of two objects are never of one group.
    objects: u32,
    /// The number of each group of an object.
    groups: HashMap<(u32, String), u32>,
    /// The first statement whose shape is left out, and its line.
    pub(super) shapeless: Option<(String, usize)>,
    /// Names after `usemtl`, with their lines.
    pub(super) uses: Vec<(String, usize)>,
    /// Names after `mtllib`, with their lines.
    pub(super) libraries: Vec<(String, usize)>,
}

/// A face of the file.
pub(super) struct Face {
    /// Its line.
    pub(super) line: usize,
    /// The index in [`Scanner::uses`] of its material.
    pub(super) material: Option<usize>,
    pub(super) normals: OfFace,
}

/// The normals that a face asks for.
pub(super) enum OfFace {
    /// None, or they were not wanted.
    None,
    /// Those in [`Scanner::corner_normals`].
    Corners,
    /// The means over its smoothing group.
    Group(u32),
}

impl Read for Scanner<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.read == self.pending.len() {
            self.pending.clear();
            self.read = 0;
            if let Err(fault) = self.fill(buffer.len()) {
                self.fault = Some(fault);
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        let count = (&self.pending[self.read..]).read(buffer)?;
        self.read += count;
        Ok(count)
    }
}

impl<'a> Scanner<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str, wanted: Wanted, most: Faces) -> Self {
        Self {
            path,
            statements: Box::new(statements(text)),
            wanted,
            most,
            triangles: 0,
            counts: [0; 3],
            greatest: [(0, 0); 3],
            pending: Vec::new(),
            read: 0,
            fault: None,
            faces: Vec::new(),
            colours: Vec::new(),
            first_coloured: None,
            corner_vertices: Vec::new(),
            normals: Vec::new(),
            corner_normals: Vec::new(),
            group: None,
            objects: 0,
            groups: HashMap::new(),
            shapeless: None,
            uses: Vec::new(),
            libraries: Vec::new(),
        }
    }

    /// Checks statements until `size` bytes are pending, or the file ends.
    fn fill(&mut self, size: usize) -> Result<(), FileError> {
        while self.pending.len() < size {
            let Some((line, statement)) = self.statements.next() else {
                return self.finish();
            };
            let checked = self.statement(line, &statement);
            checked.map_err(|what| FileError::new(what, self.path, line))?;
        }
        Ok(())
    }

    fn statement(&mut self, line: usize, statement: &str) -> Result<(), MeshFile> {
        let (keyword, rest) = split(statement)?;
        let is_in = |keywords: &str| keywords.split(' ').any(|known| known == keyword);
        match keyword {
            "v" => self.vertex(line, rest)?,
            // No picture depends on their numbers.
            "vt" => self.counts[1] += 1,
            "vn" => self.normal(rest),
            "s" => self.group = group(rest),
            "o" => self.objects += 1,
            "f" | "fo" => self.face(line, rest)?,
            "mtllib" | "usemtl" if !self.wanted.materials => {}
            "mtllib" => {
                let name = name(keyword, rest, MeshFile::NamelessLibrary)?;
                self.libraries.push((name, line));
            }
            "usemtl" => {
                let name = name(keyword, rest, MeshFile::NamelessUse)?;
                self.uses.push((name, line));
            }
            _ if is_in(IGNORED) => {}
            _ if is_in(SHAPELESS) => {
                let first = || (keyword.to_owned(), line);
                self.shapeless.get_or_insert_with(first);
            }
            _ => {
                let known = READ.split(' ').chain(IGNORED.split(' '));
                let near = nearest(keyword, known.filter(|known| known.len() > 2));
                let keyword = keyword.to_owned();
                return Err(MeshFile::UnknownStatement { keyword, near });
            }
        }
        Ok(())
    }

    fn hand_on<'w>(&mut self, keyword: &str, words: impl Iterator<Item = &'w str>) {
        self.pending.extend_from_slice(keyword.as_bytes());
        for word in words {
            self.pending.push(b' ');
            self.pending.extend_from_slice(word.as_bytes());
        }
        self.pending.push(b'\n');
    }

    /// Reads `v x y z`, `v x y z w`, `v x y z r g b` or `v x y z r g b a`. Colours are dropped unless they
    /// are wanted, and so is an opacity.
    fn vertex(&mut self, line: usize, rest: &str) -> Result<(), MeshFile> {
        let given = tokens(rest).count();
        let kept = match given {
            3 | 6 | 7 => 3,
            4 => 4,
            _ => return Err(MeshFile::VertexCount { given }),
        };
        if let [x, y, z, weight] = numbers(rest, kept, false)?[..]
            && !(DVec3::new(x, y, z) / weight).is_finite()
        {
            return Err(MeshFile::Weight { weight });
        }
        self.counts[0] += 1;
        let most = 3 * self.most.left;
        if self.counts[0] > most as i64 {
            return Err(MeshFile::ManyVertices { most });
        }
        if given >= 6 {
            self.first_coloured.get_or_insert(line);
        }
        if self.wanted.colours {
            let [_, _, _, red, green, blue] = numbers(rest, 6, false)?[..] else {
                return Err(MeshFile::NoColour);
            };
            self.colours.push(colour([red, green, blue])?);
        }
        self.hand_on("v", tokens(rest).take(kept));
        Ok(())
    }

    fn face(&mut self, line: usize, rest: &str) -> Result<(), MeshFile> {
        let count = tokens(rest).count();
        if count < 3 {
            return Err(MeshFile::FewCorners { count });
        }
        let material = self.uses.len().checked_sub(1);
        if self.wanted.materials && material.is_none() {
            return Err(MeshFile::NoUse);
        }
        self.triangles += count - 2;
        if self.triangles > self.most.left {
            let most = self.most.most;
            return Err(MeshFile::ManyTriangles { most });
        }
        let first = self.corner_normals.len();
        for corner in tokens(rest) {
            let [vertex, _, normal] = self.corner(line, corner)?;
            if self.wanted.normals {
                self.corner_normals.push(normal);
            }
            if self.wanted.colours {
                self.corner_vertices.extend(vertex);
            }
        }
        self.hand_on("f", tokens(rest));
        let named = self.corner_normals[first..].iter().any(Option::is_some);
        if !named {
            self.corner_normals.truncate(first);
        }
        let normals = match &self.group {
            _ if named => OfFace::Corners,
            Some(group) if self.wanted.normals => {
                let new = self.groups.len() as u32;
                let group = (self.objects, group.clone());
                OfFace::Group(*self.groups.entry(group).or_insert(new))
            }
            _ => OfFace::None,
        };
        self.faces.push(Face {
            line,
            material,
            normals,
        });
        Ok(())
    }

    /// Reads `vn x y z`. Numbers that are not finite are no error: the face's own normal replaces them.
    fn normal(&mut self, rest: &str) {
        self.counts[2] += 1;
        if self.wanted.normals {
            let normal = match numbers(rest, 3, false).as_deref() {
                Ok(&[x, y, z]) => DVec3::new(x, y, z),
                _ => DVec3::ZERO,
            };
            self.normals.push(normal);
        }
    }

    /// Checks `v`, `v/vt`, `v//vn` or `v/vt/vn`, with indices from 1, or backwards from -1. Returns the
    /// indices of the elements of each of [`KINDS`], from 0.
    fn corner(&mut self, line: usize, corner: &str) -> Result<[Option<usize>; 3], MeshFile> {
        let mut found = [None; 3];
        for (number, part) in corner.split('/').enumerate() {
            if part.is_empty() && (1..3).contains(&number) {
                continue;
            }
            let Some(index) = part.parse::<i64>().ok().filter(|_| number < 3) else {
                let corner = corner.to_owned();
                return Err(MeshFile::NotACorner { corner });
            };
            let (before, greatest) = (self.counts[number], &mut self.greatest[number]);
            let kind = KINDS[number];
            if index == 0 {
                return Err(MeshFile::NoZeroth { kind });
            }
            if index < -before {
                return Err(MeshFile::NotBefore {
                    kind,
                    index,
                    before,
                });
            }
            if index > greatest.0 {
                *greatest = (index, line);
            }
            let from_start = if index < 0 { before + index } else { index - 1 };
            found[number] = usize::try_from(from_start).ok();
        }
        Ok(found)
    }

    /// Makes the checks that are possible only at the end.
    fn finish(&self) -> Result<(), FileError> {
        for ((count, kind), (index, line)) in self.counts.into_iter().zip(KINDS).zip(self.greatest)
        {
            if index > count {
                let what = MeshFile::Beyond { kind, index, count };
                return Err(FileError::new(what, self.path, line));
            }
        }
        if self.faces.is_empty() {
            return Err(FileError::new(
                MeshFile::NoFaces,
                self.path,
                FilePlace::Whole,
            ));
        }
        Ok(())
    }
}

/// The name of a smoothing group, usually a number; `None` for `off` and 0.
fn group(rest: &str) -> Option<String> {
    let name = tokens(rest)
        .next()
        .filter(|name| !matches!(*name, "off" | "0"));
    name.map(str::to_owned)
}
