//! Bayesian estimators.
//!
//! Query depths and intervals follow from a prior that is uniform over S in `0 ..= N`, that is, in
//! the amplitude. Points hold the posterior of theta = asin(sqrt(S/N))/pi, from coarse to fine
//! around every mode. If few S are left, these are the points. The estimate is the mean under
//! another prior, whose bias is small: see [`unbiased`].
//!
//! * [`AdaptiveBayes`] chooses every query depth from the posterior;
//! * [`RandomDepth`] draws its query depths at random;
//! * [`PhaseMean`] goes on with the mean-phase circuit, whose phase is the mean itself.

mod adaptive;
mod depth;
mod mean;
mod phase_mean;
mod posterior;
mod random_depth;
mod run;
mod support;
#[cfg(test)]
mod tests;
mod unbiased;
#[cfg(test)]
mod unbiased_tests;
mod ways;

pub use adaptive::AdaptiveBayes;
pub use phase_mean::PhaseMean;
pub use random_depth::RandomDepth;

use crate::estimators::{EstimatorError, Noise, Settings};
use posterior::Posterior;

/// The device's known noise, and the criteria for the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Goal {
    queries: u64,
    error: Option<f64>,
    confidence: f64,
    /// The ways to count that the run may take.
    allowed: ways::Allowed,
    noise: Noise,
}

/// Queries times standard deviation of an amplitude a, over `sqrt(a (1 - a))`; measured.
const FAR: f64 = 2.2;
/// The probability of all other S at which one S is known.
const DOUBT: f64 = 1e-12;

impl Goal {
    fn from_settings(settings: &Settings) -> Result<Self, EstimatorError> {
        settings.check()?;
        Ok(Self {
            queries: settings.queries,
            error: settings.error,
            confidence: settings.confidence,
            allowed: ways::Allowed::from_settings(settings),
            noise: settings.known_noise,
        })
    }

    /// True if S is known.
    fn is_known(posterior: &Posterior) -> bool {
        let likeliest = posterior.likeliest();
        likeliest.is_some_and(|(_, probability)| probability > 1.0 - DOUBT)
    }

    /// True if S is known, or if the interval is as narrow as the requested error.
    fn is_reached(&self, posterior: &Posterior) -> bool {
        if Self::is_known(posterior) {
            return true;
        }
        // If the posterior is far wider than the requested error, the interval is not computed.
        self.error.is_some_and(|error| {
            posterior.could_reach(error) && {
                let (low, high) = posterior.interval(self.confidence);
                high - low <= 2.0 * error
            }
        })
    }
}
