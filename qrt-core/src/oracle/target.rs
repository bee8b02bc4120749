//! The settings with which the programs of a scene are built.

use super::{DEFAULT_FRACTION, OracleError, OracleOptions, faces};
use crate::compile::{Strategy, Target};
use crate::tracer::{SmoothStage, Stage, StageBall};
use qrt_scene::Material;
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::{Ball, ValidScene};

/// Least radius of a sphere, or of the curvature of a smooth face, in units in the last place: a hit is then
/// off by less than a tenth of it.
const LEAST_RADIUS: f64 = 16.0;

/// Least edge of a checker's cell, in units in the last place: a hit, which is off by a few units, is
/// then in a wrong cell only near its ends.
const LEAST_CELL: f64 = 16.0;

/// The settings with which a program of `scene` is built.
///
/// # Errors
/// A sphere, a smooth face or the cells of a checker are too small for the scene's fraction bits.
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
    if let Some((face, radius)) = stage.smooth.as_ref().and_then(SmoothStage::least_radius)
        && radius * units < LEAST_RADIUS
    {
        let more = (LEAST_RADIUS / (radius * units)).log2().ceil() as u32;
        return Err(OracleError::ThinSmoothFace {
            primitive: scene.primitive_of(face),
            fraction,
            needed: fraction + more,
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

/// The error of the smallest cells of a checker, if they are too small.
fn small_cell<const C: usize>(
    scene: &ValidScene,
    stage: &Stage<C>,
    fraction: u32,
) -> Option<OracleError> {
    let (surface, edge) = stage.smallest_cell()?;
    let edge = edge * (1_u64 << fraction) as f64;
    if edge >= LEAST_CELL {
        return None;
    }
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
        needed: fraction + (LEAST_CELL / edge).log2().ceil() as u32,
    })
}
