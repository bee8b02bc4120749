//! Tracking of the content of each register. It checks that scratch registers are zero again, and
//! that the operands of a `within!` are unchanged when it is undone.
//!
//! If all widths and bounds are known, a routine is followed bit by bit, and loops pass by pass
//! ([`exact`]). In a routine over constants, registers and loops are followed as wholes
//! ([`lists`]).

mod blame;
mod content;
mod exact;
mod keys;
mod lists;
mod polynomial;

use super::ir::{Register, Statement};
use super::problem::Problems;
use exact::{Exact, Unknown};
use std::rc::Rc;

/// Checks a routine's body.
pub(super) fn check(parameters: &[Rc<Register>], body: &[Statement], problems: &mut Problems) {
    let exact = Exact::new(parameters).and_then(|mut exact| {
        exact.statements(body)?;
        Ok(exact.problems)
    });
    match exact {
        Ok(found) => problems.append(found),
        Err(Unknown) => lists::Tracker::new(problems).body(body),
    }
}
