//! Gates that mix states.

use super::super::dense::{Kernel, OnChunk};
use super::super::error::filled;
use super::block::{Block, Row, STATES, WORDS};
use super::{Sparse, StateVectorError};
use crate::transpose::transpose;
use num_complex::Complex;
use qrt_circuit::Qubit;
use rayon::prelude::*;
use std::collections::HashMap;

/// Keys that distinguish states.
struct Keys {
    /// The qubits that are not the same in all states, except the mixed ones.
    live: Vec<Qubit>,
    /// Number of words of a key.
    words: usize,
    /// State by state: the words of its key.
    all: Vec<u64>,
    /// State by state: the content of the mixed qubits.
    subs: Vec<u64>,
}

/// States that differ only in the mixed qubits.
struct Groups {
    /// Group by group: the words of its key.
    keys: Vec<u64>,
    /// State by state: its group.
    of: Vec<usize>,
    count: usize,
}

impl Sparse {
    /// Applies `step` to the qubits `mixed`, which are its qubits 0, 1, ..., and drops amplitudes
    /// that are too small.
    pub(super) fn mix(&mut self, mixed: &[Qubit], step: Kernel) -> Result<(), StateVectorError> {
        self.run_local();
        let keys = self.keys(mixed)?;
        let groups = grouped(&keys)?;
        let bits = mixed.len() as u32;
        let total = (groups.count as u64) << bits;
        if total > self.most {
            return Err(StateVectorError::TooManyStates {
                states: total,
                most: self.most,
            });
        }
        // Kernels take eight amplitudes at a time.
        let size = 1 << bits.max(3);
        let zero = Complex::new(0.0, 0.0);
        let mut dense = filled(zero, groups.count * size)?;
        let old = self.blocks.iter().flat_map(|block| &block.amplitudes);
        let places = groups.of.iter().zip(&keys.subs);
        for ((group, sub), amplitude) in places.zip(old) {
            dense[group * size + *sub as usize] = *amplitude;
        }
        let set = self.instructions;
        dense.par_chunks_mut(size).for_each(|chunk| {
            set.dispatch(OnChunk {
                steps: &[step],
                chunk,
                base: 0,
            });
        });

        let scale = self.scale();
        let least = self.bound / scale;
        let mut kept = Vec::new();
        let mut dropped = 0.0;
        for (place, amplitude) in dense.iter().enumerate() {
            let square = amplitude.norm_sqr();
            if square > least * least {
                kept.push(place);
            } else {
                dropped += square;
            }
        }
        self.dropped += dropped * scale * scale;
        let template = self.template(mixed, &keys.live);
        let blocks = kept.par_chunks(STATES).map(|places| Block {
            amplitudes: places.iter().map(|place| dense[*place]).collect(),
            rows: rows(&template, &keys, &groups, mixed, size, places),
        });
        self.blocks = blocks.collect();
        self.states = kept.len();
        self.peak = self.peak.max(self.states as u64);
        Ok(())
    }

    fn keys(&self, mixed: &[Qubit]) -> Result<Keys, StateVectorError> {
        let qubits: Vec<Qubit> = (0..self.qubits).collect();
        let live = qubits.into_par_iter().filter(|qubit| {
            let mut same = [true; 2];
            for block in &self.blocks {
                let own = block.constant(*qubit as usize);
                same = [same[0] && own[0], same[1] && own[1]];
            }
            same == [false; 2] && !mixed.contains(qubit)
        });
        let live: Vec<Qubit> = live.collect();
        let words = live.len().div_ceil(64).max(1);
        let mut keys = filled(0, self.states * words)?;
        let mut subs = filled(0, self.states)?;
        let parts = keys.par_chunks_mut(STATES * words);
        let parts = parts.zip(subs.par_chunks_mut(STATES));
        parts.zip(&self.blocks).for_each(|((keys, subs), block)| {
            block.values(mixed, subs);
            let mut one = vec![0; subs.len()];
            for (word, register) in live.chunks(64).enumerate() {
                block.values(register, &mut one);
                for (state, value) in one.iter().enumerate() {
                    keys[state * words + word] = *value;
                }
            }
        });
        Ok(Keys {
            live,
            words,
            all: keys,
            subs,
        })
    }

    /// Rows of the qubits that are the same in all states.
    fn template(&self, mixed: &[Qubit], live: &[Qubit]) -> Vec<Row> {
        let first = |qubit: usize| {
            let block = self.blocks.first();
            block.is_some_and(|block| block.rows[qubit][0] & 1 == 1)
        };
        let mut rows: Vec<Row> = (0..self.qubits as usize)
            .map(|qubit| [if first(qubit) { u64::MAX } else { 0 }; WORDS])
            .collect();
        for qubit in mixed.iter().chain(live) {
            rows[*qubit as usize] = [0; WORDS];
        }
        rows
    }
}

/// Creates the groups, in the order in which states first show them.
fn grouped(keys: &Keys) -> Result<Groups, StateVectorError> {
    let mut of = filled(0, keys.subs.len())?;
    let mut found: HashMap<&[u64], usize> = HashMap::new();
    let mut all = Vec::new();
    let mut last: Option<(&[u64], usize)> = None;
    for (key, of) in keys.all.chunks_exact(keys.words).zip(&mut of) {
        // Neighbouring states are mostly of one group.
        *of = match last {
            Some((known, group)) if known == key => group,
            _ => {
                let next = found.len();
                *found.entry(key).or_insert_with(|| {
                    all.extend_from_slice(key);
                    next
                })
            }
        };
        last = Some((key, *of));
    }
    Ok(Groups {
        count: found.len(),
        keys: all,
        of,
    })
}

/// Rows of the states at `places` among the groups' amplitudes.
fn rows(
    template: &[Row],
    keys: &Keys,
    groups: &Groups,
    mixed: &[Qubit],
    size: usize,
    places: &[usize],
) -> Vec<Row> {
    let mut rows = template.to_vec();
    for (word, places) in places.chunks(64).enumerate() {
        let mut write = |register: &[Qubit], value: &dyn Fn(usize) -> u64| {
            let mut square = [0; 64];
            for (slot, place) in square.iter_mut().zip(places) {
                *slot = value(*place);
            }
            transpose(&mut square);
            for (qubit, bits) in register.iter().zip(square) {
                rows[*qubit as usize][word] = bits;
            }
        };
        write(mixed, &|place| (place % size) as u64);
        for (part, register) in keys.live.chunks(64).enumerate() {
            write(register, &|place| {
                groups.keys[place / size * keys.words + part]
            });
        }
    }
    rows
}
