//! The error of every estimator by its queries, and the coverage of its intervals.

use super::coverage;
use super::expected::{Expected, Verdicts};
use super::problems::Problems;
use super::runs::{self, Point, Run};
use crate::common::{Arguments, Promises};
use qrt::scene::Estimator;
use std::fmt::Write as _;

/// Runs the estimators whose names contain the first word, or all.
pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    let quick = arguments.flag("--quick");
    let asked = arguments.word().unwrap_or("");
    let names = super::estimators().filter(|estimator| estimator.name().contains(asked));
    let names: Vec<Estimator> = names.collect();
    let registers = if quick { 6..=10 } else { 6..=13 };
    let mut csv = String::from("estimator,amplitudes,asked,queries,rmse,q95,seconds_a_run\n");
    let mut verdicts = Verdicts::default();
    let kinds = [Problems::even(), Problems::pixels(quick)];
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
                    run.point(problems, expected.runs(quick))
                })
                .collect();
            for point in &points {
                writeln!(csv, "{name},{},{point}", problems.name()).unwrap();
            }
            println!("| {name} {}", runs::row(&points));
            verdicts.judge(name, &expected, problems, &points, quick);
        }
    }
    println!("\n### Coverage of the intervals\n");
    coverage::table(&names, quick, &mut verdicts);
    verdicts.finish(promises);
    if let Some(file) = arguments.csv() {
        std::fs::write(file, csv).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
}
