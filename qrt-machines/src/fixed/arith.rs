//! Steps that compute on the lanes of a block, for one type of lane.

use super::lane::{Float, Kind, Lane, Row};
use super::seen::Seen;

/// An operand: a value, or the same number in all lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Arg<K> {
    Row(u32),
    Splat(K),
}

/// The part of a number that a target keeps: its lowest bits, as the target's type reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wrap<K> {
    pub(super) mask: K,
    /// The sign's weight, or 0.
    pub(super) half: K,
}

impl<K: Lane> Wrap<K> {
    /// Keeps the whole number.
    pub(super) fn whole() -> Self {
        Self {
            mask: K::cut(-1),
            half: K::cut(0),
        }
    }

    /// Keeps `width` bits.
    pub(super) fn new(width: u32, signed: bool) -> Self {
        if width >= K::BITS {
            return Self::whole();
        }
        Self {
            // A register of no bits holds 0, for example the index of a pixel's only path.
            mask: K::cut(u64::MAX.checked_shr(64 - width).unwrap_or(0).cast_signed()),
            half: K::cut(i64::from(signed && width > 0) << width.saturating_sub(1)),
        }
    }

    #[inline(always)]
    pub(super) fn apply(self, value: K) -> K {
        value.and(self.mask).xor(self.half).sub(self.half)
    }
}

/// A step whose operands and targets have one type of lane.
#[derive(Clone, Debug)]
pub(super) enum Arith<K> {
    Add {
        a: Arg<K>,
        b: Arg<K>,
        wrap: Wrap<K>,
        t: u32,
    },
    Sub {
        a: Arg<K>,
        b: Arg<K>,
        wrap: Wrap<K>,
        t: u32,
    },
    Xor {
        a: Arg<K>,
        b: Arg<K>,
        wrap: Wrap<K>,
        t: u32,
    },
    /// The product fits, or the target keeps none of the bits that do not fit.
    Mul {
        a: Arg<K>,
        b: Arg<K>,
        drop: u32,
        wrap: Wrap<K>,
        t: u32,
    },
    /// `t: Truth`
    Less {
        a: Arg<K>,
        b: Arg<K>,
        t: u32,
    },
    /// `when: Truth`
    Select {
        when: u32,
        a: Arg<K>,
        b: Arg<K>,
        wrap: Wrap<K>,
        t: u32,
    },
    /// `when: Truth`
    Negate {
        when: u32,
        inverted: bool,
        a: u32,
        wrap: Wrap<K>,
        t: u32,
    },
    /// `((a << left) >> right) << up`
    Cut {
        a: u32,
        left: u32,
        right: u32,
        signed: bool,
        up: u32,
        t: u32,
    },
    Wrap {
        a: Arg<K>,
        wrap: Wrap<K>,
        t: u32,
    },
    /// `t: Truth`
    Bit {
        a: u32,
        index: u32,
        t: u32,
    },
    /// A bit of `a + b` or `a - b`. `t: Truth`
    SumBit {
        a: Arg<K>,
        b: Arg<K>,
        subtract: bool,
        index: u32,
        t: u32,
    },
    /// `fits: Truth`
    Divide {
        a: u32,
        b: u32,
        width: u32,
        float: Float,
        quotient: u32,
        fits: u32,
    },
    Root {
        a: u32,
        float: Float,
        t: u32,
    },
    /// `address: Int`
    Lookup {
        address: u32,
        table: Box<[K]>,
        t: u32,
    },
    /// A classical parameter of the pixel.
    Load {
        parameter: u32,
        wrap: Wrap<K>,
        t: u32,
    },
    /// The content of an input register.
    Input {
        input: u32,
        wrap: Wrap<K>,
        t: u32,
    },
    Parity {
        source: Source,
        columns: Box<[u64]>,
        /// By lane: the image of the lowest bits of the lane's number: see [`super::pattern_bits`].
        pattern: Box<Row<K>>,
        parameter: Option<u32>,
        wrap: Wrap<K>,
        t: u32,
    },
}

/// Source of a linear map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// An input register.
    Input(u32),
    /// A value of the kind `Long`.
    Row(u32),
}

impl<K: Lane> Arith<K> {
    /// Calls `see` on every value that the step reads or computes.
    pub(super) fn visit(&mut self, see: &mut impl FnMut(Seen<'_>), kind: Kind) {
        let mut args: [Option<&mut Arg<K>>; 2] = [None, None];
        match self {
            Self::Add { a, b, t, .. }
            | Self::Sub { a, b, t, .. }
            | Self::Xor { a, b, t, .. }
            | Self::Mul { a, b, t, .. } => {
                args = [Some(a), Some(b)];
                see(Seen::computed(kind, t));
            }
            Self::Less { a, b, t } | Self::SumBit { a, b, t, .. } => {
                args = [Some(a), Some(b)];
                see(Seen::computed(Kind::Truth, t));
            }
            Self::Select { when, a, b, t, .. } => {
                args = [Some(a), Some(b)];
                see(Seen::read(Kind::Truth, when));
                see(Seen::computed(kind, t));
            }
            Self::Negate { when, a, t, .. } => {
                see(Seen::read(Kind::Truth, when));
                see(Seen::read(kind, a));
                see(Seen::computed(kind, t));
            }
            Self::Wrap { a, t, .. } => {
                args = [Some(a), None];
                see(Seen::computed(kind, t));
            }
            Self::Cut { a, t, .. } | Self::Root { a, t, .. } => {
                see(Seen::read(kind, a));
                see(Seen::computed(kind, t));
            }
            Self::Bit { a, t, .. } => {
                see(Seen::read(kind, a));
                see(Seen::computed(Kind::Truth, t));
            }
            Self::Divide {
                a,
                b,
                quotient,
                fits,
                ..
            } => {
                see(Seen::read(kind, a));
                see(Seen::read(kind, b));
                see(Seen::computed(kind, quotient));
                see(Seen::computed(Kind::Truth, fits));
            }
            Self::Lookup { address, t, .. } => {
                see(Seen::read(Kind::Int, address));
                see(Seen::computed(kind, t));
            }
            Self::Load { t, .. } | Self::Input { t, .. } => see(Seen::computed(kind, t)),
            Self::Parity { source, t, .. } => {
                if let Source::Row(source) = source {
                    see(Seen::read(Kind::Long, source));
                }
                see(Seen::computed(kind, t));
            }
        }
        for arg in args.into_iter().flatten() {
            if let Arg::Row(row) = arg {
                see(Seen::read(kind, row));
            }
        }
    }
}
