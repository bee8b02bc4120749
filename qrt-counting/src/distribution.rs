//! The exact distribution P(theta~ | theta) of the outcomes of quantum counting.
//!
//! With S good indices among N, the Grover iterate has the eigenphases +-theta turns, where
//! `theta = asin(sqrt(S/N)) / pi` in [0, 1/2]. The uniform superposition of indices contains both
//! eigenvectors equally, and the phase register cannot distinguish them: outcomes y and T - y mean
//! the same `theta~ = y/T`. They are folded onto `y = 0 ..= T/2`. With the kernel K of a single
//! phase,
//!
//! ```text
//! P(y) = K(y - T theta) + K(y + T theta),   0 < y < T/2,
//! ```
//!
//! For y = 0 and y = T/2 the two terms coincide, and P(y) is one of them. The sum over all y is 1.

use qrt_circuit::quantum::Window;

use super::double::{self, Double};
use super::draw::Sampler;
use super::error::{CountingError, MAX_PHASE_BITS};
use super::kernel::Register;
use super::phase::{Phase, theta_of};
use crate::random::Stream;

/// ln P(y) for a phase; negative infinity where P is zero.
pub(crate) fn ln_probability(register: &Register, phase: Phase, y: u64) -> f64 {
    let (near, far) = roots(register, phase, y);
    let (large, small) = if near > far { (near, far) } else { (far, near) };
    if large == 0.0 {
        return f64::NEG_INFINITY;
    }
    let ratio = small / large;
    2.0 * libm::log(large) + libm::log1p(ratio * ratio)
}

/// The square roots of the two terms of P(y); the second is zero if the terms coincide.
fn roots(register: &Register, phase: Phase, y: u64) -> (f64, f64) {
    let half = register.size() / 2;
    let cell = phase.cell;
    let near = register.root(y as i64 - cell as i64, phase.offset);
    if y == 0 || y == half {
        return (near, 0.0);
    }
    // y + T theta, or T minus it: K has period T.
    let sum = y + cell;
    let far = if sum <= half {
        register.root(sum as i64, -phase.offset)
    } else {
        register.root((register.size() - sum) as i64, phase.offset)
    };
    (near, far)
}

/// P(theta~ | theta): the outcome distribution of a phase register of size `T = 2^phase_bits`.
///
/// Outcomes are folded onto `y = 0 ..= T/2`.
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::PhaseDistribution;
/// // Half of the indices are good: theta = 1/4 is on the grid, and is always read.
/// let distribution = PhaseDistribution::new(8, 16, 3, Window::Rect)?;
/// assert_eq!(distribution.probability(2), 1.0);
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseDistribution {
    register: Register,
    theta: f64,
    phase: Phase,
}

impl PhaseDistribution {
    /// The distribution for `good` among `total` indices.
    ///
    /// # Errors
    ///
    /// `total` is 0, `good` exceeds it, or `phase_bits` is not in `1..=40`.
    pub fn new(
        good: u64,
        total: u64,
        phase_bits: u32,
        window: Window,
    ) -> Result<Self, CountingError> {
        check_counts(good, total)?;
        Ok(Self::from_theta(
            theta_of(good, total),
            register(phase_bits, window)?,
        ))
    }

    /// The distribution for an `amplitude` S/N in [0, 1] that is not a ratio of known integers.
    ///
    /// # Errors
    ///
    /// The amplitude is not in [0, 1] (or not a number), or `phase_bits` is not in `1..=40`.
    pub fn from_amplitude(
        amplitude: f64,
        phase_bits: u32,
        window: Window,
    ) -> Result<Self, CountingError> {
        if !(0.0..=1.0).contains(&amplitude) {
            return Err(CountingError::AmplitudeOutOfRange(amplitude));
        }
        let theta = if amplitude == 0.5 {
            Double::from(0.25)
        } else {
            let good = Double::from(amplitude);
            double::theta(good, Double::ONE - good)
        };
        Ok(Self::from_theta(theta, register(phase_bits, window)?))
    }

    fn from_theta(theta: Double, register: Register) -> Self {
        Self {
            register,
            theta: theta.hi,
            phase: Phase::new(theta, &register),
        }
    }

    /// theta, in turns, in [0, 1/2].
    pub fn theta(&self) -> f64 {
        self.theta
    }

    /// T/2, the largest outcome.
    pub fn largest_outcome(&self) -> u64 {
        self.register.size() / 2
    }

    /// The outcome nearest to T theta.
    pub fn nearest_outcome(&self) -> u64 {
        self.phase.cell
    }

    /// P(y), to better than 1e-12; 0 beyond T/2, where there is no outcome.
    pub fn probability(&self, y: u64) -> f64 {
        if y > self.largest_outcome() {
            return 0.0;
        }
        let (near, far) = roots(&self.register, self.phase, y);
        near * near + far * far
    }

    /// ln P(y), which does not underflow; negative infinity if P(y) is zero.
    pub fn ln_probability(&self, y: u64) -> f64 {
        if y > self.largest_outcome() {
            return f64::NEG_INFINITY;
        }
        ln_probability(&self.register, self.phase, y)
    }

    /// Draws one outcome; for many, keep a [`PhaseDistribution::sampler`].
    pub fn sample(&self, stream: &mut Stream) -> u64 {
        self.sampler().sample(stream)
    }

    /// A sampler of this distribution, with O(1) expected time per draw for every T.
    pub fn sampler(&self) -> Sampler {
        Sampler::new(self.register, self.phase)
    }
}

pub(crate) fn check_counts(good: u64, total: u64) -> Result<(), CountingError> {
    if total == 0 {
        return Err(CountingError::NoIds);
    }
    if good > total {
        return Err(CountingError::MoreGoodThanTotal { good, total });
    }
    Ok(())
}

pub(crate) fn register(phase_bits: u32, window: Window) -> Result<Register, CountingError> {
    if !(1..=MAX_PHASE_BITS).contains(&phase_bits) {
        return Err(CountingError::PhaseBitsOutOfRange(phase_bits));
    }
    Ok(Register::new(phase_bits, window))
}
