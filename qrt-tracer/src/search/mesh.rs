//! The search of meshes by their edges, for numbers of a few bits.
//!
//! Let `o` be the start of a ray and `d` its direction. The sign of `U` says on which side of the edge from
//! `a` to `b` the ray's line passes:
//!
//! ```text
//! U = d.((a - o) x (b - o)) = d.m + (o x d).e,    e = b - a,  m = a x b
//! ```
//!
//! (Pluecker coordinates). The line meets the front of a face if all `U` of its edges are below 0, and its
//! back if all are above 0.
//!
//! - The two faces at an edge read one number, so a line passes neither between them nor through both.
//! - At a corner, the edges' numbers are rounded apart: a line could pass between all faces there. So a
//!   strip along each edge belongs to both of its faces ([`REACH`]). An edge is scaled by a power of two
//!   such that the greatest component of `e` is at least 1/2: `U` is then about a distance.
//! - All edges multiply the same six numbers, `d` and `o x d`, by constants. Rays from one eye multiply
//!   three, since `U = d.(m + e x o)`.
//! - A line meets few faces. [`Arith::encode`] puts the first of them into slots, and a slot looks the
//!   plane of its face up: one division a slot, and none a face.

use super::Running;
use super::planner::Planner;
use crate::ball::StageBall;
use crate::convex::{Edges, covered, height};
use crate::crossing::{AxisPermuted, rise, slope};
use crate::geometry::StageGeometry;
use crate::ray::{Ray, Start};
use crate::vector::Vector;
use crate::{Arith, TracerPart};
use glam::DVec3;
use std::cmp::Ordering;

mod lines;

/// Half the width of the strip along an edge that belongs to both of its faces, in units in the last place.
const REACH: f64 = 4.0;

/// A great error of a `U`, in units in the last place.
const ERROR: f64 = 2.0;

/// The last bit of the constants of `e` and of `m`, in units in the last place of a number.
const STEPS: [f64; 2] = [16.0, 4.0];

/// Number of edges whose products with constants are computed together.
const GROUP: usize = 128;

/// Fewest faces of a component that is searched by its edges.
const LEAST: usize = 4;

/// Toffolis of a plane with one face, in hundreds: about 1,400 with its [face](ON_PLANE). Meshes are searched
/// by their edges if that is cheaper for all of them together.
const PLANE: usize = 10;
/// Toffolis of a face of a plane, in hundreds.
const ON_PLANE: usize = 4;
/// Toffolis of a face and its edges, in hundreds.
const BY_EDGES: usize = 3;
/// Toffolis of a slot, in hundreds.
const SLOT: usize = 29;

/// The sides from which rays may meet a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Facing {
    Front,
    Back,
    Both,
}

/// An edge: `m` and `e`, or `m + e x o` and nothing for rays from one eye.
#[derive(Debug, PartialEq)]
struct Edge {
    moment: [f64; 3],
    along: [f64; 3],
}

#[derive(Debug, PartialEq)]
struct MeshFace {
    label: u32,
    facing: Facing,
    /// The edges by number, and whether the face has them from their second end to their first.
    edges: Vec<(usize, bool)>,
}

/// Columns that slots look up, by face label.
#[derive(Debug, Default, PartialEq)]
struct SlotTable {
    axes: Vec<u32>,
    /// The form and the offset of the face's plane.
    planes: Vec<[f64; 3]>,
    /// The number of the face's plane.
    numbers: Vec<u32>,
    /// 1 if a ray that falls towards the plane meets the face's front, else 0.
    along: Vec<u32>,
}

/// The search of meshes, for rays with one kind of start.
#[derive(Debug, Default, PartialEq)]
pub(super) struct MeshPlan {
    edges: Vec<Edge>,
    faces: Vec<MeshFace>,
    /// Number of slots: an estimate of the most faces that a line meets.
    slots: usize,
    table: SlotTable,
    /// True if all rays start at one eye, which the constants of the edges contain.
    from_eye: bool,
    reach: f64,
    /// A bound on the distance between two points of the geometry.
    farthest: f64,
}

/// The truth values of an edge: its number is not above 0, and not below 0.
struct Sides<A: Arith> {
    low: A::Bool,
    high: A::Bool,
}

/// A face that the line of a ray meets.
struct Crossed<A: Arith> {
    /// True if the ray meets it.
    meets: A::Bool,
    here: Running<A>,
}

impl MeshPlan {
    /// Updates `nearest` with all meshes.
    pub(super) fn nearest<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, nearest: &mut Running<A>) {
        self.each(cx, ray, |cx, crossed| {
            let nearer = math!(
                cx,
                crossed.meets && crossed.here.distance < nearest.distance
            );
            nearest.replace(cx, nearer, &crossed.here);
        });
    }

    /// True where `hidden` is, or where a face is nearer than `limit`.
    pub(super) fn hides<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        limit: A::Real,
        mut hidden: A::Bool,
    ) -> A::Bool {
        self.each(cx, ray, |cx, crossed| {
            hidden = math!(cx, hidden || crossed.meets && crossed.here.distance < limit);
        });
        hidden
    }

    /// True where `hidden` is, or where a face stands between the start of `ray` and its end, one length
    /// of its direction away.
    pub(super) fn occluded<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, hidden: A::Bool) -> A::Bool {
        if self.is_empty() {
            return hidden;
        }
        // An edge's reach is a distance if the direction has unit length.
        let length = cx.length(ray.direction);
        let direction = ray.direction.map(|part| cx.div(part, length, 1.0));
        let ray = Ray {
            direction,
            t_max: self.farthest,
            ..*ray
        };
        self.hides(cx, &ray, length, hidden)
    }

    /// Calls `see` with every face that the line of the ray meets.
    fn each<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, mut see: impl FnMut(&mut A, &Crossed<A>)) {
        if self.is_empty() {
            return;
        }
        cx.enter(TracerPart::Mesh);
        let sides = self.sides(cx, ray);
        let met = self.faces.iter().map(|face| {
            let met = match face.facing {
                Facing::Front => face.met(cx, &sides, false),
                Facing::Back => face.met(cx, &sides, true),
                Facing::Both => {
                    let (front, back) = (face.met(cx, &sides, false), face.met(cx, &sides, true));
                    cx.or(front, back)
                }
            };
            (met, face.label)
        });
        let met: Vec<(A::Bool, u32)> = met.collect();
        let slots = cx.encode(&met, self.slots);
        for (number, (found, face)) in slots.into_iter().enumerate() {
            cx.enter(TracerPart::Slot(number));
            let crossed = self.slot(cx, ray, found, face);
            cx.leave();
            see(cx, &crossed);
        }
        cx.leave();
    }

    /// The sides on which the line of the ray passes each edge.
    fn sides<A: Arith>(&self, cx: &mut A, ray: &Ray<A>) -> Vec<Sides<A>> {
        let (o, d) = (ray.origin, ray.direction);
        // The constants of rays from one eye contain the product.
        let across: Vector<A> = [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            if self.from_eye {
                cx.real(0.0)
            } else {
                math!(cx, o[i] * d[j] - o[j] * d[i])
            }
        });
        let mut sides = Vec::with_capacity(self.edges.len());
        for (number, group) in self.edges.chunks(GROUP).enumerate() {
            cx.enter(TracerPart::Edges(number));
            for edge in group {
                let mut u = cx.real(0.0);
                for (number, factor) in d.into_iter().zip(edge.moment) {
                    let part = cx.scale(number, factor);
                    u = cx.add(u, part);
                }
                for (number, factor) in across.into_iter().zip(edge.along) {
                    let part = cx.scale(number, factor);
                    u = cx.add(u, part);
                }
                let (ahead, back) = (cx.real(self.reach), cx.real(-self.reach));
                sides.push(Sides {
                    low: cx.less(u, ahead),
                    high: cx.less(back, u),
                });
            }
            cx.leave();
        }
        sides
    }

    /// The face in a slot.
    fn slot<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        found: A::Bool,
        face: A::Index,
    ) -> Crossed<A> {
        let axis = cx.entry(&self.table.axes, face);
        let turned = AxisPermuted::looked_up(cx, ray, axis);
        let [a, b, offset] = cx.rows(&self.table.planes, face);
        let slope = slope(cx, [a, b], &turned);
        let rise = rise(cx, [a, b], offset, &turned);
        let (ahead, distance) = cx.ahead(rise, slope, ray.t_max);
        let plane = cx.entry(&self.table.numbers, face);
        let left = cx.same(plane, ray.from);
        let along = cx.entry(&self.table.along, face);
        let along = cx.is(along, 1);
        let falls = math!(cx, slope < 0.0);
        let rises = cx.not(falls);
        Crossed {
            meets: math!(cx, (found && ahead) && !left),
            here: Running {
                distance,
                face,
                front: cx.select_truth(along, falls, rises),
            },
        }
    }
}

impl MeshPlan {
    /// The meshes among `components`, each the places of faces that meet at edges. `rest` tells by place
    /// which faces nothing else tests.
    pub(super) fn new(
        planner: &Planner<'_>,
        start: Start,
        components: &[Vec<usize>],
        rest: &[bool],
    ) -> Self {
        let geometry = planner.geometry;
        let mut chosen: Vec<(usize, Facing)> = Vec::new();
        let mut cost = 0;
        for component in components {
            let faces = component.iter().copied();
            let mut faces: Vec<usize> = faces.filter(|&place| rest[place]).collect();
            if faces.len() < LEAST {
                continue;
            }
            let planes = planes_of(geometry, &faces);
            let (kept, lost): (Vec<u32>, Vec<u32>) = planes
                .into_iter()
                .partition(|&number| planner.is_apart(start, number, &faces));
            if !lost.is_empty() {
                let plane = |place: usize| geometry.plane_of[geometry.faces[place].label as usize];
                faces.retain(|&place| lost.binary_search(&plane(place)).is_err());
            }
            if faces.len() >= LEAST {
                cost += kept.len() * PLANE + faces.len() * ON_PLANE;
                let facing = planner.facing(component);
                chosen.extend(faces.into_iter().map(|place| (place, facing)));
            }
        }
        chosen.sort_unstable_by_key(|(place, _)| *place);
        if cost <= chosen.len() * BY_EDGES + 3 * SLOT {
            return Self::default();
        }
        let slots = {
            let any = Self::with_faces(planner, Start::Surface, &chosen);
            lines::most_crossings(&any, planner, start)
        };
        if cost <= chosen.len() * BY_EDGES + slots * SLOT {
            return Self::default();
        }
        // An encoder takes the fewest CNOTs if its entries count upwards.
        chosen.sort_unstable_by_key(|(place, _)| geometry.faces[*place].label);
        Self {
            slots,
            ..Self::with_faces(planner, start, &chosen)
        }
    }

    fn with_faces(planner: &Planner<'_>, start: Start, chosen: &[(usize, Facing)]) -> Self {
        let geometry = planner.geometry;
        let eye = match planner.eyes {
            [eye] if start == Start::Camera => Some(*eye),
            _ => None,
        };
        let ends_of = |place: usize| {
            let corners = &planner.edges.corners[place];
            (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
        };
        let in_order = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let all = chosen.iter().flat_map(|(place, _)| ends_of(*place));
        let mut all: Vec<[u32; 2]> = all.map(in_order).collect();
        all.sort_unstable();
        all.dedup();
        let new = |&ends: &[u32; 2]| Edge::new(planner.edges.ends(ends), eye, planner.ulp);
        let mut edges: Vec<(usize, Edge)> = all.iter().map(new).enumerate().collect();
        edges.sort_by(|(_, a), (_, b)| a.cmp_size(b));
        let mut numbers = vec![0; edges.len()];
        for (number, (place, _)) in edges.iter().enumerate() {
            numbers[*place] = number;
        }
        let number = |[a, b]: [u32; 2]| {
            let place = all.binary_search(&in_order([a, b]));
            (numbers[place.unwrap_or_else(|place| place)], a > b)
        };
        let face = |&(place, facing): &(usize, Facing)| MeshFace {
            label: geometry.faces[place].label,
            facing,
            edges: ends_of(place).map(number).collect(),
        };
        Self {
            faces: chosen.iter().map(face).collect(),
            edges: edges.into_iter().map(|(_, edge)| edge).collect(),
            slots: 0,
            table: SlotTable::new(geometry, chosen),
            from_eye: eye.is_some(),
            reach: REACH * planner.ulp,
            farthest: 2.0 * geometry.radius(),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The labels of its faces.
    pub(super) fn labels(&self) -> impl Iterator<Item = u32> + '_ {
        self.faces.iter().map(|face| face.label)
    }

    #[cfg(test)]
    pub(super) fn size(&self) -> [usize; 3] {
        [self.edges.len(), self.faces.len(), self.slots]
    }
}

impl MeshFace {
    /// True if the line meets the face's front, or its `back`.
    fn met<A: Arith>(&self, cx: &mut A, sides: &[Sides<A>], back: bool) -> A::Bool {
        let mut met = cx.truth(true);
        for &(edge, turned) in &self.edges {
            let sides = &sides[edge];
            let side = if turned == back {
                sides.low
            } else {
                sides.high
            };
            met = cx.and(met, side);
        }
        met
    }
}

impl Edge {
    fn new([a, b]: [DVec3; 2], eye: Option<DVec3>, ulp: f64) -> Self {
        let along = b - a;
        let moment = a.cross(b) + eye.map_or(DVec3::ZERO, |eye| along.cross(eye));
        let (_, exponent) = libm::frexp(along.abs().max_element());
        let rounded = |vector: DVec3, step: f64| {
            let scaled = vector * libm::exp2(-f64::from(exponent));
            (scaled / step)
                .to_array()
                .map(|part| part.round_ties_even() * step)
        };
        Self {
            moment: rounded(moment, STEPS[1] * ulp),
            along: rounded(along, STEPS[0] * ulp),
        }
    }

    /// Compares the magnitudes of the constants: edges of one group then share more products.
    fn cmp_size(&self, other: &Self) -> Ordering {
        let sizes = |edge: &Self| {
            let [e, m] = [edge.along, edge.moment].map(|vector| vector.map(f64::abs));
            [e[0], e[1], e[2], m[0], m[1], m[2]]
        };
        let pairs = sizes(self).into_iter().zip(sizes(other));
        let by_size = pairs.map(|(a, b)| a.total_cmp(&b));
        by_size.fold(Ordering::Equal, Ordering::then)
    }
}

impl SlotTable {
    fn new(geometry: &StageGeometry, chosen: &[(usize, Facing)]) -> Self {
        let labels = chosen.iter().map(|(place, _)| geometry.faces[*place].label);
        let mut labels: Vec<u32> = labels.collect();
        labels.sort_unstable();
        let mut table = Self::default();
        // Rows of other faces repeat the next face of a mesh. An empty slot reads row 0.
        let mut row = 0;
        for label in labels {
            let number = geometry.plane_of[label as usize];
            let plane = &geometry.planes[number as usize];
            let along = geometry.normals[label as usize][plane.axis] > 0.0;
            while row <= label {
                table.axes.push(plane.axis as u32);
                table
                    .planes
                    .push([plane.form[0], plane.form[1], plane.offset]);
                table.numbers.push(number);
                table.along.push(u32::from(along));
                row += 1;
            }
        }
        table
    }
}

/// The numbers of the planes of these faces (by place), each once.
fn planes_of(geometry: &StageGeometry, faces: &[usize]) -> Vec<u32> {
    let plane = |&place: &usize| geometry.plane_of[geometry.faces[place].label as usize];
    let mut planes: Vec<u32> = faces.iter().map(plane).collect();
    planes.sort_unstable();
    planes.dedup();
    planes
}

impl Planner<'_> {
    /// True if `faces` (by place) of one plane may be searched by their edges.
    ///
    /// False if another face of the plane covers one of them, or if one is at a lamp: distances on one plane,
    /// computed in two ways, could not be compared. False if the camera's rays start on the plane, which they
    /// do not meet: in a slot, their distance is not exactly 0.
    fn is_apart(&self, start: Start, number: u32, faces: &[usize]) -> bool {
        let geometry = self.geometry;
        let plane = &geometry.planes[number as usize];
        let is_near = |eye: &DVec3| height(plane, *eye).abs() <= 8.0 * self.ulp;
        if start == Start::Camera && self.eyes.iter().any(is_near) {
            return false;
        }
        let [first, last] = [plane.faces.start, plane.faces.end]
            .map(|end| faces.partition_point(|&place| place < end));
        let own = &faces[first..last];
        let at_lamps = |&place: &usize| {
            let face = &geometry.faces[place];
            face.emits || face.hides_emitter || face.covers.is_some()
        };
        let alone = own.len() == plane.faces.len();
        !own.iter().any(at_lamps) && (alone || !covered(geometry, number as usize, own))
    }

    /// The sides from which rays may meet the faces of a component (by place).
    ///
    /// Rays that start outside a closed opaque surface meet its outer side first, if the surface does not cross
    /// itself.
    fn facing(&self, component: &[usize]) -> Facing {
        let geometry = self.geometry;
        let label = |place: usize| geometry.faces[place].label as usize;
        if component.iter().any(|&place| self.transmits[label(place)])
            || !is_closed(self.edges, component)
        {
            return Facing::Both;
        }
        let outline = |&place: &usize| &geometry.corners[label(place)];
        let corners = || component.iter().flat_map(outline).copied();
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let [eye_low, eye_high] = self.eye_box();
        let apart =
            (eye_low.cmpgt(high + 2.0 * self.ulp) | low.cmpgt(eye_high + 2.0 * self.ulp)).any();
        let outside = apart
            || matches!(self.eyes, [eye] if !lines::encloses(component.iter().map(outline), *eye, self.ulp));
        // A sphere that cuts the surface has points of its own within, from which rays start.
        let cut = |ball: &StageBall| {
            let around = ball.centre.clamp(low, high).distance(ball.centre);
            around < ball.radius + self.ulp
        };
        if !outside || geometry.balls.iter().any(cut) {
            return Facing::Both;
        }
        match lines::outer_side(&component.iter().map(outline).collect::<Vec<_>>()) {
            Some(true) => Facing::Front,
            Some(false) => Facing::Back,
            None => Facing::Both,
        }
    }
}

/// True if each edge of the component's faces has two of them, which have it in opposite directions.
fn is_closed(edges: &Edges, component: &[usize]) -> bool {
    let mut directed: Vec<[u32; 2]> = Vec::new();
    for &place in component {
        let corners = &edges.corners[place];
        let next = corners.iter().cycle().skip(1);
        directed.extend(corners.iter().zip(next).map(|(&a, &b)| [a, b]));
    }
    directed.sort_unstable();
    let twice = directed.windows(2).any(|pair| pair[0] == pair[1]);
    let turned = |&[a, b]: &[u32; 2]| directed.binary_search(&[b, a]).is_ok();
    !twice && directed.iter().all(turned)
}

#[cfg(test)]
mod tests;
