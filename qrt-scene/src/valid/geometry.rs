//! Converts primitives to polygons: each must have an area, and a quad must be convex.
//!
//! Tolerances are relative to the primitive's size, so a scene of 1e-6 units, or one 1e9 units from
//! the origin, is treated like any other.

use crate::polygons::{MOST_PAIRS, mean_normals, unit_across, unit_normal, unit_vector};
use crate::scene::finalize::second_file;
use crate::scene::meshes::{FileError, FileMesh, Meshes};
use crate::scene::shape::LARGEST;
use crate::scene::{Cuboid, Disc, Geometry, Lambertian, Material, Mesh, MeshFormat, Scene};
use crate::valid::bsdf::Faces;
use crate::valid::{Ball, ColouredFace, Polygon, Scatter, SmoothFace, Surface, simple};
use glam::{BVec3, DVec3};
use qrt_syntax::{
    Material as Naming, Mesh as Unplaced, MeshFile, Path, Problem, Problems, Shape as Fault,
    Structure, Triangles, nearest,
};
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::PathBuf;

/// Minimum of twice the area over the square of the longest edge: below it, rounding decides the
/// direction of the normal.
const LEAST_AREA: f64 = 1e-12;
/// Maximum sine of the angle between a corner's normal and its face's own that counts as rounding:
/// files have normals of four decimals.
const FLAT: f64 = 1e-3;
/// Minimum cosine of the angle between a corner's normal and its face's own. Interpolated normals are
/// then at least this long, and no face is shaded from behind.
pub(super) const LEAST_COSINE: f64 = 0.25;
/// Maximum distance of a corner of a planar quad from the plane of the others, relative to the
/// quad's longest extent.
const PLANAR: f64 = 1e-9;

/// The corners of a box's six faces, counterclockwise as seen from outside. Bit 0 of a corner is set at the greatest x,
/// bit 1 at the greatest y, bit 2 at the greatest z.
const BOX: [[u8; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// Maximum number of keywords without a counterpart that a note names.
const MOST_KEYWORDS: usize = 16;

/// The faces of a scene's primitives and meshes.
pub(super) struct Shapes {
    pub(super) polygons: Vec<Polygon>,
    pub(super) smooth: Vec<SmoothFace>,
    pub(super) coloured: Vec<ColouredFace>,
    pub(super) balls: Vec<Ball>,
    /// The first polygon of each primitive.
    pub(super) firsts: Vec<usize>,
    /// The files that were read for them, each once.
    pub(super) files: Vec<PathBuf>,
}

impl Shapes {
    /// The faces of a surface.
    pub(super) fn faces(&self, surface: u32) -> Faces {
        let polygons = self.polygons.iter().filter(|face| face.surface == surface);
        let balls = self.balls.iter().filter(|face| face.surface == surface);
        Faces::new(&polygons.collect::<Vec<_>>(), &balls.collect::<Vec<_>>())
    }
}

pub(super) fn polygons(
    scene: &Scene,
    meshes: &Meshes,
    surfaces: &mut Vec<Surface>,
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) -> Shapes {
    let names = HashMap::new();
    let mut build = Build {
        scene,
        meshes,
        surfaces,
        problems,
        names,
        out: vec![],
        smooth: vec![],
        coloured: vec![],
        pairs_left: MOST_PAIRS,
        balls: vec![],
        spheres: HashSet::new(),
        files: BTreeSet::new(),
        unknown: 0,
        own_materials: HashMap::new(),
        is_full: false,
        warnings,
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
                let moved = Transform::of_shape(quad.scale, quad.rotate, quad.translate);
                if let Some(vertices) = build.moved(quad.vertices, moved, &path) {
                    build.quad(&vertices, surface, &path);
                }
            }
            Geometry::Triangle(triangle) => {
                let surface = build.surface(&triangle.material, &path);
                let moved =
                    Transform::of_shape(triangle.scale, triangle.rotate, triangle.translate);
                if let Some(vertices) = build.moved(triangle.vertices, moved, &path) {
                    build.triangle(&vertices, surface, &path);
                }
            }
            Geometry::Sphere(sphere) => {
                let surface = build.surface(&sphere.material, &path);
                let moved = Transform::of_shape(sphere.scale, sphere.rotate, sphere.translate);
                if let Some([centre]) = build.moved([sphere.center], moved, &path) {
                    let radius = sphere.radius * sphere.scale;
                    build.ball(centre, radius, (surface, index), &path);
                }
            }
            Geometry::Disc(disc) => {
                let surface = build.surface(&disc.material, &path);
                build.disc(disc, surface, &path);
            }
            Geometry::Cuboid(cuboid) => {
                let surface = build.surface(&cuboid.material, &path);
                build.cuboid(cuboid, surface, &path);
            }
            Geometry::Mesh(mesh) => build.mesh(mesh, &path),
        }
    }
    Shapes {
        polygons: build.out,
        smooth: build.smooth,
        coloured: build.coloured,
        balls: build.balls,
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
    /// The polygons so far that are not flat.
    smooth: Vec<SmoothFace>,
    /// The polygons so far with colours of their corners.
    coloured: Vec<ColouredFace>,
    /// Number of pairs of triangles that may still be compared for means of normals.
    pairs_left: u64,
    balls: Vec<Ball>,
    /// Centres and radii of the spheres so far, by their bits.
    spheres: HashSet<[u64; 4]>,
    /// Files that were read.
    files: BTreeSet<PathBuf>,
    /// Number of unknown materials so far.
    unknown: usize,
    /// For each mesh, the indices of its materials in `surfaces`: copies of a mesh share them.
    own_materials: HashMap<(MeshFormat, &'a str), Vec<u32>>,
    /// True if a mesh has exceeded the limit on faces.
    is_full: bool,
    warnings: &'a mut Vec<Problem>,
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
        let what = Naming::Unknown {
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
            _ => Problem::new(path, fault),
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
                    disc: false,
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

    /// Moves the points of a shape. Reports points that are moved out of range. Returns `None` for a shape
    /// whose place is not known.
    fn moved<const N: usize>(
        &mut self,
        points: [DVec3; N],
        transform: Option<Transform>,
        path: &Path,
    ) -> Option<[DVec3; N]> {
        let mut keys = ["scale", "rotate", "translate"].into_iter();
        if keys.any(|key| self.problems.touches(&path.key(key))) {
            return None;
        }
        let Some(transform) = transform else {
            return Some(points);
        };
        let moved = points.map(|point| transform.apply(point));
        let fault = if !moved.iter().all(|&point| is_in_range(point)) {
            Fault::Far
        } else if is_repeated(&moved) && !is_repeated(&points) {
            Fault::Merged
        } else {
            return Some(moved);
        };
        if !self.problems.touches(path) {
            self.problems.add(path.clone(), fault);
        }
        None
    }

    /// True if nothing leaves surface number `surface`. User-defined BSDFs are not compiled yet.
    fn is_black(&self, surface: usize) -> bool {
        let own = self.scene.materials.get(surface);
        let is_custom = matches!(own, Some((_, Material::Bsdf(_))));
        let known = self.surfaces.get(surface);
        !is_custom && known.is_some_and(|known| matches!(known.scatter, Scatter::Black))
    }

    /// Adds a sphere, unless there is one in its place: the first of several hides the others.
    fn ball(
        &mut self,
        centre: DVec3,
        radius: f64,
        (surface, primitive): (u32, usize),
        path: &Path,
    ) {
        if !(radius > 0.0 && radius <= LARGEST) {
            let fault = if radius > 0.0 {
                Fault::Far
            } else {
                Fault::Small
            };
            if !self.problems.touches(path) {
                self.problems.add(path.clone(), fault);
            }
            return;
        }
        let [x, y, z] = (centre + DVec3::ZERO).to_array();
        let place = [x, y, z, radius].map(f64::to_bits);
        if self.spheres.insert(place) {
            self.balls.push(Ball {
                centre,
                radius,
                surface,
                primitive,
            });
        }
    }

    /// Adds a disc, by the square around it.
    fn disc(&mut self, disc: &Disc, surface: u32, path: &Path) {
        let normal = path.key("normal");
        if self.problems.touches(&normal) {
            return;
        }
        let Some(mut front) = unit_vector(disc.normal) else {
            return self.problems.add(normal, Fault::NoNormal);
        };
        let moved = Transform::of_shape(disc.scale, disc.rotate, disc.translate);
        if let Some(transform) = &moved {
            front = transform.turn(front);
        }
        let Some([centre]) = self.moved([disc.center], moved, path) else {
            return;
        };
        let radius = disc.radius * disc.scale;
        let vertices = square_around(centre, front, radius);
        let fault = if !vertices.iter().all(|&vertex| is_in_range(vertex)) {
            Fault::Far
        } else if quad_fault(&vertices).is_some() {
            Fault::Small
        } else {
            return self.out.push(Polygon {
                vertices,
                corners: 4,
                disc: true,
                surface,
            });
        };
        if !self.problems.touches(path) {
            self.problems.add(path.clone(), fault);
        }
    }

    /// Adds the six quads of a box.
    fn cuboid(&mut self, cuboid: &Cuboid, surface: u32, path: &Path) {
        let [min, max] = ["min", "max"].map(|key| path.key(key));
        if self.problems.touches(&min) || self.problems.touches(&max) {
            return;
        }
        let flat = (0..3).filter(|&axis| cuboid.min[axis] >= cuboid.max[axis]);
        let axes: Vec<_> = flat.map(|axis| ["x", "y", "z"][axis]).collect();
        if !axes.is_empty() {
            let problem = Problem::new(max, Fault::NoVolume { axes });
            return self.problems.push(problem.also(min));
        }
        let transform = Transform::new(cuboid.scale, cuboid.rotate, cuboid.translate);
        let faces = BOX.map(|corners| {
            corners.map(|corner| {
                let far = BVec3::new(corner & 1 != 0, corner & 2 != 0, corner & 4 != 0);
                transform.apply(DVec3::select(far, cuboid.max, cuboid.min))
            })
        });
        if !faces
            .as_flattened()
            .iter()
            .all(|&corner| is_in_range(corner))
        {
            self.problems.add(path.clone(), Fault::Far);
        } else if faces.iter().any(|face| quad_fault(face).is_some()) {
            self.problems.add(path.clone(), Fault::Thin);
        } else {
            for face in &faces {
                self.quad(face, surface, path);
            }
        }
    }

    fn mesh(&mut self, mesh: &'a Mesh, path: &Path) {
        let Some((format, name)) = mesh.file() else {
            let mut formats = mesh.files().map(|(format, _)| format.name());
            if let (Some(first), Some(second)) = (formats.next(), formats.next()) {
                self.problems.push(second_file(path, first, second));
            } else {
                self.problems.add(path.clone(), Structure::NoFile);
            }
            return;
        };
        let file = (format, name);
        let place = path.key(format.name());
        let named = mesh.material.as_ref().map(|name| self.surface(name, path));
        let read = match self.meshes.get(mesh) {
            Ok(read) => read,
            Err(error) => {
                self.problems.add(place.clone(), error.problem());
                return;
            }
        };
        let is_new = read.files.iter().any(|file| !self.files.contains(file));
        let is_meant = |note: &&FileError| match *note.what {
            MeshFile::ColoursUnused => mesh.colors.is_none(),
            _ => is_new,
        };
        for note in read.notes.iter().filter(is_meant) {
            let note = Problem::new(place.clone(), note.clone().problem());
            // The mesh may have been placed with another choice of materials.
            if !self.warnings.iter().any(|known| known.what == note.what) {
                self.warnings.push(note);
            }
        }
        self.files.extend(read.files.iter().cloned());
        let triangles = self.out.len() + read.faces.len();
        let most = self.meshes.most_faces();
        if triangles > most {
            let what = Unplaced::TooMany { triangles, most };
            if !std::mem::replace(&mut self.is_full, true) {
                self.problems.add(place.clone(), what);
            }
            return;
        }
        let transform = Transform::new(mesh.scale, mesh.rotate, mesh.translate);
        let own = match named {
            None => self.own_materials(file, read, &place),
            Some(_) => Vec::new(),
        };
        let Some(normals) = self.normals(mesh, read, &path.key("smooth")) else {
            return;
        };
        if mesh.is_coloured() {
            match mesh.material.as_deref() {
                None => self.check_colourable(&own, &place),
                // An unknown material has been reported.
                Some(name) => {
                    let known = self.names.get(name).copied();
                    self.check_colourable(known.as_slice(), &path.key("material"));
                }
            }
        }
        self.out.reserve_exact(read.faces.len());
        let mut flat = Vec::new();
        let mut bare = Vec::new();
        let mut far = Vec::new();
        for (index, face) in read.faces.iter().enumerate() {
            let of_file = || face.material.map(|material| own[material]);
            let Some(surface) = named.or_else(of_file) else {
                bare.push(index);
                continue;
            };
            let vertices = face.vertices.map(|vertex| transform.apply(vertex));
            if !vertices.iter().all(|&vertex| is_in_range(vertex)) {
                far.push(index);
            } else if triangle_fault(&vertices).is_some() {
                flat.push(index);
            } else {
                let is_black = self.is_black(surface as usize);
                if let Some(normals) = normals.get(index).filter(|_| !is_black) {
                    let turned = normals.map(|normal| transform.turn(normal));
                    let normals = shading_normals(&vertices, turned);
                    let polygon = self.out.len();
                    self.smooth
                        .extend(normals.map(|normals| SmoothFace { polygon, normals }));
                }
                // White changes nothing.
                let colours = read.colours.get(index).filter(|c| **c != [[1.0; 3]; 3]);
                if let Some(&colours) = colours.filter(|_| !is_black) {
                    let polygon = self.out.len();
                    self.coloured.push(ColouredFace { polygon, colours });
                }
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
                self.problems.add(place.clone(), what);
            }
        }
    }
}

impl<'a> Build<'a> {
    /// Returns the normals of the corners of a mesh's faces, in the file's frame; empty if the mesh is
    /// flat. `None` after a problem.
    fn normals<'m>(
        &mut self,
        mesh: &Mesh,
        read: &'m FileMesh,
        path: &Path,
    ) -> Option<Cow<'m, [[DVec3; 3]]>> {
        let degrees = match mesh.smooth {
            None => return Some(Cow::Borrowed(&read.normals)),
            Some(0.0) => return Some(Cow::Borrowed(&[])),
            Some(degrees) => degrees,
        };
        // Rounding may turn faces that make exactly this angle.
        let least = libm::cos(degrees.to_radians()) - 1e-9;
        let triangles: Vec<[DVec3; 3]> = read.faces.iter().map(|face| face.vertices).collect();
        match mean_normals(&triangles, &mut self.pairs_left, |_, [a, b]| {
            a.dot(b) >= least
        }) {
            Ok(normals) => Some(Cow::Owned(normals)),
            Err(count) => {
                self.problems
                    .add(path.clone(), Unplaced::ManyAround { count });
                None
            }
        }
    }

    /// Reports the first of a coloured mesh's `surfaces` whose tint is not one colour. Black surfaces scatter nothing, so
    /// that colours do not matter there.
    fn check_colourable(&mut self, surfaces: &[u32], place: &Path) {
        let uncoloured = |surface: u32| {
            let own = self.scene.materials.get(surface as usize);
            let surface = self.surfaces.get(surface as usize)?;
            let kind = match (own, &surface.scatter) {
                (Some((_, Material::Bsdf(_))), _) | (_, Scatter::Custom(_)) => "bsdf",
                (_, Scatter::Dielectric(_)) => "dielectric",
                (_, Scatter::Phong(_)) => "phong",
                _ => surface.checker().map(|_| "checker")?,
            };
            let name = surface.name.clone();
            Some(Unplaced::Uncoloured { name, kind })
        };
        if let Some(what) = surfaces.iter().copied().find_map(uncoloured) {
            self.problems.add(place.clone(), what);
        }
    }

    /// Returns the surfaces of the materials of a mesh's file, as indices into `surfaces`. Those
    /// that materials of the scene replace are the scene's.
    fn own_materials(
        &mut self,
        file: (MeshFormat, &'a str),
        read: &FileMesh,
        place: &Path,
    ) -> Vec<u32> {
        if let Some(known) = self.own_materials.get(&file) {
            return known.clone();
        }
        let (mut own, mut left_out) = (Vec::with_capacity(read.materials.len()), Vec::new());
        for material in &read.materials {
            if let Some(&surface) = self.names.get(material.name.as_str()) {
                own.push(surface);
                continue;
            }
            own.push(self.surfaces.len() as u32);
            let black = Material::Lambertian(Lambertian {
                albedo: [0.0; 3].into(),
            });
            let meant = match &material.material {
                Ok(meant) => meant,
                Err(error) => {
                    // A faulty material of the scene may be meant to replace it.
                    if !self.problems.covers(&Path::root().key("materials")) {
                        self.problems.add(place.clone(), error.clone().problem());
                    }
                    &black
                }
            };
            let (radiance, scatter) = simple(meant).unwrap_or(([0.0; 3], Scatter::Black));
            if let Some(radiance) = radiance.iter().find(|value| **value > LARGEST) {
                let what = Unplaced::TooBright {
                    material: material.label.clone(),
                    radiance: *radiance,
                    most: LARGEST,
                };
                self.problems.add(place.clone(), what);
            }
            self.surfaces.push(Surface {
                name: material.label.clone(),
                radiance,
                scatter,
            });
            if !material.left_out.is_empty() {
                left_out.push(material);
            }
        }
        if let Some(first) = left_out.first() {
            let keywords: BTreeSet<&String> = left_out.iter().flat_map(|m| &m.left_out).collect();
            let what = MeshFile::LeftOut {
                keywords: keywords.into_iter().take(MOST_KEYWORDS).cloned().collect(),
                name: first.name.clone(),
                others: left_out.len() - 1,
            };
            let note = FileError::new(what, &first.file, first.place.clone());
            self.warnings
                .push(Problem::new(place.clone(), note.problem()));
        }
        self.own_materials.insert(file, own.clone());
        own
    }
}

/// Corners of a square around a disc, counterclockwise as seen from the side of the unit `normal`. Its
/// edges are parallel to an axis where the plane allows it, which saves products in circuits.
fn square_around(centre: DVec3, normal: DVec3, radius: f64) -> [DVec3; 4] {
    let first = unit_across(normal) * radius;
    let second = normal.cross(first);
    [
        centre - first - second,
        centre + first - second,
        centre + first + second,
        centre - first + second,
    ]
}

/// The constructor of a problem of triangles that cannot be placed.
type Kind = fn(Triangles) -> Unplaced;

fn triangle([a, b, c]: [DVec3; 3], surface: u32) -> Polygon {
    Polygon {
        vertices: [a, b, c, c],
        corners: 3,
        disc: false,
        surface,
    }
}

/// Returns the normals of a triangle's corners as its shading uses them: on the side of its front, and
/// within 75.5 degrees of its own normal. `None` if all are its own up to rounding: it is flat.
fn shading_normals(vertices: &[DVec3; 3], normals: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let own = unit_normal(vertices);
    let [a, b, c] = normals;
    // A file may have all normals on the other side.
    let side = if (a + b + c).dot(own) < 0.0 {
        -1.0
    } else {
        1.0
    };
    let normals = normals.map(|normal| normal * side);
    let is_own = |normal: &DVec3| normal.dot(own) > 0.0 && normal.cross(own).length() <= FLAT;
    if normals.iter().all(is_own) {
        return None;
    }
    Some(normals.map(|normal| {
        let cosine = normal.dot(own);
        if cosine >= LEAST_COSINE {
            return normal;
        }
        let across = (normal - own * cosine).normalize_or_zero();
        let sine = (1.0 - LEAST_COSINE * LEAST_COSINE).sqrt();
        // A normal that is opposite to the face's own has no direction to lean to.
        (own * LEAST_COSINE + across * sine).normalize()
    }))
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

pub(crate) fn triangle_fault(vertices: &[DVec3; 3]) -> Option<Fault> {
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

/// True if two of `points` are one.
fn is_repeated(points: &[DVec3]) -> bool {
    (1..points.len()).any(|at| points[..at].contains(&points[at]))
}

/// True if no coordinate of `point` is larger than those that a scene may have.
fn is_in_range(point: DVec3) -> bool {
    point.abs().cmple(DVec3::splat(LARGEST)).all()
}

/// Scale, then rotation about x, then y, then z, then translation.
struct Transform {
    columns: [DVec3; 3],
    translate: DVec3,
}

impl Transform {
    /// Returns the transform of a shape; `None` if it stays as it is.
    fn of_shape(scale: f64, rotate: DVec3, translate: DVec3) -> Option<Self> {
        let stays = scale == 1.0 && rotate == DVec3::ZERO && translate == DVec3::ZERO;
        (!stays).then(|| Self::new(scale, rotate, translate))
    }

    fn new(scale: f64, rotate: DVec3, translate: DVec3) -> Self {
        let [x, y, z] = rotate.to_array().map(sin_cos_degrees);
        let turn = |v: DVec3| {
            let v = DVec3::new(v.x, x.1 * v.y - x.0 * v.z, x.0 * v.y + x.1 * v.z);
            let v = DVec3::new(y.1 * v.x + y.0 * v.z, v.y, y.1 * v.z - y.0 * v.x);
            DVec3::new(z.1 * v.x - z.0 * v.y, z.0 * v.x + z.1 * v.y, v.z)
        };
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn(axis) * scale);
        Self { columns, translate }
    }

    /// Turns a unit normal. The scale is above 0.
    fn turn(&self, normal: DVec3) -> DVec3 {
        let [x, y, z] = self.columns;
        (x * normal.x + y * normal.y + z * normal.z).normalize_or_zero()
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
