//! Square roots and lengths.

use super::number::RegisterShape;
use super::value::RealValue;
use super::{Builder, GARBAGE, Garbage, MAX_BITS};
use qrt_circuit::{Op, Operand, Word};

impl Builder<'_> {
    /// The length of `v`: the root of a sum of squares. The squares keep all bits that fit.
    pub(super) fn norm(&mut self, v: [RealValue; 3]) -> RealValue {
        // Squares are in units of 4^-fraction. Low bits are dropped so that the greatest sum fits.
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
            return RealValue::constant((exact / (self.units() * self.units())).sqrt());
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
                RealValue::constant((square as f64).sqrt() * self.ulp())
            }
            None => RealValue::constant(0.0),
        }
    }

    /// `floor(sqrt(word))`, as ulps.
    fn integer_root(&mut self, word: Word, range: [i64; 2]) -> RealValue {
        let range = range.map(|end| end.max(0).cast_unsigned().isqrt().cast_signed());
        let RegisterShape { ty, width, signed } = self.shape(range);
        let style = self.style(Garbage::Quotients);
        let a = Word {
            signed: false,
            ..word
        };
        let target = self.emit(Op::SquareRoot {
            a,
            style,
            target: (ty, width),
            scratch: GARBAGE,
        })[0];
        self.computed(Self::whole(target, width, signed), range)
    }

    /// `sqrt(max(a, 0))`, rounded down.
    pub(super) fn root(&mut self, a: RealValue) -> RealValue {
        if let Some(constant) = a.as_constant() {
            return RealValue::constant(constant.max(0.0).sqrt());
        }
        if let Some(root) = self.tabulate_one(a, |a| a.max(0.0).sqrt()) {
            return root;
        }
        let a = if self.range(a)[0] < 0 {
            self.greater(a, RealValue::constant(0.0))
        } else {
            a
        };
        let (operand, range) = self.operand(a);
        let Operand::Word(word) = operand else {
            return RealValue::constant(0.0);
        };
        // Zeros appended below give the root its fraction bits: `fraction` zeros, or two fewer for
        // each fraction bit that the root then lacks.
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
}
