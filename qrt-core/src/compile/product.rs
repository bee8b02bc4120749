//! Products, squares, and products with constants.

use super::number::RegisterShape;
use super::value::{RealValue, bits_of};
use super::{Builder, GARBAGE, Garbage, MAX_BITS};
use qrt_circuit::{Op, Operand, Word};

fn hull(ends: [i128; 4]) -> [i64; 2] {
    let saturated = |n: i128| n.clamp(i64::MIN.into(), i64::MAX.into()) as i64;
    let low = ends.iter().copied().fold(i128::MAX, i128::min);
    let high = ends.iter().copied().fold(i128::MIN, i128::max);
    [saturated(low), saturated(high)]
}

impl Builder<'_> {
    /// `factor a`, for a constant factor.
    pub(super) fn times_constant(&mut self, a: RealValue, factor: f64) -> RealValue {
        if factor == 0.0 || !factor.is_finite() {
            return RealValue::constant(0.0);
        }
        let offset = a.offset.scaled(factor);
        let bias = a.bias * factor;
        let Some(node) = a.node else {
            return RealValue::fixed(offset);
        };
        let negated = a.negated != (factor < 0.0);
        let factor = factor.abs();
        let scaled = if factor == 1.0 {
            RealValue::node(node)
        } else if let Some(table) = &self.values[node as usize].table {
            let table = table.map(|entry| entry * factor);
            self.tabulated(table)
        } else {
            self.scaled_node(node, factor)
        };
        let scaled = if negated { scaled.negative() } else { scaled };
        RealValue {
            offset: scaled.offset.plus(offset),
            bias: scaled.bias + bias,
            ..scaled
        }
    }

    fn scaled_node(&mut self, node: u32, factor: f64) -> RealValue {
        let range = self.values[node as usize].range;
        let most = range[0].unsigned_abs().max(range[1].unsigned_abs());
        // factor = m 2^-k up to a quarter of an ulp of the product; m is odd.
        let (mantissa, exponent) = libm::frexp(factor);
        if mantissa == 0.5 {
            return self.shifted(node, exponent - 1);
        }
        let mut k = (64 - most.leading_zeros()) as i32 + 1;
        // The constant and the number together must fit the widest product.
        k = k.min((MAX_BITS - 1).saturating_sub(64 - most.leading_zeros()) as i32 - exponent);
        let whole = libm::ldexp(factor, k).round_ties_even();
        if whole >= (1_i64 << (MAX_BITS - 2)) as f64 {
            self.too_wide("a product", whole);
            return RealValue::constant(0.0);
        }
        let whole = whole as i64;
        if whole == 0 {
            return RealValue::constant(0.0);
        }
        let zeros = whole.trailing_zeros();
        let (odd, k) = (whole >> zeros, k - zeros as i32);
        if odd == 1 {
            return self.shifted(node, -k);
        }
        let drop = k.max(0).cast_unsigned();
        let ends = range.map(|end| (i128::from(end) * i128::from(odd)) >> drop);
        let range = hull([ends[0], ends[1], ends[0], ends[1]]);
        let a = self.word_of(node);
        let RegisterShape { ty, width, signed } = self.shape(range);
        let style = self.style(Garbage::Products);
        let target = self.emit(Op::Scale {
            a,
            factor: odd,
            drop,
            style,
            target: (ty, width),
            scratch: GARBAGE,
        })[0];
        let product = self.computed(Self::whole(target, width, signed), range);
        match (product.node, (-k).max(0)) {
            (Some(node), shift) if shift > 0 => self.shifted(node, shift),
            _ if drop > 0 => self.rounded_down(product),
            _ => product,
        }
    }

    /// `node 2^exponent`, rounded down.
    pub(super) fn shifted(&mut self, node: u32, exponent: i32) -> RealValue {
        let range = self.values[node as usize].range;
        let word = self.word_of(node);
        if exponent >= 0 {
            let shift = exponent.cast_unsigned();
            if word.bits() + shift > MAX_BITS {
                self.too_wide("a product", libm::ldexp(1.0, (word.bits() + shift) as i32));
                return RealValue::constant(0.0);
            }
            let word = Word {
                shift: word.shift + shift,
                ..word
            };
            return self.computed(word, range.map(|end| end << shift));
        }
        let drop = exponent.unsigned_abs().min(63);
        let range = range.map(|end| end >> drop);
        let word = dropped(word, drop);
        match word {
            Some(word) => {
                let floor = self.computed(word, range);
                self.rounded_down(floor)
            }
            None => RealValue::constant(0.0),
        }
    }

    /// Marks a number as rounded down from one with many more bits. It is half an ulp too small on
    /// average.
    pub(super) fn rounded_down(&self, a: RealValue) -> RealValue {
        RealValue {
            bias: if a.node.is_some() {
                0.5 * self.ulp()
            } else {
                0.0
            },
            ..a
        }
    }

    pub(super) fn times(&mut self, a: RealValue, b: RealValue) -> RealValue {
        if let Some(factor) = a.as_constant() {
            return self.times_constant(b, factor);
        }
        if let Some(factor) = b.as_constant() {
            return self.times_constant(a, factor);
        }
        let cost = self.product_cost(a, b);
        if let Some(product) = self.tabulate_pair(a, b, cost, |a, b| a * b) {
            return product;
        }
        let (a, b) = (self.plain(a), self.plain(b));
        let negated = a.negated != b.negated;
        let (Operand::Word(x), Operand::Word(y)) = (a.operand, b.operand) else {
            // Unreachable: constants are handled above, and every other operand is a word.
            return RealValue::constant(0.0);
        };
        let drop = self.fraction();
        let ends = |i: usize, j: usize| (i128::from(a.range[i]) * i128::from(b.range[j])) >> drop;
        let product = if x == y {
            let ends = [ends(0, 0), ends(1, 1)];
            let mut range = hull([ends[0], ends[1], ends[0], ends[1]]);
            if a.range[0] < 0 && a.range[1] > 0 {
                range[0] = 0;
            }
            self.square(x, drop, range)
        } else {
            let range = hull([ends(0, 0), ends(0, 1), ends(1, 0), ends(1, 1)]);
            // The narrower factor selects the rows.
            let order = |word: Word| (word.width, word.register, word.offset, word.shift);
            let (rows, other) = if order(x) <= order(y) { (x, y) } else { (y, x) };
            let RegisterShape { ty, width, signed } = self.shape(range);
            let style = self.style(Garbage::Products);
            let target = self.emit(Op::Multiply {
                a: rows,
                b: other,
                drop,
                style,
                target: (ty, width),
                scratch: GARBAGE,
            })[0];
            self.computed(Self::whole(target, width, signed), range)
        };
        let product = self.rounded_down(product);
        if negated { product.negative() } else { product }
    }

    fn product_cost(&mut self, a: RealValue, b: RealValue) -> u32 {
        let (a, b) = (self.range(a), self.range(b));
        bits_of(a).0 * bits_of(b).0
    }

    pub(super) fn square(&mut self, a: Word, drop: u32, range: [i64; 2]) -> RealValue {
        let RegisterShape { ty, width, signed } = self.shape(range);
        let style = self.style(Garbage::Products);
        let target = self.emit(Op::Square {
            a,
            drop,
            style,
            target: (ty, width),
            scratch: GARBAGE,
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }
}

/// The word without its `drop` lowest bits; none if nothing is left of it.
fn dropped(word: Word, drop: u32) -> Option<Word> {
    if drop <= word.shift {
        return Some(Word {
            shift: word.shift - drop,
            ..word
        });
    }
    let drop = drop - word.shift;
    if drop < word.width {
        return Some(Word {
            offset: word.offset + drop,
            width: word.width - drop,
            shift: 0,
            ..word
        });
    }
    // Only the sign is left: 0 or -1.
    word.signed.then_some(Word {
        offset: word.offset + word.width - 1,
        width: 1,
        shift: 0,
        ..word
    })
}
