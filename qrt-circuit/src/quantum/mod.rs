//! The counting circuit, gate by gate: the paper's whole figure.
//!
//! An oracle of [`super::lower`] permutes basis states and flips one phase. Quantum counting adds
//! Hadamards, phases and rotations around it. A [`QuantumGate`] is a gate of either kind.
//!
//! * [`PhaseOracle`]: O_f, an oracle that flips the phase of good basis states, as gates;
//! * [`GroverIterate`]: `G = H O_0 H O_f`, alone or under a control;
//! * [`CountingCircuit`]: Hadamards on the qubits in superposition, the phase register's window,
//!   controlled powers of G and the inverse Fourier transform;
//! * [`MeanPhaseCircuit`]: the circuit whose phase is a pixel's mean, by [`LevelPhases`];
//! * [`LogicalCounts`]: the input that estimators of physical resources take from circuits.
//!
//! Circuits are emitted gate by gate and never held: the controlled powers of G repeat the oracle
//! `T - 1` times. A *sink* is a closure that receives each gate and may refuse it, which ends the
//! circuit:
//!
//! ```
//! use qrt_circuit::quantum::{CountingCircuit, CircuitPart, PhaseOracle, QuantumGate, Window};
//! use std::convert::Infallible;
//!
//! // 3 of 8 basis states are good; the phase is read to 4 bits.
//! let oracle = PhaseOracle::table(3, |id| id > 4)?;
//! let counting = CountingCircuit::new(&oracle, 4, Window::Rect)?;
//! let mut hadamards = 0;
//! counting.part(CircuitPart::Counting, &mut |gate| {
//!     hadamards += u32::from(matches!(gate, QuantumGate::H(_)));
//!     Ok::<(), Infallible>(())
//! })?;
//! // 3 + 4 at the beginning, 2 * 3 for each of 15 queries, 4 in the Fourier transform.
//! assert_eq!(hadamards, 7 + 15 * 6 + 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Bit order.** Bit 0 of every register is its least significant. Qubit j of the phase register
//! controls `G^(2^j)`. At the end the phase register reads `y`, and `theta~ = y/T` or `1 - y/T`.
//!
//! **Phases** are in turns: `Phase` multiplies by `exp(2 pi i turns)`.

mod conjunction;
mod counting;
mod error;
mod fourier;
mod gate;
mod grover;
mod level_phases;
mod logical;
mod mean_phase;
mod oracle;
#[cfg(test)]
mod tests;
mod window;

pub use conjunction::Conjunction;
pub use counting::{CircuitPart, CountingCircuit};
pub use error::QuantumError;
pub use gate::{QuantumGate, Turns};
pub use grover::GroverIterate;
pub use level_phases::LevelPhases;
pub use logical::LogicalCounts;
pub use mean_phase::MeanPhaseCircuit;
pub use oracle::{Flip, PhaseOracle};
pub use window::Window;

/// The most bits of a level's number of thresholds, of which a table looks the phase up.
pub const MAX_LEVEL_BITS: u32 = 12;

/// The most qubits that a phase register may have.
pub const MAX_PHASE_BITS: u32 = 40;
