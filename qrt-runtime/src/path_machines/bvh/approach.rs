//! The approach of all lanes' rays to the tree: the rays that meet the box around it, and the
//! distances at which they enter it.

use crate::path_machines::lanes::{Lanes, lanes};
use qrt_tracer::{Arith, Ray};

/// Largest number of lanes of a value.
pub(super) const MOST_RAYS: usize = 16;

/// Largest ratio of two components of a direction in box tests. A shorter component is treated as
/// if it had this ratio; on its way through the tree, that moves a ray by less than its slack.
const STEEPEST: f64 = (1_u64 << 40) as f64;

/// Largest factor by which a direction's length may differ from 1 for single precision to be
/// usable.
const LONGEST: f64 = (1_u64 << 40) as f64;

/// Least length of a component of a direction, so that no box test computes 0 times infinity.
const SHORTEST: f64 = 1e-100;

/// Largest error of single precision in the place where a ray meets a box, as a fraction of the
/// coordinates of both: more than a dozen roundings.
const SLACK: f64 = 1.0 / (1_u64 << 20) as f64;

/// Largest rounding error of a point on the way to the tree, as a fraction of the origin's
/// coordinate.
const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

/// Rays, and the distances at which they enter the box around the tree.
pub(super) struct Approach<S: pulp::Simd, const W: usize> {
    /// True if the ray meets the box.
    pub(super) meets: [S::m64s; W],
    /// Distance of the entry, in lengths of the ray's direction.
    pub(super) near: [S::f64s; W],
    inverse: [[S::f64s; W]; 3],
}

impl<S: pulp::Simd, const W: usize> Approach<S, W> {
    /// Computes the approach of the `wanted` rays, up to the distance `limit`, to the box from
    /// `low` to `high`.
    #[inline(always)]
    pub(super) fn new<'i>(
        cx: &mut Lanes<'i, S, W>,
        [low, high]: &[[f64; 3]; 2],
        ray: &Ray<Lanes<'i, S, W>>,
        limit: [S::f64s; W],
        wanted: [S::m64s; W],
    ) -> Self {
        let (zero, one) = (cx.real(0.0), cx.real(1.0));
        let mut inverse = [zero; 3];
        let (mut near, mut far) = (zero, limit);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let (shortest, shortest_back) = (cx.real(SHORTEST), cx.real(-SHORTEST));
            let (length, negative) = (cx.abs(d), cx.less(d, zero));
            let short = cx.less(length, shortest);
            let least = cx.select(negative, shortest_back, shortest);
            let d = cx.select(short, least, d);
            inverse[axis] = cx.div(one, d, f64::INFINITY);
            let (low, high) = (cx.real(low[axis]), cx.real(high[axis]));
            let (low, high) = (cx.sub(low, o), cx.sub(high, o));
            let (low, high) = (cx.mul(low, inverse[axis]), cx.mul(high, inverse[axis]));
            let (enter, leave) = (cx.min(low, high), cx.max(low, high));
            near = cx.max(near, enter);
            far = cx.min(far, leave);
        }
        let inside = cx.less_equal(near, far);
        Self {
            meets: cx.and(wanted, inside),
            near,
            inverse,
        }
    }

    /// Writes the rays to `lines`, for boxes whose coordinates are at most `greatest`. Box tests
    /// measure distances from the point at distance `start`.
    #[inline(always)]
    pub(super) fn make_ready<'i>(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        start: [S::f64s; W],
        greatest: f64,
        lines: &mut Lines,
    ) {
        let zero = cx.real(0.0);
        let [x, y, z] = self.inverse;
        let (x, y, z) = (cx.abs(x), cx.abs(y), cx.abs(z));
        let least = cx.min(x, y);
        let least = cx.min(least, z);
        let (short, long) = (cx.real(1.0 / LONGEST), cx.real(LONGEST));
        let (short, long) = (cx.less(short, least), cx.less(least, long));
        let served = cx.and(short, long);
        let most = cx.scale(least, STEEPEST);
        let least = cx.neg(most);
        let (before, beyond) = (cx.real(f64::NEG_INFINITY), cx.real(f64::INFINITY));
        keep_double(&start, &mut lines.start);
        for axis in 0..3 {
            let way = cx.mul(start, ray.direction[axis]);
            let origin = cx.add(ray.origin[axis], way);
            // The slack covers the rounding of the box tests in single precision, and of the point
            // at `start`.
            let (near, far) = (cx.abs(origin), cx.abs(ray.origin[axis]));
            let greatest = cx.real(greatest);
            let near = cx.add(near, greatest);
            let (slack, rounding) = (cx.scale(near, SLACK), cx.scale(far, ROUNDING));
            let slack = cx.add(slack, rounding);
            let inverse = cx.max(self.inverse[axis], least);
            let inverse = cx.min(inverse, most);
            let (low, high) = (cx.sub(origin, slack), cx.add(origin, slack));
            keep_single(&low, &mut lines.points[0][axis]);
            keep_single(&high, &mut lines.points[1][axis]);
            let (low, high) = (cx.mul(low, inverse), cx.mul(high, inverse));
            let (enter, leave) = (cx.max(low, high), cx.min(low, high));
            let (enter, leave) = (cx.neg(enter), cx.neg(leave));
            // A ray whose direction is too long or too short for single precision meets all boxes.
            let inverse = cx.select(served, inverse, zero);
            let enter = cx.select(served, enter, before);
            let leave = cx.select(served, leave, beyond);
            keep_double(&ray.origin[axis], &mut lines.origin[axis]);
            keep_double(&ray.direction[axis], &mut lines.direction[axis]);
            keep_single(&inverse, &mut lines.inverse[axis]);
            keep_single(&enter, &mut lines.enter[axis]);
            keep_single(&leave, &mut lines.leave[axis]);
        }
        for axis in 0..2 {
            keep_double(&ray.origin[axis], &mut lines.origin[3 + axis]);
            keep_double(&ray.direction[axis], &mut lines.direction[3 + axis]);
        }
        let from = lanes::<_, u64>(&ray.from);
        lines.from[..from.len()].copy_from_slice(from);
    }
}

#[inline(always)]
fn keep_double<V: pulp::bytemuck::Pod>(value: &[V], kept: &mut [f64; MOST_RAYS]) {
    let value = lanes::<_, f64>(value);
    kept[..value.len()].copy_from_slice(value);
}

#[inline(always)]
fn keep_single<V: pulp::bytemuck::Pod>(value: &[V], kept: &mut [f32; MOST_RAYS]) {
    for (kept, &value) in kept.iter_mut().zip(lanes::<_, f64>(value)) {
        *kept = value as f32;
    }
}

/// Rays in the form that walks read, one per lane.
///
/// Box tests use single precision, and measure distances from the point at which the ray comes to
/// the tree. From there, the ray enters the plane of a box no earlier than at the distance
/// `plane inverse + enter`, and leaves it no later than at `plane inverse + leave`. Both offsets include
/// the largest possible sum of rounding errors.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Lines {
    /// Components along x, y, z, x, y, so that three components from any axis on are adjacent.
    pub(super) origin: [[f64; MOST_RAYS]; 5],
    pub(super) direction: [[f64; MOST_RAYS]; 5],
    /// The plane that the ray leaves.
    pub(super) from: [u64; MOST_RAYS],
    /// Distance from which box tests measure, in lengths of the ray's direction.
    pub(super) start: [f64; MOST_RAYS],
    /// Least and greatest coordinates of the point at `start`.
    pub(super) points: [[[f32; MOST_RAYS]; 3]; 2],
    /// Inverse of each component of the direction.
    pub(super) inverse: [[f32; MOST_RAYS]; 3],
    pub(super) enter: [[f32; MOST_RAYS]; 3],
    pub(super) leave: [[f32; MOST_RAYS]; 3],
}

impl Lines {
    /// Converts a distance from the origin of the ray in `lane` to a distance from `start`, or
    /// slightly more.
    #[inline(always)]
    pub(super) fn boxed(&self, lane: usize, distance: f64) -> f32 {
        (distance - self.start[lane % MOST_RAYS]) as f32 * (1.0 + 4.0 * f32::EPSILON)
    }

    /// Returns, by axis, whether the direction of the ray in `lane` is negative.
    #[inline(always)]
    pub(super) fn backwards(&self, lane: usize) -> [bool; 3] {
        let [x, y, z] = &self.inverse;
        let lane = lane % MOST_RAYS;
        [x[lane] < 0.0, y[lane] < 0.0, z[lane] < 0.0]
    }
}
