//! An oracle as circuits: what the gates machine runs.

use qrt_circuit::{Circuit, Instruction, Operand, Program, Qubit, RegisterId, lower};
use qrt_core::oracle::Oracle;

/// The parts of an oracle's circuit, which share their qubits.
#[derive(Clone, Debug)]
pub struct OracleCircuits {
    /// From path indices to colours.
    pub compute: Circuit,
    /// By channel: compare, flip, undo the comparison.
    pub flips: Vec<Circuit>,
    /// From colours back to path indices alone.
    pub uncompute: Circuit,
}

impl OracleCircuits {
    /// Lowers an oracle to gates: compute, all channels' flips one after another, uncompute.
    pub fn new(oracle: &Oracle) -> Self {
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
        whole.instructions.extend(undo);
        let mut parts = lower::parts(&whole, &cuts).into_iter();
        let compute = parts.next().unwrap_or_default();
        let uncompute = parts.next_back().unwrap_or_default();
        Self {
            compute,
            flips: parts.collect(),
            uncompute,
        }
    }

    /// Gates of all parts.
    pub fn gates(&self) -> usize {
        let flips = self.flips.iter().map(|flip| flip.gates.len());
        self.compute.gates.len() + flips.sum::<usize>() + self.uncompute.gates.len()
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

    /// What a qubit belongs to after compute.
    pub(super) fn name(&self, oracle: &Oracle, qubit: Qubit) -> String {
        name(&self.compute, &oracle.program, qubit)
    }
}

/// The qubits of a register after `compute`; none if it holds none.
pub(in crate::machines) fn qubits(compute: &Circuit, register: RegisterId) -> &[Qubit] {
    let mut held = compute.outputs.iter();
    held.find(|(id, _)| *id == register)
        .map_or(&[], |(_, qubits)| qubits)
}

/// The register of `program` that a qubit belongs to after `compute`, or that it belongs to none.
pub(in crate::machines) fn name(compute: &Circuit, program: &Program, qubit: Qubit) -> String {
    let mut held = compute.outputs.iter();
    let register = held.find(|(_, qubits)| qubits.contains(&qubit));
    register.map_or_else(
        || "an ancilla".to_owned(),
        |(register, _)| program.registers[register.index()].name.clone(),
    )
}
