//! The rays of all lanes, on their way to the tree: which of them meet the box around it, and where.

use crate::machines::lanes::{Lanes, lanes};
use qrt_core::tracer::{Arith, Ray};

/// Lanes of a value, at most.
pub(super) const MOST_RAYS: usize = 16;

/// How much longer one component of a direction may be than another where boxes are concerned, at
/// most: what is left of a shorter one moves a ray on its way through the tree by less than its
/// slack.
const STEEPEST: f64 = (1_u64 << 40) as f64;

/// Within this factor of 1 are the lengths of directions that single precision can serve.
const LONGEST: f64 = (1_u64 << 40) as f64;

/// What a component of a direction is not shorter than, so that no box's test has 0 times infinity.
const SHORTEST: f64 = 1e-100;

/// By how much single precision may be wrong about where a ray meets a box, as a fraction of the coordinates
/// of both: more than a dozen roundings.
const SLACK: f64 = 1.0 / (1_u64 << 20) as f64;

/// What rounding a point on the way to the tree may move it by, as a fraction of the way.
const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

/// Rays, and where they come to the box around the tree.
pub(super) struct Approach<S: pulp::Simd, const W: usize> {
    /// Whether the ray meets the box.
    pub(super) meets: [S::m64s; W],
    /// At which distance, in lengths of its direction.
    pub(super) near: [S::f64s; W],
    inverse: [[S::f64s; W]; 3],
}

impl<S: pulp::Simd, const W: usize> Approach<S, W> {
    /// Of those `wanted`, up to the distance `limit`, to the box from `low` to `high`.
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

    /// Makes the rays ready for boxes whose coordinates are at most `greatest`; `start` is the distance
    /// from which on.
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
        keep(&start, &mut lines.start);
        for axis in 0..3 {
            let way = cx.mul(start, ray.direction[axis]);
            let origin = cx.add(ray.origin[axis], way);
            // How far the ray may seem to be from there, and what rounding made of the way there.
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
            // A ray of any other length meets all boxes.
            let inverse = cx.select(served, inverse, zero);
            let enter = cx.select(served, enter, before);
            let leave = cx.select(served, leave, beyond);
            keep(&ray.origin[axis], &mut lines.origin[axis]);
            keep(&ray.direction[axis], &mut lines.direction[axis]);
            keep_single(&inverse, &mut lines.inverse[axis]);
            keep_single(&enter, &mut lines.enter[axis]);
            keep_single(&leave, &mut lines.leave[axis]);
        }
        for axis in 0..2 {
            keep(&ray.origin[axis], &mut lines.origin[3 + axis]);
            keep(&ray.direction[axis], &mut lines.direction[3 + axis]);
        }
        let from = lanes::<_, u64>(&ray.from);
        lines.from[..from.len()].copy_from_slice(from);
    }
}

#[inline(always)]
fn keep<V: pulp::bytemuck::Pod>(value: &[V], kept: &mut [f64; MOST_RAYS]) {
    let value = lanes::<_, f64>(value);
    kept[..value.len()].copy_from_slice(value);
}

#[inline(always)]
fn keep_single<V: pulp::bytemuck::Pod>(value: &[V], kept: &mut [f32; MOST_RAYS]) {
    for (kept, &value) in kept.iter_mut().zip(lanes::<_, f64>(value)) {
        *kept = value as f32;
    }
}

/// Rays, one a lane, as walks read them.
///
/// Boxes see them in single precision, and from where they come to the tree: the plane of a box is
/// entered no later than at the distance `plane inverse + enter` from there, and left no earlier than
/// at `plane inverse + leave`. Both hold what rounding may add up to.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Lines {
    /// Along x, y, z, x, y, so that those from any axis on are neighbours.
    pub(super) origin: [[f64; MOST_RAYS]; 5],
    pub(super) direction: [[f64; MOST_RAYS]; 5],
    /// The plane that the ray leaves.
    pub(super) from: [u64; MOST_RAYS],
    /// The distance from which on boxes see it, in lengths of its direction.
    pub(super) start: [f64; MOST_RAYS],
    /// The least and the greatest coordinates of the point from which on boxes see it.
    pub(super) points: [[[f32; MOST_RAYS]; 3]; 2],
    /// Of each component of the direction.
    pub(super) inverse: [[f32; MOST_RAYS]; 3],
    pub(super) enter: [[f32; MOST_RAYS]; 3],
    pub(super) leave: [[f32; MOST_RAYS]; 3],
}

impl Lines {
    /// A distance from the origin of the ray in `lane` as one from where boxes see it, or little more.
    #[inline(always)]
    pub(super) fn boxed(&self, lane: usize, distance: f64) -> f32 {
        (distance - self.start[lane % MOST_RAYS]) as f32 * (1.0 + 4.0 * f32::EPSILON)
    }

    /// By axis: whether the direction of the ray in `lane` is negative.
    #[inline(always)]
    pub(super) fn backwards(&self, lane: usize) -> [bool; 3] {
        let [x, y, z] = &self.inverse;
        let lane = lane % MOST_RAYS;
        [x[lane] < 0.0, y[lane] < 0.0, z[lane] < 0.0]
    }
}
