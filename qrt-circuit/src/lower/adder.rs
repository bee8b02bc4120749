//! Additions and comparisons.
//!
//! Out of place, the carry into bit i is computed in the place of the sum's bit i, with one AND a
//! bit (Gidney 2018), since `maj(a, b, c) = a ^ (a ^ b)(a ^ c)`. In place, a ladder of carries is
//! computed upwards and uncomputed downwards: 2n - 2 Toffolis for n bits. A carry takes the place
//! of the addend's bit if that bit is a qubit of its own (Cuccaro, Draper, Kutin and Moulton 2004).
//! It takes a borrowed bit if the addend's bit is a constant or the copy of a sign. A controlled
//! addition adds one Toffoli a bit to the ladder, 3n - 2 in all (Takahashi, Tani and Kunihiro
//! 2010).

use super::{GateSink, Lowering, Qubit, Wire};

/// The place of a carry, and its gates.
enum Carry {
    /// It follows from the wires, without a gate.
    Free,
    /// The carry is in the place of the addend's bit.
    Replaced { carry: Qubit, addend: Qubit },
    /// The carry is in a borrowed bit, computed by the gates of this range.
    Borrowed { at: Qubit, gates: [usize; 2] },
}

impl Lowering {
    /// Flips `target` if `wire` is inverted.
    #[inline(always)]
    pub(super) fn flip(&mut self, wire: Wire, target: Qubit) {
        if wire.inverted() {
            self.x(target);
        }
    }

    /// Flips all of `target` where `wire` is 1.
    pub(super) fn flips(&mut self, wire: Wire, target: &[Qubit]) {
        for t in target {
            self.copy(wire, *t);
        }
    }

    /// `t ^= wire`
    #[inline(always)]
    pub(super) fn copy(&mut self, wire: Wire, target: Qubit) {
        if let Some(qubit) = wire.source() {
            self.cx(qubit, target);
        }
        self.flip(wire, target);
    }

    pub(super) fn copies(&mut self, wires: &[Wire], target: &[Qubit]) {
        for (wire, t) in wires.iter().zip(target) {
            self.copy(*wire, *t);
        }
    }

    /// `t ^= a ^ b`
    pub(super) fn copy_two(&mut self, a: Wire, b: Wire, target: Qubit) {
        if a.related(b) {
            self.copy(Wire::constant(a != b), target);
        } else {
            let odd = a.inverted() != b.inverted();
            self.copy(a.xor(a.inverted()), target);
            self.copy(b.xor(b.inverted() != odd), target);
        }
    }

    /// `t ^= a b`
    pub(super) fn and(&mut self, a: Wire, b: Wire, target: Qubit) {
        match (a.source(), b.source()) {
            (Some(x), Some(y)) if x != y => {
                self.flip(a, x);
                self.flip(b, y);
                self.ccx(x, y, target);
                self.flip(b, y);
                self.flip(a, x);
            }
            _ if a == b || b == Wire::ONE => self.copy(a, target),
            _ if a == Wire::ONE => self.copy(b, target),
            _ => {}
        }
    }

    /// `t ^= maj(a, b, c)`
    pub(super) fn majority(&mut self, a: Wire, b: Wire, c: Wire, target: Qubit) {
        if let Some(wire) = Wire::majority(a, b, c) {
            self.copy(wire, target);
            return;
        }
        match [a.source(), b.source(), c.source()] {
            [Some(x), Some(y), Some(z)] => {
                self.cx(x, y);
                self.cx(x, z);
                let (y_wire, z_wire) = (Wire::qubit(y), Wire::qubit(z));
                let turned = a.inverted();
                self.and(
                    y_wire.xor(b.inverted() != turned),
                    z_wire.xor(c.inverted() != turned),
                    target,
                );
                self.cx(x, z);
                self.cx(x, y);
                self.copy(a, target);
            }
            [None, ..] => self.and_or(a, b, c, target),
            [_, None, _] => self.and_or(b, a, c, target),
            _ => self.and_or(c, a, b, target),
        }
    }

    /// `t ^= maj(constant, a, b)`: an AND or an OR.
    fn and_or(&mut self, constant: Wire, a: Wire, b: Wire, target: Qubit) {
        let or = constant.inverted();
        self.and(a.xor(or), b.xor(or), target);
        self.flip(constant, target);
    }

    /// `t = a + b + carry mod 2^w`, out of place; a and b have w wires.
    pub(super) fn add(&mut self, a: &[Wire], b: &[Wire], carry: Wire, target: &[Qubit]) {
        let same = settled(a, b);
        let mut carry = carry;
        for (place, t) in target.iter().enumerate() {
            let (a, b, t) = (a[place], b[place], *t);
            if place >= same + 2 {
                self.cx(target[same + 1], t);
                continue;
            }
            let above = target.get(place + 1).copied();
            let Some(above) = above.filter(|_| place <= same) else {
                self.sum(a, b, carry, t);
                continue;
            };
            let mut next = Wire::majority(a, b, carry);
            if next == Some(Wire::qubit(t)) {
                // The carry propagates, and t becomes the sum.
                self.cx(t, above);
                next = Some(Wire::qubit(above));
            }
            match [a.source(), b.source()] {
                _ if next.is_some() => self.sum(a, b, carry, t),
                [Some(x), Some(y)] if carry.source().is_some() => {
                    if carry != Wire::qubit(t) {
                        self.copy(carry, t);
                    }
                    self.cx(x, t);
                    self.cx(x, y);
                    let turned = a.inverted();
                    let other = Wire::qubit(y).xor(b.inverted() != turned);
                    self.and(Wire::qubit(t).xor(turned), other, above);
                    self.copy(a, above);
                    self.cx(x, y);
                    self.cx(y, t);
                    self.flip(a.xor(b.inverted()), t);
                }
                _ => {
                    self.majority(a, b, carry, above);
                    self.sum(a, b, carry, t);
                }
            }
            carry = next.unwrap_or(Wire::qubit(above));
        }
    }

    /// `t = a ^ b ^ carry`, where t may hold the carry.
    fn sum(&mut self, a: Wire, b: Wire, carry: Wire, target: Qubit) {
        if carry == Wire::qubit(target) {
            self.copy_two(a, b, target);
        } else if a.related(b) {
            self.copy(carry.xor(a != b), target);
        } else if b.related(carry) {
            self.copy(a.xor(b != carry), target);
        } else if a.related(carry) {
            self.copy(b.xor(a != carry), target);
        } else {
            self.copy_two(a, b, target);
            self.copy(carry, target);
        }
    }

    /// `t += a + carry mod 2^w`, in place, where `when` is 1. a has w wires, none of which is a
    /// qubit of t or of `when`.
    pub(super) fn add_into(&mut self, a: &[Wire], carry: bool, when: Wire, target: &[Qubit]) {
        let Some(top) = target.len().checked_sub(1) else {
            return;
        };
        let mut carries = Vec::with_capacity(target.len());
        let mut steps = Vec::with_capacity(top);
        let mut carry = Wire::constant(carry);
        let mut own = false;
        for place in 0..top {
            carries.push(carry);
            let (addend, t) = (a[place], target[place]);
            let next = Wire::majority(addend, Wire::qubit(t), carry);
            let replaces = match (carry.source(), addend.source()) {
                (Some(c), Some(x)) if own && !addend.inverted() && alone(a, place) => Some((c, x)),
                _ => None,
            };
            own = next.is_none();
            let step;
            (carry, step) = match (next, replaces) {
                (Some(wire), _) => (wire, Carry::Free),
                (None, Some((carry, addend))) => {
                    self.cx(addend, t);
                    self.cx(addend, carry);
                    self.carry(carry, t, addend);
                    (Wire::qubit(addend), Carry::Replaced { carry, addend })
                }
                (None, None) => {
                    let at = self.pool.allocate();
                    let start = self.gates.len();
                    self.majority(Wire::qubit(t), addend, carry, at);
                    let gates = [start, self.gates.len()];
                    (Wire::qubit(at), Carry::Borrowed { at, gates })
                }
            };
            steps.push(step);
        }
        carries.push(carry);
        self.sum_when(a[top], carry, when, target[top]);
        for place in (0..top).rev() {
            let t = target[place];
            match steps[place] {
                Carry::Free => {}
                Carry::Replaced { carry, addend } => {
                    self.carry(carry, t, addend);
                    self.cx(addend, carry);
                    if when == Wire::ONE {
                        self.cx(carry, t);
                        continue;
                    }
                    self.cx(addend, t);
                }
                Carry::Borrowed { at, gates } => {
                    self.undo(gates[0], gates[1]);
                    self.pool.free(at);
                }
            }
            self.sum_when(a[place], carries[place], when, t);
        }
    }

    /// Computes a carry in the addend's place, or uncomputes it.
    fn carry(&mut self, carry: Qubit, t: Qubit, addend: Qubit) {
        self.carried.push(self.gates.len());
        self.ccx(carry, t, addend);
    }

    /// `t ^= when (a ^ b)`
    fn sum_when(&mut self, a: Wire, b: Wire, when: Wire, target: Qubit) {
        match (a.source(), b.source()) {
            _ if when == Wire::ONE => self.copy_two(a, b, target),
            _ if a.related(b) => self.and(when, Wire::constant(a != b), target),
            (None, _) => self.and(when, b.xor(a.inverted()), target),
            (_, None) => self.and(when, a.xor(b.inverted()), target),
            (Some(x), Some(y)) => {
                self.cx(y, x);
                self.and(when, a.xor(b.inverted()), target);
                self.cx(y, x);
            }
        }
    }

    /// `t = a < b` of unsigned numbers of one width; the carries stay as garbage if `keep`.
    pub(super) fn less(&mut self, a: &[Wire], b: &[Wire], target: Qubit, keep: bool) {
        let Some(top) = a.len().checked_sub(1) else {
            return;
        };
        // The carry out of ~a + b.
        let mut carry = Wire::ZERO;
        let mut ladder = Vec::new();
        for place in 0..top {
            let (x, y) = (a[place].xor(true), b[place]);
            carry = Wire::majority(x, y, carry).unwrap_or_else(|| {
                let at = if keep {
                    self.garbage_bit()
                } else {
                    self.pool.allocate()
                };
                let start = self.gates.len();
                self.majority(x, y, carry, at);
                ladder.push((at, start, self.gates.len()));
                Wire::qubit(at)
            });
        }
        self.majority(a[top].xor(true), b[top], carry, target);
        if !keep {
            for (at, start, end) in ladder.into_iter().rev() {
                self.undo(start, end);
                self.pool.free(at);
            }
        }
    }
}

/// True if the qubit of the wire at `place` is at no other place of `wires`.
fn alone(wires: &[Wire], place: usize) -> bool {
    // A plain loop: in unoptimised code, as in a macro, an iterator takes longer.
    let mut other = 0;
    while other < wires.len() {
        if other != place && wires[other].source() == wires[place].source() {
            return false;
        }
        other += 1;
    }
    true
}

/// Returns the place from which on the bits of both numbers repeat. From there on the carry no
/// longer changes; from two bits further on, the sum no longer changes either.
pub(super) fn settled(a: &[Wire], b: &[Wire]) -> usize {
    let mut place = a.len().saturating_sub(1);
    while place > 0 && a[place - 1] == a[place] && b[place - 1] == b[place] {
        place -= 1;
    }
    place
}
