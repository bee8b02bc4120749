//! `abrams-williams`: the mean as an amplitude, shifted and amplified again and again.

use super::clopper_pearson::clopper_pearson;
use super::coin::{Coin, intersection, most_queries};
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// The fewest tosses of a stage.
const FEWEST: u64 = 10;
/// Tosses of a stage in which the probability f may fail: this times ln(2/f). What they exclude
/// lets the next stage take at least some 1.4 times the queries a toss.
const TOSSES: f64 = 1.8;
/// A stage is the last one if the queries do not suffice for this many like it.
const LAST: u64 = 3;
/// A stage after which queries are left is followed by no more than this many.
const STAGES: u32 = 200;

/// `abrams-williams`: Grover's mean algorithm as simplified by Abrams & Williams (*Fast quantum
/// algorithms for numerical integrals and stochastic processes*, quant-ph/9908083, 1999).
///
/// The amplitude of one basis state is the mean of f - E: see [`Device::shifted`], the circuit. A
/// first estimate comes of classical paths. Each stage then shifts f by an end of the interval that
/// is known, amplifies what is left of the mean as far as it stays unambiguous, and measures some
/// times; the estimate, so many times finer, is the next stage's. The stages' costs are a geometric
/// series, and the last, which takes all queries that are left, dominates them: the error falls as
/// 1/queries.
///
/// The mean is magnified, and not its square root: unlike with Grover's iterate, the error does not
/// fall with sqrt(a) for small a.
///
/// Interval: the stages' Clopper-Pearson intervals, intersected. Half of the failure probability is
/// the last one's, and of the other half a stage has the square of its fraction of the queries:
/// what fails early errs most, and is made least probable, so that the root mean square error falls
/// as 1/queries, too. The coverage is at least the asked confidence, whatever S is. With an error,
/// stages go on until its half-width is at most that.
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
        // The squares of fractions add up to one at most: stages take FEWEST tosses or more.
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

/// The queries a toss with which `tosses` have an interval of half-width `error` wherever heads and
/// tails are as frequent; more would be finer than asked.
pub(super) fn most_for(error: f64, failure: f64, tosses: u64) -> u64 {
    let (low, high) = clopper_pearson(tosses / 2, tosses, failure);
    let reach = 0.5 * (libm::asin(high.sqrt()) - libm::asin(low.sqrt()));
    // A float beyond 2^64, or infinity, becomes the largest integer.
    (reach / error).ceil() as u64
}
