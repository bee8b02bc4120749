//! Spheres prepared for intersection.

use glam::DVec3;

/// A sphere in stage units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageBall {
    /// The centre.
    pub centre: DVec3,
    /// The radius.
    pub radius: f64,
    /// The number of its face: after those of all polygons.
    pub label: u32,
    /// The number that stands for it where polygons have the number of their plane
    /// ([`super::Ray::from`]): after those of all planes.
    pub number: u32,
    /// The number of the lamp that it is: after those of all emitting polygons. None if it does not
    /// emit.
    pub emitter: Option<u32>,
}

impl StageBall {
    /// The corners of the box around the sphere.
    pub(crate) fn corners(&self) -> [DVec3; 8] {
        let side = |bit: usize| if bit & 1 == 0 { -1.0 } else { 1.0 };
        std::array::from_fn(|k| {
            self.centre + self.radius * DVec3::new(side(k), side(k >> 1), side(k >> 2))
        })
    }

    /// The distance of a point from the sphere; below 0 inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        point.distance(self.centre) - self.radius
    }
}
