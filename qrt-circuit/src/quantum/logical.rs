//! Logical counts: the input that estimators of physical resources take from a circuit.
//!
//! On a surface code, Clifford gates (X, CNOT, H, S, CZ) are almost free. The cost is in Toffolis,
//! T gates, rotations and measurements (Beverland et al., *Assessing requirements to scale to
//! practical quantum advantage*, 2022, appendix D). These are counted gate by gate, as the circuit
//! emits them.

use super::QuantumGate::{Ccx, Cx, H, Phase, Ry, X};
use super::{Conjunction, QuantumGate, Turns};
use crate::Qubit;
use std::convert::Infallible;

/// The receiver of a circuit's gates.
type Sink<'a> = &'a mut dyn FnMut(QuantumGate<'_>) -> Result<(), Infallible>;

/// Logical qubits, and the operations that have a cost on an error-corrected machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LogicalCounts {
    /// Qubits, ancillas included.
    pub qubits: u64,
    /// Toffolis that are computed and undone by gates.
    pub toffoli: u64,
    /// Toffolis into a clean qubit that a measurement undoes.
    pub and: u64,
    /// T gates; Toffolis are counted apart.
    pub t: u64,
    /// Rotations by other angles.
    pub rotations: u64,
    /// Rotations on the longest chain of gates, each of which waits for the one before.
    pub rotation_depth: u64,
    /// Measurements of a qubit.
    pub measurements: u64,
}

impl LogicalCounts {
    /// Counts the gates that `circuit` emits to its sink. Qubits are `0..qubits`, up to the last
    /// one that a gate is on.
    ///
    /// A phase on two qubits takes three on one, of half the angle, and two CNOTs. A phase on more
    /// qubits is reduced to two as in [`Conjunction::Toffolis`], whose ancillas are not counted.
    ///
    /// ```
    /// use qrt_circuit::quantum::{LogicalCounts, QuantumGate, Turns};
    /// let eighth = Turns::new(1, 3);
    /// let counts = LogicalCounts::from_circuit(|sink| {
    ///     sink(QuantumGate::Ccx(0, 1, 2))?;
    ///     sink(QuantumGate::Phase { turns: eighth, on: &[2] })?;
    ///     sink(QuantumGate::Phase { turns: eighth, on: &[0, 2] })
    /// });
    /// assert_eq!([counts.qubits, counts.toffoli, counts.t], [3, 1, 1]);
    /// assert_eq!([counts.rotations, counts.rotation_depth], [3, 2]);
    /// ```
    pub fn from_circuit(circuit: impl FnOnce(Sink<'_>) -> Result<(), Infallible>) -> Self {
        let mut tally = Tally::default();
        let Ok(()) = circuit(&mut |gate| {
            tally.add(gate);
            Ok(())
        });
        Self {
            qubits: tally.depths.len() as u64,
            rotation_depth: tally.depths.into_iter().max().unwrap_or(0),
            ..tally.counts
        }
    }

    /// Returns the counts of the same circuit with `pairs` pairs of its Toffolis replaced. Of each
    /// pair, one Toffoli undoes in a clean qubit the result of the other; an AND and a measurement
    /// take their place (Gidney, *Halving the cost of quantum addition*, 2018).
    pub fn measuring(self, pairs: u64) -> Self {
        Self {
            toffoli: self.toffoli.saturating_sub(2 * pairs),
            and: self.and + pairs,
            measurements: self.measurements + pairs,
            ..self
        }
    }

    /// Returns the counts of this circuit and then another, on the same qubits. `None` on overflow
    /// of u64.
    pub fn then(self, other: Self) -> Option<Self> {
        Some(Self {
            qubits: self.qubits.max(other.qubits),
            toffoli: self.toffoli.checked_add(other.toffoli)?,
            and: self.and.checked_add(other.and)?,
            t: self.t.checked_add(other.t)?,
            rotations: self.rotations.checked_add(other.rotations)?,
            rotation_depth: self.rotation_depth.checked_add(other.rotation_depth)?,
            measurements: self.measurements.checked_add(other.measurements)?,
        })
    }

    /// Returns the counts of `n` runs of this circuit, one after another. `None` on overflow of
    /// u64.
    pub fn times(self, n: u64) -> Option<Self> {
        Some(Self {
            qubits: self.qubits,
            toffoli: self.toffoli.checked_mul(n)?,
            and: self.and.checked_mul(n)?,
            t: self.t.checked_mul(n)?,
            rotations: self.rotations.checked_mul(n)?,
            rotation_depth: self.rotation_depth.checked_mul(n)?,
            measurements: self.measurements.checked_mul(n)?,
        })
    }
}

/// The counts so far, and for each qubit the number of rotations that its state waits for.
#[derive(Default)]
struct Tally {
    counts: LogicalCounts,
    depths: Vec<u64>,
}

impl Tally {
    fn add(&mut self, gate: QuantumGate<'_>) {
        match gate {
            X(on) | H(on) => self.together(&[on]),
            Cx(a, b) => self.together(&[a, b]),
            Ccx(a, b, c) => {
                self.together(&[a, b, c]);
                self.counts.toffoli += 1;
            }
            Ry { target, .. } => self.rotate(target),
            Phase { turns, on } => self.phase(turns, on),
        }
    }

    fn phase(&mut self, turns: Turns, on: &[Qubit]) {
        let ladder = Conjunction::Toffolis.ancillas(on.len() as u32);
        self.counts.toffoli += 2 * u64::from(ladder);
        self.together(on);
        let bits = turns.bits();
        match on {
            // S and its powers; a global phase.
            [_] if bits <= 2 => {}
            [] => {}
            [_] if bits == 3 => self.counts.t += 1,
            [on] => self.rotate(*on),
            // CZ.
            [_, _, ..] if bits <= 1 => {}
            [.., a, b] => {
                let half = Turns::new(turns.numerator(), bits + 1);
                self.phase(half, &[*a]);
                self.phase(half, &[*b]);
                self.together(&[*a, *b]);
                self.phase(half.inverse(), &[*b]);
                self.together(&[*a, *b]);
            }
        }
    }

    fn rotate(&mut self, on: Qubit) {
        self.together(&[on]);
        self.counts.rotations += 1;
        self.depths[on as usize] += 1;
    }

    /// Adds a gate on these qubits: each then waits for the most rotations that one of them waited
    /// for.
    fn together(&mut self, on: &[Qubit]) {
        let last = on.iter().max().map_or(0, |last| *last as usize + 1);
        if self.depths.len() < last {
            self.depths.resize(last, 0);
        }
        let depth = on.iter().map(|on| self.depths[*on as usize]).max();
        for on in on {
            self.depths[*on as usize] = depth.unwrap_or(0);
        }
    }
}
