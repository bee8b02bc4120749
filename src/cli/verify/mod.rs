//! `qrt verify`: checks the three models of a scene against each other.

mod parts;

use super::args::{SceneArgs, ThreadsArgs};
use super::failure::Failure;
use super::path;
use super::prepare::{self, Preparation};
use super::progress::Bar;
use super::{interrupt, terminal, time};
use clap::Args;
use qrt_core::inspect::grouped;
use qrt_core::oracle::OracleCost;
use qrt_lab::json::{self, VerifyFigures};
use qrt_lab::verify::{CIRCUIT, Mismatch, VerifyOptions, VerifyReport, verify_prepared};
use qrt_runtime::memory::CircuitWork;
use qrt_runtime::plan::PlanOptions;
use qrt_runtime::render::{Model, Portion, out_of_bounds_advice};
use qrt_runtime::workers::Workers;
use qrt_scene::valid::ValidScene;
use serde_json::Value;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// Check a scene's circuit, path by path
///
/// Runs the same paths on all three models. The oracle's integers (fixed) and its circuit (gates)
/// must agree bit for bit, in every path's colour and in how many comparators it exceeds; every
/// qubit that the circuit borrows must be zero again; the phase must be flipped for exactly the
/// comparators below the colour. How far floating point (real) is from the integers is measured:
/// E_W, the error that the registers' width leaves in a pixel.
///
/// A scene that asks for an `accuracy` is checked with the parameters that are chosen for it.
///
/// Exits with 0 if all of it holds, and with 1 if not, naming the path, its pixel and the register.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt verify box.yaml                                   16 pixels, all their paths
  qrt verify box.yaml --pixels 1000000                  all pixels
  qrt verify box.yaml --pixels 1000000 --portion 3/100 --json > 3.json
                                                        the fourth of a hundred portions of them
  qrt verify box.yaml --pixels 1000000 --parts *.json   all of them, put together
  qrt verify box.yaml --set precision.fraction=20 --json")]
pub(crate) struct VerifyArgs {
    /// Pixels to check, spread over the film; all of them if it has fewer
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16,
        value_parser = clap::value_parser!(u64).range(1..)
    )]
    pixels: u64,
    /// Another seed gives other paths
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Check only portion K (from 0) of N of these pixels, for one of several processes: where each
    /// exits with 0, all of it holds
    #[arg(
        long,
        value_name = "K/N",
        allow_hyphen_values = true,
        conflicts_with = "parts"
    )]
    portion: Option<Portion>,
    /// Check nothing, and put the answers of all portions together: what --portion K/N --json has
    /// written for every K, of this scene, these pixels and this seed, in any order
    #[arg(long, value_name = "FILE.json", num_args = 1..)]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// JSON instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scene: SceneArgs,
}

/// Prints the result of the check on standard output.
///
/// # Errors
/// An invalid scene, an interruption, and a failed check.
pub(crate) fn run(args: &VerifyArgs) -> Result<(), Failure> {
    let cancel = interrupt::cancel_on_interrupt()?;
    let loaded = args.scene.load()?;
    let bar = Bar::paths(!args.json);
    let show = |progress| bar.show(progress);
    let workers = Workers {
        threads: args.threads.count(),
        cancel: Some(&cancel),
        progress: Some(&show),
    };
    let preparation = Preparation {
        memory: args.scene.memory(),
        planning: PlanOptions {
            workers,
            ..PlanOptions::default()
        },
        shows_plan: !args.json,
    };
    let prepared = preparation.prepare(&loaded)?;
    let scene = prepared.scene();
    let options = VerifyOptions {
        pixels: args.pixels,
        portion: args.portion.unwrap_or_default(),
        seed: args.seed,
        workers,
    };
    let found = if args.parts.is_empty() {
        let work = CircuitWork::gates(args.threads.count());
        prepare::compile(&prepared, &loaded, ([0, 0], work))?;
        let checked = prepared.check_budget();
        checked.map_err(|error| prepare::refused(error, &loaded))?;
        let film = scene.scene().film;
        let pixels = (f64::from(film.width) * f64::from(film.height)).min(args.pixels as f64);
        let pixels = pixels / f64::from(options.portion.count());
        time::tell_of_paths(&prepared, pixels, 1.0, &Model::ALL, args.threads.or_cores());
        let start = Instant::now();
        bar.set_up();
        let verified = verify_prepared(&prepared, &options);
        bar.clear();
        Found::from_report(verified?, start.elapsed().as_secs_f64())
    } else {
        parts::put_together(&args.parts, scene, &options)?
    };
    let answer = if args.json {
        let figures = VerifyFigures {
            scene,
            seed: args.seed,
            portion: args.portion,
            report: &found.report,
            defect: found.defect.as_ref(),
            seconds: found.seconds,
        };
        format!("{:#}\n", json::verify(&figures))
    } else {
        text(args, scene, &found)
    };
    terminal::print(&answer)?;
    match fault(&found) {
        None => Ok(()),
        Some(fault) => {
            let advice = advice(&found, scene, args.seed);
            Err(Failure::Job(format!("{fault}; {advice}")))
        }
    }
}

/// The result of a check: its own report, or that of all portions.
struct Found {
    report: VerifyReport,
    /// Defect of the circuit, in the form of the JSON answer.
    defect: Option<Value>,
    /// Wall time of the check, in seconds; for portions, the sum.
    seconds: f64,
}

impl Found {
    fn from_report(report: VerifyReport, seconds: f64) -> Self {
        Self {
            defect: (report.defect.as_ref())
                .map(|defect| json::defect(defect, report.defect_model)),
            report,
            seconds,
        }
    }

    fn holds(&self) -> bool {
        self.report.mismatched == 0 && self.defect.is_none()
    }

    /// Returns the path whose colour exceeds its bound, if that is the defect: model, pixel and index.
    fn beyond_bound(&self) -> Option<(Model, [u32; 2], u64)> {
        let defect = self.defect.as_ref()?;
        let name = defect["model"].as_str()?;
        let model = Model::ALL.into_iter().find(|model| model.name() == name)?;
        let pixel = parts::pixel(&defect["pixel"])?;
        Some((model, pixel, defect["id"].as_u64()?))
    }

    /// Returns the defect in words.
    fn defect(&self) -> Option<&str> {
        self.defect.as_ref()?["message"].as_str()
    }
}

/// Returns advice on a failed check, with the hits of the path whose colour exceeds its bound.
fn advice(found: &Found, scene: &ValidScene, seed: u64) -> String {
    let Some((model, pixel, id)) = found.beyond_bound() else {
        return "this is a defect of qrt, please report it with the scene".to_owned();
    };
    // Gates that exceed a bound which the integers keep are a defect, however coarse the numbers are.
    let fraction = (model == Model::Fixed).then_some(found.report.fraction);
    let path = path::in_words(scene, model, seed, pixel, id);
    out_of_bounds_advice(fraction) + &path
}

/// Returns the defect or the first mismatch in words, if the check failed.
fn fault(found: &Found) -> Option<String> {
    if let Some(defect) = found.defect() {
        return Some(defect.to_owned());
    }
    let report = &found.report;
    let first = report.mismatches.first().map(shown)?;
    let pairs = match report.mismatched {
        1 => "a path".to_owned(),
        n => format!("{n} of {} path colours", 3 * report.paths),
    };
    Some(format!("the models disagree on {pairs}: {first}"))
}

fn shown(mismatch: &Mismatch) -> String {
    let Mismatch {
        pixel: [x, y],
        id,
        channel,
        fixed,
        gates,
        thresholds,
    } = mismatch;
    format!(
        "path {id} of pixel ({x}, {y}), {}: `colour.{}` is {} by fixed and {} by gates, `count` \
         {} and {}, and the colour exceeds {thresholds} thresholds",
        CHANNELS[*channel],
        &CHANNELS[*channel][..1],
        fixed[0],
        gates[0],
        fixed[1],
        gates[1],
    )
}

fn text(args: &VerifyArgs, scene: &ValidScene, found: &Found) -> String {
    let Found {
        report, seconds, ..
    } = found;
    let film = &scene.scene().film;
    let pixels = report.pixels.len();
    let mut out = format!(
        "{}: {pixels} of {} pixels, {} paths, on {} qubits and {} gates, in {seconds:.2} s\n\
         the circuit has {CIRCUIT}\n\n",
        args.scene.scene.display(),
        u64::from(film.width) * u64::from(film.height),
        report.paths,
        report.qubits,
        report.gates,
    );
    let mut line = |name: &str, value: &str| {
        let _ = writeln!(out, "  {name:<34}{value}");
    };
    if let Some(defect) = found.defect() {
        line("circuit", &format!("wrong: {defect}"));
    } else {
        line("every borrowed qubit zero again", "yes, on every path");
        line(
            "phases flipped as compared",
            "yes, for every colour and comparator tried",
        );
        let agree = match report.mismatched {
            0 => "yes, bit for bit".to_owned(),
            n => format!("NO: {n} of {} path colours differ", 3 * report.paths),
        };
        line("fixed and gates agree", &agree);
        for mismatch in &report.mismatches {
            line("", &shown(mismatch));
        }
        let [red, green, blue] = report.width_error;
        line(
            "fixed against real: E_W",
            &format!("{red:.3e} {green:.3e} {blue:.3e} (red, green, blue: RMSE over pixels)"),
        );
        let relative = report.relative_error().map_or_else(
            || "nothing is bright".to_owned(),
            |error| {
                format!(
                    "{:.4} % of the mean, with {} fraction bits",
                    100.0 * error,
                    report.fraction
                )
            },
        );
        line("", &relative);
        line(
            "paths that met something else",
            &format!("{:.4} %", 100.0 * report.parted),
        );
    }
    out.push_str("\noracles that are parts of it: qubits and Toffolis of one call of each\n");
    for OracleCost { name, call } in &report.oracles {
        let _ = writeln!(
            out,
            "  {:<42}{:>10} qubits {:>11} Toffoli",
            name.to_string(),
            grouped(call.qubits),
            grouped(call.toffoli)
        );
    }
    let verdict = if found.holds() {
        "all of it holds"
    } else {
        "it does NOT hold"
    };
    let _ = writeln!(out, "\n{verdict}");
    out
}
