//! Compares the searches of circuits with [`StageGeometry`], which tests every plane: the same
//! faces, distances, sides, lamps and shadows along thousands of random paths.

use super::*;
use crate::frame::start;
use crate::geometry::NO_PLANE;
use crate::scalar::Scalar;
use crate::{PixelClass, Stage};
use glam::DVec3;
use qrt_scene::front::parse;
use scenes::scenes;
use std::fmt::Write;

mod balls;
mod discs;
mod found;
mod scenes;
mod suns;

/// Random numbers in 0..1, the same on every run.
pub(super) struct Chance(pub(super) u64);

impl Chance {
    pub(super) fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let inside = DVec3::from_array([(); 3].map(|()| self.between(-1.0, 1.0)));
            if (0.01..1.0).contains(&inside.length_squared()) {
                return inside.normalize();
            }
        }
    }
}

/// Polygons of a material.
#[derive(Clone)]
struct Shape {
    outlines: Vec<Vec<DVec3>>,
    material: &'static str,
}

fn shape(outlines: Vec<Vec<[f64; 3]>>, material: &'static str) -> Shape {
    let outline = |outline: Vec<[f64; 3]>| outline.into_iter().map(DVec3::from_array).collect();
    Shape {
        outlines: outlines.into_iter().map(outline).collect(),
        material,
    }
}

impl Shape {
    fn without(mut self, sides: &[usize]) -> Self {
        let mut number = 0;
        self.outlines.retain(|_| {
            number += 1;
            !sides.contains(&(number - 1))
        });
        self
    }

    fn made_of(mut self, material: &'static str) -> Self {
        self.material = material;
        self
    }

    fn moved(mut self, to: impl Fn(DVec3) -> DVec3) -> Self {
        let corners = self.outlines.iter_mut().flatten();
        corners.for_each(|corner| *corner = to(*corner));
        self
    }

    /// Turns it by `angle` about the vertical.
    fn turned(self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.moved(|p| DVec3::new(cos * p.x + sin * p.z, p.y, cos * p.z - sin * p.x))
    }

    fn at(self, x: f64, y: f64, z: f64) -> Self {
        self.moved(|p| p + DVec3::new(x, y, z))
    }

    /// Cuts each quad into two triangles.
    fn triangulated(mut self) -> Self {
        let cut = |outline: Vec<DVec3>| match outline[..] {
            [a, b, c, d] => vec![vec![a, b, c], vec![a, c, d]],
            _ => vec![outline],
        };
        self.outlines = self.outlines.into_iter().flat_map(cut).collect();
        self
    }
}

/// A level square at height `y`, where y points up, with half side `half`.
fn level(half: f64, y: f64) -> Shape {
    let (a, b) = (-half, half);
    shape(
        vec![vec![[a, y, a], [b, y, a], [b, y, b], [a, y, b]]],
        "grey",
    )
}

/// The sides of a box at low and high x, y, z.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Shape {
    shape(convex::tests::cuboid(low, high), "grey")
}

/// The number of a side of [`cuboid`].
const BOTTOM: usize = 2;
const TOP: usize = 3;

/// The triangles of the convex hull of points, no four of which are on one plane; fronts on both
/// sides.
fn hull(points: &[DVec3]) -> Shape {
    let mut outlines = Vec::new();
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for &c in &points[j + 1..] {
                let normal = (b - a).cross(c - a);
                let above = |p: &&DVec3| normal.dot(**p - a) > 1e-12;
                let below = |p: &&DVec3| normal.dot(**p - a) < -1e-12;
                let count = [
                    points.iter().filter(above).count(),
                    points.iter().filter(below).count(),
                ];
                if count.contains(&0) {
                    outlines.push(vec![a, b, c]);
                }
            }
        }
    }
    Shape {
        outlines,
        material: "grey",
    }
}

fn tetrahedron() -> Shape {
    let corners = [
        [0.0, 1.0, 0.0],
        [-0.6, 0.0, -0.4],
        [0.7, 0.0, -0.3],
        [0.1, 0.0, 0.6],
    ];
    hull(&corners.map(DVec3::from_array))
}

fn icosahedron() -> Shape {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (1.0, -golden),
        (-1.0, golden),
        (-1.0, -golden),
    ] {
        corners.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(DVec3::from_array));
    }
    hull(&corners).moved(|p| 0.3 * p)
}

/// The convex hull of 42 points on a sphere, which has 80 faces.
fn boulder() -> Shape {
    let mut chance = Chance(5);
    let points: Vec<DVec3> = (0..42).map(|_| 0.6 * chance.direction()).collect();
    hull(&points)
}

/// A ring of 72 triangles, with a tube of radius 0.2 and a hole.
fn ring() -> Shape {
    let at = |i: usize, j: usize| {
        let angle =
            |k: usize, count: usize| std::f64::consts::TAU * (k % count) as f64 / count as f64;
        let ((sin, cos), (up, out)) = (angle(i, 9).sin_cos(), angle(j, 4).sin_cos());
        let far = 0.6 + 0.2 * out;
        DVec3::new(far * cos, 0.2 * up, far * sin)
    };
    let quads = (0..36).map(|n| (n / 4, n % 4));
    let outline = |(i, j)| vec![at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
    Shape {
        outlines: quads.map(outline).collect(),
        material: "grey",
    }
    .triangulated()
}

/// A lamp that looks down.
fn lamp(half: f64, y: f64) -> Shape {
    level(half, y).made_of("lamp")
}

fn perspective(eye: [f64; 3], target: [f64; 3], vfov: f64) -> String {
    format!("perspective: {{ eye: {eye:?}, target: {target:?}, vfov: {vfov:?} }}")
}

fn stage(camera: &str, shapes: &[Shape]) -> Stage<3> {
    let mut text = format!(
        "name: test
camera: {{ {camera} }}
film: {{ width: 16, height: 16 }}
materials:
  grey: {{ lambertian: {{ albedo: [0.7, 0.6, 0.5] }} }}
  lamp: {{ emitter: {{ radiance: [3, 2, 1] }} }}
  glass: {{ dielectric: {{ ior: 1.5 }} }}
geometry:
"
    );
    for shape in shapes {
        for outline in &shape.outlines {
            let kind = if outline.len() == 3 {
                "triangle"
            } else {
                "quad"
            };
            let corners: Vec<[f64; 3]> = outline.iter().map(DVec3::to_array).collect();
            let material = shape.material;
            let line = format!("  - {kind}: {{ vertices: {corners:?}, material: {material} }}");
            writeln!(text, "{line}").unwrap();
        }
    }
    text.push_str("sampling: { depths: [{ bits: [4, 4] }, { bits: [4, 4] }], lights: none }");
    staged(&text)
}

fn staged(text: &str) -> Stage<3> {
    let loaded = parse(text, "test.yaml", &[], "".as_ref());
    let loaded = loaded.unwrap_or_else(|report| panic!("{report}\n{text}"));
    Stage::rgb(&loaded.valid, PixelClass::MayMeetLamp)
}

const ULP: f64 = 1.0 / 4096.0;

/// A random ray of the camera.
fn camera_ray(stage: &Stage<3>, chance: &mut Chance) -> Ray<Scalar> {
    let camera = &stage.camera;
    let (x, y) = (16.0 * chance.next(), 16.0 * chance.next());
    let moving = [0, 1, 2].map(|k| camera.corner[k] + camera.column[k] * x + camera.row[k] * y);
    let (origin, direction) = if camera.perspective {
        (camera.fixed, moving)
    } else {
        (moving, camera.fixed)
    };
    Ray {
        origin,
        direction,
        from: NO_PLANE,
        t_max: camera.t_max,
        start: Start::Camera,
    }
}

/// Counts of compared rays, hits, lamps and shadows, and the differences.
#[derive(Debug, Default)]
struct Compared {
    rays: usize,
    hits: usize,
    lamps: usize,
    shadows: usize,
    /// Rays that reach the sun.
    lit: usize,
    /// Descriptions of the differences between the two searches.
    differ: Vec<String>,
}

struct Comparison<'a> {
    stage: &'a Stage<3>,
    search: Search<'a>,
    chance: Chance,
    compared: Compared,
}

impl Comparison<'_> {
    /// Compares the hits of both searches on `ray`. Returns the face's label and the distance.
    fn nearest(&mut self, ray: &Ray<Scalar>) -> Option<(u32, f64)> {
        let geometry = self.stage.geometry();
        let cx = &mut Scalar::default();
        let asked = geometry.nearest(cx, ray, true);
        let found = self.search.nearest(cx, ray, true);
        let normal = DVec3::from(self.stage.normals()[asked.face as usize]);
        let front = normal.dot(ray.direction.into()) < 0.0;
        let told = |hit: &Hit<Scalar>, front| hit.found.then_some((hit.face, hit.distance, front));
        let (asked, found) = (told(&asked, front), told(&found, found.front == Some(true)));
        self.judge("nearest", ray, asked, found);
        let asked_emitter = geometry.emitter(cx, ray, true);
        let found_emitter = self.search.emitter(cx, ray, true);
        let same = [&asked_emitter, &found_emitter].map(|hit| told(hit, true));
        self.judge("emitter", ray, same[0], same[1]);
        self.compared.rays += 1;
        self.compared.hits += usize::from(asked.is_some());
        self.compared.lamps += usize::from(asked_emitter.found);
        asked.map(|(face, distance, _)| (face, distance))
    }

    #[allow(clippy::needless_pass_by_value)] // Answers are made to be compared.
    fn judge<T: PartialEq + std::fmt::Debug>(&mut self, what: &str, ray: &Ray<Scalar>, a: T, b: T) {
        if a != b {
            let (origin, direction, from) = (ray.origin, ray.direction, ray.from);
            let told =
                format!("{what}: {a:?}, searched {b:?} {origin:?} {direction:?} from {from}");
            self.compared.differ.push(told);
        }
    }

    /// Compares if something stands between the start of a surface's ray and a point of a lamp. Only
    /// points on the side of `towards` are compared.
    fn shadow(&mut self, ray: &Ray<Scalar>, towards: DVec3) {
        let geometry = self.stage.geometry();
        let lamps = geometry.faces.iter().filter(|face| face.emits);
        let lamps: Vec<u32> = lamps.map(|face| face.label).collect();
        let number = (self.chance.next() * lamps.len() as f64) as usize;
        let Some(&label) = lamps.get(number) else {
            return;
        };
        let corners = &geometry.corners[label as usize];
        let at = |weights: [f64; 3]| -> DVec3 {
            let sum: f64 = weights.iter().sum();
            let corners = weights.iter().zip(corners);
            corners
                .map(|(weight, corner)| *corner * (weight / sum))
                .sum()
        };
        let point = at([(); 3].map(|()| self.chance.next()));
        let direction = point - DVec3::from(ray.origin);
        if geometry.plane_of[label as usize] == ray.from || direction.dot(towards) <= 0.0 {
            return;
        }
        let ray = Ray {
            direction: direction.to_array(),
            t_max: 1.0,
            ..*ray
        };
        let cx = &mut Scalar::default();
        let asked = geometry.occluded(cx, &ray, number as u32, true);
        let found = self.search.occluded(cx, &ray, number as u32, true);
        self.judge("occluded", &ray, asked, found);
        self.compared.shadows += 1;
    }

    /// Compares paths from the camera, each of a few rays in random directions.
    fn paths(&mut self, paths: usize) {
        for _ in 0..paths {
            let mut ray = camera_ray(self.stage, &mut self.chance);
            for _ in 0..6 {
                let Some((face, distance)) = self.nearest(&ray) else {
                    break;
                };
                let normal = DVec3::from(self.stage.normals()[face as usize]);
                let viewer = -normal.dot(ray.direction.into()).signum() * normal;
                let mut direction = self.chance.direction();
                direction *= direction.dot(viewer).signum();
                if self.chance.next() < 0.1 {
                    direction -= 0.999 * viewer * direction.dot(viewer);
                }
                let transmits = self.stage.transmits[face as usize];
                if transmits && self.chance.next() < 0.7 {
                    direction = -direction;
                }
                let frame = &self.stage.geometry.frames[face as usize];
                ray = Ray {
                    origin: start(&mut Scalar::default(), &ray, distance, frame),
                    direction: direction.to_array(),
                    from: self.stage.geometry.plane_of[face as usize],
                    t_max: self.stage.t_max,
                    start: Start::Surface,
                };
                match &self.stage.sun {
                    Some(sun) if !transmits => self.sunlight(&ray, viewer, sun.cone()),
                    None if !transmits => self.shadow(&ray, viewer),
                    _ => {}
                }
            }
        }
    }
}

/// The unit of a search that rounds the constants of edges: no ray shows it.
const FINE: f64 = 1.0 / (1_u64 << 46) as f64;

fn compare(stage: &Stage<3>, paths: usize) -> Compared {
    let coarse = Search::new(stage, ULP);
    let search = if coarse.surfaces.mesh.is_empty() && coarse.camera.mesh.is_empty() {
        coarse
    } else {
        Search::new(stage, FINE)
    };
    let mut comparison = Comparison {
        stage,
        search,
        chance: Chance(1),
        compared: Compared::default(),
    };
    comparison.paths(paths);
    comparison.compared
}

/// A room without a front, three wide, with a lamp just below its ceiling.
fn room() -> Vec<Shape> {
    let walls = cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5]).without(&[4]);
    vec![lamp(0.4, 2.99), walls]
}

const FRONT: [f64; 3] = [0.1, 1.4, -5.0];
const MIDDLE: [f64; 3] = [0.0, 1.2, 0.0];

#[test]
fn searches_find_what_asking_every_plane_finds() {
    let mut wrong = String::new();
    let [mut hits, mut lamps, mut shadows] = [0; 3];
    for (name, stage) in scenes() {
        let compared = compare(&stage, 2000);
        if let Some(first) = compared.differ.first() {
            let count = compared.differ.len();
            let _ = writeln!(wrong, "{name}: {count} of {}: {first}", compared.rays);
        }
        hits += compared.hits;
        lamps += compared.lamps;
        shadows += compared.shadows;
    }
    assert_eq!(wrong, "");
    // Enough comparisons of each kind.
    assert!(
        [hits, lamps, shadows].iter().all(|&count| count > 1000),
        "{hits} hits, {lamps} lamps, {shadows} shadows"
    );
}
