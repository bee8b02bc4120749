//! Validation: turns a `Scene` into a [`ValidScene`], or reports all errors at once.
//!
//! The range of each value is part of its definition in [`crate::Scene`]. This module checks the
//! ranges, and relations between values: names are defined, primitives have an area, path indices
//! fit into a word.

pub mod bsdf;
mod camera;
mod counting;
mod geometry;
pub(crate) use geometry::triangle_fault;
mod glass;
pub mod lights;
mod parameters;
mod sampling;
mod sky;
mod warnings;

pub use parameters::Parameters;
pub use sampling::{MAX_ID_BITS, MAX_NET_DEPTHS};

use crate::lights::Cone;
pub use crate::scene::invalid::InvalidScene;
use crate::scene::meshes::Meshes;
use crate::scene::shape::Part;
use crate::scene::text::Fingerprint;
use crate::scene::{
    Bsdf, Checker, Dielectric, Ggx, Lambertian, Material, Metal, Mirror, Phong, Reflectance, Rgb,
    Scene, Sun,
};
use glam::DVec3;
use qrt_syntax::expr::{Expr, Variable};
use qrt_syntax::{Path, Place, Problem, Problems};
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// A checked scene, which all later stages require. Only validation ([`validate`]) creates one.
#[derive(Clone, Debug)]
pub struct ValidScene {
    pub(crate) scene: Scene,
    pub(crate) materials: Vec<Surface>,
    pub(crate) polygons: Vec<Polygon>,
    pub(crate) smooth: Vec<SmoothFace>,
    pub(crate) coloured: Vec<ColouredFace>,
    pub(crate) balls: Vec<Ball>,
    /// The first polygon of each primitive.
    pub(crate) firsts: Vec<usize>,
    pub(crate) files: Vec<PathBuf>,
    pub(crate) warnings: Vec<Problem>,
    /// True if the estimator follows from the number of pixels.
    by_size: bool,
    /// The number of the strategy that `uncompute: auto` chooses, cached because it takes a search.
    auto: OnceLock<usize>,
    /// The fingerprint, cached because it takes a second for millions of faces.
    fingerprint: OnceLock<Fingerprint>,
    /// Number of programs recorded from this scene, or from it with other parameters.
    recordings: Arc<AtomicU64>,
}

/// The emission and scattering of a surface. [`ValidScene::surfaces`] lists the scene's materials
/// first, in their order, then those of mesh files.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The name in the scene, or `FILE.mtl:NAME`.
    pub name: String,
    /// The radiance that leaves the front, in W/(sr m^2), linear RGB.
    pub radiance: Rgb,
    /// The surface's scattering.
    pub scatter: Scatter,
}

impl Surface {
    /// True if the surface emits in any channel.
    pub fn emits(&self) -> bool {
        self.radiance.iter().any(|&channel| channel > 0.0)
    }

    /// The surface's albedo or reflectance. `None` for materials without exactly one.
    pub fn tint(&self) -> Option<&Reflectance> {
        match &self.scatter {
            Scatter::Lambertian(lobe) => Some(&lobe.albedo),
            Scatter::Mirror(lobe) => Some(&lobe.reflectance),
            Scatter::Ggx(lobe) => Some(&lobe.reflectance),
            Scatter::Metal(lobe) => Some(&lobe.reflectance),
            Scatter::Black | Scatter::Dielectric(_) | Scatter::Phong(_) | Scatter::Custom(_) => {
                None
            }
        }
    }

    /// The checker of the surface's albedo or reflectance, if it has one.
    pub fn checker(&self) -> Option<&Checker> {
        self.tint()?.checker()
    }

    /// True if paths may continue beyond the surface. The map of a user-defined BSDF may lead
    /// there.
    pub fn transmits(&self) -> bool {
        matches!(self.scatter, Scatter::Dielectric(_) | Scatter::Custom(_))
    }

    /// True if the surface reflects to more than single directions and has a known density of
    /// sampled directions. Light of a lamp can then be weighed against light that the surface's own
    /// rays find.
    pub fn samples_lights(&self) -> bool {
        match &self.scatter {
            Scatter::Black | Scatter::Mirror(_) | Scatter::Dielectric(_) => false,
            Scatter::Lambertian(_) | Scatter::Ggx(_) | Scatter::Phong(_) => true,
            Scatter::Metal(metal) => metal.alpha > 0.0,
            Scatter::Custom(bsdf) => bsdf.pdf.is_some(),
        }
    }
}

/// The scattering of a surface.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Scatter {
    /// Nothing leaves: the path ends here.
    Black,
    Lambertian(Lambertian),
    Mirror(Mirror),
    Dielectric(Dielectric),
    Ggx(Ggx),
    Metal(Metal),
    Phong(Phong),
    Custom(Box<CustomBsdf>),
}

/// A checked user-defined BSDF.
#[derive(Clone, Debug)]
pub struct CustomBsdf {
    /// The map phi(u, v) from the unit square to unit vectors, by component x, y, z.
    pub map: [Expr; 3],
    /// The factor `J |phi_z|`, in `u`, `v`, that turns `value` into the weight `f |n.i| J`. With
    /// `jacobian: auto` it equals `|x_u y_v - x_v y_u|`, simplified so that common factors cancel.
    pub projected_jacobian: Expr,
    /// f, per channel, in `cos_i`, `cos_o`, `cos_a`, `u`, `v`, and the point that is hit, `x`, `y`, `z`.
    pub value: [Expr; 3],
    /// An upper bound, per channel, of the weight `value * projected_jacobian` over its domain.
    pub weight_bound: Rgb,
    /// The density of the map's directions, in `cos_i`, `cos_o`, `cos_a`, if it is stated.
    pub pdf: Option<Expr>,
    /// The box of the faces that have the BSDF, for a value that reads the point that is hit.
    pub extent: bsdf::Extent,
}

impl CustomBsdf {
    /// True if the value depends on the point that is hit.
    pub fn reads_point(&self) -> bool {
        let mut values = self.value.iter();
        values.any(|value| value.variables(value.root()).has_any(&Variable::POINT))
    }
}

/// A triangle, a planar convex quadrilateral or a disc in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygon {
    /// Corners; a triangle repeats its last one. Those of a disc are the corners of a square around it, up to
    /// rounding.
    pub vertices: [DVec3; 4],
    /// Number of corners of the polygon: 3 or 4.
    pub corners: u8,
    /// True for a disc: the circle that touches the square's edges is its outline. Analyses of the square
    /// hold for the disc if they need a region that contains it.
    pub disc: bool,
    /// The polygon's surface, as an index into [`ValidScene::surfaces`].
    pub surface: u32,
}

/// Minimum length of the interpolated normals of a [`SmoothFace`].
pub const LEAST_NORMAL: f64 = geometry::LEAST_COSINE;

/// A triangle that is shaded by normals which are interpolated between its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothFace {
    /// The triangle, as an index into [`ValidScene::polygons`].
    pub polygon: usize,
    /// The unit normals at its corners, on the side of the triangle's front. Their dot products with the
    /// triangle's own normal are at least [`LEAST_NORMAL`].
    pub normals: [DVec3; 3],
}

impl SmoothFace {
    /// The unit normal at a point of the triangle, given its corners in the point's units.
    pub fn normal_at(&self, [a, b, c]: [DVec3; 3], point: DVec3) -> DVec3 {
        let across = (b - a).cross(c - a);
        let share = |from: DVec3, to: DVec3| across.dot((to - from).cross(point - from));
        let [first, second, third] = self.normals;
        let sum = first * share(b, c) + second * share(c, a) + third * share(a, b);
        sum.normalize_or(across.normalize_or_zero())
    }
}

/// A triangle whose albedo or reflectance is multiplied by colours that are interpolated between its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColouredFace {
    /// The triangle, as an index into [`ValidScene::polygons`]. Its surface has a tint ([`Surface::tint`]) of one
    /// colour.
    pub polygon: usize,
    /// Linear RGB from 0 to 1, by corner.
    pub colours: [Rgb; 3],
}

/// A sphere in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre.
    pub centre: DVec3,
    /// The radius, above 0.
    pub radius: f64,
    /// The sphere's surface, as an index into [`ValidScene::surfaces`].
    pub surface: u32,
    /// The sphere's number in the scene's list of primitives.
    pub primitive: usize,
}

impl Ball {
    /// Two opposite corners of the box around the sphere.
    pub fn corners(&self) -> [DVec3; 2] {
        [self.centre - self.radius, self.centre + self.radius]
    }

    /// The place of the sphere in the scene.
    pub(crate) fn place(&self) -> Path {
        Path::root()
            .key("geometry")
            .item(self.primitive)
            .key("sphere")
    }
}

impl ValidScene {
    /// The scene as its author wrote it, with one exception: if [`ValidScene::is_counted_by_size`], it has an estimator
    /// that is not written.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
    /// True if no estimator is written, and the picture is counted by `sine` because it is large.
    pub fn is_counted_by_size(&self) -> bool {
        self.by_size
    }
    /// A cache for the number of the strategy that `uncompute: auto` chooses. The compiler fills it, since
    /// the choice takes a search.
    #[doc(hidden)]
    pub fn strategy_cache(&self) -> &OnceLock<usize> {
        &self.auto
    }
    /// Number of programs that the compiler has recorded from this scene, and from it with other
    /// parameters. Each recording traces the scene once; the oracles of all channels come from one.
    pub fn recordings(&self) -> u64 {
        self.recordings.load(Ordering::Relaxed)
    }
    /// Counts a recording; for the compiler.
    #[doc(hidden)]
    pub fn count_recording(&self) {
        self.recordings.fetch_add(1, Ordering::Relaxed);
    }
    /// All surfaces that polygons may refer to.
    pub fn surfaces(&self) -> &[Surface] {
        &self.materials
    }
    /// All polygons of the scene, those of meshes included.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }
    /// The polygons that are not flat, in the order of [`ValidScene::polygons`].
    pub fn smooth_faces(&self) -> &[SmoothFace] {
        &self.smooth
    }
    /// The normals of polygon number `polygon`, unless it is flat.
    pub fn smooth_face(&self, polygon: usize) -> Option<&SmoothFace> {
        let found = self
            .smooth
            .binary_search_by_key(&polygon, |face| face.polygon);
        found.ok().map(|place| &self.smooth[place])
    }
    /// The polygons with colours of their corners, in the order of [`ValidScene::polygons`].
    pub fn coloured_faces(&self) -> &[ColouredFace] {
        &self.coloured
    }
    /// All spheres of the scene.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }
    /// The directions of the sun and its radiance; none if it is black.
    pub fn sun(&self) -> Option<(Cone, Rgb)> {
        let sun = self.scene.sun.filter(Sun::shines)?;
        Some((Cone::new(sun.direction, sun.angle)?, sun.radiance))
    }
    /// The surface of each face: of the polygons, and then of the spheres.
    pub fn surface_of_faces(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        (0..self.polygons.len() + self.balls.len()).map(|face| self.surface_of_face(face))
    }
    /// The surface of face number `face`.
    ///
    /// # Panics
    /// If there is no face of that number.
    pub fn surface_of_face(&self, face: usize) -> u32 {
        match face.checked_sub(self.polygons.len()) {
            None => self.polygons[face].surface,
            Some(ball) => self.balls[ball].surface,
        }
    }
    /// Points whose box is that around all faces.
    pub fn extent(&self) -> impl Iterator<Item = DVec3> + '_ {
        let polygons = self.polygons.iter().flat_map(|polygon| polygon.vertices);
        polygons.chain(self.balls.iter().flat_map(Ball::corners))
    }
    /// Returns the polygons of a primitive, as a range of [`ValidScene::polygons`]: one; two of a
    /// quad that is not planar, or of a sampled lamp that is no parallelogram; or all of a mesh. The
    /// range is empty for a sphere, and if there is no primitive of that number.
    pub fn polygons_of(&self, primitive: usize) -> std::ops::Range<usize> {
        let end = self.polygons.len();
        let first = |primitive: usize| self.firsts.get(primitive).copied().unwrap_or(end);
        first(primitive)..first(primitive + 1)
    }
    /// The number of the primitive that polygon number `polygon` belongs to.
    pub fn primitive_of(&self, polygon: usize) -> usize {
        let after = self.firsts.partition_point(|&first| first <= polygon);
        after.saturating_sub(1)
    }

    /// Returns the place in the scene of the primitive that polygon number `polygon` belongs to.
    pub(crate) fn place_of(&self, polygon: usize) -> Path {
        let index = self.primitive_of(polygon);
        let place = Path::root().key("geometry").item(index);
        match self.scene.geometry.get(index) {
            Some(primitive) => place.key(primitive.kind()),
            None => place,
        }
    }

    /// The mesh files and material libraries that were read, each once, under their names in
    /// errors.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the warnings about parts that are not errors but probably unintended.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// Returns the 128-bit FNV-1a hash of the scene's canonical text (see [`Scene::fingerprint`]),
    /// of the corners of all polygons with the normals and colours there, bit for bit, and of the
    /// surfaces that mesh files add. It changes with everything that changes the picture, in the scene
    /// or in a mesh file.
    pub fn fingerprint(&self) -> Fingerprint {
        *self.fingerprint.get_or_init(|| self.hashed())
    }

    fn hashed(&self) -> Fingerprint {
        let mut print = self.scene.fingerprint();
        for surface in self.materials.iter().skip(self.scene.materials.len()) {
            let (kind, values) = match &surface.scatter {
                Scatter::Lambertian(Lambertian { albedo }) => (0, albedo.colours().concat()),
                // User-defined BSDFs and patterns are the scene's alone.
                Scatter::Black | Scatter::Custom(_) => (0, vec![0.0; 3]),
                Scatter::Mirror(mirror) => (1, mirror.reflectance.colours().concat()),
                Scatter::Dielectric(glass) => {
                    (2, [&[glass.ior], &glass.transmittance[..]].concat())
                }
                Scatter::Ggx(ggx) => (
                    3,
                    [&[ggx.alpha], &ggx.reflectance.colours().concat()[..]].concat(),
                ),
                Scatter::Metal(metal) => (
                    5,
                    [&[metal.alpha], &metal.reflectance.colours().concat()[..]].concat(),
                ),
                Scatter::Phong(phong) => {
                    let colours = [phong.diffuse, phong.specular].concat();
                    (4, [&colours[..], &[phong.exponent]].concat())
                }
            };
            print = print.and(&[kind]);
            for value in surface.radiance.into_iter().chain(values) {
                print = print.and(&value.to_bits().to_le_bytes());
            }
        }
        for polygon in &self.polygons {
            print = print
                .and(&[polygon.corners + u8::from(polygon.disc)])
                .and(&polygon.surface.to_le_bytes());
            for value in polygon.vertices.iter().flat_map(DVec3::to_array) {
                print = print.and(&value.to_bits().to_le_bytes());
            }
        }
        for face in &self.smooth {
            print = print.and(&(face.polygon as u64).to_le_bytes());
            for value in face.normals.iter().flat_map(DVec3::to_array) {
                print = print.and(&value.to_bits().to_le_bytes());
            }
        }
        for face in &self.coloured {
            print = print.and(&(face.polygon as u64).to_le_bytes());
            for value in face.colours.as_flattened() {
                print = print.and(&value.to_bits().to_le_bytes());
            }
        }
        print
    }
}

/// Checks a scene and its meshes, which [`crate::front::load_all`] reads.
///
/// # Errors
/// All problems of the scene.
///
/// ```
/// use qrt_scene::{Film, Scene};
/// use qrt_scene::valid::validate;
///
/// let scene = Scene { film: Film { width: 4, height: 4 }, ..Scene::default() };
/// let valid = validate(scene.clone(), &Default::default())?;
/// assert_eq!(valid.scene(), &scene);
///
/// let faulty = Scene { film: Film { width: 4, height: 0 }, ..scene };
/// let invalid = validate(faulty, &Default::default()).unwrap_err();
/// assert_eq!(invalid[0].path().unwrap().to_string(), "film.height");
/// # Ok::<(), qrt_scene::valid::InvalidScene>(())
/// ```
pub fn validate(scene: Scene, meshes: &Meshes) -> Result<ValidScene, InvalidScene> {
    check(scene, meshes, Problems::default()).map_err(InvalidScene::new)
}

/// Checks as [`validate`] does, for a scene whose reading has found `problems`.
pub(crate) fn check(
    mut scene: Scene,
    meshes: &Meshes,
    mut problems: Problems,
) -> Result<ValidScene, Vec<Problem>> {
    scene.check(&Place::ROOT, &mut problems);
    // A value out of its own range is not compared with other values.
    problems.finalize();
    crate::scene::finalize::sample_lens(&mut scene);
    camera::check(&scene.camera, &mut problems);
    sky::check(&scene, &mut problems);
    sampling::check(&scene, &mut problems);
    let by_size = counting::choose_by_size(&mut scene);
    counting::check(&scene, &mut problems);
    let mut warnings = Vec::new();
    let mut materials = surfaces(&scene, &mut problems);
    let shapes = geometry::polygons(&scene, meshes, &mut materials, &mut problems, &mut warnings);
    customs(
        &scene,
        &shapes,
        &mut materials,
        &mut problems,
        &mut warnings,
    );
    let geometry::Shapes {
        polygons,
        smooth,
        coloured,
        balls,
        firsts,
        files,
    } = shapes;
    let mut valid = ValidScene {
        scene,
        materials,
        polygons,
        smooth,
        coloured,
        balls,
        firsts,
        files,
        warnings,
        by_size,
        auto: OnceLock::new(),
        fingerprint: OnceLock::new(),
        recordings: Arc::default(),
    };
    camera::check_spheres(&valid.scene.camera, &valid.balls, &mut problems);
    glass::check(&valid, &mut problems);
    if problems.count() == 0 {
        let found = warnings::find(&valid);
        valid.warnings.extend(found);
    }
    lights::check(&mut valid, &mut problems);
    problems.result(valid)
}

/// The surfaces of the scene's own materials. User-defined BSDFs are black until [`customs`] compiles them.
fn surfaces(scene: &Scene, problems: &mut Problems) -> Vec<Surface> {
    let materials = Path::root().key("materials");
    let surface = |(name, material): &(String, Material)| {
        if let Material::Phong(part) = material {
            problems.extend(phong_energy(part, &materials.key(name.as_str())));
        }
        let (radiance, scatter) = simple(material).unwrap_or(([0.0; 3], Scatter::Black));
        Surface {
            name: name.clone(),
            radiance,
            scatter,
        }
    };
    scene.materials.iter().map(surface).collect()
}

/// Compiles the user-defined BSDFs of `surfaces`, whose faces are `shapes`.
fn customs(
    scene: &Scene,
    shapes: &geometry::Shapes,
    surfaces: &mut [Surface],
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) {
    let materials = Path::root().key("materials");
    if let Some(too_many) = too_many(scene, &materials) {
        return problems.push(too_many);
    }
    let (mut known, mut map) = (HashMap::new(), bsdf::KnownMap::default());
    for (number, (name, material)) in scene.materials.iter().enumerate() {
        let Material::Bsdf(part) = material else {
            continue;
        };
        // Equal values have the same faults, unless they depend on where their faces are.
        let own = bsdf::reads_point(part).then_some(number);
        let faces = own.map_or(bsdf::Faces::NONE, |number| shapes.faces(number as u32));
        let compile = || bsdf::compile_with(part, &faces, &mut map);
        let compiled = known.entry((part, own)).or_insert_with(compile);
        let path = materials.key(name.as_str()).key("bsdf");
        surfaces[number].scatter = custom((part, compiled), &faces, &path, problems, warnings);
    }
}

/// Returns the radiance and scattering of a material, or its user-defined BSDF, which has to be
/// compiled.
fn simple(material: &Material) -> Result<(Rgb, Scatter), &Bsdf> {
    let scatter = match material {
        Material::Lambertian(part) => matte(part.albedo),
        Material::Emitter(part) => return Ok((part.radiance, matte(part.albedo))),
        Material::Mirror(part) => Scatter::Mirror(*part),
        Material::Dielectric(part) => Scatter::Dielectric(*part),
        Material::Ggx(part) => Scatter::Ggx(*part),
        Material::Metal(part) => Scatter::Metal(*part),
        Material::Phong(part) => Scatter::Phong(*part),
        Material::Bsdf(part) => return Err(part),
    };
    Ok(([0.0; 3], scatter))
}

/// Returns a problem if checking all user-defined BSDFs takes too long, at the BSDF that exceeds
/// the limit. Equal BSDFs are checked once.
fn too_many(scene: &Scene, materials: &Path) -> Option<Problem> {
    let (mut known, mut minutes) = (HashSet::new(), 0.0);
    let (mut last, mut first) = (None, None);
    for (name, material) in &scene.materials {
        if let Material::Bsdf(part) = material
            && known.insert(part)
        {
            minutes += bsdf::minutes(part, last.replace(part));
            if minutes > bsdf::MOST_MINUTES as f64 && first.is_none() {
                first = Some(name);
            }
        }
    }
    let what = qrt_syntax::Expression::TooMany {
        minutes: minutes.ceil() as u64,
        most: bsdf::MOST_MINUTES,
    };
    first.map(|name| Problem::new(materials.key(name.as_str()).key("bsdf"), what))
}

/// Returns a Lambertian, or black if nothing is reflected: the path then ends.
fn matte(albedo: Reflectance) -> Scatter {
    if albedo.is_black() {
        Scatter::Black
    } else {
        Scatter::Lambertian(Lambertian { albedo })
    }
}

/// Checks that a Phong surface does not reflect more than arrives. At normal incidence the lobe
/// `(n + 2) / (2 pi) cos^n` has the albedo 1, at any other less, so kd + ks is the maximum that is
/// reflected.
fn phong_energy(phong: &Phong, path: &Path) -> Option<Problem> {
    let sums = phong
        .diffuse
        .iter()
        .zip(&phong.specular)
        .map(|(kd, ks)| kd + ks);
    // 0.7 + 0.3 is 1 up to a rounding.
    let (channel, sum) = sums
        .enumerate()
        .find(|(_, sum)| *sum > 1.0 + f64::EPSILON)?;
    let channel = ["red", "green", "blue"][channel];
    let path = path.key("phong");
    let what = qrt_syntax::Material::GainsEnergy { sum, channel };
    Some(Problem::new(path.key("specular"), what).also(path.key("diffuse")))
}

fn custom(
    (bsdf, compiled): (&Bsdf, &Result<CustomBsdf, Vec<Problem>>),
    faces: &bsdf::Faces,
    path: &Path,
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) -> Scatter {
    let placed = |problem: Problem| problem.below(path);
    match compiled {
        Ok(compiled) => {
            let written = &compiled.value[..bsdf.value.len().min(3)];
            let found = bsdf::warnings(written, faces);
            warnings.extend(found.into_iter().map(placed));
            Scatter::Custom(Box::new(compiled.clone()))
        }
        Err(found) => {
            problems.extend(found.iter().cloned().map(placed));
            Scatter::Black
        }
    }
}

#[cfg(test)]
mod tests;
