//! Checks that a sky has one radiance or a gradient, and a direction of its zenith.

use crate::scene::{Sky, finalize};
use crate::syntax::{Path, Problems, Sky as Fault};
use glam::DVec3;

pub(super) fn check(sky: Option<&Sky>, problems: &mut Problems) {
    let path = Path::root().key("sky");
    let Some(sky) = sky.filter(|_| !problems.touches(&path)) else {
        return;
    };
    let written = [sky.radiance, sky.horizon, sky.zenith].map(|part| part.is_some());
    if let Some(problem) = finalize::sky_fault(&path, written) {
        problems.push(problem);
    }
    if sky.up == DVec3::ZERO {
        problems.add(path.key("up"), Fault::NoUp);
    }
}
