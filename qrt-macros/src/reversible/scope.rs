//! What a statement can see: registers, constants, the loops around it.

use super::dim::Linear;
use super::ir::{Demand, Place, Register};
use super::problem::Problems;
use proc_macro2::{Span, TokenStream};
use qrt_core::syntax::{codes, nearest};
use quote::{ToTokens, quote};
use std::rc::Rc;
use syn::{BinOp, Expr, Ident, Lit, RangeLimits, UnOp};

/// The state of a routine's understanding.
pub(super) struct Scope {
    pub(super) routine: Ident,
    pub(super) registers: Vec<Rc<Register>>,
    /// Names whose declarations are wrong, which is enough to be said once.
    pub(super) unusable: Vec<Ident>,
    pub(super) constants: Vec<Ident>,
    /// Variables of the loops around, and from where to where they run.
    pub(super) loops: Vec<(Ident, [Linear; 2])>,
    pub(super) demands: Vec<Demand>,
    pub(super) problems: Problems,
    /// Everything that has been written to so far, in the order of the text.
    pub(super) writes: Vec<(Place, TokenStream)>,
    /// Fraction bits of what is updated, which say what constants can be.
    pub(super) fraction: Option<i64>,
    /// The statement or term that is being understood.
    pub(super) here: Span,
}

impl Scope {
    /// The register that a name stands for; reports a name that stands for none.
    pub(super) fn register(&mut self, name: &Ident) -> Option<Rc<Register>> {
        let mut latest_first = self.registers.iter().rev();
        let found = latest_first.find(|register| register.name == *name);
        if let Some(register) = found {
            return Some(register.clone());
        }
        if self.unusable.contains(name) {
            return None;
        }
        let message;
        let help;
        if self.is_number(name) {
            message = format!("`{name}` is a constant, not a register");
            help =
                "constants stand in bounds, places of bits and shifts, as in `1 << i`; those of \
                    the function's generics in comparisons, too"
                    .into();
        } else {
            message = format!("no register `{name}` is known here");
            let known: Vec<String> = self.registers.iter().map(|r| r.name.to_string()).collect();
            let near = nearest(&name.to_string(), known.iter().map(String::as_str));
            help = near.map_or_else(
                || "registers are parameters, or `let mut t: UInt<8> = 0;`".into(),
                |near| format!("did you mean `{near}`?"),
            );
        }
        self.problems.add(codes::REV_NAME, name, &message, &help);
        None
    }

    fn is_number(&self, name: &Ident) -> bool {
        self.constants.contains(name) || self.loops.iter().any(|(variable, _)| variable == name)
    }

    /// Complains if a name can't be given to something new.
    #[cfg_attr(test, track_caller)]
    pub(super) fn check_free(&mut self, name: &Ident) {
        if self.is_number(name) || self.registers.iter().any(|register| register.name == *name) {
            let message = format!("the name `{name}` is taken");
            let help =
                "choose another: nothing is shadowed, so that what is undone is what was done";
            self.problems.add(codes::REV_TAKEN, name, &message, help);
        }
    }

    /// A number that is known where the routine is compiled.
    pub(super) fn linear(&mut self, expression: &Expr) -> Option<Linear> {
        match expression {
            Expr::Paren(inner) => self.linear(&inner.expr),
            Expr::Group(inner) => self.linear(&inner.expr),
            Expr::Path(path) => {
                let name = path.path.get_ident()?;
                self.is_number(name).then(|| Linear::name(name))
            }
            Expr::Binary(binary) => {
                let (a, b) = (self.linear(&binary.left)?, self.linear(&binary.right)?);
                match binary.op {
                    BinOp::Add(_) => Some(a.plus(&b)),
                    BinOp::Sub(_) => Some(a.minus(&b)),
                    BinOp::Mul(_) => match (a.known(), b.known()) {
                        (Some(factor), _) => Some(b.times(factor)),
                        (_, Some(factor)) => Some(a.times(factor)),
                        _ => None,
                    },
                    _ => None,
                }
            }
            _ => integer(expression)?.try_into().ok().map(i64::into),
        }
    }

    /// As [`Scope::linear`], and if it is none, says that `what` must be one.
    #[cfg_attr(test, track_caller)]
    pub(super) fn must_be_known(&mut self, expression: &Expr, what: &str) -> Option<Linear> {
        let read = self.linear(expression);
        if read.is_none() {
            let message = format!("{what} must be known where the routine is compiled");
            let help = "write a number, a `const` parameter, a loop's variable, or a sum of these";
            self.problems
                .add(codes::REV_INDEX, expression, &message, help);
        }
        read
    }

    /// The first and the one after the last of a range.
    pub(super) fn range(
        &mut self,
        range: &syn::ExprRange,
        end: Option<&Linear>,
    ) -> Option<[Linear; 2]> {
        let what = "the bounds of a range";
        let first = match &range.start {
            Some(start) => self.must_be_known(start, what)?,
            None => 0.into(),
        };
        let last = match &range.end {
            Some(end) => self.must_be_known(end, what)?,
            None => return Some([first, end?.clone()]),
        };
        Some(match range.limits {
            RangeLimits::HalfOpen(_) => [first, last],
            RangeLimits::Closed(_) => [first, last.plus(&1.into())],
        })
    }

    /// The least that a number can be in the loops around.
    pub(super) fn least(&self, number: &Linear) -> Linear {
        let mut least = number.clone();
        for (variable, [first, end]) in self.loops.iter().rev() {
            let worst = if least.factor(variable) > 0 {
                first.clone()
            } else {
                end.minus(&1.into())
            };
            least = least.with(variable, &worst);
        }
        least
    }

    /// Whether a number is never negative. Where that depends on the routine's constants, it is
    /// demanded of them, with this message.
    pub(super) fn holds(&mut self, number: &Linear, message: &str) -> bool {
        let least = self.least(number);
        if let Some(known) = least.known() {
            return known >= 0;
        }
        if !least.never_negative() {
            let condition = least.never_negative_tokens();
            let same = |known: &Demand| known.condition.to_string() == condition.to_string();
            if !self.demands.iter().any(same) {
                self.demands.push(Demand {
                    condition,
                    message: message.to_owned(),
                    span: self.here,
                });
            }
        }
        true
    }

    /// Whether a number is never negative, whatever the constants are.
    pub(super) fn certain(&self, number: &Linear) -> bool {
        self.least(number).never_negative()
    }

    /// Whether two places have no bit in common for certain.
    pub(super) fn apart(&self, a: &Place, b: &Place) -> bool {
        if a.register.name != b.register.name {
            return true;
        }
        let (Some([a_first, a_width]), Some([b_first, b_width])) = (&a.part, &b.part) else {
            return false;
        };
        self.certain(&b_first.minus(&a_first.plus(a_width)))
            || self.certain(&a_first.minus(&b_first.plus(b_width)))
    }

    /// The place that an expression names: a register, a bit of one, or some bits.
    pub(super) fn place(&mut self, expression: &Expr) -> Option<Place> {
        match expression {
            Expr::Paren(inner) => self.place(&inner.expr),
            Expr::Path(path) if path.path.get_ident().is_some() => {
                let register = self.register(path.path.get_ident()?)?;
                Some(Place {
                    register,
                    part: None,
                })
            }
            Expr::Index(index) => {
                let whole = self.place(&index.expr)?;
                if whole.part.is_some() {
                    let message = "these are bits of bits";
                    let help = "count from the register's first bit, in one pair of brackets";
                    self.problems
                        .add(codes::REV_INDEX, &index.index, message, help);
                    return None;
                }
                let register = whole.register;
                let part = self.part(&register, &index.index)?;
                Some(Place {
                    register,
                    part: Some(part),
                })
            }
            _ => {
                self.problems.add(
                    codes::REV_EXPRESSION,
                    expression,
                    "a register is needed here",
                    "name a register, a bit of it as in `a[0]`, or bits as in `a[0..4]`",
                );
                None
            }
        }
    }

    /// The first of some bits, and their number.
    fn part(&mut self, register: &Register, index: &Expr) -> Option<[Linear; 2]> {
        let width = &register.format.width;
        let [first, end] = if let Expr::Range(range) = index {
            self.range(range, Some(width))?
        } else {
            let bit = self.must_be_known(index, "the place of a bit")?;
            let end = bit.plus(&1.into());
            [bit, end]
        };
        let name = &register.name;
        let message = format!("QRT0819: bits beyond the last of `{name}`");
        let bits = end.minus(&first);
        let some = self.holds(&bits.minus(&1.into()), "QRT0819: an empty range of bits");
        if !some || !self.holds(&first, &message) || !self.holds(&width.minus(&end), &message) {
            let shown = if some {
                format!("`{name}` has {width} bits, and none there")
            } else {
                "an empty range of bits".to_owned()
            };
            let last = width.minus(&1.into());
            let help = format!("its bits are `{name}[0]` to `{name}[{last}]`");
            self.problems.add(codes::REV_INDEX, index, &shown, &help);
            return None;
        }
        Some([first, bits])
    }
}

/// The span where source text begins.
pub(super) fn begin(source: &TokenStream) -> Span {
    let first = source.clone().into_iter().next();
    first.map_or_else(Span::call_site, |token| token.span())
}

/// A whole number as it is written.
pub(super) fn integer(expression: &Expr) -> Option<i128> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(digits) if digits.suffix().is_empty() => digits.base10_parse().ok(),
            _ => None,
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
            integer(&unary.expr).map(|number| -number)
        }
        Expr::Paren(inner) => integer(&inner.expr),
        Expr::Group(inner) => integer(&inner.expr),
        Expr::Block(block) => match block.block.stmts.as_slice() {
            [syn::Stmt::Expr(inner, None)] => integer(inner),
            _ => None,
        },
        _ => None,
    }
}

/// Source text, with spaces as they are usually set.
pub(super) fn text(source: impl ToTokens) -> String {
    let mut text = quote!(#source).to_string();
    for (from, to) in [
        (" [", "["),
        ("[ ", "["),
        (" ]", "]"),
        (" (", "("),
        ("( ", "("),
        (" )", ")"),
        (" ..", ".."),
        (".. ", ".."),
        ("! ", "!"),
        (" ,", ","),
        (" ;", ";"),
        (" :: ", "::"),
        ("& ", "&"),
        ("- (", "-("),
        ("* - ", "* -"),
        ("(- ", "(-"),
        ("*(", "* ("),
        ("+(", "+ ("),
        ("-(", "- ("),
    ] {
        text = text.replace(from, to);
    }
    match text.strip_prefix("- ") {
        Some(number) => format!("-{number}"),
        None => text,
    }
}

/// A type, as it is usually written.
pub(super) fn type_text(ty: &syn::Type) -> String {
    text(ty)
        .replace(" <", "<")
        .replace("< ", "<")
        .replace(" >", ">")
}
