//! Tests that a requested accuracy is kept, at the least cost, or refused.

use crate::common::scene::written;
use qrt::runtime::Prepared;
use qrt::runtime::memory::Memory;
use qrt::runtime::path_machines::Real;
use qrt::runtime::plan::{Plan, PlanOptions, plan};
use qrt::runtime::render::{self, Model};
use qrt::runtime::sample::{prefix_means, radiance, spread};
use qrt::runtime::workers::Workers;
use qrt::scene::Estimator;
use qrt::scene::meshes::Meshes;
use qrt::scene::valid::{ValidScene, validate};
use std::num::NonZeroUsize;
use std::ops::Range;

/// Returns a lamp over a floor, seen obliquely; two rays.
fn lit(accuracy: &str, more: &str) -> ValidScene {
    lit_on([16, 12], accuracy, more)
}

/// Returns the same on a film of another width and height.
fn lit_on([width, height]: [u32; 2], accuracy: &str, more: &str) -> ValidScene {
    let text = format!(
        "
name: lit
camera: {{ perspective: {{ eye: [0, 1, 2], target: [0, 0.4, 0], vfov: 60 }} }}
film: {{ width: {width}, height: {height} }}
materials:
  floor: {{ lambertian: {{ albedo: [0.8, 0.5, 0.2] }} }}
  lamp: {{ emitter: {{ radiance: [3, 2, 0] }} }}
geometry:
  - quad: {{ vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor }}
  - quad: {{ vertices: [[-1, 1.5, -1], [1, 1.5, -1], [1, 1.5, 1], [-1, 1.5, 1]], material: lamp }}
sampling: {{ {more} depths: [{{ bits: [8, 8] }}, {{ bits: [8, 8] }}], lights: none }}
accuracy: {accuracy}
"
    );
    written(&text, &[])
}

fn planned(scene: &ValidScene) -> Plan {
    plan(scene, &PlanOptions::default()).unwrap().unwrap()
}

/// Checks the promise itself, against far more paths of another seed, on the circuit's numbers.
fn the_asked_share_is_within<const N: usize>(cases: [(f64, f64, Range<u64>); N]) {
    for (error, confidence, seeds) in cases {
        let scene = lit(
            &format!("{{ error: {error}, confidence: {confidence} }}"),
            "",
        );
        let plan = planned(&scene);
        let mut parameters = plan.scene.parameters();
        parameters.sampling.path_bits = 15;
        let limit = scene.with_parameters(parameters).unwrap();
        let pixels = spread([16, 12], u64::MAX);
        let truth = prefix_means(
            &Real::new(&limit, 9).unwrap(),
            &pixels,
            &[15],
            &Workers::default(),
        )
        .unwrap();
        let mean = radiance(&truth[0]);
        assert!((plan.figures.mean / mean - 1.0).abs() < 0.01);
        let prepared = Prepared::with_plan(&scene, Some(plan.clone()), Memory::default());
        for seed in seeds {
            let options = render::RenderOptions {
                seed,
                model: Some(Model::Fixed),
                ..Default::default()
            };
            let picture = prepared.render(&options).unwrap().0;
            let values = picture.image.pixels.iter().flatten();
            let within = values
                .zip(truth[0].iter().flatten())
                .filter(|(value, truth)| (*value - *truth).abs() <= error * mean)
                .count();
            let share = within as f64 / (3 * pixels.len()) as f64;
            assert!(share >= confidence, "{error} {confidence} {seed}: {share}");
            assert_eq!(picture.plan, Some(plan.figures));
        }
    }
}

#[test]
fn the_asked_share_of_channels_is_within_the_asked_error() {
    the_asked_share_is_within([(0.2, 0.8, 0..2)]);
}

#[test]
#[ignore = "takes two minutes"]
fn so_it_is_with_other_seeds_and_errors() {
    the_asked_share_is_within([(0.2, 0.8, 2..8), (0.05, 0.95, 0..4)]);
}

#[test]
fn a_scene_without_an_accuracy_needs_no_plan() {
    let mut parameters = lit("{ error: 0.2, confidence: 0.9 }", "").parameters();
    parameters.sampling.path_bits = 5;
    let scene = lit("{ error: 0.2, confidence: 0.9 }", "")
        .with_parameters(parameters)
        .unwrap();
    assert!(plan(&scene, &PlanOptions::default()).unwrap().is_none());
}

#[test]
#[ignore = "takes half a minute: five plans"]
fn half_the_error_costs_more_and_threads_change_nothing() {
    let film = [8, 6];
    let coarse_scene = lit_on(film, "{ error: 0.2, confidence: 0.9 }", "");
    let coarse = planned(&coarse_scene);
    let fine_scene = lit_on(film, "{ error: 0.05, confidence: 0.9 }", "");
    let fine = planned(&fine_scene);
    let (a, b) = (coarse.figures, fine.figures);
    assert!(
        b.queries > 2.0 * a.queries && b.path_bits >= a.path_bits,
        "{a} {b}"
    );
    assert!(b.parts.total <= 0.05 && b.within >= 0.9);
    assert!(b.comparator_bits > a.comparator_bits);
    let one = PlanOptions {
        workers: Workers {
            threads: NonZeroUsize::new(1),
            ..Workers::default()
        },
        ..PlanOptions::default()
    };
    assert_eq!(plan(&coarse_scene, &one).unwrap().unwrap().figures, a);
    // Monte Carlo needs the square of the queries.
    let classical = PlanOptions {
        estimator: Some(Estimator::MonteCarlo),
        ..PlanOptions::default()
    };
    let classical = plan(&fine_scene, &classical).unwrap().unwrap().figures;
    assert!(classical.queries > 4.0 * b.queries, "{classical}");
    let exact = PlanOptions {
        estimator: Some(Estimator::Exact),
        ..PlanOptions::default()
    };
    let exact = plan(&fine_scene, &exact).unwrap().unwrap().figures;
    assert_eq!((exact.queries, exact.parts.counting), (0.0, 0.0));
}

#[test]
fn what_cannot_be_kept_is_refused_with_the_reason() {
    let refused = |scene: &ValidScene, words: &str| {
        let error = plan(scene, &PlanOptions::default()).unwrap_err();
        assert!(
            error.is_refusal() && error.to_string().contains(words),
            "{error}"
        );
    };
    refused(
        &lit("{ error: 0.1, confidence: 0.9999999 }", ""),
        "cannot show",
    );
    let lattice = lit(
        "{ error: 0.001, confidence: 0.95 }",
        "sequence: product-lattice,",
    );
    let mut coarse = lattice.scene().clone();
    for depth in &mut coarse.sampling.depths {
        depth.bits = [2, 1];
    }
    coarse.sampling.path_bits = 6;
    let coarse = validate(coarse, &Meshes::default()).unwrap();
    refused(&coarse, "sequence: digital-net");
}
