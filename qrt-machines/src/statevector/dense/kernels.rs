//! Steps on a chunk of amplitudes that the nearest caches hold.

use num_complex::Complex;
use pulp::{Simd, WithSimd, bytemuck};

/// Qubits below this one are within vectors: their amplitudes are exchanged there.
const LOW: u32 = 3;

/// An operation on amplitudes; indices are those of memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::statevector) enum Kernel {
    /// Hadamards on all qubits of `mask`, with one factor for all.
    Hadamards { mask: usize, scale: f64 },
    /// A real matrix on one qubit.
    Rotate { target: u32, matrix: [[f64; 2]; 2] },
    /// Flips `target` where the index agrees with `value` on `mask`.
    Flip {
        target: u32,
        mask: usize,
        value: usize,
    },
    /// Multiplies by a factor where the index agrees with `value` on `mask`.
    Phase {
        factor: Complex<f64>,
        mask: usize,
        value: usize,
    },
}

impl Kernel {
    /// Qubits whose amplitudes the kernel mixes or exchanges, as a mask.
    pub(super) fn targets(&self) -> usize {
        match *self {
            Self::Hadamards { mask, .. } => mask,
            Self::Rotate { target, .. } | Self::Flip { target, .. } => 1 << target,
            Self::Phase { .. } => 0,
        }
    }
}

/// Runs steps on a chunk whose first amplitude has index `base`. The targets of the steps lie
/// within it.
pub(in crate::statevector) struct OnChunk<'a> {
    pub(in crate::statevector) steps: &'a [Kernel],
    pub(in crate::statevector) chunk: &'a mut [Complex<f64>],
    pub(in crate::statevector) base: usize,
}

impl WithSimd for OnChunk<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let within = self.chunk.len() - 1;
        let one = Complex::new(1.0, 0.0);
        // The product of the factors of the whole chunk, which is applied last.
        let mut all = one;
        for step in self.steps {
            match *step {
                Kernel::Hadamards { mask, scale } => {
                    hadamards(simd, bytemuck::cast_slice_mut(self.chunk), mask, scale);
                }
                Kernel::Rotate { target, matrix } => rotate(self.chunk, target, &matrix),
                Kernel::Flip {
                    target,
                    mask,
                    value,
                } => {
                    if (self.base ^ value) & mask & !within == 0 {
                        flip(self.chunk, target, mask & within, value & within);
                    }
                }
                Kernel::Phase {
                    factor,
                    mask,
                    value,
                } => {
                    if (self.base ^ value) & mask & !within == 0 {
                        if mask & within == 0 {
                            all *= factor;
                        } else {
                            phase(self.chunk, factor, mask & within, value & within);
                        }
                    }
                }
            }
        }
        if all != one {
            multiply(self.chunk, all);
        }
    }
}

#[inline(always)]
fn multiply(amplitudes: &mut [Complex<f64>], factor: Complex<f64>) {
    if factor == Complex::new(-1.0, 0.0) {
        for amplitude in amplitudes {
            *amplitude = -*amplitude;
        }
    } else {
        for amplitude in amplitudes {
            *amplitude *= factor;
        }
    }
}

/// Calls `each` for the first index of every run of indices that agree with `value` on `mask`. The
/// length of every run is the lowest bit of `mask`.
#[inline(always)]
pub(super) fn runs(len: usize, mask: usize, value: usize, mut each: impl FnMut(usize)) {
    let run = mask & mask.wrapping_neg();
    let free = !mask & (len - 1) & !(run - 1);
    let mut at = 0_usize;
    loop {
        each(at | value);
        // The next subset of the free bits.
        at = at.wrapping_sub(free) & free;
        if at == 0 {
            break;
        }
    }
}

#[inline(always)]
fn phase(chunk: &mut [Complex<f64>], factor: Complex<f64>, mask: usize, value: usize) {
    let run = mask & mask.wrapping_neg();
    runs(chunk.len(), mask, value, |first| {
        multiply(&mut chunk[first..first + run], factor);
    });
}

#[inline(always)]
fn flip(chunk: &mut [Complex<f64>], target: u32, mask: usize, value: usize) {
    let bit = 1 << target;
    let mask = mask | bit;
    let run = mask & mask.wrapping_neg();
    runs(chunk.len(), mask, value, |first| {
        let (low, high) = chunk.split_at_mut(first | bit);
        low[first..first + run].swap_with_slice(&mut high[..run]);
    });
}

#[inline(always)]
fn rotate(chunk: &mut [Complex<f64>], target: u32, matrix: &[[f64; 2]; 2]) {
    let half = 1 << target;
    for block in chunk.chunks_exact_mut(2 * half) {
        let (low, high) = block.split_at_mut(half);
        rotate_halves(low, high, matrix);
    }
}

#[inline(always)]
pub(super) fn rotate_halves(
    low: &mut [Complex<f64>],
    high: &mut [Complex<f64>],
    matrix: &[[f64; 2]; 2],
) {
    let [[m00, m01], [m10, m11]] = *matrix;
    for (a, b) in low.iter_mut().zip(high) {
        (*a, *b) = (*a * m00 + *b * m01, *a * m10 + *b * m11);
    }
}

/// `(a, b) -> (a + b, a - b) scale`, of two halves of amplitudes.
pub(super) struct Butterfly<'a> {
    pub(super) low: &'a mut [Complex<f64>],
    pub(super) high: &'a mut [Complex<f64>],
    pub(super) scale: f64,
}

impl WithSimd for Butterfly<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let low = bytemuck::cast_slice_mut(self.low);
        pairs(simd, low, bytemuck::cast_slice_mut(self.high), self.scale);
    }
}

/// Hadamards without normalization, times `scale`: a fast Walsh-Hadamard transform over the qubits
/// of `mask`. `data` are real and imaginary parts in turn, of at least 8 amplitudes.
#[inline(always)]
fn hadamards<S: Simd>(simd: S, data: &mut [f64], mask: usize, scale: f64) {
    let mut high = mask >> LOW << LOW;
    let low = mask & ((1 << LOW) - 1);
    if low != 0 {
        let scale = if high == 0 { scale } else { 1.0 };
        let (blocks, _) = data.as_chunks_mut::<{ 2 << LOW }>();
        match low {
            1 => within::<1>(blocks, scale),
            2 => within::<2>(blocks, scale),
            3 => within::<3>(blocks, scale),
            4 => within::<4>(blocks, scale),
            5 => within::<5>(blocks, scale),
            6 => within::<6>(blocks, scale),
            _ => within::<7>(blocks, scale),
        }
    }
    let mut next = || {
        let bit = high.trailing_zeros();
        high &= high.wrapping_sub(1);
        2_usize << bit
    };
    let mut left = (mask >> LOW).count_ones();
    while left > 0 {
        let near = next();
        if left >= 2 {
            left -= 2;
            let scale = if left == 0 { scale } else { 1.0 };
            fours(simd, data, [near, next()], scale);
        } else {
            left -= 1;
            for block in data.chunks_exact_mut(2 * near) {
                let (a, b) = block.split_at_mut(near);
                pairs(simd, a, b, scale);
            }
        }
    }
}

/// Hadamards on the qubits of `MASK`, among the lowest three.
#[inline(always)]
fn within<const MASK: usize>(blocks: &mut [[f64; 2 << LOW]], scale: f64) {
    for block in blocks {
        let mut v = *block;
        for bit in 0..LOW {
            if MASK >> bit & 1 == 0 {
                continue;
            }
            let stride = 2 << bit;
            let old = v;
            for k in 0..2 << LOW {
                let other = k ^ stride;
                v[k] = if k & stride == 0 {
                    old[k] + old[other]
                } else {
                    old[other] - old[k]
                };
            }
        }
        if scale != 1.0 {
            v = v.map(|part| part * scale);
        }
        *block = v;
        // Without this barrier, the compiler gathers and scatters vectors across blocks, at twice
        // the time.
        std::hint::black_box(&mut *block);
    }
}

#[inline(always)]
fn pairs<S: Simd>(simd: S, a: &mut [f64], b: &mut [f64], scale: f64) {
    let (a, _) = S::as_mut_simd_f64s(a);
    let (b, _) = S::as_mut_simd_f64s(b);
    let scale = simd.splat_f64s(scale);
    for (a, b) in a.iter_mut().zip(b) {
        let (sum, difference) = (simd.add_f64s(*a, *b), simd.sub_f64s(*a, *b));
        *a = simd.mul_f64s(sum, scale);
        *b = simd.mul_f64s(difference, scale);
    }
}

/// Two Hadamards at once, on halves that are `near` and `far` numbers apart, the nearer first.
#[inline(always)]
fn fours<S: Simd>(simd: S, data: &mut [f64], [near, far]: [usize; 2], scale: f64) {
    for block in data.chunks_exact_mut(2 * far) {
        let (low, high) = block.split_at_mut(far);
        let halves = low.chunks_exact_mut(2 * near);
        for (low, high) in halves.zip(high.chunks_exact_mut(2 * near)) {
            let (a, b) = low.split_at_mut(near);
            let (c, d) = high.split_at_mut(near);
            let [a, b, c, d] = [a, b, c, d].map(|part| S::as_mut_simd_f64s(part).0);
            for (((a, b), c), d) in a.iter_mut().zip(b).zip(c).zip(d) {
                let ([s, t], [u, v]) = (one(simd, *a, *b), one(simd, *c, *d));
                let ([p, q], [r, w]) = (one(simd, s, u), one(simd, t, v));
                [*a, *b, *c, *d] = scaled(simd, [p, r, q, w], scale);
            }
        }
    }
}

/// The sum and the difference of two amplitudes.
#[inline(always)]
fn one<S: Simd>(simd: S, a: S::f64s, b: S::f64s) -> [S::f64s; 2] {
    [simd.add_f64s(a, b), simd.sub_f64s(a, b)]
}

#[inline(always)]
fn scaled<S: Simd>(simd: S, values: [S::f64s; 4], scale: f64) -> [S::f64s; 4] {
    if scale == 1.0 {
        return values;
    }
    let factor = simd.splat_f64s(scale);
    [0, 1, 2, 3].map(|k| simd.mul_f64s(values[k], factor))
}
