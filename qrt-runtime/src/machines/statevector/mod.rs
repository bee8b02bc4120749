//! Amplitudes of every qubit, ancillas included: the paper's whole figure, gate by gate.
//!
//! Four models of one experiment, quantum counting, each of which knows more about it than the one
//! before:
//!
//! * [`Dense`]: all `2^qubits` amplitudes, to 26 qubits. It knows nothing.
//! * [`Sparse`]: the basis states that carry amplitude, of any number of qubits. An oracle permutes
//!   basis states, so that a scene's hundreds of ancillas add none.
//! * [`reduced`]: amplitudes over (phase register, index). It knows that ancillas return to zero,
//!   so that an oracle is a sign for each index.
//! * [`subspace`]: two amplitudes for each value of the phase register. It knows that all good
//!   indices have one amplitude, and all others one, so that S and N suffice.
//!
//! [`crate::counting::PhaseDistribution`] is the closed form that the last sums up to. All give the
//! distribution of folded outcomes, `y = 0 ..= T/2`.
//!
//! [`counting_of`] runs a pixel's circuit with all its ancillas; [`count`] does so on a machine and
//! a circuit of one's own.

mod count;
mod dense;
mod error;
mod fourier;
mod reduced;
mod sparse;
mod subspace;
#[cfg(test)]
mod tests;

pub use count::{Checks, Counted, Report, count, counting_of, fold};
pub use dense::Dense;
pub use error::StateVectorError;
pub use reduced::reduced;
pub use sparse::Sparse;
pub use subspace::subspace;

use crate::random::Stream;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::QuantumGate;

/// A machine that follows amplitudes. Registers are lists of qubits, bit 0 first.
pub trait StateVector {
    /// Its qubits: `0..qubits`, all zero at first.
    fn qubits(&self) -> u32;

    /// Executes a gate. It may wait until someone looks.
    ///
    /// # Errors
    /// A qubit that is none, or more states than there is memory for; the machine is then of no
    /// further use.
    fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), StateVectorError>;

    /// The probabilities of a register's values, as they would be measured.
    ///
    /// # Errors
    /// A qubit that is none, or more values than can be listed.
    fn distribution(&mut self, register: &[Qubit]) -> Result<Vec<f64>, StateVectorError>;

    /// The probability that one of these qubits is read as 1.
    ///
    /// # Errors
    /// A qubit that is none.
    fn excited(&mut self, qubits: &[Qubit]) -> Result<f64, StateVectorError>;

    /// Measures a register: draws a value and leaves the state as that measurement does.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn measure(&mut self, register: &[Qubit], stream: &mut Stream)
    -> Result<u64, StateVectorError>;

    /// Draws a value of a register as a measurement would, and leaves the state as it is.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn sample(&mut self, register: &[Qubit], stream: &mut Stream) -> Result<u64, StateVectorError> {
        let outcomes = self.distribution(register)?;
        Ok(draw(&outcomes, stream)? as u64)
    }

    /// The sum of the amplitudes' squares: 1, but for rounding.
    ///
    /// # Errors
    /// As [`StateVector::gate`], of gates that waited.
    fn norm(&mut self) -> Result<f64, StateVectorError>;
}

/// Draws from a list of probabilities; never an outcome of probability 0.
fn draw(probabilities: &[f64], stream: &mut Stream) -> Result<usize, StateVectorError> {
    let mut left = stream.uniform() * probabilities.iter().sum::<f64>();
    let mut last = None;
    for (outcome, &probability) in probabilities.iter().enumerate() {
        if probability > 0.0 {
            last = Some(outcome);
            if left < probability {
                break;
            }
            left -= probability;
        }
    }
    last.ok_or(StateVectorError::NoStates)
}
