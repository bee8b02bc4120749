//! The settings with which the programs of a scene are built.

use super::{DEFAULT_FRACTION, OracleError, OracleOptions, faces};
use crate::compile::{Strategy, Target};
use crate::tracer::{Stage, StageBall};
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::{Ball, ValidScene};

/// Least radius of a sphere, in units in the last place: a hit is then off by less than a tenth of it.
const LEAST_RADIUS: f64 = 16.0;

/// The settings with which a program of `scene` is built.
///
/// # Errors
/// A sphere is too small for the scene's fraction bits.
pub(super) fn target<'a, const C: usize>(
    scene: &ValidScene,
    stage: &Stage<C>,
    points: &'a PathPoints,
    strategy: Strategy,
    options: OracleOptions,
) -> Result<Target<'a>, OracleError> {
    let written = scene.scene();
    let fraction = written.precision.fraction.unwrap_or(DEFAULT_FRACTION);
    let units = (1_u64 << fraction) as f64;
    let balls = stage.geometry().balls.iter().zip(scene.balls());
    let small = |(staged, _): &(&StageBall, &Ball)| staged.radius * units < LEAST_RADIUS;
    if let Some((staged, ball)) = balls.into_iter().find(small) {
        let more = (LEAST_RADIUS / (staged.radius * units)).log2().ceil() as u32;
        return Err(OracleError::SmallSphere {
            primitive: ball.primitive,
            fraction,
            needed: fraction + more,
        });
    }
    Ok(Target {
        fraction,
        strategy,
        points,
        film: [written.film.width, written.film.height],
        pixel: options.pixel,
        faces: faces(stage),
        passes: options.passes,
    })
}
