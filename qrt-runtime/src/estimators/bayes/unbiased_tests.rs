//! Bias of the estimates of dark pictures.

use super::unbiased::{Evidence, amplitude};
use crate::estimators::{Device, Noise, Problem, Settings, estimator};
use crate::random::Stream;
use crate::render::{Model, Options, render};
use qrt_core::front;
use qrt_core::scene::{Counting, Estimator};
use std::path::Path;

/// Width and height of the picture, whose mean has the standard error RMSE/SIDE.
const SIDE: u32 = 64;

/// Errors of a picture's channels.
struct Errors {
    /// Mean error over the mean.
    bias: f64,
    /// Root mean square over the mean.
    rmse: f64,
    channels: f64,
}

impl Errors {
    /// The bias in standard errors of the picture's mean, and the standard deviation of this number.
    fn in_standard_errors(&self) -> [f64; 2] {
        let side = f64::from(SIDE);
        [self.bias * side / self.rmse, side / self.channels.sqrt()]
    }
}

/// Renders an example scene `seeds` times with a phase register of so many bits and compares it with the
/// exact counts.
fn errors(scene: &str, estimator: Estimator, phase_bits: u32, seeds: u64) -> Errors {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes-yaml/{scene}.yaml"));
    let sets = [
        format!("film.width={SIDE}"),
        format!("film.height={SIDE}"),
        "sampling.path_bits=9".to_owned(),
        format!("counting.phase_bits={phase_bits}"),
    ];
    let loaded = front::load(&path, &sets).unwrap();
    let rendered = |estimator, seed| {
        let options = Options {
            model: Model::Fixed,
            estimator: Some(estimator),
            seed,
            ..Options::default()
        };
        let counts: Vec<_> = render(&loaded.valid, &options).unwrap().counts().collect();
        counts.into_iter().filter(|count| count.scale > 0.0)
    };
    let exact: Vec<f64> = rendered(Estimator::Exact, 0).map(|c| c.value).collect();
    let (mut sum, mut squares) = (0.0, 0.0);
    for seed in 0..seeds {
        for (count, exact) in rendered(estimator, seed).zip(&exact) {
            let error = count.value - exact;
            sum += error;
            squares += error * error;
        }
    }
    let channels = exact.len() as f64 * seeds as f64;
    let mean = exact.iter().sum::<f64>() / exact.len() as f64;
    Errors {
        bias: sum / channels / mean,
        rmse: (squares / channels).sqrt() / mean,
        channels,
    }
}

/// Measured to 0.33 standard errors of the picture's mean, of which three are allowed on top of one. Under
/// a prior that is even in the amplitude the Cornell box has 16 with 63 queries.
#[test]
fn a_picture_counted_with_few_queries_is_as_bright_as_it_is() {
    for scene in ["cornell-box", "lit-box"] {
        for phase_bits in [6, 8] {
            let found = errors(scene, Estimator::AdaptiveBayes, phase_bits, 3);
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
    let rmse = |name| errors("cornell-box", name, 8, 1).rmse;
    let [random, sampling] = [Estimator::RandomDepth, Estimator::MonteCarlo].map(rmse);
    assert!(
        random < sampling,
        "{random:.3} and {sampling:.3} of the mean"
    );
}

#[test]
fn black_stays_black_and_white_white() {
    let total = 1 << 40;
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        for queries in [1, 2, 15, 63, 255, 4095] {
            let settings = Settings {
                queries,
                ..Settings::of(&Counting::default()).unwrap()
            };
            let estimator = estimator(name, &settings).unwrap();
            for good in [0, total] {
                for run in 0..20 {
                    let mut stream = Stream::new(queries, run, 5, 0);
                    let problem = Problem { good, total };
                    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                    let found = estimator.estimate(&mut device).unwrap().amplitude;
                    let truth = if good == 0 { 0.0 } else { 1.0 };
                    assert_eq!(found, truth, "{name}, {queries} queries");
                }
            }
        }
    }
}

/// Plain shots, h of n of them good: with Haldane's prior the mean is h/n, for any h. Many shots
/// leave nothing of the mass near the ends.
#[test]
fn plain_shots_give_the_fraction_of_good_ones() {
    let n = 4000;
    for good in [0, n / 4, n / 2, n - 400, n] {
        let bad = n - good;
        let fraction = f64::from(good) / f64::from(n);
        let points = (1..40_000).map(|i| {
            let a = f64::from(i) / 40_000.0;
            let ln = |count: u32, p: f64| f64::from(count) * libm::log(p);
            let peak = |count: u32, p: f64| if count == 0 { 0.0 } else { ln(count, p) };
            let most = peak(good, fraction) + peak(bad, 1.0 - fraction);
            (libm::exp(ln(good, a) + ln(bad, 1.0 - a) - most), a)
        });
        let evidence = Evidence {
            good: u64::from(good),
            bad: u64::from(bad),
            resolution: f64::from(n),
        };
        let found = amplitude(points, evidence).unwrap();
        // A thousandth of the standard deviation of h/n, at most.
        assert!((found - fraction).abs() < 1e-5, "{good}: {found}");
    }
}
