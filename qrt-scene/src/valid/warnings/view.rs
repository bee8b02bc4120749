//! The camera's view as a convex region. Polygons in it count as seen, even if others hide them.

use crate::scene::{Basis, Camera, Film};
use glam::{DVec2, DVec3};

/// The part of space that primary rays may pass.
pub(super) struct View {
    basis: Basis,
    /// Half the film's width and height: at distance 1, or in scene units.
    half: DVec2,
}

/// Margin of the view around the film, as a fraction of the film. It is larger than rounding errors.
const MARGIN: f64 = 1e-6;

impl View {
    pub(super) fn new(camera: &Camera, film: Film) -> Self {
        let basis = Basis::new(camera);
        let half = basis.half_film(film) * (1.0 + MARGIN);
        Self { basis, half }
    }

    /// True unless the outline lies outside the view, beyond one of its sides.
    pub(super) fn may_see(&self, outline: &[DVec3]) -> bool {
        let seen = outline.iter().map(|corner| self.basis.coordinates(*corner));
        let seen: Vec<DVec3> = seen.collect();
        let size = seen.iter().map(|v| v.abs().max_element());
        let rounding = super::ROUNDING * size.fold(self.basis.eye.abs().max_element(), f64::max);
        let reach = |z: f64, half: f64| {
            if self.basis.perspective {
                z * half
            } else {
                half
            }
        };
        let beyond: [&dyn Fn(&DVec3) -> f64; 5] = [
            &|v| -v.z,
            &|v| v.x - reach(v.z, self.half.x),
            &|v| -v.x - reach(v.z, self.half.x),
            &|v| v.y - reach(v.z, self.half.y),
            &|v| -v.y - reach(v.z, self.half.y),
        ];
        !beyond
            .iter()
            .any(|side| seen.iter().all(|v| side(v) > rounding))
    }

    /// True unless no ray of the camera meets the outline on the side that `normal` points to.
    pub(super) fn may_see_front(&self, outline: &[DVec3], normal: DVec3) -> bool {
        let towards = if self.basis.perspective {
            let size = outline.iter().map(|v| v.abs().max_element());
            let rounding =
                super::ROUNDING * size.fold(self.basis.eye.abs().max_element(), f64::max);
            normal.dot(self.basis.eye - outline[0]) + rounding
        } else {
            super::ROUNDING - normal.dot(self.basis.forward)
        };
        // NaN proves nothing, so the polygon may be seen.
        (towards.is_nan() || towards >= 0.0) && self.may_see(outline)
    }
}
