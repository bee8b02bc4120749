//! Tables without garbage: unary iteration.
//!
//! A walk over the tree of addresses (Babbush et al. 2018) holds the conjunction of the bits on its
//! path in one ancilla a level. The way from a node to its two children takes an AND, the way from
//! one child to the other a CNOT, and the way back another AND: `2 (2^k - 2)` Toffolis. Wider words
//! cost no more. Subtrees of equal entries are not walked.

use super::{GateSink, Lowering, Qubit, Wire};
use std::sync::Arc;

/// The entries of a subtree, by index.
type Range = std::ops::Range<usize>;

fn entry(column: &[i64], place: usize) -> i64 {
    column.get(place).or(column.last()).copied().unwrap_or(0)
}

/// Returns the two halves of a subtree. `None` if they are equal.
fn halves(columns: &[Arc<[i64]>], masks: &[i64], range: &Range) -> Option<[Range; 2]> {
    let middle = range.start.midpoint(range.end);
    let half = middle - range.start;
    let differ = |place: usize| {
        let pairs = columns.iter().zip(masks);
        pairs
            .into_iter()
            .any(|(column, mask)| (entry(column, place) ^ entry(column, place + half)) & mask != 0)
    };
    let split = (range.start..middle).any(differ);
    split.then_some([range.start..middle, middle..range.end])
}

/// Returns the masks of the bits of entries that matter, by column.
fn masks(columns: usize, width: impl Fn(usize) -> usize) -> Vec<i64> {
    let mask = |column| match width(column) {
        width @ 0..64 => (1_i64 << width) - 1,
        _ => -1,
    };
    (0..columns).map(mask).collect()
}

fn all_zero(columns: &[Arc<[i64]>], masks: &[i64], range: &Range) -> bool {
    // Plain loops: in unoptimised code, as in a macro, iterators take longer.
    let mut which = 0;
    while which < columns.len() {
        let (column, mask) = (&columns[which], masks[which]);
        let mut place = range.start;
        while place < range.end {
            if entry(column, place) & mask != 0 {
                return false;
            }
            place += 1;
        }
        which += 1;
    }
    true
}

impl Lowering {
    pub(super) fn walk(
        &mut self,
        mut address: Vec<Wire>,
        columns: &[Arc<[i64]>],
        targets: &[Vec<Qubit>],
    ) {
        let copies = self.detach(&mut address, &[]);
        let masks = masks(columns.len(), |column| targets[column].len());
        let range = 0..1 << address.len();
        self.visit(&address, columns, &masks, targets, range, None);
        self.attach(copies);
    }

    /// XORs the entries of `range` into the targets where `held` is 1; on all paths if it is
    /// `None`.
    fn visit(
        &mut self,
        address: &[Wire],
        columns: &[Arc<[i64]>],
        masks: &[i64],
        targets: &[Vec<Qubit>],
        range: Range,
        held: Option<Qubit>,
    ) {
        if all_zero(columns, masks, &range) {
            return;
        }
        if range.len() == 1 {
            for (column, target) in columns.iter().zip(targets) {
                let entry = entry(column, range.start);
                for (place, qubit) in target.iter().enumerate() {
                    if entry >> place.min(63) & 1 == 1 {
                        match held {
                            Some(held) => self.cx(held, *qubit),
                            None => self.x(*qubit),
                        }
                    }
                }
            }
            return;
        }
        let Some([low, high]) = halves(columns, masks, &range) else {
            let one = range.start..range.start.midpoint(range.end);
            self.visit(address, columns, masks, targets, one, held);
            return;
        };
        let level = range.len().ilog2() as usize - 1;
        let bit = address[level];
        let Some(source) = bit.source() else {
            // An address bit that is the same on all paths.
            let taken = if bit == Wire::ONE { high } else { low };
            self.visit(address, columns, masks, targets, taken, held);
            return;
        };
        let at = match held {
            None => source,
            Some(_) => self.pool.allocate(),
        };
        // `at` holds: the path is in the upper half.
        self.flip(bit, source);
        if let Some(held) = held {
            self.ccx(held, source, at);
        }
        self.visit(address, columns, masks, targets, high, Some(at));
        // `at` now holds: the path is in the lower half.
        match held {
            Some(held) => self.cx(held, at),
            None => self.x(at),
        }
        self.visit(address, columns, masks, targets, low, Some(at));
        match held {
            Some(held) => {
                self.cx(held, at);
                self.ccx(held, source, at);
                self.pool.free(at);
            }
            None => self.x(at),
        }
        self.flip(bit, source);
    }
}
