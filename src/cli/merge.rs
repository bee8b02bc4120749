//! `qrt merge`: parts of a picture become the picture.

use super::failure::Failure;
use super::files::Output;
use super::memory::{self, Memory};
use super::picture::{self, BesideArgs, Outputs};
use super::terminal;
use clap::Args;
use qrt_runtime::image::Encoding;
use qrt_runtime::render::Merge;
use std::fs;
use std::path::PathBuf;

/// Put the parts of a picture together
///
/// The parts are what `qrt render --tile K/N` has written for every K from 0 to N - 1, in any order.
/// The picture, and the files beside it, are those of one render of the whole, byte for byte; only the
/// times of --stats are those of all parts together.
///
/// A part that is missing, there twice, damaged or of another picture is named, and nothing is written;
/// the exit code is then 1.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt render box.yaml --tile 0/2 -o box.0               one part of two
  qrt render box.yaml --tile 1/2 -o box.1               the other, perhaps on another machine
  qrt merge box.0 box.1 -o box.png --stats box.json     the picture")]
pub(crate) struct MergeArgs {
    /// All parts of a picture
    #[arg(value_name = "PARTS", required = true)]
    parts: Vec<PathBuf>,
    /// The picture: .png (8-bit sRGB) or .exr (linear 32-bit float)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    beside: BesideArgs,
    /// The memory that the work may take, such as 500M or 4G: what would take more is refused before it
    /// begins [default: three quarters of what the machine has]
    #[arg(long, value_name = "SIZE", value_parser = memory::size)]
    max_memory: Option<u64>,
    /// No summary
    #[arg(short, long)]
    quiet: bool,
}

pub(crate) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let encoding = Encoding::of(&args.output, args.beside.exposure)?;
    let outputs = Outputs::new(&args.output, &args.beside)?;
    outputs.keep_off(args.parts.iter().map(PathBuf::as_path))?;
    outputs.asked().try_for_each(Output::try_writing)?;
    let length = |path: &PathBuf| fs::metadata(path).map_or(0, |found| found.len());
    Memory::of(args.max_memory).keep_parts(args.parts.iter().map(length).sum())?;
    let mut merge = Merge::default();
    for path in &args.parts {
        let bytes = fs::read(path).map_err(|error| Failure::file(path, &error))?;
        merge.add(&path.display().to_string(), &bytes)?;
    }
    let rendered = merge.finish()?;
    let clipped = picture::write(&outputs, encoding, &rendered, &[])?;
    if args.quiet {
        return Ok(());
    }
    terminal::print(&picture::summary(&args.output, &rendered, clipped))
}
