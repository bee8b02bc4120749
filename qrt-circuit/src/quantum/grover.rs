//! The Grover iterate.

use super::QuantumGate::{H, Phase, X};
use super::{Conjunction, PhaseOracle, QuantumGate, Turns};
use crate::Qubit;

/// `G = H O_0 H O_f`, over an oracle's qubits in superposition.
///
/// O_0 flips the phase of every basis state *except* `|0...0>`. So G rotates the plane of good and
/// bad basis states by `theta` turns, with `sin(pi theta)^2 = S/N`. With the opposite sign, O_0
/// would flip the phase of `|0...0>` alone, and the iterate would be the negative of G. Alone that
/// is a global phase. Under a control it is a Z on the control, and the count is N - S.
///
/// Under a control only the phase flips are controlled: the oracle's, O_0's, and the Z that
/// corrects O_0's sign. Where the control is 0, the Hadamards and all computations cancel with
/// their inverses.
#[derive(Clone, Debug)]
pub struct GroverIterate<'a> {
    oracle: &'a PhaseOracle,
    conjunction: Conjunction,
    ancillas: Vec<Qubit>,
}

impl<'a> GroverIterate<'a> {
    /// Creates the iterate of an oracle, with O_0's phase flip as one gate.
    pub fn new(oracle: &'a PhaseOracle) -> Self {
        Self::with(oracle, Conjunction::Whole)
    }

    /// Creates the iterate of an oracle, with O_0's phase flip as `conjunction` specifies.
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

    /// Returns the oracle whose good basis states the iterate amplifies.
    pub fn oracle(&self) -> &'a PhaseOracle {
        self.oracle
    }

    /// Number of qubits except the control: they are `0..qubits`. Ancillas of O_0 follow the
    /// oracle's qubits, if the oracle has too few.
    pub fn qubits(&self) -> u32 {
        let last = self.ancillas.iter().max().map_or(0, |last| last + 1);
        self.oracle.qubits().max(last)
    }

    /// Number of gates of one iterate, with a control or without.
    pub fn gates(&self, controlled: bool) -> u64 {
        let ids = self.oracle.superposed().len() as u32;
        let sign = self.conjunction.gates(ids + u32::from(controlled));
        self.oracle.gates() + 4 * u64::from(ids) + sign + 1
    }

    /// Emits the gates of G, under `control`, which is not among its own qubits, or without a
    /// control.
    ///
    /// # Errors
    /// An error of `sink`.
    pub fn apply<E>(
        &self,
        control: Option<Qubit>,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.oracle.apply(control, sink)?;
        self.diffuse(control, sink)
    }

    /// Emits `H O_0 H`: the reflection `2 psi psi^T - 1` of the uniform state psi, without the oracle.
    pub(super) fn diffuse<E>(
        &self,
        control: Option<Qubit>,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids = self.oracle.superposed();
        ids.iter().try_for_each(|id| sink(H(*id)))?;
        self.reflect(control, sink)?;
        ids.iter().try_for_each(|id| sink(H(*id)))
    }

    /// Number of gates of the reflection alone.
    pub(super) fn reflection_gates(&self) -> u64 {
        self.gates(false) - self.oracle.gates()
    }

    /// Emits O_0: Xs around the phase flip of `|1...1>`, and a global phase of -1.
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
