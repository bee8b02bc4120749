//! Converts the canonical form back to nodes.

use super::{Atom, Canon, Product, Sum, is_integer};
use crate::expr::arena::Arena;
use crate::expr::{Expr, ExprNode, Id};

/// The sum as an expression; `None` if one of its numbers is not finite.
pub(super) fn write(canon: &Canon, root: &Sum) -> Option<Expr> {
    Writer {
        canon,
        arena: Arena::default(),
        written: vec![None; canon.atoms.len()],
    }
    .write(root)
}

struct Writer<'a> {
    canon: &'a Canon,
    arena: Arena,
    written: Vec<Option<Id>>,
}

impl Writer<'_> {
    fn write(mut self, root: &Sum) -> Option<Expr> {
        // Atoms contain only earlier ones, so writing those in use in order needs no recursion.
        let mut used = vec![false; self.canon.atoms.len()];
        mark(&mut used, root);
        for index in (0..used.len()).rev() {
            if used[index] {
                match &self.canon.atoms[index] {
                    Atom::Variable(_) | Atom::Number(_) => {}
                    Atom::Abs(inner) => used[*inner] = true,
                    Atom::Sum(sum) | Atom::Function(_, sum) => mark(&mut used, sum),
                    Atom::Pow(a, b) | Atom::Min(a, b) | Atom::Max(a, b) | Atom::Atan2(a, b) => {
                        mark(&mut used, a);
                        mark(&mut used, b);
                    }
                    Atom::IfLess(parts) => parts.iter().for_each(|sum| mark(&mut used, sum)),
                }
            }
        }
        for (index, atom) in self.canon.atoms.iter().enumerate() {
            if used[index] {
                self.written[index] = self.atom(atom);
            }
        }
        let root = self.sum(root)?;
        Some(self.arena.finish(root))
    }

    /// Writes an atom. The power of a number goes into the coefficient, so a number has no node
    /// here.
    fn atom(&mut self, atom: &Atom) -> Option<Id> {
        let node = match atom {
            Atom::Number(_) => return None,
            Atom::Sum(sum) => return self.sum(sum),
            Atom::Variable(variable) => ExprNode::Variable(*variable),
            Atom::Abs(inner) => ExprNode::Abs(self.written[*inner]?),
            Atom::Function(f, operand) => ExprNode::Function(*f, self.sum(operand)?),
            Atom::Pow(a, b) => ExprNode::Pow(self.sum(a)?, self.sum(b)?),
            Atom::Min(a, b) => ExprNode::Min(self.sum(a)?, self.sum(b)?),
            Atom::Max(a, b) => ExprNode::Max(self.sum(a)?, self.sum(b)?),
            Atom::Atan2(a, b) => ExprNode::Atan2(self.sum(a)?, self.sum(b)?),
            Atom::IfLess(parts) => {
                let [a, b, x, y] = &**parts;
                ExprNode::IfLess(self.sum(a)?, self.sum(b)?, self.sum(x)?, self.sum(y)?)
            }
        };
        Some(self.arena.push(node))
    }

    fn sum(&mut self, sum: &Sum) -> Option<Id> {
        // 2 - 2u is written 2 (1 - u), which is exact to the last bit where 1 - u is small.
        if let [first, rest @ ..] = &sum[..]
            && !rest.is_empty()
        {
            let size = first.coefficient.abs();
            if size != 1.0 && rest.iter().all(|term| term.coefficient.abs() == size) {
                let signs: Sum = sum
                    .iter()
                    .map(|term| Product::new(term.coefficient.signum(), term.factors.clone()))
                    .collect();
                let number = self.arena.number(size);
                let signs = self.sum(&signs)?;
                return Some(self.arena.push(ExprNode::Mul(number, signs)));
            }
        }
        // A positive term first spares a sign.
        let first = sum
            .iter()
            .position(|term| term.coefficient > 0.0)
            .unwrap_or(0);
        let Some(term) = sum.get(first) else {
            return Some(self.arena.number(0.0));
        };
        let mut total = self.product(term)?;
        for (_, term) in sum.iter().enumerate().filter(|(i, _)| *i != first) {
            let size = Product::new(term.coefficient.abs(), term.factors.clone());
            let size = self.product(&size)?;
            total = self.arena.push(if term.coefficient < 0.0 {
                ExprNode::Sub(total, size)
            } else {
                ExprNode::Add(total, size)
            });
        }
        Some(total)
    }

    fn product(&mut self, product: &Product) -> Option<Id> {
        let mut coefficient = product.coefficient;
        let mut above = Vec::new();
        let mut below = Vec::new();
        let mut root_above = Vec::new();
        let mut root_below = Vec::new();
        for factor in &product.factors {
            if let Atom::Number(value) = self.canon.atoms[factor.atom] {
                coefficient *= match factor.exponent {
                    0.5 => value.sqrt(),
                    -0.5 => 1.0 / value.sqrt(),
                    exponent => libm::pow(value, exponent),
                };
                continue;
            }
            let base = self.written[factor.atom]?;
            let exponent = factor.exponent.abs();
            let (side, roots) = if factor.exponent > 0.0 {
                (&mut above, &mut root_above)
            } else {
                (&mut below, &mut root_below)
            };
            let whole = if exponent % 1.0 == 0.5 && exponent < 64.0 {
                roots.push(base);
                exponent.trunc()
            } else {
                exponent
            };
            if whole == 1.0 {
                side.push(base);
            } else if is_integer(whole) && whole < i32::MAX.into() {
                if whole != 0.0 {
                    side.push(self.arena.push(ExprNode::Powi(base, whole as i32)));
                }
            } else {
                let exponent = self.arena.number(whole);
                side.push(self.arena.push(ExprNode::Pow(base, exponent)));
            }
        }
        if !coefficient.is_finite() || coefficient == 0.0 {
            return (product.coefficient == 0.0).then(|| self.arena.number(0.0));
        }
        for (roots, side) in [(root_above, &mut above), (root_below, &mut below)] {
            if let Some(product) = self.chain(&roots) {
                side.push(self.arena.push(ExprNode::Sqrt(product)));
            }
        }
        let below = self.chain(&below);
        let mut factors = Vec::new();
        if coefficient.abs() != 1.0 || (above.is_empty() && (coefficient == 1.0 || below.is_some()))
        {
            factors.push(self.arena.number(coefficient));
        }
        factors.extend(above);
        let mut value = match self.chain(&factors) {
            Some(value) => value,
            None => self.arena.number(coefficient),
        };
        if let Some(below) = below {
            value = self.arena.push(ExprNode::Div(value, below));
        }
        if coefficient == -1.0 && !matches!(self.arena.node(value), ExprNode::Number(_)) {
            let signed = matches!(self.arena.node(value), ExprNode::Div(a, _)
                if matches!(self.arena.node(a), ExprNode::Number(_)));
            if !signed {
                value = self.arena.push(ExprNode::Neg(value));
            }
        }
        Some(value)
    }

    fn chain(&mut self, factors: &[Id]) -> Option<Id> {
        let (first, rest) = factors.split_first()?;
        Some(rest.iter().fold(*first, |product, id| {
            self.arena.push(ExprNode::Mul(product, *id))
        }))
    }
}

fn mark(used: &mut [bool], sum: &Sum) {
    for factor in sum.iter().flat_map(|product| &product.factors) {
        used[factor.atom] = true;
    }
}
