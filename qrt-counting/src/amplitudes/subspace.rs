//! The plane of good and bad indices: two amplitudes for each value of the phase register.
//!
//! All good indices have one amplitude and all bad indices another. Therefore G is a rotation of
//! that plane, by `2 phi` with `sin(phi)^2 = S/N`. The amplitudes for value j of the phase register
//! are `w_j (sin((2j+1) phi), cos((2j+1) phi))`. Both are real: one is the real part and one the
//! imaginary part of the values that are transformed. The computation takes `O(T log T)` time and
//! is exact from S and N.

use super::AmplitudesError;
use super::fourier::Fourier;
use crate::{Double, check_counts};
use qrt_circuit::quantum::Window;
use qrt_machines::statevector::{StateVectorError, filled, fold};
use std::f64::consts::PI;

/// Most bits of a phase register whose amplitudes are listed.
pub(super) const MOST_PHASE_BITS: u32 = 24;

/// The distribution of counting `good` among `total` indices: by outcome `y = 0 ..= T/2`.
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::amplitudes::subspace;
/// // theta = 1/4 is on the grid.
/// let distribution = subspace(8, 16, 3, Window::Rect)?;
/// assert!((distribution[2] - 1.0).abs() < 1e-15);
/// # Ok::<(), qrt_counting::amplitudes::AmplitudesError>(())
/// ```
///
/// # Errors
/// If there are no indices, more good indices than indices, or the phase register is not in 1 to 24
/// bits.
pub fn subspace(
    good: u64,
    total: u64,
    phase_bits: u32,
    shape: Window,
) -> Result<Vec<f64>, AmplitudesError> {
    check_counts(good, total)?;
    if !(1..=MOST_PHASE_BITS).contains(&phase_bits) {
        return Err(AmplitudesError::PhaseBits {
            bits: phase_bits,
            most: MOST_PHASE_BITS,
        });
    }
    let size = 1_usize << phase_bits;
    // To 100 bits, because the phase of G^(2^k) has 2^k times the error of the phase of G.
    let all = Double::from(total);
    let (sine, cosine) = (
        Double::from(good).divide(all).sqrt(),
        Double::from(total - good).divide(all).sqrt(),
    );
    let mut power = turned((cosine, sine), (cosine, sine));
    let (mut re, mut im) = (filled([sine.hi], size)?, filled([cosine.hi], size)?);
    for bit in 0..phase_bits {
        let (c, s) = (power.0.hi, power.1.hi);
        let known = 1 << bit;
        for j in 0..known {
            let ([sine], [cosine]) = (re[j], im[j]);
            re[known + j] = [sine * c + cosine * s];
            im[known + j] = [cosine * c - sine * s];
        }
        power = turned(power, power);
    }
    let window = window(phase_bits, shape)?;
    for ((re, im), weight) in re.iter_mut().zip(&mut im).zip(window) {
        re[0] *= weight;
        im[0] *= weight;
    }
    let fourier = Fourier::new(phase_bits);
    fourier.transform(&mut re, &mut im);
    let probability = |y: usize| {
        let place = fourier.place(y);
        (re[place][0] * re[place][0] + im[place][0] * im[place][0]) / size as f64
    };
    let all: Vec<f64> = (0..size).map(probability).collect();
    Ok(fold(&all))
}

/// The sum of two angles, as cosine and sine.
fn turned(a: (Double, Double), b: (Double, Double)) -> (Double, Double) {
    (a.0 * b.0 - a.1 * b.1, a.1 * b.0 + a.0 * b.1)
}

/// The phase register's amplitudes.
pub(super) fn window(phase_bits: u32, shape: Window) -> Result<Vec<f64>, StateVectorError> {
    let size = 1_usize << phase_bits;
    let mut weights = filled(1.0 / (size as f64).sqrt(), size)?;
    if shape == Window::Sine {
        let points = size as f64 + 1.0;
        let most = (2.0 / points).sqrt();
        for (j, weight) in weights.iter_mut().enumerate() {
            // From the nearer end: a sine near half a turn would lose its last bits.
            let near = (j + 1).min(size - j);
            *weight = most * libm::sin(PI * (near as f64 / points));
        }
    }
    Ok(weights)
}
