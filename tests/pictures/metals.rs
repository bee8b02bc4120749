//! Metal against closed forms and quadrature, in floating point and as circuits.

use crate::common::scene::written;
use qrt::prelude::*;
use std::f64::consts::PI;

/// A large plate of `material` under a sky of radiance 1, seen by parallel rays whose cosine to the normal is `cos`.
fn plate(material: &str, cos: f64) -> ValidScene {
    let sin = (1.0 - cos * cos).sqrt();
    let text = format!(
        "name: plate
camera: {{ orthographic: {{ eye: [{}, {}, 0], target: [0, 0, 0], up: [0, 0, 1], height: 0.1 }} }}
film: {{ width: 1, height: 1 }}
sky: {{ radiance: 1 }}
materials: {{ m: {material} }}
geometry:
  - quad: {{ vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: m }}
sampling: {{ path_bits: 14, depths: [{{ bits: [0, 0] }}, {{ bits: [12, 12] }}], lights: none }}",
        4.0 * sin,
        4.0 * cos
    );
    written(&text, &[])
}

/// The exact mean of a model's only pixel.
fn seen(scene: &ValidScene, model: Model) -> [f64; 3] {
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    render(scene, &options).unwrap().image.pixels[0]
}

fn schlick(along: f64, cos: f64) -> f64 {
    along + (1.0 - along) * (1.0 - cos).powi(5)
}

const GOLD: [f64; 3] = [0.95, 0.65, 0.1];

#[test]
fn smooth_metal_reflects_by_schlicks_formula() {
    for cos in [1.0, 0.8, 0.5, 0.2] {
        let scene = plate("{ metal: { reflectance: [0.95, 0.65, 0.1] } }", cos);
        for (model, allowed) in [(Model::Real, 1e-9), (Model::Fixed, 1e-3)] {
            let pixel = seen(&scene, model);
            for (found, along) in pixel.iter().zip(GOLD) {
                let expected = schlick(along, cos);
                assert!(
                    (found - expected).abs() < allowed,
                    "{model:?}, {cos}: {pixel:?}, not {expected}"
                );
            }
        }
    }
}

/// The share of a white sky that a rough plate reflects, by quadrature of the BSDF over the hemisphere.
fn albedo(along: f64, alpha: f64, cos: f64) -> f64 {
    let squared = alpha * alpha;
    let g1 = |cos: f64| 2.0 * cos / (cos + (squared + (1.0 - squared) * cos * cos).sqrt());
    let outgoing = [(1.0 - cos * cos).sqrt(), 0.0, cos];
    let steps = 600;
    let mut sum = 0.0;
    for row in 0..steps {
        let z = (f64::from(row) + 0.5) / f64::from(steps);
        let radius = (1.0 - z * z).sqrt();
        for column in 0..steps {
            let angle = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(steps);
            let incoming = [radius * angle.cos(), radius * angle.sin(), z];
            let half = [0, 1, 2].map(|axis| incoming[axis] + outgoing[axis]);
            let length = half.iter().map(|c| c * c).sum::<f64>().sqrt();
            let cos_h = half[2] / length;
            let cos_d = [0, 1, 2]
                .map(|axis| half[axis] * outgoing[axis])
                .iter()
                .sum::<f64>()
                / length;
            let d = squared / (PI * (cos_h * cos_h * (squared - 1.0) + 1.0).powi(2));
            let f = schlick(along, cos_d) * d * g1(z) * g1(cos) / (4.0 * z * cos);
            sum += f * z;
        }
    }
    sum * 2.0 * PI / f64::from(steps * steps)
}

#[test]
fn rough_metal_reflects_its_integral() {
    for (alpha, cos) in [(0.5, 0.9), (0.5, 0.3), (1.0, 0.6), (0.3, 0.5)] {
        let material = format!("{{ metal: {{ reflectance: [0.95, 0.65, 0.1], alpha: {alpha} }} }}");
        let scene = plate(&material, cos);
        for (model, allowed) in [(Model::Real, 1e-3), (Model::Fixed, 3e-3)] {
            let pixel = seen(&scene, model);
            for (found, along) in pixel.iter().zip(GOLD) {
                let expected = albedo(along, alpha, cos);
                assert!(
                    (found - expected).abs() < allowed,
                    "{model:?}, alpha {alpha}, cosine {cos}: {pixel:?}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn white_metal_is_a_white_mirror_or_ggx() {
    for cos in [0.9, 0.4] {
        for (metal, other) in [
            (
                "{ metal: { reflectance: 1 } }",
                "{ mirror: { reflectance: 1 } }",
            ),
            (
                "{ metal: { reflectance: 1, alpha: 0.3 } }",
                "{ ggx: { reflectance: 1, alpha: 0.3 } }",
            ),
        ] {
            let [metal, other] = [metal, other].map(|m| seen(&plate(m, cos), Model::Real));
            for (metal, other) in metal.iter().zip(other) {
                assert!((metal - other).abs() < 1e-12, "{metal} and {other}");
            }
        }
    }
}
