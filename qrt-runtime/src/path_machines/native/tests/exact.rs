//! Tests of quotients and roots, which floating-point numbers compute in place of integers.

use super::super::{Integers, Vectors};
use super::every_set;
use super::lanes::{Lanes, chance, samples};

/// Number of samples of a kind.
const MANY: usize = if cfg!(miri) { 40 } else { 20_000 };

fn double_quotients_are_floors<V: Vectors>(v: Lanes<V>) {
    let mut state = 7;
    let pairs = (0..MANY).map(|n| {
        let b = (chance(&mut state) >> (12 + chance(&mut state) % 52)).max(1);
        let whole = (chance(&mut state) >> 12) / b * b;
        // Next to an integer, from both sides.
        (whole.saturating_sub((n % 2) as u64) as i64, b as i64)
    });
    let pairs: Vec<_> = pairs.collect();
    v.longs2(&pairs, |a, b| v.0.quotient_double(a, b), |a, b| a / b);
}

#[test]
fn quotients_of_52_bits_are_floors() {
    every_set!(double_quotients_are_floors);
}

fn quotients_are_floors<V: Vectors>(v: Lanes<V>) {
    let pairs = samples(0..=i64::MAX, 1..=i64::MAX);
    let pairs: Vec<_> = pairs
        .into_iter()
        .map(|(a, b)| (a.max(0), b.max(1)))
        .collect();
    v.longs2(&pairs, |a, b| v.0.quotient_of_longs(a, b), |a, b| a / b);
}

#[test]
fn quotients_of_63_bits_are_floors() {
    every_set!(quotients_are_floors);
}

/// Checks that quotients are the floor, or one more where they are rounded to the next integer.
fn single_quotients_are_near<V: Vectors>(v: Lanes<V>) {
    let mut state = 3;
    for up in (0..60).step_by(if cfg!(miri) { 29 } else { 1 }) {
        let pairs = (0..MANY / 20).map(|n| {
            let b = (chance(&mut state) >> (40 + chance(&mut state) % 24)).max(1);
            // A quotient of up to 24 bits.
            let quotient = chance(&mut state) >> (40 + chance(&mut state) % 24);
            let a = (u128::from(quotient) * u128::from(b)).div_ceil(1 << up) as u64;
            (
                a.saturating_sub((n % 2) as u64).min(0xff_ffff) as i64,
                b as i64,
            )
        });
        let exact = |a: i64, b: i64| (i128::from(a) << up) / i128::from(b);
        let pairs: Vec<_> = pairs.filter(|(a, b)| exact(*a, *b) < 1 << 24).collect();
        let excess = |a: V::Longs, b: V::Longs| {
            let near = v.0.quotient_single(v.0.narrow(a), v.0.narrow(b), up);
            // The remainder's sign distinguishes the two, as in the code that `qrt!` writes.
            let near = v.0.widen(near);
            let product = near.mul(b);
            let beyond = a.left(up).sub(product).less(v.0.longs(0));
            near.sub(v.0.longs(1)).choose(beyond, near)
        };
        v.longs2(&pairs, excess, |a, b| exact(a, b) as i64);
    }
}

#[test]
fn quotients_of_24_bits_are_floors_or_one_more() {
    every_set!(single_quotients_are_near);
}

fn single_roots_are_floors<V: Vectors>(v: Lanes<V>) {
    let step = if cfg!(miri) { 99_991 } else { 1 };
    let all: Vec<(i64, i64)> = (0..1 << 23).step_by(step).map(|a| (a, 0)).collect();
    v.ints1(&all, |a| v.0.root_single(a), |a| a.isqrt());
}

#[test]
fn roots_of_all_23_bits_are_floors() {
    every_set!(single_roots_are_floors);
}

fn roots_are_floors<V: Vectors>(v: Lanes<V>) {
    let mut state = 5;
    let mut next_to_squares = |bits: u64| {
        let squares = (0..MANY).map(|n| {
            let root = chance(&mut state) >> (64 - bits / 2 + chance(&mut state) % (bits / 2));
            let square = (root * root) as i64;
            ((square - (n % 2) as i64).max(0), 0)
        });
        squares.collect::<Vec<_>>()
    };
    let of_52 = next_to_squares(52);
    v.longs1(&of_52, |a| v.0.root_double(a), i64::isqrt);
    let of_62 = next_to_squares(62);
    v.longs1(&of_62, |a| v.0.root_of_longs(a), i64::isqrt);
}

#[test]
fn roots_are_the_floors_of_roots() {
    every_set!(roots_are_floors);
}
