//! Tests of estimates at the ends, and from shots without iterations.

use super::unbiased::{Evidence, amplitude};
use crate::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use crate::random::Stream;
use qrt_scene::{Counting, Estimator};

#[test]
fn black_stays_black_and_white_white() {
    let total = 1 << 40;
    for name in [Estimator::AdaptiveBayes, Estimator::RandomDepth] {
        for queries in [1, 2, 15, 63, 255, 4095] {
            let settings = Settings {
                queries,
                ..Settings::from_counting(&Counting::default()).unwrap()
            };
            let estimator = estimator(name, &settings).unwrap();
            for good in [0, total] {
                for run in 0..20 {
                    let mut stream = Stream::new(queries, run, 5, 0);
                    let problem = CountingProblem { good, total };
                    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                    let found = estimator.estimate(&mut device).unwrap().amplitude;
                    let truth = if good == 0 { 0.0 } else { 1.0 };
                    assert_eq!(found, truth, "{name}, {queries} queries");
                }
            }
        }
    }
}

/// Checks shots without iterations: with Haldane's prior the mean is h/n for h good ones of n.
///
/// Many shots leave none of the mass near the ends.
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
