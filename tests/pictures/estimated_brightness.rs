//! Tests that pictures counted with few queries have the right brightness.

use qrt::prelude::*;
use qrt::scene::Estimator;
use qrt::scene::front;
use std::path::Path;

/// Width and height of the picture, whose mean has the standard error RMSE/SIDE.
const SIDE: u32 = 32;

/// Errors of a picture's channels.
struct Errors {
    /// Mean error over the mean.
    bias: f64,
    /// Root mean square over the mean.
    rmse: f64,
    channels: f64,
}

impl Errors {
    /// Returns the bias in standard errors of the picture's mean, and the standard deviation of this number.
    fn in_standard_errors(&self) -> [f64; 2] {
        let side = f64::from(SIDE);
        [self.bias * side / self.rmse, side / self.channels.sqrt()]
    }
}

/// Compares an example scene, counted with a phase register of `phase_bits` bits, with the exact counts.
fn errors(scene: &str, estimator: Estimator, phase_bits: u32) -> Errors {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes-yaml/{scene}.yaml"));
    let sets = [
        format!("film.width={SIDE}"),
        format!("film.height={SIDE}"),
        "sampling.path_bits=9".to_owned(),
        format!("counting.phase_bits={phase_bits}"),
    ];
    let loaded = front::load(&path, &sets).unwrap();
    let rendered = |estimator| {
        let options = RenderOptions {
            model: Some(Model::Fixed),
            estimator: Some(estimator),
            ..RenderOptions::default()
        };
        let counts: Vec<_> = render(&loaded.valid, &options).unwrap().counts().collect();
        counts.into_iter().filter(|count| count.scale > 0.0)
    };
    let exact: Vec<f64> = rendered(Estimator::Exact).map(|c| c.value).collect();
    let (mut sum, mut squares) = (0.0, 0.0);
    for (count, exact) in rendered(estimator).zip(&exact) {
        let error = count.value - exact;
        sum += error;
        squares += error * error;
    }
    let channels = exact.len() as f64;
    let mean = exact.iter().sum::<f64>() / channels;
    Errors {
        bias: sum / channels / mean,
        rmse: (squares / channels).sqrt() / mean,
        channels,
    }
}

/// The measurement has a deviation of 0.58 standard errors of the picture's mean, of which the test allows three
/// in addition to one. Under a prior that is even in the amplitude the Cornell box has 8 with 63 queries.
#[test]
fn a_picture_counted_with_few_queries_is_as_bright_as_it_is() {
    for scene in ["cornell-box", "lit-box"] {
        for phase_bits in [6, 8] {
            let found = errors(scene, Estimator::AdaptiveBayes, phase_bits);
            let [bias, deviation] = found.in_standard_errors();
            assert!(
                bias.abs() < 1.0 + 3.0 * deviation,
                "{scene}, {phase_bits} bits: {:.2} % of the mean, {bias:.1} standard errors",
                100.0 * found.bias
            );
        }
    }
}

/// A bright mode that an even prior prefers would make errors of 1.5 of the mean.
#[test]
fn random_depths_have_less_error_than_sampling_on_pixels() {
    let rmse = |name| errors("cornell-box", name, 8).rmse;
    let [random, sampling] = [Estimator::RandomDepth, Estimator::MonteCarlo].map(rmse);
    assert!(
        random < sampling,
        "{random:.3} and {sampling:.3} of the mean"
    );
}
