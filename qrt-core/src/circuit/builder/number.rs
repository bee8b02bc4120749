//! Sums and products of fixed-point numbers.

use super::value::{Affine, Real, Tabulated, Value, bits_of};
use super::{Bool, Builder, MAX_BITS, Parameter};
use crate::circuit::{Op, Operand, Type, Word};

/// A number whose bits are there, or one that is the same on all paths of all pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain {
    pub(super) operand: Operand,
    pub(super) range: [i64; 2],
    /// Does it stand for its negative?
    pub(super) negated: bool,
}

fn hull(ends: [i128; 4]) -> [i64; 2] {
    let saturated = |n: i128| n.clamp(i64::MIN.into(), i64::MAX.into()) as i64;
    let low = ends.iter().copied().fold(i128::MAX, i128::min);
    let high = ends.iter().copied().fold(i128::MIN, i128::max);
    [saturated(low), saturated(high)]
}

pub(super) fn negative([low, high]: [i64; 2]) -> [i64; 2] {
    [-high, -low]
}

impl Builder<'_> {
    pub(super) fn fraction(&self) -> u32 {
        self.target.fraction
    }

    /// One unit in the last place.
    pub(super) fn ulp(&self) -> f64 {
        1.0 / self.units()
    }

    pub(super) fn units(&self) -> f64 {
        (1_u64 << self.fraction()) as f64
    }

    /// A constant in ulps, rounded to nearest.
    pub(super) fn rounded(&mut self, value: f64) -> i64 {
        let scaled = (value * self.units()).round_ties_even();
        let most = (1_i64 << (MAX_BITS - 1)) as f64;
        if scaled.abs() < most {
            scaled as i64
        } else {
            self.too_wide("a constant of the scene", scaled);
            0
        }
    }

    pub(super) fn too_wide(&mut self, what: &'static str, value: f64) {
        let bits = value
            .abs()
            .log2()
            .ceil()
            .clamp(f64::from(MAX_BITS) + 1.0, 9999.0) as u32;
        self.fail(super::BuildError::TooWide { what, bits });
    }

    pub(super) fn value(&mut self, value: Value) -> Real {
        if value.range[0] == value.range[1] {
            return Real::constant(value.range[0] as f64 * self.ulp());
        }
        self.values.push(value);
        Real::node(self.values.len() as u32 - 1)
    }

    /// The value of a new register of `range`.
    pub(super) fn computed(&mut self, word: Word, range: [i64; 2]) -> Real {
        let register = &mut self.registers[word.register.index()];
        if word.width == register.width && word.shift == 0 {
            // The first to read all of it is who computed it.
            register.range.get_or_insert(range);
        }
        self.value(Value {
            range,
            word: Some(word),
            table: None,
        })
    }

    /// Type and width of a register for `range`, and how the register is read.
    pub(super) fn shape(&mut self, range: [i64; 2]) -> (Type, u32, bool) {
        let (bits, signed) = bits_of(range);
        (self.number_type(signed), bits.max(1), signed)
    }

    /// The interval of a number, in ulps.
    pub(super) fn range(&mut self, a: Real) -> [i64; 2] {
        let node = a
            .node
            .map_or([0, 0], |node| self.values[node as usize].range);
        let node = if a.negated { negative(node) } else { node };
        let [low, high] = self.offset_range(a.offset);
        [node[0].saturating_add(low), node[1].saturating_add(high)]
    }

    fn offset_range(&mut self, offset: Affine) -> [i64; 2] {
        let [width, height] = self.target.film;
        let ends = |slope: f64, last: u32| [0.0, slope * f64::from(last.max(1) - 1)];
        let (x, y) = (ends(offset.along[0], width), ends(offset.along[1], height));
        let low = offset.constant + x[0].min(x[1]) + y[0].min(y[1]);
        let high = offset.constant + x[0].max(x[1]) + y[0].max(y[1]);
        // Where slopes are summed in another order the last bit may differ.
        let slack = i64::from(!offset.is_constant());
        [self.rounded(low) - slack, self.rounded(high) + slack]
    }

    /// A number as an operand, its sign apart where that costs nothing.
    pub(super) fn plain(&mut self, a: Real) -> Plain {
        let whole = |operand, range| Plain {
            operand,
            range,
            negated: false,
        };
        let Some(node) = a.node else {
            if a.offset.is_constant() {
                let value = self.rounded(a.offset.constant);
                return whole(Operand::Constant(value), [value; 2]);
            }
            let (word, range) = self.loaded(a.offset);
            return whole(Operand::Word(word), range);
        };
        let offset = a.offset.plus(Affine::constant(a.bias));
        let slight = a.offset.is_constant() && offset.constant.abs() <= 0.75 * self.ulp();
        if a.offset == Affine::ZERO || slight {
            let word = self.word_of(node);
            return Plain {
                operand: Operand::Word(word),
                range: self.values[node as usize].range,
                negated: a.negated,
            };
        }
        if let (Some(table), true) = (&self.values[node as usize].table, a.offset.is_constant()) {
            let sign = if a.negated { -1.0 } else { 1.0 };
            let constant = offset.constant;
            let shifted = table.map(|entry| sign * entry + constant);
            let shifted = self.tabulated(shifted);
            return self.plain(shifted);
        }
        let (offset, extent) = if offset.is_constant() {
            let value = self.rounded(offset.constant);
            (Operand::Constant(value), [value; 2])
        } else {
            let (word, range) = self.loaded(offset);
            (Operand::Word(word), range)
        };
        let word = self.word_of(node);
        let range = self.values[node as usize].range;
        if let (Operand::Constant(0), false) = (offset, a.negated) {
            return whole(Operand::Word(word), range);
        }
        let signed = if a.negated { negative(range) } else { range };
        let range = [signed[0] + extent[0], signed[1] + extent[1]];
        let word = self.sum(offset, Operand::Word(word), a.negated, range);
        whole(Operand::Word(word), range)
    }

    /// A number as an operand, its sign included.
    pub(super) fn operand(&mut self, a: Real) -> (Operand, [i64; 2]) {
        let plain = self.plain(a);
        match plain.operand {
            Operand::Word(word) if plain.negated => {
                let range = negative(plain.range);
                let negated = self.sum(Operand::Constant(0), Operand::Word(word), true, range);
                (Operand::Word(negated), range)
            }
            operand => (operand, plain.range),
        }
    }

    /// `a ± b`, of which `range` is known.
    pub(super) fn sum(&mut self, a: Operand, b: Operand, subtract: bool, range: [i64; 2]) -> Word {
        let (ty, width, signed) = self.shape(range);
        let target = self.emit(&[(ty, width)], |t, _| Op::Add {
            a,
            b,
            subtract,
            target: t[0],
        })[0];
        Self::whole(target, width, signed)
    }

    fn loaded(&mut self, offset: Affine) -> (Word, [i64; 2]) {
        let range = self.offset_range(offset);
        let (ty, width, signed) = self.shape(range);
        let parameter = self.parameter(Parameter::Affine {
            constant: offset.constant,
            along: offset.along,
            fraction: self.fraction(),
            width,
        });
        let target = self.emit(&[(ty, width)], |t, _| Op::Load {
            parameter,
            target: t[0],
        })[0];
        (Self::whole(target, width, signed), range)
    }

    pub(super) fn plus(&mut self, a: Real, b: Real) -> Real {
        let offset = a.offset.plus(b.offset);
        let bias = a.bias + b.bias;
        let (Some(x), Some(y)) = (a.node, b.node) else {
            let (node, negated) = match a.node {
                Some(_) => (a.node, a.negated),
                None => (b.node, b.negated),
            };
            return Real {
                node,
                negated,
                offset,
                bias,
            };
        };
        if let Some(sum) = self.tabulate_pair(a, b, self.fraction() + 2, |a, b| a + b) {
            return sum;
        }
        if x == y {
            if a.negated != b.negated {
                return Real::fixed(offset);
            }
            let bare = Real {
                offset: Affine::ZERO,
                ..a
            };
            let twice = self.times_constant(bare, 2.0);
            return Real {
                offset,
                bias,
                ..twice
            };
        }
        // A subtrahend comes second; of two equal signs the order is the nodes'.
        let (first, second) = match (a.negated, b.negated) {
            (true, false) => (y, x),
            (false, true) => (x, y),
            _ => (x.min(y), x.max(y)),
        };
        let subtract = a.negated != b.negated;
        let (f, s) = (self.word_of(first), self.word_of(second));
        let (fr, sr) = (
            self.values[first as usize].range,
            self.values[second as usize].range,
        );
        let sr = if subtract { negative(sr) } else { sr };
        let range = [fr[0] + sr[0], fr[1] + sr[1]];
        let word = self.sum(Operand::Word(f), Operand::Word(s), subtract, range);
        let sum = self.computed(word, range);
        let sum = if a.negated && b.negated {
            sum.negative()
        } else {
            sum
        };
        Real {
            offset: sum.offset.plus(offset),
            bias,
            ..sum
        }
    }

    /// `factor a`, for a constant factor.
    pub(super) fn times_constant(&mut self, a: Real, factor: f64) -> Real {
        if factor == 0.0 || !factor.is_finite() {
            return Real::constant(0.0);
        }
        let offset = a.offset.scaled(factor);
        let bias = a.bias * factor;
        let Some(node) = a.node else {
            return Real::fixed(offset);
        };
        let negated = a.negated != (factor < 0.0);
        let factor = factor.abs();
        let scaled = if factor == 1.0 {
            Real::node(node)
        } else if let Some(table) = &self.values[node as usize].table {
            let table = table.map(|entry| entry * factor);
            self.tabulated(table)
        } else {
            self.scaled_node(node, factor)
        };
        let scaled = if negated { scaled.negative() } else { scaled };
        Real {
            offset: scaled.offset.plus(offset),
            bias: scaled.bias + bias,
            ..scaled
        }
    }

    fn scaled_node(&mut self, node: u32, factor: f64) -> Real {
        let range = self.values[node as usize].range;
        let most = range[0].unsigned_abs().max(range[1].unsigned_abs());
        // factor = m 2^-k up to a quarter of an ulp of the product; m is odd.
        let (mantissa, exponent) = libm::frexp(factor);
        if mantissa == 0.5 {
            return self.shifted(node, exponent - 1);
        }
        let mut k = (64 - most.leading_zeros()) as i32 + 1;
        // No more than fits beside the number itself.
        k = k.min((MAX_BITS - 1).saturating_sub(64 - most.leading_zeros()) as i32 - exponent);
        let whole = libm::ldexp(factor, k).round_ties_even();
        if whole >= (1_i64 << (MAX_BITS - 2)) as f64 {
            self.too_wide("a product", whole);
            return Real::constant(0.0);
        }
        let whole = whole as i64;
        if whole == 0 {
            return Real::constant(0.0);
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
        let (ty, width, signed) = self.shape(range);
        let style = self.target.style;
        let target = self.emit(&[(ty, width)], |t, scratch| Op::Scale {
            a,
            factor: odd,
            drop,
            style,
            target: t[0],
            scratch,
        })[0];
        let product = self.computed(Self::whole(target, width, signed), range);
        match (product.node, (-k).max(0)) {
            (Some(node), shift) if shift > 0 => self.shifted(node, shift),
            _ if drop > 0 => self.rounded_down(product),
            _ => product,
        }
    }

    /// `node 2^exponent`, rounded down.
    pub(super) fn shifted(&mut self, node: u32, exponent: i32) -> Real {
        let range = self.values[node as usize].range;
        let word = self.word_of(node);
        if exponent >= 0 {
            let shift = exponent.cast_unsigned();
            if word.bits() + shift > MAX_BITS {
                self.too_wide("a product", libm::ldexp(1.0, (word.bits() + shift) as i32));
                return Real::constant(0.0);
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
            None => Real::constant(0.0),
        }
    }

    /// A number that was rounded down from one with many more bits.
    pub(super) fn rounded_down(&self, a: Real) -> Real {
        Real {
            bias: if a.node.is_some() {
                0.5 * self.ulp()
            } else {
                0.0
            },
            ..a
        }
    }

    pub(super) fn times(&mut self, a: Real, b: Real) -> Real {
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
            // What is loaded is a word; a constant has been dealt with.
            return Real::constant(0.0);
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
            // The narrower one chooses the rows.
            let order = |word: Word| (word.width, word.register, word.offset, word.shift);
            let (rows, other) = if order(x) <= order(y) { (x, y) } else { (y, x) };
            let (ty, width, signed) = self.shape(range);
            let style = self.target.style;
            let target = self.emit(&[(ty, width)], |t, scratch| Op::Multiply {
                a: rows,
                b: other,
                drop,
                style,
                target: t[0],
                scratch,
            })[0];
            self.computed(Self::whole(target, width, signed), range)
        };
        let product = self.rounded_down(product);
        if negated { product.negative() } else { product }
    }

    fn product_cost(&mut self, a: Real, b: Real) -> u32 {
        let (a, b) = (self.range(a), self.range(b));
        bits_of(a).0 * bits_of(b).0
    }

    fn square(&mut self, a: Word, drop: u32, range: [i64; 2]) -> Real {
        let (ty, width, signed) = self.shape(range);
        let style = self.target.style;
        let target = self.emit(&[(ty, width)], |t, scratch| Op::Square {
            a,
            drop,
            style,
            target: t[0],
            scratch,
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }

    /// The root of a sum of squares that are kept exact.
    pub(super) fn norm(&mut self, v: [Real; 3]) -> Real {
        // In units of 4^-fraction; as many low bits are dropped as the widest sum needs.
        let mut parts = Vec::new();
        let mut exact = 0.0;
        for part in v {
            if let Some(constant) = part.as_constant() {
                exact += constant * constant;
                continue;
            }
            parts.push(self.plain(part));
        }
        let most: i128 = parts
            .iter()
            .map(|part| {
                let most = part.range[0]
                    .unsigned_abs()
                    .max(part.range[1].unsigned_abs());
                i128::from(most) * i128::from(most)
            })
            .sum();
        let exact = exact * self.units() * self.units();
        let bits = (128 - (most + exact as i128).leading_zeros()) as i32;
        // An even number, so that the root has whole bits.
        let drop = ((bits - MAX_BITS as i32 + 2).max(0).cast_unsigned() + 1) & !1;
        if parts.is_empty() {
            return Real::constant((exact / (self.units() * self.units())).sqrt());
        }
        let mut sum: Option<(Operand, [i64; 2])> = None;
        let constant = libm::ldexp(exact, -(drop as i32)).round_ties_even() as i64;
        if constant > 0 {
            sum = Some((Operand::Constant(constant), [constant; 2]));
        }
        for part in parts {
            let Operand::Word(word) = part.operand else {
                continue;
            };
            let squares = part
                .range
                .map(|end| (i128::from(end) * i128::from(end)) >> drop);
            let low = if part.range[0] < 0 && part.range[1] > 0 {
                0
            } else {
                squares[0].min(squares[1])
            };
            let range = [low as i64, squares[0].max(squares[1]) as i64];
            let square = self.square(word, drop, range);
            let square = self.plain(square);
            sum = Some(match sum {
                None => (square.operand, square.range),
                Some((sum, extent)) => {
                    let range = [extent[0] + square.range[0], extent[1] + square.range[1]];
                    let word = self.sum(sum, square.operand, false, range);
                    (Operand::Word(word), range)
                }
            });
        }
        match sum {
            Some((Operand::Word(word), range)) => {
                let root = self.integer_root(word, range);
                match (root.node, drop / 2) {
                    (Some(node), shift) if shift > 0 => self.shifted(node, shift as i32),
                    _ => root,
                }
            }
            Some((Operand::Constant(square), _)) => {
                Real::constant((square as f64).sqrt() * self.ulp())
            }
            None => Real::constant(0.0),
        }
    }

    /// `floor(sqrt(word))`, as ulps.
    fn integer_root(&mut self, word: Word, range: [i64; 2]) -> Real {
        let range = range.map(|end| end.max(0).cast_unsigned().isqrt().cast_signed());
        let (ty, width, signed) = self.shape(range);
        let style = self.target.style;
        let a = Word {
            signed: false,
            ..word
        };
        let target = self.emit(&[(ty, width)], |t, scratch| Op::SquareRoot {
            a,
            style,
            target: t[0],
            scratch,
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }

    /// `sqrt(max(a, 0))`, rounded down.
    pub(super) fn root(&mut self, a: Real) -> Real {
        if let Some(constant) = a.as_constant() {
            return Real::constant(constant.max(0.0).sqrt());
        }
        if let Some(root) = self.tabulate_one(a, |a| a.max(0.0).sqrt()) {
            return root;
        }
        let a = if self.range(a)[0] < 0 {
            self.greater(a, Real::constant(0.0))
        } else {
            a
        };
        let (operand, range) = self.operand(a);
        let Operand::Word(word) = operand else {
            return Real::constant(0.0);
        };
        // Zeros below make room for the root's fraction: as many, or two fewer for each bit that
        // the root then lacks.
        let room = (MAX_BITS - 1).saturating_sub(word.bits());
        let fraction = self.fraction();
        let lost = fraction.saturating_sub(room).div_ceil(2);
        let shift = fraction - 2 * lost.min(fraction / 2);
        let lost = (fraction - shift) / 2;
        let word = Word {
            shift: word.shift + shift,
            signed: false,
            ..word
        };
        let root = self.integer_root(word, range.map(|end| end.max(0) << shift));
        match root.node {
            Some(node) if lost > 0 => self.shifted(node, lost as i32),
            _ => root,
        }
    }

    pub(super) fn magnitude(&mut self, a: Real) -> Real {
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
    pub(super) fn signed(&mut self, a: Real, when: Bool) -> Real {
        let when = match when {
            Bool::Constant(true) => return a.negative(),
            Bool::Constant(false) => return a,
            node @ Bool::Node { .. } => node,
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
            [0, high.max(-low)]
        } else {
            [low.min(-high), high.max(-low)]
        };
        let (ty, width, signed) = self.shape(range);
        let target = self.emit(&[(ty, width)], |t, _| Op::Negate {
            a: word,
            when: bit,
            target: t[0],
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }

    pub(super) fn greater(&mut self, a: Real, b: Real) -> Real {
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

    pub(super) fn lesser(&mut self, a: Real, b: Real) -> Real {
        let greater = self.greater(a.negative(), b.negative());
        greater.negative()
    }

    /// The same number, of which a tighter interval is known.
    pub(super) fn narrowed(&mut self, a: Real, range: [i64; 2]) -> Real {
        if a.offset != Affine::ZERO || a.negated {
            return a;
        }
        let Some(node) = a.node else {
            return a;
        };
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
        self.value(value)
    }

    /// The same number, known to lie within `low ..= high` up to rounding: read in the bits that
    /// hold this, of which there is at least one unit's worth to spare.
    pub(super) fn bounded(&mut self, a: Real, low: f64, high: f64) -> Real {
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
    // Nothing but the sign: 0 or -1.
    word.signed.then_some(Word {
        offset: word.offset + word.width - 1,
        width: 1,
        shift: 0,
        ..word
    })
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

impl Tabulated {
    pub(super) fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Self {
            address: self.address.clone(),
            entries: self.entries.iter().map(|&entry| f(entry)).collect(),
        }
    }
}
