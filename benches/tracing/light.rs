//! Gain of light sampling, in paths and in gates.
//!
//! `cargo bench --bench tracing -- light` renders the Cornell box, once with its lamp sampled at
//! every bounce and once with paths that find it by chance. It prints the error of pixels that see
//! no lamp by the number of paths, as RMSE over the mean against very many lamp-sampled paths; the
//! cost of a call of the oracle; and the time in which the gates machine executes every gate of
//! every path of the film, which is some minutes.
//!
//! It fails where a promise is broken: an error of at most 8, 4, 1.3 and 0.7 % with 2^6, 2^8, 2^10
//! and 2^12 paths; at most 1.9 times the Toffolis; and by gates, 2^8 paths with the lamp sampled in
//! a twentieth of the time of 2^14 paths without, at less error.

use crate::common::{Arguments, Promises};
use qrt::core::oracle::{Oracle, call_cost};
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::front::load;
use qrt::scene::valid::ValidScene;
use qrt::tracer::{PixelClass, PixelClasses};
use std::path::Path;

/// The part of the film in which errors are measured: it sees no lamp.
const PART: [u32; 4] = [24, 24, 16, 16];

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let pictures: Vec<Picture> = (201..204)
        .map(|seed| picture(&scene(true, 14), Model::Real, seed))
        .collect();
    let truth = middle(&pictures);
    println!("RMSE over the mean of pixels that see no lamp, real model");
    println!("  paths     lamp sampled     by chance");
    for (bits, most) in [(6, 0.08), (8, 0.04), (10, 0.013), (12, 0.007)] {
        let of = |lit| {
            let error = |seed| error(&picture(&scene(lit, bits), Model::Real, seed), &truth);
            (error(1).powi(2) + error(2).powi(2)).sqrt() * std::f64::consts::FRAC_1_SQRT_2
        };
        let (lit, chance) = (of(true), of(false));
        println!(
            "  2^{bits:<8} {:9.2} %  {:11.1} %",
            100.0 * lit,
            100.0 * chance
        );
        promises.judge(
            &format!("2^{bits} paths are off by {:.1} % at most", 100.0 * most),
            lit <= most,
        );
    }

    let toffoli = |lit| {
        let (channels, _) = Oracle::all(&scene(lit, 8)).expect("the scene has a circuit");
        call_cost(&channels).toffoli as f64
    };
    let (lit, chance) = (toffoli(true), toffoli(false));
    println!(
        "Toffolis of a call: {lit} with the lamp sampled, {chance} without: {:.2} times",
        lit / chance
    );
    promises.judge("at most 1.9 times the Toffolis", lit <= 1.9 * chance);

    let timed = |lit, bits| {
        let scene = scene(lit, bits);
        let whole = RenderOptions {
            crop: None,
            ..options(Model::Gates, 1)
        };
        let made = render(&scene, &whole).expect("a picture");
        let [left, top, width, height] = PART;
        let row = |y: u32| (y * made.image.width + left) as usize;
        let rows = (top..top + height).map(|y| &made.image.pixels[row(y)..][..width as usize]);
        (
            made.seconds,
            error(&rows.collect::<Vec<_>>().concat(), &truth),
        )
    };
    let (few, many) = (timed(true, 8), timed(false, 14));
    println!("Every gate of every path of the film");
    println!(
        "  2^8 paths, lamp sampled   {:8.2} s, error {:5.2} %",
        few.0,
        100.0 * few.1
    );
    println!(
        "  2^14 paths, by chance     {:8.2} s, error {:5.2} %",
        many.0,
        100.0 * many.1
    );
    promises.judge("a twentieth of the time by gates", few.0 <= 0.05 * many.0);
    promises.judge("and less error", few.1 < many.1);
}

type Picture = Vec<[f64; 3]>;

/// Returns the Cornell box with 2^bits paths a pixel.
fn scene(lit: bool, bits: u32) -> ValidScene {
    let depth = "{ bits: [10, 10] }";
    let sets = [
        format!("sampling.depths=[{{ bits: [10, 10] }}, {depth}, {depth}]"),
        format!("sampling.path_bits={bits}"),
        format!("sampling.lights={}", if lit { "auto" } else { "none" }),
    ];
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml/cornell-box.yaml");
    let scene = load(&file, &sets)
        .unwrap_or_else(|report| panic!("{report}"))
        .valid;
    let classes = PixelClasses::new(&scene);
    assert!(!lit || classes.class([PART[0], PART[1]]) == PixelClass::MeetsNoLamp);
    scene
}

fn options(model: Model, seed: u64) -> RenderOptions<'static> {
    RenderOptions {
        model: Some(model),
        seed,
        crop: Some(PART),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    }
}

fn picture(scene: &ValidScene, model: Model, seed: u64) -> Picture {
    let made = render(scene, &options(model, seed)).expect("a picture");
    made.image.pixels
}

fn middle(pictures: &[Picture]) -> Picture {
    let count = pictures.len() as f64;
    let at = |k: usize| [0, 1, 2].map(|c| pictures.iter().map(|p| p[k][c]).sum::<f64>() / count);
    (0..pictures[0].len()).map(at).collect()
}

/// Returns the RMSE over the mean.
fn error(picture: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let pairs = || picture.as_flattened().iter().zip(truth.as_flattened());
    let squares: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
    let mean: f64 = pairs().map(|(_, b)| b).sum::<f64>() / pairs().count() as f64;
    (squares / pairs().count() as f64).sqrt() / mean
}
