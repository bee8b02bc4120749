//! `abrams-williams`: the mean as an amplitude that is shifted and amplified repeatedly.

use super::clopper_pearson::clopper_pearson;
use super::coin::{Coin, intersection, most_queries};
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// The smallest number of tosses of a stage.
const FEWEST: u64 = 10;
/// A stage with failure probability f takes this number times ln(2/f) tosses. Their interval lets
/// the next stage take at least about 1.4 times the queries per toss.
const TOSSES: f64 = 1.8;
/// A stage is the last one if the remaining queries do not suffice for this number of equal stages.
const LAST: u64 = 3;
/// The largest number of stages after the classical paths.
const STAGES: u32 = 200;

/// `abrams-williams`: Grover's mean algorithm as simplified by Abrams & Williams (*Fast quantum
/// algorithms for numerical integrals and stochastic processes*, quant-ph/9908083, 1999).
///
/// The mean of f - E is the amplitude of one basis state: see [`Device::shifted`] for the circuit.
/// The first estimate comes from classical paths. Each later stage shifts f by an end of the known
/// interval, amplifies the rest of the mean as far as it stays unambiguous, and measures
/// repeatedly. The next stage starts from its finer estimate. The stages' costs form a geometric
/// series. The last stage takes all remaining queries and dominates the cost, so the error falls as
/// 1/queries.
///
/// The method amplifies the mean itself, not its square root. Unlike with Grover's iterate, the
/// error therefore does not fall with sqrt(a) for small a.
///
/// Interval: the intersection of the stages' Clopper-Pearson intervals. The last stage has half of
/// the failure probability. Of the other half, each stage has the square of its fraction of the
/// queries. An early failure causes the largest error, so it gets the smallest probability, and the
/// root mean square error also falls as 1/queries. The coverage is at least the requested
/// confidence for every S. If an error is requested, stages follow until the interval's half-width
/// is at most that error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbramsWilliams {
    settings: Settings,
}

impl AbramsWilliams {
    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            settings: *settings,
        }
    }
}

impl AmplitudeEstimator for AbramsWilliams {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let Settings {
            queries,
            confidence,
            known_noise,
            ..
        } = self.settings;
        let start = device.usage();
        let failure = 0.5 * (1.0 - confidence);
        // The squares of fractions add up to at most one, because a stage takes FEWEST tosses or
        // more.
        let failing = |each: u64| {
            let fraction = (each.saturating_mul(FEWEST) as f64 / queries as f64).min(1.0);
            failure * fraction * fraction
        };
        let tosses = |failing: f64| {
            let tosses = TOSSES * libm::log(2.0 / failing);
            (tosses.ceil() as u64).max(FEWEST)
        };
        let error = self.settings.error.unwrap_or(0.0);
        let deepest = most_queries(known_noise);
        let enough = most_for(error, failing(1), tosses(failing(1)));

        let mut left = queries;
        let first = tosses(failing(1));
        let paths = if left / LAST < first { left } else { first };
        let hits = device.paths(paths);
        left -= paths;
        let fails = if left == 0 { failure } else { failing(1) };
        let mut interval = clopper_pearson(hits, paths, fails);
        let mut amplitude = hits as f64 / paths as f64;
        for stage in 1..=STAGES {
            if left == 0 || 0.5 * (interval.1 - interval.0) <= error {
                break;
            }
            let mut coin = Coin::new(interval, deepest.min(enough));
            let mut fails = failing(coin.queries);
            let mut shots = tosses(fails);
            if coin.queries == deepest {
                shots = shots.max(coin.tosses_for(error, fails, known_noise, device.total()));
            }
            let cost = coin.queries.saturating_mul(shots);
            let last = stage == STAGES || left / LAST < cost;
            if last {
                coin = coin.with_queries(coin.queries.min(left / FEWEST).max(1));
                shots = left / coin.queries;
                fails = failure;
            }
            let found = coin.toss(device, shots, known_noise)?;
            left = if last { 0 } else { left - cost };
            interval = intersection(interval, coin.interval(&found, fails));
            amplitude = coin.estimate(&found).clamp(interval.0, interval.1);
        }
        Ok(device.estimate(start, amplitude, interval, confidence))
    }
}

/// The queries per toss at which `tosses` tosses give an interval of half-width `error`.
///
/// The interval is that of equally frequent heads and tails. More queries would give a smaller
/// error than requested.
pub(super) fn most_for(error: f64, failure: f64, tosses: u64) -> u64 {
    let (low, high) = clopper_pearson(tosses / 2, tosses, failure);
    let reach = 0.5 * (libm::asin(high.sqrt()) - libm::asin(low.sqrt()));
    // A float beyond 2^64, or infinity, becomes the largest integer.
    (reach / error).ceil() as u64
}
