//! Squares.
//!
//! With digits of either sign, `2a + 1 = sum d_i 2^i` (see [`super::multiply`]), the product of two
//! digits is a sign, and of each pair one product suffices: with `h_i = a >> (i + 1)` and u_i = h_i
//! where a_i holds and its complement elsewhere, `a^2 = -a + 2 sum 4^i (u_i + 1)`. The rows need no
//! ANDs, and get shorter: about n^2 / 2 Toffolis in all. The first of them and -a are together
//! `a_0 - 4 (not a_0) h_0`.

use super::super::{Style, Word};
use super::multiply::Landing;
use super::{Gates, Lowering, Qubit, Wire, extended, invert, qubits};

/// Bits of a square that are computed.
pub(super) fn needed(a: Word, landing: &Landing) -> usize {
    let bits = 2 * a.width as usize - usize::from(a.signed);
    landing.needed(bits, false)
}

impl Lowering {
    pub(super) fn square(&mut self, a: Word, drop: u32, style: Style, target: &[Qubit]) {
        let landing = Landing::new(2 * a.shift, drop, target);
        let needed = needed(a, &landing);
        // A sign bit, and 0 above where there is none.
        let digits = a.width as usize + usize::from(!a.signed);
        let a = self.word(Word { shift: 0, ..a }, digits);
        if let Some(t) = landing.at(0).filter(|_| needed > 0) {
            self.copy(a[0], t);
        }
        let single = a.len() == 1 || a[1] == Wire::ZERO;
        if single || needed < 3 {
            return;
        }
        match style {
            Style::Wide => self.square_rows(&a, needed, &landing),
            Style::Lean => self.square_rows_into(&a, needed, &landing),
        }
    }

    fn square_rows(&mut self, a: &[Wire], needed: usize, landing: &Landing) {
        let n = a.len();
        let first = self.first_row(a, needed - 2);
        let bits = n.min(needed - 2);
        let last = if n == 2 { bits } else { 1 };
        let mut sum = self.partial(landing, 2, bits, last);
        let mut y = extended(&first, first[first.len() - 1], bits);
        invert(&mut y, true);
        self.add(&vec![Wire::ZERO; bits], &y, Wire::ONE, &sum);
        sum.remove(0);
        for place in 1..n - 1 {
            let from = 2 * place + 1;
            let Some(bits) = needed.checked_sub(from).filter(|bits| *bits > 0) else {
                break;
            };
            let bits = bits.min(n - place + 1);
            let last = if place + 2 == n { bits } else { 2 };
            let sign = a[place].xor(true);
            let row = self.complement(sign, &a[place + 1..]);
            let row = extended(&row, row[row.len() - 1], bits);
            let rest = extended(&qubits(&sum), Wire::qubit(sum[sum.len() - 1]), bits);
            let t = self.partial(landing, from, bits, last);
            self.add(&rest, &row, Wire::ONE, &t);
            self.complement(sign, &a[place + 1..]);
            sum = t.get(2..).unwrap_or_default().to_vec();
        }
    }

    /// `(not a_0) h_0`, out of place.
    fn first_row(&mut self, a: &[Wire], needed: usize) -> Vec<Wire> {
        let mut row = Vec::new();
        for bit in a[1..].iter().take(needed) {
            row.push(if bit.source().is_some() {
                let t = self.draw();
                self.and(a[0].xor(true), *bit, t);
                Wire::qubit(t)
            } else {
                *bit
            });
        }
        row
    }

    fn square_rows_into(&mut self, a: &[Wire], needed: usize, landing: &Landing) {
        let n = a.len();
        // Bit 0 is a's, and bit 1 is zero.
        let square = self.lands(landing, 2, needed - 2);
        for (bit, t) in a[1..].iter().zip(&square) {
            self.and(a[0].xor(true), *bit, *t);
        }
        let signed = a[n - 1] != Wire::ZERO;
        self.negate_in_place(&square, n - 1, signed);
        for place in 1..n - 1 {
            let from = 2 * place - 1;
            let Some(bits) = square.len().checked_sub(from).filter(|bits| *bits > 0) else {
                break;
            };
            let bits = bits.min(n - place + 1);
            let window = &square[from..from + bits];
            if bits == n - place + 1 {
                self.cx(window[bits - 2], window[bits - 1]);
            }
            // a_i says where the row is not complemented.
            let rest = &a[place + 1..];
            let own: Vec<Qubit> = rest.iter().filter_map(|wire| wire.source()).collect();
            let sign = a[place].xor(true);
            self.flips(sign, &own);
            let row: Vec<Wire> = rest
                .iter()
                .map(|wire| if wire.source().is_some() { *wire } else { sign })
                .collect();
            let row = extended(&row, row[row.len() - 1], bits);
            self.add_into(&row, true, Wire::ONE, window);
            self.flips(sign, &own);
        }
    }
}
