//! `monte-carlo`: classical sampling.

use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};
use crate::binomial;

/// `monte-carlo`: the fraction of good indices among `queries` drawn at random, with replacement.
///
/// Interval: all a whose Kullback-Leibler divergence from the fraction is at most
/// `ln(2/(1 - confidence))/n` (Chernoff's bound, with half of the failure probability on either
/// side). It is valid for every n and a. If an error is requested, n is the smallest number that
/// Hoeffding's inequality allows, `ln(2/(1 - confidence)) / (2 error^2)`, or `queries` if that is
/// smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonteCarlo {
    /// Number of indices that are drawn, at least 1.
    queries: u64,
    confidence: f64,
}

impl MonteCarlo {
    pub(super) fn new(settings: &Settings) -> Self {
        let enough = settings.error.map_or(f64::INFINITY, |error| {
            libm::log(2.0 / (1.0 - settings.confidence)) / (2.0 * error * error)
        });
        Self {
            // A float beyond 2^64 becomes the largest integer.
            queries: settings.queries.min(enough.ceil() as u64).max(1),
            confidence: settings.confidence,
        }
    }
}

impl AmplitudeEstimator for MonteCarlo {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let hits = device.paths(self.queries);
        let shots = self.queries as f64;
        let amplitude = hits as f64 / shots;
        let interval = chernoff_interval(hits, self.queries, 1.0 - self.confidence);
        Ok(device.estimate(start, amplitude, interval, self.confidence))
    }
}

/// The range of a that Chernoff's bound does not exclude after `hits` of `shots`.
///
/// `failure` is the failure probability of both sides together.
pub(super) fn chernoff_interval(hits: u64, shots: u64, failure: f64) -> (f64, f64) {
    let n = shots as f64;
    let fraction = hits as f64 / n;
    let missed = (shots - hits) as f64 / n;
    let reach = libm::log(2.0 / failure) / n;
    let low = (fraction - chernoff(missed, reach)).max(0.0);
    let high = (fraction + chernoff(fraction, reach)).min(1.0);
    (low, high)
}

/// The distance from `fraction` to the largest a at or above it with `KL(fraction, a) <= reach`.
///
/// By Chernoff's bound a fraction this low or lower has probability at most exp(-n reach) under
/// any larger a.
fn chernoff(fraction: f64, reach: f64) -> f64 {
    let rest = 1.0 - fraction;
    let (mut low, mut high) = (0.0, rest);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let divergence = binomial::deviance(fraction, -middle) + binomial::deviance(rest, middle);
        if divergence <= reach {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
