//! The basis states that carry amplitude, and no others.

mod block;
mod mix;

use super::dense::Kernel;
use super::error::{check_qubits, filled};
use super::{StateVector, StateVectorError};
use crate::InstructionSet;
use block::{Block, Local, RunBlock, STATES};
use num_complex::Complex;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::QuantumGate;
use rayon::prelude::*;

/// Largest number of gates that wait.
const WAITING: usize = 1 << 16;

/// Most qubits of a register whose distribution is listed.
const LISTED: u32 = 26;

/// Largest number of Hadamards that are executed together.
const TOGETHER: usize = 16;

/// The sparse machine: basis states with amplitude, of any number of qubits, on all cores.
///
/// Blocks hold 2048 states each, bit-sliced: a row of bits for each qubit. X, CNOT and Toffoli
/// change rows, of all states at once, and phases change amplitudes. The machine executes these
/// gates one by one, block after block. Hadamards and rotations mix states: the machine gathers the
/// states that differ only in the mixed qubits, transforms them together (adjacent Hadamards on
/// different qubits as one fast Walsh-Hadamard transform), and puts them back in the order of their
/// groups. The qubits that are not the same in all states distinguish groups, so that ancillas at
/// zero cost nothing.
///
/// The machine drops a state when its amplitude is at most `1e-16`, which is about
/// what rounding leaves of amplitudes that cancel. [`Sparse::dropped`] is the sum of the
/// probabilities of dropped states; nothing is renormalised.
///
/// The results are the same bits for any number of threads and any instruction set.
///
/// ```
/// use qrt_circuit::quantum::QuantumGate::{Cx, H};
/// use qrt_machines::statevector::{Sparse, StateVector};
/// // 500 qubits that are all read as 0 or all as 1.
/// let mut cat = Sparse::new(500);
/// cat.gate(H(0))?;
/// for qubit in 1..500 {
///     cat.gate(Cx(qubit - 1, qubit))?;
/// }
/// assert_eq!(cat.states()?, 2);
/// let ends = cat.distribution(&[0, 499])?;
/// assert!((ends[0] - 0.5).abs() < 1e-15 && (ends[3] - 0.5).abs() < 1e-15);
/// # Ok::<(), qrt_machines::statevector::StateVectorError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sparse {
    qubits: u32,
    blocks: Vec<Block>,
    states: usize,
    waiting: Vec<Local>,
    /// Adjacent Hadamards that wait, after everything in `waiting`.
    hadamards: Vec<Qubit>,
    /// True if the amplitudes lack a factor `1/sqrt(2)`.
    odd: bool,
    pub(super) bound: f64,
    dropped: f64,
    pub(super) most: u64,
    peak: u64,
    instructions: InstructionSet,
}

impl Sparse {
    /// Largest amplitude that is dropped, just below 2^-53. Two amplitudes below 1/2 that cancel
    /// and were each rounded once leave at most 2^-54, which is dropped. Larger amplitudes, and
    /// those that were rounded many times, can leave more; such a state stays, which costs memory
    /// only.
    pub(crate) const ROUNDING: f64 = 1e-16;

    /// Largest number of states. A state takes a bit for each qubit and 16 bytes; while states are
    /// mixed, it takes twice that and some 60 bytes more.
    pub const MOST_STATES: u64 = 1 << 24;

    /// Creates the basis state in which all qubits are zero.
    pub fn new(qubits: u32) -> Self {
        Self {
            qubits,
            blocks: vec![Block::zero(qubits)],
            states: 1,
            waiting: Vec::new(),
            hadamards: Vec::new(),
            odd: false,
            bound: Self::ROUNDING,
            dropped: 0.0,
            most: Self::MOST_STATES,
            peak: 1,
            instructions: InstructionSet::widest(),
        }
    }

    /// Sets the instruction set.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// Number of states that carry amplitude.
    ///
    /// # Errors
    /// As [`StateVector::gate`], for gates that waited.
    pub fn states(&mut self) -> Result<u64, StateVectorError> {
        self.run_waiting()?;
        Ok(self.states as u64)
    }

    /// Largest number of states that have carried amplitude.
    pub(crate) fn most_states(&self) -> u64 {
        self.peak
    }

    /// The probability of all states that were dropped.
    pub fn dropped(&self) -> f64 {
        self.dropped
    }

    /// Returns every state with amplitude: its content of up to 64 qubits, bit 0 first, and its
    /// amplitude.
    ///
    /// # Errors
    /// If a qubit does not exist, or there are more than 64.
    pub fn amplitudes(
        &mut self,
        register: &[Qubit],
    ) -> Result<Vec<(u64, Complex<f64>)>, StateVectorError> {
        let values = self.values(register)?;
        let scale = self.scale();
        let amplitudes = self.blocks.iter().flat_map(|block| &block.amplitudes);
        let amplitudes = amplitudes.map(|amplitude| amplitude * scale);
        Ok(values.into_iter().zip(amplitudes).collect())
    }

    /// Returns the contents of a register, state by state.
    fn values(&mut self, register: &[Qubit]) -> Result<Vec<u64>, StateVectorError> {
        check_qubits(register, self.qubits)?;
        if register.len() > 64 {
            return Err(StateVectorError::RegisterTooWide {
                bits: register.len() as u32,
                most: 64,
            });
        }
        self.run_waiting()?;
        let mut values = filled(0, self.states)?;
        for (block, values) in self.blocks.iter().zip(values.chunks_mut(STATES)) {
            block.values(register, values);
        }
        Ok(values)
    }

    fn scale(&self) -> f64 {
        if self.odd {
            std::f64::consts::FRAC_1_SQRT_2
        } else {
            1.0
        }
    }

    /// Executes the gates that wait.
    fn run_waiting(&mut self) -> Result<(), StateVectorError> {
        self.run_local();
        while !self.hadamards.is_empty() {
            let count = self.hadamards.len().min(TOGETHER);
            let mixed: Vec<Qubit> = self.hadamards.drain(..count).collect();
            let factors = count as u32 + u32::from(self.odd);
            self.odd = factors % 2 == 1;
            let step = Kernel::Hadamards {
                mask: (1 << count) - 1,
                scale: 0.5_f64.powi((factors / 2) as i32),
            };
            self.mix(&mixed, step)?;
        }
        Ok(())
    }

    fn run_local(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        let steps = std::mem::take(&mut self.waiting);
        let set = self.instructions;
        self.blocks.par_iter_mut().for_each(|block| {
            set.dispatch(RunBlock {
                steps: &steps,
                block,
            });
        });
        self.waiting = steps;
        self.waiting.clear();
    }

    /// Adds a step that does not mix states. Hadamards that wait run first.
    fn wait(&mut self, step: Local) -> Result<(), StateVectorError> {
        if !self.hadamards.is_empty() {
            self.run_waiting()?;
        }
        self.waiting.push(step);
        if self.waiting.len() >= WAITING {
            self.run_local();
        }
        Ok(())
    }
}

impl StateVector for Sparse {
    fn qubits(&self) -> u32 {
        self.qubits
    }

    fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), StateVectorError> {
        let is = |qubits: &[Qubit]| check_qubits(qubits, self.qubits);
        match gate {
            QuantumGate::X(t) => is(&[t]).and_then(|()| self.wait(Local::X(t))),
            QuantumGate::Cx(a, t) => is(&[a, t]).and_then(|()| self.wait(Local::Cx(a, t))),
            QuantumGate::Ccx(a, b, t) => {
                is(&[a, b, t]).and_then(|()| self.wait(Local::Ccx(a, b, t)))
            }
            QuantumGate::Phase { turns, on } => {
                is(on)?;
                let [re, im] = turns.factor();
                self.wait(Local::Phase(Complex::new(re, im), on.into()))
            }
            QuantumGate::H(t) => {
                is(&[t])?;
                if self.hadamards.contains(&t) {
                    self.run_waiting()?;
                }
                self.hadamards.push(t);
                Ok(())
            }
            QuantumGate::Ry { angle, target } => {
                is(&[target])?;
                if !angle.is_finite() {
                    return Err(StateVectorError::Angle(angle));
                }
                self.run_waiting()?;
                let matrix = super::dense::rotation(angle);
                self.mix(&[target], Kernel::Rotate { target: 0, matrix })
            }
        }
    }

    fn distribution(&mut self, register: &[Qubit]) -> Result<Vec<f64>, StateVectorError> {
        let bits = register.len() as u32;
        if bits > LISTED {
            return Err(StateVectorError::RegisterTooWide { bits, most: LISTED });
        }
        let values = self.values(register)?;
        let mut sums = filled(0.0, 1 << bits)?;
        let amplitudes = self.blocks.iter().flat_map(|block| &block.amplitudes);
        for (value, amplitude) in values.into_iter().zip(amplitudes) {
            sums[value as usize] += amplitude.norm_sqr();
        }
        let scale = self.scale();
        Ok(sums.into_iter().map(|sum| sum * scale * scale).collect())
    }

    fn excited(&mut self, qubits: &[Qubit]) -> Result<f64, StateVectorError> {
        check_qubits(qubits, self.qubits)?;
        self.run_waiting()?;
        let scale = self.scale();
        let sums = self.blocks.iter().map(|block| block.excited(qubits));
        Ok(sums.sum::<f64>() * scale * scale)
    }

    fn measure(&mut self, register: &[Qubit], uniform: f64) -> Result<u64, StateVectorError> {
        let outcomes = self.distribution(register)?;
        let outcome = super::draw(&outcomes, uniform)?;
        let values = self.values(register)?;
        let factor = self.scale() / outcomes[outcome].sqrt();
        self.odd = false;
        let amplitudes = self.blocks.iter_mut().flat_map(|b| &mut b.amplitudes);
        for (value, amplitude) in values.into_iter().zip(amplitudes) {
            *amplitude *= if value as usize == outcome {
                factor
            } else {
                0.0
            };
        }
        // Mixing no qubits drops the states that were not read, because they have no amplitude any
        // more.
        let none = Kernel::Hadamards {
            mask: 0,
            scale: 1.0,
        };
        self.mix(&[], none)?;
        Ok(outcome as u64)
    }

    fn norm(&mut self) -> Result<f64, StateVectorError> {
        self.run_waiting()?;
        let scale = self.scale();
        let sums = self.blocks.iter().map(|block| {
            let squares = block.amplitudes.iter().map(Complex::norm_sqr);
            squares.sum::<f64>()
        });
        Ok(sums.sum::<f64>() * scale * scale)
    }
}
