//! The readings of an oracle's program, which share no code: on integers, and gate by gate
//! ([`super::through_gates`]).

use super::{Defect, OracleBlock, OracleCircuits, word_of};
use crate::path_machines::pool::Pool;
use qrt_circuit::{Operand, Program, Word};
use qrt_core::oracle::Oracle;
use qrt_machines::{FixedLanes, FixedMachine, GatesMachine, InstructionSet, PixelLanes};
use std::sync::atomic::AtomicBool;

/// Runs an oracle's program on blocks of paths.
pub(super) trait Reading: Send + Sync {
    /// Number of paths that run together. A multiple of it leaves no lanes idle.
    fn paths_at_once(&self) -> usize;

    /// The largest number of paths of a block.
    fn block_length(&self) -> usize;

    /// Runs a block's paths, each run of which has a span, and sets the values of those of `outputs`
    /// that are registers.
    ///
    /// # Errors
    /// The first defect found; [`Defect::Cancelled`].
    fn run(
        &self,
        oracle: &Oracle,
        outputs: &[Operand],
        block: &mut OracleBlock,
        spans: (&[PixelLanes<'_>], Option<&AtomicBool>),
    ) -> Result<(), Defect>;

    /// Prepares for outputs that are `words`.
    fn read_words(&mut self, program: &Program, words: &[Word]);

    /// The parts of the circuit, if the reading runs one.
    fn circuits(&self) -> Option<&OracleCircuits> {
        None
    }
}

/// The reading on lanes of integers.
pub(super) struct FixedReading {
    fixed: FixedMachine,
    lanes: Pool<FixedLanes>,
}

impl FixedReading {
    pub(super) fn new(program: &Program, words: &[Word], instructions: InstructionSet) -> Self {
        Self {
            fixed: FixedMachine::new(program, words).with_instructions(instructions),
            lanes: Pool::new(),
        }
    }
}

impl Reading for FixedReading {
    fn paths_at_once(&self) -> usize {
        GatesMachine::LANES
    }

    fn block_length(&self) -> usize {
        FixedMachine::LANES
    }

    fn run(
        &self,
        oracle: &Oracle,
        outputs: &[Operand],
        block: &mut OracleBlock,
        (spans, _): (&[PixelLanes<'_>], Option<&AtomicBool>),
    ) -> Result<(), Defect> {
        let count = block.ids.len();
        let zeros = vec![0; count];
        let wanted = outputs.iter().zip(&mut block.values);
        let wanted = wanted.filter(|(output, _)| word_of(**output).is_some());
        let mut wanted: Vec<&mut [i64]> = wanted.map(|(_, values)| &mut values[..count]).collect();
        let inputs = [&block.ids, &zeros, &block.hits].map(Vec::as_slice);
        let inputs = &inputs[..2 + usize::from(oracle.nearest.is_some())];
        self.lanes.lend(
            || self.fixed.lanes(),
            |lanes| {
                self.fixed.run(lanes, inputs, spans, &mut wanted);
                Ok(())
            },
        )
    }

    fn read_words(&mut self, program: &Program, words: &[Word]) {
        self.fixed = FixedMachine::new(program, words);
        self.lanes = Pool::new();
    }
}
