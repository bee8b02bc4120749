//! Rays, and what is asked of them: the nearest intersection.

use super::Arith;
use super::geometry::NO_FACE;
use super::vector::Vector;

/// A ray of every path, in stage units.
pub struct Ray<A: Arith> {
    /// The point where the ray starts.
    pub origin: Vector<A>,
    /// The direction of the ray; of unit length wherever a material reads angles.
    pub direction: Vector<A>,
    /// The number of the plane that the ray leaves, which it does not meet, or [`super::NO_PLANE`]: an eye
    /// leaves none, and a film only one that it lies on.
    pub from: A::Index,
    /// A bound on the distance of whatever the ray meets, in lengths of its direction.
    pub t_max: f64,
    /// Where it starts, on all paths.
    pub start: Start,
}

/// Where rays start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At the camera.
    Camera,
    /// On a surface.
    Surface,
}

impl<A: Arith> Clone for Ray<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Ray<A> {}

/// The nearest intersection.
pub struct Hit<A: Arith> {
    /// Whether the ray meets any face.
    pub found: A::Bool,
    /// The distance of the hit, in lengths of the ray's direction.
    pub distance: A::Real,
    /// The number of the face that is hit; the first face where none is.
    pub face: A::Index,
    /// Whether the face's front is hit, if the search knows.
    pub front: Option<A::Bool>,
}

impl<A: Arith> Hit<A> {
    /// The hit on `face`, or none where that is [`NO_FACE`] or the path is not `wanted`.
    #[inline(always)]
    pub fn new(cx: &mut A, distance: A::Real, face: A::Index, wanted: A::Bool) -> Self {
        let none = cx.is(face, NO_FACE);
        let first = cx.index(0);
        Self {
            face: cx.select_index(none, first, face),
            found: math!(cx, !none && wanted),
            distance,
            front: None,
        }
    }
}

/// A ray of a path and what it meets: see [`Arith::traced`].
pub struct Segment<A: Arith> {
    /// Where the ray starts, in stage units.
    pub origin: Vector<A>,
    /// Where the ray goes.
    pub direction: Vector<A>,
    /// Whether the path has not ended before the ray.
    pub goes: A::Bool,
    /// Whether it goes on and the ray meets a face.
    pub found: A::Bool,
    /// As [`Hit::distance`].
    pub distance: A::Real,
    /// As [`Hit::face`].
    pub face: A::Index,
    /// As [`Hit::front`].
    pub front: Option<A::Bool>,
}

impl<A: Arith> Clone for Segment<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Segment<A> {}

/// What finds the nearest intersection.
pub trait Nearest<A: Arith> {
    /// The nearest intersection of `ray`, wanted only where `wanted`.
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;

    /// The nearest intersection of `ray` where that is on an emitter: all that matters of a
    /// path's last ray.
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;

    /// Whether anything stands between the start of `ray` and its end, one length of its direction
    /// away on emitting face number `lamp` ([`super::Plane::emitters`]); asked only where `wanted`.
    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, wanted: A::Bool) -> A::Bool;
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub(crate) fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
    vector!(cx, ray.origin + ray.direction * distance)
}
