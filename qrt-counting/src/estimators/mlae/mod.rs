//! `mlae`: maximum likelihood amplitude estimation.

mod likelihood;
mod schedule;
mod search;
#[cfg(test)]
mod tests;

use super::clopper_pearson::clopper_pearson;
use super::id_bits;
use super::normal::normal_quantile;
use super::turns::amplitude;
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Noise, Settings};
use likelihood::{Level, Likelihood};
use schedule::Schedule;
use search::{Found, search};

/// `mlae`: maximum likelihood amplitude estimation (Suzuki, Uno, Raymond, Tanaka, Onodera &
/// Yamamoto, *Amplitude estimation without phase estimation*, 2020).
///
/// The estimator takes shots after 0, 1, 2, 4, ... Grover iterations, the exponential schedule. Its
/// estimate is the angle under which all measurements are likeliest. [`Mlae::SHOTS`] gives the
/// number of shots at each query depth. The queries that remain after the doubling make one last
/// query depth.
///
/// Interval: from the first to the last angle whose ln likelihood is at most [`Mlae::REACH`] times
/// half the square of the normal quantile below the largest ([`Estimate::candidates`] is the number
/// of ranges that these angles form). The chi-square distribution of the ratio (Wilks) is an
/// asymptotic statement, and here shots are few. The factor is therefore measured: at a confidence
/// of 95 %, the coverage is 95 to 97 %. If the queries suffice for paths alone, it is Clopper &
/// Pearson's interval.
///
/// If an error is requested, query depths go only as deep as needed on average, and deeper while
/// the interval is too wide.
///
/// Known noise enters the likelihood and the schedule. Query depths are limited to the one at which
/// a query is most informative about theta, `1/(2 d)` for a depolarising probability d. The number
/// of shots is divided by the square of the fraction of shots that stay intact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mlae {
    queries: u64,
    error: Option<f64>,
    confidence: f64,
    noise: Noise,
}

impl Mlae {
    /// Number of shots at the deepest level. With few shots two angles may stay equally likely, and
    /// later levels do not correct a wrong choice.
    pub const SHOTS: u64 = 12;
    /// Number of shots that each shallower level has in addition. They cost little. They make the
    /// probability of a wrong choice fall as fast as its error grows, without which the root mean
    /// square error would not fall with the queries (Higgins et al., *Demonstrating
    /// Heisenberg-limited unambiguous phase estimation without adaptive measurements*, 2009).
    pub(crate) const MORE_SHOTS: u64 = 3;
    /// Factor on the asymptotic likelihood ratio.
    pub const REACH: f64 = 1.2;
    /// Queries times the interval's half-width, for a around 1/2.
    const COST: f64 = 3.6;

    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            queries: settings.queries,
            error: settings.error,
            confidence: settings.confidence,
            noise: settings.known_noise,
        }
    }

    /// The likeliest angle and its range for `likelihood`, and the interval of S/N.
    fn found(&self, likelihood: &Likelihood) -> (Found, (f64, f64)) {
        let z = normal_quantile(0.5 * (1.0 - self.confidence));
        let found = search(likelihood, Self::REACH * 0.5 * z * z);
        let interval = match likelihood.paths() {
            Some((hits, shots)) => clopper_pearson(hits, shots, 1.0 - self.confidence),
            None => (amplitude(found.low), amplitude(found.high)),
        };
        (found, interval)
    }

    /// Measures level by level.
    fn measured(&self, device: &mut Device<'_>) -> Result<Likelihood, EstimatorError> {
        let start = device.usage().queries;
        let schedule = Schedule::new(self.noise, id_bits(device.total()));
        let enough = self.error.map_or(f64::INFINITY, |error| Self::COST / error);
        let mut planned = schedule
            .levels(self.queries.min(enough.ceil() as u64))
            .into_iter();
        let mut likelihood = Likelihood::default();
        let mut deepest = 0;
        loop {
            let spent = device.usage().queries - start;
            let next = planned.next().or_else(|| {
                self.error?;
                schedule.beyond(deepest, spent, self.queries - spent)
            });
            let Some((iterations, shots)) = next else {
                break;
            };
            deepest = iterations.max(deepest);
            likelihood.add(Level {
                multiple: 2 * iterations + 1,
                hits: device.iterated(iterations, shots)?,
                shots,
                intact: schedule.intact(iterations),
            });
            let is_enough = |error| {
                let (_, (low, high)) = self.found(&likelihood);
                0.5 * (high - low) <= error
            };
            if self.error.is_some_and(is_enough) {
                break;
            }
        }
        Ok(likelihood)
    }
}

impl AmplitudeEstimator for Mlae {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let likelihood = self.measured(device)?;
        let (found, interval) = self.found(&likelihood);
        Ok(Estimate {
            ln_likelihood: Some(likelihood.ln_probability(found.angle)),
            candidates: Some(found.ranges),
            ..device.estimate(start, amplitude(found.angle), interval, self.confidence)
        })
    }
}
