//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::geometry::{Geometry, Linear, NO_FACE, NO_PLANE, Slab};
use super::vector::Vector;
use super::{Arith, vector};

/// A ray.
pub struct Ray<A: Arith> {
    /// Where it starts.
    pub origin: Vector<A>,
    /// Where it goes; of unit length wherever a material asks for angles.
    pub direction: Vector<A>,
    /// The plane it leaves; [`NO_PLANE`] from the camera.
    pub from: A::Index,
}

impl<A: Arith> Clone for Ray<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Ray<A> {}

/// The nearest intersection.
pub struct Hit<A: Arith> {
    /// Is there one?
    pub found: A::Bool,
    /// Distance, in lengths of the ray's direction.
    pub distance: A::Real,
    /// The face; the first where there is none.
    pub face: A::Index,
}

impl<A: Arith> Clone for Hit<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Hit<A> {}

impl<A: Arith> Hit<A> {
    /// The hit on `face`, or none where that is [`NO_FACE`] or the path is not `wanted`.
    #[inline(always)]
    pub fn new(cx: &mut A, distance: A::Real, face: A::Index, wanted: A::Bool) -> Self {
        let none = cx.is(face, NO_FACE);
        let found = cx.not(none);
        let zero = cx.index(0);
        let face = cx.select_index(none, zero, face);
        Self {
            found: cx.and(found, wanted),
            distance,
            face,
        }
    }
}

/// What finds the nearest intersection.
pub trait Nearest<A: Arith> {
    /// The nearest intersection of `ray`, wanted only where `wanted`.
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;
}

/// A linear form on vectors.
pub trait Form<A: Arith> {
    /// Its value at `v`.
    fn at(&self, cx: &mut A, v: &Vector<A>) -> A::Real;
}

impl<A: Arith> Form<A> for Linear {
    #[inline(always)]
    fn at(&self, cx: &mut A, v: &Vector<A>) -> A::Real {
        let x = cx.scale(v[0], self.0[0]);
        let y = cx.scale(v[1], self.0[1]);
        let z = cx.scale(v[2], self.0[2]);
        let xy = cx.add(x, y);
        cx.add(xy, z)
    }
}

/// A test that a point of a plane lies on the inner side of one or two parallel edges.
pub trait SlabTest<A: Arith> {
    /// Does `point` pass?
    fn holds(&self, cx: &mut A, point: &Vector<A>) -> A::Bool;
}

impl<A: Arith> SlabTest<A> for Slab {
    #[inline(always)]
    fn holds(&self, cx: &mut A, point: &Vector<A>) -> A::Bool {
        let value = self.form.at(cx, point);
        let (low, high) = (cx.real(self.low), cx.real(self.high));
        let above = cx.less_equal(low, value);
        let under = cx.less_equal(value, high);
        cx.and(above, under)
    }
}

/// Where `ray` crosses the plane `form.p = offset`: whether ahead, and at which distance.
#[inline(always)]
pub fn cross_plane<A: Arith>(
    cx: &mut A,
    form: &impl Form<A>,
    offset: A::Real,
    ray: &Ray<A>,
) -> (A::Bool, A::Real) {
    let slope = form.at(cx, &ray.direction);
    let height = form.at(cx, &ray.origin);
    let rise = cx.sub(offset, height);
    let distance = cx.div(rise, slope);
    let zero = cx.real(0.0);
    (cx.less(zero, distance), distance)
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
    let way = vector::scale(cx, &ray.direction, distance);
    vector::add(cx, &ray.origin, &way)
}

/// Does `point` pass every slab?
#[inline(always)]
pub fn within<A: Arith, T: SlabTest<A>>(cx: &mut A, slabs: &[T], point: &Vector<A>) -> A::Bool {
    // The usual cases without a loop: truth values then stay in mask registers.
    match slabs {
        [a, b] => {
            let (a, b) = (a.holds(cx, point), b.holds(cx, point));
            cx.and(a, b)
        }
        [a, b, c] => {
            let (a, b, c) = (a.holds(cx, point), b.holds(cx, point), c.holds(cx, point));
            let ab = cx.and(a, b);
            cx.and(ab, c)
        }
        [first, rest @ ..] => {
            let mut inside = first.holds(cx, point);
            for slab in rest {
                let holds = slab.holds(cx, point);
                inside = cx.and(inside, holds);
            }
            inside
        }
        [] => cx.truth(true),
    }
}

impl<A: Arith> Nearest<A> for Geometry {
    /// All planes in turn, with a running nearest.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = cx.real(f64::MAX);
        let mut label = cx.index(NO_FACE);
        for (number, plane) in self.planes.iter().enumerate() {
            let offset = cx.real(plane.offset);
            let (ahead, distance) = cross_plane(cx, &plane.form, offset, ray);
            let left = cx.is(ray.from, number as u32);
            let other = cx.not(left);
            let ahead = cx.and(ahead, other);
            let point = point_at(cx, ray, distance);
            for face in &self.faces[plane.faces.clone()] {
                let inside = within(cx, &face.slabs, &point);
                let meets = cx.and(ahead, inside);
                let nearer = cx.less(distance, nearest);
                let hit = cx.and(meets, nearer);
                let new = cx.index(face.label);
                nearest = cx.select(hit, distance, nearest);
                label = cx.select_index(hit, new, label);
            }
        }
        Hit::new(cx, nearest, label, wanted)
    }
}

/// A ray that leaves no plane.
#[inline(always)]
pub(crate) fn from_nowhere<A: Arith>(cx: &mut A) -> A::Index {
    cx.index(NO_PLANE)
}
