//! The stages of the paper's Path Tracing frame, found in the order of a program's instructions.

use super::Inspection;
use crate::compile::{Label, StageName};
use qrt_circuit::lower::Cost;
use qrt_circuit::{BlockId, Op};
use std::fmt;
use std::ops::Range;

/// A part of one call of the oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CallPart {
    /// Computes the colour from the path index.
    Compute,
    /// Compares the colour with the comparator, flips the phase, and uncomputes the comparison.
    Flip,
    /// Uncomputes the results of the compute part.
    Uncompute,
}

impl CallPart {
    /// All parts, in the order in which they run.
    pub const ALL: [Self; 3] = [Self::Compute, Self::Flip, Self::Uncompute];

    /// The part's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute",
            Self::Flip => "compare and flip",
            Self::Uncompute => "uncompute",
        }
    }
}

/// A stage of the oracle: a run of instructions that belong together, and a box of the paper's
/// figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallStage {
    /// The part of the call.
    pub part: CallPart,
    /// The name of the stage's block, or [`StageName::Surface`], [`StageName::Compare`],
    /// [`StageName::Flip`].
    pub name: StageName,
    /// The bounce that the stage belongs to, 0 for the primary ray; none for a stage of no ray.
    pub depth: Option<u32>,
    /// The stage's block; none for instructions between blocks. The frame's few instructions after
    /// other blocks, such as those that end a path, are counted with these blocks.
    pub block: Option<BlockId>,
    /// True if the stage is the inverse of another.
    pub inverse: bool,
    /// The range of the call's instructions that belong to the stage.
    pub instructions: Range<usize>,
    /// The cost of the instructions in gates.
    pub cost: Cost,
    /// The most qubits in use while the stage runs.
    pub qubits: u32,
}

impl fmt::Display for CallStage {
    /// Writes a name like `find_intersection 1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.name.fmt(f)?;
        match self.depth {
            Some(depth) => write!(f, " {depth}"),
            None => Ok(()),
        }
    }
}

impl Inspection {
    /// The stages, in the order in which they run. Each instruction of the call belongs to one
    /// stage.
    pub fn stages(&self) -> Vec<CallStage> {
        let mut stages: Vec<CallStage> = Vec::new();
        for (block, instructions) in self.runs() {
            let (name, depth) = match (block, stages.last_mut()) {
                (Some(block), _) => {
                    let label = Label::from_block(&self.whole.blocks[block.index()]);
                    (label.stage, label.depth)
                }
                (None, Some(before)) if before.name == StageName::FindIntersection => {
                    (StageName::Surface, before.depth)
                }
                (None, Some(before)) => {
                    let (name, depth) = (before.name, before.depth);
                    let both = before.instructions.start..instructions.end;
                    *before = CallStage {
                        depth,
                        block: before.block,
                        ..self.stage(CallPart::Compute, name, both)
                    };
                    continue;
                }
                (None, None) => (StageName::Frame, None),
            };
            stages.push(CallStage {
                depth,
                block,
                ..self.stage(CallPart::Compute, name, instructions)
            });
        }
        let computed = stages.len();
        for at in self.instructions(CallPart::Flip) {
            let instruction = self.whole.instructions[at];
            let name = match self.whole.ops[instruction.op as usize] {
                Op::Phase { .. } => StageName::Flip,
                _ => StageName::Compare,
            };
            let mut stage = self.stage(CallPart::Flip, name, at..at + 1);
            stage.block = Some(instruction.block);
            stage.inverse = instruction.inverse;
            stages.push(stage);
        }
        let end = self.whole.instructions.len();
        for place in (0..computed).rev() {
            let Range { start, end: after } = stages[place].instructions;
            let name = stages[place].name;
            let stage = self.stage(CallPart::Uncompute, name, end - after..end - start);
            stages.push(CallStage {
                depth: stages[place].depth,
                block: stages[place].block,
                inverse: true,
                ..stage
            });
        }
        stages
    }

    fn stage(&self, part: CallPart, name: StageName, instructions: Range<usize>) -> CallStage {
        CallStage {
            part,
            name,
            depth: None,
            block: None,
            inverse: false,
            cost: self.cost(instructions.clone()),
            qubits: self.peak(instructions.clone()),
            instructions,
        }
    }

    /// Runs of instructions of one block below the root in the compute part. The copies that a
    /// scope leaves are charged to the block around it, but belong to the run.
    fn runs(&self) -> Vec<(Option<BlockId>, Range<usize>)> {
        let mut runs: Vec<(Option<BlockId>, Range<usize>)> = Vec::new();
        for at in self.instructions(CallPart::Compute) {
            let block = self.below_root(self.whole.instructions[at].block);
            match runs.as_mut_slice() {
                [.., (last, range)] if *last == block => range.end = at + 1,
                [.., (before, range), (None, between)]
                    if *before == block && self.copies(between.clone()) =>
                {
                    range.end = at + 1;
                    runs.pop();
                }
                _ => runs.push((block, at..at + 1)),
            }
        }
        runs
    }

    fn copies(&self, instructions: Range<usize>) -> bool {
        self.whole.instructions[instructions]
            .iter()
            .all(|instruction| matches!(self.whole.ops[instruction.op as usize], Op::Copy { .. }))
    }

    /// The child of the root that is `block` or contains it; none for the root.
    fn below_root(&self, block: BlockId) -> Option<BlockId> {
        let mut at = block;
        loop {
            match self.whole.blocks[at.index()].parent {
                None => return None,
                Some(BlockId::ROOT) => return Some(at),
                Some(parent) => at = parent,
            }
        }
    }
}
