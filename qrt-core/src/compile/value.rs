//! Values of the builder: their intervals, their bits and their tables.

use qrt_circuit::{Bit, Word};
use std::rc::Rc;

/// A function of a few bits, by table. Entry `i` is the value where the address bits spell `i`,
/// the first bit the least significant.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tabulated {
    pub(super) address: Rc<[Bit]>,
    pub(super) entries: Rc<[f64]>,
}

/// A number of the path, in units of `2^-fraction`.
#[derive(Clone, Debug)]
pub(super) struct Value {
    /// The least and the greatest value that it can have.
    pub(super) range: [i64; 2],
    /// The bits of the value, once an operation has needed them.
    pub(super) word: Option<Word>,
    /// The table, if the value is a function of few bits.
    pub(super) table: Option<Tabulated>,
}

/// A truth value of the path.
#[derive(Clone, Debug)]
pub(super) struct Truth {
    pub(super) bit: Option<Bit>,
    pub(super) table: Option<Tabulated>,
}

/// A small unsigned integer of the path.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// The exclusive upper bound of the integer.
    pub(super) bound: u32,
    pub(super) word: Option<Word>,
    pub(super) table: Option<Tabulated>,
}

/// The part of a value outside its register: `constant + along[0] column + along[1] row`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine {
    pub(super) constant: f64,
    pub(super) along: [f64; 2],
}

impl Affine {
    pub(super) const ZERO: Self = Self {
        constant: 0.0,
        along: [0.0; 2],
    };

    pub(super) fn constant(constant: f64) -> Self {
        Self {
            constant,
            ..Self::ZERO
        }
    }

    pub(super) fn is_constant(self) -> bool {
        self.along == [0.0; 2]
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            constant: self.constant * factor,
            along: self.along.map(|slope| slope * factor),
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            constant: self.constant + other.constant,
            along: [
                self.along[0] + other.along[0],
                self.along[1] + other.along[1],
            ],
        }
    }
}

/// A register's value, or its negative, plus an offset that the pixel and the scene fix:
/// `±node + offset`. Signs and constants stay apart from the bits until an operation needs the
/// bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealValue {
    pub(super) node: Option<u32>,
    pub(super) negated: bool,
    pub(super) offset: Affine,
    /// The amount that rounding down has taken from it on average. It is added with the offset if
    /// there is one; alone it is not worth an addition.
    pub(super) bias: f64,
}

impl RealValue {
    pub(super) fn constant(value: f64) -> Self {
        Self::fixed(Affine::constant(value))
    }

    pub(super) fn fixed(offset: Affine) -> Self {
        Self {
            node: None,
            negated: false,
            offset,
            bias: 0.0,
        }
    }

    pub(super) fn node(node: u32) -> Self {
        Self {
            node: Some(node),
            negated: false,
            offset: Affine::ZERO,
            bias: 0.0,
        }
    }

    /// Its value, if that is the same on all paths of all pixels.
    pub(super) fn as_constant(self) -> Option<f64> {
        (self.node.is_none() && self.offset.is_constant()).then_some(self.offset.constant)
    }

    pub(super) fn negative(self) -> Self {
        Self {
            node: self.node,
            negated: self.node.is_some() && !self.negated,
            offset: self.offset.scaled(-1.0),
            bias: -self.bias,
        }
    }
}

/// A truth value: the same on all paths, or a node or its negation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoolValue {
    /// The same on all paths.
    Constant(bool),
    /// A truth value of the path, by its node or that node's negation.
    Node {
        /// The node's index in the builder's list.
        node: u32,
        /// True if the value is the node's negation.
        inverted: bool,
    },
}

impl BoolValue {
    pub(super) fn node(node: u32) -> Self {
        Self::Node {
            node,
            inverted: false,
        }
    }

    pub(super) fn negated(self) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(!value),
            Self::Node { node, inverted } => Self::Node {
                node,
                inverted: !inverted,
            },
        }
    }
}

/// A small unsigned integer: the same on all paths, or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    /// The same on all paths.
    Constant(u32),
    /// An integer of the path, by its index in the builder's list.
    Node(u32),
}

/// Number of bits that hold every number of `range`, and whether one of them is a sign.
pub(super) fn bits_of(range: [i64; 2]) -> (u32, bool) {
    let [low, high] = range;
    if low >= 0 {
        (64 - high.leading_zeros(), false)
    } else {
        let magnitude = |n: i64| 64 - (if n < 0 { !n } else { n }).leading_zeros();
        (magnitude(low).max(magnitude(high)) + 1, true)
    }
}

/// The least `k >= 0` with `2^k > most`.
pub(super) fn bits_above(most: f64) -> u32 {
    let mut bits = 0;
    while bits < 62 && (1_u64 << bits) as f64 <= most {
        bits += 1;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_hold_their_ranges_and_no_narrower_one_does() {
        for low in -70..70_i64 {
            for high in low..70 {
                let (bits, signed) = bits_of([low, high]);
                assert_eq!(signed, low < 0);
                let holds = |bits: u32| {
                    let (least, most) = match (signed, bits) {
                        (true, 0) => (0, -1),
                        (true, _) => (-(1_i64 << (bits - 1)), (1 << (bits - 1)) - 1),
                        (false, _) => (0, (1_i64 << bits) - 1),
                    };
                    least <= low && high <= most
                };
                assert!(holds(bits), "{low} {high}");
                assert!(bits == 0 || !holds(bits - 1), "{low} {high}");
            }
        }
        assert_eq!([0.5, 1.0, 1.9, 2.0, 3.9].map(bits_above), [0, 1, 1, 2, 2]);
    }
}
