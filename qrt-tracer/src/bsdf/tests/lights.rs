//! Checks that the two ways to find a lamp share its light: the weights of a point on the lamp and
//! of a ray that meets that point add up to 1, for every surface and all positions of both.

use super::{
    Direction, METAL, Textbook, VIEWERS, assert_all_that_scatter, at, dot, matte, metal,
    microfacets,
};
use crate::bsdf::Vertex;
use crate::lights::Towards;
use crate::scalar::Scalar;
use crate::{PixelClass, Stage};
use qrt_scene::front::parse;
use std::f64::consts::PI;

/// A surface on the plane z = 0 with a lamp of two parts above it, sampled by `lights`.
fn stage(material: &str, map: &str, lights: &str) -> Stage<3> {
    let text = format!(
        "name: lamps
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ m: {material}, lamp: {{ emitter: {{ radiance: [3, 2, 1] }} }} }}
geometry:
  - quad: {{ vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: m }}
  - quad: {{ vertices: [[-0.2, 0, 0.8], [-0.2, 0.5, 0.8], [0.3, 0.5, 0.8], [0.3, 0, 0.8]], material: lamp }}
  - triangle: {{ vertices: [[-0.2, 0, 0.7], [-0.2, 0.2, 0.7], [0.2, 0, 0.7]], material: lamp }}
sampling: {{ lights: {lights}, depths: [{{ bits: [0, 0] }}, {{ bits: [10, 10], light: [6, 6], map: {map} }}] }}"
    );
    let loaded = parse(&text, "lamps.yaml", &[], "".as_ref());
    let loaded = loaded.unwrap_or_else(|report| panic!("{report}"));
    Stage::rgb(&loaded.valid, PixelClass::MayMeetLamp)
}

/// The surface's number. Lamps reflect nothing, so they come first.
const SURFACE: u32 = 1;

fn vertex(outgoing: Direction) -> Vertex<Scalar, 3> {
    let arriving = outgoing.map(|c| -c);
    Vertex {
        arriving,
        tangent: [1.0, 0.0, 0.0],
        bitangent: [0.0, 1.0, 0.0],
        normal: [0.0, 0.0, 1.0],
        cos_theta: arriving[2],
        smooth: None,
        front: true,
        surface: SURFACE,
        tint: SURFACE,
        painted: None,
        point: None,
        alive: true,
    }
}

/// Ways to a point that faces the surface: the direction, the distance and the cosine at the lamp.
fn ways() -> Vec<(Direction, f64, f64)> {
    let mut ways = Vec::new();
    for theta in [1.0, 20.0, 45.0, 70.0, 88.0] {
        for phi in [10.0, 130.0, 250.0] {
            for (distance, cos) in [(0.05, 0.9), (0.7, 0.3), (1.9, 1.0), (1.0, 1e-4)] {
                ways.push((at(theta, phi), distance, cos));
            }
        }
    }
    ways
}

/// Converts a way of [`ways`], to a lamp with this `area` over probability and pi.
fn towards((incoming, distance, cos): (Direction, f64, f64), area: f64) -> Towards<Scalar> {
    let (rise, fall) = (incoming[2] * distance, cos * distance);
    Towards {
        to: incoming.map(|c| c * distance),
        rise,
        fall,
        both: rise * fall,
        square: distance * distance,
        lamp: 0,
        area,
    }
}

/// Checks that a point adds its value times the share that a ray to it leaves. `value` is that of
/// the surface.
fn shares(name: &str, stage: &Stage<3>, value: impl Fn(Direction, Direction) -> f64) {
    let scatter = &stage.scatters[0];
    let lights = scatter.lights.as_ref().unwrap();
    // Area over probability and pi, of some lamp.
    let area = 0.3;
    let lamp = stage.surface_of.iter().position(|&s| s != SURFACE).unwrap();
    for (theta, phi) in VIEWERS {
        let outgoing = at(theta, phi);
        for (incoming, distance, cos) in ways() {
            let cx = &mut Scalar::default();
            let towards = towards((incoming, distance, cos), area);
            let lit = scatter.light(cx, &vertex(outgoing), &towards, lights);
            let density = scatter.density(cx, SURFACE, &outgoing, &incoming).unwrap();
            let departure = lights.departed(cx, SURFACE, density * PI);
            // The ray's own share, for a lamp of the same area.
            let own = lights.emission_of(cx, &departure, area, distance, -cos);
            // Per steradian, with the density of points that the area stands for.
            let of_point = distance * distance / (cos * area * PI);
            let whole = value(incoming, outgoing) * incoming[2] / of_point;
            let expected = whole * (1.0 - own);
            let found = lit.weight[0] * lit.factor;
            assert!(
                (found - expected).abs() <= 1e-9 * whole.max(1e-6),
                "{name}: {found} {expected} at {incoming:?} {distance} {cos}, of {own}"
            );
            let by_density = density / (density + of_point);
            assert!(
                (own - by_density).abs() <= 1e-12,
                "{name}: {own} {by_density}"
            );
        }
    }
    assert_eq!(stage.surface_of[lamp], 0);
}

#[test]
fn a_point_and_the_ray_to_it_share_the_light_of_every_lobe() {
    let ggx = "{ ggx: { alpha: 0.3, reflectance: [0.9, 0.9, 0.9] } }";
    let glossy = "{ phong: { diffuse: [0, 0, 0], specular: [0.5, 0.5, 0.5], exponent: 7 } }";
    let cloth = r#"{ bsdf: { map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"],
        value: "0.2*(1+cos_o)*cos_i", pdf: "cos_i/pi" } }"#;
    let textbook: [(&str, &str, Textbook); 5] = [
        (
            "matte",
            "{ lambertian: { albedo: [0.7, 0.7, 0.7] } }",
            matte,
        ),
        ("ggx", ggx, microfacets),
        ("metal", METAL, metal),
        ("phong", glossy, |i, o| {
            let mirror = [-o[0], -o[1], o[2]];
            0.5 * 9.0 / (2.0 * PI) * dot(i, mirror).max(0.0).powi(7)
        }),
        ("cloth", cloth, |i, o| 0.2 * (1.0 + o[2]) * i[2]),
    ];
    assert_all_that_scatter(textbook.map(|(_, material, _)| material));
    for (name, material, value) in textbook {
        for map in ["auto", "uniform-hemisphere"] {
            let name = format!("{name}, {map}");
            shares(&name, &stage(material, map, "mis"), value);
        }
    }
}

/// Without weighting, a point has all of the light, and rays that meet a lamp have none.
#[test]
fn next_event_estimation_counts_a_lamp_once() {
    let stage = stage(
        "{ lambertian: { albedo: [0.7, 0.7, 0.7] } }",
        "auto",
        "next-event",
    );
    let scatter = &stage.scatters[0];
    let lights = scatter.lights.as_ref().unwrap();
    assert!(!lights.rays_count() && !lights.asks_for_densities());
    let cx = &mut Scalar::default();
    let (incoming, distance, cos) = (at(30.0, 70.0), 0.9, 0.8);
    let towards = towards((incoming, distance, cos), 0.2);
    let lit = scatter.light(cx, &vertex(at(10.0, 0.0)), &towards, lights);
    let expected = 0.2 * incoming[2] * cos / (distance * distance);
    assert!((lit.factor - expected).abs() < 1e-12);
    assert_eq!(lit.weight, [0.7; 3]);
}
