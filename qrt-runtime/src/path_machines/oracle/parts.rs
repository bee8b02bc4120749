//! An oracle as circuits, which the gates machine runs.

use qrt_circuit::{GateCircuit, Instruction, Operand, Program, Qubit, RegisterId, lower};
use qrt_core::oracle::{MOST_BITS, Oracle};
use std::sync::{Arc, Mutex};

/// The parts of an oracle's circuit, which share their qubits.
#[derive(Clone, Debug)]
pub struct OracleCircuits {
    /// From path indices to colours.
    pub compute: GateCircuit,
    /// By channel: compare, flip, undo the comparison.
    pub flips: Vec<GateCircuit>,
    /// From colours back to path indices alone.
    pub uncompute: GateCircuit,
    /// A replacement for the gates of compute and uncompute, if these are too many to be held in
    /// memory.
    pub(super) streamed: Option<Box<Streamed>>,
}

/// A program whose gates are generated anew each time they run.
#[derive(Clone, Debug)]
pub(super) struct Streamed {
    /// Compute and uncompute.
    pub(super) program: Program,
    /// The first instruction of uncompute.
    pub(super) cut: usize,
    /// Lock of the thread that runs a very large program: there is memory for one set of its rows
    /// only.
    pub(super) turn: Arc<Mutex<()>>,
    gates: usize,
}

impl OracleCircuits {
    /// Largest number of bits in registers for which the gates of compute and uncompute are held in
    /// memory.
    pub const MOST_BITS: u64 = MOST_BITS;

    /// Lowers an oracle to gates: compute, all channels' flips one after another, uncompute.
    ///
    /// If the registers have more than [`OracleCircuits::MOST_BITS`] bits, the gates of compute and
    /// uncompute are not held: [`GateCircuit::gates`] is empty, and the gates machine lowers
    /// operations as it runs them.
    pub fn new(oracle: &Oracle) -> Self {
        let widths = oracle.program.registers.iter();
        let bits: u64 = widths.map(|register| u64::from(register.width)).sum();
        Self::lowered(oracle, bits <= Self::MOST_BITS)
    }

    /// Lowers an oracle to gates. If `held` is false, the gates of compute and uncompute are not
    /// held.
    pub(super) fn lowered(oracle: &Oracle, held: bool) -> Self {
        let mut whole = oracle.program.clone();
        let undo = whole.inverse().instructions;
        let mut cuts = vec![whole.instructions.len()];
        for channel in 0..oracle.channels.len() {
            let flip = oracle.flip(channel);
            let (own, base) = (oracle.program.ops.len(), whole.ops.len());
            whole.blocks = flip.blocks;
            whole.ops.extend_from_slice(&flip.ops[own..]);
            whole
                .instructions
                .extend(flip.instructions.into_iter().map(|step| Instruction {
                    op: step.op - own as u32 + base as u32,
                    ..step
                }));
            cuts.push(whole.instructions.len());
        }
        whole.instructions.extend(undo.iter().copied());
        let (parts, streamed) = if held {
            (lower::parts(&whole, &cuts), None)
        } else {
            let (parts, gates) = lower::parts_between(&whole, &cuts);
            let mut program = oracle.program.clone();
            program.instructions.extend(undo);
            let cut = cuts[0];
            let streamed = Streamed {
                program,
                cut,
                turn: Arc::default(),
                gates,
            };
            (parts, Some(Box::new(streamed)))
        };
        let mut parts = parts.into_iter();
        let compute = parts.next().unwrap_or_default();
        let uncompute = parts.next_back().unwrap_or_default();
        Self {
            compute,
            flips: parts.collect(),
            uncompute,
            streamed,
        }
    }

    /// Number of gates of all parts.
    pub fn gates(&self) -> usize {
        let flips = self.flips.iter().map(|flip| flip.gates.len());
        let streamed = self.streamed.as_ref().map_or(0, |streamed| streamed.gates);
        let held = self.compute.gates.len() + self.uncompute.gates.len();
        held + flips.sum::<usize>() + streamed
    }

    /// The qubits of an operand after compute, its lowest bit first; none for a constant.
    pub(super) fn qubits(&self, operand: Operand) -> Vec<Qubit> {
        match operand {
            Operand::Constant(_) => Vec::new(),
            Operand::Word(word) => {
                let all = self.register(word.register);
                let range = word.offset as usize..(word.offset + word.width) as usize;
                all.get(range).map(<[Qubit]>::to_vec).unwrap_or_default()
            }
        }
    }

    pub(super) fn register(&self, register: RegisterId) -> &[Qubit] {
        qubits(&self.compute, register)
    }

    /// Name of the register that a qubit belongs to after compute.
    pub(super) fn name(&self, oracle: &Oracle, qubit: Qubit) -> String {
        name(&self.compute, &oracle.program, qubit)
    }
}

/// The qubits of a register after `compute`; none if it holds none.
pub(in crate::path_machines) fn qubits(compute: &GateCircuit, register: RegisterId) -> &[Qubit] {
    let mut held = compute.outputs.iter();
    held.find(|(id, _)| *id == register)
        .map_or(&[], |(_, qubits)| qubits)
}

/// Name of the register of `program` that a qubit belongs to after `compute`; `an ancilla` if there
/// is none.
pub(in crate::path_machines) fn name(
    compute: &GateCircuit,
    program: &Program,
    qubit: Qubit,
) -> String {
    let mut held = compute.outputs.iter();
    let register = held.find(|(_, qubits)| qubits.contains(&qubit));
    register.map_or_else(
        || "an ancilla".to_owned(),
        |(register, _)| program.registers[register.index()].name.clone(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path_machines::{Defect, OracleMachine};
    use qrt_core::oracle::OracleOptions;
    use qrt_scene::front::parse;

    const ROOM: &str = "
name: room
camera: { perspective: { eye: [0, 1, 3], target: [0, 0.5, 0], vfov: 60 } }
film: { width: 3, height: 2 }
materials:
  grey: { lambertian: { albedo: [0.5, 0.7, 0.2] } }
  lamp: { emitter: { radiance: [4, 2, 1] } }
geometry:
  - quad: { vertices: [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], material: grey }
  - quad: { vertices: [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], material: grey }
  - triangle: { vertices: [[-0.5, 1.9, 0.5], [0.5, 1.9, -0.5], [0.5, 1.9, 0.5]], material: lamp }
precision: { fraction: 10 }
comparator: { bits: 6 }
sampling: { path_bits: 9, depths: [{ bits: [3, 3] }, { bits: [5, 5] }], lights: none }
";

    /// Returns the counts and colours of every path of every pixel, by channel, from the gates
    /// machine.
    fn traced(oracle: &Arc<Oracle>, parts: OracleCircuits) -> Result<[Vec<i64>; 6], Defect> {
        let machine = OracleMachine::of_parts(Arc::clone(oracle), parts, 3, true)?;
        let pixels: Vec<[u32; 2]> = (0..6).map(|n| [n % 3, n / 3]).collect();
        let mut all: [Vec<i64>; 6] = Default::default();
        machine.trace(&pixels, 0..512, |run| {
            let columns = run.good.into_iter().chain(run.colours);
            for (all, column) in all.iter_mut().zip(columns) {
                all.extend_from_slice(column);
            }
        })?;
        Ok(all)
    }

    #[test]
    fn gates_that_are_not_held_compute_what_those_held_do() {
        let scene = parse(ROOM, "room.yaml", &[], "".as_ref()).unwrap().valid;
        let oracle = Oracle::rgb(&scene, OracleOptions::default());
        let oracle = Arc::new(oracle.unwrap());
        let [held, streamed] = [true, false].map(|held| OracleCircuits::lowered(&oracle, held));
        assert!(held.compute.gates.len() > 10_000);
        assert!(streamed.compute.gates.is_empty() && streamed.uncompute.gates.is_empty());
        assert_eq!(streamed.gates(), held.gates());
        assert_eq!(streamed.flips[2].gates, held.flips[2].gates);
        let of_held = traced(&oracle, held).unwrap();
        assert_eq!(of_held.concat().len(), 6 * 6 * 512);
        assert!(traced(&oracle, streamed.clone()).unwrap() == of_held);
        // A missing operation is found.
        let mut wrong = streamed;
        if let Some(streamed) = &mut wrong.streamed {
            streamed.program.instructions.pop();
        }
        assert!(matches!(traced(&oracle, wrong), Err(Defect::Dirty { .. })));
    }
}
