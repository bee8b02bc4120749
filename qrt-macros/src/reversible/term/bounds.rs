//! Bounds of registers, and proofs that a number is always one of a format.

use super::content::{Path, Value};
use crate::reversible::ir::Format;
use qrt_scene::expr::{Domain, Expr, Interval, Node, Variable, VariableSet};

/// The most parts of the domain that a proof examines before it gives up.
const PARTS: usize = 2048;

/// Returns the least and the greatest number of a format whose widths are known.
pub(super) fn of_format(format: &Format) -> Option<Interval> {
    let width = format.width.known()?;
    let unit = unit(format)?;
    let power = |bits: i64| 2_f64.powi(bits as i32);
    let (lo, hi) = if format.signed() {
        (-power(width - 1), power(width - 1) - 1.0)
    } else {
        (0.0, power(width) - 1.0)
    };
    let (lo, hi) = (lo * unit, hi * unit);
    Some(Interval { lo, hi })
}

/// Returns the number that the lowest bit of a format stands for.
pub(super) fn unit(format: &Format) -> Option<f64> {
    let fraction = format.fraction.known()?;
    Some(2_f64.powi(-(fraction as i32)))
}

/// Returns the domain in which the comparisons of a path hold, as far as they bound a variable by a
/// number. `None` if there is none.
pub(super) fn narrowed(domain: &Domain, path: &Path) -> Option<Domain> {
    let mut domain = *domain;
    for (less, holds) in path {
        let [a, b] = [&less.0, &less.1];
        let (variable, bound, below) = match (a.constant(), b.constant()) {
            (None, Some(bound)) => (lone(a), bound, *holds),
            (Some(bound), None) => (lone(b), bound, !holds),
            _ => continue,
        };
        let Some(variable) = variable else { continue };
        let range = domain.get_mut(variable);
        if below {
            range.hi = range.hi.min(bound);
        } else {
            range.lo = range.lo.max(bound);
        }
        if range.lo > range.hi {
            return None;
        }
    }
    Some(domain)
}

/// Returns the variable, if an expression is a single variable.
fn lone(expression: &Expr) -> Option<Variable> {
    match expression.nodes() {
        [Node::Variable(variable)] => Some(*variable),
        _ => None,
    }
}

/// True if a register's number, its rounding included, is always within `room` on `path`.
pub(super) fn fits(value: &Value, room: Interval, domain: &Domain, path: &Path) -> bool {
    if within(value.run, room) {
        return true;
    }
    let room = [room.lo - value.error.lo, room.hi - value.error.hi];
    let mut parts = vec![*domain];
    let mut seen = 0;
    while let Some(part) = parts.pop() {
        seen += 1;
        if !possible(path, &part) {
            continue;
        }
        let range = value.expr.range(&part).unwrap_or(Interval::ALL);
        if room[0] <= range.lo && range.hi <= room[1] {
            continue;
        }
        let Some(halves) = halves(&part, value.expr.variables(value.expr.root())) else {
            return false;
        };
        if seen + parts.len() > PARTS {
            return false;
        }
        parts.extend(halves);
    }
    true
}

pub(super) fn within(range: Interval, room: Interval) -> bool {
    room.lo <= range.lo && range.hi <= room.hi
}

/// True if the comparisons of a path can hold somewhere in a part of the domain.
fn possible(path: &Path, part: &Domain) -> bool {
    path.iter().all(|(less, holds)| {
        let [a, b] = [&less.0, &less.1].map(|e| e.range(part).unwrap_or(Interval::ALL));
        if *holds { a.lo < b.hi } else { a.hi >= b.lo }
    })
}

/// Cuts a part of the domain in two, across the longest of the ranges of `variables`.
fn halves(part: &Domain, variables: VariableSet) -> Option<[Domain; 2]> {
    let length = |variable: &Variable| part.get(*variable).hi - part.get(*variable).lo;
    let longest = variables
        .iter()
        .max_by(|a, b| length(a).total_cmp(&length(b)))?;
    if length(&longest) <= f64::EPSILON {
        return None;
    }
    let Interval { lo, hi } = part.get(longest);
    let middle = f64::midpoint(lo, hi);
    let mut halves = [*part, *part];
    *halves[0].get_mut(longest) = Interval { lo, hi: middle };
    *halves[1].get_mut(longest) = Interval { lo: middle, hi };
    Some(halves)
}
