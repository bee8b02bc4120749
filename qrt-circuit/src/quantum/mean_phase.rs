//! The mean-phase circuit, whose phase is the mean of the paths' colours minus a reference.

use super::QuantumGate::{Cx, H, Phase};
use super::{
    Conjunction, GroverIterate, LevelPhases, PhaseOracle, QuantumError, QuantumGate, Turns,
};
use crate::Qubit;

/// The mean-phase circuit of a pixel: `U^k` on the paths' uniform state, its phases under the sign of
/// a qubit.
///
/// With `R = 2 psi psi^T - 1` on the paths' uniform state `psi` and `D = diag(exp(i phi))`, phi the
/// phases of the paths' levels, the iterate is
///
/// ```text
/// U = D^(1/2) R D^(1/2).
/// ```
///
/// The *sign* qubit is in superposition. Where it is 1, all phases are negative, and the circuit
/// applies the inverse of U instead. k iterates take k - 1 calls with whole phases and two with half
/// ones: [`MeanPhaseCircuit::queries`].
///
/// Its oracle looks a level's phase up and flips the sign of each bit of that phase, bit 0 first. The
/// circuit turns the bit's phase in place of the sign.
///
/// Its qubits are the oracle's and O_0's ancillas, then the sign qubit. All are zero before it. After
/// it, all are zero again except the oracle's qubits in superposition, which hold the index of a path,
/// and the sign qubit.
#[derive(Clone, Debug)]
pub struct MeanPhaseCircuit<'a> {
    iterate: GroverIterate<'a>,
    bits: u32,
    iterations: u64,
    basis: Turns,
}

impl<'a> MeanPhaseCircuit<'a> {
    /// Creates the circuit of `iterations` iterates, measured at the angle `basis`.
    ///
    /// `oracle` flips the sign of each bit of a phase of `phases`.
    ///
    /// # Errors
    /// The oracle flips another number of signs than a phase has bits, or one of several qubits, or it
    /// has fixed qubits.
    pub fn new(
        oracle: &'a PhaseOracle,
        phases: LevelPhases,
        iterations: u64,
        basis: Turns,
    ) -> Result<Self, QuantumError> {
        Self::with(oracle, phases, (iterations, basis), Conjunction::Whole)
    }

    /// Creates the circuit of [`MeanPhaseCircuit::new`], with the phase flip of O_0 as `conjunction`
    /// specifies.
    ///
    /// # Errors
    /// As [`MeanPhaseCircuit::new`].
    pub fn with(
        oracle: &'a PhaseOracle,
        phases: LevelPhases,
        (iterations, basis): (u64, Turns),
        conjunction: Conjunction,
    ) -> Result<Self, QuantumError> {
        if oracle.signs() != u64::from(phases.bits()) || !oracle.flips_single_qubits() {
            return Err(QuantumError::PhaseSigns {
                signs: oracle.signs(),
                bits: phases.bits(),
            });
        }
        Ok(Self {
            iterate: GroverIterate::with(oracle, conjunction),
            bits: phases.bits(),
            iterations,
            basis,
        })
    }

    /// Returns the qubit that chooses the sign of all phases.
    pub fn sign(&self) -> Qubit {
        self.iterate.qubits()
    }

    /// Number of qubits: they are `0..qubits`.
    pub fn qubits(&self) -> u32 {
        self.iterate.qubits() + 1
    }

    /// Returns the oracle, whose qubits in superposition hold the index of a path.
    pub fn oracle(&self) -> &'a PhaseOracle {
        self.iterate.oracle()
    }

    /// Returns the qubits that are zero at the end.
    pub fn ancillas(&self) -> Vec<Qubit> {
        let paths = self.oracle().superposed();
        let all = 0..self.iterate.qubits();
        all.filter(|qubit| !paths.contains(qubit)).collect()
    }

    /// Number of calls of the oracle: one more than iterates.
    pub fn queries(&self) -> u64 {
        match self.iterations {
            0 => 0,
            iterations => iterations + 1,
        }
    }

    /// Number of gates.
    pub fn gates(&self) -> u64 {
        let signs = self.oracle().signs();
        // Each sign becomes a turn between two CNOTs, and one more turn is for all of them.
        let call = self.oracle().gates() + 2 * signs + 1;
        let ids = self.oracle().superposed().len() as u64;
        let calls = self.queries().saturating_mul(call);
        let reflections = self
            .iterations
            .saturating_mul(self.iterate.reflection_gates());
        calls.saturating_add(reflections).saturating_add(ids + 3)
    }

    /// Emits the circuit without its measurement: at its end the sign qubit reads 0 with probability
    /// `(1 + Re(exp(-i b) <psi| U^(2k) |psi>)) / 2`, b the angle of the basis.
    ///
    /// # Errors
    /// An error of `sink`, which ends the circuit.
    pub fn apply<E>(
        &self,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let paths = self.oracle().superposed();
        paths.iter().try_for_each(|id| sink(H(*id)))?;
        sink(H(self.sign()))?;
        if self.iterations > 0 {
            self.call(true, sink)?;
        }
        for left in (0..self.iterations).rev() {
            self.iterate.diffuse(None, sink)?;
            self.call(left == 0, sink)?;
        }
        let sign = [self.sign()];
        sink(Phase {
            turns: self.basis,
            on: &sign,
        })?;
        sink(H(self.sign()))
    }

    /// Emits D, or its square root if `half`, under the sign qubit.
    ///
    /// A bit b of phase t becomes the phase `t b (1 - 2s)`, s the sign qubit. That is t/2 (1 - 2s),
    /// the same for all b, and -t/2 times the sign of the parity of b and s: a turn of s between two
    /// CNOTs.
    fn call<E, S: FnMut(QuantumGate<'_>) -> Result<(), E>>(
        &self,
        half: bool,
        sink: &mut S,
    ) -> Result<(), E> {
        let sign = [self.sign()];
        let size = self.bits + u32::from(half);
        let turns = |bit: u32| {
            let value = 1_i64 << bit;
            // The highest bit is the sign of the phase.
            Turns::new(if bit + 1 == self.bits { -value } else { value }, size)
        };
        let mut bit = 0;
        self.oracle().apply_signs(
            &mut |qubits, sink: &mut S| {
                let turns = turns(bit);
                bit += 1;
                for qubit in qubits {
                    sink(Cx(*qubit, sign[0]))?;
                }
                sink(Phase { turns, on: &sign })?;
                for qubit in qubits {
                    sink(Cx(*qubit, sign[0]))?;
                }
                Ok(())
            },
            sink,
        )?;
        // All bits' phases add up to -1 in units of the lowest.
        sink(Phase {
            turns: Turns::new(1, size),
            on: &sign,
        })
    }
}
