//! Expressions that are true or false.

use super::dim::Linear;
use super::ir::{Bit, Entry, Kind, Number, NumberKind, Place, Register};
use super::scope::Scope;
use qrt_syntax::codes;
use std::rc::Rc;
use syn::{BinOp, Expr, Lit, UnOp};

impl Scope {
    /// True if the form of an expression is that of a truth value, and not of a number.
    pub(super) fn is_bit(&self, expression: &Expr) -> bool {
        match expression {
            Expr::Paren(inner) => self.is_bit(&inner.expr),
            Expr::Group(inner) => self.is_bit(&inner.expr),
            Expr::Lit(literal) => matches!(literal.lit, Lit::Bool(_)),
            Expr::Unary(unary) => matches!(unary.op, UnOp::Not(_)) && self.is_bit(&unary.expr),
            Expr::Index(index) if self.table_path(index).is_some() => false,
            Expr::Index(index) => match &*index.expr {
                Expr::Path(path) if self.array(path).is_some() => {
                    self.array(path) == Some(Kind::Bool)
                }
                _ => !matches!(*index.index, Expr::Range(_)),
            },
            Expr::Path(path) => path.path.get_ident().is_some_and(|name| {
                let mut known = self.registers.iter();
                let is_bit =
                    |known: &Register| known.format.kind == Kind::Bool && !known.is_array();
                known.any(|known| known.name == *name && is_bit(known))
            }),
            Expr::Binary(binary) => match binary.op {
                BinOp::Eq(_)
                | BinOp::Ne(_)
                | BinOp::Lt(_)
                | BinOp::Le(_)
                | BinOp::Gt(_)
                | BinOp::Ge(_)
                | BinOp::And(_)
                | BinOp::Or(_) => true,
                BinOp::BitAnd(_) | BinOp::BitOr(_) | BinOp::BitXor(_) => {
                    self.is_bit(&binary.left) && self.is_bit(&binary.right)
                }
                _ => false,
            },
            _ => false,
        }
    }

    /// Returns the kind of the registers of an array.
    fn array(&self, path: &syn::ExprPath) -> Option<Kind> {
        let name = path.path.get_ident()?;
        let mut known = self.registers.iter();
        let array = known.find(|known| known.name == *name && known.is_array())?;
        Some(array.format.kind)
    }

    /// Reads an expression that must be true or false.
    pub(super) fn bit(&mut self, expression: &Expr) -> Option<Bit> {
        match expression {
            Expr::Paren(inner) => self.bit(&inner.expr),
            Expr::Group(inner) => self.bit(&inner.expr),
            Expr::Lit(literal) if self.is_bit(expression) => match &literal.lit {
                Lit::Bool(value) => Some(Bit::Constant(value.value)),
                _ => None,
            },
            Expr::Path(_) | Expr::Index(_) if self.is_bit(expression) => {
                let Place { register, part } = self.place(expression)?;
                let index = part.map_or_else(|| 0.into(), |[first, _]| first);
                Some(Bit::At(register, index))
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                Some(not(self.bit(&unary.expr)?))
            }
            Expr::Binary(binary) => match binary.op {
                BinOp::And(_) | BinOp::BitAnd(_) => {
                    let (a, b) = self.bits(binary)?;
                    Some(Bit::And(a, b))
                }
                BinOp::Or(_) | BinOp::BitOr(_) => {
                    let (a, b) = self.bits(binary)?;
                    Some(not(Bit::And(Box::new(not(*a)), Box::new(not(*b)))))
                }
                BinOp::BitXor(_) => {
                    let (a, b) = self.bits(binary)?;
                    Some(Bit::Xor(a, b))
                }
                BinOp::Lt(_) | BinOp::Ge(_) | BinOp::Gt(_) | BinOp::Le(_) => {
                    let (a, b) = self.compared(binary)?;
                    Some(match binary.op {
                        BinOp::Lt(_) => Bit::Less(a, b),
                        BinOp::Gt(_) => Bit::Less(b, a),
                        BinOp::Ge(_) => not(Bit::Less(a, b)),
                        _ => not(Bit::Less(b, a)),
                    })
                }
                BinOp::Eq(_) | BinOp::Ne(_) => {
                    let (a, b) = self.compared(binary)?;
                    let equal = Bit::Equal(a, b);
                    Some(if matches!(binary.op, BinOp::Eq(_)) {
                        equal
                    } else {
                        not(equal)
                    })
                }
                _ => self.not_a_bit(expression),
            },
            _ => self.not_a_bit(expression),
        }
    }

    #[cfg_attr(test, track_caller)]
    fn not_a_bit(&mut self, expression: &Expr) -> Option<Bit> {
        // A problem within the expression is more to the point.
        let before = self.problems.count();
        let known = self.number(expression).is_some();
        if known || self.problems.count() == before {
            let message = "this is a number, and a bit is needed";
            let help = "write one of its bits, `a[0]`, or a comparison such as `a != 0`";
            self.problems
                .add(codes::REV_NOT_A_BIT, expression, message, help);
        }
        None
    }

    fn bits(&mut self, binary: &syn::ExprBinary) -> Option<(Box<Bit>, Box<Bit>)> {
        let (a, b) = (self.bit(&binary.left), self.bit(&binary.right));
        Some((Box::new(a?), Box::new(b?)))
    }

    fn compared(&mut self, binary: &syn::ExprBinary) -> Option<(Box<Number>, Box<Number>)> {
        let (a, b) = (self.number(&binary.left), self.number(&binary.right));
        let (a, b) = (a?, b?);
        let source = quote::quote!(#binary);
        // Both are aligned to the fraction that their sum would have.
        let sum = self.added(&a.size, &b.size, false, &source)?;
        let help = "compare numbers of 62 bits or fewer, such as `a[0..62]`";
        self.check_bits(&sum.width, &source, help)?;
        Some((Box::new(a), Box::new(b)))
    }
}

pub(super) fn not(bit: Bit) -> Bit {
    match bit {
        Bit::Constant(value) => Bit::Constant(!value),
        Bit::Not(inner) => *inner,
        bit => Bit::Not(Box::new(bit)),
    }
}

impl Bit {
    pub(super) fn is_negated(&self) -> bool {
        matches!(self, Self::Not(_))
    }

    /// Calls `visit` with every place that it reads.
    pub(super) fn reads(&self, visit: &mut impl FnMut(Place)) {
        match self {
            Self::Constant(_) => {}
            Self::At(register, index) => {
                let part = Some([index.clone(), Linear::from(1)]);
                let register = Rc::clone(register);
                visit(Place { register, part });
            }
            Self::Not(a) => a.reads(visit),
            Self::And(a, b) | Self::Xor(a, b) => {
                a.reads(visit);
                b.reads(visit);
            }
            Self::Less(a, b) | Self::Equal(a, b) => {
                a.reads(visit);
                b.reads(visit);
            }
        }
    }
}

impl Number {
    /// Calls `visit` with every place that it reads.
    pub(super) fn reads(&self, visit: &mut impl FnMut(Place)) {
        match &self.kind {
            NumberKind::Constant(_) | NumberKind::Given(_) => {}
            NumberKind::Entry(_, entry) => {
                if let Entry::Of(place, _) = &**entry {
                    visit(place.clone());
                }
            }
            NumberKind::Word(register, first) => {
                let width = self.size.width.parts().first().cloned();
                let whole = first.is_zero() && width.as_ref() == Some(&register.format.width);
                let part = width.filter(|_| !whole).map(|width| [first.clone(), width]);
                let register = Rc::clone(register);
                visit(Place { register, part });
            }
            NumberKind::Truth(bit) => bit.reads(visit),
            NumberKind::Shifted(inner, _)
            | NumberKind::Dropped(inner, _)
            | NumberKind::Pointed(inner)
            | NumberKind::Square(inner) => inner.reads(visit),
            NumberKind::Product(a, b) => {
                a.reads(visit);
                b.reads(visit);
            }
            NumberKind::Sum(terms) => terms.iter().for_each(|(_, term)| term.reads(visit)),
        }
    }
}
