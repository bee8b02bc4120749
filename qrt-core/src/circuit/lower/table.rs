//! Tables (QROM).
//!
//! The address's high bits are decoded into one-hot qubits by doubling: with each bit b, every
//! qubit splits into itself without b and a new one with b. As one of them is 1, the last one of a
//! level follows from b and the others by CNOTs: `2^h - h - 1` Toffolis in all, and no more for
//! wider words. (Babbush et al. 2018 walk the same tree one path at a time, with few qubits.) The
//! low address bits select among `2^l` words that are looked up together (Low, Kliuchnikov &
//! Schaeffer 2018), for a Toffoli a bit and word beyond the first.

use super::wires::{Bit, Wires};
use crate::circuit::Qubit;

impl Wires<'_> {
    /// The one-hot qubits of `address`, those below `count`.
    fn one_hot(&mut self, address: &[Bit], count: usize) -> Vec<Bit> {
        let mut hot = vec![Bit::Constant(true)];
        for (level, &bit) in address.iter().enumerate() {
            let old = 1_usize << level;
            let made = count.saturating_sub(old).min(old);
            let mut upper = Vec::with_capacity(made);
            for (place, &below) in hot.iter().enumerate().take(made) {
                let qubit = self.fresh();
                if place + 1 == old {
                    // b less the others.
                    self.add_bit(bit, qubit);
                    for &other in &upper {
                        self.add_bit(other, qubit);
                    }
                } else {
                    self.and(below, bit, qubit);
                }
                upper.push(Bit::of(qubit));
            }
            for (place, &high) in upper.iter().enumerate() {
                match hot[place] {
                    Bit::Constant(_) => {
                        // 1 less b, in a qubit of its own.
                        let qubit = self.fresh();
                        self.add_bit(bit.not(), qubit);
                        hot[place] = Bit::of(qubit);
                    }
                    Bit::Qubit { qubit, .. } => self.add_bit(high, qubit),
                }
            }
            hot.extend(upper);
        }
        hot
    }

    /// Looks words of `targets`' widths up. Entries are in two's complement.
    pub(super) fn table(
        &mut self,
        address: &[Bit],
        columns: &[Box<[i64]>],
        low: usize,
        targets: &[Vec<Qubit>],
    ) {
        let low = low.min(address.len());
        let (select, high) = address.split_at(low);
        let entries = columns.first().map_or(0, |column| column.len());
        let rows = entries.div_ceil(1 << low).max(1);
        let hot = self.one_hot(high, rows);
        for (column, target) in columns.iter().zip(targets) {
            for (place, &target) in target.iter().enumerate() {
                let bit = |entry: usize| {
                    let entry = entry.min(entries.saturating_sub(1));
                    column
                        .get(entry)
                        .is_some_and(|e| e >> place.min(63) & 1 == 1)
                };
                self.looked_up(&hot, select, &bit, target);
            }
        }
    }

    /// One bit of a table: `bit(hot row, select)`.
    fn looked_up(
        &mut self,
        hot: &[Bit],
        select: &[Bit],
        bit: &dyn Fn(usize) -> bool,
        target: Qubit,
    ) {
        let Some((&last, rest)) = select.split_last() else {
            let ones: Vec<bool> = (0..hot.len()).map(bit).collect();
            self.row_sum(hot, &ones, target);
            return;
        };
        // Without the last select bit, and what it changes.
        let half = 1_usize << rest.len();
        let spread = |entry: usize, upper: bool| {
            let (row, word) = (entry >> rest.len(), entry & (half - 1));
            (row << select.len()) | (usize::from(upper) * half) | word
        };
        let without = |entry: usize| bit(spread(entry, false));
        let change = |entry: usize| bit(spread(entry, false)) != bit(spread(entry, true));
        self.looked_up(hot, rest, &without, target);
        let all = hot.len() << rest.len();
        if (0..all).any(change) {
            let qubit = self.fresh();
            self.looked_up(hot, rest, &change, qubit);
            self.and(last, Bit::of(qubit), target);
        }
    }

    /// `target ^= sum of the hot qubits of the rows that are ones`
    fn row_sum(&mut self, hot: &[Bit], ones: &[bool], target: Qubit) {
        // One of the rows is hot: ones and zeros can change places.
        let count = ones.iter().filter(|&&one| one).count();
        let flip = 2 * count > ones.len();
        if flip {
            self.x(target);
        }
        for (&row, &one) in hot.iter().zip(ones) {
            if one != flip {
                self.add_bit(row, target);
            }
        }
    }
}

/// Toffolis of a table whose words are chosen by `low` select bits.
fn toffolis(address: u32, low: u32, columns: &[Box<[i64]>]) -> u64 {
    let entries = columns.first().map_or(0, |column| column.len());
    let rows = entries.div_ceil(1 << low).max(1) as u64;
    let high = address - low;
    let hot = rows.saturating_sub(u64::from(high) + 1);
    let mut selects = 0;
    for column in columns {
        let changing = column
            .iter()
            .fold(0, |any, entry| any | (entry ^ column[0]));
        let bits = u64::from(changing.count_ones().min(64));
        selects += bits * ((1 << low) - 1);
    }
    hot + selects
}

/// The number of select bits that makes a table cheapest.
pub(super) fn best(address: u32, columns: &[Box<[i64]>]) -> u32 {
    (0..address)
        .min_by_key(|&low| toffolis(address, low, columns))
        .unwrap_or(0)
}
