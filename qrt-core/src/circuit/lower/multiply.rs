//! Products, squares, and products with constants.
//!
//! A factor's bits as digits ±1 instead of 0 and 1, `2a + 1 = sum_i ±2^i` (the sign's turned),
//! make each row of a product an addition or subtraction by a bit: CNOTs and one carry chain, where
//! a row of ANDs would cost as much again. With the first two rows together,
//!
//! ```text
//! a b = a_0 b - 2 (not a_1) b  +  sum_(i>=2) ±2^(i-1) b
//! ```
//!
//! about `n^2 + n` Toffolis out of place. The square's digits multiply what is known of the number
//! so far, `X_k^2 = X_(k-1)^2 ± 2^(k+1) X_(k-1) + 4^k`, which halves the rows; a constant's digits
//! are the canonical signed ones (Reitwiesner 1960).
//!
//! Rows out of place leave their partial sums in scratch qubits; in place they cost twice the
//! Toffolis.

use super::super::Style;
use super::wires::{Bit, ONE, Wires, ZERO, bit_at};
use crate::circuit::Qubit;

/// Where a product's bits go: those below `drop` are scratch, those from it on the target's.
pub(super) struct Product<'a> {
    pub(super) drop: usize,
    pub(super) target: &'a [Qubit],
}

impl Product<'_> {
    /// Bits that matter.
    fn width(&self) -> usize {
        self.drop + self.target.len()
    }

    fn place(&self, wires: &mut Wires<'_>, bit: usize) -> Qubit {
        if bit < self.drop {
            wires.fresh()
        } else {
            self.target[bit - self.drop]
        }
    }
}

/// A number without its zeros below, and how many these are.
fn without_zeros(bits: &[Bit]) -> (&[Bit], usize) {
    let zeros = bits.iter().take_while(|bit| **bit == ZERO).count();
    (&bits[zeros..], zeros)
}

/// After the last row all bits are final.
const ALL: usize = usize::MAX;

/// A running sum whose low bits are final.
struct Rows<'a, 'b> {
    product: &'a Product<'b>,
    style: Style,
    /// The sum's bits from position `from` on; above its last it is extended by that.
    sum: Vec<Bit>,
    from: usize,
    /// In place: the qubits of the whole product, of which the first `filled` hold the sum.
    whole: Vec<Qubit>,
    filled: usize,
}

/// What a row adds: `(b ^ turn) + carry` where `when` holds.
struct Row<'a> {
    b: &'a [Bit],
    turn: Bit,
    carry: Bit,
    when: Bit,
}

impl<'a> Row<'a> {
    /// b or its negative, by a bit.
    fn signed(b: &'a [Bit], negative: Bit) -> Self {
        Self {
            b,
            turn: negative,
            carry: negative,
            when: ONE,
        }
    }
}

impl<'a, 'b> Rows<'a, 'b> {
    /// Rows over a sum that is `first` at position `at`.
    fn new(
        wires: &mut Wires<'_>,
        product: &'a Product<'b>,
        style: Style,
        first: &[Bit],
        at: usize,
    ) -> Self {
        let mut rows = Self {
            product,
            style,
            sum: first.to_vec(),
            from: at,
            whole: Vec::new(),
            filled: 0,
        };
        if style == Style::Lean {
            let bits = 0..product.width();
            rows.whole = bits.map(|bit| product.place(wires, bit)).collect();
            rows.filled = (at + first.len()).min(rows.whole.len());
            for (bit, &qubit) in first.iter().zip(rows.whole.iter().skip(at)) {
                wires.add_bit(*bit, qubit);
            }
        }
        rows
    }

    /// Adds a row at position `at`, below which all is final. The sum then has `width` bits from
    /// there on, its sign the last, and its lowest `fixed` bits are final.
    fn add(&mut self, wires: &mut Wires<'_>, row: &Row<'_>, at: usize, width: usize, fixed: usize) {
        let end = self.product.width();
        if at >= end {
            return;
        }
        let width = width.min(end - at);
        if self.style == Style::Lean {
            self.extend(wires, at + width);
            let t = &self.whole[at..at + width];
            wires.sum_into(row.b, row.turn, row.carry, row.when, t);
            return;
        }
        self.settle(wires, at);
        let t: Vec<Qubit> = (0..width)
            .map(|k| {
                if k < fixed {
                    self.product.place(wires, at + k)
                } else {
                    wires.fresh()
                }
            })
            .collect();
        wires.sum(&self.sum, row.b, row.turn, row.carry, &t);
        self.sum = t.into_iter().map(Bit::of).collect();
    }

    /// In place: copies the sign up to position `end`.
    fn extend(&mut self, wires: &mut Wires<'_>, end: usize) {
        while self.filled < end.min(self.whole.len()) {
            if let Some(below) = self.filled.checked_sub(1) {
                wires.cx(self.whole[below], self.whole[self.filled]);
            }
            self.filled += 1;
        }
    }

    /// The sum's bits below `at` are final.
    fn settle(&mut self, wires: &mut Wires<'_>, at: usize) {
        while self.from < at.min(self.product.width()) {
            let bit = bit_at(&self.sum, 0);
            if self.from >= self.product.drop {
                let target = self.product.target[self.from - self.product.drop];
                if bit.qubit() != Some(target) {
                    wires.add_bit(bit, target);
                }
            }
            if self.sum.len() > 1 {
                self.sum.remove(0);
            }
            self.from += 1;
        }
    }

    /// Everything is final.
    fn finish(&mut self, wires: &mut Wires<'_>) {
        match self.style {
            Style::Wide => self.settle(wires, self.product.width()),
            Style::Lean => self.extend(wires, self.product.width()),
        }
    }
}

impl Wires<'_> {
    /// `t ^= a`, extended by its last bit.
    pub(super) fn copy(&mut self, a: &[Bit], t: &[Qubit]) {
        for (place, &target) in t.iter().enumerate() {
            self.add_bit(bit_at(a, place), target);
        }
    }

    /// `digit and b`, in scratch qubits.
    fn ands(&mut self, digit: Bit, b: &[Bit], most: usize) -> Vec<Bit> {
        b.iter()
            .take(most)
            .map(|&bit| match bit {
                Bit::Constant(false) => ZERO,
                bit => {
                    let qubit = self.fresh();
                    self.and(digit, bit, qubit);
                    Bit::of(qubit)
                }
            })
            .collect()
    }

    /// `floor(a b / 2^drop)`. The last bits of `a` and `b` are their signs, or zeros.
    pub(super) fn product(&mut self, a: &[Bit], b: &[Bit], style: Style, product: &Product<'_>) {
        let (a, low) = without_zeros(a);
        let (b, more) = without_zeros(b);
        let at = low + more;
        if a.is_empty() || b.is_empty() || at >= product.width() {
            return;
        }
        // An unsigned number's last bit is a zero, which is no digit.
        let signed = a.last() != Some(&ZERO);
        let digits = a.len() - usize::from(!signed);
        let minus = |i: usize| signed && i + 1 == digits;
        let room = product.width() - at;
        if digits == 1 {
            // 0 or b, or for a sign 0 or -b.
            let row = self.ands(a[0], b, room);
            if signed {
                let mut rows = Rows::new(self, product, style, &[ZERO], at);
                let row = Row::signed(&row, ONE);
                rows.add(self, &row, at, b.len() + 1, ALL);
                rows.finish(self);
            } else {
                Rows::new(self, product, style, &row, at).finish(self);
            }
            return;
        }
        // a_0 b - 2 (not a_1) b, or 2 a_1 b if that is the sign.
        let second = a[1].xor(!minus(1));
        let first = self.ands(a[0], b, room);
        let mut rows = Rows::new(self, product, style, &first, at);
        // The third row stands where the second does.
        let fixed = if digits == 2 && signed { ALL } else { 0 };
        match style {
            Style::Wide => {
                let row = self.ands(second, b, room.saturating_sub(1));
                rows.add(self, &Row::signed(&row, ONE), at + 1, b.len() + 1, fixed);
            }
            Style::Lean => {
                let row = Row {
                    when: second,
                    ..Row::signed(b, ONE)
                };
                rows.add(self, &row, at + 1, b.len() + 1, fixed);
            }
        }
        for (i, &digit) in a.iter().enumerate().take(digits).skip(2) {
            // Digit 1 adds, 0 subtracts; a sign the other way round.
            let row = Row::signed(b, digit.xor(!minus(i)));
            let fixed = if minus(i) { ALL } else { 1 };
            rows.add(self, &row, at + i - 1, b.len() + 2, fixed);
        }
        if !signed {
            // The sign of an unsigned number: a digit +1.
            rows.add(
                self,
                &Row::signed(b, ZERO),
                at + digits - 1,
                b.len() + 2,
                ALL,
            );
        }
        rows.finish(self);
    }

    /// `floor(a^2 / 2^drop)`. The last bit of `a` is its sign, or a zero.
    pub(super) fn square(&mut self, a: &[Bit], style: Style, product: &Product<'_>) {
        let (a, zeros) = without_zeros(a);
        let at = 2 * zeros;
        if a.is_empty() || at >= product.width() {
            return;
        }
        let n = a.len();
        // With digits up to the k-th, X_k = sum_(i<=k) ±2^i and Y_k = (X_k^2 - 1)/4:
        // Y_k = Y_(k-1) ± 2^(k-1) X_(k-1) + 4^(k-1), Y_0 = 0, and Y_(n-1) = a^2 + a.
        let mut sum: Vec<Bit> = vec![ZERO];
        let mut done: Vec<Bit> = Vec::new();
        for k in 1..n {
            // X_(k-1): the digits' bits with a 1 below, and the last one's complement as the sign.
            let mut known = vec![ONE];
            known.extend_from_slice(&a[..k - 1]);
            known.push(a[k - 1].not());
            let turn = a[k].xor(k + 1 != n);
            while done.len() + 1 < k {
                done.push(sum_bit(&sum, 0));
                sum.remove(0);
            }
            // Y_(k-1) is below 4^(k-1): the constant has a place of its own.
            let mut plus: Vec<Bit> = (0..k - 1).map(|place| sum_bit(&sum, place)).collect();
            plus.extend([ONE, ZERO]);
            let t: Vec<Qubit> = (0..=k).map(|_| self.fresh()).collect();
            self.sum(&plus, &known, turn, turn, &t);
            sum = t.into_iter().map(Bit::of).collect();
        }
        done.extend(sum);
        done.push(ZERO);
        done.truncate(product.width() - at);
        // a^2 = (a^2 + a) - a
        let mut rows = Rows::new(self, product, style, &done, at);
        rows.add(self, &Row::signed(a, ONE), at, 2 * n, ALL);
        rows.finish(self);
    }

    /// `floor(factor a / 2^drop)`. The last bit of `a` is its sign, or a zero.
    pub(super) fn scale(&mut self, a: &[Bit], factor: i64, style: Style, product: &Product<'_>) {
        let (a, zeros) = without_zeros(a);
        let at = zeros + factor.trailing_zeros() as usize;
        if a.is_empty() || at >= product.width() {
            return;
        }
        let digits = digits(i128::from(factor >> factor.trailing_zeros()));
        let mut rows = if digits[0].1 {
            let mut rows = Rows::new(self, product, style, &[ZERO], at);
            let fixed = if digits.len() == 1 { ALL } else { 1 };
            rows.add(self, &Row::signed(a, ONE), at, a.len() + 1, fixed);
            rows
        } else {
            Rows::new(self, product, style, a, at)
        };
        for (number, &(place, minus)) in digits.iter().enumerate().skip(1) {
            // The sum so far is below 2^place a in magnitude.
            let row = Row::signed(a, Bit::Constant(minus));
            let fixed = if number + 1 == digits.len() { ALL } else { 1 };
            rows.add(self, &row, at + place, a.len() + 2, fixed);
        }
        rows.finish(self);
    }
}

fn sum_bit(sum: &[Bit], place: usize) -> Bit {
    sum.get(place).copied().unwrap_or(ZERO)
}

/// Signed digits of an odd number: places and whether they are subtracted. The first is a 1 where
/// that costs no more digits.
fn digits(factor: i128) -> Vec<(usize, bool)> {
    let canonical = signed_digits(factor, 0);
    if canonical[0].1 {
        let mut other = vec![(0, false)];
        other.extend(signed_digits((factor - 1) / 2, 1));
        if other.len() <= canonical.len() {
            return other;
        }
    }
    canonical
}

/// Canonical signed digits: no two neighbours.
fn signed_digits(mut rest: i128, mut place: usize) -> Vec<(usize, bool)> {
    let mut digits = Vec::new();
    while rest != 0 {
        if rest & 1 == 1 {
            let minus = rest & 3 == 3;
            digits.push((place, minus));
            rest += if minus { 1 } else { -1 };
        }
        rest >>= 1;
        place += 1;
    }
    digits
}
