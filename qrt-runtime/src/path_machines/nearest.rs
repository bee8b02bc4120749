//! The oracle of nearest hits, run by the fixed or the gates machine on every basis state of rays.
//!
//! The circuit alone decides which faces are marked, one basis state (ray, face) after the other.
//! The gates machine runs compute, flip and uncompute, and checks every qubit and every sign: work
//! qubits must be zero again, and inputs unchanged.

use super::oracle::{Defect, check, name, qubits};
use super::pool::Pool;
use qrt_circuit::{Circuit, Operand, Qubit, RegisterId, Word, lower};
use qrt_core::oracle::NearestOracle;
use qrt_machines::Fixed;
use qrt_machines::Span;
use qrt_machines::{Gates, Rows};
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
pub struct Asked {
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
    machine: Machine,
}

enum Machine {
    Fixed {
        fixed: Box<Fixed>,
        lanes: Pool<qrt_machines::Lanes>,
    },
    Gates(Box<GatesCircuit>),
}

/// The circuits of compute, flip and uncompute, and the qubits of compute's inputs and distance.
struct GatesCircuit {
    gates: Gates,
    rows: Pool<Rows>,
    /// Qubits by input, as in [`RayBlock::inputs`].
    inputs: [Vec<Qubit>; 4],
    distance: Vec<Qubit>,
    compute: Circuit,
}

/// Basis states, one per lane.
#[derive(Default)]
struct RayBlock {
    /// Contents by input: path index, primitive, and distance and primitive of the nearest so far.
    inputs: [Vec<u64>; 4],
    /// Runs of consecutive lanes that belong to one ray: the ray, and the number of lanes.
    runs: Vec<(Asked, usize)>,
}

impl NearestMachine {
    /// Creates a fixed machine that runs the oracle.
    pub fn fixed(oracle: Arc<NearestOracle>, seed: u64) -> Self {
        let words: Vec<Word> = oracle.outputs().into_iter().flatten().collect();
        let fixed = Box::new(Fixed::new(&oracle.program, &words));
        Self {
            machine: Machine::Fixed {
                fixed,
                lanes: Pool::new(),
            },
            oracle,
            seed,
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
        parts: Vec<Circuit>,
        seed: u64,
    ) -> Result<Self, Defect> {
        let gates = Gates::new(&parts.iter().collect::<Vec<_>>())?;
        let compute = parts.into_iter().next().unwrap_or_default();
        let held = |register: RegisterId| qubits(&compute, register).to_vec();
        let distance = match oracle.outputs()[0] {
            Some(word) => {
                held(word.register)[word.offset as usize..][..word.width as usize].to_vec()
            }
            None => Vec::new(),
        };
        Ok(Self {
            machine: Machine::Gates(Box::new(GatesCircuit {
                gates,
                rows: Pool::new(),
                inputs: registers(&oracle).map(held),
                distance,
                compute,
            })),
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
    pub fn ask(&self, asked: &[Asked], answers: &mut Answers) -> Result<(), Defect> {
        let states = self.oracle.states();
        answers.states = states;
        answers.marks.clear();
        answers.marks.resize(states * asked.len(), false);
        answers.distances.clear();
        answers.distances.resize(states * asked.len(), 0);
        let most = match &self.machine {
            Machine::Fixed { .. } => Fixed::LANES,
            Machine::Gates(circuit) => circuit.gates.lanes(),
        };
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
        let spans = spans.map(|(&(_, lanes), parameters)| Span { lanes, parameters });
        let spans: Vec<Span<'_>> = spans.collect();
        let [distance, nearer] = self.oracle.outputs();
        match &self.machine {
            Machine::Fixed { fixed, lanes } => {
                let mut bits = vec![0; marks.len()];
                let mut wanted: Vec<&mut [i64]> = Vec::new();
                if distance.is_some() {
                    wanted.push(distances);
                }
                if nearer.is_some() {
                    wanted.push(&mut bits);
                }
                let inputs = block.inputs.each_ref().map(Vec::as_slice);
                lanes.lend(
                    || fixed.lanes(),
                    |own| {
                        fixed.run(own, &inputs, &spans, &mut wanted);
                        Ok::<(), Defect>(())
                    },
                )?;
                let inverted = self.oracle.nearer.is_some_and(|bit| bit.inverted);
                for (mark, bit) in marks.iter_mut().zip(&bits) {
                    *mark = (*bit == 1) != inverted;
                }
                Ok(())
            }
            Machine::Gates(circuit) => circuit.rows.lend(
                || circuit.gates.rows(),
                |rows| self.through_gates(circuit, rows, block, &spans, marks, distances),
            ),
        }
    }

    fn through_gates(
        &self,
        circuit: &GatesCircuit,
        rows: &mut Rows,
        block: &RayBlock,
        spans: &[Span<'_>],
        marks: &mut [bool],
        distances: &mut [i64],
    ) -> Result<(), Defect> {
        let gates = &circuit.gates;
        rows.clear();
        let inputs = [0, 1, 2, 3].map(|k| (&circuit.inputs[k][..], &block.inputs[k][..]));
        for (qubits, contents) in inputs {
            rows.set(qubits, contents);
        }
        rows.set_parameters(spans);
        gates.run(0, rows);
        if let [Some(word), _] = self.oracle.outputs() {
            let mut bits = vec![0; block.lanes()];
            rows.get(&circuit.distance, &mut bits);
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
            let Asked { pixel, id, .. } = block.ray(lane);
            (pixel, id)
        };
        check(rows, &inputs, path, |qubit| {
            name(&circuit.compute, &self.oracle.program, qubit)
        })
    }

    /// The classical parameters of a ray's pixel.
    fn parameter_words(&self, ray: &Asked) -> Vec<u64> {
        self.oracle.parameter_words(self.seed, ray.pixel)
    }
}

impl RayBlock {
    fn lanes(&self) -> usize {
        self.inputs[0].len()
    }

    fn push(&mut self, oracle: &NearestOracle, ray: &Asked, primitives: Range<usize>) {
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
    fn ray(&self, lane: usize) -> Asked {
        let mut end = 0;
        let mut runs = self.runs.iter();
        let run = runs.find(|(_, lanes)| {
            end += lanes;
            lane < end
        });
        run.map_or(
            Asked {
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
