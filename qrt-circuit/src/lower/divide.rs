//! Quotients.
//!
//! Division without restoring. Each step doubles the remainder and brings down a bit of the
//! dividend. Then it subtracts the divisor where the remainder is not negative, and adds it where
//! the remainder is negative. The sign of the result is the complement of the quotient's bit, and
//! its qubit becomes that bit. Remainders lie in [-b, b), and have one bit more than b.
//!
//! If the dividend has more than n bits, its bits are ANDed with `a < b 2^n`. Otherwise the
//! quotient always fits unless b is 0. Then the dividend's bits would reach the sign of the
//! remainder if the quotient is wider than b, and only those bits are ANDed.

use super::super::{Style, Word};
use super::{GateSink, Lowering, Qubit, Wire, extended, qubits};

impl Lowering {
    pub(super) fn divide(
        &mut self,
        a: Word,
        b: Word,
        style: Style,
        quotient: &[Qubit],
        fits: Qubit,
    ) {
        let keep = style == Style::OutOfPlace;
        let n = quotient.len();
        let bits = b.bits() as usize;
        let number = self.word(a, (a.bits() as usize).max(n));
        let b = self.word(b, bits);
        let width = bits.max(number.len() - n);
        let high = extended(&number[n..], Wire::ZERO, width);
        self.less(&high, &extended(&b, Wire::ZERO, width), fits, keep);
        if n == 0 {
            return;
        }
        let mut high = high[..bits].to_vec();
        for wire in high
            .iter_mut()
            .filter(|wire| keep && wire.source().is_some())
        {
            let t = self.garbage_bit();
            self.and(Wire::qubit(fits), *wire, t);
            *wire = Wire::qubit(t);
        }
        let cut = if number.len() > n { 0 } else { bits };
        match style {
            Style::OutOfPlace => {
                let mut low = number[..n].to_vec();
                for wire in low.iter_mut().skip(cut) {
                    if wire.source().is_some() {
                        let t = self.garbage_bit();
                        self.and(Wire::qubit(fits), *wire, t);
                        *wire = Wire::qubit(t);
                    }
                }
                let copies = self.detach(&mut low, &b);
                self.remainders(&low, high, &b, quotient);
                self.attach(copies);
            }
            Style::InPlace => {
                let mut all = self.allocate_garbage(bits);
                all.extend_from_slice(quotient);
                for (place, wire) in number[..n].iter().enumerate() {
                    let fits = if place < cut {
                        Wire::ONE
                    } else {
                        Wire::qubit(fits)
                    };
                    self.and(fits, *wire, all[place]);
                }
                for (wire, t) in high.iter().zip(&all[n..]) {
                    self.and(Wire::qubit(fits), *wire, *t);
                }
                self.remainders_into(&b, &all, n);
            }
        }
    }

    fn remainders(&mut self, low: &[Wire], high: Vec<Wire>, b: &[Wire], quotient: &[Qubit]) {
        let mut remainder = high;
        let mut subtract = Wire::ONE;
        for (place, q) in quotient.iter().enumerate().rev() {
            let mut number = vec![low[place]];
            number.append(&mut remainder);
            let row = self.complement(subtract, b);
            let row = extended(&row, subtract, number.len());
            let mut t = self.allocate_garbage(b.len());
            t.push(*q);
            self.add(&number, &row, subtract, &t);
            self.complement(subtract, b);
            self.x(*q);
            subtract = Wire::qubit(*q);
            t.pop();
            remainder = qubits(&t);
        }
    }

    fn remainders_into(&mut self, b: &[Wire], all: &[Qubit], n: usize) {
        let mut subtract = Wire::ONE;
        for place in (0..n).rev() {
            let window = &all[place..=place + b.len()];
            self.flips(subtract, window);
            let number = extended(b, Wire::ZERO, window.len());
            self.add_into(&number, false, Wire::ONE, window);
            self.flips(subtract, window);
            let sign = window[b.len()];
            self.x(sign);
            subtract = Wire::qubit(sign);
        }
    }
}
