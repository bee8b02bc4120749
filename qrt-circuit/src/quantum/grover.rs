//! The Grover iterate.

use super::QuantumGate::{H, Phase, X};
use super::{Conjunction, PhaseOracle, QuantumGate, Turns};
use crate::Qubit;

/// `G = H O_0 H O_f`, over an oracle's qubits in superposition.
///
/// O_0 flips the phase of every basis state *except* `|0...0>`: so G rotates the plane of good and
/// bad basis states by `theta` turns, with `sin(pi theta)^2 = S/N`. With the opposite sign, that of
/// `|0...0>` alone, G is its negative. Alone that is a global phase; under a control it is a Z on
/// the control, and the count comes out as N - S.
///
/// Under a control only the phase flips are controlled: the oracle's, O_0's, and the Z that makes
/// O_0's sign right. The Hadamards and all that computes meet their inverses where the control is
/// 0.
#[derive(Clone, Debug)]
pub struct GroverIterate<'a> {
    oracle: &'a PhaseOracle,
    conjunction: Conjunction,
    ancillas: Vec<Qubit>,
}

impl<'a> GroverIterate<'a> {
    /// The iterate of an oracle, with O_0's phase flip as one gate.
    pub fn new(oracle: &'a PhaseOracle) -> Self {
        Self::with(oracle, Conjunction::Whole)
    }

    /// The iterate of an oracle, with O_0's phase flip written as `conjunction` says.
    pub fn with(oracle: &'a PhaseOracle, conjunction: Conjunction) -> Self {
        let controlled = oracle.superposed().len() as u32 + 1;
        let mut ancillas = oracle.ancillas();
        let needed = conjunction.ancillas(controlled);
        let missing = needed.saturating_sub(ancillas.len() as u32);
        ancillas.extend(oracle.qubits()..oracle.qubits() + missing);
        ancillas.truncate(needed as usize);
        Self {
            oracle,
            conjunction,
            ancillas,
        }
    }

    /// The oracle whose good basis states the iterate amplifies.
    pub fn oracle(&self) -> &'a PhaseOracle {
        self.oracle
    }

    /// All qubits but the control: `0..qubits`. Beyond the oracle's are ancillas of O_0, if the
    /// oracle's own are too few.
    pub fn qubits(&self) -> u32 {
        let last = self.ancillas.iter().max().map_or(0, |last| last + 1);
        self.oracle.qubits().max(last)
    }

    /// Gates of one iterate, with a control or without.
    pub fn gates(&self, controlled: bool) -> u64 {
        let ids = self.oracle.superposed().len() as u32;
        let sign = self.conjunction.gates(ids + u32::from(controlled));
        self.oracle.gates() + 4 * u64::from(ids) + sign + 1
    }

    /// Hands over the gates of G, under the control of a qubit that is not among its own, or under
    /// none.
    ///
    /// # Errors
    /// The sink's.
    pub fn apply<E>(
        &self,
        control: Option<Qubit>,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids = self.oracle.superposed();
        self.oracle.apply(control, sink)?;
        ids.iter().try_for_each(|id| sink(H(*id)))?;
        self.reflect(control, sink)?;
        ids.iter().try_for_each(|id| sink(H(*id)))
    }

    /// O_0: Xs around the phase flip of `|1...1>`, and a global phase of -1.
    fn reflect<E>(
        &self,
        control: Option<Qubit>,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids = self.oracle.superposed();
        let control: Vec<Qubit> = control.into_iter().collect();
        let on = [&control[..], ids].concat();
        ids.iter().try_for_each(|id| sink(X(*id)))?;
        self.conjunction.sign(&on, &self.ancillas, sink)?;
        ids.iter().try_for_each(|id| sink(X(*id)))?;
        sink(Phase {
            turns: Turns::HALF,
            on: &control,
        })
    }
}
