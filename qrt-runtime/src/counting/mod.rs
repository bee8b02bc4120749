//! Quantum counting: how many indices the oracle calls good, as the paper's counting circuit would
//! find out.
//!
//! After the oracle, the Grover operator lives in the plane of the good and the bad indices, where
//! it turns by `theta` turns, `theta = asin(sqrt(S/N))/pi`. Everything that its phase estimation
//! can measure follows from S, N and the phase register alone: this module draws from that
//! distribution exactly, without a state vector, for registers of up to 40 bits.
//!
//! * [`PhaseDistribution`]: `P(theta~ | theta)`, rectangular and sine window, and draws from it;
//! * [`maximum_likelihood`]: the paper's inference, over every S in `0 ..= N`;
//! * [`posterior_mean`]: the mean of the same data's posterior, and its interval;
//! * [`LookupTable`]: that distribution the other way round, from an outcome to S;
//! * [`Comparators`]: from colours to good indices, and from amplitudes to pixels;
//! * [`Stratum`]: ranges of thresholds that are counted one by one.

mod angle;
pub(crate) mod binomial;
mod comparator;
mod distribution;
mod double;
mod draw;
mod error;
mod kernel;
mod likelihood;
mod lookup;
mod measured;
mod posterior;
mod strata;
#[cfg(test)]
pub(crate) mod tests;

pub(crate) use angle::Angle;
pub use comparator::{Comparators, MAX_COMPARATOR_BITS};
pub use distribution::PhaseDistribution;
pub(crate) use distribution::check_counts;
pub(crate) use double::Double;
pub use draw::Sampler;
pub use error::{CountingError, MAX_PHASE_BITS, MAX_REPETITIONS};
pub use likelihood::{MaximumLikelihood, ln_likelihood, maximum_likelihood, posterior};
pub use lookup::{Column, LookupTable};
pub(crate) use measured::good_id;
pub use posterior::{Posterior, posterior_mean};
pub use strata::{Octaves, Stratum};
