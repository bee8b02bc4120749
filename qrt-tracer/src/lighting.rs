//! The light of lamps that a vertex reflects: the connection of a vertex to a point on a lamp.

use super::bsdf::{Lit, ScatterStage, Vertex};
use super::lights::{LightStage, Towards};
use super::ray::{NearestSearch, Ray, Start};
use super::vector::{self, Vector};
use super::{Arith, TracerPart, Work};

/// The light of a point on a lamp that the paths at a vertex reflect towards the camera, per channel;
/// none if none do.
pub(super) struct Lighting<'a, A: Arith, N, const C: usize> {
    pub(super) lights: &'a LightStage<C>,
    pub(super) scatter: &'a ScatterStage<C>,
    pub(super) nearest: &'a N,
    pub(super) at: &'a Vertex<A, C>,
    pub(super) leaves: &'a Leaves<A>,
    /// The throughput of the paths before the vertex.
    pub(super) throughput: Option<[A::Real; C]>,
}

impl<A: Arith, N: NearestSearch<A>, const C: usize> Work<A> for Lighting<'_, A, N, C> {
    type Output = Option<[A::Real; C]>;

    #[inline(always)]
    fn run(self, cx: &mut A) -> Self::Output {
        let Self {
            lights,
            scatter,
            nearest,
            at,
            leaves,
            throughput,
        } = self;
        cx.enter(TracerPart::SampleLight(lights.depth));
        let origin = &leaves.origin;
        let point = lights.point(cx, origin);
        let [mx, my, mz, height] = cx.rows(&lights.normals, point.lamp);
        let rise = math!(cx, dot(at.normal, point.to));
        let rise = math!(cx, max(select(at.front, rise, -rise), 0.0));
        let mut fall = math!(cx, dot([mx, my, mz], *origin) - height);
        if let Some((is, normal)) = point.normal {
            fall = math!(cx, select(is, -dot(normal, point.to), fall));
        }
        let fall = math!(cx, max(fall, 0.0));
        let lit = cx.entry(&lights.receivers.samples, at.surface);
        let lit = cx.is(lit, 1);
        let both = math!(cx, rise * fall);
        // If `both` is 0, the divisors may be 0 too: coarse numbers soon are.
        let mut wanted = math!(cx, at.alive && lit && 0.0 < both);
        if let Some(stays) = at.stays(cx, &point.to, None) {
            wanted = cx.and(wanted, stays);
        }
        if !cx.any(wanted) {
            cx.leave();
            return None;
        }
        let [area] = cx.rows(&lights.areas, point.lamp);
        let square = lights.square(cx, &point.to);
        let Lit { weight, factor } = scatter.light(
            cx,
            at,
            &Towards {
                to: point.to,
                rise,
                fall,
                both,
                square,
                lamp: point.lamp,
                area,
            },
            lights,
        );
        let weight = match throughput {
            Some(throughput) => vector::mul(cx, &throughput, &weight),
            None => weight,
        };
        let radiance = cx.rows(&lights.radiance, point.lamp);
        let light = vector::mul(cx, &weight, &radiance);
        let light = vector::scale(cx, &light, factor);
        cx.leave();
        cx.enter(TracerPart::Shadow(lights.depth));
        let ray = Ray {
            origin: *origin,
            direction: point.to,
            from: leaves.from,
            t_max: 1.0,
            start: Start::Surface,
        };
        let hidden = nearest.occluded(cx, &ray, point.lamp, wanted);
        cx.leave();
        let shown = math!(cx, wanted && !hidden);
        let none = [cx.real(0.0); C];
        Some(vector::select(cx, shown, &light, &none))
    }
}

/// The start of the rays that leave a vertex: a point, and the plane that it is on.
pub(super) struct Leaves<A: Arith> {
    pub(super) origin: Vector<A>,
    pub(super) from: A::Index,
}
