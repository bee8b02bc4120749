//! `qrt export`: writes a pixel's circuit, or the scene, for other programs.

mod mitsuba;

use super::args::{SceneArgs, choice, on_film, pixel, reference, slope};
use super::failure::Failure;
use super::files::{Output, keep_apart, named_after};
use super::inspect::{CHANNEL_CHOICES, channel_name, keep_budget};
use super::prepare::{self, Preparation};
use super::progress::Bar;
use super::simulate::short;
use super::{interrupt, terminal};
use clap::Args;
use qrt_circuit::export::{Export, ExportCounts, ExportError, ExportFormat};
use qrt_circuit::lower::Cost;
use qrt_circuit::quantum::{
    CircuitPart, Conjunction, CountingCircuit, LevelPhases, MeanPhaseCircuit, PhaseOracle,
    QuantumError,
};
use qrt_core::inspect::{Inspection, OraclePixel, grouped};
use qrt_core::oracle::{Oracle, OracleName, PARTS_OF_A_CALL};
use qrt_counting::Stratum;
use qrt_lab::json;
use qrt_lab::simulate::{MeanPhase, SimulateError};
use qrt_lab::verify::{PixelCounts, pixel_counts};
use qrt_runtime::memory::CircuitWork;
use qrt_runtime::plan::{PlanFigures, PlanOptions};
use qrt_runtime::replace_file::replace_file;
use qrt_runtime::workers::{Progress, Workers};
use qrt_scene::Window;
use qrt_scene::valid::ValidScene;
use serde_json::{Map, Value, json};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Language {
    /// A circuit.
    Circuit(ExportFormat),
    /// The scene, for Mitsuba.
    Mitsuba,
}

impl Language {
    fn name(self) -> &'static str {
        match self {
            Self::Circuit(format) => format.name(),
            Self::Mitsuba => "mitsuba",
        }
    }
}

const LANGUAGES: [(Language, &str); 3] = [
    (
        Language::Circuit(ExportFormat::OpenQasm3),
        "OpenQASM 3.0, of its standard gates alone",
    ),
    (
        Language::Circuit(ExportFormat::OpenQasm2),
        "OpenQASM 2.0, for programs that do not read version 3",
    ),
    (
        Language::Mitsuba,
        "The scene as XML for the renderer Mitsuba 3, with its faces in .ply files beside it",
    ),
];

/// A circuit to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// A part of the counting circuit.
    Of(CircuitPart),
    /// The circuit of the mean phase.
    MeanPhase,
}

const ORACLE: Part = Part::Of(CircuitPart::Oracle);
const COUNTING: Part = Part::Of(CircuitPart::Counting);

const PARTS: [(Part, &str); 4] = [
    (ORACLE, "O_f, once"),
    (Part::Of(CircuitPart::Grover), "One iterate G = H O_0 H O_f"),
    (COUNTING, "The whole circuit of quantum counting"),
    (
        Part::MeanPhase,
        "The circuit of the mean phase: iterates, and the measurement of the path and the sign",
    ),
];

/// Bytes of a gate's line in a circuit of some 10,000 to 100,000 qubits.
const BYTES_A_GATE: u64 = 28;

/// Write a pixel's circuit as OpenQASM, or the scene for Mitsuba 3
///
/// The oracle flips the signs of the pixel's good indices. It computes the colours of all paths,
/// compares, flips and uncomputes, with X, CNOT, Toffoli and Z gates. The pixel's position is built
/// in. The Grover iterate is the oracle and a reflection. Counting is all of it: the window on the
/// phase register, 2^t - 1 controlled iterates, the inverse Fourier transform, and the
/// measurement of y, which estimates S/N by sin(pi y / 2^t)^2. The mean-phase circuit looks the phase
/// of a path's colour up in place of comparing, and runs K iterates whose phase is the mean of the
/// pixel's colours in units of their standard deviation.
///
/// The text is flat: registers, gates, measurements, a line each. Qiskit, Q#, Cirq and MQT Core
/// read both languages, pytket version 2, PennyLane version 3 without `include` and measurements.
/// Bit 0 of every register is its least significant. Every qubit starts at zero. For the oracle and
/// the iterate, prepare the index (its path and its comparator) yourself, for example with
/// Hadamards.
///
/// For Mitsuba, the whole scene is written: its `path` integrator renders the picture that qrt
/// renders, so that anyone can check one by the other. A `phong` that shines and a `bsdf` of one's own
/// have no counterpart there.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt export box.yaml                    the middle pixel's oracle, box.qasm
  qrt export box.yaml --pixel 10,20 --channel g -o g.qasm
  qrt export box.yaml --part counting --set counting.phase_bits=3
  qrt export box.yaml --part grover --stratum 0/4        the darkest eighth of the comparator
  qrt export box.yaml --part mean-phase --iterates 4
  qrt export box.yaml --format openqasm2 -o - | gzip > box.qasm.gz
  qrt export box.yaml --format mitsuba   the scene, box.xml and box.N.MATERIAL.ply")]
pub(crate) struct ExportArgs {
    /// The file; `-` is standard output, for a circuit [default: SCENE's name with .qasm or .xml, in
    /// the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The language
    #[arg(long, value_parser = choice(LANGUAGES, Language::name), default_value = "openqasm3")]
    format: Language,
    /// The part of the circuit [default: oracle]
    #[arg(long, value_parser = choice(PARTS, part_name))]
    part: Option<Part>,
    /// Iterates of the mean-phase circuit, below 2^40; it calls the oracle K + 1 times [default: 1]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(0..1 << 40))]
    iterates: Option<u64>,
    /// The slope of the mean phase, for colours over the scale [default: 0.6 over the paths' standard
    /// deviation]
    #[arg(long, value_name = "ALPHA", value_parser = slope, allow_hyphen_values = true)]
    slope: Option<f64>,
    /// The colour of phase 0, over the scale [default: half a standard deviation below the mean]
    #[arg(long, value_name = "COLOUR", value_parser = reference, allow_hyphen_values = true)]
    reference: Option<f64>,
    /// The pixel: column and row, from 0 at the top left [default: the one in the middle]
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pixel: Option<[u32; 2]>,
    /// The channel [default: the one whose oracle has the most Toffolis]
    #[arg(long, value_parser = choice(CHANNEL_CHOICES, channel_name), value_name = "CHANNEL")]
    channel: Option<usize>,
    /// Of the strata that halve the comparator's range N - 1 times, only number K, from 0 for the
    /// darkest: its comparator's top bits are fixed by Xs where the whole has Hadamards. For grover
    /// and counting; the oracle is the same for all
    #[arg(long, value_name = "K/N", value_parser = stratum)]
    stratum: Option<(u32, u32)>,
    /// Another seed gives other paths [default: 0]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Refuse to write more gates; a gate takes some 28 bytes [default: 50000000]
    #[arg(long, value_name = "N")]
    max_gates: Option<u64>,
    /// JSON instead of a summary
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scene: SceneArgs,
}

impl ExportArgs {
    /// Returns the first given option that is of a pixel's circuit.
    fn of_circuits(&self) -> Option<&'static str> {
        let circuits = [
            ("--part", self.part.is_some()),
            ("--pixel", self.pixel.is_some()),
            ("--channel", self.channel.is_some()),
            ("--stratum", self.stratum.is_some()),
            ("--iterates", self.iterates.is_some()),
            ("--slope", self.slope.is_some()),
            ("--reference", self.reference.is_some()),
            ("--seed", self.seed.is_some()),
            ("--max-gates", self.max_gates.is_some()),
        ];
        let given = circuits.into_iter().find(|(_, given)| *given);
        given.map(|(flag, _)| flag)
    }

    fn part(&self) -> Part {
        self.part.unwrap_or(ORACLE)
    }

    fn mean_phase(&self) -> MeanPhase {
        MeanPhase {
            iterates: self.iterates.unwrap_or(1),
            slope: self.slope,
            reference: self.reference,
        }
    }

    /// Refuses parameters of another part than the requested one.
    fn check_part(&self) -> Result<(), Failure> {
        let of_mean_phase = [
            ("--iterates", self.iterates.is_some()),
            ("--slope", self.slope.is_some()),
            ("--reference", self.reference.is_some()),
        ];
        match of_mean_phase.into_iter().find(|(_, given)| *given) {
            Some((name, _)) if self.part() != Part::MeanPhase => Err(Failure::Usage(format!(
                "{name} is a parameter of the mean phase: it needs --part mean-phase"
            ))),
            _ => Ok(()),
        }
    }

    fn seed(&self) -> u64 {
        self.seed.unwrap_or(0)
    }

    fn max_gates(&self) -> u64 {
        self.max_gates.unwrap_or(50_000_000)
    }
}

fn part_name(part: Part) -> &'static str {
    match part {
        Part::Of(CircuitPart::Oracle) => "oracle",
        Part::Of(CircuitPart::Grover) => "grover",
        Part::Of(CircuitPart::Counting) => "counting",
        Part::MeanPhase => "mean-phase",
    }
}

/// Returns the comment that describes a part, for readers of the file.
fn about(part: Part) -> &'static [&'static str] {
    match part {
        Part::Of(CircuitPart::Oracle) => &[
            "Flips the sign of each good index: of a path whose colour exceeds the comparator's threshold.",
        ],
        Part::Of(CircuitPart::Grover) => &[
            "G = H O_0 H O_f: rotates the plane of good and other indices by theta turns, where",
            "sin(pi theta)^2 = S/N for S good indices of N. Its global phase is included.",
        ],
        Part::Of(CircuitPart::Counting) => &[
            "Reads y into outcome: y/2^t or 1 - y/2^t is about theta, in turns, where",
            "sin(pi theta)^2 = S/N for S good indices of N.",
        ],
        Part::MeanPhase => &[
            "Reads the sign into bit 0 of outcome, and the path into the bits above it. The sign is measured at a",
            "right angle: the fraction of ones moves with the mean of the paths' colours.",
        ],
    }
}

/// Returns, in words, the qubits and gates of a part that the oracle does not have.
fn beside_oracle(part: Part) -> Option<&'static str> {
    match part {
        Part::Of(CircuitPart::Oracle) => None,
        Part::MeanPhase => Some(
            "A call of this circuit looks a phase up by the path's colour, where the oracle compares. Beside its \
             calls, the circuit has a sign qubit, and a reflection between two calls.",
        ),
        Part::Of(CircuitPart::Grover) => {
            Some("Beside the oracle, the iterate has the reflection O_0.")
        }
        Part::Of(CircuitPart::Counting) => Some(
            "Beside its calls of the oracle, counting has the phase register, its window and inverse \
             Fourier transform, and a reflection O_0 after each call.",
        ),
    }
}

fn stratum(text: &str) -> Result<(u32, u32), String> {
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
    match numbers {
        Some((number, strata)) if number < strata => Ok((number, strata)),
        _ => Err("a stratum is written as K/N, with K from 0 to N - 1, such as 3/4".to_owned()),
    }
}

/// Returns the requested stratum of a comparator of `bits` bits.
fn stratum_of(args: &ExportArgs, bits: u32) -> Result<Option<Stratum>, Failure> {
    let Some((number, strata)) = args.stratum else {
        return Ok(None);
    };
    let refuse = |message: String| Err(Failure::Usage(message));
    if matches!(args.part(), ORACLE | Part::MeanPhase) {
        return refuse(
            "--stratum is of what is counted, and the oracle is the same for all strata: it needs \
             --part grover or counting"
                .to_owned(),
        );
    }
    let mut all = Stratum::halving(strata, bits);
    let most = all.len() as u64;
    if u64::from(strata) > most {
        return refuse(format!(
            "--stratum {number}/{strata}: a comparator of {bits} bits has at most {most} strata"
        ));
    }
    Ok(all.nth(number as usize))
}

/// Fixes the comparator's bits of `oracle` to their values in `stratum`.
fn fixed(
    oracle: PhaseOracle,
    stratum: Stratum,
    path_bits: u32,
    bits: u32,
) -> Result<PhaseOracle, QuantumError> {
    let (fixed, lowest) = stratum.fixed_bits(bits);
    let comparator = oracle.index().get(path_bits as usize..).unwrap_or_default();
    let fixed = comparator.get(fixed.start as usize..fixed.end as usize);
    let fixed = fixed.unwrap_or_default().to_vec();
    let (ones, zeros) = fixed.split_at(usize::from(lowest).min(fixed.len()));
    oracle.with_fixed(zeros, ones)
}

/// Figures of the oracle of the written circuit, as `qrt inspect --pixel` prints them.
struct OracleFigures {
    name: OracleName,
    pixel: OraclePixel,
    which: String,
    call: String,
    qubits: u32,
    cost: Cost,
    toffoli_depth: u64,
}

impl OracleFigures {
    fn from_inspection(inspection: &Inspection) -> Self {
        Self {
            name: inspection.name,
            pixel: inspection.pixel.unwrap_or_default(),
            which: inspection.which(),
            call: inspection.call_in_words(),
            qubits: inspection.qubits,
            cost: inspection.total(),
            toffoli_depth: inspection.toffoli_depth,
        }
    }

    fn json(&self) -> Value {
        let mut gates = json::cost(self.cost);
        gates["toffoli_depth"] = json!(self.toffoli_depth);
        json!({
            "includes": PARTS_OF_A_CALL,
            "qubits": self.qubits,
            "gates": gates,
        })
    }
}

/// A circuit to write, with the facts for its summary.
struct Exported<'a> {
    args: &'a ExportArgs,
    format: ExportFormat,
    scene: &'a ValidScene,
    oracle: &'a OracleFigures,
    export: &'a Export<'a>,
    /// Number of calls of the oracle.
    queries: u64,
    plan: Option<&'a PlanFigures>,
    window: Window,
    /// The table of the mean phase.
    phases: Option<LevelPhases>,
    stratum: Option<Stratum>,
    /// The pixel's counts beside those of real numbers, if they can be had.
    counts: Option<PixelCounts>,
    file: &'a Path,
}

pub(crate) fn run(args: &ExportArgs) -> Result<(), Failure> {
    match args.format {
        Language::Circuit(format) => circuit(args, format),
        Language::Mitsuba => mitsuba::export_scene(args),
    }
}

fn circuit(args: &ExportArgs, format: ExportFormat) -> Result<(), Failure> {
    args.check_part()?;
    let file = args
        .output
        .clone()
        .unwrap_or_else(|| named_after(&args.scene.scene, "qasm"));
    let to_stdout = file == Path::new("-");
    if to_stdout && args.json {
        let message = "`-o -` writes where `--json` does; name a file for the circuit";
        return Err(Failure::Usage(message.to_owned()));
    }
    let output = (!to_stdout).then(|| Output::new(&file)).transpose()?;
    if let Some(output) = &output {
        keep_apart([&*args.scene.scene], &[output])?;
    }
    let loaded = args.scene.load()?;
    if let Some(output) = &output {
        keep_apart(loaded.valid.files().iter().map(PathBuf::as_path), &[output])?;
        output.try_writing()?;
    }
    let cancel = interrupt::cancel_on_interrupt()?;
    let workers = Workers {
        cancel: Some(&cancel),
        ..Workers::default()
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
    let written = scene.scene();
    let film = written.film;
    let middle = [film.width / 2, film.height / 2];
    let pixel = OraclePixel {
        place: on_film(args.pixel.unwrap_or(middle), film)?,
        seed: args.seed(),
    };
    let inspection = {
        let alone = prepare::pixel_oracles(&prepared, &loaded, (pixel.place, CircuitWork::Export))?;
        let inspection = Inspection::of_pixel(&alone, args.channel, pixel);
        inspection.map_err(|error| prepare::without_circuit(&error, &loaded))?
    };
    let call = inspection.oracle_cost();
    if args.part() != Part::MeanPhase {
        keep_budget(&loaded, &[call])?;
    }
    let failed = |error: &dyn std::error::Error| Failure::Job(error.to_string());
    let path_bits = inspection.oracle.points.path_bits();
    let bits = inspection.oracle.comparator_bits();
    let stratum = stratum_of(args, bits)?;
    let wanted = match args.part() {
        Part::Of(part) => Wanted::Part(part),
        Part::MeanPhase => {
            // Paths may be traced for it.
            interrupt::begun();
            Wanted::MeanPhase(table(args, &inspection.oracle, pixel, &workers)?)
        }
    };
    let oracle = match &wanted {
        Wanted::Part(_) => inspection.oracle.phase(0, pixel.seed, pixel.place),
        Wanted::MeanPhase(phases) => {
            (inspection.oracle).level_phases(0, pixel.seed, pixel.place, phases)
        }
    };
    let mut oracle = oracle.map_err(|error| failed(&error))?;
    if let Some(stratum) = stratum {
        oracle = fixed(oracle, stratum, path_bits, bits).map_err(|error| failed(&error))?;
    }
    let window = written.counting.register_window();
    let source = match wanted {
        Wanted::MeanPhase(phases) => {
            let asked = args.mean_phase();
            let turns = (asked.iterates, asked.basis());
            let circuit = MeanPhaseCircuit::with(&oracle, phases, turns, Conjunction::Toffolis);
            if let Ok(circuit) = &circuit {
                let mut own = call;
                own.call.qubits = circuit.qubits().into();
                keep_budget(&loaded, &[own])?;
            }
            circuit.map(Source::MeanPhase)
        }
        Wanted::Part(part) => {
            let phase_bits = written.counting.phase_bits;
            let counting =
                CountingCircuit::with(&oracle, phase_bits, window, Conjunction::Toffolis);
            counting.map(|counting| Source::Counting(counting, part))
        }
    };
    let source = source.map_err(|error| failed(&error))?;
    let parts = inspection.oracle.index_parts();
    let counts = match args.part() {
        Part::Of(_) => pixel_counts(scene, &inspection.oracle, pixel)?,
        // Nothing is compared.
        Part::MeanPhase => None,
    };
    let figures = OracleFigures::from_inspection(&inspection);
    // The phase oracle has its own program, so the inspection can be freed.
    drop(inspection);
    let export = source.export(parts);
    let export = export.map_err(|error| failed(&error))?;
    allow(args, &source, window, export.gates())?;
    let bar = Bar::gates(!args.json && !to_stdout);
    bar.show(Progress::Started {
        total: export.gates(),
        resumed: 0,
    });
    let show = |gates| bar.show(Progress::Finished(gates));
    let export = export.with_cancel(&cancel).with_progress(&show);
    let exported = Exported {
        args,
        format,
        scene,
        oracle: &figures,
        export: &export,
        queries: source.queries(),
        plan: prepared.plan(),
        window,
        phases: wanted.phases(),
        stratum,
        counts,
        file: &file,
    };
    let tally = match &output {
        None => exported.to_stdout(),
        Some(output) => exported.to_file(output),
    };
    bar.clear();
    let Some(tally) = tally? else {
        return Ok(());
    };
    if to_stdout {
        terminal::note(exported.summary(&tally).trim_end());
        Ok(())
    } else if args.json {
        terminal::print(&format!("{:#}\n", exported.json(&tally)))
    } else {
        terminal::print(&exported.summary(&tally))
    }
}

/// A part of the counting circuit, or the mean phase with its table.
#[derive(Clone, Copy)]
enum Wanted {
    Part(CircuitPart),
    MeanPhase(LevelPhases),
}

impl Wanted {
    /// Returns the table of the mean phase.
    fn phases(self) -> Option<LevelPhases> {
        match self {
            Self::Part(_) => None,
            Self::MeanPhase(phases) => Some(phases),
        }
    }
}

/// The circuit that is written, or whose part is.
enum Source<'a> {
    Counting(CountingCircuit<'a>, CircuitPart),
    MeanPhase(MeanPhaseCircuit<'a>),
}

impl Source<'_> {
    /// Prepares the circuit for writing, with the names of the path and of the comparator in its index.
    fn export(
        &self,
        [path, comparator]: [(&'static str, u32); 2],
    ) -> Result<Export<'_>, ExportError> {
        match self {
            Self::Counting(counting, part) => Export::new(counting, *part, &[path, comparator]),
            Self::MeanPhase(circuit) => Export::mean_phase(circuit, &[path]),
        }
    }

    /// Returns the number of calls of the oracle.
    fn queries(&self) -> u64 {
        match self {
            Self::Counting(counting, CircuitPart::Counting) => counting.queries(),
            Self::Counting(..) => 1,
            Self::MeanPhase(circuit) => circuit.queries(),
        }
    }
}

/// Returns the table of the mean phase in a pixel.
fn table(
    args: &ExportArgs,
    oracle: &Oracle,
    pixel: OraclePixel,
    workers: &Workers<'_>,
) -> Result<LevelPhases, Failure> {
    let table = args.mean_phase().table(oracle, pixel, workers);
    table.map_err(|error| match error {
        SimulateError::Interrupted => Failure::Job(error.to_string()),
        error => Failure::Usage(error.to_string()),
    })
}

/// Refuses to write more gates than `--max-gates`.
fn allow(
    args: &ExportArgs,
    source: &Source<'_>,
    window: Window,
    gates: u64,
) -> Result<(), Failure> {
    if gates <= args.max_gates() {
        return Ok(());
    }
    let shorter = match source {
        Source::Counting(counting, CircuitPart::Counting) => {
            match longest(counting, window, args.max_gates()) {
                None => format!(
                    "; one iterate alone has {}",
                    grouped(counting.iterate().gates(true))
                ),
                Some(bits) => format!("; `--set counting.phase_bits={bits}` makes it short enough"),
            }
        }
        Source::Counting(..) => String::new(),
        Source::MeanPhase(circuit) => match circuit.queries() {
            0 | 1 => String::new(),
            queries => {
                // The gates of a call with its reflection.
                let call = gates.div_ceil(queries);
                match (args.max_gates() / call).saturating_sub(1) {
                    0 => format!("; one call alone has some {}", grouped(call)),
                    most => format!("; `--iterates {most}` makes it short enough"),
                }
            }
        },
    };
    Err(Failure::Usage(format!(
        "{} gates, some {} of text, are more than --max-gates {}{shorter}",
        grouped(gates),
        size(gates.saturating_mul(BYTES_A_GATE)),
        args.max_gates()
    )))
}

/// Returns the most phase bits for which a counting circuit has no more than `gates` gates.
fn longest(counting: &CountingCircuit<'_>, window: Window, gates: u64) -> Option<u32> {
    let oracle = counting.iterate().oracle();
    let fits = |bits: &u32| {
        CountingCircuit::with(oracle, *bits, window, Conjunction::Toffolis)
            .is_ok_and(|shorter| shorter.gates(CircuitPart::Counting) <= gates)
    };
    (1..=counting.phase_register().len() as u32)
        .rev()
        .find(fits)
}

/// Formats a number of bytes in the largest unit that it fills.
fn size(bytes: u64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let bytes = bytes as f64;
    match units.into_iter().find(|(unit, _)| bytes >= *unit) {
        Some((unit, name)) => format!("{:.1} {name}", bytes / unit),
        None => format!("{bytes} bytes"),
    }
}

impl Exported<'_> {
    fn write(&self, out: &mut impl Write) -> Result<ExportCounts, ExportError> {
        self.export.write(self.format, &self.comments(), out)
    }

    fn to_file(&self, output: &Output) -> Result<Option<ExportCounts>, Failure> {
        let mut tally = None;
        let written = replace_file(output.path()?, |out| {
            tally = Some(self.write(out)?);
            Ok::<(), ExportError>(())
        });
        match written {
            Ok(()) => Ok(tally),
            Err(ExportError::Io(error)) => Err(Failure::file(self.file, &error)),
            Err(error) => Err(Failure::Job(error.to_string())),
        }
    }

    /// Writes to standard output; `None` if the reader closed the pipe.
    fn to_stdout(&self) -> Result<Option<ExportCounts>, Failure> {
        match self.write(&mut BufWriter::new(io::stdout().lock())) {
            Ok(tally) => Ok(Some(tally)),
            Err(ExportError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(None),
            Err(ExportError::Io(error)) => Err(Failure::Job(format!("standard output: {error}"))),
            Err(error) => Err(Failure::Job(error.to_string())),
        }
    }

    fn comments(&self) -> Vec<String> {
        let part = self.args.part();
        let mut lines = vec![format!(
            "qrt {}: {}, {} of {}, seed {}",
            env!("CARGO_PKG_VERSION"),
            self.scene.scene().name,
            part_name(part),
            self.oracle.which,
            self.args.seed()
        )];
        lines.extend(about(part).iter().map(|line| (*line).to_owned()));
        lines.extend(
            self.call()
                .map(|call| format!("One call of the oracle has {call}.")),
        );
        lines.extend(beside_oracle(part).map(str::to_owned));
        lines.extend(self.table_in_words().map(|words| format!("{words}.")));
        lines.push("The pixel's position and shifts are built in.".to_owned());
        lines.extend(self.counts.map(|counts| format!("{}.", counts.in_words())));
        if let (Some((number, strata)), Some(stratum)) = (self.args.stratum, self.stratum) {
            let Range { start, end } = stratum.thresholds();
            lines.push(format!(
                "Stratum {number} of {strata}: the comparator is in {start}..{end}; its bits above are fixed."
            ));
        }
        lines.push("Bit 0 of each register is its least significant.".to_owned());
        lines
    }

    /// Returns a call of the oracle in words. A mean-phase circuit has another oracle, without a comparator.
    fn call(&self) -> Option<&str> {
        self.phases.is_none().then_some(&*self.oracle.call)
    }

    /// Returns the table of the mean phase in words.
    fn table_in_words(&self) -> Option<String> {
        let phases = self.phases?;
        Some(format!(
            "iterates: {}; the phase of a colour x of the scale is 2 atan({} (x - {:.6}))",
            self.args.mean_phase().iterates,
            short(phases.slope()),
            phases.reference()
        ))
    }

    fn summary(&self, tally: &ExportCounts) -> String {
        let file = match self.file.to_str() {
            Some("-") => "standard output".into(),
            _ => self.file.to_string_lossy(),
        };
        let part = self.args.part();
        let mut text = format!(
            "{file}: {} of {}; {}; {}\n",
            part_name(part),
            self.oracle.which,
            tally.text(),
            size(tally.bytes)
        );
        let values = self.counts.map(|counts| counts.in_words());
        let call = self
            .call()
            .map(|call| format!("one call of the oracle: {call}"));
        let beside = beside_oracle(part).map(str::to_owned);
        for line in [call, beside, self.table_in_words(), values]
            .into_iter()
            .flatten()
        {
            text.push_str(&line);
            text.push('\n');
        }
        text
    }

    fn json(&self, tally: &ExportCounts) -> Value {
        let registers = self.export.registers().iter();
        let registers: Vec<Value> = registers
            .map(|register| json!({ "name": register.name, "width": register.qubits.len() }))
            .collect();
        let gates = tally.by_name.iter();
        let gates: Map<String, Value> = gates
            .map(|(name, gates)| ((*name).to_owned(), json!(gates)))
            .collect();
        let counting = self.args.part() == COUNTING;
        json!({
            "version": 1,
            "qrt": env!("CARGO_PKG_VERSION"),
            "scene": self.scene.scene().name,
            "scene_hash": self.scene.fingerprint().to_string(),
            "file": self.file.display().to_string(),
            "format": self.format.name(),
            "part": part_name(self.args.part()),
            "channel": self.oracle.name.channel_name(),
            "class": self.oracle.name.class_name(),
            "pixel": self.oracle.pixel.place,
            "seed": self.oracle.pixel.seed,
            "oracle": self.call().map(|_| self.oracle.json()),
            "beside_oracle": beside_oracle(self.args.part()),
            "queries": self.queries,
            "window": counting.then(|| self.window.name()),
            "mean_phase": self.phases.map(|phases| json!({
                "iterates": self.args.mean_phase().iterates,
                "slope": phases.slope(),
                "reference": phases.reference(),
            })),
            "stratum": self.stratum.map(|stratum| {
                let Range { start, end } = stratum.thresholds();
                json!({ "thresholds": [start, end] })
            }),
            "registers": registers,
            "qubits": tally.qubits,
            "gates": gates,
            "bytes": tally.bytes,
            "counts": self.counts.map(json::pixel_counts),
            "plan": self.plan.map(json::plan),
        })
    }
}
