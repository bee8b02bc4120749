//! Values that read the point that is hit, against the values there, in floating point and as circuits.
//!
//! Under a sky of radiance 1 that no other face covers, a convex thing shows its own albedo, which is `pi`
//! times a value without angles.

use crate::common::scene::written;
use qrt::prelude::*;

/// The models, and the difference that their numbers allow.
const MODELS: [(Model, f64); 3] = [
    (Model::Real, 1e-9),
    (Model::Fixed, 0.01),
    (Model::Gates, 0.01),
];

const MAP: &str = "[\"sqrt(u)*cos(2*pi*v)\", \"sqrt(u)*sin(2*pi*v)\", \"sqrt(1-u)\"]";
const FLOOR: &str = "[[-2, 0.5, 2], [2, 0.5, 2], [2, 0.5, -2], [-2, 0.5, -2]]";

/// A material whose albedos are `albedos`, of each channel.
fn material(albedos: [&str; 3]) -> String {
    let values = albedos.map(|albedo| format!("\"({albedo})/pi\""));
    format!(
        "{{ bsdf: {{ map: {MAP}, value: [{}] }} }}",
        values.join(", ")
    )
}

/// The picture of 4 x 4 pixels of `rest`, seen from above by parallel rays through the square of edge 2
/// around (1, 0, 1), at the centres of the pixels.
fn picture(rest: &str, model: Model) -> Vec<[f64; 3]> {
    let text = format!(
        "name: pattern
camera: {{ orthographic: {{ eye: [1, 9, 1], target: [1, 0, 1], up: [0, 0, -1], height: 2 }} }}
film: {{ width: 4, height: 4 }}
{rest}"
    );
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    render(&written(&text, &[]), &options).unwrap().image.pixels
}

/// The places along an axis of the centres of the pixels.
fn place(pixel: usize) -> f64 {
    0.25 + 0.5 * pixel as f64
}

/// Compares the picture of `rest` in every model with the colours `expected` at (x, z).
fn shows(rest: &str, expected: impl Fn(f64, f64) -> [f64; 3]) {
    for (model, allowed) in MODELS {
        for (number, pixel) in picture(rest, model).iter().enumerate() {
            let (x, z) = (place(number % 4), place(number / 4));
            let expected = expected(x, z);
            for (value, right) in pixel.iter().zip(expected) {
                let off = (value - right).abs();
                assert!(
                    off < allowed,
                    "{model:?} at {x}, {z}: {pixel:?} for {expected:?}"
                );
            }
        }
    }
}

#[test]
fn a_floor_shows_its_values_at_the_points_that_are_hit() {
    let albedos = [
        "0.5 + 0.25*x",
        "0.3*(1 + sin(3*z))",
        "if_less(x*x + z*z, y + 1, 0.75, 0.125) + 0*u",
    ];
    let rest = format!(
        "sky: {{ radiance: 1 }}
materials: {{ floor: {} }}
geometry: [ {{ quad: {{ vertices: {FLOOR}, material: floor }} }} ]
sampling: {{ path_bits: 4, depths: [{{ bits: [0, 0] }}, {{ bits: [2, 2] }}], lights: none }}",
        material(albedos)
    );
    shows(&rest, |x, z| {
        let disc = if x * x + z * z < 1.5 { 0.75 } else { 0.125 };
        [0.5 + 0.25 * x, 0.3 * (1.0 + (3.0 * z).sin()), disc]
    });
}

/// On a sphere the point that is hit differs in all coordinates.
#[test]
fn a_sphere_shows_its_values_at_the_points_that_are_hit() {
    let rest = format!(
        "sky: {{ radiance: 1 }}
materials: {{ ball: {} }}
geometry: [ {{ sphere: {{ center: [1, 0, 1], radius: 1, material: ball }} }} ]
sampling: {{ path_bits: 4, depths: [{{ bits: [0, 0] }}, {{ bits: [2, 2] }}], lights: none }}",
        material(["0.5 + 0.5*y", "0.25*x + 0.125*z", "(x - 1)^2"])
    );
    shows(&rest, |x, z| {
        let height = 1.0 - (x - 1.0).powi(2) - (z - 1.0).powi(2);
        // Pixels at the corners of the film miss the sphere.
        if height > 0.0 {
            let rise = 0.5 * height.sqrt();
            [0.5 + rise, 0.25 * x + 0.125 * z, (x - 1.0).powi(2)]
        } else {
            [1.0; 3]
        }
    });
}

/// With lamps sampled, and with them met by chance, a pixel is to that of a plain floor as the values are.
#[test]
fn sampled_light_is_weighed_by_the_value_at_the_point() {
    let picture = |value: &str, lights: &str, model: Model| {
        let rest = format!(
            "materials:
  floor: {{ bsdf: {{ map: {MAP}, value: \"{value}\", pdf: \"cos_i/pi\" }} }}
  lamp: {{ emitter: {{ radiance: 2 }} }}
geometry:
  - quad: {{ vertices: {FLOOR}, material: floor }}
  - quad: {{ vertices: [[-1, 2, -1], [0, 2, -1], [0, 2, 0], [-1, 2, 0]], material: lamp }}
sampling:
  path_bits: 6
  depths: [{{ bits: [0, 0] }}, {{ bits: [4, 4] }}]
  lights: {lights}"
        );
        self::picture(&rest, model)
    };
    for lights in ["none", "mis", "auto"] {
        for (model, allowed) in MODELS {
            let plain = picture("0.5/pi", lights, model);
            let ramp = picture("(0.5 + 0.25*x)/pi", lights, model);
            assert!(plain.iter().any(|pixel| pixel[0] > 0.01));
            for (number, (plain, ramp)) in plain.iter().zip(&ramp).enumerate() {
                let ratio = (0.5 + 0.25 * place(number % 4)) / 0.5;
                let off = (ramp[0] - ratio * plain[0]).abs();
                assert!(
                    off < allowed,
                    "{lights} {model:?}: {ramp:?} for {ratio} of {plain:?}"
                );
            }
        }
    }
}

/// Outside of the faces, in the box around them, a value may be anything.
#[test]
fn a_value_has_to_be_right_on_its_faces_alone() {
    for (shape, albedo) in [
        (
            "disc: { center: [0, 0, 0], normal: [0, 1, 0], radius: 2",
            "1 - (x^2 + z^2)/4",
        ),
        (
            "sphere: { center: [1, 0, 0], radius: 1",
            "((x - 1)^2 + y^2 + z^2)/1.01",
        ),
        (
            "triangle: { vertices: [[0, 0, 0], [0, 0, 1], [1, 0, 0]]",
            "1 - x - z",
        ),
    ] {
        let material = material([albedo; 3]);
        let text = format!(
            "name: pattern
camera: {{ perspective: {{ eye: [0, 9, 1], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 1, height: 1 }}
sky: {{ radiance: 1 }}
materials: {{ own: {material} }}
geometry: [ {{ {shape}, material: own }} }} ]"
        );
        let picture = render(
            &written(&text, &[]),
            &RenderOptions {
                quiet: true,
                ..RenderOptions::default()
            },
        );
        assert!(picture.is_ok(), "{shape}: {:?}", picture.err());
    }
}
