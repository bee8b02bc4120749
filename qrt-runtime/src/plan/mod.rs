//! Chooses the cheapest parameters for a requested accuracy.
//!
//! `accuracy: { error, confidence }` requests that the fraction `confidence` of a picture's
//! channels be within `error` times the picture's mean radiance of their limit. The limit has
//! infinitely many paths of the scene's length, real numbers, and no error of counting.
//!
//! # Choice of parameters
//!
//! Parameters are tried on a sample of pixels, and each part of the error is measured separately:
//!
//! * *paths*: the difference between two independently shifted nets of `2^k` paths, over the square
//!   root of 2, for growing k; beyond [`MOST_TRIED`] bits, a power law fitted to these differences;
//! * *comparators*: the count of thresholds against the mean of the same paths;
//! * *width*: the circuit's counts against those of real numbers on the same paths;
//! * *counting*: runs of the estimator on each channel's own S/N.
//!
//! The parts are added channel by channel and run by run, so that the sum has the distribution of
//! the combined error. Parameters are accepted if the fraction of channels beyond the requested
//! error, plus 1.645 times its standard error, is at most 1 - confidence. The standard error covers
//! the choice of the sample and the randomness of one picture.
//!
//! Among accepted parameters, the plan minimizes the product of queries and Toffolis: it balances
//! queries against the width of numbers. A path bit costs a qubit and no Toffoli, but twice the
//! time of a simulation. Path bits are added as long as each one, or each of up to three together,
//! saves a sixteenth of the queries. The number of comparators is chosen so that they take at most
//! a twentieth of the error.
//!
//! The seed of a picture has no influence: a scene always gets the same parameters.

mod counted;
mod error;
mod figures;
mod pilot;
mod search;
mod together;

pub use error::PlanError;
pub use figures::{ErrorParts, PlanFigures};
pub use pilot::MOST_TRIED;

use crate::workers::Workers;
use pilot::Pilot;
use qrt_counting::estimators::Noise;
use qrt_scene::valid::ValidScene;
use qrt_scene::{Counting, Estimator};

/// Options of a plan. Options that are not set follow from the scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlanOptions<'a> {
    /// The estimator; the default one unless set.
    pub estimator: Option<Estimator>,
    /// Noise of the device that the plan is for.
    pub noise: Noise,
    /// The threads that do the work.
    pub workers: Workers<'a>,
}

/// A scene with chosen parameters.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene with the chosen parameters in place of its accuracy.
    pub scene: ValidScene,
    /// The chosen parameters, and the errors and costs that are expected of them.
    pub figures: PlanFigures,
}

/// Chooses the parameters of a scene that asks for an accuracy; `None` for one that doesn't.
///
/// # Errors
/// See [`PlanError`].
pub fn plan(scene: &ValidScene, options: &PlanOptions<'_>) -> Result<Option<Plan>, PlanError> {
    let Some(accuracy) = scene.scene().accuracy else {
        return Ok(None);
    };
    let estimator = options.estimator.unwrap_or(Counting::default().estimator());
    options.workers.on_threads(|| {
        let pilot = Pilot::new(scene, accuracy, estimator, options)?;
        search::search(pilot).map(Some)
    })?
}
