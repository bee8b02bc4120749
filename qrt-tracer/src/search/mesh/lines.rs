//! Lines through meshes, in `f64`: the number of faces that a line meets.

use super::{ERROR, Facing, MeshPlan};
use crate::ray::Start;
use crate::search::planner::Planner;
use glam::DVec3;
use qrt_scene::sampling::pixel_shift;

/// Number of lines that are tried.
const LINES: u64 = 1 << 12;

/// Number of slots beyond the most faces that one of the lines may meet.
const SPARE: usize = 2;

/// Faces of a leaf of the tree.
const LEAF: usize = 4;

/// A box around some faces.
struct Node {
    low: DVec3,
    high: DVec3,
    /// The faces of a leaf, or the places of the two nodes below.
    kind: Kind,
}

enum Kind {
    Leaf(Vec<usize>),
    Inner([usize; 2]),
}

/// A tree of boxes around the faces of a mesh, for lines that reach in both directions.
struct Tree<'a> {
    plan: &'a MeshPlan,
    outlines: Vec<&'a [DVec3]>,
    nodes: Vec<Node>,
    /// The error of an edge's number.
    error: f64,
}

/// Returns true if the line passes all edges on the side of the face's front, false if it passes all on the
/// other side. None if it misses the face.
pub(super) fn met_front(outline: &[DVec3], origin: DVec3, direction: DVec3) -> Option<bool> {
    let mut signs = [false; 2];
    for (k, &a) in outline.iter().enumerate() {
        let b = outline[(k + 1) % outline.len()];
        let side = direction.dot((a - origin).cross(b - origin));
        signs[0] |= side < 0.0;
        signs[1] |= side > 0.0;
    }
    match signs {
        [true, false] => Some(true),
        [false, true] => Some(false),
        _ => None,
    }
}

impl<'a> Tree<'a> {
    fn new(plan: &'a MeshPlan, outlines: Vec<&'a [DVec3]>, ulp: f64) -> Self {
        let all = (0..outlines.len()).collect();
        let mut tree = Self {
            plan,
            outlines,
            nodes: Vec::new(),
            error: ERROR * ulp,
        };
        tree.add(all);
        tree
    }

    fn add(&mut self, mut faces: Vec<usize>) -> usize {
        let corners = || faces.iter().flat_map(|&face| self.outlines[face]).copied();
        let low = corners().fold(DVec3::INFINITY, DVec3::min) - 8.0 * self.error;
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max) + 8.0 * self.error;
        let place = self.nodes.len();
        let kind = Kind::Leaf(Vec::new());
        self.nodes.push(Node { low, high, kind });
        let kind = if faces.len() <= LEAF {
            Kind::Leaf(faces)
        } else {
            let extent = high - low;
            let axis = (0..3).fold(0, |best, axis| {
                if extent[axis] > extent[best] {
                    axis
                } else {
                    best
                }
            });
            let outlines = &self.outlines;
            let middle = |face: usize| outlines[face].iter().map(|p| p[axis]).sum::<f64>();
            let half = faces.len() / 2;
            faces.select_nth_unstable_by(half, |&a, &b| middle(a).total_cmp(&middle(b)));
            let second = faces.split_off(half);
            Kind::Inner([self.add(faces), self.add(second)])
        };
        self.nodes[place].kind = kind;
        place
    }

    /// Number of faces that a circuit may find on the line.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> usize {
        let mut count = 0;
        let mut open = vec![0];
        while let Some(place) = open.pop() {
            let node = &self.nodes[place];
            let ends = [node.low, node.high].map(|end| (end - origin) / direction);
            let enters = ends[0].min(ends[1]).max_element();
            let leaves = ends[0].max(ends[1]).min_element();
            // NaN, of a line in a side of the box, passes.
            if enters > leaves {
                continue;
            }
            match &node.kind {
                Kind::Inner(below) => open.extend(below),
                Kind::Leaf(faces) => {
                    let met = |&&face: &&usize| self.may_meet(face, origin, direction);
                    count += faces.iter().filter(met).count();
                }
            }
        }
        count
    }

    fn may_meet(&self, face: usize, origin: DVec3, direction: DVec3) -> bool {
        let face = &self.plan.faces[face];
        let across = origin.cross(direction);
        let passes = |back: bool| {
            face.edges.iter().all(|&(edge, turned)| {
                let edge = &self.plan.edges[edge];
                let u = direction.dot(edge.moment.into()) + across.dot(edge.along.into());
                if turned == back {
                    u < self.plan.reach + self.error
                } else {
                    u > -self.plan.reach - self.error
                }
            })
        };
        match face.facing {
            Facing::Front => passes(false),
            Facing::Back => passes(true),
            Facing::Both => passes(false) || passes(true),
        }
    }
}

/// Numbers that look random, the same in every run.
struct Random(usize);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 += 1;
        pixel_shift(0, 0, 0, self.0)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Three numbers from 0 to 1.
    fn vector(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.unit()))
    }

    /// A point of a convex polygon.
    fn point(&mut self, outline: &[DVec3]) -> DVec3 {
        let weights: Vec<f64> = outline.iter().map(|_| self.unit() + 1e-3).collect();
        let sum: f64 = weights.iter().sum();
        let pairs = outline.iter().zip(weights);
        pairs.map(|(corner, weight)| *corner * (weight / sum)).sum()
    }
}

/// Most faces of meshes whose slots suffice for all tried lines.
const LARGE: usize = 1 << 14;

/// Number of lines through larger meshes that may meet more faces than there are slots: one in a thousand. A slot takes
/// about a gate for each face, and a line along a surface of small faces may meet hundreds.
const GRAZING: usize = LINES as usize / 1024;

/// The number of slots for the faces of `plan`: [`SPARE`] more than the most that one of many lines may meet. Through
/// more than [`LARGE`] faces, the [`GRAZING`] lines that meet the most do not count.
/// The lines pass through points and corners of the faces, and through starts of rays. Lines of an
/// orthographic camera have its direction.
pub(super) fn most_crossings(plan: &MeshPlan, planner: &Planner<'_>, start: Start) -> usize {
    let geometry = planner.geometry;
    let outline = |label: u32| &geometry.corners[label as usize];
    let tree = Tree::new(plan, plan.labels().map(outline).collect(), planner.ulp);
    let [low, high] = planner.eye_box();
    let starts = geometry.faces.len() + geometry.balls.len();
    let mut random = Random(0);
    let mut counts = Vec::with_capacity(LINES as usize);
    for number in 0..LINES {
        let mut any = |count: usize| (random.next() % count as u64) as usize;
        let aimed = tree.outlines[any(tree.outlines.len())];
        let left = any(starts);
        let through = if number % 4 == 0 {
            aimed[any(aimed.len())]
        } else {
            random.point(aimed)
        };
        let origin = match start {
            Start::Camera => low + (high - low) * random.vector(),
            Start::Surface => {
                if let Some(face) = geometry.faces.get(left) {
                    random.point(outline(face.label))
                } else {
                    let ball = &geometry.balls[left - geometry.faces.len()];
                    let away = (random.vector() - 0.5).normalize_or_zero();
                    ball.centre + ball.radius * away
                }
            }
        };
        let direction = match (start, planner.parallel) {
            (Start::Camera, Some(parallel)) => parallel,
            _ => through - origin,
        };
        let (origin, direction) = (through, direction.normalize_or_zero());
        if direction != DVec3::ZERO {
            counts.push(tree.crossings(origin, direction));
        }
    }
    counts.sort_unstable();
    let skipped = if plan.faces.len() > LARGE { GRAZING } else { 0 };
    let most = counts.iter().rev().nth(skipped).copied().unwrap_or(0);
    (most + SPARE).min(plan.faces.len())
}

/// Most pairs of a line and a face that [`outer_side`] tests.
const MOST_TESTED: usize = 1 << 24;

/// Finds the outer side of a closed surface: true if lines from outside meet fronts and backs in turn, fronts
/// first; false if backs come first. `None` if neither holds for all of some lines: the surface crosses
/// itself.
pub(super) fn outer_side(outlines: &[&[DVec3]]) -> Option<bool> {
    let lines = (MOST_TESTED / outlines.len().max(1)).clamp(32, 128);
    let mut random = Random(0);
    let mut side = None;
    for _ in 0..lines {
        let mut any = || outlines[(random.next() % outlines.len() as u64) as usize];
        let aimed = [any(), any()];
        let [through, from] = aimed.map(|outline| random.point(outline));
        let direction = (through - from).normalize_or_zero();
        let mut met: Vec<(f64, bool)> = Vec::new();
        let mut is_clear = direction != DVec3::ZERO;
        for outline in outlines {
            let Some(front) = met_front(outline, through, direction) else {
                continue;
            };
            let normal = (outline[1] - outline[0]).cross(outline[2] - outline[0]);
            let slope = direction.dot(normal);
            is_clear &= slope.abs() > 1e-6 * normal.length();
            met.push(((outline[0] - through).dot(normal) / slope, front));
        }
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Lines along a face or past an edge have no clear order.
        if !is_clear || met.windows(2).any(|pair| pair[1].0 - pair[0].0 < 1e-9) {
            continue;
        }
        for (place, (_, front)) in met.iter().enumerate() {
            let outer = *front == (place % 2 == 0);
            if *side.get_or_insert(outer) != outer {
                return None;
            }
        }
    }
    side
}

/// True if the closed surface of these outlines encloses the point, or passes near it: a line from the
/// point crosses it an odd number of times.
pub(super) fn encloses<'a>(
    outlines: impl Iterator<Item = &'a [DVec3]>,
    point: DVec3,
    ulp: f64,
) -> bool {
    // No edge of a scene has this direction.
    let direction = DVec3::new(0.615_234_917, 0.493_817_263, 0.614_327_811).normalize();
    let mut inside = false;
    for outline in outlines {
        let normal = (outline[1] - outline[0]).cross(outline[2] - outline[0]);
        let height = (outline[0] - point).dot(normal);
        if height.abs() <= 4.0 * ulp * normal.length()
            && qrt_scene::lights::polygon_distance(outline, point) <= 4.0 * ulp
        {
            return true;
        }
        if met_front(outline, point, direction).is_some() && height / direction.dot(normal) > 0.0 {
            inside = !inside;
        }
    }
    inside
}
