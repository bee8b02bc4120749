//! Convex bodies among the faces of a scene.
//!
//! Faces that meet at whole edges and have all of their corners on one side of each of their planes are
//! the surface of a convex body, or a part of it. A ray is within the body while it is behind all of its
//! planes: from the last plane that it enters to the first that it leaves (Cyrus & Beck 1978). This needs
//! no point on a plane and no edge test, and leaves no cracks.
//!
//! If faces are missing, such as the underside of a box that stands on a floor, the edges of the hole lie
//! in a plane of their own. This plane bounds the body like the others, and has no face.

use super::geometry::StageGeometry;
use super::polygon::{Plane, plane_of};
use glam::DVec3;
use qrt_scene::polygons::{Outlines, SAME_PLANE};
use std::collections::{HashMap, HashSet};

/// Most comparisons of a corner with a plane. Beyond this, no more bodies are searched.
const MOST_COMPARED: usize = 1 << 24;

/// The cosine of the least angle between two faces of a body.
const FOLDED: f64 = 1.0 - 1e-6;

/// A convex body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    pub(super) bounds: Vec<Bound>,
}

/// A plane that bounds a body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bound {
    /// Its number in [`StageGeometry::planes`]; a number beyond these if no face of the scene is on
    /// it.
    pub(super) number: usize,
    /// The plane itself.
    pub(super) plane: Plane,
    /// True if the body is where `p[axis] + a p[axis + 1] + b p[axis + 2]` is below the offset.
    pub(super) below: bool,
    /// The body's faces on the plane, as places in [`StageGeometry::faces`]; none if they are
    /// missing.
    pub(super) faces: Vec<usize>,
}

/// The signed distance of a point from a plane, along the plane's main axis.
pub(super) fn height(plane: &Plane, point: DVec3) -> f64 {
    let [along, first, second] = [0, 1, 2].map(|k| point[(plane.axis + k) % 3]);
    along + (plane.form[0] * first + plane.form[1] * second) - plane.offset
}

impl Bound {
    /// The distance of a point from the inside, along the plane's main axis; negative inside.
    pub(super) fn outside(&self, point: DVec3) -> f64 {
        let height = height(&self.plane, point);
        if self.below { height } else { -height }
    }
}

impl Body {
    /// True if any part of the polygon is inside by more than `tolerance`.
    pub(super) fn is_entered_by(&self, outline: &[DVec3], tolerance: f64) -> bool {
        let mut rest = outline.to_vec();
        for bound in &self.bounds {
            rest = clipped(&rest, |point| bound.outside(point) + tolerance);
            if rest.is_empty() {
                return false;
            }
        }
        true
    }

    /// The places of all of its faces.
    pub(super) fn faces(&self) -> impl Iterator<Item = usize> {
        self.bounds
            .iter()
            .flat_map(|bound| bound.faces.iter().copied())
    }
}

/// The part of a convex polygon where `outside` is below zero.
fn clipped(outline: &[DVec3], outside: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(outline.len() + 1);
    for (k, &start) in outline.iter().enumerate() {
        let end = outline[(k + 1) % outline.len()];
        let (a, b) = (outside(start), outside(end));
        if a < 0.0 {
            kept.push(start);
        }
        if (a < 0.0) != (b < 0.0) {
            kept.push(start + (end - start) * (a / (a - b)));
        }
    }
    kept
}

/// The corners of a geometry's faces by number, each once, and the faces at each edge.
pub(super) struct Edges {
    /// By place in [`StageGeometry::faces`]; none for a disc, which has no edges: the square around it
    /// bounds no body and meets no neighbour.
    pub(super) corners: Vec<Vec<u32>>,
    points: Vec<DVec3>,
    /// The faces at each edge, by place.
    at: HashMap<[u32; 2], Vec<usize>>,
}

impl Edges {
    pub(super) fn new(geometry: &StageGeometry) -> Self {
        let mut edges = Self {
            corners: Vec::new(),
            points: Vec::new(),
            at: HashMap::new(),
        };
        let mut numbers = HashMap::new();
        for (place, face) in geometry.faces.iter().enumerate() {
            if face.disc.is_some() {
                edges.corners.push(Vec::new());
                continue;
            }
            let outline = &geometry.corners[face.label as usize];
            let corners: Vec<u32> = outline
                .iter()
                .map(|corner| {
                    // 0 and -0 are one coordinate.
                    let key = corner.to_array().map(|x| (x + 0.0).to_bits());
                    *numbers.entry(key).or_insert_with(|| {
                        edges.points.push(*corner);
                        edges.points.len() as u32 - 1
                    })
                })
                .collect();
            for edge in of_outline(&corners) {
                edges.at.entry(edge).or_default().push(place);
            }
            edges.corners.push(corners);
        }
        edges
    }

    /// The edges of a face, in the order of its corners.
    pub(super) fn of_face(&self, place: usize) -> impl Iterator<Item = [u32; 2]> {
        of_outline(&self.corners[place])
    }

    /// The ends of an edge.
    pub(super) fn ends(&self, edge: [u32; 2]) -> [DVec3; 2] {
        edge.map(|corner| self.points[corner as usize])
    }

    /// The faces that have this edge, by place.
    pub(super) fn faces_at(&self, edge: [u32; 2]) -> &[usize] {
        self.at.get(&edge).map_or(&[], Vec::as_slice)
    }

    /// True if two `faces` (by place) at this edge fold back upon each other there.
    pub(super) fn fold(&self, geometry: &StageGeometry, edge: [u32; 2], faces: [usize; 2]) -> bool {
        let [start, end] = self.ends(edge);
        let [a, b] = faces.map(|place| {
            let centre = geometry.frame(geometry.faces[place].label as usize).centre;
            (end - start).cross(centre - start).normalize_or_zero()
        });
        a.dot(b) > FOLDED
    }
}

/// Edges as pairs of corners' numbers, the lesser first.
fn of_outline(corners: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    (0..corners.len()).map(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        [a.min(b), a.max(b)]
    })
}

/// Disjoint sets of numbers, which can be joined.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn find(&mut self, number: usize) -> usize {
        let mut at = number;
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// The sets, each in order, the one with the least number first.
    fn sets(mut self, members: impl Iterator<Item = usize>) -> Vec<Vec<usize>> {
        let mut place = HashMap::new();
        let mut sets: Vec<Vec<usize>> = Vec::new();
        for member in members {
            let group = self.find(member);
            let place = *place.entry(group).or_insert_with(|| {
                sets.push(Vec::new());
                sets.len() - 1
            });
            sets[place].push(member);
        }
        sets
    }
}

/// The faces (by place) in sets that meet at edges, each in order.
pub(super) fn components(edges: &Edges) -> Vec<Vec<usize>> {
    let mut groups = Groups::new(edges.corners.len());
    for faces in edges.at.values() {
        for pair in faces.windows(2) {
            groups.join(pair[0], pair[1]);
        }
    }
    groups.sets(0..edges.corners.len())
}

/// The convex bodies among the faces: planes are `tolerance` thick.
pub(super) fn bodies(
    geometry: &StageGeometry,
    edges: &Edges,
    components: &[Vec<usize>],
    tolerance: f64,
) -> Vec<Body> {
    let mut budget = MOST_COMPARED;
    let mut found = Vec::new();
    let mut virtual_planes = Vec::new();
    for component in components {
        let mut finder = Finder {
            geometry,
            edges,
            tolerance,
            budget: &mut budget,
            virtual_planes: &mut virtual_planes,
        };
        found.extend(finder.body(component));
    }
    found
}

struct Finder<'a> {
    geometry: &'a StageGeometry,
    edges: &'a Edges,
    tolerance: f64,
    /// The number of comparisons of a corner with a plane that are left.
    budget: &'a mut usize,
    virtual_planes: &'a mut Vec<Plane>,
}

impl Finder<'_> {
    fn body(&mut self, component: &[usize]) -> Option<Body> {
        let mut corners: Vec<u32> = component
            .iter()
            .flat_map(|&place| self.edges.corners[place].iter().copied())
            .collect();
        corners.sort_unstable();
        corners.dedup();
        let mut by_plane: Vec<(usize, Vec<usize>)> = Vec::new();
        let mut known = HashMap::new();
        for &place in component {
            let label = self.geometry.faces[place].label;
            let plane = self.geometry.plane_of[label as usize] as usize;
            let at = *known.entry(plane).or_insert_with(|| {
                by_plane.push((plane, Vec::new()));
                by_plane.len() - 1
            });
            by_plane[at].1.push(place);
        }
        // Two planes share an edge, for which edge tests suffice.
        if by_plane.len() < 3 {
            return None;
        }
        let mut bounds = Vec::with_capacity(by_plane.len());
        for (number, faces) in by_plane {
            let plane = self.geometry.planes[number].clone();
            let below = self.side(&plane, &corners)?;
            bounds.push(Bound {
                number,
                plane,
                below,
                faces,
            });
        }
        for hole in self.holes(component)? {
            let Some(mut plane) = self.plane_through(&hole)? else {
                continue;
            };
            let below = self.side(&plane, &corners)?;
            let number = self.number(&mut plane);
            if bounds.iter().any(|bound| bound.number == number) {
                // The hole lies on the plane of a face: the faces do not fill their side of the body.
                return None;
            }
            bounds.push(Bound {
                number,
                plane,
                below,
                faces: Vec::new(),
            });
        }
        Some(Body { bounds })
    }

    /// Returns true if all `corners` are below the plane, false if all are above it. None if they are on
    /// both sides, or on the plane.
    fn side(&mut self, plane: &Plane, corners: &[u32]) -> Option<bool> {
        *self.budget = self.budget.checked_sub(corners.len())?;
        let heights = corners
            .iter()
            .map(|&corner| height(plane, self.edges.points[corner as usize]));
        let ends = heights.fold([0.0_f64; 2], |[low, high], h| [low.min(h), high.max(h)]);
        match ends.map(|end| end.abs() > self.tolerance) {
            [true, false] => Some(true),
            [false, true] => Some(false),
            _ => None,
        }
    }

    /// The corners of each hole, whose edges have one face. None if an edge has more than two faces, or
    /// two that fold back upon each other.
    fn holes(&self, component: &[usize]) -> Option<Vec<Vec<u32>>> {
        let mut open: Vec<[u32; 2]> = Vec::new();
        for &place in component {
            for edge in self.edges.of_face(place) {
                match *self.edges.faces_at(edge) {
                    [_] => open.push(edge),
                    [a, b] if !self.edges.fold(self.geometry, edge, [a, b]) => {}
                    _ => return None,
                }
            }
        }
        let mut places = HashMap::new();
        let mut corners: Vec<u32> = open.iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        for (place, &corner) in corners.iter().enumerate() {
            places.insert(corner, place);
        }
        let mut groups = Groups::new(corners.len());
        for [a, b] in open {
            groups.join(places[&a], places[&b]);
        }
        let sets = groups.sets(0..corners.len());
        let holes = sets.into_iter();
        Some(
            holes
                .map(|hole| hole.into_iter().map(|place| corners[place]).collect())
                .collect(),
        )
    }

    /// The plane of `corners`; `Some(None)` if they are on one line, which leaves no hole. None if they
    /// are on no plane.
    #[allow(clippy::option_option)] // No hole, and no body.
    fn plane_through(&self, corners: &[u32]) -> Option<Option<Plane>> {
        let points = || corners.iter().map(|&c| self.edges.points[c as usize]);
        let first = points().next()?;
        let farthest =
            |from: &dyn Fn(DVec3) -> f64| points().max_by(|a, b| from(*a).total_cmp(&from(*b)));
        let second = farthest(&|p| p.distance_squared(first))?;
        let along = (second - first).normalize_or_zero();
        let away = |p: DVec3| along.cross(p - first);
        let third = farthest(&|p| away(p).length_squared())?;
        let normal = away(third);
        if normal.length() <= self.tolerance {
            return Some(None);
        }
        let corners = [first, second, third];
        let plane = plane_of(&corners, &super::polygon::frame(&corners));
        let flat = points().all(|p| height(&plane, p).abs() <= self.tolerance);
        flat.then_some(Some(plane))
    }

    /// The number of `plane`. If it is one of the scene's own planes, that one replaces it.
    fn number(&mut self, plane: &mut Plane) -> usize {
        let same = |other: &Plane| {
            let values = |p: &Plane| [p.form[0], p.form[1], p.offset];
            let pairs = values(plane).into_iter().zip(values(other));
            plane.axis == other.axis
                && pairs
                    .into_iter()
                    .all(|(a, b)| (a - b).abs() <= 4.0 * SAME_PLANE)
        };
        let all = self
            .geometry
            .planes
            .iter()
            .chain(self.virtual_planes.iter());
        let found = all.enumerate().find(|(_, other)| same(other));
        if let Some((number, known)) = found {
            *plane = Plane {
                faces: 0..0,
                emitters: 0..0,
                ..known.clone()
            };
            return number;
        }
        self.virtual_planes.push(plane.clone());
        self.geometry.planes.len() + self.virtual_planes.len() - 1
    }
}

/// True if other faces on the plane cover one of `faces` (by place), all of which are on it.
pub(super) fn covered(geometry: &StageGeometry, plane: usize, faces: &[usize]) -> bool {
    let range = geometry.planes[plane].faces.clone();
    let outline = |place: usize| &geometry.corners[geometry.faces[place].label as usize];
    let own: HashSet<usize> = faces.iter().copied().collect();
    let others: Vec<&[DVec3]> = range
        .filter(|place| !own.contains(place))
        .map(outline)
        .collect();
    if others.is_empty() {
        return false;
    }
    let mut others = Outlines::new(geometry.planes[plane].axis, others);
    others.ask_from(0);
    faces
        .iter()
        .any(|&face| others.first_overlapped(outline(face)).is_some())
}

#[cfg(test)]
pub(super) mod tests;
