//! Small unsigned integers: indices of faces, surfaces and cells.

use super::table::joined;
use super::value::{BoolValue, Choice, Index, RealValue, Tabulated};
use super::{Builder, GARBAGE, MAX_INDEX};
use qrt_circuit::{Bit, Op, Operand, Type, Word};
use std::rc::Rc;

/// Number of bits that hold every integer below `bound`.
fn bits_below(bound: u32) -> u32 {
    32 - bound.saturating_sub(1).leading_zeros()
}

impl Builder<'_> {
    /// The integer that `word` holds.
    pub(super) fn choice_of(&mut self, word: Word) -> Index {
        self.choice_within(word, MAX_INDEX)
    }

    /// The integer that `word` holds, with a table if it has at most this number of bits.
    pub(super) fn choice_within(&mut self, word: Word, bits: u32) -> Index {
        let table = (word.width <= bits).then(|| {
            // Words of one width share these entries: each table of a face index is as long as the
            // number of faces.
            let counted = || (0..1_u32 << word.width).map(f64::from).collect();
            let entries = self.counted.entry(word.width).or_insert_with(counted);
            Tabulated {
                address: Self::bits(word).collect(),
                entries: entries.clone(),
            }
        });
        let bound = 1_u64.checked_shl(word.width).unwrap_or(u64::MAX);
        self.choices.push(Choice {
            bound: u32::try_from(bound).unwrap_or(u32::MAX),
            word: Some(word),
            table,
        });
        Index::Node(self.choices.len() as u32 - 1)
    }

    /// The code of the constant `value`; the code of `u32::MAX`, none, follows the last face.
    pub(super) fn code(&self, value: u32) -> u32 {
        if value == u32::MAX {
            self.target.faces
        } else {
            value
        }
    }

    pub(super) fn choice_table(&self, a: Index) -> Option<Tabulated> {
        match a {
            Index::Constant(value) => Some(Tabulated {
                address: Rc::new([]),
                entries: Rc::new([f64::from(value)]),
            }),
            Index::Node(node) => self.choices[node as usize].table.clone(),
        }
    }

    /// An integer that is a function of few bits.
    pub(super) fn tabulated_choice(&mut self, table: Tabulated) -> Index {
        let first = table.entries[0];
        if table.entries.iter().all(|&entry| entry == first) {
            return Index::Constant(first as u32);
        }
        let most = table.entries.iter().copied().fold(0.0, f64::max);
        self.choices.push(Choice {
            bound: most as u32 + 1,
            word: None,
            table: Some(table),
        });
        Index::Node(self.choices.len() as u32 - 1)
    }

    pub(super) fn choice_bound(&self, a: Index) -> u32 {
        match a {
            Index::Constant(value) => value + 1,
            Index::Node(node) => self.choices[node as usize].bound,
        }
    }

    pub(super) fn choice_operand(&mut self, a: Index) -> Operand {
        let node = match a {
            Index::Constant(value) => return Operand::Constant(i64::from(value)),
            Index::Node(node) => node,
        };
        let choice = self.choices[node as usize].clone();
        if let Some(word) = choice.word
            && (choice.table.is_none() || self.is_filled(word.register))
        {
            return Operand::Word(word);
        }
        let Some(table) = choice.table else {
            return Operand::Constant(0);
        };
        let width = bits_below(choice.bound).max(1);
        let entries = table.entries.iter().map(|&entry| entry as i64).collect();
        let target = self.look_up(&table.address, entries, Type::UInt, width);
        let word = Self::whole(target, width, false);
        self.choices[node as usize].word = Some(word);
        Operand::Word(word)
    }

    pub(super) fn chosen_index(&mut self, when: BoolValue, a: Index, b: Index) -> Index {
        let node = match when {
            BoolValue::Constant(true) => return a,
            BoolValue::Constant(false) => return b,
            node @ BoolValue::Node { .. } => node,
        };
        if a == b {
            return a;
        }
        if let (Some(c), Some(x), Some(y)) = (
            self.truth_table(node),
            self.choice_table(a),
            self.choice_table(b),
        ) {
            let width = bits_below(self.choice_bound(a).max(self.choice_bound(b)));
            // `joined` combines two tables, not three: -1 marks the rows of `b` before `b` is
            // joined.
            let picked = joined(&c, &x, width, |c, x| if c == 0.0 { -1.0 } else { x });
            let table = picked
                .and_then(|picked| joined(&picked, &y, width, |x, y| if x < 0.0 { y } else { x }));
            if let Some(table) = table {
                return self.tabulated_choice(table);
            }
        }
        let bound = self.choice_bound(a).max(self.choice_bound(b));
        let width = bits_below(bound).max(1);
        let (a, b) = (self.choice_operand(a), self.choice_operand(b));
        let when = self.bit(node);
        let target = self.emit(Op::Select {
            when,
            a,
            b,
            target: (Type::UInt, width),
        })[0];
        let index = self.choice_of(Self::whole(target, width, false));
        if let Index::Node(node) = index {
            self.choices[node as usize].bound = bound;
        }
        index
    }

    /// `a == b`
    pub(super) fn are_equal(&mut self, a: Index, b: Index) -> BoolValue {
        let (a, b) = match (a, b) {
            (Index::Constant(value), other) | (other, Index::Constant(value)) => {
                return self.test(other, |index| index == value);
            }
            nodes => nodes,
        };
        let words = [a, b].map(|index| self.choice_operand(index));
        let [Operand::Word(a), Operand::Word(b)] = words else {
            return BoolValue::Constant(false);
        };
        let mut bits = [a, b].map(|word| Self::bits(word).collect::<Vec<_>>());
        bits.sort_by_key(Vec::len);
        let [short, long] = bits;
        let mut equal = BoolValue::Constant(true);
        for (place, &bit) in long.iter().enumerate().rev() {
            let bit = self.truth_of(bit);
            let differ = match short.get(place) {
                Some(&other) => {
                    let other = self.truth_of(other);
                    self.differ(bit, other)
                }
                None => bit,
            };
            equal = self.both(equal, differ.negated());
        }
        equal
    }

    /// The first `most` of the marked integers whose truth value holds, and whether there is one.
    pub(super) fn encoded(
        &mut self,
        marked: &[(BoolValue, u32)],
        most: usize,
    ) -> Vec<(BoolValue, Index)> {
        let may_hold = |(holds, _): &&(BoolValue, u32)| *holds != BoolValue::Constant(false);
        let marked: Vec<(BoolValue, u32)> = marked.iter().filter(may_hold).copied().collect();
        let none = (BoolValue::Constant(false), Index::Constant(0));
        let mut all = vec![none; most];
        let count = most.min(marked.len());
        let greatest = marked.iter().map(|(_, value)| *value).max().unwrap_or(0);
        if count == 0 {
            return all;
        }
        let width = bits_below(greatest + 1).max(1);
        let bits = marked.iter().map(|(holds, _)| match holds {
            // A face that covers all pixels at hand is met on all paths.
            BoolValue::Constant(_) => {
                let one = self.constant_word(1);
                Bit {
                    register: one.register,
                    index: one.offset,
                    inverted: false,
                }
            }
            BoolValue::Node { .. } => self.bit(*holds),
        });
        let bits = bits.collect();
        let entries = marked
            .iter()
            .map(|(_, value)| 1 << width | u64::from(*value));
        let targets = self.emit(Op::Encode {
            bits,
            entries: entries.collect(),
            targets: vec![(Type::UInt, width + 1); count].into(),
            scratch: GARBAGE,
        });
        for (target, (found, index)) in targets.into_iter().zip(&mut all) {
            *found = self.truth_of(Bit {
                register: target,
                index: width,
                inverted: false,
            });
            *index = self.choice_of(Self::whole(target, width, false));
            if let Index::Node(node) = *index {
                self.choices[node as usize].bound = greatest + 1;
            }
        }
        all
    }

    /// The truth value `holds(a)`.
    pub(super) fn test(&mut self, a: Index, holds: impl Fn(u32) -> bool) -> BoolValue {
        match self.choice_table(a) {
            Some(table) => {
                let table = table.map(|entry| f64::from(holds(entry as u32)));
                self.tabulated_truth(table)
            }
            // Only sample coordinates are too wide for a table, and no code tests them.
            None => BoolValue::Constant(false),
        }
    }

    /// The number `value(a)`. Table entries from `rows` on, which never occur, repeat entry 0.
    pub(super) fn row(&mut self, a: Index, rows: usize, value: impl Fn(usize) -> f64) -> RealValue {
        let Some(table) = self.choice_table(a) else {
            return RealValue::constant(0.0);
        };
        let table = table.map(|entry| {
            let row = entry as usize;
            value(if row < rows { row } else { 0 })
        });
        self.tabulated(table)
    }

    /// The integer `entries[a]`, by table.
    pub(super) fn entry_of(&mut self, a: Index, entries: &[u32]) -> Index {
        let Some(table) = self.choice_table(a) else {
            return Index::Constant(0);
        };
        let first = entries.first().copied().unwrap_or(0);
        let looked_up = table.map(|entry| {
            let entry = entries.get(entry as usize).copied().unwrap_or(first);
            f64::from(self.code(entry))
        });
        let index = self.tabulated_choice(looked_up);
        // The result has fewer bits than its address: put it into a register, so that tables of
        // values that depend on it have fewer address bits.
        let own = bits_below(self.choice_bound(index));
        if own as usize + 1 < table.address.len()
            && let Operand::Word(word) = self.choice_operand(index)
        {
            let bound = self.choice_bound(index);
            let index = self.choice_of(word);
            if let Index::Node(node) = index {
                self.choices[node as usize].bound = bound;
            }
            return index;
        }
        index
    }
}
