//! Runs blocks of paths through the gates: compute, read, uncompute, check every qubit.

use super::parts::Streamed;
use super::reading::Reading;
use super::{Defect, OracleBlock, OracleCircuits, word_of};
use crate::memory::{QUBITS_OF_ONE_TURN, bytes_of_rows, bytes_of_templates};
use crate::path_machines::pool::Pool;
use qrt_circuit::lower::{self, Templates};
use qrt_circuit::{Operand, Program, Qubit, Word};
use qrt_core::oracle::Oracle;
use qrt_machines::{GatesMachine, PixelLanes, Queue, Rows, Template};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of gates of a streamed circuit that run together.
const AT_ONCE: usize = 1 << 14;

/// The reading gate by gate.
pub(super) struct GatesReading {
    gates: GatesMachine,
    /// `at_once` rows for a block of paths, and at most `room` bytes of templates for operations
    /// whose gates are not held in memory.
    rows: Pool<(Vec<Rows>, Templates<Template>)>,
    at_once: usize,
    room: usize,
    parts: OracleCircuits,
}

impl GatesReading {
    pub(super) fn new(parts: OracleCircuits) -> Result<Self, Defect> {
        let mut circuits = vec![&parts.compute];
        circuits.extend(&parts.flips);
        circuits.push(&parts.uncompute);
        let mut gates = GatesMachine::new(&circuits)?;
        let (mut at_once, mut room) = (1, 0);
        if parts.streamed.is_some() {
            let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
            let bytes = bytes_of_rows(threads, parts.compute.qubits);
            gates = gates.for_many_rows(bytes);
            at_once = gates.rows_at_once(bytes);
            room = bytes_of_templates(threads, parts.compute.qubits);
        }
        Ok(Self {
            gates,
            rows: Pool::new(),
            at_once,
            room,
            parts,
        })
    }

    pub(super) fn parts(&self) -> &OracleCircuits {
        &self.parts
    }
}

impl Reading for GatesReading {
    fn paths_at_once(&self) -> usize {
        self.at_once * self.gates.lanes()
    }

    fn block_length(&self) -> usize {
        self.paths_at_once()
    }

    fn run(
        &self,
        oracle: &Oracle,
        outputs: &[Operand],
        block: &mut OracleBlock,
        spans: (&[PixelLanes<'_>], Option<&AtomicBool>),
    ) -> Result<(), Defect> {
        let large = self.parts.streamed.as_ref();
        let large = large.filter(|_| self.parts.compute.qubits > QUBITS_OF_ONE_TURN);
        let turn = large.map(|streamed| &streamed.turn);
        let _turn = turn.map(|turn| turn.lock().unwrap_or_else(PoisonError::into_inner));
        self.rows.lend(
            || {
                let rows = (0..self.at_once).map(|_| self.gates.rows()).collect();
                (rows, Templates::with_room(self.room))
            },
            |own| self.run_gates(oracle, outputs, own, block, spans),
        )
    }

    /// All qubits can be read.
    fn read_words(&mut self, _program: &Program, _words: &[Word]) {}

    fn circuits(&self) -> Option<&OracleCircuits> {
        Some(&self.parts)
    }
}

impl GatesReading {
    /// Runs a block's paths, divided among `rows`.
    fn run_gates(
        &self,
        oracle: &Oracle,
        outputs: &[Operand],
        (rows, templates): &mut (Vec<Rows>, Templates<Template>),
        block: &mut OracleBlock,
        (spans, cancel): (&[PixelLanes<'_>], Option<&AtomicBool>),
    ) -> Result<(), Defect> {
        let Self { gates, parts, .. } = self;
        let lanes = gates.lanes();
        let count = block.ids.len();
        let rows = &mut rows[..count.div_ceil(lanes)];
        let id = parts.register(oracle.id).to_vec();
        let nearest = oracle.nearest;
        let hit = nearest.map_or(Vec::new(), |hit| parts.register(hit).to_vec());
        let mut hits = block.hits.chunks(lanes);
        let shares = rows.iter_mut().zip(block.ids.chunks(lanes)).enumerate();
        for (number, (rows, ids)) in shares {
            rows.set(&id, ids);
            rows.set(&hit, hits.next().unwrap_or_default());
            let first = number * lanes;
            rows.set_parameters(&part_of_spans(spans, first..first + ids.len()));
        }
        let values = &mut block.values;
        let read = |rows: &[Rows]| {
            for (output, values) in outputs.iter().zip(values) {
                let Some(word) = word_of(*output) else {
                    continue;
                };
                let qubits = parts.qubits(*output);
                // `qubits` are those of the word alone, so it begins at offset 0.
                let alone = Word { offset: 0, ..word };
                for (rows, values) in rows.iter().zip(values[..count].chunks_mut(lanes)) {
                    let mut bits = vec![0; values.len()];
                    rows.get(&qubits, &mut bits);
                    for (value, bits) in values.iter_mut().zip(&bits) {
                        *value = alone.read(*bits);
                    }
                }
            }
        };
        match &parts.streamed {
            None => {
                let run =
                    |part, rows: &mut [Rows]| rows.iter_mut().for_each(|r| gates.run(part, r));
                run(0, rows);
                read(rows);
                run(1 + parts.flips.len(), rows);
            }
            Some(streamed) => streamed.run_templates(cancel, gates, (rows, templates), read)?,
        }
        let mut hits = block.hits.chunks(lanes);
        let shares = rows.iter().zip(block.ids.chunks(lanes)).enumerate();
        for (number, (rows, ids)) in shares {
            let inputs = [(&id[..], ids), (&hit, hits.next().unwrap_or_default())];
            let path = |lane| (block.pixel_of(number * lanes + lane), ids[lane]);
            check(rows, &inputs, path, |qubit| parts.name(oracle, qubit))?;
        }
        Ok(())
    }
}

impl Streamed {
    /// Lowers the program and runs its gates, some at a time. Calls `read` between compute and
    /// uncompute.
    fn run_templates(
        &self,
        cancel: Option<&AtomicBool>,
        gates: &GatesMachine,
        (rows, templates): (&mut [Rows], &mut Templates<Template>),
        read: impl FnOnce(&[Rows]),
    ) -> Result<(), Defect> {
        let mut queue = Queue::default();
        let mut read = Some(read);
        let mut step = 0;
        let run = |queue: &mut Queue, rows: &mut [Rows]| {
            if cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                return Err(Defect::Cancelled);
            }
            gates.run_queued(queue, rows);
            Ok(())
        };
        lower::try_each_template(
            &self.program,
            templates,
            |own, qubits| {
                let template = gates.template(own, qubits)?;
                let bytes = template.bytes();
                Ok((template, bytes))
            },
            |template, qubits| {
                if step == self.cut {
                    run(&mut queue, rows)?;
                    if let Some(read) = read.take() {
                        read(rows);
                    }
                }
                gates.queue(template, qubits, &mut queue);
                if queue.len() >= AT_ONCE {
                    run(&mut queue, rows)?;
                }
                step += 1;
                Ok::<(), Defect>(())
            },
        )?;
        run(&mut queue, rows)
    }
}

/// Checks that after uncompute all qubits are zero again, except those of `inputs`, which must hold
/// their old contents. `path` returns the pixel and the path of a lane, and `name` the register of
/// a qubit.
pub(in crate::path_machines) fn check(
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

/// Returns the parts of `spans` that lie within `lanes`.
fn part_of_spans<'a>(spans: &[PixelLanes<'a>], lanes: Range<usize>) -> Vec<PixelLanes<'a>> {
    let mut first = 0;
    let parts = spans.iter().map(|span| {
        let end = first + span.lanes;
        let part = first.max(lanes.start)..end.min(lanes.end);
        first = end;
        PixelLanes {
            lanes: part.len(),
            parameters: span.parameters,
        }
    });
    parts.filter(|span| span.lanes > 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_its_lanes_alone() {
        let words: [&[u64]; 3] = [&[1], &[2], &[3]];
        let of = |lanes: [usize; 3]| {
            let spans = lanes.into_iter().zip(words);
            let spans = spans.filter(|(lanes, _)| *lanes > 0);
            let spans = spans.map(|(lanes, parameters)| PixelLanes { lanes, parameters });
            spans.collect::<Vec<_>>()
        };
        let all = of([3, 4, 1]);
        assert_eq!(part_of_spans(&all, 0..8), all);
        assert_eq!(part_of_spans(&all, 0..3), of([3, 0, 0]));
        assert_eq!(part_of_spans(&all, 2..4), of([1, 1, 0]));
        assert_eq!(part_of_spans(&all, 4..6), of([0, 2, 0]));
        assert_eq!(part_of_spans(&all, 6..8), of([0, 1, 1]));
    }
}
