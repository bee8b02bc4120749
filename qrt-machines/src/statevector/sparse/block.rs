//! A block of basis states, bit-sliced.

use crate::transpose::transpose;
use num_complex::Complex;
use pulp::{Simd, WithSimd};
use qrt_circuit::Qubit;

/// Number of states of a block.
pub(super) const STATES: usize = 2048;

/// Number of words of a row.
pub(super) const WORDS: usize = STATES / 64;

/// A qubit of all states of a block, a bit each.
pub(super) type Row = [u64; WORDS];

/// A gate that does not mix states.
#[derive(Clone, Debug)]
pub(super) enum Local {
    X(Qubit),
    Cx(Qubit, Qubit),
    Ccx(Qubit, Qubit, Qubit),
    /// A factor where all of these qubits are 1.
    Phase(Complex<f64>, Box<[Qubit]>),
}

/// Up to [`STATES`] states. The lanes after the last state are not states, whatever their rows
/// hold.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// By qubit: its bit in every state.
    pub(super) rows: Vec<Row>,
    /// By state: its amplitude.
    pub(super) amplitudes: Vec<Complex<f64>>,
}

impl Block {
    /// The state of all zeros.
    pub(super) fn zero(qubits: u32) -> Self {
        Self {
            rows: vec![[0; WORDS]; qubits as usize],
            amplitudes: vec![Complex::new(1.0, 0.0)],
        }
    }

    /// The lanes of a word that are states.
    pub(super) fn lanes(&self, word: usize) -> u64 {
        match self.amplitudes.len().saturating_sub(64 * word) {
            0 => 0,
            left @ 1..64 => (1 << left) - 1,
            _ => u64::MAX,
        }
    }

    /// Sets `values` to the contents of a register of up to 64 qubits, state by state.
    pub(super) fn values(&self, register: &[Qubit], values: &mut [u64]) {
        for (word, values) in values.chunks_mut(64).enumerate() {
            let mut square = [0; 64];
            for (bits, qubit) in square.iter_mut().zip(register) {
                *bits = self.rows[*qubit as usize][word];
            }
            transpose(&mut square);
            values.copy_from_slice(&square[..values.len()]);
        }
    }

    /// Returns whether a qubit is 0 in every state, and whether it is 1 in every state.
    pub(super) fn constant(&self, qubit: usize) -> [bool; 2] {
        let (mut ones, mut zeros) = (0, 0);
        for (word, bits) in self.rows[qubit].iter().enumerate() {
            let lanes = self.lanes(word);
            ones |= bits & lanes;
            zeros |= !bits & lanes;
        }
        [ones == 0, zeros == 0]
    }

    /// The sum of the squares of amplitudes of the states in which one of `qubits` is 1.
    pub(super) fn excited(&self, qubits: &[Qubit]) -> f64 {
        let mut sum = 0.0;
        for word in 0..WORDS {
            let rows = qubits.iter().map(|qubit| self.rows[*qubit as usize][word]);
            let mut any = rows.fold(0, |any, bits| any | bits) & self.lanes(word);
            while any != 0 {
                let lane = any.trailing_zeros() as usize;
                any &= any - 1;
                sum += self.amplitudes[64 * word + lane].norm_sqr();
            }
        }
        sum
    }
}

/// Runs gates on a block, one after another.
pub(super) struct RunBlock<'a> {
    pub(super) steps: &'a [Local],
    pub(super) block: &'a mut Block,
}

impl WithSimd for RunBlock<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Block { rows, amplitudes } = self.block;
        for step in self.steps {
            match step {
                Local::X(t) => {
                    for word in &mut rows[*t as usize] {
                        *word = !*word;
                    }
                }
                Local::Cx(a, t) => {
                    let a = rows[*a as usize];
                    for (word, a) in rows[*t as usize].iter_mut().zip(a) {
                        *word ^= a;
                    }
                }
                Local::Ccx(a, b, t) => {
                    let (a, b) = (rows[*a as usize], rows[*b as usize]);
                    for ((word, a), b) in rows[*t as usize].iter_mut().zip(a).zip(b) {
                        *word ^= a & b;
                    }
                }
                Local::Phase(factor, on) => {
                    let mut all = [u64::MAX; WORDS];
                    for qubit in on {
                        for (all, bits) in all.iter_mut().zip(rows[*qubit as usize]) {
                            *all &= bits;
                        }
                    }
                    multiply(amplitudes, &all, *factor);
                }
            }
        }
    }
}

/// Multiplies the amplitudes of `lanes` by `factor`.
fn multiply(amplitudes: &mut [Complex<f64>], lanes: &Row, factor: Complex<f64>) {
    let sign = factor == Complex::new(-1.0, 0.0);
    for (amplitudes, &lanes) in amplitudes.chunks_mut(64).zip(lanes) {
        let mut left = lanes;
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let Some(amplitude) = amplitudes.get_mut(lane) else {
                break;
            };
            *amplitude = if sign {
                -*amplitude
            } else {
                *amplitude * factor
            };
        }
    }
}
