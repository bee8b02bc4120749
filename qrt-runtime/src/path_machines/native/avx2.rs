//! Vectors of x86-64-v3: eight lanes in registers of 256 bits, truths as lanes of ones or zeros.

use super::scalar;
use super::vectors::{Integers, Truths, Vectors};
use super::x86::{common, halves, instructions, lane_by_lane, shifts, whole};
use pulp::x86::V3;
use std::arch::x86_64::{__m256d, __m256i};

/// 32 bits a lane: all ones or all zeros.
#[derive(Clone, Copy)]
pub struct Masks(V3, __m256i);

/// 32 bits a lane.
#[derive(Clone, Copy)]
pub struct Ints(V3, __m256i);

/// 64 bits a lane: the first four lanes and the last.
#[derive(Clone, Copy)]
pub struct Longs(V3, [__m256i; 2]);

impl Truths for Masks {
    instructions!(whole, avx2: and = _mm256_and_si256, xor = _mm256_xor_si256);

    #[inline(always)]
    fn not(self) -> Self {
        let all = self.0.avx._mm256_set1_epi32(-1);
        Self(self.0, self.0.avx2._mm256_xor_si256(self.1, all))
    }
}

impl Ints {
    #[inline(always)]
    fn all(simd: V3, value: i32) -> Self {
        Self(simd, simd.avx._mm256_set1_epi32(value))
    }
}

impl Integers<Masks> for Ints {
    instructions!(
        whole, avx2:
        add = _mm256_add_epi32,
        sub = _mm256_sub_epi32,
        mul = _mm256_mullo_epi32,
        xor = _mm256_xor_si256
    );
    shifts!(whole, avx2: left = _mm256_sllv_epi32, right = _mm256_srav_epi32);

    #[inline(always)]
    fn lowest(self, bits: u32) -> Self {
        let bits = Self::all(self.0, (u32::MAX >> (32 - bits)).cast_signed());
        whole!(self, bits, avx2._mm256_and_si256)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Masks {
        Masks(self.0, self.0.avx2._mm256_cmpgt_epi32(other.1, self.1))
    }
    #[inline(always)]
    fn has(self, bits: i64) -> Masks {
        let avx2 = self.0.avx2;
        let mask = Self::all(self.0, bits as i32);
        let set = avx2._mm256_and_si256(self.1, mask.1);
        if (bits as u32).is_power_of_two() {
            return Masks(self.0, avx2._mm256_cmpeq_epi32(set, mask.1));
        }
        let none = Self::all(self.0, 0);
        Masks(self.0, avx2._mm256_cmpeq_epi32(set, none.1)).not()
    }
    #[inline(always)]
    fn choose(self, when: Masks, other: Self) -> Self {
        let avx2 = self.0.avx2;
        Self(self.0, avx2._mm256_blendv_epi8(other.1, self.1, when.1))
    }
}

impl Longs {
    #[inline(always)]
    fn all(simd: V3, value: i64) -> Self {
        Self(simd, [simd.avx._mm256_set1_epi64x(value); 2])
    }

    /// Shifts right and fills with zeros.
    #[inline(always)]
    fn right_unsigned(self, by: u32) -> Self {
        let by = Self::all(self.0, by.into());
        halves!(self, by, avx2._mm256_srlv_epi64)
    }

    /// Products of the lower halves of lanes, unsigned.
    #[inline(always)]
    fn mul_low(self, other: Self) -> Self {
        halves!(self, other, avx2._mm256_mul_epu32)
    }

    #[inline(always)]
    fn equal(self, other: Self) -> Masks {
        halves!(self, other, avx2._mm256_cmpeq_epi64).masks()
    }

    /// Narrows lanes of ones or zeros.
    #[inline(always)]
    fn masks(self) -> Masks {
        Masks(self.0, self.0.narrow(self).1)
    }

    #[inline(always)]
    fn doubles(self) -> [__m256d; 2] {
        // The xor puts the exponent of 2^52 above the integer's bits, and the subtraction takes
        // 2^52 away.
        let (avx, power) = (self.0.avx, Self::all(self.0, POWER));
        let Self(_, [low, high]) = self.xor(power);
        let power = avx._mm256_castsi256_pd(power.1[0]);
        [
            avx._mm256_sub_pd(avx._mm256_castsi256_pd(low), power),
            avx._mm256_sub_pd(avx._mm256_castsi256_pd(high), power),
        ]
    }

    /// Returns the floors of numbers in 0 .. 2^52.
    #[inline(always)]
    fn floors(simd: V3, [low, high]: [__m256d; 2]) -> Self {
        let (avx, power) = (simd.avx, Self::all(simd, POWER));
        let one = avx._mm256_castsi256_pd(power.1[0]);
        let low = avx._mm256_add_pd(avx._mm256_floor_pd(low), one);
        let high = avx._mm256_add_pd(avx._mm256_floor_pd(high), one);
        let both = [avx._mm256_castpd_si256(low), avx._mm256_castpd_si256(high)];
        Self(simd, both).xor(power)
    }
}

/// 2^52, as an `f64`'s bits. The sum of 2^52 and a smaller integer has this integer in its lowest
/// bits.
const POWER: i64 = 0x4330_0000_0000_0000;

impl Integers<Masks> for Longs {
    instructions!(
        halves, avx2:
        add = _mm256_add_epi64,
        sub = _mm256_sub_epi64,
        xor = _mm256_xor_si256
    );
    shifts!(halves, avx2: left = _mm256_sllv_epi64);

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let crossed = self.right_unsigned(32).mul_low(other);
        let crossed = crossed.add(self.mul_low(other.right_unsigned(32)));
        self.mul_low(other).add(crossed.left(32))
    }
    #[inline(always)]
    fn right(self, by: u32) -> Self {
        // AVX2 has no 64-bit shift that copies the sign. Instead, xor and subtraction extend the
        // shifted sign bit.
        let sign = Self::all(self.0, (1_u64 << (63 - by)).cast_signed());
        self.right_unsigned(by).xor(sign).sub(sign)
    }
    #[inline(always)]
    fn lowest(self, bits: u32) -> Self {
        let bits = Self::all(self.0, (u64::MAX >> (64 - bits)).cast_signed());
        halves!(self, bits, avx2._mm256_and_si256)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Masks {
        halves!(other, self, avx2._mm256_cmpgt_epi64).masks()
    }
    #[inline(always)]
    fn has(self, bits: i64) -> Masks {
        let mask = Self::all(self.0, bits);
        let set = halves!(self, mask, avx2._mm256_and_si256);
        if bits.cast_unsigned().is_power_of_two() {
            return set.equal(mask);
        }
        set.equal(Self::all(self.0, 0)).not()
    }
    #[inline(always)]
    fn choose(self, when: Masks, other: Self) -> Self {
        let avx2 = self.0.avx2;
        let Self(_, when) = self.0.widen(Ints(when.0, when.1));
        let low = avx2._mm256_blendv_epi8(other.1[0], self.1[0], when[0]);
        let high = avx2._mm256_blendv_epi8(other.1[1], self.1[1], when[1]);
        Self(self.0, [low, high])
    }
}

/// A shuffle that moves the odd lanes to the places of the even ones.
const ODD: i32 = 0b11_11_01_01;

/// Returns entries of a table of eight, by the index's lowest 3 bits.
#[inline(always)]
fn eight(table: &[i32; 8], index: Ints) -> Ints {
    let avx2 = index.0.avx2;
    let table = pulp::cast(*table);
    Ints(index.0, avx2._mm256_permutevar8x32_epi32(table, index.1))
}

/// Returns `high` where bit `bit` of the index is set, and `low` elsewhere.
#[inline(always)]
fn either(low: Ints, high: Ints, index: Ints, bit: u32) -> Ints {
    // The blend reads only the sign bits.
    let avx = index.0.avx;
    let [low, high] = [
        avx._mm256_castsi256_ps(low.1),
        avx._mm256_castsi256_ps(high.1),
    ];
    let by = avx._mm256_castsi256_ps(index.left(31 - bit).1);
    let chosen = avx._mm256_blendv_ps(low, high, by);
    Ints(index.0, avx._mm256_castps_si256(chosen))
}

impl Vectors for V3 {
    common!(8);

    #[inline(always)]
    fn truths(self, all: bool) -> Masks {
        Masks(self, Ints::all(self, -i32::from(all)).1)
    }
    #[inline(always)]
    fn widen(self, a: Ints) -> Longs {
        let low = self.avx._mm256_castsi256_si128(a.1);
        let high = self.avx2._mm256_extracti128_si256::<1>(a.1);
        let low = self.avx2._mm256_cvtepi32_epi64(low);
        Longs(self, [low, self.avx2._mm256_cvtepi32_epi64(high)])
    }
    #[inline(always)]
    fn narrow(self, a: Longs) -> Ints {
        let avx = self.avx;
        // Takes the even lanes of both registers, quarter by quarter, and then puts the quarters in
        // order.
        let low = avx._mm256_castsi256_ps(a.1[0]);
        let high = avx._mm256_castsi256_ps(a.1[1]);
        let even = avx._mm256_shuffle_ps::<0b10_00_10_00>(low, high);
        let even = avx._mm256_castps_si256(even);
        Ints(
            self,
            self.avx2._mm256_permute4x64_epi64::<0b11_01_10_00>(even),
        )
    }

    #[inline(always)]
    fn product_above(self, a: Ints, b: Ints, drop: u32) -> Ints {
        let avx2 = self.avx2;
        let even = avx2._mm256_mul_epi32(a.1, b.1);
        let a = avx2._mm256_shuffle_epi32::<ODD>(a.1);
        let b = avx2._mm256_shuffle_epi32::<ODD>(b.1);
        let odd = avx2._mm256_mul_epi32(a, b);
        // Even products go into the lower half of each pair of lanes, and odd ones into the upper
        // half.
        let (even, odd) = if drop < 32 {
            let up = self.avx._mm256_set1_epi64x((32 - drop).into());
            let down = self.avx._mm256_set1_epi64x(drop.into());
            (
                avx2._mm256_srlv_epi64(even, down),
                avx2._mm256_sllv_epi64(odd, up),
            )
        } else {
            let upper = Ints(self, avx2._mm256_shuffle_epi32::<ODD>(even));
            let rest = drop - 32;
            (upper.right(rest).1, Ints(self, odd).right(rest).1)
        };
        Ints(self, avx2._mm256_blend_epi32::<0b1010_1010>(even, odd))
    }
    #[inline(always)]
    fn product(self, a: Ints, b: Ints) -> Longs {
        let (Longs(_, a), Longs(_, b)) = (self.widen(a), self.widen(b));
        let low = self.avx2._mm256_mul_epi32(a[0], b[0]);
        Longs(self, [low, self.avx2._mm256_mul_epi32(a[1], b[1])])
    }

    #[inline(always)]
    fn quotient_single(self, a: Ints, b: Ints, up: u32) -> Ints {
        let avx = self.avx;
        let power = avx._mm256_set1_ps(f32::from_bits((127 + up) << 23));
        let a = avx._mm256_mul_ps(avx._mm256_cvtepi32_ps(a.1), power);
        let quotient = avx._mm256_div_ps(a, avx._mm256_cvtepi32_ps(b.1));
        Ints(self, avx._mm256_cvttps_epi32(quotient))
    }
    #[inline(always)]
    fn quotient_double(self, a: Longs, b: Longs) -> Longs {
        let ([low, high], [by_low, by_high]) = (a.doubles(), b.doubles());
        let low = self.avx._mm256_div_pd(low, by_low);
        Longs::floors(self, [low, self.avx._mm256_div_pd(high, by_high)])
    }
    #[inline(always)]
    fn root_single(self, a: Ints) -> Ints {
        let avx = self.avx;
        let root = avx._mm256_sqrt_ps(avx._mm256_cvtepi32_ps(a.1));
        Ints(self, avx._mm256_cvttps_epi32(root))
    }
    #[inline(always)]
    fn root_double(self, a: Longs) -> Longs {
        let [low, high] = a.doubles();
        let low = self.avx._mm256_sqrt_pd(low);
        Longs::floors(self, [low, self.avx._mm256_sqrt_pd(high)])
    }
    #[inline(always)]
    fn table16(self, table: &[i32; 16], index: Ints) -> Ints {
        let [low, high]: [[i32; 8]; 2] = pulp::cast(*table);
        either(eight(&low, index), eight(&high, index), index, 3)
    }
    #[inline(always)]
    fn table32(self, table: &[i32; 32], index: Ints) -> Ints {
        let [low, high]: [[i32; 16]; 2] = pulp::cast(*table);
        let (low, high) = (self.table16(&low, index), self.table16(&high, index));
        either(low, high, index, 4)
    }
    #[inline(always)]
    fn table<const L: usize>(self, table: &[i32; L], index: Ints) -> Ints {
        const { assert!(L.is_power_of_two() && L > 1 && L <= 1 << 31) };
        let index = index.lowest(L.trailing_zeros());
        // SAFETY: `lowest` keeps only the bits of an index below L <= 2^31, so as a signed number
        // each index is in 0..L. The scale of 4 is the size of an entry. Therefore every read is
        // inside `table`.
        let found = unsafe {
            self.avx2
                ._mm256_i32gather_epi32::<4>(table.as_ptr(), index.1)
        };
        Ints(self, found)
    }
    #[inline(always)]
    fn marks(self, table: u32, index: Ints) -> Masks {
        let table = Ints::all(self, table.cast_signed());
        Ints(self, self.avx2._mm256_srlv_epi32(table.1, index.1)).has(1)
    }
}
