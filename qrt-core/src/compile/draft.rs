//! The draft of a program: the data that passes work on.

use super::known::{Known, locked};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Block, BlockId, Instruction, Op, Register, RegisterId, Word};
use std::sync::Mutex;

/// The data that passes work on.
#[derive(Clone, Debug, Default)]
pub(super) struct Draft {
    pub(super) registers: Vec<Register>,
    pub(super) blocks: Vec<Block>,
    pub(super) ops: Vec<(Op, BlockId)>,
}

/// Maps a recorded register to the copy that replaces it.
pub(super) type Renamed = QuickMap<RegisterId, RegisterId>;

impl Draft {
    /// Creates a copy of `register` in `parent`. Returns the copy and the instruction that makes it.
    pub(super) fn copy(
        &mut self,
        register: RegisterId,
        parent: BlockId,
    ) -> (RegisterId, Instruction) {
        let original = self.registers[register.index()].clone();
        let a = Word {
            register,
            offset: 0,
            width: original.width,
            signed: false,
            shift: 0,
        };
        let id = RegisterId(self.registers.len() as u32);
        self.registers.push(Register {
            name: format!("{}'", original.name),
            block: parent,
            ..original
        });
        self.ops.push((Op::Copy { a, target: id }, parent));
        let instruction = Instruction {
            op: self.ops.len() as u32 - 1,
            inverse: false,
            block: parent,
        };
        (id, instruction)
    }

    /// Blocks from `block` to the root.
    pub(super) fn ancestors(&self, block: BlockId) -> Vec<BlockId> {
        let mut path = vec![block];
        let mut at = block;
        while let Some(parent) = self.blocks[at.index()].parent {
            path.push(parent);
            at = parent;
        }
        path
    }

    /// The child of `above` that contains `block`; none if `above` is `block`.
    pub(super) fn child_towards(&self, above: BlockId, block: BlockId) -> Option<BlockId> {
        let path = self.ancestors(block);
        let place = path.iter().position(|&b| b == above)?;
        place.checked_sub(1).map(|below| path[below])
    }

    /// Gives every garbage register the width that its operation needs.
    pub(super) fn size_scratch(&mut self, known: &Mutex<Known>) {
        let ops = self.ops.iter().map(|(op, _)| op);
        let ops = ops.filter(|op| op.scratch().is_some());
        let figures = locked(known).figures(ops.clone(), &self.registers);
        for (scratch, figures) in ops.filter_map(Op::scratch).zip(figures) {
            self.registers[scratch.index()].width = figures.scratch;
        }
    }
}
