//! Extremes of scenes, under all three models.
//!
//! Most tests use a furnace: a closed room whose walls all glow and reflect alike, where a path of
//! D rays brings `Le (1 - rho^D) / (1 - rho)` in every direction of the camera. A leak, a lost hit or
//! a rounding error changes this value.

use super::Extreme;
use crate::pictures::cube::{WALLS, corner};
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::front::parse;
use qrt::syntax::Report;
use std::fmt::Write as _;

type Point = [f64; 3];

const RADIANCE: [f64; 3] = [1.0, 0.5, 0.25];
const ALBEDO: [f64; 3] = [0.25, 0.5, 0.8];
const DEPTH: i32 = 2;

/// Renders a scene under a model, counted exactly; returns its pixels.
pub(super) fn picture(text: &str, model: Model) -> Result<Vec<[f64; 3]>, Report> {
    let scene = parse(text, "scene.yaml", &[], "".as_ref())?.valid;
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        seed: 1,
        ..RenderOptions::default()
    };
    Ok(render(&scene, &options).unwrap().image.pixels)
}

/// A furnace.
#[derive(Clone, Copy)]
struct Room {
    place: fn(Point) -> Point,
    radiance: f64,
    eye: Point,
    target: Point,
    vfov: f64,
    film: u32,
    triangles: bool,
}

const ROOM: Room = Room {
    place: |p| p,
    radiance: 1.0,
    eye: [0.125, -0.25, 0.375],
    target: [1.0, 0.5, -0.25],
    vfov: 90.0,
    film: 3,
    triangles: false,
};

impl Room {
    fn text(&self) -> String {
        let mut geometry = String::new();
        for wall in WALLS {
            let [a, b, c, d] = wall.map(|code| (self.place)(corner(code)));
            if self.triangles {
                for half in [[a, b, c], [a, c, d]] {
                    writeln!(
                        geometry,
                        "  - triangle: {{ vertices: {half:?}, material: wall }}"
                    )
                    .unwrap();
                }
            } else {
                let all = [a, b, c, d];
                writeln!(
                    geometry,
                    "  - quad: {{ vertices: {all:?}, material: wall }}"
                )
                .unwrap();
            }
        }
        let bits = ", { bits: [6, 6] }".repeat(DEPTH as usize - 1);
        format!(
            "name: room
camera: {{ perspective: {{ eye: {:?}, target: {:?}, vfov: {} }} }}
film: {{ width: {}, height: {} }}
materials: {{ wall: {{ emitter: {{ radiance: {:?}, albedo: {ALBEDO:?} }} }} }}
geometry:
{geometry}sampling: {{ path_bits: 6, depths: [{{ bits: [4, 4] }}{bits}], lights: none }}
comparator: {{ bits: 10 }}
",
            (self.place)(self.eye),
            (self.place)(self.target),
            self.vfov,
            self.film,
            self.film,
            RADIANCE.map(|c| c * self.radiance),
        )
    }

    /// Returns the largest relative error of a pixel's channel.
    fn error(&self, model: Model) -> f64 {
        let mut worst = 0.0_f64;
        for pixel in picture(&self.text(), model).unwrap() {
            for c in 0..3 {
                let exact =
                    self.radiance * RADIANCE[c] * (1.0 - ALBEDO[c].powi(DEPTH)) / (1.0 - ALBEDO[c]);
                assert!(pixel[c].is_finite());
                worst = worst.max((pixel[c] / exact - 1.0).abs());
            }
        }
        worst
    }
}

/// Returns the errors of rooms by model, each within its bound; `gates` equals `fixed`.
fn errors(rooms: &[Room], real: f64, fixed: f64) -> String {
    let worst = |model| {
        rooms
            .iter()
            .map(|room| room.error(model))
            .fold(0.0, f64::max)
    };
    let [by_real, by_fixed] = [worst(Model::Real), worst(Model::Fixed)];
    assert!(by_real <= real, "real: {by_real}");
    assert!(by_fixed <= fixed, "fixed: {by_fixed}");
    let first = rooms[0].text();
    assert_eq!(picture(&first, Model::Gates), picture(&first, Model::Fixed));
    format!("real {by_real:.0e}, fixed and gates {by_fixed:.0e}, relative")
}

fn radiances() -> Extreme {
    let rooms = [1e-12, 1e12].map(|radiance| Room { radiance, ..ROOM });
    Extreme::new(
        "radiance 1e-12 and 1e12",
        "a furnace shows its colour, to the models' precision",
        errors(&rooms, 2e-5, 1e-3),
    )
}

fn places() -> Extreme {
    let places: [fn(Point) -> Point; 3] = [
        |p| p.map(|c| 1e-6 * c),
        |p| p.map(|c| c + 1e9),
        |p| p.map(|c| 1e9 * c),
    ];
    let rooms = places.map(|place| Room { place, ..ROOM });
    Extreme::new(
        "a scene of size 1e-6, of size 1e9, and at 1e9 from the origin",
        "a furnace shows its colour, to the models' precision",
        errors(&rooms, 2e-5, 1e-3),
    )
}

/// Tests pixels that look exactly at vertices and along edges, in rooms of quads and of triangles.
fn edges() -> Extreme {
    let mut rooms = Vec::new();
    for triangles in [false, true] {
        for code in 0..8 {
            for vfov in [90.0, 1e-7] {
                rooms.push(Room {
                    target: corner(code),
                    vfov,
                    triangles,
                    ..ROOM
                });
            }
            let mut on_edge = corner(code);
            on_edge[code % 3] *= 0.375;
            rooms.push(Room {
                target: on_edge,
                vfov: 1e-6,
                triangles,
                ..ROOM
            });
        }
    }
    Extreme::new(
        "rays through shared edges and vertices",
        "a closed box leaks nothing",
        errors(&rooms, 2e-5, 1e-3),
    )
}

fn grazing() -> Extreme {
    let rooms = [1e-7, 2e-8].map(|above| Room {
        eye: [-0.5, -1.0 + above, 0.0],
        target: [1.0, -1.0 + 0.5 * above, 0.25],
        vfov: 1e-7,
        ..ROOM
    });
    Extreme::new(
        "grazing rays, cosines below 1e-6",
        "the wall along which they run is met, or what lies behind it",
        errors(&rooms, 2e-5, 1e-3),
    )
}

/// Rotates by 30 degrees about z and 20 about x.
fn askew([x, y, z]: Point) -> Point {
    let [s, c] = [0.5, 0.75_f64.sqrt()];
    let [x, y] = [c * x - s * y, s * x + c * y];
    let [s, c] = [0.342_020_143_325_668_7, 0.939_692_620_785_908_4];
    [x, c * y - s * z, s * y + c * z]
}

fn inside() -> Extreme {
    let room = |eye: Point, target: Point, vfov: f64| Room {
        eye,
        target,
        vfov,
        ..ROOM
    };
    // The field of view is narrow enough to look inwards only.
    let rooms = [
        room([1.0, 0.0, 0.0], [-1.0, 0.25, 0.125], 60.0),
        room([1.0, 1.0, 1.0], [0.0, 0.0, 0.0], 20.0),
        room([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 90.0),
        // The same wall and corner, rotated.
        Room {
            place: askew,
            ..room([1.0, 0.0, 0.0], [-1.0, 0.25, 0.125], 60.0)
        },
        Room {
            place: askew,
            ..room([1.0, 1.0, 1.0], [0.0, 0.0, 0.0], 20.0)
        },
    ];
    Extreme::new(
        "the camera inside, on a wall, in a corner",
        "a furnace shows its colour from there, too",
        errors(&rooms, 2e-5, 1e-3),
    )
}

/// Returns a floor lit by a lamp, with colours that are no round numbers.
fn lit_floor(fraction: u32) -> String {
    format!(
        "name: lit
camera: {{ perspective: {{ eye: [0.3, 1.5, -0.2], target: [0.3, 0, -0.2], up: [0, 0, 1], vfov: 60 }} }}
film: {{ width: 4, height: 4 }}
materials:
  floor: {{ lambertian: {{ albedo: [0.8, 0.5, 0.2] }} }}
  lamp: {{ emitter: {{ radiance: [10, 8, 6], albedo: [0.3, 0.3, 0.3] }} }}
geometry:
  - quad: {{ vertices: [[-4, 0, -4], [-4, 0, 4], [4, 0, 4], [4, 0, -4]], material: floor }}
  - quad: {{ vertices: [[-0.5, 2, -0.5], [0.5, 2, -0.5], [0.5, 2, 0.5], [-0.5, 2, 0.5]], material: lamp }}
sampling: {{ path_bits: 9, depths: [{{ bits: [8, 8] }}, {{ bits: [8, 8] }}, {{ bits: [8, 8] }}, {{ bits: [8, 8] }}], lights: none }}
comparator: {{ bits: 20 }}
precision: {{ fraction: {fraction} }}
"
    )
}

fn fractions() -> Extreme {
    let mut measured = Vec::new();
    let mut last = f64::INFINITY;
    for fraction in [4, 8, 12, 16, 24, 30] {
        let text = lit_floor(fraction);
        let [real, fixed] = [Model::Real, Model::Fixed].map(|model| picture(&text, model).unwrap());
        let pairs = real.as_flattened().iter().zip(fixed.as_flattened());
        let (square, sum) = pairs.fold((0.0, 0.0), |(square, sum), (r, f)| {
            assert!(f.is_finite());
            (square + (r - f) * (r - f), sum + r)
        });
        let error = (square / 48.0).sqrt() / (sum / 48.0);
        // The error that remains at the end is the comparators'.
        assert!(error <= last.max(1e-5), "{fraction}: {error} after {last}");
        last = error;
        measured.push(format!("{fraction}: {error:.0e}"));
    }
    assert!(last < 1e-5, "{last}");
    Extreme::new(
        "fractions of 4 to 30 bits",
        "every number of bits works; the error falls to that of 2^20 thresholds",
        format!(
            "RMSE to real over the mean, by bits: {}",
            measured.join(", ")
        ),
    )
}

/// Covers a quarter of the view by two quads in one plane.
fn overlaps() -> Extreme {
    let text = |first: &str, second: &str| {
        format!(
            "name: overlap
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 20 }} }}
film: {{ width: 4, height: 4 }}
materials:
  red: {{ emitter: {{ radiance: [1, 0, 0] }} }}
  green: {{ emitter: {{ radiance: [0, 1, 0] }} }}
geometry:
  - quad: {{ vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: {first} }}
  - triangle: {{ vertices: [[-3, -2, 0], [3, -2, 0], [0, 4, 0]], material: {second} }}
sampling: {{ path_bits: 4, depths: [{{ bits: [4, 4] }}] }}"
        )
    };
    for model in Model::ALL {
        assert_eq!(
            picture(&text("red", "green"), model).unwrap(),
            vec![[1.0, 0.0, 0.0]; 16]
        );
        assert_eq!(
            picture(&text("green", "red"), model).unwrap(),
            vec![[0.0, 1.0, 0.0]; 16]
        );
    }
    Extreme::new(
        "surfaces that overlap in one plane",
        "the first listed is seen, under every model",
        "in all 16 pixels, with the two surfaces listed in either order".to_owned(),
    )
}

/// Tests a slit of light between two triangles that are almost lines.
fn slivers() -> Extreme {
    let text = |height: f64| {
        format!(
            "name: sliver
camera: {{ orthographic: {{ eye: [0, 0, 3], target: [0, 0, 0], height: 2 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ m: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry: [{{ triangle: {{ vertices: [[-1, 0, 0], [1, 0, 0], [1, {height:?}, 0]], material: m }} }}]
sampling: {{ path_bits: 16, depths: [{{ bits: [12, 12] }}] }}
comparator: {{ bits: 1 }}
precision: {{ fraction: 24 }}"
        )
    };
    let mut measured = Vec::new();
    for height in [0.5, 0.05, 0.005] {
        let expected = 0.25 * height;
        for model in [Model::Real, Model::Fixed] {
            let [pixel] = picture(&text(height), model).unwrap()[..] else {
                panic!("one pixel");
            };
            let error = (pixel[0] / expected - 1.0).abs();
            assert!(error < 0.05, "{model:?} {height}: {pixel:?}");
            if model == Model::Real {
                measured.push(format!("{height}: {error:.0e}"));
            }
        }
    }
    for height in [0.0, 1e-300] {
        let report = picture(&text(height), Model::Real).unwrap_err().to_string();
        assert!(report.contains("error[QRT03"), "{report}");
    }
    Extreme::new(
        "slivers, and triangles without an area",
        "a sliver covers its area; a triangle without an area is refused, with its place",
        format!(
            "relative error of the area by height, {}",
            measured.join(", ")
        ),
    )
}

/// A lamp of a ten-thousandth of the floor's size appears like any other, and lights as it must.
fn tiny_lamp() -> Extreme {
    // Seen from the floor, straight up.
    let text = |up: bool| {
        let target = if up {
            "[0, 0.0002, 0]"
        } else {
            "[0.00003, 0, -0.00002]"
        };
        let eye = if up {
            "[0, 0.0001, 0]"
        } else {
            "[0.00003, 0.00015, -0.00002]"
        };
        format!(
            "name: small
camera: {{ perspective: {{ eye: {eye}, target: {target}, up: [0, 0, 1], vfov: 20 }} }}
film: {{ width: 1, height: 1 }}
materials:
  floor: {{ lambertian: {{ albedo: [0.8, 0.8, 0.8] }} }}
  lamp: {{ emitter: {{ radiance: [10, 8, 6] }} }}
geometry:
  - quad: {{ vertices: [[-4, 0, -4], [-4, 0, 4], [4, 0, 4], [4, 0, -4]], material: floor }}
  - quad: {{ vertices: [[-5e-5, 2e-4, -5e-5], [5e-5, 2e-4, -5e-5], [5e-5, 2e-4, 5e-5], [-5e-5, 2e-4, 5e-5]], material: lamp }}
sampling: {{ path_bits: 14, depths: [{{ bits: [8, 8] }}, {{ bits: [12, 12] }}], lights: none }}"
        )
    };
    assert_eq!(
        picture(&text(true), Model::Real).unwrap(),
        [[10.0, 8.0, 6.0]]
    );
    let [pixel] = picture(&text(false), Model::Real).unwrap()[..] else {
        panic!("one pixel");
    };
    // The form factor of the lamp from the middle of the visible part of the floor, by the closed form of
    // a rectangle above a point.
    let form_factor = pixel[0] / 8.0;
    let error = (form_factor / 0.069_553_7 - 1.0).abs();
    assert!(error < 0.1, "{form_factor}");
    Extreme::new(
        "a lamp 1e-4 of the scene",
        "the lamp shows exactly, and lights the floor by its form factor (0.0696)",
        format!("shown exactly; form factor off by {:.0} %", 100.0 * error),
    )
}

fn nothing() -> Extreme {
    let text = "
name: nothing
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 1, height: 1 }
materials: {}
geometry: []
";
    for model in Model::ALL {
        assert_eq!(picture(text, model).unwrap(), [[0.0; 3]]);
    }
    Extreme::new(
        "no primitive at all; a film of 1 x 1",
        "black, without a query",
        "black under every model".to_owned(),
    )
}

pub(super) fn all() -> Vec<Extreme> {
    let all: [fn() -> Extreme; 10] = [
        radiances, places, edges, grazing, inside, fractions, overlaps, slivers, tiny_lamp, nothing,
    ];
    all.map(|extreme| extreme()).into()
}
