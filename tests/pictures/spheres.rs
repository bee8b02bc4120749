//! Spheres, skies and lenses against closed forms, in floating point and as circuits.

use crate::common::scene::written;
use qrt::prelude::*;

/// A scene of `geometry` and other `blocks`, seen by parallel rays that fall on the square of one unit
/// around (0, 0, 0) from above.
fn from_above(geometry: &str, blocks: &str) -> ValidScene {
    let text = format!(
        "name: test
camera: {{ orthographic: {{ eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], height: 1 }} }}
film: {{ width: 1, height: 1 }}
materials:
  white: {{ lambertian: {{ albedo: 1 }} }}
  grey: {{ lambertian: {{ albedo: 0.5 }} }}
  mirror: {{ mirror: {{ reflectance: 1 }} }}
  glass: {{ dielectric: {{ ior: 1.5 }} }}
  coloured: {{ dielectric: {{ ior: 1.5, transmittance: [0.5, 0.8, 1] }} }}
  air: {{ dielectric: {{ ior: 1, transmittance: [0.5, 0.8, 1] }} }}
  lamp: {{ emitter: {{ radiance: [4, 2, 1] }} }}
geometry:
{geometry}
{blocks}"
    );
    written(&text, &[])
}

/// The exact mean of a model's pixels.
pub(crate) fn seen(scene: &ValidScene, model: Model) -> Vec<[f64; 3]> {
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    let rendered = render(scene, &options).unwrap();
    rendered.image.pixels
}

fn depths(rays: usize, more: &str) -> String {
    let rest = format!(", {{ bits: [10, 10]{more} }}").repeat(rays - 1);
    format!("[{{ bits: [10, 10] }}{rest}]")
}

#[test]
fn a_convex_white_thing_under_a_white_sky_cannot_be_seen() {
    for (material, rays) in [("white", 2), ("mirror", 2), ("glass", 12)] {
        let geometry =
            format!("  - sphere: {{ center: [0.1, 0, 0.2], radius: 1, material: {material} }}");
        let sampling = format!(
            "sampling: {{ path_bits: 12, lights: none, depths: {} }}",
            depths(rays, "")
        );
        let scene = from_above(&geometry, &format!("sky: {{ radiance: 1 }}\n{sampling}"));
        for pixel in seen(&scene, Model::Real) {
            // Of glass, a thousandth of the paths is still inside after twelve rays.
            let allowed = if material == "glass" { 1e-3 } else { 1e-9 };
            assert!(
                pixel.iter().all(|c| (c - 1.0).abs() < allowed),
                "{material}: {pixel:?}"
            );
        }
    }
}

#[test]
fn a_gradient_is_linear_above_the_horizon_and_constant_below() {
    // Each pixel of this narrow view has one direction, up to its width.
    let text = |target: [f64; 3]| {
        format!(
            "name: sky
camera: {{ perspective: {{ eye: [0, 0, 0], target: {target:?}, up: [1, 0, 0], vfov: 0.001 }} }}
film: {{ width: 1, height: 1 }}
sky: {{ horizon: [1, 0.5, 0.25], zenith: [0.5, 1, 0.25], up: [0, 2, 0] }}
materials: {{}}
geometry: []
sampling: {{ path_bits: 2, depths: [{{ bits: [2, 2] }}] }}"
        )
    };
    for (target, height) in [
        ([0.0, 1.0, 0.0], 1.0),
        ([0.0, 3.0, 4.0], 0.6),
        ([0.0, 0.0, 1.0], 0.0),
        ([0.0, -3.0, 4.0], 0.0),
    ] {
        let scene = written(&text(target), &[]);
        let expected = [1.0 - 0.5 * height, 0.5 + 0.5 * height, 0.25];
        for (model, allowed) in [(Model::Real, 2e-5), (Model::Fixed, 1e-3)] {
            let pixel = seen(&scene, model)[0];
            let close = pixel
                .iter()
                .zip(expected)
                .all(|(c, e)| (c - e).abs() < allowed);
            assert!(close, "{target:?}: {pixel:?}, not {expected:?}");
        }
    }
}

/// A sphere of radius R at the height h above a point of a floor gives the irradiance `pi L (R / h)^2`
/// there. The mean over the square of side a around it is lower by `3 a^2 / (4 h^2)` of that, up to
/// the fourth power.
#[test]
fn a_spherical_lamp_lights_a_floor_by_the_cosine_law() {
    let geometry =
        "  - quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: grey }
  - sphere: { center: [0, 10, 0], radius: 2, material: lamp }";
    let camera_below = |lights: &str| {
        let light = if lights == "none" {
            ""
        } else {
            ", light: [10, 10]"
        };
        let sampling = format!(
            "sampling: {{ path_bits: 16, lights: {lights}, depths: {} }}",
            depths(2, light)
        );
        // The camera is between the floor and the lamp.
        let scene = from_above(geometry, &sampling);
        let mut changed = scene.scene().clone();
        if let qrt::scene::Camera::Orthographic(camera) = &mut changed.camera {
            camera.eye.y = 1.0;
        }
        changed.validate("".as_ref()).unwrap()
    };
    let expected = 0.5 * (2.0_f64 / 10.0).powi(2) * (1.0 - 2.0 * (1.0 / 12.0) * 2.0 / 100.0);
    for lights in ["none", "mis", "auto", "next-event"] {
        let scene = camera_below(lights);
        let real = seen(&scene, Model::Real)[0];
        for (channel, radiance) in real.iter().zip([4.0, 2.0, 1.0]) {
            let error = channel / (radiance * expected) - 1.0;
            // Rays alone find the lamp by chance; sampled points are smooth.
            let allowed = if lights == "none" { 0.02 } else { 2e-3 };
            assert!(error.abs() < allowed, "{lights}: {real:?}, off by {error}");
        }
        let fixed = seen(&scene, Model::Fixed)[0];
        for (real, fixed) in real.iter().zip(fixed) {
            assert!(
                (fixed / real - 1.0).abs() < 0.02,
                "{lights}: {real} and {fixed}"
            );
        }
    }
}

/// Points of the sharp plane are seen from all points of the lens alike.
#[test]
fn a_lens_leaves_the_sharp_plane_as_a_pinhole_shows_it() {
    let scene = |lens: &str| {
        let text = format!(
            "name: sharp
camera: {{ perspective: {{ eye: [0, 0, 4], target: [0, 0, 0], vfov: 30{lens} }} }}
film: {{ width: 6, height: 4 }}
sky: {{ radiance: 1 }}
materials: {{ dark: {{ lambertian: {{ albedo: 0 }} }} }}
geometry:
  - triangle: {{ vertices: [[-1, -0.8, 0], [1.1, -0.3, 0], [0.2, 0.9, 0]], material: dark }}
sampling: {{ path_bits: 12, depths: [{{ bits: [8, 8] }}] }}"
        );
        seen(&written(&text, &[]), Model::Real)
    };
    let pinhole = scene("");
    let sharp = scene(", lens: { aperture: 0.4, focus: 4 }");
    let blurred = scene(", lens: { aperture: 0.4, focus: 2 }");
    let apart = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max)
    };
    // A path on an edge may fall on either side.
    assert!(
        apart(&pinhole, &sharp) <= 2.0 / 4096.0,
        "{pinhole:?} {sharp:?}"
    );
    assert!(apart(&pinhole, &blurred) > 0.05, "{pinhole:?} {blurred:?}");
}

/// Scenes with every relation of spheres: the integers stay near floating point, and the gates compute
/// the integers bit for bit (which the machine of gates checks with every qubit that it borrows).
#[test]
fn circuits_of_spheres_compute_what_floating_point_does() {
    let floor = "  - quad: { vertices: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: grey }\n";
    let ball = |center: [f64; 3], radius: f64, material: &str| {
        format!("  - sphere: {{ center: {center:?}, radius: {radius}, material: {material} }}\n")
    };
    let overlapping = ball([0.0, 0.5, 0.0], 0.6, "grey") + &ball([0.4, 0.5, 0.2], 0.5, "mirror");
    let nested = ball([0.0, 1.0, 0.0], 0.9, "glass") + &ball([0.1, 1.0, 0.0], 0.4, "grey");
    let cut = ball([0.0, 0.1, 0.0], 0.6, "glass") + &ball([-0.9, 0.0, 0.3], 0.4, "grey");
    let around = ball([0.0, 1.0, 0.0], 12.0, "grey") + &ball([0.2, 0.5, 0.0], 0.5, "mirror");
    let lit = ball([0.3, 2.5, 0.2], 0.4, "lamp") + &ball([-0.2, 0.5, 0.0], 0.5, "grey");
    for (name, spheres, light) in [
        ("overlapping", overlapping, ""),
        ("nested", nested, ""),
        ("cut", cut, ""),
        ("around", around, ""),
        ("lit", lit, ", light: [6, 6]"),
    ] {
        let rays = depths(3, light).replace("10", "6");
        let sampling = format!("sampling: {{ path_bits: 10, depths: {rays} }}");
        let sky = if light.is_empty() {
            "sky: { radiance: 1 }\n"
        } else {
            ""
        };
        for circuit in ["keep", "scoped"] {
            let blocks = format!("{sky}{sampling}\ncircuit: {{ uncompute: {circuit} }}");
            let scene = from_above(&(floor.to_owned() + &spheres), &blocks);
            let [real, fixed, gates] =
                [Model::Real, Model::Fixed, Model::Gates].map(|model| seen(&scene, model)[0]);
            assert_eq!(fixed, gates, "{name}");
            for (real, fixed) in real.iter().zip(fixed) {
                assert!(
                    (real - fixed).abs() < 0.01 * real.max(0.05),
                    "{name}: {real}, {fixed}"
                );
            }
        }
    }
}

/// A plate under a sky of radiance 1, seen along its normal: with r of one face, what the eye sees is
/// `r + (1 - r) t^2`, since the parts that are reflected within add up to a geometric series.
#[test]
fn coloured_glass_keeps_its_share_at_each_crossing() {
    let reflected: f64 = 0.04;
    let through = [0.5, 0.8, 1.0];
    let plate = "  - box: { min: [-2, -1, -2], max: [2, 0, 2], material: coloured }";
    let ball = "  - sphere: { center: [0, 0, 0], radius: 1, material: air }";
    for (geometry, reflected) in [(plate, reflected), (ball, 0.0)] {
        let blocks = format!(
            "sky: {{ radiance: 1 }}\nsampling: {{ path_bits: 13, depths: {} }}",
            depths(6, "").replace("10", "13")
        );
        let scene = from_above(geometry, &blocks);
        for model in [Model::Real, Model::Fixed] {
            let pixel = seen(&scene, model)[0];
            for (seen, through) in pixel.iter().zip(through) {
                let expected = reflected + (1.0 - reflected) * through * through;
                assert!(
                    (seen - expected).abs() < 2e-3,
                    "{model:?}: {pixel:?}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn a_box_is_its_six_quads() {
    let sampling = format!(
        "sky: {{ radiance: 1 }}\nsampling: {{ path_bits: 8, depths: {} }}",
        depths(3, "")
    );
    let of_box = "  - box: { min: [-0.25, -0.5, -0.125], max: [0.25, 0.5, 0.375], material: grey }";
    let corner = |bits: usize| {
        [("-0.25", "0.25"), ("-0.5", "0.5"), ("-0.125", "0.375")]
            .iter()
            .enumerate()
            .map(|(axis, (low, high))| if bits >> axis & 1 == 1 { *high } else { *low })
            .collect::<Vec<_>>()
            .join(", ")
    };
    let outlines = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let quads = outlines.map(|outline| {
        let points = outline.map(|bits| format!("[{}]", corner(bits)));
        format!(
            "  - quad: {{ vertices: [{}], material: grey }}",
            points.join(", ")
        )
    });
    let quads = quads.join("\n");
    let [one, six] = [of_box, &quads].map(|geometry| from_above(geometry, &sampling));
    assert_eq!(one.polygons(), six.polygons());
    // The front of each face is outside.
    for face in one.polygons() {
        let [a, b, c, _] = face.vertices;
        let middle = qrt::glam::DVec3::new(0.0, 0.0, 0.125);
        assert!((b - a).cross(c - a).dot(a - middle) > 0.0);
    }
    assert_eq!(seen(&one, Model::Fixed), seen(&six, Model::Fixed));
}
