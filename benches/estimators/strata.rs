//! Savings by strata of the comparator.
//!
//! Errors fall as one over the queries, so the ratio of two errors at equal queries is the ratio of
//! the queries for equal errors. The queries with which `auto` chooses the strata count, too.

use super::expected::Verdicts;
use qrt::counting::Octaves;
use qrt::counting::estimators::{Device, Noise, Settings, estimator};
use qrt::counting::random::Stream;
use qrt::scene::{Counting, Estimator};
use std::fmt::Write as _;

const COMPARATOR_BITS: u32 = 10;
const PATHS: u64 = 1 << 12;
/// Bits of the phase registers whose queries may be used.
const REGISTERS: [u32; 4] = [8, 10, 12, 13];
/// Least bits for which the saving is promised: with fewer queries, the search in each stratum dominates.
const PROMISED_FROM: u32 = 12;

/// Distribution of the colours of a pixel's paths, in units of their bound.
struct Pixel {
    name: &'static str,
    colour: fn(f64) -> f64,
}

/// All have a mean of 0.03.
const PIXELS: [Pixel; 3] = [
    // A deviation of 0.85 of the mean: some paths are in shadow, the others spread evenly.
    Pixel {
        name: "light sampling",
        colour: |u| 0.1 * (u - 0.226).max(0.0),
    },
    // The same deviation with an endless tail: Weibull's distribution.
    Pixel {
        name: "light sampling, long tail",
        colour: |u| (0.031_76 * (-(1.0 - u).ln()).powf(1.0 / 1.18)).min(1.0),
    },
    Pixel {
        name: "all or nothing",
        colour: |u| if u < 0.03 { 1.0 } else { 0.0 },
    },
];

const STRATA: [(Option<u32>, &str); 6] = [
    (Some(1), "1"),
    (Some(2), "2"),
    (Some(3), "3"),
    (Some(4), "4"),
    (Some(6), "6"),
    (None, "auto"),
];

impl Pixel {
    fn octaves(&self) -> Octaves {
        let mut octaves = Octaves::new(COMPARATOR_BITS);
        for path in 0..PATHS {
            let u = (path as f64 + 0.5) / PATHS as f64;
            let count = (self.colour)(u) * f64::from(1_u32 << COMPARATOR_BITS);
            octaves.add(count.round() as u64);
        }
        octaves
    }

    /// Returns the root mean square and the 95th-percentile error of `runs` runs.
    fn errors(&self, bits: u32, strata: Option<u32>, runs: u32) -> [f64; 2] {
        let counting = Counting {
            phase_bits: bits,
            strata,
            ..Counting::default()
        };
        let settings = Settings::from_counting(&counting).unwrap();
        let estimator = estimator(Estimator::AdaptiveBayes, &settings).unwrap();
        let octaves = self.octaves();
        let good: u64 = (octaves.good().iter()).sum();
        let truth = good as f64 / (PATHS << COMPARATOR_BITS) as f64;
        let one = |run: u32| {
            let mut stream = Stream::new(u64::from(bits), run, 0, 0);
            let mut device = Device::of_octaves(&octaves, Noise::NONE, &mut stream).unwrap();
            (estimator.estimate(&mut device).unwrap().amplitude - truth).abs()
        };
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
        let mut errors: Vec<f64> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|t| {
                    let one = &one;
                    let share = t * runs / threads..(t + 1) * runs / threads;
                    scope.spawn(move || share.map(one).collect::<Vec<_>>())
                })
                .collect();
            let joined = workers.into_iter().map(|worker| worker.join().unwrap());
            joined.flatten().collect()
        });
        errors.sort_by(f64::total_cmp);
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        [
            (squares / f64::from(runs)).sqrt(),
            errors[(runs - 1) as usize * 95 / 100],
        ]
    }
}

/// Prints the savings of strata on every pixel, and judges them; returns all measurements as CSV.
pub(crate) fn tables(quick: bool, verdicts: &mut Verdicts) -> String {
    let runs = if quick { 600 } else { 2000 };
    let mut csv = String::from("pixel,queries,strata,rmse,q95\n");
    for pixel in &PIXELS {
        println!("\n### Strata: {}\n", pixel.name);
        println!("| queries | 1: q95 x queries | 2 | 3 | 4 | 6 | auto |");
        println!("| --- | --- | --- | --- | --- | --- | --- |");
        // Sums of the logarithms of promised savings and their number, by number of strata.
        let mut savings = [(0.0, 0.0); STRATA.len()];
        for bits in REGISTERS {
            let queries = (1_u64 << bits) - 1;
            let mut cells = String::new();
            let mut whole = 0.0;
            for ((strata, name), saving) in STRATA.into_iter().zip(&mut savings) {
                let [rmse, q95] = pixel.errors(bits, strata, runs);
                writeln!(csv, "{},{queries},{name},{rmse},{q95}", pixel.name).unwrap();
                if strata == Some(1) {
                    whole = q95;
                    write!(cells, " {:.2} |", q95 * queries as f64).unwrap();
                } else {
                    write!(cells, " {:.2} |", whole / q95).unwrap();
                }
                if bits >= PROMISED_FROM {
                    saving.0 += (whole / q95).ln();
                    saving.1 += 1.0;
                }
            }
            println!("| {queries} |{cells}");
        }
        let slack = if quick { 0.9 } else { 1.0 };
        let promises: &[(&str, f64)] = match pixel.name {
            "light sampling" => &[("4", 2.2), ("auto", 2.2)],
            "all or nothing" => &[("auto", 0.95)],
            _ => &[("4", 1.5), ("auto", 1.5)],
        };
        for (name, promised) in promises {
            let place = STRATA.iter().position(|(_, other)| other == name).unwrap();
            let saving = (savings[place].0 / savings[place].1).exp();
            verdicts.keep(
                saving >= slack * promised,
                format!(
                    "{}, strata {name}: {saving:.2} times fewer queries, at least {promised}",
                    pixel.name
                ),
            );
        }
    }
    csv
}
