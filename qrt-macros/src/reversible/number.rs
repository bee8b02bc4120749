//! Expressions that are numbers: their parts, and their numbers of bits.
//!
//! | expression | bits | fraction bits |
//! |---|---|---|
//! | register | its own | its own |
//! | `a[i..j]` | `j - i`, unsigned | 0 |
//! | a bit | 1, unsigned | 0 |
//! | `TABLE[k]` | those of the table's longest entry, unsigned | 0 |
//! | constant | the fewest that hold it | the fewest that hold it |
//! | `a * b` | the sum | the sum |
//! | `a + b`, `a - b` | one more than the longer, signed if a difference | the greater |
//! | `a << n` | `n` more | its own |
//! | `a >> n` of an integer | `n` less, rounded down | 0 |
//! | `a >> n` of a number with a point | its own | `n` more |

use super::advice;
use super::constant::{Constant, Inexact, bits};
use super::dim::{Dim, Linear};
use super::ir::{Bit, Number, NumberKind, Place, Size};
use super::scope::Scope;
use super::source::text;
use proc_macro2::TokenStream;
use qrt_syntax::codes;
use quote::quote;
use syn::{BinOp, Expr, Lit, UnOp};

/// Number of bits of a constant whose value is not known here: those of a `u32`.
pub(super) const GIVEN: i64 = 32;

impl Scope {
    /// Reads an expression as a number.
    pub(super) fn number(&mut self, expression: &Expr) -> Option<Number> {
        let source = quote!(#expression);
        if let Some(value) = self.given(expression) {
            return Some(self.given_number(value, source));
        }
        match expression {
            Expr::Paren(inner) => self.number(&inner.expr),
            Expr::Group(inner) => self.number(&inner.expr),
            _ if self.is_bit(expression) => {
                let bit = self.bit(expression)?;
                Some(truth(bit, source))
            }
            Expr::Lit(literal) => self.literal(&literal.lit, source),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Deref(_)) => {
                // Reports the `*`.
                self.place(expression)?;
                None
            }
            Expr::Index(index) if self.table_path(index).is_some() => {
                let path = self.table_path(index)?;
                self.entry(path, index, source)
            }
            Expr::Path(_) | Expr::Index(_) => {
                let place = self.place(expression)?;
                Some(word(place, source))
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
                let inner = self.number(&unary.expr)?;
                self.sum(vec![(true, inner)], source)
            }
            Expr::Binary(binary) => self.binary(binary, source),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                let message = "`!` of a number is not computed reversibly";
                let help = advice::in_scratch(expression);
                self.problems
                    .add(codes::REV_OPERATOR, unary.op, message, &help);
                None
            }
            _ => {
                self.not_an_expression(expression);
                None
            }
        }
    }

    /// Reads an expression as a number of constants and loops' variables. `None` if it is another
    /// expression, or is known to become negative.
    pub(super) fn given(&mut self, expression: &Expr) -> Option<Linear> {
        if !matches!(expression, Expr::Path(_) | Expr::Binary(_)) {
            return None;
        }
        let value = self.linear(expression)?;
        let negative = self.least(&value).known().is_some_and(|least| least < 0);
        (value.known().is_none() && !negative).then_some(value)
    }

    fn given_number(&mut self, value: Linear, source: TokenStream) -> Number {
        let message = format!("QRT0808: `{}` is negative", text(&source));
        self.holds(&value, &message);
        let greatest = self.greatest(&value).known();
        let size = Size {
            width: greatest.map_or(GIVEN, |most| bits(most.into())).into(),
            signed: false,
            fraction: 0.into(),
            fixed: false,
            floors: false,
        };
        let kind = NumberKind::Given(value);
        Number { kind, size, source }
    }

    pub(super) fn not_an_expression(&mut self, expression: &Expr) {
        let escapes = match expression {
            Expr::Try(_) => Some("`?` would skip what is undone after it"),
            Expr::Return(_) => Some("`return` would skip what is undone after it"),
            Expr::Break(_) | Expr::Continue(_) => Some("this would skip what is undone after it"),
            _ => None,
        };
        if let Some(message) = escapes {
            let help = "let every statement run, and write `if` for what depends on a bit";
            self.problems
                .add(codes::REV_EARLY_EXIT, expression, message, help);
            return;
        }
        let (message, help) = match expression {
            Expr::Call(_) | Expr::MethodCall(_) | Expr::Macro(_) => (
                "a call inside an expression",
                "call a reversible function as a statement, and let it write into a register",
            ),
            Expr::Reference(_) => (
                "a reference inside an expression",
                "name the register itself: `&` stands in calls only",
            ),
            Expr::Closure(_) => (
                "a closure is not computed reversibly",
                "write the statements where they run, or a reversible function",
            ),
            Expr::Cast(_) => (
                "a cast inside an expression",
                "formats are converted as they are added; `wrapping(..)` takes the lowest bits",
            ),
            _ => (
                "this is not computed reversibly",
                "write registers, constants, `+ - * << >>`, bits, slices and comparisons",
            ),
        };
        self.problems
            .add(codes::REV_EXPRESSION, expression, message, help);
    }

    fn literal(&mut self, literal: &Lit, source: TokenStream) -> Option<Number> {
        let (digits, suffix) = match literal {
            Lit::Int(int) => (int.base10_digits(), int.suffix()),
            Lit::Float(float) => (float.base10_digits(), float.suffix()),
            _ => {
                let message = "this constant is not a number";
                let help = "write a number such as 3 or 0.25";
                self.problems
                    .add(codes::REV_CONSTANT, literal, message, help);
                return None;
            }
        };
        if !suffix.is_empty() {
            let message = "a constant takes the format of what it is added to";
            let help = format!("write `{digits}`");
            self.problems
                .add(codes::REV_CONSTANT, literal, message, &help);
            return None;
        }
        match Constant::read(digits) {
            Ok(Constant { units, fraction }) => Some(constant(units, fraction, source)),
            Err(reason) => {
                let message = match reason {
                    Inexact::Never => format!("{digits} has no last bit in binary"),
                    Inexact::TooLong => format!("{digits} has more bits than a register can"),
                };
                let fraction = self.fraction.unwrap_or(14).clamp(0, 62);
                let scale = 2_f64.powi(fraction as i32);
                let near = digits
                    .parse::<f64>()
                    .map_or(0.0, |x| (x * scale).round() / scale);
                let help = format!("write {near}, the nearest with {fraction} fraction bits");
                self.problems
                    .add(codes::REV_CONSTANT, literal, &message, &help);
                None
            }
        }
    }

    fn binary(&mut self, binary: &syn::ExprBinary, source: TokenStream) -> Option<Number> {
        match binary.op {
            BinOp::Add(_) | BinOp::Sub(_) => {
                let (left, right) = (self.number(&binary.left), self.number(&binary.right));
                let subtract = matches!(binary.op, BinOp::Sub(_));
                self.sum(vec![(false, left?), (subtract, right?)], source)
            }
            BinOp::Mul(_) => {
                let (left, right) = (self.number(&binary.left), self.number(&binary.right));
                self.product(left?, right?, source)
            }
            BinOp::Shl(_) => {
                let number = self.number(&binary.left)?;
                let by = self.must_be_known(&binary.right, "the distance of a shift")?;
                Some(shifted(number, by, source))
            }
            BinOp::Shr(_) => {
                let number = self.number(&binary.left)?;
                let by = self.must_be_known(&binary.right, "the distance of a shift")?;
                self.shifted_down(number, by, source)
            }
            operator => {
                let shown = text(operator);
                let message = format!("`{shown}` of numbers is not computed reversibly");
                let help = advice::operator(binary);
                self.problems
                    .add(codes::REV_OPERATOR, operator, &message, &help);
                None
            }
        }
    }

    fn shifted_down(&mut self, number: Number, by: Linear, source: TokenStream) -> Option<Number> {
        let mut size = number.size.clone();
        if let (NumberKind::Constant(units), false) = (&number.kind, size.fixed) {
            let by = by.known().unwrap_or(63).clamp(0, 63);
            return Some(constant(units >> by, 0, source));
        }
        if size.fixed {
            size.fraction = size.fraction.plus(&by);
            size.floors = true;
            let kind = NumberKind::Pointed(Box::new(number));
            return Some(Number { kind, size, source });
        }
        size.width = size.width.add(&by.times(-1));
        let parts = size.width.parts().to_vec();
        let left = parts
            .iter()
            .any(|part| self.certain(&part.minus(&1.into())))
            || self.holds(
                &parts[0].minus(&1.into()),
                "QRT0806: everything is shifted out",
            );
        if !left {
            let message = "everything is shifted out";
            let help = "shift by less than the number of bits";
            self.problems.add(codes::REV_WIDTH, &source, message, help);
            return None;
        }
        let kind = NumberKind::Dropped(Box::new(number), by);
        Some(Number { kind, size, source })
    }

    fn product(&mut self, a: Number, b: Number, source: TokenStream) -> Option<Number> {
        use NumberKind::{Constant, Given, Product, Square};
        if let (Constant(x), Constant(y)) = (&a.kind, &b.kind) {
            let fraction = a.size.fraction.plus(&b.size.fraction).known();
            let (Some(units), Some(fraction)) = (x.checked_mul(*y), fraction) else {
                let message = format!("`{}` has more bits than a register can", text(&source));
                let help = "write smaller constants";
                self.problems
                    .add(codes::REV_CONSTANT, &source, &message, help);
                return None;
            };
            return Some(constant(units, fraction as u32, source));
        }
        let (a, b) = match b.kind {
            Constant(_) | Given(_) => (b, a),
            _ => (a, b),
        };
        self.check_operand(&a)?;
        self.check_operand(&b)?;
        if let Constant(factor) = a.kind {
            return self.multiple(factor, &a, b, source);
        }
        let size = Size {
            width: a.size.width.plus(&b.size.width),
            signed: a.size.signed || b.size.signed,
            fraction: a.size.fraction.plus(&b.size.fraction),
            fixed: a.size.fixed || b.size.fixed,
            floors: true,
        };
        let equal = a.source.to_string() == b.source.to_string();
        let (kind, signed) = if equal {
            (Square(Box::new(a)), false)
        } else {
            (Product(Box::new(a), Box::new(b)), size.signed)
        };
        Some(Number {
            kind,
            size: Size { signed, ..size },
            source,
        })
    }

    fn multiple(
        &mut self,
        factor: i64,
        constant: &Number,
        number: Number,
        source: TokenStream,
    ) -> Option<Number> {
        let fraction = constant.size.fraction.plus(&number.size.fraction);
        let fixed = number.size.fixed || !constant.size.fraction.is_zero();
        if factor <= 0 {
            let positive = self::constant(-factor, 0, constant.source.clone());
            let positive = Number {
                size: Size {
                    fraction: constant.size.fraction.clone(),
                    ..positive.size
                },
                ..positive
            };
            if factor == 0 {
                let message = "a product with 0 is always 0";
                self.problems
                    .add(codes::REV_CONSTANT, &source, message, "remove it");
                return None;
            }
            let product = self.multiple(-factor, &positive, number, source.clone())?;
            return self.sum(vec![(true, product)], source);
        }
        let mut size = Size {
            width: number.size.width.clone(),
            signed: number.size.signed,
            fraction,
            fixed,
            floors: true,
        };
        if factor & (factor - 1) == 0 {
            let by = i64::from(factor.trailing_zeros());
            size.width = size.width.add(&by.into());
            let number = Box::new(number);
            let kind = if by == 0 {
                NumberKind::Pointed(number)
            } else {
                NumberKind::Shifted(number, by.into())
            };
            return Some(Number { kind, size, source });
        }
        size.width = match size.width.known() {
            Some(width) if !size.signed && width < 63 => {
                bits(((1_i128 << width) - 1) * i128::from(factor)).into()
            }
            _ => size.width.add(&bits(factor.into()).into()),
        };
        let kind = NumberKind::Product(Box::new(constant.clone()), Box::new(number));
        Some(Number { kind, size, source })
    }

    /// Reads a sum as a flat list of terms.
    pub(super) fn sum(
        &mut self,
        parts: Vec<(bool, Number)>,
        source: TokenStream,
    ) -> Option<Number> {
        let mut terms: Vec<(bool, Number)> = Vec::new();
        for (subtract, part) in parts {
            match part.kind {
                NumberKind::Sum(inner) => {
                    let turned = inner.into_iter().map(|(minus, n)| (minus != subtract, n));
                    terms.extend(turned);
                }
                _ => terms.push((subtract, part)),
            }
        }
        let mut size: Option<Size> = None;
        for (subtract, term) in &terms {
            size = Some(match size {
                None if *subtract => {
                    let width = term.size.width.add(&1.into());
                    Size {
                        width,
                        signed: true,
                        ..term.size.clone()
                    }
                }
                None => term.size.clone(),
                Some(size) => self.added(&size, &term.size, *subtract, &source)?,
            });
        }
        // A single constant that is subtracted becomes a negative constant.
        if let [
            (
                true,
                Number {
                    kind: NumberKind::Constant(units),
                    size,
                    ..
                },
            ),
        ] = terms.as_slice()
        {
            let fraction = size.fraction.known().unwrap_or(0);
            return Some(constant(-units, fraction as u32, source));
        }
        Some(Number {
            kind: NumberKind::Sum(terms),
            size: size?,
            source,
        })
    }

    /// Returns the size of a sum or a difference.
    pub(super) fn added(
        &mut self,
        a: &Size,
        b: &Size,
        subtract: bool,
        source: &TokenStream,
    ) -> Option<Size> {
        let fraction = self.common(&a.fraction, &b.fraction, source)?;
        let signed = a.signed || b.signed;
        let width = |size: &Size| -> Dim {
            let sign = i64::from(signed && !size.signed);
            let below = fraction.minus(&size.fraction);
            size.width.add(&below).add(&sign.into())
        };
        Some(Size {
            width: width(a).max(&width(b)).add(&1.into()),
            signed: signed || subtract,
            fixed: a.fixed || b.fixed,
            floors: a.floors || b.floors,
            fraction,
        })
    }

    /// Returns the greater of two numbers of fraction bits.
    fn common(&mut self, a: &Linear, b: &Linear, source: &TokenStream) -> Option<Linear> {
        if self.certain(&a.minus(b)) {
            return Some(a.clone());
        }
        if self.certain(&b.minus(a)) {
            return Some(b.clone());
        }
        // A known number is a constant's; the other one must be able to hold it.
        let (held, holding) = if a.known().is_some() { (a, b) } else { (b, a) };
        if held.known().is_some() {
            let message = "QRT0808: a constant has more fraction bits than what it is added to";
            self.holds(&holding.minus(held), message);
            return Some(holding.clone());
        }
        let message = format!("whether `{a}` or `{b}` fraction bits are more is not known here");
        let help = "give both as many fraction bits, by one constant";
        self.problems.add(codes::REV_FORMAT, source, &message, help);
        None
    }

    /// Reports a number that is too long for an operation to read.
    #[cfg_attr(test, track_caller)]
    pub(super) fn check_operand(&mut self, number: &Number) -> Option<()> {
        let help = "compute it from fewer bits, such as `a[0..16]`";
        self.check_bits(&number.size.width.clone(), &number.source, help)
    }

    #[cfg_attr(test, track_caller)]
    pub(super) fn check_bits(
        &mut self,
        width: &Dim,
        source: &TokenStream,
        help: &str,
    ) -> Option<()> {
        let message = "QRT0829: a number of more than 63 bits";
        let fits = |part: &Linear| Linear::from(63).minus(part);
        let parts: Vec<Linear> = width.parts().iter().map(fits).collect();
        if parts.iter().all(|part| self.holds(part, message)) {
            return Some(());
        }
        let shown = format!("`{}` can take more than 63 bits", text(source));
        self.problems.add(codes::REV_TOO_WIDE, source, &shown, help);
        None
    }
}

pub(super) fn truth(bit: Bit, source: TokenStream) -> Number {
    let size = Size {
        width: 1.into(),
        signed: false,
        fraction: 0.into(),
        fixed: false,
        floors: false,
    };
    let kind = match bit {
        Bit::At(register, index) => NumberKind::Word(register, index),
        bit => NumberKind::Truth(Box::new(bit)),
    };
    Number { kind, size, source }
}

fn word(place: Place, source: TokenStream) -> Number {
    let format = &place.register.format;
    let size = match &place.part {
        None => Size {
            width: format.width.clone().into(),
            signed: format.signed(),
            fraction: format.fraction.clone(),
            fixed: format.fixed(),
            floors: false,
        },
        Some([_, bits]) => Size {
            width: bits.clone().into(),
            signed: false,
            fraction: 0.into(),
            fixed: false,
            floors: false,
        },
    };
    let offset = place.part.map_or_else(|| 0.into(), |[first, _]| first);
    let kind = NumberKind::Word(place.register, offset);
    Number { kind, size, source }
}

fn shifted(number: Number, by: Linear, source: TokenStream) -> Number {
    let size = Size {
        width: number.size.width.add(&by),
        ..number.size.clone()
    };
    let kind = NumberKind::Shifted(Box::new(number), by);
    Number { kind, size, source }
}

fn constant(units: i64, fraction: u32, source: TokenStream) -> Number {
    let size = Size {
        width: bits(units.into()).into(),
        signed: units < 0,
        fraction: i64::from(fraction).into(),
        fixed: fraction > 0,
        floors: false,
    };
    let kind = NumberKind::Constant(units);
    Number { kind, size, source }
}

/// Creates a constant that is a whole number.
pub(super) fn units(units: i64) -> Number {
    constant(units, 0, quote!(#units))
}
