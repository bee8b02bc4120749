//! Wires: the bits of operands.

use super::Qubit;

/// A qubit, its negation, or a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Wire {
    source: Option<Qubit>,
    inverted: bool,
}

impl Wire {
    pub(super) const ZERO: Self = Self::constant(false);
    pub(super) const ONE: Self = Self::constant(true);

    #[inline(always)]
    pub(super) const fn constant(value: bool) -> Self {
        Self {
            source: None,
            inverted: value,
        }
    }

    #[inline(always)]
    pub(super) const fn qubit(qubit: Qubit) -> Self {
        Self {
            source: Some(qubit),
            inverted: false,
        }
    }

    /// Returns the wire's qubit. `None` for a constant.
    #[inline(always)]
    pub(super) const fn source(self) -> Option<Qubit> {
        self.source
    }

    /// True if the wire is the negation of its qubit, or the constant 1.
    #[inline(always)]
    pub(super) const fn inverted(self) -> bool {
        self.inverted
    }

    #[must_use]
    #[inline(always)]
    pub(super) const fn xor(self, inverted: bool) -> Self {
        Self {
            source: self.source,
            inverted: self.inverted != inverted,
        }
    }

    /// True if the two wires are equal, or each other's negation, for all contents of the qubits.
    #[inline(always)]
    pub(super) fn related(self, other: Self) -> bool {
        match (self.source, other.source) {
            (Some(a), Some(b)) => a == b,
            (None, None) => true,
            _ => false,
        }
    }

    /// Returns the majority of three wires if it follows without a gate: that of two equal bits is
    /// that bit, and that of two opposite bits is the third.
    pub(super) fn majority(a: Self, b: Self, c: Self) -> Option<Self> {
        if a.related(b) {
            return Some(if a.inverted == b.inverted { a } else { c });
        }
        if a.related(c) {
            return Some(if a.inverted == c.inverted { a } else { b });
        }
        if b.related(c) {
            return Some(if b.inverted == c.inverted { b } else { a });
        }
        None
    }
}
