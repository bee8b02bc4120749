//! The intersection of rays and spheres, over numbers of high precision.
//!
//! Let `l` be the vector from the start of a ray to the centre, `d` the direction. The ray is
//! nearest to the centre at `t = l.d / d.d`, and there `l - t d` is the offset from the centre. It
//! meets the sphere if `h^2 = r^2 - |l - t d|^2` is above 0, at `t - h / |d|` and `t + h / |d|`
//! (Haines, Günther & Akenine-Möller, Ray Tracing Gems, chapter 7). Neither loses bits for small or
//! far spheres. A ray that starts on the sphere has the roots 0 and `2 t` exactly, so that none is
//! met at its start.
//!
//! Circuits search spheres in [`super::search::balls`].

use super::ball::StageBall;
use super::ray::Ray;
use super::vector::{self, Vector};
use super::{Arith, Work};

/// A ray with the number that all spheres share.
pub struct BallRay<'a, A: Arith> {
    ray: &'a Ray<A>,
    /// `1 / d.d`
    inverse: A::Real,
}

/// A ray's meeting with a sphere.
struct Meeting<A: Arith> {
    /// True if the ray's line meets the sphere.
    meets: A::Bool,
    near: A::Real,
    far: A::Real,
    /// True if the ray starts on the sphere.
    left: A::Bool,
}

impl<A: Arith> Meeting<A> {
    #[inline(always)]
    fn nearest(&self, cx: &mut A) -> (A::Bool, A::Real) {
        let &Self {
            meets,
            near,
            far,
            left,
        } = self;
        let outside = math!(cx, !left && 0.0 < near);
        let distance = cx.select(outside, near, far);
        (math!(cx, meets && 0.0 < distance), distance)
    }
}

impl<'a, A: Arith> BallRay<'a, A> {
    /// Prepares a ray.
    #[inline(always)]
    pub fn new(cx: &mut A, ray: &'a Ray<A>) -> Self {
        let square = math!(cx, dot(ray.direction, ray.direction));
        Self {
            ray,
            inverse: math!(cx, 1.0 / square),
        }
    }

    #[inline(always)]
    fn meet(&self, cx: &mut A, centre: &Vector<A>, square: A::Real, left: A::Bool) -> Meeting<A> {
        let Ray {
            origin, direction, ..
        } = self.ray;
        let to = vector!(cx, *centre - *origin);
        let middle = math!(cx, dot(to, *direction) * self.inverse);
        let offset = vector!(cx, to - *direction * middle);
        let half = math!(cx, square - dot(offset, offset));
        let half = math!(cx, half * self.inverse);
        let root = math!(cx, sqrt(max(half, 0.0)));
        let far = math!(cx, middle + root);
        Meeting {
            meets: math!(cx, left || 0.0 < half),
            near: math!(cx, middle - root),
            far: math!(cx, select(left, middle + middle, far)),
            left,
        }
    }

    /// The meeting with `ball`.
    #[inline(always)]
    fn meet_ball(&self, cx: &mut A, ball: &StageBall) -> Meeting<A> {
        let centre = vector::constant(cx, ball.centre.to_array());
        let square = cx.real(ball.radius * ball.radius);
        let left = cx.is(self.ray.from, ball.number);
        self.meet(cx, &centre, square, left)
    }

    /// Returns whether the ray meets a sphere, and at which distance. The sphere has the centre
    /// `centre` and the squared radius `square`, and the ray starts on it if `left` holds.
    #[inline(always)]
    pub fn nearest_of(
        &self,
        cx: &mut A,
        centre: &Vector<A>,
        square: A::Real,
        left: A::Bool,
    ) -> (A::Bool, A::Real) {
        let met = self.meet(cx, centre, square, left);
        met.nearest(cx)
    }

    /// Returns whether the ray meets the sphere, and at which distance.
    #[inline(always)]
    pub(crate) fn nearest(&self, cx: &mut A, ball: &StageBall) -> (A::Bool, A::Real) {
        let met = self.meet_ball(cx, ball);
        met.nearest(cx)
    }

    /// Returns whether the ray crosses the sphere before its end, one length of its direction away.
    #[inline(always)]
    pub(crate) fn crosses(&self, cx: &mut A, ball: &StageBall) -> A::Bool {
        let Meeting {
            meets,
            near,
            far,
            left,
        } = self.meet_ball(cx, ball);
        let enters = math!(cx, (!left && 0.0 < near) && near < 1.0);
        let leaves = math!(cx, 0.0 < far && far < 1.0);
        math!(cx, meets && (enters || leaves))
    }
}

/// True where `hidden` is, or where the ray `crosses` the sphere and does not end on it.
#[inline(always)]
pub(super) fn hides<A: Arith>(
    cx: &mut A,
    ball: &StageBall,
    lamp: A::Index,
    crosses: A::Bool,
    hidden: A::Bool,
) -> A::Bool {
    match ball.emitter {
        // The lamp's near side is lit from outside alone, so nothing of the sphere stands before it.
        Some(number) => math!(cx, hidden || crosses && !cx.is(lamp, number)),
        None => math!(cx, hidden || crosses),
    }
}

/// A hit on a sphere or a polygon, in a scene that has spheres.
pub(super) struct Round<A: Arith> {
    /// True if the hit is on a sphere.
    pub(super) is: A::Bool,
    /// The hit.
    pub(super) point: Vector<A>,
    /// The unit normal of the sphere.
    pub(super) normal: Vector<A>,
}

/// Least length of a normal before it is made a unit vector: a hit is that near to its sphere.
const LEAST_NORMAL: f64 = 0.5;

impl<A: Arith> Round<A> {
    /// The hit on `face` at `point`. `balls` is the number of the first sphere's face, and by face the
    /// centre and the inverse of the radius.
    #[inline(always)]
    pub(super) fn new(
        cx: &mut A,
        (first, rows): (u32, &[[f64; 4]]),
        face: A::Index,
        point: Vector<A>,
    ) -> Self {
        let [x, y, z, inverse] = cx.rows(rows, face);
        let offset = vector!(cx, (point - [x, y, z]) * inverse);
        let bound = 1.0 / LEAST_NORMAL;
        let offset = [
            cx.known(offset[0], -bound, bound),
            cx.known(offset[1], -bound, bound),
            cx.known(offset[2], -bound, bound),
        ];
        let polygon = cx.below(face, first);
        Self {
            is: cx.not(polygon),
            point,
            normal: vector::normalize(cx, &offset, bound),
        }
    }
}

/// A tangent and a bitangent of a unit normal (Duff et al., Building an Orthonormal Basis, Revisited,
/// 2017).
pub(super) struct Tangents<'a, A: Arith> {
    pub(super) normal: &'a Vector<A>,
}

impl<A: Arith> Work<A> for Tangents<'_, A> {
    type Output = [Vector<A>; 2];

    #[inline(always)]
    fn run(self, cx: &mut A) -> [Vector<A>; 2] {
        let &[x, y, z] = self.normal;
        let below = math!(cx, z < 0.0);
        let height = cx.abs(z);
        let inverse = math!(cx, div(1.0, 1.0 + height, 1.0));
        let across = math!(cx, x * y * inverse);
        let tangent = [
            math!(cx, known(1.0 - x * x * inverse, -1.0, 1.0)),
            cx.neg(across),
            math!(cx, select(below, x, -x)),
        ];
        let along = math!(cx, 1.0 - y * y * inverse);
        let bitangent = [
            math!(cx, select(below, across, -across)),
            math!(cx, known(select(below, -along, along), -1.0, 1.0)),
            cx.neg(y),
        ];
        [tangent, bitangent]
    }
}
