//! Sums.
//!
//! Out of place, a carry needs one Toffoli and no ancilla: the target's bit i holds the carry into
//! position i until the sum's bit replaces it there,
//!
//! ```text
//! t_(i+1) = maj(a_i, b_i, t_i),      t_i ^= a_i ^ b_i
//! ```
//!
//! In place, carries are computed into borrowed qubits and taken back from the top down: two
//! Toffolis a bit (Vedral, Barenco & Ekert 1996 in the order of Cuccaro et al. 2004), which leaves
//! operands with constants and repeated sign bits as they are. A condition costs one more a bit,
//! for it need only gate the sum's bits and not the carries. Adding or subtracting by a bit costs
//! CNOTs alone: `t - a = ~(~t + a)`.

use super::wires::{Bit, ONE, Wires, ZERO, bit_at};
use crate::circuit::Qubit;

impl Wires<'_> {
    /// `t = a + (b ^ turn) + carry`, for a zero t as wide as `t` is long. Operands' last bits are
    /// their signs, or zeros.
    pub(super) fn sum(&mut self, a: &[Bit], b: &[Bit], turn: Bit, carry: Bit, t: &[Qubit]) {
        let mut carry = carry;
        for (place, &target) in t.iter().enumerate() {
            let (p, q) = (bit_at(a, place), bit_at(b, place));
            let q = self.turned(q, turn);
            if let Some(&next) = t.get(place + 1) {
                let known = known_majority(p, q, carry);
                if known.is_none() {
                    self.majority(p, q, carry, next);
                }
                self.add_bit(p, target);
                self.add_bit(q, target);
                // A carry that stands in the target is part of the sum already.
                if carry.qubit() != Some(target) {
                    self.add_bit(carry, target);
                }
                carry = known.unwrap_or(Bit::of(next));
            } else {
                self.add_bit(p, target);
                self.add_bit(q, target);
                if carry.qubit() != Some(target) {
                    self.add_bit(carry, target);
                }
            }
            self.turned(bit_at(b, place), turn);
        }
    }

    /// `t += (a ^ turn) + carry`, where `when` holds.
    pub(super) fn sum_into(&mut self, a: &[Bit], turn: Bit, carry: Bit, when: Bit, t: &[Qubit]) {
        let before = self.toffolis();
        let mut carries = vec![carry];
        let lent = self.borrow(t.len().saturating_sub(1));
        for (place, &next) in lent.iter().enumerate() {
            let q = self.turned(bit_at(a, place), turn);
            let p = Bit::of(t[place]);
            let known = known_majority(p, q, carries[place]);
            if known.is_none() {
                self.majority(p, q, carries[place], next);
            }
            carries.push(known.unwrap_or(Bit::of(next)));
            self.turned(bit_at(a, place), turn);
        }
        self.returned += self.toffolis() - before;
        for place in (0..t.len()).rev() {
            let q = self.turned(bit_at(a, place), turn);
            if let (Some(&next), Some(above)) = (lent.get(place), carries.get(place + 1))
                && above.qubit() == Some(next)
            {
                self.majority(Bit::of(t[place]), q, carries[place], next);
            }
            self.gated(&[q, carries[place]], when, t[place]);
            self.turned(bit_at(a, place), turn);
        }
        self.give_back(lent);
    }

    /// `target ^= (sum of bits) and when`
    fn gated(&mut self, bits: &[Bit], when: Bit, target: Qubit) {
        if when == ONE {
            for &bit in bits {
                self.add_bit(bit, target);
            }
            return;
        }
        // The sum is gathered in one of its qubits.
        let mut flip = false;
        let mut qubits: Vec<Qubit> = Vec::new();
        for bit in bits {
            match *bit {
                Bit::Constant(value) => flip ^= value,
                Bit::Qubit { qubit, inverted } => {
                    flip ^= inverted;
                    if let Some(place) = qubits.iter().position(|&q| q == qubit) {
                        qubits.remove(place);
                    } else {
                        qubits.push(qubit);
                    }
                }
            }
        }
        // Not in the condition's.
        if qubits.len() == 2 && when.qubit() == Some(qubits[1]) {
            qubits.swap(0, 1);
        }
        let sum = match qubits[..] {
            [] => Bit::Constant(flip),
            [one] => Bit::of(one).xor(flip),
            [one, other, ..] => {
                self.cx(one, other);
                Bit::of(other).xor(flip)
            }
        };
        self.and(sum, when, target);
        if let [one, other, ..] = qubits[..] {
            self.cx(one, other);
        }
    }

    /// `target ^= a < b`, for operands whose last bits are their signs, or zeros.
    pub(super) fn less(&mut self, a: &[Bit], b: &[Bit], target: Qubit) {
        // With both signs turned, the order is that of unsigned numbers: the carry out of
        // ~a + b tells it.
        let width = a.len().max(b.len());
        // Two unsigned numbers are in order as they are.
        let unsigned = a.last() == Some(&ZERO) && b.last() == Some(&ZERO);
        let width = width - usize::from(unsigned);
        let bit =
            |bits: &[Bit], place: usize| bit_at(bits, place).xor(!unsigned && place + 1 == width);
        let lent = self.borrow(width.saturating_sub(1));
        let before = self.toffolis();
        let mut carries = vec![ZERO];
        let start = self.gates.len();
        for (place, &next) in lent.iter().enumerate() {
            let (p, q) = (bit(a, place).not(), bit(b, place));
            let known = known_majority(p, q, carries[place]);
            if known.is_none() {
                self.majority(p, q, carries[place], next);
            }
            carries.push(known.unwrap_or(Bit::of(next)));
        }
        let end = self.gates.len();
        self.returned += self.toffolis() - before;
        if width > 0 {
            let last = width - 1;
            let (p, q) = (bit(a, last).not(), bit(b, last));
            match known_majority(p, q, carries[last]) {
                Some(known) => self.add_bit(known, target),
                None => self.majority(p, q, carries[last], target),
            }
        }
        self.undo(start..end);
        self.give_back(lent);
    }
}

/// The majority where it is a constant; elsewhere it needs a qubit.
fn known_majority(a: Bit, b: Bit, c: Bit) -> Option<Bit> {
    let values = [a, b, c].map(|bit| match bit {
        Bit::Constant(value) => Some(value),
        Bit::Qubit { .. } => None,
    });
    let count = |wanted: bool| values.iter().filter(|v| **v == Some(wanted)).count();
    if count(true) >= 2 {
        Some(ONE)
    } else if count(false) >= 2 {
        Some(ZERO)
    } else {
        None
    }
}
