//! The content of a register: a sum of expressions, each under some comparisons.
//!
//! A subtraction removes an equal addition from the sum, so a scratch register that was uncomputed
//! is 0.

use qrt_scene::expr::{Expr, Interval};

/// The comparison `.0 < .1`.
#[derive(Clone, PartialEq)]
pub(super) struct Less(pub(super) Expr, pub(super) Expr);

/// Comparisons, and whether they hold: the branches around a statement.
pub(super) type Path = Vec<(Less, bool)>;

/// A computed number.
#[derive(Clone)]
pub(super) struct Value {
    /// The number without any rounding, as an expression.
    pub(super) expr: Expr,
    /// An interval of the rounding error.
    pub(super) error: Interval,
    /// An interval of the numbers that a machine's register may hold.
    pub(super) run: Interval,
}

impl Value {
    pub(super) fn constant(number: f64) -> Option<Self> {
        Some(Self {
            expr: Expr::number(number)?,
            error: Interval::point(0.0),
            run: Interval::point(number),
        })
    }
}

/// One of the added numbers.
#[derive(Clone)]
struct Addend {
    subtracted: bool,
    path: Path,
    value: Value,
}

/// The content of a register.
#[derive(Clone, Default)]
pub(super) struct Content(Vec<Addend>);

impl Content {
    /// Creates the content of a register that holds `value` at the beginning.
    pub(super) fn from_value(value: Value) -> Self {
        let part = Addend {
            subtracted: false,
            path: Path::new(),
            value,
        };
        Self(vec![part])
    }

    /// Number of addends.
    pub(super) fn parts(&self) -> usize {
        self.0.len()
    }

    /// Adds a number on `path`, or subtracts it.
    pub(super) fn add(&mut self, value: Value, subtracted: bool, path: &Path) {
        let taken_back = self.0.iter().rposition(|part| {
            part.subtracted != subtracted && part.path == *path && part.value.expr == value.expr
        });
        if let Some(taken_back) = taken_back {
            self.0.remove(taken_back);
            return;
        }
        self.0.push(Addend {
            subtracted,
            path: path.clone(),
            value,
        });
    }

    /// Returns this content with `other` in its place on `path`.
    pub(super) fn replaced(&self, other: &Self, path: &Path) -> Self {
        let mut parts = other.within(path);
        // Off the path: the first comparisons are as on the path, and the next one is not.
        for (at, (less, holds)) in path.iter().enumerate() {
            let mut elsewhere = path[..at].to_vec();
            elsewhere.push((less.clone(), !holds));
            parts.extend(self.within(&elsewhere));
        }
        Self(merged(parts))
    }

    /// Returns the parts that exist on `path`, as parts that exist only there.
    fn within(&self, path: &Path) -> Vec<Addend> {
        let parts = self.0.iter().filter_map(|part| {
            let mut part = part.seen_from(path)?;
            part.path.splice(..0, path.iter().cloned());
            Some(part)
        });
        parts.collect()
    }

    /// Returns the register's number on `path`.
    pub(super) fn value(&self, path: &Path) -> Value {
        let parts = self.0.iter().filter_map(|part| part.seen_from(path));
        sum(parts.collect())
    }
}

impl Addend {
    /// Returns the part on `path`; `None` if it was not added there.
    fn seen_from(&self, path: &Path) -> Option<Self> {
        let mut own = Path::new();
        for (less, holds) in &self.path {
            match path.iter().find(|(known, _)| known == less) {
                Some((_, known)) if known == holds => {}
                Some(_) => return None,
                None => own.push((less.clone(), *holds)),
            }
        }
        Some(Self {
            path: own,
            ..self.clone()
        })
    }

    /// Returns the part once its first comparison is known.
    fn inner(&self) -> Self {
        Self {
            path: self.path[1..].to_vec(),
            ..self.clone()
        }
    }
}

/// Merges the parts that were added on both sides of a comparison.
fn merged(mut parts: Vec<Addend>) -> Vec<Addend> {
    let twin = |a: &Addend, b: &Addend| {
        let both = || a.path.iter().zip(&b.path);
        let differs = both().position(|(a, b)| a != b)?;
        let opposite = both()
            .enumerate()
            .all(|(at, (a, b))| a.0 == b.0 && (at == differs) == (a.1 != b.1));
        let same = a.subtracted == b.subtracted && a.value.expr == b.value.expr;
        (same && opposite && a.path.len() == b.path.len()).then_some(differs)
    };
    let mut at = 0;
    while at < parts.len() {
        let mut others = parts.iter().enumerate().skip(at + 1);
        let found = others.find_map(|(other, part)| Some((other, twin(&parts[at], part)?)));
        match found {
            Some((other, differs)) => {
                parts.remove(other);
                parts[at].path.remove(differs);
                at = 0;
            }
            None => at += 1,
        }
    }
    parts
}

/// Returns the sum of parts. The parts that one comparison decides about become one `if_less`.
fn sum(parts: Vec<Addend>) -> Value {
    let mut total: Option<Value> = None;
    let mut rest = parts;
    // An added part comes first, so that the sum does not begin with a minus.
    if let Some(first) = rest.iter().position(|part| !part.subtracted) {
        rest[..=first].rotate_right(1);
    }
    while !rest.is_empty() {
        let part = rest.remove(0);
        let (value, subtracted) = match part.path.first() {
            None => (part.value.clone(), part.subtracted),
            Some((less, _)) => {
                let less = less.clone();
                let same = |other: &Addend| other.path.first().is_some_and(|(own, _)| *own == less);
                let (mut decided, others): (Vec<_>, Vec<_>) = rest.drain(..).partition(same);
                rest = others;
                decided.insert(0, part);
                let side = |holds: bool| {
                    let own = decided.iter().filter(|part| part.path[0].1 == holds);
                    sum(own.map(Addend::inner).collect())
                };
                (choice(&less, &side(true), &side(false)), false)
            }
        };
        total = Some(match total {
            None if subtracted => negative(&value),
            None => value,
            Some(total) => added(&total, &value, subtracted),
        });
    }
    total.unwrap_or_else(|| Value {
        expr: Expr::from(0),
        error: Interval::point(0.0),
        run: Interval::point(0.0),
    })
}

pub(super) fn negative(value: &Value) -> Value {
    let expr = match value
        .expr
        .constant()
        .and_then(|number| Expr::number(-number))
    {
        Some(number) => number,
        None => -&value.expr,
    };
    Value {
        expr,
        error: -value.error,
        run: -value.run,
    }
}

pub(super) fn added(a: &Value, b: &Value, subtracted: bool) -> Value {
    let turned = if subtracted { negative(b) } else { b.clone() };
    let expr = if subtracted {
        &a.expr - &b.expr
    } else {
        &a.expr + &b.expr
    };
    Value {
        expr,
        error: a.error.plus(turned.error),
        run: a.run.plus(turned.run),
    }
}

/// Returns `then` where the comparison holds, `otherwise` elsewhere.
fn choice(less: &Less, then: &Value, otherwise: &Value) -> Value {
    Value {
        expr: less.0.if_less(&less.1, &then.expr, &otherwise.expr),
        error: then.error.hull(otherwise.error),
        run: then.run.hull(otherwise.run),
    }
}
