//! The expression language of maps and BSDFs: parse, evaluate, differentiate, simplify, bound.
//!
//! A scene's author writes the map `phi(u, v)` from the unit square to directions, and the value
//! `f` of a BSDF, as formulas. The Jacobian of the change of variables,
//! `J = |dphi/du x dphi/dv|`, then follows by exact differentiation, and products that cancel on
//! paper (`f |n.i| J` of a Lambertian under the cosine map is its albedo) cancel here too.
//!
//! ```
//! use qrt_syntax::expr::{Expr, Variable, Variables};
//!
//! let r = Expr::parse("sqrt(u)", &[Variable::U, Variable::V]).unwrap();
//! let slope = &r * &r.diff(Variable::U);
//! assert_eq!(slope.simplify().to_string(), "0.5");
//! assert_eq!(r.eval(&Variables { u: 0.25, ..Variables::default() }), 0.5);
//! ```
//!
//! # The language
//!
//! Numbers (`2`, `0.5`, `1e-3`), `pi`, the variables that the place allows, `+ - * / ^` and
//! parentheses. `^` binds tightest, to the right, and a sign in front of a power applies to the
//! whole power: `-u^2` is `-(u^2)`, `2^3^2` is `2^9`. Functions: `sqrt sin cos tan asin acos atan
//! exp log abs` of one argument, `atan2 pow min max` of two, and `if_less(a, b, x, y)`, which is `x`
//! where `a < b` and `y` elsewhere. There is no implied multiplication.
//!
//! # The representation
//!
//! An [`Expr`] is a list of [`ExprNode`]s whose operands stand earlier in the list, without two
//! equal nodes: walking it in order evaluates every shared subexpression once.

mod arena;
mod diff;
mod display;
mod eval;
mod grid;
mod interval;
mod parse;
#[cfg(test)]
mod properties;
mod simplify;
#[cfg(test)]
mod tests;

use arena::Arena;
pub use grid::OnGrid;
pub use interval::{Domain, Interval};
pub use parse::function_names;
#[cfg(test)]
use parse::{MAX_DEPTH, MAX_LENGTH};
use std::ops;

/// The index of a [`ExprNode`] in [`Expr::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(u32);

impl Id {
    /// The index into [`Expr::nodes`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A variable of expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variable {
    /// `u`, the first coordinate of the unit square, in (0, 1).
    U,
    /// `v`, the second coordinate of the unit square, in (0, 1).
    V,
    /// `cos_i` = |n.i|, of the sampled direction towards the light, in [0, 1].
    CosI,
    /// `cos_o` = |n.o|, of the direction towards the viewer, in [0, 1].
    CosO,
    /// `cos_a` = i . mirror(o), of the angle to the mirror direction, in [-1, 1].
    CosA,
    /// `x`, the first coordinate of the point that is hit, in units of the scene.
    X,
    /// `y`, the second coordinate.
    Y,
    /// `z`, the third coordinate.
    Z,
}

impl Variable {
    /// All variables, in the order of their definition.
    pub const ALL: [Self; 8] = [
        Self::U,
        Self::V,
        Self::CosI,
        Self::CosO,
        Self::CosA,
        Self::X,
        Self::Y,
        Self::Z,
    ];
    /// The coordinates of the point that is hit.
    pub const POINT: [Self; 3] = [Self::X, Self::Y, Self::Z];
    /// The variables of a density of directions.
    pub const ANGLES: [Self; 3] = [Self::CosI, Self::CosO, Self::CosA];
    /// The variables of a map or a Jacobian.
    pub const SQUARE: [Self; 2] = [Self::U, Self::V];

    /// The variable's name in a formula.
    pub fn name(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::V => "v",
            Self::CosI => "cos_i",
            Self::CosO => "cos_o",
            Self::CosA => "cos_a",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

/// A set of variables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct VariableSet(u8);

impl VariableSet {
    /// The empty set.
    pub const EMPTY: Self = Self(0);
    /// `u` and `v`.
    pub const SQUARE: Self = Self(1 << Variable::U as u8 | 1 << Variable::V as u8);

    /// The set that holds `variable` alone.
    pub(crate) fn from_variable(variable: Variable) -> Self {
        Self(1 << variable as u8)
    }
    /// True if the set holds any of `variables`.
    pub fn has_any(self, variables: &[Variable]) -> bool {
        variables.iter().any(|variable| self.contains(*variable))
    }
    /// True if the set holds `variable`.
    pub fn contains(self, variable: Variable) -> bool {
        self.0 & Self::from_variable(variable).0 != 0
    }
    /// The variables that are in this set, in `other` or in both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    /// True if all variables of this set are in `other`.
    pub fn is_subset(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }
    /// True if the set is empty: the expression is constant.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
    /// The set's members in the order of [`Variable::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Variable> {
        Variable::ALL.into_iter().filter(move |v| self.contains(*v))
    }
}

/// A value for each variable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Variables {
    pub u: f64,
    pub v: f64,
    pub cos_i: f64,
    pub cos_o: f64,
    pub cos_a: f64,
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

impl Variables {
    /// The value of `variable`.
    pub fn get(&self, variable: Variable) -> f64 {
        match variable {
            Variable::U => self.u,
            Variable::V => self.v,
            Variable::CosI => self.cos_i,
            Variable::CosO => self.cos_o,
            Variable::CosA => self.cos_a,
            Variable::X => self.x,
            Variable::Y => self.y,
            Variable::Z => self.z,
        }
    }
}

/// A function of one argument that is not algebraic. Angles are in radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Exp,
    /// The natural logarithm.
    Log,
}

impl Function {
    /// All functions, in the order of their definition.
    pub const ALL: [Self; 8] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Exp,
        Self::Log,
    ];

    /// The function's name in a formula.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Exp => "exp",
            Self::Log => "log",
        }
    }
}

/// One operation; its operands are earlier nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum ExprNode {
    /// A finite number.
    Number(f64),
    Variable(Variable),
    Neg(Id),
    Add(Id, Id),
    Sub(Id, Id),
    Mul(Id, Id),
    Div(Id, Id),
    /// An integer power, by repeated squaring.
    Powi(Id, i32),
    /// Any other power.
    Pow(Id, Id),
    Sqrt(Id),
    Abs(Id),
    Min(Id, Id),
    Max(Id, Id),
    Function(Function, Id),
    /// The angle of the vector (second, first), as in C.
    Atan2(Id, Id),
    /// The third where the first is less than the second, the fourth elsewhere.
    IfLess(Id, Id, Id, Id),
}

/// An expression. See the [module](self).
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    nodes: Vec<ExprNode>,
    root: Id,
}

impl Expr {
    /// A constant; `None` unless it is finite.
    pub fn number(value: f64) -> Option<Self> {
        value.is_finite().then(|| Self {
            nodes: vec![ExprNode::Number(value)],
            root: Id(0),
        })
    }

    /// The constant pi.
    pub fn pi() -> Self {
        Self {
            nodes: vec![ExprNode::Number(std::f64::consts::PI)],
            root: Id(0),
        }
    }

    /// A variable.
    pub fn variable(variable: Variable) -> Self {
        Self {
            nodes: vec![ExprNode::Variable(variable)],
            root: Id(0),
        }
    }

    /// The nodes; operands first, no two equal, all of them in use.
    pub fn nodes(&self) -> &[ExprNode] {
        &self.nodes
    }

    /// The node that is the expression's value: the last.
    pub fn root(&self) -> Id {
        self.root
    }

    /// The expression's value, where it is a plain number.
    pub fn constant(&self) -> Option<f64> {
        match self.nodes[self.root.index()] {
            ExprNode::Number(value) => Some(value),
            _ => None,
        }
    }

    /// The absolute value of this expression.
    pub fn abs(&self) -> Self {
        self.with(self, |a, _| ExprNode::Abs(a))
    }

    /// The greater of this expression and 0.
    pub fn positive(&self) -> Self {
        let zero = self.with(self, |_, _| ExprNode::Number(0.0));
        self.with(&zero, ExprNode::Max)
    }

    /// The square root of this expression.
    pub fn sqrt(&self) -> Self {
        self.with(self, |a, _| ExprNode::Sqrt(a))
    }

    /// The function `f` of this expression.
    pub fn apply(&self, f: Function) -> Self {
        self.with(self, |a, _| ExprNode::Function(f, a))
    }

    /// An integer power of this expression.
    pub fn powi(&self, power: i32) -> Self {
        self.with(self, |a, _| ExprNode::Powi(a, power))
    }

    /// `then` where this expression is less than `other`, `otherwise` elsewhere.
    pub fn if_less(&self, other: &Self, then: &Self, otherwise: &Self) -> Self {
        let mut arena = Arena::default();
        let [a, b, x, y] = [self, other, then, otherwise].map(|operand| arena.import(operand));
        let root = arena.push(ExprNode::IfLess(a, b, x, y));
        arena.finish(root)
    }

    /// This expression with `variable` replaced by `by`.
    pub fn substitute(&self, variable: Variable, by: &Self) -> Self {
        let mut arena = Arena::default();
        let by = arena.import(by);
        let mut ids = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            ids.push(match *node {
                ExprNode::Variable(v) if v == variable => by,
                _ => arena.push(node.map_operands(|id| ids[id.index()])),
            });
        }
        arena.finish(ids[self.root.index()])
    }

    /// Numerator and denominator of a quotient; of anything else itself and 1.
    pub fn fraction(&self) -> [Self; 2] {
        let part = |id| {
            let mut arena = Arena::default();
            arena.import(self);
            arena.finish(id)
        };
        match self.nodes[self.root.index()] {
            ExprNode::Div(a, b) => [part(a), part(b)],
            _ => [self.clone(), Self::from(1)],
        }
    }

    fn with(&self, other: &Self, node: impl Fn(Id, Id) -> ExprNode) -> Self {
        let mut arena = Arena::default();
        let a = arena.import(self);
        let b = arena.import(other);
        let root = arena.push(node(a, b));
        arena.finish(root)
    }
}

impl From<i32> for Expr {
    fn from(value: i32) -> Self {
        Self {
            nodes: vec![ExprNode::Number(value.into())],
            root: Id(0),
        }
    }
}

impl ops::Neg for &Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        self.with(self, |a, _| ExprNode::Neg(a))
    }
}

impl ops::Add for &Expr {
    type Output = Expr;
    fn add(self, other: &Expr) -> Expr {
        self.with(other, ExprNode::Add)
    }
}

impl ops::Sub for &Expr {
    type Output = Expr;
    fn sub(self, other: &Expr) -> Expr {
        self.with(other, ExprNode::Sub)
    }
}

impl ops::Mul for &Expr {
    type Output = Expr;
    fn mul(self, other: &Expr) -> Expr {
        self.with(other, ExprNode::Mul)
    }
}

impl ops::Div for &Expr {
    type Output = Expr;
    fn div(self, other: &Expr) -> Expr {
        self.with(other, ExprNode::Div)
    }
}
