//! The mean error of every estimator: the part of the error that a picture's average keeps.
//!
//! The unit is the standard error of a picture's mean: a pixel's RMSE over the square root of
//! the pixels, here 64 x 64. A bias below it cannot be seen in one picture's brightness.

use super::expected::{Expected, Verdicts};
use super::problems::TOTAL;
use super::runs::Run;
use qrt::counting::estimators::CountingProblem;
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::front;
use std::fmt::Write as _;
use std::path::Path;

/// Amplitudes that are measured one by one.
const AMPLITUDES: [f64; 8] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5];
/// Bits of the phase registers whose queries may be used.
const REGISTERS: [u32; 4] = [6, 8, 10, 12];
/// Width and height of the picture whose mean gives the unit.
const SIDE: f64 = 64.0;
/// Bits of the register at which random query depths are compared with sampling.
const COMPARED: u32 = 8;
const SCENES: [&str; 2] = ["cornell-box", "lit-box"];
/// Least bits with which only a sixteenth of the runs is made: phase registers take long to simulate, and
/// biases are small there.
const FEWER_FROM: u32 = 12;

/// An example scene's channels.
struct Picture {
    scene: &'static str,
    film: u32,
    /// Values by exact counting, by seed, which decides the paths.
    exact: Vec<Vec<f64>>,
}

impl Picture {
    fn new(scene: &'static str, film: u32, seeds: u64) -> Self {
        let mut picture = Self {
            scene,
            film,
            exact: Vec::new(),
        };
        let exact = ["counting.estimator=exact".to_owned()];
        let by_seed = (0..seeds).map(|seed| picture.values(&exact, seed));
        picture.exact = by_seed.collect();
        picture
    }

    /// Returns the values of all counted channels, from 2^9 paths a pixel.
    fn values(&self, sets: &[String], seed: u64) -> Vec<f64> {
        let mut all = vec![
            format!("film.width={}", self.film),
            format!("film.height={}", self.film),
            "sampling.path_bits=9".to_owned(),
        ];
        all.extend_from_slice(sets);
        let file = format!("scenes-yaml/{}.yaml", self.scene);
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let loaded = front::load(&path, &all).unwrap_or_else(|report| panic!("{report}"));
        let options = RenderOptions {
            model: Some(Model::Fixed),
            seed,
            ..RenderOptions::default()
        };
        let rendered = render(&loaded.valid, &options).unwrap_or_else(|error| panic!("{error}"));
        let counted = rendered.counts().filter(|count| count.scale > 0.0);
        counted.map(|count| count.value).collect()
    }
}

/// Errors of many runs.
struct Errors {
    /// Mean error.
    bias: f64,
    rmse: f64,
    /// Mean of the truth.
    mean: f64,
    runs: f64,
}

impl Errors {
    /// Computes the statistics of pairs of an error and the truth.
    fn of(runs: impl Iterator<Item = (f64, f64)>) -> Self {
        let [mut n, mut error, mut square, mut truth] = [0.0; 4];
        for (e, t) in runs {
            n += 1.0;
            error += e;
            square += e * e;
            truth += t;
        }
        Self {
            bias: error / n,
            rmse: f64::sqrt(square / n),
            mean: truth / n,
            runs: n,
        }
    }

    /// Returns the bias in standard errors of a picture's mean.
    fn in_standard_errors(&self) -> f64 {
        if self.rmse > 0.0 {
            self.bias * SIDE / self.rmse
        } else {
            0.0
        }
    }

    /// Returns the standard deviation of [`Self::in_standard_errors`].
    fn measured_to(&self) -> f64 {
        SIDE / self.runs.sqrt()
    }

    fn percent(&self, value: f64) -> f64 {
        100.0 * value / self.mean
    }
}

/// An estimator with its settings: a row of the table.
#[derive(Clone, Copy)]
struct Row {
    name: Estimator,
    /// `auto`, or a number of strata.
    strata: &'static str,
    bits: u32,
}

/// Measurements of all estimators.
struct Table {
    pictures: [Picture; 2],
    /// The same pictures with fewer pixels, from [`FEWER_FROM`] on.
    small: [Picture; 2],
    /// Renderings of each picture; one of each from [`FEWER_FROM`] on.
    seeds: u64,
    csv: String,
}

/// Prints the bias of each estimator and judges those of `adaptive-bayes` and `auto`. Returns all figures as CSV.
pub(crate) fn tables(names: &[Estimator], quick: bool, verdicts: &mut Verdicts) -> String {
    let (small, seeds) = if quick { (16, 1) } else { (32, 3) };
    let mut table = Table {
        pictures: SCENES.map(|scene| Picture::new(scene, 2 * small, seeds)),
        small: SCENES.map(|scene| Picture::new(scene, small, 1)),
        seeds,
        csv: String::from("estimator,strata,amplitudes,asked,bias,rmse,mean,runs\n"),
    };
    println!("\n### Bias\n");
    println!(
        "Of single amplitudes, the mean error. Of pictures, the mean error over the mean and,"
    );
    println!("in brackets, in standard errors of the mean of 64 x 64 pixels, +- their standard");
    println!("deviation; and the RMSE over the mean.\n");
    print!("| estimator | queries |");
    for a in AMPLITUDES {
        print!(" {a:e} |");
    }
    println!(" Cornell box | RMSE | lit box | RMSE |");
    println!("|{}", " --- |".repeat(2 + AMPLITUDES.len() + 4));
    let mut rmse_of = Vec::new();
    for &name in names {
        let strata: &[_] = if name == Estimator::AdaptiveBayes {
            &["auto", "4"]
        } else {
            &["auto"]
        };
        for &strata in strata {
            for bits in REGISTERS {
                let rmse = table.row(Row { name, strata, bits }, verdicts);
                if bits == COMPARED {
                    rmse_of.push((name, rmse));
                }
            }
        }
    }
    let of = |name| rmse_of.iter().find(|found| found.0 == name);
    if let (Some((name, random)), Some((_, sampling))) =
        (of(Estimator::RandomDepth), of(Estimator::MonteCarlo))
    {
        let what = format!(
            "{name}, cornell-box: RMSE {random:.1} % of the mean, sampling {sampling:.1} %"
        );
        verdicts.keep(random <= sampling, what);
    }
    table.csv
}

impl Table {
    /// Prints one row. Returns the RMSE on the first picture, in percent of its mean.
    fn row(&mut self, row: Row, verdicts: &mut Verdicts) -> f64 {
        let Row { name, strata, bits } = row;
        let run = Run {
            name,
            bits,
            repetitions: Expected::of(name).repetitions,
        };
        let asked = run.settings().queries;
        let (seeds, runs) = if bits < FEWER_FROM {
            (self.seeds, 4096 * self.seeds as u32)
        } else {
            (1, 256 * self.seeds as u32)
        };
        let by_strata = strata != "auto";
        let label = if by_strata {
            format!("{name}, {strata} strata")
        } else {
            name.to_string()
        };
        print!("| {label} | {asked} |");
        for a in AMPLITUDES {
            if by_strata || name.reads_levels() {
                // A single amplitude says nothing about the colours of paths.
                print!(" |");
                continue;
            }
            let good = (a * TOTAL as f64).round() as u64;
            let problem = CountingProblem { good, total: TOTAL };
            let outcomes = run.outcomes(runs, |_| problem);
            let found = Errors::of(outcomes.iter().map(|o| (o.error, o.truth)));
            print!(" {:+.1e} |", found.bias);
            self.note(row, &a.to_string(), asked, &found);
        }
        let mut rmses = [0.0; 2];
        for (place, rmse) in rmses.iter_mut().enumerate() {
            let picture = if bits < FEWER_FROM {
                &self.pictures[place]
            } else {
                &self.small[place]
            };
            let sets = [
                format!("counting.estimator={name}"),
                format!("counting.phase_bits={bits}"),
                format!("counting.repetitions={}", run.repetitions),
                format!("counting.strata={strata}"),
            ];
            let pairs = (0..seeds).flat_map(|seed| {
                let values = picture.values(&sets, seed).into_iter();
                let pairs = values.zip(&picture.exact[seed as usize]);
                pairs.map(|(value, &exact)| (value - exact, exact))
            });
            let (found, scene) = (Errors::of(pairs), picture.scene);
            let (errors, to) = (found.in_standard_errors(), found.measured_to());
            *rmse = found.percent(found.rmse);
            let bias = found.percent(found.bias);
            print!(" {bias:+.2} % ({errors:+.1} +- {to:.1}) | {rmse:.1} % |");
            self.note(row, scene, asked, &found);
            if matches!(name, Estimator::AdaptiveBayes | Estimator::Auto) && !by_strata {
                let what = format!(
                    "{name}, {scene}, {asked} queries: bias of {errors:.2} +- {to:.2} standard errors \
                     of the mean, at most 1"
                );
                verdicts.keep(errors.abs() <= 1.0 + 3.0 * to, what);
            }
        }
        println!();
        rmses[0]
    }

    /// Appends a line to the CSV file.
    fn note(&mut self, row: Row, on: &str, asked: u64, found: &Errors) {
        let (
            Row { name, strata, .. },
            Errors {
                bias,
                rmse,
                mean,
                runs,
            },
        ) = (row, found);
        let line = format!("{name},{strata},{on},{asked},{bias:e},{rmse:e},{mean:e},{runs}");
        writeln!(self.csv, "{line}").unwrap();
    }
}
