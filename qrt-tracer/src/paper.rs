//! The paper's way to find the nearest intersection: a full record of the intersection with every
//! primitive, and after each one a full record of the nearest so far.

use super::geometry::NO_FACE;
use super::ray::{Hit, NearestSearch, Ray, point_at};
use super::search::Search;
use super::{Arith, Stage, TracerPart};

/// Finds hits with records of every primitive, in place of the geometry. For comparison: the hits
/// are the same.
pub(crate) struct Records<'a, const C: usize> {
    stage: &'a Stage<C>,
    /// The search of spheres, which has no records.
    search: Search<'a>,
}

impl<const C: usize> Stage<C> {
    /// The paper's search, with full records of every primitive, for numbers whose last bit is `ulp` in stage units.
    /// For comparison: the hits are the same.
    pub fn recorded_search<A: Arith>(&self, ulp: f64) -> impl NearestSearch<A> {
        Records::new(self, ulp)
    }
}

impl<'a, const C: usize> Records<'a, C> {
    /// Creates the search of a stage, for numbers with this `ulp`.
    pub(crate) fn new(stage: &'a Stage<C>, ulp: f64) -> Self {
        let search = Search::new(stage, ulp);
        Self { stage, search }
    }
}

/// Distance, point, normal, surface.
type Record<A> = [<A as Arith>::Real; 8];

impl<A: Arith, const C: usize> NearestSearch<A> for Records<'_, C> {
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let stage = self.stage;
        let zero = cx.real(0.0);
        let mut nearest: Record<A> = [zero; 8];
        nearest[0] = cx.t_max(ray.t_max);
        let mut face = cx.index(NO_FACE);
        // In the order of the running nearest: of faces equally far, the first is kept.
        for number in 0..stage.geometry.faces.len() {
            let label = stage.geometry.faces[number].label;
            cx.enter(TracerPart::Primitive(label as usize));
            let (meets, distance) = stage.geometry.meet(cx, number, ray);
            let point = point_at(cx, ray, distance);
            let normal = stage.normal(label as usize);
            let surface = f64::from(stage.surface_of[label as usize]);
            let mut record: Record<A> = [
                distance, point[0], point[1], point[2], zero, zero, zero, zero,
            ];
            for (field, value) in record[4..]
                .iter_mut()
                .zip(normal.into_iter().chain([surface]))
            {
                *field = cx.real(value);
            }
            let hit = math!(cx, meets && distance < nearest[0]);
            for (kept, new) in nearest.iter_mut().zip(record) {
                *kept = cx.select(hit, new, *kept);
                cx.record(new);
                cx.record(*kept);
            }
            let label = cx.index(label);
            face = cx.select_index(hit, label, face);
            cx.leave();
        }
        let hit = Hit::new(cx, nearest[0], face, wanted);
        self.search.nearer_ball(cx, ray, wanted, hit)
    }

    #[inline(always)]
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        self.nearest(cx, ray, wanted)
    }

    #[inline(always)]
    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, wanted: A::Bool) -> A::Bool {
        if self.stage.geometry.balls.is_empty() {
            self.stage.geometry.occluded(cx, ray, lamp, wanted)
        } else {
            self.search.occluded(cx, ray, lamp, wanted)
        }
    }
}
