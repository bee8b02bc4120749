//! What a step computes on the lanes of a block, for one type of lane.

use super::lane::{Float, LANES, Lane, Row, Slots};
use super::steps::{Block, Seen};

/// An operand: a value, or the same number in all lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Arg<K> {
    Row(u32),
    Splat(K),
}

/// What a target keeps of a number: its lowest bits, as its type reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wrap<K> {
    pub(super) mask: K,
    /// The sign's weight, or 0.
    pub(super) half: K,
}

impl<K: Lane> Wrap<K> {
    /// All of it.
    pub(super) fn none() -> Self {
        Self {
            mask: K::cut(-1),
            half: K::cut(0),
        }
    }

    /// `width` bits.
    pub(super) fn new(width: u32, signed: bool) -> Self {
        if width >= K::BITS {
            return Self::none();
        }
        Self {
            mask: K::cut((u64::MAX >> (64 - width)).cast_signed()),
            half: K::cut(i64::from(signed) << (width - 1)),
        }
    }

    #[inline(always)]
    pub(super) fn of(self, value: K) -> K {
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
    /// The product fits, or what of it does not is not asked for.
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
    /// A classical word of the pixel.
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
        /// By lane: what `lane`, as the source, maps to.
        pattern: Box<Row<K>>,
        parameter: Option<u32>,
        wrap: Wrap<K>,
        t: u32,
    },
}

/// Where a linear map's source is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// An input register of so many bits.
    Input(u32, u32),
    /// `Long`
    Row(u32),
}

/// Entries up to which a table is read by comparing the address with each.
const FEW_ENTRIES: usize = 16;

/// Lanes that such a table is read for at a time: a register or two.
const READ: usize = 32;

#[inline(always)]
fn unary<K: Copy, T>(t: &mut Row<T>, a: &Row<K>, f: impl Fn(K) -> T) {
    for (t, a) in t.0.iter_mut().zip(&a.0) {
        *t = f(*a);
    }
}

#[inline(always)]
pub(super) fn rows<K: Copy, T>(t: &mut Row<T>, a: &Row<K>, b: &Row<K>, f: impl Fn(K, K) -> T) {
    for ((t, a), b) in t.0.iter_mut().zip(&a.0).zip(&b.0) {
        *t = f(*a, *b);
    }
}

#[inline(always)]
fn binary<K: Lane, T>(
    slots: &Slots,
    t: &mut Row<T>,
    (a, b): (Arg<K>, Arg<K>),
    f: impl Fn(K, K) -> T,
) {
    let all = K::rows(slots);
    match (a, b) {
        (Arg::Row(a), Arg::Row(b)) => rows(t, &all[a as usize], &all[b as usize], f),
        (Arg::Row(a), Arg::Splat(b)) => unary(t, &all[a as usize], |a| f(a, b)),
        (Arg::Splat(a), Arg::Row(b)) => unary(t, &all[b as usize], |b| f(a, b)),
        (Arg::Splat(a), Arg::Splat(b)) => t.0.iter_mut().for_each(|t| *t = f(a, b)),
    }
}

#[inline(always)]
fn select<K: Lane>(
    slots: &Slots,
    t: &mut Row<K>,
    when: &Row<u8>,
    (a, b): (Arg<K>, Arg<K>),
    wrap: Wrap<K>,
) {
    let all = K::rows(slots);
    let lanes = t.0.iter_mut().zip(&when.0);
    match (a, b) {
        (Arg::Row(a), Arg::Row(b)) => {
            let pairs = all[a as usize].0.iter().zip(&all[b as usize].0);
            for ((t, when), (a, b)) in lanes.zip(pairs) {
                *t = wrap.of(if *when == 0 { *b } else { *a });
            }
        }
        (Arg::Row(a), Arg::Splat(b)) => {
            for ((t, when), a) in lanes.zip(&all[a as usize].0) {
                *t = wrap.of(if *when == 0 { b } else { *a });
            }
        }
        (Arg::Splat(a), Arg::Row(b)) => {
            for ((t, when), b) in lanes.zip(&all[b as usize].0) {
                *t = wrap.of(if *when == 0 { *b } else { a });
            }
        }
        (Arg::Splat(a), Arg::Splat(b)) => {
            for (t, when) in lanes {
                *t = wrap.of(if *when == 0 { b } else { a });
            }
        }
    }
}

#[inline(always)]
fn divide<K: Lane>(
    (quotient, fits): (&mut Row<K>, &mut Row<u8>),
    (a, b): (&Row<K>, &Row<K>),
    width: u32,
    float: Float,
) {
    let all = Wrap::<K>::new(width, false).mask;
    // Not negative, so that a shift by all bits but the sign leaves 0 as one by more would.
    let down = width.min(K::BITS - 1);
    let lanes = quotient.0.iter_mut().zip(&mut fits.0);
    for ((quotient, fits), (a, b)) in lanes.zip(a.0.iter().zip(&b.0)) {
        let holds = a.right(down) < *b;
        let rest = if holds { *a } else { K::cut(0) };
        let none = *b == K::cut(0);
        let divisor = if none { K::cut(1) } else { *b };
        let value = rest.divided(divisor, float);
        *quotient = if none { all } else { value };
        *fits = u8::from(holds);
    }
}

#[inline(always)]
fn lookup<K: Lane>(t: &mut Row<K>, address: &Row<i32>, table: &[K]) {
    if table.len() > FEW_ENTRIES {
        for (t, address) in t.0.iter_mut().zip(&address.0) {
            *t = table.get(*address as usize).copied().unwrap_or_default();
        }
        return;
    }
    let chunks = t.0.as_chunks_mut::<READ>().0.iter_mut();
    for (t, address) in chunks.zip(address.0.as_chunks::<READ>().0) {
        let mut found = [K::default(); READ];
        for (place, entry) in table.iter().enumerate() {
            for (found, address) in found.iter_mut().zip(address) {
                *found = if *address == place as i32 {
                    *entry
                } else {
                    *found
                };
            }
        }
        *t = found;
    }
}

/// The image of `source` under `columns`.
pub(super) fn image(columns: &[u64], source: u64) -> u64 {
    let bits = columns.iter().enumerate();
    bits.fold(0, |sum, (bit, column)| {
        sum ^ (column & (source >> bit & 1).wrapping_neg())
    })
}

#[inline(always)]
fn parity<K: Lane>(
    (slots, block): (&Slots, &Block<'_>),
    t: &mut Row<K>,
    source: Source,
    columns: &[u64],
    pattern: &Row<K>,
    parameter: Option<u32>,
    wrap: Wrap<K>,
) {
    // Parameters are added over GF(2) first and the number is cut last, so that `pattern` holds
    // the bits, not what the target's type makes of them.
    let run = match source {
        Source::Input(input, _) => block.runs[input as usize],
        Source::Row(_) => None,
    };
    if let Some(first) = run {
        let high = K::cut(image(columns, first).cast_signed());
        block.each_span(|range, parameters| {
            let shift = parameter.map_or(0, |p| parameters[p as usize]);
            let start = K::cut(shift.cast_signed()).xor(high);
            let lanes = t.0[range.clone()].iter_mut().zip(&pattern.0[range]);
            lanes.for_each(|(t, low)| *t = wrap.of(low.xor(start)));
        });
        return;
    }
    block.each_span(|range, parameters| {
        let shift = parameter.map_or(0, |p| parameters[p as usize]);
        for lane in range {
            let source = match source {
                Source::Input(input, _) => block.input(input, lane),
                Source::Row(row) => slots.longs[row as usize].0[lane].cast_unsigned(),
            };
            let bits = image(columns, source) ^ shift;
            t.0[lane] = wrap.of(K::cut(bits.cast_signed()));
        }
    });
}

impl<K: Lane> Arith<K> {
    /// Computes into `spare`, or into `truth` if the target is one, and swaps it into its slot.
    #[inline(always)]
    pub(super) fn run(
        &self,
        slots: &mut Slots,
        spare: &mut Box<Row<K>>,
        truth: &mut Box<Row<u8>>,
        block: &Block<'_>,
    ) {
        let t = match *self {
            Self::Add { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.of(a.add(b)));
                t
            }
            Self::Sub { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.of(a.sub(b)));
                t
            }
            Self::Xor { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.of(a.xor(b)));
                t
            }
            Self::Mul {
                a,
                b,
                drop,
                wrap,
                t,
            } => {
                binary(slots, spare, (a, b), |a, b| wrap.of(a.mul(b).right(drop)));
                t
            }
            Self::Less { a, b, t } => {
                binary(slots, truth, (a, b), |a, b| u8::from(a < b));
                std::mem::swap(truth, &mut slots.truths[t as usize]);
                return;
            }
            Self::Select {
                when,
                a,
                b,
                wrap,
                t,
            } => {
                select(slots, spare, &slots.truths[when as usize], (a, b), wrap);
                t
            }
            Self::Negate {
                when,
                inverted,
                a,
                wrap,
                t,
            } => {
                let when = &slots.truths[when as usize].0;
                let plus = u8::from(inverted);
                let lanes = spare.0.iter_mut().zip(&K::rows(slots)[a as usize].0);
                for ((t, a), when) in lanes.zip(when) {
                    let minus = K::cut(0).sub(*a);
                    *t = wrap.of(if *when == plus { *a } else { minus });
                }
                t
            }
            Self::Cut {
                a,
                left,
                right,
                signed,
                up,
                t,
            } => {
                let a = &K::rows(slots)[a as usize];
                if signed {
                    unary(spare, a, |a| a.left(left).right(right).left(up));
                } else {
                    unary(spare, a, |a| a.left(left).right_unsigned(right).left(up));
                }
                t
            }
            Self::Wrap { a, wrap, t } => {
                binary(slots, spare, (a, Arg::Splat(K::cut(0))), |a, _| wrap.of(a));
                t
            }
            Self::Bit { a, index, t } => {
                let one = K::cut(1_i64 << index);
                let a = &K::rows(slots)[a as usize];
                unary(truth, a, |a| u8::from(a.and(one) != K::cut(0)));
                std::mem::swap(truth, &mut slots.truths[t as usize]);
                return;
            }
            Self::Divide {
                a,
                b,
                width,
                float,
                quotient,
                fits,
            } => {
                let all = K::rows(slots);
                let operands = (&*all[a as usize], &*all[b as usize]);
                let results = (&mut **spare, &mut **truth);
                match float {
                    Float::Single => divide(results, operands, width, Float::Single),
                    Float::Double => divide(results, operands, width, Float::Double),
                    Float::None => divide(results, operands, width, Float::None),
                }
                std::mem::swap(truth, &mut slots.truths[fits as usize]);
                quotient
            }
            Self::Root { a, float, t } => {
                let a = &K::rows(slots)[a as usize];
                match float {
                    Float::Single => unary(spare, a, |a| a.root(Float::Single)),
                    Float::Double => unary(spare, a, |a| a.root(Float::Double)),
                    Float::None => unary(spare, a, |a| a.root(Float::None)),
                }
                t
            }
            Self::Lookup {
                address,
                ref table,
                t,
            } => {
                lookup(spare, &slots.ints[address as usize], table);
                t
            }
            Self::Load { parameter, wrap, t } => {
                block.each_span(|range, parameters| {
                    let value = parameters[parameter as usize].cast_signed();
                    spare.0[range].fill(wrap.of(K::cut(value)));
                });
                t
            }
            Self::Input { input, wrap, t } => {
                for (lane, t) in spare.0.iter_mut().enumerate() {
                    *t = wrap.of(K::cut(block.input(input, lane).cast_signed()));
                }
                t
            }
            Self::Parity {
                source,
                ref columns,
                ref pattern,
                parameter,
                wrap,
                t,
            } => {
                let block = (&*slots, block);
                parity(block, spare, source, columns, pattern, parameter, wrap);
                t
            }
        };
        std::mem::swap(spare, &mut K::rows_mut(slots)[t as usize]);
    }

    /// Calls `see` on every value that the step reads or computes.
    pub(super) fn visit(&mut self, see: &mut impl FnMut(Seen<'_>), kind: super::lane::Kind) {
        use super::lane::Kind::{Int, Long, Truth};
        let mut args: [Option<&mut Arg<K>>; 2] = [None, None];
        match self {
            Self::Add { a, b, t, .. }
            | Self::Sub { a, b, t, .. }
            | Self::Xor { a, b, t, .. }
            | Self::Mul { a, b, t, .. } => {
                args = [Some(a), Some(b)];
                see(Seen::computed(kind, t));
            }
            Self::Less { a, b, t } => {
                args = [Some(a), Some(b)];
                see(Seen::computed(Truth, t));
            }
            Self::Select { when, a, b, t, .. } => {
                args = [Some(a), Some(b)];
                see(Seen::read(Truth, when));
                see(Seen::computed(kind, t));
            }
            Self::Negate { when, a, t, .. } => {
                see(Seen::read(Truth, when));
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
                see(Seen::computed(Truth, t));
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
                see(Seen::computed(Truth, fits));
            }
            Self::Lookup { address, t, .. } => {
                see(Seen::read(Int, address));
                see(Seen::computed(kind, t));
            }
            Self::Load { t, .. } | Self::Input { t, .. } => see(Seen::computed(kind, t)),
            Self::Parity { source, t, .. } => {
                if let Source::Row(source) = source {
                    see(Seen::read(Long, source));
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

const _: () = assert!(LANES.is_multiple_of(READ));
