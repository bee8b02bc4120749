//! Large faces, which most rays come near: all lanes try them at once, before any ray walks the tree.

use super::build::{self, Bounds};
use crate::path_machines::lanes::Lanes;
use qrt_tracer::{
    Arith, AxisPermuted, Crossing, DiscTest, EdgeTest, Ray, StageGeometry, between, cross, weighted,
};

/// Largest number of faces that are taken out of the tree.
const MOST: usize = 8;

/// Cost of a walk through the tree for each ray, in trials of a face by all lanes.
const WALK: f64 = 16.0;

/// A face outside the tree.
#[derive(Clone, Debug)]
pub(super) struct LargeFace {
    /// Position of the face in [`StageGeometry::faces`].
    pub(super) rank: u32,
    plane: u32,
    axis: usize,
    form: [f64; 2],
    offset: f64,
    edge_tests: Vec<EdgeTest>,
    disc: Option<DiscTest>,
    /// True if the face may stand between a point of the scene and a point on a lamp, or the sun.
    pub(super) blocks: bool,
}

/// Chooses the large faces among the first `polygons` and returns their numbers in ascending order. Without the large faces,
/// the box around the others is smaller, and the walks that this saves cost more than the large
/// faces.
pub(super) fn choose(boxes: &[Bounds], polygons: usize) -> Vec<u32> {
    let areas = boxes[..polygons].iter().map(|bounds| bounds.area());
    let mut order: Vec<(f64, u32)> = areas.zip(0..).collect();
    let most = MOST.min(order.len());
    let by_area = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    if most < order.len() {
        order.select_nth_unstable_by(most, by_area);
    }
    let others = order.drain(most..).map(|(_, face)| boxes[face as usize]);
    let mut around = build::around(others.chain(boxes[polygons..].iter().copied()));
    order.sort_unstable_by(by_area);
    let mut order: Vec<u32> = order.into_iter().map(|(_, face)| face).collect();
    let mut areas = vec![around.area()];
    for &face in order.iter().rev() {
        around = around.with(boxes[face as usize]);
        areas.push(around.area());
    }
    let cost = |large: usize| WALK * areas[most - large] / around.area() + large as f64;
    let best = (0..=most).min_by(|&a, &b| cost(a).total_cmp(&cost(b)));
    order.truncate(best.unwrap_or(0));
    order.sort_unstable();
    order
}

impl LargeFace {
    /// Creates the large face number `rank`, which is on the plane number `plane`.
    pub(super) fn new(geometry: &StageGeometry, rank: u32, plane: u32) -> Self {
        let on = &geometry.planes[plane as usize];
        // The same condition as in a loop over all faces: see `StageGeometry::occluded`.
        let passed = on.outermost && geometry.sun.is_none()
            || on.emitters.len() == geometry.emitters as usize;
        let mut beside = geometry.faces_of(plane as usize).iter();
        Self {
            rank,
            plane,
            axis: on.axis,
            form: on.form,
            offset: on.offset,
            edge_tests: geometry.faces[rank as usize].edge_tests.clone(),
            disc: geometry.faces[rank as usize].disc.as_deref().copied(),
            blocks: !passed || beside.any(|face| face.covers.is_some()),
        }
    }

    /// Returns whether `ray` meets the face, and the distance.
    #[inline(always)]
    pub(super) fn meet<'i, S: pulp::Simd, const W: usize>(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
    ) -> ([S::m64s; W], [S::f64s; W]) {
        let (o, d) = (&ray.origin, &ray.direction);
        let [first, second] = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        let axis = self.axis % 3;
        let ray_along = AxisPermuted::<Lanes<'i, S, W>> {
            origin: o[axis],
            direction: d[axis],
            origin_across: [o[first], o[second]],
            direction_across: [d[first], d[second]],
            t_max: f64::INFINITY,
        };
        let form = [cx.real(self.form[0]), cx.real(self.form[1])];
        let offset = cx.real(self.offset);
        let Crossing {
            ahead,
            distance,
            point,
        } = cross(cx, form, offset, &ray_along);
        let left = cx.is(ray.from, self.plane);
        let other = cx.not(left);
        let mut meets = cx.and(ahead, other);
        for edge_test in &self.edge_tests {
            let form = [cx.real(edge_test.form[0]), cx.real(edge_test.form[1])];
            let value = weighted(cx, form, point);
            let (low, high) = (cx.real(edge_test.low), cx.real(edge_test.high));
            let inside = between(cx, low, value, high);
            meets = cx.and(meets, inside);
        }
        if let Some(disc) = &self.disc {
            let within = disc.holds(cx, &self.edge_tests, point);
            meets = cx.and(meets, within);
        }
        (meets, distance)
    }
}
