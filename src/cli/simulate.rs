//! `qrt simulate`: runs a pixel's complete counting circuit as amplitudes.

use super::args::{SceneArgs, ThreadsArgs, choice, on_film, pixel, reference, slope};
use super::failure::Failure;
use super::files::{Output, keep_apart};
use super::inspect::{CHANNEL_CHOICES, channel_name};
use super::memory;
use super::prepare::Preparation;
use super::progress::Bar;
use super::{count, interrupt, terminal};
use clap::Args;
use qrt_core::inspect::{OraclePixel, grouped};
use qrt_core::oracle::Oracles;
use qrt_lab::simulate::{
    MeanPhase, MeanPhaseSimulation, Outcome, SimulateError, SimulateOptions, Simulation, simulate,
    simulate_film, simulate_mean_phase,
};
use qrt_lab::{draw, json};
use qrt_runtime::image::{self, Encoding, Metadata};
use qrt_runtime::plan::PlanOptions;
use qrt_runtime::replace_file::replace_file;
use qrt_runtime::workers::Workers;
use qrt_scene::Window;
use qrt_scene::front::Loaded;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

/// Columns of the bar of probability 1.
const BAR: f64 = 32.0;

/// Run a pixel's complete counting circuit as amplitudes
///
/// The circuit is the one that `qrt export --part counting` writes: Hadamards, the window, 2^t - 1
/// controlled Grover iterates with every gate of the oracle, and the inverse Fourier transform. It runs on
/// a sparse state vector; after each query all ancillas are read as 0. Beside the probability of each
/// outcome y stands the one that theory predicts from S of N, where S is counted path by path.
///
/// The path index, the comparator and the phase register together have at most 24 qubits. The path
/// index and the sign of the mean phase have at most 24, too. The scenes in scenes-yaml/small/ are that
/// small.
///
/// With --mean-phase, it is the circuit of the mean phase: K iterates, whose phase is the mean of the
/// paths' colours less a reference, and no phase register. Theory is what the levels of the paths say.
///
/// With --film, every channel of every pixel is counted by a circuit of its own, and the estimates from
/// the drawn outcomes are a picture.
///
/// A scene that asks for an `accuracy` is simulated with the parameters that are chosen for it.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt simulate scenes-yaml/small/edge.yaml --pixel 1,0
  qrt simulate edge.yaml --pixel 1,0 --phase-bits 4 --shots 100 --plot edge.svg
  qrt simulate edge.yaml --film edge.png
  qrt simulate edge.yaml --pixel 1,0 --mean-phase 4")]
pub(crate) struct SimulateArgs {
    /// The pixel: column and row, from 0 at the top left [default: the one in the middle]
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pixel: Option<[u32; 2]>,
    /// The channel [default: the one whose oracle has the most Toffolis]
    #[arg(long, value_parser = choice(CHANNEL_CHOICES, channel_name), value_name = "CHANNEL")]
    channel: Option<usize>,
    /// t, the number of qubits of the phase register [default: the scene's counting.phase_bits]
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(1..=23))]
    phase_bits: Option<u32>,
    /// The window on the phase register [default: the scene's]
    #[arg(long, value_parser = choice(count::WINDOWS, Window::name))]
    window: Option<Window>,
    /// Draw B outcomes and estimate S from them [default: the scene's counting.repetitions]
    #[arg(
        long,
        value_name = "B",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(qrt_counting::MAX_REPETITIONS))
    )]
    shots: Option<u32>,
    /// Run K iterates of the mean phase in place of counting
    #[arg(
        long,
        value_name = "K",
        value_parser = clap::value_parser!(u64).range(0..=qrt_lab::simulate::MOST_ITERATES),
        conflicts_with_all = ["phase_bits", "window", "shots", "plot", "film"]
    )]
    mean_phase: Option<u64>,
    /// The slope of the mean phase, for colours over the scale [default: 0.6 over the paths' standard
    /// deviation]
    #[arg(
        long,
        value_name = "ALPHA",
        value_parser = slope,
        requires = "mean_phase",
        allow_hyphen_values = true
    )]
    slope: Option<f64>,
    /// The colour of phase 0, over the scale [default: half a standard deviation below the mean]
    #[arg(
        long,
        value_name = "COLOUR",
        value_parser = reference,
        requires = "mean_phase",
        allow_hyphen_values = true
    )]
    reference: Option<f64>,
    /// Another seed gives other paths and draws
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Draw the simulated probabilities beside theory's as bars
    #[arg(long, value_name = "FILE.svg", conflicts_with = "film")]
    plot: Option<PathBuf>,
    /// Simulate all pixels, and write their estimates as a picture: .png or .exr
    #[arg(long, value_name = "FILE", conflicts_with_all = ["pixel", "channel", "json"])]
    film: Option<PathBuf>,
    /// JSON instead of a table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: ThreadsArgs,
    #[command(flatten)]
    scene: SceneArgs,
}

impl SimulateArgs {
    fn options<'a>(&self, workers: Workers<'a>) -> SimulateOptions<'a> {
        SimulateOptions {
            channel: self.channel,
            phase_bits: self.phase_bits,
            window: self.window,
            shots: self.shots,
            memory: self.scene.memory(),
            workers,
        }
    }
}

/// Simulates, and prints or writes the result.
///
/// # Errors
/// The scene or the command line is wrong, the circuit is too large, or an output cannot be written.
pub(crate) fn run(args: &SimulateArgs) -> Result<(), Failure> {
    let asked = args.film.as_deref().or(args.plot.as_deref());
    let output = asked.map(Output::new).transpose()?;
    let outputs: Vec<&Output> = output.iter().collect();
    keep_apart([&*args.scene.scene], &outputs)?;
    let encoding = args
        .film
        .as_deref()
        .map(|file| Encoding::for_path(file, None))
        .transpose()?;
    let loaded = args.scene.load()?;
    keep_apart(loaded.valid.files().iter().map(PathBuf::as_path), &outputs)?;
    outputs.iter().try_for_each(|output| output.try_writing())?;
    let preparation = Preparation {
        memory: args.scene.memory(),
        planning: PlanOptions::default(),
        shows_plan: false,
    };
    let prepared = preparation.prepare(&loaded)?;
    // Only small circuits can be simulated, so that compiling them is quick.
    let fits = args.scene.memory().keep_compiling(prepared.scene());
    fits.map_err(|error| memory::refused(&error))?;
    let oracles = prepared.oracles();
    match (&output, encoding) {
        (Some(output), Some(encoding)) => film(args, &loaded, oracles, output, encoding),
        _ => one_pixel(args, &loaded, oracles, output.as_ref()),
    }
}

fn one_pixel(
    args: &SimulateArgs,
    loaded: &Loaded,
    oracles: &Oracles<'_>,
    plot: Option<&Output>,
) -> Result<(), Failure> {
    let scene = oracles.scene();
    let film = scene.scene().film;
    let middle = [film.width / 2, film.height / 2];
    let pixel = OraclePixel {
        place: on_film(args.pixel.unwrap_or(middle), film)?,
        seed: args.seed,
    };
    let cancel = interrupt::cancel_on_interrupt()?;
    let workers = Workers {
        cancel: Some(&cancel),
        ..Workers::default()
    };
    let bar = Bar::setting_up();
    if let Some(iterates) = args.mean_phase {
        let asked = MeanPhase {
            iterates,
            slope: args.slope,
            reference: args.reference,
        };
        let simulated = simulate_mean_phase(oracles, pixel, &args.options(workers), &asked);
        bar.clear();
        let simulation = simulated.map_err(|error| refused(loaded, error))?;
        return if args.json {
            let json = json::simulate_mean_phase(scene, &simulation);
            terminal::print(&format!("{json:#}\n"))
        } else {
            terminal::print(&mean_phase_text(&scene.scene().name, &simulation))
        };
    }
    let simulated = simulate(oracles, pixel, &args.options(workers));
    bar.clear();
    let simulation = simulated.map_err(|error| refused(loaded, error))?;
    let name = &scene.scene().name;
    if let Some(output) = plot {
        let file = output.path()?;
        let drawing = draw::outcomes(&simulation, name).svg();
        replace_file(file, |out| out.write_all(drawing.as_bytes()))
            .map_err(|error| Failure::file(file, &error))?;
    }
    if args.json {
        terminal::print(&format!("{:#}\n", json::simulate(scene, &simulation)))
    } else {
        terminal::print(&text(name, &simulation))
    }
}

fn film(
    args: &SimulateArgs,
    loaded: &Loaded,
    oracles: &Oracles<'_>,
    output: &Output,
    encoding: Encoding,
) -> Result<(), Failure> {
    let cancel = interrupt::cancel_on_interrupt()?;
    let bar = Bar::pixels(true);
    let show = |progress| bar.show(progress);
    let workers = Workers {
        threads: args.threads.count(),
        cancel: Some(&cancel),
        progress: Some(&show),
    };
    let simulated = simulate_film(oracles, args.seed, &args.options(workers));
    bar.clear();
    let film = simulated.map_err(|error| refused(loaded, error))?;
    let mut metadata = Metadata::new();
    metadata.set("Software", concat!("qrt ", env!("CARGO_PKG_VERSION")))?;
    metadata.set("scene", &oracles.scene().scene().name)?;
    metadata.set("seed", args.seed.to_string())?;
    image::save(output.path()?, &film.image, &metadata, encoding)?;
    terminal::print(&format!(
        "{}: {} x {} pixels, {} counting circuits of at most {} qubits, {} gates\n\
         largest difference from theory: {:.1e}\n",
        output.path()?.display(),
        film.image.width,
        film.image.height,
        film.circuits,
        film.qubits,
        grouped(film.gates),
        film.largest_difference
    ))
}

/// Reports an error of the simulation: at its place in the scene if the scene has no circuit.
fn refused(loaded: &Loaded, error: SimulateError) -> Failure {
    match error {
        SimulateError::Oracle(error) => loaded.report(vec![error.problem()]).into(),
        SimulateError::WouldNotFit(error) => memory::refused(&error),
        other => other.into(),
    }
}

fn text(scene: &str, one: &Simulation) -> String {
    let [x, y] = one.pixel.place;
    let report = &one.report;
    let size = 1_u64 << one.phase_bits;
    let mut out = format!(
        "{scene}: channel {} of pixel {x},{y}, seed {}\n\
         {} qubits: {} path, {} comparator, {} phase, {} work; {} gates in {} queries\n\
         at most {} basis states with amplitude; all work qubits 0 in {} checks\n\
         S = {} of N = {}: S/N = {}\n\n",
        one.name.channel_name(),
        one.pixel.seed,
        report.qubits,
        one.path_bits,
        one.comparator_bits,
        one.phase_bits,
        one.work_qubits(),
        grouped(report.gates),
        report.queries,
        grouped(report.most_states.unwrap_or(0)),
        report.checks,
        one.good,
        one.total,
        one.amplitude(),
    );
    let width = (size / 2).to_string().len().max(3);
    let _ = writeln!(
        out,
        "{:>width$}  {:<8}  {:<10}  {:<10}  drawn  # simulated, | theory",
        "y", "S/N", "simulated", "theory"
    );
    let drawn = one.tally();
    for outcome in &one.outcomes {
        let sine = libm::sin(std::f64::consts::PI * outcome.y as f64 / size as f64);
        let times = drawn.get(&outcome.y).copied().unwrap_or(0);
        let _ = writeln!(
            out,
            "{:>width$}  {:<8.6}  {:<10.8}  {:<10.8}  {times:<5}  {}",
            outcome.y,
            sine * sine,
            outcome.simulated,
            outcome.theory,
            bar(outcome)
        );
    }
    let estimate = &one.estimate;
    let _ = write!(
        out,
        "\nlargest difference: {:.1e}\n\
         estimate from {} drawn: S/N = {:.6} in {:.6}..{:.6} ({} % confidence), radiance {:.6}\n",
        one.largest_difference(),
        one.drawn.len(),
        estimate.amplitude,
        estimate.interval.0,
        estimate.interval.1,
        100.0 * estimate.confidence,
        one.radiance()
    );
    out
}

/// The simulated probability as a bar, with a mark at the end of the bar that theory predicts.
fn bar(outcome: &Outcome) -> String {
    let [simulated, theory] =
        [outcome.simulated, outcome.theory].map(|one| (one * BAR).round() as usize);
    (0..simulated.max(theory + 1))
        .map(|column| match column {
            column if column == theory => '|',
            column if column < simulated => '#',
            _ => ' ',
        })
        .collect()
}

/// A positive number to four decimals, or in powers of ten.
pub(super) fn short(number: f64) -> String {
    if (1e-2..1e6).contains(&number) {
        format!("{number:.4}")
    } else {
        format!("{number:.4e}")
    }
}

fn mean_phase_text(scene: &str, one: &MeanPhaseSimulation) -> String {
    let [x, y] = one.pixel.place;
    let mut out = format!(
        "{scene}: channel {} of pixel {x},{y}, seed {}\n\
         {} qubits: {} path, 1 sign, {} work; {} gates in {} queries; all work qubits 0 at the end\n\
         mean {:.6} and standard deviation {:.6} of the scale; slope {}, reference {:.6}, {} iterates\n\n\
         {HEAD}",
        one.name.channel_name(),
        one.pixel.seed,
        one.qubits,
        one.path_bits,
        one.qubits - one.path_bits - 1,
        grouped(one.gates),
        one.queries,
        one.mean,
        one.deviation,
        short(one.phases.slope()),
        one.phases.reference(),
        one.iterates,
        HEAD = "level    paths  sign 0      theory      sign 1      theory\n",
    );
    for level in &one.levels {
        let ([a, b], [c, d]) = (level.simulated, level.theory);
        let _ = writeln!(
            out,
            "{:>5}  {:>7}  {a:.8}  {c:.8}  {b:.8}  {d:.8}",
            level.level, level.paths
        );
    }
    let [simulated, theory] = one.zero();
    let _ = write!(
        out,
        "\nsign 0: {simulated:.8}, theory {theory:.8}\nlargest difference: {:.1e}\n",
        one.largest_difference()
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_shows_what_is_simulated_and_where_theory_ends() {
        for (simulated, theory, expected) in [
            (0.25, 0.25, "########|"),
            (0.25, 0.125, "####|###"),
            (0.125, 0.25, "####    |"),
            (0.0, 0.0, "|"),
            (0.0, 0.0625, "  |"),
            (1e-9, 1.0, "                                |"),
        ] {
            let outcome = Outcome {
                y: 0,
                simulated,
                theory,
            };
            assert_eq!(bar(&outcome), expected);
        }
    }
}
