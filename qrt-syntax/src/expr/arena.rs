//! Builds expressions in which equal subexpressions are one node.

use super::{Expr, ExprNode, Id};
use std::collections::HashMap;

/// Nodes under construction. The map is only looked up, never walked, so its order cannot matter.
#[derive(Default)]
pub(super) struct Arena {
    nodes: Vec<ExprNode>,
    known: HashMap<[u64; 5], Id>,
}

impl Arena {
    /// Adds `node`, unless there is an equal one, and returns its index.
    pub(super) fn push(&mut self, node: ExprNode) -> Id {
        *self.known.entry(node.key()).or_insert_with(|| {
            self.nodes.push(node);
            Id(self.nodes.len() as u32 - 1)
        })
    }

    /// Adds a number.
    pub(super) fn number(&mut self, value: f64) -> Id {
        self.push(ExprNode::Number(value))
    }

    /// Adds the nodes of `expr`, and returns the index of its root in this arena.
    pub(super) fn import(&mut self, expr: &Expr) -> Id {
        let mut ids = Vec::with_capacity(expr.nodes.len());
        for node in &expr.nodes {
            let id = self.push(node.map_operands(|id| ids[id.index()]));
            ids.push(id);
        }
        ids[expr.root.index()]
    }

    /// A node that was pushed.
    pub(super) fn node(&self, id: Id) -> ExprNode {
        self.nodes[id.index()]
    }

    /// Returns the expression with the root `root`, without the nodes that it does not use.
    pub(super) fn finish(self, root: Id) -> Expr {
        let mut used = vec![false; root.index() + 1];
        used[root.index()] = true;
        for index in (0..used.len()).rev().filter(|i| self.nodes.len() > *i) {
            if used[index] {
                self.nodes[index]
                    .operands()
                    .for_each(|id| used[id.index()] = true);
            }
        }
        let mut nodes = Vec::new();
        let mut ids = Vec::with_capacity(used.len());
        for (node, used) in self.nodes.iter().zip(&used) {
            ids.push(Id(nodes.len() as u32));
            if *used {
                nodes.push(node.map_operands(|id| ids[id.index()]));
            }
        }
        let root = Id(nodes.len() as u32 - 1);
        Expr { nodes, root }
    }
}

impl Expr {
    /// Returns the subexpression with the root `root`.
    pub fn part(&self, root: Id) -> Self {
        let arena = Arena {
            nodes: self.nodes[..=root.index()].to_vec(),
            known: HashMap::new(),
        };
        arena.finish(root)
    }
}

impl ExprNode {
    /// The operands of the node.
    pub fn operands(&self) -> impl Iterator<Item = Id> + use<> {
        let none = Id(0);
        let (ids, count) = match *self {
            Self::Number(_) | Self::Variable(_) => ([none; 4], 0),
            Self::Neg(a)
            | Self::Powi(a, _)
            | Self::Sqrt(a)
            | Self::Abs(a)
            | Self::Function(_, a) => ([a, none, none, none], 1),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Pow(a, b)
            | Self::Min(a, b)
            | Self::Max(a, b)
            | Self::Atan2(a, b) => ([a, b, none, none], 2),
            Self::IfLess(a, b, x, y) => ([a, b, x, y], 4),
        };
        ids.into_iter().take(count)
    }

    /// The same operation on other nodes.
    pub(super) fn map_operands(&self, mut to: impl FnMut(Id) -> Id) -> Self {
        match *self {
            Self::Number(_) | Self::Variable(_) => *self,
            Self::Neg(a) => Self::Neg(to(a)),
            Self::Powi(a, n) => Self::Powi(to(a), n),
            Self::Sqrt(a) => Self::Sqrt(to(a)),
            Self::Abs(a) => Self::Abs(to(a)),
            Self::Function(f, a) => Self::Function(f, to(a)),
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Sub(a, b) => Self::Sub(to(a), to(b)),
            Self::Mul(a, b) => Self::Mul(to(a), to(b)),
            Self::Div(a, b) => Self::Div(to(a), to(b)),
            Self::Pow(a, b) => Self::Pow(to(a), to(b)),
            Self::Min(a, b) => Self::Min(to(a), to(b)),
            Self::Max(a, b) => Self::Max(to(a), to(b)),
            Self::Atan2(a, b) => Self::Atan2(to(a), to(b)),
            Self::IfLess(a, b, x, y) => Self::IfLess(to(a), to(b), to(x), to(y)),
        }
    }

    /// Returns a key that is equal only for equal nodes.
    fn key(&self) -> [u64; 5] {
        let tag = match *self {
            Self::Number(value) => return [0, value.to_bits(), 0, 0, 0],
            Self::Variable(variable) => return [1, variable as u64, 0, 0, 0],
            Self::Powi(a, n) => return [2, a.0.into(), n as u64, 0, 0],
            Self::Function(f, a) => return [3, a.0.into(), f as u64, 0, 0],
            Self::Neg(_) => 4,
            Self::Sqrt(_) => 5,
            Self::Abs(_) => 6,
            Self::Add(..) => 7,
            Self::Sub(..) => 8,
            Self::Mul(..) => 9,
            Self::Div(..) => 10,
            Self::Pow(..) => 11,
            Self::Min(..) => 12,
            Self::Max(..) => 13,
            Self::Atan2(..) => 14,
            Self::IfLess(..) => 15,
        };
        let mut key = [tag, 0, 0, 0, 0];
        for (slot, id) in key[1..].iter_mut().zip(self.operands()) {
            *slot = id.0.into();
        }
        key
    }
}
