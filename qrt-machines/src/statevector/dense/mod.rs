//! All amplitudes: `2^qubits` of them.

mod kernels;
mod plan;

pub(super) use kernels::{Kernel, OnChunk};
pub(super) use plan::rotation;

use super::error::{check_qubits, filled};
use super::{StateVector, StateVectorError};
use crate::InstructionSet;
use kernels::{Butterfly, rotate_halves, runs};
use num_complex::Complex;
use plan::Plan;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::QuantumGate;
use rayon::prelude::*;

/// Largest number of qubits: 1 GiB of amplitudes.
const MOST_QUBITS: u32 = 26;

/// Smallest and largest number of a chunk's qubits: 16 KiB, which the nearest cache holds, and 512
/// KiB, which the next cache holds.
const CHUNK: [u32; 2] = [10, 15];

/// Largest number of gates that wait.
const WAITING: usize = 4096;

/// The dense machine: a state vector of up to 26 qubits, on all cores.
///
/// The machine executes every gate on every amplitude that it concerns. It saves memory traffic and
/// multiplications by one:
///
/// * Gates wait until there are some thousands, or until a result is read. A run of gates whose
///   targets lie within a *chunk* of 2^10 to 2^15 amplitudes is executed chunk by chunk, all gates
///   on one chunk before the next; controls and phases may be on any qubits. Only a gate with a
///   target above goes through memory alone.
/// * Adjacent Hadamards on different qubits are one fast Walsh-Hadamard transform: their additions,
///   two levels per pass. Their factors `1/sqrt(2)` are applied in pairs.
/// * An X renames indices: it changes a mask, with which the machine reads the indices of later
///   gates.
/// * A controlled gate touches only the amplitudes where its controls are 1, and a phase only those
///   that it changes. Phases of a whole chunk are first multiplied with each other.
///
/// The results are the same bytes for any number of threads and any instruction set.
///
/// ```
/// use qrt_circuit::quantum::QuantumGate::{Cx, H};
/// use qrt_machines::statevector::{Dense, StateVector};
/// let mut bell = Dense::new(2)?;
/// bell.gate(H(0))?;
/// bell.gate(Cx(0, 1))?;
/// let both = bell.distribution(&[0, 1])?;
/// assert!((both[0] - 0.5).abs() < 1e-15 && (both[3] - 0.5).abs() < 1e-15);
/// assert_eq!(both[1] + both[2], 0.0);
/// # Ok::<(), qrt_machines::statevector::StateVectorError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Dense {
    qubits: u32,
    amplitudes: Vec<Complex<f64>>,
    plan: Plan,
    instructions: InstructionSet,
}

impl Dense {
    /// The most qubits that a dense state vector may have.
    pub const MOST_QUBITS: u32 = MOST_QUBITS;

    /// Creates the basis state in which all qubits are zero.
    ///
    /// # Errors
    /// If there are more than [`Dense::MOST_QUBITS`] qubits, or there is not enough memory.
    pub fn new(qubits: u32) -> Result<Self, StateVectorError> {
        if qubits > MOST_QUBITS {
            return Err(StateVectorError::TooManyQubits {
                qubits,
                most: MOST_QUBITS,
            });
        }
        // Kernels take eight amplitudes at a time.
        let mut amplitudes = filled(Complex::new(0.0, 0.0), 1 << qubits.max(3))?;
        amplitudes[0] = Complex::new(1.0, 0.0);
        Ok(Self {
            qubits,
            amplitudes,
            plan: Plan::default(),
            instructions: InstructionSet::widest(),
        })
    }

    /// Sets the instruction set.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// The amplitude of a basis state: bit q of `state` is qubit q.
    ///
    /// # Panics
    /// If `state` has bits beyond the machine's qubits.
    pub fn amplitude(&mut self, state: u64) -> Complex<f64> {
        assert!(state >> self.qubits == 0, "a state of other qubits");
        self.run_waiting();
        self.amplitudes[state as usize ^ self.plan.frame] * self.plan.scale()
    }

    /// Executes the gates that wait.
    fn run_waiting(&mut self) {
        let steps = self.plan.take_steps();
        let mut rest = &steps[..];
        while let Some(first) = rest.first() {
            let reach = |step: &Kernel| usize::BITS - step.targets().leading_zeros();
            let bits = self.amplitudes.len().ilog2();
            let most = CHUNK[1].min(bits);
            let count = rest.iter().take_while(|step| reach(step) <= most).count();
            if count == 0 {
                self.run_far(*first);
                rest = &rest[1..];
                continue;
            }
            let (near, after) = rest.split_at(count);
            let widest = near.iter().map(reach).max().unwrap_or(0);
            let bits = widest.clamp(CHUNK[0].min(bits), most);
            let set = self.instructions;
            let chunks = self.amplitudes.par_chunks_mut(1 << bits);
            chunks.enumerate().for_each(|(place, chunk)| {
                let base = place << bits;
                set.dispatch(OnChunk {
                    steps: near,
                    chunk,
                    base,
                });
            });
            rest = after;
        }
    }

    /// Executes a step with a target beyond chunks.
    fn run_far(&mut self, step: Kernel) {
        let set = self.instructions;
        match step {
            Kernel::Hadamards { mask, scale } => {
                let within = mask & ((1 << CHUNK[1]) - 1);
                let mut far = mask ^ within;
                while far != 0 {
                    let bit = far.trailing_zeros();
                    far &= far - 1;
                    let scale = if far | within == 0 { scale } else { 1.0 };
                    self.halves(bit, |low, high, _| {
                        set.dispatch(Butterfly { low, high, scale });
                    });
                }
                if within != 0 {
                    let near = [Kernel::Hadamards {
                        mask: within,
                        scale,
                    }];
                    self.amplitudes
                        .par_chunks_mut(1 << CHUNK[1])
                        .for_each(|chunk| {
                            set.dispatch(OnChunk {
                                steps: &near,
                                chunk,
                                base: 0,
                            });
                        });
                }
            }
            Kernel::Rotate { target, matrix } => {
                self.halves(target, |low, high, _| rotate_halves(low, high, &matrix));
            }
            Kernel::Flip {
                target,
                mask,
                value,
            } => self.halves(target, |low, high, base| {
                let within = low.len() - 1;
                if (base ^ value) & mask & !within != 0 {
                    return;
                }
                let (mask, value) = (mask & within, value & within);
                if mask == 0 {
                    low.swap_with_slice(high);
                    return;
                }
                let run = mask & mask.wrapping_neg();
                runs(low.len(), mask, value, |first| {
                    low[first..first + run].swap_with_slice(&mut high[first..first + run]);
                });
            }),
            Kernel::Phase { .. } => {}
        }
    }

    /// Calls `each` for equal chunks of the two halves that a qubit beyond chunks distinguishes,
    /// with the index of the first chunk's first amplitude.
    fn halves(
        &mut self,
        target: u32,
        each: impl Fn(&mut [Complex<f64>], &mut [Complex<f64>], usize) + Sync,
    ) {
        let half = 1 << target;
        let blocks = self.amplitudes.par_chunks_mut(2 * half).enumerate();
        blocks.for_each(|(block, amplitudes)| {
            let (low, high) = amplitudes.split_at_mut(half);
            let size = 1 << CHUNK[0];
            let chunks = low.par_chunks_mut(size).zip(high.par_chunks_mut(size));
            chunks.enumerate().for_each(|(place, (low, high))| {
                each(low, high, block * 2 * half + place * size);
            });
        });
    }

    /// Sums the squares of amplitudes by the value of `place` for their index. The sum is in the
    /// order of memory.
    fn sums(&mut self, places: usize, place: impl Fn(usize) -> usize) -> Vec<f64> {
        self.run_waiting();
        let (frame, scale) = (self.plan.frame, self.plan.scale());
        let mut sums = vec![0.0; places];
        // In runs, so that long sums do not lose their last bits.
        let mut parts = vec![0.0; places];
        for (block, chunk) in self.amplitudes.chunks(1 << CHUNK[0]).enumerate() {
            for (offset, amplitude) in chunk.iter().enumerate() {
                parts[place((block << CHUNK[0] | offset) ^ frame)] += amplitude.norm_sqr();
            }
            if places <= chunk.len() {
                drain(&mut sums, &mut parts);
            }
        }
        drain(&mut sums, &mut parts);
        for sum in &mut sums {
            *sum *= scale * scale;
        }
        sums
    }
}

fn drain(sums: &mut [f64], parts: &mut [f64]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        *sum += std::mem::take(part);
    }
}

/// The value of a register in a basis state.
fn value(register: &[Qubit], state: usize) -> usize {
    let bits = register.iter().enumerate();
    bits.fold(0, |value, (place, qubit)| {
        value | (state >> qubit & 1) << place
    })
}

impl StateVector for Dense {
    fn qubits(&self) -> u32 {
        self.qubits
    }

    fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), StateVectorError> {
        self.plan.gate(gate, self.qubits)?;
        if self.plan.len() >= WAITING {
            self.run_waiting();
        }
        Ok(())
    }

    fn distribution(&mut self, register: &[Qubit]) -> Result<Vec<f64>, StateVectorError> {
        check_qubits(register, self.qubits)?;
        Ok(self.sums(1 << register.len(), |state| value(register, state)))
    }

    fn excited(&mut self, qubits: &[Qubit]) -> Result<f64, StateVectorError> {
        check_qubits(qubits, self.qubits)?;
        let mask = qubits.iter().fold(0, |mask, qubit| mask | 1 << qubit);
        Ok(self.sums(2, |state| usize::from(state & mask != 0))[1])
    }

    fn measure(&mut self, register: &[Qubit], uniform: f64) -> Result<u64, StateVectorError> {
        let outcomes = self.distribution(register)?;
        let outcome = super::draw(&outcomes, uniform)?;
        let factor = 1.0 / outcomes[outcome].sqrt();
        let frame = self.plan.frame;
        for (index, amplitude) in self.amplitudes.iter_mut().enumerate() {
            *amplitude *= if value(register, index ^ frame) == outcome {
                factor
            } else {
                0.0
            };
        }
        Ok(outcome as u64)
    }

    fn norm(&mut self) -> Result<f64, StateVectorError> {
        Ok(self.sums(1, |_| 0)[0])
    }
}
