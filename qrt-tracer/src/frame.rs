//! The frame itself: the paper's `Path Tracing`, stage by stage.

use super::arith::Segment;
use super::ball_ray::{Round, Tangents};
use super::bsdf::{Scattering, SmoothHit, Vertex};
use super::colours::ColouredHit;
use super::lighting::{Leaves, Lighting};
use super::lights::{Departure, LightStage};
use super::ray::{NearestSearch, Ray, Start, point_at};
use super::sky::SkyStage;
use super::smooth::FlatHit;
use super::sun::SunStage;
use super::vector::{self, Vector};
use super::{Arith, Named, Quantity, Stage, TracerPart, Work};

/// The colour of each path, per channel, in radiance.
///
/// *Generate Ray*, and for each depth *Find Intersection*, emission and scattering. It reads sample
/// coordinates and the pixel from `cx`. `nearest` is the stage's own geometry, or a faster search
/// in front of it.
#[inline(always)]
pub fn trace<A: Arith, N: NearestSearch<A>, const C: usize>(
    cx: &mut A,
    stage: &Stage<C>,
    nearest: &N,
) -> [A::Real; C] {
    let zero = cx.real(0.0);
    let mut colour = [zero; C];
    if stage.surface_of.is_empty() && stage.sky.is_none() && stage.sun.is_none() {
        return colour;
    }
    cx.enter(TracerPart::GenerateRay(0));
    let mut ray = stage.primary_ray(cx);
    cx.leave();
    let mut alive = cx.truth(true);
    let mut throughput: Option<[A::Real; C]> = None;
    // The departure of the ray, if lamps were sampled at its start and the emission that it meets
    // is weighted.
    let mut departure: Option<(&LightStage<C>, Departure<A>)> = None;
    for depth in 0..stage.depths() {
        let named = |quantity| Named { depth, quantity };
        cx.named(named(Quantity::Origin), &ray.origin);
        cx.named(named(Quantity::Direction), &ray.direction);
        if let Some(throughput) = throughput {
            cx.named(named(Quantity::Throughput), &throughput);
        }
        let scatter = stage.scatters.get(depth);
        // If lamps were sampled, the emission that a ray meets may not count.
        let counts = match depth.checked_sub(1) {
            None => stage.direct,
            Some(before) => {
                let lights = stage.scatters[before].lights.as_ref();
                lights.is_none_or(LightStage::rays_count)
            }
        };
        cx.enter(TracerPart::FindIntersection(depth));
        let hit = if scatter.is_some() || stage.every_hit {
            nearest.nearest(cx, &ray, alive)
        } else {
            nearest.emitter(cx, &ray, alive)
        };
        cx.leave();
        let goes = alive;
        alive = cx.and(alive, hit.found);
        cx.traced(
            depth,
            Segment {
                origin: ray.origin,
                direction: ray.direction,
                goes,
                found: alive,
                distance: hit.distance,
                face: hit.face,
                front: hit.front,
            },
        );
        let sun = stage.sun.as_ref();
        let sun = sun.filter(|sun| if depth == 0 { sun.is_seen() } else { counts });
        if stage.sky.is_some() || sun.is_some() {
            let missed = math!(cx, goes && !hit.found);
            if cx.any(missed) {
                cx.enter(TracerPart::Sky(depth));
                let mut seen = background(
                    cx,
                    (stage.sky.as_ref(), sun),
                    &ray.direction,
                    departure.as_ref(),
                );
                if let Some(throughput) = throughput {
                    seen = vector::mul(cx, &throughput, &seen);
                }
                let none = [zero; C];
                let seen = vector::select(cx, missed, &seen, &none);
                colour = vector::add(cx, &colour, &seen);
                cx.leave();
            }
        }
        cx.named_truth(named(Quantity::Found), alive);
        cx.named(named(Quantity::Distance), &[hit.distance]);
        cx.named_index(named(Quantity::Face), hit.face);
        if !cx.any(alive) {
            break;
        }
        let surface = cx.entry(&stage.surface_of, hit.face);
        let mut vertex = Vertex::<A, C> {
            arriving: ray.direction,
            tangent: [zero; 3],
            bitangent: [zero; 3],
            normal: [zero; 3],
            cos_theta: zero,
            smooth: None,
            front: alive,
            surface,
            tint: surface,
            painted: None,
            point: None,
            alive,
        };
        let emits = if counts {
            stage.emitters.members(cx, &vertex)
        } else {
            None
        };
        if emits.is_none() && scatter.is_none() {
            break;
        }
        vertex.normal = cx.rows(stage.normals(), hit.face);
        cx.enter(TracerPart::Side(depth));
        let round = stage.round(cx, &ray, hit.distance, hit.face);
        if let Some(round) = &round {
            vertex.normal = vector::select(cx, round.is, &round.normal, &vertex.normal);
        }
        vertex.cos_theta = math!(cx, dot(ray.direction, vertex.normal));
        vertex.front = match hit.front {
            Some(front) => front,
            None => math!(cx, vertex.cos_theta < 0.0),
        };
        cx.leave();
        if let Some(emits) = emits {
            cx.enter(TracerPart::Shade(depth));
            let share = departure.as_ref().map(|(lights, departure)| {
                let (face, distance) = (hit.face, hit.distance);
                let share = lights.emission(cx, departure, face, distance, vertex.cos_theta);
                (share, lights.gain())
            });
            let seen = stage.emitters.shade(cx, &vertex, emits, throughput, share);
            colour = vector::add(cx, &colour, &seen);
            cx.leave();
        }
        let Some(scatter) = scatter else {
            break;
        };
        if stage.black > 0 {
            alive = math!(cx, alive && !cx.below(surface, stage.black));
        }
        if !cx.any(alive) {
            break;
        }
        vertex.alive = alive;
        if let Some(smooth) = &stage.smooth {
            cx.enter(TracerPart::Normal(depth));
            let point = match &round {
                Some(round) => round.point,
                None => point_at(cx, &ray, hit.distance),
            };
            let face_normal = vertex.normal;
            let found = cx.apart(FlatHit {
                face: hit.face,
                point,
                arriving: ray.direction,
                front: vertex.front,
                normal: face_normal,
                cos_theta: vertex.cos_theta,
                smooth,
            });
            vertex.normal = found.normal;
            vertex.cos_theta = found.cos_theta;
            let is = found.is;
            vertex.smooth = Some(SmoothHit { is, face_normal });
            cx.leave();
        }
        let mut known = None;
        if let Some(lights) = &scatter.lights {
            cx.enter(TracerPart::SampleLight(depth + 1));
            let frame = frame(cx, stage, hit.face, round.as_ref(), &vertex);
            let leaves = Leaves {
                origin: start(cx, &ray, hit.distance, &frame),
                from: cx.entry(&stage.geometry.plane_of, hit.face),
            };
            vertex.stand(&frame);
            stage.place(cx, &mut vertex, &leaves.origin, (hit.face, &frame));
            cx.leave();
            let light = cx.apart(Lighting {
                lights,
                scatter,
                nearest,
                at: &vertex,
                leaves: &leaves,
                throughput,
            });
            if let Some(light) = light {
                colour = vector::add(cx, &colour, &light);
            }
            if depth + 2 == stage.depths() && !lights.rays_count() && stage.sky.is_none() {
                break;
            }
            known = Some((frame, leaves.from));
        }
        cx.enter(TracerPart::GenerateRay(depth + 1));
        let frame = match known {
            Some((frame, _)) => frame,
            None => frame(cx, stage, hit.face, round.as_ref(), &vertex),
        };
        vertex.stand(&frame);
        let is_placed = known.is_some() || !stage.places_vertices();
        let origin = if cx.recomputes() {
            // The start is a part of its own, after which the previous ray is no longer needed.
            let origin = start(cx, &ray, hit.distance, &frame);
            cx.leave();
            cx.enter(TracerPart::GenerateRay(depth + 1));
            Some(origin)
        } else if is_placed {
            None
        } else {
            Some(start(cx, &ray, hit.distance, &frame))
        };
        if let Some(origin) = origin.as_ref().filter(|_| !is_placed) {
            stage.place(cx, &mut vertex, origin, (hit.face, &frame));
        }
        let at = &vertex;
        let scattered = cx.apart(Scattering { scatter, at });
        if let Some(stays) = vertex.stays(cx, &scattered.direction, scattered.crosses) {
            alive = cx.and(alive, stays);
        }
        let origin = match origin {
            Some(origin) => origin,
            None => start(cx, &ray, hit.distance, &frame),
        };
        let from = match known {
            Some((_, from)) => from,
            None => cx.entry(&stage.geometry.plane_of, hit.face),
        };
        departure = None;
        if let Some(lights) = scatter.lights.as_ref().filter(|lights| lights.rays_count()) {
            departure = Some((lights, lights.departed(cx, surface, scattered.density)));
        }
        ray = Ray {
            origin,
            direction: scattered.direction,
            from,
            t_max: stage.t_max,
            start: Start::Surface,
        };
        throughput = Some(match throughput {
            Some(old) => vector::mul(cx, &old, &scattered.weight),
            None => scattered.weight,
        });
        cx.leave();
    }
    colour
}

/// The light of a direction in which nothing stands, per channel: that of the sky, and that of the sun.
#[inline(always)]
fn background<A: Arith, const C: usize>(
    cx: &mut A,
    (sky, sun): (Option<&SkyStage<C>>, Option<&SunStage<C>>),
    direction: &Vector<A>,
    departure: Option<&(&LightStage<C>, Departure<A>)>,
) -> [A::Real; C] {
    let none = [cx.real(0.0); C];
    let behind = match sky {
        Some(sky) => sky.radiance(cx, direction),
        None => none,
    };
    let Some(sun) = sun else {
        return behind;
    };
    let light = cx.apart(Sunlight {
        sun,
        direction,
        departure,
    });
    vector::add(cx, &behind, &light)
}

/// The light of the sun on rays that meet nothing else, per channel; 0 on those beside it.
struct Sunlight<'a, A: Arith, const C: usize> {
    sun: &'a SunStage<C>,
    direction: &'a Vector<A>,
    departure: Option<&'a (&'a LightStage<C>, Departure<A>)>,
}

impl<A: Arith, const C: usize> Work<A> for Sunlight<'_, A, C> {
    type Output = [A::Real; C];

    #[inline(always)]
    fn run(self, cx: &mut A) -> Self::Output {
        let light = match self.departure {
            Some((lights, departure)) => lights.sunlight(cx, departure, self.sun.radiance()),
            None => self.sun.radiance().map(|radiance| cx.real(radiance)),
        };
        let none = [cx.real(0.0); C];
        let within = self.sun.holds(cx, self.direction);
        vector::select(cx, within, &light, &none)
    }
}

impl<const C: usize> Stage<C> {
    /// True if a surface's colour or value depends on the point that is hit.
    fn places_vertices(&self) -> bool {
        self.checkers.is_some() || self.colours.is_some() || self.reads_point
    }

    /// Sets what depends on the point `origin` at which a path leaves `face`, with this row of
    /// [`StageGeometry::frames`].
    #[inline(always)]
    fn place<A: Arith>(
        &self,
        cx: &mut A,
        vertex: &mut Vertex<A, C>,
        origin: &Vector<A>,
        (face, &[.., gx, gy, gz]): (A::Index, &[A::Real; 9]),
    ) {
        if let Some(checkers) = &self.checkers {
            vertex.tint = checkers.row(cx, origin, face, vertex.surface);
        }
        if let Some(colours) = &self.colours {
            cx.enter(TracerPart::Tint);
            vertex.painted = Some(cx.apart(ColouredHit {
                colours,
                face,
                point: origin,
                centre: [gx, gy, gz],
            }));
            cx.leave();
        }
        vertex.point = self.reads_point.then_some(*origin);
    }
}

/// The row of [`StageGeometry::frames`] of a hit, at a vertex with its final normal. On a sphere or a smooth face
/// the tangents follow from the normal, and the centre of a sphere's hit is the hit itself: the next start.
#[inline(always)]
fn frame<A: Arith, const C: usize>(
    cx: &mut A,
    stage: &Stage<C>,
    face: A::Index,
    round: Option<&Round<A>>,
    vertex: &Vertex<A, C>,
) -> [A::Real; 9] {
    let mut row = cx.rows(&stage.geometry.frames, face);
    let computed = match (round, &vertex.smooth) {
        (None, None) => return row,
        (Some(round), None) => round.is,
        (None, Some(smooth)) => smooth.is,
        (Some(round), Some(smooth)) => cx.or(round.is, smooth.is),
    };
    let normal = &vertex.normal;
    let own = cx.apart(Tangents { normal }).into_iter().flatten();
    for (entry, own) in row.iter_mut().zip(own) {
        *entry = cx.select(computed, own, *entry);
    }
    if let Some(round) = round {
        for (entry, point) in row[6..].iter_mut().zip(round.point) {
            *entry = cx.select(round.is, point, *entry);
        }
    }
    row
}

/// The start of the next ray, on a face with this row of [`StageGeometry::frames`].
#[inline(always)]
pub(super) fn start<A: Arith>(
    cx: &mut A,
    ray: &Ray<A>,
    distance: A::Real,
    &[.., gx, gy, gz]: &[A::Real; 9],
) -> Vector<A> {
    let centre = [gx, gy, gz];
    [
        start_along(cx, ray, distance, &centre, 0),
        start_along(cx, ray, distance, &centre, 1),
        start_along(cx, ray, distance, &centre, 2),
    ]
}

/// The start of the next ray, along one axis: the point of `ray` at `distance`, moved a little
/// towards the `centre` of its face.
#[inline(always)]
fn start_along<A: Arith>(
    cx: &mut A,
    ray: &Ray<A>,
    distance: A::Real,
    centre: &Vector<A>,
    axis: usize,
) -> A::Real {
    cx.enter(TracerPart::Component(axis));
    let point = math!(cx, ray.origin[axis] + ray.direction[axis] * distance);
    let fraction = cx.inward();
    let start = math!(cx, point + (centre[axis] - point) * real(fraction));
    cx.leave();
    start
}
