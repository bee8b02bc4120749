//! Blocks of paths through the gates: compute, read, uncompute, look at every qubit.

use super::{Defect, OracleBlock, OracleCircuits, OracleMachine, word_of};
use crate::machines::gates::{Gates, Rows};
use crate::machines::span::Span;
use qrt_circuit::{Qubit, Word};

impl OracleMachine {
    pub(super) fn run_gates(
        &self,
        gates: &Gates,
        parts: &OracleCircuits,
        rows: &mut Rows,
        block: &mut OracleBlock,
        spans: &[Span<'_>],
    ) -> Result<(), Defect> {
        let count = block.ids.len();
        let id = parts.register(self.oracle.id).to_vec();
        let nearest = self.oracle.nearest;
        let hit = nearest.map_or(Vec::new(), |hit| parts.register(hit).to_vec());
        rows.set(&id, &block.ids);
        rows.set(&hit, &block.hits);
        rows.set_parameters(spans);
        gates.run(0, rows);
        let mut bits = vec![0; count];
        for (output, values) in self.outputs.iter().zip(&mut block.values) {
            let Some(word) = word_of(*output) else {
                continue;
            };
            rows.get(&parts.qubits(*output), &mut bits);
            // The word is all that was read.
            let alone = Word { offset: 0, ..word };
            for (value, bits) in values.iter_mut().zip(&bits) {
                *value = alone.read(*bits);
            }
        }
        gates.run(1 + parts.flips.len(), rows);
        let place = |lane: usize| {
            let mut start = 0;
            let runs = block.runs.iter();
            let mut runs = runs.filter(|run| {
                start += run.paths.count;
                lane < start
            });
            runs.next().map_or([0, 0], |run| run.paths.pixel)
        };
        let inputs = [(&id[..], &block.ids[..]), (&hit, &block.hits)];
        let path = |lane| (place(lane), block.ids[lane]);
        check(rows, &inputs, path, |qubit| parts.name(&self.oracle, qubit))
    }
}

/// That after uncompute all qubits are zero again but those of `inputs`, which hold what they held.
/// `path` says which pixel and path a lane is, `name` what a qubit belongs to.
pub(in crate::machines) fn check(
    rows: &Rows,
    inputs: &[(&[Qubit], &[u64])],
    path: impl Fn(usize) -> ([u32; 2], u64),
    name: impl Fn(Qubit) -> String,
) -> Result<(), Defect> {
    let held: Vec<Qubit> = inputs
        .iter()
        .flat_map(|(qubits, _)| *qubits)
        .copied()
        .collect();
    let count = inputs.first().map_or(0, |(_, contents)| contents.len());
    if let Some(dirty) = rows.dirty(&held, count) {
        let (pixel, id) = path(dirty.lane);
        return Err(Defect::Dirty {
            dirty,
            pixel,
            id,
            register: name(dirty.qubit),
        });
    }
    let mut bits = vec![0; count];
    for (qubits, contents) in inputs {
        rows.get(qubits, &mut bits);
        if let Some(lane) = bits.iter().zip(*contents).position(|(is, was)| is != was) {
            let (pixel, id) = path(lane);
            return Err(Defect::Id { pixel, id });
        }
    }
    Ok(())
}
