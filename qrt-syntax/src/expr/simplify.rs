//! Simplification: a canonical form that merges like terms, and the conversion back.
//!
//! A [`Sum`] is a list of products; a [`Product`] is a number times powers of [`Atom`]s; an atom is
//! a variable, a function of sums, or a sum that stands as a factor. Then `a b - b a` is an empty
//! list, `sqrt(u) / (2 sqrt(u))` has the exponents 1/2 - 1/2, and `sin^2 + cos^2` are two terms
//! that differ in two exponents.
//!
//! The result equals the original up to rounding at every point of the domain (`u`, `v` in (0, 1),
//! the cosines in their ranges) where the original and all its parts have finite values. Where the
//! original has no value, the result may have one: `x/x` becomes 1. So a check that a formula is
//! defined must use the formula as written.

use super::{Domain, Expr, ExprNode, Function, Id, Interval, Variable};
use std::collections::HashMap;

mod rules;
mod write;

/// Maximum number of parts, more than any formula of a scene has. A larger expression is left as it
/// is.
const MAX_PARTS: usize = 200_000;

/// Maximum relative difference that counts as rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Expr {
    /// Returns a shorter expression of the same value (up to rounding) wherever this one and all
    /// its parts are finite; a copy if there is none.
    ///
    /// ```
    /// use qrt_syntax::expr::{Expr, Variable};
    /// let simple = |text| Expr::parse(text, &Variable::SQUARE).unwrap().simplify().to_string();
    /// assert_eq!(simple("sqrt(u)*(1/(2*sqrt(u)))"), "0.5");
    /// assert_eq!(simple("sin(v)^2 + cos(v)^2"), "1");
    /// assert_eq!(simple("abs(u - 1)"), "1 - u");
    /// ```
    pub fn simplify(&self) -> Self {
        match canonical(self) {
            Some(short) if cost(&short) <= cost(self) => short,
            _ => self.clone(),
        }
    }
}

/// The rough cost of evaluation, in additions.
fn cost(expr: &Expr) -> usize {
    let weigh = |node: &ExprNode| match node {
        ExprNode::Number(_) | ExprNode::Variable(_) => 0,
        ExprNode::Div(..) | ExprNode::Sqrt(_) => 4,
        ExprNode::Function(..) | ExprNode::Pow(..) | ExprNode::Atan2(..) => 16,
        ExprNode::Powi(_, n) => (32 - n.unsigned_abs().leading_zeros()) as usize,
        _ => 1,
    };
    expr.nodes().iter().map(weigh).sum()
}

type Atoms = usize;

/// An atom to a power.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Factor {
    atom: Atoms,
    exponent: f64,
}

/// A number times factors in the order of their atoms, each once, no exponent 0.
#[derive(Clone, Debug, PartialEq)]
struct Product {
    coefficient: f64,
    factors: Vec<Factor>,
}

impl Factor {
    fn new(atom: Atoms, exponent: f64) -> Self {
        Self { atom, exponent }
    }
}

impl Product {
    fn new(coefficient: f64, factors: Vec<Factor>) -> Self {
        Self {
            coefficient,
            factors,
        }
    }

    /// The atom, if one to the power 1 is all there is beside the coefficient.
    fn lone(&self) -> Option<Atoms> {
        match self.factors[..] {
            [factor] if factor.exponent == 1.0 => Some(factor.atom),
            _ => None,
        }
    }
}

/// Products with distinct factors, in order, no coefficient 0.
type Sum = Vec<Product>;

#[derive(Clone, Debug)]
enum Atom {
    Variable(Variable),
    /// A positive number to a power that has no exact value.
    Number(f64),
    Sum(Sum),
    Abs(Atoms),
    Function(Function, Sum),
    Pow(Sum, Sum),
    Min(Sum, Sum),
    Max(Sum, Sum),
    Atan2(Sum, Sum),
    IfLess(Box<[Sum; 4]>),
}

struct Canon {
    atoms: Vec<Atom>,
    /// The known bounds of each atom's value over the whole domain.
    ranges: Vec<Interval>,
    known: HashMap<Vec<u64>, Atoms>,
    parts: usize,
}

/// The canonical form as an expression; `None` if it is too large or not finite.
fn canonical(expr: &Expr) -> Option<Expr> {
    let mut canon = Canon {
        atoms: Vec::new(),
        ranges: Vec::new(),
        known: HashMap::new(),
        parts: 0,
    };
    let mut sums: Vec<Sum> = Vec::with_capacity(expr.nodes().len());
    for node in expr.nodes() {
        let sum = canon.node(*node, &sums)?;
        canon.parts += sum.iter().map(|p| 1 + p.factors.len()).sum::<usize>();
        if canon.parts > MAX_PARTS {
            return None;
        }
        sums.push(sum);
    }
    let root = &sums[expr.root().index()];
    write::write(&canon, root)
}

fn number(value: f64) -> Option<Sum> {
    if !value.is_finite() {
        return None;
    }
    Some(if value == 0.0 {
        Vec::new()
    } else {
        vec![Product::new(value, Vec::new())]
    })
}

fn constant(sum: &Sum) -> Option<f64> {
    match &sum[..] {
        [] => Some(0.0),
        [product] if product.factors.is_empty() => Some(product.coefficient),
        _ => None,
    }
}

/// Rounds an exponent to a multiple of 1/2 if only rounding separates them, as in `1/51 + 50/51`.
fn settled(exponent: f64) -> f64 {
    let near = (exponent * 2.0).round() / 2.0;
    if (exponent - near).abs() <= ROUNDING * exponent.abs().max(1.0) {
        near
    } else {
        exponent
    }
}

fn is_even(exponent: f64) -> bool {
    exponent % 2.0 == 0.0
}

fn is_integer(exponent: f64) -> bool {
    exponent == exponent.trunc()
}

fn scaled(sum: &Sum, by: f64) -> Option<Sum> {
    let scale = |p: &Product| {
        let coefficient = p.coefficient * by;
        (coefficient.is_finite() && coefficient != 0.0)
            .then(|| Product::new(coefficient, p.factors.clone()))
    };
    sum.iter().map(scale).collect()
}

fn negated(sum: &Sum) -> Sum {
    sum.iter()
        .map(|p| Product::new(-p.coefficient, p.factors.clone()))
        .collect()
}

impl Canon {
    fn node(&mut self, node: ExprNode, sums: &[Sum]) -> Option<Sum> {
        let of = |id: Id| &sums[id.index()];
        match node {
            ExprNode::Number(value) => number(value),
            ExprNode::Variable(variable) => Some(self.single(Atom::Variable(variable))),
            ExprNode::Neg(a) => Some(negated(of(a))),
            ExprNode::Add(a, b) => self.add(of(a).clone(), of(b)),
            ExprNode::Sub(a, b) => self.add(of(a).clone(), &negated(of(b))),
            ExprNode::Mul(a, b) => self.multiply(of(a), of(b)),
            ExprNode::Div(a, b) => self.divide(of(a), of(b)),
            ExprNode::Powi(a, n) => self.raise(of(a), n.into()),
            ExprNode::Sqrt(a) => self.raise(of(a), 0.5),
            ExprNode::Pow(a, b) => {
                if let Some(exponent) = self.value(of(b)) {
                    return self.raise(of(a), exponent);
                }
                Some(self.single(Atom::Pow(of(a).clone(), of(b).clone())))
            }
            ExprNode::Abs(a) => self.abs(of(a)),
            ExprNode::Min(a, b) => {
                let (below, above) = (self.range(of(a)), self.range(of(b)));
                if of(a) == of(b) || below.hi <= above.lo {
                    return Some(of(a).clone());
                }
                if above.hi <= below.lo {
                    return Some(of(b).clone());
                }
                Some(self.single(Atom::Min(of(a).clone(), of(b).clone())))
            }
            ExprNode::Max(a, b) => {
                let (below, above) = (self.range(of(a)), self.range(of(b)));
                if of(a) == of(b) || below.lo >= above.hi {
                    return Some(of(a).clone());
                }
                if above.lo >= below.hi {
                    return Some(of(b).clone());
                }
                Some(self.single(Atom::Max(of(a).clone(), of(b).clone())))
            }
            ExprNode::IfLess(a, b, x, y) => {
                let (left, right) = (self.range(of(a)), self.range(of(b)));
                if left.hi < right.lo {
                    return Some(of(x).clone());
                }
                if of(x) == of(y) || left.lo >= right.hi || of(a) == of(b) {
                    return Some(of(y).clone());
                }
                let parts = [a, b, x, y].map(|id| of(id).clone());
                Some(self.single(Atom::IfLess(Box::new(parts))))
            }
            ExprNode::Atan2(a, b) => {
                if let (Some(a), Some(b)) = (self.value(of(a)), self.value(of(b))) {
                    return number(libm::atan2(a, b));
                }
                Some(self.single(Atom::Atan2(of(a).clone(), of(b).clone())))
            }
            ExprNode::Function(f, a) => self.function(f, of(a)),
        }
    }

    /// Returns the sum as one product. A sum of several terms is its largest coefficient times an
    /// atom that is the same for all multiples of it. The atom is not negative if that can be
    /// known.
    fn product(&mut self, sum: &Sum) -> Option<Product> {
        match &sum[..] {
            [] => Some(Product::new(0.0, Vec::new())),
            [product] => Some(product.clone()),
            terms => {
                let mut content = terms[0].coefficient;
                for term in terms {
                    if term.coefficient.abs() > content.abs() {
                        content = term.coefficient;
                    }
                }
                content = content.abs();
                let range = self.range(sum);
                if range.hi <= 0.0 || (range.lo < 0.0 && terms[0].coefficient < 0.0) {
                    content = -content;
                }
                let scale = |p: &Product| {
                    let coefficient = p.coefficient / content;
                    (coefficient != 0.0).then(|| Product::new(coefficient, p.factors.clone()))
                };
                let primitive = terms.iter().map(scale).collect::<Option<Sum>>()?;
                let atom = self.atom(Atom::Sum(primitive));
                let factors = vec![Factor::new(atom, 1.0)];
                Some(Product::new(content, factors))
            }
        }
    }

    fn add(&mut self, mut left: Sum, right: &Sum) -> Option<Sum> {
        for term in right {
            left.push(term.clone());
        }
        self.collect(left)
    }

    /// Merges like terms, opens sums that are alone in a term, and combines squares of sine and
    /// cosine.
    fn collect(&mut self, terms: Vec<Product>) -> Option<Sum> {
        let mut sum = self.merged(terms)?;
        while let Some(shorter) = self.pythagoras(&sum) {
            sum = self.merged(shorter)?;
        }
        Some(sum)
    }

    fn merged(&self, terms: Vec<Product>) -> Option<Sum> {
        let mut open: Vec<Product> = Vec::with_capacity(terms.len());
        for term in terms {
            match term.lone().map(|atom| &self.atoms[atom]) {
                Some(Atom::Sum(inner)) => open.extend(scaled(inner, term.coefficient)?),
                _ => open.push(term),
            }
        }
        open.sort_by(|a, b| order(&a.factors, &b.factors));
        let mut sum: Sum = Vec::with_capacity(open.len());
        let mut largest: f64 = 0.0;
        for term in open {
            match sum.last_mut() {
                Some(last) if last.factors == term.factors => {
                    largest = largest.max(term.coefficient.abs());
                    last.coefficient += term.coefficient;
                    if !last.coefficient.is_finite() {
                        return None;
                    }
                    if last.coefficient.abs() <= ROUNDING * largest {
                        last.coefficient = 0.0;
                    }
                }
                _ => {
                    largest = term.coefficient.abs();
                    sum.push(term);
                }
            }
        }
        sum.retain(|term| term.coefficient != 0.0);
        // Merge several numbers, some of them roots, into one.
        let is_number = |term: &Product| {
            term.factors
                .iter()
                .all(|factor| matches!(self.atoms[factor.atom], Atom::Number(_)))
        };
        if sum.iter().filter(|term| is_number(term)).count() > 1 {
            let (numbers, mut rest): (Sum, Sum) = sum.into_iter().partition(is_number);
            let mut total = 0.0;
            for term in numbers {
                total += self.value(&vec![term])?;
            }
            if total != 0.0 {
                rest.insert(0, Product::new(total, Vec::new()));
            }
            sum = rest;
        }
        Some(sum)
    }

    /// Applies, with R any product: c R sin^2 + c R cos^2 = c R, and c R - c R sin^2 = c R cos^2.
    fn pythagoras(&mut self, sum: &Sum) -> Option<Vec<Product>> {
        for (i, term) in sum.iter().enumerate() {
            for factor in &term.factors {
                let Atom::Function(f @ (Function::Sin | Function::Cos), angle) =
                    &self.atoms[factor.atom]
                else {
                    continue;
                };
                if !is_integer(factor.exponent) || factor.exponent < 2.0 {
                    continue;
                }
                let other = if *f == Function::Sin {
                    Function::Cos
                } else {
                    Function::Sin
                };
                let angle = angle.clone();
                let other = self.atom(Atom::Function(other, angle));
                let square = Factor::new(factor.atom, -2.0);
                let rest = self.joined(term, &[square])?;
                let partner = self.joined(&rest, &[Factor::new(other, 2.0)])?;
                for (j, candidate) in sum.iter().enumerate().filter(|(j, _)| *j != i) {
                    let (a, b) = (term.coefficient, candidate.coefficient);
                    let replacement = if candidate.factors == partner.factors && alike(a, b) {
                        &rest
                    } else if candidate.factors == rest.factors && alike(-a, b) {
                        &Product::new(b, partner.factors.clone())
                    } else {
                        continue;
                    };
                    let mut shorter = sum.clone();
                    shorter[i] = replacement.clone();
                    shorter.remove(j);
                    return Some(shorter);
                }
            }
        }
        None
    }

    /// Multiplies `product` by the factors `more`.
    fn joined(&self, product: &Product, more: &[Factor]) -> Option<Product> {
        let mut coefficient = product.coefficient;
        let mut factors = product.factors.clone();
        factors.extend_from_slice(more);
        loop {
            factors.sort_by_key(|factor| factor.atom);
            let mut merged: Vec<Factor> = Vec::with_capacity(factors.len());
            for factor in factors {
                match merged.last_mut() {
                    Some(last) if last.atom == factor.atom => {
                        last.exponent = settled(last.exponent + factor.exponent);
                    }
                    _ => merged.push(factor),
                }
            }
            let mut again = false;
            merged.retain_mut(|factor| {
                match self.atoms[factor.atom] {
                    Atom::Number(value) if is_integer(factor.exponent) => {
                        coefficient *= libm::pow(value, factor.exponent);
                        return false;
                    }
                    Atom::Abs(inner) if is_even(factor.exponent) && factor.exponent != 0.0 => {
                        factor.atom = inner;
                        again = true;
                    }
                    _ => {}
                }
                factor.exponent != 0.0
            });
            if merged.iter().any(|factor| !factor.exponent.is_finite()) {
                return None;
            }
            factors = merged;
            if !again {
                break;
            }
        }
        if coefficient == 0.0 {
            factors.clear();
        }
        coefficient
            .is_finite()
            .then_some(Product::new(coefficient, factors))
    }

    fn multiply(&mut self, a: &Sum, b: &Sum) -> Option<Sum> {
        if let Some(by) = constant(a) {
            return if by == 0.0 {
                Some(Vec::new())
            } else {
                scaled(b, by)
            };
        }
        if let Some(by) = constant(b) {
            return if by == 0.0 {
                Some(Vec::new())
            } else {
                scaled(a, by)
            };
        }
        let a = self.product(a)?;
        let b = self.product(b)?;
        let scale = Product::new(a.coefficient * b.coefficient, a.factors);
        let product = self.joined(&scale, &b.factors)?;
        self.opened(product)
    }

    fn divide(&mut self, a: &Sum, b: &Sum) -> Option<Sum> {
        let a = self.product(a)?;
        let b = self.product(b)?;
        if b.coefficient == 0.0 {
            return None;
        }
        let inverse: Vec<Factor> = b
            .factors
            .iter()
            .map(|f| Factor::new(f.atom, -f.exponent))
            .collect();
        let scale = Product::new(a.coefficient / b.coefficient, a.factors);
        let product = self.joined(&scale, &inverse)?;
        self.opened(product)
    }

    fn opened(&mut self, product: Product) -> Option<Sum> {
        if product.coefficient == 0.0 {
            Some(Vec::new())
        } else {
            self.collect(vec![product])
        }
    }

    fn raise(&mut self, base: &Sum, exponent: f64) -> Option<Sum> {
        let base = self.product(base)?;
        if exponent == 0.0 {
            return number(1.0);
        }
        if base.coefficient == 0.0 {
            return if exponent > 0.0 {
                Some(Vec::new())
            } else {
                None
            };
        }
        let power = self.power(&base, exponent)?;
        self.opened(power)
    }

    fn single(&mut self, atom: Atom) -> Sum {
        let atom = self.atom(atom);
        vec![Product::new(1.0, vec![Factor::new(atom, 1.0)])]
    }

    /// Returns the number of `atom`, that of an equal one if there is one.
    fn atom(&mut self, atom: Atom) -> Atoms {
        let key = key(&atom);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let range = self.atom_range(&atom);
        self.parts += key.len();
        let id = self.atoms.len();
        self.known.insert(key, id);
        self.atoms.push(atom);
        self.ranges.push(range);
        id
    }

    fn atom_range(&self, atom: &Atom) -> Interval {
        let range = match atom {
            Atom::Variable(variable) => Some(Domain::default().get(*variable)),
            Atom::Number(value) => Some(Interval::point(*value)),
            Atom::Sum(sum) => Some(self.range(sum)),
            Atom::Abs(inner) => Some(self.ranges[*inner].abs()),
            Atom::Function(f, operand) => self.range(operand).apply(*f),
            Atom::Pow(a, b) => self.range(a).pow(self.range(b)),
            Atom::Min(a, b) => {
                let (a, b) = (self.range(a), self.range(b));
                Some(Interval {
                    lo: a.lo.min(b.lo),
                    hi: a.hi.min(b.hi),
                })
            }
            Atom::Max(a, b) => {
                let (a, b) = (self.range(a), self.range(b));
                Some(Interval {
                    lo: a.lo.max(b.lo),
                    hi: a.hi.max(b.hi),
                })
            }
            Atom::Atan2(..) => None,
            Atom::IfLess(parts) => Some(self.range(&parts[2]).hull(self.range(&parts[3]))),
        };
        range.unwrap_or(Interval::ALL)
    }

    /// The value of a sum without variables.
    fn value(&self, sum: &Sum) -> Option<f64> {
        let [product] = &sum[..] else {
            return constant(sum);
        };
        product
            .factors
            .iter()
            .try_fold(product.coefficient, |value, factor| {
                match self.atoms[factor.atom] {
                    Atom::Number(base) => Some(value * libm::pow(base, factor.exponent)),
                    _ => None,
                }
            })
    }

    fn range(&self, sum: &Sum) -> Interval {
        let mut total = Interval::point(0.0);
        for product in sum {
            let mut range = Interval::point(product.coefficient);
            for factor in &product.factors {
                let power = self.ranges[factor.atom].pow(Interval::point(factor.exponent));
                range = range.times(power.unwrap_or(Interval::ALL));
            }
            total = total.plus(range);
        }
        total
    }
}

fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs()
}

fn order(a: &[Factor], b: &[Factor]) -> std::cmp::Ordering {
    for (a, b) in a.iter().zip(b) {
        let order = a.atom.cmp(&b.atom).then(a.exponent.total_cmp(&b.exponent));
        if order.is_ne() {
            return order;
        }
    }
    a.len().cmp(&b.len())
}

/// Returns a key that is equal only for equal atoms.
fn key(atom: &Atom) -> Vec<u64> {
    fn put(key: &mut Vec<u64>, sum: &Sum) {
        key.push(sum.len() as u64);
        for product in sum {
            key.push(product.coefficient.to_bits());
            key.push(product.factors.len() as u64);
            for factor in &product.factors {
                key.push(factor.atom as u64);
                key.push(factor.exponent.to_bits());
            }
        }
    }
    let (tag, word, sums): (u64, u64, Vec<&Sum>) = match atom {
        Atom::Variable(variable) => (0, *variable as u64, Vec::new()),
        Atom::Number(value) => (1, value.to_bits(), Vec::new()),
        Atom::Sum(sum) => (2, 0, vec![sum]),
        Atom::Abs(inner) => (3, *inner as u64, Vec::new()),
        Atom::Function(f, operand) => (4, *f as u64, vec![operand]),
        Atom::Pow(a, b) => (5, 0, vec![a, b]),
        Atom::Min(a, b) => (6, 0, vec![a, b]),
        Atom::Max(a, b) => (7, 0, vec![a, b]),
        Atom::Atan2(a, b) => (8, 0, vec![a, b]),
        Atom::IfLess(parts) => (9, 0, parts.iter().collect()),
    };
    let mut key = vec![tag, word];
    for sum in sums {
        put(&mut key, sum);
    }
    key
}
