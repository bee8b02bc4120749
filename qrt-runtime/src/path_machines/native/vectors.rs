//! Operations that an instruction set must offer: vectors of truths and of integers.

/// Truths, one per lane.
pub trait Truths: Copy {
    /// The conjunction of both, lane by lane.
    fn and(self, other: Self) -> Self;
    /// True where the two differ.
    fn xor(self, other: Self) -> Self;
    /// The negation, lane by lane.
    fn not(self) -> Self;
}

/// Integers of one width, one per lane. Bits above the width are cut off.
pub trait Integers<T>: Copy {
    /// `a + b`
    fn add(self, other: Self) -> Self;
    /// `a - b`
    fn sub(self, other: Self) -> Self;
    /// `a b`
    fn mul(self, other: Self) -> Self;
    /// The exclusive or, bit by bit.
    fn xor(self, other: Self) -> Self;
    /// Shifts left. All shifts are by less than the lanes' width.
    fn left(self, by: u32) -> Self;
    /// Shifts right, with copies of the sign.
    fn right(self, by: u32) -> Self;
    /// The lowest `bits` bits, extended by zeros.
    fn lowest(self, bits: u32) -> Self;
    /// True where `a < b`.
    fn less(self, other: Self) -> T;
    /// True where any of `bits` is set.
    fn has(self, bits: i64) -> T;
    /// `self` where `when` is true, `other` elsewhere.
    fn choose(self, when: T, other: Self) -> Self;
}

/// An instruction set's vectors of [`Vectors::LANES`] lanes.
///
/// Each method is one instruction or a few. `qrt!` makes all decisions that depend on widths when
/// it writes the code that calls them.
pub trait Vectors: Copy {
    /// Number of lanes of a vector.
    const LANES: usize;
    /// Truth values of [`Vectors::LANES`] lanes.
    type Truths: Truths;
    /// Integers of 32 bits a lane.
    type Ints: Integers<Self::Truths>;
    /// Integers of 64 bits a lane.
    type Longs: Integers<Self::Truths>;

    /// The value `all` in all lanes.
    fn truths(self, all: bool) -> Self::Truths;
    /// The value `all` in all lanes.
    fn ints(self, all: i32) -> Self::Ints;
    /// The value `all` in all lanes.
    fn longs(self, all: i64) -> Self::Longs;
    /// `first`, `first + 1`, ...
    fn from(self, first: u64) -> Self::Longs;

    /// Extends every lane to 64 bits with copies of the sign.
    fn widen(self, a: Self::Ints) -> Self::Longs;
    /// Keeps the lowest 32 bits of every lane.
    fn narrow(self, a: Self::Longs) -> Self::Ints;

    /// The lowest bits of `a b >> drop`, from all bits of the product; `drop < 64`.
    fn product_above(self, a: Self::Ints, b: Self::Ints, drop: u32) -> Self::Ints;
    /// All bits of `a b`.
    fn product(self, a: Self::Ints, b: Self::Ints) -> Self::Longs;
    /// The lowest bits of `a b >> drop`, from all bits of the product.
    fn product_of_longs(self, a: Self::Longs, b: Self::Longs, drop: u32) -> Self::Longs;

    /// `a 2^up / b`, correctly rounded to 24 bits and then down, of numbers that fit into 24 bits.
    /// Any value where b is 0.
    fn quotient_single(self, a: Self::Ints, b: Self::Ints, up: u32) -> Self::Ints;
    /// `floor(a / b)` of numbers in 0 .. 2^52. Any value where b is 0.
    fn quotient_double(self, a: Self::Longs, b: Self::Longs) -> Self::Longs;
    /// `floor(a / b)` of numbers that are not negative. Any value where b is 0.
    fn quotient_of_longs(self, a: Self::Longs, b: Self::Longs) -> Self::Longs;
    /// `floor(sqrt(a))` of numbers in 0 .. 2^23.
    fn root_single(self, a: Self::Ints) -> Self::Ints;
    /// `floor(sqrt(a))` of numbers in 0 .. 2^52.
    fn root_double(self, a: Self::Longs) -> Self::Longs;
    /// `floor(sqrt(a))` of numbers that are not negative.
    fn root_of_longs(self, a: Self::Longs) -> Self::Longs;

    /// The entries that the index's lowest 4 bits name.
    fn table16(self, table: &[i32; 16], index: Self::Ints) -> Self::Ints;
    /// The entries that the index's lowest 5 bits name.
    fn table32(self, table: &[i32; 32], index: Self::Ints) -> Self::Ints;
    /// The entries that the index's lowest bits name; `L` is a power of two from 2 to 2^31.
    fn table<const L: usize>(self, table: &[i32; L], index: Self::Ints) -> Self::Ints;
    /// As [`Vectors::table`], for entries of 64 bits.
    fn wide_table<const L: usize>(self, table: &[i64; L], index: Self::Ints) -> Self::Longs;
    /// The bits of `table` that `index` names, which is below 32.
    fn marks(self, table: u32, index: Self::Ints) -> Self::Truths;

    /// Stores the first lanes in `lanes`, until that is full.
    fn store(self, a: Self::Longs, lanes: &mut [i64]);
}

/// The lowest `width` bits of the parameter `place`, extended by zeros or by copies of the top bit.
#[inline(always)]
pub fn word(words: &[u64], place: usize, width: u32, signed: bool) -> i64 {
    let word = words.get(place).copied().unwrap_or(0);
    let unused = 64 - width;
    let bits = word << unused;
    if signed {
        bits.cast_signed() >> unused
    } else {
        (bits >> unused).cast_signed()
    }
}
