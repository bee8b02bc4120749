//! Meshes from PLY files (the Stanford triangle format), ASCII or binary.
//!
//! The counts in a header and before a list are claims. So nothing is allocated before the file has
//! shown the bytes for it, and an element without properties, which has no bytes, is not counted
//! through.

#[cfg(test)]
mod tests;

use super::meshes::{Collector, Corners, Faces, Normals, colour};
use crate::Rgb;
use crate::scene::meshes::{FileError, FileMesh, FilePlace, Wanted};
use glam::DVec3;
use qrt_syntax::{MeshFile, line_after};
use std::path::Path;

/// Maximum number of elements and properties in a header.
const MOST_DECLARED: usize = 1024;

/// The properties of a vertex that are its colour.
const COLOURS: [&str; 3] = ["red", "green", "blue"];

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Result<Self, MeshFile> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => {
                let word = name.to_owned();
                return Err(MeshFile::PlyType { word });
            }
        })
    }

    /// The value that stands for 1 in a colour, or the name of a type that colours do not have.
    const fn white(self) -> Result<f64, &'static str> {
        match self {
            Self::U8 => Ok(255.0),
            Self::U16 => Ok(65535.0),
            Self::F32 | Self::F64 => Ok(1.0),
            Self::I8 => Err("char"),
            Self::I16 => Err("short"),
            Self::I32 => Err("int"),
            Self::U32 => Err("uint"),
        }
    }

    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property {
    name: String,
    /// The type of the number of values; `None` for a single value.
    list: Option<Scalar>,
    value: Scalar,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

impl Element {
    /// The place among the properties of a single value called `name`.
    fn property(&self, name: &str) -> Option<usize> {
        let is_meant = |p: &Property| p.name == name && p.list.is_none();
        self.properties.iter().position(is_meant)
    }

    /// True if there is a single value called `name`.
    fn has(&self, name: &str) -> bool {
        self.property(name).is_some()
    }

    /// The places of the properties of a colour among all, each with the value that stands for 1.
    fn colour(&self) -> Result<[(usize, f64); 3], MeshFile> {
        let mut found = [(0, 1.0); 3];
        for (found, property) in found.iter_mut().zip(COLOURS) {
            let place = self.property(property);
            let place = place.ok_or(MeshFile::PlyNoColour { property })?;
            let white = self.properties[place].value.white();
            let white = white.map_err(|word| MeshFile::PlyColourType { property, word })?;
            *found = (place, white);
        }
        Ok(found)
    }

    fn place(&self, number: usize, byte: usize) -> FilePlace {
        let kind = self.name.as_str().into();
        FilePlace::Element { kind, number, byte }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// The first byte after the header.
    end: usize,
}

/// Reads the mesh of the bytes of the file at `path`, which has no materials.
pub(super) fn parse(
    path: &Path,
    bytes: &[u8],
    wanted: Wanted,
    faces: Faces,
) -> Result<FileMesh, FileError> {
    let whole = |what| FileError::new(what, path, FilePlace::Whole);
    if wanted.materials {
        return Err(whole(MeshFile::NoMaterials));
    }
    let header = header(bytes).map_err(|(what, at)| {
        let line = line_after(&bytes[..at]);
        FileError::new(what, path, line)
    })?;
    let mut data = Data {
        bytes,
        at: header.end,
        encoding: header.encoding,
    };
    let mut mesh = Mesh::new(faces, wanted);
    let (mut has_vertices, mut has_faces) = (false, false);
    for element in &header.elements {
        let is_first = |seen: &mut bool| !std::mem::replace(seen, true);
        let (mut number, start) = (0, data.at);
        let read = match element.name.as_str() {
            "vertex" if is_first(&mut has_vertices) => {
                mesh.read_vertices(element, &mut data, &mut number)
            }
            "face" if is_first(&mut has_faces) => mesh.read_faces(element, &mut data, &mut number),
            _ => data.skip(element, &mut number),
        };
        read.map_err(|what| {
            let place = match data.encoding {
                _ if matches!(
                    what,
                    MeshFile::PlyNoCoordinate { .. }
                        | MeshFile::PlyNoIndices
                        | MeshFile::PlyNoColour { .. }
                        | MeshFile::PlyColourType { .. }
                ) =>
                {
                    // The end of the header, without the end of its line.
                    FilePlace::Line(line_after(&bytes[..header.end - 2]))
                }
                Encoding::Ascii => FilePlace::Line(line_after(&bytes[..data.at.max(start)])),
                _ => element.place(number, data.at),
            };
            FileError::new(what, path, place)
        })?;
    }
    if !has_faces && header.elements.iter().any(|e| e.name == "tristrips") {
        return Err(whole(MeshFile::PlyStrips));
    }
    let Mesh {
        vertices,
        normals,
        colours,
        corners,
        ends,
        ..
    } = mesh;
    let face = header.elements.iter().find(|e| e.name == "face");
    let place = |number: u32| match (data.encoding, face) {
        (_, None) => FilePlace::Whole,
        (Encoding::Ascii, _) => FilePlace::Line(line_after(&bytes[..ends[number as usize].start])),
        (_, Some(face)) => face.place(number as usize, ends[number as usize].start),
    };
    let mut collector = Collector::default();
    let mut first = 0;
    for (number, end) in ends.iter().enumerate() {
        let number = number as u32;
        let fail = |what| FileError::new(what, path, place(number));
        let corner = |index: &u32| {
            let (index, count) = (*index, vertices.len());
            let found = vertices.get(index as usize).copied();
            found.ok_or_else(|| fail(MeshFile::PlyIndex { index, count }))
        };
        let indices = &corners[first..end.corners];
        let places = indices.iter().map(corner);
        let places: Vec<DVec3> = places.collect::<Result<_, _>>()?;
        let normals: Vec<DVec3> = of_vertices(&normals, indices);
        let colours: Vec<Rgb> = of_vertices(&colours, indices);
        let face = Corners {
            places: &places,
            normals: match normals[..] {
                [] => Normals::Flat,
                _ => Normals::OfCorners(&normals),
            },
            colours: &colours,
        };
        collector.add(face, None, number).map_err(fail)?;
        first = end.corners;
    }
    let mut read = collector.finish(path, place)?;
    let vertex = header.elements.iter().find(|e| e.name == "vertex");
    let has_colours = |vertex: &Element| COLOURS.iter().all(|name| vertex.has(name));
    if !wanted.colours && vertex.is_some_and(has_colours) {
        read.notes.push(whole(MeshFile::ColoursUnused));
    }
    Ok(read)
}

/// Returns the attributes of the vertices with these `indices`; none if there are none.
fn of_vertices<T: Copy>(attributes: &[T], indices: &[u32]) -> Vec<T> {
    let of = |&index: &u32| attributes.get(index as usize).copied();
    indices.iter().filter_map(of).collect()
}

/// Reads the header. An error has the place of its line, in bytes.
fn header(bytes: &[u8]) -> Result<Header, (MeshFile, usize)> {
    let Some(mut at) = bytes.starts_with(b"ply").then_some(3) else {
        return Err((MeshFile::NotPly, 0));
    };
    // A CR alone ends the lines of some files; binary data may begin with an LF.
    let line_end = match bytes[at..] {
        [b'\n', ..] | [b'\r', b'\n', ..] => b'\n',
        [b'\r', ..] => b'\r',
        _ => return Err((MeshFile::NotPly, 0)),
    };
    at += if bytes[at..].starts_with(b"\r\n") {
        2
    } else {
        1
    };
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let mut declared = 0;
    loop {
        let start = at;
        let fail = |what| (what, start);
        let rest = &bytes[start..];
        let Some(length) = rest.iter().position(|byte| *byte == line_end) else {
            return Err(fail(MeshFile::PlyNoEnd));
        };
        at += length + 1;
        let line = String::from_utf8_lossy(&rest[..length]);
        let line = line.trim();
        let unknown = || {
            let line = line.to_owned();
            fail(MeshFile::PlyHeader { line })
        };
        let words: Vec<&str> = line.split_whitespace().take(6).collect();
        let scalar = |name| Scalar::from_name(name).map_err(fail);
        match words[..] {
            [] | ["comment" | "obj_info", ..] => continue,
            ["end_header"] => break,
            ["format", name, "1.0"] if encoding.is_none() => {
                encoding = Some(match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return Err(unknown()),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| unknown())?;
                elements.push(Element {
                    name: name.to_owned(),
                    count,
                    properties: Vec::new(),
                });
            }
            ["property", "list", count, value, name] => {
                let property = Property {
                    name: name.to_owned(),
                    list: Some(scalar(count)?),
                    value: scalar(value)?,
                };
                elements
                    .last_mut()
                    .ok_or_else(unknown)?
                    .properties
                    .push(property);
            }
            ["property", value, name] => {
                let property = Property {
                    name: name.to_owned(),
                    list: None,
                    value: scalar(value)?,
                };
                elements
                    .last_mut()
                    .ok_or_else(unknown)?
                    .properties
                    .push(property);
            }
            _ => return Err(unknown()),
        }
        declared += 1;
        if declared > MOST_DECLARED {
            let most = MOST_DECLARED;
            return Err(fail(MeshFile::PlyMany { most }));
        }
    }
    let encoding = encoding.ok_or((MeshFile::PlyNoFormat, 0))?;
    Ok(Header {
        encoding,
        elements,
        end: at,
    })
}

/// The data after a header, of which the bytes up to `at` have been read.
struct Data<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl Data<'_> {
    /// Moves to the next word of a text.
    fn skip_blanks(&mut self) {
        let rest = &self.bytes[self.at..];
        let blanks = rest.iter().take_while(|byte| byte.is_ascii_whitespace());
        self.at += blanks.count();
    }

    /// Reads a number. An integer of at most 32 bits is exact.
    fn number(&mut self, scalar: Scalar) -> Result<f64, MeshFile> {
        if self.encoding == Encoding::Ascii {
            let before = self.at;
            self.skip_blanks();
            let rest = &self.bytes[self.at..];
            let is_blank = |byte: &u8| byte.is_ascii_whitespace();
            let length = rest.iter().position(is_blank).unwrap_or(rest.len());
            if length == 0 {
                self.at = before;
                return Err(MeshFile::PlyEnds);
            }
            let word = String::from_utf8_lossy(&rest[..length]);
            let value = word.parse().map_err(|_| {
                let (word, is_library) = (word.into_owned(), false);
                MeshFile::NotANumber { word, is_library }
            })?;
            self.at += length;
            return Ok(value);
        }
        let rest = &self.bytes[self.at..];
        let bytes = rest.get(..scalar.size()).ok_or(MeshFile::PlyEnds)?;
        let is_big = self.encoding == Encoding::BigEndian;
        let bits = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        let bits = if is_big {
            bytes.iter().fold(0, bits)
        } else {
            bytes.iter().rev().fold(0, bits)
        };
        self.at += bytes.len();
        Ok(match scalar {
            Scalar::I8 => f64::from(bits as u8 as i8),
            Scalar::U8 => f64::from(bits as u8),
            Scalar::I16 => f64::from(bits as u16 as i16),
            Scalar::U16 => f64::from(bits as u16),
            Scalar::I32 => f64::from(bits as u32 as i32),
            Scalar::U32 => f64::from(bits as u32),
            Scalar::F32 => f64::from(f32::from_bits(bits as u32)),
            Scalar::F64 => f64::from_bits(bits),
        })
    }

    /// Reads a whole number from 0 to 2^32 - 1.
    fn whole(&mut self, scalar: Scalar) -> Result<u32, MeshFile> {
        let value = self.number(scalar)?;
        let whole = value as u32;
        let is_whole = f64::from(whole) == value;
        is_whole
            .then_some(whole)
            .ok_or(MeshFile::PlyWhole { value })
    }

    fn skip_property(&mut self, property: &Property) -> Result<(), MeshFile> {
        let count = property.list.map_or(Ok(1), |list| self.whole(list))?;
        if self.encoding == Encoding::Ascii {
            for _ in 0..count {
                self.number(property.value)?;
            }
            return Ok(());
        }
        let size = u64::from(count) * property.value.size() as u64;
        let left = (self.bytes.len() - self.at) as u64;
        if size > left {
            return Err(MeshFile::PlyEnds);
        }
        self.at += size as usize;
        Ok(())
    }

    fn skip(&mut self, element: &Element, number: &mut usize) -> Result<(), MeshFile> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for _ in 0..element.count {
            for property in &element.properties {
                self.skip_property(property)?;
            }
            *number += 1;
        }
        Ok(())
    }
}

/// The vertices and faces so far.
struct Mesh {
    most: Faces,
    wanted: Wanted,
    vertices: Vec<DVec3>,
    /// By vertex; empty if the file has none or if they are not wanted.
    normals: Vec<DVec3>,
    /// By vertex; empty if they are not wanted.
    colours: Vec<Rgb>,
    /// The indices of the corners of all faces.
    corners: Vec<u32>,
    ends: Vec<End>,
    triangles: usize,
}

/// A face of the file.
struct End {
    /// The number of corners of all faces up to this one.
    corners: usize,
    /// The first byte of its indices.
    start: usize,
}

impl Mesh {
    fn new(most: Faces, wanted: Wanted) -> Self {
        Self {
            most,
            wanted,
            vertices: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
            corners: Vec::new(),
            ends: Vec::new(),
            triangles: 0,
        }
    }

    fn read_vertices(
        &mut self,
        element: &Element,
        data: &mut Data<'_>,
        number: &mut usize,
    ) -> Result<(), MeshFile> {
        let most = 3 * self.most.left;
        if element.count > most as u64 {
            return Err(MeshFile::ManyVertices { most });
        }
        let place = |property: &str| element.property(property);
        let mut axes = Vec::new();
        for property in ["x", "y", "z"] {
            axes.push(place(property).ok_or(MeshFile::PlyNoCoordinate { property })?);
        }
        let normal = match ["nx", "ny", "nz"].map(place) {
            [Some(x), Some(y), Some(z)] if self.wanted.normals => Some([x, y, z]),
            _ => None,
        };
        let colours = if self.wanted.colours {
            Some(element.colour()?)
        } else {
            None
        };
        let mut values = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            for (value, property) in values.iter_mut().zip(&element.properties) {
                match property.list {
                    None => *value = data.number(property.value)?,
                    Some(_) => data.skip_property(property)?,
                }
            }
            let vertex = DVec3::new(values[axes[0]], values[axes[1]], values[axes[2]]);
            if !vertex.is_finite() {
                let off = vertex.to_array().into_iter().find(|x| !x.is_finite());
                let word = off.unwrap_or_default().to_string();
                let is_library = false;
                return Err(MeshFile::NotFinite { word, is_library });
            }
            self.vertices.push(vertex);
            if let Some(places) = normal {
                let normal = DVec3::from_array(places.map(|place| values[place]));
                // The face's own normal replaces one that is not finite.
                let normal = if normal.is_finite() {
                    normal
                } else {
                    DVec3::ZERO
                };
                self.normals.push(normal);
            }
            if let Some(places) = colours {
                let value = places.map(|(place, white)| values[place] / white);
                self.colours.push(colour(value)?);
            }
            *number += 1;
        }
        Ok(())
    }

    fn read_faces(
        &mut self,
        element: &Element,
        data: &mut Data<'_>,
        number: &mut usize,
    ) -> Result<(), MeshFile> {
        let most = self.most.most;
        if element.count > self.most.left as u64 {
            return Err(MeshFile::ManyTriangles { most });
        }
        let is_indices = |p: &Property| {
            p.list.is_some() && matches!(&*p.name, "vertex_indices" | "vertex_index")
        };
        let indices = element.properties.iter().position(is_indices);
        let indices = indices.ok_or(MeshFile::PlyNoIndices)?;
        for _ in 0..element.count {
            for (place, property) in element.properties.iter().enumerate() {
                let (Some(list), true) = (property.list, place == indices) else {
                    data.skip_property(property)?;
                    continue;
                };
                if data.encoding == Encoding::Ascii {
                    data.skip_blanks();
                }
                let start = data.at;
                let count = data.whole(list)? as usize;
                if count < 3 {
                    return Err(MeshFile::FewCorners { count });
                }
                self.triangles += count - 2;
                if self.triangles > self.most.left {
                    return Err(MeshFile::ManyTriangles { most });
                }
                for _ in 0..count {
                    self.corners.push(data.whole(property.value)?);
                }
                let corners = self.corners.len();
                self.ends.push(End { corners, start });
            }
            *number += 1;
        }
        Ok(())
    }
}
