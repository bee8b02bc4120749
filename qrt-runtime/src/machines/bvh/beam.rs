//! The rays of all lanes at once.
//!
//! Rays from the camera are neighbours: those of a value mostly cross the same pixel. They walk
//! the tree together, as a beam: a node is tried once for all of them, and each ray by itself only
//! at the packets. Rays that were scattered walk alone.

use super::packet::bits;
use super::walk::{Found, Line, NearestFace, Stack};
use super::{Bvh, Child, Node, WIDE, line};
use crate::machines::lanes::Lanes;
use qrt_core::tracer::{NO_PLANE, Ray};

/// Fewer rays than this are no beam.
const FEW_RAYS: usize = 4;

/// Lanes of a value, at most.
const MOST_RAYS: usize = 16;

/// What walks keep from one to the next: memory.
#[derive(Default)]
pub(super) struct Scratch {
    /// The stack of a lone ray.
    pub(super) stack: Stack,
    /// The stack of a beam: numbers of nodes and their children, as `WIDE node + child`.
    beam_stack: Vec<(f64, u32)>,
    lines: Vec<Line>,
    /// The lanes whose rays were asked for, and what they meet.
    pub(super) found: Vec<(usize, Found)>,
}

/// The walks of several rays, to be run as a function of its own.
pub(super) struct Rays<'a, 'i, S: pulp::Simd, const W: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) cx: Lanes<'i, S, W>,
    pub(super) ray: Ray<Lanes<'i, S, W>>,
    /// The lanes whose rays are wanted, as bits.
    pub(super) wanted: u64,
    pub(super) scratch: &'a mut Scratch,
}

impl<S: pulp::Simd, const W: usize> Rays<'_, '_, S, W> {
    /// Puts the nearest face of each wanted lane into the scratch's `found`.
    #[inline(never)]
    pub(super) fn find(self) {
        self.cx.simd.vectorize(self);
    }
}

impl<S: pulp::Simd, const W: usize> pulp::WithSimd for Rays<'_, '_, S, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: pulp::Simd>(self, _: U) {
        let scratch = self.scratch;
        scratch.lines.clear();
        scratch.found.clear();
        let mut from_camera = true;
        let mut left = self.wanted;
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let line = line(&self.ray, lane);
            from_camera &= line.from == u64::from(NO_PLANE);
            scratch.lines.push(line);
            scratch.found.push((lane, Found::NONE));
        }
        let mut cx = self.cx.narrow();
        if from_camera
            && (FEW_RAYS..=MOST_RAYS).contains(&scratch.lines.len())
            && let Some(beam) = Beam::around(&scratch.lines)
        {
            self.bvh.walk_together(&mut cx, &beam, scratch);
            return;
        }
        for (line, (_, found)) in scratch.lines.iter().zip(&mut scratch.found) {
            let mut search = NearestFace::default();
            self.bvh
                .walk(&mut cx, line, &mut scratch.stack, &mut search);
            *found = search.best;
        }
    }
}

/// Rays that go the same way along each axis.
struct Beam {
    /// The least and the greatest origin.
    origin: [[f64; 3]; 2],
    /// The least and the greatest inverse direction.
    inverse: [[f64; 3]; 2],
    backwards: [bool; 3],
    /// By axis and ray: see [`Line`].
    inverses: [[f64; MOST_RAYS]; 3],
    starts: [[f64; MOST_RAYS]; 3],
}

impl Beam {
    /// Of `lines`, if they go the same way.
    #[inline(always)]
    fn around(lines: &[Line]) -> Option<Self> {
        let first = lines.first()?;
        let mut beam = Self {
            origin: [[first.origin[0], first.origin[1], first.origin[2]]; 2],
            inverse: [first.inverse; 2],
            backwards: first.backwards,
            inverses: [[1.0; MOST_RAYS]; 3],
            starts: [[0.0; MOST_RAYS]; 3],
        };
        for (ray, line) in lines.iter().enumerate() {
            if line.backwards != beam.backwards {
                return None;
            }
            for axis in 0..3 {
                beam.origin[0][axis] = beam.origin[0][axis].min(line.origin[axis]);
                beam.origin[1][axis] = beam.origin[1][axis].max(line.origin[axis]);
                beam.inverse[0][axis] = beam.inverse[0][axis].min(line.inverse[axis]);
                beam.inverse[1][axis] = beam.inverse[1][axis].max(line.inverse[axis]);
                beam.inverses[axis][ray] = line.inverse[axis];
                beam.starts[axis][ray] = line.start[axis];
            }
        }
        Some(beam)
    }

    /// The rays that meet box `child` of `node` within their limits, as bits.
    #[inline(always)]
    fn meeting<S: pulp::Simd>(
        &self,
        simd: S,
        node: &Node,
        child: usize,
        limits: &[f64; MOST_RAYS],
    ) -> u32 {
        let mut met = 0;
        for first in (0..MOST_RAYS).step_by(S::F64_LANES) {
            let at = first / S::F64_LANES;
            let mut near = simd.splat_f64s(0.0);
            let mut far = S::as_simd_f64s(limits).0[at];
            for axis in 0..3 {
                let inverse = S::as_simd_f64s(&self.inverses[axis]).0[at];
                let start = S::as_simd_f64s(&self.starts[axis]).0[at];
                let backwards = usize::from(self.backwards[axis]);
                let enter = simd.splat_f64s(node.boxes[backwards][axis][child]);
                let leave = simd.splat_f64s(node.boxes[1 - backwards][axis][child]);
                let enter = simd.mul_add_e_f64s(enter, inverse, start);
                let leave = simd.mul_add_e_f64s(leave, inverse, start);
                near = simd.max_f64s(near, enter);
                far = simd.min_f64s(far, leave);
            }
            met |= bits(simd, simd.less_than_or_equal_f64s(near, far)) << first;
        }
        met
    }
}

impl Bvh {
    /// The nearest face of each of `scratch`'s lines, which make up `beam`.
    #[inline(always)]
    fn walk_together<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        beam: &Beam,
        scratch: &mut Scratch,
    ) {
        let Scratch {
            beam_stack: stack,
            lines,
            found,
            ..
        } = scratch;
        stack.clear();
        // No ray meets anything before its origin.
        let mut limits = [-1.0; MOST_RAYS];
        limits[..lines.len()].fill(f64::MAX);
        let mut farthest = f64::MAX;
        if let Some(root) = self.nodes.first() {
            root.open_to_beam(cx.simd, beam, farthest, 0, stack);
        }
        while let Some((near, place)) = stack.pop() {
            if near > farthest {
                continue;
            }
            let node = &self.nodes[place as usize / WIDE];
            let child = place as usize % WIDE;
            match node.children[child] {
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    node.open_to_beam(cx.simd, beam, farthest, number, stack);
                }
                Child::Packet(number, axis) => {
                    let packet = &self.packets[number as usize];
                    let mut left = beam.meeting(cx.simd, node, child, &limits);
                    if left == 0 {
                        continue;
                    }
                    while left != 0 {
                        let ray = left.trailing_zeros() as usize;
                        left &= left - 1;
                        let best = &mut found[ray].1;
                        let mut search = NearestFace { best: *best };
                        packet.show(cx, axis, &lines[ray], &mut search);
                        *best = search.best;
                        limits[ray] = best.distance;
                    }
                    farthest = limits.iter().copied().fold(0.0, f64::max);
                }
                Child::Absent => {}
            }
        }
    }
}

impl Node {
    /// Pushes the children that a ray of the beam may meet within `limit`, the nearest last.
    /// `number` is the node's.
    #[inline(always)]
    fn open_to_beam<S: pulp::Simd>(
        &self,
        simd: S,
        beam: &Beam,
        limit: f64,
        number: u32,
        stack: &mut Vec<(f64, u32)>,
    ) {
        let base = stack.len();
        let mut nears = [0.0; WIDE];
        let mut left = 0;
        for first in (0..WIDE).step_by(S::F64_LANES) {
            let at = first / S::F64_LANES;
            let mut near = simd.splat_f64s(0.0);
            let mut far = simd.splat_f64s(limit);
            for axis in 0..3 {
                let backwards = usize::from(beam.backwards[axis]);
                let slow = simd.splat_f64s(beam.inverse[0][axis]);
                let fast = simd.splat_f64s(beam.inverse[1][axis]);
                let ahead = simd.splat_f64s(beam.origin[1 - backwards][axis]);
                let behind = simd.splat_f64s(beam.origin[backwards][axis]);
                let enter = S::as_simd_f64s(&self.boxes[backwards][axis]).0[at];
                let leave = S::as_simd_f64s(&self.boxes[1 - backwards][axis]).0[at];
                let enter = simd.sub_f64s(enter, ahead);
                let leave = simd.sub_f64s(leave, behind);
                let (a, b) = (simd.mul_f64s(enter, slow), simd.mul_f64s(enter, fast));
                near = simd.max_f64s(near, simd.min_f64s(a, b));
                let (a, b) = (simd.mul_f64s(leave, slow), simd.mul_f64s(leave, fast));
                far = simd.min_f64s(far, simd.max_f64s(a, b));
            }
            S::as_mut_simd_f64s(&mut nears).0[at] = near;
            left |= bits(simd, simd.less_than_or_equal_f64s(near, far)) << first;
        }
        while left != 0 {
            let lane = left.trailing_zeros() as usize % WIDE;
            left &= left - 1;
            let near = nears[lane];
            let mut place = stack.len();
            stack.push((near, number * WIDE as u32 + lane as u32));
            while place > base && stack[place - 1].0 < near {
                stack.swap(place - 1, place);
                place -= 1;
            }
        }
    }
}
