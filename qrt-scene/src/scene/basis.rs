//! The camera's place and directions.

use super::{Camera, Film};
use crate::polygons::normalized;
use glam::{DVec2, DVec3};

/// The camera's coordinate system, in scene units.
pub struct Basis {
    /// The camera's position.
    pub eye: DVec3,
    /// Unit vector from the eye to the target.
    pub forward: DVec3,
    /// Unit vector along the film's rows: forward x up.
    pub right: DVec3,
    /// Unit vector along the film's columns, upwards.
    pub up: DVec3,
    /// Half the film's height: at distance 1, or in scene units.
    pub half: f64,
    /// True for a perspective camera, false for an orthographic one.
    pub perspective: bool,
}

impl Basis {
    /// The coordinate system of `camera`.
    pub fn new(camera: &Camera) -> Self {
        let (eye, target, up, half, perspective) = match camera {
            Camera::Perspective(c) => {
                let half = libm::tan(0.5 * c.vfov.to_radians());
                (c.eye, c.target, c.up, half, true)
            }
            Camera::Orthographic(c) => (c.eye, c.target, c.up, 0.5 * c.height, false),
        };
        let forward = normalized(target - eye);
        let right = forward.cross(normalized(up)).normalize();
        Self {
            eye,
            forward,
            right,
            up: right.cross(forward),
            half,
            perspective,
        }
    }

    /// Corners of the film from its centre: at distance 1, or in scene units.
    pub fn corners(&self, film: Film) -> [DVec3; 4] {
        let half = self.half_film(film);
        let (x, y) = (self.right * half.x, self.up * half.y);
        [y - x, y + x, -x - y, x - y]
    }

    /// Half the film's width and height: at distance 1, or in scene units.
    pub(crate) fn half_film(&self, film: Film) -> DVec2 {
        let aspect = f64::from(film.width) / f64::from(film.height);
        DVec2::new(self.half * aspect, self.half)
    }

    /// Returns the coordinates of `point` in the camera's frame: right of the eye, above it, and
    /// before it.
    pub(crate) fn coordinates(&self, point: DVec3) -> DVec3 {
        let v = point - self.eye;
        DVec3::new(v.dot(self.right), v.dot(self.up), v.dot(self.forward))
    }
}
