//! The budget of a scene's circuit, and the problems of a scene that has no circuit.

#[cfg(test)]
mod tests;

use super::{CallCost, MOST_FACES, OracleCost, OracleError};
use crate::compile::BuildError;
use qrt_scene::valid::ValidScene;
use qrt_scene::{Nearest, Uncompute};
use qrt_syntax::{Circuit, Path, Problem, Problems};

/// Reports the limits of the scene's `budget` that `costs` exceed, each with advice. `costs` are those
/// of [`Oracles::costs`](super::Oracles::costs), or of the oracles that are run. Each limit holds for every
/// oracle. [`qrt_scene::front::Loaded::report`] shows the problems in the scene.
///
/// # Errors
/// At least one limit is exceeded.
pub fn check_budget(scene: &ValidScene, costs: &[OracleCost]) -> Result<(), Vec<Problem>> {
    let written = scene.scene();
    let Some(budget) = written.budget else {
        return Ok(());
    };
    let spent = CallCost::greatest(costs);
    let uncompute = written.circuit.uncompute;
    let scoped = !matches!(uncompute, Uncompute::Keep | Uncompute::Auto);
    let path = Path::root().key("budget");
    let mut problems = Problems::default();
    let used = spent.qubits;
    if let Some(most) = budget.qubits.filter(|&most| most < used) {
        let what = Circuit::Qubits {
            used,
            most,
            auto: uncompute == Uncompute::Auto,
        };
        problems.add(path.key("qubits"), what);
    }
    let used = spent.toffoli;
    if let Some(most) = budget.toffoli.filter(|&most| most < used) {
        let what = Circuit::Toffolis {
            used,
            most,
            scoped,
            running: written.circuit.nearest == Nearest::Running,
        };
        problems.add(path.key("toffoli"), what);
    }
    problems.result(())
}

impl OracleError {
    /// Converts this error to a problem of the scene, for [`qrt_scene::front::Loaded::report`].
    pub fn problem(&self) -> Problem {
        let root = Path::root();
        match self {
            Self::Build(error) => {
                let path = match error {
                    BuildError::UnboundedQuotient | BuildError::UnboundedFunction => {
                        root.key("materials")
                    }
                    BuildError::TooWide {
                        value: Some(value), ..
                    } => {
                        let material = root.key("materials").key(&value.material);
                        material.key(value.kind).key(value.key)
                    }
                    BuildError::TooWide { .. } => root.key("precision").key("fraction"),
                };
                Problem::new(path, error.problem())
            }
            Self::Sampling(error) => Problem::new(root.key("sampling"), error.problem()),
            &Self::TooManyFaces { faces } => {
                let most = MOST_FACES;
                let what = Circuit::TooManyFaces { faces, most };
                Problem::new(root.key("geometry"), what)
            }
            &Self::SphereInTable { primitive } => {
                let place = root.key("geometry").item(primitive).key("sphere");
                Problem::new(place, Circuit::SphereInTable)
            }
            &Self::SmallSphere {
                primitive,
                fraction,
                needed,
            } => {
                let place = root.key("geometry").item(primitive).key("sphere");
                let what = Circuit::SmallSphere { fraction, needed };
                Problem::new(place.key("radius"), what)
            }
            &Self::ThinSmoothFace {
                primitive,
                fraction,
                needed,
            } => {
                let place = root.key("geometry").item(primitive).key("mesh");
                Problem::new(place, Circuit::ThinSmoothFace { fraction, needed })
            }
            &Self::ThinColouredFace {
                primitive,
                fraction,
                needed,
            } => {
                let place = root.key("geometry").item(primitive).key("mesh");
                let what = Circuit::ThinColouredFace { fraction, needed };
                Problem::new(place.key("colors"), what)
            }
            &Self::SmallCell {
                ref material,
                kind,
                key,
                fraction,
                needed,
            } => {
                let place = root.key("materials").key(material).key(kind).key(key);
                let what = Circuit::SmallCell { fraction, needed };
                Problem::new(place.key("checker").key("scale"), what)
            }
        }
    }
}
