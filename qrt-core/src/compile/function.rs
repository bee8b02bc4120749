//! Smooth functions of a number that has too many bits for a table: piecewise polynomials.
//!
//! The top bits of the argument select a piece. The other bits are the position t in [0, 1) on the
//! piece. The value is `c0 + t (c1 + t c2)`, with coefficients from a table. The pieces are halved
//! until the greatest error at their quarter points is at most half a unit in the last place, or
//! until there are `2^MOST_PIECES` pieces.

use super::value::{RealValue, Tabulated};
use super::{BuildError, Builder, MAX_BITS};
use qrt_circuit::{Operand, Word};
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};

/// Most bits that select a piece.
const MOST_PIECES: u32 = 10;

/// Most bits of an argument whose function is one plain table.
const PLAIN_TABLE: u32 = 9;

/// The parabola through a piece's ends and its middle.
#[derive(Clone, Copy)]
struct Piece {
    coefficients: [f64; 3],
    error: f64,
}

impl Piece {
    fn new(f: impl Fn(f64) -> f64) -> Self {
        let (start, middle, end) = (f(0.0), f(0.5), f(1.0));
        let bend = 2.0 * (start + end - 2.0 * middle);
        let coefficients = [start, end - start - bend, bend];
        let error = [0.25, 0.75].map(|t| (evaluate(coefficients, t) - f(t)).abs());
        Self {
            coefficients,
            error: error[0].max(error[1]),
        }
    }
}

fn evaluate([c0, c1, c2]: [f64; 3], t: f64) -> f64 {
    c0 + t * (c1 + t * c2)
}

impl Builder<'_> {
    /// `f(a)`, for a function `f` that is smooth except at isolated points.
    pub(super) fn smooth(&mut self, a: RealValue, f: impl Fn(f64) -> f64) -> RealValue {
        if let Some(constant) = a.as_constant() {
            let value = f(constant);
            if value.is_infinite() {
                self.fail(BuildError::UnboundedFunction);
            }
            return RealValue::constant(value);
        }
        if let Some(table) = self.tabulate_one(a, &f) {
            return table;
        }
        let (operand, range) = self.operand(a);
        let ulp = self.ulp();
        match operand {
            Operand::Word(word) => self.fitted(word, range, |x| f(x as f64 * ulp)),
            Operand::Constant(value) => RealValue::constant(f(value as f64 * ulp)),
        }
    }

    /// `f(word)`, if the values of `word` are in `range`.
    pub(super) fn fitted(
        &mut self,
        word: Word,
        range: [i64; 2],
        f: impl Fn(i64) -> f64,
    ) -> RealValue {
        let word = Word { shift: 0, ..word };
        let bits = word.width;
        if bits > MAX_BITS {
            let what = "a function's operand";
            self.too_many_bits(what, bits);
            return RealValue::constant(0.0);
        }
        let sign = word.signed;
        // The number that the word's bits, `code`, stand for, clamped to `range`: codes outside do
        // not occur.
        let number = |code: u64| {
            let negative = sign && code >> (bits - 1) & 1 == 1;
            let value = if negative {
                code.cast_signed() - (1 << bits)
            } else {
                code.cast_signed()
            };
            value.clamp(range[0], range[1])
        };
        let is_bounded = Cell::new(true);
        let finite = |value: f64| {
            if value.is_infinite() {
                is_bounded.set(false);
            }
            if value.is_finite() { value } else { 0.0 }
        };
        let address = |count: u32| {
            let top = Word {
                offset: word.offset + bits - count,
                width: count,
                ..word
            };
            Self::bits(top).collect()
        };
        if bits <= PLAIN_TABLE {
            let entries = (0..1_u64 << bits).map(|code| finite(f(number(code))));
            let table = Tabulated {
                address: address(bits),
                entries: entries.collect(),
            };
            if !is_bounded.get() {
                self.fail(BuildError::UnboundedFunction);
            }
            return self.tabulated(table);
        }
        let ulp = self.ulp();
        let mut pieces = Vec::new();
        let mut count = 3;
        loop {
            let rest = bits - count;
            pieces.clear();
            pieces.extend((0..1_u64 << count).map(|piece| {
                Piece::new(|t| {
                    let within = (t * (1_u64 << rest) as f64) as u64;
                    let last = (1_u64 << rest) - 1;
                    finite(f(number(piece << rest | within.min(last))))
                })
            }));
            let worst = pieces.iter().map(|piece| piece.error).fold(0.0, f64::max);
            if worst <= 0.5 * ulp || count == MOST_PIECES.min(bits - 1) {
                break;
            }
            count += 1;
        }
        if !is_bounded.get() {
            self.fail(BuildError::UnboundedFunction);
        }
        let rest = bits - count;
        let flat = pieces
            .iter()
            .all(|piece| piece.coefficients[2].abs() < 0.5 * ulp);
        let column = |k: usize| Tabulated {
            address: address(count),
            entries: pieces.iter().map(|piece| piece.coefficients[k]).collect(),
        };
        let columns = [column(0), column(1), column(2)];
        let [c0, c1, c2] = columns.map(|column| self.tabulated(column));
        // The position on the piece: its top bits, at most the number of fraction bits.
        let kept = rest.min(self.fraction());
        let place = Word {
            offset: word.offset + rest - kept,
            width: kept,
            signed: false,
            shift: self.fraction() - kept,
            ..word
        };
        let t = self.computed(place, place.range());
        let slope = if flat {
            c1
        } else {
            let bend = self.times(c2, t);
            self.plus(c1, bend)
        };
        let rise = self.times(slope, t);
        self.plus(c0, rise)
    }

    /// `a^b` for `a >= 0`.
    pub(super) fn power(&mut self, a: RealValue, b: RealValue) -> RealValue {
        if let Some(exponent) = b.as_constant() {
            return self.smooth(a, |a| libm::pow(a.max(0.0), exponent));
        }
        if let Some(table) = self.tabulate_pair(a, b, u32::MAX, |a, b| libm::pow(a.max(0.0), b)) {
            return table;
        }
        // Numbers below one ulp get the logarithm of one ulp: the format cannot distinguish them.
        let least = self.ulp();
        let log = self.smooth(a, |a| libm::log(a.max(least)));
        let exponent = self.times(b, log);
        self.smooth(exponent, libm::exp)
    }

    /// The angle of the vector (x, y), in `-pi ..= pi`.
    pub(super) fn angle(&mut self, y: RealValue, x: RealValue) -> RealValue {
        if let Some(table) = self.tabulate_pair(y, x, u32::MAX, libm::atan2) {
            return table;
        }
        let (width, height) = (self.magnitude(x), self.magnitude(y));
        let steep = self.is_less(width, height);
        let (least, most) = (self.lesser(width, height), self.greater(width, height));
        let ratio = self.over(least, most, 1.0);
        let angle = self.smooth(ratio, libm::atan);
        let other = self.plus(RealValue::constant(FRAC_PI_2), angle.negative());
        let angle = self.chosen(steep, other, angle);
        let left = self.negative_sign(x);
        let other = self.plus(RealValue::constant(PI), angle.negative());
        let angle = self.chosen(left, other, angle);
        let below = self.negative_sign(y);
        self.signed(angle, below)
    }
}
