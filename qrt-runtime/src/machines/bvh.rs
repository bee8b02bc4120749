//! A bounding volume hierarchy in front of the tracer's own intersection routine.
//!
//! Trying every face is what the circuit does, and what the real machine does while faces are few.
//! For a mesh it narrows the faces down: a ray walks a tree of boxes, eight to a node, and only the
//! faces of the leaves it reaches are tried, eight at once. What is tried runs through
//! [`qrt_core::tracer::cross`] with the same constants, and ties go to the face that a loop over
//! all faces would have kept: the result is the loop's, bit for bit.

mod beam;
mod build;
mod packet;
mod walk;

use super::lanes::{Lanes, lanes, slots};
use beam::{Rays, Scratch};
use packet::Packet;
use qrt_core::tracer::{Arith, Geometry, Hit, NO_FACE, Nearest, Ray};
use std::cell::Cell;
use std::ops::Range;
use walk::Line;

/// Boxes of a node, and faces of a packet.
pub(crate) const WIDE: usize = 8;

/// Up to this many faces a loop over all of them is faster (`cargo bench --bench tracing`).
pub(crate) const FEW_FACES: usize = 72;

/// Up to this many emitting faces, a last ray asks them first.
const FEW_EMITTERS: usize = 16;

/// The children of a node: their boxes by corner and axis, and where they are.
#[derive(Clone, Debug)]
struct Node {
    /// `[low, high][axis][child]`; an absent child's box is empty.
    boxes: [[[f64; WIDE]; 3]; 2],
    children: [Child; WIDE],
}

/// What a node's box holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Child {
    Absent,
    Node(u32),
    /// Its number and its faces' main axis, which is known here before the packet is there.
    Packet(u32, u8),
}

/// The hierarchy over the faces of a [`Geometry`].
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    packets: Vec<Packet>,
    /// By face, in the order of [`Geometry::faces`]: whether it hides an emitter at the same
    /// distance.
    hides_emitter: Vec<bool>,
    emits: Vec<bool>,
    /// By face: the numbers of the emitting faces on its plane, and the first of them that it may
    /// cover.
    emitters: Vec<(Range<u32>, u32)>,
    labels: Vec<u32>,
    few_emitters: bool,
}

impl Bvh {
    /// Over all faces of `geometry`.
    pub(crate) fn new(geometry: &Geometry) -> Self {
        let faces = &geometry.faces;
        let tree = build::tree(&build::boxes(geometry), &build::axes(geometry));
        let place = packet::planes_of_faces(geometry);
        Self {
            packets: tree
                .leaves
                .iter()
                .map(|leaf| Packet::new(geometry, &place, leaf))
                .collect(),
            nodes: tree.nodes,
            hides_emitter: faces.iter().map(|face| face.hides_emitter).collect(),
            emits: faces.iter().map(|face| face.emits).collect(),
            emitters: faces
                .iter()
                .zip(&place)
                .map(|(face, &plane)| {
                    let emitters = geometry.planes[plane as usize].emitters.clone();
                    let earlier = face.covers.unwrap_or(emitters.len() as u32);
                    (emitters.clone(), emitters.start + earlier)
                })
                .collect(),
            labels: faces.iter().map(|face| face.label).collect(),
            few_emitters: faces.iter().filter(|face| face.emits).count() <= FEW_EMITTERS,
        }
    }
}

/// A geometry with its hierarchy.
pub(crate) struct Indexed<'a> {
    geometry: &'a Geometry,
    bvh: &'a Bvh,
    /// Lent to one walk after the other.
    scratch: Cell<Scratch>,
}

impl<'a> Indexed<'a> {
    pub(crate) fn new(geometry: &'a Geometry, bvh: &'a Bvh) -> Self {
        Self {
            geometry,
            bvh,
            scratch: Cell::default(),
        }
    }
}

/// The lanes in which `mask` holds, as bits.
#[inline(always)]
fn bits<S: pulp::Simd, const W: usize>(cx: &mut Lanes<'_, S, W>, mask: [S::m64s; W]) -> u64 {
    let (one, zero) = (cx.index(1), cx.index(0));
    let flags = cx.select_index(mask, one, zero);
    let mut bits = 0;
    for (lane, &flag) in lanes::<_, u64>(&flags).iter().enumerate() {
        bits |= flag << lane;
    }
    bits
}

/// The ray of one lane.
#[inline(always)]
fn line<S: pulp::Simd, const W: usize>(ray: &Ray<Lanes<'_, S, W>>, lane: usize) -> Line {
    let mut parts = [[0.0; 3]; 2];
    for (part, vector) in parts.iter_mut().zip([&ray.origin, &ray.direction]) {
        for (part, component) in part.iter_mut().zip(vector) {
            *part = lanes::<_, f64>(component)[lane];
        }
    }
    Line::new(parts[0], parts[1], lanes::<_, u64>(&ray.from)[lane])
}

impl<'i, S: pulp::Simd, const W: usize> Nearest<Lanes<'i, S, W>> for Indexed<'_> {
    #[inline(always)]
    fn nearest(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        let mut distance = cx.real(f64::MAX);
        let mut label = cx.index(NO_FACE);
        let mut scratch = self.scratch.take();
        Rays {
            bvh: self.bvh,
            cx: *cx,
            // A copy, so that the tracer's own can stay in registers.
            ray: *ray,
            wanted: bits(cx, wanted),
            scratch: &mut scratch,
        }
        .find();
        for &(lane, found) in scratch.found.iter().filter(|(_, f)| f.rank != u32::MAX) {
            slots::<_, f64>(&mut distance)[lane] = found.distance;
            let face = self.bvh.labels[found.rank as usize];
            slots::<_, u64>(&mut label)[lane] = u64::from(face);
        }
        self.scratch.set(scratch);
        Hit::new(cx, distance, label, wanted)
    }

    #[inline(always)]
    fn emitter(
        &self,
        cx: &mut Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
    ) -> Hit<Lanes<'i, S, W>> {
        if !self.bvh.few_emitters {
            return self.nearest(cx, ray, wanted);
        }
        let mut hit = self.geometry.nearest_emitter(cx, ray, wanted);
        if !cx.any(hit.found) {
            return hit;
        }
        let mut hidden = cx.index(0);
        let mut scratch = self.scratch.take();
        let mut left = bits(cx, hit.found);
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let distance = lanes::<_, f64>(&hit.distance)[lane];
            if self
                .bvh
                .hides(cx.narrow(), &line(ray, lane), &mut scratch.stack, distance)
            {
                slots::<_, u64>(&mut hidden)[lane] = 1;
            }
        }
        self.scratch.set(scratch);
        let shown = cx.is(hidden, 0);
        hit.found = cx.and(hit.found, shown);
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
        let mut hidden = cx.index(0);
        let mut scratch = self.scratch.take();
        let mut left = bits(cx, wanted);
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let lamp = lanes::<_, u64>(&lamp)[lane] as u32;
            let line = line(ray, lane);
            if self
                .bvh
                .blocks(cx.narrow(), &line, &mut scratch.stack, lamp)
            {
                slots::<_, u64>(&mut hidden)[lane] = 1;
            }
        }
        self.scratch.set(scratch);
        cx.is(hidden, 1)
    }
}

/// What a ray is tried against. (One type, so that the tracer is compiled once for both.)
pub(crate) enum Faces<'a> {
    /// All faces, in turn.
    Few(&'a Geometry),
    /// Those of the boxes that it meets.
    Many(Indexed<'a>),
}

impl<'i, S: pulp::Simd, const W: usize> Nearest<Lanes<'i, S, W>> for Faces<'_> {
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
