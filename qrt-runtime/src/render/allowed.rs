//! Checks that a picture's circuit is within the scene's budget and the memory budget.

use super::{Model, Options, RenderError};
use crate::memory::CircuitWork;
use qrt_core::oracle::{check_budget, oracle_costs};
use qrt_scene::valid::ValidScene;
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

impl Options<'_> {
    /// Returns how a render uses the scene's circuit; `None` for the real model, which runs none.
    pub fn circuit_work(&self) -> Option<CircuitWork> {
        let cores = || available_parallelism().map_or(1, NonZeroUsize::get);
        match self.model {
            Model::Real => None,
            Model::Fixed => Some(CircuitWork::Program),
            Model::Gates => {
                let threads = self.workers.threads.map_or_else(cores, NonZeroUsize::get);
                Some(CircuitWork::Gates(threads))
            }
        }
    }
}

/// Checks that the circuit of a scene, whose parameters are chosen, fits into [`Options::memory`]
/// and is within the scene's budget. Under [`Model::Real`], which runs no circuit, there is nothing
/// to check.
///
/// # Errors
/// [`RenderError::WouldNotFit`], [`RenderError::Budget`], or an error that the scene has no
/// circuit.
pub fn check_circuit(scene: &ValidScene, options: &Options<'_>) -> Result<(), RenderError> {
    let Some(work) = options.circuit_work() else {
        return Ok(());
    };
    options.memory.keep_circuit(scene, work)?;
    if scene.scene().budget.is_none() {
        return Ok(());
    }
    check_budget(scene, &oracle_costs(scene)?).map_err(RenderError::Budget)
}
