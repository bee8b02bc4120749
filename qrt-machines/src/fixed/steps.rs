//! Steps, to which a program is compiled before it runs.

use super::arith::{Arith, Wrap};
use super::block::Block;
use super::lane::{Kind, LANES, Lane, Row, Slots, Spares};
use super::product::Product;
use super::quotient::Quotient;
use super::seen::Seen;

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
    Product(Product),
    Quotient(Quotient),
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
    /// The truth at an Int address, in a table of 32-bit words.
    TruthTable {
        address: u32,
        table: Box<[u32]>,
        t: u32,
    },
    /// An Int from truths.
    Address {
        bits: Box<[AddressBit]>,
        t: u32,
    },
    /// The entries of the first bits that hold, as Longs.
    Encode {
        bits: Box<[EncodedBit]>,
        targets: Box<[u32]>,
    },
}

/// A bit that a priority encoder reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct EncodedBit {
    /// The slot of the truth.
    pub(super) truth: u32,
    /// True if the bit is the negation of the truth.
    pub(super) negated: bool,
    /// The entry of the bit.
    pub(super) entry: i64,
}

/// A bit of an Int that is put together from truths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct AddressBit {
    /// The slot of the truth.
    pub(super) truth: u32,
    /// The place of the bit in the Int.
    pub(super) place: u32,
    /// True if the bit is the negation of the truth.
    pub(super) negated: bool,
}

/// A type of lane on which steps compute.
pub(super) trait StepLane: Lane {
    /// Returns the step that computes `arith` on lanes of this type.
    fn step(arith: Arith<Self>) -> Step;
}

impl StepLane for u8 {
    fn step(arith: Arith<Self>) -> Step {
        Step::Truth(arith)
    }
}

impl StepLane for i16 {
    fn step(arith: Arith<Self>) -> Step {
        Step::Short(arith)
    }
}

impl StepLane for i32 {
    fn step(arith: Arith<Self>) -> Step {
        Step::Int(arith)
    }
}

impl StepLane for i64 {
    fn step(arith: Arith<Self>) -> Step {
        Step::Long(arith)
    }
}

/// Evaluates `$body` with `$row` a spare of kind `$kind` and its lanes' type `$K`, then swaps it
/// into `$t`.
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
        *t = wrap.apply(f(*a));
    }
}

/// Writes the entries of the first bits that hold to the targets. Passes over rows in which a bit holds on no
/// lane, which are most of a mesh's.
fn encode(slots: &mut Slots, bits: &[EncodedBit], targets: &[u32]) {
    for target in targets {
        slots.longs[*target as usize].0.fill(0);
    }
    let mut found = [0_usize; LANES];
    for bit in bits {
        let flip = u8::from(bit.negated);
        let truths = &slots.truths[bit.truth as usize].0;
        if truths.iter().fold(0, |any, truth| any | (truth ^ flip)) == 0 {
            continue;
        }
        for (lane, found) in found.iter_mut().enumerate() {
            if truths[lane] ^ flip == 0 {
                continue;
            }
            if let Some(target) = targets.get(*found) {
                slots.longs[*target as usize].0[lane] = bit.entry;
            }
            *found += 1;
        }
    }
}

impl Step {
    /// Runs the step on all lanes.
    #[inline(always)]
    pub(super) fn run(&self, slots: &mut Slots, spares: &mut Spares, block: &Block<'_>) {
        let [truth, other] = &mut spares.truth;
        match *self {
            Self::Truth(ref arith) => arith.compute(slots, other, truth, block),
            Self::Short(ref arith) => arith.compute(slots, &mut spares.short, truth, block),
            Self::Int(ref arith) => arith.compute(slots, &mut spares.int, truth, block),
            Self::Long(ref arith) => arith.compute(slots, &mut spares.long, truth, block),
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
            Self::Product(ref product) => product.compute(slots, spares),
            Self::Quotient(ref quotient) => quotient.compute(slots, spares),
            Self::And { a, b, t } => {
                let (flip_a, flip_b) = (u8::from(a.1), u8::from(b.1));
                let all = &slots.truths;
                super::compute::rows(truth, &all[a.0 as usize], &all[b.0 as usize], |a, b| {
                    (a ^ flip_a) & (b ^ flip_b)
                });
                std::mem::swap(truth, &mut slots.truths[t as usize]);
            }
            Self::Xor { a, b, flip, t } => {
                let flip = u8::from(flip);
                let all = &slots.truths;
                super::compute::rows(truth, &all[a as usize], &all[b as usize], |a, b| {
                    a ^ b ^ flip
                });
                std::mem::swap(truth, &mut slots.truths[t as usize]);
            }
            Self::TruthTable {
                address,
                ref table,
                t,
            } => {
                super::table::look_up_truth(slots, truth, address, table);
                std::mem::swap(truth, &mut slots.truths[t as usize]);
            }
            Self::Address { ref bits, t } => {
                let row = &mut spares.int;
                row.0.fill(0);
                for bit in bits {
                    let flip = u8::from(bit.negated);
                    let truths = &slots.truths[bit.truth as usize].0;
                    for (t, truth) in row.0.iter_mut().zip(truths) {
                        *t |= i32::from(truth ^ flip) << bit.place;
                    }
                }
                std::mem::swap(row, &mut slots.ints[t as usize]);
            }
            Self::Encode {
                ref bits,
                ref targets,
            } => encode(slots, bits, targets),
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
            Self::Product(product) => product.visit(&mut see),
            Self::Quotient(quotient) => quotient.visit(&mut see),
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
            Self::TruthTable { address, t, .. } => {
                see(Seen::read(Kind::Int, address));
                see(Seen::computed(Kind::Truth, t));
            }
            Self::Address { bits, t } => {
                for bit in bits {
                    see(Seen::read(Kind::Truth, &mut bit.truth));
                }
                see(Seen::computed(Kind::Int, t));
            }
            Self::Encode { bits, targets } => {
                for bit in bits {
                    see(Seen::read(Kind::Truth, &mut bit.truth));
                }
                for target in targets {
                    see(Seen::computed(Kind::Long, target));
                }
            }
        }
    }
}
