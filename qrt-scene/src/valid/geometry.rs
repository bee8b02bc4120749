//! Converts primitives to polygons: each must have an area, and a quad must be convex.
//!
//! Tolerances are relative to the primitive's size, so a scene of 1e-6 units, or one 1e9 units from
//! the origin, is treated like any other.

use crate::scene::meshes::Meshes;
use crate::scene::shape::LARGEST;
use crate::scene::{Geometry, Mesh, Scene};
use crate::syntax::{
    Material, Mesh as Unplaced, Path, Problem, Problems, Shape as Fault, Triangles, nearest,
};
use crate::valid::{Polygon, Surface, matte};
use glam::DVec3;
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

/// Minimum of twice the area over the square of the longest edge: below it, rounding decides the
/// direction of the normal.
const LEAST_AREA: f64 = 1e-12;
/// Maximum distance of a corner of a planar quad from the plane of the others, relative to the
/// quad's longest extent.
const PLANAR: f64 = 1e-9;

/// The polygons of a scene's primitives and meshes.
pub(super) struct Shapes {
    pub(super) polygons: Vec<Polygon>,
    /// The first polygon of each primitive.
    pub(super) firsts: Vec<usize>,
    /// The files that were read for them, each once.
    pub(super) files: Vec<PathBuf>,
}

pub(super) fn polygons(
    scene: &Scene,
    meshes: &Meshes,
    surfaces: &mut Vec<Surface>,
    problems: &mut Problems,
) -> Shapes {
    let names = HashMap::new();
    let mut build = Build {
        scene,
        meshes,
        surfaces,
        problems,
        names,
        out: vec![],
        files: BTreeSet::new(),
        unknown: 0,
        own_materials: HashMap::new(),
        is_full: false,
    };
    for (index, (name, _)) in scene.materials.iter().enumerate() {
        build.names.entry(name.as_str()).or_insert(index as u32);
    }
    let geometry = Path::root().key("geometry");
    let mut firsts = Vec::with_capacity(scene.geometry.len());
    for (index, primitive) in scene.geometry.iter().enumerate() {
        firsts.push(build.out.len());
        let path = geometry.item(index).key(primitive.kind());
        match primitive {
            Geometry::Quad(quad) => {
                let surface = build.surface(&quad.material, &path);
                build.quad(&quad.vertices, surface, &path);
            }
            Geometry::Triangle(triangle) => {
                let surface = build.surface(&triangle.material, &path);
                build.triangle(&triangle.vertices, surface, &path);
            }
            Geometry::Mesh(mesh) => build.mesh(mesh, &path),
        }
    }
    Shapes {
        polygons: build.out,
        firsts,
        files: build.files.into_iter().collect(),
    }
}

struct Build<'a> {
    scene: &'a Scene,
    meshes: &'a Meshes,
    surfaces: &'a mut Vec<Surface>,
    problems: &'a mut Problems,
    names: HashMap<&'a str, u32>,
    out: Vec<Polygon>,
    /// Files that were read.
    files: BTreeSet<PathBuf>,
    /// Number of unknown materials so far.
    unknown: usize,
    /// For each mesh, the index of the first of its own materials in `surfaces`: copies of a mesh
    /// share them.
    own_materials: HashMap<&'a str, u32>,
    /// True if a mesh has exceeded the limit on faces.
    is_full: bool,
}

impl<'a> Build<'a> {
    /// Returns the index of the surface called `name`. Reports an unknown name and returns the
    /// first surface in its place, so that the primitive's shape is still checked.
    fn surface(&mut self, name: &str, path: &Path) -> u32 {
        if let Some(&surface) = self.names.get(name) {
            return surface;
        }
        let materials = Path::root().key("materials");
        if self.problems.covers(&materials) {
            // The materials are faulty, so the defined names are unknown.
            return 0;
        }
        // Finding the nearest name takes time, so only the first 100 unknown names get advice.
        self.unknown += 1;
        let advised = if self.unknown <= 100 { 1000 } else { 0 };
        let names = self.scene.materials.iter().map(|(name, _)| name.as_str());
        let what = Material::Unknown {
            name: name.to_owned(),
            near: nearest(name, names.clone().take(advised)).map(str::to_owned),
            defined: names
                .clone()
                .take(advised.min(8))
                .map(str::to_owned)
                .collect(),
            more: names.len() > 8,
        };
        self.problems.add(path.key("material"), what);
        0
    }

    /// Reports the fault of a primitive's shape, unless a faulty vertex may have caused it.
    fn fault(&mut self, path: &Path, fault: Fault) {
        let path = path.key("vertices");
        if self.problems.touches(&path) {
            return;
        }
        let problem = match fault {
            Fault::Coincident { first, second } => {
                Problem::new(path.item(second), fault).also(path.item(first))
            }
            Fault::Straight { at } | Fault::Reflex { at } => Problem::new(path.item(at), fault),
            Fault::Flat | Fault::Crossing => Problem::new(path, fault),
        };
        self.problems.push(problem);
    }

    fn triangle(&mut self, vertices: &[DVec3; 3], surface: u32, path: &Path) {
        match triangle_fault(vertices) {
            Some(fault) => self.fault(path, fault),
            None => self.out.push(triangle(*vertices, surface)),
        }
    }

    fn quad(&mut self, vertices: &[DVec3; 4], surface: u32, path: &Path) {
        match quad_fault(vertices) {
            Some(fault) => self.fault(path, fault),
            None if is_planar(vertices) => {
                self.out.push(Polygon {
                    vertices: *vertices,
                    corners: 4,
                    surface,
                });
            }
            None => {
                let [a, b, c, d] = *vertices;
                self.out.push(triangle([a, b, c], surface));
                self.out.push(triangle([a, c, d], surface));
            }
        }
    }

    fn mesh(&mut self, mesh: &'a Mesh, path: &Path) {
        let named = mesh.material.as_ref().map(|name| self.surface(name, path));
        let read = match self.meshes.get(mesh) {
            Ok(read) => read,
            Err(error) => {
                self.problems.add(path.key("obj"), error.problem());
                return;
            }
        };
        self.files.extend(read.files.iter().cloned());
        let triangles = self.out.len() + read.faces.len();
        let most = self.meshes.most_faces();
        if triangles > most {
            let what = Unplaced::TooMany { triangles, most };
            if !std::mem::replace(&mut self.is_full, true) {
                self.problems.add(path.key("obj"), what);
            }
            return;
        }
        let transform = Transform::from_mesh(mesh);
        let first = self.own_materials.get(mesh.obj.as_str()).copied();
        let is_new = first.is_none() && named.is_none();
        let first = first.unwrap_or(self.surfaces.len() as u32);
        if is_new {
            self.own_materials.insert(&mesh.obj, first);
            for material in &read.materials {
                if let Some(radiance) = material.radiance.iter().find(|value| **value > LARGEST) {
                    let what = Unplaced::TooBright {
                        material: material.name.clone(),
                        radiance: *radiance,
                        most: LARGEST,
                    };
                    self.problems.add(path.key("obj"), what);
                }
                self.surfaces.push(Surface {
                    name: material.name.clone(),
                    radiance: material.radiance,
                    scatter: matte(material.albedo),
                });
            }
        }
        self.out.reserve_exact(read.faces.len());
        let mut flat = Vec::new();
        let mut bare = Vec::new();
        let mut far = Vec::new();
        for (index, face) in read.faces.iter().enumerate() {
            let own = || face.material.map(|material| first + material as u32);
            let Some(surface) = named.or_else(own) else {
                bare.push(index);
                continue;
            };
            let vertices = face.vertices.map(|vertex| transform.apply(vertex));
            if !vertices
                .iter()
                .all(|vertex| vertex.abs().cmple(DVec3::splat(LARGEST)).all())
            {
                far.push(index);
            } else if triangle_fault(&vertices).is_some() {
                flat.push(index);
            } else {
                self.out.push(triangle(vertices, surface));
            }
        }
        let all = read.faces.len();
        let kinds: [(&[usize], Kind); 3] = [
            (&bare, |triangles| Unplaced::NoMaterial { triangles }),
            (&flat, |triangles| Unplaced::Flat { triangles }),
            (&far, |triangles| Unplaced::Far { triangles }),
        ];
        for (faces, what) in kinds {
            if let Some(&first) = faces.first() {
                let some = faces.len();
                let what = what(Triangles { some, all, first });
                self.problems.add(path.key("obj"), what);
            }
        }
    }
}

/// The constructor of a problem of triangles that cannot be placed.
type Kind = fn(Triangles) -> Unplaced;

fn triangle([a, b, c]: [DVec3; 3], surface: u32) -> Polygon {
    Polygon {
        vertices: [a, b, c, c],
        corners: 3,
        surface,
    }
}

fn coincident(vertices: &[DVec3]) -> Option<Fault> {
    (0..vertices.len())
        .flat_map(|b| (0..b).map(move |a| (a, b)))
        .find(|&(a, b)| vertices[a] == vertices[b])
        .map(|(first, second)| Fault::Coincident { first, second })
}

/// The vertices relative to the first, in units of the longest extent, so that nothing over- or
/// underflows.
fn unit<const N: usize>(vertices: &[DVec3; N]) -> [DVec3; N] {
    let edges = vertices.map(|vertex| vertex - vertices[0]);
    let size = edges
        .iter()
        .map(|edge| edge.abs().max_element())
        .fold(0.0, f64::max);
    edges.map(|edge| edge / size)
}

fn triangle_fault(vertices: &[DVec3; 3]) -> Option<Fault> {
    if let Some(fault) = coincident(vertices) {
        return Some(fault);
    }
    let [_, b, c] = unit(vertices);
    let area = b.cross(c).length();
    let longest = b
        .length_squared()
        .max(c.length_squared())
        .max((c - b).length_squared());
    let ok = area > LEAST_AREA * longest;
    (!ok).then_some(Fault::Flat)
}

fn quad_fault(vertices: &[DVec3; 4]) -> Option<Fault> {
    if let Some(fault) = coincident(vertices) {
        return Some(fault);
    }
    let corner = unit(vertices);
    let turn = |at: usize| {
        let (before, here, after) = (corner[(at + 3) % 4], corner[at], corner[(at + 1) % 4]);
        (here - before).cross(after - here)
    };
    let turns: [DVec3; 4] = std::array::from_fn(turn);
    let edge = |at: usize| (corner[(at + 1) % 4] - corner[at]).length_squared();
    let longest = (0..4).map(edge).fold(0.0, f64::max);
    let least = LEAST_AREA * longest;
    let straight: Vec<usize> = (0..4).filter(|&at| turns[at].length() <= least).collect();
    match straight[..] {
        [] => {}
        [at] => return Some(Fault::Straight { at }),
        _ => return Some(Fault::Flat),
    }
    // Twice the vector area; zero for a symmetric bow tie, where any corner will do.
    let area = (corner[2] - corner[0]).cross(corner[3] - corner[1]);
    let normal = if area.length() > least {
        area
    } else {
        turns[0]
    };
    let against: Vec<usize> = (0..4).filter(|&at| turns[at].dot(normal) <= 0.0).collect();
    match against[..] {
        [] => None,
        [at] => Some(Fault::Reflex { at }),
        _ => Some(Fault::Crossing),
    }
}

fn is_planar(vertices: &[DVec3; 4]) -> bool {
    let [_, b, c, d] = unit(vertices);
    let normal = b.cross(c);
    d.dot(normal).abs() <= PLANAR * normal.length()
}

/// Scale, then rotation about x, then y, then z, then translation.
struct Transform {
    columns: [DVec3; 3],
    translate: DVec3,
}

impl Transform {
    fn from_mesh(mesh: &Mesh) -> Self {
        let [x, y, z] = mesh.rotate.to_array().map(sin_cos_degrees);
        let turn = |v: DVec3| {
            let v = DVec3::new(v.x, x.1 * v.y - x.0 * v.z, x.0 * v.y + x.1 * v.z);
            let v = DVec3::new(y.1 * v.x + y.0 * v.z, v.y, y.1 * v.z - y.0 * v.x);
            DVec3::new(z.1 * v.x - z.0 * v.y, z.0 * v.x + z.1 * v.y, v.z)
        };
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn(axis) * mesh.scale);
        Self {
            columns,
            translate: mesh.translate,
        }
    }

    fn apply(&self, v: DVec3) -> DVec3 {
        self.columns[0] * v.x + self.columns[1] * v.y + self.columns[2] * v.z + self.translate
    }
}

/// Returns the sine and cosine of an angle in degrees, exact at multiples of 90, so that edges
/// parallel to an axis stay parallel.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = libm::fmod(degrees, 360.0);
    let turn = if turn < 0.0 { turn + 360.0 } else { turn };
    match turn {
        0.0 | 360.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => {
            let radians = turn.to_radians();
            (libm::sin(radians), libm::cos(radians))
        }
    }
}

#[cfg(test)]
mod tests;
