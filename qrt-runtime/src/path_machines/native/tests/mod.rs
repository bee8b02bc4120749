//! Every method of [`Vectors`] against its definition on integers, for every instruction set that
//! this processor has.

mod exact;
mod lanes;

use super::{Integers, Truths, Vectors};
use lanes::{Lanes, samples};
use std::ops::RangeInclusive;

/// Calls `$check` with the vectors of every instruction set.
macro_rules! every_set {
    ($check:ident) => {{
        $check($crate::path_machines::native::tests::lanes::Lanes(
            $crate::path_machines::native::Scalar,
        ));
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V4::try_new() {
            $check($crate::path_machines::native::tests::lanes::Lanes(simd));
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            $check($crate::path_machines::native::tests::lanes::Lanes(simd));
        }
    }};
}

pub(super) use every_set;

/// Numbers that 32 and 64 bits hold.
const INTS: RangeInclusive<i64> = i32::MIN as i64..=i32::MAX as i64;
const LONGS: RangeInclusive<i64> = i64::MIN..=i64::MAX;

fn int(value: i128) -> i64 {
    (value as i32).into()
}

fn long(value: i128) -> i64 {
    value as i64
}

fn wide(a: i64, b: i64) -> [i128; 2] {
    [a.into(), b.into()]
}

fn ints_are_right<V: Vectors>(v: Lanes<V>) {
    let pairs = samples(INTS, INTS);
    let sum = |[a, b]: [i128; 2]| int(a + b);
    v.ints2(&pairs, V::Ints::add, |a, b| sum(wide(a, b)));
    v.ints2(&pairs, V::Ints::sub, |a, b| sum(wide(a, -b)));
    v.ints2(&pairs, V::Ints::mul, |a, b| {
        int(i128::from(a) * i128::from(b))
    });
    v.ints2(&pairs, V::Ints::xor, |a, b| a ^ b);
    v.ints2(&pairs, |a, b| v.digit(a.less(b)), |a, b| i64::from(a < b));
    for bits in 0..32 {
        v.ints1(&pairs, |a| a.left(bits), |a| int(i128::from(a) << bits));
        v.ints1(&pairs, |a| a.right(bits), |a| a >> bits);
        if bits > 0 {
            v.ints1(&pairs, |a| a.lowest(bits), |a| a & ((1 << bits) - 1));
        }
        let bit = 1_i64 << bits;
        v.ints1(&pairs, |a| v.digit(a.has(bit)), |a| a >> bits & 1);
    }
    let odd = |a: V::Ints| a.has(1);
    v.ints2(
        &pairs,
        |a, b| a.choose(odd(a), b),
        |a, b| if a & 1 == 1 { a } else { b },
    );
}

#[test]
fn ints_are_integers_of_32_bits() {
    every_set!(ints_are_right);
}

fn longs_are_right<V: Vectors>(v: Lanes<V>) {
    let pairs = samples(LONGS, LONGS);
    v.longs2(&pairs, V::Longs::add, i64::wrapping_add);
    v.longs2(&pairs, V::Longs::sub, i64::wrapping_sub);
    v.longs2(&pairs, V::Longs::mul, i64::wrapping_mul);
    v.longs2(&pairs, V::Longs::xor, |a, b| a ^ b);
    let less = |a: V::Longs, b| v.0.widen(v.digit(a.less(b)));
    v.longs2(&pairs, less, |a, b| i64::from(a < b));
    for bits in 0..64 {
        v.longs1(&pairs, |a| a.left(bits), |a| a << bits);
        v.longs1(&pairs, |a| a.right(bits), |a| a >> bits);
        let kept = (1_u64 << bits).wrapping_sub(1).cast_signed();
        if bits > 0 {
            v.longs1(&pairs, |a| a.lowest(bits), |a| a & kept);
        }
        let bit = 1_i64 << bits;
        v.longs1(
            &pairs,
            |a| v.0.widen(v.digit(a.has(bit))),
            |a| a >> bits & 1,
        );
    }
    v.longs2(
        &pairs,
        |a, b| a.choose(a.has(1), b),
        |a, b| if a & 1 == 1 { a } else { b },
    );
    v.longs1(&pairs, |a| v.0.widen(v.0.narrow(a)), |a| int(a.into()));
}

#[test]
fn longs_are_integers_of_64_bits() {
    every_set!(longs_are_right);
}

fn truths_are_right<V: Vectors>(v: Lanes<V>) {
    let pairs = samples(INTS, INTS);
    let both = |f: fn(V::Truths, V::Truths) -> V::Truths| {
        move |a: V::Ints, b: V::Ints| v.digit(f(a.has(1), b.has(1)))
    };
    v.ints2(&pairs, both(V::Truths::and), |a, b| a & b & 1);
    v.ints2(&pairs, both(V::Truths::xor), |a, b| (a ^ b) & 1);
    v.ints1(&pairs, |a| v.digit(a.has(1).not()), |a| !a & 1);
    for all in [false, true] {
        v.ints1(&pairs, |_| v.digit(v.0.truths(all)), |_| all.into());
    }
}

#[test]
fn truths_are_one_bit() {
    every_set!(truths_are_right);
}

fn the_same_is_everywhere<V: Vectors>(v: Lanes<V>) {
    for (a, b) in samples(INTS, LONGS) {
        v.ints1(&[(0, 0)], |_| v.0.ints(a as i32), |_| a);
        v.longs1(&[(0, 0)], |_| v.0.longs(b), |_| b);
    }
    for first in [0, 16, 1 << 31, 1 << 40] {
        let mut found = vec![0; V::LANES];
        v.0.store(v.0.from(first), &mut found);
        let expected = (0..V::LANES as i64).map(|lane| first as i64 + lane);
        assert!(found.iter().copied().eq(expected), "{found:?}");
        // Fewer places than lanes.
        let mut some = vec![0; V::LANES.min(3)];
        v.0.store(v.0.from(first), &mut some);
        assert_eq!(some, found[..some.len()]);
    }
}

#[test]
fn constants_and_ids_are_in_their_lanes() {
    every_set!(the_same_is_everywhere);
}

fn products_are_right<V: Vectors>(v: Lanes<V>) {
    let pairs = samples(INTS, INTS);
    v.longs2(
        &pairs,
        |a, b| v.0.product(v.0.narrow(a), v.0.narrow(b)),
        |a, b| a * b,
    );
    for drop in 0..64 {
        let above = |a, b| v.0.product_above(a, b, drop);
        v.ints2(&pairs, above, |a, b| int(((a * b) >> drop).into()));
    }
    let pairs = samples(LONGS, LONGS);
    for drop in 0..127 {
        let above = |a, b| v.0.product_of_longs(a, b, drop);
        v.longs2(&pairs, above, |a, b| {
            long((i128::from(a) * i128::from(b)) >> drop)
        });
    }
}

#[test]
fn products_have_all_their_bits() {
    every_set!(products_are_right);
}

fn tables_are_right<V: Vectors>(v: Lanes<V>) {
    let entries = samples(INTS, LONGS);
    let some = |n: usize| entries[n % entries.len()];
    let table: [i32; 256] = std::array::from_fn(|n| some(n).0 as i32);
    let wide: [i64; 256] = std::array::from_fn(|n| some(n).1);
    let (Some(first16), Some(first32)) = (table.first_chunk(), table.first_chunk()) else {
        panic!("256 are more than 32");
    };
    look_up(v, (first16, first32), &table, &wide);
}

fn look_up<V: Vectors>(
    v: Lanes<V>,
    (first16, first32): (&[i32; 16], &[i32; 32]),
    table: &[i32; 256],
    wide: &[i64; 256],
) {
    let indices: Vec<(i64, i64)> = (0..256).map(|index| (index, index)).collect();
    let entry = |index: i64| i64::from(table[index as usize]);
    v.ints1(&indices, |a| v.0.table16(first16, a), |a| entry(a & 15));
    v.ints1(&indices, |a| v.0.table32(first32, a), |a| entry(a & 31));
    v.ints1(&indices, |a| v.0.table(table, a), entry);
    // Only the lowest bits of an index count: no read is outside of a table.
    let any = samples(INTS, INTS);
    v.ints1(&any, |a| v.0.table(table, a), |a| entry(a & 255));
    let short: &[i32; 64] = table.first_chunk().unwrap();
    v.ints1(&any, |a| v.0.table(short, a), |a| entry(a & 63));
    let pair: &[i32; 2] = table.first_chunk().unwrap();
    v.ints1(&any, |a| v.0.table(pair, a), |a| entry(a & 1));
    v.longs1(
        &indices,
        |a| v.0.wide_table(wide, v.0.narrow(a)),
        |a| wide[a as usize],
    );
    for marks in [0, 1, 0x8000_0000, 0xdead_beef, u32::MAX] {
        let marked = |a| v.digit(v.0.marks(marks, a));
        v.ints1(&indices[..32], marked, |a| i64::from(marks >> a & 1));
    }
}

#[test]
fn tables_hold_what_was_put_there() {
    every_set!(tables_are_right);
}
