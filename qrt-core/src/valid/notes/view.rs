//! Which polygons lie within the camera's view, whatever hides them.

use crate::scene::{Camera, Film};
use glam::{DVec2, DVec3};

/// The part of space that primary rays may pass.
pub(super) struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half the film's width and height: at distance 1, or in scene units.
    half: DVec2,
    is_perspective: bool,
}

/// How much wider than the film the view is taken to be, as a fraction of it: above rounding.
const MARGIN: f64 = 1e-6;

impl View {
    pub(super) fn new(camera: &Camera, film: Film) -> Self {
        let (eye, target, up, half, is_perspective) = match camera {
            Camera::Perspective(c) => {
                let half = libm::tan(0.5 * c.vfov.to_radians());
                (c.eye, c.target, c.up, half, true)
            }
            Camera::Orthographic(c) => (c.eye, c.target, c.up, 0.5 * c.height, false),
        };
        let forward = (target - eye).normalize();
        let right = forward.cross(up.normalize()).normalize();
        let aspect = f64::from(film.width) / f64::from(film.height);
        Self {
            eye,
            right,
            up: right.cross(forward),
            forward,
            half: DVec2::new(half * aspect, half) * (1.0 + MARGIN),
            is_perspective,
        }
    }

    /// True unless the outline lies outside the view, beyond one of its sides.
    pub(super) fn may_see(&self, outline: &[DVec3]) -> bool {
        let seen = |v: &DVec3| {
            let v = *v - self.eye;
            DVec3::new(v.dot(self.right), v.dot(self.up), v.dot(self.forward))
        };
        let seen: Vec<DVec3> = outline.iter().map(seen).collect();
        let size = seen.iter().map(|v| v.abs().max_element());
        let rounding = super::ROUNDING * size.fold(self.eye.abs().max_element(), f64::max);
        let reach = |z: f64, half: f64| if self.is_perspective { z * half } else { half };
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
        let towards = if self.is_perspective {
            let size = outline.iter().map(|v| v.abs().max_element());
            let rounding = super::ROUNDING * size.fold(self.eye.abs().max_element(), f64::max);
            normal.dot(self.eye - outline[0]) + rounding
        } else {
            super::ROUNDING - normal.dot(self.forward)
        };
        // Not a number, if anything, proves nothing.
        (towards.is_nan() || towards >= 0.0) && self.may_see(outline)
    }
}
