//! What estimators refuse.

use crate::counting::CountingError;
use std::fmt;

/// Why an estimator cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EstimatorError {
    /// Counting cannot.
    Counting(CountingError),
    /// No query may be spent.
    NoQueries,
    /// The asked error is not in (0, 1).
    AskedError(f64),
    /// The asked confidence is not in (0, 1).
    Confidence(f64),
    /// A probability of noise that is not in [0, 1].
    Noise(f64),
    /// More Grover iterations between preparation and measurement than can be told apart.
    TooManyIterations(u64),
    /// A reference from which amplitudes are measured that is not in [0, 1].
    Reference(f64),
}

impl fmt::Display for EstimatorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Counting(error) => error.fmt(f),
            Self::NoQueries => write!(f, "an estimator needs at least one query"),
            Self::AskedError(error) => {
                write!(f, "an error of {error} is not between 0 and 1")
            }
            Self::Confidence(confidence) => {
                write!(f, "a confidence of {confidence} is not between 0 and 1")
            }
            Self::Noise(probability) => {
                write!(
                    f,
                    "noise with probability {probability}; a probability is in 0..=1"
                )
            }
            Self::TooManyIterations(iterations) => write!(
                f,
                "{iterations} Grover iterations before a measurement; at most {}",
                super::MAX_ITERATIONS
            ),
            Self::Reference(reference) => {
                write!(f, "a reference of {reference} is not in [0, 1]")
            }
        }
    }
}

impl std::error::Error for EstimatorError {}

impl From<CountingError> for EstimatorError {
    fn from(error: CountingError) -> Self {
        Self::Counting(error)
    }
}
