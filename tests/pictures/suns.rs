//! Suns against closed forms, in floating point and as circuits.
//!
//! A plane whose normal makes the angle `t` with the axis of a cone of half angle `a`, all of it above the
//! plane, receives the irradiance `pi L sin(a)^2 cos(t)`. So a matte plane of albedo `rho` shows
//! `rho L sin(a)^2 cos(t)`.

use super::spheres::seen;
use crate::common::scene::written;
use glam::DVec3;
use qrt::lab::verify::{VerifyOptions, verify};
use qrt::prelude::*;
use qrt::tracer::{PixelClass, PixelClasses, Stage};
use std::fmt::Write as _;

/// The radiance of the sun, by channel, in units of the red one.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

fn sun(direction: [f64; 3], angle: f64, radiance: f64) -> String {
    let radiance = PARTS.map(|part| part * radiance);
    format!("sun: {{ direction: {direction:?}, angle: {angle:?}, radiance: {radiance:?} }}\n")
}

/// The direction at the angle `zenith` in degrees from [0, 1, 0], of no particular length.
fn towards(zenith: f64) -> [f64; 3] {
    let (sin, cos) = zenith.to_radians().sin_cos();
    [0.6 * sin, cos, 0.8 * sin].map(|part| 1.7 * part)
}

/// A scene that is seen by parallel rays, which fall on the square of side `height` around the origin from the
/// height `eye`.
fn from_above(eye: f64, height: f64, blocks: &str) -> ValidScene {
    let text = format!(
        "name: test
camera: {{ orthographic: {{ eye: [0, {eye}, 0], target: [0, -1, 0], up: [0, 0, -1], height: {height} }} }}
film: {{ width: 1, height: 1 }}
materials:
  grey: {{ lambertian: {{ albedo: 0.5 }} }}
  shiny: {{ mirror: {{ reflectance: 0.5 }} }}
  lamp: {{ emitter: {{ radiance: [4, 2, 1] }} }}
{blocks}"
    );
    written(&text, &[])
}

const FLOOR: &str =
    "  - quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: grey }\n";

/// A level disc.
fn disc(center: [f64; 3], radius: f64) -> String {
    format!(
        "  - disc: {{ center: {center:?}, normal: [0, 1, 0], radius: {radius}, material: grey }}\n"
    )
}

fn lit(lights: &str, path_bits: u32) -> String {
    let light = if lights == "none" {
        ""
    } else {
        ", light: [10, 10]"
    };
    format!(
        "sampling: {{ path_bits: {path_bits}, lights: {lights}, depths: [{{ bits: [10, 10] }}, {{ bits: [10, 10]{light} }}] }}\n"
    )
}

/// Asserts that each channel is `expected` times its part of the radiance.
fn near(what: &str, pixel: [f64; 3], expected: f64, allowed: f64) {
    for (channel, part) in pixel.iter().zip(PARTS) {
        let error = channel / (part * expected) - 1.0;
        assert!(error.abs() < allowed, "{what}: {pixel:?}, off by {error}");
    }
}

/// Asserts that both machines see `expected` in a scene.
fn shows(what: &str, scene: &ValidScene, expected: f64, allowed: [f64; 2]) {
    for (model, allowed) in [Model::Real, Model::Fixed].into_iter().zip(allowed) {
        near(
            &format!("{what}, {model:?}"),
            seen(scene, model)[0],
            expected,
            allowed,
        );
    }
}

/// The fraction of its radiance that a sun adds to a white surface: see the head of the file.
fn share(angle: f64, zenith: f64) -> f64 {
    let half = (0.5 * angle).to_radians();
    half.sin().powi(2) * zenith.to_radians().cos()
}

#[test]
fn a_floor_shows_the_irradiance_of_a_sun() {
    for (angle, zenith) in [
        (0.53, 0.0),
        (0.53, 40.0),
        (0.01, 60.0),
        (5.0, 85.0),
        (60.0, 30.0),
        (120.0, 25.0),
        (179.0, 0.0),
    ] {
        let expected = 0.5 * 1e5 * share(angle, zenith);
        for lights in ["none", "auto", "mis", "next-event"] {
            // A small sun is met too rarely.
            if lights == "none" && angle < 60.0 {
                continue;
            }
            let blocks = [
                sun(towards(zenith), angle, 1e5),
                format!("geometry:\n{FLOOR}"),
                lit(lights, 14),
            ];
            let scene = from_above(0.25, 0.01, &blocks.concat());
            let what = format!("{angle}, {zenith}, {lights}");
            let allowed = match lights {
                "none" => [0.02, 0.03],
                _ => [4e-3, 0.01],
            };
            shows(&what, &scene, expected, allowed);
        }
    }
}

/// A sun that is partly below the horizon, by points and by chance.
#[test]
fn a_setting_sun_lights_alike_in_every_way() {
    let of = |lights| {
        let blocks = [
            sun(towards(80.0), 60.0, 3.0),
            format!("geometry:\n{FLOOR}"),
            lit(lights, 16),
        ];
        from_above(0.25, 0.01, &blocks.concat())
    };
    let truth = seen(&of("none"), Model::Real)[0][0];
    assert!(truth > 0.05, "{truth}");
    for lights in ["mis", "auto", "next-event"] {
        shows(lights, &of(lights), truth, [0.01, 0.02]);
    }
}

/// The edge of a roof runs through the zenith of the middle of the floor, and so halves the sun there. Both sides
/// of the edge are in the umbra or in the light.
#[test]
fn a_roof_halves_the_sun_below_its_edge() {
    let angle = 10.0;
    // The penumbra ends 0.5 tan(5 degrees) = 0.044 to either side.
    let roof = |edge: f64| {
        format!(
            "  - quad: {{ vertices: [[{edge}, 0.5, 1], [1, 0.5, 1], [1, 0.5, -1], [{edge}, 0.5, -1]], material: grey }}\n"
        )
    };
    let whole = 0.5 * 4.0 * share(angle, 0.0);
    // Of one quad, and of many, which a hierarchy of boxes holds.
    let strips = |edge: f64| -> String {
        let strip = |k: usize| {
            let [z, next] = [k, k + 1].map(|k| -1.0 + 2.0 * k as f64 / 100.0);
            format!(
                "  - quad: {{ vertices: [[{edge}, 0.5, {next}], [1, 0.5, {next}], [1, 0.5, {z}], [{edge}, 0.5, {z}]], material: grey }}\n"
            )
        };
        (0..100).map(strip).collect()
    };
    // Beside a hundred small faces, a large one is tested before the hierarchy.
    let crowd: String = (0..100)
        .map(|k| {
            let x = 0.5 + k as f64 / 250.0;
            disc([x, 0.1, 0.9], 0.001)
        })
        .collect();
    for (edge, part) in [(0.0, 0.5), (-0.1, 0.0), (0.1, 1.0)] {
        for lights in ["none", "auto", "mis", "next-event"] {
            for (what, roof) in [
                ("roof", roof(edge)),
                ("strips", strips(edge)),
                ("large", roof(edge) + &crowd),
            ] {
                let blocks = [
                    sun([0.0, 1.0, 0.0], angle, 4.0),
                    format!("geometry:\n{FLOOR}{roof}"),
                    lit(lights, if lights == "none" { 19 } else { 14 }),
                ];
                let scene = from_above(0.25, 1e-4, &blocks.concat());
                let what = format!("{what}, {edge}, {lights}");
                let real = seen(&scene, Model::Real)[0];
                if part == 0.0 {
                    assert_eq!(real, [0.0; 3], "{what}");
                } else {
                    let allowed = if lights == "none" { 0.08 } else { 0.01 };
                    near(&what, real, whole * part, allowed);
                }
                if what.starts_with("roof") && lights != "none" {
                    let fixed = seen(&scene, Model::Fixed)[0];
                    let off = (fixed[0] - whole * part).abs();
                    assert!(off < 0.02 * whole, "{what}: {fixed:?}");
                }
            }
        }
    }
}

/// The walls of a room are the outermost faces of a scene: no ray between its points crosses them, but rays to the
/// sun do. Light comes in through a window in the ceiling, past a box that hangs from it.
#[test]
fn a_room_is_dark_except_below_its_window() {
    let walls =
        "  - quad: { vertices: [[-1, 0, -1], [1, 0, -1], [1, 1, -1], [-1, 1, -1]], material: grey }
  - quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 1, 1], [-1, 1, 1]], material: grey }
  - quad: { vertices: [[-1, 0, -1], [-1, 0, 1], [-1, 1, 1], [-1, 1, -1]], material: grey }
  - quad: { vertices: [[1, 0, -1], [1, 0, 1], [1, 1, 1], [1, 1, -1]], material: grey }\n";
    let ceiling = |low: f64| {
        format!(
            "  - quad: {{ vertices: [[{low}, 1, -1], [1, 1, -1], [1, 1, 1], [{low}, 1, 1]], material: grey }}\n"
        )
    };
    let hanging = "  - box: { min: [-0.5, 0.5, -0.25], max: [-0.25, 1, 0.25], material: grey }\n";
    let steep = [-0.5, 1.0, 0.0];
    let flat = [-2.0, 1.0, 0.0];
    let expected = |angle: f64| 0.5 * 4.0 * share(2.0, angle.atan().to_degrees());
    for (what, direction, geometry, expected) in [
        ("closed", flat, ceiling(-1.0), 0.0),
        ("behind a wall", flat, ceiling(-0.2), 0.0),
        ("below a window", steep, ceiling(-0.2), expected(0.5)),
        ("beside a window", steep, ceiling(-0.7), 0.0),
        ("no wall", flat, String::new(), expected(2.0)),
    ] {
        let walls = if what == "no wall" { "" } else { walls };
        for lights in ["auto", "mis"] {
            for hanging in ["", hanging] {
                // The box hangs in the way of steep light alone.
                let is_blocked = !hanging.is_empty() && direction == steep;
                let expected = if is_blocked { 0.0 } else { expected };
                let blocks = [
                    sun(direction, 2.0, 4.0),
                    format!("geometry:\n{FLOOR}{walls}{geometry}{hanging}"),
                    lit(lights, 12),
                ];
                let scene = from_above(0.25, 1e-3, &blocks.concat());
                let what = format!("{what}, {lights}, {}", hanging.len());
                if expected == 0.0 {
                    for model in [Model::Real, Model::Fixed] {
                        assert_eq!(seen(&scene, model), [[0.0; 3]], "{what}, {model:?}");
                    }
                } else {
                    shows(&what, &scene, expected, [5e-3, 0.01]);
                }
            }
        }
    }
}

/// A camera that looks into the sun, directly or by a mirror, sees its radiance before that of the sky.
#[test]
fn cameras_and_mirrors_show_the_disc() {
    let mirror = "geometry:\n  - quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: shiny }\n";
    let depths = "sampling: { path_bits: 8, depths: [{ bits: [4, 4] }, { bits: [4, 4] }] }\n";
    for (what, direction, expected) in [
        ("in the sun", [0.003, 1.0, 0.001], 0.5 * (1.0 + 8.0)),
        ("beside", [0.01, 1.0, 0.0], 0.5),
        ("below", [0.0, -1.0, 0.0], 0.5),
    ] {
        let blocks = [
            &sun(direction, 0.53, 8.0),
            "sky: { radiance: 1 }\n",
            mirror,
            depths,
        ];
        let scene = from_above(0.5, 0.1, &blocks.concat());
        for model in [Model::Real, Model::Fixed] {
            let red = seen(&scene, model)[0][0];
            let error = red / expected - 1.0;
            assert!(error.abs() < 4e-3, "{what}, {model:?}: {red}");
        }
    }
}

/// The disc covers `pi tan(a)^2` of the plane at the distance 1 from a pinhole.
#[test]
fn the_disc_has_its_angular_size() {
    for (angle, vfov) in [(0.53, 1.0), (10.0, 20.0), (60.0, 80.0), (100.0, 140.0)] {
        let tan = |degrees: f64| (0.5 * degrees).to_radians().tan();
        let covered = std::f64::consts::PI * (tan(angle) / (2.0 * tan(vfov))).powi(2);
        let text = format!(
            "name: test
camera: {{ perspective: {{ eye: [0, 0, 0], target: [1, 2, 2], vfov: {vfov} }} }}
film: {{ width: 1, height: 1 }}
{}geometry: []
sampling: {{ path_bits: 14, depths: [{{ bits: [14, 14] }}] }}
precision: {{ fraction: 20 }}",
            sun([2.0, 4.0, 4.0], angle, 3.0)
        );
        shows(
            &format!("{angle}"),
            &written(&text, &[]),
            3.0 * covered,
            [3e-3, 0.01],
        );
    }
}

/// A lamp beside the sun, whose factors are ten thousand times as large.
#[test]
fn a_sun_and_a_lamp_add_up() {
    let lamp = "  - quad: { vertices: [[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], material: lamp }\n";
    let sunlight = sun(towards(60.0), 0.53, 1e5);
    for lights in ["auto", "mis", "next-event"] {
        let of = |blocks: String| from_above(0.25, 0.01, &(blocks + &lit(lights, 15)));
        let lamp_alone = seen(&of(format!("geometry:\n{FLOOR}{lamp}")), Model::Real)[0][0];
        let both = of(format!("{sunlight}geometry:\n{FLOOR}{lamp}"));
        let expected = lamp_alone + 0.5 * 1e5 * share(0.53, 60.0);
        for model in [Model::Real, Model::Fixed] {
            let red = seen(&both, model)[0][0];
            assert!(
                (red / expected - 1.0).abs() < 0.01,
                "{lights}, {model:?}: {red}, {expected}"
            );
        }
    }
}

/// Angles, radiances, units and places at the ends of what a scene may say.
#[test]
fn extremes_hold() {
    for (angle, radiance, unit, away) in [
        (0.001, 1e12, 1.0, 0.0),
        (0.001, 1e-12, 1.0, 0.0),
        (179.9, 1e12, 1.0, 0.0),
        (0.53, 1e5, 1e-6, 0.0),
        (0.53, 1e5, 1e9, 0.0),
        (0.53, 1e5, 1.0, 1e9),
    ] {
        let at = |x: f64| away + unit * x;
        let (x, high, low, left, right) = (at(0.0), at(0.25), at(-1.0), at(-1.0), at(1.0));
        let height = 0.01 * unit;
        let text = format!(
            "name: far
camera: {{ orthographic: {{ eye: [{x:?}, {high:?}, {x:?}], target: [{x:?}, {low:?}, {x:?}], up: [0, 0, -1], height: {height:?} }} }}
film: {{ width: 1, height: 1 }}
materials: {{ grey: {{ lambertian: {{ albedo: 0.5 }} }} }}
{}geometry:
  - quad: {{ vertices: [[{left:?}, {x:?}, {right:?}], [{right:?}, {x:?}, {right:?}], [{right:?}, {x:?}, {left:?}], [{left:?}, {x:?}, {left:?}]], material: grey }}
{}",
            sun([0.0, 1e-9, 0.0], angle, radiance),
            lit("auto", 12)
        );
        let expected = 0.5 * radiance * share(angle, 0.0);
        shows(
            &format!("{angle}, {radiance}, {unit}, {away}"),
            &written(&text, &[]),
            expected,
            [4e-3, 0.01],
        );
    }
    // A sun below the floor lights nothing.
    let blocks = [
        sun([0.0, -1.0, 0.0], 0.53, 1e5),
        format!("geometry:\n{FLOOR}"),
        lit("auto", 8),
    ];
    let scene = from_above(0.25, 0.01, &blocks.concat());
    for model in [Model::Real, Model::Fixed] {
        assert_eq!(seen(&scene, model), [[0.0; 3]]);
    }
}

/// A small scene with a sun, and with a `lamp` or without.
fn small(circuit: &str, lights: &str, lamp: bool) -> ValidScene {
    let mut geometry = String::from(FLOOR);
    let _ = write!(
        geometry,
        "  - box: {{ min: [-0.5, 0, -0.5], max: [-0.2, 0.4, 0.1], material: grey }}
  - sphere: {{ center: [0.4, 0.3, 0.2], radius: 0.25, material: grey }}
  - quad: {{ vertices: [[0, 0.2, -0.6], [0.4, 0.2, -0.6], [0.4, 0.7, -0.8], [0, 0.7, -0.8]], material: shiny }}
"
    );
    if lamp {
        geometry += "  - quad: { vertices: [[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], material: lamp }\n";
    }
    let light = if lights == "none" {
        ""
    } else {
        ", light: [5, 5]"
    };
    let blocks = format!(
        "{}geometry:\n{geometry}sampling: {{ path_bits: 10, lights: {lights}, depths: [{{ bits: [6, 6] }}, {{ bits: [5, 5]{light} }}, {{ bits: [5, 5]{light} }}] }}
circuit: {circuit}
precision: {{ fraction: 16 }}",
        sun([1.0, 2.0, 1.5], 30.0, 4.0)
    );
    from_above(0.9, 1.8, &blocks)
}

#[test]
fn circuits_of_suns_compute_what_floating_point_does() {
    for circuit in [
        "{ uncompute: keep }",
        "{ uncompute: scoped }",
        "{ nearest: paper }",
    ] {
        for (lights, lamp) in [("none", false), ("auto", false), ("mis", true)] {
            let scene = small(circuit, lights, lamp);
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
    for lamp in [false, true] {
        let scene = small("{ uncompute: auto }", "auto", lamp);
        let report = verify(&scene, &VerifyOptions::default()).unwrap();
        assert!(report.holds(), "{report:?}");
    }
}

/// The pixels that may show the sun are those whose square has a direction in the cone. Only their scale includes its
/// radiance.
#[test]
fn pixels_beside_the_sun_have_a_smaller_scale() {
    let angle = 8.0;
    let text = format!(
        "name: test
camera: {{ perspective: {{ eye: [0, 0.5, 0], target: [1, 0.5, 0], up: [0, 1, 0], vfov: 60 }} }}
film: {{ width: 24, height: 24 }}
materials: {{ grey: {{ lambertian: {{ albedo: 0.5 }} }} }}
{}geometry:
{FLOOR}{}",
        sun([5.0, 1.5, -1.0], angle, 100.0),
        lit("auto", 8)
    );
    let scene = written(&text, &[]);
    let classes = PixelClasses::new(&scene);
    let axis = DVec3::new(5.0, 1.5, -1.0).normalize();
    let half = 30.0_f64.to_radians().tan();
    // Pixels of the film's plane at x = 1, in tenths.
    let shows = |x: u32, y: u32| {
        let places = (0..=10).flat_map(|u| (0..=10).map(move |v| (u, v)));
        let direction = |(u, v): (u32, u32)| {
            let place = |pixel: u32, part: u32| (f64::from(pixel) + f64::from(part) / 10.0) / 12.0;
            let (right, down) = (place(x, u) - 1.0, place(y, v) - 1.0);
            DVec3::new(1.0, -half * down, half * right).normalize()
        };
        let limit = (0.5 * angle).to_radians().cos();
        places
            .map(direction)
            .any(|direction| direction.dot(axis) >= limit)
    };
    let (mut seen, mut classed) = (0, 0);
    for (x, y) in (0..24).flat_map(|x| (0..24).map(move |y| (x, y))) {
        let may = classes.class([x, y]) == PixelClass::MayMeetLamp;
        assert!(may || !shows(x, y), "{x}, {y}");
        seen += u32::from(shows(x, y));
        classed += u32::from(may);
    }
    // A square around the disc.
    assert!(seen > 8 && classed <= 2 * seen, "{seen}, {classed}");
    let bound = |class| Stage::<3>::rgb(&scene, class).bound()[0];
    assert_eq!(bound(PixelClass::MayMeetLamp), 100.0);
    let lit = 0.5 * 100.0 * share(angle, 0.0);
    let least = bound(PixelClass::MeetsNoLamp);
    assert!(least < lit, "{least}, {lit}");
}
