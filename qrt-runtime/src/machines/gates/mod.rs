//! The gates machine: a circuit, gate by gate, on basis states.
//!
//! X, CNOT and Toffoli permute the basis states, so that each state is followed by itself, and a
//! gate does the same to all of them: `t ^= 1`, `t ^= a`, `t ^= a & b`. A *row* holds one qubit of
//! [`Gates::lanes`] states, a bit each, and a gate is a few instructions on vectors of bits. States
//! span paths and pixels: what a pixel's circuit has built in, the classical parameters, are rows
//! that gates read.
//!
//! It knows nothing of numbers. What it computes is what the list of gates computes, which is why
//! the machine that computes with integers is held against it.

mod compile;
mod patterns;
mod rows;
#[cfg(test)]
mod tests;

pub use rows::{Dirty, Rows};

use super::instructions::InstructionSet;
use compile::Wiring;
use pulp::{Simd, WithSimd, bytemuck};
use qrt_circuit::{Circuit, Gate, Qubit};
use rayon::prelude::*;
use rows::LANES;
use std::cell::Cell;

/// A gate that a circuit cannot have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "gate {gate} of circuit {circuit} is controlled by its own target, or names a qubit or a \
     parameter that the circuit does not have"
)]
pub struct InvalidGate {
    /// The circuit's place in the list that was given.
    pub circuit: usize,
    /// The gate's place in it.
    pub gate: usize,
}

/// Circuits, ready to be run on rows of states.
///
/// ```
/// use qrt_circuit::{Circuit, Gate, Qubit};
/// use qrt_runtime::machines::Gates;
///
/// // A half adder: the sum of qubits 0 and 1, in 1 and 2.
/// let gates = vec![Gate::Ccx(0, 1, 2), Gate::Cx(0, 1)];
/// let circuit = Circuit { gates, qubits: 3, ..Circuit::default() };
/// let machine = Gates::new(&[&circuit])?;
/// let mut rows = machine.rows();
/// rows.set(&[0], &[0, 1, 0, 1]);
/// rows.set(&[1], &[0, 0, 1, 1]);
/// machine.run(0, &mut rows);
/// let mut sums = [0; 4];
/// rows.get(&[1, 2], &mut sums);
/// assert_eq!(sums, [0, 1, 1, 2]);
/// # Ok::<(), qrt_runtime::machines::InvalidGate>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gates {
    code: Vec<Box<[u32]>>,
    lengths: Vec<usize>,
    wiring: Wiring,
    instructions: InstructionSet,
    /// Words of a row.
    words: usize,
}

impl Gates {
    /// States that a machine's rows hold, at most: see [`Gates::lanes`].
    pub const LANES: usize = LANES;

    /// A machine for circuits that share their qubits and their list of classical parameters: one
    /// circuit, or the parts of one between which the states are looked at.
    ///
    /// # Errors
    /// If a gate is not one: see [`InvalidGate`].
    pub fn new(circuits: &[&Circuit]) -> Result<Self, InvalidGate> {
        let wiring = Wiring::new(circuits);
        let code = circuits.iter().enumerate().map(|(place, circuit)| {
            let compiled = wiring.compile(&circuit.gates);
            compiled.map_err(|gate| InvalidGate {
                circuit: place,
                gate,
            })
        });
        Ok(Self {
            code: code.collect::<Result<_, _>>()?,
            lengths: circuits.iter().map(|circuit| circuit.gates.len()).collect(),
            words: rows::words_of(wiring.rows()),
            wiring,
            instructions: InstructionSet::widest(),
        })
    }

    /// With another instruction set.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// With rows such as [`Gates::run_queued`] is given many of, in so many bytes: where not even one fits, rows of 256
    /// states.
    pub fn for_many_rows(self, bytes: usize) -> Self {
        let words = rows::words_of_many(self.wiring.rows(), bytes);
        self.with_words(words)
    }

    /// How many rows fit into so many bytes, or one: if [`Gates::run_queued`] is given as many, the time that it takes
    /// to read the gates is shared by many states.
    pub fn rows_at_once(&self, bytes: usize) -> usize {
        rows::at_once(self.wiring.rows(), self.words, bytes)
    }

    /// With rows of `lanes` states, in place of the length that the number of qubits suggests.
    ///
    /// # Panics
    /// If `lanes` is not 2048, 1024, 512 or 256.
    pub fn with_lanes(self, lanes: usize) -> Self {
        let words = rows::LENGTHS.into_iter().find(|words| 64 * words == lanes);
        assert!(words.is_some(), "rows of {lanes} lanes");
        self.with_words(words.unwrap_or_default())
    }

    /// With rows of `words` words, one of [`rows::LENGTHS`].
    fn with_words(mut self, words: usize) -> Self {
        self.words = words;
        self
    }

    /// States that this machine's rows hold: [`Gates::LANES`], or a half or a quarter of them where
    /// there are so many qubits that longer rows would not stay in the processor's caches.
    pub fn lanes(&self) -> usize {
        64 * self.words
    }

    /// Gates of circuit `circuit` of those given.
    pub fn len(&self, circuit: usize) -> usize {
        self.lengths[circuit]
    }

    /// Whether circuit `circuit` has no gates.
    pub fn is_empty(&self, circuit: usize) -> bool {
        self.lengths[circuit] == 0
    }

    /// Rows for [`Gates::lanes`] states, all of whose qubits are zero.
    pub fn rows(&self) -> Rows {
        Rows::new(&self.wiring, self.words)
    }

    /// Runs circuit `circuit` of those given on every state of `rows`, which are of this machine.
    pub fn run(&self, circuit: usize, rows: &mut Rows) {
        self.run_code(&self.code[circuit], rows);
    }

    fn run_code(&self, code: &[u32], rows: &mut Rows) {
        self.instructions.dispatch(Run {
            code,
            words: self.words,
            rows: rows.all(),
        });
    }

    /// Gates on so many qubits of their own, and on the machine's parameters, to be run wherever these qubits
    /// are: see [`Gates::queue`].
    ///
    /// # Errors
    /// If a gate is not one.
    pub fn template(&self, gates: &[Gate], qubits: u32) -> Result<Template, InvalidGate> {
        let are_short = self.words <= rows::FEW_WORDS;
        let code = self.wiring.compile_on(qubits, gates, are_short);
        Ok(Template {
            code: code.map_err(|gate| InvalidGate { circuit: 0, gate })?,
            gates: gates.len(),
        })
    }

    /// Queues the gates of a template of this machine, whose qubits these of the machine's are.
    pub fn queue(&self, template: &Template, qubits: &[Qubit], queue: &mut Queue) {
        self.wiring
            .relocate(&template.code, qubits, &mut queue.code);
        queue.gates += template.gates;
    }

    /// Runs what is queued on all these rows, and empties the queue.
    pub fn run_queued(&self, queue: &mut Queue, rows: &mut [Rows]) {
        for rows in rows {
            self.run_code(&queue.code, rows);
        }
        queue.code.clear();
        queue.gates = 0;
    }

    /// Calls `block` for each of `0..blocks`, on all threads, each with rows of its own; they come
    /// as the last block on that thread left them. Results are in the order of blocks.
    pub fn blocks<T: Send>(
        &self,
        blocks: usize,
        block: impl Fn(&mut Rows, usize) -> T + Sync,
    ) -> Vec<T> {
        let numbers = (0..blocks).into_par_iter();
        numbers
            .map_init(|| self.rows(), |rows, number| block(rows, number))
            .collect()
    }
}

/// Gates on qubits of their own, as code of a machine.
#[derive(Clone, Debug)]
pub struct Template {
    code: Box<[u32]>,
    gates: usize,
}

impl Template {
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.code)
    }
}

/// Gates of a machine that are to run one after another.
#[derive(Clone, Debug, Default)]
pub struct Queue {
    code: Vec<u32>,
    gates: usize,
}

impl Queue {
    /// How many gates there are.
    pub fn len(&self) -> usize {
        self.gates
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.gates == 0
    }
}

struct Run<'a> {
    code: &'a [u32],
    /// Words of a row.
    words: usize,
    rows: &'a mut [u64],
}

impl WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::U64_LANES {
            // Few words do not fill a vector.
            8 if self.words < 8 => self.scalar(),
            8 => self.of_length::<S, 4, 2, 1, 1>(simd),
            4 => self.of_length::<S, 8, 4, 2, 1>(simd),
            2 => self.of_length::<S, 16, 8, 4, 2>(simd),
            _ => self.scalar(),
        }
    }
}

impl Run<'_> {
    /// One code for rows of every length, a part of them at a time: it is compiled once, not four
    /// times, which matters where it is sent to browsers.
    #[inline(always)]
    fn scalar(self) {
        let parts = self.words / rows::FEW_WORDS;
        run::<pulp::Scalar, { rows::FEW_WORDS }>(
            pulp::Scalar::new(),
            self.code,
            (self.rows, parts),
        );
    }

    /// Runs on rows of so many vectors, by their words: those of [`rows::LENGTHS`].
    #[inline(always)]
    fn of_length<S: Simd, const A: usize, const B: usize, const C: usize, const D: usize>(
        self,
        simd: S,
    ) {
        match rows::LENGTHS.iter().position(|words| *words == self.words) {
            Some(0) => run::<S, A>(simd, self.code, (self.rows, 1)),
            Some(1) => run::<S, B>(simd, self.code, (self.rows, 1)),
            Some(2) => run::<S, C>(simd, self.code, (self.rows, 1)),
            _ => run::<S, D>(simd, self.code, (self.rows, 1)),
        }
    }
}

/// Runs code on rows of so many parts, each of `N` vectors.
#[inline(always)]
fn run<S: Simd, const N: usize>(simd: S, mut code: &[u32], (rows, parts): (&mut [u64], usize)) {
    let vectors: &mut [S::u64s] = bytemuck::cast_slice_mut(rows);
    let (rows, _) = vectors.as_chunks_mut::<N>();
    let rows = Cell::from_mut(rows).as_slice_of_cells();
    while let [head, rest @ ..] = code {
        let (number, count) = compile::parts(*head);
        let (operands, rest) = rest.split_at(count * patterns::PATTERNS[number].rows);
        patterns::execute::<S, N>(simd, (rows, parts), number, operands);
        code = rest;
    }
}
