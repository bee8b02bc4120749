//! Powers, absolute values and functions of canonical forms, with their domains.

use super::{Atom, Canon, Factor, Product, Sum, is_even, is_integer, negated, number, settled};
use crate::expr::Function;

impl Canon {
    /// Raises a product to a power. A root is taken of a factor alone only if the factor is known
    /// not to be negative; factors of unknown sign stay together.
    pub(super) fn power(&mut self, base: &Product, exponent: f64) -> Option<Product> {
        let raised =
            |factor: &Factor| Factor::new(factor.atom, settled(factor.exponent * exponent));
        if is_integer(exponent) {
            let coefficient = libm::pow(base.coefficient, exponent);
            if coefficient == 0.0 {
                return None;
            }
            let factors: Vec<Factor> = base.factors.iter().map(raised).collect();
            return self.joined(&Product::new(coefficient, Vec::new()), &factors);
        }
        let mut factors = Vec::new();
        let mut unknown = Vec::new();
        for factor in &base.factors {
            if self.ranges[factor.atom].lo >= 0.0 || !is_integer(factor.exponent) {
                factors.push(raised(factor));
            } else if is_even(factor.exponent) {
                let atom = self.atom(Atom::Abs(factor.atom));
                factors.push(raised(&Factor::new(atom, factor.exponent)));
            } else {
                unknown.push(*factor);
            }
        }
        let size = base.coefficient.abs();
        match &unknown[..] {
            [] if base.coefficient < 0.0 => return None,
            [] => {}
            // x^n has a root only where x has one, for n odd.
            [factor] if base.coefficient > 0.0 => factors.push(raised(factor)),
            _ => {
                let coefficient = base.coefficient.signum();
                let atom = self.atom(Atom::Sum(vec![Product::new(coefficient, unknown)]));
                factors.push(Factor::new(atom, exponent));
            }
        }
        let exact = libm::pow(size, exponent);
        let mut coefficient = 1.0;
        if exponent.abs() == 0.5
            && libm::pow(exact, 1.0 / exponent) == size
            && exact * 8.0 % 1.0 == 0.0
        {
            coefficient = exact;
        } else if size != 1.0 {
            factors.push(Factor::new(self.atom(Atom::Number(size)), exponent));
        }
        self.joined(&Product::new(coefficient, Vec::new()), &factors)
    }

    pub(super) fn abs(&mut self, sum: &Sum) -> Option<Sum> {
        let range = self.range(sum);
        if range.lo >= 0.0 {
            return Some(sum.clone());
        }
        if range.hi <= 0.0 {
            return Some(negated(sum));
        }
        let product = self.product(sum)?;
        let mut factors = product.factors;
        for factor in &mut factors {
            let positive = self.ranges[factor.atom].lo >= 0.0;
            if !(positive || is_even(factor.exponent) || !is_integer(factor.exponent)) {
                factor.atom = self.atom(Atom::Abs(factor.atom));
            }
        }
        let size = Product::new(product.coefficient.abs(), Vec::new());
        let product = self.joined(&size, &factors)?;
        self.opened(product)
    }

    pub(super) fn function(&mut self, f: Function, operand: &Sum) -> Option<Sum> {
        if let Some(value) = self.value(operand) {
            return number(f.value(value));
        }
        if f == Function::Tan {
            let sin = self.function(Function::Sin, operand)?;
            let cos = self.function(Function::Cos, operand)?;
            return self.divide(&sin, &cos);
        }
        // f(-x) is -f(x) for odd functions, and f(x) for even ones.
        let odd = matches!(f, Function::Sin | Function::Asin | Function::Atan);
        if operand[0].coefficient < 0.0 && (odd || f == Function::Cos) {
            let positive = self.function(f, &negated(operand))?;
            return Some(if odd { negated(&positive) } else { positive });
        }
        if let [product] = &operand[..]
            && product.coefficient == 1.0
            && let Some(atom) = product.lone()
            && let Atom::Function(inner, angle) = &self.atoms[atom]
        {
            let (inner, angle) = (*inner, angle.clone());
            match (f, inner) {
                (Function::Sin, Function::Asin)
                | (Function::Cos, Function::Acos)
                | (Function::Exp, Function::Log)
                | (Function::Log, Function::Exp) => return Some(angle),
                (Function::Sin, Function::Acos) | (Function::Cos, Function::Asin) => {
                    let square = self.raise(&angle, 2.0)?;
                    let rest = self.add(number(1.0)?, &negated(&square))?;
                    return self.raise(&rest, 0.5);
                }
                _ => {}
            }
        }
        Some(self.single(Atom::Function(f, operand.clone())))
    }
}
