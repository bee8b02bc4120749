//! Building the tree: binned surface area heuristic, then eight children a node.
//!
//! The faces of a leaf share a main axis, so that a packet sees a ray with its axes permuted in one
//! way only. Of a smooth mesh's leaves most do by themselves.

use super::{Child, FACES, Node, WIDE};
use glam::DVec3;
use qrt_core::tracer::Geometry;

/// Levels of the binary tree that may follow the heuristic; below, parts are halved.
const FREE_DEPTH: usize = 32;

/// Candidate planes per axis.
const BINS: usize = 32;

/// How far boxes reach beyond their faces at least, in stage units: more than the rounding of a
/// crossing. Beyond that they reach several of the edges' tolerances.
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

/// The tree, and the faces (by place in [`Geometry::faces`]) of each leaf.
pub(super) struct Tree {
    /// The least and the greatest corner.
    pub(super) bounds: [[f64; 3]; 2],
    pub(super) nodes: Vec<Node>,
    pub(super) levels: usize,
    pub(super) leaves: Vec<Vec<u32>>,
}

/// The boxes of all faces.
pub(super) fn boxes(geometry: &Geometry) -> Vec<Bounds> {
    let margin = DVec3::splat(MARGIN.max(16.0 * geometry.tolerance));
    let of_face = |label: u32| {
        let corners = &geometry.corners[label as usize];
        let around = corners.iter().fold(Bounds::EMPTY, |bounds, &corner| {
            bounds.with(Bounds {
                low: corner,
                high: corner,
            })
        });
        // The same fraction of a far corner's coordinates, for planes that were averaged.
        let margin = margin * (1.0 + around.high.abs().max(around.low.abs()).max_element());
        Bounds {
            low: around.low - margin,
            high: around.high + margin,
        }
    };
    geometry
        .faces
        .iter()
        .map(|face| of_face(face.label))
        .collect()
}

/// The main axes of all faces.
pub(super) fn axes(geometry: &Geometry) -> Vec<u8> {
    let mut axes = Vec::with_capacity(geometry.faces.len());
    for plane in &geometry.planes {
        axes.resize(plane.faces.end, plane.axis as u8);
    }
    axes
}

/// The tree over those of the faces with these `boxes` and main `axes` that are not `large`, whose numbers
/// are in order.
pub(super) fn tree(boxes: &[Bounds], axes: &[u8], large: &[u32]) -> Tree {
    let all = 0..boxes.len() as u32;
    let mut faces: Vec<u32> = all
        .filter(|face| large.binary_search(face).is_err())
        .collect();
    let bounds = around(boxes, &faces);
    let mut tree = Tree {
        nodes: Vec::new(),
        levels: 0,
        leaves: Vec::new(),
        bounds: [bounds.low.to_array(), bounds.high.to_array()],
    };
    if !faces.is_empty() {
        tree.node(boxes, axes, &mut faces, [0, 1]);
    }
    tree
}

/// Whether `faces` make one packet.
fn fit(axes: &[u8], faces: &[u32]) -> bool {
    let axis = |face: u32| axes[face as usize];
    faces.len() <= FACES && faces.iter().all(|&face| axis(face) == axis(faces[0]))
}

impl Tree {
    /// A node over `faces`, whose number it returns. `depth` is the number of binary splits
    /// above it, and `level` that of nodes down to it.
    fn node(
        &mut self,
        boxes: &[Bounds],
        axes: &[u8],
        faces: &mut [u32],
        [depth, level]: [usize; 2],
    ) -> u32 {
        let number = self.nodes.len() as u32;
        self.levels = self.levels.max(level);
        // Finite, so that no box's test has 0 times infinity.
        self.nodes.push(Node {
            boxes: [[[f32::MAX; WIDE]; 3], [[f32::MIN; WIDE]; 3]],
            children: [Child::Absent; WIDE],
        });
        // Split the largest part again and again until there are eight.
        let mut parts = vec![(faces, depth)];
        while parts.len() < WIDE {
            let largest = (0..parts.len())
                .filter(|&part| !fit(axes, parts[part].0))
                .max_by(|&a, &b| cost(boxes, parts[a].0).total_cmp(&cost(boxes, parts[b].0)));
            let Some(largest) = largest else { break };
            let (part, depth) = parts.swap_remove(largest);
            let middle = if part.len() <= FACES {
                split_by_axis(axes, part)
            } else {
                split(boxes, part, depth)
            };
            let (left, right) = part.split_at_mut(middle);
            parts.push((left, depth + 1));
            parts.push((right, depth + 1));
        }
        for (place, (part, depth)) in parts.into_iter().enumerate() {
            let bounds = around(boxes, part);
            let child = if fit(axes, part) {
                self.leaves.push(part.to_vec());
                Child::Packet(self.leaves.len() as u32 - 1, axes[part[0] as usize])
            } else {
                Child::Node(self.node(boxes, axes, part, [depth, level + 1]))
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

/// A number of single precision that is not above this one.
fn below(number: f64) -> f32 {
    let single = number as f32;
    if f64::from(single) > number {
        single.next_down()
    } else {
        single
    }
}

pub(super) fn around(boxes: &[Bounds], faces: &[u32]) -> Bounds {
    faces.iter().fold(Bounds::EMPTY, |bounds, &face| {
        bounds.with(boxes[face as usize])
    })
}

fn cost(boxes: &[Bounds], faces: &[u32]) -> f64 {
    around(boxes, faces).area() * faces.len() as f64
}

/// Reorders `faces`, which don't share a main axis, and returns where to cut them: those on the
/// first one's axis come first.
fn split_by_axis(axes: &[u8], faces: &mut [u32]) -> usize {
    let axis = |face: u32| axes[face as usize];
    let first = axis(faces[0]);
    faces.sort_by_key(|&face| (axis(face) != first, face));
    faces.partition_point(|&face| axis(face) == first)
}

/// Reorders `faces` and returns where to cut them: both sides are non-empty.
fn split(boxes: &[Bounds], faces: &mut [u32], depth: usize) -> usize {
    let centres = faces.iter().fold(Bounds::EMPTY, |bounds, &face| {
        let centre = boxes[face as usize].centre();
        bounds.with(Bounds {
            low: centre,
            high: centre,
        })
    });
    let extent = centres.high - centres.low;
    if depth < FREE_DEPTH
        && let Some((axis, bin)) = best_plane(boxes, faces, centres)
    {
        let is_left = |face: u32| bin_of(boxes[face as usize].centre()[axis], centres, axis) <= bin;
        let mut middle = 0;
        for i in 0..faces.len() {
            if is_left(faces[i]) {
                faces.swap(i, middle);
                middle += 1;
            }
        }
        return middle;
    }
    // Centres in one place, or a tree too deep: halves.
    let axis = (0..3)
        .max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
        .unwrap_or(0);
    let middle = faces.len() / 2;
    let key = |face: u32| boxes[face as usize].centre()[axis];
    faces.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    middle
}

fn bin_of(centre: f64, centres: Bounds, axis: usize) -> usize {
    let fraction = (centre - centres.low[axis]) / (centres.high[axis] - centres.low[axis]);
    ((fraction * BINS as f64) as usize).min(BINS - 1)
}

/// The axis and last bin of the left side whose cut costs least.
fn best_plane(boxes: &[Bounds], faces: &[u32], centres: Bounds) -> Option<(usize, usize)> {
    let packets = |count: usize| count.div_ceil(FACES) as f64;
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in 0..3 {
        if centres.high[axis] <= centres.low[axis] {
            continue;
        }
        let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
        for &face in faces {
            let bounds = boxes[face as usize];
            let (around, count) = &mut bins[bin_of(bounds.centre()[axis], centres, axis)];
            *around = around.with(bounds);
            *count += 1;
        }
        let mut right = [(Bounds::EMPTY, 0_usize); BINS];
        for bin in (0..BINS - 1).rev() {
            let (bounds, count) = right[bin + 1];
            right[bin] = (bounds.with(bins[bin + 1].0), count + bins[bin + 1].1);
        }
        let mut left = (Bounds::EMPTY, 0);
        for bin in 0..BINS - 1 {
            left = (left.0.with(bins[bin].0), left.1 + bins[bin].1);
            if left.1 == 0 || right[bin].1 == 0 {
                continue;
            }
            let cost =
                left.0.area() * packets(left.1) + right[bin].0.area() * packets(right[bin].1);
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, bin));
            }
        }
    }
    best.map(|(_, axis, bin)| (axis, bin))
}
