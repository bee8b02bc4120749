//! Errors of estimators: settings and problems that they refuse.

use super::MAX_ITERATIONS;
use crate::counting::CountingError;
use qrt_core::scene::Estimator;

/// Why an estimator cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// Quantum counting cannot be done as asked.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The settings allow no query.
    #[error("an estimator needs at least one query")]
    NoQueries,
    /// The asked error is not in (0, 1).
    #[error("an error of {0} is not between 0 and 1")]
    AskedError(f64),
    /// The asked confidence is not in (0, 1).
    #[error("a confidence of {0} is not between 0 and 1")]
    Confidence(f64),
    /// A probability of noise that is not in [0, 1].
    #[error("noise with probability {0}; a probability is in 0..=1")]
    Noise(f64),
    /// More Grover iterations between preparation and measurement than can be told apart.
    #[error("{0} Grover iterations before a measurement; at most {MAX_ITERATIONS}")]
    TooManyIterations(u64),
    /// An estimator of one's own cannot do what is asked, and says why.
    #[error("{0}")]
    Own(&'static str),
    /// A reference from which amplitudes are measured that is not in [0, 1].
    #[error("a reference of {0} is not in [0, 1]")]
    Reference(f64),
    /// Strata of the comparator, with an estimator that counts the whole at once.
    #[error(
        "{strata} strata, and the estimator `{estimator}` counts the whole comparator at once: choose \
         `adaptive-bayes` or `random-depth`, or `counting.strata=1`"
    )]
    Strata {
        /// The estimator.
        estimator: Estimator,
        /// How many strata were asked for.
        strata: u32,
    },
    /// A stratum, on a device that was not told how good indices are spread over the comparator, or
    /// that has no such stratum.
    #[error("this device cannot count strata of its comparator one by one")]
    NotByStrata,
}
