//! Truth values and comparisons.

use super::table::joined;
use super::value::{BoolValue, RealValue, Tabulated, Truth};
use super::{Builder, negative_range};
use qrt_circuit::{Bit, Op, Operand, Type};
use qrt_scene::Checker;

/// The fewest address bits of a table with one marked row that is compared bit by bit.
///
/// Shorter tables are looked up: those of one address and block share their selection.
const COMPARED_FROM: usize = 7;

/// Returns the row of a long table whose entry differs from all others, and that entry.
fn marked_row(table: &Tabulated) -> Option<(usize, bool)> {
    if table.address.len() < COMPARED_FROM {
        return None;
    }
    let ones = table.entries.iter().filter(|&&entry| entry != 0.0).count();
    let mark = match ones {
        1 => true,
        _ if ones + 1 == table.entries.len() => false,
        _ => return None,
    };
    let row = table
        .entries
        .iter()
        .position(|&entry| (entry != 0.0) == mark)?;
    Some((row, mark))
}

impl Builder<'_> {
    /// The bit that is `mark` where the address is `row`.
    ///
    /// Starts at the top bits of the address, which rows in a sequence have in common: n rows take about n ANDs.
    fn is_row(&mut self, address: &[Bit], row: usize, mark: bool) -> Bit {
        let mut equal = BoolValue::Constant(true);
        for (place, &bit) in address.iter().enumerate().rev() {
            let bit = self.truth_of(bit);
            let wanted = row >> place & 1 == 1;
            equal = self.both(equal, if wanted { bit } else { bit.negated() });
        }
        let bit = self.bit(equal);
        Bit {
            inverted: bit.inverted == mark,
            ..bit
        }
    }

    fn truth_node(&mut self, truth: Truth) -> BoolValue {
        self.truths.push(truth);
        BoolValue::node(self.truths.len() as u32 - 1)
    }

    /// The truth value that `bit` holds.
    pub(super) fn truth_of(&mut self, bit: Bit) -> BoolValue {
        let node = self.truth_node(Truth {
            bit: Some(Bit {
                inverted: false,
                ..bit
            }),
            table: None,
        });
        if bit.inverted { node.negated() } else { node }
    }

    /// A truth value that is a function of few bits; entries are 0 and 1.
    pub(super) fn tabulated_truth(&mut self, table: Tabulated) -> BoolValue {
        let first = table.entries[0];
        if table.entries.iter().all(|&entry| entry == first) {
            return BoolValue::Constant(first != 0.0);
        }
        self.truth_node(Truth {
            bit: None,
            table: Some(table),
        })
    }

    pub(super) fn truth_table(&self, a: BoolValue) -> Option<Tabulated> {
        match a {
            BoolValue::Constant(_) => None,
            BoolValue::Node { node, inverted } => {
                let table = self.truths[node as usize].table.as_ref()?;
                Some(if inverted {
                    table.map(|entry| 1.0 - entry)
                } else {
                    table.clone()
                })
            }
        }
    }

    /// The bit that holds a truth value. A table is looked up now.
    pub(super) fn bit(&mut self, a: BoolValue) -> Bit {
        let BoolValue::Node { node, inverted } = a else {
            // Unreachable: constants fold before an operation needs their bit.
            return Bit {
                register: self.id,
                index: 0,
                inverted: false,
            };
        };
        let truth = self.truths[node as usize].clone();
        let bit = match (truth.bit, truth.table) {
            (Some(bit), None) => bit,
            (Some(bit), _) if self.is_filled(bit.register) => bit,
            (_, Some(table)) => {
                let bit = if let Some((row, mark)) = marked_row(&table) {
                    self.is_row(&table.address, row, mark)
                } else {
                    let entries = table.entries.iter().map(|&entry| entry as i64).collect();
                    Bit {
                        register: self.look_up(&table.address, entries, Type::Bool, 1),
                        index: 0,
                        inverted: false,
                    }
                };
                self.truths[node as usize].bit = Some(bit);
                bit
            }
            (None, None) => Bit {
                register: self.id,
                index: 0,
                inverted: false,
            },
        };
        Bit {
            inverted: bit.inverted != inverted,
            ..bit
        }
    }

    pub(super) fn both(&mut self, a: BoolValue, b: BoolValue) -> BoolValue {
        match (a, b) {
            (BoolValue::Constant(false), _) | (_, BoolValue::Constant(false)) => {
                BoolValue::Constant(false)
            }
            (BoolValue::Constant(true), other) | (other, BoolValue::Constant(true)) => other,
            _ if a == b => a,
            _ if a == b.negated() => BoolValue::Constant(false),
            _ => {
                if let (Some(x), Some(y)) = (self.truth_table(a), self.truth_table(b))
                    && let Some(table) = joined(&x, &y, 1, |a, b| a * b)
                {
                    return self.tabulated_truth(table);
                }
                let (a, b) = (self.bit(a), self.bit(b));
                let order = |bit: Bit| (bit.register, bit.index, bit.inverted);
                let (a, b) = if order(a) <= order(b) { (a, b) } else { (b, a) };
                let target = self.emit(Op::And {
                    a,
                    b,
                    target: (Type::Bool, 1),
                })[0];
                self.truth_of(Bit {
                    register: target,
                    index: 0,
                    inverted: false,
                })
            }
        }
    }

    pub(super) fn either(&mut self, a: BoolValue, b: BoolValue) -> BoolValue {
        self.both(a.negated(), b.negated()).negated()
    }

    /// `if when { a } else { b }`
    pub(super) fn chosen_truth(
        &mut self,
        when: BoolValue,
        a: BoolValue,
        b: BoolValue,
    ) -> BoolValue {
        match (when, a, b) {
            _ if a == b => a,
            (BoolValue::Constant(when), ..) => {
                if when {
                    a
                } else {
                    b
                }
            }
            (_, BoolValue::Constant(true), _) => self.either(when, b),
            (_, BoolValue::Constant(false), _) => self.both(when.negated(), b),
            (_, _, BoolValue::Constant(true)) => self.either(when.negated(), a),
            (_, _, BoolValue::Constant(false)) => self.both(when, a),
            _ => {
                let differ = self.differ(a, b);
                let change = self.both(when, differ);
                self.differ(b, change)
            }
        }
    }

    pub(super) fn differ(&mut self, a: BoolValue, b: BoolValue) -> BoolValue {
        match (a, b) {
            (BoolValue::Constant(known), other) | (other, BoolValue::Constant(known)) => {
                if known {
                    other.negated()
                } else {
                    other
                }
            }
            _ => {
                let (a, b) = (self.bit(a), self.bit(b));
                let target = self.emit(Op::Xor {
                    a,
                    b,
                    target: (Type::Bool, 1),
                })[0];
                self.truth_of(Bit {
                    register: target,
                    index: 0,
                    inverted: false,
                })
            }
        }
    }

    /// `a < 0`
    pub(super) fn negative_sign(&mut self, a: RealValue) -> BoolValue {
        let range = self.range(a);
        if range[0] >= 0 {
            return BoolValue::Constant(false);
        }
        if range[1] < 0 {
            return BoolValue::Constant(true);
        }
        if let Some(table) = self.table_of(a) {
            let ulp = self.ulp();
            let table = table.map(|entry| f64::from(entry < -0.5 * ulp));
            return self.tabulated_truth(table);
        }
        let plain = self.plain(a);
        let Operand::Word(word) = plain.operand else {
            return BoolValue::Constant(false);
        };
        if !plain.negated {
            return self.truth_of(Bit {
                register: word.register,
                index: word.offset + word.width - 1,
                inverted: false,
            });
        }
        // -x < 0
        let range = negative_range(plain.range);
        let word = self.sum(Operand::Constant(0), plain.operand, true, range);
        self.truth_of(Bit {
            register: word.register,
            index: word.width - 1,
            inverted: false,
        })
    }

    /// True if `floor(a)` is odd: the bit of weight 1.
    pub(super) fn is_odd(&mut self, a: RealValue) -> BoolValue {
        if let Some(table) = self.table_of(a) {
            return self.tabulated_truth(table.map(|entry| f64::from(Checker::is_odd(entry))));
        }
        let fraction = self.fraction();
        let (operand, range) = self.operand(a);
        let cells = range.map(|end| end >> fraction);
        let word = match operand {
            Operand::Word(word) if cells[0] < cells[1] => word,
            _ => return BoolValue::Constant(cells[0] & 1 == 1),
        };
        if fraction < word.shift {
            return BoolValue::Constant(false);
        }
        let bit = fraction - word.shift;
        if bit >= word.width && !word.signed {
            return BoolValue::Constant(false);
        }
        self.truth_of(Bit {
            register: word.register,
            index: word.offset + bit.min(word.width - 1),
            inverted: false,
        })
    }

    pub(super) fn is_less(&mut self, a: RealValue, b: RealValue) -> BoolValue {
        let (x, y) = (self.range(a), self.range(b));
        if x[1] < y[0] {
            return BoolValue::Constant(true);
        }
        if x[0] >= y[1] {
            return BoolValue::Constant(false);
        }
        if let (Some(x), Some(y)) = (self.table_of(a), self.table_of(b))
            && let Some(table) = joined(&x, &y, self.fraction(), |a, b| f64::from(a < b))
        {
            return self.tabulated_truth(table);
        }
        // The constants of `a` and `b` are added before they are rounded.
        let difference = self.plus(a, b.negative());
        self.negative_sign(difference)
    }
}
