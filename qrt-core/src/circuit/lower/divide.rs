//! Quotients.
//!
//! Division without restoring: each step doubles the remainder, brings down a bit of the dividend,
//! and subtracts the divisor where the remainder is not negative and adds it where it is; the sign of
//! what comes out is the complement of the quotient's bit, and its qubit is that bit's. Remainders lie
//! in [-b, b), and have one bit more than b.
//!
//! Where b is 0 the dividend's bits would reach the sign of the remainder if the quotient is wider
//! than b; those bits are therefore ANDed with `b != 0`.

use super::super::{Style, Word};
use super::{Gates, Lowering, Qubit, Wire, extended, qubits};

impl Lowering {
    pub(super) fn divide(
        &mut self,
        a: Word,
        b: Word,
        style: Style,
        quotient: &[Qubit],
        fits: Qubit,
    ) {
        let keep = style == Style::Wide;
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
            let t = self.draw();
            self.and(Wire::qubit(fits), *wire, t);
            *wire = Wire::qubit(t);
        }
        // Bits that would reach the sign of the remainder.
        let long = (bits..n).any(|place| number[place].source().is_some());
        let mut some = Wire::ONE;
        let mut borrowed = None;
        if long && number.len() == n {
            some = Wire::qubit(fits);
        } else if long {
            let at = if keep { self.draw() } else { self.pool.take() };
            self.less(&vec![Wire::ZERO; bits], &b, at, keep);
            some = Wire::qubit(at);
            borrowed = Some(at).filter(|_| !keep);
        }
        match style {
            Style::Wide => {
                let mut low = number[..n].to_vec();
                for wire in low.iter_mut().skip(bits) {
                    if wire.source().is_some() {
                        let t = self.draw();
                        self.and(some, *wire, t);
                        *wire = Wire::qubit(t);
                    }
                }
                let copies = self.detach(&mut low, &b);
                self.remainders(&low, high, &b, quotient);
                self.attach(copies);
            }
            Style::Lean => {
                let mut all = self.draws(bits);
                all.extend_from_slice(quotient);
                for (place, wire) in number[..n].iter().enumerate() {
                    let some = if place < bits { Wire::ONE } else { some };
                    self.and(some, *wire, all[place]);
                }
                for (wire, t) in high.iter().zip(&all[n..]) {
                    self.and(Wire::qubit(fits), *wire, *t);
                }
                if let Some(at) = borrowed {
                    self.less(&vec![Wire::ZERO; bits], &b, at, false);
                    self.pool.give(at);
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
            let mut t = self.draws(b.len());
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
