//! Squares.
//!
//! With digits of either sign, `2a + 1 = sum d_i 2^i` (see [`super::multiply`]). Let X_k be the sum
//! of the digits up to the k-th; then `X_k^2 = X_(k-1)^2 + d_k 2^(k+1) X_(k-1) + 4^k`. A row adds
//! or subtracts the known part of the number, which takes no ANDs, and rows are half the length of
//! a product's. The last of `Y_k = (X_k^2 - 1) / 4` is `a^2 + a`, from which a is subtracted. That
//! takes about n^2 / 2 Toffolis in all.

use super::super::{Style, Word};
use super::multiply::Landing;
use super::{GateSink, Lowering, Qubit, Wire, extended, invert, qubits};

/// Number of bits of a square that are computed.
pub(super) fn needed(a: Word, landing: &Landing) -> usize {
    let bits = 2 * a.width as usize - usize::from(a.signed);
    landing.needed(bits, false)
}

/// Number of bits that row `place` changes, from bit `place - 1` on.
pub(super) fn row_bits(place: usize, needed: usize) -> usize {
    (place + 1).min((needed + 1).saturating_sub(place))
}

impl Lowering {
    pub(super) fn square(&mut self, a: Word, drop: u32, style: Style, target: &[Qubit]) {
        let landing = Landing::new(2 * a.shift, drop, target);
        let needed = needed(a, &landing);
        if needed == 0 {
            return;
        }
        // The top digit is the sign bit, or 0 for an unsigned number.
        let digits = a.width as usize + usize::from(!a.signed);
        let own = self.word(Word { shift: 0, ..a }, digits);
        if a.width == 1 {
            if let Some(t) = landing.at(0) {
                self.copy(own[0], t);
            }
            return;
        }
        match style {
            Style::OutOfPlace => self.square_rows(&own, needed, &landing),
            Style::InPlace => self.square_rows_into(&own, needed, &landing),
        }
    }

    fn square_rows(&mut self, a: &[Wire], needed: usize, landing: &Landing) {
        let mut sum = vec![Wire::ZERO];
        for place in 1..a.len().min(needed + 1) {
            let bits = row_bits(place, needed);
            let (known, turn) = row(a, place);
            let mut rest: Vec<Wire> = sum[place - 1..].iter().copied().take(place - 1).collect();
            rest.extend([Wire::ONE, Wire::ZERO]);
            let t = self.allocate_garbage(bits);
            let turned = self.complement(turn, &known);
            self.add(&rest[..bits], &turned[..bits], turn, &t);
            self.complement(turn, &known);
            sum.truncate(place - 1);
            sum.extend(qubits(&t));
            // The sum is even.
            sum[0] = Wire::ZERO;
        }
        let sum = extended(&sum, Wire::ZERO, needed);
        let mut number = extended(a, a[a.len() - 1], needed);
        invert(&mut number, true);
        let t = self.lands(landing, 0, needed);
        self.add(&sum, &number, Wire::ONE, &t);
    }

    fn square_rows_into(&mut self, a: &[Wire], needed: usize, landing: &Landing) {
        let square = self.lands(landing, 0, needed);
        for place in 1..a.len().min(needed + 1) {
            let window = &square[place - 1..place - 1 + row_bits(place, needed)];
            let (known, turn) = row(a, place);
            if let Some(t) = window.get(place - 1) {
                self.x(*t);
            }
            self.flips(turn, window);
            self.add_into(&known[..window.len()], false, Wire::ONE, window);
            self.flips(turn, window);
        }
        let number = extended(a, a[a.len() - 1], needed);
        self.flips(Wire::ONE, &square);
        self.add_into(&number, false, Wire::ONE, &square);
        self.flips(Wire::ONE, &square);
    }
}

/// Returns the digits below `place` as a number in two's complement, and the wire on which it is
/// subtracted.
fn row(a: &[Wire], place: usize) -> (Vec<Wire>, Wire) {
    let mut known = vec![Wire::ONE];
    known.extend_from_slice(&a[..place - 1]);
    known.push(a[place - 1].xor(true));
    (known, a[place].xor(place + 1 != a.len()))
}
