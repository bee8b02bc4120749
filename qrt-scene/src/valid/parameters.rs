//! The parameters of a scene, and the same scene under other parameters.

use super::{ValidScene, counting, lights, sampling};
use crate::scene::shape::Part;
use crate::scene::{Circuit, Comparator, Counting, Precision, Sampling};
use qrt_syntax::{Place, Problem, Problems};
use std::sync::OnceLock;

/// The parameters of a scene that trade accuracy for cost. The limit of the picture depends on none
/// of them but the number of [`Sampling::depths`].
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Parameters {
    pub sampling: Sampling,
    pub precision: Precision,
    pub comparator: Comparator,
    pub counting: Counting,
    pub circuit: Circuit,
}

impl ValidScene {
    /// Returns the scene's parameters. Under `accuracy`, the parameters that it chooses have their
    /// defaults.
    pub fn parameters(&self) -> Parameters {
        let scene = &self.scene;
        Parameters {
            sampling: scene.sampling.clone(),
            precision: scene.precision,
            comparator: scene.comparator,
            counting: scene.counting,
            circuit: scene.circuit,
        }
    }

    /// Returns the same scene under other parameters, and without an `accuracy` that would choose
    /// them. Geometry and materials stay as they were read, except lamps that were not sampled
    /// before and are now: they are cut into shapes that can be sampled. An estimator that the picture's size chose is
    /// chosen anew.
    ///
    /// # Errors
    /// All problems of the parameters.
    ///
    /// ```
    /// # let text = "
    /// # name: dark
    /// # camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
    /// # film: { width: 8, height: 8 }
    /// # materials: {}
    /// # geometry: []
    /// # ";
    /// # let scene = qrt_scene::front::parse(text, "dark.yaml", &[], "".as_ref()).unwrap().valid;
    /// let mut parameters = scene.parameters();
    /// parameters.comparator.bits = 6;
    /// let coarse = scene.with_parameters(parameters.clone()).unwrap();
    /// assert_eq!(coarse.scene().comparator.bits, 6);
    /// parameters.comparator.bits = 31;
    /// let problems = scene.with_parameters(parameters).unwrap_err();
    /// assert_eq!(problems[0].path().unwrap().to_string(), "comparator.bits");
    /// ```
    pub fn with_parameters(&self, parameters: Parameters) -> Result<Self, Vec<Problem>> {
        let mut changed = Self {
            // Another circuit may need another strategy.
            auto: OnceLock::new(),
            fingerprint: OnceLock::new(),
            ..self.clone()
        };
        let scene = &mut changed.scene;
        scene.sampling = parameters.sampling;
        scene.precision = parameters.precision;
        scene.comparator = parameters.comparator;
        scene.counting = parameters.counting;
        scene.circuit = parameters.circuit;
        scene.accuracy = None;
        if self.by_size && scene.counting.estimator == self.scene.counting.estimator {
            scene.counting.estimator = None;
        }
        changed.by_size = counting::choose_by_size(scene);
        let mut problems = Problems::default();
        scene.check(&Place::ROOT, &mut problems);
        problems.finalize();
        sampling::check(scene, &mut problems);
        counting::check(scene, &mut problems);
        lights::check(&mut changed, &mut problems);
        problems.result(changed)
    }
}
