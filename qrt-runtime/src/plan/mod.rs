//! From an asked accuracy to the cheapest parameters.
//!
//! `accuracy: { error, confidence }` asks that a channel of a pixel be within `error` times the
//! picture's mean radiance of its limit (infinitely many paths of the scene's length, real numbers,
//! nothing counted) with probability `confidence`: that fraction of a picture's channels is.
//!
//! # How parameters are chosen
//!
//! By trying them on a sample of pixels, each part of the error apart:
//!
//! * *paths*: the difference between two independently shifted nets of `2^k` paths, over the square
//!   root of 2, for growing k; beyond [`MOST_TRIED`] bits by the power law that they show;
//! * *comparators*: counted thresholds against the mean of the same paths;
//! * *width*: the circuit's counts against those of real numbers on the same paths;
//! * *counting*: runs of the estimator on each channel's own S/N.
//!
//! They are added up channel by channel, run by run, so that what counts is how they really
//! combine. Parameters will do if the fraction of channels that are off by more, and 1.64 times its
//! standard error over pixels (what another sample, or one picture's luck, may add), stay below
//! 1 - confidence.
//!
//! Among parameters that will do, the product of queries and Toffolis is made least: queries
//! against the width of numbers. A path bit costs a qubit and no Toffoli, but twice the time of a
//! simulation; path bits are added as long as each, or each of up to three together, saves an
//! sixteenth of the queries. Comparators are so many that they take a twentieth of the error.
//!
//! The seed of a picture plays no part: a scene always gets the same parameters.

mod counted;
mod error;
mod figures;
mod pilot;
mod search;
mod together;

pub use error::PlanError;
pub use figures::{ErrorParts, Figures};
pub use pilot::MOST_TRIED;

use crate::estimators::Noise;
use crate::workers::Workers;
use pilot::Pilot;
use qrt_core::scene::{Counting, Estimator};
use qrt_core::valid::ValidScene;

/// How to plan. What isn't set follows from the scene.
#[derive(Clone, Copy, Default)]
pub struct Options<'a> {
    /// The estimator; the default one unless set.
    pub estimator: Option<Estimator>,
    /// Noise of the device that will count.
    pub noise: Noise,
    /// Who does the work.
    pub workers: Workers<'a>,
}

/// A scene with chosen parameters.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene with the chosen parameters in place of its accuracy.
    pub scene: ValidScene,
    /// The parameters that were chosen, and the errors and costs that are expected of them.
    pub figures: Figures,
}

/// Chooses the parameters of a scene that asks for an accuracy; `None` for one that doesn't.
///
/// # Errors
/// See [`PlanError`].
pub fn plan(scene: &ValidScene, options: &Options<'_>) -> Result<Option<Plan>, PlanError> {
    let Some(accuracy) = scene.scene().accuracy else {
        return Ok(None);
    };
    let estimator = options.estimator.unwrap_or(Counting::default().estimator);
    options.workers.run(|| {
        let pilot = Pilot::new(scene, accuracy, estimator, options)?;
        search::search(pilot).map(Some)
    })?
}
