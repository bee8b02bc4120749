//! Tests that a picture depends only on the scene, the seed and the estimator.

use crate::common::scene::written;
use qrt::prelude::*;
use qrt::runtime::path_machines::{Real, Simd};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

const BOX: &str = include_str!("../scenes/box.yaml");
const ESTIMATORS: [Estimator; 2] = [Estimator::Exact, Estimator::Sine];

fn scene(sets: &[&str]) -> ValidScene {
    written(BOX, sets)
}

/// Returns every bit of a picture, and its queries.
fn bits(rendered: &Rendered) -> (Vec<[u64; 3]>, Vec<u64>) {
    let pixels = rendered.image.pixels.iter();
    let pixels = pixels.map(|pixel| pixel.map(f64::to_bits)).collect();
    (pixels, rendered.counted.queries.clone())
}

fn with(estimator: Estimator) -> RenderOptions<'static> {
    RenderOptions {
        seed: 3,
        estimator: Some(estimator),
        ..RenderOptions::default()
    }
}

fn threads(count: usize) -> Workers<'static> {
    Workers {
        threads: NonZeroUsize::new(count),
        ..Workers::default()
    }
}

/// A path that no other test uses; the file there is removed.
struct Partial(PathBuf);

impl Partial {
    fn new(name: &str) -> Self {
        let name = format!("qrt-same-{}-{name}.qrt-partial", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn for_any_number_of_threads_and_any_tiles() {
    let scene = scene(&[]);
    for estimator in ESTIMATORS {
        let expected = bits(&render(&scene, &with(estimator)).unwrap());
        for (count, tile) in [
            (1, None),
            (2, Some([1, 1])),
            (3, Some([5, 3])),
            (8, Some([64, 64])),
            (2, Some([13, 1])),
        ] {
            let options = RenderOptions {
                workers: threads(count),
                tile,
                ..with(estimator)
            };
            let rendered = render(&scene, &options).unwrap();
            assert_eq!(rendered.threads, count);
            assert_eq!(bits(&rendered), expected, "{count} threads, tiles {tile:?}");
        }
    }
}

#[test]
fn for_any_lanes() {
    // More paths than a block has, and fewer.
    for path_bits in ["sampling.path_bits=10", "sampling.path_bits=2"] {
        let scene = scene(&[path_bits]);
        for estimator in ESTIMATORS {
            let scalar = RenderOptions {
                simd: Simd::Scalar,
                ..with(estimator)
            };
            let scalar = render(&scene, &scalar).unwrap();
            let widest = render(&scene, &with(estimator)).unwrap();
            assert_eq!(bits(&scalar), bits(&widest));
        }
    }
}

#[test]
fn a_pixel_of_many_paths_is_shared_by_threads_and_is_still_their_mean() {
    let scene = scene(&["sampling.path_bits=19", "film={ width: 2, height: 1 }"]);
    for estimator in ESTIMATORS {
        let one = RenderOptions {
            workers: threads(1),
            ..with(estimator)
        };
        let three = RenderOptions {
            workers: threads(3),
            ..with(estimator)
        };
        let one = render(&scene, &one).unwrap();
        assert_eq!(bits(&one), bits(&render(&scene, &three).unwrap()));
        if estimator == Estimator::Exact {
            // Add the colours in another order.
            let mut sums = [[0.0; 3]; 2];
            Real::new(&scene, 3)
                .unwrap()
                .trace(&[[0, 0], [1, 0]], |block| {
                    for (sum, colours) in sums[block.pixel].iter_mut().zip(block.colours) {
                        for colour in colours {
                            *sum += colour;
                        }
                    }
                });
            for (pixel, sum) in one.image.pixels.iter().zip(sums) {
                for channel in 0..3 {
                    let mean = sum[channel] / f64::from(1 << 19);
                    assert!((pixel[channel] - mean).abs() < 1e-9 * mean);
                    assert!(mean > 0.0);
                }
            }
        }
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let scene = scene(&[]);
    for estimator in ESTIMATORS {
        let whole = render(&scene, &with(estimator)).unwrap();
        for crop in [[0, 0, 13, 11], [3, 2, 7, 5], [12, 10, 1, 1]] {
            let [x, y, width, height] = crop;
            let options = RenderOptions {
                crop: Some(crop),
                ..with(estimator)
            };
            let part = render(&scene, &options).unwrap();
            assert_eq!((part.image.width, part.image.height), (width, height));
            let mut counts = part.counts();
            for row in 0..height {
                for column in 0..width {
                    let there = whole.image.pixels[((y + row) * 13 + x + column) as usize];
                    let here = part.image.pixels[(row * width + column) as usize];
                    assert_eq!(here, there);
                    for (channel, value) in here.into_iter().enumerate() {
                        let count = counts.next().unwrap();
                        assert_eq!((count.x, count.y), (x + column, y + row));
                        assert_eq!((count.channel, count.value), (channel, value));
                    }
                }
            }
            assert!(counts.next().is_none());
        }
    }
}

/// Returns the error of a render that `cancel` stops, with its progress reported.
fn stopped(
    scene: &ValidScene,
    options: &RenderOptions<'_>,
    cancel: &AtomicBool,
    progress: &(dyn Fn(Progress) + Sync),
) -> RenderError {
    let options = RenderOptions {
        workers: Workers {
            cancel: Some(cancel),
            progress: Some(progress),
            ..options.workers
        },
        ..options.clone()
    };
    render(scene, &options).unwrap_err()
}

/// Renders until `paths` more paths are traced; returns the number of pixels that were finished then.
fn interrupt(scene: &ValidScene, options: &RenderOptions<'_>, paths: u64) -> u64 {
    let cancel = AtomicBool::new(false);
    let traced = AtomicU64::new(0);
    let progress = |progress: Progress| {
        if let Progress::Finished(more) = progress
            && traced.fetch_add(more, Ordering::SeqCst) + more >= paths
        {
            cancel.store(true, Ordering::SeqCst);
        }
    };
    match stopped(scene, options, &cancel, &progress) {
        RenderError::Interrupted { finished, .. } => finished,
        other => panic!("{other}"),
    }
}

#[test]
fn interrupted_and_resumed_or_not() {
    for (name, sets, paths) in [
        ("few", &["sampling.path_bits=10"][..], 30 << 10),
        (
            "many",
            &["sampling.path_bits=19", "film={ width: 3, height: 2 }"][..],
            5 << 18,
        ),
    ] {
        let scene = scene(sets);
        for estimator in ESTIMATORS {
            let expected = bits(&render(&scene, &with(estimator)).unwrap());
            let partial = Partial::new(&format!("{name}-{estimator}"));
            let options = RenderOptions {
                checkpoint: Some(partial.0.clone()),
                resume: true,
                tile: Some([2, 1]),
                workers: threads(1),
                ..with(estimator)
            };
            let first = interrupt(&scene, &options, paths);
            assert!(first > 0);
            // The render resumes, and can be interrupted again.
            let two = RenderOptions {
                workers: threads(2),
                ..options.clone()
            };
            let second = interrupt(&scene, &two, paths / 4);
            assert!(second >= first, "{first} pixels, then {second}");
            let last = render(&scene, &RenderOptions { tile: None, ..two }).unwrap();
            // Unfinished pixels have some more paths.
            let finished = second * (last.paths / last.counted.queries.len() as u64);
            assert!(last.resumed_paths >= finished);
            assert_eq!(bits(&last), expected);
        }
    }
}

#[test]
fn an_interruption_waits_for_no_pixel() {
    // 2^40 paths, cut into 4,096 parts.
    let scene = scene(&["sampling.path_bits=40", "film={ width: 1, height: 1 }"]);
    for model in [Model::Real, Model::Fixed] {
        let (cancel, later) = (AtomicBool::new(false), AtomicU64::new(0));
        let progress = |progress: Progress| {
            if let Progress::Finished(paths) = progress
                && cancel.swap(true, Ordering::SeqCst)
            {
                later.fetch_add(paths, Ordering::SeqCst);
            }
        };
        let options = RenderOptions {
            model: Some(model),
            workers: Workers {
                cancel: Some(&cancel),
                progress: Some(&progress),
                ..threads(2)
            },
            ..RenderOptions::default()
        };
        let error = render(&scene, &options).unwrap_err();
        assert!(matches!(
            error,
            RenderError::Interrupted { finished: 0, .. }
        ));
        // Each thread may be within a run.
        assert!(later.into_inner() <= 2 << 16, "{model:?}");
    }
}

#[test]
fn an_interrupted_pixel_goes_on_within_itself() {
    let scene = scene(&["sampling.path_bits=21", "film={ width: 1, height: 1 }"]);
    let one = RenderOptions {
        colour: qrt::runtime::render::Colour::OneRun,
        ..with(Estimator::Sine)
    };
    let fixed = RenderOptions {
        model: Some(Model::Fixed),
        ..with(Estimator::Exact)
    };
    let all = [with(Estimator::Exact), with(Estimator::Sine), one, fixed];
    for (number, options) in all.into_iter().enumerate() {
        let expected = bits(&render(&scene, &options).unwrap());
        let partial = Partial::new(&format!("within-{number}"));
        let options = RenderOptions {
            checkpoint: Some(partial.0.clone()),
            resume: true,
            ..options
        };
        let mut kept = 0;
        for count in [1, 2, 3] {
            let options = RenderOptions {
                workers: threads(count),
                ..options.clone()
            };
            // No traced path is lost.
            assert_eq!(interrupt(&scene, &options, 300_000), 0);
            let resumed = resumed(&scene, &options);
            assert!(resumed >= kept + 300_000, "{resumed} after {kept}");
            kept = resumed;
        }
        let last = render(&scene, &options).unwrap();
        assert_eq!(last.resumed_paths, kept);
        assert_eq!(bits(&last), expected, "{number}");
    }
}

/// A tile is interrupted before it is finished, with its pixels traced together or one by one.
#[test]
fn an_interrupted_tile_goes_on_within_itself() {
    let lit = "{ bits: [6, 6], light: [6, 6] }";
    let lit = format!("sampling.depths=[{{ bits: [8, 8] }}, {lit}, {lit}]");
    for (model, path_bits, estimator, lights) in [
        (Model::Real, 13, Estimator::Sine, &[][..]),
        (
            Model::Real,
            13,
            Estimator::Sine,
            &[&*lit, "sampling.lights=auto"],
        ),
        (Model::Fixed, 9, Estimator::Exact, &[]),
        (
            Model::Fixed,
            9,
            Estimator::Exact,
            &[&*lit, "sampling.lights=auto"],
        ),
        (Model::Gates, 9, Estimator::Sine, &[]),
        (Model::Gates, 12, Estimator::Exact, &[]),
    ] {
        let bits_of_paths = format!("sampling.path_bits={path_bits}");
        let film = "film={ width: 8, height: 8 }";
        let scene = scene(&[&[&*bits_of_paths, film], lights].concat());
        let options = RenderOptions {
            model: Some(model),
            ..with(estimator)
        };
        let expected = bits(&render(&scene, &options).unwrap());
        let partial = Partial::new(&format!("tile-{model:?}-{path_bits}"));
        let options = RenderOptions {
            checkpoint: Some(partial.0.clone()),
            resume: true,
            tile: Some([8, 8]),
            ..options
        };
        let mut kept = 0;
        for _ in 0..2 {
            let more = 20 << path_bits;
            assert_eq!(interrupt(&scene, &options, more), 0);
            let resumed = resumed(&scene, &options);
            assert!(resumed >= kept + more, "{model:?}: {resumed} after {kept}");
            kept = resumed;
        }
        // Other tiles cause no path to be traced again, either.
        let traced = AtomicU64::new(0);
        let progress = |progress: Progress| {
            if let Progress::Finished(more) = progress {
                traced.fetch_add(more, Ordering::SeqCst);
            }
        };
        let others = RenderOptions {
            tile: Some([3, 5]),
            workers: Workers {
                progress: Some(&progress),
                ..threads(1)
            },
            ..options
        };
        let last = render(&scene, &others).unwrap();
        assert_eq!(last.resumed_paths, kept);
        assert_eq!(traced.into_inner(), last.paths - kept, "{model:?}");
        assert_eq!(bits(&last), expected, "{model:?}");
    }
}

/// Returns the number of paths in a checkpoint.
fn resumed(scene: &ValidScene, options: &RenderOptions<'_>) -> u64 {
    let cancel = AtomicBool::new(true);
    let found = AtomicU64::new(0);
    let progress = |progress: Progress| {
        if let Progress::Started { resumed, .. } = progress {
            found.store(resumed, Ordering::SeqCst);
        }
    };
    stopped(scene, options, &cancel, &progress);
    found.into_inner()
}

#[test]
fn a_kill_takes_two_seconds_of_a_pixel_at_most() {
    use std::time::{Duration, Instant};
    let scene = scene(&["sampling.path_bits=40", "film={ width: 1, height: 1 }"]);
    let [partial, killed] = ["stake", "killed"].map(Partial::new);
    let (cancel, traced) = (AtomicBool::new(false), AtomicU64::new(0));
    let progress = |progress: Progress| {
        if let Progress::Finished(more) = progress {
            traced.fetch_add(more, Ordering::SeqCst);
        }
    };
    let options = RenderOptions {
        checkpoint: Some(partial.0.clone()),
        resume: true,
        workers: Workers {
            cancel: Some(&cancel),
            progress: Some(&progress),
            ..threads(2)
        },
        ..with(Estimator::Sine)
    };
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| render(&scene, &options));
        while traced.load(Ordering::SeqCst) == 0 {
            std::thread::sleep(Duration::from_millis(1));
        }
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(2) {
            std::thread::sleep(Duration::from_millis(10));
        }
        let then = traced.load(Ordering::SeqCst);
        std::thread::sleep(Duration::from_secs(2));
        // A kill now would leave this file.
        std::fs::copy(&partial.0, &killed.0).unwrap();
        cancel.store(true, Ordering::SeqCst);
        assert!(rendering.join().unwrap().is_err());
        let options = RenderOptions {
            checkpoint: Some(killed.0.clone()),
            workers: threads(1),
            ..options.clone()
        };
        let resumed = resumed(&scene, &options);
        assert!(resumed >= then && then > 0, "{resumed} of {then}");
    });
}

#[test]
fn what_is_finished_is_not_traced_again() {
    let scene = scene(&[]);
    let partial = Partial::new("finished");
    let options = RenderOptions {
        checkpoint: Some(partial.0.clone()),
        resume: true,
        ..with(Estimator::Sine)
    };
    let first = render(&scene, &options).unwrap();
    assert_eq!(first.resumed_paths, 0);
    let again = |progress: Progress| assert!(matches!(progress, Progress::Started { .. }));
    let again = RenderOptions {
        workers: Workers {
            progress: Some(&again),
            ..options.workers
        },
        ..options.clone()
    };
    let second = render(&scene, &again).unwrap();
    assert_eq!(second.resumed_paths, second.paths);
    assert_eq!(bits(&first), bits(&second));
    // Unless the render is not to be resumed.
    let anew = RenderOptions {
        resume: false,
        ..options
    };
    assert_eq!(render(&scene, &anew).unwrap().resumed_paths, 0);
}

#[test]
fn another_render_does_not_go_on_from_it() {
    let scene = scene(&[]);
    let partial = Partial::new("other");
    let options = RenderOptions {
        checkpoint: Some(partial.0.clone()),
        resume: true,
        ..with(Estimator::Exact)
    };
    render(&scene, &options).unwrap();
    let seed = RenderOptions {
        seed: 4,
        ..options.clone()
    };
    let estimator = RenderOptions {
        estimator: Some(Estimator::Paper),
        ..options.clone()
    };
    let crop = RenderOptions {
        crop: Some([0, 0, 2, 2]),
        ..options
    };
    for (other, named) in [(seed, "seed"), (estimator, "estimator"), (crop, "crop")] {
        let error = render(&scene, &other).unwrap_err();
        assert!(error.is_refusal());
        assert!(error.to_string().contains(named), "{error}");
    }
}

#[test]
fn another_seed_is_another_picture() {
    let scene = scene(&[]);
    for estimator in ESTIMATORS {
        let one = render(&scene, &with(estimator)).unwrap();
        let options = RenderOptions {
            seed: 4,
            ..with(estimator)
        };
        assert_ne!(bits(&one).0, bits(&render(&scene, &options).unwrap()).0);
    }
}
