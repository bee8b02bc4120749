//! Quotients.

use super::number::RegisterShape;
use super::value::{BoolValue, RealValue, bits_above};
use super::{BuildError, Builder, GARBAGE, Garbage, MAX_BITS, table};
use qrt_circuit::{Bit, Op, Operand, Type, Word};

/// A quotient of magnitudes.
struct Quotient {
    /// `floor(|a| / |b|)`, in ulps.
    value: RealValue,
    /// True if the quotient fits its register. Otherwise `value` is meaningless.
    fits: BoolValue,
    /// The greatest value of its register, in ulps.
    most: i64,
}

impl Builder<'_> {
    /// The bound on `|a / b|`: `most`, or the bound that the intervals give if it is smaller.
    fn quotient_bound(&mut self, a: RealValue, b: RealValue, most: f64) -> f64 {
        let (a, b) = (self.range(a), self.range(b));
        let divisor = if b[0] > 0 {
            b[0]
        } else if b[1] < 0 {
            -b[1]
        } else {
            0
        };
        let dividend = a[0].unsigned_abs().max(a[1].unsigned_abs());
        most.min(dividend as f64 / divisor as f64)
    }

    fn quotient(&mut self, a: Word, b: Word, most: f64, range: [i64; 2]) -> Quotient {
        // The dividend is shifted left by the number of fraction bits of the quotient. The shift is
        // smaller if the dividend would not fit `MAX_BITS` bits.
        let fraction = self.fraction();
        let lost = (a.bits() + fraction).saturating_sub(MAX_BITS);
        let lost = lost.min(fraction);
        let shift = fraction - lost;
        let a = Word {
            shift: a.shift + shift,
            ..a
        };
        let width = (bits_above(most) + shift).clamp(1, MAX_BITS);
        let fraction_type = Type::UFixed { fraction: shift };
        let style = self.style(Garbage::Quotients);
        let results = self.emit(Op::Divide {
            a,
            b,
            style,
            quotient: (fraction_type, width),
            fits: (Type::Bool, 1),
            scratch: GARBAGE,
        });
        let all = (1_i64 << width) - 1;
        let value = self.computed(
            Self::whole(results[0], width, false),
            [0, all.min(range[1] >> lost)],
        );
        let value = match value.node {
            Some(node) if lost > 0 => self.shifted(node, lost as i32),
            _ => value,
        };
        // The intervals may prove that the quotient fits.
        let fits = if range[1] >> lost <= all {
            BoolValue::Constant(true)
        } else {
            self.truth_of(Bit {
                register: results[1],
                index: 0,
                inverted: false,
            })
        };
        Quotient {
            value,
            fits,
            most: all << lost,
        }
    }

    /// The unsigned word of a number that is at least 0, and its interval; none without bits.
    fn unsigned(&mut self, a: RealValue) -> Option<(Word, [i64; 2])> {
        let (operand, range) = self.operand(a);
        let word = match operand {
            Operand::Word(word) => word,
            Operand::Constant(value) => self.constant_word(value),
        };
        let range = range.map(|end| end.max(0));
        if word.signed {
            // The sign bit is 0 on every path that uses the number.
            if word.width == 1 {
                return None;
            }
            let word = Word {
                width: word.width - 1,
                signed: false,
                ..word
            };
            return Some((word, range));
        }
        Some((word, range))
    }

    /// A register that holds a constant.
    pub(super) fn constant_word(&mut self, value: i64) -> Word {
        let RegisterShape { ty, width, signed } = self.shape([value; 2]);
        let target = self.emit(Op::Add {
            a: Operand::Constant(value),
            b: Operand::Constant(0),
            subtract: false,
            target: (ty, width),
        })[0];
        Self::whole(target, width, signed)
    }

    fn quotient_range(a: [i64; 2], b: [i64; 2], fraction: u32) -> [i64; 2] {
        let least = b[0].max(0);
        if least == 0 {
            return [0, i64::MAX];
        }
        let most = (i128::from(a[1]) << fraction) / i128::from(least);
        [0, most.min(i64::MAX.into()) as i64]
    }

    /// `a / b`, clamped: to `±most` if it is a table, otherwise to the greatest value of its register.
    pub(super) fn over(&mut self, a: RealValue, b: RealValue, most: f64) -> RealValue {
        if let Some(divisor) = b.as_constant() {
            return self.times_constant(a, 1.0 / divisor);
        }
        if a.as_constant() == Some(0.0) {
            return a;
        }
        let most = self.quotient_bound(a, b, most);
        if !most.is_finite() {
            self.fail(BuildError::UnboundedQuotient);
            return RealValue::constant(0.0);
        }
        let quotient = |a: f64, b: f64| {
            let quotient = a / b;
            if quotient.is_nan() {
                0.0
            } else {
                quotient.clamp(-most, most)
            }
        };
        let cost = self.fraction() * self.fraction();
        if let Some(table) = self.tabulate_pair(a, b, cost, quotient) {
            return table;
        }
        let (x, y) = (self.negative_sign(a), self.negative_sign(b));
        let sign = self.differ(x, y);
        let (a, b) = (self.signed(a, x), self.signed(b, y));
        let (Some((a, ar)), Some((b, br))) = (self.unsigned(a), self.unsigned(b)) else {
            return RealValue::constant(0.0);
        };
        let range = Self::quotient_range(ar, br, self.fraction());
        let quotient = self.quotient(a, b, most, range);
        let most = RealValue::constant(quotient.most as f64 * self.ulp());
        let held = self.chosen(quotient.fits, quotient.value, most);
        self.signed(held, sign)
    }

    /// Returns whether `a / b` is at least 0 and fits below `most`, and the quotient if so. A dividend
    /// that is the constant 0 is not ahead: the ray starts on the plane.
    pub(super) fn ahead_of(
        &mut self,
        a: RealValue,
        b: RealValue,
        most: f64,
    ) -> (BoolValue, RealValue) {
        if a.as_constant() == Some(0.0) {
            return (BoolValue::Constant(false), a);
        }
        if let Some(divisor) = b.as_constant() {
            if divisor == 0.0 {
                // The ray is parallel to the plane.
                return (BoolValue::Constant(false), RealValue::constant(0.0));
            }
            let quotient = self.times_constant(a, 1.0 / divisor);
            let behind = self.negative_sign(quotient);
            let reach = RealValue::constant(self.farthest(most));
            let near = self.is_less(quotient, reach);
            return (self.both(behind.negated(), near), quotient);
        }
        if let Some(tabulated) = self.tabulated_ahead(a, b, most) {
            return tabulated;
        }
        // Flip both signs where `b` is negative, so that the divisor is positive.
        let sign = self.negative_sign(b);
        let (a, b) = (self.signed(a, sign), self.signed(b, sign));
        let behind = self.negative_sign(a);
        let (Some((a, ar)), Some((b, br))) = (self.unsigned(a), self.unsigned(b)) else {
            return (BoolValue::Constant(false), RealValue::constant(0.0));
        };
        // A negative dividend is read without its sign bit. Its quotient may exceed every quotient
        // ahead.
        let range = if behind == BoolValue::Constant(false) {
            Self::quotient_range(ar, br, self.fraction())
        } else {
            [0, i64::MAX]
        };
        let quotient = self.quotient(a, b, most, range);
        let ahead = self.both(behind.negated(), quotient.fits);
        (ahead, self.rounded_down(quotient.value))
    }

    /// [`Builder::ahead_of`] as tables, if `a` and `b` are tables and arithmetic would cost more. A
    /// dividend that rounds to 0 is not ahead, and the quotient is rounded to nearest.
    fn tabulated_ahead(
        &mut self,
        a: RealValue,
        b: RealValue,
        most: f64,
    ) -> Option<(BoolValue, RealValue)> {
        if !self.target.passes.tabulate {
            return None;
        }
        let (x, y) = (self.table_of(a)?, self.table_of(b)?);
        let (farthest, half) = (self.farthest(most), 0.5 * self.ulp());
        let is_ahead = move |a: f64, b: f64| {
            let quotient = a / b;
            a.abs() >= half && quotient > 0.0 && quotient <= farthest
        };
        let cost = self.fraction() * self.fraction();
        let ahead = table::joined(&x, &y, cost, |a, b| f64::from(u8::from(is_ahead(a, b))))?;
        let quotient = table::joined(
            &x,
            &y,
            cost,
            |a, b| if is_ahead(a, b) { a / b } else { 0.0 },
        )?;
        Some((self.tabulated_truth(ahead), self.tabulated(quotient)))
    }

    /// The greatest number of the register that holds quotients up to `most`.
    pub(super) fn farthest(&mut self, most: f64) -> f64 {
        (1_u64 << bits_above(most)) as f64 - self.ulp()
    }
}
