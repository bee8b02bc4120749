//! Tests of counting in pictures, against closed forms.

use crate::common::scene::written;
use qrt::prelude::*;
use qrt::runtime::memory::Memory;
use std::f64::consts::PI;

const FURNACE: &str = include_str!("../scenes/furnace.yaml");
/// e (1 + a + a^2).
const COLOUR: [f64; 3] = [1.75, 0.65625, 0.0];

fn with(estimator: Estimator, seed: u64) -> RenderOptions<'static> {
    RenderOptions {
        seed,
        estimator: Some(estimator),
        ..RenderOptions::default()
    }
}

#[test]
fn exact_is_the_mean_of_the_paths_and_asks_no_oracle() {
    let rendered = render(&written(FURNACE, &[]), &with(Estimator::Exact, 0)).unwrap();
    for pixel in &rendered.image.pixels {
        for (value, colour) in pixel.iter().zip(COLOUR) {
            assert!((value - colour).abs() < 1e-12, "{pixel:?}");
        }
    }
    assert_eq!(rendered.total_queries(), 0);
    assert_eq!((rendered.paths, rendered.ids), (256 << 4, 1 << 20));
    assert!(rendered.counts().all(|count| count.good.is_none()));
}

/// `|a~ - a| <= 2 pi sqrt(a (1 - a))/T + pi^2/T^2` with probability at least 8/pi^2 (Brassard, Hoyer, Mosca &
/// Tapp, theorem 12); half a comparator's step, and half an index, are added.
#[test]
fn counted_pixels_keep_the_bound_in_the_promised_share() {
    let phases = 256.0;
    let scene = written(FURNACE, &[]);
    for estimator in [Estimator::Paper, Estimator::Sine] {
        let rendered = render(&scene, &with(estimator, 1)).unwrap();
        for channel in 0..2 {
            let scale = rendered.scales.greatest()[channel];
            let a = COLOUR[channel] / scale;
            assert!((0.05..0.95).contains(&a), "nothing to count: {a}");
            let bound = 2.0 * PI * (a * (1.0 - a)).sqrt() / phases + (PI / phases).powi(2);
            let bound = scale * (bound + 0.5 / 65536.0 + 0.5 / rendered.ids as f64);
            let within = rendered.image.pixels.iter();
            let within = within.filter(|p| (p[channel] - COLOUR[channel]).abs() <= bound);
            let share = within.count() as f64 / 256.0;
            // Allow three standard errors below.
            let promise = 8.0 / (PI * PI);
            let least = promise - 3.0 * (promise * (1.0 - promise) / 256.0).sqrt();
            assert!(share >= least, "{estimator}, channel {channel}: {share}");
        }
        assert_eq!(rendered.counted.queries, vec![3 * 255; 256]);
    }
}

#[test]
fn no_good_id_is_counted_as_none() {
    // The rectangular window measures theta = 0 without error.
    let rendered = render(&written(FURNACE, &[]), &with(Estimator::Paper, 5)).unwrap();
    assert!(rendered.scales.greatest()[2] > 1.0);
    assert!(rendered.image.pixels.iter().all(|pixel| pixel[2] == 0.0));
}

#[test]
fn seeds_change_the_noise_and_not_the_mean() {
    let scene = written(FURNACE, &[]);
    for estimator in [Estimator::Sine, Estimator::MonteCarlo] {
        for channel in 0..2 {
            let mut values = Vec::new();
            for seed in 0..8 {
                let rendered = render(&scene, &with(estimator, seed)).unwrap();
                values.extend(rendered.image.pixels.iter().map(|pixel| pixel[channel]));
            }
            let count = values.len() as f64;
            let mean = values.iter().sum::<f64>() / count;
            let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
            assert!(variance > 0.0);
            // Counting with a window of T phases has a bias of the order of 1/T^2.
            let scale = render(&scene, &with(Estimator::Exact, 0))
                .unwrap()
                .scales
                .greatest()[channel];
            let slack =
                5.0 * (variance / count).sqrt() + scale * (1.0 / 65536.0 + (PI / 256.0).powi(2));
            assert!(
                (mean - COLOUR[channel]).abs() < slack,
                "{estimator}: {mean}"
            );
        }
    }
}

#[test]
fn every_estimator_works() {
    for &estimator in Estimator::ALL {
        let name = format!("counting.estimator={estimator}");
        let sets = [&*name, "film={ width: 2, height: 2 }", "comparator.bits=12"];
        let scene = written(FURNACE, &sets);
        let rendered = render(&scene, &RenderOptions::default()).unwrap();
        assert_eq!(rendered.estimator, estimator);
        for pixel in &rendered.image.pixels {
            for (value, bound) in pixel.iter().zip(rendered.scales.greatest()) {
                assert!((0.0..=bound).contains(value));
            }
        }
    }
}

const NOTHING: &str = "
name: nothing
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 3, height: 2 }
materials: {}
geometry: []
";

#[test]
fn nothing_is_black_and_takes_no_queries() {
    for estimator in [Estimator::Exact, Estimator::Sine, Estimator::MonteCarlo] {
        let rendered = render(&written(NOTHING, &[]), &with(estimator, 0)).unwrap();
        assert_eq!(rendered.image.pixels, [[0.0; 3]; 6]);
        assert_eq!(rendered.total_queries(), 0);
        assert_eq!(rendered.scales.greatest(), [0.0; 3]);
    }
}

/// A channel that is proven black has no relative error, and needs no queries.
#[test]
fn nothing_is_black_to_any_accuracy() {
    let scene = written(NOTHING, &["accuracy={ error: 0.01, confidence: 0.9 }"]);
    let rendered = render(&scene, &RenderOptions::default()).unwrap();
    assert_eq!(rendered.image.pixels, [[0.0; 3]; 6]);
    assert_eq!(rendered.total_queries(), 0);
    let plan = rendered.plan.unwrap();
    assert_eq!((plan.within, plan.mean, plan.queries), (1.0, 0.0, 0.0));
}

#[test]
fn a_single_pixel_of_a_single_path_is_that_path() {
    let sets = ["film={ width: 1, height: 1 }", "sampling.path_bits=0"];
    let scene = written(FURNACE, &sets);
    let rendered = render(&scene, &with(Estimator::Exact, 0)).unwrap();
    assert_eq!((rendered.paths, rendered.ids), (1, 1 << 16));
    for (value, colour) in rendered.image.pixels[0].iter().zip(COLOUR) {
        assert!((value - colour).abs() < 1e-14);
    }
    let counted = render(&scene, &with(Estimator::Paper, 0)).unwrap();
    assert_eq!(counted.counted.queries, [3 * 255]);
}

#[test]
fn what_cannot_be_rendered_is_refused_before_it_costs_anything() {
    let refused = |sets: &[&str], options: &RenderOptions<'_>, words: &str| {
        let error = render(&written(NOTHING, sets), options).unwrap_err();
        assert!(error.is_refusal(), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    let film = "film={ width: 65536, height: 65536 }";
    let unlimited = RenderOptions {
        memory: Memory::new(Some(u64::MAX)),
        ..RenderOptions::default()
    };
    refused(&[film, "sampling.path_bits=52"], &unlimited, "2^64");
    let little = RenderOptions {
        memory: Memory::new(Some(1 << 30)),
        ..RenderOptions::default()
    };
    refused(&[film], &little, "would take about 447 GB of memory");
    for crop in [
        [0, 0, 0, 1],
        [0, 0, 1, 0],
        [3, 0, 1, 1],
        [0, 1, 1, 2],
        [1, 0, u32::MAX, 1],
    ] {
        let options = RenderOptions {
            crop: Some(crop),
            ..RenderOptions::default()
        };
        refused(&[], &options, "crop");
    }
}
