//! Passes from the builder's recording to a program. They decide which operations are kept, in which order
//! they run, and when they are undone.
//!
//! 1. [`groups::separate`]: makes groups of edges that are undone at their ends leave little.
//! 2. [`needed`]: removes operations that nothing needs.
//! 3. [`merge_tables`]: merges tables of one address into one table of several columns. The columns share
//!    the selection of the row, which is the greater part of a table's Toffolis.
//! 4. [`share_multiples`]: computes products of one number with several constants from shared sums.
//! 5. [`schedule`]: orders the instructions. Operations run once and their results stay, except in scopes:
//!    a scope copies the results that are read outside it and then runs backwards. If qubits cost more than
//!    gates, [`super::recompute`] orders the instructions, or [`super::pebble`] those of a small program.

use super::draft::{Draft, Reach, Renamed, Wires};
use super::known::{Known, locked};
use super::{
    Label, Passes, PixelWord, Recorded, Scope, StageName, Strategy, groups, pebble, recompute,
};
use qrt_circuit::lower::{self, OpFigures, QuickMap};
use qrt_circuit::{
    Bit, BlockId, Instruction, Multiples, Op, Parameter, Program, Register, RegisterId, Style, Word,
};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

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

/// A table that replaces others.
struct MergedTable {
    /// The place before which it is inserted.
    start: usize,
    op: Op,
    block: BlockId,
}

/// Merges tables that have the same address and can run at the place of the first one.
pub(super) fn merge_tables(draft: &mut Draft, known_of: &Mutex<Known>) {
    let mut defined: Vec<Option<usize>> = vec![None; draft.registers.len()];
    let mut groups: HashMap<(Vec<Bit>, Option<BlockId>), Vec<usize>> = HashMap::new();
    for (place, (op, block)) in draft.ops.iter().enumerate() {
        for target in op.targets() {
            defined[target.index()] = Some(place);
        }
        if let Op::Table { address, style, .. } = op {
            // In-place tables are merged only within one block: a result for another block would have to be
            // kept in between.
            let block = (*style == Style::InPlace).then_some(*block);
            let key = (address.to_vec(), block);
            groups.entry(key).or_default().push(place);
        }
    }
    let mut inserted: Vec<MergedTable> = Vec::new();
    let mut gone = vec![false; draft.ops.len()];
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, places)| places[0]);
    for ((address, _), places) in groups {
        // The innermost block that contains all tables of the group and in which the address is computed
        // before the child block with the first table starts.
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
            // `choose_lows` sets it.
            low: 0,
            style: how,
            address: address.into(),
            columns: Arc::from(columns),
            targets,
            scratch,
        };
        inserted.push(MergedTable { start, op, block });
    }
    choose_lows(inserted.iter_mut().map(|table| &mut table.op), known_of);
    inserted.sort_by_key(|table| table.start);
    let mut inserted = inserted.into_iter().peekable();
    let mut merged = Vec::with_capacity(draft.ops.len());
    for (place, op) in std::mem::take(&mut draft.ops).into_iter().enumerate() {
        while let Some(MergedTable { op, block, .. }) =
            inserted.next_if(|table| table.start <= place)
        {
            merged.push((op, block));
        }
        if !gone[place] {
            merged.push(op);
        }
    }
    draft.ops = merged;
}

/// Chooses for each out-of-place table how many low bits of its address select among words read together.
fn choose_lows<'a>(tables: impl Iterator<Item = &'a mut Op>, known: &Mutex<Known>) {
    let mut tables: Vec<&mut Op> = tables.collect();
    let mut known = locked(known);
    let unknown = tables.iter().filter_map(|table| match &**table {
        Op::Table {
            address,
            columns,
            targets,
            style: Style::OutOfPlace,
            ..
        } if !known.lows.contains_key(targets) => Some((address.len() as u32, columns, targets)),
        _ => None,
    });
    // Searches share the columns of a mesh's tables.
    let mut alike: QuickMap<(u32, Vec<*const i64>), usize> = QuickMap::default();
    let (mut distinct, mut places) = (Vec::new(), Vec::new());
    for (bits, columns, targets) in unknown {
        let key = (bits, columns.iter().map(|column| column.as_ptr()).collect());
        let place = *alike.entry(key).or_insert_with(|| {
            distinct.push((bits, columns));
            distinct.len() - 1
        });
        places.push((targets.clone(), place));
    }
    let found = known.cores.map(&distinct, 1, |(bits, columns)| {
        lower::best_low(*bits, columns)
    });
    let lows = places
        .into_iter()
        .map(|(targets, place)| (targets, found[place]));
    known.lows.extend(lows);
    for table in &mut tables {
        if let Op::Table { low, targets, .. } = table {
            *low = known.lows.get(&*targets).copied().unwrap_or(0);
        }
    }
}

/// The largest number of products that are computed together, and the same for products with constants of
/// spheres and edges: there are many, and they are a third of a search.
const TOGETHER: usize = 12;
const OF_MANY: usize = 512;

/// Computes products of one number with constants from shared sums, where that is cheaper.
fn share_multiples(draft: &mut Draft, strategy: Strategy, known: &Mutex<Known>) {
    // A result in a scope is not available outside the scope.
    let is_scope = |block: &BlockId| {
        let stage = Label::from_block(&draft.blocks[block.index()]).stage;
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
    let of_many = |place: &usize| {
        let (_, block) = &draft.ops[*place];
        matches!(
            Label::from_block(&draft.blocks[block.index()]).stage,
            StageName::Sphere(_) | StageName::Edges(_)
        )
    };
    let chunks = groups.iter().flat_map(|(_, places)| {
        let most = if places.iter().any(of_many) {
            OF_MANY
        } else {
            TOGETHER
        };
        places.chunks(most)
    });
    let chunks: Vec<&[usize]> = chunks.collect();
    let mut known = locked(known);
    learn_together(draft, &chunks, &mut known);
    let mut gone = vec![false; draft.ops.len()];
    for places in chunks {
        let first = &draft.ops[places[0]].0;
        let targets = targets_of(draft, places);
        let (Some(Some(products)), &Op::Scale { a, scratch, .. }) =
            (known.together.get(&targets), first)
        else {
            continue;
        };
        draft.ops[places[0]].0 = Op::Multiples {
            a,
            products: Arc::clone(products),
            targets,
            scratch,
        };
        for &place in &places[1..] {
            gone[place] = true;
        }
    }
    let mut gone = gone.into_iter();
    draft.ops.retain(|_| !gone.next().unwrap_or(false));
}

fn targets_of(draft: &Draft, places: &[usize]) -> Box<[RegisterId]> {
    let targets = places.iter().map(|&place| draft.ops[place].0.targets());
    targets.flatten().collect()
}

/// Decides which products of one number, those at the places of each chunk, are cheaper together.
fn learn_together(draft: &Draft, chunks: &[&[usize]], known: &mut Known) {
    let new = chunks
        .iter()
        .map(|places| (*places, targets_of(draft, places)));
    let new = new.filter(|(_, targets)| !known.together.contains_key(targets));
    let new: Vec<(&[usize], Box<[RegisterId]>)> = new.collect();
    let products = new.iter().map(|(places, _)| {
        let scales = places.iter().filter_map(|&place| match draft.ops[place].0 {
            Op::Scale { factor, drop, .. } => Some((factor, drop)),
            _ => None,
        });
        scales.collect()
    });
    let products: Vec<Box<[(i64, u32)]>> = products.collect();
    let planned = Multiples::all(&products, &mut known.sums, known.cores);
    let mut together = Vec::new();
    for ((places, targets), products) in new.into_iter().zip(planned) {
        match (products, &draft.ops[places[0]].0) {
            (Some(products), &Op::Scale { a, scratch, .. }) => {
                let op = Op::Multiples {
                    a,
                    products: products.into(),
                    targets,
                    scratch,
                };
                together.push((places, op));
            }
            _ => {
                known.together.insert(targets, None);
            }
        }
    }
    let toffoli = |figures: OpFigures| figures.costs[0].toffoli;
    let costs = known.figures(together.iter().map(|(_, op)| op), &draft.registers);
    let apart = |&place: &usize| &draft.ops[place].0;
    let width = |id: RegisterId| draft.registers[id.index()].width;
    // The exact cost apart is computed only where the lower bound does not decide.
    let mut unclear = Vec::new();
    for ((places, op), most) in together.into_iter().zip(costs.into_iter().map(toffoli)) {
        let least: u64 = places
            .iter()
            .map(|place| lower::least_toffoli(apart(place), width))
            .sum();
        if most < least {
            known.decide(op, true);
        } else {
            unclear.push((places, op, most));
        }
    }
    let all = unclear
        .iter()
        .flat_map(|(places, ..)| places.iter().map(apart));
    let mut costs = known
        .figures(all, &draft.registers)
        .into_iter()
        .map(toffoli);
    for (places, op, most) in unclear {
        let apart: u64 = costs.by_ref().take(places.len()).sum();
        known.decide(op, most < apart);
    }
}

/// A block's content, in order.
#[derive(Clone, Copy, Debug)]
enum Item {
    Op(usize),
    Block(BlockId),
}

struct Scheduler<'a> {
    draft: &'a mut Draft,
    /// By block: true if its work is undone at its end.
    scopes: Vec<bool>,
    items: Vec<Vec<Item>>,
    wires: Wires,
    /// By register: the blocks that read it, or the register that it is a copy of.
    reaches: Vec<Reach>,
    /// The newest copies of registers of finished scopes.
    renamed: Renamed,
    /// By copy, in the order in which they are made: the register that it stands for.
    originals: Vec<RegisterId>,
    /// Number of registers that are no copies.
    recorded: usize,
    /// By register: one more than the place of the block's instruction that computed it, while the block is
    /// processed; 0 otherwise. A vector, because hash maps would take most of the time in unoptimised
    /// builds.
    computed: Vec<usize>,
    /// By operation: true if it is left out when the block is undone, while the block is processed.
    stays: Vec<bool>,
}

/// Orders the instructions: all at once, or scope by scope. `roots` stay to the end of the program. With
/// scopes, some roots may end up in copies; the returned map contains these copies.
fn schedule(
    draft: &mut Draft,
    strategy: Strategy,
    roots: Roots<'_>,
    known: &Mutex<Known>,
) -> (Vec<Instruction>, Renamed) {
    if strategy.pebbles() {
        return fewest_qubits(draft, strategy, roots, known);
    }
    if strategy.undoes_early() {
        return recompute::schedule(draft, strategy, roots.registers, known);
    }
    if strategy.is_keep() {
        let instructions = draft.ops.iter().enumerate();
        let instructions = instructions.map(|(op, &(_, block))| Instruction {
            op: op as u32,
            inverse: false,
            block,
        });
        return (instructions.collect(), Renamed::default());
    }
    // A block's place in its parent is the place of its first operation.
    let mut placed = vec![false; draft.blocks.len()];
    let mut items: Vec<Vec<Item>> = vec![Vec::new(); draft.blocks.len()];
    for (place, (_, block)) in draft.ops.iter().enumerate() {
        let mut at = *block;
        while let Some(parent) = draft.blocks[at.index()].parent
            && !std::mem::replace(&mut placed[at.index()], true)
        {
            items[parent.index()].push(Item::Block(at));
            at = parent;
        }
        items[block.index()].push(Item::Op(place));
    }
    let scope = |block| strategy.is_scope(Label::from_block(block).stage);
    let wires = Wires::new(draft);
    let mut scheduler = Scheduler {
        scopes: draft.blocks.iter().map(scope).collect(),
        reaches: draft.reaches(&wires, roots.registers),
        recorded: draft.registers.len(),
        computed: vec![0; draft.registers.len()],
        stays: vec![false; draft.ops.len()],
        draft,
        items,
        wires,
        renamed: Renamed::default(),
        originals: Vec::new(),
    };
    let mut instructions = Vec::new();
    scheduler.block(BlockId::ROOT, &mut instructions);
    (instructions, scheduler.renamed)
}

/// Orders the instructions as [`pebble::schedule`] does, scope by scope, or scope by scope with parts that are run
/// again: whichever takes the fewest qubits.
fn fewest_qubits(
    draft: &mut Draft,
    strategy: Strategy,
    roots: Roots<'_>,
    known: &Mutex<Known>,
) -> (Vec<Instruction>, Renamed) {
    let Roots { registers, after } = roots;
    let pebbled = pebble::schedule(draft, registers, after, known);
    let pebbled = pebbled.map(|all| (all.draft, all.order, all.renamed));
    let again = |mut draft: Draft| {
        let (order, renamed) = recompute::schedule(&mut draft, strategy, registers, known);
        (draft, order, renamed)
    };
    let scoped = |mut draft: Draft| {
        let (order, renamed) = schedule(&mut draft, Strategy::SCOPED, roots, known);
        (draft, order, renamed)
    };
    let others = [again(draft.clone()), scoped(draft.clone())];
    let all = pebbled.into_iter().chain(others);
    let best = all.min_by_key(|(draft, order, _)| qubits(draft, order, after, known));
    let Some((best, order, renamed)) = best else {
        unreachable!("there are always two orders");
    };
    *draft = best;
    (order, renamed)
}

/// The most qubits in use at a time, inputs apart.
fn qubits(draft: &Draft, order: &[Instruction], after: u32, known: &Mutex<Known>) -> u32 {
    let ops = draft.ops.iter().map(|(op, _)| op);
    let figures = locked(known).figures(ops, &draft.registers);
    let (mut in_use, mut most) = (0, 0);
    for instruction in order {
        let op = instruction.op as usize;
        let fresh = draft.ops[op].0.fresh().into_iter();
        let width: u32 = fresh.map(|id| draft.registers[id.index()].width).sum();
        in_use += if instruction.inverse { 0 } else { width };
        most = most.max(in_use + figures[op].borrowed);
        in_use -= if instruction.inverse { width } else { 0 };
    }
    most.max(in_use + after)
}

impl Scheduler<'_> {
    /// Appends the instructions of a block. A scope leaves only the results that are read outside it, most
    /// of them as copies.
    fn block(&mut self, block: BlockId, all: &mut Vec<Instruction>) {
        let start = all.len();
        for item in std::mem::take(&mut self.items[block.index()]) {
            match item {
                Item::Op(op) => {
                    self.rename(op);
                    all.push(Instruction {
                        op: op as u32,
                        inverse: false,
                        block,
                    });
                }
                Item::Block(inner) => self.block(inner, all),
            }
        }
        if !self.scopes[block.index()] {
            return;
        }
        let parent = self.draft.blocks[block.index()]
            .parent
            .unwrap_or(BlockId::ROOT);
        // Registers that are computed here, or copied here by inner scopes, and read outside.
        for (place, instruction) in all[start..].iter().enumerate() {
            for target in self.wires.targets(instruction.op as usize) {
                let computed = &mut self.computed[target.index()];
                *computed = if instruction.inverse { 0 } else { place + 1 };
            }
        }
        let mut outside: Vec<(usize, RegisterId)> = Vec::new();
        for instruction in &all[start..] {
            for &target in self.wires.targets(instruction.op as usize) {
                let computed = std::mem::take(&mut self.computed[target.index()]);
                if computed > 0 && (self.draft).is_read_outside(self.reaches[target.index()], block)
                {
                    outside.push((computed - 1, target));
                }
            }
        }
        outside.sort_unstable();
        // A result of an operation without garbage may stay as it is.
        let computed = all.len();
        let mut stay = Vec::new();
        for (place, register) in outside {
            let op = all[start + place].op as usize;
            if self.draft.ops[op].1 == block && self.wires.scratch(op).is_none() {
                self.stays[op] = true;
                stay.push(op);
            } else {
                all.push(self.copy(register, parent));
            }
        }
        for place in (start..computed).rev() {
            let instruction = all[place];
            if !self.stays[instruction.op as usize] {
                all.push(Instruction {
                    inverse: !instruction.inverse,
                    ..instruction
                });
            }
        }
        for op in stay {
            self.stays[op] = false;
        }
    }

    /// Lets an operation read the copies of registers of finished scopes.
    fn rename(&mut self, op: usize) {
        let renamed = |read: &RegisterId| self.renamed.get(read).copied();
        if (self.wires.reads(op).iter()).any(|read| renamed(read).is_some()) {
            let at = &mut self.draft.ops[op].0;
            *at = at
                .clone()
                .map(|read| renamed(&read).unwrap_or(read), |computed| computed);
        }
    }

    fn copy(&mut self, register: RegisterId, parent: BlockId) -> Instruction {
        let (id, instruction) = self.draft.copy(register, parent);
        // Operations read a copy by the name of the register that it stands for.
        let original = (register.index().checked_sub(self.recorded))
            .map_or(register, |copy| self.originals[copy]);
        self.renamed.insert(original, id);
        self.originals.push(original);
        self.reaches.push(self.reaches[original.index()]);
        self.wires.push(&self.draft.ops[instruction.op as usize].0);
        self.computed.push(0);
        self.stays.push(false);
        instruction
    }
}

/// The results of a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots<'a> {
    pub(crate) registers: &'a [RegisterId],
    /// The qubits that the code that reads them takes, beside the program's.
    pub(crate) after: u32,
}

impl<'a> From<&'a [RegisterId]> for Roots<'a> {
    fn from(registers: &'a [RegisterId]) -> Self {
        Self {
            registers,
            after: 0,
        }
    }
}

/// The first passes of a draft, which only depend on [`Strategy::stem`].
fn stem(
    draft: &mut Draft,
    records: &[RegisterId],
    roots: &[RegisterId],
    passes: Passes,
    strategy: Strategy,
    known: &Mutex<Known>,
) {
    locked(known)
        .of_recorded
        .resize(draft.registers.len(), None);
    if strategy.undoes(Scope::Plane) {
        groups::separate(draft);
    }
    if passes.needed {
        needed(draft, &[roots, records].concat());
    }
    if passes.merge {
        merge_tables(draft, known);
    }
}

/// The last passes of a draft: its instructions, and the copies that replace some of its `roots`.
fn branch(
    draft: &mut Draft,
    roots: Roots<'_>,
    passes: Passes,
    strategy: Strategy,
    known: &Mutex<Known>,
) -> (Vec<Instruction>, Renamed) {
    if passes.multiples {
        share_multiples(draft, strategy, known);
    }
    draft.size_scratch(known);
    schedule(draft, strategy, roots, known)
}

/// The part of assembling that strategies share which have one [`Strategy::stem`].
#[derive(Clone)]
pub(crate) struct Stem {
    draft: Draft,
}

/// A program for its cost alone: its registers and blocks have no names.
pub(crate) struct PricedProgram {
    draft: Draft,
    pub(crate) instructions: Vec<Instruction>,
    pub(crate) renamed: Renamed,
    /// By operation.
    pub(crate) figures: Vec<OpFigures>,
}

impl Stem {
    pub(crate) fn new(
        recorded: &Recorded,
        roots: &[RegisterId],
        passes: Passes,
        strategy: Strategy,
        known: &Mutex<Known>,
    ) -> Self {
        let mut draft = recorded.draft.without_names();
        let records = &recorded.records;
        stem(&mut draft, records, roots, passes, strategy, known);
        Self { draft }
    }

    /// The program under a strategy of this stem.
    pub(crate) fn priced(
        self,
        roots: Roots<'_>,
        passes: Passes,
        strategy: Strategy,
        known: &Mutex<Known>,
    ) -> PricedProgram {
        let mut draft = self.draft;
        let (instructions, renamed) = branch(&mut draft, roots, passes, strategy, known);
        let ops = draft.ops.iter().map(|(op, _)| op);
        let figures = locked(known).figures(ops, &draft.registers);
        PricedProgram {
            draft,
            instructions,
            renamed,
            figures,
        }
    }
}

impl PricedProgram {
    pub(crate) fn ops(&self) -> impl Iterator<Item = &Op> {
        self.draft.ops.iter().map(|(op, _)| op)
    }

    pub(crate) fn op(&self, place: usize) -> &Op {
        &self.draft.ops[place].0
    }

    pub(crate) fn registers(&self) -> &[Register] {
        &self.draft.registers
    }
}

/// Assembles the program of a recording. Returns it and the copies that replace some of its `roots`.
pub(crate) fn assemble(
    recorded: Recorded,
    roots: Roots<'_>,
    passes: Passes,
    strategy: Strategy,
    inputs: &[RegisterId],
    known: &Mutex<Known>,
) -> (Program, Renamed) {
    let mut draft = recorded.draft;
    let records = &recorded.records;
    stem(
        &mut draft,
        records,
        roots.registers,
        passes,
        strategy,
        known,
    );
    let (instructions, renamed) = branch(&mut draft, roots, passes, strategy, known);
    let parameters = recorded.parameters.iter().map(PixelWord::parameter);
    let mut parameters: Vec<Parameter> = parameters.collect();
    for (op, _) in &draft.ops {
        // A register to which a number is added later may be wider than what it is loaded with.
        if let Op::Load { parameter, target } = op {
            let parameter = &mut parameters[*parameter as usize];
            parameter.width = parameter.width.max(draft.registers[target.index()].width);
        }
    }
    let program = Program {
        registers: draft.registers,
        blocks: draft.blocks,
        parameters,
        ops: draft.ops.into_iter().map(|(op, _)| op).collect(),
        instructions,
        inputs: inputs.to_vec(),
    };
    (program, renamed)
}
