//! Colour from one run of counting instead of three.
//!
//! `cargo bench --bench accuracy -- colour` renders scenes both ways with the default estimator, at
//! the same queries a pixel in all, and prints the errors against the picture without counting
//! noise: of the luminance, for which one run has three times the queries, and of the colour at
//! that luminance, which it takes from a few measured paths. Fails unless one run's luminance is
//! the better one.

use crate::common::{Arguments, Promises};
use qrt_core::oracle::luminance;
use qrt_runtime::render::{Colour, RenderOptions, render};
use qrt_scene::Estimator;
use qrt_scene::front::load;
use std::path::Path;

const SCENES: [&str; 3] = ["cornell-box", "floor-and-light", "velvet"];
/// Bits of the phase registers whose queries a run may use.
const BITS: [u32; 3] = [9, 11, 13];

type Picture = Vec<[f64; 3]>;

/// Returns root mean square errors over the mean luminance: of the luminance, and of the colours when both
/// are scaled to the right luminance.
fn errors(found: &Picture, truth: &Picture) -> [f64; 2] {
    let (mut brightness, mut hue, mut mean) = (0.0, 0.0, 0.0);
    for (found, truth) in found.iter().zip(truth) {
        let (y, right) = (luminance(found), luminance(truth));
        mean += right;
        brightness += (y - right) * (y - right);
        if y > 0.0 {
            for (f, t) in found.iter().zip(truth) {
                let error = f * right / y - t;
                hue += error * error / 3.0;
            }
        }
    }
    let n = truth.len() as f64;
    [brightness, hue].map(|square| (square / n).sqrt() / (mean / n))
}

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    println!(
        "| scene | queries a pixel | luminance, three runs | one run | hue, three runs | one run |"
    );
    println!("|---|---|---|---|---|---|");
    let mut verdicts = Vec::new();
    for name in SCENES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes-yaml/{name}.yaml"));
        let picture = |estimator, colour, bits: u32, repetitions: u32| {
            let sets = [
                "film={ width: 24, height: 24 }".to_owned(),
                "sampling.path_bits=12".to_owned(),
                format!("counting.phase_bits={bits}"),
                format!("counting.repetitions={repetitions}"),
            ];
            let scene = load(&path, &sets).unwrap().valid;
            let options = RenderOptions {
                estimator: Some(estimator),
                colour,
                ..RenderOptions::default()
            };
            render(&scene, &options).unwrap()
        };
        let truth = picture(Estimator::Exact, Colour::ThreeRuns, 8, 1)
            .image
            .pixels;
        for bits in BITS {
            // One run repeats three times, so that both have the same queries.
            let three = picture(Estimator::AdaptiveBayes, Colour::ThreeRuns, bits, 1);
            let one = picture(Estimator::AdaptiveBayes, Colour::OneRun, bits, 3);
            let [y3, c3] = errors(&three.image.pixels, &truth);
            let [y1, c1] = errors(&one.image.pixels, &truth);
            let queries = one.total_queries() / (24 * 24);
            println!("| {name} | {queries} | {y3:.5} | {y1:.5} | {c3:.5} | {c1:.5} |");
            verdicts.push((
                format!("{name} at {queries} queries: one run's luminance is off by {y1:.5}, at most {y3:.5}"),
                y1 <= y3,
            ));
        }
    }
    for (what, kept) in verdicts {
        promises.judge(&what, kept);
    }
}
