//! Vectors of x86-64-v4: sixteen lanes in registers of 512 bits, truths in mask registers.

use super::scalar;
use super::vectors::{Integers, Truths, Vectors};
use super::x86::{common, halves, instructions, lane_by_lane, shifts, whole};
use pulp::x86::V4;
use std::arch::x86_64::__m512i;

/// One bit a lane.
#[derive(Clone, Copy)]
pub struct Masks(u16);

/// 32 bits a lane.
#[derive(Clone, Copy)]
pub struct Ints(V4, __m512i);

/// 64 bits a lane: the first eight lanes and the last.
#[derive(Clone, Copy)]
pub struct Longs(V4, [__m512i; 2]);

impl Truths for Masks {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Self(self.0 ^ other.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Ints {
    #[inline(always)]
    fn all(simd: V4, value: i32) -> Self {
        Self(simd, simd.avx512f._mm512_set1_epi32(value))
    }
}

impl Integers<Masks> for Ints {
    instructions!(
        whole, avx512f:
        add = _mm512_add_epi32,
        sub = _mm512_sub_epi32,
        mul = _mm512_mullo_epi32,
        xor = _mm512_xor_epi32
    );
    shifts!(whole, avx512f: left = _mm512_sllv_epi32, right = _mm512_srav_epi32);

    #[inline(always)]
    fn lowest(self, bits: u32) -> Self {
        let bits = Self::all(self.0, (u32::MAX >> (32 - bits)).cast_signed());
        whole!(self, bits, avx512f._mm512_and_epi32)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Masks {
        Masks(self.0.avx512f._mm512_cmplt_epi32_mask(self.1, other.1))
    }
    #[inline(always)]
    fn has(self, bits: i64) -> Masks {
        let f = self.0.avx512f;
        Masks(f._mm512_test_epi32_mask(self.1, f._mm512_set1_epi32(bits as i32)))
    }
    #[inline(always)]
    fn choose(self, when: Masks, other: Self) -> Self {
        let f = self.0.avx512f;
        Self(self.0, f._mm512_mask_mov_epi32(other.1, when.0, self.1))
    }
}

impl Longs {
    #[inline(always)]
    fn all(simd: V4, value: i64) -> Self {
        Self(simd, [simd.avx512f._mm512_set1_epi64(value); 2])
    }
}

impl Integers<Masks> for Longs {
    instructions!(
        halves, avx512f:
        add = _mm512_add_epi64,
        sub = _mm512_sub_epi64,
        xor = _mm512_xor_epi64
    );
    instructions!(halves, avx512dq: mul = _mm512_mullo_epi64);
    shifts!(halves, avx512f: left = _mm512_sllv_epi64, right = _mm512_srav_epi64);

    #[inline(always)]
    fn lowest(self, bits: u32) -> Self {
        let bits = Self::all(self.0, (u64::MAX >> (64 - bits)).cast_signed());
        halves!(self, bits, avx512f._mm512_and_epi64)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Masks {
        let f = self.0.avx512f;
        let low = f._mm512_cmplt_epi64_mask(self.1[0], other.1[0]);
        let high = f._mm512_cmplt_epi64_mask(self.1[1], other.1[1]);
        Masks(u16::from(low) | u16::from(high) << 8)
    }
    #[inline(always)]
    fn has(self, bits: i64) -> Masks {
        let f = self.0.avx512f;
        let bits = f._mm512_set1_epi64(bits);
        let low = f._mm512_test_epi64_mask(self.1[0], bits);
        let high = f._mm512_test_epi64_mask(self.1[1], bits);
        Masks(u16::from(low) | u16::from(high) << 8)
    }
    #[inline(always)]
    fn choose(self, when: Masks, other: Self) -> Self {
        let f = self.0.avx512f;
        let low = f._mm512_mask_mov_epi64(other.1[0], when.0 as u8, self.1[0]);
        let high = f._mm512_mask_mov_epi64(other.1[1], (when.0 >> 8) as u8, self.1[1]);
        Self(self.0, [low, high])
    }
}

/// A shuffle that moves the odd lanes to the places of the even ones.
const ODD: i32 = 0b11_11_01_01;

/// Mask of the odd lanes.
const ODD_LANES: u16 = 0xaaaa;

impl Vectors for V4 {
    common!(16);

    #[inline(always)]
    fn truths(self, all: bool) -> Masks {
        Masks(if all { u16::MAX } else { 0 })
    }
    #[inline(always)]
    fn widen(self, a: Ints) -> Longs {
        let f = self.avx512f;
        let low = f._mm512_castsi512_si256(a.1);
        let high = f._mm512_extracti64x4_epi64::<1>(a.1);
        Longs(
            self,
            [f._mm512_cvtepi32_epi64(low), f._mm512_cvtepi32_epi64(high)],
        )
    }
    #[inline(always)]
    fn narrow(self, a: Longs) -> Ints {
        let f = self.avx512f;
        let low = f._mm512_castsi256_si512(f._mm512_cvtepi64_epi32(a.1[0]));
        let high = f._mm512_cvtepi64_epi32(a.1[1]);
        Ints(self, f._mm512_inserti64x4::<1>(low, high))
    }

    #[inline(always)]
    fn product_above(self, a: Ints, b: Ints, drop: u32) -> Ints {
        let f = self.avx512f;
        let even = f._mm512_mul_epi32(a.1, b.1);
        let a = f._mm512_shuffle_epi32::<ODD>(a.1);
        let b = f._mm512_shuffle_epi32::<ODD>(b.1);
        let odd = f._mm512_mul_epi32(a, b);
        // Even products go into the lower half of each pair of lanes, and odd ones into the upper
        // half.
        let down = f._mm512_set1_epi64(drop.into());
        let even = f._mm512_srav_epi64(even, down);
        let odd = if drop < 32 {
            f._mm512_sllv_epi64(odd, f._mm512_set1_epi64((32 - drop).into()))
        } else {
            f._mm512_srav_epi64(odd, f._mm512_set1_epi64((drop - 32).into()))
        };
        Ints(self, f._mm512_mask_mov_epi32(even, ODD_LANES, odd))
    }
    #[inline(always)]
    fn product(self, a: Ints, b: Ints) -> Longs {
        let (Longs(_, a), Longs(_, b)) = (self.widen(a), self.widen(b));
        let f = self.avx512f;
        let low = f._mm512_mul_epi32(a[0], b[0]);
        Longs(self, [low, f._mm512_mul_epi32(a[1], b[1])])
    }

    #[inline(always)]
    fn quotient_single(self, a: Ints, b: Ints, up: u32) -> Ints {
        let f = self.avx512f;
        let power = f._mm512_set1_ps(f32::from_bits((127 + up) << 23));
        let a = f._mm512_mul_ps(f._mm512_cvtepi32_ps(a.1), power);
        let quotient = f._mm512_div_ps(a, f._mm512_cvtepi32_ps(b.1));
        Ints(self, f._mm512_cvttps_epi32(quotient))
    }
    #[inline(always)]
    fn quotient_double(self, a: Longs, b: Longs) -> Longs {
        let (f, dq) = (self.avx512f, self.avx512dq);
        let a = [dq._mm512_cvtepi64_pd(a.1[0]), dq._mm512_cvtepi64_pd(a.1[1])];
        let b = [dq._mm512_cvtepi64_pd(b.1[0]), dq._mm512_cvtepi64_pd(b.1[1])];
        let low = dq._mm512_cvttpd_epi64(f._mm512_div_pd(a[0], b[0]));
        let high = dq._mm512_cvttpd_epi64(f._mm512_div_pd(a[1], b[1]));
        Longs(self, [low, high])
    }
    #[inline(always)]
    fn root_single(self, a: Ints) -> Ints {
        let f = self.avx512f;
        let root = f._mm512_sqrt_ps(f._mm512_cvtepi32_ps(a.1));
        Ints(self, f._mm512_cvttps_epi32(root))
    }
    #[inline(always)]
    fn root_double(self, a: Longs) -> Longs {
        let (f, dq) = (self.avx512f, self.avx512dq);
        let low = f._mm512_sqrt_pd(dq._mm512_cvtepi64_pd(a.1[0]));
        let high = f._mm512_sqrt_pd(dq._mm512_cvtepi64_pd(a.1[1]));
        let low = dq._mm512_cvttpd_epi64(low);
        Longs(self, [low, dq._mm512_cvttpd_epi64(high)])
    }

    #[inline(always)]
    fn table16(self, table: &[i32; 16], index: Ints) -> Ints {
        let f = self.avx512f;
        Ints(
            self,
            f._mm512_permutexvar_epi32(index.1, pulp::cast(*table)),
        )
    }
    #[inline(always)]
    fn table32(self, table: &[i32; 32], index: Ints) -> Ints {
        let f = self.avx512f;
        let [low, high]: [__m512i; 2] = pulp::cast(*table);
        Ints(self, f._mm512_permutex2var_epi32(low, index.1, high))
    }
    #[inline(always)]
    fn table<const L: usize>(self, table: &[i32; L], index: Ints) -> Ints {
        const { assert!(L.is_power_of_two() && L > 1 && L <= 1 << 31) };
        let (f, index) = (self.avx512f, index.lowest(L.trailing_zeros()));
        // SAFETY: `lowest` keeps only the bits of an index below L <= 2^31, so as a signed number
        // each index is in 0..L. The scale of 4 is the size of an entry. Therefore every read is
        // inside `table`.
        let found = unsafe { f._mm512_i32gather_epi32::<4>(index.1, table.as_ptr()) };
        Ints(self, found)
    }
    #[inline(always)]
    fn marks(self, table: u32, index: Ints) -> Masks {
        let f = self.avx512f;
        let table = f._mm512_set1_epi32(table.cast_signed());
        Ints(self, f._mm512_srlv_epi32(table, index.1)).has(1)
    }
}
