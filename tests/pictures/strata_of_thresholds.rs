//! Tests of strata of the comparator: their effect on pictures, and what they leave unchanged.

use crate::common::scene::written;
use qrt::counting::estimators::EstimatorError;
use qrt::runtime::render::{Colour, Model, RenderError, RenderOptions, Rendered, render};
use qrt::runtime::workers::Workers;
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;
use std::num::NonZero;

/// A dim wall in front of the camera, which reflects a little of a bright lamp behind it: colours are small
/// against their bound, which is that of the lamp.
const DIM: &str = "
name: dim
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 4 }
materials:
  wall: { emitter: { radiance: [0.3, 0.2, 0.1], albedo: [0.02, 0.01, 0.03] } }
  lamp: { emitter: { radiance: [6, 5, 4] } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: wall }
  - quad: { vertices: [[-1, -1, 3], [-1, 1, 3], [1, 1, 3], [1, -1, 3]], material: lamp }
sampling: { path_bits: 8, depths: [{ bits: [6, 6] }, { bits: [6, 6] }], lights: none }
comparator: { bits: 8 }
counting: { phase_bits: 10, estimator: adaptive-bayes }
";

fn with<'a>(model: Model) -> RenderOptions<'a> {
    RenderOptions {
        model: Some(model),
        ..RenderOptions::default()
    }
}

fn scene(strata: &str) -> ValidScene {
    written(DIM, &[&format!("counting.strata={strata}")])
}

fn bits(rendered: &Rendered) -> (Vec<[u64; 3]>, Vec<u64>, Vec<[u8; 3]>) {
    let pixels = rendered.image.pixels.iter();
    let pixels = pixels.map(|pixel| pixel.map(f64::to_bits)).collect();
    (
        pixels,
        rendered.counted.queries.clone(),
        rendered.counted.strata.clone(),
    )
}

/// Returns the root mean square error over pixels and channels, of several seeds.
fn error(strata: &str, colour: Colour) -> f64 {
    let scene = scene(strata);
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..6 {
        let exact = RenderOptions {
            seed,
            estimator: Some(Estimator::Exact),
            ..with(Model::Fixed)
        };
        let counted = RenderOptions {
            seed,
            colour,
            ..with(Model::Fixed)
        };
        let exact = render(&scene, &exact).unwrap();
        let counted = render(&scene, &counted).unwrap();
        assert!(exact.counted.strata.iter().all(|strata| *strata == [0; 3]));
        for (a, b) in exact.image.pixels.iter().zip(&counted.image.pixels) {
            for (a, b) in a.iter().zip(b) {
                sum += (a - b).powi(2);
                count += 1.0;
            }
        }
    }
    f64::sqrt(sum / count)
}

#[test]
fn small_colours_are_counted_with_less_error() {
    let [one, four, auto] = ["1", "4", "auto"].map(|s| error(s, Colour::ThreeRuns));
    assert!(one > 1.5 * four, "{one:e}, {four:e}");
    assert!(one > 1.5 * auto, "{one:e}, {auto:e}");
}

#[test]
fn one_run_gives_its_colours_by_strata_too() {
    let [one, four] = ["1", "4"].map(|s| error(s, Colour::OneRun));
    assert!(four < 1.1 * one, "{one:e}, {four:e}");
    let options = RenderOptions {
        colour: Colour::OneRun,
        ..with(Model::Real)
    };
    let found = render(&scene("4"), &options).unwrap();
    assert!(
        found
            .counted
            .strata
            .iter()
            .all(|strata| *strata == [4, 0, 0])
    );
}

#[test]
fn queries_are_those_that_are_allowed_and_strata_are_told() {
    for (strata, used) in [("1", Some(1)), ("4", Some(4)), ("auto", None)] {
        let scene = scene(strata);
        let found = render(&scene, &with(Model::Real)).unwrap();
        let all = found.counted.strata_used();
        assert_eq!(all.values().sum::<u64>(), 48);
        assert!(used.is_none_or(|used| all.keys().eq([&used])), "{all:?}");
        for queries in &found.counted.queries {
            assert!(*queries <= 3 * 1023, "{queries}");
        }
        let metadata = found.metadata().unwrap();
        assert_eq!(metadata.get("strata"), Some(strata));
    }
}

/// The picture does not depend on the machine, the threads and the tiles, nor on an interruption.
#[test]
fn the_same_strata_make_the_same_picture() {
    for strata in ["4", "auto"] {
        let scene = scene(strata);
        for colour in [Colour::ThreeRuns, Colour::OneRun] {
            let fixed = RenderOptions {
                colour,
                ..with(Model::Fixed)
            };
            let expected = bits(&render(&scene, &fixed).unwrap());
            let gates = RenderOptions {
                model: Some(Model::Gates),
                ..fixed.clone()
            };
            assert_eq!(bits(&render(&scene, &gates).unwrap()), expected);
            let threads = RenderOptions {
                workers: Workers {
                    threads: NonZero::new(1),
                    ..Workers::default()
                },
                tile: Some([3, 1]),
                ..fixed.clone()
            };
            assert_eq!(bits(&render(&scene, &threads).unwrap()), expected);
            let name = format!("qrt-strata-{}-{strata}", std::process::id());
            let checkpoint = std::env::temp_dir().join(name);
            let kept = RenderOptions {
                checkpoint: Some(checkpoint.clone()),
                resume: true,
                ..fixed
            };
            for _ in 0..2 {
                assert_eq!(bits(&render(&scene, &kept).unwrap()), expected);
            }
            std::fs::remove_file(checkpoint).unwrap();
        }
    }
}

/// A channel that is counted at once gives the same result as without strata.
#[test]
fn auto_changes_only_what_is_counted_by_strata() {
    let [auto, one] = ["auto", "1"].map(|s| render(&scene(s), &with(Model::Real)).unwrap());
    let channels = auto.image.pixels.iter().zip(&one.image.pixels);
    let mut changed = 0;
    for ((a, b), strata) in channels.zip(&auto.counted.strata) {
        for ((a, b), strata) in a.iter().zip(b).zip(strata) {
            assert!(*strata > 1 || a.to_bits() == b.to_bits());
            changed += u32::from(*strata > 1);
        }
    }
    assert!(changed > 20, "{changed}");
}

#[test]
fn estimators_that_count_the_whole_at_once_refuse_strata() {
    let scene = scene("4");
    for estimator in Estimator::ALL.iter().copied() {
        let options = RenderOptions {
            estimator: Some(estimator),
            crop: Some([0, 0, 1, 1]),
            ..with(Model::Real)
        };
        match render(&scene, &options) {
            Ok(found) => {
                assert!(estimator.counts_strata() || estimator == Estimator::Exact);
                assert_eq!(found.counted.strata == [[4; 3]], estimator.counts_strata());
            }
            Err(RenderError::Estimator(error)) => {
                assert!(!estimator.counts_strata());
                let strata = EstimatorError::Strata {
                    estimator,
                    strata: 4,
                };
                assert_eq!(error, strata);
            }
            Err(other) => panic!("{estimator}: {other}"),
        }
    }
}
