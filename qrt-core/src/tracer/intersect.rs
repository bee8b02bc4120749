//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::geometry::{Geometry, Linear, NO_PLANE, Slab};
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
    /// The face; anything where there is none.
    pub face: A::Index,
}

impl<A: Arith> Clone for Hit<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Hit<A> {}

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
        // Zero coefficients cost nothing: an axis-aligned wall has no products.
        let (main, next, last) = match self.axis {
            0 => (v[0], v[1], v[2]),
            1 => (v[1], v[2], v[0]),
            _ => (v[2], v[0], v[1]),
        };
        let mut sum = main;
        if self.next != 0.0 {
            let term = cx.scale(next, self.next);
            sum = cx.add(sum, term);
        }
        if self.last != 0.0 {
            let term = cx.scale(last, self.last);
            sum = cx.add(sum, term);
        }
        sum
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
        let above = if self.low > f64::NEG_INFINITY {
            let low = cx.real(self.low);
            Some(cx.less_equal(low, value))
        } else {
            None
        };
        if self.high < f64::INFINITY {
            let high = cx.real(self.high);
            let under = cx.less_equal(value, high);
            above.map_or(under, |above| cx.and(above, under))
        } else {
            above.unwrap_or_else(|| cx.truth(true))
        }
    }
}

/// Where `ray` crosses the plane `form.p = offset`: whether at a distance in `(0, limit)`, and
/// that distance.
#[inline(always)]
pub fn cross_plane<A: Arith>(
    cx: &mut A,
    form: &impl Form<A>,
    offset: A::Real,
    ray: &Ray<A>,
    limit: A::Real,
) -> (A::Bool, A::Real) {
    let slope = form.at(cx, &ray.direction);
    let height = form.at(cx, &ray.origin);
    let rise = cx.sub(offset, height);
    let distance = cx.div(rise, slope);
    let zero = cx.real(0.0);
    let ahead = cx.less(zero, distance);
    let near = cx.less(distance, limit);
    (cx.and(ahead, near), distance)
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub(crate) fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
    let way = vector::scale(cx, &ray.direction, distance);
    vector::add(cx, &ray.origin, &way)
}

/// Does the point of `ray` at `distance` pass every slab?
#[inline(always)]
pub fn within<A: Arith, T: SlabTest<A>>(
    cx: &mut A,
    slabs: &[T],
    ray: &Ray<A>,
    distance: A::Real,
) -> A::Bool {
    let point = point_at(cx, ray, distance);
    let mut inside = None;
    for slab in slabs {
        let holds = slab.holds(cx, &point);
        inside = Some(inside.map_or(holds, |inside| cx.and(inside, holds)));
    }
    inside.unwrap_or_else(|| cx.truth(true))
}

impl<A: Arith> Nearest<A> for Geometry {
    /// All planes in turn, with a running nearest.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Hit {
            found: cx.truth(false),
            distance: cx.real(f64::MAX),
            face: cx.index(0),
        };
        for (number, plane) in self.planes.iter().enumerate() {
            let offset = cx.real(plane.offset);
            let (crosses, distance) = cross_plane(cx, &plane.form, offset, ray, nearest.distance);
            let left = cx.is(ray.from, number as u32);
            let other = cx.not(left);
            let open = cx.and(crosses, other);
            let open = cx.and(open, wanted);
            if !cx.possible(open) {
                continue;
            }
            for face in &self.faces[plane.faces.clone()] {
                let inside = within(cx, &face.slabs, ray, distance);
                let hit = cx.and(open, inside);
                let label = cx.index(face.label);
                nearest.found = cx.or(nearest.found, hit);
                nearest.distance = cx.select(hit, distance, nearest.distance);
                nearest.face = cx.select_index(hit, label, nearest.face);
            }
        }
        nearest
    }
}

/// A ray that leaves no plane.
#[inline(always)]
pub(crate) fn from_nowhere<A: Arith>(cx: &mut A) -> A::Index {
    cx.index(NO_PLANE)
}
