//! The Fourier transform that the phase register's gates amount to, computed as a fast one.

use std::f64::consts::TAU;

/// A transform of `2^bits` values, with precomputed factors.
pub(super) struct Fourier {
    bits: u32,
    /// `exp(-2 pi i k / 2^bits)`, for the first half of k.
    factors: Vec<[f64; 2]>,
}

impl Fourier {
    /// The transform of `2^bits` amplitudes.
    pub(super) fn new(bits: u32) -> Self {
        let size = 1_usize << bits;
        // Each factor is right to an ulp, because its angle counts from the nearest multiple of a
        // quarter turn.
        let factor = |k: usize| {
            let eighth = 8 * k / size;
            let angle = |k: usize| TAU * (k as f64 / size as f64);
            let (sine, cosine) = match eighth {
                0 => (libm::sin(angle(k)), libm::cos(angle(k))),
                1 | 2 => {
                    let rest = TAU * ((4 * k) as f64 / size as f64 - 1.0) / 4.0;
                    (libm::cos(rest), -libm::sin(rest))
                }
                _ => {
                    let rest = angle(size / 2 - k);
                    (libm::sin(rest), -libm::cos(rest))
                }
            };
            [cosine, -sine]
        };
        Self {
            bits,
            factors: (0..size / 2).map(factor).collect(),
        }
    }

    /// Replaces `values[j]` by `sum_j values[j] exp(-2 pi i j y / T)`, without normalization. The
    /// result for y is at [`Fourier::place`]. Real and imaginary parts are separate, and L
    /// transforms run at once.
    #[inline(always)]
    pub(super) fn transform<const L: usize>(&self, re: &mut [[f64; L]], im: &mut [[f64; L]]) {
        // Decimation in frequency (Gentleman & Sande, 1966): input in order, output in bit-reversed
        // order.
        for level in (0..self.bits).rev() {
            let half = 1 << level;
            let stride = self.factors.len() >> level;
            let blocks = re.chunks_exact_mut(2 * half);
            for (re, im) in blocks.zip(im.chunks_exact_mut(2 * half)) {
                let (re_low, re_high) = re.split_at_mut(half);
                let (im_low, im_high) = im.split_at_mut(half);
                let low = re_low.iter_mut().zip(im_low);
                let high = re_high.iter_mut().zip(im_high);
                let factors = self.factors.iter().step_by(stride.max(1));
                for (((a_re, a_im), (b_re, b_im)), [c, s]) in low.zip(high).zip(factors) {
                    for lane in 0..L {
                        let (re, im) = (a_re[lane] - b_re[lane], a_im[lane] - b_im[lane]);
                        a_re[lane] += b_re[lane];
                        a_im[lane] += b_im[lane];
                        b_re[lane] = re * c - im * s;
                        b_im[lane] = re * s + im * c;
                    }
                }
            }
        }
    }

    /// Position at which the transform leaves the value of y.
    pub(super) fn place(&self, y: usize) -> usize {
        y.reverse_bits() >> (usize::BITS - self.bits)
    }
}
