//! One scene under other knobs.

use super::{ValidScene, sampling};
use crate::scene::shape::Part;
use crate::scene::{Circuit, Comparator, Counting, Precision, Sampling};
use crate::syntax::{Place, Problem, Problems};

/// What of a scene trades accuracy for cost: all that is not seen in its picture's limit, but for
/// the number of [`Sampling::depths`].
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Knobs {
    pub sampling: Sampling,
    pub precision: Precision,
    pub comparator: Comparator,
    pub counting: Counting,
    pub circuit: Circuit,
}

impl ValidScene {
    /// The scene's knobs. Under `accuracy` those that it chooses have their defaults.
    pub fn knobs(&self) -> Knobs {
        let scene = &self.scene;
        Knobs {
            sampling: scene.sampling.clone(),
            precision: scene.precision,
            comparator: scene.comparator,
            counting: scene.counting,
            circuit: scene.circuit,
        }
    }

    /// The same scene under other knobs, and without an `accuracy` that would choose them.
    /// Geometry and materials are as they were read.
    ///
    /// # Errors
    /// Everything that is wrong with the knobs.
    ///
    /// ```
    /// # let text = "
    /// # name: dark
    /// # camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
    /// # film: { width: 8, height: 8 }
    /// # materials: {}
    /// # geometry: []
    /// # ";
    /// # let scene = qrt_core::front::parse(text, "dark.yaml", &[], "".as_ref()).unwrap().valid;
    /// let mut knobs = scene.knobs();
    /// knobs.comparator.bits = 6;
    /// let coarse = scene.with_knobs(knobs.clone()).unwrap();
    /// assert_eq!(coarse.scene().comparator.bits, 6);
    /// knobs.comparator.bits = 31;
    /// let problems = scene.with_knobs(knobs).unwrap_err();
    /// assert_eq!(problems[0].path().unwrap().to_string(), "comparator.bits");
    /// ```
    pub fn with_knobs(&self, knobs: Knobs) -> Result<Self, Vec<Problem>> {
        let mut changed = self.clone();
        let scene = &mut changed.scene;
        scene.sampling = knobs.sampling;
        scene.precision = knobs.precision;
        scene.comparator = knobs.comparator;
        scene.counting = knobs.counting;
        scene.circuit = knobs.circuit;
        scene.accuracy = None;
        let mut problems = Problems::default();
        scene.check(&Place::ROOT, &mut problems);
        problems.settle();
        sampling::check(scene, &mut problems);
        problems.result(changed)
    }
}
