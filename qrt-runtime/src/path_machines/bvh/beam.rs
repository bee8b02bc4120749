//! Rays that walk the tree together.
//!
//! Rays from the camera are neighbours: the rays of a value mostly cross the same pixel. They walk
//! the tree together, as a beam: a node is tried once for all of them, and only a packet is tried
//! for each ray by itself. Scattered rays walk alone.

use super::approach::{Lines, MOST_RAYS};
use super::walk::{Found, MOST_LANES, NearestFace, Waiting, columns};
use super::{Bvh, Child, Node, WIDE};
use crate::path_machines::lanes::Lanes;
use crate::path_machines::masks::bits_of_singles;

/// Smallest number of rays that form a beam.
pub(super) const FEW_RAYS: usize = 4;

/// Rays that go the same way along each axis, and start equally far from their origins.
pub(super) struct Beam<'a> {
    lines: &'a Lines,
    /// The lanes of the rays, as bits.
    rays: u64,
    /// Least and greatest coordinates of the points at which the rays start.
    origin: [[f32; 3]; 2],
    /// The least and the greatest inverse direction.
    inverse: [[f32; 3]; 2],
    backwards: [bool; 3],
}

impl<'a> Beam<'a> {
    /// Creates a beam of the `rays` among `lines`, if they go the same way along each axis.
    #[inline(always)]
    pub(super) fn around(lines: &'a Lines, rays: u64) -> Option<Self> {
        let mut beam = Self {
            lines,
            rays,
            origin: [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]],
            inverse: [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]],
            backwards: lines.backwards(rays.trailing_zeros() as usize),
        };
        let less = |a: f32, b: f32| if a < b { a } else { b };
        let more = |a: f32, b: f32| if a > b { a } else { b };
        let mut left = rays;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % MOST_RAYS;
            left &= left - 1;
            for axis in 0..3 {
                let inverse = lines.inverse[axis][lane];
                let ([low, high], [slow, fast]) = (&mut beam.origin, &mut beam.inverse);
                low[axis] = less(lines.points[0][axis][lane], low[axis]);
                high[axis] = more(lines.points[1][axis][lane], high[axis]);
                slow[axis] = less(inverse, slow[axis]);
                fast[axis] = more(inverse, fast[axis]);
            }
        }
        let [slow, fast] = &beam.inverse;
        let same = |(slow, fast): (&f32, &f32)| *slow > 0.0 || *fast < 0.0;
        slow.iter().zip(fast).all(same).then_some(beam)
    }

    /// Returns the rays that meet box `child` of `node` within their limits, as bits.
    #[inline(always)]
    fn meeting<S: pulp::Simd>(
        &self,
        simd: S,
        node: &Node,
        child: usize,
        limits: &[f32; MOST_RAYS],
    ) -> u32 {
        let mut met = 0;
        for first in (0..MOST_RAYS).step_by(S::F32_LANES) {
            let at = first / S::F32_LANES;
            let mut near = simd.splat_f32s(0.0);
            let mut far = S::as_simd_f32s(limits).0[at];
            for axis in 0..3 {
                let lines = self.lines;
                let inverse = S::as_simd_f32s(&lines.inverse[axis]).0[at];
                let enter = S::as_simd_f32s(&lines.enter[axis]).0[at];
                let leave = S::as_simd_f32s(&lines.leave[axis]).0[at];
                let backwards = usize::from(self.backwards[axis]);
                let first_plane = simd.splat_f32s(node.boxes[backwards][axis][child]);
                let last_plane = simd.splat_f32s(node.boxes[1 - backwards][axis][child]);
                near = simd.max_f32s(near, simd.mul_add_e_f32s(first_plane, inverse, enter));
                far = simd.min_f32s(far, simd.mul_add_e_f32s(last_plane, inverse, leave));
            }
            met |= bits_of_singles(simd, simd.less_than_or_equal_f32s(near, far)) << first;
        }
        met
    }
}

impl Bvh {
    /// Finds the nearest faces of the rays of `beam`, by lane, if they are nearer than the faces in
    /// `found`. `stack` must have room for all waiting entries: numbers of nodes and their
    /// children, as `WIDE node + child`.
    #[inline(always)]
    pub(super) fn walk_together<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        beam: &Beam<'_>,
        stack: &mut [Waiting<u32>],
        found: &mut [Found; MOST_RAYS],
    ) {
        let lines = beam.lines;
        // No ray meets anything before its origin.
        let mut limits = [-1.0; MOST_RAYS];
        let mut left = beam.rays;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % MOST_RAYS;
            left &= left - 1;
            limits[lane] = lines.boxed(lane, found[lane].distance);
        }
        let farthest = |limits: &[f32; MOST_RAYS]| limits.iter().copied().fold(0.0, f32::max);
        let mut limit = farthest(&limits);
        let mut waiting = self.nodes[0].open_to_beam(cx.simd, beam, limit, 0, stack, 0);
        while waiting > 0 {
            waiting -= 1;
            let (near, place) = stack[waiting];
            if near > limit {
                continue;
            }
            let node = &self.nodes[place as usize / WIDE];
            let child = place as usize % WIDE;
            match node.children[child] {
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    waiting = node.open_to_beam(cx.simd, beam, limit, number, stack, waiting);
                }
                leaf @ (Child::Packet(..) | Child::Balls(_)) => {
                    let mut left = beam.meeting(cx.simd, node, child, &limits);
                    if left == 0 {
                        continue;
                    }
                    while left != 0 {
                        let lane = left.trailing_zeros() as usize % MOST_RAYS;
                        left &= left - 1;
                        let mut search = NearestFace { best: found[lane] };
                        match leaf {
                            Child::Packet(number, axis) => {
                                let packet = &self.packets[number as usize];
                                packet.show(cx, axis, lines, lane, &mut search);
                            }
                            Child::Balls(number) => {
                                let packet = &self.balls[number as usize];
                                packet.show(cx, lines, lane, &mut search);
                            }
                            Child::Node(_) | Child::Absent => {}
                        }
                        found[lane] = search.best;
                        limits[lane] = lines.boxed(lane, search.best.distance);
                    }
                    limit = farthest(&limits);
                }
                Child::Absent => {}
            }
        }
    }
}

impl Node {
    /// Pushes the children that a ray of the beam may meet within `limit`, the nearest last, onto
    /// the `waiting` entries of the stack, and returns the new number of entries. `number` is the
    /// node's number.
    #[inline(always)]
    fn open_to_beam<S: pulp::Simd>(
        &self,
        simd: S,
        beam: &Beam,
        limit: f32,
        number: u32,
        stack: &mut [Waiting<u32>],
        mut waiting: usize,
    ) -> usize {
        let base = waiting;
        let mut nears = [0.0; MOST_LANES];
        let mut left = 0;
        for first in (0..WIDE).step_by(S::F32_LANES) {
            let mut near = simd.splat_f32s(0.0);
            let mut far = simd.splat_f32s(limit);
            for axis in 0..3 {
                let backwards = usize::from(beam.backwards[axis]);
                let slow = simd.splat_f32s(beam.inverse[0][axis]);
                let fast = simd.splat_f32s(beam.inverse[1][axis]);
                let ahead = simd.splat_f32s(beam.origin[1 - backwards][axis]);
                let behind = simd.splat_f32s(beam.origin[backwards][axis]);
                let enter = columns(simd, &self.boxes[backwards][axis], first);
                let leave = columns(simd, &self.boxes[1 - backwards][axis], first);
                let enter = simd.sub_f32s(enter, ahead);
                let leave = simd.sub_f32s(leave, behind);
                let (a, b) = (simd.mul_f32s(enter, slow), simd.mul_f32s(enter, fast));
                near = simd.max_f32s(near, simd.min_f32s(a, b));
                let (a, b) = (simd.mul_f32s(leave, slow), simd.mul_f32s(leave, fast));
                far = simd.min_f32s(far, simd.max_f32s(a, b));
            }
            S::as_mut_simd_f32s(&mut nears).0[first / S::F32_LANES] = near;
            left |= bits_of_singles(simd, simd.less_than_or_equal_f32s(near, far)) << first;
        }
        left &= (1 << WIDE) - 1;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % WIDE;
            left &= left - 1;
            let near = nears[lane];
            let mut place = waiting;
            while place > base && stack[place - 1].0 < near {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = (near, number * WIDE as u32 + lane as u32);
            waiting += 1;
        }
        waiting
    }
}
