//! User-defined predicates of paths: counts and pictures.
//!
//! A predicate is reversible code over the registers of a path; [`qrt_core::oracle::paths`] lists
//! these registers. The predicate becomes a part of the oracle, between compute and uncompute: see
//! [`Predicate`]. The machines run it as they run a scene's colours:
//!
//! | model | the path | the predicate |
//! |---|---|---|
//! | `real` | the tracer in `f64`, each number rounded to the nearest of its register | its program, on integers |
//! | `fixed` | the oracle's program, on integers | as a part of the program |
//! | `gates` | the oracle's circuit, gate by gate | as a part of the circuit, and every ancilla is checked |
//!
//! The crate `qrt` has examples of predicates, because `qrt!` creates the types of their registers.

mod count;

pub use count::{PixelCount, PredicateCount, count_where};

pub use crate::path_machines::QueryCost;
pub use crate::render::error::PredicateRefusal;

use crate::models::{MachineOptions, path_machines};
use crate::render::{Colour, RenderError, RenderOptions, Rendered, render_on};
use qrt_circuit::format::{Bool, Reg};
use qrt_circuit::{Recorded, Recorder};
use qrt_core::oracle::paths::PathScene;
use qrt_core::oracle::{Marks, Oracles, Predicate};

/// Checks that `options` and the scene are supported with a predicate.
pub(crate) fn check(
    predicate: &Predicate,
    options: &RenderOptions<'_>,
) -> Result<(), PredicateRefusal> {
    if predicate.scene().scene().accuracy.is_some() {
        return Err(PredicateRefusal::Accuracy);
    }
    if options.colour == Colour::OneRun {
        return Err(PredicateRefusal::OneRun);
    }
    if options.searches() {
        return Err(PredicateRefusal::Visibility);
    }
    if options.checkpoint.is_some() {
        return Err(PredicateRefusal::Checkpoint);
    }
    Ok(())
}

/// Renders the light of only those paths of a scene of `qrt!` that satisfy a predicate: as
/// [`crate::render::render`], with all other paths black.
///
/// The predicate gets a bit that is 0, and flips it on good paths. Its code runs once, on a
/// [`Recorder`].
///
/// # Errors
/// As [`crate::render::render`]; a [`qrt_core::oracle::PredicateError`] if the code is not a
/// predicate, and a [`PredicateRefusal`] for options that predicates don't support.
pub fn render_where<S: PathScene>(
    options: &RenderOptions<'_>,
    predicate: impl FnOnce(&mut Recorder, &S::Path, &mut Reg<Recorded, Bool>),
) -> Result<Rendered, RenderError> {
    let predicate = Predicate::record::<S>(predicate)?;
    check(&predicate, options)?;
    render_on(predicate.scene(), options, |machine| {
        let machine = MachineOptions {
            predicate: Some((&predicate, Marks::Light)),
            ..machine
        };
        path_machines(&Oracles::new(predicate.scene()), &machine)
    })
}
