//! Oracles, run by the fixed machine, as native code or by the gates machine on paths of many
//! pixels.
//!
//! Every machine returns, path by path, the number of thresholds that the path's colour exceeds: of
//! a path's `2^c` indices, that many are good.
//!
//! The gates machine runs compute and uncompute once per path, and checks every qubit between
//! paths. The comparator enters the oracle only in the block between the two, and the only other
//! input of that block is the colour. Therefore the machine runs this block separately, for *every*
//! pair of a colour and a comparator. The indices whose phase is flipped follow exactly, `2^c`
//! times cheaper than path by path.

mod bounds;
mod defect;
mod flips;
mod parts;
mod primary_hits;
mod through_gates;

pub use defect::Defect;
pub use parts::OracleCircuits;
pub(super) use parts::{name, qubits};
pub use primary_hits::{PathRun, PrimaryHits};
pub(super) use through_gates::check;

use super::native;
use super::native::NativeOracle;
use super::pool::Pool;
use crate::memory::{QUBITS_OF_ONE_TURN, bytes_of_rows, bytes_of_templates};
use qrt_circuit::lower::Templates;
use qrt_circuit::{Operand, Word};
use qrt_core::oracle::{Channel, LUMINANCE_CHANNEL, Oracle};
use qrt_machines::Fixed;
use qrt_machines::InstructionSet;
use qrt_machines::Span;
use qrt_machines::{Gates, Rows, Template};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, PoisonError};

/// An oracle of all three channels, or of one, on a machine.
pub struct OracleMachine {
    oracle: Arc<Oracle>,
    seed: u64,
    primary_hits: Option<Box<dyn PrimaryHits>>,
    /// Operands that are read after each path: the count of each channel, then, if they are wanted,
    /// the colour of each channel, and last the count of the luminance, if the oracle has it.
    outputs: Vec<Operand>,
    machine: Machine,
}

enum Machine {
    Fixed {
        fixed: Box<Fixed>,
        lanes: Pool<qrt_machines::Lanes>,
    },
    Native {
        run: fn(InstructionSet, &[native::Run<'_>], &mut [Vec<i64>]),
        instructions: InstructionSet,
    },
    Gates {
        gates: Box<Gates>,
        /// `at_once` rows for a block of paths, and at most `room` bytes of templates for
        /// operations whose gates are not held in memory.
        rows: Pool<(Vec<Rows>, Templates<Template>)>,
        at_once: usize,
        room: usize,
        parts: Box<OracleCircuits>,
    },
}

/// A finished run of paths of one pixel: by channel, and path by path in the order of path indices.
pub struct Finished<'a> {
    /// Position of the pixel in the caller's list.
    pub pixel: usize,
    /// The path index of the first path.
    pub first_id: u64,
    /// By channel: the number of thresholds that each path's colour exceeds, at most `2^c`. Of an
    /// oracle of one channel, all but the first are empty; for a predicate's oracle, the number is
    /// 1 for each good path.
    pub good: [&'a [i64]; 3],
    /// The same for the luminance; empty unless the oracle has it.
    pub luminance: &'a [i64],
    /// By channel: each path's colour, in units of `2^-fraction` of the channel's scale. Empty
    /// unless the machine was created with colours.
    pub colours: [&'a [i64]; 3],
    /// Queries that finding the paths' primary hits took; 0 unless an oracle finds them.
    pub queries: u64,
}

impl OracleMachine {
    /// Creates a fixed machine. `colours` is true if colours are wanted beside the counts.
    pub fn fixed(oracle: Arc<Oracle>, seed: u64, colours: bool) -> Self {
        Self::fixed_on(InstructionSet::widest(), oracle, seed, colours)
    }

    /// Creates a fixed machine that uses the instruction set `instructions`.
    pub fn fixed_on(
        instructions: InstructionSet,
        oracle: Arc<Oracle>,
        seed: u64,
        colours: bool,
    ) -> Self {
        let outputs = outputs(&oracle, colours);
        let words: Vec<Word> = outputs.iter().filter_map(|o| word_of(*o)).collect();
        let fixed = Fixed::new(&oracle.program, &words).with_instructions(instructions);
        let machine = Machine::Fixed {
            fixed: Box::new(fixed),
            lanes: Pool::new(),
        };
        Self::from_machine(oracle, seed, outputs, machine)
    }

    fn from_machine(
        oracle: Arc<Oracle>,
        seed: u64,
        outputs: Vec<Operand>,
        machine: Machine,
    ) -> Self {
        Self {
            oracle,
            seed,
            primary_hits: None,
            outputs,
            machine,
        }
    }

    /// Creates a native machine, which runs the oracle's program as native code `C` and gives the
    /// same bits as the fixed machine. The result is the fixed machine itself if there is no code
    /// ([`NativeOracle::WRITTEN`]). It is also the fixed machine on NEON, for which the fixed
    /// machine has vectors and the code has none (it has vectors for AVX-512 and AVX2).
    pub fn native<C: NativeOracle>(oracle: Arc<Oracle>, seed: u64, colours: bool) -> Self {
        let widest = InstructionSet::widest();
        if !C::WRITTEN || widest == InstructionSet::Neon {
            Self::fixed(oracle, seed, colours)
        } else {
            Self::native_on::<C>(widest, oracle, seed, colours)
        }
    }

    /// Creates a native machine that uses the instruction set `instructions`. There is code for
    /// AVX-512, for AVX2, and for one path at a time; all other instruction sets use the last.
    ///
    /// # Panics
    /// If there is no code, when the machine runs: see [`NativeOracle::WRITTEN`].
    pub fn native_on<C: NativeOracle>(
        instructions: InstructionSet,
        oracle: Arc<Oracle>,
        seed: u64,
        colours: bool,
    ) -> Self {
        let outputs = outputs(&oracle, colours);
        let machine = Machine::Native {
            run: native::compute_runs::<C>,
            instructions,
        };
        Self::from_machine(oracle, seed, outputs, machine)
    }

    /// Creates a gates machine, and tests the block between compute and uncompute for every colour
    /// and comparator.
    ///
    /// # Errors
    /// If that block is wrong.
    pub fn gates(oracle: Arc<Oracle>, seed: u64, colours: bool) -> Result<Self, Defect> {
        let parts = OracleCircuits::new(&oracle);
        Self::of_parts(oracle, parts, seed, colours)
    }

    /// Creates a gates machine from given circuits, for example from circuits with a deliberate
    /// error.
    ///
    /// # Errors
    /// As [`OracleMachine::gates`].
    pub fn of_parts(
        oracle: Arc<Oracle>,
        parts: OracleCircuits,
        seed: u64,
        colours: bool,
    ) -> Result<Self, Defect> {
        let mut circuits = vec![&parts.compute];
        circuits.extend(&parts.flips);
        circuits.push(&parts.uncompute);
        let mut gates = Box::new(Gates::new(&circuits)?);
        let (mut at_once, mut room) = (1, 0);
        if parts.streamed.is_some() {
            let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
            let bytes = bytes_of_rows(threads, parts.compute.qubits);
            *gates = gates.for_many_rows(bytes);
            at_once = gates.rows_at_once(bytes);
            room = bytes_of_templates(threads, parts.compute.qubits);
        }
        flips::try_all(&oracle, &parts)?;
        let outputs = outputs(&oracle, colours);
        let machine = Machine::Gates {
            gates,
            rows: Pool::new(),
            at_once,
            room,
            parts: Box::new(parts),
        };
        Ok(Self::from_machine(oracle, seed, outputs, machine))
    }

    /// Sets the search for primary hits. An oracle needs one if primary hits are its inputs.
    pub fn with_primary_hits(mut self, primary_hits: Box<dyn PrimaryHits>) -> Self {
        self.primary_hits = Some(primary_hits);
        self
    }

    /// The oracle that the machine runs.
    pub fn oracle(&self) -> &Oracle {
        &self.oracle
    }

    /// The parts of the circuit, if this is the gates machine.
    pub fn parts(&self) -> Option<&OracleCircuits> {
        match &self.machine {
            Machine::Gates { parts, .. } => Some(parts),
            Machine::Fixed { .. } | Machine::Native { .. } => None,
        }
    }

    /// Number of paths that run together. A multiple of it leaves no lanes idle.
    pub fn paths_at_once(&self) -> u64 {
        match &self.machine {
            Machine::Gates { gates, at_once, .. } => (at_once * gates.lanes()) as u64,
            Machine::Fixed { .. } | Machine::Native { .. } => Gates::LANES as u64,
        }
    }

    /// R, the paths of a pixel.
    pub fn paths(&self) -> u64 {
        1 << self.oracle.points.path_bits()
    }

    /// Runs the paths `ids` of every pixel (column, row), and passes the results to `finished` in
    /// the order of pixels and path indices.
    ///
    /// # Errors
    /// The first defect found.
    pub fn trace(
        &self,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        finished: impl FnMut(Finished<'_>),
    ) -> Result<(), Defect> {
        self.trace_until(None, pixels, ids, finished)
    }

    /// As [`OracleMachine::trace`], but stops when any thread sets `cancel`: on a circuit of very
    /// many gates, the paths that run together may take a minute.
    ///
    /// # Errors
    /// The first defect found; [`Defect::Cancelled`].
    pub fn trace_until(
        &self,
        cancel: Option<&AtomicBool>,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        mut finished: impl FnMut(Finished<'_>),
    ) -> Result<(), Defect> {
        let parameters: Vec<Vec<u64>> = pixels
            .iter()
            .map(|&pixel| self.parameter_words(pixel))
            .collect();
        let most = match &self.machine {
            Machine::Fixed { .. } | Machine::Native { .. } => Fixed::LANES,
            Machine::Gates { gates, at_once, .. } => at_once * gates.lanes(),
        };
        let mut block = OracleBlock {
            ids: Vec::with_capacity(most),
            runs: Vec::new(),
            hits: Vec::new(),
            queries: Vec::new(),
            values: vec![vec![0; most]; self.outputs.len()],
        };
        for (pixel, &place) in pixels.iter().enumerate() {
            let mut first = ids.start;
            while first < ids.end {
                let count = (ids.end - first).min((most - block.ids.len()) as u64);
                block.runs.push(PixelRun {
                    pixel,
                    paths: PathRun {
                        pixel: place,
                        first,
                        count: count as usize,
                    },
                });
                block.ids.extend(first..first + count);
                first += count;
                let last = pixel + 1 == pixels.len() && first == ids.end;
                if block.ids.len() == most || last {
                    self.run_block(cancel, &mut block, &parameters)?;
                    self.hand_over(&block, &mut finished);
                    block.ids.clear();
                    block.runs.clear();
                }
            }
        }
        Ok(())
    }

    /// Runs compute on one path, and returns the numbers that `words` read from its registers. The
    /// machine cannot return counts afterwards, so the call consumes it.
    ///
    /// # Errors
    /// The first defect found.
    pub(crate) fn read(
        mut self,
        words: &[Word],
        pixel: [u32; 2],
        id: u64,
    ) -> Result<Vec<i64>, Defect> {
        self.outputs = words.iter().copied().map(Operand::Word).collect();
        if let Machine::Fixed { fixed, lanes } = &mut self.machine {
            **fixed = Fixed::new(&self.oracle.program, words);
            *lanes = Pool::new();
        }
        let paths = PathRun {
            pixel,
            first: id,
            count: 1,
        };
        let mut block = OracleBlock {
            ids: vec![id],
            runs: vec![PixelRun { pixel: 0, paths }],
            hits: Vec::new(),
            queries: Vec::new(),
            values: vec![vec![0]; words.len()],
        };
        self.run_block(None, &mut block, &[self.parameter_words(pixel)])?;
        Ok(block.values.iter().map(|values| values[0]).collect())
    }

    /// The classical parameters of a pixel.
    fn parameter_words(&self, pixel: [u32; 2]) -> Vec<u64> {
        self.oracle.parameter_words(self.seed, pixel)
    }

    /// Position of the luminance's count among the outputs.
    fn luminance(&self) -> Option<usize> {
        let channels = &self.oracle.channels;
        let there = channels.iter().any(|c| c.number == LUMINANCE_CHANNEL);
        there.then(|| self.outputs.len() - 1)
    }

    /// Number of outputs that are counts of channels other than the luminance. They are the first
    /// outputs.
    fn counts(&self) -> usize {
        self.oracle.channels.len() - usize::from(self.luminance().is_some())
    }

    fn hand_over(&self, block: &OracleBlock, finished: &mut impl FnMut(Finished<'_>)) {
        let luminance = self.luminance();
        let colours = self.outputs.len() - usize::from(luminance.is_some()) > self.counts();
        let mut start = 0;
        for (run, &queries) in block.runs.iter().zip(&block.queries) {
            let range = start..start + run.paths.count;
            let column = |k: usize| &block.values[k][range.clone()];
            let count = |k: usize| if k < self.counts() { column(k) } else { &[] };
            let colour = |k: usize| if colours { column(k) } else { &[] };
            finished(Finished {
                pixel: run.pixel,
                first_id: run.paths.first,
                queries,
                good: [count(0), count(1), count(2)],
                luminance: luminance.map_or(&[], column),
                colours: [colour(3), colour(4), colour(5)],
            });
            start = range.end;
        }
    }

    fn run_block(
        &self,
        cancel: Option<&AtomicBool>,
        block: &mut OracleBlock,
        parameters: &[Vec<u64>],
    ) -> Result<(), Defect> {
        self.find_primary_hits(block)?;
        let spans: Vec<Span<'_>> = block
            .runs
            .iter()
            .map(|run| Span {
                lanes: run.paths.count,
                parameters: &parameters[run.pixel],
            })
            .collect();
        match &self.machine {
            Machine::Fixed { fixed, lanes } => {
                lanes.lend(
                    || fixed.lanes(),
                    |own| {
                        self.run_fixed(fixed, own, block, &spans);
                        Ok::<(), Defect>(())
                    },
                )?;
            }
            Machine::Native { run, instructions } => {
                let runs = block.runs.iter().map(|run| native::Run {
                    first: run.paths.first,
                    count: run.paths.count,
                    parameters: &parameters[run.pixel],
                });
                let runs: Vec<_> = runs.collect();
                run(*instructions, &runs, &mut block.values);
            }
            Machine::Gates {
                gates,
                rows,
                at_once,
                room,
                parts,
            } => {
                let large = parts.streamed.as_ref();
                let large = large.filter(|_| parts.compute.qubits > QUBITS_OF_ONE_TURN);
                let turn = large.map(|streamed| &streamed.turn);
                let _turn = turn.map(|turn| turn.lock().unwrap_or_else(PoisonError::into_inner));
                rows.lend(
                    || {
                        let rows = (0..*at_once).map(|_| gates.rows()).collect();
                        (rows, Templates::with_room(*room))
                    },
                    |own| self.run_gates(gates, parts, own, block, (&spans, cancel)),
                )?;
            }
        }
        self.complete(block)
    }

    /// Finds the paths' primary hits, if these are inputs of the oracle.
    fn find_primary_hits(&self, block: &mut OracleBlock) -> Result<(), Defect> {
        block.queries.clear();
        block.queries.resize(block.runs.len(), 0);
        if self.oracle.nearest.is_none() {
            return Ok(());
        }
        let runs: Vec<PathRun> = block.runs.iter().map(|run| run.paths).collect();
        let primary_hits = self.primary_hits.as_ref().ok_or(Defect::PrimaryHits)?;
        block.hits.resize(block.ids.len(), 0);
        primary_hits.find(&runs, &mut block.hits, &mut block.queries)
    }

    fn run_fixed(
        &self,
        fixed: &Fixed,
        lanes: &mut qrt_machines::Lanes,
        block: &mut OracleBlock,
        spans: &[Span<'_>],
    ) {
        let count = block.ids.len();
        let zeros = vec![0; count];
        let wanted = self.outputs.iter().zip(&mut block.values);
        let wanted = wanted.filter(|(output, _)| word_of(**output).is_some());
        let mut wanted: Vec<&mut [i64]> = wanted.map(|(_, values)| &mut values[..count]).collect();
        let inputs = [&block.ids, &zeros, &block.hits].map(Vec::as_slice);
        let inputs = &inputs[..2 + usize::from(self.oracle.nearest.is_some())];
        fixed.run(lanes, inputs, spans, &mut wanted);
    }

    /// Fills in the outputs that are constant, and clamps counts to the number of comparator
    /// values.
    ///
    /// # Errors
    /// [`Defect::OutOfBounds`], of the first path whose colour exceeds its bound by more than
    /// rounding.
    fn complete(&self, block: &mut OracleBlock) -> Result<(), Defect> {
        let count = block.ids.len();
        for (output, values) in self.outputs.iter().zip(&mut block.values) {
            if let Operand::Constant(value) = output {
                values[..count].fill(*value);
            }
        }
        let bits = self.oracle.comparator_bits();
        let most = 1 << bits;
        let slack = bounds::slack(bits, self.oracle.fraction);
        let counts = (0..self.counts()).chain(self.luminance());
        for (place, column) in counts.enumerate() {
            let values = &block.values[column][..count];
            // No early exit, so that the compiler can vectorize the loop.
            let outside = |value: i64| value < -slack || value > most + slack;
            if values
                .iter()
                .fold(false, |any, &value| any | outside(value))
            {
                let lane = values.iter().position(|&value| outside(value));
                let lane = lane.unwrap_or_default();
                return Err(Defect::OutOfBounds {
                    pixel: block.pixel_of(lane),
                    id: block.ids[lane],
                    channel: self.oracle.channels[place].number,
                    count: values[lane],
                    most,
                });
            }
            for value in &mut block.values[column][..count] {
                *value = (*value).clamp(0, most);
            }
        }
        Ok(())
    }
}

/// Paths that a thread runs together, and their outputs.
struct OracleBlock {
    ids: Vec<u64>,
    runs: Vec<PixelRun>,
    /// Primary hits by path, if they are inputs of the oracle.
    hits: Vec<u64>,
    /// Queries by run: those that finding its primary hits took.
    queries: Vec<u64>,
    values: Vec<Vec<i64>>,
}

impl OracleBlock {
    /// Column and row of the pixel whose path is in `lane`.
    fn pixel_of(&self, lane: usize) -> [u32; 2] {
        let mut end = 0;
        let mut runs = self.runs.iter();
        let run = runs.find(|run| {
            end += run.paths.count;
            lane < end
        });
        run.map_or([0, 0], |run| run.paths.pixel)
    }
}

struct PixelRun {
    /// Position of the pixel in the caller's list.
    pixel: usize,
    paths: PathRun,
}

fn outputs(oracle: &Oracle, colours: bool) -> Vec<Operand> {
    let (luminance, rgb): (Vec<&Channel>, Vec<&Channel>) =
        (oracle.channels.iter()).partition(|channel| channel.number == LUMINANCE_CHANNEL);
    let counts = rgb.iter().map(|channel| channel.count);
    let wanted = if colours { 3 } else { 0 };
    let colours = rgb.iter().map(|channel| channel.colour).take(wanted);
    let luminance = luminance.iter().map(|channel| channel.count);
    counts.chain(colours).chain(luminance).collect()
}

fn word_of(operand: Operand) -> Option<Word> {
    match operand {
        Operand::Word(word) => Some(word),
        Operand::Constant(_) => None,
    }
}
