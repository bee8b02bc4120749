//! Quantum counting: the number of good indices of an oracle, as the paper's circuit measures it.
//!
//! The Grover operator acts in the plane of the good and the bad indices, where it rotates by
//! `theta` turns, `theta = asin(sqrt(S/N))/pi`. The distribution of its phase estimation depends
//! only on S, N and the phase register. This crate draws from that distribution exactly, without a
//! state vector, for registers of up to 40 bits.
//!
//! * [`PhaseDistribution`]: `P(theta~ | theta)`, rectangular and sine window, and draws from it;
//! * [`maximum_likelihood`]: the paper's inference, over every S in `0 ..= N`;
//! * [`posterior_mean`]: the posterior mean for the same outcomes, and its interval;
//! * [`LookupTable`]: the same distribution inverted, from an outcome to S;
//! * [`Comparators`]: from colours to good indices, and from amplitudes to pixels;
//! * [`Histogram`]: the levels of a pixel's paths, from whose mean phase the pixel can be estimated;
//! * [`Stratum`]: ranges of thresholds, each of which is counted on its own;
//! * [`amplitudes`]: the same distribution by models that know less;
//! * [`estimators`]: ways of estimating an amplitude, on a device that answers their measurements;
//! * [`random`]: random numbers that a seed, a pixel and a channel determine.

#![forbid(unsafe_code)]

pub mod amplitudes;
mod angle;
mod binomial;
mod comparator;
mod distribution;
mod double;
mod draw;
mod elementary;
mod error;
pub mod estimators;
mod histogram;
mod kernel;
mod likelihood;
mod lookup;
mod mean_signal;
mod measured;
mod phase;
mod posterior;
pub mod random;
mod strata;
#[cfg(test)]
mod tests;
mod vectorized;

pub(crate) use angle::Angle;
pub use comparator::{Comparators, MAX_COMPARATOR_BITS};
pub use distribution::PhaseDistribution;
pub(crate) use distribution::check_counts;
pub(crate) use double::Double;
pub use draw::Sampler;
pub use error::{CountingError, MAX_PHASE_BITS, MAX_REPETITIONS};
pub use histogram::{Histogram, LevelCounts};
pub use likelihood::{MaximumLikelihood, ln_likelihood, maximum_likelihood, posterior};
pub use lookup::{Column, LookupTable};
pub use mean_signal::mean_phase_probabilities;
pub(crate) use measured::good_id;
pub use posterior::{Posterior, posterior_mean};
pub use strata::{Octaves, Stratum};
