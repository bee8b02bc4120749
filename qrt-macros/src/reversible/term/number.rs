//! The meaning of a routine's numbers and comparisons.

use super::bounds;
use super::content::{Content, Less, Path, Value, added, negative};
use super::meaning::Meaning;
use crate::reversible::dim::Linear;
use crate::reversible::ir::{Bit, Kind, Number, NumberKind, Register};
use crate::reversible::source::text;
use proc_macro2::TokenStream;
use qrt_scene::expr::{Expr, Interval};

impl Meaning<'_> {
    /// Returns the value of a number of an expression.
    pub(super) fn number(&mut self, number: &Number) -> Option<Value> {
        let fraction = self.known(&number.size.fraction)?;
        // A number is its units times 2^-fraction, and so are its parts.
        let of_units = |inner: &Self, part: &Number| {
            let own = inner.known(&part.size.fraction)?;
            Some(own - fraction)
        };
        match &number.kind {
            NumberKind::Constant(units) => {
                Value::constant(*units as f64 * 2_f64.powi(-(fraction as i32)))
            }
            NumberKind::Given(value) => {
                if let Some(value) = self.known(value) {
                    return Value::constant(value as f64);
                }
                let message = format!("what `{value}` is, is not known in a term");
                self.meaningless(&number.source, &message, "write the number out")
            }
            NumberKind::Word(register, first) => {
                let width = number.size.width.known();
                let whole = first.is_zero() && width == register.format.width.known();
                if !whole || register.format.kind == Kind::Bool {
                    return self.no_number(&number.source);
                }
                self.word(register)
            }
            NumberKind::Truth(bit) => {
                let one = Value::constant(1.0)?;
                let mut truth = Content::default();
                for path in self.paths(bit, true, &number.source)? {
                    truth.add(one.clone(), false, &path);
                }
                Some(truth.value(&self.path))
            }
            NumberKind::Shifted(inner, by) => {
                let by = self.known(by)? + of_units(self, inner)?;
                let value = self.number(inner)?;
                Some(scaled(value, by))
            }
            NumberKind::Dropped(inner, by) => {
                if self.known(&inner.size.fraction)? == 0 {
                    let shown = text(&number.source);
                    let message = format!("`{shown}` rounds a whole number, which is a step");
                    let help = "shift a number with a point, which is exact";
                    return self.meaningless(&number.source, &message, help);
                }
                let by = of_units(self, inner)? - self.known(by)?;
                let value = self.number(inner)?;
                Some(rounded(scaled(value, by), fraction))
            }
            NumberKind::Pointed(inner) => {
                let by = of_units(self, inner)?;
                let value = self.number(inner)?;
                Some(scaled(value, by))
            }
            NumberKind::Product(a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                let (a, b) = (a?, b?);
                self.product(&a, &b, &a.expr * &b.expr)
            }
            NumberKind::Square(a) => {
                let a = self.number(a)?;
                self.product(&a, &a, a.expr.powi(2))
            }
            NumberKind::Sum(terms) => {
                let mut total: Option<Value> = None;
                for (subtracted, term) in terms {
                    let value = self.number(term)?;
                    total = Some(match total {
                        None if *subtracted => negative(&value),
                        None => value,
                        Some(total) => added(&total, &value, *subtracted),
                    });
                }
                total
            }
        }
    }

    /// Returns a register's number, with the tightest bounds that the branches around allow.
    fn word(&mut self, register: &Register) -> Option<Value> {
        let content = self.registers.get(&register.name.to_string())?;
        let value = content.value(&self.path);
        let domain = bounds::narrowed(&self.domain, &self.path)?;
        let range = value.expr.range(&domain)?.plus(value.error);
        let (lo, hi) = (range.lo.max(value.run.lo), range.hi.min(value.run.hi));
        let run = Interval { lo, hi: hi.max(lo) };
        Some(Value { run, ..value })
    }

    fn product(&mut self, a: &Value, b: &Value, expr: Expr) -> Option<Value> {
        let domain = bounds::narrowed(&self.domain, &self.path)?;
        let exact = [a, b].map(|value| value.expr.range(&domain).unwrap_or(Interval::ALL));
        let crossed = exact[0].times(b.error).plus(exact[1].times(a.error));
        // The product of a number with itself is not negative.
        let least = if a.expr == b.expr {
            0.0
        } else {
            f64::NEG_INFINITY
        };
        let run = a.run.times(b.run);
        Some(Value {
            expr,
            error: crossed.plus(a.error.times(b.error)),
            run: Interval {
                lo: run.lo.max(least),
                hi: run.hi,
            },
        })
    }

    /// Returns the branches in which a condition is `holds`. No two of them hold at once, and the
    /// branches around rule out none of them.
    pub(super) fn paths(
        &mut self,
        bit: &Bit,
        holds: bool,
        source: &TokenStream,
    ) -> Option<Vec<Path>> {
        let paths = match bit {
            Bit::Constant(value) => {
                let always = (*value == holds).then(|| self.path.clone());
                always.into_iter().collect()
            }
            Bit::Not(inner) => self.paths(inner, !holds, source)?,
            Bit::Less(a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                let less = Less(a?.expr, b?.expr);
                match self.path.iter().find(|(known, _)| *known == less) {
                    Some((_, known)) if *known != holds => Vec::new(),
                    Some(_) => vec![self.path.clone()],
                    None => {
                        let mut path = self.path.clone();
                        path.push((less, holds));
                        vec![path]
                    }
                }
            }
            Bit::And(a, b) if holds => self.both((a, true), (b, true), source)?,
            Bit::And(a, b) => {
                let mut paths = self.paths(a, false, source)?;
                paths.extend(self.both((a, true), (b, false), source)?);
                paths
            }
            Bit::Xor(a, b) => {
                let mut paths = self.both((a, true), (b, !holds), source)?;
                paths.extend(self.both((a, false), (b, holds), source)?);
                paths
            }
            Bit::At(..) => return self.no_number(source),
            Bit::Equal(..) => {
                let shown = text(source);
                let message = format!("`{shown}`: numbers are equal in single points only");
                let help = "compare by `<` or `>`";
                return self.meaningless(source, &message, help);
            }
        };
        Some(paths)
    }

    fn both(
        &mut self,
        (a, a_holds): (&Bit, bool),
        (b, b_holds): (&Bit, bool),
        source: &TokenStream,
    ) -> Option<Vec<Path>> {
        let around = self.path.clone();
        let mut both = Some(Vec::new());
        for path in self.paths(a, a_holds, source)? {
            self.path = path;
            let found = self.paths(b, b_holds, source);
            both = both.zip(found).map(|(mut both, found)| {
                both.extend(found);
                both
            });
        }
        self.path = around;
        both
    }

    /// Reports an operation on bits, which are no numbers.
    #[cfg_attr(test, track_caller)]
    pub(super) fn no_number<T>(&mut self, source: &TokenStream) -> Option<T> {
        let shown = text(source);
        let message = format!("`{shown}` is read or changed as bits, which are no numbers");
        let help = "compare numbers, as in `cos_i < 0.5`, and add and multiply whole registers";
        self.meaningless(source, &message, help)
    }

    /// Returns the number in the current passes of the loops around.
    pub(super) fn known(&self, number: &Linear) -> Option<i64> {
        let loops = self.loops.iter();
        let number = loops.fold(number.clone(), |number, (variable, pass)| {
            number.with(variable, &Linear::from(*pass))
        });
        number.known()
    }
}

/// Returns a number times `2^by`.
fn scaled(value: Value, by: i64) -> Value {
    if by == 0 {
        return value;
    }
    let factor = 2_f64.powi(by as i32);
    let by = Interval::point(factor);
    let folded = value.expr.constant().map(|number| number * factor);
    let scale = Expr::number(folded.unwrap_or(factor));
    Value {
        expr: match (folded, scale) {
            (Some(_), Some(number)) => number,
            (None, Some(scale)) => &scale * &value.expr,
            (_, None) => value.expr,
        },
        error: value.error.times(by),
        run: value.run.times(by),
    }
}

/// Returns a number that a machine rounds down to `fraction` fraction bits.
fn rounded(value: Value, fraction: i64) -> Value {
    let unit = 2_f64.powi(-(fraction as i32));
    let down = Interval { lo: -unit, hi: 0.0 };
    Value {
        error: value.error.plus(down),
        run: Interval {
            lo: (value.run.lo / unit).floor() * unit,
            hi: value.run.hi,
        },
        ..value
    }
}
