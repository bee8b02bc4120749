//! The settings with which the programs of a scene are built.

use super::{DEFAULT_FRACTION, OracleError, OracleOptions, faces};
use crate::compile::{Strategy, Target};
use qrt_scene::Material;
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use qrt_tracer::Stage;

/// Least radius of a sphere, or of the curvature of a smooth face, in units in the last place: a hit is then
/// off by less than a tenth of it.
const LEAST_RADIUS: f64 = 16.0;

/// Least edge of a checker's cell, in units in the last place: a hit, which is off by a few units, is
/// then in a wrong cell only near its ends.
const LEAST_CELL: f64 = 16.0;

/// Least width over which a tint changes by 1, in units in the last place: it is then off by less than a tenth of the
/// change across the face.
const LEAST_WIDTH: f64 = 16.0;

/// The settings with which a program of `scene` is built.
///
/// # Errors
/// A sphere, a smooth or coloured face or the cells of a checker are too small for the scene's fraction bits.
pub(super) fn target<'a, const C: usize>(
    scene: &ValidScene,
    stage: &Stage<C>,
    points: &'a PathPoints,
    strategy: Strategy,
    options: OracleOptions,
) -> Result<Target<'a>, OracleError> {
    let written = scene.scene();
    let fraction = written.precision.fraction.unwrap_or(DEFAULT_FRACTION);
    let mut balls = stage.geometry().balls.iter().zip(scene.balls());
    let small = balls.find_map(|(staged, ball)| {
        Some((
            ball.primitive,
            needed(staged.radius, LEAST_RADIUS, fraction)?,
        ))
    });
    if let Some((primitive, needed)) = small {
        return Err(OracleError::SmallSphere {
            primitive,
            fraction,
            needed,
        });
    }
    if let Some((face, radius)) = stage.least_smooth_radius()
        && let Some(needed) = needed(radius, LEAST_RADIUS, fraction)
    {
        return Err(OracleError::ThinSmoothFace {
            primitive: scene.primitive_of(face),
            fraction,
            needed,
        });
    }
    if let Some((face, width)) = stage.least_tint_width()
        && let Some(needed) = needed(width, LEAST_WIDTH, fraction)
    {
        return Err(OracleError::ThinColouredFace {
            primitive: scene.primitive_of(face),
            fraction,
            needed,
        });
    }
    if let Some(error) = small_cell(scene, stage, fraction) {
        return Err(error);
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

/// The number of fraction bits that a `size` in stage units needs to have the `least` number of units in the last
/// place; `None` if `fraction` bits are enough.
fn needed(size: f64, least: f64, fraction: u32) -> Option<u32> {
    let units = size * (1_u64 << fraction) as f64;
    let more = || (least / units).log2().ceil() as u32;
    (units.is_nan() || units < least).then(|| fraction.saturating_add(more()))
}

/// The error of the smallest cells of a checker, if they are too small.
fn small_cell<const C: usize>(
    scene: &ValidScene,
    stage: &Stage<C>,
    fraction: u32,
) -> Option<OracleError> {
    let (surface, edge) = stage.smallest_cell()?;
    let needed = needed(edge, LEAST_CELL, fraction)?;
    let (name, material) = scene.scene().materials.get(surface)?;
    let key = match material {
        Material::Lambertian(_) | Material::Emitter(_) => "albedo",
        _ => "reflectance",
    };
    Some(OracleError::SmallCell {
        material: name.clone(),
        kind: material.kind(),
        key,
        fraction,
        needed,
    })
}
