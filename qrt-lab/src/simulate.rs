//! A pixel's complete counting circuit, run as amplitudes.
//!
//! The circuit is the one that `qrt export --part counting` writes: Hadamards on the index, the window on
//! the phase register, the controlled Grover iterates with every gate of the oracle, and the inverse
//! Fourier transform. It runs on the sparse state vector with all ancillas, which are checked after each
//! query. Beside its outcomes stand those that theory predicts from S of N, where the fixed machine
//! counts S path by path.
//!
//! [`simulate_mean_phase`] runs the circuit of the mean phase, whose ancillas are checked at its end.

mod mean_phase;

pub use mean_phase::{
    LevelOutcome, MOST_ITERATES, MeanPhase, MeanPhaseSimulation, simulate_mean_phase,
};

use qrt_circuit::quantum::{CountingCircuit, MAX_LEVEL_BITS, QuantumError};
use qrt_core::inspect::OraclePixel;
use qrt_core::oracle::{OracleError, OracleName, Oracles};
use qrt_counting::estimators::{DEFAULT_CONFIDENCE, Estimate, EstimatorError, WindowedCounting};
use qrt_counting::random::Stream;
use qrt_counting::{CountingError, PhaseDistribution};
use qrt_machines::statevector::{RunResources, Sparse, StateVectorError, counting_until};
use qrt_runtime::image::Image;
use qrt_runtime::memory::{Memory, MemoryError};
use qrt_runtime::path_machines::{Defect, run_paths};
use qrt_runtime::workers::{Progress, ThreadsError, Workers};
use qrt_scene::Window;
use qrt_scene::valid::ValidScene;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most qubits in superposition: those of the path, the comparator and the phase register. The sparse
/// machine holds an amplitude for each of their basis states.
pub const MOST_SUPERPOSED: u32 = Sparse::MOST_STATES.ilog2();

/// Options of a simulation; the scene's own values apply unless they are set.
#[derive(Clone, Copy, Debug, Default)]
pub struct SimulateOptions<'a> {
    /// The channel: 0 red, 1 green, 2 blue. Without one, the channel whose oracle has the most Toffolis.
    pub channel: Option<usize>,
    /// Number of qubits of the phase register, from 1 to 40; the scene's `counting.phase_bits` unless set.
    pub phase_bits: Option<u32>,
    /// The window on the phase register; the scene's `counting.window` unless set.
    pub window: Option<Window>,
    /// Number of outcomes that are drawn; the scene's `counting.repetitions` unless set.
    pub shots: Option<u32>,
    /// The memory budget. Amplitudes that would exceed it are refused.
    pub memory: Memory,
    /// The threads that simulate pixels of a film, the cancel flag, and the callback for progress in pixels.
    pub workers: Workers<'a>,
}

/// An outcome of the phase register. y and T - y mean the same phase and are one outcome.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The value that is read: 0 to T/2, for T = 2^t.
    pub y: u64,
    /// The probability by the amplitudes of the circuit.
    pub simulated: f64,
    /// The probability that theory predicts from S of N.
    pub theory: f64,
}

/// The result of a pixel's simulated counting circuit.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Channel and class of pixels of the oracle.
    pub name: OracleName,
    /// The pixel and the seed.
    pub pixel: OraclePixel,
    /// Number of qubits of the path index.
    pub path_bits: u32,
    /// Number of qubits of the comparator.
    pub comparator_bits: u32,
    /// Number of qubits of the phase register.
    pub phase_bits: u32,
    /// The window on the phase register.
    pub window: Window,
    /// S, the number of good indices, by the oracle's program on integers.
    pub good: u64,
    /// N, the number of indices.
    pub total: u64,
    /// The proven bound on a path's colour, in radiance: the pixel's value is `scale` times S/N.
    pub scale: f64,
    /// All outcomes.
    pub outcomes: Vec<Outcome>,
    /// Qubits, gates and queries of the run.
    pub report: RunResources,
    /// The outcomes that were drawn from the simulated probabilities, in order.
    pub drawn: Vec<u64>,
    /// The estimate from the drawn outcomes.
    pub estimate: Estimate,
}

impl Simulation {
    /// The largest difference between a simulated probability and theory.
    pub fn largest_difference(&self) -> f64 {
        let differences = self.outcomes.iter().map(|o| (o.simulated - o.theory).abs());
        differences.fold(0.0, f64::max)
    }

    /// S/N, the amplitude that is counted.
    pub fn amplitude(&self) -> f64 {
        self.good as f64 / self.total as f64
    }

    /// Number of qubits that hold neither index nor phase, and are zero before and after each query.
    pub fn work_qubits(&self) -> u32 {
        self.report.qubits - self.report.superposed
    }

    /// The number of times that each outcome was drawn; only those that were.
    pub fn tally(&self) -> BTreeMap<u64, u64> {
        let mut counts = BTreeMap::new();
        for &y in &self.drawn {
            *counts.entry(y).or_insert(0) += 1;
        }
        counts
    }

    /// The value of the pixel's channel, in radiance, from the drawn outcomes.
    pub fn radiance(&self) -> f64 {
        self.scale * self.estimate.amplitude
    }
}

/// The reason why a pixel cannot be simulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// Too many qubits are in superposition.
    #[error(
        "a counting circuit with {path} path bits, {comparator} comparator bits and {phase} phase bits \
         in superposition; at most {most} together are simulated: lower `sampling.path_bits`, \
         `comparator.bits` or `counting.phase_bits`",
        most = MOST_SUPERPOSED
    )]
    TooManySuperposed {
        /// Number of qubits of the path index.
        path: u32,
        /// Number of qubits of the comparator.
        comparator: u32,
        /// Number of qubits of the phase register.
        phase: u32,
    },
    /// Too many iterates of the mean-phase circuit.
    #[error("{0} iterates of the mean-phase circuit; at most {MOST_ITERATES} are simulated")]
    TooManyIterates(u64),
    /// Too many paths for the mean-phase circuit.
    #[error(
        "a mean-phase circuit with {0} path bits and a sign in superposition; at most {MOST_SUPERPOSED} \
         together are simulated: lower `sampling.path_bits`"
    )]
    TooManyPaths(u32),
    /// Too many paths to choose a table of phases by.
    #[error(
        "the slope and the reference are chosen by the paths of the pixel, at most 2^{MOST_SUPERPOSED}, and there \
         are 2^{0}: give both, or lower `sampling.path_bits`"
    )]
    TableOfManyPaths(u32),
    /// Levels of too many bits for a table of phases.
    #[error(
        "phases are looked up by levels of at most {MAX_LEVEL_BITS} bits, and the comparator has {0}: lower \
         `comparator.bits`"
    )]
    LevelBits(u32),
    /// The circuit cannot be made.
    #[error(transparent)]
    Circuit(#[from] QuantumError),
    /// The amplitudes cannot be computed, or an ancilla does not return to zero.
    #[error(transparent)]
    StateVector(#[from] StateVectorError),
    /// The amplitudes or the picture would exceed the memory budget.
    #[error(transparent)]
    WouldNotFit(#[from] MemoryError),
    /// The oracle's program shows a defect.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// There is no such distribution of outcomes.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The drawn outcomes give no estimate.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The simulation was interrupted.
    #[error("interrupted")]
    Interrupted,
}

impl SimulateError {
    /// True if the scene or the options are at fault, false if the work failed.
    pub fn is_refusal(&self) -> bool {
        matches!(
            self,
            Self::Oracle(_)
                | Self::TooManySuperposed { .. }
                | Self::TooManyIterates(_)
                | Self::TooManyPaths(_)
                | Self::TableOfManyPaths(_)
                | Self::LevelBits(_)
                | Self::WouldNotFit(_)
                | Self::StateVector(
                    StateVectorError::TooManyStates { .. }
                        | StateVectorError::TooManyQubits { .. }
                        | StateVectorError::RegisterTooWide { .. }
                        | StateVectorError::Memory { .. }
                )
                | Self::Circuit(_)
                | Self::Counting(_)
                | Self::Estimator(_)
        )
    }
}

/// Runs the complete counting circuit of a pixel as amplitudes.
///
/// ```
/// use qrt_core::inspect::OraclePixel;
/// use qrt_core::oracle::Oracles;
/// use qrt_lab::simulate::{SimulateOptions, simulate};
/// use qrt_scene::front::parse;
///
/// # let text = "
/// # name: lamp
/// # camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
/// # film: { width: 2, height: 2 }
/// # materials: { lamp: { emitter: { radiance: [1, 1, 1] } } }
/// # geometry:
/// #   - quad: { vertices: [[-1, -1, 0], [0.25, -1, 0], [0.25, 1, 0], [-1, 1, 0]], material: lamp }
/// # sampling: { path_bits: 4, depths: [{ bits: [2, 2] }] }
/// # precision: { fraction: 5 }
/// # comparator: { bits: 1 }
/// # counting: { phase_bits: 3 }
/// # ";
/// let scene = parse(text, "lamp.yaml", &[], "".as_ref())?.valid;
/// let pixel = OraclePixel { place: [1, 0], seed: 0 };
/// let simulation = simulate(&Oracles::new(&scene), pixel, &SimulateOptions::default())?;
/// assert_eq!(simulation.outcomes.len(), 5);
/// assert!(simulation.largest_difference() < 1e-12);
/// assert_eq!(simulation.report.queries, 7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// See [`SimulateError`].
///
/// # Panics
/// If the pixel is outside the film.
pub fn simulate(
    oracles: &Oracles<'_>,
    pixel: OraclePixel,
    options: &SimulateOptions<'_>,
) -> Result<Simulation, SimulateError> {
    let ([x, y], film) = (pixel.place, oracles.scene().scene().film);
    assert!(
        x < film.width && y < film.height,
        "there is no pixel {x},{y} on a film of {} x {}",
        film.width,
        film.height
    );
    let counting = Counting::of_scene(oracles.scene(), options)?;
    let (alone, name) = oracle_of(oracles, pixel, options)?;
    counting.simulate(&alone, name, pixel, options, 1)
}

/// The oracles of a pixel alone, and the one that is simulated.
fn oracle_of<'a>(
    oracles: &'a Oracles<'_>,
    pixel: OraclePixel,
    options: &SimulateOptions<'_>,
) -> Result<(Oracles<'a>, OracleName), SimulateError> {
    let alone = oracles.of_pixel(pixel.place);
    let class = alone.classes().class(pixel.place);
    let name = match options.channel {
        Some(channel) => alone.name(channel, class),
        None => alone.most_expensive()?.name,
    };
    Ok((alone, name))
}

/// The counting circuit that is simulated.
#[derive(Clone, Copy)]
struct Counting {
    phase_bits: u32,
    window: Window,
    shots: u32,
}

impl Counting {
    /// The scene's own with the `options`, refused if too many qubits would be in superposition: compiling
    /// may take long.
    fn of_scene(scene: &ValidScene, options: &SimulateOptions<'_>) -> Result<Self, SimulateError> {
        let written = scene.scene();
        let asked = written.counting;
        let phase_bits = options.phase_bits.unwrap_or(asked.phase_bits);
        let (path, comparator) = (written.sampling.path_bits, written.comparator.bits);
        if path.saturating_add(comparator).saturating_add(phase_bits) > MOST_SUPERPOSED {
            return Err(SimulateError::TooManySuperposed {
                path,
                comparator,
                phase: phase_bits,
            });
        }
        Ok(Self {
            phase_bits,
            window: options.window.unwrap_or_else(|| asked.register_window()),
            shots: options.shots.unwrap_or(asked.repetitions),
        })
    }

    /// Simulates one of the oracles of a pixel. `at_a_time` circuits are simulated at the same time.
    fn simulate(
        self,
        alone: &Oracles<'_>,
        name: OracleName,
        pixel: OraclePixel,
        options: &SimulateOptions<'_>,
        at_a_time: usize,
    ) -> Result<Simulation, SimulateError> {
        let Self {
            phase_bits,
            window,
            shots,
        } = self;
        let oracle = alone.channel(name.channel, name.class)?;
        let (path_bits, comparator_bits) = (oracle.points.path_bits(), oracle.comparator_bits());
        let bound = oracle.program_at(pixel.seed, pixel.place);
        let paths = run_paths::on_fixed(&bound, 0..bound.paths())?;
        let good = paths.iter().filter_map(|path| path.first()).sum();
        let total = bound.paths() << comparator_bits;
        let phase = oracle.phase(0, pixel.seed, pixel.place)?;
        let circuit = CountingCircuit::new(&phase, phase_bits, window)?;
        let superposed = path_bits + comparator_bits + phase_bits;
        let memory = options.memory;
        memory.keep_states(circuit.qubits(), superposed, at_a_time)?;
        let cancelled = || options.workers.cancelled();
        let counted = match counting_until(&circuit, &cancelled) {
            Err(StateVectorError::Cancelled) => return Err(SimulateError::Interrupted),
            counted => counted?,
        };
        let theory = PhaseDistribution::new(good, total, phase_bits, window)?;
        let simulated = (0..).zip(&counted.distribution);
        let outcomes: Vec<Outcome> = simulated
            .map(|(y, &simulated)| Outcome {
                y,
                simulated,
                theory: theory.probability(y),
            })
            .collect();
        let drawn = draw(&outcomes, shots, name.channel, pixel);
        let run = WindowedCounting {
            phase_bits,
            repetitions: shots,
            window,
            confidence: DEFAULT_CONFIDENCE,
        };
        let estimate = run.infer(&drawn, total)?;
        Ok(Simulation {
            name,
            pixel,
            path_bits,
            comparator_bits,
            phase_bits,
            window,
            good,
            total,
            scale: oracle.channels[0].scale,
            outcomes,
            report: counted.report,
            drawn,
            estimate,
        })
    }
}

/// Draws outcomes from the simulated probabilities, with the random numbers of the pixel's channel.
fn draw(outcomes: &[Outcome], shots: u32, channel: usize, pixel: OraclePixel) -> Vec<u64> {
    let OraclePixel {
        place: [x, y],
        seed,
    } = pixel;
    let mut stream = Stream::new(seed, x, y, channel as u8);
    let likely = outcomes.iter().filter(|outcome| outcome.simulated > 0.0);
    let mut all = 0.0;
    let ends: Vec<(f64, u64)> = likely
        .map(|outcome| {
            all += outcome.simulated;
            (all, outcome.y)
        })
        .collect();
    let one = |_| {
        let at = stream.uniform() * all;
        let place = ends.partition_point(|(end, _)| *end <= at);
        let last = ends.len().saturating_sub(1);
        ends.get(place.min(last)).map_or(0, |(_, y)| *y)
    };
    (0..shots).map(one).collect()
}

/// A film that was simulated: all channels of all pixels, each by a circuit of its own.
#[derive(Clone, Debug)]
pub struct SimulatedFilm {
    /// The estimates, in linear radiance.
    pub image: Image,
    /// S/N of red, green and blue of each pixel, row by row from the top left.
    pub amplitudes: Vec<[f64; 3]>,
    /// Number of circuits.
    pub circuits: u64,
    /// The most qubits of a circuit.
    pub qubits: u32,
    /// Gates of all circuits together.
    pub gates: u64,
    /// The largest difference between a simulated probability and theory, of all outcomes of all circuits.
    pub largest_difference: f64,
}

/// Runs the complete counting circuits of all channels of all pixels of a film, one circuit each.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_film(
    oracles: &Oracles<'_>,
    seed: u64,
    options: &SimulateOptions<'_>,
) -> Result<SimulatedFilm, SimulateError> {
    let workers = options.workers;
    let film = oracles.scene().scene().film;
    let counting = Counting::of_scene(oracles.scene(), options)?;
    options.memory.keep_picture([film.width, film.height])?;
    let (width, pixels) = (
        u64::from(film.width),
        u64::from(film.width) * u64::from(film.height),
    );
    workers.report(Progress::Started {
        total: pixels,
        resumed: 0,
    });
    let one = |index: u64| {
        if workers.cancelled() {
            return Err(SimulateError::Interrupted);
        }
        let place = [(index % width) as u32, (index / width) as u32];
        let pixel = OraclePixel { place, seed };
        let alone = oracles.of_pixel(place);
        let class = alone.classes().class(place);
        let at_a_time = rayon::current_num_threads();
        let channel = |channel| {
            let name = alone.name(channel, class);
            counting.simulate(&alone, name, pixel, options, at_a_time)
        };
        let [red, green, blue] = [channel(0)?, channel(1)?, channel(2)?];
        workers.report(Progress::Finished(1));
        let all = [red, green, blue];
        let differences = all.iter().map(Simulation::largest_difference);
        Ok(Simulated {
            radiance: all.each_ref().map(Simulation::radiance),
            amplitudes: all.each_ref().map(Simulation::amplitude),
            qubits: all.iter().map(|one| one.report.qubits).max().unwrap_or(0),
            gates: all.iter().map(|one| one.report.gates).sum(),
            largest_difference: differences.fold(0.0, f64::max),
        })
    };
    let all = || {
        (0..pixels)
            .into_par_iter()
            .map(one)
            .collect::<Result<Vec<_>, _>>()
    };
    let simulated: Vec<Simulated> = workers.on_threads(all)??;
    let differences = simulated.iter().map(|one| one.largest_difference);
    Ok(SimulatedFilm {
        image: Image {
            width: film.width,
            height: film.height,
            pixels: simulated.iter().map(|one| one.radiance).collect(),
            window: None,
        },
        amplitudes: simulated.iter().map(|one| one.amplitudes).collect(),
        circuits: 3 * pixels,
        qubits: simulated.iter().map(|one| one.qubits).max().unwrap_or(0),
        gates: simulated.iter().map(|one| one.gates).sum(),
        largest_difference: differences.fold(0.0, f64::max),
    })
}

/// The figures of a pixel of a simulated film.
struct Simulated {
    radiance: [f64; 3],
    amplitudes: [f64; 3],
    qubits: u32,
    gates: u64,
    largest_difference: f64,
}
