//! Amplitudes of counting, by what is known of the oracle.
//!
//! Models of one experiment, quantum counting. Each knows more about it than the one before:
//!
//! * [`qrt_machines::statevector`]: amplitudes of every qubit, gate by gate;
//! * [`reduced`]: amplitudes over (phase register, index). It knows that ancillas return to zero,
//!   so that an oracle is a sign for each index;
//! * [`subspace`]: two amplitudes for each value of the phase register. It knows that all good
//!   indices have one amplitude, and all others one, so that S and N suffice;
//! * [`crate::PhaseDistribution`]: the closed form that the last sums up to.
//!
//! All give the distribution of folded outcomes, `y = 0 ..= T/2`.

mod reduced;
mod subspace;
#[cfg(test)]
mod tests;

pub use reduced::reduced;
pub use subspace::subspace;

use crate::CountingError;
use qrt_machines::statevector::StateVectorError;

/// Why the amplitudes of a counting circuit cannot be followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AmplitudesError {
    /// S and N are no counts.
    #[error(transparent)]
    Counts(#[from] CountingError),
    /// A truth table or a phase register of a size that the model does not take, or too little memory.
    #[error(transparent)]
    StateVector(#[from] StateVectorError),
}
