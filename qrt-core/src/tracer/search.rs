//! *Find Intersection* as circuits have it: of the scene's planes, only what a ray can meet.
//!
//! [`Geometry`] asks every plane where the ray crosses it, and every polygon on it whether the crossing
//! is within its edges. Three observations spare most of that; the hits are the same.
//!
//! - **Outer planes** have the whole scene and the ray's start on one side. The ray can meet them only
//!   where it leaves the scene, so the first of them that it crosses is the only one that it can meet.
//!   An edge where two outer planes meet needs no test. The others are tested once, where the nearest
//!   hit is. Nothing on an outer plane stands between two points of the scene, and a ray that leaves one
//!   outwards meets nothing.
//! - **Convex bodies** are met where the ray enters the last of the planes that it enters, if that is
//!   before it leaves the first that it leaves: no points, no edges. See [`super::convex`].
//! - **Sides**: the sign of the slope towards a plane tells on which side a ray meets it.
//!
//! Where a ray starts decides what is outer, and what it may enter: rays that leave surfaces and rays of
//! the camera are searched for by a [`Plan`] each.

use super::convex::{self, Body, Bound, Edges, covered, height};
use super::crossing::{AxisPermuted, rise, slope};
use super::geometry::{EdgeTest, Geometry, NO_FACE, Plane, SAME_PLANE};
use super::intersect::{constants, meets, within};
use super::polygon::edge_test;
use super::ray::{Hit, Nearest, Ray, Start};
use super::{Arith, Part, Stage};
use glam::DVec3;

/// How thick planes are at most, in stage units, where convex bodies are looked for: corners from
/// files of single precision are that far off.
const THICKNESS: f64 = 1.0 / (1_u64 << 22) as f64;

/// More pairs of an edge and an outer plane than this aren't compared: all edges are tested.
const MOST_COMPARED: usize = 1 << 24;

/// The searches of a scene's rays.
pub(crate) struct Search<'a> {
    geometry: &'a Geometry,
    /// The rays of the camera.
    camera: Plan,
    /// The rays that leave surfaces.
    surfaces: Plan,
    /// By face label: whether the normal is along its plane's main axis.
    along: Vec<bool>,
}

/// What is asked about a ray, by where it starts.
#[derive(Debug, Default, PartialEq)]
struct Plan {
    outer: Vec<Outer>,
    /// Planes that are asked as [`Geometry`] asks them, and the places of their faces.
    planes: Vec<(usize, Vec<usize>)>,
    bodies: Vec<Met>,
    /// Planes with emitting faces, and the places of these.
    emitting: Vec<(usize, Vec<usize>)>,
    /// What else may stand before a lamp, as [`Geometry`] asks it: planes, and the places of their
    /// faces.
    before_lamps: Vec<(usize, Vec<usize>)>,
}

/// An outer plane, or two that face each other.
#[derive(Debug, PartialEq)]
struct Outer {
    /// The one that the ray meets where the slope towards it is above zero, the scene being below it;
    /// and the one that it meets where the slope is below zero.
    sides: [Option<OuterSide>; 2],
}

#[derive(Debug, PartialEq)]
struct OuterSide {
    plane: usize,
    facet: Facet,
    /// Whether rays may leave its faces outwards.
    outwards: bool,
}

/// The faces of one plane, of which the first that passes its tests is met. Where the last has no
/// tests, no point that is asked about is beside all of them.
#[derive(Debug, PartialEq)]
struct Facet {
    axis: usize,
    faces: Vec<(u32, Vec<EdgeTest>)>,
}

/// A convex body, and how rays may meet it.
#[derive(Debug, PartialEq)]
struct Met {
    /// Whether rays may start inside, or come to be there.
    from_inside: bool,
    /// Whether a face emits, or may cover one of its plane that does.
    at_lamps: bool,
    bounds: Vec<MetBound>,
}

#[derive(Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools)] // Each is a fact of its own.
struct MetBound {
    number: usize,
    plane: Plane,
    below: bool,
    facet: Option<Facet>,
    /// Whether rays may start outside.
    entered: bool,
    /// Whether the outer planes do not tell already where rays leave.
    left: bool,
    /// Which rays start on the plane.
    starts: Starts,
    /// Whether a ray may start on the plane, leave it outwards and yet come before other planes of the
    /// body, where none starts outside.
    outwards: bool,
}

/// Which rays start on a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Starts {
    None,
    All,
    /// Those that leave the faces on it.
    Leaving,
}

impl Plan {
    /// The bodies at which there are no lamps.
    fn bodies_apart(&self) -> impl Iterator<Item = (usize, &Met)> {
        let bodies = self.bodies.iter().enumerate();
        bodies.filter(|(_, body)| !body.at_lamps)
    }
}

impl Facet {
    /// What stands for its faces until the nearest hit is known.
    fn first(&self) -> u32 {
        self.faces[0].0
    }

    /// Whether that is all there is to know.
    fn is_plain(&self) -> bool {
        self.faces[0].1.is_empty()
    }

    /// Faces in the order in which they hide each other, each with the edges that need tests. What comes
    /// after a face without tests is never met.
    fn new(axis: usize, faces: impl Iterator<Item = (u32, Vec<EdgeTest>)>) -> Self {
        let mut facet = Self {
            axis,
            faces: Vec::new(),
        };
        for face in faces {
            let plain = face.1.is_empty();
            facet.faces.push(face);
            if plain {
                break;
            }
        }
        facet
    }
}

impl<'a> Search<'a> {
    /// The searches of a stage's rays, in numbers of this precision.
    pub(crate) fn new<const C: usize>(stage: &'a Stage<C>, ulp: f64) -> Self {
        let geometry = stage.geometry();
        let edges = Edges::new(geometry);
        let planner = Planner {
            geometry,
            edges: &edges,
            eyes: &stage.starts,
            transmits: &stage.transmits,
            surface_of: &stage.surface_of,
            ulp,
        };
        let bodies = convex::bodies(geometry, &edges, THICKNESS.min(0.25 * ulp));
        let camera = planner.plan(Start::Camera, &bodies);
        let surfaces = planner.plan(Start::Surface, &bodies);
        let frames = geometry.frames.iter().zip(&geometry.plane_of);
        let along = frames
            .map(|(frame, &plane)| frame.normal[geometry.planes[plane as usize].axis] > 0.0)
            .collect();
        Self {
            geometry,
            camera,
            surfaces,
            along,
        }
    }
}

struct Planner<'a> {
    geometry: &'a Geometry,
    edges: &'a Edges,
    /// Where the camera's rays start, or the corners of the area that they start from.
    eyes: &'a [DVec3],
    /// By face label: whether rays may go on beyond the face.
    transmits: &'a [bool],
    /// By face label.
    surface_of: &'a [u32],
    /// An eye that is as near to a plane as this may be on either side, or on the plane.
    ulp: f64,
}

impl Planner<'_> {
    fn label(&self, place: usize) -> u32 {
        self.geometry.faces[place].label
    }

    fn outline(&self, place: usize) -> &[DVec3] {
        &self.geometry.corners[self.label(place) as usize]
    }

    /// All points from which rays start, or the corners of the polygons that they start from.
    fn starts(&self, start: Start) -> Box<dyn Iterator<Item = DVec3> + '_> {
        match start {
            Start::Camera => Box::new(self.eyes.iter().copied()),
            Start::Surface => Box::new(self.geometry.corners.iter().flatten().copied()),
        }
    }

    /// Whether some rays start on the side of a plane where `outside` is above zero.
    fn start_beyond(&self, start: Start, outside: impl Fn(DVec3) -> f64) -> bool {
        let margin = match start {
            Start::Camera => self.ulp,
            Start::Surface => SAME_PLANE,
        };
        self.starts(start).any(|point| outside(point) > margin)
    }

    /// Whether rays may leave the faces on plane `number` to the side where `outside` is above zero, on
    /// which the scene has nothing: to a viewer there, or through the faces.
    fn leave_outwards(&self, number: usize, outside: impl Fn(DVec3) -> f64) -> bool {
        let plane = self.geometry.planes.get(number);
        let mut faces = plane.into_iter().flat_map(|plane| plane.faces.clone());
        faces.any(|place| self.transmits[self.label(place) as usize])
            || self.eyes.iter().any(|&eye| outside(eye) > 0.0)
    }

    fn plan(&self, start: Start, bodies: &[Body]) -> Plan {
        let mut outer_sides = self.outer_sides(start);
        let mut rest: Vec<bool> = vec![true; self.geometry.faces.len()];
        let mut met = Vec::new();
        for body in bodies {
            let from_inside = self.may_be_inside(start, body);
            if self.is_blunt(body, from_inside) {
                continue;
            }
            let entered = |bound: &Bound| self.start_beyond(start, |p| bound.outside(p));
            let entered: Vec<bool> = body.bounds.iter().map(entered).collect();
            // The walls of a room are outer planes, and better off as these.
            let is_outer =
                |bound: &Bound| outer_sides.get(bound.number).is_some_and(Option::is_some);
            let walls = |bound: &Bound| is_outer(bound) || bound.faces.is_empty();
            if from_inside && body.bounds.iter().all(walls) {
                continue;
            }
            let hidden = |(bound, entered): (&Bound, &bool)| {
                (from_inside || *entered)
                    && !bound.faces.is_empty()
                    && covered(self.geometry, bound.number, &bound.faces)
            };
            if body.bounds.iter().zip(&entered).any(hidden) {
                continue;
            }
            body.faces().for_each(|place| rest[place] = false);
            met.push((from_inside, body, entered));
        }
        // Planes that have no face left are not asked.
        for (number, side) in outer_sides.iter_mut().enumerate() {
            let mut faces = self.geometry.planes[number].faces.clone();
            if !faces.any(|place| rest[place]) {
                *side = None;
            }
        }
        let outer = self.outer(&outer_sides, &rest);
        let planes = self.planes_with(|place| rest[place]).into_iter();
        let planes = planes.filter(|(number, _)| outer_sides[*number].is_none());
        let at_lamps = |place: usize| {
            let face = &self.geometry.faces[place];
            face.emits || face.hides_emitter || face.covers.is_some()
        };
        let mut before = rest.clone();
        for (_, body, _) in met.iter().filter(|(_, body, _)| body.faces().any(at_lamps)) {
            body.faces().for_each(|place| before[place] = true);
        }
        let before_lamps = self.planes_with(|place| before[place]).into_iter();
        let before_lamps = before_lamps.filter(|(number, faces)| {
            outer_sides[*number].is_none() || faces.iter().copied().any(at_lamps)
        });
        let bodies = met.iter().map(|(from_inside, body, entered)| Met {
            from_inside: *from_inside,
            at_lamps: body.faces().any(at_lamps),
            bounds: body
                .bounds
                .iter()
                .zip(entered)
                .map(|(bound, &entered)| {
                    self.bound(start, bound, entered, *from_inside, &outer_sides)
                })
                .collect(),
        });
        Plan {
            outer,
            planes: planes.collect(),
            bodies: bodies.collect(),
            emitting: self.planes_with(|place| self.geometry.faces[place].emits),
            before_lamps: before_lamps.collect(),
        }
    }

    /// The planes that have faces which are `wanted` (by place), with these.
    fn planes_with(&self, wanted: impl Fn(usize) -> bool) -> Vec<(usize, Vec<usize>)> {
        let planes = self.geometry.planes.iter().enumerate();
        let planes = planes.map(|(number, plane)| {
            let faces = plane.faces.clone().filter(|&place| wanted(place));
            (number, faces.collect::<Vec<usize>>())
        });
        planes.filter(|(_, faces)| !faces.is_empty()).collect()
    }

    /// By plane: whether the scene and all starts are below it (`Some(true)`) or above it
    /// (`Some(false)`); none for planes that are not outer.
    fn outer_sides(&self, start: Start) -> Vec<Option<bool>> {
        let side = |plane: &Plane| {
            if !plane.outermost {
                return None;
            }
            let corners = self.geometry.corners.iter().flatten();
            let far = corners
                .map(|&corner| height(plane, corner))
                .max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
            let below = far < 0.0;
            let inside = |eye: &DVec3| {
                let height = height(plane, *eye);
                (if below { height } else { -height }) < -self.ulp
            };
            // Rays of surfaces start within the scene.
            (start == Start::Surface || self.eyes.iter().all(inside)).then_some(below)
        };
        let mut sides: Vec<Option<bool>> = self.geometry.planes.iter().map(side).collect();
        // The first that is crossed must be told from the others, or be like them.
        let numbers: Vec<usize> = (0..sides.len()).filter(|&n| sides[n].is_some()).collect();
        if numbers.len().saturating_mul(numbers.len()) <= MOST_COMPARED {
            for &number in &numbers {
                let plane = &self.geometry.planes[number];
                let blurred = |&&other: &&usize| {
                    let faces = self.geometry.planes[other].faces.clone();
                    other != number
                        && self.surface(plane.faces.clone()) != self.surface(faces.clone())
                        && self.lie_on(plane, faces)
                };
                if let Some(&other) = numbers.iter().find(blurred) {
                    (sides[number], sides[other]) = (None, None);
                }
            }
        }
        sides
    }

    /// The surface of the first of these faces (by place).
    fn surface(&self, mut faces: impl Iterator<Item = usize>) -> Option<u32> {
        let label = faces.next().map(|place| self.label(place));
        label.map(|label| self.surface_of[label as usize])
    }

    /// Whether these faces (by place) are so near to a plane that circuits cannot tell them from it.
    fn lie_on(&self, plane: &Plane, faces: impl Iterator<Item = usize>) -> bool {
        let mut corners = faces.flat_map(|place| self.outline(place));
        corners.all(|&corner| height(plane, corner).abs() <= 4.0 * self.ulp)
    }

    fn outer(&self, sides: &[Option<bool>], rest: &[bool]) -> Vec<Outer> {
        let numbers: Vec<usize> = (0..sides.len()).filter(|&n| sides[n].is_some()).collect();
        let few = numbers.len().saturating_mul(4 * numbers.len()) <= MOST_COMPARED;
        let mut outer: Vec<Outer> = Vec::new();
        for &number in &numbers {
            let plane = &self.geometry.planes[number];
            let others = numbers.iter().filter(|&&other| few && other != number);
            let others: Vec<&Plane> = others.map(|&other| &self.geometry.planes[other]).collect();
            let faces = plane.faces.clone().filter(|&place| rest[place]);
            let faces: Vec<usize> = faces.collect();
            let implied = |edge: [u32; 2]| {
                let [a, b] = self.edges.ends(edge);
                let on = |plane: &&Plane, point| height(plane, point).abs() <= SAME_PLANE;
                others.iter().any(|plane| on(plane, a) && on(plane, b))
            };
            let above = sides[number] == Some(false);
            let outside = |point| {
                let height = height(plane, point);
                if above { -height } else { height }
            };
            let side = Some(OuterSide {
                plane: number,
                facet: self.facet(plane.axis, &faces, implied),
                outwards: self.leave_outwards(number, outside),
            });
            let place = usize::from(above);
            let opposite = outer.iter_mut().find(|other| {
                let facing = other.sides[1 - place].as_ref();
                other.sides[place].is_none()
                    && facing.is_some_and(|facing| {
                        let facing = &self.geometry.planes[facing.plane];
                        facing.axis == plane.axis && facing.form == plane.form
                    })
            });
            if let Some(opposite) = opposite {
                opposite.sides[place] = side;
            } else {
                let mut sides = [None, None];
                sides[place] = side;
                outer.push(Outer { sides });
            }
        }
        outer
    }

    /// Whether two faces of the edge's plane meet there, one on each side.
    fn meet(&self, edge: [u32; 2], plane: u32) -> bool {
        let on_plane =
            |place: &&usize| self.geometry.plane_of[self.label(**place) as usize] == plane;
        let mut here = self.edges.faces_at(edge).iter().filter(on_plane);
        match [here.next(), here.next(), here.next()] {
            [Some(&a), Some(&b), None] => !self.edges.fold(self.geometry, edge, [a, b]),
            _ => false,
        }
    }

    /// Faces of one plane (by place), with tests of those of their edges that are not `implied`.
    fn facet(&self, axis: usize, faces: &[usize], implied: impl Fn([u32; 2]) -> bool) -> Facet {
        let tested = |&place: &usize| -> Vec<[u32; 2]> {
            let edges = self.edges.of(place);
            edges.filter(|&edge| !implied(edge)).collect()
        };
        let all: Vec<Vec<[u32; 2]>> = faces.iter().map(tested).collect();
        // Where all edges but those at which two of these faces meet are implied, one of the faces is met
        // wherever the plane is.
        let plane = faces.first().map_or(0, |&place| {
            self.geometry.plane_of[self.label(place) as usize]
        });
        let whole = all.iter().flatten().all(|&edge| self.meet(edge, plane));
        let last = faces.len().wrapping_sub(1);
        let tests = faces.iter().zip(&all).enumerate();
        let tests = tests.map(|(k, (&place, edges))| {
            let label = self.label(place);
            let centre = self.geometry.frames[label as usize].centre;
            let edges = edges.iter().filter(|_| !(whole && k == last));
            let tolerance = self.geometry.tolerance;
            let tests =
                edges.map(|&edge| edge_test(self.edges.ends(edge), axis, centre, tolerance));
            (label, tests.collect())
        });
        Facet::new(axis, tests)
    }

    fn bound(
        &self,
        start: Start,
        bound: &Bound,
        entered: bool,
        from_inside: bool,
        outer: &[Option<bool>],
    ) -> MetBound {
        let reached = entered || from_inside;
        let faces = if reached { &*bound.faces } else { &[] };
        let plane = &bound.plane;
        let facet = (!faces.is_empty()).then(|| {
            // All edges but those at which two of the faces meet are the body's.
            let number = bound.number as u32;
            self.facet(plane.axis, faces, |edge| !self.meet(edge, number))
        });
        let near = |eye: &DVec3| bound.outside(*eye).abs() <= self.ulp;
        let starts = match start {
            Start::Camera if self.eyes.iter().all(near) => Starts::All,
            Start::Surface if bound.number < self.geometry.planes.len() => Starts::Leaving,
            _ => Starts::None,
        };
        let outwards = match starts {
            Starts::None => false,
            Starts::All => true,
            Starts::Leaving => {
                let all = self.geometry.planes[bound.number].faces.len();
                !entered
                    && (from_inside || all > bound.faces.len())
                    && self.leave_outwards(bound.number, |point| bound.outside(point))
            }
        };
        MetBound {
            number: bound.number,
            plane: plane.clone(),
            below: bound.below,
            facet,
            entered,
            left: from_inside || !outer.get(bound.number).is_some_and(Option::is_some),
            starts,
            outwards,
        }
    }

    /// Whether planes of the body cannot be told apart at a face, and should be: where their surfaces
    /// differ, or rays come from inside.
    fn is_blunt(&self, body: &Body, from_inside: bool) -> bool {
        let faces = |bound: &'_ Bound| bound.faces.clone().into_iter();
        let with_faces = || body.bounds.iter().filter(|bound| !bound.faces.is_empty());
        with_faces().any(|a| {
            let mut others = with_faces().filter(|b| b.number != a.number);
            others.any(|b| {
                (from_inside || self.surface(faces(a)) != self.surface(faces(b)))
                    && self.lie_on(&a.plane, faces(b))
            })
        })
    }

    /// Whether a ray may start within the body, or come to be there.
    fn may_be_inside(&self, start: Start, body: &Body) -> bool {
        let eye_outside = body.bounds.iter().any(|bound| {
            let mut eyes = self.eyes.iter();
            eyes.all(|&eye| bound.outside(eye) > self.ulp)
        });
        if !eye_outside
            || body
                .faces()
                .any(|place| self.transmits[self.label(place) as usize])
        {
            return true;
        }
        // Through a hole of its surface.
        let open = |bound: &Bound| {
            let enters = |start| self.start_beyond(start, |point| bound.outside(point));
            bound.faces.is_empty() && (enters(Start::Camera) || enters(Start::Surface))
        };
        if body.bounds.iter().any(open) {
            return true;
        }
        let mut own = vec![false; self.geometry.faces.len()];
        body.faces().for_each(|place| own[place] = true);
        start == Start::Surface
            && (0..own.len()).any(|place| {
                !own[place] && body.is_entered_by(self.outline(place), SAME_PLANE.sqrt())
            })
    }
}

/// The nearest hit so far.
struct Running<A: Arith> {
    distance: A::Real,
    face: A::Index,
    front: A::Bool,
}

impl<A: Arith> Running<A> {
    fn new(cx: &mut A, reach: f64) -> Self {
        Self {
            distance: cx.t_max(reach),
            face: cx.index(NO_FACE),
            front: cx.truth(true),
        }
    }

    fn take(&mut self, cx: &mut A, when: A::Bool, other: &Self) {
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

/// How a ray goes towards a plane.
struct Approach<A: Arith> {
    /// Whether the ray crosses the plane ahead of its start.
    ahead: A::Bool,
    distance: A::Real,
    /// Whether it goes against the plane's main axis, seen along the plane.
    falls: A::Bool,
    /// Whether it starts above the plane.
    above: A::Bool,
}

impl<A: Arith> Approach<A> {
    fn new(cx: &mut A, plane: &Plane, ray: &Ray<A>) -> Self {
        let ray = AxisPermuted::along(plane.axis, ray);
        let form = constants(cx, plane.form);
        let slope = slope(cx, form, &ray);
        let offset = cx.real(plane.offset);
        let rise = rise(cx, form, offset, &ray);
        let (ahead, distance) = cx.ahead(rise, slope, ray.reach);
        Self {
            ahead,
            distance,
            falls: math!(cx, slope < 0.0),
            above: math!(cx, rise < 0.0),
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

    /// Whether a ray that falls or rises towards a face's plane meets its front.
    fn front<A: Arith>(&self, cx: &mut A, label: u32, falls: A::Bool) -> A::Bool {
        if self.along[label as usize] {
            falls
        } else {
            cx.not(falls)
        }
    }

    /// An outer plane is met from within the scene: where the ray falls towards it, the scene is above.
    /// Whether the ray leaves the plane outwards.
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
        cx.enter(Part::Plane(up.0.plane));
        let turned = AxisPermuted::along(plane.axis, ray);
        let form = constants(cx, plane.form);
        let slope = slope(cx, form, &turned);
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
        let rise = rise(cx, form, offset, &turned);
        let (ahead, distance) = cx.ahead(rise, slope, ray.reach);
        let hit = math!(cx, (ahead && !left) && distance < nearest.distance);
        let here = Running {
            distance,
            face: cx.select_index(falls, a.2, b.2),
            front: cx.select_truth(falls, a.3, b.3),
        };
        nearest.take(cx, hit, &here);
        let [down, up] = [1, 0].map(|k| {
            let outwards = outer.sides[k].as_ref().is_some_and(|side| side.outwards);
            cx.truth(outwards)
        });
        let outwards = cx.select_truth(falls, down, up);
        cx.leave();
        math!(cx, outwards && left)
    }

    /// Where `ray` meets a body nearer than `limit`, and whether.
    fn body<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        body: &Met,
        limit: A::Real,
    ) -> (A::Bool, Running<A>) {
        let mut entry = Running::new(cx, ray.reach);
        entry.distance = cx.real(0.0);
        let mut exit = Running::new(cx, ray.reach);
        let mut exits = Vec::new();
        let mut entered = cx.truth(false);
        let mut missed = cx.truth(false);
        for bound in &body.bounds {
            if !(bound.entered || bound.left || bound.outwards) {
                continue;
            }
            cx.enter(Part::Plane(bound.number));
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
            let ahead = math!(cx, towards.ahead && !starts);
            let label = bound.facet.as_ref().map_or(NO_FACE, Facet::first);
            let mut here = Running {
                distance: towards.distance,
                face: cx.index(label),
                front: cx.truth(true),
            };
            if bound.outwards {
                missed = math!(cx, missed || starts && !inwards);
            }
            if bound.entered {
                let enters = math!(cx, ahead && inwards);
                // From outside to farther outside, or along the plane.
                let turned_away = cx.not(inwards);
                let outside = cx.select_truth(starts, turned_away, outside);
                missed = math!(cx, missed || outside && !enters);
                if bound.facet.is_some() {
                    let falls = cx.truth(bound.below);
                    here.front = self.front(cx, label, falls);
                }
                let later = math!(cx, enters && entry.distance <= here.distance);
                entry.take(cx, later, &here);
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
                    exit.take(cx, earlier, &here);
                } else {
                    exits.push((leaves, here.distance));
                }
            }
            cx.leave();
        }
        let mut meets = math!(cx, !missed);
        if body.from_inside {
            // Through a side that has no face, or from within: what it meets is where it leaves.
            let none = [entry.face, exit.face].map(|face| cx.is(face, NO_FACE));
            let from_outside = math!(cx, entered && !none[0]);
            meets = math!(
                cx,
                (meets && entry.distance < exit.distance) && !(none[0] && none[1])
            );
            exit.take(cx, from_outside, &entry);
            let none = cx.is(exit.face, NO_FACE);
            meets = math!(cx, (meets && !none) && exit.distance < limit);
            return (meets, exit);
        }
        meets = math!(cx, (meets && entered) && entry.distance < limit);
        for (leaves, distance) in exits {
            meets = math!(cx, meets && !(leaves && distance <= entry.distance));
        }
        (meets, entry)
    }

    /// The planes that are asked one after the other, and each with its faces.
    fn planes<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        planes: &[(usize, Vec<usize>)],
        nearest: &mut Running<A>,
    ) {
        for (number, faces) in planes {
            cx.enter(Part::Plane(*number));
            let plane = &self.geometry.planes[*number];
            let turned = AxisPermuted::along(plane.axis, ray);
            let crossing = self.geometry.cross(cx, *number, &turned, ray.from);
            let form = constants(cx, plane.form);
            let slope = slope(cx, form, &turned);
            let falls = math!(cx, slope < 0.0);
            for &place in faces {
                let face = &self.geometry.faces[place];
                let meets = meets(cx, &crossing, &*face.edge_tests);
                let hit = math!(cx, meets && crossing.distance < nearest.distance);
                let here = Running {
                    distance: crossing.distance,
                    face: cx.index(face.label),
                    front: self.front(cx, face.label, falls),
                };
                nearest.take(cx, hit, &here);
            }
            cx.leave();
        }
    }

    /// Tells apart the faces of a plane, now that it is known where the ray meets it.
    fn resolve<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, plan: &Plan, nearest: &mut Running<A>) {
        let outer = plan
            .outer
            .iter()
            .flat_map(|outer| outer.sides.iter().flatten());
        let outer = outer.map(|side| &side.facet);
        let bodies = plan.bodies.iter().flat_map(|body| &body.bounds);
        let facets = outer.chain(bodies.filter_map(|bound| bound.facet.as_ref()));
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
            for (label, tests) in facet.faces.iter().rev() {
                let inside = within(cx, tests, point);
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

impl<A: Arith> Nearest<A> for Search<'_> {
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let plan = self.plan(ray);
        let mut nearest = Running::new(cx, ray.reach);
        let mut gone = cx.truth(false);
        for outer in &plan.outer {
            let outwards = self.outer(cx, ray, outer, &mut nearest);
            gone = math!(cx, gone || outwards);
        }
        self.planes(cx, ray, &plan.planes, &mut nearest);
        for (number, body) in plan.bodies.iter().enumerate() {
            cx.enter(Part::Body(number));
            let (meets, here) = self.body(cx, ray, body, nearest.distance);
            nearest.take(cx, meets, &here);
            cx.leave();
        }
        let none = cx.index(NO_FACE);
        nearest.face = cx.select_index(gone, none, nearest.face);
        self.resolve(cx, ray, plan, &mut nearest);
        nearest.hit(cx, wanted)
    }

    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        let plan = self.plan(ray);
        let mut nearest = Running::new(cx, ray.reach);
        self.planes(cx, ray, &plan.emitting, &mut nearest);
        let mut hit = nearest.hit(cx, wanted);
        let mut hidden = cx.truth(false);
        for (number, body) in plan.bodies_apart() {
            cx.enter(Part::Body(number));
            let (meets, _) = self.body(cx, ray, body, hit.distance);
            hidden = math!(cx, hidden || meets);
            cx.leave();
        }
        for (number, places) in &plan.before_lamps {
            let faces = places.iter().map(|&place| &self.geometry.faces[place]);
            let turned = AxisPermuted::along(self.geometry.planes[*number].axis, ray);
            let (from, lamp) = (ray.from, hit.distance);
            hidden = self
                .geometry
                .hidden_by(cx, *number, faces, &turned, from, lamp, hidden);
        }
        hit.found = math!(cx, hit.found && !hidden);
        hit
    }

    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, _wanted: A::Bool) -> A::Bool {
        let plan = self.plan(ray);
        let mut hidden = cx.truth(false);
        let end = cx.real(1.0);
        for (number, body) in plan.bodies_apart() {
            cx.enter(Part::Body(number));
            let (meets, _) = self.body(cx, ray, body, end);
            hidden = math!(cx, hidden || meets);
            cx.leave();
        }
        for (number, places) in &plan.before_lamps {
            let faces = places.iter().map(|&place| &self.geometry.faces[place]);
            let turned = AxisPermuted::along(self.geometry.planes[*number].axis, ray);
            hidden = self
                .geometry
                .occluded_by(cx, *number, faces, &turned, ray.from, lamp, hidden);
        }
        hidden
    }
}

#[cfg(test)]
mod tests;
