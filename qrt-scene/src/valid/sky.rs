//! Checks that a sky has one radiance or a gradient, and that it and the sun have a direction.

use crate::scene::{Scene, Sky, finalize};
use glam::DVec3;
use qrt_syntax::{Path, Problems, Sky as Fault};

pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    if let Some(sky) = &scene.sky {
        check_sky(sky, problems);
    }
    let direction = Path::root().key("sun").key("direction");
    let is_zero = scene.sun.is_some_and(|sun| sun.direction == DVec3::ZERO);
    if is_zero && !problems.touches(&direction) {
        problems.add(direction, Fault::NoSunDirection);
    }
}

fn check_sky(sky: &Sky, problems: &mut Problems) {
    let path = Path::root().key("sky");
    if problems.touches(&path) {
        return;
    }
    let written = [sky.radiance, sky.horizon, sky.zenith].map(|part| part.is_some());
    if let Some(problem) = finalize::sky_fault(&path, written) {
        problems.push(problem);
    }
    if sky.up == DVec3::ZERO {
        problems.add(path.key("up"), Fault::NoUp);
    }
}
