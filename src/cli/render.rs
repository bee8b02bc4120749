//! `qrt render`: renders a scene to a picture.

use super::args::{SceneArgs, ThreadsArgs, choice, numbers};
use super::failure::Failure;
use super::files::{Output, named_after};
use super::picture::{self, BesideArgs, Outputs};
use super::prepare::{self, Preparation};
use super::progress::Bar;
use super::watch::watch;
use super::{interrupt, memory, path, terminal, time};
use clap::Args;
use clap::builder::PossibleValuesParser;
use qrt_core::inspect::grouped;
use qrt_counting::estimators::{Noise, NoiseError};
use qrt_counting::{Comparators, MAX_COMPARATOR_BITS};
use qrt_runtime::Prepared;
use qrt_runtime::checkpoint::Checkpoint;
use qrt_runtime::image::{Encoding, Metadata};
use qrt_runtime::path_machines::Real;
use qrt_runtime::render::{
    Colour, DEFAULT_FAILURE, Model, PicturePart, Portion, RenderError, RenderOptions, Rendered,
    Visibility,
};
use qrt_runtime::replace_file::replace_file;
use qrt_runtime::search::Guess;
use qrt_runtime::workers::Workers;
use qrt_scene::Estimator;
use qrt_scene::front::Loaded;
use qrt_scene::valid::ValidScene;
use qrt_syntax::codes;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const MODELS: [(Model, &str); 3] = [
    (Model::Real, "In 64-bit floating point"),
    (
        Model::Fixed,
        "The oracle's program, operation by operation, on integers",
    ),
    (
        Model::Gates,
        "The oracle's circuit, every gate of compute, flip and uncompute",
    ),
];

const COLOURS: [(Colour, &str); 2] = [
    (Colour::ThreeRuns, "Each channel is counted"),
    (
        Colour::OneRun,
        "The luminance is counted, and the paths that are measured give the colour; a pixel of which none \
         is measured is grey, as half of them are with one measurement: paper, sine, posterior-mean and qss \
         measure as often as counting.repetitions says",
    ),
];

const VISIBILITIES: [(Visibility, &str); 3] = [
    (Visibility::Classical, "By the tracer, like all other hits"),
    (
        Visibility::Exhaustive,
        "By asking the oracle of nearest hits about every face, path by path",
    ),
    (
        Visibility::GROVER,
        "By quantum search with that oracle, path by path; needs --model fixed or gates",
    ),
];

const GUESSES: [(Guess, &str); 2] = [
    (Guess::Random, "Whatever its first round measures"),
    (
        Guess::Coherent,
        "What the path before it met, or the pixel beside it",
    ),
];

/// Render a scene to a PNG or EXR picture
///
/// Traces every path of every pixel, lets the scene's estimator count them, and writes the
/// picture. The same scene, seed and estimator give the same bytes, on any machine and any number
/// of threads.
///
/// For a scene that asks for an `accuracy`, the cheapest parameters that keep it are chosen first,
/// and the plan is shown.
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
  qrt render box.yaml --watch --estimator exact         again whenever box.yaml is saved
  qrt render box.yaml --portion 0/4 -o box.0            the first of four parts for `qrt merge`
  qrt render box.yaml --model fixed --visibility grover primary hits by quantum search")]
#[allow(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct RenderArgs {
    /// The picture: .png (8-bit sRGB) or .exr (linear 32-bit float) [default: SCENE's name with
    /// .png, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The model that traces the paths
    #[arg(long, value_parser = choice(MODELS, Model::name), default_value = "real")]
    model: Model,
    /// The estimator of the number of good indices; exact takes them all, without noise [default: the scene's]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Estimator::NAMES))]
    estimator: Option<String>,
    /// The way in which pixels get their colours
    #[arg(long, value_parser = choice(COLOURS, Colour::name), default_value = "three-runs")]
    colour: Colour,
    /// Noise of the device that counts: the probability that a query destroys the state, and that a
    /// measured bit is wrong; either may be left out
    #[arg(long, value_name = "depolarising=P,readout=P", value_parser = noise)]
    noise: Option<Noise>,
    /// The way in which a path's primary hit is found
    #[arg(
        long,
        value_parser = choice(VISIBILITIES, Visibility::name),
        default_value = "classical"
    )]
    visibility: Visibility,
    /// The probability with which a ray's search may miss the nearest face [default: 0.001]
    #[arg(long, value_name = "P")]
    search_failure: Option<f64>,
    /// The face that a ray's search begins with [default: coherent]
    #[arg(long, value_parser = choice(GUESSES, Guess::name))]
    first_guess: Option<Guess>,
    /// Another seed gives other noise
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Render only these pixels: x and y from the top left corner, width and height
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    crop: Option<[u32; 4]>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Render only portion K (from 0) of N, whose pixels lie all over the picture, and write a part of
    /// it to -o FILE, for `qrt merge`
    #[arg(
        long,
        value_name = "K/N",
        allow_hyphen_values = true,
        requires = "output",
        conflicts_with_all = ["exposure", "stats", "counts"]
    )]
    portion: Option<Portion>,
    /// Keep more of each pixel in an .exr: interval.R .G .B (widths of intervals, in radiance), queries.Y,
    /// and of what the ray through its middle meets, depth.Z, normal.X .Y .Z and material.ID (the number
    /// of the material, from 1)
    #[arg(long, conflicts_with = "portion")]
    layers: bool,
    #[command(flatten)]
    beside: BesideArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// Go on from what an interrupted render has left, if it has
    #[arg(long)]
    resume: bool,
    /// Render again whenever the scene or a file that it names is saved, until Ctrl-C
    #[arg(long, conflicts_with_all = ["resume", "portion"])]
    watch: bool,
    /// Neither progress nor summary
    #[arg(short, long)]
    quiet: bool,
}

impl RenderArgs {
    fn visibility(&self) -> Result<Visibility, Failure> {
        let grover = self.visibility == Visibility::GROVER;
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
            Visibility::Grover { .. } => Visibility::Grover {
                failure: self.search_failure.unwrap_or(DEFAULT_FAILURE),
                guess: self.first_guess.unwrap_or_default(),
            },
            other => other,
        })
    }
}

fn noise(text: &str) -> Result<Noise, String> {
    text.parse().map_err(|error: NoiseError| error.to_string())
}

fn crop(text: &str) -> Result<[u32; 4], String> {
    numbers(text, "four whole numbers, such as 10,20,4,4")
}

/// The output made from a scene.
#[derive(Clone, Copy)]
enum Target {
    Picture(Encoding),
    Part(Portion),
}

impl Target {
    fn from_args(args: &RenderArgs, output: &Path) -> Result<Self, Failure> {
        let Some(portion) = args.portion else {
            let encoding = Encoding::for_path(output, args.beside.exposure)?;
            picture::keeps_layers(args.layers, output, encoding)?;
            return Ok(Self::Picture(encoding));
        };
        if Encoding::for_path(output, None).is_ok() {
            return Err(Failure::Usage(format!(
                "`{}` would be a picture, and part {portion} of one is none: give it another ending, \
                 and `qrt merge` makes the picture",
                output.display()
            )));
        }
        Ok(Self::Part(portion))
    }

    /// Returns the number of portions of the picture.
    fn portions(self) -> u32 {
        match self {
            Self::Picture(_) => 1,
            Self::Part(portion) => portion.count(),
        }
    }
}

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let cancel = interrupt::cancel_on_interrupt()?;
    if !args.watch {
        return render(args, &cancel, &mut Vec::new());
    }
    // Watching never finishes by itself, so the first Ctrl-C sets the flag instead of ending the process.
    interrupt::begun();
    watch(&args.scene.scene, &cancel, |outdated, files| {
        render(args, outdated, files)
    })
}

/// Renders until `cancel` is set; adds the files that the scene names to `files`.
fn render(args: &RenderArgs, cancel: &AtomicBool, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let visibility = args.visibility()?;
    let output = args
        .output
        .clone()
        .unwrap_or_else(|| named_after(&args.scene.scene, "png"));
    let target = Target::from_args(args, &output)?;
    let mut outputs = Outputs::new(&output, &args.beside)?;
    if args.watch {
        // A watched render restarts from the changed scene, so no checkpoint is kept.
        outputs.checkpoint = None;
    }
    outputs.keep_off([&*args.scene.scene])?;
    let loaded = args.scene.load_with(args.estimator.as_deref())?;
    let scene = &loaded.valid;
    files.extend(scene.files().iter().cloned());
    // Check the outputs before the work, not after it.
    outputs.keep_off(scene.files().iter().map(PathBuf::as_path))?;
    outputs.asked().try_for_each(Output::try_writing)?;
    Metadata::new().set("scene", scene.scene().name.as_str())?;
    let bar = Bar::paths(!args.quiet);
    let show = |progress| bar.show(progress);
    let options = RenderOptions {
        seed: args.seed,
        crop: args.crop,
        model: Some(args.model),
        estimator: args.estimator.as_deref().and_then(Estimator::from_name),
        colour: args.colour,
        noise: args.noise.unwrap_or_default(),
        visibility,
        workers: Workers {
            threads: args.threads.count(),
            cancel: Some(cancel),
            progress: Some(&show),
        },
        memory: args.scene.memory(),
        checkpoint: outputs.checkpoint.clone(),
        resume: args.resume,
        ..RenderOptions::default()
    };
    let prepared = prepared(&loaded, &options, args.quiet)?;
    announce(&prepared, args, target, &options)?;
    let counts = options.visibility == Visibility::Classical && args.estimator.is_none();
    if scene.is_counted_by_size() && counts && !args.quiet {
        note_estimator(scene);
    }
    bar.set_up();
    let (made, checkpoint) = match target {
        Target::Picture(encoding) => {
            let rendered = prepared.render(&options);
            bar.clear();
            let (rendered, checkpoint) =
                rendered.map_err(|error| failure(error, &loaded, &prepared, &options))?;
            if !args.quiet {
                note_black(&rendered, scene);
            }
            let layers = if args.layers {
                rendered.layers(scene)
            } else {
                Ok(Vec::new())
            };
            let clipped = layers
                .map_err(Failure::from)
                .and_then(|layers| picture::write(&outputs, encoding, &rendered, &layers));
            let told = |clipped| picture::summary(&output, &rendered, clipped);
            (clipped.map(told), checkpoint)
        }
        Target::Part(portion) => {
            let rendered = prepared.render_part(portion, &options);
            bar.clear();
            let (part, checkpoint) =
                rendered.map_err(|error| failure(error, &loaded, &prepared, &options))?;
            let written = write_part(&outputs.picture, &part);
            (written.map(|()| part_summary(&output, &part)), checkpoint)
        }
    };
    let told = match made {
        Ok(told) => told,
        Err(error) => return Err(kept(error, checkpoint, &outputs)),
    };
    // Only now is everything safe. Until here the lock keeps other processes off the checkpoint.
    if let Some(checkpoint) = checkpoint {
        checkpoint.remove().map_err(RenderError::from)?;
    }
    if args.quiet {
        return Ok(());
    }
    outputs.tell(&told)
}

/// Prepares the scene: refuses a picture that does not fit, chooses the parameters, and compiles and
/// checks the circuit that the picture needs.
fn prepared<'s>(
    loaded: &'s Loaded,
    options: &RenderOptions<'_>,
    quiet: bool,
) -> Result<Prepared<'s>, Failure> {
    options.check(&loaded.valid).map_err(|error| match error {
        RenderError::WouldNotFit(error) => memory::refused(&error),
        error => error.into(),
    })?;
    let preparation = Preparation {
        memory: options.memory,
        planning: options.planning(),
        shows_plan: !quiet,
    };
    let mut prepared = preparation.prepare(loaded)?;
    if options.colour == Colour::OneRun {
        prepared = prepared.with_luminance();
    }
    match options.circuit_work() {
        Some(work) if options.visibility == Visibility::Classical => {
            prepare::compile(&prepared, loaded, ([0, 0], work))?;
        }
        _ => {}
    }
    let checked = prepared.check_render(options);
    checked.map_err(|error| prepare::refused(error, loaded))?;
    Ok(prepared)
}

/// Prints, before the work, what the user may not expect of it.
fn announce(
    prepared: &Prepared<'_>,
    args: &RenderArgs,
    target: Target,
    options: &RenderOptions<'_>,
) -> Result<(), Failure> {
    let there = options.checkpoint.as_ref().filter(|path| path.exists());
    if let Some(path) = there.filter(|_| !args.resume) {
        terminal::note(&format!(
            "`{}` of an interrupted render is replaced; `--resume` would go on from it",
            path.display()
        ));
    }
    note_grey(options.expected_grey(prepared.scene())?, options, prepared);
    if !args.quiet {
        note_time(prepared, args, target.portions());
    }
    Ok(())
}

fn write_part(output: &Output, part: &PicturePart) -> Result<(), Failure> {
    let path = output.path()?;
    let bytes = part.encode();
    replace_file(path, |out| out.write_all(&bytes)).map_err(|error| Failure::file(path, &error))
}

fn part_summary(output: &Path, part: &PicturePart) -> String {
    format!(
        "{}: part {} of the picture, {} pixels, {} paths in {:.2} s\n",
        output.display(),
        part.portion(),
        part.pixels(),
        part.paths(),
        part.seconds(),
    )
}

/// Returns the error for an output that cannot be written, with the place that keeps the finished work.
fn kept(error: Failure, checkpoint: Option<Checkpoint>, outputs: &Outputs) -> Failure {
    let there = checkpoint.is_some_and(|checkpoint| checkpoint.close().unwrap_or(false));
    match &outputs.checkpoint {
        Some(path) if there => Failure::Job(format!(
            "{error}; all pixels are finished, and `{}` keeps them: the same command with `--resume` \
             writes them",
            path.display()
        )),
        _ => error,
    }
}

/// Warns if the fraction of pixels expected to be grey is large enough to be seen.
fn note_grey(fraction: f64, options: &RenderOptions<'_>, prepared: &Prepared<'_>) {
    const SHOWN: f64 = 1e-3;
    const ENOUGH: u32 = 10;
    if fraction <= SHOWN {
        return;
    }
    let counting = prepared.scene().scene().counting;
    // The planner chooses the repetitions itself.
    let enough = if prepared.plan().is_some() {
        String::new()
    } else {
        format!("`--set counting.repetitions={ENOUGH}` or more, or ")
    };
    terminal::note(&format!(
        "about {:.2} % of the pixels will be grey: `{}` measures as often as `counting.repetitions` says, \
         here {}, and where no measured path is good, `--colour one-run` knows no colour; take {enough}an \
         estimator that measures until it knows enough, such as `--estimator {}`",
        100.0 * fraction,
        options.estimator.unwrap_or(counting.estimator()),
        counting.repetitions,
        Estimator::Auto,
    ));
}

/// Tells by which estimator a large picture is counted if its scene has none.
fn note_estimator(scene: &ValidScene) {
    let film = scene.scene().film;
    terminal::note(&format!(
        "the scene has no `counting.estimator`: a film of {} x {} pixels is counted by `{}`, which is simulated \
         fastest; `--estimator {}` needs fewer queries for the same error, and simulating its measurements takes about \
         30 times as long",
        film.width,
        film.height,
        scene.scene().counting.estimator(),
        Estimator::Auto,
    ));
}

/// True if every colour is 0.
pub(super) fn is_black(rendered: &Rendered) -> bool {
    rendered.image.pixels.iter().flatten().all(|&c| c == 0.0)
}

/// Tells why a picture is black: no path leads to a lamp, or no colour reaches the comparator's first
/// threshold.
pub(super) fn note_black(rendered: &Rendered, scene: &ValidScene) {
    /// Pixels and paths of each that are looked at.
    const PIXELS: usize = 64;
    const PATHS: u64 = 1 << 10;
    if !is_black(rendered) {
        return;
    }
    let Ok(machine) = Real::new(scene, rendered.seed) else {
        return;
    };
    let [left, top, width, height] = rendered.crop;
    let all = width as usize * height as usize;
    let pixels: Vec<[u32; 2]> = (0..all)
        .step_by(all.div_ceil(PIXELS).max(1))
        .map(|n| [left + n as u32 % width, top + n as u32 / width])
        .collect();
    let paths = PATHS.min(machine.paths());
    let (mut sums, mut greatest) = ([0.0; 3], [0.0; 3]);
    machine.trace_range(&pixels, 0..paths, |block| {
        for (channel, colours) in block.colours.iter().enumerate() {
            sums[channel] += colours.iter().sum::<f64>();
            greatest[channel] = colours.iter().copied().fold(greatest[channel], f64::max);
        }
    });
    let comparator = scene.scene().comparator;
    let (bounds, limits) = (machine.stage().bound(), machine.stage().limit());
    let rounded = |c: usize| greatest[c] <= limits[c] - bounds[c];
    if (0..3).all(rounded) {
        // Rounding may have left a trace of a lamp that faces away. The scene may have a warning.
        let mut warnings = scene.warnings().iter();
        let warned = warnings.any(|one| one.code() == codes::BLACK);
        if !warned && greatest == [0.0; 3] {
            terminal::note(&format!(
                "the picture is black: none of {} paths that were tried has light. Does the camera look \
                 elsewhere, are there too few rays in `sampling.depths`, or is a lamp enclosed, turned away or \
                 too small to be found by rays that do not sample it?",
                grouped(pixels.len() as u64 * paths)
            ));
        }
        return;
    }
    let counts = |(greatest, bound): (f64, f64)| {
        let comparators = Comparators::new(bound, comparator);
        comparators.is_ok_and(|comparators| comparators.good(greatest) > 0)
    };
    if greatest.into_iter().zip(bounds).any(counts) {
        // Some colour is above a threshold: too few queries have found none.
        return;
    }
    let of_channel = |(sum, scale): (f64, f64)| {
        let mean = sum / (pixels.len() as f64 * paths as f64);
        (mean, scale / (1_u64 << comparator.bits) as f64)
    };
    let channels = sums.into_iter().zip(bounds);
    let brightest = channels
        .map(of_channel)
        .max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)));
    let Some((mean, step)) = brightest.filter(|(mean, _)| *mean > 0.0) else {
        return;
    };
    // Eight thresholds below the mean.
    let bits = f64::from(comparator.bits) + (step / mean).log2().ceil() + 3.0;
    let advice = if bits <= f64::from(MAX_COMPARATOR_BITS) {
        format!("take `--set comparator.bits={bits}`")
    } else {
        "take other materials or maps, whose bound is lower".to_owned()
    };
    terminal::note(&format!(
        "the picture is black, but its paths carry light, {mean:.2e} on average: the comparator's \
         thresholds are {step:.2e} apart; {advice}"
    ));
}

/// Warns if the estimated time is long; the user may still have meant it.
fn note_time(prepared: &Prepared<'_>, args: &RenderArgs, portions: u32) {
    let film = prepared.scene().scene().film;
    let [_, _, width, height] = args.crop.unwrap_or([0, 0, film.width, film.height]);
    let pixels = f64::from(width) * f64::from(height) / f64::from(portions);
    time::tell_of_paths(
        prepared,
        pixels,
        1.0,
        &[args.model],
        args.threads.or_cores(),
    );
}

/// Returns the reason that there is no picture: at its place in the scene, or with the user's remedy.
fn failure(
    error: RenderError,
    loaded: &Loaded,
    prepared: &Prepared<'_>,
    options: &RenderOptions<'_>,
) -> Failure {
    match error {
        RenderError::OutOfBounds { pixel, id, .. } => {
            // The planner's scene has other parameters, and so other paths.
            let (model, seed) = (options.model(), options.seed);
            let path = path::in_words(prepared.scene(), model, seed, pixel, id);
            Failure::Job(format!("{error}{path}"))
        }
        RenderError::Oracle(error) => prepare::without_circuit(&error, loaded),
        RenderError::Budget(problems) => prepare::over_budget(problems, loaded),
        RenderError::WouldNotFit(error) => memory::refused(&error),
        RenderError::Interrupted {
            checkpoint: Some(_),
            ..
        } => Failure::Job(format!(
            "{error}; the same command with `--resume` goes on from there"
        )),
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_runtime::memory::Memory;
    use qrt_runtime::plan::{ErrorParts, Plan, PlanFigures};
    use qrt_scene::Accuracy;
    use qrt_scene::front::parse;
    use qrt_scene::valid::ValidScene;

    /// A wall that fills the picture.
    const WALL: &str = "
name: wall
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 2, height: 1 }
materials: { NAME: { emitter: { radiance: [2, 1, 0] } } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: NAME }
sampling: { path_bits: 5 }
";

    fn wall(name: &str) -> Loaded {
        let text = WALL.replace("NAME", name);
        parse(&text, "wall.yaml", &[], "".as_ref()).unwrap()
    }

    fn planned(scene: ValidScene) -> Plan {
        let parameters = scene.parameters();
        let figures = PlanFigures {
            accuracy: Accuracy {
                error: 0.1,
                confidence: 0.9,
            },
            mean: 1.0,
            pixels: [2; 2],
            sequence: parameters.sampling.sequence,
            path_bits: parameters.sampling.path_bits,
            extrapolated: false,
            fraction: None,
            comparator_bits: parameters.comparator.bits,
            estimator: parameters.counting.estimator(),
            phase_bits: parameters.counting.phase_bits,
            repetitions: parameters.counting.repetitions,
            error: None,
            within: 1.0,
            parts: ErrorParts::default(),
            queries: 0.0,
            channel_queries: [0.0; 3],
            cost: None,
        };
        Plan { scene, figures }
    }

    #[test]
    fn a_path_beyond_its_bound_is_traced_in_the_scene_that_was_rendered() {
        let asked = wall("asked");
        let plan = planned(wall("chosen").valid);
        for (plan, name) in [(None, "asked"), (Some(plan), "chosen")] {
            let prepared = Prepared::with_plan(&asked.valid, plan, Memory::default());
            let options = RenderOptions::default();
            let error = RenderError::OutOfBounds {
                pixel: [1, 0],
                id: 3,
                channel: 0,
                colour: 3.0,
                bound: 2.0,
                fraction: None,
            };
            let told = failure(error, &asked, &prepared, &options).to_string();
            assert!(told.contains(&format!("(`{name}`)")), "{told}");
        }
    }
}
