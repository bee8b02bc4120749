//! Polygons prepared for intersection: planes, the faces on them, and shading frames.
//!
//! Everything is in *stage units*: the geometry's bounding box is centred at the origin and scaled by a
//! power of two so that its largest half extent lies in `(1/2, 1]`. A scene that is a million units
//! across, or a billion units from the origin, is traced with the same precision as a scene near the
//! origin.

use super::ball::StageBall;
use super::corners::Corners;
use super::polygon::{
    DiscTest, EdgeTest, FaceFrame, Plane, disc_tests, edge_tests, frame, plane_of,
};
use glam::DVec3;
use qrt_scene::polygons::{Outlines, SAME_PLANE, fill_once, stage_units};
use qrt_scene::valid::{Ball, Polygon};
use std::cmp::Ordering;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The face number of a ray that meets no face.
pub const NO_FACE: u32 = u32::MAX;

/// The plane number of camera rays that leave no plane: all, unless all of them start on one plane.
pub const NO_PLANE: u32 = u32::MAX;

/// The outward tolerance of edges in stage units, for rays that start within one unit of the origin. It is
/// a few ulps, so that neighbours overlap and leave no cracks.
pub const TOLERANCE: f64 = 1.0 / (1_u64 << 49) as f64;

/// The fraction of the way to its face's centre by which a hit is moved. It is more than the edges'
/// tolerance, and less than any picture shows. A ray that starts there starts strictly inside the face, so
/// it cannot slip past a neighbour that meets it at that edge.
pub const INWARD: f64 = 1.0 / (1_u64 << 32) as f64;

/// Most pairs of a plane and a corner that are compared: enough for scenes whose planes are all tested for
/// each ray.
const MOST_COMPARED: usize = 1 << 24;

/// A convex polygon or a disc on a plane: the points that pass all half-plane edge tests and, for a disc, its
/// own.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The face's number in the order of the scene.
    pub label: u32,
    /// True if the face emits.
    pub emits: bool,
    /// True if the face emits nothing and a later face of its plane emits, which this one hides where
    /// they overlap.
    pub hides_emitter: bool,
    /// Number of emitting faces of its plane before the first that this one may cover, if any.
    pub covers: Option<u32>,
    /// The half-plane edge tests. Pairs of parallel edges share one: two for a parallelogram, three
    /// for a triangle.
    pub edge_tests: Vec<EdgeTest>,
    /// The test of a disc, whose square has two edge tests.
    pub disc: Option<Box<DiscTest>>,
}

impl Face {
    /// True if a search for emitters meets the face: it emits, or hides an emitter of its plane.
    pub fn is_asked_first(&self) -> bool {
        self.emits || self.hides_emitter
    }
}

/// The planes so far, by the bucket of their coefficients and offset.
#[derive(Default)]
struct KnownPlanes {
    /// The first plane of each bucket.
    first: HashMap<[i64; 3], u32>,
    /// For each plane, the next one of its bucket, or [`NO_PLANE`].
    next: Vec<u32>,
}

impl KnownPlanes {
    /// The planes of the bucket `key`, the oldest first.
    fn in_bucket(&self, key: &[i64; 3]) -> impl Iterator<Item = u32> + '_ {
        let next = |plane: &u32| self.next[*plane as usize];
        let next = move |plane: &u32| Some(next(plane)).filter(|plane| *plane != NO_PLANE);
        std::iter::successors(self.first.get(key).copied(), next)
    }

    /// Adds plane number `plane`, the number of planes so far, to the bucket `key`.
    fn add(&mut self, key: [i64; 3], plane: u32) {
        match self.first.entry(key) {
            Entry::Vacant(entry) => _ = entry.insert(plane),
            Entry::Occupied(entry) => {
                let mut last = *entry.get() as usize;
                while self.next[last] != NO_PLANE {
                    last = self.next[last] as usize;
                }
                self.next[last] = plane;
            }
        }
        self.next.push(NO_PLANE);
    }
}

/// The numbers of a face's tests.
fn numbers(face: &Face) -> impl Iterator<Item = f64> {
    let tests = face.edge_tests.iter();
    let tests = tests.flat_map(|test| [test.form[0], test.form[1], test.low, test.high]);
    tests.chain(face.disc.iter().map(|disc| disc.square))
}

/// Leaves out all copies of a face but the first, which hides them. All `faces` are on one plane.
fn leave_out_copies(faces: &mut Vec<Face>) {
    if faces.len() < 2 {
        return;
    }
    let compare = |a: &Face, b: &Face| {
        let by_numbers = numbers(a).partial_cmp(numbers(b));
        by_numbers.unwrap_or(Ordering::Equal)
    };
    let mut order: Vec<usize> = (0..faces.len()).collect();
    // Copies come one after the other, the first of the scene first.
    order.sort_by(|&a, &b| compare(&faces[a], &faces[b]));
    let outline = |place: usize| (&faces[place].edge_tests, &faces[place].disc);
    let is_copy = |pair: &&[usize]| outline(pair[0]) == outline(pair[1]);
    let copies = order.windows(2).filter(is_copy).map(|pair| pair[1]);
    let copies: HashSet<u32> = copies.map(|copy| faces[copy].label).collect();
    faces.retain(|face| !copies.contains(&face.label));
}

/// All polygons of a scene, in stage units.
#[derive(Clone, Debug, PartialEq)]
pub struct StageGeometry {
    /// Distinct planes by main axis, then by tilt and offset: an order that does not
    /// depend on that of the scene's list.
    pub planes: Vec<Plane>,
    /// The planes with main axis x, y, z.
    pub by_axis: [Range<usize>; 3],
    /// The planes of each main axis that have an emitting face.
    pub emitting: [Vec<usize>; 3],
    /// Faces, grouped by plane, in the order of the scene: where faces of one plane overlap, the
    /// one listed first wins.
    pub faces: Vec<Face>,
    /// The unit normal of each label's front; zeros for a sphere.
    pub(crate) normals: Vec<[f64; 3]>,
    /// The tangent, bitangent and centre of each label; zeros for a sphere, whose frame depends on the hit.
    pub(crate) frames: Vec<[f64; 9]>,
    /// The plane of each face label; for a sphere [`StageBall::number`].
    pub plane_of: Vec<u32>,
    /// The corners of each polygon's label.
    pub corners: Corners,
    /// The point of the scene that is the stage's origin.
    pub centre: DVec3,
    /// Stage units per scene unit: a power of two.
    pub scale: f64,
    /// The outward tolerance of edges in stage units: [`TOLERANCE`], or more if rays start far away and
    /// arrive less precisely.
    pub tolerance: f64,
    /// Number of faces that emit, spheres included, and of suns.
    pub emitters: u32,
    /// The number of the sun among the emitters, after all others.
    pub sun: Option<u32>,
    /// The spheres, in the order of the scene.
    pub balls: Vec<StageBall>,
}

impl StageGeometry {
    /// Prepares faces for intersection. `emits` is true for surfaces that emit. `reach` are further
    /// points from which rays start (the eye).
    pub fn new(
        polygons: &[Polygon],
        balls: &[Ball],
        emits: impl Fn(u32) -> bool,
        reach: &[DVec3],
    ) -> Self {
        let corners = polygons.iter().flat_map(|polygon| polygon.vertices);
        let around = balls.iter().flat_map(Ball::corners);
        let (centre, scale) = stage_units(corners.chain(around));
        let staged = |p: DVec3| (p - centre) * scale;
        let far = reach
            .iter()
            .map(|&p| staged(p).abs().max_element())
            .fold(1.0, f64::max);
        let tolerance = TOLERANCE * far;
        let mut geometry = Self {
            planes: Vec::new(),
            by_axis: [0..0, 0..0, 0..0],
            emitting: [Vec::new(), Vec::new(), Vec::new()],
            faces: Vec::new(),
            normals: Vec::with_capacity(polygons.len() + balls.len()),
            frames: Vec::with_capacity(polygons.len() + balls.len()),
            plane_of: Vec::with_capacity(polygons.len() + balls.len()),
            corners: Corners::new(polygons, staged),
            centre,
            scale,
            tolerance,
            emitters: 0,
            sun: None,
            balls: Vec::with_capacity(balls.len()),
        };
        let mut faces = Vec::with_capacity(polygons.len());
        let mut known = KnownPlanes::default();
        for (label, polygon) in polygons.iter().enumerate() {
            let corners = &geometry.corners[label];
            let frame = frame(corners);
            let plane = plane_of(corners, &frame);
            let (edge_tests, disc) = if polygon.disc {
                let (edge_tests, disc) = disc_tests(corners, plane.axis, tolerance);
                (edge_tests, Some(Box::new(disc)))
            } else {
                let edge_tests = edge_tests(corners, plane.axis, frame.centre, tolerance);
                (edge_tests, None)
            };
            let plane = geometry.find_plane(plane, &mut known);
            geometry.normals.push(frame.normal.to_array());
            geometry.frames.push(frame.row());
            geometry.plane_of.push(plane);
            faces.push(Some(Face {
                label: label as u32,
                emits: emits(polygon.surface),
                hides_emitter: false,
                covers: None,
                edge_tests,
                disc,
            }));
        }
        drop(known);
        geometry.place_balls(balls, emits);
        geometry.arrange(faces);
        geometry
    }

    /// Appends the spheres, after the planes of all polygons.
    fn place_balls(&mut self, balls: &[Ball], emits: impl Fn(u32) -> bool) {
        let [polygons, planes] = [self.corners.len(), self.planes.len()];
        for (place, ball) in balls.iter().enumerate() {
            let number = (planes + place) as u32;
            self.normals.push([0.0; 3]);
            self.frames.push([0.0; 9]);
            self.plane_of.push(number);
            self.balls.push(StageBall {
                centre: (ball.centre - self.centre) * self.scale,
                radius: ball.radius * self.scale,
                label: (polygons + place) as u32,
                number,
                emitter: emits(ball.surface).then_some(0),
            });
        }
    }

    /// The greatest distance of a point of the geometry from the origin, in stage units.
    pub fn radius(&self) -> f64 {
        self.points().map(DVec3::length).fold(0.0, f64::max)
    }

    /// Adds a sun to the emitters.
    pub(super) fn add_sun(&mut self) {
        self.sun = Some(self.emitters);
        self.emitters += 1;
    }

    /// The corners of all polygons, and of the boxes around the spheres.
    pub(super) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let corners = self.corners.points().iter().copied();
        corners.chain(self.balls.iter().flat_map(StageBall::corners))
    }

    /// Points of the scene, in stage units.
    pub(super) fn staged(&self, points: &[DVec3]) -> Vec<DVec3> {
        let staged = |&point: &DVec3| (point - self.centre) * self.scale;
        points.iter().map(staged).collect()
    }

    /// The unit normal of the front of polygon `label`.
    pub(crate) fn normal(&self, label: usize) -> DVec3 {
        self.normals[label].into()
    }

    /// The shading frame of polygon `label`.
    pub fn frame(&self, label: usize) -> FaceFrame {
        FaceFrame::new(self.normals[label], &self.frames[label])
    }

    /// The faces on plane number `plane`.
    pub fn faces_of(&self, plane: usize) -> &[Face] {
        &self.faces[self.planes[plane].faces.clone()]
    }

    /// Returns the number of the plane `new`, which is added if it is not known.
    fn find_plane(&mut self, new: Plane, known: &mut KnownPlanes) -> u32 {
        // Buckets are so narrow that few distinct planes share one. A plane near a bucket's edge is also
        // searched in the bucket beyond the edge.
        let width = SAME_PLANE * 16.0;
        let values = |plane: &Plane| [plane.form[0], plane.form[1], plane.offset];
        let bucket = |k: usize, shift: f64| ((values(&new)[k] + shift) / width).floor() as i64;
        let sides = [0, 1, 2].map(|k| [-SAME_PLANE, SAME_PLANE].map(|shift| bucket(k, shift)));
        let key = |[a, b, c]: [i64; 3]| [new.axis as i64 + 3 * a, b, c];
        let same = |plane: &Plane| {
            let pairs = values(plane).into_iter().zip(values(&new));
            plane.axis == new.axis && pairs.into_iter().all(|(a, b)| (a - b).abs() <= SAME_PLANE)
        };
        for code in 0..8_usize {
            let is_far = [0, 1, 2].map(|k| code >> k & 1);
            // A side that is in the bucket of the other one has been searched with it.
            if (0..3).any(|k| is_far[k] == 1 && sides[k][0] == sides[k][1]) {
                continue;
            }
            let key = key([0, 1, 2].map(|k| sides[k][is_far[k]]));
            let mut found = known.in_bucket(&key);
            if let Some(plane) = found.find(|&n| same(&self.planes[n as usize])) {
                return plane;
            }
        }
        let plane = self.planes.len() as u32;
        known.add(key([0, 1, 2].map(|k| bucket(k, 0.0))), plane);
        self.planes.push(new);
        plane
    }

    /// The numbers of the planes on which all `points` lie, within rounding.
    pub(super) fn planes_through(&self, points: &[DVec3]) -> Vec<u32> {
        let through = |plane: &Plane| points.iter().all(|point| plane.passes(point.to_array()));
        let planes = (0..).zip(&self.planes);
        let planes = planes.filter(|(_, plane)| !points.is_empty() && through(plane));
        planes.map(|(number, _)| number).collect()
    }

    /// Moves planes that pass by `point` within rounding onto it, so that a ray from there does not
    /// meet the wall where it starts.
    pub(super) fn pass_through(&mut self, point: [f64; 3]) {
        for plane in &mut self.planes {
            if plane.passes(point) {
                plane.offset = plane.height(point);
            }
        }
    }

    /// Finds the faces that hide or may cover a later face that emits. All `faces` are on one plane, whose
    /// main axis is `axis`.
    fn cover(&self, axis: usize, faces: &mut [Face]) {
        let outline = |face: &Face| &self.corners[face.label as usize];
        let emitting: Vec<usize> = (0..faces.len()).filter(|&n| faces[n].emits).collect();
        let Some(&last) = emitting.last() else {
            return;
        };
        let overlap = !fill_once(axis, faces.iter().map(outline));
        let outlines = || emitting.iter().map(|&n| outline(&faces[n])).collect();
        let mut outlines = overlap.then(|| Outlines::new(axis, outlines()));
        for (number, face) in faces.iter_mut().enumerate().rev() {
            let covered = outlines.as_mut().and_then(|outlines| {
                outlines.ask_from(emitting.partition_point(|&other| other <= number));
                outlines.first_overlapped(&self.corners[face.label as usize])
            });
            face.covers = covered.map(|covered| covered as u32);
            face.hides_emitter = !face.emits && number < last;
        }
    }

    /// The labels of all polygons by plane, in the order of the scene, and the end of each plane's labels.
    fn labels_by_plane(&self) -> (Vec<u32>, Vec<usize>) {
        let polygons = &self.plane_of[..self.corners.len()];
        let mut ends = vec![0; self.planes.len() + 1];
        for &plane in polygons {
            ends[plane as usize + 1] += 1;
        }
        for plane in 1..ends.len() {
            ends[plane] += ends[plane - 1];
        }
        let mut labels = vec![0; polygons.len()];
        for (label, &plane) in (0..).zip(polygons) {
            let next = &mut ends[plane as usize];
            labels[*next] = label;
            *next += 1;
        }
        // Each start has become an end.
        ends.pop();
        (labels, ends)
    }

    /// Sorts planes by main axis and tilt, and lays their faces out in that order. `faces` has the face of each
    /// polygon.
    fn arrange(&mut self, mut faces: Vec<Option<Face>>) {
        let mut order: Vec<usize> = (0..self.planes.len()).collect();
        order.sort_by(|&a, &b| self.planes[a].cmp_tilt(&self.planes[b]));
        let mut place = vec![0; order.len()];
        let mut planes = Vec::with_capacity(order.len());
        let (labels, ends) = self.labels_by_plane();
        self.faces.reserve_exact(faces.len());
        let mut own = Vec::new();
        for (new, &old) in order.iter().enumerate() {
            place[old] = new as u32;
            let start = self.faces.len();
            let first = old.checked_sub(1).map_or(0, |before| ends[before]);
            let labels = labels[first..ends[old]].iter();
            own.extend(labels.filter_map(|&label| faces[label as usize].take()));
            leave_out_copies(&mut own);
            self.cover(self.planes[old].axis, &mut own);
            self.faces.append(&mut own);
            let faces = start..self.faces.len();
            let emitting = self.faces[start..].iter().filter(|face| face.emits);
            let emitters = self.emitters..self.emitters + emitting.count() as u32;
            self.emitters = emitters.end;
            planes.push(Plane {
                faces,
                emitters,
                ..self.planes[old].clone()
            });
        }
        self.planes = planes;
        // Numbers of spheres follow those of all planes, in any order of these.
        for plane in &mut self.plane_of[..self.corners.len()] {
            *plane = place[*plane as usize];
        }
        for emitter in self
            .balls
            .iter_mut()
            .filter_map(|ball| ball.emitter.as_mut())
        {
            *emitter = self.emitters;
            self.emitters += 1;
        }
        let first = |axis: usize| self.planes.partition_point(|plane| plane.axis < axis);
        self.by_axis = [0, 1, 2].map(|axis| first(axis)..first(axis + 1));
        let emits = |plane: &usize| self.faces_of(*plane).iter().any(|face| face.emits);
        self.emitting = self
            .by_axis
            .clone()
            .map(|range| range.filter(emits).collect());
        self.find_outermost();
    }

    /// Finds the planes that have the whole scene on one side.
    fn find_outermost(&mut self) {
        let corners: Vec<[f64; 3]> = self.points().map(|point| point.to_array()).collect();
        if self.planes.len() * corners.len() > MOST_COMPARED {
            return;
        }
        for plane in &mut self.planes {
            let height = |corner: &[f64; 3]| plane.height(*corner) - plane.offset;
            let outermost = corners.iter().all(|corner| height(corner) <= SAME_PLANE)
                || corners.iter().all(|corner| height(corner) >= -SAME_PLANE);
            plane.outermost = outermost;
        }
    }
}
