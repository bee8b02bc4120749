//! Tests that a user-defined estimator renders pictures like the built-in ones, and that the metadata of a
//! picture names it.

use crate::common::scene::written;
use qrt::counting::estimators::{Device, Estimate, EstimatorError, Settings, estimator};
use qrt::prelude::*;
use qrt::runtime::render::{BoxedEstimator, Colour, Visibility};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

const BOX: &str = include_str!("../scenes/box.yaml");

fn scene(sets: &[&str]) -> ValidScene {
    written(BOX, sets)
}

/// A built-in estimator in a wrapper.
struct Wrapped(BoxedEstimator);

static RUNS: AtomicU64 = AtomicU64::new(0);

impl AmplitudeEstimator for Wrapped {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        RUNS.fetch_add(1, Ordering::Relaxed);
        self.0.estimate(device)
    }
}

fn wrapped(settings: &Settings) -> Result<BoxedEstimator, EstimatorError> {
    Ok(Box::new(Wrapped(estimator(Estimator::Sine, settings)?)))
}

fn named(name: &str) -> RenderOptions<'_> {
    RenderOptions {
        seed: 3,
        own_estimator: Some(OwnEstimator::new(name, &wrapped)),
        ..RenderOptions::default()
    }
}

#[test]
fn one_that_wraps_a_known_one_renders_its_picture() {
    let scene = scene(&["film.width=5", "film.height=4"]);
    for colour in [Colour::ThreeRuns, Colour::OneRun] {
        for model in [Model::Real, Model::Fixed] {
            let known = RenderOptions {
                colour,
                model: Some(model),
                seed: 3,
                estimator: Some(Estimator::Sine),
                ..RenderOptions::default()
            };
            let own = RenderOptions {
                colour,
                model: Some(model),
                ..named("mine")
            };
            let before = RUNS.load(Ordering::Relaxed);
            let [known, own] = [known, own].map(|options| render(&scene, &options).unwrap());
            assert!(RUNS.load(Ordering::Relaxed) >= before + 20);
            let bytes = |rendered: &Rendered| {
                let mut bytes = Vec::new();
                write_to(
                    &mut bytes,
                    &rendered.image,
                    &[],
                    &Metadata::new(),
                    Encoding::Exr,
                )
                .unwrap();
                bytes
            };
            assert_eq!(bytes(&own), bytes(&known));
            assert_eq!(own.counted.queries, known.counted.queries);
            assert_eq!(own.counted.widths, known.counted.widths);
            assert_eq!(known.own_estimator, None);
            assert_eq!(own.own_estimator.as_deref(), Some("mine"));
            assert_eq!(known.metadata().unwrap().get("estimator"), Some("sine"));
            assert_eq!(own.metadata().unwrap().get("estimator"), Some("own:mine"));
        }
    }
}

#[test]
fn a_picture_is_gone_on_with_by_the_same_name_alone() {
    let path = std::env::temp_dir().join(format!("qrt-own-{}.qrt-partial", std::process::id()));
    let checkpoint = Checkpointed(path.clone());
    let scene = scene(&[]);
    let stop = AtomicBool::new(false);
    let told = |progress: Progress| {
        if matches!(progress, Progress::Finished(_)) {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let kept = |options: RenderOptions<'static>, resume| RenderOptions {
        checkpoint: Some(checkpoint.0.clone()),
        tile: Some([4, 4]),
        resume,
        ..options
    };
    let workers = Workers {
        cancel: Some(&stop),
        progress: Some(&told),
        threads: None,
    };
    let interrupted = render(
        &scene,
        &RenderOptions {
            workers,
            ..kept(named("first"), false)
        },
    );
    assert!(matches!(interrupted, Err(RenderError::Interrupted { .. })));
    let sine = RenderOptions {
        seed: 3,
        estimator: Some(Estimator::Sine),
        ..RenderOptions::default()
    };
    for other in [named("second"), sine.clone()] {
        let refused = render(&scene, &kept(other, true)).unwrap_err();
        assert!(matches!(refused, RenderError::Checkpoint(_)), "{refused}");
        assert!(refused.to_string().contains("own:first"), "{refused}");
    }
    let resumed = render(&scene, &kept(named("first"), true)).unwrap();
    assert!(resumed.resumed_paths > 0);
    assert_eq!(resumed.image, render(&scene, &sine).unwrap().image);
}

struct Checkpointed(PathBuf);

impl Drop for Checkpointed {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn what_cannot_be_done_with_one_is_refused() {
    let scene = scene(&["film.width=2", "film.height=2"]);
    let refused = |options: &RenderOptions<'_>| render(&scene, options).unwrap_err().to_string();
    for name in ["", "own name", "ä", &"n".repeat(65)] {
        assert!(
            refused(&named(name)).contains("is no name of an estimator"),
            "{name}"
        );
    }
    let searched = RenderOptions {
        visibility: Visibility::Exhaustive,
        model: Some(Model::Fixed),
        ..named("mine")
    };
    assert!(refused(&searched).contains("find primary hits classically"));
    let accurate = BOX.replace(
        "counting: { phase_bits: 7, estimator: sine }",
        "accuracy: { error: 0.2, confidence: 0.9 }",
    );
    let accurate = written(&accurate.replace("  path_bits: 10\n", ""), &[]);
    let error = render(&accurate, &named("mine")).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("write the parameters into the scene"),
        "{error}"
    );
    assert!(error.is_refusal());
    let fails = |_: &Settings| Err(EstimatorError::Own("no estimator on Sundays"));
    let own = OwnEstimator::new("sunday", &fails);
    let error = refused(&RenderOptions {
        own_estimator: Some(own),
        ..RenderOptions::default()
    });
    assert_eq!(error, "no estimator on Sundays");
}
