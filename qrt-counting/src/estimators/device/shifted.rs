//! The shifted circuit, whose amplitude is the mean itself minus a reference.
//!
//! Grover's mean algorithm, as Abrams & Williams simplified it, makes the *amplitude* of one basis
//! state equal to the mean of f - E, so that amplitude amplification magnifies the distance from a
//! reference E. They rotate a qubit by f(index) - E. The oracle here flips a phase instead. One
//! more qubit, the *coin*, gives the same amplitude:
//!
//! ```text
//! W = (H^n x R(phi)^-1) (oracle, if the coin is 1) (sign, if the coin is 0) (H^n x R(phi)),
//! R(phi) |0> = cos(phi) |0> + sin(phi) |1>,    sin^2(phi) = 1 / (1 + |1 - 2E|).
//! ```
//!
//! If the good indices are a fraction a = S/N, the oracle's mean sign is 1 - 2a. The coin's 0
//! contributes `cos^2(phi)`, with the sign opposite to that of 1 - 2E, so that the two cancel at a
//! = E:
//!
//! ```text
//! <0|W|0> = sin^2(phi) ((1 - 2a) - (1 - 2E)) = (E - a) / max(E, 1 - E) = -sin(omega).
//! ```
//!
//! That is the mean of f - E in units of its largest value. Of all circuits that call the oracle
//! once and have a zero at E, none has a larger slope. W is real, symmetric and its own inverse,
//! because the oracle is. With `Z` the sign of |0...0>, m queries therefore give a Chebyshev
//! polynomial,
//!
//! ```text
//! |<0| W Z W ... Z W |0>| = |T_m(sin(omega))|,    m times W,
//! ```
//!
//! which is `|sin(m omega)|` for an odd m (amplitude amplification with W as preparation: k rounds
//! take m = 2k + 1) and `|cos(m omega)|` for an even one. Preparation and amplification both call
//! the oracle, and both count: m queries per shot.

use super::Device;
use crate::Angle;
use crate::estimators::{EstimatorError, MAX_ITERATIONS};

impl Device<'_> {
    /// Number of heads in `shots` runs of the circuit with reference E = `reference`.
    ///
    /// Each run makes m = `queries` queries, at least one. Heads are the outcome with all bits 0 if
    /// m is odd, and any other outcome if m is even.
    ///
    /// Without noise the probability is `sin^2(m omega)` with
    /// `sin(omega) = |a - E| / max(E, 1 - E)`, a = S/N. On a state that noise has destroyed, the
    /// index and the coin read 0 with probability 1/(2N). Misread outcomes count as destroyed.
    ///
    /// # Errors
    /// A reference that is not in [0, 1], or more queries than [`MAX_ITERATIONS`].
    ///
    /// ```
    /// use qrt_counting::estimators::{Device, Noise, CountingProblem};
    /// use qrt_counting::random::Stream;
    /// let problem = CountingProblem { good: 3, total: 8 };
    /// let mut stream = Stream::new(1, 0, 0, 0);
    /// let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
    /// // At the reference itself, nothing is left to be amplified.
    /// assert_eq!(device.shifted(0.375, 1001, 500)?, 0);
    /// assert_eq!(device.usage().queries, 500 * 1001);
    /// # Ok::<(), qrt_counting::estimators::EstimatorError>(())
    /// ```
    pub fn shifted(
        &mut self,
        reference: f64,
        queries: u64,
        shots: u64,
    ) -> Result<u64, EstimatorError> {
        if !(0.0..=1.0).contains(&reference) {
            return Err(EstimatorError::Reference(reference));
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
        Ok(crate::binomial::draw_with(shots, p, q, self.stream))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimators::{CountingProblem, Noise};
    use crate::random::Stream;

    /// State vector of the index qubits and the coin, which is the highest qubit. All gates are
    /// real.
    struct State {
        ids: u32,
        amplitudes: Vec<f64>,
    }

    impl State {
        fn zero(ids: u32) -> Self {
            let mut amplitudes = vec![0.0; 2 << ids];
            amplitudes[0] = 1.0;
            Self { ids, amplitudes }
        }

        /// Applies a gate to one qubit, given by the rows of its matrix.
        fn gate(&mut self, qubit: u32, [[a, b], [c, d]]: [[f64; 2]; 2]) {
            let bit = 1 << qubit;
            for i in 0..self.amplitudes.len() {
                if i & bit == 0 {
                    let (zero, one) = (self.amplitudes[i], self.amplitudes[i | bit]);
                    self.amplitudes[i] = a * zero + b * one;
                    self.amplitudes[i | bit] = c * zero + d * one;
                }
            }
        }

        fn hadamards(&mut self) {
            let h = std::f64::consts::FRAC_1_SQRT_2;
            (0..self.ids).for_each(|qubit| self.gate(qubit, [[h, h], [h, -h]]));
        }

        /// Applies the circuit W of the module's documentation, with the first `good` indices good.
        fn shifted(&mut self, good: usize, reference: f64) {
            let tilt = (1.0 - 2.0 * reference).abs();
            let (sine, cosine) = ((1.0 / (1.0 + tilt)).sqrt(), (tilt / (1.0 + tilt)).sqrt());
            let sign = if reference <= 0.5 { -1.0 } else { 1.0 };
            let coin = 1_usize << self.ids;
            self.hadamards();
            self.gate(self.ids, [[cosine, -sine], [sine, cosine]]);
            for (i, amplitude) in self.amplitudes.iter_mut().enumerate() {
                if i & coin == 0 {
                    *amplitude *= sign;
                } else if i & !coin < good {
                    *amplitude = -*amplitude;
                }
            }
            self.gate(self.ids, [[cosine, sine], [-sine, cosine]]);
            self.hadamards();
        }
    }

    /// Compares the state vector, gate by gate, with the closed form, for all S of up to 16
    /// indices.
    #[test]
    fn the_circuit_measures_what_is_drawn_from() {
        for ids in 0..=4 {
            let total = 1_usize << ids;
            for good in 0..=total {
                for reference in [0.0, 0.03, 0.25, 0.4999, 0.5, 0.7, 0.9375, 1.0] {
                    let omega = Angle::shifted(good as u64, total as u64, reference).unwrap();
                    let mut state = State::zero(ids);
                    for queries in 1..=9 {
                        if queries > 1 {
                            state.amplitudes[0] = -state.amplitudes[0];
                        }
                        state.shifted(good, reference);
                        let zeros = state.amplitudes[0].powi(2);
                        let norm: f64 = state.amplitudes.iter().map(|a| a * a).sum();
                        let heads = if queries % 2 == 1 {
                            zeros
                        } else {
                            norm - zeros
                        };
                        let (closed, rest) = omega.sine_squared(queries);
                        assert!(
                            (heads - closed).abs() < 1e-12 && (closed + rest - 1.0).abs() < 1e-12,
                            "{good}/{total} - {reference}, {queries}: {heads}, {closed}"
                        );
                        if queries == 1 {
                            let mean = (good as f64 / total as f64 - reference)
                                / f64::max(reference, 1.0 - reference);
                            assert!((state.amplitudes[0] + mean).abs() < 1e-14);
                        }
                    }
                }
            }
        }
    }

    /// Compares fractions of heads with their probability.
    ///
    /// With noise, that is mixed with the probability in the maximally mixed state of four index
    /// qubits and a coin.
    #[test]
    fn heads_are_drawn_with_and_without_noise() {
        let problem = CountingProblem { good: 3, total: 16 };
        let noisy = Noise {
            depolarising: 0.02,
            readout: 0.01,
        };
        for noise in [Noise::NONE, noisy] {
            let mut stream = Stream::new(8, 0, 0, 0);
            let mut device = Device::new(problem, noise, &mut stream).unwrap();
            let shots = 200_000;
            for queries in [1_i32, 2, 5, 6] {
                let heads = device.shifted(0.3, queries as u64, shots).unwrap() as f64;
                let omega = libm::asin((0.3 - 3.0 / 16.0) / 0.7);
                let ideal = libm::sin(f64::from(queries) * omega).powi(2);
                let right =
                    (1.0 - noise.depolarising).powi(queries) * (1.0 - noise.readout).powi(5);
                let any = if queries % 2 == 1 { 1.0 } else { 31.0 } / 32.0;
                let expected = right * ideal + (1.0 - right) * any;
                let deviation = (expected * (1.0 - expected) / shots as f64).sqrt();
                assert!(
                    (heads / shots as f64 - expected).abs() < 5.0 * deviation,
                    "{queries}: {heads}, {expected}"
                );
            }
            assert_eq!(device.usage().queries, shots * (1 + 2 + 5 + 6));
            assert_eq!(device.usage().depth, 6);
        }
        let mut stream = Stream::new(8, 0, 0, 0);
        let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
        assert_eq!(device.usage().queries, 0);
        for reference in [-0.1, 1.1, f64::NAN] {
            assert!(device.shifted(reference, 1, 1).is_err());
        }
        assert!(device.shifted(0.5, MAX_ITERATIONS + 1, 1).is_err());
        assert_eq!(device.usage().shots, 0);
    }
}
