//! The costs of a scene's oracle and of its parts, as `qrt inspect` shows them.

use crate::verify::{PixelCounts, VerifyError, pixel_counts};
use qrt_core::inspect::{Inspection, OraclePixel, PassFigures};
use qrt_core::oracle::OracleCost;
use qrt_runtime::Prepared;
use qrt_runtime::plan::PlanFigures;
use qrt_scene::valid::ValidScene;

/// The largest number of operations of an oracle whose passes are compared: each of six steps compiles it
/// again.
pub const MOST_OPS: usize = 1 << 19;

/// The figures of one of a scene's oracles.
pub struct InspectFigures<'a> {
    /// The scene, with the parameters that were planned for it.
    pub scene: &'a ValidScene,
    /// The oracle.
    pub inspection: Inspection,
    /// The costs of all oracles of the scene.
    pub costs: Vec<OracleCost>,
    /// The figures of each pass of the compiler on the oracle, in order; empty beyond [`MOST_OPS`].
    pub passes: Vec<PassFigures>,
    /// The plan, if the scene asks for an accuracy.
    pub plan: Option<&'a PlanFigures>,
    /// The pixel's counts beside those of real numbers, if it is the oracle of a pixel and has few paths.
    pub counts: Option<PixelCounts>,
}

impl<'a> InspectFigures<'a> {
    /// Inspects the oracle of `pixel` alone, or without one the oracle with the most Toffolis: of channel
    /// 0 red, 1 green or 2 blue, or of all channels.
    ///
    /// # Errors
    /// The scene has no circuit, or the oracle's program shows a defect.
    ///
    /// # Panics
    /// If the pixel is outside the film.
    pub fn new(
        prepared: &'a Prepared<'_>,
        channel: Option<usize>,
        pixel: Option<OraclePixel>,
    ) -> Result<Self, VerifyError> {
        let (scene, oracles) = (prepared.scene(), prepared.oracles());
        // Its size is known.
        oracles.release_large();
        let costs = oracles.costs()?;
        let inspection = match pixel {
            Some(pixel) => Inspection::of_pixel(oracles, channel, pixel),
            None => Inspection::most_expensive(oracles, channel),
        }?;
        let counts = match pixel {
            Some(pixel) => pixel_counts(scene, &inspection.oracle, pixel)?,
            None => None,
        };
        let passes = if inspection.oracle.program.ops.len() > MOST_OPS {
            Vec::new()
        } else {
            inspection.passes(oracles)?
        };
        Ok(Self {
            scene,
            costs,
            passes,
            plan: prepared.plan(),
            counts,
            inspection,
        })
    }
}
