//! From what the builder recorded to a program: what is needed, in which order, and when it is
//! undone.
//!
//! 1. [`needed`]: operations that nothing needs vanish.
//! 2. [`merge_tables`]: tables of one address become one table of several columns, which share the
//!    selection of the row: the greater part of a table's Toffolis.
//! 3. [`share_multiples`]: products of one number with several constants share the sums that they
//!    consist of.
//! 4. [`schedule`]: operations run once and stay, but for those of scopes: a scope copies out what is
//!    needed outside of it and then runs backwards. Where qubits cost more than gates, see
//!    [`super::recompute`].

use super::{Label, Passes, PixelWord, Recorded, Strategy, recompute};
use qrt_circuit::{
    Bit, Block, BlockId, Instruction, KnownSums, Multiples, Op, Program, Register, RegisterId,
    Style, Word, lower,
};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// What passes work on.
#[derive(Clone, Debug, Default)]
pub(super) struct Draft {
    pub(super) registers: Vec<Register>,
    pub(super) blocks: Vec<Block>,
    pub(super) ops: Vec<(Op, BlockId)>,
}

/// What was found out about operations: of use to programs that are assembled from parts of one
/// recording.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    /// [`lower::best_low`]
    lows: HashMap<Box<[RegisterId]>, u32>,
    /// What operations cost, and the width of their garbage.
    pub(crate) figures: lower::KnownFigures,
    /// [`Multiples::known`]
    multiples: KnownSums,
}

impl Draft {
    /// A copy of a register, in `parent`, and the instruction that makes it.
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

    /// The block next below `above` on the way to `block`; none if they are one.
    fn child_towards(&self, above: BlockId, block: BlockId) -> Option<BlockId> {
        let path = self.ancestors(block);
        let place = path.iter().position(|&b| b == above)?;
        place.checked_sub(1).map(|below| path[below])
    }

    /// Gives every garbage register the width that its operation needs.
    pub(super) fn size_scratch(&mut self, known: &mut Known) {
        for (op, _) in &self.ops {
            let registers = &self.registers;
            if let Some(scratch) = op.scratch() {
                let figures = known.figures.of(op, |id| registers[id.index()].width);
                self.registers[scratch.index()].width = figures.scratch;
            }
        }
    }
}

/// Removes the operations that `roots` do not need.
pub(super) fn needed(draft: &mut Draft, roots: &[RegisterId]) {
    let mut live = vec![false; draft.registers.len()];
    for root in roots {
        live[root.index()] = true;
    }
    let mut keep = vec![false; draft.ops.len()];
    for (place, (op, _)) in draft.ops.iter().enumerate().rev() {
        if op.targets().iter().any(|target| live[target.index()]) {
            keep[place] = true;
            for read in op.reads() {
                live[read.index()] = true;
            }
        }
    }
    let mut keep = keep.into_iter();
    draft.ops.retain(|_| keep.next().unwrap_or(false));
}

/// Makes one table of all that have the same address and can run where the first one does.
pub(super) fn merge_tables(draft: &mut Draft, known_of: &mut Known) {
    let mut defined: Vec<Option<usize>> = vec![None; draft.registers.len()];
    let mut groups: HashMap<(Vec<Bit>, Option<BlockId>), Vec<usize>> = HashMap::new();
    for (place, (op, block)) in draft.ops.iter().enumerate() {
        for target in op.targets() {
            defined[target.index()] = Some(place);
        }
        if let Op::Table { address, style, .. } = op {
            // Without garbage a table is there for its block alone: what another one needs of it
            // would have to be kept in between.
            let block = (*style == Style::InPlace).then_some(*block);
            let key = (address.to_vec(), block);
            groups.entry(key).or_default().push(place);
        }
    }
    // By the place before which it is inserted.
    let mut inserted: Vec<(usize, Op, BlockId)> = Vec::new();
    let mut gone = vec![false; draft.ops.len()];
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, places)| places[0]);
    for ((address, _), places) in groups {
        // The block around all of them, as far as the address is known before the part of it in
        // which the first one stands.
        let first = places[0];
        let known = address
            .iter()
            .filter_map(|bit| defined[bit.register.index()]);
        let known = known.max();
        let mut common = draft.ancestors(draft.ops[first].1);
        for &place in &places[1..] {
            let path = draft.ancestors(draft.ops[place].1);
            common.retain(|block| path.contains(block));
        }
        let Some((block, start)) = common.iter().find_map(|&block| {
            let start = match draft.child_towards(block, draft.ops[first].1) {
                None => first,
                Some(child) => (0..=first)
                    .find(|&place| draft.ancestors(draft.ops[place].1).contains(&child))
                    .unwrap_or(first),
            };
            known
                .is_none_or(|known| known < start)
                .then_some((block, start))
        }) else {
            continue;
        };
        let mut columns = Vec::new();
        let mut targets = Vec::new();
        let mut leavings = None;
        let mut how = Style::OutOfPlace;
        for &place in &places {
            if let Op::Table {
                columns: c,
                targets: t,
                scratch,
                style,
                ..
            } = &draft.ops[place].0
            {
                how = *style;
                columns.extend(c.iter().cloned());
                targets.extend(t.iter().copied());
                leavings.get_or_insert(*scratch);
            }
            gone[place] = true;
        }
        let Some(scratch) = leavings else { continue };
        for &register in targets.iter().chain([&scratch]) {
            draft.registers[register.index()].block = block;
        }
        let targets: Box<[RegisterId]> = targets.into();
        let op = Op::Table {
            low: match how {
                Style::OutOfPlace => *known_of
                    .lows
                    .entry(targets.clone())
                    .or_insert_with(|| lower::best_low(address.len() as u32, &columns)),
                Style::InPlace => 0,
            },
            style: how,
            address: address.into(),
            columns: Arc::from(columns),
            targets,
            scratch,
        };
        inserted.push((start, op, block));
    }
    inserted.sort_by_key(|&(place, ..)| place);
    let mut inserted = inserted.into_iter().peekable();
    let mut merged = Vec::with_capacity(draft.ops.len());
    for (place, op) in std::mem::take(&mut draft.ops).into_iter().enumerate() {
        while let Some((_, op, block)) = inserted.next_if(|&(before, ..)| before <= place) {
            merged.push((op, block));
        }
        if !gone[place] {
            merged.push(op);
        }
    }
    draft.ops = merged;
}

/// So many products are computed together, at most.
const TOGETHER: usize = 12;

/// Computes products of one number with constants by sums that they share, where that is cheaper.
fn share_multiples(draft: &mut Draft, strategy: Strategy, known: &mut Known) {
    // What is in a scope is not there for others.
    let is_scope = |block: &BlockId| {
        let stage = Label::of(&draft.blocks[block.index()]).stage;
        strategy.is_scope(stage)
    };
    let mut groups: HashMap<(Word, Option<BlockId>), Vec<usize>> = HashMap::new();
    for (place, (op, block)) in draft.ops.iter().enumerate() {
        if let Op::Scale { a, style, .. } = op
            && *style == Style::OutOfPlace
        {
            let scope = draft.ancestors(*block).into_iter().find(is_scope);
            groups.entry((*a, scope)).or_default().push(place);
        }
    }
    let mut groups: Vec<((Word, _), Vec<usize>)> = groups.into_iter().collect();
    groups.sort_by_key(|(_, places)| places[0]);
    let mut gone = vec![false; draft.ops.len()];
    for ((a, _), places) in groups {
        for places in places.chunks(TOGETHER) {
            let mut products = Vec::new();
            let mut targets = Vec::new();
            let mut leavings = None;
            for &place in places {
                if let Op::Scale {
                    factor,
                    drop,
                    target,
                    scratch,
                    ..
                } = draft.ops[place].0
                {
                    products.push((factor, drop));
                    targets.push(target);
                    leavings.get_or_insert(scratch);
                }
            }
            let planned = Multiples::known(&products, &mut known.multiples).map(Arc::new);
            let (Some(products), Some(scratch)) = (planned, leavings) else {
                continue;
            };
            let together = Op::Multiples {
                a,
                products,
                targets: targets.into(),
                scratch,
            };
            let width = |id: RegisterId| draft.registers[id.index()].width;
            let mut toffoli = |op: &Op| known.figures.of(op, width).costs[0].toffoli;
            // Those that come apart are counted until they cost more.
            let (most, mut apart) = (toffoli(&together), 0);
            let costs_less = places.iter().any(|&place| {
                apart += toffoli(&draft.ops[place].0);
                most < apart
            });
            if costs_less {
                draft.ops[places[0]].0 = together;
                for &place in &places[1..] {
                    gone[place] = true;
                }
            }
        }
    }
    let mut gone = gone.into_iter();
    draft.ops.retain(|_| !gone.next().unwrap_or(false));
}

/// A block's content, in order.
#[derive(Clone, Copy, Debug)]
enum Item {
    Op(usize),
    Block(BlockId),
}

struct Scheduler<'a> {
    draft: &'a mut Draft,
    /// Whether the work of each block is undone at its end.
    scopes: Vec<bool>,
    items: Vec<Vec<Item>>,
    /// By register: the blocks around the ops that read it, none for what stays to the end.
    readers: HashMap<RegisterId, Vec<Option<BlockId>>>,
    /// Copies that stand for registers of finished scopes.
    renamed: HashMap<RegisterId, RegisterId>,
}

/// The order of instructions: all at once, or scope by scope. `roots` outlive everything; under
/// scopes, some of them may end up in copies, which the result maps them to.
pub(super) fn schedule(
    draft: &mut Draft,
    strategy: Strategy,
    roots: &[RegisterId],
) -> (Vec<Instruction>, HashMap<RegisterId, RegisterId>) {
    if strategy.recomputes() {
        return recompute::schedule(draft, strategy, roots);
    }
    if strategy.is_keep() {
        let instructions = draft.ops.iter().enumerate();
        let instructions = instructions.map(|(op, &(_, block))| Instruction {
            op: op as u32,
            inverse: false,
            block,
        });
        return (instructions.collect(), HashMap::new());
    }
    let mut readers: HashMap<RegisterId, Vec<Option<BlockId>>> = HashMap::new();
    for root in roots {
        readers.entry(*root).or_default().push(None);
    }
    for (op, block) in &draft.ops {
        for read in op.reads() {
            readers.entry(read).or_default().push(Some(*block));
        }
    }
    // Blocks stand in their parents where their first op does.
    let mut placed: HashSet<BlockId> = HashSet::new();
    let mut items: Vec<Vec<Item>> = vec![Vec::new(); draft.blocks.len()];
    for (place, (_, block)) in draft.ops.iter().enumerate() {
        let path = draft.ancestors(*block);
        for pair in path.windows(2) {
            if placed.insert(pair[0]) {
                items[pair[1].index()].push(Item::Block(pair[0]));
            }
        }
        items[block.index()].push(Item::Op(place));
    }
    let scope = |block| strategy.is_scope(Label::of(block).stage);
    let mut scheduler = Scheduler {
        scopes: draft.blocks.iter().map(scope).collect(),
        draft,
        items,
        readers,
        renamed: HashMap::new(),
    };
    let instructions = scheduler.block(BlockId::ROOT);
    (instructions, scheduler.renamed)
}

impl Scheduler<'_> {
    /// The instructions of a block. All that is left of a scope is copies of what is read outside
    /// of it.
    fn block(&mut self, block: BlockId) -> Vec<Instruction> {
        let mut forward = Vec::new();
        for item in std::mem::take(&mut self.items[block.index()]) {
            match item {
                Item::Op(op) => {
                    let renamed = |read| self.renamed.get(&read).copied().unwrap_or(read);
                    let at = &mut self.draft.ops[op].0;
                    *at = at.clone().map(renamed, |computed| computed);
                    forward.push(Instruction {
                        op: op as u32,
                        inverse: false,
                        block,
                    });
                }
                Item::Block(inner) => forward.extend(self.block(inner)),
            }
        }
        if !self.scopes[block.index()] {
            return forward;
        }
        let parent = self.draft.blocks[block.index()]
            .parent
            .unwrap_or(BlockId::ROOT);
        // What was computed here, or copied here by scopes within, and is read outside.
        let mut held: Vec<RegisterId> = Vec::new();
        for instruction in &forward {
            for target in self.draft.ops[instruction.op as usize].0.targets() {
                if instruction.inverse {
                    held.retain(|&register| register != target);
                } else {
                    held.push(target);
                }
            }
        }
        let outside: Vec<RegisterId> = held
            .into_iter()
            .filter(|register| self.read_outside(*register, block))
            .collect();
        // A result of an operation without garbage may stay as it is.
        let mut stays: HashSet<usize> = HashSet::new();
        let mut copies = Vec::new();
        for register in outside {
            let own = forward.iter().find(|instruction| {
                let op = &self.draft.ops[instruction.op as usize].0;
                !instruction.inverse && op.targets().contains(&register)
            });
            let simple = own.filter(|instruction| {
                let op = &self.draft.ops[instruction.op as usize];
                op.1 == block && op.0.scratch().is_none()
            });
            match simple {
                Some(instruction) => {
                    stays.insert(instruction.op as usize);
                }
                None => copies.push(self.copy(register, parent)),
            }
        }
        let backward: Vec<Instruction> = forward
            .iter()
            .rev()
            .filter(|instruction| !stays.contains(&(instruction.op as usize)))
            .map(|instruction| Instruction {
                inverse: !instruction.inverse,
                ..*instruction
            })
            .collect();
        forward.extend(copies);
        forward.extend(backward);
        forward
    }

    fn read_outside(&self, register: RegisterId, block: BlockId) -> bool {
        // A copy is read by whoever read the original.
        let mut names = vec![register];
        let mut at = register;
        while let Some((original, _)) = self.renamed.iter().find(|&(_, &copy)| copy == at) {
            names.push(*original);
            at = *original;
        }
        names.iter().any(|name| {
            self.readers.get(name).is_some_and(|readers| {
                readers.iter().any(|reader| {
                    reader.is_none_or(|reader| !self.draft.ancestors(reader).contains(&block))
                })
            })
        })
    }

    fn copy(&mut self, register: RegisterId, parent: BlockId) -> Instruction {
        let (id, instruction) = self.draft.copy(register, parent);
        // Earlier names lead to the newest copy.
        for copy in self.renamed.values_mut() {
            if *copy == register {
                *copy = id;
            }
        }
        self.renamed.insert(register, id);
        instruction
    }
}

/// The program of what was recorded, and the copies that stand for some of its `roots`.
pub(crate) fn assemble(
    recorded: Recorded,
    roots: &[RegisterId],
    passes: Passes,
    strategy: Strategy,
    inputs: &[RegisterId],
    known: &mut Known,
) -> (Program, HashMap<RegisterId, RegisterId>) {
    let mut draft = recorded.draft;
    if passes.needed {
        let mut kept = roots.to_vec();
        kept.extend(recorded.records);
        needed(&mut draft, &kept);
    }
    if passes.merge {
        merge_tables(&mut draft, known);
    }
    if passes.multiples {
        share_multiples(&mut draft, strategy, known);
    }
    draft.size_scratch(known);
    let (instructions, renamed) = schedule(&mut draft, strategy, roots);
    let program = Program {
        registers: draft.registers,
        blocks: draft.blocks,
        parameters: recorded
            .parameters
            .iter()
            .map(PixelWord::parameter)
            .collect(),
        ops: draft.ops.into_iter().map(|(op, _)| op).collect(),
        instructions,
        inputs: inputs.to_vec(),
    };
    (program, renamed)
}
