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

mod fourier;
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
    /// A truth table whose number of entries is not a power of two.
    #[error("a truth table of {0} entries, not a power of two")]
    TableSize(usize),
    /// A phase register with too many amplitudes to compute.
    #[error("amplitudes of a phase register of {bits} bits; at most {most}")]
    PhaseBits {
        /// The phase register's qubits.
        bits: u32,
        /// The most qubits of a phase register that is computed.
        most: u32,
    },
    /// There is too little memory for the amplitudes.
    #[error(transparent)]
    StateVector(#[from] StateVectorError),
}
