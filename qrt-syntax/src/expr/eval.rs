//! The value of an expression at a point.
//!
//! Transcendental functions are libm's, so that the same scene gives the same bits on every machine.

use super::{Expr, ExprNode, Function, Id, VariableSet, Variables};

impl Expr {
    /// The expression's value: NaN or infinite where it has none.
    pub fn eval(&self, at: &Variables) -> f64 {
        // Most expressions are short.
        let mut short = [0.0; 16];
        let mut long = Vec::new();
        let values = if let Some(short) = short.get_mut(..self.nodes.len()) {
            short
        } else {
            long.resize(self.nodes.len(), 0.0);
            &mut long
        };
        for (place, node) in self.nodes.iter().enumerate() {
            values[place] = node.value(at, |id| values[id.index()]);
        }
        values[self.root.index()]
    }

    /// Evaluates as [`Expr::eval`] does, with a reusable buffer for the values of its nodes.
    pub fn eval_in(&self, at: &Variables, values: &mut Vec<f64>) -> f64 {
        values.clear();
        for node in &self.nodes {
            let value = node.value(at, |id| values[id.index()]);
            values.push(value);
        }
        values[self.root.index()]
    }

    /// Returns the first node without a finite value on which the expression's value depends.
    /// `values` are those of its nodes, as [`Expr::eval_in`] leaves them. The branch that an
    /// `if_less` does not take does not count.
    ///
    /// # Panics
    ///
    /// Panics if `values` are fewer than the nodes.
    ///
    /// ```
    /// use qrt_syntax::expr::{Expr, Variable, Variables};
    /// let parts = |text: &str| {
    ///     let expr = Expr::parse(text, &Variable::SQUARE).unwrap();
    ///     let mut values = Vec::new();
    ///     expr.eval_in(&Variables::default(), &mut values);
    ///     expr.undefined_part(&values).map(|id| expr.nodes()[id.index()])
    /// };
    /// assert!(parts("atan(1/u)").is_some());
    /// assert!(parts("if_less(0, u, 1/u, 2)").is_none());
    /// ```
    pub fn undefined_part(&self, values: &[f64]) -> Option<Id> {
        let values = &values[..self.nodes.len()];
        if values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let mut is_needed = vec![false; self.nodes.len()];
        is_needed[self.root.index()] = true;
        for (index, node) in self.nodes.iter().enumerate().rev() {
            if !is_needed[index] {
                continue;
            }
            let untaken = match *node {
                ExprNode::IfLess(a, b, ..) if values[a.index()] < values[b.index()] => Some(3),
                ExprNode::IfLess(..) => Some(2),
                _ => None,
            };
            for (place, id) in node.operands().enumerate() {
                if untaken != Some(place) {
                    is_needed[id.index()] = true;
                }
            }
        }
        let undefined = |index: &usize| is_needed[*index] && !values[*index].is_finite();
        let first = (0..self.nodes.len()).find(undefined);
        first.map(|index| Id(index as u32))
    }

    /// The variables that the value of node `id` depends on.
    pub fn variables(&self, id: Id) -> VariableSet {
        self.node_variables()[id.index()]
    }

    /// The variables that each node depends on.
    pub fn node_variables(&self) -> Vec<VariableSet> {
        let mut sets: Vec<VariableSet> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let own = match *node {
                ExprNode::Variable(variable) => VariableSet::from_variable(variable),
                _ => VariableSet::EMPTY,
            };
            sets.push(
                node.operands()
                    .fold(own, |set, id| set.union(sets[id.index()])),
            );
        }
        sets
    }
}

impl ExprNode {
    /// The node's value, given those of its operands.
    pub fn value(&self, at: &Variables, of: impl Fn(Id) -> f64) -> f64 {
        match *self {
            Self::Number(value) => value,
            Self::Variable(variable) => at.get(variable),
            Self::Neg(a) => -of(a),
            Self::Add(a, b) => of(a) + of(b),
            Self::Sub(a, b) => of(a) - of(b),
            Self::Mul(a, b) => of(a) * of(b),
            Self::Div(a, b) => of(a) / of(b),
            Self::Powi(a, n) => powi(of(a), n),
            Self::Pow(a, b) => libm::pow(of(a), of(b)),
            Self::Sqrt(a) => of(a).sqrt(),
            Self::Abs(a) => of(a).abs(),
            Self::Min(a, b) => least(of(a), of(b)),
            Self::Max(a, b) => -least(-of(a), -of(b)),
            Self::Function(f, a) => f.value(of(a)),
            Self::Atan2(a, b) => libm::atan2(of(a), of(b)),
            Self::IfLess(a, b, x, y) => {
                let (a, b) = (of(a), of(b));
                if a.is_nan() || b.is_nan() {
                    f64::NAN
                } else if a < b {
                    of(x)
                } else {
                    of(y)
                }
            }
        }
    }
}

impl Function {
    /// The function's value at `x`.
    pub fn value(self, x: f64) -> f64 {
        match self {
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tan => libm::tan(x),
            Self::Asin => libm::asin(x),
            Self::Acos => libm::acos(x),
            Self::Atan => libm::atan(x),
            Self::Exp => libm::exp(x),
            Self::Log => libm::log(x),
        }
    }
}

/// The smaller of both; NaN if either is, unlike `f64::min`.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if a < b {
        a
    } else {
        b
    }
}

/// `x^n` by repeated squaring, least significant bit of `n` first; the reciprocal for `n < 0`.
fn powi(x: f64, n: i32) -> f64 {
    let mut result = 1.0;
    let mut square = x;
    let mut bits = n.unsigned_abs();
    while bits != 0 {
        if bits & 1 != 0 {
            result *= square;
        }
        square *= square;
        bits >>= 1;
    }
    if n < 0 { 1.0 / result } else { result }
}
