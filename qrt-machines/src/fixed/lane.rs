//! Lanes of integers, which hold the values of a block of states.

/// Number of states of a block.
///
/// Longer blocks spread the cost of choosing a step over more lanes; shorter ones keep a program's
/// live values in the nearest cache.
pub(super) const LANES: usize = 512;

/// Storage of a value's lanes: the narrowest that all of the value's contents fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Kind {
    /// A truth: a byte that is 0 or 1.
    Truth,
    /// Lanes of 16 bits.
    Short,
    /// Lanes of 32 bits.
    Int,
    /// Lanes of 64 bits.
    Long,
}

impl Kind {
    /// Number of bits of a lane.
    pub(super) fn bits(self) -> u32 {
        match self {
            Self::Truth => 1,
            Self::Short => 16,
            Self::Int => 32,
            Self::Long => 64,
        }
    }

    /// The narrowest kind of number that holds all of `low ..= high`.
    pub(super) fn for_range([low, high]: [i64; 2]) -> Self {
        let holds = |bits: u32| low >= -1 << (bits - 1) && high < 1 << (bits - 1);
        if holds(16) {
            Self::Short
        } else if holds(32) {
            Self::Int
        } else {
            Self::Long
        }
    }
}

/// The lanes of one value, aligned to cache lines.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Row<K>(pub(super) [K; LANES]);

impl<K: Copy + Default> Default for Row<K> {
    fn default() -> Self {
        Self([K::default(); LANES])
    }
}

/// The lanes of a value. A step computes its result in a spare row and swaps it in; only pointers
/// move.
pub(super) type Slot<K> = Box<Row<K>>;

/// Lanes of values, by kind.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    pub(super) truths: Vec<Slot<u8>>,
    pub(super) shorts: Vec<Slot<i16>>,
    pub(super) ints: Vec<Slot<i32>>,
    pub(super) longs: Vec<Slot<i64>>,
}

/// Spare rows, in which steps compute results before these take their slots.
#[derive(Clone, Debug)]
pub(super) struct Spares {
    pub(super) truth: [Slot<u8>; 2],
    pub(super) short: Slot<i16>,
    pub(super) int: Slot<i32>,
    pub(super) long: Slot<i64>,
}

/// A type of lane.
pub(super) trait Lane: Copy + Default + PartialEq + PartialOrd + std::fmt::Debug {
    const BITS: u32;
    /// The lowest bits of `value`, up to the lane's width.
    fn cut(value: i64) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn and(self, other: Self) -> Self;
    fn xor(self, other: Self) -> Self;
    fn left(self, by: u32) -> Self;
    /// Shifts right, with copies of the sign.
    fn right(self, by: u32) -> Self;
    /// Shifts right and fills with zeros.
    fn right_unsigned(self, by: u32) -> Self;
    /// `floor(a / b)` of non-negative numbers, exact for numbers within the limit of `how`; b is
    /// not 0.
    fn divided(self, by: Self, how: Float) -> Self;
    /// `floor(sqrt(a))` of a non-negative number.
    fn root(self, how: Float) -> Self;
    fn rows(slots: &Slots) -> &[Slot<Self>];
    fn rows_mut(slots: &mut Slots) -> &mut Vec<Slot<Self>>;
}

/// The numbers with which divisions and square roots are computed.
///
/// A quotient of integers a < 2^p and b, rounded to p bits, has the same floor as the exact
/// quotient. The exact quotient lies at least 1/b below the next integer, and the rounding error is
/// at most (a/b) 2^-p < 1/b. The same holds for square roots: the distance of a root below k to k
/// is more than 1/(2k), and the error is at most half a unit in the last place, which is no more
/// than that as long as k^2 <= 2^p.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Float {
    /// Numbers below 2^23: `f32`.
    Single,
    /// Numbers below 2^52: `f64`.
    Double,
    /// Integers.
    None,
}

impl Float {
    /// Returns the numbers for operands of `bits` bits.
    pub(super) fn for_bits(bits: u32) -> Self {
        match bits {
            0..=23 => Self::Single,
            24..=52 => Self::Double,
            _ => Self::None,
        }
    }
}

/// 2^23 and 2^52. The sum with a smaller integer has this integer in the lowest bits of its
/// significand.
const SINGLE: f32 = 8_388_608.0;
const DOUBLE: f64 = 4_503_599_627_370_496.0;

// Conversions go through the significand: those by `as` saturate, which costs more than the
// division, and most instruction sets lack those of 64 bits.

/// Returns the floor of `value`, an integer in 0 .. 2^23.
#[inline(always)]
fn floor_single(value: f32) -> i32 {
    ((value.floor() + SINGLE).to_bits() ^ SINGLE.to_bits()).cast_signed()
}

/// Returns the floor of `value`, an integer in 0 .. 2^52.
#[inline(always)]
pub(super) fn floor_double(value: f64) -> i64 {
    ((value.floor() + DOUBLE).to_bits() ^ DOUBLE.to_bits()).cast_signed()
}

/// Converts an integer in 0 .. 2^52.
#[inline(always)]
fn double(value: i64) -> f64 {
    f64::from_bits(value.cast_unsigned() | DOUBLE.to_bits()) - DOUBLE
}

macro_rules! lane {
    ($type:ident, $unsigned:ident, $bits:literal, $rows:ident) => {
        impl Lane for $type {
            const BITS: u32 = $bits;
            #[inline(always)]
            fn cut(value: i64) -> Self {
                value as Self
            }
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
            fn and(self, other: Self) -> Self {
                self & other
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
            fn right_unsigned(self, by: u32) -> Self {
                (self as $unsigned).wrapping_shr(by) as Self
            }
            #[inline(always)]
            fn divided(self, by: Self, how: Float) -> Self {
                match how {
                    Float::Single => floor_single(self as i32 as f32 / by as i32 as f32) as Self,
                    Float::Double => floor_double(double(self as i64) / double(by as i64)) as Self,
                    Float::None => self.checked_div(by).unwrap_or(0),
                }
            }
            #[inline(always)]
            fn root(self, how: Float) -> Self {
                match how {
                    Float::Single => floor_single((self as i32 as f32).sqrt()) as Self,
                    Float::Double => floor_double(double(self as i64).sqrt()) as Self,
                    Float::None => (self as $unsigned).isqrt() as Self,
                }
            }
            #[inline(always)]
            fn rows(slots: &Slots) -> &[Slot<Self>] {
                &slots.$rows
            }
            #[inline(always)]
            fn rows_mut(slots: &mut Slots) -> &mut Vec<Slot<Self>> {
                &mut slots.$rows
            }
        }
    };
}

lane!(u8, u8, 8, truths);
lane!(i16, u16, 16, shorts);
lane!(i32, u32, 32, ints);
lane!(i64, u64, 64, longs);
