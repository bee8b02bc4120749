//! Amplitudes over (phase register, index), for ancillas that are known to return to zero.
//!
//! The oracle is a sign for each index, and diffusion is twice the mean less each amplitude. For
//! value j of the phase register, the indices hold `w_j G^j |s>`. Its amplitudes are real, and
//! those of one more query follow from those of one less. Only the mean connects the indices. Once
//! the means are known, the amplitudes of each index for all values j can be computed separately,
//! and so can its Fourier transform over the phase register. The computation takes `O(T N log T)`
//! time and `O(T + N)` memory.

use super::AmplitudesError;
use super::fourier::Fourier;
use super::subspace::window;
use pulp::{Simd, WithSimd};
use qrt_circuit::quantum::Window;
use qrt_machines::InstructionSet;
use qrt_machines::statevector::{StateVectorError, filled, fold};
use rayon::prelude::*;

/// Number of transforms at once. Each has two indices: one is the real part, one the imaginary
/// part.
const LANES: usize = 8;

/// Most bits of a phase register: a batch of transforms takes 128 bytes for each value.
const MOST_PHASE_BITS: u32 = 20;

/// Number of indices whose amplitudes are summed in a run.
const RUN: usize = 1 << 12;

/// Number of parts of the indices. Each part is transformed and summed separately.
const PARTS: usize = 32;

/// The distribution of counting over a truth table, `good[id]`: by outcome `y = 0 ..= T/2`.
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::PhaseDistribution;
/// use qrt_counting::amplitudes::reduced;
/// let good = [true, false, false, true, false, false, false, true];
/// let amplitudes = reduced(&good, 4, Window::Sine)?;
/// let exact = PhaseDistribution::new(3, 8, 4, Window::Sine)?;
/// for (y, probability) in amplitudes.iter().enumerate() {
///     assert!((probability - exact.probability(y as u64)).abs() < 1e-14);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the table's size is not a power of two, or the phase register is not in 1 to 20 bits.
pub fn reduced(good: &[bool], phase_bits: u32, shape: Window) -> Result<Vec<f64>, AmplitudesError> {
    if !good.len().is_power_of_two() {
        return Err(AmplitudesError::TableSize(good.len()));
    }
    if !(1..=MOST_PHASE_BITS).contains(&phase_bits) {
        return Err(AmplitudesError::PhaseBits {
            bits: phase_bits,
            most: MOST_PHASE_BITS,
        });
    }
    let size = 1 << phase_bits;
    let set = InstructionSet::widest();
    let window = window(phase_bits, shape)?;
    let start = 1.0 / (good.len() as f64).sqrt();
    let signs: Vec<f64> = good.iter().map(|g| if *g { -1.0 } else { 1.0 }).collect();

    // Twice the mean of each query.
    let mut amplitudes = filled(start, good.len())?;
    let mut means = filled(0.0, size)?;
    for slot in &mut means {
        let runs = signs.par_chunks(RUN).zip(amplitudes.par_chunks(RUN));
        let sums: Vec<f64> = runs
            .map(|(signs, amplitudes)| set.dispatch(Sum { signs, amplitudes }))
            .collect();
        let mean = 2.0 * sums.iter().sum::<f64>() / good.len() as f64;
        *slot = mean;
        let runs = signs.par_chunks(RUN).zip(amplitudes.par_chunks_mut(RUN));
        runs.for_each(|(signs, amplitudes)| {
            set.dispatch(Query {
                signs,
                amplitudes,
                mean,
            });
        });
    }

    let fourier = Fourier::new(phase_bits);
    let batches: Vec<&[f64]> = signs.chunks(2 * LANES).collect();
    // The parts do not depend on threads, so the sums are always the same, in the same order.
    let parts = batches.par_chunks(batches.len().div_ceil(PARTS));
    let parts: Vec<Vec<f64>> = parts
        .map(|batches| {
            let mut sums = filled(0.0, size)?;
            let mut re = filled([0.0; LANES], size)?;
            let mut im = filled([0.0; LANES], size)?;
            for signs in batches {
                set.dispatch(Batch {
                    signs,
                    means: &means,
                    window: &window,
                    start,
                    fourier: &fourier,
                    re: &mut re,
                    im: &mut im,
                    sums: &mut sums,
                });
            }
            Ok(sums)
        })
        .collect::<Result<_, StateVectorError>>()?;
    let all: Vec<f64> = (0..size)
        .map(|y| {
            let place = fourier.place(y);
            parts.iter().map(|sums| sums[place]).sum::<f64>() / size as f64
        })
        .collect();
    // The transforms of a pair of indices would be separated by y and T - y. Folding adds these
    // two, so there is no need to separate them.
    Ok(fold(&all))
}

/// The sum of amplitudes with their signs.
struct Sum<'a> {
    signs: &'a [f64],
    amplitudes: &'a [f64],
}

impl WithSimd for Sum<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        // Eight partial sums for vectors of any width, so that the bits are the same.
        let mut sums = [0.0; 8];
        let (signs, signs_rest) = self.signs.as_chunks::<8>();
        let (amplitudes, rest) = self.amplitudes.as_chunks::<8>();
        for (sign, amplitude) in signs.iter().zip(amplitudes) {
            for lane in 0..8 {
                sums[lane] += sign[lane] * amplitude[lane];
            }
        }
        let rest = signs_rest.iter().zip(rest);
        sums.iter().sum::<f64>() + rest.map(|(sign, amplitude)| sign * amplitude).sum::<f64>()
    }
}

/// One query: the oracle's sign, and diffusion.
struct Query<'a> {
    signs: &'a [f64],
    amplitudes: &'a mut [f64],
    mean: f64,
}

impl WithSimd for Query<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (amplitude, sign) in self.amplitudes.iter_mut().zip(self.signs) {
            *amplitude = self.mean - sign * *amplitude;
        }
    }
}

/// The transforms of up to `2 LANES` indices, added to the sums.
struct Batch<'a> {
    signs: &'a [f64],
    means: &'a [f64],
    window: &'a [f64],
    start: f64,
    fourier: &'a Fourier,
    re: &'a mut [[f64; LANES]],
    im: &'a mut [[f64; LANES]],
    sums: &'a mut [f64],
}

impl WithSimd for Batch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut signs = [0.0; 2 * LANES];
        let mut now = [0.0; 2 * LANES];
        let mut there = [0.0; 2 * LANES];
        for (lane, sign) in self.signs.iter().enumerate() {
            (signs[lane], now[lane], there[lane]) = (*sign, self.start, 1.0);
        }
        let rows = self.re.iter_mut().zip(&mut *self.im);
        let counters = self.means.iter().zip(self.window);
        for ((re, im), (mean, weight)) in rows.zip(counters) {
            for lane in 0..LANES {
                re[lane] = weight * now[lane];
                im[lane] = weight * now[LANES + lane];
            }
            for lane in 0..2 * LANES {
                now[lane] = mean * there[lane] - signs[lane] * now[lane];
            }
        }
        self.fourier.transform(self.re, self.im);
        for ((re, im), sum) in self.re.iter().zip(&*self.im).zip(self.sums) {
            let mut square = 0.0;
            for lane in 0..LANES {
                square += re[lane] * re[lane] + im[lane] * im[lane];
            }
            *sum += square;
        }
    }
}
