//! Compares scattering with its definition, `W = f |n.i| J`, one path at a time.
//!
//! Here `f` is in textbook form, and `J = |di/du x di/dv|` comes from central differences of the
//! direction that the tracer samples. Tables of an independent renderer and quadrature over the
//! hemisphere check the rest.

mod density;
mod lights;
mod references;

use super::*;
use crate::scalar::Scalar;
use crate::{PixelClass, Stage};
use qrt_scene::front::parse;
use qrt_scene::{Material, Phong};
use std::f64::consts::{PI, TAU};

/// A surface of `material` on the plane z = 0, with `bits` bits per coordinate through `map`.
struct Specimen {
    stage: Stage<3>,
    bits: u32,
}

type Direction = [f64; 3];

impl Specimen {
    fn new(material: &str, map: &str, bits: u32) -> Self {
        let text = format!(
            "name: bench
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ m: {material} }}
geometry: [{{ triangle: {{ vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material: m }} }}]
sampling: {{ depths: [{{ bits: [0, 0] }}, {{ bits: [{bits}, {bits}], map: {map} }}], lights: none }}"
        );
        match parse(&text, "bench.yaml", &[], "".as_ref()) {
            Ok(loaded) => Self {
                stage: Stage::rgb(&loaded.valid, PixelClass::MayMeetLamp),
                bits,
            },
            Err(report) => panic!("{report}"),
        }
    }

    /// The direction towards the light and the weights, for a viewer at `outgoing` (below the
    /// surface where z < 0).
    fn scatter(&self, outgoing: Direction, cell: [u32; 2]) -> (Direction, [f64; 3]) {
        let arriving = outgoing.map(|c| -c);
        let vertex = Vertex::<Scalar, 3> {
            arriving,
            tangent: [1.0, 0.0, 0.0],
            bitangent: [0.0, 1.0, 0.0],
            normal: [0.0, 0.0, 1.0],
            cos_theta: arriving[2],
            smooth: None,
            front: arriving[2] < 0.0,
            surface: 0,
            tint: 0,
            painted: None,
            point: None,
            alive: true,
        };
        let scattered = self.stage.scatters[0].scatter(&mut Scalar::at(cell), &vertex);
        (scattered.direction, scattered.weight)
    }

    /// `|di/du x di/dv|` around the centre of a cell.
    fn jacobian(&self, outgoing: Direction, [u, v]: [u32; 2]) -> f64 {
        const REACH: u32 = 8;
        let width = f64::from(2 * REACH) / (1_u64 << self.bits) as f64;
        let slope = |low: [u32; 2], high: [u32; 2]| {
            let (a, b) = (
                self.scatter(outgoing, low).0,
                self.scatter(outgoing, high).0,
            );
            [0, 1, 2].map(|k: usize| (b[k] - a[k]) / width)
        };
        let a = slope([u - REACH, v], [u + REACH, v]);
        let b = slope([u, v - REACH], [u, v + REACH]);
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        dot(cross, cross).sqrt()
    }

    fn square(&self) -> Square {
        self.stage.scatters[0].square.clone()
    }

    /// The density of the directions that it samples.
    fn density(&self, incoming: Direction, outgoing: Direction) -> Option<f64> {
        self.stage
            .density(&mut Scalar::default(), 1, 0, &outgoing, &incoming)
    }

    fn cell(&self, u: f64, v: f64) -> [u32; 2] {
        [u, v].map(|x| (x * (1_u64 << self.bits) as f64) as u32)
    }
}

fn dot(a: Direction, b: Direction) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The direction at an angle from the normal and an azimuth, both in degrees.
fn at(theta: f64, phi: f64) -> Direction {
    let (sin, cos) = theta.to_radians().sin_cos();
    let (y, x) = phi.to_radians().sin_cos();
    [sin * x, sin * y, cos]
}

const VIEWERS: [(f64, f64); 4] = [(0.5, 200.0), (30.0, 20.0), (60.0, 130.0), (82.0, -75.0)];

/// Textbook forms, red only; `i` and `o` above the surface.
type Textbook = fn(i: Direction, o: Direction) -> f64;

fn matte(_: Direction, _: Direction) -> f64 {
    0.7 / PI
}

fn microfacets(i: Direction, o: Direction) -> f64 {
    let alpha = 0.3_f64;
    let sum = [0, 1, 2].map(|k: usize| i[k] + o[k]);
    let cos_h = sum[2] / dot(sum, sum).sqrt();
    let tan_squared = |cos: f64| (1.0 - cos * cos) / (cos * cos);
    let d = alpha.powi(2) / (PI * cos_h.powi(4) * (alpha.powi(2) + tan_squared(cos_h)).powi(2));
    let g1 = |cos: f64| 2.0 / (1.0 + (1.0 + alpha.powi(2) * tan_squared(cos)).sqrt());
    0.9 * d * g1(i[2]) * g1(o[2]) / (4.0 * i[2] * o[2])
}

/// The BSDF of [`microfacets`] with 0.4 along the normal and Schlick's formula.
fn metal(i: Direction, o: Direction) -> f64 {
    let sum = [0, 1, 2].map(|k: usize| i[k] + o[k]);
    let cos_d = dot(sum, o) / dot(sum, sum).sqrt();
    microfacets(i, o) / 0.9 * (0.4 + 0.6 * (1.0 - cos_d).powi(5))
}

/// `i.mirror(o)`
fn cos_a(i: Direction, o: Direction) -> f64 {
    i[2] * o[2] - i[0] * o[0] - i[1] * o[1]
}

fn glossy(i: Direction, o: Direction) -> f64 {
    0.3 / PI + 0.5 * 22.0 / TAU * cos_a(i, o).max(0.0).powi(20)
}

fn lobe(i: Direction, o: Direction) -> f64 {
    0.5 * 22.5 / TAU * cos_a(i, o).max(0.0).powf(20.5)
}

fn moon(i: Direction, o: Direction) -> f64 {
    0.15 / (0.1 + i[2] + o[2]) * (1.0 + 0.5 * (2.0 * i[2] * o[2] - cos_a(i, o)))
}

const LAMBERTIAN: &str = "{ lambertian: { albedo: [0.7, 0.5, 0.3] } }";
const GGX: &str = "{ ggx: { alpha: 0.3, reflectance: [0.9, 0.7, 0.5] } }";
const METAL: &str = "{ metal: { alpha: 0.3, reflectance: [0.4, 0.4, 0.4] } }";
const PHONG: &str =
    "{ phong: { diffuse: [0.3, 0.2, 0.1], specular: [0.5, 0.5, 0.5], exponent: 20 } }";
const LOBE: &str = "{ phong: { diffuse: [0, 0, 0], specular: [0.5, 0.4, 0.3], exponent: 20.5 } }";
/// Lunar dust, which reflects light back to its source, with a map that prefers low heights.
const MOON: &str = "{ bsdf: {
  map: ['sqrt(1-u^4)*cos(2*pi*v)', 'sqrt(1-u^4)*sin(2*pi*v)', 'u^2'],
  value: ['0.15/(0.1 + cos_i + cos_o) * (1 + 0.5*(2*cos_i*cos_o - cos_a))', '0.1', '0.2'] } }";

/// Checks that a material of each kind is tested. Exceptions are those that scatter to single
/// directions or not at all.
fn assert_all_that_scatter<const N: usize>(materials: [&str; N]) {
    for name in Material::NAMES {
        let tested = materials
            .iter()
            .any(|text| text.starts_with(&format!("{{ {name}:")));
        let singular = ["emitter", "mirror", "dielectric"].contains(name);
        assert!(tested != singular, "{name} is not among {materials:?}");
    }
}

/// The greatest weight of rough metal under a depth's map is near its bound, and never above it. It is
/// that of the mirror direction of a viewer near the horizon.
#[test]
fn weights_of_ggx_reach_their_bounds_and_no_more() {
    for (map, least) in [
        ("cosine-hemisphere", 0.5),
        ("uniform-hemisphere", 0.3),
        ("auto", 0.9),
    ] {
        for alpha in [0.1, 0.3, 1.0] {
            let material = format!("{{ ggx: {{ alpha: {alpha}, reflectance: 0.8 }} }}");
            let specimen = Specimen::new(&material, map, 11);
            let [bound, ..] = specimen.stage.scatters[0].weight_bound(0);
            let mut most: f64 = 0.0;
            for degrees in (0..80)
                .map(f64::from)
                .chain((800..900).step_by(4).map(|tenth| f64::from(tenth) / 10.0))
            {
                let viewer = at(degrees, 180.0);
                for u in 0..1 << 11 {
                    let (_, [weight, ..]) = specimen.scatter(viewer, [u, 0]);
                    most = most.max(weight);
                }
            }
            assert!(
                most <= bound * (1.0 + 1e-9),
                "{map}, {alpha}: {most} of {bound}"
            );
            assert!(most >= bound * least, "{map}, {alpha}: {most} of {bound}");
        }
    }
}

#[test]
fn every_weight_is_the_value_times_cosine_times_jacobian() {
    let cases: [(&str, Textbook, &[&str]); 6] = [
        (
            LAMBERTIAN,
            matte,
            &["auto", "cosine-hemisphere", "uniform-hemisphere"],
        ),
        (
            GGX,
            microfacets,
            &["auto", "cosine-hemisphere", "uniform-hemisphere"],
        ),
        (
            METAL,
            metal,
            &["auto", "cosine-hemisphere", "uniform-hemisphere"],
        ),
        (PHONG, glossy, &["cosine-hemisphere", "uniform-hemisphere"]),
        (
            LOBE,
            lobe,
            &["auto", "cosine-hemisphere", "uniform-hemisphere"],
        ),
        (
            MOON,
            moon,
            &["auto", "cosine-hemisphere", "uniform-hemisphere"],
        ),
    ];
    assert_all_that_scatter(cases.map(|(material, ..)| material));
    for (material, textbook, maps) in cases {
        for map in maps {
            let specimen = Specimen::new(material, map, 20);
            let mut checked = 0;
            for (theta, phi) in VIEWERS {
                let o = at(theta, phi);
                for u in [0.04, 0.2, 0.37, 0.5, 0.71, 0.93] {
                    for v in [0.1, 0.33, 0.52, 0.8] {
                        let cell = specimen.cell(u, v);
                        let (i, weight) = specimen.scatter(o, cell);
                        assert!((dot(i, i) - 1.0).abs() < 1e-12, "{material} {map}: {i:?}");
                        if i[2] <= 1e-3 {
                            assert!(i[2] > 0.0 || weight == [0.0; 3], "{material} {map}");
                            continue;
                        }
                        let expected = textbook(i, o) * i[2] * specimen.jacobian(o, cell);
                        assert!(
                            (weight[0] - expected).abs() < 1e-6 * expected.max(1e-3),
                            "{material} {map} {theta} {u} {v}: {} {expected}",
                            weight[0]
                        );
                        checked += 1;
                    }
                }
            }
            assert!(checked > 60, "{material} {map}: only {checked} points");
        }
    }
}

#[test]
fn phong_divides_the_square_between_its_base_and_its_lobe() {
    let specimen = Specimen::new(PHONG, "auto", 20);
    // By energy: 0.6 of 2.1 to the base, whose columns come first.
    let share = 0.6 / 2.1;
    for (theta, phi) in VIEWERS {
        let o = at(theta, phi);
        for u in [0.05, 0.15, 0.27, 0.3, 0.4, 0.6, 0.9] {
            for v in [0.12, 0.4, 0.85] {
                let cell = specimen.cell(u, v);
                let (i, weight) = specimen.scatter(o, cell);
                if i[2] <= 1e-3 {
                    assert!(i[2] > 0.0 || weight == [0.0; 3]);
                    continue;
                }
                let base = 0.3 / PI;
                let f = if u < share { base } else { glossy(i, o) - base };
                let expected = f * i[2] * specimen.jacobian(o, cell);
                assert!(
                    (weight[0] - expected).abs() < 1e-6 * expected.max(1e-3),
                    "{theta} {u} {v}: {} {expected}",
                    weight[0]
                );
            }
        }
    }
}

/// The light that a viewer at `o` gets from radiance 1 all around. It uses the midpoint rule over
/// heights and azimuths.
fn reflected(textbook: Textbook, o: Direction) -> f64 {
    const N: usize = 800;
    let mut sum = 0.0;
    for a in 0..N {
        // Heights by their square: dense where cos is small, and cos dcos is then constant.
        let cos = ((a as f64 + 0.5) / N as f64).sqrt();
        let sin = (1.0 - cos * cos).sqrt();
        for b in 0..N {
            let (y, x) = (TAU * (b as f64 + 0.5) / N as f64).sin_cos();
            sum += textbook([sin * x, sin * y, cos], o);
        }
    }
    sum * PI / (N * N) as f64
}

#[test]
fn every_map_reaches_all_that_the_value_reflects() {
    const BITS: u32 = 9;
    let cases: [(&str, Textbook); 6] = [
        (LAMBERTIAN, matte),
        (GGX, microfacets),
        (METAL, metal),
        (PHONG, glossy),
        (LOBE, lobe),
        (MOON, moon),
    ];
    let cells = 1_u32 << BITS;
    for (material, textbook) in cases {
        for map in ["auto", "uniform-hemisphere"] {
            let specimen = Specimen::new(material, map, BITS);
            for (theta, phi) in [(30.0, 20.0), (70.0, 130.0)] {
                let o = at(theta, phi);
                let expected = reflected(textbook, o);
                let weights = (0..cells * cells)
                    .map(|cell| specimen.scatter(o, [cell % cells, cell / cells]).1[0]);
                let mean = weights.sum::<f64>() / f64::from(cells).powi(2);
                assert!(
                    (mean / expected - 1.0).abs() < 2e-3,
                    "{material} {map} {theta}: {mean} {expected}"
                );
            }
        }
    }
}

#[test]
fn a_mirror_mirrors() {
    let specimen = Specimen::new("{ mirror: { reflectance: [0.9, 0.8, 0.7] } }", "auto", 4);
    for (theta, phi) in VIEWERS {
        for side in [1.0, -1.0] {
            let [x, y, z] = at(theta, phi);
            let (i, weight) = specimen.scatter([x, y, side * z], [3, 5]);
            let distance = [i[0] + x, i[1] + y, i[2] - side * z];
            assert!(dot(distance, distance) < 1e-30);
            assert_eq!(weight, [0.9, 0.8, 0.7]);
        }
    }
}
