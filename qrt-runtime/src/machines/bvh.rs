//! A bounding volume hierarchy in front of the tracer's own intersection routine.
//!
//! Trying every face is what the circuit does, and what the real machine does while faces are few.
//! For a mesh it narrows the faces down: a ray walks a tree of boxes, eight to a node, and only the
//! faces of the leaves it reaches are tried, eight at once. What is tried runs through
//! [`qrt_core::tracer::cross`] with the same constants, and ties go to the face that a loop over all
//! faces would have kept: the result is the loop's, bit for bit.

mod build;
mod packet;
mod walk;

use super::lanes::{Lanes, lanes};
use packet::Packet;
use qrt_core::tracer::{Arith, Geometry, Hit, NO_FACE, Nearest, Ray};
use walk::{Found, Line};

/// Boxes of a node, and faces of a packet.
pub(crate) const WIDE: usize = 8;

/// Up to this many faces a loop over all of them is faster (`cargo bench --bench tracing`).
pub(crate) const FEW_FACES: usize = 48;

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
    Packet(u32),
}

/// The hierarchy over the faces of a [`Geometry`].
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    packets: Vec<Packet>,
    /// By face, in the order of [`Geometry::faces`]: does it hide an emitter at the same distance?
    hides_emitter: Vec<bool>,
    emits: Vec<bool>,
    labels: Vec<u32>,
    few_emitters: bool,
}

impl Bvh {
    /// Over all faces of `geometry`.
    pub(crate) fn new(geometry: &Geometry) -> Self {
        let faces = &geometry.faces;
        let tree = build::tree(&build::boxes(geometry));
        let place = packet::planes_of_faces(geometry);
        Self {
            packets: tree.leaves.iter().map(|leaf| Packet::new(geometry, &place, leaf)).collect(),
            nodes: tree.nodes,
            hides_emitter: faces.iter().map(|face| face.hides_emitter).collect(),
            emits: faces.iter().map(|face| face.emits).collect(),
            labels: faces.iter().map(|face| face.label).collect(),
            few_emitters: faces.iter().filter(|face| face.emits).count() <= FEW_EMITTERS,
        }
    }
}

/// A geometry with its hierarchy.
pub(crate) struct Indexed<'a> {
    pub(crate) geometry: &'a Geometry,
    pub(crate) bvh: &'a Bvh,
}

impl Indexed<'_> {
    /// Walks every wanted ray; `limit` gives each lane's search what it need not look beyond.
    #[inline(always)]
    fn each_ray<'i, S: pulp::Simd, const W: usize>(
        cx: &Lanes<'i, S, W>,
        ray: &Ray<Lanes<'i, S, W>>,
        wanted: [S::m64s; W],
        mut visit: impl FnMut(usize, &Line),
    ) {
        let one = [cx.simd.splat_u64s(1); W];
        let zero = [cx.simd.splat_u64s(0); W];
        let mut cx = *cx;
        let wanted = cx.select_index(wanted, one, zero);
        let wanted = lanes::<_, u64>(&wanted);
        for lane in 0..Lanes::<S, W>::COUNT {
            if wanted[lane] == 1 {
                let part = |v: &[[S::f64s; W]; 3]| {
                    [lanes(&v[0])[lane], lanes(&v[1])[lane], lanes(&v[2])[lane]]
                };
                let from = lanes::<_, u64>(&ray.from)[lane];
                visit(lane, &Line::new(part(&ray.origin), part(&ray.direction), from));
            }
        }
    }
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
        Self::each_ray(cx, ray, wanted, |lane, line| {
            let found = self.bvh.nearest(cx.narrow(), line);
            if let Some(Found { distance: t, rank }) = found {
                super::lanes::slots::<_, f64>(&mut distance)[lane] = t;
                super::lanes::slots::<_, u64>(&mut label)[lane] =
                    u64::from(self.bvh.labels[rank as usize]);
            }
        });
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
        if !cx.possible(hit.found) {
            return hit;
        }
        let mut label = cx.index(0);
        let distance = hit.distance;
        Self::each_ray(cx, ray, hit.found, |lane, line| {
            let limit = lanes::<_, f64>(&distance)[lane];
            if self.bvh.hides(cx.narrow(), line, limit) {
                super::lanes::slots::<_, u64>(&mut label)[lane] = 1;
            }
        });
        let shown = cx.is(label, 0);
        hit.found = cx.and(hit.found, shown);
        hit
    }
}
