//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::geometry::{Face, Geometry, NO_FACE, NO_PLANE, Slab};
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

    /// The nearest intersection of `ray` where that is on an emitter: all that matters of a
    /// path's last ray.
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A>;
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

/// A ray as the planes of one main axis see it: its parts along that axis and across.
struct Turned<A: Arith> {
    origin: A::Real,
    direction: A::Real,
    origin_across: [A::Real; 2],
    direction_across: [A::Real; 2],
    from: A::Index,
}

impl<A: Arith> Turned<A> {
    #[inline(always)]
    fn new<const AXIS: usize>(ray: &Ray<A>) -> Self {
        let across = |v: &Vector<A>| [v[(AXIS + 1) % 3], v[(AXIS + 2) % 3]];
        Self {
            origin: ray.origin[AXIS],
            direction: ray.direction[AXIS],
            origin_across: across(&ray.origin),
            direction_across: across(&ray.direction),
            from: ray.from,
        }
    }
}

impl Geometry {
    /// Where `ray` crosses plane `number`: whether it does, ahead, at which distance and where
    /// across the plane's main axis.
    #[inline(always)]
    fn cross<A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        ray: &Turned<A>,
    ) -> (A::Bool, A::Real, [A::Real; 2]) {
        let plane = &self.planes[number];
        let slope = weighted(cx, plane.form, ray.direction_across);
        let slope = cx.add(ray.direction, slope);
        let height = weighted(cx, plane.form, ray.origin_across);
        let height = cx.add(ray.origin, height);
        let offset = cx.real(plane.offset);
        let rise = cx.sub(offset, height);
        let (ahead, distance) = cross_plane(cx, slope, rise);
        let left = cx.is(ray.from, number as u32);
        let other = cx.not(left);
        let ahead = cx.and(ahead, other);
        let [x, y] = vector::scale(cx, &ray.direction_across, distance);
        let point = [
            cx.add(ray.origin_across[0], x),
            cx.add(ray.origin_across[1], y),
        ];
        (ahead, distance, point)
    }

    /// The faces on planes with main axis `AXIS`, in turn, with a running nearest.
    #[inline(always)]
    fn nearest_along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        nearest: &mut Running<A>,
    ) {
        let ray = Turned::new::<AXIS>(ray);
        for number in self.by_axis[AXIS].clone() {
            let (ahead, distance, point) = self.cross(cx, number, &ray);
            for face in self.faces_of(number) {
                nearest.meet(cx, face, ahead, distance, point);
            }
        }
    }

    /// The emitting faces on planes with main axis `AXIS`.
    #[inline(always)]
    fn emitters_along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        nearest: &mut Running<A>,
    ) {
        let ray = Turned::new::<AXIS>(ray);
        for &number in &self.emitting[AXIS] {
            let (ahead, distance, point) = self.cross(cx, number, &ray);
            for face in self.faces_of(number).iter().filter(|face| face.emits) {
                nearest.meet(cx, face, ahead, distance, point);
            }
        }
    }

    /// Does another face on planes with main axis `AXIS` hide the emitter?
    #[inline(always)]
    fn hidden_along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        emitter: &Running<A>,
        mut hidden: A::Bool,
    ) -> A::Bool {
        let ray = Turned::new::<AXIS>(ray);
        for number in self.by_axis[AXIS].clone() {
            let (ahead, distance, point) = self.cross(cx, number, &ray);
            for face in self.faces_of(number).iter().filter(|face| !face.emits) {
                let inside = within(cx, &face.slabs, point);
                let meets = cx.and(ahead, inside);
                let nearer = if face.hides_emitter {
                    cx.less_equal(distance, emitter.distance)
                } else {
                    cx.less(distance, emitter.distance)
                };
                let hides = cx.and(meets, nearer);
                hidden = cx.or(hidden, hides);
            }
        }
        hidden
    }
}

/// The nearest face so far.
struct Running<A: Arith> {
    distance: A::Real,
    face: A::Index,
}

impl<A: Arith> Running<A> {
    #[inline(always)]
    fn new(cx: &mut A) -> Self {
        Self {
            distance: cx.real(f64::MAX),
            face: cx.index(NO_FACE),
        }
    }

    /// The ray crosses the plane of `face` at `distance` and `point`, if `ahead`.
    #[inline(always)]
    fn meet(
        &mut self,
        cx: &mut A,
        face: &Face,
        ahead: A::Bool,
        distance: A::Real,
        point: [A::Real; 2],
    ) {
        let inside = within(cx, &face.slabs, point);
        let meets = cx.and(ahead, inside);
        let nearer = cx.less(distance, self.distance);
        let hit = cx.and(meets, nearer);
        let label = cx.index(face.label);
        self.distance = cx.select(hit, distance, self.distance);
        self.face = cx.select_index(hit, label, self.face);
    }
}

impl<A: Arith> Nearest<A> for Geometry {
    /// All planes in turn.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx);
        self.nearest_along::<A, 0>(cx, ray, &mut nearest);
        self.nearest_along::<A, 1>(cx, ray, &mut nearest);
        self.nearest_along::<A, 2>(cx, ray, &mut nearest);
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }

    /// The nearest emitter, and then whether anything hides it: no other face needs to be told
    /// apart from its neighbours.
    #[inline(always)]
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx);
        self.emitters_along::<A, 0>(cx, ray, &mut nearest);
        self.emitters_along::<A, 1>(cx, ray, &mut nearest);
        self.emitters_along::<A, 2>(cx, ray, &mut nearest);
        let mut hit = Hit::new(cx, nearest.distance, nearest.face, wanted);
        if !cx.possible(hit.found) {
            return hit;
        }
        let mut hidden = cx.truth(false);
        hidden = self.hidden_along::<A, 0>(cx, ray, &nearest, hidden);
        hidden = self.hidden_along::<A, 1>(cx, ray, &nearest, hidden);
        hidden = self.hidden_along::<A, 2>(cx, ray, &nearest, hidden);
        let shown = cx.not(hidden);
        hit.found = cx.and(hit.found, shown);
        hit
    }
}

/// A ray that leaves no plane.
#[inline(always)]
pub(crate) fn from_nowhere<A: Arith>(cx: &mut A) -> A::Index {
    cx.index(NO_PLANE)
}
