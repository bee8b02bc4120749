//! What circuits search for, against what [`Geometry`] finds by asking every plane: the same faces,
//! distances, sides, lamps and shadows along thousands of random paths.

use super::*;
use crate::front::parse;
use crate::tracer::frame::start;
use crate::tracer::geometry::NO_PLANE;
use crate::tracer::scalar::Scalar;
use crate::tracer::{PixelClass, Stage};
use std::fmt::Write;

mod found;

/// Random numbers in 0..1, the same on every run.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
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

    /// Turned by an angle about the vertical.
    fn turned(self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.moved(|p| DVec3::new(cos * p.x + sin * p.z, p.y, cos * p.z - sin * p.x))
    }

    fn at(self, x: f64, y: f64, z: f64) -> Self {
        self.moved(|p| p + DVec3::new(x, y, z))
    }

    /// Quads as two triangles each.
    fn triangulated(mut self) -> Self {
        let cut = |outline: Vec<DVec3>| match outline[..] {
            [a, b, c, d] => vec![vec![a, b, c], vec![a, c, d]],
            _ => vec![outline],
        };
        self.outlines = self.outlines.into_iter().flat_map(cut).collect();
        self
    }
}

/// A level square with y up, of this half side.
fn level(half: f64, y: f64) -> Shape {
    let (a, b) = (-half, half);
    shape(
        vec![vec![[a, y, a], [b, y, a], [b, y, b], [a, y, b]]],
        "grey",
    )
}

/// The sides of a box at low and high x, y, z.
fn cuboid([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> Shape {
    let sides = vec![
        vec![[ax, ay, az], [ax, ay, bz], [ax, by, bz], [ax, by, az]],
        vec![[bx, ay, az], [bx, by, az], [bx, by, bz], [bx, ay, bz]],
        vec![[ax, ay, az], [bx, ay, az], [bx, ay, bz], [ax, ay, bz]],
        vec![[ax, by, az], [ax, by, bz], [bx, by, bz], [bx, by, az]],
        vec![[ax, ay, az], [ax, by, az], [bx, by, az], [bx, ay, az]],
        vec![[ax, ay, bz], [bx, ay, bz], [bx, by, bz], [ax, by, bz]],
    ];
    shape(sides, "grey")
}

/// A side of [`cuboid`].
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
    text.push_str("sampling: { depths: [{ bits: [4, 4] }, { bits: [4, 4] }] }");
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
        reach: camera.reach,
        start: Start::Camera,
    }
}

/// What was compared.
#[derive(Debug, Default)]
struct Compared {
    rays: usize,
    hits: usize,
    lamps: usize,
    shadows: usize,
    /// Where the two searches differ.
    differ: Vec<String>,
}

struct Comparison<'a> {
    stage: &'a Stage<3>,
    search: Search<'a>,
    chance: Chance,
    compared: Compared,
}

impl Comparison<'_> {
    /// What both searches find on this ray; the face's label and the distance.
    fn nearest(&mut self, ray: &Ray<Scalar>) -> Option<(u32, f64)> {
        let geometry = self.stage.geometry();
        let cx = &mut Scalar::default();
        let asked = geometry.nearest(cx, ray, true);
        let found = self.search.nearest(cx, ray, true);
        let normal = DVec3::from(self.stage.normals[asked.face as usize]);
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

    /// Whether something stands between the start of a surface's ray and some point of a lamp on the
    /// side of `towards`.
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
            reach: 1.0,
            ..*ray
        };
        let cx = &mut Scalar::default();
        let asked = geometry.occluded(cx, &ray, number as u32, true);
        let found = self.search.occluded(cx, &ray, number as u32, true);
        self.judge("occluded", &ray, asked, found);
        self.compared.shadows += 1;
    }

    /// Paths from the camera, each of a few rays in random directions.
    fn paths(&mut self, paths: usize) {
        for _ in 0..paths {
            let mut ray = camera_ray(self.stage, &mut self.chance);
            for _ in 0..6 {
                let Some((face, distance)) = self.nearest(&ray) else {
                    break;
                };
                let normal = DVec3::from(self.stage.normals[face as usize]);
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
                let frame = &self.stage.frames[face as usize];
                ray = Ray {
                    origin: start(&mut Scalar::default(), &ray, distance, frame),
                    direction: direction.to_array(),
                    from: self.stage.geometry.plane_of[face as usize],
                    reach: self.stage.reach,
                    start: Start::Surface,
                };
                if !transmits {
                    self.shadow(&ray, viewer);
                }
            }
        }
    }
}

fn compare(stage: &Stage<3>, paths: usize) -> Compared {
    let mut comparison = Comparison {
        stage,
        search: Search::new(stage, ULP),
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

/// All kinds of scenes, by name.
fn scenes() -> Vec<(&'static str, Stage<3>)> {
    let front = perspective(FRONT, MIDDLE, 45.0);
    let mut scenes = Vec::new();
    let mut with = |name: &'static str, camera: &str, shapes: &[&[Shape]]| {
        scenes.push((name, stage(camera, &shapes.concat())));
    };
    let room = &room()[..];
    let floor = &[level(1.5, 0.0)][..];
    let small = |x: f64, z: f64| {
        cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3])
            .turned(0.4)
            .at(x, 0.0, z)
    };
    let standing = |shape: &Shape| {
        [
            shape.clone().turned(0.3).at(-0.7, 0.0, -0.2),
            shape
                .clone()
                .turned(2.0)
                .at(0.8, 0.0, 0.6)
                .without(&[BOTTOM]),
        ]
    };
    let axis = cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3]);
    with("empty room", &front, &[room]);
    with("boxes", &front, &[room, &standing(&axis)]);
    with(
        "boxes along the axes",
        &front,
        &[
            room,
            &[
                axis.clone().at(0.7, 0.0, 0.0),
                axis.clone().at(-0.7, 0.0, 0.3).without(&[BOTTOM]),
            ],
        ],
    );
    with(
        "triangulated boxes",
        &front,
        &[room, &standing(&axis).map(Shape::triangulated)],
    );
    with(
        "a hovering box",
        &front,
        &[room, &[small(0.2, 0.1).at(0.0, 0.9, 0.0)]],
    );
    with(
        "tetrahedra",
        &front,
        &[
            room,
            &[
                tetrahedron().at(-0.6, 0.0, 0.0),
                tetrahedron().at(0.6, 0.7, 0.3),
            ],
        ],
    );
    let prism = shape(
        vec![
            vec![[-0.5, 0.0, -0.4], [0.5, 0.0, -0.3], [0.1, 0.0, 0.4]],
            vec![[-0.5, 0.9, -0.4], [0.5, 0.9, -0.3], [0.1, 0.9, 0.4]],
            vec![
                [-0.5, 0.0, -0.4],
                [0.5, 0.0, -0.3],
                [0.5, 0.9, -0.3],
                [-0.5, 0.9, -0.4],
            ],
            vec![
                [0.5, 0.0, -0.3],
                [0.1, 0.0, 0.4],
                [0.1, 0.9, 0.4],
                [0.5, 0.9, -0.3],
            ],
            vec![
                [0.1, 0.0, 0.4],
                [-0.5, 0.0, -0.4],
                [-0.5, 0.9, -0.4],
                [0.1, 0.9, 0.4],
            ],
        ],
        "grey",
    );
    with(
        "prisms",
        &front,
        &[
            room,
            &[
                prism.clone().at(-0.7, 0.0, 0.0),
                prism.clone().at(0.7, 0.0, 0.2).without(&[0]),
            ],
        ],
    );
    with(
        "a prism without its ends",
        &front,
        &[room, &[prism.at(0.0, 0.5, 0.0).without(&[0, 1])]],
    );
    with(
        "an icosahedron",
        &front,
        &[room, &[icosahedron().at(0.0, 1.0, 0.0)]],
    );
    with("a boulder", &front, &[room, &[boulder().at(0.0, 0.9, 0.0)]]);
    with(
        "a glass cube",
        &front,
        &[room, &[small(0.0, 0.0).at(0.0, 0.3, 0.0).made_of("glass")]],
    );
    with(
        "glass on the floor",
        &front,
        &[
            room,
            &[
                small(-0.6, 0.0).made_of("glass"),
                small(0.6, 0.0).made_of("glass").without(&[BOTTOM]),
            ],
        ],
    );
    let alone = perspective([1.0, 2.4, -3.0], [0.0, 0.4, 0.0], 40.0);
    with(
        "glass that nothing is above",
        &alone,
        &[
            floor,
            &[
                axis.clone().at(0.0, 0.1, 0.0).made_of("glass"),
                level(0.2, 0.5).at(1.0, 0.0, 0.0),
            ],
        ],
    );
    with(
        "a glass boulder",
        &front,
        &[room, &[boulder().at(0.0, 0.9, 0.0).made_of("glass")]],
    );
    with(
        "an open box",
        &front,
        &[room, &[small(0.0, 0.0).without(&[TOP])]],
    );
    with(
        "an open box, seen from above",
        &alone,
        &[floor, &[small(0.0, 0.0).without(&[TOP])]],
    );
    let tall = cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3]);
    let towers = [
        tall.clone().at(-0.6, 0.0, 0.0),
        tall.clone().at(0.5, 0.0, 0.3),
    ];
    with("two tops on one plane", &front, &[room, &towers]);
    with(
        "two tops on one plane, seen from above",
        &alone,
        &[floor, &towers],
    );
    with(
        "two boxes that touch",
        &front,
        &[
            room,
            &[
                tall.clone().at(-0.3, 0.0, 0.0),
                tall.clone().at(0.3, 0.0, 0.2),
            ],
        ],
    );
    with(
        "two boxes that overlap",
        &front,
        &[
            room,
            &[tall.clone(), tall.clone().turned(0.5).at(0.2, 0.1, 0.1)],
        ],
    );
    with(
        "a camera inside a box",
        &perspective([0.05, 0.4, 0.0], [1.0, 0.5, 0.3], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    with(
        "a camera on a box's plane",
        &perspective([0.3, 0.4, -1.4], [0.2, 0.5, 0.0], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    with(
        "a camera on a box's other plane",
        &perspective([-0.3, 0.4, -1.4], [-0.2, 0.5, 0.0], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    let closed = [lamp(0.4, 2.99), cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5])];
    with(
        "a camera in a closed room",
        &perspective([1.0, 1.4, -1.2], MIDDLE, 80.0),
        &[&closed, &[small(0.0, 0.0)]],
    );
    with(
        "a camera on a wall",
        &perspective([0.1, 1.4, -1.5], MIDDLE, 80.0),
        &[&closed, &[small(0.0, 0.0)]],
    );
    with(
        "a camera on a wall that looks out",
        &perspective([0.1, 1.4, -1.5], [2.0, 1.4, -2.0], 100.0),
        &[&closed],
    );
    with(
        "a camera on the ceiling",
        &perspective([0.1, 3.0, -1.0], [1.0, 3.2, 1.0], 120.0),
        &[room, &[small(0.0, 0.0)]],
    );
    with(
        "a camera above the room",
        &perspective([0.3, 6.0, -4.0], [0.0, 3.0, 0.0], 50.0),
        &[room, &[small(0.0, 0.0)]],
    );
    with(
        "a camera below the floor",
        &perspective([0.3, -2.0, -4.0], [0.0, 0.3, 0.0], 50.0),
        &[room, &standing(&axis)],
    );
    with(
        "a camera behind the back wall",
        &perspective([3.0, 1.0, 4.0], MIDDLE, 50.0),
        &[room, &standing(&axis)],
    );
    with(
        "a parallel camera",
        "orthographic: { eye: [0.2, 1.5, -4], target: [0, 1.3, 0], height: 4 }",
        &[room, &standing(&axis)],
    );
    with(
        "a parallel camera in the room",
        "orthographic: { eye: [0.2, 1.5, -0.2], target: [0, 1.3, 0.5], height: 3.5 }",
        &[room, &standing(&axis)],
    );
    with(
        "a small floor",
        &alone,
        &[
            &[level(0.6, 0.0), lamp(0.3, 1.6).at(0.9, 0.0, 0.0)],
            &[small(1.1, 0.4)],
        ],
    );
    with(
        "a floor in pieces",
        &alone,
        &[&[
            level(0.5, 0.0).at(-0.6, 0.0, 0.0),
            level(0.5, 0.0).at(0.6, 0.0, 0.1).triangulated(),
            lamp(0.3, 1.6),
        ]],
    );
    with(
        "a floor modelled twice",
        &alone,
        &[
            &[
                level(0.5, 0.0),
                level(0.5, 0.0).triangulated(),
                lamp(0.9, 1.6),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "nested rooms",
        &perspective([0.2, 1.4, -0.8], MIDDLE, 80.0),
        &[&closed, &[cuboid([-1.0, 0.2, -1.0], [1.1, 2.0, 1.2])]],
    );
    with(
        "nested rooms, seen from between",
        &perspective([0.2, 2.6, -1.3], MIDDLE, 80.0),
        &[&closed, &[cuboid([-1.0, 0.2, -1.0], [1.1, 2.0, 1.2])]],
    );
    let walls = cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5]).without(&[4]);
    with(
        "a lamp in the ceiling, listed first",
        &front,
        &[&[lamp(0.4, 3.0), walls.clone()], &[small(0.0, 0.0)]],
    );
    with(
        "a lamp in the ceiling, listed last",
        &front,
        &[&[walls.clone(), lamp(0.4, 3.0)], &[small(0.0, 0.0)]],
    );
    with(
        "a lamp beside the ceiling",
        &front,
        &[
            &[
                walls.clone().without(&[TOP]),
                lamp(0.4, 3.0),
                level(0.6, 3.0).at(0.9, 0.0, 0.9),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    let mark = level(0.1, 0.8).turned(0.2).made_of("lamp");
    with(
        "a lamp on a box's top, listed first",
        &front,
        &[std::slice::from_ref(&mark), room, &[small(0.0, 0.0)]],
    );
    with(
        "a lamp on a box's top, listed last",
        &front,
        &[room, &[small(0.0, 0.0), mark.clone()]],
    );
    with(
        "a decal on a box's top",
        &front,
        &[
            &[mark.clone().made_of("grey")],
            room,
            &[small(0.0, 0.0), level(0.05, 0.8).at(0.2, 0.0, 0.0)],
        ],
    );
    with(
        "a decal beside a box's top",
        &front,
        &[
            &[mark.at(0.9, 0.0, 0.0).made_of("grey")],
            room,
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "a box that emits",
        &front,
        &[
            &[small(0.4, 0.0).at(0.0, 0.6, 0.0).made_of("lamp")],
            room,
            &[small(-0.6, 0.2)],
        ],
    );
    with(
        "a box with one side that emits",
        &front,
        &[
            &[
                small(0.4, 0.0)
                    .at(0.0, 0.6, 0.0)
                    .without(&[0, 1, 2, 4, 5])
                    .made_of("lamp"),
                small(0.4, 0.0).at(0.0, 0.6, 0.0).without(&[TOP]),
            ],
            room,
        ],
    );
    let ell = shape(
        vec![
            vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 0.8, 0.0],
                [0.0, 0.8, 0.0],
            ],
            vec![
                [1.0, 0.0, 0.0],
                [1.0, 0.0, 0.4],
                [1.0, 0.8, 0.4],
                [1.0, 0.8, 0.0],
            ],
            vec![
                [1.0, 0.0, 0.4],
                [0.4, 0.0, 0.4],
                [0.4, 0.8, 0.4],
                [1.0, 0.8, 0.4],
            ],
            vec![
                [0.4, 0.0, 0.4],
                [0.4, 0.0, 1.0],
                [0.4, 0.8, 1.0],
                [0.4, 0.8, 0.4],
            ],
            vec![
                [0.4, 0.0, 1.0],
                [0.0, 0.0, 1.0],
                [0.0, 0.8, 1.0],
                [0.4, 0.8, 1.0],
            ],
            vec![
                [0.0, 0.0, 1.0],
                [0.0, 0.0, 0.0],
                [0.0, 0.8, 0.0],
                [0.0, 0.8, 1.0],
            ],
            vec![
                [0.0, 0.8, 0.0],
                [1.0, 0.8, 0.0],
                [1.0, 0.8, 0.4],
                [0.0, 0.8, 0.4],
            ],
            vec![
                [0.0, 0.8, 0.4],
                [0.4, 0.8, 0.4],
                [0.4, 0.8, 1.0],
                [0.0, 0.8, 1.0],
            ],
        ],
        "grey",
    );
    with(
        "an L that is not convex",
        &front,
        &[room, &[ell.turned(0.7).at(-0.4, 0.0, -0.2)]],
    );
    with(
        "a polygon through a box",
        &front,
        &[room, &[small(0.0, 0.0), level(0.5, 0.4).turned(0.3)]],
    );
    with(
        "glass windows",
        &front,
        &[room, &[level(0.9, 1.5).made_of("glass"), small(0.0, 0.0)]],
    );
    with(
        "a ceiling of glass",
        &perspective([0.3, 6.0, -4.0], [0.0, 3.0, 0.0], 50.0),
        &[
            &[
                lamp(0.3, 2.5),
                walls.clone().without(&[0, 1, 2, 4]).made_of("glass"),
                walls.clone().without(&[TOP]),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "a ceiling of glass, seen from below",
        &front,
        &[
            &[
                lamp(0.3, 2.5),
                walls.clone().without(&[0, 1, 2, 4]).made_of("glass"),
                walls.without(&[TOP]),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with("a boulder alone", &alone, &[&[boulder().at(0.0, 0.4, 0.0)]]);
    with(
        "a boulder of glass alone",
        &alone,
        &[&[boulder().at(0.0, 0.4, 0.0).made_of("glass")]],
    );
    with("a floor alone, from above", &alone, &[floor]);
    with(
        "a floor alone, from below",
        &perspective([0.3, -2.0, -1.0], [0.0, 0.0, 0.0], 50.0),
        &[floor],
    );
    scenes.push((
        "the Cornell box",
        staged(include_str!("../../../../scenes-yaml/cornell-box.yaml")),
    ));
    scenes.push((
        "the Cornell box with glass",
        staged(include_str!("../../../../scenes-yaml/cornell-glass.yaml")),
    ));
    scenes
}

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
    // So many that none of the three is compared in vain.
    assert!(
        [hits, lamps, shadows].iter().all(|&count| count > 1000),
        "{hits} hits, {lamps} lamps, {shadows} shadows"
    );
}
