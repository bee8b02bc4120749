//! Measures the error of every estimator by its queries, and whether its intervals have the coverage
//! that they promise.
//!
//! Parts:
//!
//! * `errors`: on amplitudes spread evenly over [0, 1], and on the pixels of the Cornell box, at 63 to
//!   8,191 queries: the root mean square error, the 95th-percentile error, the slopes of both on
//!   logarithmic axes, and queries times error; and, 10,000 times on each of a few kinds of
//!   amplitudes, among many indices and few, the fraction of intervals that hold the amplitude. A
//!   word behind `errors` runs the estimators whose names contain it;
//! * `bias`: at amplitudes from 0 to 1/2 and on the pixels of two scenes, the bias, which no average
//!   over pixels takes away;
//! * `strata`: by 1 to 6 strata of the comparator and by `auto`, on pixels whose colours are spread as
//!   light sampling spreads them, and on pixels whose paths are all or nothing, the savings of strata;
//! * `mean`: the mean phase on pixels of six scenes, beside counting;
//! * `rendering`: the estimators of quantum rendering, their coverage, convergence and time;
//! * `noise`: the errors on noisy devices;
//! * `counting`: the price of draws and estimates.
//!
//! The first three print Markdown tables, and fail if a figure is not within the range that
//! `expected.rs` gives with its source, or an interval holds more than a point less often than it
//! says. `--quick` has them make few runs and judge slopes and coverage generously, in some two
//! minutes. `--csv FILE` writes the measurements of `errors`, or of the part that is named.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod bias;
#[path = "../common/mod.rs"]
mod common;
mod counting;
mod coverage;
mod errors;
mod expected;
mod mean;
mod noise;
mod problems;
mod rendering;
mod runs;
mod strata;

use common::{Arguments, Promises};
use expected::Verdicts;
use qrt::scene::Estimator;
use std::process::ExitCode;

fn main() -> ExitCode {
    common::run(&[
        ("errors", errors::run),
        ("bias", biases),
        ("strata", strata),
        ("mean", mean::run),
        ("rendering", rendering::run),
        ("noise", noise::run),
        ("counting", counting::run),
    ])
}

/// Returns the estimators without the one that knows the amplitude.
fn measuring() -> impl Iterator<Item = Estimator> {
    let all = Estimator::ALL.iter().copied();
    all.filter(|&estimator| estimator != Estimator::Exact)
}

/// Returns those that need no levels of paths: the part `mean` measures the others.
fn estimators() -> impl Iterator<Item = Estimator> {
    measuring().filter(|estimator| !estimator.reads_levels())
}

/// `bias NAME` measures the estimator of that name alone.
fn biases(arguments: &Arguments, promises: &mut Promises) {
    let word = arguments.word().filter(|_| arguments.names("bias"));
    let asked = |name: &Estimator| word.is_none_or(|word| word == name.to_string());
    let names: Vec<Estimator> = measuring().filter(asked).collect();
    assert!(!names.is_empty(), "no estimator of that name");
    let mut verdicts = Verdicts::default();
    let csv = bias::tables(&names, arguments.flag("--quick"), &mut verdicts);
    finish("bias", arguments, &csv, &verdicts, promises);
}

fn strata(arguments: &Arguments, promises: &mut Promises) {
    let mut verdicts = Verdicts::default();
    let csv = strata::tables(arguments.flag("--quick"), &mut verdicts);
    finish("strata", arguments, &csv, &verdicts, promises);
}

/// Prints the verdicts of a part, and writes its measurements to the file of `--csv` if it is named.
fn finish(
    part: &str,
    arguments: &Arguments,
    csv: &str,
    verdicts: &Verdicts,
    promises: &mut Promises,
) {
    verdicts.finish(promises);
    if let (Some(file), true) = (arguments.csv(), arguments.names(part)) {
        std::fs::write(file, csv).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
}
