//! `qrt trade`: measures the cost of accuracy.

use super::args::{SceneArgs, ThreadsArgs};
use super::failure::Failure;
use super::files::{Output, keep_apart, keep_off_stdout};
use super::prepare::{self, Preparation};
use super::progress::Bar;
use super::{interrupt, memory, terminal, time};
use clap::Args;
use qrt_lab::trade::{TradeError, TradeOptions, trade};
use qrt_runtime::plan::PlanOptions;
use qrt_runtime::render::{Model, Portion};
use qrt_runtime::sample::SampleError;
use qrt_runtime::workers::Workers;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// Assumed number of times that the paths of a pixel are traced: a round figure.
const TRACED_ANEW: f64 = 20.0;

/// Measure what a scene's accuracy costs, parameter by parameter
///
/// Varies the scene's parameters around their values, one at a time, and every estimator with every
/// number of queries; renders a sample of its pixels under each setting; and writes to DIR:
/// trade.csv, one row a setting, plots (.svg), and index.html, which shows tables and plots
/// together.
///
/// Every part of a pixel's error is measured: of paths (e_r), comparators (e_c), the width of
/// numbers (e_w), counting (e_t) and the length of paths (e_d), as a root mean square over pixels
/// and channels, relative to the mean radiance; and the total of all but the last.
///
/// Rows are written as they are finished. After Ctrl-C, the same command goes on from there.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt trade box.yaml -o box-trade                 everything, in some minutes
  qrt trade box.yaml -o box-trade --quick         the outlines, in less than one
  qrt trade box.yaml -o wide --set precision.fraction=20
  qrt trade box.yaml -o part0 --portion 0/2       a half of it, perhaps on another machine
  qrt trade box.yaml -o whole --parts part0 part1 the whole, of the halves")]
pub(crate) struct TradeArgs {
    /// The folder to write to; it is made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Fewer settings, pixels and reference paths, and no gates that take long
    #[arg(long)]
    quick: bool,
    /// Pixels to try, spread over the film [default: 256; with --quick 32, or 16 if a call takes more than 2^20 Toffolis, 8 if more than 2^23]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pixels: Option<u64>,
    /// Another seed gives other paths and other noise
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Measure only portion K (from 0) of N of the settings, for one of several processes, and write
    /// no more than trade.csv
    #[arg(
        long,
        value_name = "K/N",
        allow_hyphen_values = true,
        conflicts_with = "parts"
    )]
    portion: Option<Portion>,
    /// Take over the rows that these folders have, from --portion or otherwise; what none of them
    /// has, such as a portion that was lost, is measured. Two may have the same row, but not
    /// different ones of a setting
    #[arg(long, value_name = "DIR", num_args = 1..)]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// Neither progress nor summary
    #[arg(short, long)]
    quiet: bool,
}

/// Checks that none of the files that would be written in `folder` is a file of the scene, or the same as
/// another of them.
fn keep_apart_from(folder: &Path, scene: &Path, files: &[PathBuf]) -> Result<(), Failure> {
    let there = fs::read_dir(folder).into_iter().flatten().flatten();
    let written = there.map(|entry| entry.path()).filter(|path| {
        let name = path.file_name().and_then(OsStr::to_str);
        let drawn = path.extension().is_some_and(|extension| extension == "svg");
        drawn || matches!(name, Some("trade.csv" | "index.html"))
    });
    let outputs = written.map(|path| Output::new(&path));
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    let inputs = files.iter().map(PathBuf::as_path).chain([scene]);
    keep_apart(inputs, &outputs.iter().collect::<Vec<_>>())
}

pub(crate) fn run(args: &TradeArgs) -> Result<(), Failure> {
    keep_off_stdout(&args.output)?;
    if args.output.exists() && !args.output.is_dir() {
        let message = format!("`{}` is no folder", args.output.display());
        return Err(Failure::Usage(message));
    }
    let loaded = args.scene.load()?;
    keep_apart_from(&args.output, &args.scene.scene, loaded.valid.files())?;
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::settings(!args.quiet);
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
        shows_plan: !args.quiet,
    };
    let prepared = preparation.prepare(&loaded)?;
    let scene = prepared.scene();
    let fits = preparation.memory.keep_compiling(scene);
    fits.map_err(|error| memory::refused(&error))?;
    prepare::note_compiling(scene);
    let options = TradeOptions {
        pixels: args.pixels,
        seed: args.seed,
        quick: args.quick,
        portion: args.portion.unwrap_or_default(),
        parts: &args.parts,
        workers,
        memory: preparation.memory,
    };
    if !args.quiet {
        let film = scene.scene().film;
        let film = f64::from(film.width) * f64::from(film.height);
        let pixels = film.min(options.most_pixels() as f64);
        let threads = args.threads.or_cores();
        let pixels = pixels / f64::from(args.portion.unwrap_or_default().count());
        time::tell_of_paths(&prepared, pixels, TRACED_ANEW, &[Model::Real], threads);
    }
    bar.set_up();
    let measured = trade(scene, &args.output, &options);
    bar.clear();
    let measured = measured.map_err(|error| match &error {
        TradeError::Oracle(error) => prepare::without_circuit(error, &loaded),
        TradeError::WouldNotFit(error) => memory::refused(error),
        TradeError::Sample(SampleError::Interrupted { .. }) => Failure::Job(format!(
            "interrupted; the same command goes on from what `{}` has",
            args.output.join("trade.csv").display()
        )),
        _ => error.into(),
    })?;
    if args.quiet {
        return Ok(());
    }
    if measured.damaged > 0 {
        terminal::note(&format!(
            "{} damaged rows of `{}` were measured again",
            measured.damaged,
            args.output.join("trade.csv").display()
        ));
    }
    let anew = measured.rows.len() - measured.resumed;
    if !args.parts.is_empty() && anew > 0 {
        terminal::note(&format!(
            "{anew} rows were in none of the parts, and were measured here"
        ));
    }
    if let Some(portion) = args.portion {
        let table = args.output.join("trade.csv");
        let rows = measured.rows.len();
        return terminal::print(&format!(
            "{}: {rows} rows, portion {portion} of the settings\n",
            table.display()
        ));
    }
    let page = args.output.join("index.html");
    terminal::print(&format!("{}{}\n", measured.summary(), page.display()))
}
