//! *Find Intersection* for circuits: of the scene's planes, it tests only those that a ray can meet.
//!
//! [`StageGeometry`] computes where the ray crosses every plane, and tests if the crossing is
//! within the edges of every polygon on it. Three observations avoid most of that; the hits are the
//! same.
//!
//! - **Outer planes** have the whole scene and the ray's start on one side. The ray can meet them only
//!   where it leaves the scene, so the first of them that it crosses is the only one that it can meet.
//!   An edge where two outer planes meet needs no test. The other edges are tested once, at the nearest
//!   hit. Nothing on an outer plane stands between two points of the scene, and a ray that leaves one
//!   outwards meets nothing.
//! - **Convex bodies**: a ray meets a body at the last of the planes that it enters, if it enters this
//!   plane before it leaves the first of the planes that it leaves. This needs no points and no edges.
//!   See [`super::convex`].
//! - **Spheres** are compared by where the ray is nearest to their centres, without a root each. See
//!   [`balls`].
//! - **Meshes** of other shapes are tested by their edges, which neighbours share. See [`mesh`].
//! - **Sides**: the sign of the slope towards a plane gives the side on which a ray meets it.
//!
//! The start of a ray decides which planes are outer, and which bodies it may enter. Rays that leave
//! surfaces and rays of the camera have a [`Plan`] each.

mod balls;
mod mesh;
mod plan;
mod planner;

use super::convex::{self, Edges};
use super::crossing::{AxisPermuted, rise, slope};
use super::geometry::{NO_FACE, StageGeometry};
use super::intersect::{constants, meets, within_outline};
use super::polygon::Plane;
use super::ray::{Hit, NearestSearch, Ray, Start};
use super::{Arith, Stage, TracerPart};
use plan::{Facet, Met, MetBound, Outer, Plan, Starts, facets};
use planner::Planner;

/// The greatest thickness of planes in the search for convex bodies, in stage units. Corners from files
/// of single precision are off by this distance.
const THICKNESS: f64 = 1.0 / (1_u64 << 22) as f64;

/// The searches of a scene's rays.
pub(crate) struct Search<'a> {
    geometry: &'a StageGeometry,
    /// The rays of the camera.
    camera: Plan,
    /// The rays that leave surfaces.
    surfaces: Plan,
    /// By face label: true if the normal points along its plane's main axis.
    along: Vec<bool>,
}

impl<const C: usize> Stage<C> {
    /// The search that tests only the planes that a ray can meet, for numbers whose last bit is `ulp` in stage
    /// units. The hits are those of [`StageGeometry`].
    pub fn search<A: Arith>(&self, ulp: f64) -> impl NearestSearch<A> {
        Search::new(self, ulp)
    }
}

impl<'a> Search<'a> {
    /// Creates the searches of a stage's rays, for numbers with this `ulp`.
    pub(crate) fn new<const C: usize>(stage: &'a Stage<C>, ulp: f64) -> Self {
        let geometry = stage.geometry();
        let edges = Edges::new(geometry);
        let planner = Planner {
            geometry,
            edges: &edges,
            eyes: &stage.starts,
            transmits: &stage.transmits,
            parallel: (!stage.camera.perspective).then(|| stage.camera.fixed.into()),
            surface_of: &stage.surface_of,
            sun: stage.sun.as_ref().map(|sun| *sun.cone()),
            ulp,
        };
        let components = convex::components(&edges);
        let bodies = convex::bodies(geometry, &edges, &components, THICKNESS.min(0.25 * ulp));
        let camera = planner.plan(Start::Camera, &bodies, &components);
        let surfaces = planner.plan(Start::Surface, &bodies, &components);
        let polygons = geometry.normals.iter().zip(&geometry.plane_of);
        let along = polygons
            .take(geometry.corners.len())
            .map(|(normal, &plane)| normal[geometry.planes[plane as usize].axis] > 0.0)
            .collect();
        Self {
            geometry,
            camera,
            surfaces,
            along,
        }
    }
}

/// The nearest hit so far.
struct Running<A: Arith> {
    distance: A::Real,
    face: A::Index,
    front: A::Bool,
}

impl<A: Arith> Running<A> {
    fn new(cx: &mut A, t_max: f64) -> Self {
        Self {
            distance: cx.t_max(t_max),
            face: cx.index(NO_FACE),
            front: cx.truth(true),
        }
    }

    fn replace(&mut self, cx: &mut A, when: A::Bool, other: &Self) {
        self.distance = cx.select(when, other.distance, self.distance);
        self.face = cx.select_index(when, other.face, self.face);
        self.front = cx.select_truth(when, other.front, self.front);
    }

    fn hit(self, cx: &mut A, wanted: A::Bool) -> Hit<A> {
        Hit {
            front: Some(self.front),
            ..Hit::new(cx, self.distance, self.face, wanted)
        }
    }
}

/// The approach of a ray to a plane.
struct Approach<A: Arith> {
    /// True if the ray crosses the plane ahead of its start.
    ahead: A::Bool,
    distance: A::Real,
    /// True if it goes against the plane's main axis, relative to the plane.
    falls: A::Bool,
    /// True if it starts above the plane.
    above: A::Bool,
}

impl<A: Arith> Approach<A> {
    fn new(cx: &mut A, plane: &Plane, ray: &Ray<A>) -> Self {
        let ray = AxisPermuted::along(plane.axis, ray);
        let form = constants(cx, plane.form);
        let slope = slope(cx, form, &ray);
        let offset = cx.real(plane.offset);
        let rise = rise(cx, form, offset, &ray);
        let (ahead, distance) = cx.ahead(rise, slope, ray.t_max);
        Self {
            ahead,
            distance,
            falls: math!(cx, slope < 0.0),
            above: math!(cx, rise < 0.0),
        }
    }
}

/// The passage of a ray through a plane that bounds a body.
struct Passage<A: Arith> {
    /// True if the ray starts on the plane.
    starts: A::Bool,
    /// True if it crosses the plane ahead of its start.
    ahead: A::Bool,
    distance: A::Real,
    /// True if it goes towards the side on which the body is.
    inwards: A::Bool,
    /// True if it starts on the other side.
    outside: A::Bool,
}

impl<A: Arith> Passage<A> {
    fn new(cx: &mut A, bound: &MetBound, ray: &Ray<A>) -> Self {
        let towards = Approach::new(cx, &bound.plane, ray);
        let (inwards, outside) = if bound.below {
            (towards.falls, towards.above)
        } else {
            (cx.not(towards.falls), cx.not(towards.above))
        };
        let starts = match bound.starts {
            Starts::None => cx.truth(false),
            Starts::All => cx.truth(true),
            Starts::Leaving => cx.is(ray.from, bound.number as u32),
        };
        Self {
            starts,
            ahead: math!(cx, towards.ahead && !starts),
            distance: towards.distance,
            inwards,
            outside,
        }
    }
}

impl Search<'_> {
    fn plan<A: Arith>(&self, ray: &Ray<A>) -> &Plan {
        match ray.start {
            Start::Camera => &self.camera,
            Start::Surface => &self.surfaces,
        }
    }

    /// Returns whether a ray meets a face's front. If `falls`, the ray falls towards the face's plane,
    /// otherwise it rises.
    fn front<A: Arith>(&self, cx: &mut A, label: u32, falls: A::Bool) -> A::Bool {
        if self.along[label as usize] {
            falls
        } else {
            cx.not(falls)
        }
    }

    /// Updates `nearest` with an outer plane, which is met from within the scene: if the ray falls
    /// towards it, the scene is above. Returns whether the ray leaves the plane outwards.
    fn outer<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        outer: &Outer,
        nearest: &mut Running<A>,
    ) -> A::Bool {
        let side = |k: usize| outer.sides[k].as_ref().map(|side| (side, k == 1));
        let (Some(up), Some(down)) = (side(0).or(side(1)), side(1).or(side(0))) else {
            return cx.truth(false);
        };
        let plane = &self.geometry.planes[up.0.plane];
        cx.enter(TracerPart::Plane(up.0.plane));
        let permuted = AxisPermuted::along(plane.axis, ray);
        let form = constants(cx, plane.form);
        let slope = slope(cx, form, &permuted);
        let falls = math!(cx, slope < 0.0);
        let [a, b] = [down, up].map(|(side, falls)| {
            let falls = cx.truth(falls);
            (
                cx.real(self.geometry.planes[side.plane].offset),
                cx.is(ray.from, side.plane as u32),
                cx.index(side.facet.first()),
                self.front(cx, side.facet.first(), falls),
            )
        });
        let offset = cx.select(falls, a.0, b.0);
        let left = cx.select_truth(falls, a.1, b.1);
        let rise = rise(cx, form, offset, &permuted);
        let (ahead, distance) = cx.ahead(rise, slope, ray.t_max);
        let hit = math!(cx, (ahead && !left) && distance < nearest.distance);
        let here = Running {
            distance,
            face: cx.select_index(falls, a.2, b.2),
            front: cx.select_truth(falls, a.3, b.3),
        };
        nearest.replace(cx, hit, &here);
        let [down, up] = [1, 0].map(|k| {
            let outwards = outer.sides[k].as_ref().is_some_and(|side| side.outwards);
            cx.truth(outwards)
        });
        let outwards = cx.select_truth(falls, down, up);
        cx.leave();
        math!(cx, outwards && left)
    }

    /// Returns whether `ray` meets a body nearer than `limit`, and the hit.
    fn body<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        body: &Met,
        limit: A::Real,
    ) -> (A::Bool, Running<A>) {
        let mut entry = Running::new(cx, ray.t_max);
        entry.distance = cx.real(0.0);
        let mut exit = Running::new(cx, ray.t_max);
        let mut entered = cx.truth(false);
        let mut missed = cx.truth(false);
        let mut exits = Vec::new();
        for bound in &body.bounds {
            if !(bound.entered || bound.left || bound.outwards) {
                continue;
            }
            cx.enter(TracerPart::Plane(bound.number));
            let Passage {
                starts,
                ahead,
                distance,
                inwards,
                outside,
            } = Passage::new(cx, bound, ray);
            let label = bound.facet.as_ref().map_or(NO_FACE, Facet::first);
            let mut here = Running {
                distance,
                face: cx.index(label),
                front: cx.truth(true),
            };
            if bound.outwards {
                missed = math!(cx, missed || starts && !inwards);
            }
            if bound.entered {
                let enters = math!(cx, ahead && inwards);
                // The ray goes from outside to farther outside, or along the plane.
                let turned_away = cx.not(inwards);
                let outside = cx.select_truth(starts, turned_away, outside);
                missed = math!(cx, missed || outside && !enters);
                if bound.facet.is_some() {
                    let falls = cx.truth(bound.below);
                    here.front = self.front(cx, label, falls);
                }
                let later = math!(cx, enters && entry.distance <= here.distance);
                entry.replace(cx, later, &here);
                entered = math!(cx, entered || enters);
            }
            if bound.left {
                let leaves = math!(cx, ahead && !inwards);
                if body.from_inside {
                    if bound.facet.is_some() {
                        let falls = cx.truth(!bound.below);
                        here.front = self.front(cx, label, falls);
                    }
                    let earlier = math!(cx, leaves && here.distance < exit.distance);
                    exit.replace(cx, earlier, &here);
                } else {
                    exits.push((bound, leaves, here.distance));
                }
            }
            cx.leave();
        }
        let mut meets = math!(cx, !missed);
        if body.from_inside {
            // If the ray comes through a side without a face, or from within, it meets the body where it
            // leaves.
            let none = [entry.face, exit.face].map(|face| cx.is(face, NO_FACE));
            let from_outside = math!(cx, entered && !none[0]);
            meets = math!(
                cx,
                (meets && entry.distance < exit.distance) && !(none[0] && none[1])
            );
            exit.replace(cx, from_outside, &entry);
            let none = cx.is(exit.face, NO_FACE);
            meets = math!(cx, (meets && !none) && exit.distance < limit);
            return (meets, exit);
        }
        meets = math!(cx, (meets && entered) && entry.distance < limit);
        for (bound, mut leaves, mut distance) in exits {
            if cx.recomputes() {
                cx.enter(TracerPart::Plane(bound.number));
                let again = Passage::new(cx, bound, ray);
                leaves = math!(cx, again.ahead && !again.inwards);
                distance = again.distance;
            }
            meets = math!(cx, meets && !(leaves && distance <= entry.distance));
            if cx.recomputes() {
                cx.leave();
            }
        }
        (meets, entry)
    }

    /// Updates `nearest` with `planes`, each with its faces, one after the other.
    fn planes<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        planes: &[(usize, Vec<usize>)],
        nearest: &mut Running<A>,
    ) {
        for (number, faces) in planes {
            cx.enter(TracerPart::Plane(*number));
            let plane = &self.geometry.planes[*number];
            let permuted = AxisPermuted::along(plane.axis, ray);
            let crossing = self.geometry.cross(cx, *number, &permuted, ray.from);
            let form = constants(cx, plane.form);
            let slope = slope(cx, form, &permuted);
            let falls = math!(cx, slope < 0.0);
            for &place in faces {
                let face = &self.geometry.faces[place];
                let meets = meets(cx, &crossing, face);
                let hit = math!(cx, meets && crossing.distance < nearest.distance);
                let here = Running {
                    distance: crossing.distance,
                    face: cx.index(face.label),
                    front: self.front(cx, face.label, falls),
                };
                nearest.replace(cx, hit, &here);
            }
            cx.leave();
        }
    }

    /// Distinguishes the faces of a plane, at the point where the ray meets it.
    fn resolve<'f, A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        facets: impl Iterator<Item = &'f Facet>,
        nearest: &mut Running<A>,
    ) {
        let found = nearest.face;
        for facet in facets.filter(|facet| !facet.is_plain()) {
            let point = [1, 2].map(|k| {
                let axis = (facet.axis + k) % 3;
                math!(
                    cx,
                    ray.origin[axis] + ray.direction[axis] * nearest.distance
                )
            });
            let mut face = cx.index(NO_FACE);
            let mut flipped = cx.truth(false);
            let along = |label: u32| self.along[label as usize];
            for (label, outline) in facet.faces.iter().rev() {
                let disc = outline.disc.as_deref();
                let inside = within_outline(cx, &outline.edge_tests, disc, point);
                let label_here = cx.index(*label);
                face = cx.select_index(inside, label_here, face);
                let other = cx.truth(along(*label) != along(facet.first()));
                flipped = cx.select_truth(inside, other, flipped);
            }
            let here = cx.is(found, facet.first());
            nearest.face = cx.select_index(here, face, nearest.face);
            let flipped = math!(cx, here && flipped);
            let back = cx.not(nearest.front);
            nearest.front = cx.select_truth(flipped, back, nearest.front);
        }
    }
}

impl Search<'_> {
    /// The nearest of `hit`, which is on a polygon, and the spheres.
    pub(crate) fn nearer_ball<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        wanted: A::Bool,
        hit: Hit<A>,
    ) -> Hit<A> {
        if self.geometry.balls.is_empty() {
            return hit;
        }
        let mut nearest = Running::new(cx, ray.t_max);
        nearest.distance = cx.select(hit.found, hit.distance, nearest.distance);
        nearest.face = cx.select_index(hit.found, hit.face, nearest.face);
        self.plan(ray).balls.nearest(cx, ray, &mut nearest);
        Hit::new(cx, nearest.distance, nearest.face, wanted)
    }
}

impl<A: Arith> NearestSearch<A> for Search<'_> {
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let plan = self.plan(ray);
        let mut nearest = Running::new(cx, ray.t_max);
        let mut gone = cx.truth(false);
        for outer in &plan.outer {
            let outwards = self.outer(cx, ray, outer, &mut nearest);
            gone = math!(cx, gone || outwards);
        }
        self.planes(cx, ray, &plan.planes, &mut nearest);
        for (number, body) in plan.bodies.iter().enumerate() {
            cx.enter(TracerPart::Body(number));
            let (meets, here) = self.body(cx, ray, body, nearest.distance);
            nearest.replace(cx, meets, &here);
            cx.leave();
        }
        plan.mesh.nearest(cx, ray, &mut nearest);
        plan.balls.nearest(cx, ray, &mut nearest);
        let none = cx.index(NO_FACE);
        nearest.face = cx.select_index(gone, none, nearest.face);
        self.resolve(cx, ray, plan.facets(), &mut nearest);
        nearest.hit(cx, wanted)
    }

    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        if !self.geometry.balls.is_empty() {
            return self.nearest(cx, ray, wanted);
        }
        let plan = self.plan(ray);
        let mut nearest = Running::new(cx, ray.t_max);
        self.planes(cx, ray, &plan.emitting, &mut nearest);
        let mut hit = nearest.hit(cx, wanted);
        let mut hidden = cx.truth(false);
        for (number, body) in plan.bodies_apart() {
            cx.enter(TracerPart::Body(number));
            let (meets, _) = self.body(cx, ray, body, hit.distance);
            hidden = math!(cx, hidden || meets);
            cx.leave();
        }
        hidden = plan.mesh.hides(cx, ray, hit.distance, hidden);
        for (number, places) in &plan.before_lamps {
            let faces = places.iter().map(|&place| &self.geometry.faces[place]);
            let permuted = AxisPermuted::along(self.geometry.planes[*number].axis, ray);
            let (from, lamp) = (ray.from, hit.distance);
            hidden = self
                .geometry
                .hidden_by(cx, *number, faces, &permuted, from, lamp, hidden);
        }
        hit.found = math!(cx, hit.found && !hidden);
        hit
    }

    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, _wanted: A::Bool) -> A::Bool {
        let plan = self.plan(ray);
        // Bodies are met before the ray leaves the scene. Only a ray to the sun does.
        let mut exit = Running::new(cx, ray.t_max);
        exit.distance = cx.real(1.0);
        let mut gone = cx.truth(false);
        for outer in &plan.sunward {
            let outwards = self.outer(cx, ray, outer, &mut exit);
            gone = math!(cx, gone || outwards);
        }
        self.resolve(cx, ray, facets(&plan.sunward), &mut exit);
        let is_free = cx.is(exit.face, NO_FACE);
        let mut hidden = match self.geometry.sun {
            Some(sun) => math!(cx, cx.is(lamp, sun) && !is_free),
            None => cx.truth(false),
        };
        for (number, body) in plan.bodies_apart() {
            cx.enter(TracerPart::Body(number));
            let (meets, _) = self.body(cx, ray, body, exit.distance);
            hidden = math!(cx, hidden || meets);
            cx.leave();
        }
        for (number, places) in &plan.before_lamps {
            let faces = places.iter().map(|&place| &self.geometry.faces[place]);
            let permuted = AxisPermuted::along(self.geometry.planes[*number].axis, ray);
            hidden = self
                .geometry
                .occluded_by(cx, *number, faces, &permuted, ray.from, lamp, hidden);
        }
        hidden = plan.mesh.occluded(cx, ray, hidden);
        hidden = plan.balls.occluded(cx, ray, lamp, hidden);
        math!(cx, hidden && !gone)
    }
}

#[cfg(test)]
mod tests;
