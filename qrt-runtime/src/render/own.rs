//! Pictures with a user-defined estimator.

use super::{OWN_LIKE, RenderError, RenderOptions};
use qrt_counting::estimators::{AmplitudeEstimator, EstimatorError, Settings, estimator};
use qrt_scene::{Estimator, Scene};
use std::fmt;

/// The longest name of a user-defined estimator, in bytes.
const MOST_BYTES: usize = 64;

/// The prefix of a user-defined estimator's name in pictures and checkpoints.
pub(super) const PREFIX: &str = "own:";

/// An estimator of a channel, with the channel's settings.
pub type BoxedEstimator = Box<dyn AmplitudeEstimator + Send + Sync>;

type Make<'a> = dyn Fn(&Settings) -> Result<BoxedEstimator, EstimatorError> + Sync + 'a;

/// A user-defined estimator for [`super::render`]: set [`RenderOptions::own_estimator`].
///
/// ```
/// use qrt_scene::front::parse;
/// use qrt_counting::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError};
/// use qrt_runtime::render::{RenderOptions, OwnEstimator, render};
///
/// /// The fraction of good indices among 100 that are drawn at random.
/// struct Hundred;
///
/// impl AmplitudeEstimator for Hundred {
///     fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
///         let start = device.usage();
///         let amplitude = device.paths(100) as f64 / 100.0;
///         let (low, high) = (amplitude - 0.1, amplitude + 0.1);
///         Ok(device.estimate(start, amplitude, (low.max(0.0), high.min(1.0)), 0.95))
///     }
/// }
///
/// # let text = "
/// # name: sky
/// # camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
/// # film: { width: 4, height: 2 }
/// # materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
/// # geometry:
/// #   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
/// # ";
/// let scene = parse(text, "sky.yaml", &[], "".as_ref())?.valid;
/// let own = OwnEstimator::new("hundred", &|_settings| Ok(Box::new(Hundred)));
/// let options = RenderOptions { own_estimator: Some(own), ..RenderOptions::default() };
/// let picture = render(&scene, &options)?;
/// assert_eq!(picture.total_queries(), 4 * 2 * 3 * 100);
/// assert_eq!(picture.metadata()?.get("estimator"), Some("own:hundred"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
pub struct OwnEstimator<'a> {
    name: &'a str,
    make: &'a Make<'a>,
}

impl fmt::Debug for OwnEstimator<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("OwnEstimator").field(&self.name).finish()
    }
}

impl<'a> OwnEstimator<'a> {
    /// Creates a user-defined estimator. Its name has 1 to 64 ASCII letters, digits, `_`, `-` or
    /// `.`. `make` creates the estimator of a channel from the channel's settings: the scene's
    /// counting block, with its error in units of the channel's amplitude.
    ///
    /// Pictures and checkpoints store the name, and a picture can be resumed only with an estimator
    /// of the same name. Change the name when you change the estimator.
    pub fn new(name: &'a str, make: &'a Make<'a>) -> Self {
        Self { name, make }
    }

    /// Returns the name of the estimator.
    pub fn name(&self) -> &'a str {
        self.name
    }

    pub(super) fn check(&self) -> Result<(), RenderError> {
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.".contains(&byte);
        if (1..=MOST_BYTES).contains(&self.name.len()) && self.name.bytes().all(plain) {
            return Ok(());
        }
        let name = self.name.to_owned();
        Err(RenderError::OwnName { name })
    }
}

impl RenderOptions<'_> {
    /// Returns the estimator that counts paths in superposition; [`OWN_LIKE`] for a user-defined
    /// one.
    ///
    /// # Errors
    /// If the name of the user-defined estimator is not valid.
    pub(crate) fn counted_by(&self, scene: &Scene) -> Result<Estimator, RenderError> {
        match &self.own_estimator {
            Some(own) => own.check().map(|()| OWN_LIKE),
            None => Ok(self.estimator.unwrap_or(scene.counting.estimator())),
        }
    }

    /// Creates the estimator of a channel: the user-defined one if there is one, otherwise `known`.
    pub(crate) fn estimator_of(
        &self,
        known: Estimator,
        settings: &Settings,
    ) -> Result<BoxedEstimator, EstimatorError> {
        match &self.own_estimator {
            Some(own) => (own.make)(settings),
            None => estimator(known, settings),
        }
    }

    /// Returns the name of the estimator in pictures and checkpoints.
    pub(super) fn estimator_name(&self, known: Estimator) -> String {
        match &self.own_estimator {
            Some(own) => format!("{PREFIX}{}", own.name),
            None => known.name().to_owned(),
        }
    }
}
