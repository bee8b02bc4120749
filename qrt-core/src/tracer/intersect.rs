//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::geometry::{Geometry, NO_FACE, NO_PLANE, Slab};
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

/// Where a ray crosses a plane that it approaches by `slope` per length of its direction and from
/// which `rise` parts it: whether ahead, and at which distance.
#[inline(always)]
pub fn cross_plane<A: Arith>(cx: &mut A, slope: A::Real, rise: A::Real) -> (A::Bool, A::Real) {
    let distance = cx.div(rise, slope);
    let zero = cx.real(0.0);
    (cx.less(zero, distance), distance)
}

/// `low <= value <= high`
#[inline(always)]
pub fn between<A: Arith>(cx: &mut A, low: A::Real, value: A::Real, high: A::Real) -> A::Bool {
    let above = cx.less_equal(low, value);
    let under = cx.less_equal(value, high);
    cx.and(above, under)
}

/// `a x + b y`
#[inline(always)]
fn weighted<A: Arith>(cx: &mut A, [a, b]: [f64; 2], [x, y]: [A::Real; 2]) -> A::Real {
    let ax = cx.scale(x, a);
    let by = cx.scale(y, b);
    cx.add(ax, by)
}

impl Slab {
    #[inline(always)]
    fn holds<A: Arith>(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool {
        let value = weighted(cx, self.form, point);
        let (low, high) = (cx.real(self.low), cx.real(self.high));
        between(cx, low, value, high)
    }
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
    let way = vector::scale(cx, &ray.direction, distance);
    vector::add(cx, &ray.origin, &way)
}

/// Does `point` pass every slab?
#[inline(always)]
fn within<A: Arith>(cx: &mut A, slabs: &[Slab], point: [A::Real; 2]) -> A::Bool {
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
        [a, b, c, d] => {
            let (a, b) = (a.holds(cx, point), b.holds(cx, point));
            let (c, d) = (c.holds(cx, point), d.holds(cx, point));
            let (ab, cd) = (cx.and(a, b), cx.and(c, d));
            cx.and(ab, cd)
        }
        _ => {
            let mut inside = cx.truth(true);
            for slab in slabs {
                let holds = slab.holds(cx, point);
                inside = cx.and(inside, holds);
            }
            inside
        }
    }
}

/// The nearest face so far.
struct Running<A: Arith> {
    distance: A::Real,
    face: A::Index,
}

impl Geometry {
    /// The planes whose main axis is `AXIS`, in turn.
    #[inline(always)]
    fn along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        nearest: &mut Running<A>,
    ) {
        let parts = |v: &Vector<A>| (v[AXIS], [v[(AXIS + 1) % 3], v[(AXIS + 2) % 3]]);
        let (start, origin) = parts(&ray.origin);
        let (step, direction) = parts(&ray.direction);
        for number in self.by_axis[AXIS].clone() {
            let plane = &self.planes[number];
            let slope = weighted(cx, plane.form, direction);
            let slope = cx.add(step, slope);
            let height = weighted(cx, plane.form, origin);
            let height = cx.add(start, height);
            let offset = cx.real(plane.offset);
            let rise = cx.sub(offset, height);
            let (ahead, distance) = cross_plane(cx, slope, rise);
            let left = cx.is(ray.from, number as u32);
            let other = cx.not(left);
            let ahead = cx.and(ahead, other);
            let way = direction.map(|d| cx.mul(d, distance));
            let point = [cx.add(origin[0], way[0]), cx.add(origin[1], way[1])];
            for face in &self.faces[plane.faces.clone()] {
                let inside = within(cx, &face.slabs, point);
                let meets = cx.and(ahead, inside);
                let nearer = cx.less(distance, nearest.distance);
                let hit = cx.and(meets, nearer);
                let label = cx.index(face.label);
                nearest.distance = cx.select(hit, distance, nearest.distance);
                nearest.face = cx.select_index(hit, label, nearest.face);
            }
        }
    }
}

impl<A: Arith> Nearest<A> for Geometry {
    /// All planes in turn, with a running nearest.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running {
            distance: cx.real(f64::MAX),
            face: cx.index(NO_FACE),
        };
        self.along::<A, 0>(cx, ray, &mut nearest);
        self.along::<A, 1>(cx, ray, &mut nearest);
        self.along::<A, 2>(cx, ray, &mut nearest);
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }
}

/// A ray that leaves no plane.
#[inline(always)]
pub(crate) fn from_nowhere<A: Arith>(cx: &mut A) -> A::Index {
    cx.index(NO_PLANE)
}
