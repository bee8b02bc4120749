//! A pixel's mean-phase circuit, run as amplitudes.

use super::{MOST_SUPERPOSED, SimulateError, SimulateOptions};
use qrt_circuit::quantum::{LevelPhases, MAX_LEVEL_BITS, MeanPhaseCircuit, QuantumError, Turns};
use qrt_core::inspect::OraclePixel;
use qrt_core::oracle::{Oracle, OracleName, Oracles};
use qrt_counting::{Histogram, mean_phase_probabilities};
use qrt_machines::statevector::{Sparse, StateVector, StateVectorError};
use qrt_runtime::path_machines::run_paths;
use qrt_runtime::workers::Workers;
use std::f64::consts::TAU;

/// The slope of a table, in units of the inverse standard deviation: the estimators' own.
const SLOPE: f64 = 0.6;
/// The reference of a table, in standard deviations below the mean.
const BELOW: f64 = 0.5;
/// Bits of a phase beyond those of the number of iterates.
const FINER: u32 = 10;
/// Number of paths that are traced between two looks at the cancel flag.
const AT_A_TIME: usize = 1 << 14;
/// The largest probability that an ancilla is read as 1, from rounding.
const CLEAN: f64 = 1e-20;

/// The table and the number of iterates of a mean-phase circuit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanPhase {
    /// Number of iterates: for a simulation at most [`MOST_ITERATES`].
    pub iterates: u64,
    /// alpha, by which a colour's distance from the reference becomes half a phase's tangent; colours
    /// are over the channel's scale. Without it, 0.6 over the standard deviation of the pixel's paths.
    pub slope: Option<f64>,
    /// The colour of phase 0, in `0 ..= 1` of the scale. Without it, half a standard deviation below
    /// the mean.
    pub reference: Option<f64>,
}

impl MeanPhase {
    /// Returns the table of phases of a pixel's circuit. Traces the pixel's paths on integers if the slope or the
    /// reference is theirs.
    ///
    /// # Errors
    /// [`SimulateError::LevelBits`]; [`SimulateError::Circuit`] if slope or reference are out of range, or if
    /// phases have too many bits; [`SimulateError::TableOfManyPaths`]; [`SimulateError::Interrupted`].
    pub fn table(
        &self,
        oracle: &Oracle,
        pixel: OraclePixel,
        workers: &Workers<'_>,
    ) -> Result<LevelPhases, SimulateError> {
        let bits = oracle.comparator_bits();
        let known = self.known(bits)?;
        if self.slope.is_some() && self.reference.is_some() {
            return Ok(known);
        }
        let path_bits = oracle.points.path_bits();
        if path_bits > MOST_SUPERPOSED {
            return Err(SimulateError::TableOfManyPaths(path_bits));
        }
        let mut histogram = Histogram::new(bits);
        trace(oracle, pixel, workers, |levels| histogram.add_all(levels))?;
        let levels: Vec<_> = histogram.levels().collect();
        Ok(self.for_levels(&levels, bits)?)
    }

    /// The angle at which the sign qubit is measured: a quarter turn, at which a small phase changes its outcome
    /// most.
    pub fn basis(&self) -> Turns {
        Turns::new(1, 2)
    }

    /// The table of the slope and the reference that are given, to refuse those out of range before paths are
    /// traced.
    fn known(&self, bits: u32) -> Result<LevelPhases, SimulateError> {
        if bits > MAX_LEVEL_BITS {
            return Err(SimulateError::LevelBits(bits));
        }
        let given = (self.slope.unwrap_or(1.0), self.reference.unwrap_or(0.0));
        Ok(self.phases(given, bits)?)
    }

    fn phases(
        &self,
        (slope, reference): (f64, f64),
        bits: u32,
    ) -> Result<LevelPhases, QuantumError> {
        let phase_bits = self.iterates.max(1).ilog2() + FINER;
        LevelPhases::new(slope, reference, bits, phase_bits)
    }

    /// The table for paths of these levels, with the number of paths of each.
    fn for_levels(&self, levels: &[(u64, u64)], bits: u32) -> Result<LevelPhases, QuantumError> {
        let (mean, deviation) = moments(levels, bits);
        let own = if deviation > 0.0 {
            SLOPE / deviation
        } else {
            1.0
        };
        let below = (mean - BELOW * deviation).max(0.0);
        let slope = self.slope.unwrap_or(own);
        self.phases((slope, self.reference.unwrap_or(below)), bits)
    }
}

/// The largest number of iterates that is simulated.
pub const MOST_ITERATES: u64 = 1 << 16;

/// Paths of one level, and the probabilities to measure one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelOutcome {
    /// The level: the number of thresholds that the colour exceeds.
    pub level: u64,
    /// Number of paths of this level.
    pub paths: u64,
    /// The probabilities to measure one of them with the sign qubit 0, and 1, by the amplitudes.
    pub simulated: [f64; 2],
    /// The same by theory, from the levels alone.
    pub theory: [f64; 2],
}

/// The result of a pixel's simulated mean-phase circuit.
#[derive(Clone, Debug)]
pub struct MeanPhaseSimulation {
    /// Channel and class of pixels of the oracle.
    pub name: OracleName,
    /// The pixel and the seed.
    pub pixel: OraclePixel,
    /// Number of qubits of the path index.
    pub path_bits: u32,
    /// The table of phases.
    pub phases: LevelPhases,
    /// Number of iterates.
    pub iterates: u64,
    /// The angle at which the sign qubit is measured.
    pub basis: Turns,
    /// The mean of the paths' colours over the scale.
    pub mean: f64,
    /// The standard deviation of the paths' colours over the scale.
    pub deviation: f64,
    /// All levels of the pixel's paths, in ascending order.
    pub levels: Vec<LevelOutcome>,
    /// Number of qubits.
    pub qubits: u32,
    /// Number of gates.
    pub gates: u64,
    /// Number of calls of the oracle.
    pub queries: u64,
}

impl MeanPhaseSimulation {
    /// The largest difference between a simulated probability and theory.
    pub fn largest_difference(&self) -> f64 {
        let difference = |level: &LevelOutcome| {
            let [zero, one] = [0, 1].map(|bit| level.simulated[bit] - level.theory[bit]);
            zero.abs().max(one.abs())
        };
        self.levels.iter().map(difference).fold(0.0, f64::max)
    }

    /// The probability that the sign qubit reads 0: simulated, and by theory.
    pub fn zero(&self) -> [f64; 2] {
        let sum = |of: fn(&LevelOutcome) -> f64| self.levels.iter().map(of).sum();
        [
            sum(|level| level.simulated[0]),
            sum(|level| level.theory[0]),
        ]
    }
}

/// Runs the mean-phase circuit of a pixel as amplitudes, with all ancillas.
///
/// The sign qubit is measured at the angle of [`MeanPhase::basis`].
///
/// # Errors
/// See [`SimulateError`]; [`SimulateError::Circuit`] if slope or reference are out of range, or if the
/// levels have too many bits for a table.
///
/// # Panics
/// If the pixel is outside the film.
pub fn simulate_mean_phase(
    oracles: &Oracles<'_>,
    pixel: OraclePixel,
    options: &SimulateOptions<'_>,
    asked: &MeanPhase,
) -> Result<MeanPhaseSimulation, SimulateError> {
    let ([x, y], film) = (pixel.place, oracles.scene().scene().film);
    assert!(x < film.width && y < film.height, "no pixel {x},{y}");
    if asked.iterates > MOST_ITERATES {
        return Err(SimulateError::TooManyIterates(asked.iterates));
    }
    // Refuse before compiling, which may take long.
    let written = oracles.scene().scene();
    let (path_bits, bits) = (written.sampling.path_bits, written.comparator.bits);
    if path_bits + 1 > MOST_SUPERPOSED {
        return Err(SimulateError::TooManyPaths(path_bits));
    }
    let phase_bits = asked.known(bits)?.bits();
    let (alone, name) = super::oracle_of(oracles, pixel, options)?;
    let oracle = alone.channel(name.channel, name.class)?;
    // Levels and outcomes of all paths take at most as much as the amplitudes.
    let qubits = oracle.qubits() + phase_bits;
    options.memory.keep_states(qubits, path_bits + 2, 1)?;
    let mut levels: Vec<u64> = Vec::new();
    trace(&oracle, pixel, &options.workers, |some| levels.extend(some))?;
    let mut histogram = Histogram::new(bits);
    histogram.add_all(levels.iter().copied());
    let all: Vec<(u64, u64)> = histogram.levels().collect();
    let (mean, deviation) = moments(&all, bits);
    let phases = asked.for_levels(&all, bits)?;
    let basis = asked.basis();
    let made = oracle.level_phases(0, pixel.seed, pixel.place, &phases)?;
    let circuit = MeanPhaseCircuit::new(&made, phases, asked.iterates, basis)?;
    let mut machine = Sparse::new(circuit.qubits());
    let mut gates = 0_u64;
    circuit.apply(&mut |gate| {
        gates += 1;
        if gates.is_multiple_of(1 << 6) && options.workers.cancelled() {
            return Err(SimulateError::Interrupted);
        }
        machine.gate(gate).map_err(SimulateError::from)
    })?;
    let ancillas = circuit.ancillas();
    let probability = machine.excited(&ancillas)?;
    if probability > CLEAN {
        let qubit = ancillas.first().copied().unwrap_or_default();
        return Err(StateVectorError::Dirty { qubit, probability }.into());
    }
    let mut register = circuit.oracle().superposed().to_vec();
    register.push(circuit.sign());
    let found = machine.distribution(&register)?;
    let theory = mean_phase_probabilities(&all, phases, asked.iterates, basis.as_f64() * TAU);
    let mut outcomes: Vec<LevelOutcome> = (all.iter().zip(theory))
        .map(|(&(level, paths), theory)| LevelOutcome {
            level,
            paths,
            simulated: [0.0; 2],
            theory,
        })
        .collect();
    for (path, level) in levels.iter().enumerate() {
        if let Ok(place) = all.binary_search_by_key(level, |(level, _)| *level) {
            for bit in [0, 1] {
                outcomes[place].simulated[bit] += found[path + bit * levels.len()];
            }
        }
    }
    Ok(MeanPhaseSimulation {
        name,
        pixel,
        path_bits,
        phases,
        iterates: asked.iterates,
        basis,
        mean,
        deviation,
        levels: outcomes,
        qubits: circuit.qubits(),
        gates,
        queries: circuit.queries(),
    })
}

/// Traces a pixel's paths on integers, and calls `each` with the levels of a few thousand at a time, in the order of
/// path indices.
fn trace(
    oracle: &Oracle,
    pixel: OraclePixel,
    workers: &Workers<'_>,
    mut each: impl FnMut(&mut dyn Iterator<Item = u64>),
) -> Result<(), SimulateError> {
    let bound = oracle.program_at(pixel.seed, pixel.place);
    for first in (0..bound.paths()).step_by(AT_A_TIME) {
        if workers.cancelled() {
            return Err(SimulateError::Interrupted);
        }
        let end = bound.paths().min(first + AT_A_TIME as u64);
        let paths = run_paths::on_fixed(&bound, first..end)?;
        each(&mut paths.iter().filter_map(|path| path.first().copied()));
    }
    Ok(())
}

/// Mean and standard deviation of levels over `2^bits`.
fn moments(levels: &[(u64, u64)], bits: u32) -> (f64, f64) {
    let scale = (1_u64 << bits) as f64;
    let total: u64 = levels.iter().map(|(_, paths)| paths).sum();
    let of = |value: &dyn Fn(f64) -> f64| {
        let terms =
            (levels.iter()).map(|&(level, paths)| value(level as f64 / scale) * paths as f64);
        terms.sum::<f64>() / total as f64
    };
    let mean = of(&|colour| colour);
    (mean, of(&|colour| (colour - mean) * (colour - mean)).sqrt())
}
