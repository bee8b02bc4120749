//! O_f, an oracle that flips the phase of good basis states, as gates.

use super::QuantumGate::{Ccx, Cx, Phase, X};
use super::{QuantumError, QuantumGate, Turns};
use crate::{
    Bit, BlockId, Gate, GateCircuit, Instruction, Op, Program, Qubit, Register, RegisterId, Style,
    Type, lower,
};
use std::sync::Arc;

/// The most address bits of a truth table.
const TABLE_BITS: u32 = 20;

/// A step of an oracle's flip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Flip {
    /// An X, CNOT or Toffoli, without the iterate's control.
    Gate(Gate),
    /// Flips the phase where all these qubits are 1. Only these steps carry an iterate's control.
    Sign(Vec<Qubit>),
}

/// An oracle that flips the phase of good basis states: compute, flip, uncompute.
///
/// Its qubits are `0..qubits`. The qubits of the index are in superposition, except for fixed bits.
/// All others are zero before and after. Classical parameters are built in.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseOracle {
    steps: Steps,
    /// The qubits of the index, bit 0 first: those in superposition and those that are fixed.
    index: Vec<Qubit>,
    superposed: Vec<Qubit>,
    /// The fixed qubits that hold 1.
    ones: Vec<Qubit>,
    qubits: u32,
}

/// The steps of a call of an oracle.
#[derive(Clone, Debug, PartialEq)]
enum Steps {
    Held {
        /// Gates X, CNOT and Toffoli alone, in the order in which they run.
        compute: Vec<Gate>,
        flip: Vec<Flip>,
        /// Gates X, CNOT and Toffoli alone, in the order in which they run.
        uncompute: Vec<Gate>,
    },
    /// A program that each call lowers again.
    Lowered {
        program: Program,
        words: Vec<u64>,
        gates: u64,
        signs: u64,
    },
}

impl PhaseOracle {
    /// Creates an oracle of circuits that share their qubits, as [`lower::parts`] makes them, for a
    /// pixel.
    ///
    /// `words` are the contents of the pixel's classical parameters. `superposed` are the qubits in
    /// superposition, bit 0 first.
    ///
    /// # Errors
    /// No superposed qubits; a missing word; a gate on a qubit that does not exist, or on one qubit
    /// twice; a phase flip outside of `flip`.
    pub fn new(
        compute: &GateCircuit,
        flip: &GateCircuit,
        uncompute: &GateCircuit,
        superposed: Vec<Qubit>,
        words: &[u64],
    ) -> Result<Self, QuantumError> {
        let qubits = compute.qubits.max(flip.qubits).max(uncompute.qubits);
        let flip = loaded(&flip.gates, words)?;
        let flip = flip.into_iter().map(|gate| match gate {
            Gate::Z(qubit) => Flip::Sign(vec![qubit]),
            gate => Flip::Gate(gate),
        });
        let oracle = Self {
            steps: Steps::Held {
                compute: loaded(&compute.gates, words)?,
                flip: flip.collect(),
                uncompute: loaded(&uncompute.gates, words)?,
            },
            index: superposed.clone(),
            superposed,
            ones: Vec::new(),
            qubits,
        };
        oracle.checked()
    }

    /// Creates an oracle of a program that computes, flips and uncomputes, with too many gates to
    /// hold. Each call lowers them again.
    ///
    /// `superposed` are registers of its inputs, which come one after another. The oracle emits the
    /// same gates as [`PhaseOracle::new`] of the program's parts.
    ///
    /// # Errors
    /// As [`PhaseOracle::new`], except that the program may flip phases anywhere.
    pub fn lowered(
        program: Program,
        superposed: &[RegisterId],
        words: &[u64],
    ) -> Result<Self, QuantumError> {
        // Inputs are placed first, in their order.
        let mut first = 0;
        let mut places = Vec::new();
        for input in &program.inputs {
            let end = first + program.width(*input);
            places.push((*input, first..end));
            first = end;
        }
        let qubits = superposed.iter().flat_map(|register| {
            let found = places.iter().find(|(input, _)| input == register);
            found.map_or(0..0, |(_, qubits)| qubits.clone())
        });
        let mut oracle = Self {
            steps: Steps::Held {
                compute: Vec::new(),
                flip: Vec::new(),
                uncompute: Vec::new(),
            },
            index: Vec::new(),
            superposed: qubits.collect(),
            ones: Vec::new(),
            qubits: lower::most_qubits(&program),
        };
        oracle.index.clone_from(&oracle.superposed);
        let (mut gates, mut signs) = (0, 0);
        lower::try_each_instruction(&program, |next, _| {
            for gate in next {
                if let Some(gate) = with_parameters(*gate, words)? {
                    oracle.check_gate(gate)?;
                    gates += 1;
                    signs += u64::from(matches!(gate, Gate::Z(_)));
                }
            }
            Ok(())
        })?;
        oracle.steps = Steps::Lowered {
            program,
            words: words.to_vec(),
            gates,
            signs,
        };
        oracle.checked()
    }

    /// Creates an oracle without ancillas. Its good basis states are those in which an odd number
    /// of `monomials` hold.
    ///
    /// Each monomial is the conjunction of some bits of the state (the algebraic normal form of a
    /// truth table). Bits are qubits `0..bits`.
    ///
    /// # Errors
    /// No bits, or a monomial with a bit that is not one of them.
    pub fn polynomial(bits: u32, monomials: Vec<Vec<Qubit>>) -> Result<Self, QuantumError> {
        let oracle = Self {
            steps: Steps::Held {
                compute: Vec::new(),
                flip: monomials.into_iter().map(Flip::Sign).collect(),
                uncompute: Vec::new(),
            },
            index: (0..bits).collect(),
            superposed: (0..bits).collect(),
            ones: Vec::new(),
            qubits: bits,
        };
        oracle.checked()
    }

    /// Creates an oracle that looks its basis states up: a table by unary iteration writes `good`
    /// into a flag. The address is qubits `0..bits`.
    ///
    /// # Errors
    /// No bits, or more than 20.
    pub fn table(bits: u32, good: impl Fn(u64) -> bool) -> Result<Self, QuantumError> {
        if bits == 0 {
            return Err(QuantumError::NoIndex);
        }
        if bits > TABLE_BITS {
            return Err(QuantumError::TableBits {
                bits,
                most: TABLE_BITS,
            });
        }
        let program = table(bits, good);
        let parts = lower::parts(&program, &[1, 2]);
        let [compute, flip, uncompute] = [0, 1, 2].map(|place| parts.get(place));
        let empty = GateCircuit::default();
        Self::new(
            compute.unwrap_or(&empty),
            flip.unwrap_or(&empty),
            uncompute.unwrap_or(&empty),
            (0..bits).collect(),
            &[],
        )
    }

    /// Returns the same oracle with some qubits of its index fixed: `zeros` hold 0 and `ones` hold
    /// 1. All others stay in superposition.
    ///
    /// The oracle's circuits then count among a part of the indices: they have an X, or nothing, where
    /// the circuit over all indices begins with a Hadamard.
    ///
    /// # Errors
    /// A qubit that is not in superposition, or is named twice; no qubit left in superposition.
    ///
    /// ```
    /// use qrt_circuit::quantum::PhaseOracle;
    /// // Of the upper half of 8 basis states, 3 are good.
    /// let oracle = PhaseOracle::table(3, |id| id > 4)?.with_fixed(&[], &[2])?;
    /// assert_eq!(oracle.superposed(), [0, 1]);
    /// # Ok::<(), qrt_circuit::quantum::QuantumError>(())
    /// ```
    pub fn with_fixed(mut self, zeros: &[Qubit], ones: &[Qubit]) -> Result<Self, QuantumError> {
        for qubit in zeros.iter().chain(ones) {
            let place = self.superposed.iter().position(|other| other == qubit);
            let place = place.ok_or(QuantumError::InvalidQubit(*qubit))?;
            self.superposed.remove(place);
        }
        self.ones.extend_from_slice(ones);
        self.checked()
    }

    /// Returns the qubits of the index, bit 0 first. All are in superposition, except for fixed
    /// ones.
    pub fn index(&self) -> &[Qubit] {
        &self.index
    }

    /// Returns the fixed qubits that hold 1, before and after each call.
    pub(crate) fn ones(&self) -> &[Qubit] {
        &self.ones
    }

    /// Returns the qubits in superposition, bit 0 first: the path index and, above it, the
    /// comparator.
    pub fn superposed(&self) -> &[Qubit] {
        &self.superposed
    }

    /// Number of qubits of one call, ancillas included: they are `0..qubits`.
    pub fn qubits(&self) -> u32 {
        self.qubits
    }

    /// Returns the ancillas: the qubits that are zero before and after each call.
    pub fn ancillas(&self) -> Vec<Qubit> {
        let all = 0..self.qubits;
        all.filter(|qubit| !self.superposed.contains(qubit) && !self.ones.contains(qubit))
            .collect()
    }

    /// Number of gates of one call, phase flips included.
    pub fn gates(&self) -> u64 {
        match &self.steps {
            Steps::Held {
                compute,
                flip,
                uncompute,
            } => (compute.len() + flip.len() + uncompute.len()) as u64,
            Steps::Lowered { gates, .. } => *gates,
        }
    }

    /// Number of phase flips of one call.
    pub fn signs(&self) -> u64 {
        match &self.steps {
            Steps::Held { flip, .. } => {
                let signs = flip.iter().filter(|step| matches!(step, Flip::Sign(_)));
                signs.count() as u64
            }
            Steps::Lowered { signs, .. } => *signs,
        }
    }

    /// True if each phase flip is that of one qubit, and no qubit of the index is fixed.
    pub(super) fn flips_single_qubits(&self) -> bool {
        let single = |step: &Flip| match step {
            Flip::Sign(qubits) => qubits.len() == 1,
            Flip::Gate(_) => true,
        };
        let flips = match &self.steps {
            Steps::Held { flip, .. } => flip.iter().all(single),
            Steps::Lowered { .. } => true,
        };
        flips && self.index.len() == self.superposed.len()
    }

    /// Emits the oracle's gates. With a `control`, only the phase flips are controlled: without a
    /// flip, uncompute cancels compute.
    ///
    /// # Errors
    /// An error of `sink`.
    pub fn apply<E>(
        &self,
        control: Option<Qubit>,
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.apply_signs(&mut |qubits, sink| sign(control, qubits, sink), sink)
    }

    /// Emits the oracle's gates, and for each phase flip what `sign` emits. `sign` receives the qubits
    /// that must all be 1, and the sink.
    ///
    /// # Errors
    /// An error of `sink`.
    pub(crate) fn apply_signs<E, S: FnMut(QuantumGate<'_>) -> Result<(), E>>(
        &self,
        sign: &mut impl FnMut(&[Qubit], &mut S) -> Result<(), E>,
        sink: &mut S,
    ) -> Result<(), E> {
        match &self.steps {
            Steps::Held {
                compute,
                flip,
                uncompute,
            } => {
                compute
                    .iter()
                    .try_for_each(|gate| reversible(*gate, sink))?;
                for step in flip {
                    match step {
                        Flip::Gate(gate) => reversible(*gate, sink)?,
                        Flip::Sign(qubits) => sign(qubits, sink)?,
                    }
                }
                uncompute
                    .iter()
                    .try_for_each(|gate| reversible(*gate, sink))
            }
            Steps::Lowered { program, words, .. } => {
                let done = lower::try_each_instruction(program, |next, _| {
                    for gate in next {
                        // `lowered` has checked that there is a word for each.
                        match with_parameters(*gate, words) {
                            Ok(Some(Gate::Z(qubit))) => sign(&[qubit], sink)?,
                            Ok(Some(gate)) => reversible(gate, sink)?,
                            Ok(None) | Err(_) => {}
                        }
                    }
                    Ok(())
                });
                done.map(drop)
            }
        }
    }

    fn checked(self) -> Result<Self, QuantumError> {
        if self.superposed.is_empty() {
            return Err(QuantumError::NoIndex);
        }
        self.different(&self.superposed)?;
        let Steps::Held {
            compute,
            flip,
            uncompute,
        } = &self.steps
        else {
            // `lowered` has checked each gate while counting it.
            return Ok(self);
        };
        for gate in compute.iter().chain(uncompute) {
            if let Gate::Z(qubit) = gate {
                return Err(QuantumError::SignOutsideFlip(*qubit));
            }
            self.check_gate(*gate)?;
        }
        for step in flip {
            match step {
                Flip::Gate(gate) => self.check_gate(*gate)?,
                Flip::Sign(qubits) => self.different(qubits)?,
            }
        }
        Ok(self)
    }

    fn check_gate(&self, gate: Gate) -> Result<(), QuantumError> {
        match gate {
            Gate::X(t) | Gate::Z(t) | Gate::Load { target: t, .. } => self.different(&[t]),
            Gate::Cx(a, t) => self.different(&[a, t]),
            Gate::Ccx(a, b, t) => self.different(&[a, b, t]),
        }
    }

    fn different(&self, qubits: &[Qubit]) -> Result<(), QuantumError> {
        for (place, qubit) in qubits.iter().enumerate() {
            if *qubit >= self.qubits || qubits[..place].contains(qubit) {
                return Err(QuantumError::InvalidQubit(*qubit));
            }
        }
        Ok(())
    }
}

fn reversible<E>(
    gate: Gate,
    sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
) -> Result<(), E> {
    match gate {
        Gate::X(t) => sink(X(t)),
        Gate::Cx(a, t) => sink(Cx(a, t)),
        Gate::Ccx(a, b, t) => sink(Ccx(a, b, t)),
        // Neither occurs: loads are built in, and phase flips are steps of their own.
        Gate::Load { .. } | Gate::Z(_) => Ok(()),
    }
}

/// Flips the phase where `qubits` and the control are 1.
fn sign<E>(
    control: Option<Qubit>,
    qubits: &[Qubit],
    sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let on: Vec<Qubit> = control.into_iter().chain(qubits.iter().copied()).collect();
    sink(Phase {
        turns: Turns::HALF,
        on: &on,
    })
}

/// Returns the gates with a pixel's classical parameters built in.
fn loaded(gates: &[Gate], words: &[u64]) -> Result<Vec<Gate>, QuantumError> {
    let gates = gates.iter();
    gates
        .filter_map(|gate| with_parameters(*gate, words).transpose())
        .collect()
}

/// Returns a gate with a pixel's classical parameters built in: a load is an X, or nothing.
fn with_parameters(gate: Gate, words: &[u64]) -> Result<Option<Gate>, QuantumError> {
    Ok(match gate {
        Gate::Load {
            parameter,
            bit,
            target,
        } => {
            let word = words.get(parameter as usize).filter(|_| bit < 64);
            let word = word.ok_or(QuantumError::MissingWord { parameter, bit })?;
            (word >> bit & 1 == 1).then_some(Gate::X(target))
        }
        // A Toffoli with twice the same control is a CNOT.
        Gate::Ccx(a, b, t) if a == b => Some(Gate::Cx(a, t)),
        gate => Some(gate),
    })
}

/// Returns the program that looks up a flag, flips its phase, and uncomputes it.
fn table(bits: u32, good: impl Fn(u64) -> bool) -> Program {
    let [id, flag, scratch] = [0, 1, 2].map(RegisterId);
    let entries: Arc<[i64]> = (0..1 << bits).map(|id| i64::from(good(id))).collect();
    let bit = |register, index| Bit {
        register,
        index,
        inverted: false,
    };
    let look_up = Op::Table {
        address: (0..bits).map(|index| bit(id, index)).collect(),
        columns: vec![entries].into(),
        low: 0,
        style: Style::InPlace,
        targets: Box::new([flag]),
        scratch,
    };
    let steps = [(0, false), (1, false), (0, true)];
    Program {
        registers: vec![
            Register::new("id", Type::UInt, bits),
            Register::new("flag", Type::Bool, 1),
            Register::new("scratch", Type::Scratch, 0),
        ],
        ops: vec![look_up, Op::Phase { bit: bit(flag, 0) }],
        instructions: steps
            .map(|(op, inverse)| Instruction {
                op,
                inverse,
                block: BlockId::ROOT,
            })
            .into(),
        inputs: vec![id],
        ..Program::default()
    }
}
