//! Gates on operands: bits that are constants, qubits, or qubits' negations.

use crate::circuit::{Gate, Qubit};

/// A bit that gates read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bit {
    Constant(bool),
    Qubit { qubit: Qubit, inverted: bool },
}

pub(super) const ZERO: Bit = Bit::Constant(false);
pub(super) const ONE: Bit = Bit::Constant(true);

impl Bit {
    pub(super) fn of(qubit: Qubit) -> Self {
        Self::Qubit {
            qubit,
            inverted: false,
        }
    }

    pub(super) fn not(self) -> Self {
        self.xor(true)
    }

    pub(super) fn xor(self, flip: bool) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(value != flip),
            Self::Qubit { qubit, inverted } => Self::Qubit {
                qubit,
                inverted: inverted != flip,
            },
        }
    }

    pub(super) fn qubit(self) -> Option<Qubit> {
        match self {
            Self::Constant(_) => None,
            Self::Qubit { qubit, .. } => Some(qubit),
        }
    }
}

/// The bit at `place` of a number whose last bit is its sign or a zero.
pub(super) fn bit_at(bits: &[Bit], place: usize) -> Bit {
    bits.get(place).or(bits.last()).copied().unwrap_or(ZERO)
}

/// Where gates go, and where qubits come from.
pub(super) struct Wires<'a> {
    /// The gates so far.
    pub(super) gates: Vec<Gate>,
    scratch: &'a [Qubit],
    used: usize,
    borrowed: Vec<Qubit>,
    next: &'a mut dyn FnMut() -> Qubit,
    /// Of the Toffolis, those that are one half of a computation and its undoing within the
    /// operation.
    pub(super) returned: u64,
    toffolis: u64,
}

/// What stands for scratch qubits while they are being counted.
const COUNTED: Qubit = 1 << 31;

impl<'a> Wires<'a> {
    /// `scratch` are the operation's own; `next` lends qubits that are zero and must be returned
    /// so.
    pub(super) fn new(scratch: &'a [Qubit], next: &'a mut dyn FnMut() -> Qubit) -> Self {
        Self {
            gates: Vec::new(),
            scratch,
            used: 0,
            borrowed: Vec::new(),
            next,
            returned: 0,
            toffolis: 0,
        }
    }

    /// Scratch qubits that were taken.
    pub(super) fn taken(&self) -> usize {
        self.used
    }

    /// A qubit of the operation's scratch register.
    pub(super) fn fresh(&mut self) -> Qubit {
        let place = self.used;
        self.used += 1;
        let counted = COUNTED + place as Qubit;
        self.scratch.get(place).copied().unwrap_or(counted)
    }

    /// Qubits that the operation returns as zeros before it ends.
    pub(super) fn borrow(&mut self, count: usize) -> Vec<Qubit> {
        let kept = self.borrowed.len().saturating_sub(count);
        let mut lent = self.borrowed.split_off(kept);
        while lent.len() < count {
            lent.push((self.next)());
        }
        lent
    }

    pub(super) fn give_back(&mut self, qubits: Vec<Qubit>) {
        self.borrowed.extend(qubits);
    }

    /// What was borrowed in all.
    pub(super) fn lent(self) -> (Vec<Gate>, Vec<Qubit>) {
        (self.gates, self.borrowed)
    }

    pub(super) fn x(&mut self, target: Qubit) {
        self.gates.push(Gate::X(target));
    }

    pub(super) fn cx(&mut self, control: Qubit, target: Qubit) {
        self.gates.push(Gate::Cx(control, target));
    }

    /// Toffolis so far.
    pub(super) fn toffolis(&self) -> u64 {
        self.toffolis
    }

    /// The gates `range` again, backwards: they are undone.
    pub(super) fn undo(&mut self, range: std::ops::Range<usize>) {
        for place in range.rev() {
            let gate = self.gates[place];
            self.toffolis += u64::from(matches!(gate, Gate::Ccx(..)));
            self.gates.push(gate);
        }
    }

    pub(super) fn ccx(&mut self, a: Qubit, b: Qubit, target: Qubit) {
        self.toffolis += 1;
        self.gates.push(Gate::Ccx(a, b, target));
    }

    /// `target ^= bit`
    pub(super) fn add_bit(&mut self, bit: Bit, target: Qubit) {
        match bit {
            Bit::Constant(false) => {}
            Bit::Constant(true) => self.x(target),
            Bit::Qubit { qubit, inverted } => {
                self.cx(qubit, target);
                if inverted {
                    self.x(target);
                }
            }
        }
    }

    /// `target ^= a and b`
    pub(super) fn and(&mut self, a: Bit, b: Bit, target: Qubit) {
        match (a, b) {
            (Bit::Constant(false), _) | (_, Bit::Constant(false)) => {}
            (Bit::Constant(true), other) | (other, Bit::Constant(true)) => {
                self.add_bit(other, target);
            }
            (
                Bit::Qubit {
                    qubit: p,
                    inverted: i,
                },
                Bit::Qubit {
                    qubit: q,
                    inverted: j,
                },
            ) => {
                if p == q {
                    if i == j {
                        self.add_bit(a, target);
                    }
                    return;
                }
                self.upright(&[a, b]);
                self.ccx(p, q, target);
                self.upright(&[a, b]);
            }
        }
    }

    /// Turns the negated ones among `bits` upright, and back.
    fn upright(&mut self, bits: &[Bit]) {
        for bit in bits {
            if let Bit::Qubit {
                qubit,
                inverted: true,
            } = bit
            {
                self.x(*qubit);
            }
        }
    }

    /// `target ^= maj(a, b, c)`
    pub(super) fn majority(&mut self, a: Bit, b: Bit, c: Bit, target: Qubit) {
        // Constants, and equal or opposite bits, need no Toffoli or a simpler one.
        let bits = [a, b, c];
        for (k, bit) in bits.iter().enumerate() {
            let (p, q) = (bits[(k + 1) % 3], bits[(k + 2) % 3]);
            if let Bit::Constant(value) = bit {
                if *value {
                    // p or q
                    self.and(p.not(), q.not(), target);
                    self.x(target);
                } else {
                    self.and(p, q, target);
                }
                return;
            }
        }
        for k in 0..3 {
            let (p, q, rest) = (bits[k], bits[(k + 1) % 3], bits[(k + 2) % 3]);
            if p.qubit() == q.qubit() {
                let decides = if p == q { p } else { rest };
                self.add_bit(decides, target);
                return;
            }
        }
        // c ^ (a ^ c)(b ^ c)
        let (Some(p), Some(q), Some(r)) = (a.qubit(), b.qubit(), c.qubit()) else {
            return;
        };
        self.upright(&bits);
        self.cx(r, p);
        self.cx(r, q);
        self.ccx(p, q, target);
        self.cx(r, target);
        self.cx(r, p);
        self.cx(r, q);
        self.upright(&bits);
    }

    /// `bit ^ when`, computed into the bit's own qubit: to be undone by the same call. What can be
    /// told without gates is.
    pub(super) fn turned(&mut self, bit: Bit, when: Bit) -> Bit {
        match (bit, when) {
            (bit, Bit::Constant(flip)) => bit.xor(flip),
            (Bit::Constant(flip), when) => when.xor(flip),
            (
                Bit::Qubit { qubit, inverted },
                Bit::Qubit {
                    qubit: control,
                    inverted: i,
                },
            ) => {
                if qubit == control {
                    return Bit::Constant(inverted != i);
                }
                self.cx(control, qubit);
                bit.xor(i)
            }
        }
    }
}
