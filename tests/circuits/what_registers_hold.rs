//! Tests that a formula that may be infinite within the ranges of its variables has no circuit: floating
//! point computes with infinities, but registers cannot. A condition does not help, because a circuit
//! computes both branches of `if_less`.

use crate::common::scene::written;
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::runtime::render::{self, Model};
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;
use qrt::syntax::Problem;

/// Returns a scene with the value `value` of a BSDF.
fn text(value: &str) -> String {
    format!(
        r#"
name: formula
camera: {{ perspective: {{ eye: [3, 0, 1], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 4, height: 4 }}
materials:
  cloth:
    bsdf:
      map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]
      value: "{value}"
  lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}
geometry:
  - quad: {{ vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: cloth }}
  - quad: {{ vertices: [[-1, -1, 2], [-1, 1, 2], [1, 1, 2], [1, -1, 2]], material: lamp }}
sampling: {{ path_bits: 4, depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4] }}], lights: none }}
precision: {{ fraction: 10 }}
comparator: {{ bits: 10 }}
"#
    )
}

fn scene(value: &str) -> ValidScene {
    written(&text(value), &[])
}

/// Returns the code of the error with which a circuit of this value is refused.
fn refused(value: &str) -> Option<&'static str> {
    let refused = Oracle::rgb(&scene(value), OracleOptions::default()).err();
    refused.map(|error| Problem::code(&error.problem()))
}

/// Returns the greatest difference between the pictures of the real and the fixed machine, over the scale.
fn difference(scene: &ValidScene) -> f64 {
    let [real, fixed] = [Model::Real, Model::Fixed].map(|model| {
        let options = render::RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Exact),
            ..render::RenderOptions::default()
        };
        let rendered = render::render(scene, &options).unwrap();
        rendered.counts().collect::<Vec<_>>()
    });
    let off = real.iter().zip(&fixed);
    off.map(|(a, b)| (a.value - b.value).abs() / a.scale)
        .fold(0.0, f64::max)
}

#[test]
fn a_function_that_may_be_infinite_has_no_circuit() {
    for value in [
        "max(0, 0.1 + 0.01*log(cos_o))",
        "min(0.1, 0.01*cos_o^-0.5)",
        "0.1*atan(1/cos_o)",
        "0.1*atan(cos_o^-3)",
        "0.1*exp(-0.01/cos_o)",
        "if_less(0, cos_a, 0.1*exp(3*log(cos_a)), 0)",
    ] {
        assert_eq!(refused(value), Some("QRT0610"), "{value}");
    }
}

#[test]
fn a_function_that_is_finite_has_a_circuit() {
    for value in [
        "max(0, 0.1 + 0.01*log(cos_o + 0.01))",
        "min(0.1, 0.01*(cos_o + 0.01)^-0.5)",
        "0.1*atan(1/(cos_o + 0.1))",
        "0.05*acos(cos_a)/pi",
        "0.1*exp(-20*(1 - cos_o))",
        "min(0.1, 0.05/cos_i)",
        "min(0.1, exp(500*cos_o))",
        "0.1*exp(log(cos_o))",
        "if_less(0, cos_a, 0.1*max(0, cos_a)^3, 0)",
    ] {
        assert_eq!(refused(value), None, "{value}");
        let off = difference(&scene(value));
        assert!(off < 0.02, "{value}: {off}");
    }
}

/// The wall faces the eye so exactly that rounding takes the cosine beyond 1, where `acos` is undefined.
#[test]
fn an_angle_of_a_cosine_that_rounding_takes_beyond_1_is_a_number() {
    let toward = "orthographic: { eye: [1, 1, 1], target: [0, 0, 0], height: 0.5 }";
    let wall = "[[-1, -1, 2], [1, -1, 0], [1, 1, -2], [-1, 1, 0]]";
    for value in [
        "0.05*acos(cos_o)",
        "0.1*sqrt(1 - cos_o^2)",
        "0.05*acos(cos_a)",
    ] {
        let text = text(value)
            .replace(
                "perspective: { eye: [3, 0, 1], target: [0, 0, 0], vfov: 40 }",
                toward,
            )
            .replace("[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]", wall);
        let off = difference(&written(&text, &[]));
        assert!(off < 0.02, "{value}: {off}");
    }
}
