//! Functions of vectors, lane by lane.

use super::super::{Integers, Vectors};
use std::ops::RangeInclusive;

/// An instruction set's vectors, compared with functions of integers.
#[derive(Clone, Copy)]
pub(super) struct Lanes<V>(pub(super) V);

impl<V: Vectors> Lanes<V> {
    /// 1 where `truths` is true, 0 elsewhere.
    pub(super) fn digit(self, truths: V::Truths) -> V::Ints {
        self.0.ints(1).choose(truths, self.0.ints(0))
    }

    /// Loads `numbers` into the first lanes, and zeros into the others.
    fn load(self, numbers: impl Iterator<Item = i64>) -> V::Longs {
        let mut lanes = [0; 16];
        for (lane, number) in lanes.iter_mut().zip(numbers) {
            *lane = number;
        }
        self.0.wide_table(&lanes, self.0.narrow(self.0.from(0)))
    }

    #[track_caller]
    pub(super) fn longs2(
        self,
        pairs: &[(i64, i64)],
        f: impl Fn(V::Longs, V::Longs) -> V::Longs,
        definition: impl Fn(i64, i64) -> i64,
    ) {
        for chunk in pairs.chunks(V::LANES) {
            let a = self.load(chunk.iter().map(|pair| pair.0));
            let b = self.load(chunk.iter().map(|pair| pair.1));
            let mut found = vec![0; chunk.len()];
            self.0.store(f(a, b), &mut found);
            for (&(a, b), found) in chunk.iter().zip(found) {
                assert_eq!(found, definition(a, b), "of {a} and {b}");
            }
        }
    }

    #[track_caller]
    pub(super) fn longs1(
        self,
        numbers: &[(i64, i64)],
        f: impl Fn(V::Longs) -> V::Longs,
        definition: impl Fn(i64) -> i64,
    ) {
        self.longs2(numbers, |a, _| f(a), |a, _| definition(a));
    }

    #[track_caller]
    pub(super) fn ints2(
        self,
        pairs: &[(i64, i64)],
        f: impl Fn(V::Ints, V::Ints) -> V::Ints,
        definition: impl Fn(i64, i64) -> i64,
    ) {
        let v = self.0;
        let f = |a, b| v.widen(f(v.narrow(a), v.narrow(b)));
        self.longs2(pairs, f, definition);
    }

    #[track_caller]
    pub(super) fn ints1(
        self,
        numbers: &[(i64, i64)],
        f: impl Fn(V::Ints) -> V::Ints,
        definition: impl Fn(i64) -> i64,
    ) {
        self.ints2(numbers, |a, _| f(a), |a, _| definition(a));
    }
}

/// Returns the next pseudo-random number.
pub(super) fn chance(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ z >> 31
}

/// Pairs of numbers that are likely to matter: all pairs of numbers next to powers of two and to
/// the ends of the ranges, and some pairs of numbers of every size.
pub(super) fn samples(a: RangeInclusive<i64>, b: RangeInclusive<i64>) -> Vec<(i64, i64)> {
    let edges = |range: &RangeInclusive<i64>| {
        let powers = (0..63).step_by(if cfg!(miri) { 31 } else { 5 });
        let near = powers.flat_map(|bits| [(1_i64 << bits) - 1, 1 << bits, -(1 << bits)]);
        let all = near.chain([0, *range.start(), *range.end()]);
        all.filter(|n| range.contains(n)).collect::<Vec<_>>()
    };
    let others = edges(&b);
    let pairs = edges(&a);
    let pairs = pairs
        .iter()
        .flat_map(|a| others.iter().map(move |b| (*a, *b)));
    let mut state = 1;
    let mut any = |range: &RangeInclusive<i64>| {
        let size = chance(&mut state) % 64;
        let number = chance(&mut state).cast_signed() >> size;
        // The lowest 32 bits, for a range of 32-bit numbers.
        if range.contains(&number) {
            number
        } else {
            i64::from(number as i32)
        }
    };
    let some = (0..if cfg!(miri) { 20 } else { 1000 }).map(|_| (any(&a), any(&b)));
    pairs.chain(some).collect()
}
