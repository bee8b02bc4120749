//! States, bit-sliced: a row of bits for each qubit.

use super::compile::Wiring;
use crate::PixelLanes;
use crate::transpose::transpose;
use qrt_circuit::Qubit;
use std::fmt;

/// Largest number of states that a machine's rows hold.
///
/// Longer rows hide the time between the write and the next read of a row, and the time to choose
/// the pattern to execute; shorter ones fit a nearer cache. On a Zen 5 core with 32 MB of cache, in
/// 1e11 lane-gates a second at 512, 1024 and 2048 lanes: the box under `scoped` (1,386 qubits) 5.2,
/// 8.7 and 13.2; under `keep` (39,277) 9.2, 14.4 and 19.2; `cornell-glass` under `keep` (143,923)
/// 9.3, 10.3 and 8.4, where the longest rows take 37 MB. On two Xeon cores at once, with 2 MB of cache each and
/// 105 MB shared: `cornell-mirror` under `keep` (65,678) 4.3, 4.2 and 8.8, where the longest take
/// 17 MB.
pub(super) const LANES: usize = 2048;

/// The possible numbers of words of a row.
pub(super) const LENGTHS: [usize; 4] = [LANES / 64, LANES / 128, LANES / 256, FEW_WORDS];

/// Number of words of a row if there are very many qubits whose gates are not held.
pub(super) const FEW_WORDS: usize = 4;

/// Bytes of a machine's rows above which the rows are made shorter: each thread has rows of its
/// own, and a few threads share the last cache.
const MOST_BYTES: usize = 18 << 20;

/// Number of words of a row for `rows` rows: the first of the lengths that fits into
/// [`MOST_BYTES`], or else the third.
pub(super) fn words_of(rows: usize) -> usize {
    let [long, middle, short, _] = LENGTHS;
    let fit = |words: &usize| rows * words * size_of::<u64>() <= MOST_BYTES;
    [long, middle].into_iter().find(fit).unwrap_or(short)
}

/// Number of words of a row for `rows` rows: [`words_of`] if the rows then fit into `bytes` bytes,
/// or else [`FEW_WORDS`].
pub(super) fn words_of_many(rows: usize, bytes: usize) -> usize {
    let words = words_of(rows);
    let fits = rows * words * size_of::<u64>() <= bytes;
    if fits { words } else { FEW_WORDS }
}

/// Number of times that `rows` rows of `words` words fit into `bytes` bytes, at least 1.
pub(super) fn at_once(rows: usize, words: usize, bytes: usize) -> usize {
    (bytes / (rows * words * size_of::<u64>())).max(1)
}

/// Alignment of rows, in words: a cache line. Vectors across two lines halve the speed.
const LINE: usize = 8;

/// A qubit that is not zero where it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dirty {
    /// The number of the qubit.
    pub qubit: Qubit,
    /// The first lane in which the qubit is not zero.
    pub lane: usize,
}

impl fmt::Display for Dirty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "qubit {} is not zero in lane {}", self.qubit, self.lane)
    }
}

/// [`super::GatesMachine::lanes`] states: their qubits, the signs of their amplitudes, and the
/// classical parameters of their pixels.
#[derive(Debug)]
pub struct Rows {
    words: Vec<u64>,
    start: usize,
    /// Words of a row.
    length: usize,
    wiring: Wiring,
}

impl Rows {
    pub(super) fn new(wiring: &Wiring, length: usize) -> Self {
        let words = vec![0; wiring.rows() * length + LINE];
        Self {
            start: words.as_ptr().align_offset(LINE * size_of::<u64>()) % LINE,
            words,
            length,
            wiring: wiring.clone(),
        }
    }

    pub(super) fn all(&mut self) -> &mut [u64] {
        &mut self.words[self.start..][..self.wiring.rows() * self.length]
    }

    fn row(&self, row: u32) -> &[u64] {
        &self.words[self.start..][row as usize * self.length..][..self.length]
    }

    fn row_mut(&mut self, row: u32) -> &mut [u64] {
        &mut self.words[self.start..][row as usize * self.length..][..self.length]
    }

    /// Sets `qubits`, bit 0 first, to the bits of `values`, one value per lane. The remaining lanes
    /// hold the last value, so that every lane holds a state that occurs.
    ///
    /// # Panics
    /// If there are more than 64 qubits, or one that the circuits do not have.
    pub fn set(&mut self, qubits: &[Qubit], values: &[u64]) {
        assert!(qubits.len() <= 64, "a value has 64 bits");
        let last = values.last().copied().unwrap_or(0);
        for word in 0..self.length {
            let mut square = [last; 64];
            let values = values.iter().skip(64 * word);
            for (slot, value) in square.iter_mut().zip(values) {
                *slot = *value;
            }
            transpose(&mut square);
            for (qubit, bits) in qubits.iter().zip(square) {
                self.row_mut(*qubit)[word] = bits;
            }
        }
    }

    /// Reads `qubits`, bit 0 first, as one unsigned number per lane, in the first `values.len()`
    /// lanes.
    ///
    /// # Panics
    /// If there are more than 64 qubits or [`super::GatesMachine::lanes`] values, or a qubit that
    /// the circuits do not have.
    pub fn get(&self, qubits: &[Qubit], values: &mut [u64]) {
        assert!(qubits.len() <= 64, "a value has 64 bits");
        for (word, values) in values.chunks_mut(64).enumerate() {
            let mut square = [0; 64];
            for (bits, qubit) in square.iter_mut().zip(qubits) {
                *bits = self.row(*qubit)[word];
            }
            transpose(&mut square);
            values.copy_from_slice(&square[..values.len()]);
        }
    }

    /// A qubit in all lanes: bit `lane % 64` of word `lane / 64`.
    pub fn bits(&self, qubit: Qubit) -> &[u64] {
        self.row(qubit)
    }

    /// As [`Rows::bits`], but mutable.
    pub fn bits_mut(&mut self, qubit: Qubit) -> &mut [u64] {
        self.row_mut(qubit)
    }

    /// Sets the classical parameters to those of the spans' pixels, lane after lane from 0 on. The
    /// remaining lanes belong to the last span.
    pub fn set_parameters(&mut self, spans: &[PixelLanes<'_>]) {
        let lanes = 64 * self.length;
        for (parameter, bit, row) in self.wiring.clone().parameters() {
            let words = self.row_mut(row);
            words.fill(0);
            let mut first = 0;
            for (place, span) in spans.iter().enumerate() {
                let last = place + 1 == spans.len();
                let end = if last { lanes } else { first + span.lanes };
                if span.parameters[parameter] >> bit & 1 == 1 {
                    set_lanes(words, first, end.min(lanes));
                }
                first = end;
            }
        }
    }

    /// The lanes whose phase is flipped: bit `lane % 64` of word `lane / 64`.
    pub fn signs(&self) -> &[u64] {
        self.row(self.wiring.sign())
    }

    /// The first qubit other than `held` that is not zero in one of the lanes `0..lanes`, if any.
    pub fn dirty(&self, held: &[Qubit], lanes: usize) -> Option<Dirty> {
        let mut free = vec![true; self.wiring.qubits() as usize];
        for qubit in held {
            free[*qubit as usize] = false;
        }
        (0..self.wiring.qubits()).find_map(|qubit| {
            // Without branches in the usual case that all rows are zero.
            if !free[qubit as usize] || self.row(qubit).iter().fold(0, |any, w| any | w) == 0 {
                return None;
            }
            let words = self.row(qubit).iter().enumerate();
            let mut ones = words.filter(|(_, word)| **word != 0);
            let lane = ones.next().map(|(place, word)| {
                let bit = word.trailing_zeros() as usize;
                64 * place + bit
            })?;
            (lane < lanes).then_some(Dirty { qubit, lane })
        })
    }

    /// Zeroes all qubits and signs.
    pub fn clear(&mut self) {
        let rows = self.wiring.sign() as usize + 1;
        let words = rows * self.length;
        self.all()[..words].fill(0);
    }
}

/// Sets bits `first..end`.
fn set_lanes(words: &mut [u64], first: usize, end: usize) {
    for (place, word) in words.iter_mut().enumerate() {
        let low = first.clamp(64 * place, 64 * place + 64) - 64 * place;
        let high = end.clamp(64 * place, 64 * place + 64) - 64 * place;
        let below = |bits: usize| u64::MAX.checked_shr(64 - bits as u32).unwrap_or(0);
        *word |= below(high) & !below(low);
    }
}
