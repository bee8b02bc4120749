//! `&`, `|` and `!` of whole registers, in `^=`: the same of each of their bits.

use super::bit::not;
use super::dim::Linear;
use super::ir::{Bit, Place, Statement, StatementKind as K, Term, Update};
use super::scope::{Scope, integer};
use super::source::text;
use proc_macro2::{Span, TokenStream};
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use syn::{BinOp, Expr, Ident, UnOp};

/// An expression of whole registers.
enum Word {
    Constant(i128),
    /// A register, and the first of its bits.
    Bits(Place, Linear),
    Not(Box<Word>),
    Pair(Pair, Box<Word>, Box<Word>),
}

#[derive(Clone, Copy)]
enum Pair {
    And,
    Or,
    Xor,
}

impl Word {
    /// Returns one of the bits; a constant is known only at a known place.
    fn bit(&self, place: &Linear) -> Bit {
        match self {
            Self::Constant(units) => {
                let place = place.known().unwrap_or(0).clamp(0, 127);
                Bit::Constant(units >> place & 1 == 1)
            }
            Self::Bits(own, first) => Bit::At(own.register.clone(), first.plus(place)),
            Self::Not(inner) => not(inner.bit(place)),
            Self::Pair(pair, a, b) => joined(*pair, a.bit(place), b.bit(place)),
        }
    }

    fn has_constants(&self) -> bool {
        match self {
            Self::Constant(_) => true,
            Self::Bits(..) => false,
            Self::Not(inner) => inner.has_constants(),
            Self::Pair(_, a, b) => a.has_constants() || b.has_constants(),
        }
    }
}

/// Returns `a & b`, `a | b` or `a ^ b`, which is simpler if one of the two is known.
fn joined(pair: Pair, a: Bit, b: Bit) -> Bit {
    match (pair, a, b) {
        (Pair::Xor, Bit::Constant(false), bit)
        | (Pair::Xor, bit, Bit::Constant(false))
        | (Pair::And, Bit::Constant(true), bit)
        | (Pair::And, bit, Bit::Constant(true)) => bit,
        (Pair::Xor, Bit::Constant(true), bit) | (Pair::Xor, bit, Bit::Constant(true)) => not(bit),
        (Pair::Xor, a, b) => Bit::Xor(Box::new(a), Box::new(b)),
        (Pair::And, Bit::Constant(false), _) | (Pair::And, _, Bit::Constant(false)) => {
            Bit::Constant(false)
        }
        (Pair::And, a, b) => Bit::And(Box::new(a), Box::new(b)),
        (Pair::Or, a, b) => not(joined(Pair::And, not(a), not(b))),
    }
}

impl Scope {
    /// True if an expression combines numbers, not bits, by `&`, `|` or `!`.
    pub(super) fn is_bitwise(&self, expression: &Expr) -> bool {
        match expression {
            Expr::Paren(inner) => self.is_bitwise(&inner.expr),
            Expr::Group(inner) => self.is_bitwise(&inner.expr),
            Expr::Unary(unary) => matches!(unary.op, UnOp::Not(_)) && !self.is_bit(&unary.expr),
            Expr::Binary(binary) => match binary.op {
                BinOp::BitAnd(_) | BinOp::BitOr(_) => !self.is_bit(expression),
                BinOp::BitXor(_) => self.is_bitwise(&binary.left) || self.is_bitwise(&binary.right),
                _ => false,
            },
            _ => false,
        }
    }

    /// Reads `target ^= expression` of whole registers.
    pub(super) fn bitwise(
        &mut self,
        target: &Place,
        expression: &Expr,
        source: &TokenStream,
    ) -> Option<K> {
        let (first, width) = match &target.part {
            Some([first, width]) => (first.clone(), width.clone()),
            None => (Linear::from(0), target.register.format.width.clone()),
        };
        let word = self.combined(expression, target, &width)?;
        let one = |place: &Linear| {
            let mut terms = Vec::new();
            split(word.bit(place), expression, &mut terms);
            let part = Some([first.plus(place), 1.into()]);
            let register = target.register.clone();
            let kind = K::Update(Place { register, part }, terms);
            let source = source.clone();
            Statement { kind, source }
        };
        if let Some(known) = width.known() {
            return Some(K::Block(
                (0..known).map(|place| one(&place.into())).collect(),
            ));
        }
        if word.has_constants() {
            let message = "a constant beside registers whose width is not known here";
            let help = "write `^=` of the bits where the constant has ones, one by one";
            self.problems
                .add(codes::REV_CONSTANT, expression, message, help);
            return None;
        }
        let variable = Ident::new("__bit", Span::call_site());
        let body = vec![one(&Linear::name(&variable))];
        Some(K::For {
            variable,
            bounds: [0.into(), width],
            reversed: false,
            body,
        })
    }

    fn combined(&mut self, expression: &Expr, target: &Place, width: &Linear) -> Option<Word> {
        match expression {
            Expr::Paren(inner) => return self.combined(&inner.expr, target, width),
            Expr::Group(inner) => return self.combined(&inner.expr, target, width),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                let inner = self.combined(&unary.expr, target, width)?;
                return Some(Word::Not(Box::new(inner)));
            }
            Expr::Binary(binary) => {
                let pair = match binary.op {
                    BinOp::BitAnd(_) => Some(Pair::And),
                    BinOp::BitOr(_) => Some(Pair::Or),
                    BinOp::BitXor(_) => Some(Pair::Xor),
                    _ => None,
                };
                if let Some(pair) = pair {
                    let a = self.combined(&binary.left, target, width);
                    let b = self.combined(&binary.right, target, width);
                    return Some(Word::Pair(pair, Box::new(a?), Box::new(b?)));
                }
            }
            Expr::Path(_) | Expr::Index(_) if self.given(expression).is_none() => {
                let place = self.place(expression)?;
                return self.operand_bits(place, expression, target, width);
            }
            _ => {}
        }
        if let Some(units @ 0..) = integer(expression) {
            let bits = super::constant::bits(units);
            if width.known().is_some_and(|width| bits > width) {
                let message = format!("`{units}` takes {bits} bits, and the target has {width}");
                let help = "write a smaller constant, or use a wider target";
                self.problems
                    .add(codes::REV_WIDTH, expression, &message, help);
                return None;
            }
            return Some(Word::Constant(units));
        }
        let shown = text(expression);
        let message = format!("`{shown}` beside `&`, `|` or `!`, which combine registers");
        let help = "compute it into a scratch register in `within!`, and name that";
        self.problems
            .add(codes::REV_OPERATOR, expression, &message, help);
        None
    }

    /// Returns the bits of a place, whose number must be that of the target.
    fn operand_bits(
        &mut self,
        place: Place,
        source: &Expr,
        target: &Place,
        width: &Linear,
    ) -> Option<Word> {
        let (first, own) = match &place.part {
            Some([first, own]) => (first.clone(), own.clone()),
            None => (Linear::from(0), place.register.format.width.clone()),
        };
        let shown = text(source);
        let message = format!("QRT0806: `{shown}` has not the width of its target");
        if !self.holds(&own.minus(width), &message) || !self.holds(&width.minus(&own), &message) {
            let message = format!("`{shown}` has {own} bits, and its target {width}");
            let longer = own.minus(width).known().is_some_and(|more| more > 0);
            let help = if longer && place.part.is_none() {
                format!("name {width} of its bits: `{shown}[0..{width}]`")
            } else {
                format!("name {own} bits of the target, or use a register of {width} bits")
            };
            self.problems.add(codes::REV_WIDTH, source, &message, &help);
            return None;
        }
        if !self.apart(&place, target) {
            self.alias(target, source);
            return None;
        }
        Some(Word::Bits(place, first))
    }
}

/// Adds the terms of a bit, each of which is read on its own.
fn split(bit: Bit, source: &Expr, terms: &mut Vec<(Update, Term)>) {
    match bit {
        Bit::Constant(false) => {}
        Bit::Constant(true) => terms.push((Update::Xor, Term::Bit(bit, quote!(true)))),
        Bit::Xor(a, b) => {
            split(*a, source, terms);
            split(*b, source, terms);
        }
        Bit::Not(inner) => {
            split(*inner, source, terms);
            split(Bit::Constant(true), source, terms);
        }
        bit => terms.push((Update::Xor, Term::Bit(bit, source.to_token_stream()))),
    }
}
