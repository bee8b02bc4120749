//! Tables: QROM, read by a one-hot address.
//!
//! The high bits of the address become a one-hot register by doubling in place:
//! `new[i + 2^j] = old[i] and b`, then `old[i] ^= new[i + 2^j]`, for each further bit b. One-hot
//! bits sum to 1, so the last new one of each bit takes CNOTs alone. That takes 2^h - h - 1
//! Toffolis, fewer than the unary iteration of Babbush et al. (2018) by the h of its lone leaves.
//! The only ancilla is the one-hot register, which stays. Entries are CNOTs from it.
//!
//! The low bits select among words read side by side (Low, Kliuchnikov and Schaeffer 2018), by a
//! tree. It takes a Toffoli for each pair of different functions of the address. Equal or opposite
//! functions, and a function that another bit already has, take none.

use super::{GateSink, Lowering, Qubit, Wire};
use std::collections::HashMap;
use std::sync::Arc;

/// The source of a planned function of the address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Zero,
    /// One of the low bits of the address.
    Address(usize),
    Node(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Function {
    source: Source,
    inverted: bool,
}

#[derive(Debug)]
enum Node {
    /// The sum of the one-hot bits of some groups: one bit a group, set if the group is included.
    Leaf(Vec<u64>),
    /// One of two functions, selected by a low bit of the address.
    Select {
        bit: usize,
        low: Function,
        high: Function,
    },
}

/// The plan of the computation of a table.
#[derive(Default)]
pub(super) struct Plan {
    /// Number of entries of the one-hot register; 1 if there is none.
    groups: usize,
    low: usize,
    /// The functions to compute, each after those that it reads.
    nodes: Vec<Node>,
    /// The functions of the targets, by column and by bit.
    outputs: Vec<Vec<Function>>,
}

/// Returns bit `place` of a vector.
fn get(bits: &[u64], place: usize) -> bool {
    bits[place / 64] >> (place % 64) & 1 == 1
}

/// Returns the lowest `bits` bits.
fn truncated(vector: &[u64], bits: usize) -> Vec<u64> {
    let mut vector = vector[..bits.div_ceil(64)].to_vec();
    if let (Some(last), rest @ 1..) = (vector.last_mut(), bits % 64) {
        *last &= (1 << rest) - 1;
    }
    vector
}

/// Masks by level: the lower half of each `2^(level + 1)` bits of a word.
const LOWER: [u64; 6] = [
    0x5555_5555_5555_5555,
    0x3333_3333_3333_3333,
    0x0f0f_0f0f_0f0f_0f0f,
    0x00ff_00ff_00ff_00ff,
    0x0000_ffff_0000_ffff,
    0x0000_0000_ffff_ffff,
];

/// Returns the lower and the upper halves of all runs of `2^(below + 1)` bits.
fn halves(vector: &[u64], below: usize) -> [Vec<u64>; 2] {
    if let Some(words) = below.checked_sub(6).map(|above| 1 << above) {
        let half = |which: usize| {
            let chunks = vector.chunks(words).skip(which).step_by(2);
            chunks.flatten().copied().collect()
        };
        return [half(0), half(1)];
    }
    let close_up = |word: u64| {
        let mut word = word & LOWER[below];
        for (level, lower) in LOWER.iter().enumerate().skip(below + 1) {
            word = (word | word >> (1 << (level - 1))) & lower;
        }
        word
    };
    let half = |shift: usize| {
        let pairs = vector.chunks(2);
        let word = |pair: &[u64]| {
            let high = pair.get(1).map_or(0, |word| close_up(word >> shift));
            close_up(pair[0] >> shift) | high << 32
        };
        pairs.map(word).collect()
    };
    [half(0), half(1 << below)]
}

/// The bits of a table's entries, by column and by bit: entry 0 first.
struct Truths {
    columns: Vec<Vec<Vec<u64>>>,
    /// Number of entries of the longest column.
    length: usize,
}

impl Truths {
    /// Reads the `width(column)` lowest bits of each column, for up to `low` low bits of the
    /// address. Entries beyond the last equal the last.
    fn new(
        address_bits: usize,
        columns: &[Arc<[i64]>],
        low: usize,
        width: impl Fn(usize) -> usize,
    ) -> Self {
        let all = 1_usize
            .checked_shl(address_bits as u32)
            .unwrap_or(usize::MAX);
        let length = columns.iter().map(|column| column.len()).max().unwrap_or(0);
        let length = length.clamp(1, all);
        let padded = length.next_multiple_of(1 << low);
        // Plain loops: in unoptimised code, as in a macro, iterators take ten times the time.
        let bits = |index: usize, column: &[i64]| {
            let mut entries = column.to_vec();
            entries.resize(padded, column.last().copied().unwrap_or(0));
            let entries: &[i64] = &entries;
            let mut bits = vec![vec![0_u64; padded.div_ceil(64)]; width(index)];
            for (bit, vector) in bits.iter_mut().enumerate() {
                let vector: &mut [u64] = vector;
                let bit = bit.min(63);
                let mut place = 0;
                while place < entries.len() {
                    let own = entries[place] >> bit & 1;
                    vector[place / 64] |= (own as u64) << (place % 64);
                    place += 1;
                }
            }
            bits
        };
        let columns = columns.iter().enumerate();
        let columns = columns.map(|(index, column)| bits(index, column));
        Self {
            columns: columns.collect(),
            length,
        }
    }

    /// Returns the plan. `None` if it needs more than `most` Toffolis.
    fn plan(&self, low: usize, most: u64) -> Option<Plan> {
        let groups = self.length.div_ceil(1 << low);
        let mut planner = Planner {
            groups,
            nodes: Vec::new(),
            known: HashMap::new(),
            left: most.checked_sub(doubling(groups))?,
        };
        let mut outputs = Vec::with_capacity(self.columns.len());
        for column in &self.columns {
            let functions = column.iter().map(|bits| truncated(bits, groups << low));
            let planned = functions.map(|function| planner.plan(low, function));
            outputs.push(planned.collect::<Option<_>>()?);
        }
        Some(Plan {
            groups,
            low,
            nodes: planner.nodes,
            outputs,
        })
    }
}

struct Planner {
    groups: usize,
    nodes: Vec<Node>,
    known: HashMap<(usize, Vec<u64>), Function>,
    /// Number of Toffolis that the plan may still take.
    left: u64,
}

impl Planner {
    /// Plans a function of the group and the lowest `level` bits, which are the low bits of its
    /// index. `None` if that takes too many Toffolis.
    fn plan(&mut self, level: usize, function: Vec<u64>) -> Option<Function> {
        let bits = self.groups << level;
        if get(&function, 0) {
            let inverted: Vec<u64> = function.iter().map(|word| !word).collect();
            let plan = self.plan(level, truncated(&inverted, bits))?;
            return Some(Function {
                inverted: !plan.inverted,
                ..plan
            });
        }
        if function.iter().all(|word| *word == 0) {
            return Some(Function {
                source: Source::Zero,
                inverted: false,
            });
        }
        let key = (level, function);
        if let Some(known) = self.known.get(&key) {
            return Some(*known);
        }
        let plan = match level.checked_sub(1) {
            None => self.node(Node::Leaf(key.1.clone())),
            Some(below) => {
                let [low, high] = halves(&key.1, below);
                let (low, high) = (self.plan(below, low)?, self.plan(below, high)?);
                if low == high {
                    low
                } else if low.source == Source::Zero && high.source == Source::Zero {
                    Function {
                        source: Source::Address(below),
                        inverted: low.inverted,
                    }
                } else {
                    let bit = below;
                    let toffoli = u64::from(low.source != high.source);
                    self.left = self.left.checked_sub(toffoli)?;
                    self.node(Node::Select { bit, low, high })
                }
            }
        };
        self.known.insert(key, plan);
        Some(plan)
    }

    fn node(&mut self, node: Node) -> Function {
        self.nodes.push(node);
        Function {
            source: Source::Node(self.nodes.len() - 1),
            inverted: false,
        }
    }
}

impl Plan {
    /// Plans a table whose targets have the widths `width`.
    pub(super) fn new(
        address_bits: usize,
        columns: &[Arc<[i64]>],
        low: u32,
        width: impl Fn(usize) -> usize,
    ) -> Self {
        let low = (low as usize).min(address_bits);
        let plan = Truths::new(address_bits, columns, low, width).plan(low, u64::MAX);
        // No plan exceeds this limit.
        plan.unwrap_or_default()
    }

    /// Number of Toffolis, all of which compute into clean bits.
    pub(super) fn toffoli(&self) -> u64 {
        let selected = self.nodes.iter().filter(|node| match node {
            Node::Leaf(_) => false,
            Node::Select { low, high, .. } => low.source != high.source,
        });
        doubling(self.groups) + selected.count() as u64
    }
}

/// Returns, for each high bit of the address, the number of bits that it adds to a one-hot register
/// of `groups` entries.
fn news(groups: usize) -> impl Iterator<Item = usize> {
    let olds = (0..).map(|bit| 1_usize << bit);
    olds.take_while(move |old| *old < groups)
        .map(move |old| old.min(groups - old))
}

/// Number of Toffolis of the one-hot register.
fn doubling(groups: usize) -> u64 {
    news(groups).map(|new| new as u64 - 1).sum()
}

/// Returns the number of low bits, of an address of `address_bits`, that select among words read
/// together: the number with the fewest Toffolis.
pub fn best_low(address_bits: u32, columns: &[Arc<[i64]>]) -> u32 {
    let bits = |column: &[i64]| {
        let bits = |entry: &i64| 65 - (entry ^ (entry >> 63)).leading_zeros();
        column.iter().map(bits).max().unwrap_or(0) as usize
    };
    let widths: Vec<usize> = columns.iter().map(|column| bits(column)).collect();
    let most = address_bits.min(10);
    let truths = Truths::new(address_bits as usize, columns, most as usize, |column| {
        widths[column]
    });
    // Begins in the middle, which is seldom far from the best, so that most other plans end early.
    let mut lows: Vec<u32> = (0..=most).collect();
    lows.sort_by_key(|low| low.abs_diff(most / 2));
    let mut best = (u64::MAX, 0);
    for low in lows {
        if let Some(plan) = truths.plan(low as usize, best.0) {
            best = best.min((plan.toffoli(), low));
        }
    }
    best.1
}

/// Least number of entries of a table whose plan is kept.
const LONG: usize = 1 << 10;

/// The plans of long tables.
#[derive(Default)]
pub(super) struct Plans(HashMap<PlanKey, KeptPlan>);

/// The addresses of the columns, which the plan's entry keeps alive; the numbers of bits of the address
/// and of its low part; the widths of the targets.
type PlanKey = (Box<[usize]>, usize, u32, Box<[usize]>);

struct KeptPlan {
    plan: Arc<Plan>,
    _columns: Box<[Arc<[i64]>]>,
}

impl Lowering {
    /// Returns the plan of a table. Many searches look up the same columns.
    fn plan(
        &mut self,
        address_bits: usize,
        columns: &[Arc<[i64]>],
        low: u32,
        targets: &[Vec<Qubit>],
    ) -> Arc<Plan> {
        let make = || {
            let width = |column: usize| targets[column].len();
            Arc::new(Plan::new(address_bits, columns, low, width))
        };
        if columns.iter().all(|column| column.len() < LONG) {
            return make();
        }
        let places = columns.iter().map(|column| column.as_ptr() as usize);
        let widths = targets.iter().map(Vec::len);
        let key = (places.collect(), address_bits, low, widths.collect());
        let kept = self.plans.0.entry(key).or_insert_with(|| KeptPlan {
            plan: make(),
            _columns: columns.into(),
        });
        kept.plan.clone()
    }

    pub(super) fn table(
        &mut self,
        mut address: Vec<Wire>,
        columns: &[Arc<[i64]>],
        low: u32,
        targets: &[Vec<Qubit>],
    ) {
        let plan = self.plan(address.len(), columns, low, targets);
        let copies = self.detach(&mut address, &[]);
        let hot = self.one_hot(&plan, &address[plan.low..]);
        let mut at: Vec<Option<(Qubit, bool)>> = vec![None; plan.nodes.len()];
        for (outputs, target) in plan.outputs.iter().zip(targets) {
            for (output, t) in outputs.iter().zip(target) {
                if let Source::Node(node) = output.source {
                    at[node].get_or_insert((*t, output.inverted));
                }
            }
        }
        let mut wires: Vec<Wire> = Vec::with_capacity(plan.nodes.len());
        for (node, at) in plan.nodes.iter().zip(&at) {
            let (t, inverted) = at.unwrap_or_else(|| (self.garbage_bit(), false));
            match node {
                Node::Leaf(ones) => {
                    let count: u32 = ones.iter().map(|word| word.count_ones()).sum();
                    let most = count as usize * 2 > plan.groups;
                    if most != inverted {
                        self.x(t);
                    }
                    // Most of a large circuit's gates are made here.
                    for (ones, hot) in ones.iter().zip(hot.chunks(64)) {
                        let mut left = if most { !ones } else { *ones };
                        left &= u64::MAX >> (64 - hot.len());
                        while left != 0 {
                            self.cx(hot[left.trailing_zeros() as usize], t);
                            left &= left - 1;
                        }
                    }
                }
                Node::Select { bit, low, high } => {
                    let low = wire(*low, &wires, &address);
                    let high = wire(*high, &wires, &address);
                    self.select_bit(address[*bit], high, low, t);
                    self.flip(Wire::constant(inverted), t);
                }
            }
            wires.push(Wire::qubit(t).xor(inverted));
        }
        for (outputs, target) in plan.outputs.iter().zip(targets) {
            for (output, t) in outputs.iter().zip(target) {
                let wire = wire(*output, &wires, &address);
                if wire != Wire::qubit(*t) {
                    self.copy(wire, *t);
                }
            }
        }
        self.attach(copies);
    }

    fn one_hot(&mut self, plan: &Plan, address: &[Wire]) -> Vec<Qubit> {
        if plan.groups == 1 {
            return Vec::new();
        }
        let hot = self.allocate_garbage(plan.groups);
        self.x(hot[0]);
        for (place, new) in news(plan.groups).enumerate() {
            let bit = address[place];
            let Some(b) = bit.source() else {
                continue;
            };
            self.flip(bit, b);
            let (old, rest) = hot.split_at(1 << place);
            let last = new - 1;
            for (old, new) in old.iter().zip(&rest[..last]) {
                self.ccx(*old, b, *new);
                self.cx(*new, *old);
            }
            self.cx(b, rest[last]);
            for other in &rest[..last] {
                self.cx(*other, rest[last]);
            }
            self.cx(rest[last], old[last]);
            self.flip(bit, b);
        }
        hot
    }
}

fn wire(function: Function, nodes: &[Wire], address: &[Wire]) -> Wire {
    let wire = match function.source {
        Source::Zero => Wire::ZERO,
        Source::Address(bit) => address[bit],
        Source::Node(node) => nodes[node],
    };
    wire.xor(function.inverted)
}
