//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::geometry::{Face, Geometry, NO_FACE, NO_PLANE, Slab};
use super::vector::Vector;
use super::{Arith, Part, vector};

/// A ray.
pub struct Ray<A: Arith> {
    /// Where it starts.
    pub origin: Vector<A>,
    /// Where it goes; of unit length wherever a material asks for angles.
    pub direction: Vector<A>,
    /// The plane it leaves; [`NO_PLANE`] from the camera.
    pub from: A::Index,
    /// A bound on the distance of whatever it meets, in lengths of its direction.
    pub reach: f64,
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

/// `low <= value <= high`
#[inline(always)]
pub fn between<A: Arith>(cx: &mut A, low: A::Real, value: A::Real, high: A::Real) -> A::Bool {
    let above = cx.less_equal(low, value);
    let under = cx.less_equal(value, high);
    cx.and(above, under)
}

/// `a x + b y`
#[inline(always)]
pub fn weighted<A: Arith>(cx: &mut A, form: [A::Real; 2], at: [A::Real; 2]) -> A::Real {
    let ax = cx.mul(at[0], form[0]);
    let by = cx.mul(at[1], form[1]);
    cx.add(ax, by)
}

#[inline(always)]
fn constants<A: Arith>(cx: &mut A, [a, b]: [f64; 2]) -> [A::Real; 2] {
    [cx.real(a), cx.real(b)]
}

impl Slab {
    #[inline(always)]
    fn holds<A: Arith>(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool {
        let form = constants(cx, self.form);
        let value = weighted(cx, form, point);
        cx.inside(self.low, value, self.high)
    }
}

/// The point of `ray` at `distance`.
#[inline(always)]
pub(crate) fn point_at<A: Arith>(cx: &mut A, ray: &Ray<A>, distance: A::Real) -> Vector<A> {
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

/// The edges of a face, as a machine holds them: the same for all paths, or looked up.
pub(crate) trait Edges<A: Arith> {
    /// Is this point of the face's plane within all of them?
    fn hold(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool;
}

impl<A: Arith> Edges<A> for [Slab] {
    #[inline(always)]
    fn hold(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool {
        within(cx, self, point)
    }
}

/// Does a ray that crosses a face's plane so meet the face?
#[inline(always)]
pub(crate) fn meets<A: Arith, E: Edges<A> + ?Sized>(
    cx: &mut A,
    crossing: &Crossing<A>,
    edges: &E,
) -> A::Bool {
    let inside = edges.hold(cx, crossing.point);
    cx.and(crossing.ahead, inside)
}

/// A ray as the planes of one main axis see it: its parts along that axis and across.
pub struct Turned<A: Arith> {
    /// Along the axis.
    pub origin: A::Real,
    /// Along the axis.
    pub direction: A::Real,
    /// Along the next axis and the one after it.
    pub origin_across: [A::Real; 2],
    /// Along the next axis and the one after it.
    pub direction_across: [A::Real; 2],
    /// As [`Ray::reach`].
    pub reach: f64,
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
            reach: ray.reach,
        }
    }

    /// As the planes of `axis` see `ray`, whichever that is.
    #[inline(always)]
    pub(crate) fn looked_up(cx: &mut A, ray: &Ray<A>, axis: A::Index) -> Self {
        let [x, y] = [cx.is(axis, 0), cx.is(axis, 1)];
        let mut turn = |v: &Vector<A>, first: usize| {
            let last = cx.select(y, v[(first + 1) % 3], v[(first + 2) % 3]);
            cx.select(x, v[first], last)
        };
        Self {
            origin: turn(&ray.origin, 0),
            direction: turn(&ray.direction, 0),
            origin_across: [turn(&ray.origin, 1), turn(&ray.origin, 2)],
            direction_across: [turn(&ray.direction, 1), turn(&ray.direction, 2)],
            reach: ray.reach,
        }
    }
}

/// Where a ray crosses a plane.
pub struct Crossing<A: Arith> {
    /// Does it, ahead of its origin?
    pub ahead: A::Bool,
    /// At which distance.
    pub distance: A::Real,
    /// Where, along the two axes after the plane's main one.
    pub point: [A::Real; 2],
}

/// Where `ray` crosses the plane of this form (see [`super::Plane`]) and offset.
#[inline(always)]
pub fn cross<A: Arith>(
    cx: &mut A,
    form: [A::Real; 2],
    offset: A::Real,
    ray: &Turned<A>,
) -> Crossing<A> {
    let slope = weighted(cx, form, ray.direction_across);
    let slope = cx.add(ray.direction, slope);
    let height = weighted(cx, form, ray.origin_across);
    let height = cx.add(ray.origin, height);
    let rise = cx.sub(offset, height);
    let (ahead, distance) = cx.ahead(rise, slope, ray.reach);
    let [x, y] = vector::scale(cx, &ray.direction_across, distance);
    let point = [
        cx.add(ray.origin_across[0], x),
        cx.add(ray.origin_across[1], y),
    ];
    Crossing {
        ahead,
        distance,
        point,
    }
}

impl Geometry {
    /// Where `ray` crosses plane `number`, unless it leaves it.
    #[inline(always)]
    fn cross<A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        ray: &Turned<A>,
        from: A::Index,
    ) -> Crossing<A> {
        let plane = &self.planes[number];
        let form = constants(cx, plane.form);
        let offset = cx.real(plane.offset);
        let crossing = cross(cx, form, offset, ray);
        let left = cx.is(from, number as u32);
        let other = cx.not(left);
        Crossing {
            ahead: cx.and(crossing.ahead, other),
            ..crossing
        }
    }

    /// Whether `ray` meets face number `number`, and at which distance.
    #[inline(always)]
    pub(crate) fn meet<A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        ray: &Ray<A>,
    ) -> (A::Bool, A::Real) {
        let face = &self.faces[number];
        let plane = self.plane_of[face.label as usize] as usize;
        let turned = match self.planes[plane].axis {
            0 => Turned::new::<0>(ray),
            1 => Turned::new::<1>(ray),
            _ => Turned::new::<2>(ray),
        };
        let crossing = self.cross(cx, plane, &turned, ray.from);
        (meets(cx, &crossing, &*face.slabs), crossing.distance)
    }

    /// The faces on planes with main axis `AXIS`, in turn, with a running nearest.
    #[inline(always)]
    fn nearest_along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        nearest: &mut Running<A>,
    ) {
        let (ray, from) = (Turned::new::<AXIS>(ray), ray.from);
        for number in self.by_axis[AXIS].clone() {
            cx.enter(Part::Plane(number));
            let crossing = self.cross(cx, number, &ray, from);
            for face in self.faces_of(number) {
                nearest.meet(cx, face, &crossing);
            }
            cx.leave();
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
        let (ray, from) = (Turned::new::<AXIS>(ray), ray.from);
        for &number in &self.emitting[AXIS] {
            cx.enter(Part::Plane(number));
            let crossing = self.cross(cx, number, &ray, from);
            for face in self.faces_of(number).iter().filter(|face| face.emits) {
                nearest.meet(cx, face, &crossing);
            }
            cx.leave();
        }
    }

    /// Does another face on planes with main axis `AXIS` hide the emitter?
    #[inline(always)]
    fn hidden_along<A: Arith, const AXIS: usize>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        emitter: A::Real,
        mut hidden: A::Bool,
    ) -> A::Bool {
        let (ray, from) = (Turned::new::<AXIS>(ray), ray.from);
        for number in self.by_axis[AXIS].clone() {
            cx.enter(Part::Plane(number));
            let crossing = self.cross(cx, number, &ray, from);
            for face in self.faces_of(number).iter().filter(|face| !face.emits) {
                let meets = meets(cx, &crossing, &*face.slabs);
                let nearer = if face.hides_emitter {
                    cx.less_equal(crossing.distance, emitter)
                } else {
                    cx.less(crossing.distance, emitter)
                };
                let hides = cx.and(meets, nearer);
                hidden = cx.or(hidden, hides);
            }
            cx.leave();
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
    fn new(cx: &mut A, reach: f64) -> Self {
        Self {
            distance: cx.nowhere(reach),
            face: cx.index(NO_FACE),
        }
    }

    /// The ray crosses the plane of `face`.
    #[inline(always)]
    fn meet(&mut self, cx: &mut A, face: &Face, crossing: &Crossing<A>) {
        let meets = meets(cx, crossing, &*face.slabs);
        let nearer = cx.less(crossing.distance, self.distance);
        let hit = cx.and(meets, nearer);
        let label = cx.index(face.label);
        self.distance = cx.select(hit, crossing.distance, self.distance);
        self.face = cx.select_index(hit, label, self.face);
    }
}

impl Geometry {
    /// The nearest emitter on the ray, hidden or not.
    #[inline(always)]
    pub fn nearest_emitter<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx, ray.reach);
        self.emitters_along::<A, 0>(cx, ray, &mut nearest);
        self.emitters_along::<A, 1>(cx, ray, &mut nearest);
        self.emitters_along::<A, 2>(cx, ray, &mut nearest);
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }
}

impl<A: Arith> Nearest<A> for Geometry {
    /// All planes in turn.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx, ray.reach);
        self.nearest_along::<A, 0>(cx, ray, &mut nearest);
        self.nearest_along::<A, 1>(cx, ray, &mut nearest);
        self.nearest_along::<A, 2>(cx, ray, &mut nearest);
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }

    /// The nearest emitter, and then whether anything hides it: no other face needs to be told
    /// apart from its neighbours.
    #[inline(always)]
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut hit = self.nearest_emitter(cx, ray, wanted);
        if !cx.possible(hit.found) {
            return hit;
        }
        let mut hidden = cx.truth(false);
        hidden = self.hidden_along::<A, 0>(cx, ray, hit.distance, hidden);
        hidden = self.hidden_along::<A, 1>(cx, ray, hit.distance, hidden);
        hidden = self.hidden_along::<A, 2>(cx, ray, hit.distance, hidden);
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
