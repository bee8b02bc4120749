//! Oracles, run by the fixed machine or by the gates machine on paths of many pixels.
//!
//! Both hand over, path by path, how many thresholds the path's colour exceeds: of a path's `2^c`
//! ids, that many are good.
//!
//! The gates machine runs compute and uncompute once per path, and looks at every qubit between
//! paths. The comparator enters the oracle only in the block between the two, which reads nothing
//! else but the colour. So this block is run apart, for *every* pair of a colour and a comparator:
//! which ids have their sign turned follows exactly, `2^c` times cheaper than path by path.

mod flips;

use super::fixed::{self, Fixed};
use super::gates::{Dirty, Gates, InvalidGate, Rows};
use super::span::Span;
use qrt_core::circuit::{Circuit, Instruction, Operand, Qubit, RegisterId, Word, lower};
use qrt_core::oracle::Oracle;
use std::fmt;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// A circuit that does not do what an oracle must: a defect of qrt, found while it ran.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Defect {
    /// The list of gates is not a circuit.
    Gate(InvalidGate),
    /// A qubit that was not returned to zero.
    Dirty {
        /// Which, and in which lane.
        dirty: Dirty,
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path.
        id: u64,
        /// What the qubit was last used for.
        register: String,
    },
    /// A path whose id was changed.
    Id {
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path.
        id: u64,
    },
    /// A sign that was turned, or not, against the comparison.
    Flip {
        /// 0 red, 1 green, 2 blue.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator.
        comparator: u64,
    },
    /// A comparison that changes what it compares.
    Compared {
        /// 0 red, 1 green, 2 blue.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator.
        comparator: u64,
    },
    /// A comparison that touches a qubit which holds something else.
    Foreign {
        /// 0 red, 1 green, 2 blue.
        channel: usize,
        /// The qubit.
        qubit: Qubit,
        /// What it holds.
        register: String,
    },
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gate(gate) => gate.fmt(f),
            Self::Dirty {
                dirty,
                pixel: [x, y],
                id,
                register,
            } => write!(
                f,
                "qubit {} (`{register}`) is not returned to zero on path {id} of pixel ({x}, {y})",
                dirty.qubit
            ),
            Self::Id { pixel: [x, y], id } => {
                write!(f, "the id of path {id} of pixel ({x}, {y}) is changed")
            }
            Self::Flip {
                channel,
                count,
                comparator,
            } => write!(
                f,
                "channel {channel}: the phase of comparator {comparator} is wrong for a colour \
                 above {count} thresholds"
            ),
            Self::Compared {
                channel,
                count,
                comparator,
            } => write!(
                f,
                "channel {channel}: comparing comparator {comparator} with a colour above {count} \
                 thresholds changes one of them"
            ),
            Self::Foreign {
                channel,
                qubit,
                register,
            } => write!(
                f,
                "channel {channel}: the comparison touches qubit {qubit}, which holds `{register}`"
            ),
        }
    }
}

impl std::error::Error for Defect {}

impl From<InvalidGate> for Defect {
    fn from(gate: InvalidGate) -> Self {
        Self::Gate(gate)
    }
}

/// An oracle of all three channels on a machine.
pub struct OracleMachine {
    oracle: Arc<Oracle>,
    seed: u64,
    /// What is read of every path: by channel the count, then by channel the colour.
    outputs: Vec<Operand>,
    machine: Machine,
}

enum Machine {
    Fixed {
        fixed: Box<Fixed>,
        lanes: Mutex<Vec<fixed::Lanes>>,
    },
    Gates {
        gates: Box<Gates>,
        rows: Mutex<Vec<Rows>>,
        parts: Box<Parts>,
    },
}

/// The parts of an oracle's circuit, which share their qubits.
#[derive(Clone, Debug)]
pub struct Parts {
    /// From ids to colours.
    pub compute: Circuit,
    /// By channel: compare, flip, undo the comparison.
    pub flips: Vec<Circuit>,
    /// From colours back to ids alone.
    pub uncompute: Circuit,
}

impl Parts {
    /// Lowers an oracle to gates: compute, all channels' flips one after another, uncompute.
    pub fn new(oracle: &Oracle) -> Self {
        let mut whole = oracle.program.clone();
        let undo = whole.inverse().instructions;
        let mut cuts = vec![whole.instructions.len()];
        for channel in 0..oracle.channels.len() {
            let flip = oracle.flip(channel);
            let (own, base) = (oracle.program.ops.len(), whole.ops.len());
            whole.blocks = flip.blocks;
            whole.ops.extend_from_slice(&flip.ops[own..]);
            whole
                .instructions
                .extend(flip.instructions.into_iter().map(|step| Instruction {
                    op: step.op - own as u32 + base as u32,
                    ..step
                }));
            cuts.push(whole.instructions.len());
        }
        whole.instructions.extend(undo);
        let mut parts = lower::parts(&whole, &cuts).into_iter();
        let compute = parts.next().unwrap_or_default();
        let uncompute = parts.next_back().unwrap_or_default();
        Self {
            compute,
            flips: parts.collect(),
            uncompute,
        }
    }

    /// Gates of all parts.
    pub fn gates(&self) -> usize {
        let flips = self.flips.iter().map(|flip| flip.gates.len());
        self.compute.gates.len() + flips.sum::<usize>() + self.uncompute.gates.len()
    }

    /// The qubits of an operand after compute, its lowest bit first; none for a constant.
    fn qubits(&self, operand: Operand) -> Vec<Qubit> {
        match operand {
            Operand::Constant(_) => Vec::new(),
            Operand::Word(word) => {
                let all = self.register(word.register);
                let range = word.offset as usize..(word.offset + word.width) as usize;
                all.get(range).map(<[Qubit]>::to_vec).unwrap_or_default()
            }
        }
    }

    fn register(&self, register: RegisterId) -> &[Qubit] {
        let mut held = self.compute.outputs.iter();
        held.find(|(id, _)| *id == register)
            .map_or(&[], |(_, qubits)| qubits)
    }
}

/// A run of paths of one pixel, finished: by channel, and path by path in the order of ids.
pub struct Finished<'a> {
    /// The pixel's place in the list that was given.
    pub pixel: usize,
    /// The first path.
    pub first_id: u64,
    /// By channel: how many thresholds each path's colour exceeds, at most `2^c`.
    pub good: [&'a [i64]; 3],
    /// By channel: each path's colour, in units of `2^-fraction` of the channel's scale. Empty
    /// unless asked for.
    pub colours: [&'a [i64]; 3],
}

impl OracleMachine {
    /// The fixed machine. `colours` says whether they are wanted beside the counts.
    pub fn fixed(oracle: Arc<Oracle>, seed: u64, colours: bool) -> Self {
        let outputs = outputs(&oracle, colours);
        let words: Vec<Word> = outputs.iter().filter_map(|o| word_of(*o)).collect();
        let machine = Machine::Fixed {
            fixed: Box::new(Fixed::new(&oracle.program, &words)),
            lanes: Mutex::new(Vec::new()),
        };
        Self {
            oracle,
            seed,
            outputs,
            machine,
        }
    }

    /// The gates machine. The block between compute and uncompute is tried here, for every colour
    /// and comparator.
    ///
    /// # Errors
    /// If that block is wrong.
    pub fn gates(oracle: Arc<Oracle>, seed: u64, colours: bool) -> Result<Self, Defect> {
        let parts = Parts::new(&oracle);
        Self::of_parts(oracle, parts, seed, colours)
    }

    /// The gates machine on circuits that are given, such as ones that were tampered with.
    ///
    /// # Errors
    /// As [`OracleMachine::gates`].
    pub fn of_parts(
        oracle: Arc<Oracle>,
        parts: Parts,
        seed: u64,
        colours: bool,
    ) -> Result<Self, Defect> {
        let mut circuits = vec![&parts.compute];
        circuits.extend(&parts.flips);
        circuits.push(&parts.uncompute);
        let gates = Box::new(Gates::new(&circuits)?);
        flips::try_all(&oracle, &parts)?;
        let outputs = outputs(&oracle, colours);
        Ok(Self {
            machine: Machine::Gates {
                gates,
                rows: Mutex::new(Vec::new()),
                parts: Box::new(parts),
            },
            oracle,
            seed,
            outputs,
        })
    }

    /// The oracle.
    pub fn oracle(&self) -> &Oracle {
        &self.oracle
    }

    /// The parts of the circuit, if this is the gates machine.
    pub fn parts(&self) -> Option<&Parts> {
        match &self.machine {
            Machine::Gates { parts, .. } => Some(parts),
            Machine::Fixed { .. } => None,
        }
    }

    /// R, the paths of a pixel.
    pub fn paths(&self) -> u64 {
        1 << self.oracle.points.path_bits()
    }

    /// Runs the paths `ids` of every pixel (column, row), and hands them over in the order of
    /// pixels and ids.
    ///
    /// # Errors
    /// The first defect that shows.
    pub fn trace(
        &self,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        mut finished: impl FnMut(Finished<'_>),
    ) -> Result<(), Defect> {
        let parameters: Vec<Vec<u64>> = pixels.iter().map(|&pixel| self.words(pixel)).collect();
        let most = match &self.machine {
            Machine::Fixed { .. } => Fixed::LANES,
            Machine::Gates { .. } => Gates::LANES,
        };
        let mut block = Block {
            ids: Vec::with_capacity(most),
            runs: Vec::new(),
            values: vec![vec![0; most]; self.outputs.len()],
        };
        for (pixel, &place) in pixels.iter().enumerate() {
            let mut first = ids.start;
            while first < ids.end {
                let count = (ids.end - first).min((most - block.ids.len()) as u64);
                block.runs.push(Run {
                    pixel,
                    place,
                    first,
                    count: count as usize,
                });
                block.ids.extend(first..first + count);
                first += count;
                let last = pixel + 1 == pixels.len() && first == ids.end;
                if block.ids.len() == most || last {
                    self.run(&mut block, &parameters)?;
                    self.hand_over(&block, &mut finished);
                    block.ids.clear();
                    block.runs.clear();
                }
            }
        }
        Ok(())
    }

    /// The classical words of a pixel.
    fn words(&self, pixel: [u32; 2]) -> Vec<u64> {
        let parameters = self.oracle.program.parameters.iter();
        parameters
            .map(|parameter| parameter.value(&self.oracle.points, self.seed, pixel))
            .collect()
    }

    fn hand_over(&self, block: &Block, finished: &mut impl FnMut(Finished<'_>)) {
        let mut start = 0;
        for run in &block.runs {
            let range = start..start + run.count;
            let column = |k: usize| block.values.get(k).map_or(&[][..], |v| &v[range.clone()]);
            finished(Finished {
                pixel: run.pixel,
                first_id: run.first,
                good: [column(0), column(1), column(2)],
                colours: [column(3), column(4), column(5)],
            });
            start = range.end;
        }
    }

    fn run(&self, block: &mut Block, parameters: &[Vec<u64>]) -> Result<(), Defect> {
        let count = block.ids.len();
        let spans: Vec<Span<'_>> = block
            .runs
            .iter()
            .map(|run| Span {
                lanes: run.count,
                parameters: &parameters[run.pixel],
            })
            .collect();
        match &self.machine {
            Machine::Fixed { fixed, lanes } => {
                let mut own = take(lanes).unwrap_or_else(|| fixed.lanes());
                let zeros = vec![0; count];
                let wanted = self.outputs.iter().zip(&mut block.values);
                let wanted = wanted.filter(|(output, _)| word_of(**output).is_some());
                let mut wanted: Vec<&mut [i64]> =
                    wanted.map(|(_, values)| &mut values[..count]).collect();
                fixed.run(&mut own, &[&block.ids, &zeros], &spans, &mut wanted);
                put_back(lanes, own);
            }
            Machine::Gates { gates, rows, parts } => {
                let mut own = take(rows).unwrap_or_else(|| gates.rows());
                let done = self.run_gates(gates, parts, &mut own, block, &spans);
                // Rows that are not as they must be are not used again.
                done?;
                put_back(rows, own);
            }
        }
        for (output, values) in self.outputs.iter().zip(&mut block.values) {
            if let Operand::Constant(value) = output {
                values[..count].fill(*value);
            }
        }
        let most = 1 << self.oracle.comparator_bits();
        for values in block.values.iter_mut().take(3) {
            for value in &mut values[..count] {
                *value = (*value).clamp(0, most);
            }
        }
        Ok(())
    }

    fn run_gates(
        &self,
        gates: &Gates,
        parts: &Parts,
        rows: &mut Rows,
        block: &mut Block,
        spans: &[Span<'_>],
    ) -> Result<(), Defect> {
        let count = block.ids.len();
        let id = parts.register(self.oracle.id).to_vec();
        rows.set(&id, &block.ids);
        rows.set_parameters(spans);
        gates.run(0, rows);
        let mut bits = vec![0; count];
        for (output, values) in self.outputs.iter().zip(&mut block.values) {
            let Some(word) = word_of(*output) else {
                continue;
            };
            rows.get(&parts.qubits(*output), &mut bits);
            // The word is all that was read.
            let alone = Word { offset: 0, ..word };
            for (value, bits) in values.iter_mut().zip(&bits) {
                *value = alone.read(*bits);
            }
        }
        gates.run(1 + parts.flips.len(), rows);
        let place = |lane: usize| {
            let mut start = 0;
            let runs = block.runs.iter();
            let mut runs = runs.filter(|run| {
                start += run.count;
                lane < start
            });
            runs.next().map_or([0, 0], |run| run.place)
        };
        if let Some(dirty) = rows.dirty(&id, count) {
            return Err(Defect::Dirty {
                dirty,
                pixel: place(dirty.lane),
                id: block.ids.get(dirty.lane).copied().unwrap_or(0),
                register: parts.name(&self.oracle, dirty.qubit),
            });
        }
        rows.get(&id, &mut bits);
        match bits.iter().zip(&block.ids).position(|(is, was)| is != was) {
            Some(lane) => Err(Defect::Id {
                pixel: place(lane),
                id: block.ids[lane],
            }),
            None => Ok(()),
        }
    }
}

impl Parts {
    /// The register that a qubit belongs to after compute, if it belongs to one.
    fn name(&self, oracle: &Oracle, qubit: Qubit) -> String {
        let mut held = self.compute.outputs.iter();
        held.find(|(_, qubits)| qubits.contains(&qubit))
            .map_or_else(
                || "an ancilla".to_owned(),
                |(register, _)| oracle.program.registers[register.index()].name.clone(),
            )
    }
}

/// What a thread has at a time.
struct Block {
    ids: Vec<u64>,
    runs: Vec<Run>,
    values: Vec<Vec<i64>>,
}

struct Run {
    pixel: usize,
    place: [u32; 2],
    first: u64,
    count: usize,
}

fn outputs(oracle: &Oracle, colours: bool) -> Vec<Operand> {
    let counts = oracle.channels.iter().map(|channel| channel.count);
    let colours = oracle
        .channels
        .iter()
        .map(|channel| channel.colour)
        .take(if colours { 3 } else { 0 });
    counts.chain(colours).collect()
}

fn word_of(operand: Operand) -> Option<Word> {
    match operand {
        Operand::Word(word) => Some(word),
        Operand::Constant(_) => None,
    }
}

fn take<T>(pool: &Mutex<Vec<T>>) -> Option<T> {
    pool.lock().unwrap_or_else(PoisonError::into_inner).pop()
}

fn put_back<T>(pool: &Mutex<Vec<T>>, own: T) {
    pool.lock()
        .unwrap_or_else(PoisonError::into_inner)
        .push(own);
}
