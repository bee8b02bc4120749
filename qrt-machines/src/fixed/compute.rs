//! Computes steps of one type of lane.
//!
//! Every loop is over all lanes of a block, and short enough that the compiler vectorizes it for
//! each instruction set.

use super::arith::{Arg, Arith, Source, Wrap};
use super::block::Block;
use super::lane::{Float, Lane, Row, Slot, Slots};
use super::table::look_up;

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
    // With masks, because the compiler would turn a choice between two places in memory into a
    // gather.
    let choose = |when: u8, a: K, b: K| {
        let chosen = K::cut(0).sub(K::cut(i64::from(when)));
        wrap.apply(b.xor(a.xor(b).and(chosen)))
    };
    let lanes = t.0.iter_mut().zip(&when.0);
    match (a, b) {
        (Arg::Row(a), Arg::Row(b)) => {
            let pairs = all[a as usize].0.iter().zip(&all[b as usize].0);
            lanes
                .zip(pairs)
                .for_each(|((t, when), (a, b))| *t = choose(*when, *a, *b));
        }
        (Arg::Row(a), Arg::Splat(b)) => {
            let lanes = lanes.zip(&all[a as usize].0);
            lanes.for_each(|((t, when), a)| *t = choose(*when, *a, b));
        }
        (Arg::Splat(a), Arg::Row(b)) => {
            let lanes = lanes.zip(&all[b as usize].0);
            lanes.for_each(|((t, when), b)| *t = choose(*when, a, *b));
        }
        (Arg::Splat(a), Arg::Splat(b)) => {
            lanes.for_each(|(t, when)| *t = choose(*when, a, b));
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
    // `a` is not negative. Therefore a shift by all bits except the sign leaves 0, as a longer
    // shift would.
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

/// Returns the image of `source` under `columns`.
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
    // The parameter is added over GF(2) first, and the number is cut last. Therefore `pattern`
    // holds plain bits, not numbers of the target's type.
    let run = match source {
        Source::Input(input) => block.runs[input as usize],
        Source::Row(_) => None,
    };
    if let Some(first) = run {
        let high = K::cut(image(columns, first).cast_signed());
        block.each_span(|range, parameters| {
            let shift = parameter.map_or(0, |p| parameters[p as usize]);
            let start = K::cut(shift.cast_signed()).xor(high);
            let lanes = t.0[range.clone()].iter_mut().zip(&pattern.0[range]);
            lanes.for_each(|(t, low)| *t = wrap.apply(low.xor(start)));
        });
        return;
    }
    block.each_span(|range, parameters| {
        let shift = parameter.map_or(0, |p| parameters[p as usize]);
        for lane in range {
            let source = match source {
                Source::Input(input) => block.input(input, lane),
                Source::Row(row) => slots.longs[row as usize].0[lane].cast_unsigned(),
            };
            let bits = image(columns, source) ^ shift;
            t.0[lane] = wrap.apply(K::cut(bits.cast_signed()));
        }
    });
}

impl<K: Lane> Arith<K> {
    /// Computes into `spare`, or into `truth` if the target is a truth, and swaps the result into
    /// its slot.
    #[inline(always)]
    pub(super) fn compute(
        &self,
        slots: &mut Slots,
        spare: &mut Slot<K>,
        truth: &mut Slot<u8>,
        block: &Block<'_>,
    ) {
        let t = match *self {
            Self::Add { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.apply(a.add(b)));
                t
            }
            Self::Sub { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.apply(a.sub(b)));
                t
            }
            Self::Xor { a, b, wrap, t } => {
                binary(slots, spare, (a, b), |a, b| wrap.apply(a.xor(b)));
                t
            }
            Self::Mul {
                a,
                b,
                drop,
                wrap,
                t,
            } => {
                binary(slots, spare, (a, b), |a, b| {
                    wrap.apply(a.mul(b).right(drop))
                });
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
                    *t = wrap.apply(if *when == plus { *a } else { minus });
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
                binary(slots, spare, (a, Arg::Splat(K::cut(0))), |a, _| {
                    wrap.apply(a)
                });
                t
            }
            Self::Bit { a, index, t } => {
                let one = K::cut(1_i64 << index);
                let a = &K::rows(slots)[a as usize];
                unary(truth, a, |a| u8::from(a.and(one) != K::cut(0)));
                std::mem::swap(truth, &mut slots.truths[t as usize]);
                return;
            }
            Self::SumBit {
                a,
                b,
                subtract,
                index,
                t,
            } => {
                let one = K::cut(1_i64 << index);
                let read = |sum: K| u8::from(sum.and(one) != K::cut(0));
                if subtract {
                    binary(slots, truth, (a, b), |a, b| read(a.sub(b)));
                } else {
                    binary(slots, truth, (a, b), |a, b| read(a.add(b)));
                }
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
                look_up(spare, &slots.ints[address as usize], table);
                t
            }
            Self::Load { parameter, wrap, t } => {
                block.each_span(|range, parameters| {
                    let value = parameters[parameter as usize].cast_signed();
                    spare.0[range].fill(wrap.apply(K::cut(value)));
                });
                t
            }
            Self::Input { input, wrap, t } => {
                for (lane, t) in spare.0.iter_mut().enumerate() {
                    *t = wrap.apply(K::cut(block.input(input, lane).cast_signed()));
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
}
