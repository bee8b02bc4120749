//! Tables: QROM, read by a one-hot address.
//!
//! The high bits of the address become a one-hot register by doubling in place: `new[i + 2^j] =
//! old[i] and b`, then `old[i] ^= new[i + 2^j]`, for each further bit b. One-hot bits sum to 1, so the
//! last new one of each bit takes CNOTs alone: 2^h - h - 1 Toffolis, fewer than the unary iteration
//! of Babbush et al. (2018) by the h of its lone leaves, and no ancilla beyond the one-hot register,
//! which stays. Entries are CNOTs from it.
//!
//! The low bits select among words read side by side (Low, Kliuchnikov and Schaeffer 2018), by a
//! tree: a Toffoli for each pair of different functions of the address, and none for equal or
//! opposite ones, nor for a function that another bit has already.

use super::{Gates, Lowering, Qubit, Wire};
use std::collections::HashMap;

/// A function of the address that has been planned.
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
    /// The sum of one-hot bits: by group, whether it is in it.
    Leaf(Vec<u64>),
    /// By a low bit of the address.
    Select {
        bit: usize,
        low: Function,
        high: Function,
    },
}

/// What is computed for a table.
pub(super) struct Plan {
    /// Entries of the one-hot register; 1: there is none.
    groups: usize,
    low: usize,
    /// Each after those that it reads.
    nodes: Vec<Node>,
    /// By column and by bit.
    outputs: Vec<Vec<Function>>,
}

/// Bits of a vector.
fn get(bits: &[u64], place: usize) -> bool {
    bits[place / 64] >> (place % 64) & 1 == 1
}

fn vector(bits: usize, of: impl Fn(usize) -> bool) -> Vec<u64> {
    let mut vector = vec![0; bits.div_ceil(64)];
    for place in (0..bits).filter(|place| of(*place)) {
        vector[place / 64] |= 1 << (place % 64);
    }
    vector
}

struct Planner {
    groups: usize,
    nodes: Vec<Node>,
    known: HashMap<(usize, Vec<u64>), Function>,
}

impl Planner {
    /// Plans a function of the group and the lowest `level` bits, the latter counting first.
    fn plan(&mut self, level: usize, function: Vec<u64>) -> Function {
        let bits = self.groups << level;
        if get(&function, 0) {
            let mut plan = self.plan(level, vector(bits, |place| !get(&function, place)));
            plan.inverted = !plan.inverted;
            return plan;
        }
        if function.iter().all(|word| *word == 0) {
            return Function {
                source: Source::Zero,
                inverted: false,
            };
        }
        let key = (level, function);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let plan = match level.checked_sub(1) {
            None => self.node(Node::Leaf(key.1.clone())),
            Some(below) => {
                let half = 1 << below;
                let part = |place: usize| (place >> below << level) | (place & (half - 1));
                let low = vector(bits / 2, |place| get(&key.1, part(place)));
                let high = vector(bits / 2, |place| get(&key.1, part(place) | half));
                let (low, high) = (self.plan(below, low), self.plan(below, high));
                if low == high {
                    low
                } else if low.source == Source::Zero && high.source == Source::Zero {
                    Function {
                        source: Source::Address(below),
                        inverted: low.inverted,
                    }
                } else {
                    let bit = below;
                    self.node(Node::Select { bit, low, high })
                }
            }
        };
        self.known.insert(key, plan);
        plan
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
    /// For a table of which the targets have the widths `width`.
    pub(super) fn new(
        address_bits: usize,
        columns: &[Box<[i64]>],
        low: u32,
        width: impl Fn(usize) -> usize,
    ) -> Self {
        let low = (low as usize).min(address_bits);
        let all = 1_usize
            .checked_shl(address_bits as u32)
            .unwrap_or(usize::MAX);
        let length = columns.iter().map(|column| column.len()).max().unwrap_or(0);
        let length = length.clamp(1, all);
        let groups = length.div_ceil(1 << low);
        let mut planner = Planner {
            groups,
            nodes: Vec::new(),
            known: HashMap::new(),
        };
        let mut outputs = Vec::with_capacity(columns.len());
        for (index, column) in columns.iter().enumerate() {
            // Entries beyond the last are as it is.
            let entry = |place: usize| column.get(place).or(column.last()).copied().unwrap_or(0);
            let output = |bit: usize| {
                let holds = |place| entry(place) >> bit.min(63) & 1 == 1;
                planner.plan(low, vector(groups << low, holds))
            };
            outputs.push((0..width(index)).map(output).collect());
        }
        Self {
            groups,
            low,
            nodes: planner.nodes,
            outputs,
        }
    }

    /// By high bit of the address: the new bits of the one-hot register.
    fn news(&self) -> impl Iterator<Item = usize> {
        let groups = self.groups;
        let olds = (0..).map(|bit| 1_usize << bit);
        olds.take_while(move |old| *old < groups)
            .map(move |old| old.min(groups - old))
    }

    /// Toffolis, all of which compute into clean bits.
    pub(super) fn toffoli(&self) -> u64 {
        let doubling: usize = self.news().map(|new| new - 1).sum();
        let selected = self.nodes.iter().filter(|node| match node {
            Node::Leaf(_) => false,
            Node::Select { low, high, .. } => low.source != high.source,
        });
        doubling as u64 + selected.count() as u64
    }
}

/// How many low bits of an address of `address_bits` best select among words read together: the
/// number with the fewest Toffolis.
pub fn best_low(address_bits: u32, columns: &[Box<[i64]>]) -> u32 {
    let bits = |column: &[i64]| {
        let bits = |entry: &i64| 65 - (entry ^ (entry >> 63)).leading_zeros();
        column.iter().map(bits).max().unwrap_or(0) as usize
    };
    let widths: Vec<usize> = columns.iter().map(|column| bits(column)).collect();
    let toffoli = |low: u32| {
        Plan::new(address_bits as usize, columns, low, |column| widths[column]).toffoli()
    };
    let lows = 0..=address_bits.min(10);
    lows.min_by_key(|low| (toffoli(*low), *low)).unwrap_or(0)
}

impl Lowering {
    pub(super) fn table(
        &mut self,
        mut address: Vec<Wire>,
        columns: &[Box<[i64]>],
        low: u32,
        targets: &[Vec<Qubit>],
    ) {
        let plan = Plan::new(address.len(), columns, low, |column| targets[column].len());
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
            let (t, inverted) = at.unwrap_or_else(|| (self.draw(), false));
            match node {
                Node::Leaf(ones) => {
                    let count: u32 = ones.iter().map(|word| word.count_ones()).sum();
                    let most = count as usize * 2 > plan.groups;
                    if most != inverted {
                        self.x(t);
                    }
                    for (group, bit) in hot.iter().enumerate() {
                        if get(ones, group) != most {
                            self.cx(*bit, t);
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
        let hot = self.draws(plan.groups);
        self.x(hot[0]);
        for (place, new) in plan.news().enumerate() {
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
