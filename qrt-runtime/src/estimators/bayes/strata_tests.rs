//! What counting by strata promises.

use crate::counting::Octaves;
use crate::estimators::{Device, Noise, Settings, estimator};
use crate::random::Stream;
use qrt_core::scene::{Counting, Estimator};

const BITS: u32 = 10;
const PATHS: u64 = 1 << 12;

/// Octaves of paths whose colours, in units of the scale, are `colour(u)` for u spread evenly.
fn octaves(colour: impl Fn(f64) -> f64) -> Octaves {
    let mut octaves = Octaves::new(BITS);
    for path in 0..PATHS {
        let u = (path as f64 + 0.5) / PATHS as f64;
        octaves.add((colour(u) * f64::from(1_u32 << BITS)).round() as u64);
    }
    octaves
}

fn shadowed(u: f64) -> f64 {
    let lit = 0.774;
    if u < 1.0 - lit { 0.0 } else { 0.0775 * (u - (1.0 - lit)) / lit }
}

fn gamma(u: f64) -> f64 {
    // Weibull with sigma/mean .85, mean .03.
    let k = 1.18;
    0.03 / 0.9447 * (-libm::log(1.0 - u)).powf(1.0 / k)
}

fn measure(octaves: &Octaves, queries: u64, strata: Option<u32>, runs: u32) -> (f64, f64, f64, f64, f64) {
    let settings = Settings { queries, strata, ..Settings::of(&Counting::default()).unwrap() };
    let est = estimator(Estimator::AdaptiveBayes, &settings).unwrap();
    let truth = octaves.good().iter().sum::<u64>() as f64 / (PATHS << BITS) as f64;
    let (mut sq, mut bias, mut held, mut n) = (0.0, 0.0, 0, 0.0);
    let mut errors = vec![];
    for run in 0..runs {
        let mut stream = Stream::new(3, run, 0, 0);
        let mut device = Device::of_octaves(octaves, Noise::NONE, &mut stream).unwrap();
        let e = est.estimate(&mut device).unwrap();
        assert!(e.queries <= queries);
        let err = e.amplitude - truth;
        errors.push(err.abs());
        sq += err * err; bias += err; n += f64::from(e.strata);
        held += u32::from(e.interval.0 <= truth + 1e-15 && truth - 1e-15 <= e.interval.1);
    }
    let r = f64::from(runs);
    errors.sort_by(f64::total_cmp);
    ((sq / r).sqrt(), errors[errors.len() * 95 / 100], bias / r, f64::from(held) / r, n / r)
}

#[test]
#[ignore]
fn scratch() {
    let cases: Vec<(&str, Octaves)> = vec![
        ("shadowed", octaves(shadowed)),
        ("weibull", octaves(gamma)),
        ("bernoulli", octaves(|u| f64::from(u < 0.03))),
        ("bern .3", octaves(|u| f64::from(u < 0.3))),
        ("zero", octaves(|_| 0.0)),
        ("all", octaves(|_| 1.0)),
        ("const .3", octaves(|_| 0.3)),
        ("const .01", octaves(|_| 0.01)),
        ("one path", octaves(|u| f64::from(u > 1.0 - 1.0 / PATHS as f64))),
        ("mix", octaves(|u| if u < 0.01 { 1.0 } else { 0.04 * u })),
        ("uniform", octaves(|u| u)),
    ];
    let runs: u32 = std::env::var("RUNS").map_or(400, |r| r.parse().unwrap());
    for (name, octaves) in &cases {
        for queries in [127, 255, 1023, 8191] {
            let base = measure(octaves, queries, Some(1), runs);
            print!("{name:10} {queries:5} rms {:.2e} q95 {:.2e} cov {:.3} |", base.0, base.1, base.3);
            for strata in [Some(3), Some(4), Some(5), None] {
                let f = measure(octaves, queries, strata, runs);
                print!(" {:?}: {:.2}/{:.2} b{:+.2} c{:.3} n{:.1} |", strata.unwrap_or(0), base.0 / f.0, base.1 / f.1, f.2 / f.0, f.3, f.4);
            }
            println!();
        }
    }
}
