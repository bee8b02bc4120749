//! Convex polygons in space: which of them overlap on a plane, which enclose a solid, and the normals of
//! their corners.
//!
//! Corners are in units in which the scene is about one unit large. The constants of this module
//! are rounding errors of numbers of that size.

mod apart;
mod normals;
mod overlap;
mod plane;
mod solid;

pub(crate) use normals::{MOST_PAIRS, mean_normals, unit_normal};
pub(crate) use overlap::overlap;
pub use overlap::{Outlines, fill_once};
pub use plane::{Overlap, first_overlap};
pub use solid::{Solid, solids};

use glam::DVec3;
use std::borrow::Borrow;

/// Planes nearer than this to each other (in coefficients and offset) count as one.
pub const SAME_PLANE: f64 = 1.0 / (1_u64 << 42) as f64;

/// Returns the centre of the box around `points`, and the power of two that scales the box's
/// greatest half extent into `[1/2, 1)`. Returns the origin and 1 if all points coincide, or there
/// are none.
pub fn stage_units(points: impl Iterator<Item = DVec3>) -> (DVec3, f64) {
    let (low, high) = bounds(points);
    let extent = (high * 0.5 - low * 0.5).max_element();
    // Without points the extent is negative infinity.
    let has_extent = extent > 0.0;
    if !has_extent {
        return (DVec3::ZERO, 1.0);
    }
    // extent = m 2^e with m in [1/2, 1): 2^-e takes it to [1/2, 1).
    let (_, exponent) = libm::frexp(extent);
    (low * 0.5 + high * 0.5, libm::ldexp(1.0, -exponent))
}

/// Returns the axis of the greatest component of a normal. Of components that only rounding makes
/// unequal it is the first, so that polygons of one plane have one main axis.
pub fn main_axis(normal: DVec3) -> usize {
    let size = normal.abs();
    let least = size.max_element() * (1.0 - 4.0 * SAME_PLANE);
    (0..3).find(|&axis| size[axis] >= least).unwrap_or(2)
}

/// Returns the unit vector along `direction`; `None` if it is zero.
pub(crate) fn unit_vector(direction: DVec3) -> Option<DVec3> {
    // The size is divided out first, so that squares neither overflow nor vanish.
    let size = direction.abs().max_element();
    (size > 0.0).then(|| (direction / size).normalize())
}

/// Returns the unit vector along `direction`, which is not zero: bit for bit that of [`DVec3::normalize`],
/// where squares neither overflow nor vanish.
pub(crate) fn normalized(direction: DVec3) -> DVec3 {
    let size = direction.abs().max_element();
    if (1e-100..1e100).contains(&size) {
        direction.normalize()
    } else {
        unit_vector(direction).unwrap_or(direction)
    }
}

/// Returns a unit vector across the unit vector `along`, parallel to an axis if `along` is.
pub(crate) fn unit_across(along: DVec3) -> DVec3 {
    let away = [DVec3::Y, DVec3::Z, DVec3::X][main_axis(along)];
    (away - along * along.dot(away)).normalize()
}

/// The least and the greatest coordinates of `points`.
pub(crate) fn bounds<P: Borrow<DVec3>>(points: impl Iterator<Item = P>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(*p.borrow()), high.max(*p.borrow()))
    })
}
