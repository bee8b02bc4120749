//! The order of instructions if qubits cost more than gates: a value is undone soon after its last use.
//!
//! A scope is a list of parts: operations and inner scopes. In addition to the uncomputation at the end of
//! a scope, as in [`super::passes`],
//!
//! - a part runs as late as the parts that read it allow;
//! - a part is undone as soon as the last part that reads it has run, if its inputs are still there and
//!   undoing it costs little (eager cleanup: Parent, Roetteler & Svore, *Reversible circuit compilation
//!   with space constraints*, 2015). Of a chain of equal parts, every other one is undone;
//! - if its inputs are gone, the parts that compute them may be run again, and undone once more. Of a
//!   chain, such as a search's nearest hit so far, one part in three or four stays (Bennett 1989);
//! - a part without garbage whose outputs are all read outside the scope stays as it is, and is not
//!   computed twice.

use super::draft::{Draft, Renamed};
use super::known::{Known, QuickSet, locked};
use super::{Label, StageName, Strategy};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{BlockId, Instruction, RegisterId};
use std::collections::BTreeSet;
use std::sync::Mutex;

/// Least width in qubits of a part that is undone before the end of its scope.
const LEAST_WIDTH: u32 = 8;

/// Most Toffolis for undoing a part, per qubit that it frees. The first limit applies if nothing may be run
/// again for it, the second if parts may be.
const MOST_TOFFOLIS: [u64; 2] = [1000, 3000];

/// The longest chain of parts, each run again for the next one, to undo a part.
const MOST_AGAIN: usize = 2;

/// A part of a scope, before it runs.
#[derive(Clone, Debug)]
enum Item {
    Op(usize),
    Block(BlockId),
}

/// An item that has run.
struct ItemRun {
    instructions: Vec<Instruction>,
    /// Registers that it left: results and copies.
    outputs: Vec<RegisterId>,
    /// True if it left garbage.
    garbage: bool,
    /// Registers of other items that it reads.
    inputs: QuickSet<RegisterId>,
    /// The qubits of its outputs.
    width: u32,
    toffoli: u64,
    undone: bool,
}

struct Scheduler<'a> {
    draft: &'a mut Draft,
    strategy: Strategy,
    items: Vec<Vec<Item>>,
    /// By register: the operations that read it.
    readers: QuickMap<RegisterId, Vec<usize>>,
    /// Registers that stay to the end of the program.
    roots: QuickSet<RegisterId>,
    /// Copies that stand for registers of finished scopes.
    renamed: Renamed,
    /// By copy: its original register.
    originals: QuickMap<RegisterId, RegisterId>,
    /// Toffolis by operation. Copies have no entry.
    toffoli: Vec<u64>,
}

/// Orders the instructions, as [`super::passes::schedule`] does.
pub(super) fn schedule(
    draft: &mut Draft,
    strategy: Strategy,
    roots: &[RegisterId],
    known: &Mutex<Known>,
) -> (Vec<Instruction>, Renamed) {
    let ops = draft.ops.iter().map(|(op, _)| op);
    let figures = locked(known).figures(ops, &draft.registers);
    let mut readers: QuickMap<RegisterId, Vec<usize>> = QuickMap::default();
    let mut items: Vec<Vec<Item>> = vec![Vec::new(); draft.blocks.len()];
    let mut placed: QuickSet<BlockId> = QuickSet::default();
    for (op, (code, block)) in draft.ops.iter().enumerate() {
        for read in code.reads() {
            readers.entry(read).or_default().push(op);
        }
        for pair in draft.ancestors(*block).windows(2) {
            if placed.insert(pair[0]) {
                items[pair[1].index()].push(Item::Block(pair[0]));
            }
        }
        items[block.index()].push(Item::Op(op));
    }
    let mut scheduler = Scheduler {
        draft,
        strategy,
        items,
        readers,
        roots: roots.iter().copied().collect(),
        renamed: Renamed::default(),
        originals: QuickMap::default(),
        toffoli: figures.iter().map(|of| of.costs[0].toffoli).collect(),
    };
    let instructions = scheduler.block(BlockId::ROOT);
    (instructions, scheduler.renamed)
}

/// Appends `second` to `first`. An instruction that follows its own inverse cancels it.
fn join(first: &mut Vec<Instruction>, second: impl IntoIterator<Item = Instruction>) {
    for next in second {
        match first.last() {
            Some(last) if last.op == next.op && last.inverse != next.inverse => {
                first.pop();
            }
            _ => first.push(next),
        }
    }
}

fn inverse(instructions: &[Instruction]) -> impl Iterator<Item = Instruction> {
    instructions.iter().rev().map(|instruction| Instruction {
        inverse: !instruction.inverse,
        ..*instruction
    })
}

impl Scheduler<'_> {
    fn block(&mut self, block: BlockId) -> Vec<Instruction> {
        let items = std::mem::take(&mut self.items[block.index()]);
        let stage = Label::from_block(&self.draft.blocks[block.index()]).stage;
        let parent = self.draft.blocks[block.index()].parent;
        let is_scope = self.strategy.is_scope(stage);
        let parent = is_scope.then_some(parent.unwrap_or(BlockId::ROOT));
        let chains = [
            StageName::Oracle,
            StageName::FindIntersection,
            StageName::Shadow,
        ];
        let again = self.strategy.runs_again() && chains.contains(&stage);
        self.scope(items, block, parent, again)
    }

    /// Appends the operations of `item` to `all`.
    fn operations(&self, item: &Item, all: &mut Vec<usize>) {
        match item {
            Item::Op(op) => all.push(*op),
            Item::Block(block) => {
                for item in &self.items[block.index()] {
                    self.operations(item, all);
                }
            }
        }
    }

    /// The items, each as late as its readers allow, and a map from each operation to its item's place.
    fn sunk(&self, items: Vec<Item>) -> (Vec<Item>, QuickMap<usize, usize>) {
        let operations: Vec<Vec<usize>> = items
            .iter()
            .map(|item| {
                let mut all = Vec::new();
                self.operations(item, &mut all);
                all
            })
            .collect();
        let mut item_of: QuickMap<usize, usize> = QuickMap::default();
        for (item, operations) in operations.iter().enumerate() {
            item_of.extend(operations.iter().map(|&op| (op, item)));
        }
        let mut order: Vec<usize> = Vec::with_capacity(items.len());
        for item in (0..items.len()).rev() {
            let targets = operations[item].iter();
            let targets = targets.flat_map(|&op| self.draft.ops[op].0.targets());
            let read_by: QuickSet<usize> = targets
                .filter_map(|target| self.readers.get(&target))
                .flatten()
                .filter_map(|reader| item_of.get(reader).copied())
                .filter(|&reader| reader != item)
                .collect();
            let place = order.iter().position(|later| read_by.contains(later));
            order.insert(place.unwrap_or(0), item);
        }
        let mut places = vec![0; items.len()];
        for (place, &item) in order.iter().enumerate() {
            places[item] = place;
        }
        let item_of = item_of.into_iter();
        let place_of = item_of.map(|(op, item)| (op, places[item])).collect();
        let mut items: Vec<Option<Item>> = items.into_iter().map(Some).collect();
        let sunk = order.iter().filter_map(|&item| items[item].take());
        (sunk.collect(), place_of)
    }

    /// Returns the instructions of `items`, which belong to `block`. If there is a `parent`, the items are
    /// a scope within it and leave only the results that are read outside. If `again`, parts may be run
    /// again to undo others.
    fn scope(
        &mut self,
        items: Vec<Item>,
        block: BlockId,
        parent: Option<BlockId>,
        again: bool,
    ) -> Vec<Instruction> {
        let (items, place_of) = self.sunk(items);
        let last = items.len().saturating_sub(1);
        let mut parts: Vec<ItemRun> = Vec::with_capacity(items.len());
        // The parts in the order in which they are run, or undone.
        let mut steps: Vec<(usize, bool)> = Vec::new();
        for (place, item) in items.into_iter().enumerate() {
            let instructions = match item {
                Item::Op(op) => {
                    let renamed = |read| self.renamed.get(&read).copied().unwrap_or(read);
                    let at = &mut self.draft.ops[op].0;
                    *at = at.clone().map(renamed, |computed| computed);
                    vec![Instruction {
                        op: op as u32,
                        inverse: false,
                        block,
                    }]
                }
                Item::Block(inner) => self.block(inner),
            };
            let part = self.part(instructions);
            parts.push(part);
            steps.push((place, false));
            if place < last {
                self.clean_up(&mut parts, &mut steps, &place_of, again);
            }
        }
        let mut forward = Vec::new();
        for &(place, undone) in &steps {
            let part = &parts[place].instructions;
            if undone {
                join(&mut forward, inverse(part));
            } else {
                join(&mut forward, part.iter().copied());
            }
        }
        let Some(parent) = parent else {
            return forward;
        };
        let mut stays = vec![false; parts.len()];
        let mut copied = Vec::new();
        for (part, stays) in parts
            .iter()
            .zip(&mut stays)
            .filter(|(part, _)| !part.undone)
        {
            let outside = |register: &RegisterId| self.is_read_outside(*register, &place_of);
            let (read, unread): (Vec<RegisterId>, Vec<RegisterId>) =
                part.outputs.iter().partition(|register| outside(register));
            *stays = unread.is_empty() && !part.garbage;
            if !*stays {
                copied.extend(read);
            }
        }
        for register in copied {
            let copy = self.copy(register, parent);
            forward.push(copy);
        }
        for &(place, undone) in steps.iter().rev().filter(|(place, _)| !stays[*place]) {
            let part = &parts[place].instructions;
            if undone {
                join(&mut forward, part.iter().copied());
            } else {
                join(&mut forward, inverse(part));
            }
        }
        forward
    }

    fn part(&self, instructions: Vec<Instruction>) -> ItemRun {
        let mut outputs: Vec<RegisterId> = Vec::new();
        let mut garbage = 0;
        let mut inputs: QuickSet<RegisterId> = QuickSet::default();
        let mut own: QuickSet<RegisterId> = QuickSet::default();
        let mut toffoli = 0;
        for instruction in &instructions {
            let op = &self.draft.ops[instruction.op as usize].0;
            let width = |id: RegisterId| self.draft.registers[id.index()].width;
            inputs.extend(op.reads());
            own.extend(op.targets());
            let left = op.scratch().map_or(0, |scratch| i64::from(width(scratch)));
            if instruction.inverse {
                let targets = op.targets();
                outputs.retain(|output| !targets.contains(output));
                garbage -= left;
            } else {
                outputs.extend(op.targets());
                garbage += left;
            }
            let cost = self.toffoli.get(instruction.op as usize);
            toffoli += cost.copied().unwrap_or(0);
        }
        let width = |id: &RegisterId| self.draft.registers[id.index()].width;
        ItemRun {
            width: outputs.iter().map(width).sum(),
            inputs: inputs.difference(&own).copied().collect(),
            outputs,
            garbage: garbage > 0,
            instructions,
            toffoli,
            undone: false,
        }
    }

    /// Undoes parts that no later part reads, the latest parts first.
    fn clean_up(
        &self,
        parts: &mut [ItemRun],
        steps: &mut Vec<(usize, bool)>,
        place_of: &QuickMap<usize, usize>,
        again: bool,
    ) {
        let now = parts.len() - 1;
        let undone = parts.iter().enumerate().filter(|(_, part)| part.undone);
        // By register: the part that left it, if that part is undone.
        let mut gone: QuickMap<RegisterId, usize> = undone
            .flat_map(|(place, part)| part.outputs.iter().map(move |output| (*output, place)))
            .collect();
        for place in (0..parts.len()).rev() {
            let part = &parts[place];
            let idle = || {
                self.last_read(part, place_of)
                    .is_some_and(|read| read <= now)
            };
            if part.undone || part.width < LEAST_WIDTH || !idle() {
                continue;
            }
            let mut needed = BTreeSet::new();
            let depth = if again { MOST_AGAIN } else { 0 };
            if !find_again(parts, &gone, part, depth, &mut needed) {
                continue;
            }
            let more = needed.iter().map(|&place| 2 * parts[place].toffoli);
            let most = MOST_TOFFOLIS[usize::from(again)] * u64::from(part.width);
            if part.toffoli + more.sum::<u64>() > most {
                continue;
            }
            steps.extend(needed.iter().map(|&place| (place, false)));
            steps.push((place, true));
            steps.extend(needed.iter().rev().map(|&place| (place, true)));
            gone.extend(part.outputs.iter().map(|output| (*output, place)));
            parts[place].undone = true;
        }
    }

    /// The original of `register`, which is itself if it is no copy.
    fn original(&self, register: RegisterId) -> RegisterId {
        self.originals.get(&register).copied().unwrap_or(register)
    }

    fn is_read_outside(&self, register: RegisterId, place_of: &QuickMap<usize, usize>) -> bool {
        let original = self.original(register);
        let mut readers = self.readers.get(&original).into_iter().flatten();
        self.roots.contains(&original) || readers.any(|reader| !place_of.contains_key(reader))
    }

    /// The place of the last item of a scope that reads an output of `part`; none if one is read outside.
    fn last_read(&self, part: &ItemRun, place_of: &QuickMap<usize, usize>) -> Option<usize> {
        let mut last = 0;
        for output in &part.outputs {
            let original = self.original(*output);
            if self.roots.contains(&original) {
                return None;
            }
            for reader in self.readers.get(&original).into_iter().flatten() {
                last = last.max(*place_of.get(reader)?);
            }
        }
        Some(last)
    }

    fn copy(&mut self, register: RegisterId, parent: BlockId) -> Instruction {
        let original = self.original(register);
        let (id, instruction) = self.draft.copy(register, parent);
        self.originals.insert(id, original);
        self.renamed.insert(original, id);
        instruction
    }
}

/// Adds to `needed` the parts that have to run again before `part` can be undone. It follows chains of at
/// most `depth` parts, and returns false if that is not enough.
fn find_again(
    parts: &[ItemRun],
    gone: &QuickMap<RegisterId, usize>,
    part: &ItemRun,
    depth: usize,
    needed: &mut BTreeSet<usize>,
) -> bool {
    let missing: BTreeSet<usize> = part
        .inputs
        .iter()
        .filter_map(|input| gone.get(input).copied())
        .collect();
    missing.into_iter().all(|place| {
        needed.contains(&place)
            || depth > 0
                && find_again(parts, gone, &parts[place], depth - 1, needed)
                && needed.insert(place)
    })
}
