//! Blocks of paths through the gates: compute, read, uncompute, look at every qubit.

use super::{Block, Defect, OracleMachine, Parts, word_of};
use crate::machines::gates::{Gates, Rows};
use crate::machines::span::Span;
use qrt_circuit::Word;

impl OracleMachine {
    pub(super) fn run_gates(
        &self,
        gates: &Gates,
        parts: &Parts,
        rows: &mut Rows,
        block: &mut Block,
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
        if let Some(dirty) = rows.dirty(&[&id[..], &hit].concat(), count) {
            return Err(Defect::Dirty {
                dirty,
                pixel: place(dirty.lane),
                id: block.ids.get(dirty.lane).copied().unwrap_or(0),
                register: parts.name(&self.oracle, dirty.qubit),
            });
        }
        for (qubits, contents) in [(&id, &block.ids), (&hit, &block.hits)] {
            rows.get(qubits, &mut bits);
            if let Some(lane) = bits.iter().zip(contents).position(|(is, was)| is != was) {
                return Err(Defect::Id {
                    pixel: place(lane),
                    id: block.ids[lane],
                });
            }
        }
        Ok(())
    }
}
