//! Parts of an expression without a finite value, and the point at which they occur.

use qrt_syntax::Bsdf;
use qrt_syntax::expr::{Expr, VariableSet, Variables};

/// Returns a problem if a part of `f` is not finite while `f` is, such as the quotient in
/// `atan2(1/0, 1)`. `values` are the values of its nodes at `at`.
///
/// Floating point computes with an infinity, but a register cannot hold one, so results would
/// differ.
pub(super) fn undefined_part(f: &Expr, at: &Variables, values: &[f64]) -> Option<Bsdf> {
    let id = f.undefined_part(values)?;
    let part = f.part(id);
    let is_short = part.written_nodes() <= 60;
    Some(Bsdf::UndefinedPart {
        part: is_short.then(|| part.to_string()),
        is_infinite: values[id.index()].is_infinite(),
        at: situation(f, at),
    })
}

/// The variables of `f` with their values.
pub(super) fn situation(f: &Expr, at: &Variables) -> Vec<(&'static str, f64)> {
    let set = f.variables(f.root());
    let shown = if set.is_empty() {
        VariableSet::SQUARE
    } else {
        set
    };
    shown.iter().map(|v| (v.name(), at.get(v))).collect()
}
