//! Fixed-point numbers: their intervals, their bits, and their sums.

use super::value::{Affine, RealValue, Tabulated, Value, bits_of};
use super::{Builder, MAX_BITS, PixelWord};
use qrt_circuit::{Op, Operand, Type, Word};

/// A number whose bits are in a register, or one that is the same on all paths of all pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain {
    pub(super) operand: Operand,
    pub(super) range: [i64; 2],
    /// True if the number is the operand's negative.
    pub(super) negated: bool,
}

pub(super) fn negative([low, high]: [i64; 2]) -> [i64; 2] {
    [high, low].map(i64::saturating_neg)
}

/// The shape of a register that holds a number.
pub(super) struct RegisterShape {
    pub(super) ty: Type,
    pub(super) width: u32,
    /// True if the top bit is a sign.
    pub(super) signed: bool,
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
        self.too_many_bits(what, bits);
    }

    pub(super) fn value(&mut self, value: Value) -> RealValue {
        if value.range[0] == value.range[1] {
            return RealValue::constant(value.range[0] as f64 * self.ulp());
        }
        self.values.push(value);
        RealValue::node(self.values.len() as u32 - 1)
    }

    /// The number that `word` holds, which lies in `range`.
    pub(super) fn computed(&mut self, word: Word, range: [i64; 2]) -> RealValue {
        let register = &mut self.registers[word.register.index()];
        if word.width == register.width && word.shift == 0 {
            // The defining operation counts as the first reader of the whole register: its range is
            // kept.
            register.range.get_or_insert(range);
        }
        self.value(Value {
            range,
            word: Some(word),
            table: None,
        })
    }

    /// The shape of a register for `range`.
    pub(super) fn shape(&mut self, range: [i64; 2]) -> RegisterShape {
        let (bits, signed) = bits_of(range);
        RegisterShape {
            ty: self.number_type(signed),
            width: bits.max(1),
            signed,
        }
    }

    /// The interval of a number, in ulps.
    pub(super) fn range(&mut self, a: RealValue) -> [i64; 2] {
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
        // If coefficients are summed in another order, the last bit may differ.
        let slack = i64::from(!offset.is_constant());
        [self.rounded(low) - slack, self.rounded(high) + slack]
    }

    /// A number as an operand. Its sign stays apart where applying it would cost an operation.
    pub(super) fn plain(&mut self, a: RealValue) -> Plain {
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
        let range = [0, 1].map(|end| signed[end].saturating_add(extent[end]));
        let word = self.sum(offset, Operand::Word(word), a.negated, range);
        whole(Operand::Word(word), range)
    }

    /// A number as an operand, its sign included.
    pub(super) fn operand(&mut self, a: RealValue) -> (Operand, [i64; 2]) {
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

    /// `a ± b`, which lies in `range`.
    pub(super) fn sum(&mut self, a: Operand, b: Operand, subtract: bool, range: [i64; 2]) -> Word {
        let RegisterShape { ty, width, signed } = self.shape(range);
        let target = self.emit(Op::Add {
            a,
            b,
            subtract,
            target: (ty, width),
        })[0];
        Self::whole(target, width, signed)
    }

    fn loaded(&mut self, offset: Affine) -> (Word, [i64; 2]) {
        let range = self.offset_range(offset);
        let RegisterShape { ty, width, signed } = self.shape(range);
        let parameter = self.parameter(PixelWord::Affine {
            constant: offset.constant,
            along: offset.along,
            fraction: self.fraction(),
            width,
        });
        let target = self.emit(Op::Load {
            parameter,
            target: (ty, width),
        })[0];
        (Self::whole(target, width, signed), range)
    }

    pub(super) fn plus(&mut self, a: RealValue, b: RealValue) -> RealValue {
        let offset = a.offset.plus(b.offset);
        let bias = a.bias + b.bias;
        let (Some(x), Some(y)) = (a.node, b.node) else {
            let (node, negated) = match a.node {
                Some(_) => (a.node, a.negated),
                None => (b.node, b.negated),
            };
            return RealValue {
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
                return RealValue::fixed(offset);
            }
            let bare = RealValue {
                offset: Affine::ZERO,
                ..a
            };
            let twice = self.times_constant(bare, 2.0);
            return RealValue {
                offset,
                bias,
                ..twice
            };
        }
        // The subtrahend is second. With equal signs, the order of the nodes decides, so that equal
        // sums are shared.
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
        let range = [0, 1].map(|end| fr[end].saturating_add(sr[end]));
        let word = self.sum(Operand::Word(f), Operand::Word(s), subtract, range);
        let sum = self.computed(word, range);
        let sum = if a.negated && b.negated {
            sum.negative()
        } else {
            sum
        };
        RealValue {
            offset: sum.offset.plus(offset),
            bias,
            ..sum
        }
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
