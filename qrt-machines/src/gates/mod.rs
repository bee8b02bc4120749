//! The gates machine: a circuit, gate by gate, on basis states.
//!
//! X, CNOT and Toffoli permute the basis states. Therefore each basis state stays a single basis
//! state, and a gate does the same to all of them: `t ^= 1`, `t ^= a`, `t ^= a & b`. A *row* holds
//! one qubit of [`GatesMachine::lanes`] states, one bit each, and a gate is a few instructions on
//! vectors of bits. States span paths and pixels: the classical parameters, which are built into a
//! pixel's circuit, are rows that gates read.
//!
//! The machine does not interpret qubits as numbers: it computes what the list of gates computes.
//! Therefore the machine that computes with integers is checked against it.

mod compile;
mod patterns;
mod rows;
#[cfg(test)]
mod tests;

pub use rows::{Dirty, Rows};

use super::instructions::InstructionSet;
use compile::Wiring;
use pulp::{Simd, WithSimd, bytemuck};
use qrt_circuit::{Gate, GateCircuit, Qubit};
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
    /// Position of the circuit in the caller's list.
    pub circuit: usize,
    /// Position of the gate in the circuit.
    pub gate: usize,
}

/// Circuits, ready to be run on rows of states.
///
/// ```
/// use qrt_circuit::{GateCircuit, Gate, Qubit};
/// use qrt_machines::GatesMachine;
///
/// // A half adder: the sum of qubits 0 and 1, in 1 and 2.
/// let gates = vec![Gate::Ccx(0, 1, 2), Gate::Cx(0, 1)];
/// let circuit = GateCircuit { gates, qubits: 3, ..GateCircuit::default() };
/// let machine = GatesMachine::new(&[&circuit])?;
/// let mut rows = machine.rows();
/// rows.set(&[0], &[0, 1, 0, 1]);
/// rows.set(&[1], &[0, 0, 1, 1]);
/// machine.run(0, &mut rows);
/// let mut sums = [0; 4];
/// rows.get(&[1, 2], &mut sums);
/// assert_eq!(sums, [0, 1, 1, 2]);
/// # Ok::<(), qrt_machines::InvalidGate>(())
/// ```
#[derive(Clone, Debug)]
pub struct GatesMachine {
    code: Vec<Box<[u32]>>,
    lengths: Vec<usize>,
    wiring: Wiring,
    instructions: InstructionSet,
    /// Words of a row.
    words: usize,
}

impl GatesMachine {
    /// Largest number of states that a machine's rows hold: see [`GatesMachine::lanes`].
    pub const LANES: usize = LANES;

    /// Creates a machine for circuits that share their qubits and their list of classical
    /// parameters: one circuit, or the parts of one between which the caller reads the states.
    ///
    /// # Errors
    /// If a gate is invalid: see [`InvalidGate`].
    pub fn new(circuits: &[&GateCircuit]) -> Result<Self, InvalidGate> {
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

    /// Sets the instruction set.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// Sets the length of rows for [`GatesMachine::run_queued`], which takes many [`Rows`]. If not
    /// even one of them fits into `bytes` bytes, it holds 256 states.
    pub fn for_many_rows(self, bytes: usize) -> Self {
        let words = rows::words_of_many(self.wiring.rows(), bytes);
        self.with_words(words)
    }

    /// Returns the number of [`Rows`] that fit into `bytes` bytes, at least 1. If
    /// [`GatesMachine::run_queued`] gets that many, a large number of states share the time that it
    /// takes to read the gates.
    pub fn rows_at_once(&self, bytes: usize) -> usize {
        rows::at_once(self.wiring.rows(), self.words, bytes)
    }

    /// Sets rows of `lanes` states, in place of the length that the number of qubits suggests.
    ///
    /// # Panics
    /// If `lanes` is not 2048, 1024, 512 or 256.
    pub fn with_lanes(self, lanes: usize) -> Self {
        let words = rows::LENGTHS.into_iter().find(|words| 64 * words == lanes);
        assert!(words.is_some(), "rows of {lanes} lanes");
        self.with_words(words.unwrap_or_default())
    }

    /// Sets the number of words of a row, one of [`rows::LENGTHS`].
    fn with_words(mut self, words: usize) -> Self {
        self.words = words;
        self
    }

    /// Number of states that this machine's rows hold: [`GatesMachine::LANES`], or a half or a
    /// quarter of them if the number of qubits is so large that longer rows would not stay in the
    /// processor's caches. After [`GatesMachine::for_many_rows`] it may also be an eighth.
    pub fn lanes(&self) -> usize {
        64 * self.words
    }

    /// Number of gates of circuit number `circuit`.
    pub fn len(&self, circuit: usize) -> usize {
        self.lengths[circuit]
    }

    /// Returns whether circuit number `circuit` has no gates.
    pub fn is_empty(&self, circuit: usize) -> bool {
        self.lengths[circuit] == 0
    }

    /// Creates rows for [`GatesMachine::lanes`] states, all of whose qubits are zero.
    pub fn rows(&self) -> Rows {
        Rows::new(&self.wiring, self.words)
    }

    /// Runs circuit number `circuit` on every state of `rows`, which must belong to this machine.
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

    /// Compiles gates on `qubits` qubits of their own and on the machine's parameters.
    /// [`GatesMachine::queue`] then places them on any qubits of the machine.
    ///
    /// # Errors
    /// If a gate is invalid.
    pub fn template(&self, gates: &[Gate], qubits: u32) -> Result<Template, InvalidGate> {
        let are_short = self.words <= rows::FEW_WORDS;
        let code = self.wiring.compile_on(qubits, gates, are_short);
        Ok(Template {
            code: code.map_err(|gate| InvalidGate { circuit: 0, gate })?,
            gates: gates.len(),
        })
    }

    /// Queues the gates of a template of this machine, with `qubits` in place of the template's
    /// own.
    pub fn queue(&self, template: &Template, qubits: &[Qubit], queue: &mut Queue) {
        self.wiring
            .relocate(&template.code, qubits, &mut queue.code);
        queue.gates += template.gates;
    }

    /// Runs the queued gates on all of `rows`, and empties the queue.
    pub fn run_queued(&self, queue: &mut Queue, rows: &mut [Rows]) {
        for rows in rows {
            self.run_code(&queue.code, rows);
        }
        queue.code.clear();
        queue.gates = 0;
    }

    /// Calls `block` for each of `0..blocks`, on all threads, with rows that no other thread uses.
    /// They may still hold the states of an earlier block. Results are in the order of blocks.
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

/// Gates on qubits of their own, compiled to code of a machine.
#[derive(Clone, Debug)]
pub struct Template {
    code: Box<[u32]>,
    gates: usize,
}

impl Template {
    /// Number of bytes of the template's code.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.code)
    }
}

/// Gates of a machine that wait to run one after another.
#[derive(Clone, Debug, Default)]
pub struct Queue {
    code: Vec<u32>,
    gates: usize,
}

impl Queue {
    /// Number of gates in the queue.
    pub fn len(&self) -> usize {
        self.gates
    }

    /// Returns whether the queue is empty.
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
    /// Runs rows of every length with one code, a part of each row at a time. The compiler compiles
    /// it once, not four times, which matters for programs that browsers load.
    #[inline(always)]
    fn scalar(self) {
        let parts = self.words / rows::FEW_WORDS;
        run_patterns::<pulp::Scalar, { rows::FEW_WORDS }>(
            pulp::Scalar::new(),
            self.code,
            (self.rows, parts),
        );
    }

    /// Runs on rows of `A`, `B`, `C` or `D` vectors: the lengths in [`rows::LENGTHS`], in this
    /// order.
    #[inline(always)]
    fn of_length<S: Simd, const A: usize, const B: usize, const C: usize, const D: usize>(
        self,
        simd: S,
    ) {
        match rows::LENGTHS.iter().position(|words| *words == self.words) {
            Some(0) => run_patterns::<S, A>(simd, self.code, (self.rows, 1)),
            Some(1) => run_patterns::<S, B>(simd, self.code, (self.rows, 1)),
            Some(2) => run_patterns::<S, C>(simd, self.code, (self.rows, 1)),
            _ => run_patterns::<S, D>(simd, self.code, (self.rows, 1)),
        }
    }
}

/// Runs code on rows of `parts` parts, each of `N` vectors.
#[inline(always)]
fn run_patterns<S: Simd, const N: usize>(
    simd: S,
    mut code: &[u32],
    (rows, parts): (&mut [u64], usize),
) {
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
