//! Steps: what a program becomes before it runs.

use super::arith::{Arith, Wrap};
use super::lane::{Kind, LANES, Lane, Row, Slots};
use crate::machines::Span;
use std::ops::Range;

/// One step, with its operands' and targets' places among the slots of their kinds.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Truth(Arith<u8>),
    Short(Arith<i16>),
    Int(Arith<i32>),
    Long(Arith<i64>),
    /// `t = a`, cut to `wrap` bits.
    Cast {
        from: (Kind, u32),
        to: (Kind, u32),
        wrap: Wrap<i64>,
    },
    /// `t = a b >> drop`: Short factors, the product in 32 bits.
    MulShort {
        a: u32,
        b: Factor,
        drop: u32,
        wrap: Wrap<i64>,
        to: (Kind, u32),
    },
    /// The same of Int factors, the product in 64 bits.
    MulInt {
        a: u32,
        b: Factor,
        drop: u32,
        wrap: Wrap<i64>,
        to: (Kind, u32),
    },
    /// The same of Long factors, the product in 128 bits.
    MulLong {
        a: u32,
        b: Factor,
        drop: u32,
        wrap: Wrap<i64>,
        t: u32,
    },
    /// `t = (a ^ flip_a) & (b ^ flip_b)`
    And {
        a: (u32, bool),
        b: (u32, bool),
        t: u32,
    },
    /// `t = a ^ b ^ flip`
    Xor {
        a: u32,
        b: u32,
        flip: bool,
        t: u32,
    },
    /// An Int from truths: slot, place and whether it is negated.
    Address {
        bits: Box<[(u32, u32, bool)]>,
        t: u32,
    },
}

/// A second factor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Factor {
    Row(u32),
    Splat(i64),
}

/// A value that a step reads or computes: its kind, and its place.
pub(super) struct Seen<'a> {
    pub(super) kind: Kind,
    pub(super) place: &'a mut u32,
    pub(super) computed: bool,
}

impl<'a> Seen<'a> {
    pub(super) fn read(kind: Kind, place: &'a mut u32) -> Self {
        Self {
            kind,
            place,
            computed: false,
        }
    }

    pub(super) fn computed(kind: Kind, place: &'a mut u32) -> Self {
        Self {
            kind,
            place,
            computed: true,
        }
    }
}

/// What a block of states starts from.
pub(super) struct Block<'a> {
    pub(super) inputs: &'a [&'a [u64]],
    pub(super) spans: &'a [Span<'a>],
    /// By input: if lane l holds `first ^ (l mod 2^k)`, with the k of [`super::pattern_bits`].
    pub(super) runs: Vec<Option<u64>>,
}

impl Block<'_> {
    /// What an input register holds; lanes beyond those given hold what the last does.
    #[inline(always)]
    pub(super) fn input(&self, input: u32, lane: usize) -> u64 {
        let lanes = self.inputs[input as usize];
        lanes.get(lane).or(lanes.last()).copied().unwrap_or(0)
    }

    /// Calls `each` with the lanes and the parameters of every span; the last one takes all lanes
    /// that remain.
    #[inline(always)]
    pub(super) fn each_span(&self, mut each: impl FnMut(Range<usize>, &[u64])) {
        let mut first = 0;
        for (place, span) in self.spans.iter().enumerate() {
            let last = place + 1 == self.spans.len();
            let end = if last { LANES } else { first + span.lanes };
            each(first..end.min(LANES), span.parameters);
            first = end.min(LANES);
        }
    }
}

/// Where results are computed before they take their slots.
#[derive(Clone, Debug)]
pub(super) struct Spares {
    pub(super) truth: [Box<Row<u8>>; 2],
    pub(super) short: Box<Row<i16>>,
    pub(super) int: Box<Row<i32>>,
    pub(super) long: Box<Row<i64>>,
}

/// `$body` with `$row` a spare of kind `$kind` and its lanes' type `$K`, then swapped into `$t`.
macro_rules! into {
    (($kind:expr, $t:expr), $slots:ident, $spares:ident, |$row:ident: $K:ident| $body:expr) => {
        match $kind {
            Kind::Truth => into!(@ u8, $t, $slots, $spares.truth[0], $row, $K, $body),
            Kind::Short => into!(@ i16, $t, $slots, $spares.short, $row, $K, $body),
            Kind::Int => into!(@ i32, $t, $slots, $spares.int, $row, $K, $body),
            Kind::Long => into!(@ i64, $t, $slots, $spares.long, $row, $K, $body),
        }
    };
    (@ $type:ident, $t:expr, $slots:ident, $spare:expr, $row:ident, $K:ident, $body:expr) => {{
        type $K = $type;
        let $row = &mut $spare;
        $body;
        std::mem::swap($row, &mut $K::rows_mut($slots)[$t as usize]);
    }};
}

#[inline(always)]
fn cast<A: Lane, T: Lane>(
    slots: &Slots,
    a: u32,
    t: &mut Row<T>,
    wrap: Wrap<i64>,
    f: impl Fn(A) -> T,
) {
    let wrap = Wrap {
        mask: T::cut(wrap.mask),
        half: T::cut(wrap.half),
    };
    for (t, a) in t.0.iter_mut().zip(&A::rows(slots)[a as usize].0) {
        *t = wrap.of(f(*a));
    }
}

macro_rules! multiply {
    ($narrow:ident, $wide:ident, $slots:ident, $row:ident: $K:ident, $a:expr, $b:expr, $drop:expr, $wrap:expr) => {{
        let wrap = Wrap {
            mask: $K::cut($wrap.mask),
            half: $K::cut($wrap.half),
        };
        let all = $narrow::rows($slots);
        let a = &all[$a as usize].0;
        match $b {
            Factor::Row(b) => {
                for (t, (a, b)) in $row.0.iter_mut().zip(a.iter().zip(&all[b as usize].0)) {
                    *t = wrap.of(((*a as $wide * *b as $wide) >> $drop) as $K);
                }
            }
            Factor::Splat(b) => {
                let b = b as $wide;
                for (t, a) in $row.0.iter_mut().zip(a) {
                    *t = wrap.of(((*a as $wide * b) >> $drop) as $K);
                }
            }
        }
    }};
}

impl Step {
    /// Runs the step on all lanes.
    #[inline(always)]
    pub(super) fn run(&self, slots: &mut Slots, spares: &mut Spares, block: &Block<'_>) {
        let [truth, other] = &mut spares.truth;
        match *self {
            Self::Truth(ref arith) => arith.run(slots, other, truth, block),
            Self::Short(ref arith) => arith.run(slots, &mut spares.short, truth, block),
            Self::Int(ref arith) => arith.run(slots, &mut spares.int, truth, block),
            Self::Long(ref arith) => arith.run(slots, &mut spares.long, truth, block),
            Self::Cast {
                from: (from, a),
                to: (to, t),
                wrap,
            } => into!((to, t), slots, spares, |row: K| match from {
                Kind::Truth => cast::<u8, K>(slots, a, row, wrap, |a| a as K),
                Kind::Short => cast::<i16, K>(slots, a, row, wrap, |a| a as K),
                Kind::Int => cast::<i32, K>(slots, a, row, wrap, |a| a as K),
                Kind::Long => cast::<i64, K>(slots, a, row, wrap, |a| a as K),
            }),
            Self::MulShort {
                a,
                b,
                drop,
                wrap,
                to: (to, t),
            } => match to {
                Kind::Short => {
                    let row = &mut spares.short;
                    multiply!(i16, i32, slots, row: i16, a, b, drop, wrap);
                    std::mem::swap(row, &mut slots.shorts[t as usize]);
                }
                _ => {
                    let row = &mut spares.int;
                    multiply!(i16, i32, slots, row: i32, a, b, drop, wrap);
                    std::mem::swap(row, &mut slots.ints[t as usize]);
                }
            },
            Self::MulInt {
                a,
                b,
                drop,
                wrap,
                to: (to, t),
            } => match to {
                Kind::Int => {
                    let row = &mut spares.int;
                    multiply!(i32, i64, slots, row: i32, a, b, drop, wrap);
                    std::mem::swap(row, &mut slots.ints[t as usize]);
                }
                _ => {
                    let row = &mut spares.long;
                    multiply!(i32, i64, slots, row: i64, a, b, drop, wrap);
                    std::mem::swap(row, &mut slots.longs[t as usize]);
                }
            },
            Self::MulLong {
                a,
                b,
                drop,
                wrap,
                t,
            } => {
                let row = &mut spares.long;
                multiply!(i64, i128, slots, row: i64, a, b, drop, wrap);
                std::mem::swap(row, &mut slots.longs[t as usize]);
            }
            Self::And { a, b, t } => {
                let (flip_a, flip_b) = (u8::from(a.1), u8::from(b.1));
                let all = &slots.truths;
                super::arith::rows(truth, &all[a.0 as usize], &all[b.0 as usize], |a, b| {
                    (a ^ flip_a) & (b ^ flip_b)
                });
                std::mem::swap(truth, &mut slots.truths[t as usize]);
            }
            Self::Xor { a, b, flip, t } => {
                let flip = u8::from(flip);
                let all = &slots.truths;
                super::arith::rows(truth, &all[a as usize], &all[b as usize], |a, b| {
                    a ^ b ^ flip
                });
                std::mem::swap(truth, &mut slots.truths[t as usize]);
            }
            Self::Address { ref bits, t } => {
                let row = &mut spares.int;
                row.0.fill(0);
                for (truth, place, flip) in bits {
                    let flip = u8::from(*flip);
                    let truths = &slots.truths[*truth as usize].0;
                    for (t, truth) in row.0.iter_mut().zip(truths) {
                        *t |= i32::from(truth ^ flip) << place;
                    }
                }
                std::mem::swap(row, &mut slots.ints[t as usize]);
            }
        }
    }

    /// Calls `see` on every value that the step reads or computes.
    pub(super) fn visit(&mut self, mut see: impl FnMut(Seen<'_>)) {
        match self {
            Self::Truth(arith) => arith.visit(&mut see, Kind::Truth),
            Self::Short(arith) => arith.visit(&mut see, Kind::Short),
            Self::Int(arith) => arith.visit(&mut see, Kind::Int),
            Self::Long(arith) => arith.visit(&mut see, Kind::Long),
            Self::Cast { from, to, .. } => {
                see(Seen::read(from.0, &mut from.1));
                see(Seen::computed(to.0, &mut to.1));
            }
            Self::MulShort { a, b, to, .. } => {
                factors(&mut see, Kind::Short, a, b);
                see(Seen::computed(to.0, &mut to.1));
            }
            Self::MulInt { a, b, to, .. } => {
                factors(&mut see, Kind::Int, a, b);
                see(Seen::computed(to.0, &mut to.1));
            }
            Self::MulLong { a, b, t, .. } => {
                factors(&mut see, Kind::Long, a, b);
                see(Seen::computed(Kind::Long, t));
            }
            Self::And { a, b, t } => {
                see(Seen::read(Kind::Truth, &mut a.0));
                see(Seen::read(Kind::Truth, &mut b.0));
                see(Seen::computed(Kind::Truth, t));
            }
            Self::Xor { a, b, t, .. } => {
                see(Seen::read(Kind::Truth, a));
                see(Seen::read(Kind::Truth, b));
                see(Seen::computed(Kind::Truth, t));
            }
            Self::Address { bits, t } => {
                for (truth, _, _) in bits {
                    see(Seen::read(Kind::Truth, truth));
                }
                see(Seen::computed(Kind::Int, t));
            }
        }
    }
}

fn factors(see: &mut impl FnMut(Seen<'_>), kind: Kind, a: &mut u32, b: &mut Factor) {
    see(Seen::read(kind, a));
    if let Factor::Row(b) = b {
        see(Seen::read(kind, b));
    }
}
