//! Quantum counting's circuit, run on a machine.

use super::{Sparse, StateVector, StateVectorError};
use qrt_circuit::quantum::{CountingCircuit, PhaseOracle, QuantumGate, Window};

/// Largest probability with which ancillas may be excited: rounding leaves a window's bond excited
/// by up to this much.
const CLEAN: f64 = 1e-28;

/// Times at which ancillas are checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checks {
    /// After the preparation, after each query, and at the end.
    EveryQuery,
    /// At the end only.
    AtTheEnd,
}

/// Result of a run of the counting circuit: the distribution that it measures, and its resources.
#[derive(Clone, Debug, PartialEq)]
pub struct CountingRun {
    /// `P(theta~)`, by outcome `y = 0 ..= T/2`.
    pub distribution: Vec<f64>,
    /// The qubits, gates and queries that the run took.
    pub report: RunResources,
}

/// Resources that a run of the counting circuit took.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResources {
    /// Number of qubits: those of the index, the ancillas and the phase register.
    pub qubits: u32,
    /// Number of qubits in superposition: those of the index and the phase register.
    pub superposed: u32,
    /// Number of gates that were executed.
    pub gates: u64,
    /// Calls of the oracle, compute and uncompute each.
    pub queries: u64,
    /// Largest number of basis states with amplitude at a time; `None` if the machine keeps all
    /// states.
    pub most_states: Option<u64>,
    /// Number of checks of all ancillas, each of which found zero in every basis state with
    /// amplitude.
    pub checks: u64,
    /// The sum of all probabilities.
    pub norm: f64,
    /// The probability of the states that were dropped because their amplitudes are too small.
    pub dropped: f64,
}

/// Adds the probabilities of outcomes y and T - y, which mean the same theta~, for `y = 0 ..= T/2`.
pub fn fold(outcomes: &[f64]) -> Vec<f64> {
    let size = outcomes.len();
    if size == 0 {
        return Vec::new();
    }
    let folded = (0..=size / 2).map(|y| match (size - y) % size {
        other if other == y => outcomes[y],
        other => outcomes[y] + outcomes[other],
    });
    folded.collect()
}

/// Runs a counting circuit on a machine whose qubits are zero, gate by gate.
///
/// # Errors
/// Errors of the machine; an ancilla that does not return to zero.
pub fn count<M: StateVector>(
    machine: &mut M,
    counting: &CountingCircuit<'_>,
    checks: Checks,
) -> Result<CountingRun, StateVectorError> {
    run(machine, counting, checks, &|| false)
}

fn run<M: StateVector>(
    machine: &mut M,
    counting: &CountingCircuit<'_>,
    checks: Checks,
    cancelled: &dyn Fn() -> bool,
) -> Result<CountingRun, StateVectorError> {
    let ancillas = counting.ancillas();
    let mut run = Run {
        machine,
        ancillas: &ancillas,
        gates: 0,
        checks: 0,
    };
    counting.prepare(&mut |gate| run.gate(gate))?;
    for bit in 0..counting.phase_register().len() as u32 {
        for _ in 0..1_u64 << bit {
            if cancelled() {
                return Err(StateVectorError::Cancelled);
            }
            if checks == Checks::EveryQuery {
                run.check()?;
            }
            counting.query(bit, &mut |gate| run.gate(gate))?;
        }
    }
    if checks == Checks::EveryQuery {
        run.check()?;
    }
    counting.inverse_fourier(&mut |gate| run.gate(gate))?;
    run.check()?;
    let (gates, checks) = (run.gates, run.checks);
    let outcomes = machine.distribution(counting.phase_register())?;
    let ids = counting.iterate().oracle().superposed().len();
    Ok(CountingRun {
        distribution: fold(&outcomes),
        report: RunResources {
            qubits: counting.qubits(),
            superposed: (ids + counting.phase_register().len()) as u32,
            gates,
            queries: counting.queries(),
            most_states: None,
            checks,
            norm: machine.norm()?,
            dropped: 0.0,
        },
    })
}

struct Run<'a, M> {
    machine: &'a mut M,
    ancillas: &'a [u32],
    gates: u64,
    checks: u64,
}

impl<M: StateVector> Run<'_, M> {
    fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), StateVectorError> {
        self.gates += 1;
        self.machine.gate(gate)
    }

    fn check(&mut self) -> Result<(), StateVectorError> {
        let probability = self.machine.excited(self.ancillas)?;
        if probability > CLEAN {
            let mut qubit = 0;
            for ancilla in self.ancillas {
                if self.machine.excited(&[*ancilla])? > 0.0 {
                    qubit = *ancilla;
                    break;
                }
            }
            return Err(StateVectorError::Dirty { qubit, probability });
        }
        self.checks += 1;
        Ok(())
    }
}

/// Counts the good indices of `oracle` by the whole circuit, on the sparse machine: every Hadamard, every gate of
/// every controlled query with all its ancillas, the window and the inverse Fourier transform, for a
/// phase register of `phase_bits` qubits.
///
/// ```
/// use qrt_circuit::quantum::{PhaseOracle, Window};
/// use qrt_machines::statevector::counting_of;
///
/// let oracle = PhaseOracle::table(3, |index| index < 4)?;
/// let counted = counting_of(&oracle, 4, Window::Rect)?;
/// assert!((counted.distribution.iter().sum::<f64>() - 1.0).abs() < 1e-12);
/// assert_eq!(counted.report.queries, 15);
/// assert_eq!(counted.report.superposed, 3 + 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// No such phase register, more states than the machine allows, an ancilla that does not return to zero.
pub fn counting_of(
    oracle: &PhaseOracle,
    phase_bits: u32,
    window: Window,
) -> Result<CountingRun, StateVectorError> {
    counting_until(&CountingCircuit::new(oracle, phase_bits, window)?, &|| {
        false
    })
}

/// Runs a counting circuit on the sparse machine, with a check of all ancillas after every query. Before
/// each query `cancelled` is asked whether to go on.
///
/// # Errors
/// As [`counting_of`]; [`StateVectorError::Cancelled`] if `cancelled` returned true.
pub fn counting_until(
    counting: &CountingCircuit<'_>,
    cancelled: &dyn Fn() -> bool,
) -> Result<CountingRun, StateVectorError> {
    let mut machine = Sparse::new(counting.qubits());
    let mut counted = run(&mut machine, counting, Checks::EveryQuery, cancelled)?;
    counted.report.most_states = Some(machine.most_states());
    counted.report.dropped = machine.dropped();
    Ok(counted)
}
