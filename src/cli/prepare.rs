//! The one way of a command from a loaded scene to its work: chooses the parameters, and compiles and
//! checks the circuit.

use super::failure::Failure;
use super::progress::Bar;
use super::{memory, terminal, time};
use qrt_core::oracle::{OracleError, Oracles};
use qrt_runtime::Prepared;
use qrt_runtime::memory::{CircuitWork, Memory, compiling_seconds};
use qrt_runtime::plan;
use qrt_runtime::prepared::PrepareError;
use qrt_scene::front::Loaded;
use qrt_scene::valid::ValidScene;
use qrt_syntax::Problem;

/// The preparation that a command asks for.
pub(crate) struct Preparation<'a> {
    pub(crate) memory: Memory,
    pub(crate) planning: plan::PlanOptions<'a>,
    /// True if the plan of a scene that asks for an accuracy is printed on standard error.
    pub(crate) shows_plan: bool,
}

impl Preparation<'_> {
    /// Prepares a scene. Prints the time that planning takes if it is long, and the plan.
    ///
    /// # Errors
    /// No parameters keep the accuracy, or the circuits that are tried do not fit into memory.
    pub(crate) fn prepare<'s>(&self, loaded: &'s Loaded) -> Result<Prepared<'s>, Failure> {
        let scene = &loaded.valid;
        if scene.scene().accuracy.is_some() {
            let fits = self.memory.keep_compiling(scene);
            fits.map_err(|error| memory::refused(&error))?;
            note_compiling(scene);
        }
        let prepared = Prepared::new(scene, &self.planning, self.memory);
        let prepared = prepared.map_err(|error| refused(error, loaded))?;
        if let Some(figures) = prepared.plan().filter(|_| self.shows_plan) {
            terminal::note(figures.to_string().trim_end());
        }
        Ok(prepared)
    }
}

/// Compiles the circuit of the pixel alone, and checks that work on it fits into memory. Prints the time
/// that compiling takes if it is long.
///
/// # Errors
/// The scene has no circuit, or it does not fit.
pub(crate) fn pixel_oracles<'a>(
    prepared: &'a Prepared<'_>,
    loaded: &Loaded,
    (pixel, work): ([u32; 2], CircuitWork),
) -> Result<Oracles<'a>, Failure> {
    note_compiling(prepared.scene());
    let bar = Bar::setting_up();
    let oracles = prepared.pixel_oracles(pixel, work);
    bar.clear();
    oracles.map_err(|error| refused(error, loaded))
}

/// Compiles the circuit of the class of `pixel`, and checks that work on it fits into memory. Prints the
/// time that compiling takes if it is long.
///
/// # Errors
/// The scene has no circuit, or it does not fit.
pub(crate) fn compile(
    prepared: &Prepared<'_>,
    loaded: &Loaded,
    (pixel, work): ([u32; 2], CircuitWork),
) -> Result<(), Failure> {
    let scene = prepared.scene();
    let fits = prepared.memory().keep_compiling(scene);
    fits.map_err(|error| memory::refused(&error))?;
    note_compiling(scene);
    let bar = Bar::setting_up();
    let checked = prepared.check_memory(pixel, work);
    bar.clear();
    checked.map_err(|error| refused(error, loaded))
}

/// Returns the failure of a scene that cannot be prepared: at its place in the scene, or with the
/// user's remedy.
pub(crate) fn refused(error: PrepareError, loaded: &Loaded) -> Failure {
    match error {
        PrepareError::Oracle(error) => without_circuit(&error, loaded),
        PrepareError::Budget(problems) => over_budget(problems, loaded),
        PrepareError::WouldNotFit(error) => memory::refused(&error),
        PrepareError::Plan(error) => error.into(),
        error if error.is_refusal() => Failure::Usage(error.to_string()),
        error => Failure::Job(error.to_string()),
    }
}

/// Returns the failure of a scene that has no circuit, at its place in the scene.
pub(crate) fn without_circuit(error: &OracleError, loaded: &Loaded) -> Failure {
    loaded.report(vec![error.problem()]).into()
}

/// Returns the failure of a scene whose circuit is beyond its budget.
pub(crate) fn over_budget(problems: Vec<Problem>, loaded: &Loaded) -> Failure {
    loaded.report(problems).into()
}

/// Prints the expected time of compiling a scene's circuit if it is long.
pub(crate) fn note_compiling(scene: &ValidScene) {
    let faces = scene.surface_of_faces().len();
    let what = format!("compiling the circuit of a scene of {faces} faces and counting its gates");
    let seconds = compiling_seconds(scene);
    time::tell(&what, seconds, "a coarser mesh takes less");
}
