//! Expressions in sample coordinates and angles, along a path.
//!
//! Values that depend on lattice points alone need not be computed along a path. In an expression in `u`
//! and `v`, every subexpression of one coordinate becomes a table over that coordinate's indices (a
//! QROM, in a circuit). Only subexpressions that mix coordinates or angles are arithmetic.

use super::sampled::TABLE_BITS;
use super::{Arith, Axis, Coordinate, Sampled};
use qrt_scene::sampling::cell_centre;
use qrt_syntax::expr::{Domain, Expr, ExprNode, Id, Interval, Variable, VariableSet, Variables};
use std::collections::HashMap;

/// One step of a compiled expression.
#[derive(Clone, Debug)]
enum Step {
    /// A function of one coordinate.
    Sampled(Axis, Sampled),
    /// An operation on earlier steps, those of the node's operands in their order, and a bound of
    /// the absolute values that it takes.
    Node(ExprNode, [usize; 4], f64),
}

/// Expressions in `u`, `v`, angles and the point that is hit, compiled together for one depth.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    steps: Vec<Step>,
    roots: Vec<usize>,
}

/// The angles that an expression may read, by their names in it, and the point that is hit.
#[derive(Clone, Copy)]
pub(crate) struct Angles<R> {
    /// `|n.i|`, of the sampled direction.
    pub(crate) cos_i: R,
    /// `|n.o|`, towards the viewer.
    pub(crate) cos_o: R,
    /// `i.mirror(o)`
    pub(crate) cos_a: R,
    /// The point, in stage units: not read unless a value reads it.
    pub(crate) point: [R; 3],
}

struct Compiler {
    on: Domain,
    bits: [u32; 2],
    most_stored: u32,
    steps: Vec<Step>,
}

impl Compiled {
    /// Compiles `expressions` for coordinates of `bits` bits, on the domain `on` of the other variables.
    /// Tables of at most `most_stored` index bits are stored. If `cos_i` is given, it is `phi_z`, whose
    /// absolute value replaces the variable; otherwise that is an angle.
    pub(crate) fn new(
        expressions: &[&Expr],
        (bits, most_stored): ([u32; 2], u32),
        cos_i: Option<&Expr>,
        on: Domain,
    ) -> Self {
        let mut compiler = Compiler {
            on,
            bits,
            most_stored,
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
            Step::Node(ExprNode::Number(value), ..) => Some(value),
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
        let u = cx.coordinate(Coordinate::u(depth));
        let v = cx.coordinate(Coordinate::v(depth));
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
            cos_i: zero,
            cos_o: zero,
            cos_a: zero,
            point: [zero; 3],
        });
        for (number, step) in self.steps.iter().enumerate() {
            let (node, [a, b, x, y], most) = match step {
                Step::Sampled(axis, sampled) => {
                    let index = if *axis == Axis::U { u } else { v };
                    values[number] = cx.sampled(sampled, index);
                    continue;
                }
                Step::Node(node, operands, most) => (node, *operands, *most),
            };
            values[number] = match node {
                ExprNode::Number(value) => cx.real(*value),
                ExprNode::Variable(Variable::CosO) => angles.cos_o,
                ExprNode::Variable(Variable::CosI) => angles.cos_i,
                ExprNode::Variable(Variable::X) => angles.point[0],
                ExprNode::Variable(Variable::Y) => angles.point[1],
                ExprNode::Variable(Variable::Z) => angles.point[2],
                // `u` and `v` are tables, so they do not occur here.
                ExprNode::Variable(Variable::CosA | Variable::U | Variable::V) => angles.cos_a,
                ExprNode::Add(..) => cx.add(values[a], values[b]),
                ExprNode::Sub(..) => cx.sub(values[a], values[b]),
                ExprNode::Mul(..) => cx.mul(values[a], values[b]),
                ExprNode::Div(..) => cx.quotient(values[a], values[b], most),
                ExprNode::Min(..) => cx.min(values[a], values[b]),
                ExprNode::Max(..) => cx.max(values[a], values[b]),
                ExprNode::Pow(..) => cx.pow(values[a], values[b]),
                ExprNode::Neg(..) => cx.neg(values[a]),
                ExprNode::Abs(..) => cx.abs(values[a]),
                ExprNode::Sqrt(..) => cx.sqrt(values[a]),
                ExprNode::Atan2(..) => cx.atan2(values[a], values[b]),
                ExprNode::IfLess(..) => {
                    math!(cx, select(values[a] < values[b], values[x], values[y]))
                }
                ExprNode::Powi(_, exponent) => {
                    let power = integer_power(cx, values[a], exponent.unsigned_abs());
                    if *exponent < 0 {
                        let one = cx.real(1.0);
                        cx.quotient(one, power, most)
                    } else {
                        power
                    }
                }
                ExprNode::Function(function, _) => cx.function(*function, values[a]),
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
        let part = expr.part(id);
        let value = move |coordinate: f64| {
            part.eval(&Variables {
                u: coordinate,
                v: coordinate,
                ..Variables::default()
            })
        };
        if needs.is_empty() {
            return Some(self.constant(value(0.5)));
        }
        let value = move |index: u32| value(cell_centre(index, bits));
        // A function that has one value in all cells is a constant, whatever its expression is.
        let first = value(0);
        if bits <= TABLE_BITS && (1..1 << bits).all(|index| value(index) == first) {
            return Some(self.constant(first));
        }
        let sampled = Sampled::stored(bits, self.most_stored, value);
        Some(self.push(Step::Sampled(axis, sampled)))
    }

    /// The square of the cell centres.
    fn cells(&self) -> Domain {
        let cells = |bits: u32| Interval {
            lo: cell_centre(0, bits),
            hi: 1.0 - cell_centre(0, bits),
        };
        Domain {
            u: cells(self.bits[0]),
            v: cells(self.bits[1]),
            ..self.on
        }
    }

    fn arithmetic(
        &mut self,
        node: &ExprNode,
        done: &HashMap<Id, usize>,
        range: Option<Interval>,
    ) -> usize {
        let mut operands = [0; 4];
        for (slot, id) in operands.iter_mut().zip(node.operands()) {
            *slot = done[&id];
        }
        let most = range.map_or(f64::INFINITY, |range| range.lo.abs().max(range.hi.abs()));
        self.push(Step::Node(*node, operands, most))
    }

    /// Adds a number.
    fn constant(&mut self, value: f64) -> usize {
        self.push(Step::Node(ExprNode::Number(value), [0; 4], value.abs()))
    }

    /// Adds a step, or finds an equal one.
    fn push(&mut self, step: Step) -> usize {
        let equal = |other: &Step| match (&step, other) {
            (Step::Sampled(a, f), Step::Sampled(b, g)) => a == b && f.same(g),
            (Step::Node(a, of_a, _), Step::Node(b, of_b, _)) => match (a, b) {
                (ExprNode::Number(a), ExprNode::Number(b)) => a.to_bits() == b.to_bits(),
                (ExprNode::Variable(a), ExprNode::Variable(b)) => a == b,
                (ExprNode::Mul(..), ExprNode::Mul(..)) | (ExprNode::Add(..), ExprNode::Add(..)) => {
                    of_a == of_b
                }
                _ => false,
            },
            _ => false,
        };
        if let Some(number) = self.steps.iter().position(equal) {
            return number;
        }
        self.steps.push(step);
        self.steps.len() - 1
    }
}
