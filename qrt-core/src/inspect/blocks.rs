//! Costs by block.

use super::{Inspection, Part, sum};
use crate::circuit::lower::Cost;
use crate::circuit::{Block, BlockId};

/// A block of the program, and what it costs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockFigures {
    /// Its place in the program's list.
    pub block: BlockId,
    /// The names of the blocks around it and its own, from below the root, each with its depth
    /// where it brings one: `find_intersection 1/plane 3`. The root's is `oracle`.
    pub path: String,
    /// What it is called.
    pub name: String,
    /// The depth it belongs to.
    pub depth: Option<u32>,
    /// Blocks around it.
    pub level: u32,
    /// Of the whole call, without the blocks within it.
    pub own: Cost,
    /// Of the whole call, the blocks within it included.
    pub total: Cost,
    /// [`BlockFigures::total`] in the compute part alone.
    pub compute: Cost,
    /// Qubits of the registers that it computes, the blocks within it included.
    pub width: u64,
}

impl Inspection {
    /// The blocks, each before those within it. The `own` costs of all blocks add up to the total
    /// of the root, which is that of the whole call.
    pub fn blocks(&self) -> Vec<BlockFigures> {
        let blocks = &self.whole.blocks;
        let mut own = vec![[Cost::default(); 2]; blocks.len()];
        let compute = self.instructions(Part::Compute);
        for (at, instruction) in self.whole.instructions.iter().enumerate() {
            let [whole, computed] = &mut own[instruction.block.index()];
            *whole = sum([&*whole, &self.costs[at]]);
            if compute.contains(&at) {
                *computed = sum([&*computed, &self.costs[at]]);
            }
        }
        let mut width = vec![0_u64; blocks.len()];
        for (place, register) in self.whole.registers.iter().enumerate() {
            let id = crate::circuit::RegisterId(place as u32);
            if self.layout.offset(id).is_some() {
                width[register.block.index()] += u64::from(register.width);
            }
        }
        let mut total = own.clone();
        // A block stands behind the one around it in the list.
        for place in (1..blocks.len()).rev() {
            if let Some(parent) = blocks[place].parent {
                let parent = parent.index();
                let inner = total[place];
                for (outer, inner) in total[parent].iter_mut().zip(&inner) {
                    *outer = sum([&*outer, inner]);
                }
                width[parent] += width[place];
            }
        }
        let mut order = Vec::with_capacity(blocks.len());
        let mut within: Vec<Vec<usize>> = vec![Vec::new(); blocks.len()];
        for (place, block) in blocks.iter().enumerate().skip(1) {
            let parent = block.parent.unwrap_or(BlockId::ROOT);
            within[parent.index()].push(place);
        }
        let mut open = vec![(BlockId::ROOT.index(), 0)];
        while let Some((place, level)) = open.pop() {
            order.push((place, level));
            open.extend(within[place].iter().rev().map(|&inner| (inner, level + 1)));
        }
        let figures = order.into_iter().map(|(place, level)| BlockFigures {
            block: BlockId(place as u32),
            path: path(blocks, place),
            name: blocks[place].name.clone(),
            depth: blocks[place].depth,
            level,
            own: own[place][0],
            total: total[place][0],
            compute: total[place][1],
            width: width[place],
        });
        figures.collect()
    }
}

fn path(blocks: &[Block], place: usize) -> String {
    let mut names = Vec::new();
    let mut at = Some(place);
    while let Some(here) = at {
        let block = &blocks[here];
        let parent = block.parent.map(BlockId::index);
        let around = parent.and_then(|parent| blocks[parent].depth);
        match block.depth {
            Some(depth) if around != Some(depth) => names.push(format!("{} {depth}", block.name)),
            _ => names.push(block.name.clone()),
        }
        at = parent;
    }
    if names.len() > 1 {
        names.pop();
    }
    names.reverse();
    names.join("/")
}
