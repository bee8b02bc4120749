//! Conditional operations: negation, choice, exclusive or.

use super::{GateSink, Lowering, Qubit, Wire};

impl Lowering {
    /// `t = if when { -a } else { a }`: a carry that starts as `when` propagates through the zeros
    /// of a; the bits above the place where it stops are complemented.
    pub(super) fn negate(&mut self, a: &[Wire], when: Wire, target: &[Qubit]) {
        let mut carry = when;
        for (place, t) in target.iter().enumerate() {
            let mut next = turned(a, place, when, carry);
            if let Some(above) = target.get(place + 1) {
                if next.is_none() {
                    self.and(carry, a[place].xor(true), *above);
                } else if next == Some(Wire::qubit(*t)) {
                    // The carry propagates, and t becomes the sum.
                    self.cx(*t, *above);
                    next = None;
                }
            }
            // t is carry ^ when ^ a.
            if carry == Wire::qubit(*t) {
                self.copy_two(a[place], when, *t);
            } else if carry == when {
                self.copy(a[place], *t);
            } else {
                self.copy_two(a[place], when, *t);
                self.copy(carry, *t);
            }
            carry = match (next, target.get(place + 1)) {
                (Some(wire), _) => wire,
                (None, Some(above)) => Wire::qubit(*above),
                (None, None) => break,
            };
        }
    }

    /// `t = if when { a } else { b }`, as `b ^ when (a ^ b)`.
    pub(super) fn select(&mut self, when: Wire, a: &[Wire], b: &[Wire], target: &[Qubit]) {
        for (place, t) in target.iter().enumerate() {
            if place > 0 && a[place] == a[place - 1] && b[place] == b[place - 1] {
                self.cx(target[place - 1], *t);
            } else {
                self.select_bit(when, a[place], b[place], *t);
            }
        }
    }

    pub(super) fn select_bit(&mut self, when: Wire, a: Wire, b: Wire, target: Qubit) {
        let [a, b] = chosen(when, a, b);
        match (a.source(), b.source()) {
            _ if a == b => self.copy(a, target),
            _ if a.related(b) => self.copy_two(b, when, target),
            (None, _) => {
                // when a + b (1 - when): b where not `when`, and a constant elsewhere.
                let one = a.inverted();
                self.and(when.xor(true), b.xor(one), target);
                self.flip(a, target);
            }
            (_, None) => {
                let one = b.inverted();
                self.and(when, a.xor(one), target);
                self.flip(b, target);
            }
            (Some(x), Some(y)) => {
                self.cx(x, y);
                let differ = Wire::qubit(y).xor(a.inverted() != b.inverted());
                self.and(when, differ, target);
                self.cx(x, y);
                self.copy(b, target);
            }
        }
    }

    /// `t ^= when a`. Copies of a sign are computed once.
    pub(super) fn xor_into(&mut self, a: &[Wire], when: Wire, target: &[Qubit]) {
        let mut place = 0;
        while place < target.len() {
            let same = a[place..].iter().take_while(|wire| **wire == a[place]);
            let group = &target[place..place + same.count()];
            if a[place].source().is_some() {
                let fan = |this: &mut Self| {
                    for t in &group[1..] {
                        this.cx(group[0], *t);
                    }
                };
                fan(self);
                self.and(when, a[place], group[0]);
                fan(self);
            } else {
                for t in group {
                    self.and(when, a[place], *t);
                }
            }
            place += group.len();
        }
    }
}

/// Returns the wire that is read where `when` holds, and the wire that is read where it does not.
/// There, a wire of the condition's own qubit is a constant.
pub(super) fn chosen(when: Wire, a: Wire, b: Wire) -> [Wire; 2] {
    let a = if a.related(when) && a.source().is_some() {
        Wire::constant(a == when)
    } else {
        a
    };
    let b = if b.related(when) && b.source().is_some() {
        Wire::constant(b != when)
    } else {
        b
    };
    [a, b]
}

/// Returns the carry `carry and not a` of a negation. `None` if it takes a gate.
pub(super) fn turned(a: &[Wire], place: usize, when: Wire, carry: Wire) -> Option<Wire> {
    let bit = a[place];
    if carry == Wire::ZERO || bit == when || bit == Wire::ONE {
        Some(Wire::ZERO)
    } else if bit == Wire::ZERO || bit.related(when) || (place > 0 && bit == a[place - 1]) {
        Some(carry)
    } else {
        None
    }
}
