//! The names that a statement can use: registers, constants, the loops around it.

use super::constants::Constants;
use super::dim::{self, Linear, Loop};
use super::ir::{Demand, Place, Register, Table};
use super::outside;
use super::problem::Problems;
use super::source::bare;
use proc_macro2::{Span, TokenStream};
use qrt_syntax::{codes, nearest};
use std::rc::Rc;
use syn::{BinOp, Expr, Ident, Lit, RangeLimits, UnOp};

/// The state of reading a routine.
pub(super) struct Scope {
    pub(super) routine: Ident,
    pub(super) registers: Vec<Rc<Register>>,
    /// Names whose declarations are wrong, which are reported only once.
    pub(super) unusable: Vec<Ident>,
    pub(super) constants: Constants,
    /// Variables of the loops around, and the bounds of their ranges.
    pub(super) loops: Vec<Loop>,
    pub(super) demands: Vec<Demand>,
    pub(super) problems: Problems,
    /// All writes so far, in the order of the text.
    pub(super) writes: Vec<(Place, TokenStream)>,
    /// Number of fraction bits of the updated register, which determine the possible constants.
    pub(super) fraction: Option<i64>,
    /// The update that is being read.
    pub(super) updated: Option<syn::ExprBinary>,
    /// The constant arrays that are read.
    pub(super) tables: Vec<Rc<Table>>,
    /// Number of the registers that were known where the current block began.
    pub(super) block: usize,
    /// The statement or term that is being read.
    pub(super) here: Span,
}

impl Scope {
    /// Returns the register that a name stands for; reports a name that stands for none.
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
            help = "constants can be added, compared and counted to, and never changed".into();
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

    /// True if a name stands for a register, or for a faulty declaration of one.
    pub(super) fn is_known(&self, name: &Ident) -> bool {
        let mut registers = self.registers.iter();
        registers.any(|register| register.name == *name) || self.unusable.contains(name)
    }

    fn is_number(&self, name: &Ident) -> bool {
        self.constants.contains(name) || self.loops.iter().any(|(variable, _)| variable == name)
    }

    /// Reports a name that is already taken.
    #[cfg_attr(test, track_caller)]
    pub(super) fn check_free(&mut self, name: &Ident) {
        if self.is_number(name) || self.registers.iter().any(|register| register.name == *name) {
            let message = format!("the name `{name}` is taken");
            let help =
                "choose another: nothing is shadowed, so that what is undone is what was done";
            self.problems.add(codes::REV_TAKEN, name, &message, help);
        }
    }

    /// Reads a number that is known when the routine is compiled.
    pub(super) fn linear(&mut self, expression: &Expr) -> Option<Linear> {
        match expression {
            Expr::Paren(inner) => self.linear(&inner.expr),
            Expr::Group(inner) => self.linear(&inner.expr),
            Expr::Path(path) if path.qself.is_none() => match path.path.get_ident() {
                Some(name) if self.is_number(name) => Some(self.constants.linear(name)),
                Some(name) if self.is_known(name) => None,
                _ => outside::constant(&path.path, &mut self.demands),
            },
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

    /// Reads a number as [`Scope::linear`] does. If there is none, reports that `what` must be one.
    #[cfg_attr(test, track_caller)]
    pub(super) fn must_be_known(&mut self, expression: &Expr, what: &str) -> Option<Linear> {
        let read = self.linear(expression);
        if read.is_none() {
            let message = format!("{what} must be known where the routine is compiled");
            let help = "write a number, a constant, a loop's variable, or a sum of these";
            self.problems
                .add(codes::REV_INDEX, expression, &message, help);
        }
        read
    }

    /// Returns the first index of a range, and the index after the last.
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

    /// Returns the greatest value of a number in the loops around.
    pub(super) fn greatest(&self, number: &Linear) -> Linear {
        self.least(&number.times(-1)).times(-1)
    }

    /// Returns the least value of a number in the loops around.
    pub(super) fn least(&self, number: &Linear) -> Linear {
        dim::least(number, &self.loops)
    }

    /// True if a number is never negative. If that depends on the routine's constants, it is
    /// demanded of them, with this message.
    pub(super) fn holds(&mut self, number: &Linear, message: &str) -> bool {
        let least = self.least(number);
        if let Some(known) = least.known() {
            return known >= 0;
        }
        if !least.never_negative() {
            self.demand(least.never_negative_tokens(), message);
        }
        true
    }

    /// Demands of the routine's constants that a condition holds.
    pub(super) fn demand(&mut self, condition: TokenStream, message: &str) {
        let (message, span) = (message.to_owned(), self.here);
        outside::demand(
            &mut self.demands,
            Demand {
                condition,
                message,
                span,
            },
        );
    }

    /// True if a number is never negative, for all values of the constants.
    pub(super) fn certain(&self, number: &Linear) -> bool {
        self.least(number).never_negative()
    }

    /// True if two places certainly have no bit in common.
    pub(super) fn apart(&self, a: &Place, b: &Place) -> bool {
        if a.register.is_apart(&b.register, &self.loops) {
            return true;
        }
        let (Some(a), Some(b)) = (&a.part, &b.part) else {
            return false;
        };
        dim::apart(a, b, &self.loops)
    }

    /// Returns the place that an expression names: a register, a bit of one, or some bits.
    pub(super) fn place(&mut self, expression: &Expr) -> Option<Place> {
        let place = self.any_place(expression)?;
        if place.register.is_array() {
            let name = &place.register.name;
            let message = format!("`{name}` is an array of registers");
            let help = format!("name one of them, `{name}[0]`; a call takes all, `&{name}`");
            self.problems
                .add(codes::REV_ARGUMENT, expression, &message, &help);
            return None;
        }
        Some(place)
    }

    /// Returns the place that an expression names, which may be an array of registers.
    pub(super) fn any_place(&mut self, expression: &Expr) -> Option<Place> {
        match expression {
            Expr::Paren(inner) => self.any_place(&inner.expr),
            Expr::Path(path) if path.path.get_ident().is_some() => {
                let register = self.register(path.path.get_ident()?)?;
                Some(Place {
                    register,
                    part: None,
                })
            }
            Expr::Index(index) => {
                let whole = self.any_place(&index.expr)?;
                if whole.register.is_array() {
                    let register = Rc::new(self.element(&whole.register, &index.index)?);
                    let part = None;
                    return Some(Place { register, part });
                }
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
                let message = "a register is needed here";
                let help = match expression {
                    Expr::Unary(unary) if matches!(unary.op, UnOp::Deref(_)) => {
                        format!("write `{}`: a register needs no `*`", bare(&unary.expr))
                    }
                    _ => {
                        "name a register, a bit of it as in `a[0]`, or bits as in `a[0..4]`".into()
                    }
                };
                self.problems
                    .add(codes::REV_EXPRESSION, expression, message, &help);
                None
            }
        }
    }

    /// Returns one register of an array.
    fn element(&mut self, array: &Register, index: &Expr) -> Option<Register> {
        let place = self.must_be_known(index, "the place of a register")?;
        let length = array.array.as_ref().map(|array| array.length.clone())?;
        let name = &array.name;
        let message = format!("QRT0819: a register beyond the last of `{name}`");
        let last = length.minus(&1.into());
        if !self.holds(&place, &message) || !self.holds(&last.minus(&place), &message) {
            let shown = format!("`{name}` has {length} registers, and none there");
            let help = format!("they are `{name}[0]` to `{name}[{last}]`");
            self.problems.add(codes::REV_INDEX, index, &shown, &help);
            return None;
        }
        Some(Register {
            element: Some(place),
            ..array.clone()
        })
    }

    /// Returns the first of some bits, and their number.
    fn part(&mut self, register: &Register, index: &Expr) -> Option<[Linear; 2]> {
        let width = &register.format.width;
        let [first, end] = if let Expr::Range(range) = index {
            self.range(range, Some(width))?
        } else {
            let bit = self.must_be_known(index, "the place of a bit")?;
            let end = bit.plus(&1.into());
            [bit, end]
        };
        let name = register;
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

/// Returns a whole number, as it is written.
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
