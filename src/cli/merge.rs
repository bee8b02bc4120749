//! `qrt merge`: puts the parts of a picture together.

use super::args::load;
use super::failure::Failure;
use super::files::Output;
use super::memory::{self, refused};
use super::picture::{self, BesideArgs, Outputs};
use super::render::{is_black, note_black};
use super::terminal;
use clap::Args;
use qrt_runtime::disk::read_regular;
use qrt_runtime::image::Encoding;
use qrt_runtime::memory::Memory;
use qrt_runtime::render::Merge;
use std::fs;
use std::path::PathBuf;

/// Put the parts of a picture together
///
/// The parts are what `qrt render --portion K/N` has written for every K from 0 to N - 1, in any
/// order. The picture, and the files beside it, are those of one render of the whole, byte for
/// byte; only the times of --stats are those of all parts together.
///
/// A part that is missing, there twice, damaged or of another picture is named, and nothing is written;
/// the exit code is then 1.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt render box.yaml --portion 0/2 -o box.0            one part of two
  qrt render box.yaml --portion 1/2 -o box.1            the other, perhaps on another machine
  qrt merge box.0 box.1 -o box.png --stats box.json     the picture
  qrt merge box.0 box.1 -o box.exr --layers box.yaml    with depths, normals, materials and more")]
pub(crate) struct MergeArgs {
    /// All parts of a picture
    #[arg(value_name = "PARTS", required = true)]
    parts: Vec<PathBuf>,
    /// The picture: .png (8-bit sRGB) or .exr (linear 32-bit float)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Keep more of each pixel in an .exr, as `qrt render --layers` does, of the scene that the parts are of
    #[arg(long, value_name = "SCENE")]
    layers: Option<PathBuf>,
    /// Override a key of that scene, as the parts' renders did; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "layers")]
    sets: Vec<String>,
    /// Let that scene read files below this folder, too; may be repeated
    #[arg(long, value_name = "DIR", requires = "layers")]
    allow_files: Vec<PathBuf>,
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
    let encoding = Encoding::for_path(&args.output, args.beside.exposure)?;
    let outputs = Outputs::new(&args.output, &args.beside)?;
    picture::keeps_layers(args.layers.is_some(), &args.output, encoding)?;
    let inputs = args.parts.iter().chain(&args.layers);
    outputs.keep_off(inputs.map(PathBuf::as_path))?;
    let memory = Memory::new(args.max_memory);
    let load = |path| load(path, &args.sets, &args.allow_files, memory);
    let scene = args.layers.as_deref().map(load).transpose()?;
    let files = scene.iter().flat_map(|loaded| loaded.valid.files());
    outputs.keep_off(files.map(PathBuf::as_path))?;
    outputs.asked().try_for_each(Output::try_writing)?;
    let length = |path: &PathBuf| fs::metadata(path).map_or(0, |found| found.len());
    let length = args.parts.iter().map(length).sum();
    memory.keep_parts(length).map_err(|error| refused(&error))?;
    let mut merge = Merge::default();
    for path in &args.parts {
        let bytes = read_regular(path).map_err(|error| Failure::file(path, &error))?;
        merge.add(&path.display().to_string(), &bytes)?;
    }
    let rendered = merge.finish()?;
    let layers = match &scene {
        Some(loaded) => rendered.layers(&loaded.valid)?,
        None => Vec::new(),
    };
    let clipped = picture::write(&outputs, encoding, &rendered, &layers)?;
    if args.quiet {
        return Ok(());
    }
    match &scene {
        Some(loaded) => note_black(&rendered, &loaded.valid),
        None if is_black(&rendered) => terminal::note(
            "the picture is black: `qrt render` says why, for a picture that is not divided into portions",
        ),
        None => {}
    }
    outputs.tell(&picture::summary(&args.output, &rendered, clipped))
}
