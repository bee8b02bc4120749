//! The terms that are added to a register, and the check that they fit.
//!
//! A sum is added term by term. Every number that a term can be must be a number of the target's
//! format:
//!
//! | target | takes |
//! |---|---|
//! | `UInt<W>`, bits of a register | unsigned numbers of at most `W` bits |
//! | `Int<W>` | unsigned ones of at most `W - 1`, signed ones of at most `W` |
//! | `UFixed<I, F>`, `Fixed<I, F>` | the same, of at most `F` bits after the point |
//! | `Bool`, a bit | bits |
//!
//! Products of numbers with a point, and numbers with a point that are shifted down, are rounded
//! down to the target's last bit. Anything else is rounded down by `floor(..)` only. `wrapping(..)`
//! takes the lowest bits of a number that is too long, and the bits of a signed number.

use super::advice;
use super::dim::{Dim, Linear};
use super::ir::{Bit, Kind, Number, NumberKind, Place, Size, Term, Update};
use super::number::GIVEN;
use super::scope::Scope;
use super::source::{begin, text, type_text};
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use syn::{BinOp, Expr, UnOp};

/// The requests of the author.
#[derive(Clone, Copy, Default)]
struct Asked {
    floor: bool,
    wrapping: bool,
}

impl Scope {
    /// Returns the terms that an update adds or subtracts.
    pub(super) fn terms(
        &mut self,
        update: Update,
        target: &Place,
        expression: &Expr,
    ) -> Option<Vec<(Update, Term)>> {
        let mut terms = Vec::new();
        let bits = target.register.format.kind == Kind::Bool
            || target
                .part
                .as_ref()
                .is_some_and(|[_, width]| width.known() == Some(1));
        if bits {
            self.bit_terms(expression, &mut terms)?;
        } else {
            self.number_terms(update, target, expression, Asked::default(), &mut terms)?;
        }
        for (_, term) in &terms {
            let mut alias = false;
            let read = |place: Place| alias |= !self.apart(&place, target);
            let source = match term {
                Term::Number(number) => {
                    number.reads(&mut { read });
                    &number.source
                }
                Term::Bit(bit, source) => {
                    bit.reads(&mut { read });
                    source
                }
            };
            if alias {
                self.alias(target, source);
            }
        }
        Some(terms)
    }

    /// Reports an operand that the statement around it changes.
    #[cfg_attr(test, track_caller)]
    pub(super) fn alias(&mut self, target: &Place, source: impl ToTokens) {
        let name = &target.register;
        let message = format!("`{name}` is read by the statement that changes it");
        let help = self
            .updated
            .as_ref()
            .map_or_else(String::new, |updated| advice::elsewhere(target, updated));
        self.problems.add(codes::REV_ALIAS, source, &message, &help);
    }

    fn bit_terms(&mut self, expression: &Expr, terms: &mut Vec<(Update, Term)>) -> Option<()> {
        match expression {
            Expr::Paren(inner) => return self.bit_terms(&inner.expr, terms),
            Expr::Group(inner) => return self.bit_terms(&inner.expr, terms),
            Expr::Binary(binary) if matches!(binary.op, BinOp::BitXor(_)) => {
                let first = self.bit_terms(&binary.left, terms);
                self.bit_terms(&binary.right, terms)?;
                return first;
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                self.bit_terms(&unary.expr, terms)?;
                let one = Term::Bit(Bit::Constant(true), quote!(true));
                terms.push((Update::Xor, one));
                return Some(());
            }
            _ => {}
        }
        let bit = match super::scope::integer(expression) {
            Some(number @ (0 | 1)) => Bit::Constant(number == 1),
            _ => self.bit(expression)?,
        };
        let source = expression.to_token_stream();
        // A negation becomes a term of its own.
        if let Bit::Not(inner) = bit {
            terms.push((Update::Xor, Term::Bit(*inner, source.clone())));
            terms.push((Update::Xor, Term::Bit(Bit::Constant(true), quote!(true))));
        } else {
            terms.push((Update::Xor, Term::Bit(bit, source)));
        }
        Some(())
    }

    fn number_terms(
        &mut self,
        update: Update,
        target: &Place,
        expression: &Expr,
        asked: Asked,
        terms: &mut Vec<(Update, Term)>,
    ) -> Option<()> {
        match expression {
            _ if self.given(expression).is_some() => {}
            Expr::Paren(inner) => {
                return self.number_terms(update, target, &inner.expr, asked, terms);
            }
            Expr::Call(call) => {
                if let Some(asked) = request(call, asked)
                    && let Some(inner) = call.args.first()
                {
                    return self.number_terms(update, target, inner, asked, terms);
                }
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) && update != Update::Xor => {
                let update = turned(update, true);
                return self.number_terms(update, target, &unary.expr, asked, terms);
            }
            Expr::Binary(binary) => {
                let subtract = matches!(binary.op, BinOp::Sub(_));
                let splits = match binary.op {
                    BinOp::Add(_) | BinOp::Sub(_) => update != Update::Xor,
                    BinOp::BitXor(_) => update == Update::Xor && !self.is_bit(expression),
                    _ => false,
                };
                if splits {
                    let first = self.number_terms(update, target, &binary.left, asked, terms);
                    let update = turned(update, subtract);
                    self.number_terms(update, target, &binary.right, asked, terms)?;
                    return first;
                }
            }
            _ => {}
        }
        self.here = begin(&expression.to_token_stream());
        let number = self.number(expression)?;
        // A negative multiple is subtracted as a positive one.
        let number = match number.kind {
            NumberKind::Sum(inner) if update != Update::Xor => {
                for (subtract, term) in inner {
                    let term = self.fitted(target, term, asked)?;
                    terms.push((turned(update, subtract), Term::Number(term)));
                }
                return Some(());
            }
            kind => Number { kind, ..number },
        };
        let term = self.fitted(target, number, asked)?;
        terms.push((update, Term::Number(term)));
        Some(())
    }

    /// Cuts a term to the bits that the target can take.
    fn fitted(&mut self, target: &Place, number: Number, asked: Asked) -> Option<Number> {
        let format = &target.register.format;
        let (width, fraction, signed, fixed) = match &target.part {
            Some([_, bits]) => (bits.clone(), Linear::from(0), false, false),
            None => (
                format.width.clone(),
                format.fraction.clone(),
                format.signed(),
                format.fixed(),
            ),
        };
        let name = match &target.part {
            None => format!("`{}`", type_text(&target.register.ty)),
            Some([_, bits]) => format!("{bits} bits of `{}`", target.register),
        };
        let Number { size, source, kind } = &number;
        let shown = text(source);
        let constant = matches!(kind, NumberKind::Constant(_));

        let below = fraction.minus(&size.fraction);
        let floors = asked.floor || (size.floors && (fixed || !size.fixed));
        let aligned = if self.certain(&below) {
            size.width.add(&below)
        } else if constant {
            let message = "QRT0808: a constant has more fraction bits than its target";
            if !self.holds(&below, message) {
                let message = format!("`{shown}` is no number of {name}");
                let units = nearest(kind, size, &fraction);
                let help = format!("write {units}, the nearest that is");
                self.problems
                    .add(codes::REV_CONSTANT, source, &message, &help);
                return None;
            }
            size.width.add(&below)
        } else if self.certain(&below.times(-1)) && floors {
            size.width.add(&below)
        } else {
            let message = format!("`{shown}` has more fraction bits than {name}");
            let help = format!("write `floor({shown})` to round it down");
            self.problems
                .add(codes::REV_FORMAT, source, &message, &help);
            return None;
        };

        if size.signed && !signed && !asked.wrapping {
            let message = format!("`{shown}` can be negative, and {name} cannot");
            let help = if constant {
                "subtract it: write `-=`".to_owned()
            } else {
                format!("use a signed target, or `wrapping({shown})` for its bits as they are")
            };
            self.problems
                .add(codes::REV_FORMAT, source, &message, &help);
            return None;
        }
        if !asked.wrapping {
            self.narrow_enough(&width, signed, &name, &aligned, &number)?;
        }
        self.something_left(&aligned, &number)?;
        if !number.is_product() {
            self.check_operand(&number)?;
        }
        Some(cut(number, &below, asked.wrapping.then_some(width)))
    }

    fn narrow_enough(
        &mut self,
        width: &Linear,
        signed: bool,
        name: &str,
        aligned: &Dim,
        number: &Number,
    ) -> Option<()> {
        let shown = text(&number.source);
        let sign = i64::from(signed && !number.size.signed);
        if let NumberKind::Given(value) = &number.kind {
            let greatest = self.greatest(value);
            if greatest.known().is_none() {
                let room = width.minus(&(sign - GIVEN).into());
                let room = aligned
                    .parts()
                    .iter()
                    .fold(room, |room, part| room.minus(part));
                let room = self.least(&room);
                let message = format!("QRT0806: `{shown}` is too large a constant for its target");
                if self.holds(&room, &message) {
                    let (greatest, room) = (greatest.grouped(), room.grouped());
                    let fits = quote!(#greatest as ::core::primitive::u64 >> #room == 0);
                    self.demand(fits, &message);
                    return Some(());
                }
            }
        }
        for part in aligned.parts() {
            let room = width.minus(part).minus(&sign.into());
            let message = format!("QRT0806: `{shown}` has more bits than its target");
            if !self.holds(&room, &message) {
                let bits = self.greatest(&part.plus(&sign.into()));
                let message = format!("`{shown}` takes {bits} bits, and {name} has {width}");
                let help = if matches!(number.kind, NumberKind::Constant(_)) {
                    "write a smaller constant, or use a wider target".to_owned()
                } else {
                    format!(
                        "use a target of {bits} bits, or `wrapping({shown})` for the lowest {width}"
                    )
                };
                self.problems
                    .add(codes::REV_WIDTH, &number.source, &message, &help);
                return None;
            }
        }
        Some(())
    }

    fn something_left(&mut self, aligned: &Dim, number: &Number) -> Option<()> {
        let parts: Vec<Linear> = aligned.parts().iter().map(|p| p.minus(&1.into())).collect();
        let message = "QRT0806: nothing is left of a number that is rounded down";
        if parts.iter().any(|part| self.certain(part)) || self.holds(&parts[0], message) {
            return Some(());
        }
        let shown = text(&number.source);
        let message = format!("nothing is left of `{shown}` at the target's last bit");
        let help = "use a target with more fraction bits";
        self.problems
            .add(codes::REV_WIDTH, &number.source, &message, help);
        None
    }
}

/// Reads the request of `floor(..)` or of `wrapping(..)`.
fn request(call: &syn::ExprCall, asked: Asked) -> Option<Asked> {
    let Expr::Path(function) = &*call.func else {
        return None;
    };
    if call.args.len() != 1 {
        return None;
    }
    if function.path.is_ident("floor") {
        return Some(Asked {
            floor: true,
            ..asked
        });
    }
    function.path.is_ident("wrapping").then_some(Asked {
        wrapping: true,
        ..asked
    })
}

fn turned(update: Update, subtract: bool) -> Update {
    match update {
        Update::Add if subtract => Update::Subtract,
        Update::Subtract if subtract => Update::Add,
        update => update,
    }
}

/// Returns the nearest number with `fraction` fraction bits, as text.
fn nearest(kind: &NumberKind, size: &Size, fraction: &Linear) -> String {
    let NumberKind::Constant(units) = kind else {
        return "0".to_owned();
    };
    let own = size.fraction.known().unwrap_or(0) as i32;
    let value = *units as f64 * 2_f64.powi(-own);
    let scale = 2_f64.powi(fraction.known().unwrap_or(0) as i32);
    format!("{}", (value * scale).round() / scale)
}

/// Aligns the number to the target's last bit, and cuts it to the target's first bit if it wraps.
fn cut(number: Number, below: &Linear, wraps: Option<Linear>) -> Number {
    let source = number.source.clone();
    let mut size = number.size.clone();
    size.fraction = size.fraction.plus(below);
    size.width = size.width.add(below);
    let kind = if below.is_zero() {
        number.kind
    } else if below.never_negative() || matches!(number.kind, NumberKind::Constant(_)) {
        NumberKind::Shifted(Box::new(number), below.clone())
    } else {
        NumberKind::Dropped(Box::new(number), below.times(-1))
    };
    // A product computes no more bits than needed.
    let computed = match &kind {
        NumberKind::Dropped(inner, _) => inner.is_product(),
        NumberKind::Product(..) | NumberKind::Square(_) => true,
        _ => false,
    };
    if let (Some(width), true) = (wraps, computed) {
        size.width = width.into();
    }
    Number { kind, size, source }
}

impl Number {
    /// True if an operation that can leave out the lowest bits computes the number.
    pub(super) fn is_product(&self) -> bool {
        match &self.kind {
            NumberKind::Pointed(inner) => inner.is_product(),
            kind => matches!(kind, NumberKind::Product(..) | NumberKind::Square(_)),
        }
    }
}
