//! The oracle of nearest hits, run by the fixed or the gates machine on every basis state of rays.
//!
//! The circuit alone decides which faces are marked, one basis state (ray, face) after the other.
//! The gates machine runs compute, flip and uncompute, and checks every qubit and every sign: work
//! qubits must be zero again, and inputs unchanged.

use super::oracle::{Defect, check, name, qubits};
use super::pool::Pool;
use qrt_circuit::{GateCircuit, Operand, Qubit, RegisterId, Word, lower};
use qrt_core::oracle::NearestOracle;
use qrt_machines::FixedMachine;
use qrt_machines::PixelLanes;
use qrt_machines::{GatesMachine, Rows};
use std::ops::Range;
use std::sync::Arc;

/// A face that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// Distance of the face, in ulps.
    pub distance: i64,
    /// Number of the face.
    pub primitive: u32,
}

/// The first ray of a path, and the nearest face known for it so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NearestQuery {
    /// Column and row of the path's pixel.
    pub pixel: [u32; 2],
    /// The path's index.
    pub id: u64,
    /// The bound: the oracle marks only faces that are nearer. Without a bound it marks all faces
    /// that the ray meets.
    pub best: Option<Candidate>,
}

/// Results of the oracle on all basis states of some rays.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    states: usize,
    marks: Vec<bool>,
    distances: Vec<i64>,
}

impl Answers {
    /// Marks of ray number `ray`, by basis state: true if the oracle flips its phase.
    pub fn marks(&self, ray: usize) -> &[bool] {
        &self.marks[ray * self.states..][..self.states]
    }

    /// Distances of ray number `ray`, by basis state: the face's distance in ulps, if the ray meets
    /// the face.
    pub fn distances(&self, ray: usize) -> &[i64] {
        &self.distances[ray * self.states..][..self.states]
    }
}

/// An oracle of nearest hits on a machine.
pub struct NearestMachine {
    oracle: Arc<NearestOracle>,
    seed: u64,
    reading: Box<dyn Reading>,
}

/// Runs the oracle on blocks of basis states.
trait Reading: Send + Sync {
    /// The largest number of basis states of a block.
    fn lanes(&self) -> usize;

    /// Sets the marks and, unless they are the same everywhere, the distances of a block.
    fn run(
        &self,
        oracle: &NearestOracle,
        block: &RayBlock,
        spans: &[PixelLanes<'_>],
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect>;
}

/// The program on lanes of integers.
struct FixedProgram {
    fixed: FixedMachine,
    lanes: Pool<qrt_machines::FixedLanes>,
}

/// The circuits of compute, flip and uncompute, and the qubits of compute's inputs and distance.
struct GatesCircuit {
    gates: GatesMachine,
    rows: Pool<Rows>,
    /// Qubits by input, as in [`RayBlock::inputs`].
    inputs: [Vec<Qubit>; 4],
    distance: Vec<Qubit>,
    compute: GateCircuit,
}

/// Basis states, one per lane.
#[derive(Default)]
struct RayBlock {
    /// Contents by input: path index, primitive, and distance and primitive of the nearest so far.
    inputs: [Vec<u64>; 4],
    /// Runs of consecutive lanes that belong to one ray: the ray, and the number of lanes.
    runs: Vec<(NearestQuery, usize)>,
}

impl NearestMachine {
    /// Creates a fixed machine that runs the oracle.
    pub fn fixed(oracle: Arc<NearestOracle>, seed: u64) -> Self {
        let words: Vec<Word> = oracle.outputs().into_iter().flatten().collect();
        let reading = Box::new(FixedProgram {
            fixed: FixedMachine::new(&oracle.program, &words),
            lanes: Pool::new(),
        });
        Self {
            oracle,
            seed,
            reading,
        }
    }

    /// Creates a gates machine that runs the oracle.
    ///
    /// # Errors
    /// If the gates are not a valid circuit: a defect of qrt.
    pub fn gates(oracle: Arc<NearestOracle>, seed: u64) -> Result<Self, Defect> {
        let whole = oracle.whole();
        let compute = oracle.program.instructions.len();
        let flip = whole.instructions.len() - compute;
        let parts = lower::parts(&whole, &[compute, flip]);
        Self::of_parts(oracle, parts, seed)
    }

    /// Creates a gates machine from given circuits, for example from circuits with a deliberate
    /// error: compute, flip and uncompute, as [`lower::parts`] makes them.
    ///
    /// # Errors
    /// As [`NearestMachine::gates`].
    pub fn of_parts(
        oracle: Arc<NearestOracle>,
        parts: Vec<GateCircuit>,
        seed: u64,
    ) -> Result<Self, Defect> {
        let gates = GatesMachine::new(&parts.iter().collect::<Vec<_>>())?;
        let compute = parts.into_iter().next().unwrap_or_default();
        let held = |register: RegisterId| qubits(&compute, register).to_vec();
        let distance = match oracle.outputs()[0] {
            Some(word) => {
                held(word.register)[word.offset as usize..][..word.width as usize].to_vec()
            }
            None => Vec::new(),
        };
        Ok(Self {
            reading: Box::new(GatesCircuit {
                gates,
                rows: Pool::new(),
                inputs: registers(&oracle).map(held),
                distance,
                compute,
            }),
            oracle,
            seed,
        })
    }

    /// The oracle that the machine runs.
    pub fn oracle(&self) -> &NearestOracle {
        &self.oracle
    }

    /// Runs the oracle on every basis state of every ray of `asked`.
    ///
    /// # Errors
    /// The first defect found.
    pub fn ask(&self, asked: &[NearestQuery], answers: &mut Answers) -> Result<(), Defect> {
        let states = self.oracle.states();
        answers.states = states;
        answers.marks.clear();
        answers.marks.resize(states * asked.len(), false);
        answers.distances.clear();
        answers.distances.resize(states * asked.len(), 0);
        let most = self.reading.lanes();
        let mut marks = answers.marks.as_mut_slice();
        let mut distances = answers.distances.as_mut_slice();
        let mut block = RayBlock::default();
        for (place, ray) in asked.iter().enumerate() {
            let mut first = 0;
            while first < states {
                let count = (states - first).min(most - block.lanes());
                block.push(&self.oracle, ray, first..first + count);
                first += count;
                let last = first == states && place + 1 == asked.len();
                if block.lanes() == most || last {
                    let (now, later) = marks.split_at_mut(block.lanes());
                    let (far, farther) = distances.split_at_mut(block.lanes());
                    self.run_block(&block, now, far)?;
                    (marks, distances) = (later, farther);
                    block.clear();
                }
            }
        }
        Ok(())
    }

    fn run_block(
        &self,
        block: &RayBlock,
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect> {
        if let Operand::Constant(value) = self.oracle.distance {
            distances.fill(value);
        }
        let words: Vec<Vec<u64>> = block
            .runs
            .iter()
            .map(|(ray, _)| self.parameter_words(ray))
            .collect();
        let spans = block.runs.iter().zip(&words);
        let spans = spans.map(|(&(_, lanes), parameters)| PixelLanes { lanes, parameters });
        let spans: Vec<PixelLanes<'_>> = spans.collect();
        self.reading
            .run(&self.oracle, block, &spans, marks, distances)
    }

    /// The classical parameters of a ray's pixel.
    fn parameter_words(&self, ray: &NearestQuery) -> Vec<u64> {
        self.oracle.parameter_words(self.seed, ray.pixel)
    }
}

impl Reading for FixedProgram {
    fn lanes(&self) -> usize {
        FixedMachine::LANES
    }

    fn run(
        &self,
        oracle: &NearestOracle,
        block: &RayBlock,
        spans: &[PixelLanes<'_>],
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect> {
        let [distance, nearer] = oracle.outputs();
        let mut bits = vec![0; marks.len()];
        let mut wanted: Vec<&mut [i64]> = Vec::new();
        if distance.is_some() {
            wanted.push(distances);
        }
        if nearer.is_some() {
            wanted.push(&mut bits);
        }
        let inputs = block.inputs.each_ref().map(Vec::as_slice);
        self.lanes.lend(
            || self.fixed.lanes(),
            |own| {
                self.fixed.run(own, &inputs, spans, &mut wanted);
                Ok::<(), Defect>(())
            },
        )?;
        let inverted = oracle.nearer.is_some_and(|bit| bit.inverted);
        for (mark, bit) in marks.iter_mut().zip(&bits) {
            *mark = (*bit == 1) != inverted;
        }
        Ok(())
    }
}

impl Reading for GatesCircuit {
    fn lanes(&self) -> usize {
        self.gates.lanes()
    }

    fn run(
        &self,
        oracle: &NearestOracle,
        block: &RayBlock,
        spans: &[PixelLanes<'_>],
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect> {
        self.rows.lend(
            || self.gates.rows(),
            |rows| self.through_gates(oracle, rows, block, spans, marks, distances),
        )
    }
}

impl GatesCircuit {
    fn through_gates(
        &self,
        oracle: &NearestOracle,
        rows: &mut Rows,
        block: &RayBlock,
        spans: &[PixelLanes<'_>],
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect> {
        let gates = &self.gates;
        rows.clear();
        let inputs = [0, 1, 2, 3].map(|k| (&self.inputs[k][..], &block.inputs[k][..]));
        for (qubits, contents) in inputs {
            rows.set(qubits, contents);
        }
        rows.set_parameters(spans);
        gates.run(0, rows);
        if let [Some(word), _] = oracle.outputs() {
            let mut bits = vec![0; block.lanes()];
            rows.get(&self.distance, &mut bits);
            let alone = Word { offset: 0, ..word };
            for (distance, bits) in distances.iter_mut().zip(&bits) {
                *distance = alone.read(*bits);
            }
        }
        gates.run(1, rows);
        gates.run(2, rows);
        for (lane, mark) in marks.iter_mut().enumerate() {
            *mark = rows.signs()[lane / 64] >> (lane % 64) & 1 == 1;
        }
        let path = |lane| {
            let NearestQuery { pixel, id, .. } = block.ray(lane);
            (pixel, id)
        };
        check(rows, &inputs, path, |qubit| {
            name(&self.compute, &oracle.program, qubit)
        })
    }
}

impl RayBlock {
    fn lanes(&self) -> usize {
        self.inputs[0].len()
    }

    fn push(&mut self, oracle: &NearestOracle, ray: &NearestQuery, primitives: Range<usize>) {
        let (distance, number) = match ray.best {
            Some(best) => (best.distance.cast_unsigned(), u64::from(best.primitive)),
            None => (oracle.t_max, 0),
        };
        let [id, primitive, best_distance, best_primitive] = &mut self.inputs;
        let lanes = id.len() + primitives.len();
        id.resize(lanes, ray.id);
        best_distance.resize(lanes, distance);
        best_primitive.resize(lanes, number);
        self.runs.push((*ray, primitives.len()));
        primitive.extend(primitives.map(|primitive| primitive as u64));
    }

    fn clear(&mut self) {
        self.inputs.iter_mut().for_each(Vec::clear);
        self.runs.clear();
    }

    /// The ray that a lane belongs to.
    fn ray(&self, lane: usize) -> NearestQuery {
        let mut end = 0;
        let mut runs = self.runs.iter();
        let run = runs.find(|(_, lanes)| {
            end += lanes;
            lane < end
        });
        run.map_or(
            NearestQuery {
                pixel: [0, 0],
                id: 0,
                best: None,
            },
            |(ray, _)| *ray,
        )
    }
}

/// The input registers, in the order of [`RayBlock::inputs`].
fn registers(oracle: &NearestOracle) -> [RegisterId; 4] {
    [
        oracle.id,
        oracle.primitive,
        oracle.best_distance,
        oracle.best_primitive,
    ]
}
