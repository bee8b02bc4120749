//! Paths on which a predicate of one's own holds: counted, rendered, and looked at one by one.
//!
//! A predicate is reversible code over the registers of a path: see
//! [`qrt_core::oracle::paths`] for what they hold. It becomes a part of the oracle, between
//! compute and uncompute: see [`Predicate`]. So the machines run it as they run a scene's colours:
//!
//! | model | the path | the predicate |
//! |---|---|---|
//! | `real` | the tracer in `f64`, each number rounded to the nearest of its register | its program, on integers |
//! | `fixed` | the oracle's program, on integers | as a part of it |
//! | `gates` | the oracle's circuit, gate by gate | as a part of it, with every ancilla looked at |
//!
//! The crate `qrt` shows predicates at work, since `qrt!` makes the types of their registers.

mod count;
mod path;

pub use count::{Counted, PixelCount, QueryCost, count_where};
pub use path::{TracedHit, TracedPath, TracedRay, trace_path, trace_path_of};

pub use crate::render::PredicateRefusal;

use crate::render::{Colour, Options, RenderError, Rendered, Visibility, render_predicate};
use qrt_circuit::format::{Bool, Reg};
use qrt_circuit::{Recorded, Recorder};
use qrt_core::oracle::Predicate;
use qrt_core::oracle::paths::PathScene;

/// Refuses what is not asked with a predicate.
pub(crate) fn check(predicate: &Predicate, options: &Options<'_>) -> Result<(), PredicateRefusal> {
    if predicate.scene().scene().accuracy.is_some() {
        return Err(PredicateRefusal::Accuracy);
    }
    if options.colour == Colour::OneRun {
        return Err(PredicateRefusal::OneRun);
    }
    if options.visibility != Visibility::Classical {
        return Err(PredicateRefusal::Visibility);
    }
    if options.checkpoint.is_some() {
        return Err(PredicateRefusal::Checkpoint);
    }
    Ok(())
}

/// Renders the light that arrives on the paths of a scene of `qrt!` on which a predicate holds: as
/// [`crate::render::render`] does, with all other paths black.
///
/// The predicate flips the bit that it is given, which is 0, on good paths. It runs on a
/// [`Recorder`], once.
///
/// # Errors
/// As [`crate::render::render`]; a [`qrt_core::oracle::PredicateError`] if the code is no
/// predicate, and a [`PredicateRefusal`] for options that none is asked with.
pub fn render_where<S: PathScene>(
    options: &Options<'_>,
    predicate: impl FnOnce(&mut Recorder, &S::Path, &mut Reg<Recorded, Bool>),
) -> Result<Rendered, RenderError> {
    let predicate = Predicate::of::<S>(predicate)?;
    check(&predicate, options)?;
    render_predicate(&predicate, options)
}
