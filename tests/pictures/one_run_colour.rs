//! Tests of colour from one run of counting: the luminance of the estimator, and the colours of the paths
//! that it measured.

use crate::common::scene::written;
use qrt::core::oracle::{self, Oracle, luminance};
use qrt::runtime::Prepared;
use qrt::runtime::memory::Memory;
use qrt::runtime::path_machines::OracleMachine;
use qrt::runtime::render::{Colour, Model, RenderOptions, Rendered, render};
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;

/// Two lamps of different colours above a reddish floor: the paths of one pixel differ in colour.
const LAMPS: &str = "
name: lamps
camera: { perspective: { eye: [0, 1, 4], target: [0, 0, 0], vfov: 40 } }
film: { width: 3, height: 3 }
materials:
  floor: { lambertian: { albedo: [0.9, 0.4, 0.3] } }
  warm: { emitter: { radiance: [4, 2, 0.5] } }
  cold: { emitter: { radiance: [0.5, 1, 3] } }
geometry:
  - quad: { vertices: [[-4, -1, -4], [-4, -1, 4], [4, -1, 4], [4, -1, -4]], material: floor }
  - quad: { vertices: [[-3, 3, -3], [-1, 3, -3], [-1, 3, 3], [-3, 3, 3]], material: warm }
  - quad: { vertices: [[1, 3, -3], [3, 3, -3], [3, 3, 3], [1, 3, 3]], material: cold }
sampling: { path_bits: 8, depths: [{ bits: [4, 4] }, { bits: [6, 6] }], lights: none }
comparator: { bits: 8 }
counting: { phase_bits: 9 }
";

fn picture(
    scene: &ValidScene,
    model: Model,
    estimator: Estimator,
    colour: Colour,
    seed: u64,
) -> Rendered {
    let options = RenderOptions {
        seed,
        model: Some(model),
        estimator: Some(estimator),
        colour,
        ..RenderOptions::default()
    };
    render(scene, &options).unwrap()
}

/// Depths at which those lamps are sampled.
const LIT: &str = "[{ bits: [4, 4] }, { bits: [6, 6], light: [6, 6] }]";

/// The seed also sets the net's shift: the mean over seeds is that of many shifted nets.
#[test]
fn colours_are_right_on_average() {
    let lit = format!("sampling.depths={LIT}");
    for (model, seeds, sets) in [
        (Model::Real, 400_u32, &[][..]),
        (Model::Real, 400, &[&*lit, "sampling.lights=auto"]),
        (Model::Fixed, 60, &[]),
    ] {
        let scene = written(LAMPS, sets);
        let mut sum = [[0.0; 3]; 9];
        let mut square = [[0.0; 3]; 9];
        for seed in 0..u64::from(seeds) {
            let one = picture(&scene, model, Estimator::MonteCarlo, Colour::OneRun, seed);
            let exact = picture(&scene, model, Estimator::Exact, Colour::ThreeRuns, seed);
            for place in 0..9 {
                for c in 0..3 {
                    let error = one.image.pixels[place][c] - exact.image.pixels[place][c];
                    sum[place][c] += error;
                    square[place][c] += error * error;
                }
            }
        }
        let n = f64::from(seeds);
        for place in 0..9 {
            for c in 0..3 {
                let mean = sum[place][c] / n;
                let deviation = (square[place][c] / n / n).sqrt();
                // The bias is half a comparator's step, and the machine's rounding.
                let bias = 0.004 + 5.0 * deviation;
                assert!(
                    mean.abs() < bias,
                    "{model:?} {place} {c}: {mean} {deviation}"
                );
            }
        }
    }
}

#[test]
fn one_colour_of_all_paths_is_that_of_the_pixel() {
    let wall = "
name: wall
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 2, height: 1 }
materials: { wall: { emitter: { radiance: [2, 1, 0.25] } } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: wall }
sampling: { path_bits: 5 }
";
    let scene = written(wall, &[]);
    for &estimator in Estimator::ALL {
        if [Estimator::Exact, Estimator::PhaseMean].contains(&estimator) {
            continue;
        }
        let rendered = picture(&scene, Model::Real, estimator, Colour::OneRun, 0);
        for [r, g, b] in &rendered.image.pixels {
            assert!(*g > 0.9 && *g <= 1.1, "{estimator}: {g}");
            assert!((r - 2.0 * g).abs() < 1e-12 && (b - 0.25 * g).abs() < 1e-12);
        }
    }
}

#[test]
fn all_models_measure_the_same_paths() {
    for depths in ["[{ bits: [4, 4] }, { bits: [6, 6] }]", LIT] {
        let depths = format!("sampling.depths={depths}");
        let sets = ["sampling.path_bits=5", "comparator.bits=5", &depths];
        let scene = written(LAMPS, &sets);
        let [fixed, gates] = [Model::Fixed, Model::Gates]
            .map(|model| picture(&scene, model, Estimator::Sine, Colour::OneRun, 3));
        assert_eq!(fixed.image, gates.image);
        assert_eq!(fixed.counted.queries, gates.counted.queries);
        assert!(fixed.good().is_none());
    }
}

/// The luminance that the circuit computes is that of the colours that it computes.
#[test]
fn the_luminance_is_that_of_the_colours() {
    let scene = written(LAMPS, &["precision.fraction=20"]);
    let oracle = Oracle::rgb_and_luminance(&scene, oracle::OracleOptions::default()).unwrap();
    let scale = [0, 1, 2].map(|c| oracle.channels[c].scale);
    let whole = oracle.channels[3].scale;
    assert!((whole - luminance(&scale)).abs() < 1e-12);
    let machine = OracleMachine::fixed(oracle.into(), 0, true);
    let mut seen = 0;
    machine
        .trace(&[[1, 2], [2, 0]], 0..machine.paths(), |finished| {
            for (place, &count) in finished.luminance.iter().enumerate() {
                let colour = [0, 1, 2]
                    .map(|c| scale[c] * finished.colours[c][place] as f64 / f64::from(1 << 20));
                let expected = luminance(&colour) / whole * 256.0;
                assert!(
                    (count as f64 - expected).abs() <= 0.501,
                    "{count} {expected}"
                );
                seen += u64::from(count > 0);
            }
        })
        .unwrap();
    assert!(seen > 50, "{seen}");
}

/// One run replaces three; its circuit is not three times as large.
#[test]
fn one_run_takes_a_third_of_the_queries() {
    let scene = written(LAMPS, &[]);
    let [three, one] = [Colour::ThreeRuns, Colour::OneRun]
        .map(|colour| picture(&scene, Model::Real, Estimator::Paper, colour, 0));
    assert_eq!(three.total_queries(), 3 * one.total_queries());
    let toffoli = |oracle: Oracle| oracle::call_cost(&[oracle]).toffoli;
    let options = oracle::OracleOptions::default();
    let red = toffoli(Oracle::new(&scene, 0, options).unwrap());
    let all = toffoli(Oracle::luminance(&scene, options).unwrap());
    assert!(all < 2 * red, "{all}, and red alone {red}");
}

/// A prepared scene serves renders with other options than those that it was prepared for.
#[test]
fn a_scene_prepared_for_three_runs_renders_with_one() {
    let scene = written(LAMPS, &[]);
    for model in [Model::Real, Model::Fixed] {
        let options = RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Paper),
            colour: Colour::OneRun,
            ..RenderOptions::default()
        };
        let three = RenderOptions::default();
        let prepared = Prepared::new(&scene, &three.planning(), Memory::default()).unwrap();
        let (found, _) = prepared.render(&options).unwrap();
        let expected = render(&scene, &options).unwrap();
        assert_eq!(found.image.pixels, expected.image.pixels, "{model:?}");
    }
}

#[test]
fn what_measures_nothing_is_refused_and_nothing_is_black() {
    let lamps = written(LAMPS, &[]);
    let options = RenderOptions {
        estimator: Some(Estimator::Exact),
        colour: Colour::OneRun,
        ..RenderOptions::default()
    };
    let error = render(&lamps, &options).unwrap_err();
    assert!(error.is_refusal());
    assert!(error.to_string().contains("choose another estimator"));
    let noisy = RenderOptions {
        colour: Colour::ThreeRuns,
        noise: "readout=0.01".parse().unwrap(),
        ..options
    };
    let error = render(&lamps, &noisy).unwrap_err();
    assert!(error.is_refusal());
    assert!(error.to_string().contains("or no noise"), "{error}");
    let nothing = "
name: nothing
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 3, height: 2 }
materials: {}
geometry: []
";
    let nothing = written(nothing, &[]);
    let rendered = picture(&nothing, Model::Real, Estimator::Sine, Colour::OneRun, 0);
    assert_eq!(rendered.image.pixels, [[0.0; 3]; 6]);
    assert_eq!(rendered.total_queries(), 0);
}

/// A run that measures no good index has no path to take a colour from, and the command warns of it.
#[test]
fn as_many_pixels_are_grey_as_the_estimator_says() {
    let film = "film={ width: 24, height: 24 }";
    let mut warned = 0;
    for estimator in [
        Estimator::Sine,
        Estimator::PosteriorMean,
        Estimator::AdaptiveBayes,
    ] {
        let scene = written(LAMPS, &[film, "counting.phase_bits=9"]);
        let options = RenderOptions {
            estimator: Some(estimator),
            colour: Colour::OneRun,
            ..RenderOptions::default()
        };
        let expected = options.expected_grey(&scene).unwrap();
        let rendered = render(&scene, &options).unwrap();
        let exact = picture(&scene, Model::Real, Estimator::Exact, Colour::ThreeRuns, 0);
        let pairs = rendered.image.pixels.iter().zip(&exact.image.pixels);
        // With few bits, the window may find no good index of darker pixels.
        let lit = pairs.filter(|(_, exact)| exact.iter().sum::<f64>() > 0.4);
        let lit: Vec<&[f64; 3]> = lit.map(|(pixel, _)| pixel).collect();
        let grey = lit.iter().filter(|[r, g, b]| r == g && g == b).count() as f64;
        let found = grey / lit.len() as f64;
        assert!(
            (found - expected).abs() < 0.15,
            "{estimator:?}: {found} {expected}"
        );
        warned += usize::from(expected > 0.1);
    }
    assert!(warned >= 1);
    let each = RenderOptions::default();
    assert_eq!(each.expected_grey(&written(LAMPS, &[])).unwrap(), 0.0);
}
