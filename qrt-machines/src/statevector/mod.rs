//! Amplitudes of every qubit, ancillas included: the paper's whole figure, gate by gate.
//!
//! Two machines:
//!
//! * [`Dense`]: all `2^qubits` amplitudes, to 26 qubits. It knows nothing.
//! * [`Sparse`]: the basis states that carry amplitude, of any number of qubits. An oracle permutes
//!   basis states, so that a scene's hundreds of ancillas add none.
//!
//! `qrt-counting` has two models that know more about the experiment, and its closed form. All give the
//! distribution of folded outcomes, `y = 0 ..= T/2`.
//!
//! [`counting_of`] runs a phase oracle's counting circuit on the sparse machine, with all its ancillas;
//! [`count`] runs a counting circuit on any machine.

mod count;
mod dense;
mod error;
mod sparse;
#[cfg(test)]
mod tests;

pub use count::{Checks, CountingRun, RunResources, count, counting_of, counting_until, fold};
pub use dense::Dense;
pub use error::{StateVectorError, filled};
pub use sparse::Sparse;

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

    /// Measures a register: `uniform`, a random number in `0.0..1.0`, decides the value, and the state is left as
    /// that measurement does.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn measure(&mut self, register: &[Qubit], uniform: f64) -> Result<u64, StateVectorError>;

    /// The value of a register that a measurement with `uniform` would read. The state stays as it is.
    ///
    /// # Errors
    /// As [`StateVector::distribution`].
    fn sample(&mut self, register: &[Qubit], uniform: f64) -> Result<u64, StateVectorError> {
        let outcomes = self.distribution(register)?;
        Ok(draw(&outcomes, uniform)? as u64)
    }

    /// The sum of the amplitudes' squares: 1, except for rounding.
    ///
    /// # Errors
    /// As [`StateVector::gate`], for delayed gates.
    fn norm(&mut self) -> Result<f64, StateVectorError>;
}

/// The outcome that `uniform` in `0.0..1.0` selects; never one of probability 0.
fn draw(probabilities: &[f64], uniform: f64) -> Result<usize, StateVectorError> {
    let mut left = uniform * probabilities.iter().sum::<f64>();
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
