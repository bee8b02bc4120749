//! Measures the error of every estimator by its queries, and whether its intervals have the coverage
//! that they promise.
//!
//! `cargo bench --bench estimators` runs every estimator
//!
//! * on amplitudes spread evenly over [0, 1], and on the pixels of the Cornell box, at 63 to 8,191
//!   queries: the root mean square error, the 95th-percentile error, the slopes of both
//!   on logarithmic axes, and queries times error;
//! * 10,000 times on each of a few kinds of amplitudes, among many indices and few: the fraction of
//!   intervals that hold the amplitude;
//! * at amplitudes from 0 to 1/2 and on the pixels of two scenes: the bias, which no average over
//!   pixels takes away;
//! * by 1 to 6 strata of the comparator and by `auto`, on pixels whose colours are spread as light
//!   sampling spreads them, and on pixels whose paths are all or nothing: the savings of strata;
//!
//! prints all as Markdown tables, and fails if a figure is not within the range that `expected.rs`
//! gives with its source, or an interval holds more than a point less often than it says.
//! `--csv FILE` writes all measurements. `--quick` makes few runs and judges slopes and coverage
//! generously, in some two minutes. A name alone runs the estimators whose names contain it, `strata`
//! the tables of strata, and `bias` the biases of all.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod bias;
mod coverage;
mod expected;
mod problems;
mod runs;
mod strata;

use expected::{Expected, Verdicts};
use problems::Problems;
use qrt::scene::Estimator;
use runs::{Point, Run};
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

/// Arguments of the command line.
struct Arguments {
    quick: bool,
    csv: Option<String>,
    name: Option<String>,
}

impl Arguments {
    fn of_command_line() -> Self {
        let (mut quick, mut csv, mut name) = (false, None, None);
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--quick" => quick = true,
                "--csv" => csv = Some(arguments.next().expect("--csv FILE")),
                // Cargo adds it.
                "--bench" => {}
                _ => name = Some(argument),
            }
        }
        Self { quick, csv, name }
    }
}

fn main() -> ExitCode {
    let asked = Arguments::of_command_line();
    let names = Estimator::ALL.iter().copied().filter(|&estimator| {
        let asked = asked.name.as_ref();
        estimator != Estimator::Exact
            && asked.is_none_or(|name| name == "bias" || estimator.name().contains(name))
    });
    let names: Vec<Estimator> = names.collect();
    let registers = if asked.quick { 6..=10 } else { 6..=13 };
    let mut csv = String::from("estimator,amplitudes,asked,queries,rmse,q95,seconds_a_run\n");
    let mut verdicts = Verdicts::default();

    let begin = Instant::now();
    if asked.name.as_deref() == Some("strata") {
        let csv = strata::tables(asked.quick, &mut verdicts);
        return finish(&asked, begin, &csv, &verdicts);
    }
    if asked.name.as_deref() == Some("bias") {
        let csv = bias::tables(&names, asked.quick, &mut verdicts);
        return finish(&asked, begin, &csv, &verdicts);
    }
    let kinds = [Problems::even(), Problems::pixels(asked.quick)];
    eprintln!("{}", kinds[1]);
    for problems in &kinds {
        println!("\n### {problems}\n");
        println!("| estimator | RMSE x queries | slope | q95 x queries | slope | us a run |");
        println!("| --- | --- | --- | --- | --- | --- |");
        for &name in &names {
            let expected = Expected::of(name);
            let points: Vec<Point> = registers
                .clone()
                .map(|bits| {
                    let run = Run {
                        name,
                        bits,
                        repetitions: expected.repetitions,
                    };
                    run.point(problems, expected.runs(asked.quick))
                })
                .collect();
            for point in &points {
                writeln!(csv, "{name},{},{point}", problems.name()).unwrap();
            }
            println!("| {name} {}", runs::row(&points));
            verdicts.judge(name, &expected, problems, &points, asked.quick);
        }
    }

    println!("\n### Coverage of the intervals\n");
    coverage::table(&names, asked.quick, &mut verdicts);
    bias::tables(&names, asked.quick, &mut verdicts);
    if asked.name.is_none() {
        strata::tables(asked.quick, &mut verdicts);
    }
    finish(&asked, begin, &csv, &verdicts)
}

/// Prints the verdicts, and writes the measurements to the file of `--csv`.
fn finish(asked: &Arguments, begin: Instant, csv: &str, verdicts: &Verdicts) -> ExitCode {
    println!("\n{verdicts}");
    println!("{:.0} seconds", begin.elapsed().as_secs_f64());
    if let Some(file) = &asked.csv {
        std::fs::write(file, csv).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
    ExitCode::from(u8::from(!verdicts.all_kept()))
}
