//! Quantum counting's circuit.

use super::QuantumGate::{H, X};
use super::Window;
use super::{
    Conjunction, GroverIterate, MAX_PHASE_BITS, PhaseOracle, QuantumError, QuantumGate, fourier,
    window,
};
use crate::Qubit;

/// Which part of the counting circuit is handed over, gate by gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// One call of the phase oracle O_f alone.
    Oracle,
    /// One iterate G alone, its global phase included.
    Grover,
    /// All of it: preparation, controlled powers of G, inverse Fourier transform.
    Counting,
}

/// The counting circuit of an oracle: phase estimation of its Grover iterate.
///
/// Its qubits are the iterate's, then the phase register's, then the sine window's bond. All are
/// zero before; after it all but the oracle's qubits in superposition and the phase register are
/// zero again.
#[derive(Clone, Debug)]
pub struct Counting<'a> {
    iterate: GroverIterate<'a>,
    counter: Vec<Qubit>,
    window: Window,
}

impl<'a> Counting<'a> {
    /// Counting with a register of `T = 2^phase_bits`, prepared in a window.
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

    /// As [`Counting::new`], with O_0's phase flip written as `conjunction` says.
    ///
    /// # Errors
    /// As [`Counting::new`].
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

    /// The Grover iterate whose phase is estimated.
    pub fn iterate(&self) -> &GroverIterate<'a> {
        &self.iterate
    }

    /// The phase register, bit 0 first.
    pub fn phase_register(&self) -> &[Qubit] {
        &self.counter
    }

    /// How many qubits the whole circuit has: they are `0..qubits`.
    pub fn qubits(&self) -> u32 {
        let bond = u32::from(window::has_bond(self.window));
        self.iterate.qubits() + self.counter.len() as u32 + bond
    }

    /// The qubits that are zero after each iterate and at the end: all but those in superposition,
    /// those that are fixed at 1, and the phase register's.
    pub fn ancillas(&self) -> Vec<Qubit> {
        let oracle = self.iterate.oracle();
        let held = [oracle.superposed(), oracle.ones(), &self.counter].concat();
        let all = 0..self.qubits();
        all.filter(|qubit| !held.contains(qubit)).collect()
    }

    /// How many qubits a part uses: they are `0..qubits_of`.
    pub fn qubits_of(&self, part: Part) -> u32 {
        match part {
            Part::Oracle => self.iterate.oracle().qubits(),
            Part::Grover => self.iterate.qubits(),
            Part::Counting => self.qubits(),
        }
    }

    /// How many gates of a part are handed over.
    pub fn gates(&self, part: Part) -> u64 {
        let bits = self.counter.len() as u32;
        match part {
            Part::Oracle => self.iterate.oracle().gates(),
            Part::Grover => self.iterate.gates(false),
            Part::Counting => {
                let oracle = self.iterate.oracle();
                let ids = (oracle.superposed().len() + oracle.ones().len()) as u64;
                let prepare = ids + window::gates(self.window, bits);
                let powers = self.queries().saturating_mul(self.iterate.gates(true));
                powers.saturating_add(prepare + fourier::gates(bits))
            }
        }
    }

    /// Queries: calls of the oracle, `T - 1`.
    pub fn queries(&self) -> u64 {
        (1 << self.counter.len()) - 1
    }

    /// Hands over a part, gate by gate.
    ///
    /// # Errors
    /// The sink's, which ends it.
    pub fn part<E>(
        &self,
        part: Part,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        match part {
            Part::Oracle => self.iterate.oracle().apply(None, sink),
            Part::Grover => self.iterate.apply(None, sink),
            Part::Counting => {
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
    /// The sink's.
    pub fn prepare<E>(
        &self,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        // The window first: while its bond is entangled, a simulator has twice the states.
        let bond = self.iterate.qubits() + self.counter.len() as u32;
        window::prepare(self.window, &self.counter, bond, sink)?;
        let oracle = self.iterate.oracle();
        oracle.ones().iter().try_for_each(|id| sink(X(*id)))?;
        let ids = oracle.superposed();
        ids.iter().try_for_each(|id| sink(H(*id)))
    }

    /// One G under the control of bit `bit` of the phase register, which controls `2^bit` of them.
    ///
    /// # Errors
    /// The sink's.
    ///
    /// # Panics
    /// If the register has no such bit.
    pub fn query<E>(
        &self,
        bit: u32,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.iterate.apply(Some(self.counter[bit as usize]), sink)
    }

    /// The inverse Fourier transform of the phase register.
    ///
    /// # Errors
    /// The sink's.
    pub fn inverse_fourier<E>(
        &self,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        fourier::inverse(&self.counter, sink)
    }
}
