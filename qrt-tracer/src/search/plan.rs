//! The tests of a search, for rays with one kind of start: outer planes, bodies, and the other planes.

use super::balls::BallPlan;
use super::mesh::MeshPlan;
use super::planner::Planner;
use crate::ball::StageBall;
use crate::convex::{Body, Bound, covered, height};
use crate::polygon::{Outline, Plane, edge_test};
use crate::ray::Start;
use glam::DVec3;
use qrt_scene::polygons::SAME_PLANE;

/// Most pairs of an edge and an outer plane that are compared. Beyond this, all edges are tested.
const MOST_COMPARED: usize = 1 << 24;

/// The tests for a ray, by the kind of its start.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Plan {
    pub(super) outer: Vec<Outer>,
    /// The outer planes through which rays to the sun may leave the scene.
    pub(super) sunward: Vec<Outer>,
    /// Planes that are tested as [`StageGeometry`] tests them, and the places of their faces.
    pub(super) planes: Vec<(usize, Vec<usize>)>,
    pub(super) bodies: Vec<Met>,
    /// Planes with emitting faces, and the places of these and of those that hide them.
    pub(super) emitting: Vec<(usize, Vec<usize>)>,
    /// The meshes whose edges are tested.
    pub(super) mesh: MeshPlan,
    /// The spheres.
    pub(super) balls: BallPlan,
    /// The other planes that may hide a lamp, and the places of their faces. They are tested as
    /// [`StageGeometry`] tests them.
    pub(super) before_lamps: Vec<(usize, Vec<usize>)>,
}

/// An outer plane, or two that face each other.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outer {
    /// The plane that the ray meets if the slope towards it is above zero, with the scene below it; and
    /// the plane that the ray meets if the slope is below zero.
    pub(super) sides: [Option<OuterSide>; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct OuterSide {
    pub(super) plane: usize,
    pub(super) facet: Facet,
    /// True if rays may leave its faces outwards.
    pub(super) outwards: bool,
}

/// The faces of one plane. A ray meets the first face that passes its tests. If the last face has no
/// tests, every tested point is on one of the faces.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Facet {
    pub(super) axis: usize,
    pub(super) faces: Vec<(u32, Outline)>,
}

/// A convex body, and the ways in which rays may meet it.
#[derive(Debug, PartialEq)]
pub(super) struct Met {
    /// True if rays may start inside, or get there.
    pub(super) from_inside: bool,
    /// True if a face emits, or may cover a face of its plane that emits.
    pub(super) at_lamps: bool,
    pub(super) bounds: Vec<MetBound>,
}

#[derive(Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools)] // Each is a fact of its own.
pub(super) struct MetBound {
    pub(super) number: usize,
    pub(super) plane: Plane,
    pub(super) below: bool,
    pub(super) facet: Option<Facet>,
    /// True if rays may start outside.
    pub(super) entered: bool,
    /// True if the outer planes do not already determine where rays leave.
    pub(super) left: bool,
    /// The rays that start on the plane.
    pub(super) starts: Starts,
    /// True if a ray may start on the plane, leave it outwards and yet cross other planes of the body.
    /// False if rays may start outside.
    pub(super) outwards: bool,
}

/// The rays that start on a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Starts {
    None,
    All,
    /// The rays that leave the faces on it.
    Leaving,
}

impl Plan {
    /// The facets of all outer planes and bodies.
    pub(super) fn facets(&self) -> impl Iterator<Item = &Facet> {
        let bodies = self.bodies.iter().flat_map(|body| &body.bounds);
        let bodies = bodies.filter_map(|bound| bound.facet.as_ref());
        facets(&self.outer).chain(bodies)
    }

    /// The bodies without lamps, with their numbers.
    pub(super) fn bodies_apart(&self) -> impl Iterator<Item = (usize, &Met)> {
        let bodies = self.bodies.iter().enumerate();
        bodies.filter(|(_, body)| !body.at_lamps)
    }
}

/// The facets of outer planes.
pub(super) fn facets(outer: &[Outer]) -> impl Iterator<Item = &Facet> {
    let sides = outer.iter().flat_map(|outer| outer.sides.iter().flatten());
    sides.map(|side| &side.facet)
}

impl Facet {
    /// The label that stands for all faces until the nearest hit is known.
    pub(super) fn first(&self) -> u32 {
        self.faces[0].0
    }

    /// True if that label is the face: it has no tests.
    pub(super) fn is_plain(&self) -> bool {
        self.faces[0].1.is_open()
    }

    /// Creates a facet of faces in the order in which they hide each other, with their tests. Faces
    /// after a face without tests are never met.
    fn new(axis: usize, faces: impl Iterator<Item = (u32, Outline)>) -> Self {
        let mut facet = Self {
            axis,
            faces: Vec::new(),
        };
        for face in faces {
            let plain = face.1.is_open();
            facet.faces.push(face);
            if plain {
                break;
            }
        }
        facet
    }
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
            Start::Surface => Box::new(self.geometry.points()),
        }
    }

    /// True if some rays start on the side of a plane where `outside` is above zero.
    fn start_beyond(&self, start: Start, outside: impl Fn(DVec3) -> f64) -> bool {
        let margin = match start {
            Start::Camera => self.ulp,
            Start::Surface => SAME_PLANE,
        };
        self.starts(start).any(|point| outside(point) > margin)
    }

    /// True if rays may leave the faces on plane `number` to the side where `outside` is above zero. The
    /// scene has nothing on that side: rays go to a viewer there, or through the faces.
    fn leave_outwards(&self, number: usize, outside: impl Fn(DVec3) -> f64) -> bool {
        let plane = self.geometry.planes.get(number);
        let mut faces = plane.into_iter().flat_map(|plane| plane.faces.clone());
        faces.any(|place| self.transmits[self.label(place) as usize])
            || self.eyes.iter().any(|&eye| outside(eye) > 0.0)
    }

    pub(super) fn plan(&self, start: Start, bodies: &[Body], components: &[Vec<usize>]) -> Plan {
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
            // The walls of a room are outer planes, and are better tested as outer planes.
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
        // Planes that have no face left are not tested. A ray may leave a body at the distance of an outer plane
        // whose other faces it misses: that plane is tested as the inner ones are.
        for (number, side) in outer_sides.iter_mut().enumerate() {
            let mut faces = self.geometry.planes[number].faces.clone();
            let mut left = met.iter().filter(|(from_inside, ..)| *from_inside);
            let is_left = left.any(|(_, body, _)| {
                let mut bounds = body.bounds.iter();
                bounds.any(|bound| bound.number == number && !bound.faces.is_empty())
            });
            if is_left || !faces.any(|place| rest[place]) {
                *side = None;
            }
        }
        let outer = self.outer(&outer_sides, &rest);
        let on_inner_plane: Vec<bool> = (0..rest.len())
            .map(|place| {
                let plane = self.geometry.plane_of[self.label(place) as usize] as usize;
                rest[place] && outer_sides[plane].is_none()
            })
            .collect();
        let mesh = MeshPlan::new(self, start, components, &on_inner_plane);
        let mut in_mesh = vec![false; self.geometry.plane_of.len()];
        mesh.labels()
            .for_each(|label| in_mesh[label as usize] = true);
        for (place, rest) in rest.iter_mut().enumerate() {
            *rest &= !in_mesh[self.label(place) as usize];
        }
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
            sunward: self.sunward(&outer),
            outer,
            planes: planes.collect(),
            bodies: bodies.collect(),
            mesh,
            balls: BallPlan::new(self.geometry, self.eyes, self.transmits, start, self.ulp),
            emitting: self.planes_with(|place| self.geometry.faces[place].is_asked_first()),
            before_lamps: before_lamps.collect(),
        }
    }

    /// The outer planes, and sides of them, that rays to the sun may cross on their way out.
    fn sunward(&self, outer: &[Outer]) -> Vec<Outer> {
        let Some(cone) = &self.sun else {
            return Vec::new();
        };
        let is_crossed = |side: &OuterSide, sign: f64| {
            let plane = &self.geometry.planes[side.plane];
            let mut normal = [sign; 3];
            for (k, part) in plane.form.into_iter().enumerate() {
                normal[(plane.axis + k + 1) % 3] = sign * part;
            }
            cone.greatest_cosine(DVec3::from_array(normal).normalize()) > 0.0
        };
        let crossed = outer.iter().map(|outer| {
            let [up, down] = &outer.sides;
            let sides = [(up, 1.0), (down, -1.0)]
                .map(|(side, sign)| side.clone().filter(|side| is_crossed(side, sign)));
            Outer { sides }
        });
        let is_left = |outer: &Outer| outer.sides.iter().any(Option::is_some);
        crossed.filter(is_left).collect()
    }

    /// The planes that have faces which are `wanted` (by place), and these faces.
    fn planes_with(&self, wanted: impl Fn(usize) -> bool) -> Vec<(usize, Vec<usize>)> {
        let planes = self.geometry.planes.iter().enumerate();
        let planes = planes.map(|(number, plane)| {
            let faces = plane.faces.clone().filter(|&place| wanted(place));
            (number, faces.collect::<Vec<usize>>())
        });
        planes.filter(|(_, faces)| !faces.is_empty()).collect()
    }

    /// By plane: `Some(true)` if the scene and all starts are below it, `Some(false)` if they are above
    /// it; none for planes that are not outer.
    fn outer_sides(&self, start: Start) -> Vec<Option<bool>> {
        let side = |plane: &Plane| {
            if !plane.outermost {
                return None;
            }
            let far = self
                .geometry
                .points()
                .map(|corner| height(plane, corner))
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
        // The first outer plane that is crossed must be distinguishable from the others, or have their
        // surface; and from faces before it, such as a lamp right below a ceiling.
        let planes = || self.geometry.planes.iter().enumerate();
        let numbers: Vec<usize> = (0..sides.len()).filter(|&n| sides[n].is_some()).collect();
        if numbers.len().saturating_mul(sides.len()) <= MOST_COMPARED {
            for &number in &numbers {
                let plane = &self.geometry.planes[number];
                let blurred = |(other, near): &(usize, &Plane)| {
                    let differs =
                        self.surface(plane.faces.clone()) != self.surface(near.faces.clone());
                    *other != number
                        && (differs || !numbers.contains(other))
                        && self.lie_on(plane, near.faces.clone())
                };
                if let Some((other, _)) = planes().find(blurred) {
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

    /// True if circuits cannot distinguish these faces (by place) from the plane: they are too near to it.
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

    /// True if two faces of the edge's plane meet there, one on each side.
    fn meet(&self, edge: [u32; 2], plane: u32) -> bool {
        let on_plane =
            |place: &&usize| self.geometry.plane_of[self.label(**place) as usize] == plane;
        let mut here = self.edges.faces_at(edge).iter().filter(on_plane);
        match [here.next(), here.next(), here.next()] {
            [Some(&a), Some(&b), None] => !self.edges.fold(self.geometry, edge, [a, b]),
            _ => false,
        }
    }

    /// The facet of `faces` (by place) of one plane, with tests of their edges that are not `implied`.
    fn facet(&self, axis: usize, faces: &[usize], implied: impl Fn([u32; 2]) -> bool) -> Facet {
        let tested = |&place: &usize| -> Vec<[u32; 2]> {
            let edges = self.edges.of_face(place);
            edges.filter(|&edge| !implied(edge)).collect()
        };
        let all: Vec<Vec<[u32; 2]>> = faces.iter().map(tested).collect();
        // If all edges are implied except those at which two of these faces meet, a ray that meets the
        // plane meets one of the polygons: the last one needs no test. Discs have no edges, and keep their
        // tests.
        let plane = faces.first().map_or(0, |&place| {
            self.geometry.plane_of[self.label(place) as usize]
        });
        let whole = all.iter().flatten().all(|&edge| self.meet(edge, plane));
        let is_polygon = |&place: &usize| self.geometry.faces[place].disc.is_none();
        let last = faces.iter().rposition(is_polygon);
        let tests = faces.iter().zip(&all).enumerate();
        let tests = tests.map(|(k, (&place, edges))| {
            let label = self.label(place);
            let face = &self.geometry.faces[place];
            if face.disc.is_some() {
                let (edge_tests, disc) = (face.edge_tests.clone(), face.disc.clone());
                return (label, Outline { edge_tests, disc });
            }
            let centre = self.geometry.frame(label as usize).centre;
            let edges = edges.iter().filter(|_| !(whole && Some(k) == last));
            let tolerance = self.geometry.tolerance;
            let tests =
                edges.map(|&edge| edge_test(self.edges.ends(edge), axis, centre, tolerance));
            let (edge_tests, disc) = (tests.collect(), None);
            (label, Outline { edge_tests, disc })
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
            // All edges except those at which two of the faces meet are the body's.
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

    /// True if planes of the body cannot be distinguished at a face, although they have to be: their
    /// surfaces differ, or rays come from inside.
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

    /// True if a ray may start within the body, or get there.
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
        // Rays may enter through a hole of the body's surface.
        let open = |bound: &Bound| {
            let enters = |start| self.start_beyond(start, |point| bound.outside(point));
            bound.faces.is_empty() && (enters(Start::Camera) || enters(Start::Surface))
        };
        if body.bounds.iter().any(open) {
            return true;
        }
        // A ray may leave a sphere that reaches into the body.
        let reaches_in = |ball: &StageBall| {
            let mut bounds = body.bounds.iter();
            bounds.all(|bound| {
                let [a, b] = bound.plane.form;
                // Heights are along the plane's main axis.
                let reach = ball.radius * (1.0 + a * a + b * b).sqrt();
                bound.outside(ball.centre) < reach - SAME_PLANE.sqrt()
            })
        };
        if start == Start::Surface && self.geometry.balls.iter().any(reaches_in) {
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
