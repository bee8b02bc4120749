//! `qrt render`: a scene becomes a picture.

use super::failure::Failure;
use super::files::{can_be_written, is_device, keep_apart, named_after};
use super::inspect::check_circuit;
use super::progress::Bar;
use super::{interrupt, plan, stats, terminal};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use qrt_core::front;
use qrt_core::inspect::grouped;
use qrt_core::scene::Estimator;
use qrt_runtime::estimators::{Noise, NoiseError};
use qrt_runtime::image::{self, Encoding, Metadata};
use qrt_runtime::render::{self, Options, Progress, RenderError, Rendered, render};
use qrt_runtime::search::Guess;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// More threads than any machine profits from.
pub(crate) const MAX_THREADS: u64 = 4096;

/// Render a scene to a PNG or EXR picture
///
/// Traces every path of every pixel, lets the scene's estimator count them, and writes the
/// picture. The same scene, seed and estimator give the same bytes, on any machine and any number
/// of threads.
///
/// For a scene that asks for an `accuracy`, the cheapest knobs that keep it are chosen first, and the
/// plan is shown.
///
/// Ctrl-C stops and keeps what is finished in FILE.qrt-partial, beside the picture; the exit code
/// is then 1. With --resume the same command goes on from there, to the same bytes.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt render box.yaml                                   the picture, box.png
  qrt render box.yaml --estimator exact -o box.exr      without the noise of counting, linear
  qrt render box.yaml --set sampling.path_bits=16       more paths
  qrt render box.yaml --set 'film={ width: 8, height: 8 }' --counts box.csv
  qrt render box.yaml --crop 10,20,4,4 --stats box.json
  qrt render box.yaml --model fixed --visibility grover first hits by quantum search")]
pub(crate) struct RenderArgs {
    /// The scene, a YAML file
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// The picture: .png (8-bit sRGB) or .exr (linear 32-bit float) [default: SCENE's name with
    /// .png, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// What traces the paths
    #[arg(long, value_enum, default_value_t = Model::Real)]
    model: Model,
    /// How the good ids are counted; exact takes them all, without noise [default: the scene's]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Estimator::NAMES))]
    estimator: Option<String>,
    /// How pixels get their colours
    #[arg(long, value_enum, default_value_t = Colour::ThreeRuns)]
    colour: Colour,
    /// Noise of the device that counts: the probability that a query destroys the state, and that a
    /// measured bit is wrong; either may be left out
    #[arg(long, value_name = "depolarising=P,readout=P", value_parser = noise)]
    noise: Option<Noise>,
    /// How a path's first hit is found
    #[arg(long, value_enum, default_value_t = Visibility::Classical)]
    visibility: Visibility,
    /// The probability with which a ray's search may miss the nearest face [default: 0.001]
    #[arg(long, value_name = "P")]
    search_failure: Option<f64>,
    /// What a ray's search begins with [default: coherent]
    #[arg(long, value_enum)]
    first_guess: Option<FirstGuess>,
    /// Another seed gives other noise
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Render only these pixels: x and y from the top left corner, width and height
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    crop: Option<[u32; 4]>,
    /// Threads [default: one for each core]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=MAX_THREADS)
    )]
    threads: Option<u64>,
    /// Stops of exposure: the picture times 2^STOPS; for .png only
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true)]
    exposure: Option<f64>,
    /// Write time, queries, mean colour and more as JSON
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Write every channel of every pixel as CSV: x,y,channel,value,good,total,scale
    #[arg(long, value_name = "FILE.csv")]
    counts: Option<PathBuf>,
    /// Override a key of the scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Go on from what an interrupted render has left, if it has
    #[arg(long)]
    resume: bool,
    /// Neither progress nor summary
    #[arg(short, long)]
    quiet: bool,
}

/// What traces the paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Model {
    /// In 64-bit floating point
    Real,
    /// The oracle's program, operation by operation, on integers
    Fixed,
    /// The oracle's circuit, every gate of compute, flip and uncompute
    Gates,
}

/// How a path's first hit is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Visibility {
    /// By the tracer, like all other hits
    Classical,
    /// By asking the oracle of nearest hits about every face, path by path
    Exhaustive,
    /// By quantum search with that oracle, path by path; needs --model fixed or gates
    Grover,
}

/// What a ray's search begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FirstGuess {
    /// Whatever its first round measures
    Random,
    /// What the path before it met, or the pixel beside it
    Coherent,
}

impl RenderArgs {
    fn visibility(&self) -> Result<render::Visibility, Failure> {
        let grover = self.visibility == Visibility::Grover;
        for (flag, given) in [
            ("--search-failure", self.search_failure.is_some()),
            ("--first-guess", self.first_guess.is_some()),
        ] {
            if given && !grover {
                let message = format!("{flag} is of a search: it needs --visibility grover");
                return Err(Failure::Usage(message));
            }
        }
        Ok(match self.visibility {
            Visibility::Classical => render::Visibility::Classical,
            Visibility::Exhaustive => render::Visibility::Exhaustive,
            Visibility::Grover => render::Visibility::Grover {
                failure: self.search_failure.unwrap_or(render::DEFAULT_FAILURE),
                guess: match self.first_guess {
                    Some(FirstGuess::Random) => Guess::Random,
                    Some(FirstGuess::Coherent) | None => Guess::Coherent,
                },
            },
        })
    }
}

impl From<Model> for render::Model {
    fn from(model: Model) -> Self {
        match model {
            Model::Real => Self::Real,
            Model::Fixed => Self::Fixed,
            Model::Gates => Self::Gates,
        }
    }
}

/// How pixels get their colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Colour {
    /// Each channel is counted
    ThreeRuns,
    /// The luminance is counted, and the paths that are measured give the colour
    OneRun,
}

impl From<Colour> for render::Colour {
    fn from(colour: Colour) -> Self {
        match colour {
            Colour::ThreeRuns => Self::ThreeRuns,
            Colour::OneRun => Self::OneRun,
        }
    }
}

fn noise(text: &str) -> Result<Noise, String> {
    text.parse().map_err(|error: NoiseError| error.to_string())
}

fn crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| <[u32; 4]>::try_from(numbers).ok())
        .ok_or_else(|| "four whole numbers, such as 10,20,4,4".to_owned())
}

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let visibility = args.visibility()?;
    let output = args
        .output
        .clone()
        .unwrap_or_else(|| named_after(&args.scene, "png"));
    let encoding = Encoding::of(&output, args.exposure)?;
    let files = [
        Some(&*output),
        args.stats.as_deref(),
        args.counts.as_deref(),
    ];
    let files = files.into_iter().flatten();
    keep_apart(std::iter::once(&*args.scene).chain(files.clone()))?;
    for file in files {
        can_be_written(file)?;
    }
    let loaded = front::load(&args.scene, &args.sets)?;
    let scene = &loaded.valid;
    // Known before the work, not after it.
    Metadata::new().set("scene", scene.scene().name.as_str())?;
    let checkpoint = checkpoint(&output);
    if let Some(path) = checkpoint
        .as_ref()
        .filter(|path| path.exists() && !args.resume)
    {
        terminal::note(&format!(
            "`{}` of an interrupted render is replaced; `--resume` would go on from it",
            path.display()
        ));
    }
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::new(!args.quiet);
    let show = |progress: Progress| bar.show(progress);
    let mut options = Options {
        seed: args.seed,
        crop: args.crop,
        model: args.model.into(),
        estimator: args.estimator.as_deref().and_then(Estimator::from_name),
        colour: args.colour.into(),
        noise: args.noise.unwrap_or_default(),
        visibility,
        threads: args.threads.and_then(|n| NonZeroUsize::new(n as usize)),
        checkpoint: checkpoint.clone(),
        resume: args.resume,
        cancel: Some(&cancel),
        progress: Some(&show),
        ..Options::default()
    };
    let planned = plan::of(scene, &options.planning(), args.quiet)?;
    options.plan = planned.as_ref();
    if args.model != Model::Real {
        check_circuit(&loaded, planned.as_ref().map_or(scene, |plan| &plan.scene))?;
    }
    let rendered = render(scene, &options);
    bar.clear();
    let rendered = rendered.map_err(|error| match &error {
        RenderError::Oracle(error) => loaded.report(vec![error.problem()]).into(),
        RenderError::Interrupted {
            checkpoint: Some(_),
            ..
        } => Failure::Job(format!(
            "{error}; the same command with `--resume` goes on from there"
        )),
        _ => error.into(),
    })?;

    let mut metadata = rendered.metadata(scene)?;
    if let Encoding::Png { exposure } = encoding {
        metadata.set("exposure", exposure.to_string())?;
    }
    let clipped = image::save(&output, &rendered.image, &metadata, encoding)?;
    if let Some(path) = &args.counts {
        image::write_counts(path, rendered.counts())?;
    }
    if let Some(path) = &args.stats {
        stats::write(path, scene, &rendered, clipped)?;
    }
    // Only now is everything safe.
    if let Some(path) = &checkpoint {
        fs::remove_file(path).map_err(|error| Failure::file(path, &error))?;
    }
    if args.quiet {
        return Ok(());
    }
    terminal::print(&summary(&output, &rendered, clipped))
}

/// Beside the picture; none for a pipe or a device, beside which there is no place.
fn checkpoint(output: &Path) -> Option<PathBuf> {
    if is_device(output) {
        return None;
    }
    let mut name = output.as_os_str().to_owned();
    name.push(".qrt-partial");
    Some(name.into())
}

fn summary(output: &Path, rendered: &Rendered, clipped: u64) -> String {
    let Rendered { image, paths, .. } = rendered;
    let clipped = match clipped {
        0 => String::new(),
        _ => format!(
            "{clipped} of {} pixels are clipped: lower --exposure, or write .exr\n",
            image.pixels.len()
        ),
    };
    format!(
        "{}: {} x {} pixels, {paths} paths in {:.2} s ({:.2} Mpaths/s), model {}, estimator {}, {} \
         queries\n\
         {clipped}",
        output.display(),
        image.width,
        image.height,
        rendered.seconds,
        stats::paths_per_second(rendered) / 1e6,
        rendered.model.name(),
        rendered.estimator,
        rendered.total_queries(),
    ) + &search_summary(rendered)
}

/// What the search for first hits took; nothing if there was none.
fn search_summary(rendered: &Rendered) -> String {
    let Some(searched) = rendered.searched else {
        return String::new();
    };
    let root = libm::sqrt(searched.faces as f64);
    let mean = rendered.total_queries() as f64 / rendered.paths as f64;
    let promise = match searched.failure {
        0.0 => String::new(),
        failure => format!(", a miss at most {failure:.1e} likely"),
    };
    format!(
        "first hits by {}: P = {} faces, {mean:.2} queries a ray = {:.2} sqrt(P) = {:.3} P, each of \
         {} Toffolis on {} qubits{promise}\n",
        rendered.visibility.name(),
        searched.faces,
        mean / root,
        mean / searched.faces as f64,
        grouped(searched.toffoli),
        grouped(searched.qubits),
    )
}
