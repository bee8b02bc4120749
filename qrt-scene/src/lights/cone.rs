//! A lamp that is infinitely far away: a cone of directions with one radiance.
//!
//! Let `a` be the half angle of the cone. Its solid angle is `2 pi (1 - cos a)`, and directions that are uniform
//! in it have heights along the axis that are uniform in `[cos a, 1]` (Archimedes).

use crate::polygons::{unit_across, unit_vector};
use glam::DVec3;
use std::f64::consts::TAU;

/// A cone of directions, with a half angle below 90 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The unit vector from the scene to the centre of the lamp.
    pub axis: DVec3,
    /// Unit vectors across the axis and each other.
    pub across: [DVec3; 2],
    /// The sine of the half angle.
    pub sin: f64,
    /// 1 minus the cosine of the half angle.
    pub cap: f64,
}

impl Cone {
    /// Creates the cone around `direction`, of `angle` degrees from edge to edge; `None` if the direction is zero.
    pub fn new(direction: DVec3, angle: f64) -> Option<Self> {
        let axis = unit_vector(direction)?;
        let first = unit_across(axis);
        let half = 0.5 * angle.to_radians();
        Some(Self {
            axis,
            across: [first, axis.cross(first)],
            sin: libm::sin(half),
            // Exact for small angles, too.
            cap: 2.0 * libm::sin(0.5 * half).powi(2),
        })
    }

    /// The solid angle in steradians.
    pub fn solid_angle(&self) -> f64 {
        TAU * self.cap
    }

    /// The greatest cosine of a direction of the cone and the unit vector `normal`; 0 if all are below 0.
    pub fn greatest_cosine(&self, normal: DVec3) -> f64 {
        let cos = normal.dot(self.axis);
        let half = 1.0 - self.cap;
        if cos >= half {
            return 1.0;
        }
        // The cosine of the angle between the normal and the cone's nearest edge.
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        (cos * half + sin * self.sin).max(0.0)
    }
}
