//! Rays and their nearest intersections.

use super::Arith;
use super::geometry::NO_FACE;
use super::vector::Vector;

/// A ray of every path, in stage units.
pub struct Ray<A: Arith> {
    /// The point where the ray starts.
    pub origin: Vector<A>,
    /// The direction of the ray; of unit length wherever a material reads angles.
    pub direction: Vector<A>,
    /// The number of the plane that the ray leaves and does not meet, or [`super::NO_PLANE`]. A ray from
    /// an eye leaves none; a ray from a film leaves only a plane that the film lies on.
    pub from: A::Index,
    /// A bound on the distance of every hit of the ray, in lengths of its direction.
    pub t_max: f64,
    /// The kind of its start, the same on all paths.
    pub start: Start,
}

/// The kind of a ray's start.
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
    /// True if the ray meets any face.
    pub found: A::Bool,
    /// The distance of the hit, in lengths of the ray's direction.
    pub distance: A::Real,
    /// The number of the face that is hit; the first face if none is hit.
    pub face: A::Index,
    /// True if the face's front is hit; none if the search does not determine this.
    pub front: Option<A::Bool>,
}

impl<A: Arith> Hit<A> {
    /// The hit on `face`; no hit if `face` is [`NO_FACE`] or the path is not `wanted`.
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

/// A search for the nearest intersection.
pub trait NearestSearch<A: Arith> {
    /// The nearest intersection of `ray`, needed only where `wanted` holds.
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;

    /// The nearest intersection of `ray` if it is on an emitter. Only that matters for a path's last ray.
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;

    /// True if anything stands between the start of `ray` and its end. The end is one length of its
    /// direction away, on emitting face number `lamp` ([`super::Plane::emitters`]), or beyond the scene if
    /// `lamp` is the sun ([`super::StageGeometry::sun`]). Needed only where `wanted` holds.
    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, wanted: A::Bool) -> A::Bool;
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub(crate) fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
    vector!(cx, ray.origin + ray.direction * distance)
}
