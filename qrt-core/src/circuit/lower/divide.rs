//! Quotients and square roots, by digits that are never restored.
//!
//! A step of the division adds the divisor to the remainder or subtracts it, by the remainder's
//! sign; the signs are the quotient. So does a step of the root with `4 q + 3` and `-(4 q + 1)`,
//! which differ in the sign's XOR alone: `-(4 q + 1) = 4 (not q) + 3`. Remainders are as wide as
//! they must be, so that no operand is an exception.

use super::super::Style;
use super::wires::{Bit, ONE, Wires, ZERO, bit_at};
use crate::circuit::Qubit;

impl Wires<'_> {
    /// See [`crate::circuit::Op::Divide`]; `a` and `b` are unsigned and without a sign bit.
    pub(super) fn divide(
        &mut self,
        a: &[Bit],
        b: &[Bit],
        style: Style,
        quotient: &[Qubit],
        fits: Qubit,
    ) {
        let n = quotient.len();
        let (low, high) = a.split_at(n.min(a.len()));
        let mut divisor = b.to_vec();
        divisor.push(ZERO);
        // f = high < b: the borrow of high - b.
        let mut above = high.to_vec();
        above.push(ZERO);
        match style {
            Style::Wide => {
                let width = above.len().max(divisor.len());
                let t: Vec<Qubit> = (0..width).map(|_| self.fresh()).collect();
                self.sum(&above, &divisor, ONE, ONE, &t);
                self.cx(t[width - 1], fits);
            }
            Style::Lean => self.less(&above, &divisor, fits),
        }
        // Where it does not fit, the dividend is zero.
        let f = Bit::of(fits);
        let masked = |wires: &mut Self, bit: Bit| match bit {
            Bit::Constant(false) => ZERO,
            bit => {
                let qubit = wires.fresh();
                wires.and(f, bit, qubit);
                Bit::of(qubit)
            }
        };
        let low: Vec<Bit> = low.iter().map(|&bit| masked(self, bit)).collect();
        let high = high.iter().take(b.len());
        let high: Vec<Bit> = high.map(|&bit| masked(self, bit)).collect();
        // The remainder has one bit more than the divisor: its sign.
        let width = b.len() + 1;
        let mut rest: Vec<Bit> = (0..b.len()).map(|k| sum_bit(&high, k)).collect();
        let mut place: Vec<Qubit> = Vec::new();
        if style == Style::Lean {
            // In place: the window moves down by a qubit a step.
            place = (0..width + n).map(|_| self.fresh()).collect();
            for (k, &bit) in rest.iter().enumerate() {
                self.add_bit(bit, place[n + k]);
            }
            for (k, &bit) in low.iter().enumerate() {
                self.add_bit(bit, place[k]);
            }
        }
        let mut subtract = ONE;
        for i in (0..n).rev() {
            let sign = match style {
                Style::Wide => {
                    let mut next = vec![sum_bit(&low, i)];
                    next.extend_from_slice(&rest[..width - 1]);
                    let t: Vec<Qubit> = (0..width).map(|_| self.fresh()).collect();
                    self.sum(&next, &divisor, subtract, subtract, &t);
                    rest = t.iter().map(|&qubit| Bit::of(qubit)).collect();
                    t[width - 1]
                }
                Style::Lean => {
                    let t: Vec<Qubit> = place[i..i + width].to_vec();
                    self.sum_into(&divisor, subtract, subtract, ONE, &t);
                    t[width - 1]
                }
            };
            self.cx(sign, quotient[i]);
            self.x(quotient[i]);
            subtract = Bit::of(quotient[i]);
        }
    }

    /// `floor(sqrt(a))`; `a` is unsigned and without a sign bit.
    pub(super) fn root(&mut self, a: &[Bit], target: &[Qubit]) {
        let digits = a.len().div_ceil(2);
        let mut root: Vec<Bit> = Vec::new();
        let mut rest: Vec<Bit> = Vec::new();
        let mut sign = ONE;
        for step in 0..digits {
            let i = digits - 1 - step;
            let width = step + 3;
            let mut next = vec![sum_bit(a, 2 * i), sum_bit(a, 2 * i + 1)];
            next.extend(rest.iter().take(width - 2));
            next.resize(width, ZERO);
            // 4 (q ^ s) + 3, extended by s, for s = 1 where it is subtracted.
            let mut addend = vec![ONE, ONE];
            addend.extend(root.iter().rev());
            addend.resize(width, ZERO);
            let t: Vec<Qubit> = (0..width).map(|_| self.fresh()).collect();
            self.sum_turned(&next, &addend, sign, &t);
            rest = t.iter().map(|&qubit| Bit::of(qubit)).collect();
            let digit = match target.get(i) {
                Some(&qubit) => qubit,
                None => self.fresh(),
            };
            self.cx(t[width - 1], digit);
            self.x(digit);
            sign = Bit::of(digit);
            root.push(sign);
        }
    }

    /// `t = a + (b ^ turn)`, of whose bits b's two lowest are not turned.
    fn sum_turned(&mut self, a: &[Bit], b: &[Bit], turn: Bit, t: &[Qubit]) {
        let mut turned = Vec::with_capacity(b.len());
        for (place, &bit) in b.iter().enumerate() {
            turned.push(if place < 2 {
                bit
            } else {
                self.turned(bit, turn)
            });
        }
        self.sum(a, &turned, ZERO, ZERO, t);
        for (place, &bit) in b.iter().enumerate().rev() {
            if place >= 2 {
                self.turned(bit, turn);
            }
        }
    }
}

fn sum_bit(bits: &[Bit], place: usize) -> Bit {
    if place < bits.len() {
        bit_at(bits, place)
    } else {
        ZERO
    }
}
