//! Exact symbolic derivatives.

use super::arena::Arena;
use super::{Expr, ExprNode, Function, Id, Variable};

impl Expr {
    /// The derivative with respect to `variable`, as the rules give it: [`Expr::simplify`] makes it
    /// short.
    ///
    /// At the kinks of `abs`, `min`, `max` and `if_less` it is the derivative on one of the sides.
    /// Jumps of `if_less` are ignored.
    ///
    /// ```
    /// use qrt_syntax::expr::{Expr, Variable};
    /// let e = Expr::parse("u^3*v", &Variable::SQUARE).unwrap();
    /// assert_eq!(e.diff(Variable::U).simplify().to_string(), "3*u^2*v");
    /// ```
    pub fn diff(&self, variable: Variable) -> Self {
        let mut rules = Rules {
            arena: Arena::default(),
        };
        let mut ids = Vec::with_capacity(self.nodes.len());
        // None stands for a derivative of zero.
        let mut slopes: Vec<Option<Id>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let here = node.map_operands(|id| ids[id.index()]);
            let id = rules.arena.push(here);
            ids.push(id);
            let operands = node.operands().map(|id| slopes[id.index()]);
            let mut slope = [None; 4];
            slope
                .iter_mut()
                .zip(operands)
                .for_each(|(slot, s)| *slot = s);
            let result = match here {
                ExprNode::Variable(v) if v == variable => Some(rules.arena.number(1.0)),
                _ if slope.iter().all(Option::is_none) => None,
                _ => rules.derivative(id, here, slope),
            };
            slopes.push(result);
        }
        let root = match slopes[self.root.index()] {
            Some(id) => id,
            None => rules.arena.number(0.0),
        };
        rules.arena.finish(root)
    }
}

struct Rules {
    arena: Arena,
}

impl Rules {
    /// Returns the derivative of `node`, whose index is `id`, from those of its operands.
    fn derivative(
        &mut self,
        id: Id,
        node: ExprNode,
        [da, db, dx, dy]: [Option<Id>; 4],
    ) -> Option<Id> {
        match node {
            ExprNode::Number(_) | ExprNode::Variable(_) | ExprNode::Powi(_, 0) => None,
            ExprNode::Neg(_) => self.neg(da),
            ExprNode::Add(..) => self.add(da, db),
            ExprNode::Sub(..) => self.sub(da, db),
            ExprNode::Mul(a, b) => {
                let left = self.times(da, b);
                let right = self.times(db, a);
                self.add(left, right)
            }
            // (a/b)' = a'/b - (a/b) b'/b
            ExprNode::Div(_, b) => {
                let left = self.over(da, b);
                let right = self.times(db, id);
                let right = self.over(right, b);
                self.sub(left, right)
            }
            ExprNode::Powi(a, n) => {
                let lower = match n.checked_sub(1) {
                    Some(1) => a,
                    Some(lower) => self.arena.push(ExprNode::Powi(a, lower)),
                    // `i32::MIN` has no predecessor: use a^n / a.
                    None => self.arena.push(ExprNode::Div(id, a)),
                };
                let slope = self.times(da, lower);
                let n = self.arena.number(n.into());
                self.times(slope, n)
            }
            // b a^(b-1) a' + a^b log(a) b'
            ExprNode::Pow(a, b) => {
                let one = self.arena.number(1.0);
                let lower = self.arena.push(ExprNode::Sub(b, one));
                let power = self.arena.push(ExprNode::Pow(a, lower));
                let left = self.times(da, power);
                let left = self.times(left, b);
                let right = if db.is_some() {
                    let log = self.arena.push(ExprNode::Function(Function::Log, a));
                    let right = self.times(db, log);
                    self.times(right, id)
                } else {
                    None
                };
                self.add(left, right)
            }
            ExprNode::Sqrt(_) => {
                let two = self.arena.number(2.0);
                let twice = self.arena.push(ExprNode::Mul(two, id));
                self.over(da, twice)
            }
            ExprNode::Abs(a) => {
                let zero = self.arena.number(0.0);
                let negative = self.neg(da);
                self.select(a, zero, negative, da)
            }
            ExprNode::Min(a, b) => self.select(a, b, da, db),
            ExprNode::Max(a, b) => self.select(a, b, db, da),
            ExprNode::IfLess(a, b, ..) => self.select(a, b, dx, dy),
            ExprNode::Function(f, a) => self.function(f, id, a, da),
            // (b a' - a b') / (a^2 + b^2)
            ExprNode::Atan2(a, b) => {
                let left = self.times(da, b);
                let right = self.times(db, a);
                let top = self.sub(left, right);
                let a = self.arena.push(ExprNode::Powi(a, 2));
                let b = self.arena.push(ExprNode::Powi(b, 2));
                let norm = self.arena.push(ExprNode::Add(a, b));
                self.over(top, norm)
            }
        }
    }

    fn function(&mut self, f: Function, id: Id, a: Id, da: Option<Id>) -> Option<Id> {
        let one = self.arena.number(1.0);
        let square = |rules: &mut Self, x| rules.arena.push(ExprNode::Powi(x, 2));
        match f {
            Function::Sin => {
                let cos = self.arena.push(ExprNode::Function(Function::Cos, a));
                self.times(da, cos)
            }
            Function::Cos => {
                let sin = self.arena.push(ExprNode::Function(Function::Sin, a));
                let slope = self.times(da, sin);
                self.neg(slope)
            }
            Function::Tan => {
                let cos = self.arena.push(ExprNode::Function(Function::Cos, a));
                let cos = square(self, cos);
                self.over(da, cos)
            }
            Function::Asin | Function::Acos => {
                let a = square(self, a);
                let rest = self.arena.push(ExprNode::Sub(one, a));
                let root = self.arena.push(ExprNode::Sqrt(rest));
                let slope = self.over(da, root);
                if f == Function::Acos {
                    self.neg(slope)
                } else {
                    slope
                }
            }
            Function::Atan => {
                let a = square(self, a);
                let norm = self.arena.push(ExprNode::Add(one, a));
                self.over(da, norm)
            }
            Function::Exp => self.times(da, id),
            Function::Log => self.over(da, a),
        }
    }

    fn neg(&mut self, a: Option<Id>) -> Option<Id> {
        a.map(|a| self.arena.push(ExprNode::Neg(a)))
    }

    fn add(&mut self, a: Option<Id>, b: Option<Id>) -> Option<Id> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.arena.push(ExprNode::Add(a, b))),
            _ => a.or(b),
        }
    }

    fn sub(&mut self, a: Option<Id>, b: Option<Id>) -> Option<Id> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.arena.push(ExprNode::Sub(a, b))),
            (None, b) => self.neg(b),
            (a, None) => a,
        }
    }

    fn times(&mut self, a: Option<Id>, b: Id) -> Option<Id> {
        a.map(|a| match self.arena.node(a) {
            ExprNode::Number(1.0) => b,
            _ => self.arena.push(ExprNode::Mul(a, b)),
        })
    }

    fn over(&mut self, a: Option<Id>, b: Id) -> Option<Id> {
        a.map(|a| self.arena.push(ExprNode::Div(a, b)))
    }

    fn select(&mut self, a: Id, b: Id, x: Option<Id>, y: Option<Id>) -> Option<Id> {
        if x.is_none() && y.is_none() {
            return None;
        }
        let zero = self.arena.number(0.0);
        Some(
            self.arena
                .push(ExprNode::IfLess(a, b, x.unwrap_or(zero), y.unwrap_or(zero))),
        )
    }
}
