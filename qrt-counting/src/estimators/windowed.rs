//! `paper` and `sine`: repeated quantum counting, and the likeliest S.

use super::interval::median_steps;
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};
use crate::maximum_likelihood;
use qrt_circuit::quantum::Window;
use qrt_scene::Estimator;
use std::f64::consts::PI;

/// Repeated quantum counting, and the likeliest S: `paper` with the rectangular window, `sine`
/// with the sine window.
///
/// Interval: let y' and y'' be the lower and the upper median of the B outcomes. theta lies in
/// `[(y' - w)/T, (y'' + w)/T]` with at least the requested confidence, for every theta, T and B. w
/// follows from the exact tails of the kernel and from the binomial distribution of the number of
/// outcomes that are far off. For a single outcome of `paper`, w is 3/4 at 8/pi^2 (Brassard, Hoyer,
/// Mosca & Tapp, *Quantum amplitude amplification and estimation*, 2000, theorem 11, have 1), and
/// 4.1 at 95 %; with B = 3 it is 1.0. If the likeliest S lies outside, the interval is extended to
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowedCounting {
    /// t, of T = 2^t, in `1..=40`.
    pub phase_bits: u32,
    /// B, the runs of the circuit, in `1..=1000000`.
    pub repetitions: u32,
    /// The window of the phase register.
    pub window: Window,
    /// The confidence of the interval, in (0, 1).
    pub confidence: f64,
}

impl WindowedCounting {
    /// Creates the counting circuit of `name`, an estimator with a phase register.
    ///
    /// The estimators with one are `paper`, `sine`, `posterior-mean` and `qss`.
    ///
    /// # Errors
    /// A setting out of range.
    pub fn new(name: Estimator, settings: &Settings) -> Result<Self, EstimatorError> {
        settings.check()?;
        Ok(Self {
            phase_bits: settings.phase_bits,
            repetitions: settings.repetitions,
            window: name.register_window(settings.window),
            confidence: settings.confidence,
        })
    }

    /// Runs the circuit B times.
    pub(super) fn outcomes(&self, device: &mut Device<'_>) -> Result<Vec<u64>, EstimatorError> {
        device.phases(self.phase_bits, self.window, self.repetitions)
    }

    /// Estimates the good indices among `total` from `outcomes`.
    ///
    /// The number of outcomes need not be [`Self::repetitions`].
    ///
    /// # Errors
    ///
    /// As [`maximum_likelihood`].
    pub fn infer(&self, outcomes: &[u64], total: u64) -> Result<Estimate, EstimatorError> {
        let likeliest = maximum_likelihood(outcomes, total, self.phase_bits, self.window)?;
        let amplitude = likeliest.good as f64 / total as f64;
        let (low, high) = self.medians_interval(outcomes);
        let shots = outcomes.len() as u64;
        let depth = (1 << self.phase_bits) - 1;
        Ok(Estimate {
            amplitude,
            good: Some(likeliest.good),
            interval: (low.min(amplitude), high.max(amplitude)),
            confidence: self.confidence,
            queries: shots.saturating_mul(depth),
            shots,
            depth,
            rounds: 1,
            ln_likelihood: Some(likeliest.ln_likelihood),
            ..Estimate::UNMEASURED
        })
    }

    /// The interval from the medians of the outcomes.
    pub(super) fn medians_interval(&self, outcomes: &[u64]) -> (f64, f64) {
        let mut sorted = outcomes.to_vec();
        sorted.sort_unstable();
        let size = (1_u64 << self.phase_bits) as f64;
        let repetitions = u32::try_from(outcomes.len()).unwrap_or(u32::MAX);
        let reach = median_steps(self.window, repetitions, self.confidence);
        let lower = sorted[(sorted.len() - 1) / 2] as f64 - reach;
        let upper = sorted[sorted.len() / 2] as f64 + reach;
        let amplitude = |steps: f64| {
            let sine = libm::sin(PI * (steps.clamp(0.0, 0.5 * size) / size));
            sine * sine
        };
        (amplitude(lower), amplitude(upper))
    }
}

impl AmplitudeEstimator for WindowedCounting {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let outcomes = self.outcomes(device)?;
        self.infer(&outcomes, device.total())
    }

    /// The probability that no run measures a good index, 2^-B.
    ///
    /// A phase register that distinguishes the two eigenstates leaves the index in one of them.
    /// Half of that eigenstate's probability is on the good indices.
    fn misses(&self) -> f64 {
        libm::exp2(-f64::from(self.repetitions))
    }
}
