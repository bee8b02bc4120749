//! Oracles, run by the fixed machine or by the gates machine on paths of many pixels.
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
mod reading;
mod through_gates;

pub use defect::Defect;
pub use parts::OracleCircuits;
pub(super) use parts::{name, qubits};
pub use primary_hits::{PathRun, PrimaryHits};
pub(super) use through_gates::check;

use qrt_circuit::{Operand, Word};
use qrt_core::oracle::{Channel, LUMINANCE_CHANNEL, Oracle};
use qrt_machines::{InstructionSet, PixelLanes};
use reading::{FixedReading, Reading};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use through_gates::GatesReading;

/// An oracle of all three channels, or of one, on a machine.
pub struct OracleMachine {
    pub(super) oracle: Arc<Oracle>,
    seed: u64,
    primary_hits: Option<Box<dyn PrimaryHits>>,
    /// Operands that are read after each path: the count of each channel, then, if they are wanted,
    /// the colour of each channel, and last the count of the luminance, if the oracle has it.
    outputs: Vec<Operand>,
    reading: Box<dyn Reading>,
}

/// A finished run of paths of one pixel: by channel, and path by path in the order of path indices.
#[derive(Clone, Copy)]
pub struct Finished<'a> {
    /// Position of the pixel in the caller's list.
    pub pixel: usize,
    /// The path index of the first path.
    pub first_id: u64,
    /// By channel: the number of thresholds that each path's colour exceeds, at most `2^c`. Of an
    /// oracle of one channel, all but the first are empty; of an oracle that marks paths, the number
    /// is 1 for each good path.
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
    pub(crate) fn fixed_on(
        instructions: InstructionSet,
        oracle: Arc<Oracle>,
        seed: u64,
        colours: bool,
    ) -> Self {
        let outputs = outputs(&oracle, colours);
        let reading = FixedReading::new(&oracle.program, &output_words(&outputs), instructions);
        Self::with_reading(oracle, seed, outputs, Box::new(reading))
    }

    fn with_reading(
        oracle: Arc<Oracle>,
        seed: u64,
        outputs: Vec<Operand>,
        reading: Box<dyn Reading>,
    ) -> Self {
        Self {
            oracle,
            seed,
            primary_hits: None,
            outputs,
            reading,
        }
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
        let reading = GatesReading::new(parts)?;
        flips::try_all(&oracle, reading.parts())?;
        let outputs = outputs(&oracle, colours);
        Ok(Self::with_reading(oracle, seed, outputs, Box::new(reading)))
    }

    /// Sets the search for primary hits. An oracle needs one if primary hits are its inputs.
    pub(crate) fn with_primary_hits(mut self, primary_hits: Box<dyn PrimaryHits>) -> Self {
        self.primary_hits = Some(primary_hits);
        self
    }

    /// The oracle that the machine runs.
    pub fn oracle(&self) -> &Oracle {
        &self.oracle
    }

    /// The parts of the circuit, if this is the gates machine.
    pub fn parts(&self) -> Option<&OracleCircuits> {
        self.reading.circuits()
    }

    /// Number of paths that run together. A multiple of it leaves no lanes idle.
    pub fn paths_at_once(&self) -> u64 {
        self.reading.paths_at_once() as u64
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
    pub(crate) fn trace_until(
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
        let most = self.reading.block_length();
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
        self.reading.read_words(&self.oracle.program, words);
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
        let spans: Vec<PixelLanes<'_>> = block
            .runs
            .iter()
            .map(|run| PixelLanes {
                lanes: run.paths.count,
                parameters: &parameters[run.pixel],
            })
            .collect();
        self.reading
            .run(&self.oracle, &self.outputs, block, (&spans, cancel))?;
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

/// The registers among `outputs`.
fn output_words(outputs: &[Operand]) -> Vec<Word> {
    outputs
        .iter()
        .filter_map(|output| word_of(*output))
        .collect()
}

fn word_of(operand: Operand) -> Option<Word> {
    match operand {
        Operand::Word(word) => Some(word),
        Operand::Constant(_) => None,
    }
}
