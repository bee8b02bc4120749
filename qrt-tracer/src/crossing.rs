//! The crossing of a ray and a plane.

use super::Arith;
use super::ray::Ray;
use super::vector::Vector;

/// `low <= value <= high`
#[inline(always)]
pub fn between<A: Arith>(cx: &mut A, low: A::Real, value: A::Real, high: A::Real) -> A::Bool {
    math!(cx, low <= value && value <= high)
}

/// `a x + b y`
#[inline(always)]
pub fn weighted<A: Arith>(cx: &mut A, form: [A::Real; 2], at: [A::Real; 2]) -> A::Real {
    math!(cx, at[0] * form[0] + at[1] * form[1])
}

/// An axis-permuted ray: its components along the main axis of a plane, and along the two axes
/// after it.
pub struct AxisPermuted<A: Arith> {
    /// The origin's coordinate along the main axis.
    pub origin: A::Real,
    /// The direction's component along the main axis.
    pub direction: A::Real,
    /// The origin's coordinates along the next axis and the one after it.
    pub origin_across: [A::Real; 2],
    /// The direction's components along the next axis and the one after it.
    pub direction_across: [A::Real; 2],
    /// A bound on the distance of every hit of the ray: see [`Ray::t_max`].
    pub t_max: f64,
}

impl<A: Arith> AxisPermuted<A> {
    /// The axis-permuted `ray` for planes with this main axis.
    #[inline(always)]
    pub(super) fn along(axis: usize, ray: &Ray<A>) -> Self {
        let across = |v: &Vector<A>| [v[(axis + 1) % 3], v[(axis + 2) % 3]];
        Self {
            origin: ray.origin[axis],
            direction: ray.direction[axis],
            origin_across: across(&ray.origin),
            direction_across: across(&ray.direction),
            t_max: ray.t_max,
        }
    }

    /// The axis-permuted `ray` for planes whose main axis is the register `axis`.
    #[inline(always)]
    pub(crate) fn looked_up(cx: &mut A, ray: &Ray<A>, axis: A::Index) -> Self {
        let axis = [cx.is(axis, 0), cx.is(axis, 1)];
        Self {
            origin: beside(cx, axis, &ray.origin, 0),
            direction: beside(cx, axis, &ray.direction, 0),
            origin_across: across(cx, axis, &ray.origin),
            direction_across: across(cx, axis, &ray.direction),
            t_max: ray.t_max,
        }
    }
}

/// The component of `v` that is `after` axes after the main axis, given whether this is x and whether it is y.
#[inline(always)]
fn beside<A: Arith>(cx: &mut A, [x, y]: [A::Bool; 2], v: &Vector<A>, after: usize) -> A::Real {
    let along = [v[after], v[(after + 1) % 3], v[(after + 2) % 3]];
    math!(cx, select(x, along[0], select(y, along[1], along[2])))
}

/// The components of `v` along the two axes after the main one, given whether this is x and whether it is y.
#[inline(always)]
pub(super) fn across<A: Arith>(cx: &mut A, axis: [A::Bool; 2], v: &Vector<A>) -> [A::Real; 2] {
    [beside(cx, axis, v, 1), beside(cx, axis, v, 2)]
}

/// The crossing of a ray and a plane.
pub struct Crossing<A: Arith> {
    /// True if the ray crosses the plane ahead of its origin.
    pub ahead: A::Bool,
    /// The distance of the crossing, in lengths of the ray's direction.
    pub distance: A::Real,
    /// The crossing point's coordinates along the two axes after the plane's main one.
    pub point: [A::Real; 2],
}

/// The rate at which `ray` rises along the main axis of planes of this form, relative to the plane.
#[inline(always)]
pub(super) fn slope<A: Arith>(cx: &mut A, form: [A::Real; 2], ray: &AxisPermuted<A>) -> A::Real {
    let across = weighted(cx, form, ray.direction_across);
    math!(cx, ray.direction + across)
}

/// The height of the plane of this form and offset above the start of `ray`, along the main axis.
#[inline(always)]
pub(super) fn rise<A: Arith>(
    cx: &mut A,
    form: [A::Real; 2],
    offset: A::Real,
    ray: &AxisPermuted<A>,
) -> A::Real {
    let height = weighted(cx, form, ray.origin_across);
    math!(cx, offset - (ray.origin + height))
}

/// The crossing of `ray` and the plane of this form (see [`super::Plane`]) and offset.
#[inline(always)]
pub fn cross<A: Arith>(
    cx: &mut A,
    form: [A::Real; 2],
    offset: A::Real,
    ray: &AxisPermuted<A>,
) -> Crossing<A> {
    let slope = slope(cx, form, ray);
    let rise = rise(cx, form, offset, ray);
    let (ahead, distance) = cx.ahead(rise, slope, ray.t_max);
    let point = vector!(cx, ray.origin_across + ray.direction_across * distance);
    Crossing {
        ahead,
        distance,
        point,
    }
}
