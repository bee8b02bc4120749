//! Collects the triangles of a mesh with the normals and colours of their corners, and leaves out
//! triangles without area and copies.

use super::polygon;
use crate::Rgb;
use crate::polygons::{MOST_PAIRS, mean_normals, unit_normal};
use crate::scene::meshes::{FileError, FileFace, FileMesh, FilePlace};
use crate::valid::triangle_fault;
use glam::DVec3;
use qrt_syntax::MeshFile;
use std::path::Path;

/// The triangles of a mesh so far. Faces without area are left out at once, copies at the end.
#[derive(Default)]
pub(in crate::front) struct Collector {
    faces: Vec<FileFace>,
    /// For each triangle, its shading. Shorter than `faces` if the last ones are flat.
    shading: Vec<Shading>,
    /// For each triangle, the colours of its corners; empty if faces have none.
    colours: Vec<[Rgb; 3]>,
    /// For each triangle, the number of its face in the file.
    origins: Vec<u32>,
    flat: LeftOut,
}

/// The number of triangles that are left out, and the number of the first one's face.
#[derive(Default)]
struct LeftOut {
    count: usize,
    first: u32,
}

impl LeftOut {
    fn add(&mut self, origin: u32) {
        if self.count == 0 {
            self.first = origin;
        }
        self.count += 1;
    }
}

/// The corners of a face in its file, in the order of its outline.
#[derive(Clone, Copy)]
pub(in crate::front) struct Corners<'a> {
    pub(in crate::front) places: &'a [DVec3],
    pub(in crate::front) normals: Normals<'a>,
    /// Linear RGB from 0 to 1, by corner; empty for all faces of a mesh whose colours are not wanted.
    pub(in crate::front) colours: &'a [Rgb],
}

/// The normals of a face's corners in its file.
#[derive(Clone, Copy)]
pub(in crate::front) enum Normals<'a> {
    /// The face's own.
    Flat,
    /// By corner, of any length; 0 stands for the face's own. The side of the face is not theirs:
    /// [`crate::valid`] turns normals of the back around.
    OfCorners(&'a [DVec3]),
    /// The mean of the faces that share the corner and have the same smoothing group.
    OfGroup(u32),
}

/// The shading of a triangle.
#[derive(Clone, Copy, PartialEq)]
enum Shading {
    Flat,
    OfCorners([DVec3; 3]),
    OfGroup(u32),
}

impl Collector {
    /// Adds face number `origin` of the file, cut into triangles.
    ///
    /// # Errors
    /// The reason that the face cannot be cut; that it has no area is none.
    pub(in crate::front) fn add(
        &mut self,
        face: Corners<'_>,
        material: Option<usize>,
        origin: u32,
    ) -> Result<(), MeshFile> {
        let corners = face.places;
        let triangles = match polygon::triangles(corners) {
            Err(MeshFile::NoArea) => {
                self.flat.add(origin);
                return Ok(());
            }
            triangles => triangles?,
        };
        for triangle in triangles {
            let vertices = triangle.map(|corner| corners[corner]);
            if triangle_fault(&vertices).is_some() {
                self.flat.add(origin);
                continue;
            }
            if !face.colours.is_empty() {
                let colours = triangle.map(|corner| face.colours[corner]);
                self.colours.push(colours);
            }
            let shading = match face.normals {
                Normals::Flat => Shading::Flat,
                Normals::OfCorners(normals) => {
                    Shading::OfCorners(triangle.map(|corner| normals[corner]))
                }
                Normals::OfGroup(group) => Shading::OfGroup(group),
            };
            if shading != Shading::Flat {
                self.shading.resize(self.faces.len(), Shading::Flat);
                self.shading.push(shading);
            }
            self.faces.push(FileFace { vertices, material });
            self.origins.push(origin);
        }
        Ok(())
    }

    /// Returns the mesh of these triangles without copies, with notes about those that are left out.
    /// `place` gives the place of a face in the file at `path`.
    ///
    /// # Errors
    /// No triangle is left, or very many meet at one corner whose normal is their mean.
    pub(in crate::front) fn finish(
        mut self,
        path: &Path,
        place: impl Fn(u32) -> FilePlace,
    ) -> Result<FileMesh, FileError> {
        let fail = |what, place| FileError::new(what, path, place);
        if self.faces.is_empty() {
            return Err(match self.flat.count {
                0 => fail(MeshFile::NoFaces, FilePlace::Whole),
                _ => fail(MeshFile::NoArea, place(self.flat.first)),
            });
        }
        let mut copies = LeftOut::default();
        let is_copy = copied(&self.faces);
        let mut triangles = self.origins.iter().zip(is_copy);
        let coloured = std::mem::take(&mut self.colours);
        let mut coloured = coloured.into_iter();
        let mut colours = Vec::with_capacity(coloured.len());
        let shading = std::mem::take(&mut self.shading);
        let mut shading = shading.into_iter();
        let mut kept = Vec::new();
        self.faces.retain(|_| {
            let shading = shading.next();
            let copy = triangles.next().filter(|(_, is_copy)| *is_copy);
            let is_kept = copy.inspect(|(origin, _)| copies.add(**origin)).is_none();
            kept.extend(shading.filter(|_| is_kept));
            colours.extend(coloured.next().filter(|_| is_kept));
            is_kept
        });
        let normals = corner_normals(&self.faces, &kept);
        let normals =
            normals.map_err(|count| fail(MeshFile::ManyAround { count }, FilePlace::Whole))?;
        let note = |left: LeftOut, what: fn(usize) -> MeshFile| {
            (left.count > 0).then(|| fail(what(left.count), place(left.first)))
        };
        let flat = note(self.flat, |count| MeshFile::FlatLeftOut { count });
        let copies = note(copies, |count| MeshFile::CopiesLeftOut { count });
        Ok(FileMesh {
            faces: self.faces,
            normals,
            colours,
            materials: Vec::new(),
            files: vec![path.to_owned()],
            notes: flat.into_iter().chain(copies).collect(),
        })
    }
}

/// Returns the unit normals of the corners of all `faces`; none if all faces are flat. Faces after the
/// last `shading` are flat.
///
/// # Errors
/// The number of triangles at one corner, if they are too many for a mean.
fn corner_normals(faces: &[FileFace], shading: &[Shading]) -> Result<Vec<[DVec3; 3]>, usize> {
    if shading.is_empty() {
        return Ok(Vec::new());
    }
    let of = |face: usize| shading.get(face).copied().unwrap_or(Shading::Flat);
    let triangles: Vec<[DVec3; 3]> = faces.iter().map(|face| face.vertices).collect();
    let is_grouped = |shading: &Shading| matches!(shading, Shading::OfGroup(_));
    let means = if shading.iter().any(is_grouped) {
        mean_normals(&triangles, &mut { MOST_PAIRS }, |[face, other], _| {
            is_grouped(&of(face)) && of(face) == of(other)
        })?
    } else {
        Vec::new()
    };
    let normals = triangles.iter().enumerate().map(|(face, triangle)| {
        let own = unit_normal(triangle);
        match of(face) {
            Shading::Flat => [own; 3],
            Shading::OfCorners(normals) => normals.map(|n| n.try_normalize().unwrap_or(own)),
            Shading::OfGroup(_) => means[face],
        }
    });
    Ok(normals.collect())
}

/// Marks each triangle that has the corners of an earlier one, in the same cyclic order.
fn copied(faces: &[FileFace]) -> Vec<bool> {
    let corners = |face: u32| corners(&faces[face as usize].vertices);
    let mut order: Vec<(u64, u32)> = (0..faces.len() as u32)
        .map(|face| (hash(&corners(face)), face))
        .collect();
    // Equal hashes may be chosen, so the corners decide.
    order.sort_unstable_by(|(hash, face), (other_hash, other)| {
        let by_corners = || corners(*face).cmp(&corners(*other));
        let by_hash = hash.cmp(other_hash);
        by_hash.then_with(by_corners).then(face.cmp(other))
    });
    let mut copied = vec![false; faces.len()];
    for pair in order.windows(2) {
        let [(hash, face), (other_hash, other)] = [pair[0], pair[1]];
        copied[other as usize] = hash == other_hash && corners(face) == corners(other);
    }
    copied
}

/// The bits of a triangle's corners, from the least corner on; -0 is written as 0.
fn corners(vertices: &[DVec3; 3]) -> [[u64; 3]; 3] {
    let corners = vertices.map(|v| v.to_array().map(|x| (x + 0.0).to_bits()));
    let least = (0..3).min_by_key(|corner| corners[*corner]).unwrap_or(0);
    [0, 1, 2].map(|corner| corners[(least + corner) % 3])
}

fn hash(corners: &[[u64; 3]; 3]) -> u64 {
    // The odd multiplier of Fibonacci hashing.
    const PHI: u64 = 0x9e37_79b9_7f4a_7c15;
    let words = corners.as_flattened().iter();
    words.fold(0, |hash, word| {
        (hash ^ word).wrapping_mul(PHI).rotate_left(29)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(origin: u32) -> FilePlace {
        FilePlace::Line(origin as usize + 1)
    }

    fn flat(places: &[DVec3]) -> Corners<'_> {
        Corners {
            places,
            normals: Normals::Flat,
            colours: &[],
        }
    }

    #[test]
    fn copies_are_left_out_whichever_corner_comes_first() {
        let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let minus = DVec3::new(-0.0, 0.0, -0.0);
        let mut collector = Collector::default();
        for (origin, face) in [
            [a, b, c],
            [c, a, b],
            // The other side is another face.
            [a, c, b],
            [b, c, minus],
            [b, c, DVec3::Z],
        ]
        .iter()
        .enumerate()
        {
            let added = collector.add(flat(face), Some(origin), origin as u32);
            added.unwrap();
        }
        let FileMesh { faces, notes, .. } = collector.finish("m".as_ref(), place).unwrap();
        let kept: Vec<_> = faces.iter().filter_map(|face| face.material).collect();
        assert_eq!(kept, [0, 2, 4]);
        assert_eq!(notes.len(), 1);
        assert_eq!(*notes[0].what, MeshFile::CopiesLeftOut { count: 2 });
        assert_eq!(notes[0].place, FilePlace::Line(2));
    }

    #[test]
    fn triangles_keep_the_colours_of_their_corners() {
        let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        let colours = [[0.0; 3], [0.25; 3], [0.5; 3], [0.75; 3]];
        let mut collector = Collector::default();
        // The second face has no area, the third is a copy of half of the first.
        for (places, colours) in [
            (&[a, b, c, d][..], &colours[..]),
            (&[a, b, b], &[[1.0; 3]; 3]),
            (&[a, b, c], &[[1.0; 3]; 3]),
            (&[c, b, DVec3::Z], &colours[1..]),
        ] {
            let face = Corners {
                colours,
                ..flat(places)
            };
            collector.add(face, None, 0).unwrap();
        }
        let mesh = collector.finish("m".as_ref(), place).unwrap();
        let found: Vec<_> = mesh.colours.iter().map(|face| face.map(|c| c[0])).collect();
        assert_eq!(
            found,
            [[0.0, 0.25, 0.5], [0.0, 0.5, 0.75], [0.25, 0.5, 0.75]]
        );
        assert_eq!(mesh.faces.len(), 3);
    }

    #[test]
    fn a_mesh_needs_a_face_with_an_area() {
        let mut collector = Collector::default();
        let refused = Collector::default().finish("m".as_ref(), place);
        assert_eq!(*refused.unwrap_err().what, MeshFile::NoFaces);
        // The second is thinner than the checks of a scene allow.
        let thin = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 3e-13, 0.0)];
        for face in [[DVec3::ZERO, DVec3::X, DVec3::X], thin] {
            collector.add(flat(&face), None, 6).unwrap();
        }
        let refused = collector.finish("m".as_ref(), place).unwrap_err();
        assert_eq!(
            (*refused.what, refused.place),
            (MeshFile::NoArea, FilePlace::Line(7))
        );
    }
}
