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
    /// The same draft, with registers and blocks that have no names.
    pub(super) fn without_names(&self) -> Self {
        let register = |register: &Register| Register {
            name: String::new(),
            ..*register
        };
        let block = |block: &Block| Block {
            name: String::new(),
            ..*block
        };
        Self {
            registers: self.registers.iter().map(register).collect(),
            blocks: self.blocks.iter().map(block).collect(),
            ops: self.ops.clone(),
        }
    }

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

/// The registers that each operation of a draft reads and computes, in two lists.
#[derive(Debug, Default)]
pub(super) struct Wires {
    reads: Vec<RegisterId>,
    targets: Vec<RegisterId>,
    /// By operation: the ends of its parts of the two lists.
    ends: Vec<[usize; 2]>,
    scratch: Vec<Option<RegisterId>>,
}

impl Wires {
    pub(super) fn new(draft: &Draft) -> Self {
        let mut wires = Self::default();
        for (op, _) in &draft.ops {
            wires.push(op);
        }
        wires
    }

    /// Appends the registers of the next operation.
    pub(super) fn push(&mut self, op: &Op) {
        op.each_read(&mut |register| self.reads.push(*register));
        op.each_target(|register| self.targets.push(register));
        self.ends.push([self.reads.len(), self.targets.len()]);
        self.scratch.push(op.scratch());
    }

    fn start(&self, op: usize) -> [usize; 2] {
        op.checked_sub(1).map_or([0, 0], |before| self.ends[before])
    }

    pub(super) fn reads(&self, op: usize) -> &[RegisterId] {
        &self.reads[self.start(op)[0]..self.ends[op][0]]
    }

    pub(super) fn reads_mut(&mut self, op: usize) -> &mut [RegisterId] {
        let start = self.start(op)[0];
        &mut self.reads[start..self.ends[op][0]]
    }

    pub(super) fn targets(&self, op: usize) -> &[RegisterId] {
        &self.targets[self.start(op)[1]..self.ends[op][1]]
    }

    /// The register of the operation's garbage.
    pub(super) fn scratch(&self, op: usize) -> Option<RegisterId> {
        self.scratch[op]
    }
}

/// The part of a program that reads a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// No operation reads it.
    Unread,
    /// The innermost block that contains all operations that read it.
    Within(BlockId),
    /// It stays to the end of the program.
    End,
}

impl Draft {
    /// By register: its reach. `roots` stay to the end.
    pub(super) fn reaches(&self, wires: &Wires, roots: &[RegisterId]) -> Vec<Reach> {
        let mut all = vec![Reach::Unread; self.registers.len()];
        for root in roots {
            all[root.index()] = Reach::End;
        }
        for (place, (_, block)) in self.ops.iter().enumerate() {
            for read in wires.reads(place) {
                let reach = &mut all[read.index()];
                *reach = match *reach {
                    Reach::Unread => Reach::Within(*block),
                    Reach::Within(other) => Reach::Within(self.common(other, *block)),
                    Reach::End => Reach::End,
                };
            }
        }
        all
    }

    /// The innermost block that contains two blocks. A block has a greater number than its parent.
    fn common(&self, mut a: BlockId, mut b: BlockId) -> BlockId {
        while a != b {
            let inner = if a.0 > b.0 { &mut a } else { &mut b };
            *inner = self.blocks[inner.index()].parent.unwrap_or(BlockId::ROOT);
        }
        a
    }

    /// True if operations outside `block`, or the program's end, read what has this reach.
    pub(super) fn is_read_outside(&self, reach: Reach, block: BlockId) -> bool {
        match reach {
            Reach::Unread => false,
            Reach::Within(inner) => self.common(inner, block) != block,
            Reach::End => true,
        }
    }
}
