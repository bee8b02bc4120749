//! Amplitudes of every qubit, ancillas included: the paper's whole figure, gate by gate.
//!
//! Four models of one experiment, quantum counting. Each uses more knowledge about the experiment
//! than the one before:
//!
//! * [`Dense`]: all `2^qubits` amplitudes, up to 26 qubits. It uses no knowledge.
//! * [`Sparse`]: the basis states that carry amplitude, for any number of qubits. An oracle
//!   permutes basis states, so that a scene's hundreds of ancillas add none.
//! * [`reduced`]: amplitudes over (phase register, index). It uses that ancillas return to zero, so
//!   that an oracle is a sign for each index.
//! * [`subspace`]: two amplitudes for each value of the phase register. It uses that all good
//!   indices have one amplitude and all others another, so that S and N suffice.
//!
//! [`crate::counting::PhaseDistribution`] is the closed form of the sums in the last model. All
//! models give the distribution of folded outcomes, `y = 0 ..= T/2`.
//!
//! [`counting_of`] runs a pixel's circuit with all its ancillas; [`count`] runs any counting
//! circuit on any machine.

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

/// A machine that computes amplitudes. Registers are lists of qubits, bit 0 first.
pub trait StateVector {
    /// Number of the machine's qubits, which are `0..qubits` and all zero at first.
    fn qubits(&self) -> u32;

    /// Executes a gate. The machine may delay the gate until a result is read.
    ///
    /// # Errors
    /// If the gate names a qubit that does not exist, or there are more states than there is memory
    /// for. The machine cannot be used afterwards.
    fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), StateVectorError>;

    /// The probabilities of a register's values, as they would be measured.
    ///
    /// # Errors
    /// If a qubit does not exist, or there are more values than can be listed.
    fn distribution(&mut self, register: &[Qubit]) -> Result<Vec<f64>, StateVectorError>;

    /// The probability that one of `qubits` is read as 1.
    ///
    /// # Errors
    /// If a qubit does not exist.
    fn excited(&mut self, qubits: &[Qubit]) -> Result<f64, StateVectorError>;

    /// Measures a register: draws a value and leaves the state as that measurement does.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn measure(&mut self, register: &[Qubit], stream: &mut Stream)
    -> Result<u64, StateVectorError>;

    /// Draws a value of a register as a measurement would, but does not change the state.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn sample(&mut self, register: &[Qubit], stream: &mut Stream) -> Result<u64, StateVectorError> {
        let outcomes = self.distribution(register)?;
        Ok(draw(&outcomes, stream)? as u64)
    }

    /// The sum of the amplitudes' squares: 1, except for rounding.
    ///
    /// # Errors
    /// As [`StateVector::gate`], for delayed gates.
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
