//! The circuit whose amplitude is the mean itself, less a reference.
//!
//! Grover's mean algorithm, as Abrams & Williams simplified it, makes the *amplitude* of one basis
//! state equal to the mean of f - E, so that amplitude amplification magnifies the distance from a
//! reference E. They rotate a qubit by f(id) - E. The oracle here flips a phase, and the same
//! amplitude comes of one qubit more, the *coin*:
//!
//! ```text
//! W = (H^n x R(phi)^-1) (oracle, if the coin is 1) (sign, if the coin is 0) (H^n x R(phi)),
//! R(phi) |0> = cos(phi) |0> + sin(phi) |1>,    sin^2(phi) = 1 / (1 + |1 - 2E|).
//! ```
//!
//! With good ids, a = S/N of all, the oracle's mean sign is 1 - 2a. The coin's 0 contributes
//! `cos^2(phi)`, with the sign that is not that of 1 - 2E, so that the two cancel at a = E:
//!
//! ```text
//! <0|W|0> = sin^2(phi) ((1 - 2a) - (1 - 2E)) = (E - a) / max(E, 1 - E) = -sin(omega).
//! ```
//!
//! That is the mean of f - E in units of its largest value: of all circuits that ask the oracle
//! once, none has a larger slope with a zero at E. W is real and symmetric and its own inverse,
//! for the oracle is. So with `Z` the sign of |0...0>, m queries give a Chebyshev polynomial,
//!
//! ```text
//! |<0| W Z W ... Z W |0>| = |T_m(sin(omega))|,    m times W,
//! ```
//!
//! which is `|sin(m omega)|` for an odd m (amplitude amplification with W as preparation: k rounds
//! take m = 2k + 1) and `|cos(m omega)|` for an even one. Preparing and amplifying both ask the
//! oracle, and both are counted: m queries a shot.

use super::Device;
use crate::counting::Angle;
use crate::estimators::{EstimatorError, MAX_ITERATIONS};

impl Device<'_> {
    /// Of `shots` runs of the circuit shifted by `reference` = E, with `queries` = m each, those
    /// that give heads: all bits 0 if m is odd, any other outcome if m is even. At least one query.
    ///
    /// Without noise the probability is `sin^2(m omega)` with
    /// `sin(omega) = |a - E| / max(E, 1 - E)`, a = S/N. On a state that noise destroyed, the ids
    /// and the coin read 0 with probability 1/(2N). Outcomes that are read wrongly count as
    /// destroyed.
    ///
    /// # Errors
    /// A reference that is not in [0, 1], or more queries than [`MAX_ITERATIONS`].
    ///
    /// ```
    /// use qrt_runtime::estimators::{Device, Noise, Problem};
    /// use qrt_runtime::random::Stream;
    /// let (problem, mut stream) = (Problem { good: 3, total: 8 }, Stream::new(1, 0, 0, 0));
    /// let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
    /// // At the reference itself, nothing is left to be amplified.
    /// assert_eq!(device.shifted(0.375, 1001, 500)?, 0);
    /// assert_eq!(device.spent().queries, 500 * 1001);
    /// # Ok::<(), qrt_runtime::estimators::EstimatorError>(())
    /// ```
    pub fn shifted(
        &mut self,
        reference: f64,
        queries: u64,
        shots: u64,
    ) -> Result<u64, EstimatorError> {
        if !(0.0..=1.0).contains(&reference) {
            return Err(EstimatorError::ReferenceOutOfRange(reference));
        }
        if queries > MAX_ITERATIONS {
            return Err(EstimatorError::TooManyIterations(queries));
        }
        let queries = queries.max(1);
        self.spend(shots, queries);
        let omega = Angle::shifted(self.problem.good, self.problem.total, reference)?;
        let ideal = omega.sine_squared(queries);
        let right = self.noise.coin_intact(queries, self.problem.total);
        let zeros = 0.5 / self.problem.total as f64;
        let any = if queries % 2 == 1 {
            (zeros, 1.0 - zeros)
        } else {
            (1.0 - zeros, zeros)
        };
        let mixed = |ideal: f64, any: f64| right * ideal + (1.0 - right) * any;
        let (p, q) = (mixed(ideal.0, any.0), mixed(ideal.1, any.1));
        Ok(crate::counting::binomial::draw_with(shots, p, q, self.stream))
    }
}
