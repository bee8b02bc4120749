//! Truth values of lanes as the bits of a number: the first lane is the lowest bit.

use pulp::bytemuck::{self, NoUninit};
use pulp::{Simd, WithSimd};

/// Returns the lanes in which `mask` is true.
#[inline(always)]
pub(super) fn bits<S: Simd>(simd: S, mask: S::m64s) -> u32 {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = same(&simd) {
        let v3: &pulp::x86::V3 = v3;
        if let Some(mask) = same(&mask) {
            let mask: &pulp::m64x4 = mask;
            return v3.avx._mm256_movemask_pd(bytemuck::cast(*mask)) as u32;
        }
    }
    let _ = simd;
    short(&mask).unwrap_or_else(|| {
        let lanes: &[u64] = bytemuck::cast_slice(std::slice::from_ref(&mask));
        let flags = lanes.iter().enumerate();
        flags.fold(0, |bits, (lane, flag)| bits | (flag & 1 << lane) as u32)
    })
}

/// Returns the single-precision lanes in which `mask` is true.
#[inline(always)]
pub(super) fn bits_of_singles<S: Simd>(simd: S, mask: S::m32s) -> u32 {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = same(&simd) {
        let v3: &pulp::x86::V3 = v3;
        if let Some(mask) = same(&mask) {
            let mask: &pulp::m32x8 = mask;
            return v3.avx._mm256_movemask_ps(bytemuck::cast(*mask)) as u32;
        }
    }
    let _ = simd;
    short(&mask).unwrap_or_else(|| {
        let lanes: &[u32] = bytemuck::cast_slice(std::slice::from_ref(&mask));
        let flags = lanes.iter().enumerate();
        flags.fold(0, |bits, (lane, flag)| bits | flag & 1 << lane)
    })
}

/// Returns `value` if it has type `B`, which is known at compile time.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn same<A: 'static, B: 'static>(value: &A) -> Option<&B> {
    (value as &dyn std::any::Any).downcast_ref()
}

/// Returns the bits of a mask that has one bit for each lane: a mask register, or the truth value
/// of a single lane.
#[inline(always)]
fn short<M: NoUninit>(mask: &M) -> Option<u32> {
    match *bytemuck::bytes_of(mask) {
        [bits] => Some(u32::from(bits)),
        [low, high] => Some(u32::from(u16::from_le_bytes([low, high]))),
        _ => None,
    }
}

/// Runs `work` in registers of at most 256 bits. Eight single-precision or four double-precision
/// numbers fill them. Half-filled wider registers would be loaded through a mask and divided at
/// half the speed.
#[inline(always)]
pub(super) fn at_256_bits<S: Simd, W: WithSimd>(simd: S, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(v4) = same(&simd) {
        let v4: &pulp::x86::V4 = v4;
        return work.with_simd(**v4);
    }
    work.with_simd(simd)
}
