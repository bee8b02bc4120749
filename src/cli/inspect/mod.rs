//! `qrt inspect`: shows the cost of a scene's oracle, and its parts.

mod logical;
mod pareto;
mod text;

use super::args::{SceneArgs, ThreadsArgs, choice, on_film, pixel};
use super::failure::Failure;
use super::files::{Output, keep_apart};
use super::prepare::{self, Preparation};
use super::progress::Bar;
use super::terminal;
use clap::Args;
use qrt_core::inspect::{CHANNELS, CallDiagram, OraclePixel};
use qrt_core::oracle::{OracleCost, check_budget};
use qrt_lab::draw;
use qrt_lab::inspect::InspectFigures;
use qrt_lab::json;
use qrt_lab::verify::VerifyError;
use qrt_runtime::memory::CircuitWork;
use qrt_runtime::plan::PlanOptions;
use qrt_runtime::replace_file::replace_file;
use qrt_scene::front::Loaded;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Show what a scene's quantum circuit costs, and where
///
/// Compiles one of the scene's oracles and counts one whole call of it: compute the colours of all
/// paths in superposition, compare and flip the phase, uncompute. Nothing is rendered.
///
/// A scene has an oracle for each channel. Where lamps are sampled it has one for pixels that may see
/// a lamp and another for pixels that see none: their colours have other scales. Without --channel and
/// --pixel the oracle with the most Toffolis is shown, and the others are listed. With --pixel it is
/// the oracle of that pixel, as `qrt export` writes it.
///
/// A scene that asks for an `accuracy` is shown with the parameters that are chosen for it, and the
/// plan with what is expected of it.
///
/// A scene's `budget` is checked; beyond it the figures are still shown and the exit code is 2.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt inspect box.yaml                                  the figures
  qrt inspect box.yaml --pixel 10,20 --channel g        the oracle that `qrt export` writes
  qrt inspect box.yaml --planes                         with each plane of each search
  qrt inspect box.yaml --json --set precision.fraction=12
  qrt inspect box.yaml --registers map.svg --circuit frame.svg
  qrt inspect box.yaml --circuit -                      the circuit, drawn in the terminal
  qrt inspect box.yaml --pareto                         qubits against gates: what can be had
  qrt inspect box.yaml --logical-counts counts.json     for estimators of physical resources")]
pub(crate) struct InspectArgs {
    /// The channel [default: the one whose oracle has the most Toffolis]
    #[arg(long, value_parser = choice(CHANNEL_CHOICES, channel_name), value_name = "CHANNEL")]
    channel: Option<usize>,
    /// The pixel: column and row, from 0 at the top left [default: those whose oracle has the most
    /// Toffolis]
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pixel: Option<[u32; 2]>,
    /// Another seed gives the pixel other paths [default: 0]
    #[arg(long, value_name = "S", requires = "pixel")]
    seed: Option<u64>,
    /// List each plane or primitive of a search, not only their sum
    #[arg(short = 'v', long, conflicts_with = "json")]
    planes: bool,
    /// JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Draw which qubits each register has, and when
    #[arg(long, value_name = "FILE.svg")]
    registers: Option<PathBuf>,
    /// Draw the circuit as boxes on wires; `-` draws it in the terminal
    #[arg(long, value_name = "FILE.svg")]
    circuit: Option<PathBuf>,
    /// Write what estimators of physical resources take, as Q#'s `LogicalCounts`: the counts of a call
    /// of the oracle, of a channel of a pixel, of a pixel and of the film, with all that counting needs
    #[arg(long, value_name = "FILE.json")]
    logical_counts: Option<PathBuf>,
    /// Compile under each strategy, and list those that no other beats in qubits and in Toffolis; drawings
    /// are of the scene's own
    #[arg(long, conflicts_with_all = ["planes", "logical_counts"])]
    pareto: bool,
    /// Draw qubits against gates
    #[arg(long, value_name = "FILE.svg", requires = "pareto")]
    pareto_plot: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    #[command(flatten)]
    scene: SceneArgs,
}

pub(super) const CHANNEL_CHOICES: [(usize, &str); 3] = [(0, "Red"), (1, "Green"), (2, "Blue")];

/// Returns the name of a channel: `r`, `g` or `b`.
pub(super) fn channel_name(channel: usize) -> &'static str {
    CHANNELS[channel]
}

pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    let in_terminal = args.circuit.as_deref() == Some(Path::new("-"));
    if in_terminal && args.json {
        let message = "`--circuit -` draws where `--json` writes; name a file for one of them";
        return Err(Failure::Usage(message.to_owned()));
    }
    let circuit = args.circuit.as_deref().filter(|_| !in_terminal);
    let circuit = circuit.map(Output::new).transpose()?;
    let registers = args.registers.as_deref().map(Output::new).transpose()?;
    let front = args.pareto_plot.as_deref().map(Output::new).transpose()?;
    let counts = args.logical_counts.as_deref();
    let counts = counts.map(Output::new).transpose()?;
    let outputs = [&circuit, &registers, &front, &counts];
    let outputs: Vec<&Output> = outputs.into_iter().flatten().collect();
    keep_apart([&*args.scene.scene], &outputs)?;
    let loaded = args.scene.load()?;
    keep_apart(loaded.valid.files().iter().map(PathBuf::as_path), &outputs)?;
    outputs.iter().try_for_each(|output| output.try_writing())?;
    let preparation = Preparation {
        memory: args.scene.memory(),
        planning: PlanOptions::default(),
        shows_plan: false,
    };
    let prepared = preparation.prepare(&loaded)?;
    let scene = prepared.scene();
    let pixel = args.pixel.map(|pixel| on_film(pixel, scene.scene().film));
    let pixel = pixel.transpose()?.map(|place| OraclePixel {
        place,
        seed: args.seed.unwrap_or(0),
    });
    let shown = pixel.map_or([0, 0], |pixel| pixel.place);
    prepare::compile(&prepared, &loaded, (shown, CircuitWork::Program))?;
    let oracles = prepared.oracles();
    let front = if args.pareto {
        Some(pareto::report(
            args,
            pixel,
            &loaded,
            oracles,
            front.as_ref(),
        )?)
    } else {
        None
    };
    if let Some(front) = front
        .as_ref()
        .filter(|_| args.circuit.is_none() && args.registers.is_none())
    {
        return terminal::print(front);
    }
    let bar = Bar::setting_up();
    let figures = InspectFigures::new(&prepared, args.channel, pixel);
    bar.clear();
    let figures = figures.map_err(|error| match error {
        VerifyError::Oracle(error) => prepare::without_circuit(&error, &loaded),
        error => error.into(),
    })?;
    let inspection = &figures.inspection;

    let name = &scene.scene().name;
    if let Some(file) = &registers {
        write(file, &draw::registers(inspection, name).svg())?;
    }
    if let Some(file) = &circuit {
        write(file, &draw::frame(inspection, name).svg())?;
    }
    if let Some(file) = &counts {
        let counts = logical::json(&loaded, oracles, inspection, figures.plan)?;
        write(file, &format!("{counts:#}\n"))?;
    }
    let is_front = front.is_some();
    let mut out = if let Some(front) = front {
        front
    } else if args.json {
        format!("{:#}\n", json::inspect(&figures))
    } else {
        text::text(&figures, args.channel.is_some(), args.planes)
    };
    if in_terminal {
        out.push('\n');
        out.push_str(&draw::frame_text(&CallDiagram::new(inspection)));
    }
    terminal::print(&out)?;
    if is_front {
        // A budget applies to one strategy, the scene's.
        return Ok(());
    }
    if pixel.is_some() {
        return keep_budget(&loaded, &[inspection.oracle_cost()]);
    }
    let mut costs = figures.costs;
    costs.retain(|cost| args.channel.is_none_or(|one| one == cost.name.channel));
    keep_budget(&loaded, &costs)
}

/// Checks that one call of each of the oracles in `costs` is within the scene's budget.
///
/// # Errors
/// The figures that exceed the budget.
pub(super) fn keep_budget(loaded: &Loaded, costs: &[OracleCost]) -> Result<(), Failure> {
    check_budget(&loaded.valid, costs).map_err(|problems| loaded.report(problems).into())
}

fn write(output: &Output, text: &str) -> Result<(), Failure> {
    let file = output.path()?;
    replace_file(file, |out| out.write_all(text.as_bytes()))
        .map_err(|error| Failure::file(file, &error))
}
