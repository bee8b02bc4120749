//! Costs by block.

use super::{CallPart, Inspection};
use crate::compile::Label;
use qrt_circuit::lower::Cost;
use qrt_circuit::{Block, BlockId, RegisterId};
use std::collections::HashMap;
use std::ops::Range;

/// A block of the program, and its cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockFigures {
    /// The block's index in the program's list. If several blocks within the same block have one
    /// name, the first one's index.
    pub block: BlockId,
    /// The block's path: the names of the blocks around it and its own, from below the root. Each
    /// has its bounce, if there is one: `find_intersection 1/plane 3`. The root's is `oracle`.
    pub path: String,
    /// The block's stage and the bounce that it belongs to.
    pub label: Label,
    /// Number of blocks around it: 0 for the root.
    pub level: u32,
    /// The block's cost in the whole call, without its inner blocks.
    pub own: Cost,
    /// The block's cost in the whole call, its inner blocks included.
    pub total: Cost,
    /// [`BlockFigures::total`] in the compute part alone.
    pub compute: Cost,
    /// Qubits of the registers that it computes, its inner blocks included.
    pub width: u64,
}

impl Inspection {
    /// The [`BlockFigures::block`] that has the costs of each block, by the block's place in the program's list.
    pub fn merged_blocks(&self) -> Vec<BlockId> {
        let (one, _) = merged(&self.whole.blocks);
        one.into_iter().map(|first| BlockId(first as u32)).collect()
    }

    /// The cost of some instructions, by [`BlockFigures::block`]: that of each block with any of them, its
    /// inner blocks included.
    pub fn blocks_in(&self, instructions: Range<usize>) -> HashMap<BlockId, Cost> {
        let blocks = &self.whole.blocks;
        let (one, _) = merged(blocks);
        let mut costs: HashMap<BlockId, Cost> = HashMap::new();
        for at in instructions {
            let mut place = Some(one[self.whole.instructions[at].block.index()]);
            while let Some(block) = place {
                let cost = costs.entry(BlockId(block as u32)).or_default();
                *cost = *cost + self.costs[at];
                place = blocks[block].parent.map(|parent| one[parent.index()]);
            }
        }
        costs
    }

    /// The blocks, each before its inner blocks. Blocks of one name within one block are merged: a
    /// search may pass a plane twice. The `own` costs of all blocks add up to the total of the
    /// root, the cost of the whole call.
    pub fn blocks(&self) -> Vec<BlockFigures> {
        let blocks = &self.whole.blocks;
        let (one, within) = merged(blocks);
        let mut own = vec![[Cost::default(); 2]; blocks.len()];
        let compute = self.instructions(CallPart::Compute);
        for (at, instruction) in self.whole.instructions.iter().enumerate() {
            let [whole, computed] = &mut own[one[instruction.block.index()]];
            *whole = *whole + self.costs[at];
            if compute.contains(&at) {
                *computed = *computed + self.costs[at];
            }
        }
        let mut width = vec![0_u64; blocks.len()];
        for (place, register) in self.whole.registers.iter().enumerate() {
            if self.layout.offset(RegisterId(place as u32)).is_some() {
                width[one[register.block.index()]] += u64::from(register.width);
            }
        }
        let mut total = own.clone();
        // In the list, a block comes after the block around it.
        for place in (1..blocks.len()).rev() {
            if let Some(parent) = blocks[place].parent
                && one[place] == place
            {
                let parent = one[parent.index()];
                let inner = total[place];
                for (outer, inner) in total[parent].iter_mut().zip(inner) {
                    *outer = *outer + inner;
                }
                width[parent] += width[place];
            }
        }
        let mut order = Vec::with_capacity(blocks.len());
        let mut open = vec![(BlockId::ROOT.index(), 0)];
        while let Some((place, level)) = open.pop() {
            order.push((place, level));
            let inner = within[place].iter().rev();
            open.extend(inner.map(|&inner| (inner, level + 1)));
        }
        let figures = order.into_iter().map(|(place, level)| BlockFigures {
            block: BlockId(place as u32),
            path: path(blocks, place),
            label: Label::from_block(&blocks[place]),
            level,
            own: own[place][0],
            total: total[place][0],
            compute: total[place][1],
            width: width[place],
        });
        figures.collect()
    }
}

/// For each block, the first of its name within the same block, and the list of its inner blocks.
fn merged(blocks: &[Block]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut one: Vec<usize> = Vec::with_capacity(blocks.len());
    let mut within = vec![Vec::new(); blocks.len()];
    let mut known: HashMap<(usize, Label), usize> = HashMap::new();
    for (place, block) in blocks.iter().enumerate() {
        let Some(parent) = block.parent else {
            one.push(place);
            continue;
        };
        let parent = one[parent.index()];
        let first = *known
            .entry((parent, Label::from_block(block)))
            .or_insert(place);
        if first == place {
            within[parent].push(place);
        }
        one.push(first);
    }
    (one, within)
}

fn path(blocks: &[Block], place: usize) -> String {
    let mut names = Vec::new();
    let mut at = Some(place);
    while let Some(here) = at {
        let Label { stage, depth } = Label::from_block(&blocks[here]);
        let parent = blocks[here].parent.map(BlockId::index);
        let around = parent.and_then(|parent| Label::from_block(&blocks[parent]).depth);
        match depth {
            Some(depth) if around != Some(depth) => names.push(format!("{stage} {depth}")),
            _ => names.push(stage.to_string()),
        }
        at = parent;
    }
    if names.len() > 1 {
        names.pop();
    }
    names.reverse();
    names.join("/")
}
