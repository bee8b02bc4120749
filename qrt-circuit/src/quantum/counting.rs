//! The circuit of quantum counting.

use super::QuantumGate::{H, X};
use super::Window;
use super::{
    Conjunction, GroverIterate, MAX_PHASE_BITS, PhaseOracle, QuantumError, QuantumGate, fourier,
    window,
};
use crate::Qubit;

/// A part of the counting circuit, which is emitted gate by gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CircuitPart {
    /// One call of the phase oracle O_f alone.
    Oracle,
    /// One iterate G alone, its global phase included.
    Grover,
    /// The whole circuit: preparation, controlled powers of G, inverse Fourier transform.
    Counting,
}

/// The counting circuit of an oracle: phase estimation of its Grover iterate.
///
/// Its qubits are the iterate's, then the phase register's, then the sine window's bond. All are
/// zero before it. After it, all are zero again except the oracle's qubits in superposition and the
/// phase register.
#[derive(Clone, Debug)]
pub struct CountingCircuit<'a> {
    iterate: GroverIterate<'a>,
    counter: Vec<Qubit>,
    window: Window,
}

impl<'a> CountingCircuit<'a> {
    /// Creates the counting circuit with a phase register of `T = 2^phase_bits`, prepared in a
    /// window.
    ///
    /// # Errors
    /// `phase_bits` is not in `1..=40`.
    pub fn new(
        oracle: &'a PhaseOracle,
        phase_bits: u32,
        window: Window,
    ) -> Result<Self, QuantumError> {
        Self::with(oracle, phase_bits, window, Conjunction::Whole)
    }

    /// Creates the circuit of [`CountingCircuit::new`], with O_0's phase flip as `conjunction`
    /// specifies.
    ///
    /// # Errors
    /// As [`CountingCircuit::new`].
    pub fn with(
        oracle: &'a PhaseOracle,
        phase_bits: u32,
        window: Window,
        conjunction: Conjunction,
    ) -> Result<Self, QuantumError> {
        if !(1..=MAX_PHASE_BITS).contains(&phase_bits) {
            return Err(QuantumError::PhaseBitsOutOfRange(phase_bits));
        }
        let iterate = GroverIterate::with(oracle, conjunction);
        let first = iterate.qubits();
        Ok(Self {
            iterate,
            counter: (first..first + phase_bits).collect(),
            window,
        })
    }

    /// Returns the Grover iterate whose phase is estimated.
    pub fn iterate(&self) -> &GroverIterate<'a> {
        &self.iterate
    }

    /// Returns the phase register, bit 0 first.
    pub fn phase_register(&self) -> &[Qubit] {
        &self.counter
    }

    /// Number of qubits of the whole circuit: they are `0..qubits`.
    pub fn qubits(&self) -> u32 {
        let bond = u32::from(window::has_bond(self.window));
        self.iterate.qubits() + self.counter.len() as u32 + bond
    }

    /// Number of qubits of the counting circuit around an oracle of `oracle` qubits, of which `index` are
    /// in superposition, for a phase register of `phase_bits` qubits.
    pub fn qubits_around(
        oracle: u32,
        index: u32,
        phase_bits: u32,
        window: Window,
        conjunction: Conjunction,
    ) -> u32 {
        let needed = conjunction.ancillas(index + 1);
        let missing = needed.saturating_sub(oracle - index);
        oracle + missing + phase_bits + u32::from(window::has_bond(window))
    }

    /// Returns the qubits that are zero after each iterate and at the end: all except those in
    /// superposition, those that are fixed at 1, and the phase register's.
    pub fn ancillas(&self) -> Vec<Qubit> {
        let oracle = self.iterate.oracle();
        let held = [oracle.superposed(), oracle.ones(), &self.counter].concat();
        let all = 0..self.qubits();
        all.filter(|qubit| !held.contains(qubit)).collect()
    }

    /// Number of qubits that a part uses: they are `0..qubits_of`.
    pub(crate) fn qubits_of(&self, part: CircuitPart) -> u32 {
        match part {
            CircuitPart::Oracle => self.iterate.oracle().qubits(),
            CircuitPart::Grover => self.iterate.qubits(),
            CircuitPart::Counting => self.qubits(),
        }
    }

    /// Number of gates that a part emits.
    pub fn gates(&self, part: CircuitPart) -> u64 {
        let bits = self.counter.len() as u32;
        match part {
            CircuitPart::Oracle => self.iterate.oracle().gates(),
            CircuitPart::Grover => self.iterate.gates(false),
            CircuitPart::Counting => {
                let oracle = self.iterate.oracle();
                let ids = (oracle.superposed().len() + oracle.ones().len()) as u64;
                let prepare = ids + window::gates(self.window, bits);
                let powers = self.queries().saturating_mul(self.iterate.gates(true));
                powers.saturating_add(prepare + fourier::gates(bits))
            }
        }
    }

    /// Number of queries, that is, calls of the oracle: `T - 1`.
    pub fn queries(&self) -> u64 {
        (1 << self.counter.len()) - 1
    }

    /// Emits a part, gate by gate.
    ///
    /// # Errors
    /// An error of `sink`, which ends the circuit.
    pub fn part<E>(
        &self,
        part: CircuitPart,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        match part {
            CircuitPart::Oracle => self.iterate.oracle().apply(None, sink),
            CircuitPart::Grover => self.iterate.apply(None, sink),
            CircuitPart::Counting => {
                self.prepare(sink)?;
                for bit in 0..self.counter.len() as u32 {
                    for _ in 0..1_u64 << bit {
                        self.query(bit, sink)?;
                    }
                }
                self.inverse_fourier(sink)
            }
        }
    }

    /// Prepares the phase register in the window, and puts Hadamards on the oracle's qubits in
    /// superposition and Xs on those that are fixed at 1.
    ///
    /// # Errors
    /// An error of `sink`.
    pub fn prepare<E>(
        &self,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        // The window comes first: while its bond is entangled, a simulator has twice the states.
        let bond = self.iterate.qubits() + self.counter.len() as u32;
        window::prepare(self.window, &self.counter, bond, sink)?;
        let oracle = self.iterate.oracle();
        oracle.ones().iter().try_for_each(|id| sink(X(*id)))?;
        let ids = oracle.superposed();
        ids.iter().try_for_each(|id| sink(H(*id)))
    }

    /// Emits one G under the control of bit `bit` of the phase register, which controls `2^bit` of
    /// them.
    ///
    /// # Errors
    /// An error of `sink`.
    ///
    /// # Panics
    /// If the phase register has no bit `bit`.
    pub fn query<E>(
        &self,
        bit: u32,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.iterate.apply(Some(self.counter[bit as usize]), sink)
    }

    /// Emits the inverse Fourier transform of the phase register.
    ///
    /// # Errors
    /// An error of `sink`.
    pub fn inverse_fourier<E>(
        &self,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        fourier::inverse(&self.counter, sink)
    }
}
