//! The reader of glTF files.

mod container;
mod material;

use crate::Rgb;
use crate::front::meshes::{Collector, Corners, Faces, Library, Normals, colour};
use crate::scene::meshes::{FileError, FileMaterial, FileMesh, FilePlace, Wanted};
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::Source;
use ::gltf::mesh::Mode;
use ::gltf::scene::Transform;
use ::gltf::{Accessor, Document, Mesh, Node, Primitive, Semantic};
use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};
use qrt_syntax::MeshFile;
use std::collections::{HashMap, HashSet};
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Reads the mesh of the bytes of the file at `path`: all nodes of its scene.
pub(in crate::front) fn parse(
    path: &Path,
    bytes: &[u8],
    wanted: Wanted,
    faces: Faces,
    library: Library<'_>,
) -> Result<FileMesh, FileError> {
    let (text, binary) =
        container::split(bytes).map_err(|what| FileError::new(what, path, FilePlace::Whole))?;
    let document = container::document(path, text)?;
    let mut reader = Reader {
        path,
        wanted,
        faces,
        library,
        binary,
        buffers: HashMap::new(),
        files: vec![path.to_owned()],
        named: HashSet::from([path.to_owned()]),
        materials: Vec::new(),
        by_index: HashMap::new(),
        collector: Collector::default(),
        parts: Vec::new(),
        placed: 0,
        triangles: 0,
        notes: Vec::new(),
    };
    reader.read(&document)?;
    let Reader {
        collector,
        parts,
        files,
        materials,
        mut notes,
        ..
    } = reader;
    let place = |part: u32| FilePlace::Part(part_name(parts[part as usize]));
    let mut read = collector.finish(path, place)?;
    notes.append(&mut read.notes);
    Ok(FileMesh {
        materials,
        files,
        notes,
        ..read
    })
}

/// The type of positions and normals.
const FLOATS: (DataType, Dimensions) = (DataType::F32, Dimensions::Vec3);

/// The indices of a mesh and of a primitive in it.
type Part = (usize, usize);

fn part_name((mesh, primitive): Part) -> String {
    format!("meshes[{mesh}].primitives[{primitive}]")
}

struct Reader<'a> {
    path: &'a Path,
    wanted: Wanted,
    faces: Faces,
    library: Library<'a>,
    /// The binary data in the file itself.
    binary: Option<&'a [u8]>,
    /// The buffers that were read, by index.
    buffers: HashMap<usize, Bytes<'a>>,
    files: Vec<PathBuf>,
    /// The same files, to look them up.
    named: HashSet<PathBuf>,
    materials: Vec<FileMaterial>,
    /// Indices into `materials`, by those in the file.
    by_index: HashMap<usize, usize>,
    collector: Collector,
    /// The primitives with triangles that were placed.
    parts: Vec<Part>,
    /// Number of primitives that were placed, with triangles or without.
    placed: usize,
    triangles: usize,
    notes: Vec<FileError>,
}

impl<'a> Reader<'a> {
    fn error(&self, what: MeshFile, part: impl Into<String>) -> FileError {
        FileError::new(what, self.path, FilePlace::Part(part.into()))
    }

    /// Adds a note, unless there is one like it.
    fn note(&mut self, what: MeshFile, part: impl FnOnce() -> String) {
        if self.notes.iter().all(|note| *note.what != what) {
            let note = self.error(what, part());
            self.notes.push(note);
        }
    }

    /// Reads the default scene; without one, the first; without any, all nodes.
    fn read(&mut self, document: &Document) -> Result<(), FileError> {
        let scene = document
            .default_scene()
            .or_else(|| document.scenes().next());
        let mut waiting = Waiting {
            nodes: Vec::new(),
            seen: vec![false; document.nodes().count()],
        };
        let twice = |node: usize| self.error(MeshFile::GltfTree, format!("nodes[{node}]"));
        if let Some(scene) = scene {
            let added = waiting.add(scene.nodes(), DMat4::IDENTITY);
            added.map_err(twice)?;
        } else {
            let mut is_child = vec![false; document.nodes().count()];
            for child in document.nodes().flat_map(|node| node.children()) {
                is_child[child.index()] = true;
            }
            let roots = document.nodes().filter(|node| !is_child[node.index()]);
            waiting.add(roots, DMat4::IDENTITY).map_err(twice)?;
        }
        while let Some((node, outer)) = waiting.nodes.pop() {
            let transform = outer * matrix(&node.transform());
            if node.skin().is_some() {
                self.note(MeshFile::GltfSkin, || format!("nodes[{}]", node.index()));
            }
            if let Some(mesh) = node.mesh() {
                for primitive in mesh.primitives() {
                    self.primitive(&mesh, &primitive, &transform)?;
                }
            }
            let twice = |node: usize| self.error(MeshFile::GltfTree, format!("nodes[{node}]"));
            waiting.add(node.children(), transform).map_err(twice)?;
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        mesh: &Mesh<'_>,
        primitive: &Primitive<'_>,
        transform: &DMat4,
    ) -> Result<(), FileError> {
        let part = (mesh.index(), primitive.index());
        // Few nodes can place many primitives many times, and those without triangles take time, too.
        self.placed += 1;
        if self.placed > self.faces.most {
            let most = self.faces.most;
            return Err(self.error(MeshFile::GltfPlaced { most }, part_name(part)));
        }
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            let keyword = if mode == Mode::Points {
                "points"
            } else {
                "lines"
            };
            let keyword = keyword.to_owned();
            self.note(MeshFile::Shapeless { keyword }, || part_name(part));
            return Ok(());
        }
        let fail = |what| FileError::new(what, self.path, FilePlace::Part(part_name(part)));
        let positions = primitive.get(&Semantic::Positions);
        let positions = positions.ok_or_else(|| fail(MeshFile::GltfNoPositions))?;
        if (positions.data_type(), positions.dimensions()) != FLOATS {
            return Err(fail(MeshFile::GltfType {
                attribute: "POSITION",
            }));
        }
        let indices = primitive.indices();
        let is_index = |a: &Accessor<'_>| {
            let is_whole = matches!(a.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
            is_whole && a.dimensions() == Dimensions::Scalar
        };
        if !indices.as_ref().is_none_or(is_index) {
            return Err(fail(MeshFile::GltfType {
                attribute: "indices",
            }));
        }
        if primitive.morph_targets().next().is_some() {
            self.note(MeshFile::GltfMorph, || part_name(part));
        }
        let vertices = self.data(&positions, part)?;
        let normals = primitive.get(&Semantic::Normals);
        let normals = match normals.filter(|_| self.wanted.normals) {
            Some(normals)
                if (normals.data_type(), normals.dimensions()) != FLOATS
                    || normals.sparse().is_some() =>
            {
                self.note(MeshFile::GltfNormals, || part_name(part));
                None
            }
            Some(normals) => Some(self.data(&normals, part)?),
            None => None,
        };
        let indices = match indices {
            Some(indices) => Some(self.data(&indices, part)?),
            None => None,
        };
        let corners = indices.as_ref().map_or(vertices.count, |data| data.count);
        let triangles = match mode {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        self.triangles = self.triangles.saturating_add(triangles);
        if self.triangles > self.faces.left {
            let most = self.faces.most;
            return Err(self.error(MeshFile::ManyTriangles { most }, part_name(part)));
        }
        if triangles == 0 {
            return Ok(());
        }
        let colours = self.colours(primitive, part)?;
        let material = if self.wanted.materials {
            Some(self.material(primitive, part)?)
        } else {
            None
        };
        let origin = self.parts.len() as u32;
        self.parts.push(part);
        // A transform that mirrors turns the faces around.
        let is_mirrored = transform.determinant() < 0.0;
        // Normals are scaled inversely; a sign does not matter.
        let turn = DMat3::from_mat4(*transform).inverse().transpose();
        for triangle in 0..triangles {
            let mut corners = match mode {
                Mode::Triangles => [0, 1, 2].map(|corner| 3 * triangle + corner),
                Mode::TriangleFan => [triangle + 1, triangle + 2, 0],
                _ => [0, 1 + triangle % 2, 2 - triangle % 2].map(|corner| triangle + corner),
            };
            if is_mirrored {
                corners.swap(1, 2);
            }
            let mut face = [DVec3::ZERO; 3];
            let mut of_corners = [DVec3::ZERO; 3];
            let mut of_vertices = Vec::new();
            for ((vertex, normal), corner) in face.iter_mut().zip(&mut of_corners).zip(corners) {
                let index = indices.as_ref().map_or(corner, |data| data.index(corner));
                let beyond = |count: usize| {
                    let index = index as u32;
                    self.error(MeshFile::PlyIndex { index, count }, part_name(part))
                };
                let found = vertices.point(index);
                let found = found.ok_or_else(|| beyond(vertices.count))?;
                if let Some(colours) = &colours {
                    let found = colours.colour(index).ok_or_else(|| beyond(colours.count))?;
                    let found = colour(found).map_err(|what| self.error(what, part_name(part)));
                    of_vertices.push(found?);
                }
                *vertex = transform.transform_point3(found);
                if let Some(given) = normals.as_ref().and_then(|normals| normals.point(index)) {
                    let turned = turn * given;
                    *normal = if turned.is_finite() {
                        turned
                    } else {
                        DVec3::ZERO
                    };
                }
                if let Some(off) = vertex.to_array().into_iter().find(|x| !x.is_finite()) {
                    let (word, is_library) = (off.to_string(), false);
                    let what = MeshFile::NotFinite { word, is_library };
                    return Err(self.error(what, part_name(part)));
                }
            }
            let of_corners = match normals {
                None => Normals::Flat,
                Some(_) => Normals::OfCorners(&of_corners),
            };
            let face = Corners {
                places: &face,
                normals: of_corners,
                colours: &of_vertices,
            };
            let added = self.collector.add(face, material, origin);
            added.map_err(|what| self.error(what, part_name(part)))?;
        }
        Ok(())
    }

    /// Returns the colours of a primitive's vertices; `None` if they are not wanted, with a note if there
    /// are any.
    fn colours(
        &mut self,
        primitive: &Primitive<'_>,
        part: Part,
    ) -> Result<Option<Data<'a>>, FileError> {
        let colours = primitive.get(&Semantic::Colors(0));
        if !self.wanted.colours {
            if colours.is_some() {
                self.note(MeshFile::ColoursUnused, || part_name(part));
            }
            return Ok(None);
        }
        let fail = |what| FileError::new(what, self.path, FilePlace::Part(part_name(part)));
        let colours = colours.ok_or_else(|| fail(MeshFile::GltfNoColours))?;
        let is_colour = match (colours.data_type(), colours.dimensions()) {
            (DataType::F32, Dimensions::Vec3 | Dimensions::Vec4) => true,
            (DataType::U8 | DataType::U16, Dimensions::Vec3 | Dimensions::Vec4) => {
                colours.normalized()
            }
            _ => false,
        };
        if !is_colour {
            return Err(fail(MeshFile::GltfType {
                attribute: "COLOR_0",
            }));
        }
        self.data(&colours, part).map(Some)
    }

    /// Returns the index of a primitive's material in `materials`.
    fn material(&mut self, primitive: &Primitive<'_>, part: Part) -> Result<usize, FileError> {
        let material = primitive.material();
        let Some(index) = material.index() else {
            return Err(self.error(MeshFile::GltfNoMaterial, part_name(part)));
        };
        if let Some(known) = self.by_index.get(&index) {
            return Ok(*known);
        }
        let number = self.materials.len();
        self.by_index.insert(index, number);
        self.materials
            .push(material::read(self.path, &material, index));
        Ok(number)
    }

    /// Returns the data of an accessor, which lie within their buffer.
    fn data(&mut self, accessor: &Accessor<'_>, part: Part) -> Result<Data<'a>, FileError> {
        let fail = |what| {
            let number = accessor.index();
            let name = format!("{}, accessors[{number}]", part_name(part));
            FileError::new(what, self.path, FilePlace::Part(name))
        };
        if accessor.sparse().is_some() {
            return Err(fail(MeshFile::GltfSparse));
        }
        let Some(view) = accessor.view() else {
            return Err(fail(MeshFile::GltfNoData));
        };
        let buffer = view.buffer();
        let bytes = self.buffer(buffer.index(), &buffer.source())?;
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size);
        let count = accessor.count();
        // The last element need not fill its stride.
        let needed = (count.checked_sub(1))
            .map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size))
            .and_then(|length| length.checked_add(accessor.offset()));
        let start = view.offset().checked_add(accessor.offset());
        let end = needed.and_then(|needed| view.offset().checked_add(needed));
        let is_whole = needed.is_some_and(|needed| needed <= view.length())
            && end.is_some_and(|end| end <= bytes.len());
        match start {
            Some(start) if is_whole && stride >= size => Ok(Data {
                bytes,
                start,
                stride,
                count,
                numbers: accessor.data_type(),
            }),
            _ => Err(fail(MeshFile::GltfShort)),
        }
    }

    /// Returns the bytes of a buffer: of the file itself, of its text, or of another file.
    fn buffer(&mut self, index: usize, source: &Source<'_>) -> Result<Bytes<'a>, FileError> {
        if let Some(known) = self.buffers.get(&index) {
            return Ok(known.clone());
        }
        let read = match source {
            Source::Bin => {
                let own = self.binary.filter(|_| index == 0);
                own.map(Bytes::Own).ok_or(MeshFile::GltfNoBinary)
            }
            Source::Uri(uri) if uri.starts_with("data:") => {
                let bytes = container::data_uri(uri).ok_or(MeshFile::GltfDataUri);
                bytes.map(|bytes| Bytes::Read(bytes.into()))
            }
            Source::Uri(uri) => {
                let folder = self.path.parent().unwrap_or(Path::new(""));
                let path = folder.join(container::unescaped(uri));
                let read = (self.library)(&path);
                if read.is_ok() && self.named.insert(path.clone()) {
                    self.files.push(path);
                }
                read.map(Bytes::Read)
            }
        };
        let bytes = read.map_err(|what| self.error(what, format!("buffers[{index}]")))?;
        self.buffers.insert(index, bytes.clone());
        Ok(bytes)
    }
}

/// The nodes that are still to be read, the next one last, each with the transform of the nodes
/// above it.
struct Waiting<'a> {
    nodes: Vec<(Node<'a>, DMat4)>,
    /// True for each node that was added.
    seen: Vec<bool>,
}

impl<'a> Waiting<'a> {
    /// Adds `nodes` so that the first of them comes next.
    ///
    /// # Errors
    /// The index of a node that was added before: a file must not make a list longer than itself.
    fn add(
        &mut self,
        nodes: impl Iterator<Item = Node<'a>>,
        transform: DMat4,
    ) -> Result<(), usize> {
        let start = self.nodes.len();
        for node in nodes {
            let index = node.index();
            if std::mem::replace(&mut self.seen[index], true) {
                return Err(index);
            }
            self.nodes.push((node, transform));
        }
        self.nodes[start..].reverse();
        Ok(())
    }
}

/// The bytes of a buffer.
#[derive(Clone)]
enum Bytes<'a> {
    /// The binary data of the file itself.
    Own(&'a [u8]),
    Read(Rc<[u8]>),
}

impl Deref for Bytes<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Own(bytes) => bytes,
            Self::Read(bytes) => bytes,
        }
    }
}

/// The elements of an accessor, all of which lie within `bytes`.
struct Data<'a> {
    bytes: Bytes<'a>,
    start: usize,
    stride: usize,
    count: usize,
    numbers: DataType,
}

impl Data<'_> {
    /// The bytes of element `number` and of those after it.
    fn element(&self, number: usize) -> Option<&[u8]> {
        let number = (number < self.count).then_some(number)?;
        self.bytes.get(self.start + number * self.stride..)
    }

    /// Returns point number `number`; `None` if there is none.
    fn point(&self, number: usize) -> Option<DVec3> {
        let (coordinates, _) = self.element(number)?.as_chunks::<4>();
        let [x, y, z, ..] = *coordinates else {
            return None;
        };
        let point = Vec3::from_array([x, y, z].map(f32::from_le_bytes));
        Some(point.as_dvec3())
    }

    /// Returns colour number `number`, of floats or normalized whole numbers; `None` if there is none.
    fn colour(&self, number: usize) -> Option<Rgb> {
        let white = match self.numbers {
            DataType::U8 => 255.0,
            DataType::U16 => 65535.0,
            _ => return self.point(number).map(|colour| colour.to_array()),
        };
        let bytes = self.element(number)?;
        let channels = [0, 1, 2].map(|channel| {
            let size = self.numbers.size();
            let bytes = bytes.get(channel * size..).unwrap_or_default();
            self.whole(bytes) as f64 / white
        });
        Some(channels)
    }

    /// Returns index number `number`, which is less than `count`.
    fn index(&self, number: usize) -> usize {
        self.whole(self.element(number).unwrap_or_default())
    }

    /// The little-endian whole number at the start of `bytes`.
    fn whole(&self, bytes: &[u8]) -> usize {
        let bytes = bytes.iter().take(self.numbers.size()).rev();
        bytes.fold(0, |whole, byte| whole << 8 | usize::from(*byte))
    }
}

fn matrix(transform: &Transform) -> DMat4 {
    match transform {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            // 32-bit numbers make a unit quaternion only nearly one.
            let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
            let [scale, translation] =
                [scale, translation].map(|v| DVec3::from_array(v.map(f64::from)));
            DMat4::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}
