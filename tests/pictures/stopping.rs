//! Tests of `counting.error`: a channel stops once its interval is narrow enough.

use crate::common::scene::written;
use qrt::runtime::render::{Colour, Model, RenderOptions, Rendered, render};
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;

/// A grey floor under a lamp whose blue, and with it the scale of blue, is a twentieth of its red.
const FLOOR: &str = "
name: floor
camera: { perspective: { eye: [0, 1, 2], target: [0, 0.2, 0], vfov: 60 } }
film: { width: 8, height: 6 }
materials:
  floor: { lambertian: { albedo: [0.5, 0.5, 0.5] } }
  lamp: { emitter: { radiance: [4, 2, 0.2] } }
geometry:
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor }
  - quad: { vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], material: lamp }
sampling: { path_bits: 6, depths: [{ bits: [8, 8] }, { bits: [8, 8], light: [8, 8] }] }
comparator: { bits: 12 }
counting: { phase_bits: 16 }
";

fn scene(error: f64) -> ValidScene {
    written(FLOOR, &[&format!("counting.error={error}")])
}

fn counted(error: f64, estimator: Estimator, colour: Colour) -> Rendered {
    let options = RenderOptions {
        model: Some(Model::Fixed),
        estimator: Some(estimator),
        colour,
        ..RenderOptions::default()
    };
    render(&scene(error), &options).unwrap()
}

fn exact() -> Rendered {
    counted(1.0, Estimator::Exact, Colour::ThreeRuns)
}

/// Returns the fraction of all channels within `error` of the exact picture.
fn share(found: &Rendered, error: f64) -> f64 {
    let exact = exact();
    let pairs = found.image.pixels.iter().zip(&exact.image.pixels);
    let channels: Vec<f64> = pairs
        .flat_map(|(a, b)| [0, 1, 2].map(|c| (a[c] - b[c]).abs()))
        .collect();
    let within = channels.iter().filter(|off| **off <= error).count();
    within as f64 / channels.len() as f64
}

/// Intervals in radiance have their coverage, 95 %. All of them stop far below their queries.
#[test]
fn what_stops_by_itself_stops_within_the_error() {
    let stopping = Estimator::ALL.iter().copied();
    let mut tried = 0;
    for estimator in stopping.filter(|estimator| estimator.stops_itself()) {
        // A coin takes 1/error^2 queries, and for a small error more than it has.
        let slow = [
            Estimator::MonteCarlo,
            Estimator::Qcoin,
            Estimator::AbramsWilliams,
        ];
        let error = if slow.contains(&estimator) { 0.1 } else { 0.01 };
        let found = counted(error, estimator, Colour::ThreeRuns);
        assert!(
            share(&found, error) >= 0.93,
            "{estimator}: {}",
            share(&found, error)
        );
        let most = found.counted.queries.iter().max();
        assert!(most < Some(&(3 * 65535)), "{estimator}: {most:?}");
        tried += 1;
    }
    assert_eq!(tried, 11);
}

#[test]
fn queries_follow_the_error_and_not_the_limit() {
    let sum = |error| {
        let found = counted(error, Estimator::AdaptiveBayes, Colour::ThreeRuns);
        found.total_queries() as f64
    };
    let [coarse, fine] = [sum(0.02), sum(0.005)];
    assert!((3.0..6.0).contains(&(fine / coarse)), "{coarse} {fine}");
    // No interval of blue, whose scale is 0.2, is wider than 0.2, so it takes almost no queries.
    let blind = counted(10.0, Estimator::AdaptiveBayes, Colour::ThreeRuns);
    let most = blind.counted.queries.iter().max();
    assert!(most < Some(&100), "{most:?}");
}

#[test]
fn one_run_stops_at_the_luminance() {
    let found = counted(0.01, Estimator::AdaptiveBayes, Colour::OneRun);
    let exact = exact();
    let luminance = |[r, g, b]: &[f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let pairs = found.image.pixels.iter().zip(&exact.image.pixels);
    let off = pairs.map(|(a, b)| (luminance(a) - luminance(b)).abs());
    let within = off.filter(|off| *off <= 0.01).count();
    assert!(within >= 44, "{within}");
    let three = counted(0.01, Estimator::AdaptiveBayes, Colour::ThreeRuns);
    assert!(found.total_queries() < three.total_queries());
}

#[test]
fn the_error_is_told_where_it_counts() {
    let told = |estimator| {
        let found = counted(0.25, estimator, Colour::ThreeRuns);
        let metadata = found.metadata().unwrap();
        metadata.get("counting_error").map(str::to_owned)
    };
    assert_eq!(told(Estimator::AdaptiveBayes).as_deref(), Some("0.25"));
    assert_eq!(told(Estimator::Sine), None);
}
