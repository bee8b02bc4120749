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

use super::draft::{Draft, Reach, Renamed, Wires};
use super::known::{Known, locked};
use super::queue::Queue;
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
    inputs: Vec<RegisterId>,
    /// The qubits of its outputs.
    width: u32,
    toffoli: u64,
    undone: bool,
}

/// The parts of a scope, in the order in which they were first run.
#[derive(Default)]
struct Parts {
    /// The number of this scope.
    scope: u32,
    all: Vec<ItemRun>,
    /// The parts in the order in which they are run, or undone.
    steps: Vec<(usize, bool)>,
    /// By place: the parts whose last reader stands there.
    idle: Vec<Vec<usize>>,
    /// Parts without later readers that could not be undone when this number of parts was.
    stuck: Vec<(usize, usize)>,
    /// Number of parts that are undone.
    undone: usize,
}

struct Scheduler<'a> {
    draft: &'a mut Draft,
    strategy: Strategy,
    items: Vec<Vec<Item>>,
    wires: Wires,
    /// By register: the operations that read it, in one list, and the end of each part of the list.
    readers: Vec<u32>,
    reader_ends: Vec<usize>,
    /// By register, except copies: the part of the program that reads it.
    reaches: Vec<Reach>,
    /// By operation, and by block: its place among the items of its block, or of its parent.
    places: [Vec<usize>; 2],
    /// Copies that stand for registers of finished scopes.
    renamed: Renamed,
    /// By copy: its original register.
    originals: QuickMap<RegisterId, RegisterId>,
    /// Toffolis by operation. Copies have no entry.
    toffoli: Vec<u64>,
    /// By register: the part of a scope that left it and is undone, with the scope's number.
    gone: Vec<(u32, usize)>,
    /// Number of scopes so far.
    scopes: u32,
    /// By register: the last instruction of a part that computed it, while the part is summed up.
    computed: Vec<u32>,
    /// By register: the last part that computed it, and the last one that read it.
    seen: [Vec<u32>; 2],
    /// Number of parts so far.
    parts: u32,
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
    let wires = Wires::new(draft);
    let mut items: Vec<Vec<Item>> = vec![Vec::new(); draft.blocks.len()];
    let mut placed = vec![false; draft.blocks.len()];
    for (op, (_, block)) in draft.ops.iter().enumerate() {
        let mut at = *block;
        while let Some(parent) = draft.blocks[at.index()].parent
            && !std::mem::replace(&mut placed[at.index()], true)
        {
            items[parent.index()].push(Item::Block(at));
            at = parent;
        }
        items[block.index()].push(Item::Op(op));
    }
    let (readers, reader_ends) = readers(draft, &wires);
    let registers = draft.registers.len();
    let mut scheduler = Scheduler {
        strategy,
        items,
        readers,
        reader_ends,
        reaches: draft.reaches(&wires, roots),
        places: [vec![0; draft.ops.len()], vec![0; draft.blocks.len()]],
        wires,
        renamed: Renamed::default(),
        originals: QuickMap::default(),
        toffoli: figures.iter().map(|of| of.costs[0].toffoli).collect(),
        gone: vec![(0, 0); registers],
        scopes: 0,
        computed: vec![0; registers],
        seen: [vec![0; registers], vec![0; registers]],
        parts: 0,
        draft,
    };
    let instructions = scheduler.block(BlockId::ROOT);
    (instructions, scheduler.renamed)
}

/// By register: the operations that read it, in one list, and the end of each part of the list.
fn readers(draft: &Draft, wires: &Wires) -> (Vec<u32>, Vec<usize>) {
    let mut ends = vec![0; draft.registers.len()];
    for op in 0..draft.ops.len() {
        for read in wires.reads(op) {
            ends[read.index()] += 1;
        }
    }
    let mut total = 0;
    for end in &mut ends {
        total += std::mem::replace(end, total);
    }
    let mut readers = vec![0; total];
    for op in 0..draft.ops.len() {
        for read in wires.reads(op) {
            let end = &mut ends[read.index()];
            readers[*end] = op as u32;
            *end += 1;
        }
    }
    (readers, ends)
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
        self.scope(&items, block, parent, again)
    }

    /// The operations that read `register`, which is no copy.
    fn readers(&self, register: RegisterId) -> &[u32] {
        let at = register.index();
        let start = at
            .checked_sub(1)
            .map_or(0, |before| self.reader_ends[before]);
        &self.readers[start..self.reader_ends[at]]
    }

    /// The place of the item of `block` that contains `op`; none if the operation is outside.
    fn place(&self, op: u32, block: BlockId) -> Option<usize> {
        let op = op as usize;
        let mut at = self.draft.ops[op].1;
        if at == block {
            return Some(self.places[0][op]);
        }
        // A block has a greater number than its parent.
        while at.0 > block.0 {
            let parent = self.draft.blocks[at.index()].parent?;
            if parent == block {
                return Some(self.places[1][at.index()]);
            }
            at = parent;
        }
        None
    }

    /// Calls `see` with each operation of `item`.
    fn operations(&self, item: &Item, see: &mut impl FnMut(usize)) {
        match item {
            Item::Op(op) => see(*op),
            Item::Block(block) => {
                for item in &self.items[block.index()] {
                    self.operations(item, see);
                }
            }
        }
    }

    /// The items of `block`, each as late as its readers allow. Sets their places.
    fn sunk(&mut self, items: &[Item], block: BlockId) -> Vec<Item> {
        let order: Vec<usize> = (0..items.len()).collect();
        self.set_places(items, &order);
        let mut queue = Queue::new(items.len());
        for (number, item) in items.iter().enumerate().rev() {
            let mut first = None;
            self.operations(item, &mut |op| {
                for target in self.wires.targets(op) {
                    for &reader in self.readers(*target) {
                        // A block stands at its first operation, which may be before what it reads.
                        let reader = self.place(reader, block);
                        let Some(reader) = reader.filter(|reader| *reader > number) else {
                            continue;
                        };
                        let place = queue.place(reader);
                        if first.is_none_or(|(_, first)| place < first) {
                            first = Some((reader, place));
                        }
                    }
                }
            });
            queue.insert(number, first.map(|(reader, _)| reader));
        }
        let order: Vec<usize> = queue.items().collect();
        self.set_places(items, &order);
        order.iter().map(|&item| items[item].clone()).collect()
    }

    /// Sets the places of the items in `order`.
    fn set_places(&mut self, items: &[Item], order: &[usize]) {
        for (place, &item) in order.iter().enumerate() {
            match items[item] {
                Item::Op(op) => self.places[0][op] = place,
                Item::Block(inner) => self.places[1][inner.index()] = place,
            }
        }
    }

    /// Returns the instructions of `items`, which belong to `block`. If there is a `parent`, the items are
    /// a scope within it and leave only the results that are read outside. If `again`, parts may be run
    /// again to undo others.
    fn scope(
        &mut self,
        items: &[Item],
        block: BlockId,
        parent: Option<BlockId>,
        again: bool,
    ) -> Vec<Instruction> {
        let items = self.sunk(items, block);
        let last = items.len().saturating_sub(1);
        self.scopes += 1;
        let mut parts = Parts {
            scope: self.scopes,
            idle: vec![Vec::new(); items.len()],
            ..Parts::default()
        };
        for (place, item) in items.into_iter().enumerate() {
            let instructions = match item {
                Item::Op(op) => {
                    self.rename(op);
                    vec![Instruction {
                        op: op as u32,
                        inverse: false,
                        block,
                    }]
                }
                Item::Block(inner) => self.block(inner),
            };
            let part = self.part(instructions);
            if part.width >= LEAST_WIDTH
                && let Some(read) = self.last_read(&part, block)
            {
                parts.idle[read.max(place)].push(place);
            }
            parts.all.push(part);
            parts.steps.push((place, false));
            if place < last {
                self.clean_up(&mut parts, again);
            }
        }
        let Parts {
            all: parts, steps, ..
        } = parts;
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
            let outside = |register: &RegisterId| {
                let reach = self.reaches[self.original(*register).index()];
                self.draft.is_read_outside(reach, block)
            };
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

    /// Lets an operation read the copies of registers of finished scopes.
    fn rename(&mut self, op: usize) {
        let renamed = |read: &RegisterId| self.renamed.get(read).copied();
        let reads = self.wires.reads_mut(op);
        if !reads.iter().any(|read| renamed(read).is_some()) {
            return;
        }
        for read in reads {
            *read = renamed(read).unwrap_or(*read);
        }
        let at = &mut self.draft.ops[op].0;
        *at = at
            .clone()
            .map(|read| renamed(&read).unwrap_or(read), |computed| computed);
    }

    fn part(&mut self, instructions: Vec<Instruction>) -> ItemRun {
        self.parts += 1;
        let [own, read] = &mut self.seen;
        let mut garbage = 0;
        let mut toffoli = 0;
        for (place, instruction) in instructions.iter().enumerate() {
            let op = instruction.op as usize;
            let scratch = self.wires.scratch(op);
            let left = scratch.map_or(0, |id| i64::from(self.draft.registers[id.index()].width));
            garbage += if instruction.inverse { -left } else { left };
            for target in self.wires.targets(op) {
                own[target.index()] = self.parts;
                self.computed[target.index()] = if instruction.inverse {
                    0
                } else {
                    place as u32 + 1
                };
            }
            let cost = self.toffoli.get(op);
            toffoli += cost.copied().unwrap_or(0);
        }
        let mut outputs: Vec<RegisterId> = Vec::new();
        let mut inputs: Vec<RegisterId> = Vec::new();
        for (place, instruction) in instructions.iter().enumerate() {
            let op = instruction.op as usize;
            for target in self.wires.targets(op) {
                let computed = &mut self.computed[target.index()];
                if *computed == place as u32 + 1 {
                    *computed = 0;
                    outputs.push(*target);
                }
            }
            for id in self.wires.reads(op) {
                if own[id.index()] != self.parts
                    && std::mem::replace(&mut read[id.index()], self.parts) != self.parts
                {
                    inputs.push(*id);
                }
            }
        }
        let width = |id: &RegisterId| self.draft.registers[id.index()].width;
        ItemRun {
            width: outputs.iter().map(width).sum(),
            inputs,
            outputs,
            garbage: garbage > 0,
            instructions,
            toffoli,
            undone: false,
        }
    }

    /// Undoes parts that no later part reads, the latest parts first.
    ///
    /// A part that cannot be undone is tried once more after each further part that is undone, if parts may run
    /// again for it. If none may, it lacks an input from then on.
    fn clean_up(&mut self, parts: &mut Parts, again: bool) {
        let now = parts.all.len() - 1;
        let idle = std::mem::take(&mut parts.idle[now]).into_iter();
        let mut tried: Vec<(usize, Option<usize>)> = idle.map(|place| (place, None)).collect();
        let stuck = parts.stuck.drain(..);
        tried.extend(stuck.map(|(place, undone)| (place, Some(undone))));
        tried.sort_unstable_by(|a, b| b.cmp(a));
        for (place, undone) in tried {
            if undone != Some(parts.undone) && self.undo(parts, place, again) {
                continue;
            }
            if again {
                parts.stuck.push((place, parts.undone));
            }
        }
    }

    /// Undoes the part at `place`, and returns true, if its inputs are there and this costs little.
    fn undo(&mut self, parts: &mut Parts, place: usize, again: bool) -> bool {
        let part = &parts.all[place];
        let mut needed = BTreeSet::new();
        let depth = if again { MOST_AGAIN } else { 0 };
        let gone = |input: &RegisterId| {
            let (scope, place) = self.gone[input.index()];
            (scope == parts.scope).then_some(place)
        };
        if !find_again(&parts.all, &gone, part, depth, &mut needed) {
            return false;
        }
        let more = needed.iter().map(|&place| 2 * parts.all[place].toffoli);
        let most = MOST_TOFFOLIS[usize::from(again)] * u64::from(part.width);
        if part.toffoli + more.sum::<u64>() > most {
            return false;
        }
        parts
            .steps
            .extend(needed.iter().map(|&place| (place, false)));
        parts.steps.push((place, true));
        parts
            .steps
            .extend(needed.iter().rev().map(|&place| (place, true)));
        for output in &part.outputs {
            self.gone[output.index()] = (parts.scope, place);
        }
        parts.all[place].undone = true;
        parts.undone += 1;
        true
    }

    /// The original of `register`, which is itself if it is no copy.
    fn original(&self, register: RegisterId) -> RegisterId {
        self.originals.get(&register).copied().unwrap_or(register)
    }

    /// The place of the last item of a scope that reads an output of `part`; none if one is read outside.
    fn last_read(&self, part: &ItemRun, block: BlockId) -> Option<usize> {
        let mut last = 0;
        for output in &part.outputs {
            let original = self.original(*output);
            if self.reaches[original.index()] == Reach::End {
                return None;
            }
            for &reader in self.readers(original) {
                last = last.max(self.place(reader, block)?);
            }
        }
        Some(last)
    }

    fn copy(&mut self, register: RegisterId, parent: BlockId) -> Instruction {
        let original = self.original(register);
        let (id, instruction) = self.draft.copy(register, parent);
        self.originals.insert(id, original);
        self.renamed.insert(original, id);
        self.wires.push(&self.draft.ops[instruction.op as usize].0);
        self.gone.push((0, 0));
        self.computed.push(0);
        for seen in &mut self.seen {
            seen.push(0);
        }
        instruction
    }
}

/// Adds to `needed` the parts that have to run again before `part` can be undone. It follows chains of at
/// most `depth` parts, and returns false if that is not enough.
fn find_again(
    parts: &[ItemRun],
    gone: &impl Fn(&RegisterId) -> Option<usize>,
    part: &ItemRun,
    depth: usize,
    needed: &mut BTreeSet<usize>,
) -> bool {
    let missing: BTreeSet<usize> = part.inputs.iter().filter_map(gone).collect();
    missing.into_iter().all(|place| {
        needed.contains(&place)
            || depth > 0
                && find_again(parts, gone, &parts[place], depth - 1, needed)
                && needed.insert(place)
    })
}
