//! Functions of few bits.

use super::known::QuickSet;
use super::number::RegisterShape;
use super::value::{RealValue, Tabulated, Value};
use super::{Builder, FEW, GARBAGE, Garbage};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Bit, Op, RegisterId, Type, Word};
use std::rc::Rc;
use std::sync::Arc;

/// Least number of entries of a table that is worth sharing.
const LONG: usize = 1 << 8;

impl Tabulated {
    fn constant(value: f64) -> Self {
        Self {
            address: Rc::new([]),
            entries: Rc::new([value]),
        }
    }

    /// Removes the address bits that no entry depends on.
    fn reduced(mut self) -> Self {
        let mut place = 0;
        while place < self.address.len() {
            let step = 1 << place;
            let entries = &self.entries;
            let idle = (0..entries.len())
                .filter(|i| i & step == 0)
                .all(|i| entries[i] == entries[i | step]);
            if !idle {
                place += 1;
                continue;
            }
            let kept = (0..entries.len()).filter(|i| i & step == 0);
            let entries = kept.map(|i| entries[i]).collect();
            let address = self.address.iter().enumerate();
            let address = address.filter(|&(i, _)| i != place).map(|(_, &bit)| bit);
            self = Self {
                address: address.collect(),
                entries,
            };
        }
        self
    }

    /// The table of `f(a, b)`, with the address bits of both. None if these are more than `most`,
    /// unless both addresses are equal or one is empty.
    fn join(a: &Self, b: &Self, most: usize, f: impl Fn(f64, f64) -> f64) -> Option<Self> {
        if a.address == b.address {
            let pairs = a.entries.iter().zip(&*b.entries);
            return Some(Self {
                address: a.address.clone(),
                entries: pairs.map(|(&a, &b)| f(a, b)).collect(),
            });
        }
        let mut address = a.address.to_vec();
        // For each bit of `b`'s address, its place in the common address.
        let places: Vec<usize> = b
            .address
            .iter()
            .map(|bit| {
                let known = address.iter().position(|known| known == bit);
                known.unwrap_or_else(|| {
                    address.push(*bit);
                    address.len() - 1
                })
            })
            .collect();
        let free = a.address.is_empty() || b.address.is_empty();
        if address.len() > most && !free {
            return None;
        }
        let mask = a.entries.len() - 1;
        let entries = (0..1_usize << address.len())
            .map(|i| {
                let spread = places.iter().enumerate();
                let of_b = spread.fold(0, |sum, (bit, place)| sum | (i >> place & 1) << bit);
                f(a.entries[i & mask], b.entries[of_b])
            })
            .collect();
        Some(Self {
            address: address.into(),
            entries,
        })
    }
}

/// The entries of tables, each list once: all searches look up the same rows of a mesh.
#[derive(Default)]
pub(super) struct SharedTables {
    columns: QuickSet<Arc<[i64]>>,
    /// Entries of values, by the bits of their numbers.
    entries: QuickMap<Box<[u64]>, Rc<[f64]>>,
}

impl SharedTables {
    /// Returns the column with these entries.
    fn column(&mut self, entries: Vec<i64>) -> Arc<[i64]> {
        if let Some(known) = self.columns.get(&*entries) {
            return known.clone();
        }
        let column: Arc<[i64]> = entries.into();
        self.columns.insert(column.clone());
        column
    }

    /// Returns the table with entries that it shares with an equal one, if it is long.
    fn table(&mut self, table: Tabulated) -> Tabulated {
        if table.entries.len() < LONG {
            return table;
        }
        let bits = table.entries.iter().map(|entry| entry.to_bits());
        let known = self.entries.entry(bits.collect());
        Tabulated {
            entries: known.or_insert(table.entries).clone(),
            ..table
        }
    }
}

/// Toffolis of a table with `bits` address bits.
fn one_hot_cost(bits: usize) -> u32 {
    (1_u32 << bits) - bits as u32 - 1
}

/// `f(a, b)` as a table, if the table is cheaper than arithmetic of `cost` Toffolis.
pub(super) fn joined(
    a: &Tabulated,
    b: &Tabulated,
    cost: u32,
    f: impl Fn(f64, f64) -> f64,
) -> Option<Tabulated> {
    let joined = Tabulated::join(a, b, FEW, f)?.reduced();
    let bits = joined.address.len();
    let free = bits <= a.address.len().max(b.address.len());
    (free || one_hot_cost(bits) <= cost).then_some(joined)
}

impl Builder<'_> {
    /// A number that is a function of few bits.
    pub(super) fn tabulated(&mut self, table: Tabulated) -> RealValue {
        let table = self.shared_tables.table(table.reduced());
        let first = table.entries[0];
        if table.address.is_empty() {
            return RealValue::constant(first);
        }
        let low = table.entries.iter().copied().fold(first, f64::min);
        let high = table.entries.iter().copied().fold(first, f64::max);
        let range = [self.rounded(low), self.rounded(high)];
        if range[0] == range[1] {
            // All entries round to one number: the table is that constant.
            return RealValue::constant(range[0] as f64 * self.ulp());
        }
        self.value(Value {
            range,
            word: None,
            table: Some(table),
        })
    }

    /// The table of a number, its sign and constant included; none if it has no table.
    pub(super) fn table_of(&self, a: RealValue) -> Option<Tabulated> {
        if !a.offset.is_constant() {
            return None;
        }
        let offset = a.offset.constant;
        let Some(node) = a.node else {
            return Some(Tabulated::constant(offset));
        };
        let table = self.values[node as usize].table.as_ref()?;
        if offset == 0.0 && !a.negated {
            return Some(table.clone());
        }
        let sign = if a.negated { -1.0 } else { 1.0 };
        Some(table.map(|entry| sign * entry + offset))
    }

    /// `f(a)` as a table, if `a` is a table.
    pub(super) fn tabulate_one(
        &mut self,
        a: RealValue,
        f: impl Fn(f64) -> f64,
    ) -> Option<RealValue> {
        let table = self.table_of(a)?.map(f);
        Some(self.tabulated(table))
    }

    /// `f(a, b)` as a table, if both are tables and arithmetic would cost more.
    pub(super) fn tabulate_pair(
        &mut self,
        a: RealValue,
        b: RealValue,
        cost: u32,
        f: impl Fn(f64, f64) -> f64,
    ) -> Option<RealValue> {
        let (a, b) = (self.table_of(a)?, self.table_of(b)?);
        if !self.target.passes.tabulate && a.address != b.address {
            return None;
        }
        let table = joined(&a, &b, cost, f)?;
        Some(self.tabulated(table))
    }

    /// The word that holds a node. A table is looked up now.
    pub(super) fn word_of(&mut self, node: u32) -> Word {
        let value = &self.values[node as usize];
        let table = value.table.clone();
        if let Some(word) = value.word
            && (table.is_none() || self.is_filled(word.register))
        {
            return word;
        }
        let range = value.range;
        let word = match table {
            Some(table) => {
                let entries: Vec<i64> = table.entries.iter().map(|&e| self.rounded(e)).collect();
                // Low zero bits that all entries share need no qubits: the word's shift supplies
                // them.
                let zeros = entries.iter().filter(|&&entry| entry != 0);
                let zeros = zeros.map(|entry| entry.trailing_zeros()).min().unwrap_or(0);
                let entries = entries.into_iter().map(|entry| entry >> zeros);
                let entries = entries.collect();
                let RegisterShape { ty, width, signed } = self.shape(range.map(|end| end >> zeros));
                let target = self.look_up(&table.address, entries, ty, width);
                Word {
                    shift: zeros,
                    ..Self::whole(target, width, signed)
                }
            }
            // Unreachable: every value has a word or a table.
            None => Self::whole(self.id, 1, false),
        };
        self.values[node as usize].word = Some(word);
        word
    }

    /// The register of a table's column.
    pub(super) fn look_up(
        &mut self,
        address: &[Bit],
        entries: Vec<i64>,
        ty: Type,
        width: u32,
    ) -> RegisterId {
        let columns = Arc::new([self.shared_tables.column(entries)]);
        let address: Box<[Bit]> = address.into();
        let style = self.style(Garbage::Tables);
        self.emit(Op::Table {
            low: 0,
            style,
            address,
            columns,
            targets: Box::new([(ty, width)]),
            scratch: GARBAGE,
        })[0]
    }
}
