//! Tests of the real model with extreme numbers: correct, or refused; never NaN.
//!
//! Most tests use a furnace: a closed room whose walls all glow and reflect alike. In every direction of
//! a camera in it, and for every construction of the room, a path of D rays brings
//! `Le (1 - rho^D) / (1 - rho)`; a leak, a lost hit or a rounding error changes this value.

use super::cube::{WALLS, corner};
use crate::common::scene::{from_file, written};
use qrt_runtime::path_machines::Real;

const RADIANCE: [f64; 3] = [1.0, 0.5, 0.25];
const ALBEDO: [f64; 3] = [0.25, 0.5, 0.8];
const DEPTH: i32 = 5;

type Point = [f64; 3];

fn quads() -> Vec<Vec<Point>> {
    WALLS.map(|wall| wall.map(corner).to_vec()).to_vec()
}

fn triangles() -> Vec<Vec<Point>> {
    let halves = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    let all = WALLS.into_iter().flat_map(halves);
    all.map(|half| half.map(corner).to_vec()).collect()
}

/// Returns a line of a scene's geometry.
fn listed(kind: &str, vertices: &[Point], material: &str) -> String {
    format!("  - {kind}: {{ vertices: {vertices:?}, material: {material} }}\n")
}

/// A room of `polygons`, every point moved by `place`, seen through a pinhole.
struct Room {
    polygons: Vec<Vec<Point>>,
    place: fn(Point) -> Point,
    radiance: f64,
}

impl Room {
    fn new(polygons: Vec<Vec<Point>>) -> Self {
        Self {
            polygons,
            place: |p| p,
            radiance: 1.0,
        }
    }

    /// Renders the furnace from `eye` towards `target`, both in the cube's coordinates.
    fn seen(&self, eye: Point, target: Point, film: [u32; 2], vfov: f64) -> Vec<[f64; 3]> {
        let mut geometry = String::new();
        for polygon in &self.polygons {
            let kind = if polygon.len() == 3 {
                "triangle"
            } else {
                "quad"
            };
            let vertices: Vec<Point> = polygon.iter().map(|&p| (self.place)(p)).collect();
            geometry += &listed(kind, &vertices, "wall");
        }
        // `up` must not be parallel to the view.
        let up = if eye[0] == target[0] && eye[2] == target[2] {
            "[0, 0, 1]"
        } else {
            "[0, 1, 0]"
        };
        let camera = format!(
            "{{ perspective: {{ eye: {:?}, target: {:?}, up: {up}, vfov: {vfov} }} }}",
            (self.place)(eye),
            (self.place)(target)
        );
        let materials = format!(
            "{{ wall: {{ emitter: {{ radiance: {:?}, albedo: {ALBEDO:?} }} }} }}",
            RADIANCE.map(|c| c * self.radiance)
        );
        let bits = ", { bits: [10, 10] }".repeat(DEPTH as usize - 1);
        traced(&format!(
            "name: room\ncamera: {camera}\nfilm: {{ width: {}, height: {} }}\n\
             materials: {materials}\ngeometry:\n{geometry}\
             sampling: {{ path_bits: 8, depths: [{{ bits: [0, 0] }}{bits}], lights: none }}\n",
            film[0], film[1]
        ))
    }

    /// Checks that every pixel has the furnace's own colour.
    fn check(&self, eye: Point, target: Point, film: [u32; 2], vfov: f64) {
        let exact: [f64; 3] = std::array::from_fn(|c| {
            self.radiance * RADIANCE[c] * (1.0 - ALBEDO[c].powi(DEPTH)) / (1.0 - ALBEDO[c])
        });
        for (i, pixel) in self.seen(eye, target, film, vfov).iter().enumerate() {
            for c in 0..3 {
                assert!(
                    (pixel[c] / exact[c] - 1.0).abs() < 1e-9,
                    "from {eye:?} to {target:?}, pixel {i}: {pixel:?}, not {exact:?}"
                );
            }
        }
    }
}

/// Renders the picture: pixels from the top left, row by row.
fn traced(text: &str) -> Vec<[f64; 3]> {
    let scene = written(text, &[]);
    let film = scene.scene().film;
    let real = Real::new(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
    let pixels: Vec<[u32; 2]> = (0..film.width * film.height)
        .map(|i| [i % film.width, i / film.width])
        .collect();
    let paths = real.paths() as f64;
    let sums = real.sums(&pixels);
    sums.iter()
        .map(|sum| sum.colour.map(|c| c / paths))
        .collect()
}

const EYES: [Point; 3] = [[0.0, 0.0, 0.0], [0.1, -0.2, 0.3], [-0.875, 0.5, 0.75]];

#[test]
fn a_closed_box_leaks_nothing_at_its_vertices_and_edges() {
    for room in [Room::new(quads()), Room::new(triangles())] {
        for eye in EYES {
            for code in 0..8 {
                // Exactly at a vertex; its neighbourhood, a nanoradian across; and along the edges that meet
                // there.
                room.check(eye, corner(code), [1, 1], 10.0);
                room.check(eye, corner(code), [9, 9], 1e-7);
                for k in 0..3 {
                    let mut on_edge = corner(code);
                    on_edge[k] *= 0.375;
                    room.check(eye, on_edge, [3, 3], 1e-7);
                }
            }
            // The diagonals, which only the triangles share.
            room.check(eye, [0.0, 0.0, 1.0], [5, 5], 90.0);
            room.check(eye, [0.5, -1.0, 0.5], [3, 3], 1e-7);
        }
    }
}

#[test]
fn a_box_of_many_thin_triangles_leaks_nothing() {
    // Each wall is slivers 1e-9 wide beside halves of the rest.
    let mut slivers = Vec::new();
    for wall in WALLS {
        let [a, b, c, d] = wall.map(corner);
        let between = |p: Point, q: Point, t: f64| -> Point {
            std::array::from_fn(|k| p[k] + t * (q[k] - p[k]))
        };
        let cuts = [0.0, 1e-9, 0.5, 1.0 - 1e-9, 1.0];
        for cut in cuts.windows(2) {
            let [p, q] = [cut[0], cut[1]].map(|t| between(a, b, t));
            let [s, r] = [cut[0], cut[1]].map(|t| between(d, c, t));
            slivers.push(vec![p, q, r]);
            slivers.push(vec![p, r, s]);
        }
    }
    let room = Room::new(slivers);
    for eye in EYES {
        room.check(eye, [1.0, 0.3, -0.2], [16, 16], 120.0);
        // All around a vertex where slivers meet, but not exactly at it: a hit within 1e-16 of a
        // sliver's long edge may leave beyond the neighbouring wall.
        room.check(eye, [-1.0, -1.0, 1.0], [4, 4], 1e-6);
        room.check(eye, [0.0, 1.0, 0.1], [5, 5], 1e-8);
    }
}

#[test]
fn neither_size_nor_place_matters() {
    // Eyes and targets are exact even where the room stands far away.
    let places: [fn(Point) -> Point; 5] = [
        |p| p.map(|c| 1e-6 * c),
        |p| p.map(|c| 1e9 * c),
        |p| p.map(|c| c + 1e9),
        |[x, y, z]| [x - 1e9, y + 1e9, z],
        |p| p.map(|c| 1e-30 * c),
    ];
    for place in places {
        for polygons in [quads(), triangles()] {
            let room = Room {
                place,
                ..Room::new(polygons)
            };
            room.check([0.25, -0.5, 0.125], [1.0, 0.5, -0.25], [8, 8], 120.0);
            room.check([0.25, -0.5, 0.125], [1.0, 1.0, 1.0], [3, 3], 1e-6);
        }
    }
}

#[test]
fn neither_dim_nor_bright_matters() {
    for radiance in [1e-12, 1e12] {
        let room = Room {
            radiance,
            ..Room::new(quads())
        };
        room.check([0.1, -0.2, 0.3], [1.0, 0.5, -0.3], [4, 4], 60.0);
    }
}

#[test]
fn a_camera_may_stand_on_a_wall_and_look_along_it() {
    for polygons in [quads(), triangles()] {
        let room = Room::new(polygons);
        // On a wall, on an edge, in a corner; looking inwards.
        room.check([1.0, 0.0, 0.0], [-1.0, 0.25, 0.125], [4, 4], 60.0);
        room.check([1.0, 1.0, 0.0], [-1.0, -0.25, 0.125], [4, 4], 30.0);
        room.check([1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [4, 4], 20.0);
        // Slightly above a wall: rays graze it with cosines down to 1e-10.
        room.check(
            [0.0, -1.0 + 1e-9, 0.0],
            [1.0, -1.0 + 2e-9, 0.25],
            [4, 4],
            1e-7,
        );
        room.check(
            [0.0, -1.0 + 1e-9, 0.0],
            [1.0, -1.0 - 1e-7, 0.25],
            [4, 4],
            1e-7,
        );
    }
}

#[test]
fn a_lamp_a_ten_thousandth_of_the_scene_lights_and_shows_as_any_other() {
    // The lamp and the camera of a scene of ordinary size, scaled by 1e-4 above a floor that is not.
    let scene = |size: f64| {
        let lamp = [
            [-0.5, 2.0, -0.5],
            [0.5, 2.0, -0.5],
            [0.5, 2.0, 0.5],
            [-0.5, 2.0, 0.5],
        ];
        let lamp = lamp.map(|p| p.map(|c: f64| c * size));
        let eye = [0.3, 1.5, -0.2].map(|c| c * size);
        let target = [0.3 * size, 0.0, -0.2 * size];
        (
            format!(
                "materials: {{ floor: {{ lambertian: {{ albedo: [0.8, 0.5, 0.2] }} }}, \
             lamp: {{ emitter: {{ radiance: [10, 8, 6] }} }} }}
geometry:
  - quad: {{ vertices: [[-4, 0, -4], [-4, 0, 4], [4, 0, 4], [4, 0, -4]], material: floor }}
  - quad: {{ vertices: {lamp:?}, material: lamp }}
sampling: {{ path_bits: 14, depths: [{{ bits: [8, 8] }}, {{ bits: [12, 12] }}], lights: none }}\n"
            ),
            eye,
            target,
        )
    };
    let seen = |size: f64, up: bool| {
        let (rest, eye, mut target) = scene(size);
        if up {
            target = [0.0, 2.0 * size, 0.0];
        }
        traced(&format!(
            "name: small
camera: {{ perspective: {{ eye: {eye:?}, target: {target:?}, up: [0, 0, 1], vfov: 20 }} }}
film: {{ width: 2, height: 2 }}
{rest}"
        ))
    };
    // The camera looks straight at the lamp.
    assert_eq!(seen(1e-4, true), vec![[10.0, 8.0, 6.0]; 4]);
    // Its light on the floor is albedo Le F, with F of the point below the camera within the spread of
    // the pixels.
    for pixel in seen(1e-4, false) {
        for (c, full) in [8.0, 4.0, 1.2].into_iter().enumerate() {
            let form_factor = pixel[c] / full;
            assert!((form_factor / 0.0695537 - 1.0).abs() < 0.1, "{pixel:?}");
        }
    }
}

#[test]
fn a_scene_of_nothing_is_black_and_a_film_may_be_one_pixel() {
    let empty = "name: void
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 20 } }
film: { width: 3, height: 2 }
materials: {}
geometry: []";
    assert_eq!(traced(empty), vec![[0.0; 3]; 6]);
    let unlit = "name: unlit
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 20 } }
film: { width: 1, height: 1 }
materials: { m: { lambertian: { albedo: [1, 1, 1] } } }
geometry: [{ triangle: { vertices: [[-9, -9, 0], [9, -9, 0], [0, 9, 0]], material: m } }]";
    assert_eq!(traced(unlit), vec![[0.0; 3]]);
}

#[test]
fn every_material_is_finite_at_grazing_angles_and_inside_solids() {
    // A block of each material in a glowing room, seen from outside, along its faces, and inside.
    let materials = [
        "{ lambertian: { albedo: [1, 1, 1] } }",
        "{ mirror: { reflectance: [1, 1, 1] } }",
        "{ dielectric: { ior: 1.5 } }",
        "{ dielectric: { ior: 0.01 } }",
        "{ ggx: { alpha: 1e-4, reflectance: [1, 1, 1] } }",
        "{ ggx: { alpha: 1, reflectance: [1, 1, 1] } }",
        "{ metal: { reflectance: [0, 0.5, 1] } }",
        "{ metal: { alpha: 1e-4, reflectance: [0, 0.5, 1] } }",
        "{ metal: { alpha: 1, reflectance: [0, 0.5, 1] } }",
        "{ phong: { diffuse: [0.5, 0, 0], specular: [0.5, 1, 1], exponent: 1000000 } }",
        "{ phong: { diffuse: [0.5, 0, 0], specular: [0.5, 1, 1], exponent: 0 } }",
    ];
    let mut block = String::new();
    let mut room = String::new();
    for wall in quads() {
        // A quarter of the size, fronts outwards.
        let vertices: Vec<Point> = wall.iter().rev().map(|p| p.map(|c| 0.25 * c)).collect();
        block += &listed("quad", &vertices, "block");
        room += &listed("quad", &wall, "glow");
    }
    let views: [(Point, Point); 4] = [
        ([0.75, 0.5, 0.25], [0.0, 0.0, 0.0]),
        ([0.75, 0.25, 0.0], [0.0, 0.25, 0.0]),
        ([0.75, 0.250_000_001, 0.0], [0.0, 0.25, 0.0]),
        ([0.125, 0.0, 0.0625], [0.25, 0.25, 0.25]),
    ];
    for material in materials {
        for map in ["auto", "cosine-hemisphere", "uniform-hemisphere"] {
            for (eye, target) in views {
                let depth = format!(", {{ bits: [10, 10], map: {map} }}").repeat(4);
                let picture = traced(&format!(
                    "name: block
camera: {{ perspective: {{ eye: {eye:?}, target: {target:?}, vfov: 90 }} }}
film: {{ width: 5, height: 5 }}
materials: {{ block: {material}, glow: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry:
{block}{room}sampling: {{ path_bits: 8, depths: [{{ bits: [0, 0] }}{depth}], lights: none }}"
                ));
                for value in picture.as_flattened() {
                    assert!(
                        value.is_finite() && *value >= 0.0,
                        "{material} {map}: {picture:?}"
                    );
                }
                // In a room of radiance 1 no surface that conserves energy is brighter, if the weight of each path
                // is the reflection of its surface (glass squeezes light by the squared index).
                if map == "auto" && !material.contains("dielectric") {
                    let most = picture.as_flattened().iter().copied().fold(0.0, f64::max);
                    assert!(most < 1.1, "{material} {map}: {most}");
                }
            }
        }
    }
}

/// Random directions under two densities, and the net's, give the same integral.
#[test]
fn random_paths_have_the_mean_of_dense_ones_whatever_their_density() {
    const PATHS: u64 = 1 << 16;
    let pixels: Vec<[u32; 2]> = (0..20).map(|i| [i % 5, i / 5]).collect();
    let machine = |map: &str, path_bits: u32| {
        let depths = format!("[{{ bits: [16, 16] }}, {{ bits: [16, 16], map: {map} }}]");
        let sampling =
            format!("sampling={{ path_bits: {path_bits}, depths: {depths}, lights: none }}");
        let sets = ["film={ width: 5, height: 4 }", &sampling];
        let scene = from_file("scenes-yaml/floor-and-light.yaml", &sets);
        Real::new(&scene, 3).unwrap_or_else(|error| panic!("{error}"))
    };
    let dense = machine("auto", 18).sums(&pixels);
    for map in ["cosine-hemisphere", "uniform-hemisphere"] {
        let random = machine(map, 0).monte_carlo(PATHS);
        let mut sums = vec![[[0.0; 2]; 3]; pixels.len()];
        random.trace(&pixels, |block| {
            for (sum, colours) in sums[block.pixel].iter_mut().zip(block.colours) {
                for colour in colours {
                    sum[0] += colour;
                    sum[1] += colour * colour;
                }
            }
        });
        // The distance in standard errors: a standard normal, if both are right.
        let mut apart = Vec::new();
        for (sum, dense) in sums.iter().zip(&dense) {
            for (&[first, second], dense) in sum.iter().zip(dense.colour) {
                let mean = first / PATHS as f64;
                let variance = second / PATHS as f64 - mean * mean;
                let error = (variance / PATHS as f64).sqrt();
                assert!(
                    error < 0.05 * mean,
                    "{map}: {mean} +- {error} tells nothing"
                );
                apart.push((mean - dense / f64::from(1 << 18)) / error);
            }
        }
        let square = apart.iter().map(|z| z * z).sum::<f64>() / apart.len() as f64;
        assert!((0.3..2.0).contains(&square), "{map}: {square}");
        // Channels of a pixel share their paths.
        let pixels = apart.len() as f64 / 3.0;
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        assert!(mean.abs() < 4.0 / pixels.sqrt(), "{map}: {mean}");
    }
}
