//! The rays of all lanes at once: those that come near the tree walk it, one after the other or
//! together.

use super::approach::{Approach, Lines, MOST_RAYS};
use super::beam::{Beam, FEW_RAYS};
use super::large::LargeFace;
use super::walk::{Blocks, Found, Hides, NearestFace, Waiting};
use super::{Bvh, Child};
use crate::path_machines::lanes::{Inputs, Lanes, lanes, slots};
use crate::path_machines::masks;
use crate::path_machines::masks::at_256_bits;
use pulp::WithSimd;
use qrt_tracer::{Arith, Ray, Start, Work};

/// Memory that successive walks reuse.
#[derive(Debug)]
pub(super) struct Scratch {
    lines: Lines,
    stack: Vec<Waiting<Child>>,
    beam_stack: Vec<Waiting<u32>>,
}

impl Scratch {
    /// Creates stacks that are deep enough for the walks through a tree.
    pub(super) fn new(bvh: &Bvh) -> Self {
        let most = bvh.most_waiting();
        Self {
            lines: Lines::default(),
            stack: vec![(0.0, Child::Absent); most],
            beam_stack: vec![(0.0, 0); most],
        }
    }
}

/// Returns the lanes in which `mask` is true, as bits.
#[inline(always)]
fn bits<S: pulp::Simd, const W: usize>(simd: S, mask: [S::m64s; W]) -> u64 {
    let mut all = 0;
    for (register, &mask) in mask.iter().enumerate() {
        all |= u64::from(masks::bits(simd, mask)) << (register * S::F64_LANES);
    }
    all
}

/// Returns the lanes that are set in `rays`, one after the other.
#[inline(always)]
fn lanes_of(mut rays: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (rays != 0).then(|| rays.trailing_zeros() as usize)?;
        rays &= rays - 1;
        Some(lane)
    })
}

/// Finds the nearest face of each ray: its distance and its position in the geometry's faces. For a
/// ray without a face, the position is the number of faces.
pub(super) struct FindNearest<'a, 'i, S: pulp::Simd, const W: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) ray: &'a Ray<Lanes<'i, S, W>>,
    pub(super) wanted: [S::m64s; W],
    pub(super) scratch: &'a mut Scratch,
}

impl<'i, S: pulp::Simd, const W: usize> Work<Lanes<'i, S, W>> for FindNearest<'_, 'i, S, W> {
    type Output = ([S::f64s; W], [S::u64s; W]);

    #[inline(always)]
    fn run(self, cx: &mut Lanes<'i, S, W>) -> Self::Output {
        let Self {
            bvh, ray, scratch, ..
        } = self;
        let mut distance = cx.real(f64::MAX);
        let mut rank = cx.index(bvh.labels.len() as u32 - 1);
        for large in &bvh.large {
            let (meets, at) = large.meet(cx, ray);
            let nearer = cx.less(at, distance);
            let nearer = cx.and(meets, nearer);
            let this = cx.index(large.rank);
            distance = cx.select(nearer, at, distance);
            rank = cx.select_index(nearer, this, rank);
        }
        if bvh.nodes.is_empty() {
            return (distance, rank);
        }
        let approach = Approach::new(cx, &bvh.bounds, ray, distance, self.wanted);
        let near = bits(cx.simd, approach.meets);
        if near == 0 {
            return (distance, rank);
        }
        let lines = &mut scratch.lines;
        if ray.start == Start::Camera && near.count_ones() as usize >= FEW_RAYS {
            let mut start = f64::INFINITY;
            for (lane, &near_to) in lanes::<_, f64>(&approach.near).iter().enumerate() {
                if near >> lane & 1 != 0 {
                    start = start.min(near_to);
                }
            }
            let start = cx.real(start);
            approach.make_ready(cx, ray, start, bvh.greatest, lines);
            if let Some(beam) = Beam::around(lines, near) {
                let together = Together {
                    bvh,
                    inputs: cx.inputs,
                    beam,
                    stack: &mut scratch.beam_stack,
                    distance: slots(&mut distance),
                    rank: slots(&mut rank),
                };
                at_256_bits(cx.simd, together);
                return (distance, rank);
            }
        }
        approach.make_ready(cx, ray, approach.near, bvh.greatest, lines);
        let alone = Alone {
            bvh,
            inputs: cx.inputs,
            lines,
            rays: near,
            stack: &mut scratch.stack,
            distance: slots(&mut distance),
            rank: slots(&mut rank),
        };
        at_256_bits(cx.simd, alone);
        (distance, rank)
    }
}

/// Finds the nearest faces of the rays of a beam, if they are nearer than the known ones.
struct Together<'a, 'i> {
    bvh: &'a Bvh,
    inputs: &'i Inputs,
    beam: Beam<'a>,
    stack: &'a mut [Waiting<u32>],
    /// The nearest known face, by lane.
    distance: &'a mut [f64],
    rank: &'a mut [u64],
}

impl WithSimd for Together<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let mut cx = Lanes::single(simd, self.inputs);
        let mut found = [Found {
            distance: 0.0,
            rank: 0,
        }; MOST_RAYS];
        let known = self.distance.iter().zip(&*self.rank);
        for (found, (&distance, &rank)) in found.iter_mut().zip(known) {
            let rank = rank as u32;
            *found = Found { distance, rank };
        }
        self.bvh
            .walk_together(&mut cx, &self.beam, self.stack, &mut found);
        let known = self.distance.iter_mut().zip(self.rank);
        for ((distance, rank), found) in known.zip(&found) {
            *distance = found.distance;
            *rank = u64::from(found.rank);
        }
    }
}

/// Finds the nearest faces of rays that each walk by themselves, if they are nearer than the known
/// ones.
struct Alone<'a, 'i> {
    bvh: &'a Bvh,
    inputs: &'i Inputs,
    lines: &'a Lines,
    /// The lanes of the rays, as bits.
    rays: u64,
    stack: &'a mut [Waiting<Child>],
    /// The nearest known face, by lane.
    distance: &'a mut [f64],
    rank: &'a mut [u64],
}

impl WithSimd for Alone<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let mut cx = Lanes::single(simd, self.inputs);
        for lane in lanes_of(self.rays) {
            let mut search = NearestFace {
                best: Found {
                    distance: self.distance[lane],
                    rank: self.rank[lane] as u32,
                },
            };
            let Self { bvh, lines, .. } = self;
            bvh.walk(&mut cx, lines, lane, self.stack, &mut search);
            self.distance[lane] = search.best.distance;
            self.rank[lane] = u64::from(search.best.rank);
        }
    }
}

/// The ends of rays, and the condition that hides an end.
pub(super) enum Ends<S: pulp::Simd, const W: usize> {
    /// The ray ends on an emitter at this distance. A face before it that does not emit hides it.
    Emitter([S::f64s; W]),
    /// The ray ends on this emitting face, one length of the direction away. Any face before it
    /// hides it.
    Lamp([S::u64s; W]),
}

impl<S: pulp::Simd, const W: usize> Ends<S, W> {
    /// Returns whether `large` hides the ends, or `None` if it never does.
    #[inline(always)]
    fn hidden_by<'i>(
        &self,
        cx: &mut Lanes<'i, S, W>,
        bvh: &Bvh,
        large: &LargeFace,
        ray: &Ray<Lanes<'i, S, W>>,
    ) -> Option<[S::m64s; W]> {
        let rank = large.rank as usize;
        match *self {
            Self::Emitter(_) if bvh.emits[rank] => None,
            Self::Emitter(distance) => {
                let (meets, at) = large.meet(cx, ray);
                let before = cx.less(at, distance);
                Some(cx.and(meets, before))
            }
            Self::Lamp(_) if !large.blocks => None,
            Self::Lamp(lamp) => {
                let (meets, at) = large.meet(cx, ray);
                let (here, covered) = &bvh.emitters[rank];
                let end = cx.real(1.0);
                let mut hides = cx.less(at, end);
                if !here.is_empty() {
                    let (earlier, later) = (cx.below(lamp, here.start), cx.below(lamp, here.end));
                    let uncovered = cx.below(lamp, *covered);
                    let (from, covers) = (cx.not(earlier), cx.not(uncovered));
                    let ends_here = cx.and(from, later);
                    let elsewhere = cx.not(ends_here);
                    let (before, over) = (cx.and(elsewhere, hides), cx.and(ends_here, covers));
                    hides = cx.or(before, over);
                }
                Some(cx.and(meets, hides))
            }
        }
    }
}

/// Finds whether a face stands before the end of each ray.
pub(super) struct FindOccluded<'a, 'i, S: pulp::Simd, const W: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) ray: &'a Ray<Lanes<'i, S, W>>,
    pub(super) ends: Ends<S, W>,
    pub(super) wanted: [S::m64s; W],
    pub(super) scratch: &'a mut Scratch,
}

impl<'i, S: pulp::Simd, const W: usize> Work<Lanes<'i, S, W>> for FindOccluded<'_, 'i, S, W> {
    type Output = [S::m64s; W];

    #[inline(always)]
    fn run(self, cx: &mut Lanes<'i, S, W>) -> Self::Output {
        let Self {
            bvh, ray, scratch, ..
        } = self;
        let mut hidden = cx.truth(false);
        for large in &bvh.large {
            if let Some(hides) = self.ends.hidden_by(cx, bvh, large, ray) {
                hidden = cx.or(hidden, hides);
            }
        }
        if bvh.nodes.is_empty() {
            return hidden;
        }
        let shown = cx.not(hidden);
        let open = cx.and(self.wanted, shown);
        let limit = match self.ends {
            Ends::Emitter(distance) => distance,
            Ends::Lamp(_) => cx.real(Blocks::LIMIT),
        };
        let approach = Approach::new(cx, &bvh.bounds, ray, limit, open);
        let rays = bits(cx.simd, approach.meets);
        if rays == 0 {
            return hidden;
        }
        let (lines, stack) = (&mut scratch.lines, &mut scratch.stack);
        approach.make_ready(cx, ray, approach.near, bvh.greatest, lines);
        let mut found = cx.index(0);
        let hiding = Hiding {
            bvh,
            inputs: cx.inputs,
            lines,
            rays,
            ends: match &self.ends {
                Ends::Emitter(distance) => EndsByLane::Emitter(lanes(distance)),
                Ends::Lamp(lamp) => EndsByLane::Lamp(lanes(lamp)),
            },
            stack,
            hidden: slots(&mut found),
        };
        at_256_bits(cx.simd, hiding);
        let found = cx.is(found, 1);
        cx.or(hidden, found)
    }
}

/// The end of each ray, by lane.
enum EndsByLane<'a> {
    /// The distance of an emitter.
    Emitter(&'a [f64]),
    /// The number of an emitting face.
    Lamp(&'a [u64]),
}

/// Finds whether a face of the tree stands before the end of each ray.
struct Hiding<'a, 'i> {
    bvh: &'a Bvh,
    inputs: &'i Inputs,
    lines: &'a Lines,
    /// The lanes of the rays, as bits.
    rays: u64,
    ends: EndsByLane<'a>,
    stack: &'a mut [Waiting<Child>],
    /// 1 in the lanes of hidden rays.
    hidden: &'a mut [u64],
}

impl WithSimd for Hiding<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let mut cx = Lanes::single(simd, self.inputs);
        let Self { bvh, lines, .. } = self;
        for lane in lanes_of(self.rays) {
            let hidden = match self.ends {
                EndsByLane::Emitter(distance) => {
                    let distance = distance[lane];
                    let mut search = Hides { bvh, distance };
                    bvh.walk(&mut cx, lines, lane, self.stack, &mut search)
                }
                EndsByLane::Lamp(lamp) => {
                    let lamp = lamp[lane] as u32;
                    let mut search = Blocks { bvh, lamp };
                    bvh.walk(&mut cx, lines, lane, self.stack, &mut search)
                }
            };
            self.hidden[lane] = u64::from(hidden);
        }
    }
}
