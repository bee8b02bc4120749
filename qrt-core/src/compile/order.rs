//! Signs, minima and maxima, and known bounds of numbers.

use super::Builder;
use super::number::RegisterShape;
use super::number::negative;
use super::value::{Affine, BoolValue, RealValue, bits_of};
use qrt_circuit::{Op, Operand, Word};

impl Builder<'_> {
    pub(super) fn magnitude(&mut self, a: RealValue) -> RealValue {
        let [low, high] = self.range(a);
        if low >= 0 {
            return a;
        }
        if high <= 0 {
            return a.negative();
        }
        if let Some(table) = self.tabulate_one(a, f64::abs) {
            return table;
        }
        let sign = self.negative_sign(a);
        self.signed(a, sign)
    }

    /// `if when { -a } else { a }`
    pub(super) fn signed(&mut self, a: RealValue, when: BoolValue) -> RealValue {
        let when = match when {
            BoolValue::Constant(true) => return a.negative(),
            BoolValue::Constant(false) => return a,
            node @ BoolValue::Node { .. } => node,
        };
        let plain = self.plain(a);
        let Operand::Word(word) = plain.operand else {
            return self.chosen(when, a.negative(), a);
        };
        let when = if plain.negated { when.negated() } else { when };
        let bit = self.bit(when);
        let own_sign = word.signed
            && bit.index == word.offset + word.width - 1
            && bit.register == word.register;
        let [low, high] = plain.range;
        let range = if own_sign && !bit.inverted {
            [0, high.max(low.saturating_neg())]
        } else {
            [
                low.min(high.saturating_neg()),
                high.max(low.saturating_neg()),
            ]
        };
        let RegisterShape { ty, width, signed } = self.shape(range);
        let target = self.emit(Op::Negate {
            a: word,
            when: bit,
            target: (ty, width),
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }

    pub(super) fn greater(&mut self, a: RealValue, b: RealValue) -> RealValue {
        let (x, y) = (self.range(a), self.range(b));
        if x[0] >= y[1] {
            return a;
        }
        if y[0] >= x[1] {
            return b;
        }
        if let Some(table) = self.tabulate_pair(a, b, 2 * self.fraction(), f64::max) {
            return table;
        }
        let below = self.is_less(a, b);
        let chosen = self.chosen(below, b, a);
        self.narrowed(chosen, [x[0].max(y[0]), x[1].max(y[1])])
    }

    pub(super) fn lesser(&mut self, a: RealValue, b: RealValue) -> RealValue {
        let greater = self.greater(a.negative(), b.negative());
        greater.negative()
    }

    /// The same number, known to lie in `range`.
    pub(super) fn narrowed(&mut self, a: RealValue, range: [i64; 2]) -> RealValue {
        if a.offset != Affine::ZERO {
            return a;
        }
        let Some(node) = a.node else {
            return a;
        };
        let range = if a.negated { negative(range) } else { range };
        let old = &self.values[node as usize];
        let range = [range[0].max(old.range[0]), range[1].min(old.range[1])];
        if range == old.range || range[0] > range[1] {
            return a;
        }
        let mut value = old.clone();
        value.range = range;
        if let Some(word) = value.word {
            value.word = Some(trimmed(word, range));
        }
        let value = self.value(value);
        if a.negated { value.negative() } else { value }
    }

    /// The same number, known to lie within `low ..= high` up to rounding. It is read in the lowest
    /// bits that hold this interval. The bits for the bounds 1 and -1 hold at least one unit in the
    /// last place more.
    pub(super) fn bounded(&mut self, a: RealValue, low: f64, high: f64) -> RealValue {
        let range = self.range(a);
        let wanted = [self.rounded(low), self.rounded(high)];
        let (bits, signed) = bits_of([wanted[0].min(range[0].min(0).signum()), wanted[1]]);
        if bits >= bits_of(range).0 || bits < 2 {
            return a;
        }
        let (operand, old) = self.operand(a);
        let Operand::Word(word) = operand else {
            return a;
        };
        let most = if signed {
            (1_i64 << (bits - 1)) - 1
        } else {
            (1_i64 << bits) - 1
        };
        let least = if signed { -most - 1 } else { 0 };
        let range = [old[0].max(least), old[1].min(most)];
        let word = trimmed(word, range);
        self.computed(word, range)
    }
}

/// The lowest bits of a word, those that hold `range`.
fn trimmed(word: Word, range: [i64; 2]) -> Word {
    let (bits, signed) = bits_of(range);
    let width = bits.max(word.shift + 1) - word.shift;
    if width < word.width {
        Word {
            width,
            signed,
            ..word
        }
    } else {
        word
    }
}
