//! Cached results about operations: the plans and figures that passes compute.

use qrt_circuit::lower::{self, OpFigures, QuickMap};
use qrt_circuit::{Cores, KnownSums, Multiples, Op, Register, RegisterId};
use std::collections::HashSet;
use std::hash::BuildHasherDefault;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Cached results about operations, for all programs that are assembled from parts of one recording.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    /// The number of threads that compute the results.
    pub(crate) cores: Cores,
    /// [`lower::best_low`], by the targets of a table.
    pub(super) lows: QuickMap<Box<[RegisterId]>, u32>,
    /// By the targets of products of one number: the plan that computes them together, if that is cheaper.
    pub(super) together: QuickMap<Box<[RegisterId]>, Option<Arc<Multiples>>>,
    pub(super) sums: KnownSums,
    /// The figures of operations that are alike.
    pub(crate) alike: lower::KnownFigures,
    /// Figures of operations that no pass changes, by the first register that the operation computes.
    pub(super) of_recorded: Vec<Option<OpFigures>>,
    /// Figures of tables and products, by the registers that they compute.
    of_merged: QuickMap<Box<[RegisterId]>, OpFigures>,
}

/// A hash set for trusted keys.
pub(super) type QuickSet<T> = HashSet<T, BuildHasherDefault<lower::Quick>>;

/// Locks the cache. Entries are complete when inserted, so a poisoned lock is safe to reuse.
pub(crate) fn locked(known: &Mutex<Known>) -> MutexGuard<'_, Known> {
    known.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The place where the figures of an operation are kept.
enum Place<'a> {
    Recorded(usize),
    Merged(&'a [RegisterId]),
    /// Not kept: registers that passes add have other numbers in each program.
    Nowhere,
}

impl Known {
    /// The cost of each operation, and the width of its garbage.
    pub(crate) fn figures<'a>(
        &mut self,
        ops: impl Iterator<Item = &'a Op>,
        registers: &[Register],
    ) -> Vec<OpFigures> {
        let mut figures = Vec::new();
        let mut unknown = Vec::new();
        for op in ops {
            let place = self.place(op);
            let known = match place {
                Place::Recorded(first) => self.of_recorded[first],
                Place::Merged(targets) => self.of_merged.get(targets).copied(),
                Place::Nowhere => None,
            };
            if known.is_none() {
                unknown.push((figures.len(), op, place));
            }
            figures.push(known.unwrap_or_default());
        }
        let ops: Vec<&Op> = unknown.iter().map(|&(_, op, _)| op).collect();
        let width = |id: RegisterId| registers[id.index()].width;
        let found = self.alike.all(&ops, width, self.cores);
        for ((at, _, place), found) in unknown.into_iter().zip(found) {
            figures[at] = found;
            match place {
                Place::Recorded(first) => self.of_recorded[first] = Some(found),
                Place::Merged(targets) => {
                    self.of_merged.insert(targets.into(), found);
                }
                Place::Nowhere => {}
            }
        }
        figures
    }

    fn place<'a>(&self, op: &'a Op) -> Place<'a> {
        let mut first = None;
        op.each_target(|target| _ = first.get_or_insert(target.index()));
        let Some(first) = first.filter(|first| *first < self.of_recorded.len()) else {
            return Place::Nowhere;
        };
        match op {
            Op::Table { targets, .. } | Op::Multiples { targets, .. } => Place::Merged(targets),
            _ => Place::Recorded(first),
        }
    }

    /// Records whether products of one number are computed together, as in `op`.
    pub(super) fn decide(&mut self, op: Op, is_cheaper: bool) {
        if let Op::Multiples {
            products, targets, ..
        } = op
        {
            self.together
                .insert(targets, is_cheaper.then_some(products));
        }
    }
}
