//! One lane: plain integers, for any processor.

use super::vectors::{Integers, Truths, Vectors};

/// The instruction set that every processor has.
#[derive(Clone, Copy)]
pub struct Scalar;

impl Truths for bool {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self ^ other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
}

macro_rules! integers {
    ($type:ident) => {
        impl Integers<bool> for $type {
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                self.wrapping_add(other)
            }
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                self.wrapping_mul(other)
            }
            #[inline(always)]
            fn xor(self, other: Self) -> Self {
                self ^ other
            }
            #[inline(always)]
            fn left(self, by: u32) -> Self {
                self.wrapping_shl(by)
            }
            #[inline(always)]
            fn right(self, by: u32) -> Self {
                self.wrapping_shr(by)
            }
            #[inline(always)]
            fn lowest(self, bits: u32) -> Self {
                self & (1 as Self).wrapping_shl(bits).wrapping_sub(1)
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn has(self, bits: i64) -> bool {
                self & bits as Self != 0
            }
            #[inline(always)]
            fn choose(self, when: bool, other: Self) -> Self {
                if when { self } else { other }
            }
        }
    };
}

integers!(i32);
integers!(i64);

impl Vectors for Scalar {
    const LANES: usize = 1;
    type Truths = bool;
    type Ints = i32;
    type Longs = i64;

    #[inline(always)]
    fn truths(self, all: bool) -> bool {
        all
    }
    #[inline(always)]
    fn ints(self, all: i32) -> i32 {
        all
    }
    #[inline(always)]
    fn longs(self, all: i64) -> i64 {
        all
    }
    #[inline(always)]
    fn from(self, first: u64) -> i64 {
        first.cast_signed()
    }

    #[inline(always)]
    fn widen(self, a: i32) -> i64 {
        a.into()
    }
    #[inline(always)]
    fn narrow(self, a: i64) -> i32 {
        a as i32
    }

    #[inline(always)]
    fn product_above(self, a: i32, b: i32, drop: u32) -> i32 {
        (self.product(a, b) >> drop) as i32
    }
    #[inline(always)]
    fn product(self, a: i32, b: i32) -> i64 {
        i64::from(a) * i64::from(b)
    }

    #[inline(always)]
    fn quotient_single(self, a: i32, b: i32, up: u32) -> i32 {
        (a as f32 * f32::from_bits((127 + up) << 23) / b as f32) as i32
    }
    #[inline(always)]
    fn quotient_double(self, a: i64, b: i64) -> i64 {
        a.checked_div(b).unwrap_or(0)
    }
    #[inline(always)]
    fn root_single(self, a: i32) -> i32 {
        (a as f32).sqrt() as i32
    }
    #[inline(always)]
    fn root_double(self, a: i64) -> i64 {
        (a as f64).sqrt() as i64
    }

    #[inline(always)]
    fn product_of_longs(self, a: i64, b: i64, drop: u32) -> i64 {
        one(a, b, |a, b| products(a, b, drop))
    }
    #[inline(always)]
    fn quotient_of_longs(self, a: i64, b: i64) -> i64 {
        one(a, b, quotients)
    }
    #[inline(always)]
    fn root_of_longs(self, a: i64) -> i64 {
        one(a, a, roots)
    }

    #[inline(always)]
    fn table16(self, table: &[i32; 16], index: i32) -> i32 {
        self.table(table, index)
    }
    #[inline(always)]
    fn table32(self, table: &[i32; 32], index: i32) -> i32 {
        self.table(table, index)
    }
    #[inline(always)]
    fn table<const L: usize>(self, table: &[i32; L], index: i32) -> i32 {
        const { assert!(L.is_power_of_two() && L > 1 && L <= 1 << 31) };
        table[index.cast_unsigned() as usize & (L - 1)]
    }
    #[inline(always)]
    fn wide_table<const L: usize>(self, table: &[i64; L], index: i32) -> i64 {
        table[index.cast_unsigned() as usize & (L - 1)]
    }
    #[inline(always)]
    fn marks(self, table: u32, index: i32) -> bool {
        table.wrapping_shr(index.cast_unsigned()) & 1 == 1
    }

    #[inline(always)]
    fn store(self, a: i64, lanes: &mut [i64]) {
        lanes.fill(a);
    }
}

fn one(a: i64, b: i64, change: impl FnOnce(&mut [i64], &[i64])) -> i64 {
    let mut lane = [a];
    change(&mut lane, &[b]);
    lane[0]
}

/// Sets each `a` of `lanes` to `floor(a b / 2^drop)`, with `b` from `others`.
#[inline(never)]
pub(super) fn products(lanes: &mut [i64], others: &[i64], drop: u32) {
    for (a, b) in lanes.iter_mut().zip(others) {
        *a = ((i128::from(*a) * i128::from(*b)) >> drop.min(127)) as i64;
    }
}

/// Sets each `a` of `lanes` to `floor(a / b)`, with `b` from `others`; to 0 where b is 0.
#[inline(never)]
pub(super) fn quotients(lanes: &mut [i64], others: &[i64]) {
    for (a, b) in lanes.iter_mut().zip(others) {
        *a = a.checked_div(*b).unwrap_or(0);
    }
}

/// Sets each `a` of `lanes` to `floor(sqrt(a))`.
#[inline(never)]
pub(super) fn roots(lanes: &mut [i64], _: &[i64]) {
    for a in lanes {
        *a = a.cast_unsigned().isqrt().cast_signed();
    }
}

/// Returns entries of a table, lane by lane. Not inlined, because it is long and rarely called.
#[inline(never)]
pub(super) fn entries<const L: usize, const N: usize>(
    table: &[i64; L],
    index: [u32; N],
) -> [i64; N] {
    let mut found = [0; N];
    for (found, index) in found.iter_mut().zip(index) {
        *found = table[index as usize & (L - 1)];
    }
    found
}
