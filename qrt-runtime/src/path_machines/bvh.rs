//! A bounding volume hierarchy in front of the tracer's own intersection routine.
//!
//! Trying every face is what the circuit does, and what the real machine does while faces are few.
//! For a mesh, the hierarchy narrows the faces down: a ray walks a tree of boxes, eight to a node,
//! and the search tries only the faces of the leaves that the ray reaches, four at once. All rays
//! first try a few large faces, for example a room's walls; a ray that comes near nothing else
//! walks no tree. Every trial runs through [`qrt_tracer::cross`] with the same constants.
//! Ties go to the face that a loop over all faces would keep. Therefore the result is that of the
//! loop, bit for bit.

mod approach;
mod balls;
mod beam;
mod build;
mod large;
mod packet;
mod rays;
mod walk;

use super::lanes::Lanes;
use balls::BallPacket;
use large::LargeFace;
use packet::Packet;
use qrt_tracer::{Arith, Hit, NO_FACE, NearestSearch, Ray, StageGeometry};
use rays::{Ends, FindNearest, FindOccluded, Scratch};
use std::cell::RefCell;
use std::ops::Range;

/// Number of boxes of a node.
const WIDE: usize = 8;

/// Number of faces of a packet.
const FACES: usize = 4;

/// Largest number of faces for which a loop over all of them is faster
/// (`cargo bench --bench tracing -- speed`).
pub(crate) const FEW_FACES: usize = 72;

/// Largest number of faces that emit or hide an emitter of their plane for which a path's last ray
/// tests these faces first.
const FEW_EMITTERS: usize = 16;

/// The children of a node: their boxes by corner and axis, and references to them.
#[derive(Clone, Debug)]
struct Node {
    /// `[low, high][axis][child]`, rounded outwards; the box of an absent child is empty.
    boxes: [[[f32; WIDE]; 3]; 2],
    children: [Child; WIDE],
}

/// The content of a node's box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Child {
    Absent,
    Node(u32),
    /// The packet's number, and the main axis of its faces. The axis is stored here so that it is
    /// known before the packet is loaded.
    Packet(u32, u8),
    /// The number of a packet of spheres.
    Balls(u32),
}

/// The hierarchy over the faces of a [`StageGeometry`].
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    /// The large faces, in the order of their ranks.
    large: Vec<LargeFace>,
    /// Least and greatest corner of the tree over the other faces.
    bounds: [[f64; 3]; 2],
    /// The greatest absolute coordinate of these corners.
    greatest: f64,
    nodes: Vec<Node>,
    /// Number of levels of nodes.
    levels: usize,
    packets: Vec<Packet>,
    balls: Vec<BallPacket>,
    /// By face, in the order of [`StageGeometry::faces`], and then by sphere: true if it emits.
    emits: Vec<bool>,
    /// By face: the numbers of the emitting faces on the face's plane, and the first of these that
    /// the face may cover.
    emitters: Vec<(Range<u32>, u32)>,
    /// By face: its label. After the last face, [`NO_FACE`].
    labels: Vec<u32>,
    few_emitters: bool,
}

impl Bvh {
    /// Builds the hierarchy over all faces of `geometry`.
    pub(crate) fn new(geometry: &StageGeometry) -> Self {
        let faces = &geometry.faces;
        let boxes = build::boxes(geometry);
        let large = large::choose(&boxes, faces.len());
        let tree = build::tree(boxes, &build::axes(geometry), &large);
        let place = packet::planes_of_faces(geometry);
        let corners = tree.bounds.as_flattened().iter();
        let greatest = corners.fold(0.0, |most: f64, c| most.max(c.abs()));
        Self {
            large: large
                .iter()
                .map(|&rank| LargeFace::new(geometry, rank, place[rank as usize]))
                .collect(),
            bounds: tree.bounds,
            greatest,
            packets: tree
                .leaves
                .iter()
                .map(|leaf| Packet::new(geometry, &place, leaf.faces()))
                .collect(),
            balls: tree
                .balls
                .iter()
                .map(|leaf| BallPacket::new(geometry, leaf.faces()))
                .collect(),
            nodes: tree.nodes,
            levels: tree.levels,
            emits: faces
                .iter()
                .map(|face| face.emits)
                .chain(geometry.balls.iter().map(|ball| ball.emitter.is_some()))
                .collect(),
            emitters: faces
                .iter()
                .zip(&place)
                .map(|(face, &plane)| {
                    let emitters = geometry.planes[plane as usize].emitters.clone();
                    let earlier = face.covers.unwrap_or(emitters.len() as u32);
                    (emitters.clone(), emitters.start + earlier)
                })
                .chain(geometry.balls.iter().map(|ball| match ball.emitter {
                    // Nothing of a sphere covers the lamp that it is.
                    Some(number) => (number..number + 1, number + 1),
                    None => (0..0, 0),
                }))
                .collect(),
            labels: faces
                .iter()
                .map(|face| face.label)
                .chain(geometry.balls.iter().map(|ball| ball.label))
                .chain([NO_FACE])
                .collect(),
            few_emitters: faces.iter().filter(|face| face.is_asked_first()).count() <= FEW_EMITTERS,
        }
    }
}

/// A geometry with its hierarchy.
pub(crate) struct Indexed<'a> {
    geometry: &'a StageGeometry,
    bvh: &'a Bvh,
    /// Buffers that successive walks reuse.
    scratch: RefCell<Scratch>,
}

impl<'a> Indexed<'a> {
    pub(crate) fn new(geometry: &'a StageGeometry, bvh: &'a Bvh) -> Self {
        Self {
            geometry,
            bvh,
            scratch: RefCell::new(Scratch::new(bvh)),
        }
    }
}

impl<'i, S: pulp::Simd, const W: usize> NearestSearch<Lanes<'i, S, W>> for Indexed<'_> {
    #[inline(always)]
    fn nearest(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        let (distance, rank) = cx.apart(FindNearest {
            bvh: self.bvh,
            // A reference to a copy, so that the tracer's own ray can stay in registers.
            ray: &{ *ray },
            wanted,
            scratch: &mut self.scratch.borrow_mut(),
        });
        let label = cx.entry(&self.bvh.labels, rank);
        Hit::new(cx, distance, label, wanted)
    }

    #[inline(always)]
    fn emitter(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        if !self.bvh.few_emitters || !self.geometry.balls.is_empty() {
            return self.nearest(cx, ray, wanted);
        }
        let mut hit = self.geometry.nearest_emitter(cx, ray, wanted);
        if cx.any(hit.found) {
            let hidden = self.hidden(cx, ray, Ends::Emitter(hit.distance), hit.found);
            let shown = cx.not(hidden);
            hit.found = cx.and(hit.found, shown);
        }
        hit
    }

    #[inline(always)]
    fn occluded(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        lamp: [S::u64s; W],
        wanted: [S::m64s; W],
    ) -> [S::m64s; W] {
        self.hidden(cx, ray, Ends::Lamp(lamp), wanted)
    }
}

impl Indexed<'_> {
    /// Returns for each `wanted` ray whether a face stands before its end.
    #[inline(always)]
    fn hidden<'i, S: pulp::Simd, const W: usize>(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        ends: Ends<S, W>,
        wanted: [S::m64s; W],
    ) -> [S::m64s; W] {
        cx.apart(FindOccluded {
            bvh: self.bvh,
            ray: &{ *ray },
            ends,
            wanted,
            scratch: &mut self.scratch.borrow_mut(),
        })
    }
}

/// The faces that a ray is tried against. (One type, so that the tracer is compiled once for both.)
#[allow(clippy::large_enum_variant)] // There is one for all rays of a batch.
pub(crate) enum Faces<'a> {
    /// All faces, in turn.
    Few(&'a StageGeometry),
    /// The faces of the boxes that the ray meets.
    Many(Indexed<'a>),
}

impl<'i, S: pulp::Simd, const W: usize> NearestSearch<Lanes<'i, S, W>> for Faces<'_> {
    #[inline(always)]
    fn nearest(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        match self {
            Self::Few(geometry) => geometry.nearest(cx, ray, wanted),
            Self::Many(indexed) => indexed.nearest(cx, ray, wanted),
        }
    }

    #[inline(always)]
    fn emitter(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        match self {
            Self::Few(geometry) => geometry.emitter(cx, ray, wanted),
            Self::Many(indexed) => indexed.emitter(cx, ray, wanted),
        }
    }

    #[inline(always)]
    fn occluded(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        lamp: [S::u64s; W],
        wanted: [S::m64s; W],
    ) -> [S::m64s; W] {
        match self {
            Self::Few(geometry) => geometry.occluded(cx, ray, lamp, wanted),
            Self::Many(indexed) => indexed.occluded(cx, ray, lamp, wanted),
        }
    }
}
