//! *Find Intersection*: the nearest polygon that a ray meets.
//!
//! A plane's distance is computed once and serves all polygons on it. A ray remembers the plane
//! that it leaves and cannot meet that plane again: two distinct points of a line on a plane put
//! the whole line there. So no epsilon is needed to leave a surface.

use super::ball_ray::{BallRay, hides};
use super::crossing::{AxisPermuted, Crossing, cross, weighted};
use super::geometry::{Face, NO_FACE, StageGeometry};
use super::polygon::{DiscTest, EdgeTest};
use super::ray::{Hit, NearestSearch, Ray};
use super::{Arith, TracerPart};

#[inline(always)]
pub(super) fn constants<A: Arith>(cx: &mut A, [a, b]: [f64; 2]) -> [A::Real; 2] {
    [cx.real(a), cx.real(b)]
}

impl EdgeTest {
    /// The value of the form at `point`.
    #[inline(always)]
    fn value<A: Arith>(&self, cx: &mut A, point: [A::Real; 2]) -> A::Real {
        let form = constants(cx, self.form);
        weighted(cx, form, point)
    }

    #[inline(always)]
    fn holds<A: Arith>(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool {
        let value = self.value(cx, point);
        cx.inside(self.low, value, self.high)
    }
}

/// A disc's test, over numbers of a machine: see [`DiscTest`].
pub struct DiscNumbers<A: Arith> {
    /// As [`DiscTest::centre`].
    pub centre: [A::Real; 2],
    /// As [`DiscTest::scale`].
    pub scale: [A::Real; 2],
    /// As [`DiscTest::square`].
    pub square: A::Real,
    /// The greatest of all scales.
    pub most: f64,
}

impl<A: Arith> DiscNumbers<A> {
    /// True if the point at which both forms have these `values` is within the circle. Arbitrary for a
    /// point outside the square.
    #[inline(always)]
    pub fn hold(&self, cx: &mut A, values: [A::Real; 2]) -> A::Bool {
        // A point may be off by some units in the last place.
        let most = 1.0 + cx.inward() * self.most;
        let [u, v] = [0, 1].map(|k| {
            let away = math!(cx, (values[k] - self.centre[k]) * self.scale[k]);
            cx.known(away, -most, most)
        });
        math!(cx, u * u + v * v <= self.square)
    }
}

impl DiscTest {
    /// True if `point`, which passes the disc's `edge_tests`, is within the circle.
    #[inline(always)]
    pub fn holds<A: Arith>(
        &self,
        cx: &mut A,
        edge_tests: &[EdgeTest],
        point: [A::Real; 2],
    ) -> A::Bool {
        let numbers = DiscNumbers {
            centre: constants(cx, self.centre),
            scale: constants(cx, self.scale),
            square: cx.real(self.square),
            most: self.scale[0].max(self.scale[1]),
        };
        let values = [0, 1].map(|k| edge_tests[k].value(cx, point));
        numbers.hold(cx, values)
    }
}

/// True if `point` passes every half-plane edge test.
#[inline(always)]
pub(super) fn within<A: Arith>(
    cx: &mut A,
    edge_tests: &[EdgeTest],
    point: [A::Real; 2],
) -> A::Bool {
    // The usual cases without a loop: truth values then stay in mask registers.
    match edge_tests {
        [a, b] => {
            math!(cx, a.holds(cx, point) && b.holds(cx, point))
        }
        [a, b, c] => {
            let (a, b, c) = (a.holds(cx, point), b.holds(cx, point), c.holds(cx, point));
            math!(cx, a && b && c)
        }
        [a, b, c, d] => {
            let (a, b) = (a.holds(cx, point), b.holds(cx, point));
            let (c, d) = (c.holds(cx, point), d.holds(cx, point));
            math!(cx, (a && b) && (c && d))
        }
        _ => {
            let mut inside = cx.truth(true);
            for edge_test in edge_tests {
                let holds = edge_test.holds(cx, point);
                inside = cx.and(inside, holds);
            }
            inside
        }
    }
}

/// True if `point` passes every half-plane edge test, and the test of the `disc` if there is one.
#[inline(always)]
pub(super) fn within_outline<A: Arith>(
    cx: &mut A,
    edge_tests: &[EdgeTest],
    disc: Option<&DiscTest>,
    point: [A::Real; 2],
) -> A::Bool {
    let within = within(cx, edge_tests, point);
    let Some(disc) = disc else {
        return within;
    };
    let holds = disc.holds(cx, edge_tests, point);
    cx.and(within, holds)
}

/// The edges of a face, as a machine holds them: the same for all paths, or looked up.
pub(crate) trait Edges<A: Arith> {
    /// True if `point` of the face's plane is within all edges.
    fn hold(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool;
}

impl<A: Arith> Edges<A> for Face {
    #[inline(always)]
    fn hold(&self, cx: &mut A, point: [A::Real; 2]) -> A::Bool {
        within_outline(cx, &self.edge_tests, self.disc.as_deref(), point)
    }
}

/// True if a ray with this crossing of a face's plane meets the face.
#[inline(always)]
pub(crate) fn meets<A: Arith, E: Edges<A> + ?Sized>(
    cx: &mut A,
    crossing: &Crossing<A>,
    edges: &E,
) -> A::Bool {
    let inside = edges.hold(cx, crossing.point);
    cx.and(crossing.ahead, inside)
}

impl StageGeometry {
    /// The crossing of `ray` and plane `number`, unless the ray leaves that plane.
    #[inline(always)]
    pub(super) fn cross<A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        ray: &AxisPermuted<A>,
        from: A::Index,
    ) -> Crossing<A> {
        let plane = &self.planes[number];
        let form = constants(cx, plane.form);
        let offset = cx.real(plane.offset);
        let crossing = cross(cx, form, offset, ray);
        let left = cx.is(from, number as u32);
        Crossing {
            ahead: math!(cx, crossing.ahead && !left),
            ..crossing
        }
    }

    /// Returns whether `ray` meets face number `number`, and at which distance.
    #[inline(always)]
    pub(crate) fn meet<A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        ray: &Ray<A>,
    ) -> (A::Bool, A::Real) {
        let face = &self.faces[number];
        let plane = self.plane_of[face.label as usize] as usize;
        let permuted = AxisPermuted::along(self.planes[plane].axis, ray);
        let crossing = self.cross(cx, plane, &permuted, ray.from);
        (meets(cx, &crossing, face), crossing.distance)
    }

    /// True if `hidden` is, or if one of these faces of plane `number` stands between the start of `ray`
    /// and its end. The end is one length of its direction away, on emitting face number `lamp`.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // The ray is permuted once for many planes.
    pub(super) fn occluded_by<'f, A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        faces: impl Iterator<Item = &'f Face> + Clone,
        ray: &AxisPermuted<A>,
        from: A::Index,
        lamp: A::Index,
        mut hidden: A::Bool,
    ) -> A::Bool {
        let here = self.planes[number].emitters.clone();
        // If the ray ends on this plane, it does not cross the plane before; only another face may cover
        // the lamp there. A ray between points of the scene crosses no outermost plane, but a ray to the sun may.
        let all_here = here.len() == self.emitters as usize;
        let passed = all_here || self.planes[number].outermost && self.sun.is_none();
        if passed && faces.clone().all(|face| face.covers.is_none()) {
            return hidden;
        }
        cx.enter(TracerPart::Plane(number));
        let crossing = self.cross(cx, number, ray, from);
        let ends_here = if here.is_empty() {
            cx.truth(false)
        } else if all_here {
            cx.truth(true)
        } else {
            math!(cx, below(lamp, here.end) && !below(lamp, here.start))
        };
        let before = math!(cx, !ends_here && crossing.distance < 1.0);
        for face in faces {
            let mut hides = before;
            if let Some(earlier) = face.covers {
                let first = here.start + earlier;
                hides = math!(cx, hides || ends_here && !below(lamp, first));
            }
            let meets = meets(cx, &crossing, face);
            hidden = math!(cx, hidden || meets && hides);
        }
        cx.leave();
        hidden
    }

    /// True where `hidden` is, or where one of these faces of plane `number` stands before an emitter at
    /// the distance `emitter`. Faces in the emitter's own plane do not: those that are listed before it,
    /// and hide it, are met in its place ([`StageGeometry::nearest_emitter`]).
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // The ray is permuted once for many planes.
    pub(super) fn hidden_by<'f, A: Arith>(
        &self,
        cx: &mut A,
        number: usize,
        faces: impl Iterator<Item = &'f Face>,
        ray: &AxisPermuted<A>,
        from: A::Index,
        emitter: A::Real,
        mut hidden: A::Bool,
    ) -> A::Bool {
        cx.enter(TracerPart::Plane(number));
        let crossing = self.cross(cx, number, ray, from);
        for face in faces.filter(|face| !face.emits) {
            let meets = meets(cx, &crossing, face);
            hidden = math!(cx, hidden || meets && crossing.distance < emitter);
        }
        cx.leave();
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
    fn new(cx: &mut A, t_max: f64) -> Self {
        Self {
            distance: cx.t_max(t_max),
            face: cx.index(NO_FACE),
        }
    }

    /// Updates the nearest face with these faces of plane `number`.
    #[inline(always)]
    fn meet_all<'f>(
        &mut self,
        cx: &mut A,
        geometry: &StageGeometry,
        number: usize,
        faces: impl Iterator<Item = &'f Face>,
        ray: &AxisPermuted<A>,
        from: A::Index,
    ) {
        cx.enter(TracerPart::Plane(number));
        let crossing = geometry.cross(cx, number, ray, from);
        for face in faces {
            self.meet(cx, face, &crossing);
        }
        cx.leave();
    }

    /// Updates the nearest face with `face`, whose plane the ray crosses.
    #[inline(always)]
    fn meet(&mut self, cx: &mut A, face: &Face, crossing: &Crossing<A>) {
        let meets = meets(cx, crossing, face);
        let hit = math!(cx, meets && crossing.distance < self.distance);
        let label = cx.index(face.label);
        self.distance = cx.select(hit, crossing.distance, self.distance);
        self.face = cx.select_index(hit, label, self.face);
    }
}

impl StageGeometry {
    /// The nearest emitter on the ray, even if faces of other planes hide it.
    ///
    /// Of the faces of one plane, the first in the list is met. Faces before an emitter
    /// ([`Face::hides_emitter`]) therefore take part: if one of them is the nearest, it is the hit, and
    /// emits nothing.
    #[inline(always)]
    pub fn nearest_emitter<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx, ray.t_max);
        for (axis, planes) in self.emitting.iter().enumerate() {
            let permuted = AxisPermuted::along(axis, ray);
            for &number in planes {
                let faces = self
                    .faces_of(number)
                    .iter()
                    .filter(|face| face.is_asked_first());
                nearest.meet_all(cx, self, number, faces, &permuted, ray.from);
            }
        }
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }
}

impl StageGeometry {
    /// The nearest of `hit` and the spheres.
    #[inline(always)]
    pub(crate) fn nearer_ball<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        wanted: A::Bool,
        hit: Hit<A>,
    ) -> Hit<A> {
        if self.balls.is_empty() {
            return hit;
        }
        let balls = BallRay::new(cx, ray);
        let none = cx.t_max(ray.t_max);
        let mut nearest = cx.select(hit.found, hit.distance, none);
        let (mut face, mut found) = (hit.face, hit.found);
        for ball in &self.balls {
            cx.enter(TracerPart::Ball(ball.label as usize));
            let (meets, distance) = balls.nearest(cx, ball);
            let nearer = math!(cx, meets && distance < nearest);
            let label = cx.index(ball.label);
            nearest = cx.select(nearer, distance, nearest);
            face = cx.select_index(nearer, label, face);
            found = math!(cx, found || nearer && wanted);
            cx.leave();
        }
        Hit {
            found,
            distance: nearest,
            face,
            front: None,
        }
    }

    /// True where `hidden` is, or where a sphere stands between the start of `ray` and its end on lamp
    /// number `lamp`, one length of its direction away.
    #[inline(always)]
    pub(crate) fn hidden_by_balls<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        lamp: A::Index,
        mut hidden: A::Bool,
    ) -> A::Bool {
        if self.balls.is_empty() {
            return hidden;
        }
        let balls = BallRay::new(cx, ray);
        for ball in &self.balls {
            cx.enter(TracerPart::Ball(ball.label as usize));
            let crosses = balls.crosses(cx, ball);
            hidden = hides(cx, ball, lamp, crosses, hidden);
            cx.leave();
        }
        hidden
    }
}

impl<A: Arith> NearestSearch<A> for StageGeometry {
    /// Tests all planes in turn.
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let mut nearest = Running::new(cx, ray.t_max);
        for (axis, planes) in self.by_axis.iter().enumerate() {
            let permuted = AxisPermuted::along(axis, ray);
            for number in planes.clone() {
                let faces = self.faces_of(number).iter();
                nearest.meet_all(cx, self, number, faces, &permuted, ray.from);
            }
        }
        let hit = Hit::new(cx, nearest.distance, nearest.face, wanted);
        self.nearer_ball(cx, ray, wanted, hit)
    }

    /// Finds the nearest emitter, and then tests if anything hides it: no other face needs to be
    /// distinguished from its neighbours.
    #[inline(always)]
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        if !self.balls.is_empty() {
            return self.nearest(cx, ray, wanted);
        }
        let mut hit = self.nearest_emitter(cx, ray, wanted);
        if !cx.any(hit.found) {
            return hit;
        }
        let mut hidden = cx.truth(false);
        for (axis, planes) in self.by_axis.iter().enumerate() {
            let permuted = AxisPermuted::along(axis, ray);
            for number in planes.clone() {
                let faces = self.faces_of(number).iter();
                let (from, emitter) = (ray.from, hit.distance);
                hidden = self.hidden_by(cx, number, faces, &permuted, from, emitter, hidden);
            }
        }
        hit.found = math!(cx, hit.found && !hidden);
        hit
    }

    #[inline(always)]
    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, _wanted: A::Bool) -> A::Bool {
        let mut hidden = cx.truth(false);
        for (axis, planes) in self.by_axis.iter().enumerate() {
            let permuted = AxisPermuted::along(axis, ray);
            for number in planes.clone() {
                let faces = self.faces_of(number).iter();
                hidden = self.occluded_by(cx, number, faces, &permuted, ray.from, lamp, hidden);
            }
        }
        self.hidden_by_balls(cx, ray, lamp, hidden)
    }
}
