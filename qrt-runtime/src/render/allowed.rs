//! What a picture's circuit may cost: the scene's budget, and memory.

use super::{Model, Options, RenderError};
use crate::memory::CircuitWork;
use qrt_core::oracle::{check_budget, oracle_costs};
use qrt_core::valid::ValidScene;
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

impl Options<'_> {
    /// What is done with the scene's circuit, under the models that run one.
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

/// That the circuit of a scene, whose parameters are chosen, fits into [`Options::memory`] and is within
/// the scene's budget, under the models that run one.
///
/// # Errors
/// [`RenderError::WouldNotFit`], [`RenderError::Budget`], and why there is no circuit.
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
