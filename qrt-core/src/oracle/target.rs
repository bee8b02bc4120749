//! The settings with which the programs of a scene are built.

use super::{DEFAULT_FRACTION, faces};
use crate::compile::{Passes, Strategy, Target};
use crate::tracer::Stage;
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;

/// The settings with which a program of `scene` is built.
pub(super) fn target<'a, const C: usize>(
    scene: &ValidScene,
    stage: &Stage<C>,
    points: &'a PathPoints,
    strategy: Strategy,
    passes: Passes,
) -> Target<'a> {
    let written = scene.scene();
    Target {
        fraction: written.precision.fraction.unwrap_or(DEFAULT_FRACTION),
        strategy,
        points,
        film: [written.film.width, written.film.height],
        faces: faces(stage),
        passes,
    }
}
