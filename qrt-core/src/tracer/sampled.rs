//! Functions of sample coordinates: tables where that is possible, arithmetic where it is not.
//!
//! What depends on lattice points alone need not be computed along a path. Of an expression in
//! `u` and `v`, every subexpression of one coordinate becomes a table over that coordinate's
//! indices (a QROM, in a circuit), and only what mixes coordinates or angles is arithmetic.

use super::{Arith, Axis, Coordinate};
use crate::expr::{Domain, Expr, Function, Id, Interval, Node, Variable, VariableSet, Variables};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// Tables of more index bits than this are not stored: machines evaluate the function instead.
const TABLE_BITS: u32 = 14;

/// A function of one sample coordinate's index.
#[derive(Clone)]
pub struct Sampled {
    bits: u32,
    table: Arc<[f64]>,
    function: Arc<dyn Fn(u32) -> f64 + Send + Sync>,
}

impl Sampled {
    /// A function of the index, `0..2^bits`.
    pub fn of_index(bits: u32, function: impl Fn(u32) -> f64 + Send + Sync + 'static) -> Self {
        let entries = if bits <= TABLE_BITS { 1 << bits } else { 0 };
        let table = (0..entries).map(&function).collect();
        Self {
            bits,
            table,
            function: Arc::new(function),
        }
    }

    /// A function of the cell centre `(index + 1/2) / 2^bits`.
    pub fn of_centre(bits: u32, function: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::of_index(bits, move |index| function(centre(index, bits)))
    }

    /// Bits of the index.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// All values by index, where they are stored.
    #[inline(always)]
    pub fn table(&self) -> Option<&[f64]> {
        (!self.table.is_empty()).then_some(&*self.table)
    }

    /// The value at `index`.
    pub fn at(&self, index: u32) -> f64 {
        match self.table() {
            Some(table) => table[index as usize],
            None => (self.function)(index),
        }
    }

    fn same(&self, other: &Self) -> bool {
        self.bits == other.bits && !self.table.is_empty() && self.table == other.table
    }
}

impl fmt::Debug for Sampled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sampled")
            .field("bits", &self.bits)
            .field("table", &self.table)
            .finish_non_exhaustive()
    }
}

/// The cell centre `(index + 1/2) / 2^bits`.
#[inline(always)]
pub(crate) fn centre(index: u32, bits: u32) -> f64 {
    (f64::from(index) + 0.5) / (1_u64 << bits) as f64
}

/// One step of a compiled expression; operands are earlier steps.
#[derive(Clone, Debug)]
enum Step {
    Constant(f64),
    Sampled(Axis, Sampled),
    CosO,
    CosA,
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    /// The bound of its values comes third.
    Div(usize, usize, f64),
    Min(usize, usize),
    Max(usize, usize),
    Pow(usize, usize),
    Neg(usize),
    Abs(usize),
    Sqrt(usize),
    Powi(usize, u32),
    Call(Function, usize),
    Atan2(usize, usize),
    IfLess(usize, usize, usize, usize),
}

/// Expressions in `u`, `v` and angles, compiled together for one depth.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    steps: Vec<Step>,
    roots: Vec<usize>,
}

/// The angles an expression may ask for.
#[derive(Clone, Copy)]
pub(crate) struct Angles<R> {
    /// `|n.o|`, towards the viewer.
    pub(crate) cos_o: R,
    /// `i.mirror(o)`
    pub(crate) cos_a: R,
}

struct Compiler {
    bits: [u32; 2],
    steps: Vec<Step>,
}

impl Compiled {
    /// Compiles `expressions` for coordinates of `bits`; `cos_i` is `|phi_z|`.
    pub(crate) fn new(expressions: &[&Expr], bits: [u32; 2], cos_i: Option<&Expr>) -> Self {
        let mut compiler = Compiler {
            bits,
            steps: Vec::new(),
        };
        let cos_i = cos_i.map(Expr::abs);
        let roots = expressions
            .iter()
            .map(|&expr| match &cos_i {
                Some(cos_i) => compiler.expression(&expr.substitute(Variable::CosI, cos_i)),
                None => compiler.expression(expr),
            })
            .collect();
        Self {
            steps: compiler.steps,
            roots,
        }
    }

    /// The value of expression `root`, if it is the same for all paths.
    pub(crate) fn constant(&self, root: usize) -> Option<f64> {
        match self.steps[self.roots[root]] {
            Step::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// The values of the first `K` expressions along a path.
    #[inline(always)]
    pub(crate) fn evaluate<A: Arith, const K: usize>(
        &self,
        cx: &mut A,
        depth: usize,
        angles: Option<Angles<A::Real>>,
    ) -> [A::Real; K] {
        let u = cx.coordinate(Coordinate {
            depth,
            axis: Axis::U,
        });
        let v = cx.coordinate(Coordinate {
            depth,
            axis: Axis::V,
        });
        let zero = cx.real(0.0);
        let mut few = [zero; 12];
        let mut many = Vec::new();
        let values: &mut [A::Real] = if self.steps.len() <= few.len() {
            &mut few
        } else {
            many.resize(self.steps.len(), zero);
            &mut many
        };
        let angles = angles.unwrap_or(Angles {
            cos_o: zero,
            cos_a: zero,
        });
        for (number, step) in self.steps.iter().enumerate() {
            values[number] = match step {
                Step::Constant(value) => cx.real(*value),
                Step::Sampled(Axis::U, sampled) => cx.sampled(sampled, u),
                Step::Sampled(Axis::V, sampled) => cx.sampled(sampled, v),
                Step::CosO => angles.cos_o,
                Step::CosA => angles.cos_a,
                Step::Add(a, b) => cx.add(values[*a], values[*b]),
                Step::Sub(a, b) => cx.sub(values[*a], values[*b]),
                Step::Mul(a, b) => cx.mul(values[*a], values[*b]),
                Step::Div(a, b, most) => cx.div(values[*a], values[*b], *most),
                Step::Min(a, b) => cx.min(values[*a], values[*b]),
                Step::Max(a, b) => cx.max(values[*a], values[*b]),
                Step::Pow(a, b) => cx.pow(values[*a], values[*b]),
                Step::Neg(a) => cx.neg(values[*a]),
                Step::Abs(a) => cx.abs(values[*a]),
                Step::Sqrt(a) => cx.sqrt(values[*a]),
                Step::Atan2(y, x) => cx.atan2(values[*y], values[*x]),
                Step::IfLess(a, b, x, y) => {
                    let less = cx.less(values[*a], values[*b]);
                    cx.select(less, values[*x], values[*y])
                }
                Step::Powi(a, exponent) => integer_power(cx, values[*a], *exponent),
                Step::Call(function, a) => cx.function(*function, values[*a]),
            };
        }
        let mut results = [zero; K];
        for (result, &root) in results.iter_mut().zip(&self.roots) {
            *result = values[root];
        }
        results
    }
}

/// `a^exponent` by squaring.
#[inline(always)]
pub(crate) fn integer_power<A: Arith>(cx: &mut A, a: A::Real, exponent: u32) -> A::Real {
    let mut power = None;
    let mut square = a;
    let mut left = exponent;
    while left > 0 {
        if left & 1 == 1 {
            power = Some(power.map_or(square, |power| cx.mul(power, square)));
        }
        left >>= 1;
        if left > 0 {
            square = cx.mul(square, square);
        }
    }
    power.unwrap_or_else(|| cx.real(1.0))
}

impl Compiler {
    fn expression(&mut self, expr: &Expr) -> usize {
        let needs = expr.node_variables();
        let ranges = expr.ranges(&self.cells());
        let mut done: HashMap<Id, usize> = HashMap::new();
        let mut pending = vec![expr.root()];
        // Depth first without recursion: an operand's step comes before its user's.
        while let Some(&id) = pending.last() {
            if done.contains_key(&id) {
                pending.pop();
                continue;
            }
            if let Some(step) = self.tabulated(expr, id, needs[id.index()]) {
                done.insert(id, step);
                pending.pop();
                continue;
            }
            let node = &expr.nodes()[id.index()];
            let missing: Vec<Id> = node
                .operands()
                .filter(|operand| !done.contains_key(operand))
                .collect();
            if missing.is_empty() {
                let step = self.arithmetic(node, &done, ranges[id.index()]);
                done.insert(id, step);
                pending.pop();
            } else {
                pending.extend(missing);
            }
        }
        done[&expr.root()]
    }

    /// A constant or a table, if the node needs at most one coordinate.
    fn tabulated(&mut self, expr: &Expr, id: Id, needs: VariableSet) -> Option<usize> {
        if !needs.is_subset(VariableSet::SQUARE) || needs == VariableSet::SQUARE {
            return None;
        }
        let axis = if needs.contains(Variable::V) {
            Axis::V
        } else {
            Axis::U
        };
        let bits = self.bits[usize::from(axis == Axis::V)];
        let owned = expr.clone();
        let value = move |coordinate: f64| {
            let mut values = Vec::new();
            let at = Variables {
                u: coordinate,
                v: coordinate,
                ..Variables::default()
            };
            owned.eval_in(&at, &mut values);
            values[id.index()]
        };
        if needs.is_empty() {
            return Some(self.push(Step::Constant(value(0.5))));
        }
        let sampled = Sampled::of_centre(bits, value);
        // A function that does not vary over its cells is a constant, whatever it looks like.
        if let Some((first, rest)) = sampled.table().and_then(<[f64]>::split_first)
            && rest.iter().all(|value| value == first)
        {
            return Some(self.push(Step::Constant(*first)));
        }
        Some(self.push(Step::Sampled(axis, sampled)))
    }

    /// The square of the cell centres.
    fn cells(&self) -> Domain {
        let cells = |bits: u32| Interval {
            lo: centre(0, bits),
            hi: 1.0 - centre(0, bits),
        };
        Domain {
            u: cells(self.bits[0]),
            v: cells(self.bits[1]),
            ..Domain::default()
        }
    }

    fn arithmetic(
        &mut self,
        node: &Node,
        done: &HashMap<Id, usize>,
        range: Option<Interval>,
    ) -> usize {
        let most = range.map_or(f64::INFINITY, |range| range.lo.abs().max(range.hi.abs()));
        let step = match node {
            Node::Number(value) => Step::Constant(*value),
            Node::Add(a, b) => Step::Add(done[a], done[b]),
            Node::Sub(a, b) => Step::Sub(done[a], done[b]),
            Node::Mul(a, b) => Step::Mul(done[a], done[b]),
            Node::Div(a, b) => Step::Div(done[a], done[b], most),
            Node::Min(a, b) => Step::Min(done[a], done[b]),
            Node::Max(a, b) => Step::Max(done[a], done[b]),
            Node::Pow(a, b) => Step::Pow(done[a], done[b]),
            Node::Atan2(a, b) => Step::Atan2(done[a], done[b]),
            Node::IfLess(a, b, x, y) => Step::IfLess(done[a], done[b], done[x], done[y]),
            Node::Neg(a) => Step::Neg(done[a]),
            Node::Abs(a) => Step::Abs(done[a]),
            Node::Sqrt(a) => Step::Sqrt(done[a]),
            Node::Function(function, a) => Step::Call(*function, done[a]),
            Node::Powi(a, exponent) => {
                let power = self.push(Step::Powi(done[a], exponent.unsigned_abs()));
                if *exponent >= 0 {
                    return power;
                }
                let one = self.push(Step::Constant(1.0));
                Step::Div(one, power, most)
            }
            Node::Variable(Variable::CosO) => Step::CosO,
            // `u` and `v` alone are tables, and `cos_i` was replaced by `|phi_z|`.
            Node::Variable(Variable::CosA | Variable::U | Variable::V | Variable::CosI) => {
                Step::CosA
            }
        };
        self.push(step)
    }

    /// Adds a step, or finds the equal one.
    fn push(&mut self, step: Step) -> usize {
        let equal = |other: &Step| match (&step, other) {
            (Step::Constant(a), Step::Constant(b)) => a.to_bits() == b.to_bits(),
            (Step::Sampled(a, f), Step::Sampled(b, g)) => a == b && f.same(g),
            (Step::CosO, Step::CosO) | (Step::CosA, Step::CosA) => true,
            (Step::Mul(a, b), Step::Mul(c, d)) | (Step::Add(a, b), Step::Add(c, d)) => {
                (a, b) == (c, d)
            }
            _ => false,
        };
        if let Some(number) = self.steps.iter().position(equal) {
            return number;
        }
        self.steps.push(step);
        self.steps.len() - 1
    }
}
