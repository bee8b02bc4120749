//! Discs against closed forms, in floating point and as circuits.

use super::spheres::seen;
use crate::common::scene::written;
use qrt::lab::verify::{VerifyOptions, verify};
use qrt::prelude::*;
use qrt::runtime::render::Visibility;
use qrt::runtime::search::Guess;
use qrt::tracer::{PixelClass, Stage};
use std::f64::consts::PI;

/// The radiance of the lamp, by channel.
const RADIANCE: [f64; 3] = [4.0, 2.0, 1.0];

/// A scene of `geometry` and other `blocks`, seen by parallel rays that fall on the square of side
/// `height` around the origin from the height `eye`.
fn from_above(eye: f64, height: f64, geometry: &str, blocks: &str) -> ValidScene {
    let text = format!(
        "name: test
camera: {{ orthographic: {{ eye: [0, {eye}, 0], target: [0, -1, 0], up: [0, 0, -1], height: {height} }} }}
film: {{ width: 1, height: 1 }}
materials:
  white: {{ lambertian: {{ albedo: 1 }} }}
  grey: {{ lambertian: {{ albedo: 0.5 }} }}
  lamp: {{ emitter: {{ radiance: [4, 2, 1] }} }}
  dim: {{ emitter: {{ radiance: [1, 1, 1] }} }}
geometry:
{geometry}
{blocks}"
    );
    written(&text, &[])
}

fn disc(center: [f64; 3], normal: [f64; 3], radius: f64, material: &str) -> String {
    format!(
        "  - disc: {{ center: {center:?}, normal: {normal:?}, radius: {radius}, material: {material} }}\n"
    )
}

const ALONE: &str = "sampling: { path_bits: 14, depths: [{ bits: [14, 14] }] }";

/// Asserts that each channel is `expected` of the lamp's radiance, relative to it.
fn near(what: &str, pixel: [f64; 3], expected: f64, allowed: f64) {
    for (channel, radiance) in pixel.iter().zip(RADIANCE) {
        let error = channel / (radiance * expected) - 1.0;
        assert!(error.abs() < allowed, "{what}: {pixel:?}, off by {error}");
    }
}

/// From above, a disc whose normal makes the angle a with the vertical covers the area `pi r^2 cos a`.
#[test]
fn a_disc_covers_its_projected_area() {
    let r: f64 = 0.4;
    let area = PI * r * r;
    let level = disc([0.05, 1.0, -0.02], [0.0, 3.0, 0.0], r, "lamp");
    let slanted = disc([0.0, 1.0, 0.0], [1.0, 2.0, -2.0], r, "lamp");
    let steep = disc([0.0, 1.0, 0.0], [0.0, 0.28, 0.96], r, "lamp");
    let small = disc([0.3, 1.0, 0.2], [0.0, 1.0, 0.0], 0.05, "lamp");
    let moved = "  - disc: { center: [0, 0, 1], normal: [0, 0, 5], radius: 0.8, scale: 0.5, \
                 rotate: [-60, 0, 0], translate: [0, 0.5, -0.25], material: lamp }\n";
    for (what, geometry, expected) in [
        ("level", level.as_str(), area),
        ("slanted", &slanted, area * 2.0 / 3.0),
        ("steep", &steep, area * 0.28),
        ("small", &small, PI * 0.0025),
        ("moved", moved, area * (60.0_f64).to_radians().sin()),
    ] {
        let scene = from_above(9.0, 1.0, geometry, ALONE);
        for model in [Model::Real, Model::Fixed] {
            // Few of the points fall on the small one.
            let allowed = if what == "small" { 0.05 } else { 3e-3 };
            let what = format!("{what}, {model:?}");
            near(&what, seen(&scene, model)[0], expected, allowed);
        }
    }
}

/// A disc of any size is as round at any distance from the origin, as far as coordinates have digits.
#[test]
fn size_and_distance_do_not_matter() {
    let r = 0.4;
    let expected = PI * r * r * 2.0 / 3.0;
    for (unit, away) in [
        (1.0, 0.0),
        (1e-6, 0.0),
        (1e9, 0.0),
        (1.0, 1e9),
        (1e-6, 100.0),
    ] {
        let at = |x: f64| away + unit * x;
        let (x, high, target) = (at(0.0), at(9.0), at(-1.0));
        let text = format!(
            "name: far
camera: {{ orthographic: {{ eye: [{x:?}, {high:?}, {x:?}], target: [{x:?}, {target:?}, {x:?}], up: [0, 0, -1], height: {unit:?} }} }}
film: {{ width: 1, height: 1 }}
materials: {{ lamp: {{ emitter: {{ radiance: [4, 2, 1] }} }} }}
geometry:
{}{ALONE}",
            disc([x, at(1.0), x], [1.0, 2.0, -2.0], r * unit, "lamp")
        );
        let scene = written(&text, &[]);
        for model in [Model::Real, Model::Fixed] {
            near(
                &format!("{unit}, {away}, {model:?}"),
                seen(&scene, model)[0],
                expected,
                5e-3,
            );
        }
    }
}

/// A disc is dark from behind.
#[test]
fn the_front_is_the_side_of_the_normal() {
    let away = disc([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 0.4, "lamp");
    let scene = from_above(9.0, 1.0, &away, ALONE);
    for model in [Model::Real, Model::Fixed] {
        assert_eq!(seen(&scene, model), [[0.0; 3]]);
    }
}

const FLOOR: &str =
    "  - quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: grey }\n";

fn lit(lights: &str, path_bits: u32) -> String {
    let light = if lights == "none" {
        ""
    } else {
        ", light: [10, 10]"
    };
    format!(
        "sampling: {{ path_bits: {path_bits}, lights: {lights}, depths: [{{ bits: [10, 10] }}, {{ bits: [10, 10]{light} }}] }}"
    )
}

/// Below the centre of a disc of radius r at the height h the irradiance is `pi L r^2 / (r^2 + h^2)`. A disc
/// halfway, parallel to it, takes away its own part.
#[test]
fn a_disc_lights_a_floor_and_shades_it() {
    let (r, h) = (0.6, 1.0);
    let part = |r: f64, h: f64| r * r / (r * r + h * h);
    let lamp = disc([0.0, h, 0.0], [0.0, -1.0, 0.0], r, "lamp");
    let shade = disc([0.0, 0.5, 0.0], [0.0, 1.0, 0.0], 0.2, "grey");
    let lamps = format!("{FLOOR}{lamp}");
    let shaded = format!("{FLOOR}{lamp}{shade}");
    for (what, geometry, expected) in [
        ("lit", &lamps, 0.5 * part(r, h)),
        ("shaded", &shaded, 0.5 * (part(r, h) - part(0.2, 0.5))),
    ] {
        for lights in ["none", "mis", "auto", "next-event"] {
            // The patch is so narrow that its centre stands for it.
            let scene = from_above(0.25, 0.01, geometry, &lit(lights, 16));
            let allowed = if lights == "none" { 0.02 } else { 4e-3 };
            let real = seen(&scene, Model::Real)[0];
            near(&format!("{what}, {lights}"), real, expected, allowed);
            let fixed = seen(&scene, Model::Fixed)[0];
            near(&format!("{what}, {lights}, fixed"), fixed, expected, 0.02);
        }
    }
}

/// The points on a lamp are uniform by area: light of a slanted lamp beside a point, by sampled points and
/// by rays that find the lamp by chance.
#[test]
fn sampled_points_give_the_light_that_is_found_by_chance() {
    let lamp = disc([0.7, 0.6, -0.2], [-1.0, -0.6, 0.3], 0.5, "lamp");
    let other = "  - quad: { vertices: [[-0.9, 0.5, 0.1], [-0.9, 0.5, 0.4], [-0.9, 0.9, 0.4], [-0.9, 0.9, 0.1]], material: lamp }\n";
    for lamps in [lamp.clone(), format!("{lamp}{other}")] {
        let geometry = format!("{FLOOR}{lamps}");
        let of = |lights| from_above(0.3, 1.0, &geometry, &lit(lights, 16));
        let truth = seen(&of("none"), Model::Real)[0][0];
        assert!(truth > 0.05, "{truth}");
        for lights in ["mis", "auto", "next-event"] {
            let scene = of(lights);
            for (model, allowed) in [(Model::Real, 0.01), (Model::Fixed, 0.02)] {
                let found = seen(&scene, model)[0][0];
                let error = found / truth - 1.0;
                assert!(
                    error.abs() < allowed,
                    "{lights}, {model:?}: {found}, {truth}"
                );
            }
        }
    }
}

/// Of faces on one plane the first is seen, a disc before a quad as well as after it.
#[test]
fn of_a_disc_and_a_quad_on_one_plane_the_first_is_seen() {
    let quad =
        "  - quad: { vertices: [[-1, 1, 1], [1, 1, 1], [1, 1, -1], [-1, 1, -1]], material: dim }\n";
    let disc = disc([0.1, 1.0, 0.0], [0.0, 1.0, 0.0], 0.3, "lamp");
    let area = PI * 0.09;
    for (geometry, expected) in [
        (format!("{disc}{quad}"), 1.0 + area * 3.0),
        (format!("{quad}{disc}"), 1.0),
    ] {
        let scene = from_above(9.0, 1.0, &geometry, ALONE);
        for model in [Model::Real, Model::Fixed] {
            let found = seen(&scene, model)[0][0];
            assert!(
                (found - expected).abs() < 4e-3,
                "{model:?}: {found}, {expected}"
            );
        }
    }
    // A lamp is dark where a disc of its plane, listed before it, covers it.
    let lamp = "  - quad: { vertices: [[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], material: lamp }\n";
    let cover = self::disc([0.0, 1.0, 0.0], [0.0, 1.0, 0.0], 0.4, "grey");
    let mean = |geometry: &str, model| {
        let scene = from_above(0.25, 0.01, geometry, &lit("next-event", 14));
        seen(&scene, model)[0][0]
    };
    for model in [Model::Real, Model::Fixed] {
        let whole = mean(&format!("{FLOOR}{lamp}"), model);
        let after = mean(&format!("{FLOOR}{lamp}{cover}"), model);
        let before = mean(&format!("{FLOOR}{cover}{lamp}"), model);
        let hidden = 0.5 * 4.0 * 0.16 / 1.16;
        assert!(
            (after / whole - 1.0).abs() < 1e-3,
            "{model:?}: {after} {whole}"
        );
        let error = (whole - before) / hidden - 1.0;
        assert!(error.abs() < 0.02, "{model:?}: {before} of {whole}");
    }
}

/// A small scene with a disc that is seen, one that casts a shadow, a lamp, and glass.
fn small(circuit: &str, lights: &str) -> ValidScene {
    let geometry = [
        FLOOR.to_owned(),
        disc([0.1, 0.0, 0.1], [0.0, 1.0, 0.0], 0.3, "white"),
        disc([0.1, 1.2, 0.0], [0.1, -1.0, 0.0], 0.4, "lamp"),
        disc([-0.2, 0.5, 0.1], [1.0, 2.0, 0.5], 0.3, "grey"),
    ];
    let light = if lights == "none" {
        ""
    } else {
        ", light: [5, 5]"
    };
    let blocks = format!(
        "sampling: {{ path_bits: 10, lights: {lights}, depths: [{{ bits: [6, 6] }}, {{ bits: [5, 5]{light} }}, {{ bits: [5, 5]{light} }}] }}
circuit: {circuit}
precision: {{ fraction: 14 }}"
    );
    from_above(0.9, 1.8, &geometry.concat(), &blocks)
}

#[test]
fn circuits_of_discs_compute_what_floating_point_does() {
    for circuit in [
        "{ uncompute: keep }",
        "{ uncompute: scoped }",
        "{ nearest: paper }",
    ] {
        for lights in ["none", "auto", "mis"] {
            let scene = small(circuit, lights);
            let [real, fixed, gates] =
                [Model::Real, Model::Fixed, Model::Gates].map(|model| seen(&scene, model)[0]);
            assert_eq!(fixed, gates, "{circuit}, {lights}");
            for (real, fixed) in real.iter().zip(fixed) {
                assert!(*real > 0.02, "{circuit}, {lights}: {real}");
                assert!(
                    (real - fixed).abs() < 0.02 * real,
                    "{circuit}, {lights}: {real}, {fixed}"
                );
            }
        }
    }
    let report = verify(
        &small("{ uncompute: auto }", "auto"),
        &VerifyOptions::default(),
    );
    let report = report.unwrap();
    assert!(report.holds(), "{report:?}");
}

/// Primary hits that are searched for among the numbers of faces, which tables hold.
#[test]
fn searches_over_the_numbers_of_faces_find_discs() {
    let scene = small("{ uncompute: keep }", "auto");
    let picture = |visibility| {
        let options = RenderOptions {
            seed: 3,
            model: Some(Model::Fixed),
            visibility,
            estimator: Some(Estimator::Exact),
            ..RenderOptions::default()
        };
        render(&scene, &options).unwrap().image.pixels
    };
    let all = picture(Visibility::Exhaustive);
    let (failure, guess) = (1e-12, Guess::Coherent);
    assert_eq!(all, picture(Visibility::Grover { failure, guess }));
    // A table rounds differently from a constant, which may matter at edges.
    let traced = picture(Visibility::Classical);
    let pairs = all[0].iter().zip(traced[0]);
    for (all, traced) in pairs {
        assert!((all / traced - 1.0).abs() < 0.02, "{all} {traced}");
    }
}

/// A disc of each kind in the circuit: the square around it takes two edge tests, the circle two squares
/// more, and no product with a constant where the plane is axis-aligned.
#[test]
fn the_circle_is_exact_and_no_polygon() {
    let scene = small("{ uncompute: keep }", "none");
    let stage = Stage::<3>::rgb(&scene, PixelClass::MayMeetLamp);
    let geometry = stage.geometry();
    let discs: Vec<_> = geometry
        .faces
        .iter()
        .filter_map(|face| face.disc.as_ref())
        .collect();
    assert_eq!(discs.len(), 3);
    let level = discs.iter().filter(|disc| disc.scale[0] == disc.scale[1]);
    for disc in level {
        assert!(disc.scale[0].log2().fract() == 0.0, "{disc:?}");
    }
    for face in &geometry.faces {
        assert_eq!(face.edge_tests.len(), 2);
    }
}
