//! Building the tree: a binary tree by a binned surface area heuristic, then nodes of up to eight
//! children that cover it at the least cost (Ylitie, Karras and Laine 2017).
//!
//! The faces of a leaf share a main axis, so that a packet permutes a ray's axes in one way only.

use super::{Child, FACES, Node, WIDE};
use glam::DVec3;
use qrt_tracer::{StageBall, StageGeometry};

/// Number of levels of the binary tree that follow the heuristic; deeper parts are halved.
const FREE_DEPTH: usize = 32;

/// Most bins per axis. The planes between them are the candidates for a cut.
const BINS: usize = 32;

/// Least distance by which boxes reach beyond their faces, in stage units: more than the rounding
/// of a crossing. Boxes also reach several edge tolerances beyond their faces.
const MARGIN: f64 = 1.0 / (1_u64 << 36) as f64;

#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn centre(self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Half the surface area.
    pub(super) fn area(self) -> f64 {
        let e = (self.high - self.low).max(DVec3::ZERO);
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

/// The tree, and the faces (by place in [`StageGeometry::faces`]) of each leaf.
pub(super) struct Tree {
    /// The least and the greatest corner.
    pub(super) bounds: [[f64; 3]; 2],
    pub(super) nodes: Vec<Node>,
    pub(super) levels: usize,
    pub(super) leaves: Vec<Leaf>,
    /// The spheres of each leaf, by their places after all faces.
    pub(super) balls: Vec<Leaf>,
}

/// The faces of a leaf.
#[derive(Clone, Copy)]
pub(super) struct Leaf {
    faces: [u32; FACES],
    count: u8,
}

impl Leaf {
    /// The numbers of the faces.
    pub(super) fn faces(&self) -> &[u32] {
        &self.faces[..usize::from(self.count)]
    }
}

/// The main axis that stands for spheres, which have none.
const ROUND: u8 = 3;
/// Kinds of packets: main axes, and spheres.
const KINDS: usize = 4;

/// The boxes of all faces and spheres.
pub(super) fn boxes(geometry: &StageGeometry) -> Vec<Bounds> {
    let margin = DVec3::splat(MARGIN.max(16.0 * geometry.tolerance));
    let of_face = |label: u32| {
        let corners = &geometry.corners[label as usize];
        let around = corners.iter().fold(Bounds::EMPTY, |bounds, &corner| {
            bounds.with(Bounds {
                low: corner,
                high: corner,
            })
        });
        // The margin includes the same fraction of a far corner's coordinates, for planes that were
        // averaged.
        let margin = margin * (1.0 + around.high.abs().max(around.low.abs()).max_element());
        Bounds {
            low: around.low - margin,
            high: around.high + margin,
        }
    };
    let of_ball = |ball: &StageBall| {
        let margin = margin * (1.0 + ball.centre.abs().max_element() + ball.radius);
        Bounds {
            low: ball.centre - ball.radius - margin,
            high: ball.centre + ball.radius + margin,
        }
    };
    let faces = geometry.faces.iter().map(|face| of_face(face.label));
    faces.chain(geometry.balls.iter().map(of_ball)).collect()
}

/// The main axes of all faces.
pub(super) fn axes(geometry: &StageGeometry) -> Vec<u8> {
    let mut axes = Vec::with_capacity(geometry.faces.len());
    for plane in &geometry.planes {
        axes.resize(plane.faces.end, plane.axis as u8);
    }
    axes.resize(geometry.faces.len() + geometry.balls.len(), ROUND);
    axes
}

/// Builds the tree over the faces with these `boxes` and main `axes`, except the faces in `large`,
/// whose numbers are in ascending order.
pub(super) fn tree(boxes: Vec<Bounds>, axes: &[u8], large: &[u32]) -> Tree {
    let numbered = (0..).zip(boxes.into_iter().zip(axes));
    let mut faces: Vec<Boxed> = numbered
        .filter(|(number, _)| large.binary_search(number).is_err())
        .map(|(number, (bounds, &axis))| Boxed {
            bounds,
            number,
            axis,
        })
        .collect();
    let bounds = around(faces.iter().map(|face| face.bounds));
    let mut tree = Tree {
        nodes: Vec::new(),
        levels: 0,
        leaves: Vec::new(),
        balls: Vec::new(),
        bounds: [bounds.low.to_array(), bounds.high.to_array()],
    };
    if !faces.is_empty() {
        let mut halving = Halving { parts: Vec::new() };
        let (root, _) = halving.part(&mut faces, 0);
        tree.node(&halving.parts, root, 1);
    }
    tree
}

/// A face or sphere with its box. Those of one part of the tree stand side by side in memory.
#[derive(Clone, Copy)]
struct Boxed {
    bounds: Bounds,
    number: u32,
    axis: u8,
}

/// A part of the binary tree: some of the faces.
struct Subtree {
    bounds: Bounds,
    content: Content,
}

enum Content {
    /// One packet: its faces and their main axis.
    Packet(Leaf, u8),
    /// Two parts, by their numbers. The second entry is indexed by the number of children that a
    /// node has left for both: the number of these that the first part gets at the least cost. If
    /// it is 0, both parts together are one child: a node.
    Halves([u32; 2], [u8; WIDE + 1]),
}

/// The binary tree, while it grows.
struct Halving {
    parts: Vec<Subtree>,
}

/// Costs of a part for a ray through the root, up to a factor: by the number of children of one
/// node that may hold the part, from one on.
type Costs = [f64; WIDE + 1];

impl Halving {
    /// Creates the part of `faces`; returns its number and its costs. `depth` counts the halvings
    /// above it.
    fn part(&mut self, faces: &mut [Boxed], depth: usize) -> (u32, Costs) {
        let bounds = around(faces.iter().map(|face| face.bounds));
        let axis = faces[0].axis;
        let one_axis = faces.iter().all(|face| face.axis == axis);
        let (content, costs) = if faces.len() <= FACES && one_axis {
            let mut leaf = Leaf {
                faces: [u32::MAX; FACES],
                count: faces.len() as u8,
            };
            for (number, face) in leaf.faces.iter_mut().zip(faces.iter()) {
                *number = face.number;
            }
            (Content::Packet(leaf, axis), [bounds.area(); WIDE + 1])
        } else {
            let middle = split(faces, depth);
            let (left, right) = faces.split_at_mut(middle);
            let (left, of_left) = self.part(left, depth + 1);
            let (right, of_right) = self.part(right, depth + 1);
            let (mut costs, mut shares) = ([f64::INFINITY; WIDE + 1], [0; WIDE + 1]);
            for children in 2..=WIDE {
                for share in 1..children {
                    let cost = of_left[share] + of_right[children - share];
                    if cost < costs[children] {
                        (costs[children], shares[children]) = (cost, share as u8);
                    }
                }
            }
            costs[1] = bounds.area() + costs[WIDE];
            for children in 2..WIDE {
                if costs[1] <= costs[children] {
                    (costs[children], shares[children]) = (costs[1], 0);
                }
            }
            (Content::Halves([left, right], shares), costs)
        };
        self.parts.push(Subtree { bounds, content });
        (self.parts.len() as u32 - 1, costs)
    }
}

/// Reorders `faces` and returns the position of the cut: both sides are non-empty.
fn split(faces: &mut [Boxed], depth: usize) -> usize {
    let centres = around(faces.iter().map(|face| {
        let centre = face.bounds.centre();
        Bounds {
            low: centre,
            high: centre,
        }
    }));
    let bins = Bins::new(centres, faces.len());
    let cut = (depth < FREE_DEPTH).then(|| bins.best_cut(faces));
    match cut.flatten() {
        Some(Cut::Plane(axis, bin)) => partition(faces, |face| bins.places(face)[axis] <= bin),
        Some(Cut::MainAxis(axis)) => partition(faces, |face| usize::from(face.axis) == axis),
        None => {
            // All centres are in one place, or the tree is too deep: cut into halves.
            let extent = centres.high - centres.low;
            let axis = (0..3)
                .max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
                .unwrap_or(0);
            let key = |face: &Boxed| face.bounds.centre()[axis];
            let middle = faces.len() / 2;
            faces.select_nth_unstable_by(middle, |a, b| {
                key(a).total_cmp(&key(b)).then(a.number.cmp(&b.number))
            });
            middle
        }
    }
}

/// Bins of equal width along each axis, into which the centres of boxes fall.
struct Bins {
    low: DVec3,
    /// Bins per unit of length; 0 along an axis on which all centres agree.
    per_unit: DVec3,
    /// Number of bins of each axis, at most [`BINS`].
    count: usize,
}

impl Bins {
    /// Creates the bins for `faces` faces whose centres are within `centres`.
    fn new(centres: Bounds, faces: usize) -> Self {
        let count = faces.clamp(4, BINS);
        let extent = centres.high - centres.low;
        let per_unit = DVec3::splat(count as f64) / extent;
        // The quotient is infinite if all centres are in one place, or nearly.
        let is_usable = per_unit.cmplt(DVec3::INFINITY);
        Self {
            low: centres.low,
            per_unit: DVec3::select(is_usable, per_unit, DVec3::ZERO),
            count,
        }
    }

    /// Returns the bin along each axis.
    fn places(&self, face: &Boxed) -> [usize; 3] {
        let places = (face.bounds.centre() - self.low) * self.per_unit;
        places
            .to_array()
            .map(|place| (place as usize).min(self.count - 1))
    }

    /// Returns the cut of least cost that has faces on both sides, if there is one.
    #[inline(never)] // Its bins would stand in each frame of the recursion.
    fn best_cut(&self, faces: &[Boxed]) -> Option<Cut> {
        let mut bins = [[Group::EMPTY; BINS]; 3];
        let mut kinds = [Group::EMPTY; KINDS];
        for face in faces {
            let group = Group::single(face);
            for (bins, bin) in bins.iter_mut().zip(self.places(face)) {
                bins[bin] = bins[bin].with(group);
            }
            let kind = &mut kinds[usize::from(face.axis)];
            *kind = kind.with(group);
        }
        let mut best: Option<(f64, Cut)> = None;
        let mut consider = |left: &Group, right: &Group, cut: Cut| {
            if left.packets() > 0.0 && right.packets() > 0.0 {
                let cost = left.cost() + right.cost();
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, cut));
                }
            }
        };
        for (axis, bins) in bins.iter().enumerate() {
            if self.per_unit[axis] <= 0.0 {
                continue;
            }
            let mut right = [Group::EMPTY; BINS];
            for bin in (0..self.count - 1).rev() {
                right[bin] = right[bin + 1].with(bins[bin + 1]);
            }
            let mut left = Group::EMPTY;
            for bin in 0..self.count - 1 {
                left = left.with(bins[bin]);
                consider(&left, &right[bin], Cut::Plane(axis, bin));
            }
        }
        for axis in 0..KINDS {
            let others = (0..KINDS).filter(|kind| *kind != axis);
            let others = others.fold(Group::EMPTY, |all, kind| all.with(kinds[kind]));
            consider(&kinds[axis], &others, Cut::MainAxis(axis));
        }
        best.map(|(_, cut)| cut)
    }
}

/// The faces on the left side of a cut.
#[derive(Clone, Copy)]
enum Cut {
    /// The faces whose centres lie, along an axis, in the bins up to this one.
    Plane(usize, usize),
    /// The faces with this main axis.
    MainAxis(usize),
}

/// Faces on one side of a cut: the box around them, and their number by main axis.
#[derive(Clone, Copy)]
struct Group {
    bounds: Bounds,
    counts: [u32; KINDS],
}

impl Group {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        counts: [0; KINDS],
    };

    fn single(face: &Boxed) -> Self {
        let mut counts = [0; KINDS];
        counts[usize::from(face.axis)] = 1;
        Self {
            bounds: face.bounds,
            counts,
        }
    }

    fn with(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.with(other.bounds),
            counts: std::array::from_fn(|kind| self.counts[kind] + other.counts[kind]),
        }
    }

    fn packets(&self) -> f64 {
        let packets = |count: u32| count.div_ceil(FACES as u32);
        f64::from(self.counts.map(packets).into_iter().sum::<u32>())
    }

    fn cost(&self) -> f64 {
        self.bounds.area() * self.packets()
    }
}

/// Moves the faces for which `left` is true to the front, and returns their number.
fn partition(faces: &mut [Boxed], left: impl Fn(&Boxed) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..faces.len() {
        if left(&faces[i]) {
            faces.swap(i, middle);
            middle += 1;
        }
    }
    middle
}

impl Tree {
    /// Adds a node over part `part` and returns its number. `level` counts the nodes from the root
    /// down to it.
    fn node(&mut self, parts: &[Subtree], part: u32, level: usize) -> u32 {
        let number = self.nodes.len() as u32;
        self.levels = self.levels.max(level);
        // Finite, so that no box test computes 0 times infinity.
        self.nodes.push(Node {
            boxes: [[[f32::MAX; WIDE]; 3], [[f32::MIN; WIDE]; 3]],
            children: [Child::Absent; WIDE],
        });
        let mut children = Vec::with_capacity(WIDE);
        children_of(parts, part, WIDE, &mut children);
        for (place, part) in children.into_iter().enumerate() {
            let Subtree { bounds, content } = &parts[part as usize];
            let child = match content {
                Content::Packet(leaf, ROUND) => {
                    self.balls.push(*leaf);
                    Child::Balls(self.balls.len() as u32 - 1)
                }
                Content::Packet(leaf, axis) => {
                    self.leaves.push(*leaf);
                    Child::Packet(self.leaves.len() as u32 - 1, *axis)
                }
                Content::Halves(..) => Child::Node(self.node(parts, part, level + 1)),
            };
            let node = &mut self.nodes[number as usize];
            node.children[place] = child;
            for axis in 0..3 {
                node.boxes[0][axis][place] = below(bounds.low[axis]);
                node.boxes[1][axis][place] = -below(-bounds.high[axis]);
            }
        }
        number
    }
}

/// Appends to `children` the parts that hold part `part` as at most `most` children of one node, at
/// the least cost.
fn children_of(parts: &[Subtree], part: u32, most: usize, children: &mut Vec<u32>) {
    match parts[part as usize].content {
        Content::Halves([left, right], shares) if shares[most] > 0 => {
            let share = usize::from(shares[most]);
            children_of(parts, left, share, children);
            children_of(parts, right, most - share, children);
        }
        Content::Packet(..) | Content::Halves(..) => children.push(part),
    }
}

/// Returns a single-precision number that is not above `number`.
fn below(number: f64) -> f32 {
    let single = number as f32;
    if f64::from(single) > number {
        single.next_down()
    } else {
        single
    }
}

pub(super) fn around(boxes: impl IntoIterator<Item = Bounds>) -> Bounds {
    boxes.into_iter().fold(Bounds::EMPTY, Bounds::with)
}
