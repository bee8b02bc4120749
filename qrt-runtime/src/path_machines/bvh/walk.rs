//! The walk of one ray through the tree.

use super::approach::Lines;
use super::{Bvh, Child, Node, WIDE};
use crate::path_machines::lanes::Lanes;
use crate::path_machines::masks::bits_of_singles;

/// A face that the ray meets: its distance, and its position in the geometry's faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) distance: f64,
    pub(super) rank: u32,
}

/// An entry on the stack, and the distance at which its box begins.
pub(super) type Waiting<T> = (f32, T);

/// A search among the faces along a ray. (A trait and not a closure: see
/// [`crate::path_machines::lanes`].)
pub(super) trait Search {
    /// True if nearer faces matter more.
    const IN_ORDER: bool;
    /// Returns the distance beyond which nothing matters.
    fn limit(&self) -> f64;
    /// Handles face `rank`, which the ray meets at `distance`. Returns true if the search needs no
    /// more faces.
    fn meet(&mut self, rank: u32, distance: f64) -> bool;
}

/// Finds the nearest face; of equally near faces the first.
pub(super) struct NearestFace {
    pub(super) best: Found,
}

impl Search for NearestFace {
    const IN_ORDER: bool = true;
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.best.distance
    }
    #[inline(always)]
    fn meet(&mut self, rank: u32, distance: f64) -> bool {
        let best = self.best;
        if distance < best.distance || (distance == best.distance && rank < best.rank) {
            self.best = Found { distance, rank };
        }
        false
    }
}

/// Finds any face that hides an emitter at `distance` along the ray.
pub(super) struct Hides<'a> {
    pub(super) bvh: &'a Bvh,
    pub(super) distance: f64,
}

impl Search for Hides<'_> {
    const IN_ORDER: bool = false;
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.distance
    }
    #[inline(always)]
    fn meet(&mut self, rank: u32, distance: f64) -> bool {
        distance < self.distance && !self.bvh.emits[rank as usize]
    }
}

/// Finds any face before the end of a ray, which is on the emitting face `lamp`, one length of the
/// ray's direction away.
pub(super) struct Blocks<'a> {
    pub(super) bvh: &'a Bvh,
    pub(super) lamp: u32,
}

impl Blocks<'_> {
    /// A ray meets faces in the emitter's plane at its end, up to rounding.
    pub(super) const LIMIT: f64 = 1.0 + 1e-6;
}

impl Search for Blocks<'_> {
    const IN_ORDER: bool = false;
    #[inline(always)]
    fn limit(&self) -> f64 {
        Self::LIMIT
    }
    #[inline(always)]
    fn meet(&mut self, rank: u32, distance: f64) -> bool {
        let (here, covered) = &self.bvh.emitters[rank as usize];
        if here.contains(&self.lamp) {
            *covered <= self.lamp
        } else {
            distance < 1.0
        }
    }
}

impl Bvh {
    /// Returns the largest number of entries on a walk's stack.
    pub(super) fn most_waiting(&self) -> usize {
        // All children of a node on each level.
        WIDE * self.levels
    }

    /// Passes to `search` the faces of the tree that the ray in `lane` meets within its limit, and
    /// returns true as soon as the search needs no more. `stack` must have room for all waiting
    /// entries.
    #[inline(always)]
    pub(super) fn walk<S: pulp::Simd, T: Search>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        lines: &Lines,
        lane: usize,
        stack: &mut [Waiting<Child>],
        search: &mut T,
    ) -> bool {
        let backwards = lines.backwards(lane);
        let mut limit = lines.boxed(lane, search.limit());
        let mut waiting = 0;
        let mut next = Child::Node(0);
        loop {
            match next {
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let (nears, mut left) = node.open(cx.simd, lines, lane, backwards, limit);
                    if left != 0 {
                        let place = left.trailing_zeros() as usize % WIDE;
                        left &= left - 1;
                        next = node.children[place];
                        // A single child, by far the most frequent case, bypasses the stack.
                        if left != 0 {
                            let base = waiting;
                            let mut nearest = nears[place];
                            while left != 0 {
                                let place = left.trailing_zeros() as usize % WIDE;
                                left &= left - 1;
                                let mut other = (nears[place], node.children[place]);
                                if T::IN_ORDER && other.0 < nearest {
                                    std::mem::swap(&mut other.0, &mut nearest);
                                    std::mem::swap(&mut other.1, &mut next);
                                }
                                // Insertion sort, because children are few; the farthest comes
                                // first.
                                let mut place = waiting;
                                while T::IN_ORDER && place > base && stack[place - 1].0 < other.0 {
                                    stack[place] = stack[place - 1];
                                    place -= 1;
                                }
                                stack[place] = other;
                                waiting += 1;
                            }
                        }
                        continue;
                    }
                }
                Child::Packet(number, axis) => {
                    let packet = &self.packets[number as usize];
                    if packet.show(cx, axis, lines, lane, search) {
                        return true;
                    }
                    if T::IN_ORDER {
                        limit = lines.boxed(lane, search.limit());
                    }
                }
                Child::Balls(number) => {
                    let packet = &self.balls[number as usize];
                    if packet.show(cx, lines, lane, search) {
                        return true;
                    }
                    if T::IN_ORDER {
                        limit = lines.boxed(lane, search.limit());
                    }
                }
                Child::Absent => {}
            }
            // Take the nearest child on the stack that is not beyond the current limit.
            loop {
                if waiting == 0 {
                    return false;
                }
                waiting -= 1;
                let (near, child) = stack[waiting];
                if near <= limit {
                    next = child;
                    break;
                }
            }
        }
    }
}

/// Largest number of single-precision lanes.
pub(super) const MOST_LANES: usize = 16;

/// Loads a register of `columns` from `first` on. If the register has more lanes than there are
/// columns, the remaining lanes have no meaning.
#[inline(always)]
pub(super) fn columns<S: pulp::Simd>(simd: S, columns: &[f32; WIDE], first: usize) -> S::f32s {
    if S::F32_LANES > WIDE {
        simd.partial_load_f32s(columns)
    } else {
        S::as_simd_f32s(columns).0[first / S::F32_LANES]
    }
}

impl Node {
    /// Returns the distances of all children, and as bits the children that the ray in `lane` meets
    /// within `limit`.
    #[inline(always)]
    fn open<S: pulp::Simd>(
        &self,
        simd: S,
        lines: &Lines,
        lane: usize,
        backwards: [bool; 3],
        limit: f32,
    ) -> ([f32; MOST_LANES], u32) {
        let lane = lane % super::approach::MOST_RAYS;
        let mut nears = [0.0; MOST_LANES];
        let mut met = 0;
        for first in (0..WIDE).step_by(S::F32_LANES) {
            let mut near = simd.splat_f32s(0.0);
            let mut far = simd.splat_f32s(limit);
            for axis in 0..3 {
                let inverse = simd.splat_f32s(lines.inverse[axis][lane]);
                let enter = simd.splat_f32s(lines.enter[axis][lane]);
                let leave = simd.splat_f32s(lines.leave[axis][lane]);
                let backwards = usize::from(backwards[axis]);
                let first_plane = columns(simd, &self.boxes[backwards][axis], first);
                let last_plane = columns(simd, &self.boxes[1 - backwards][axis], first);
                // Fused or not: the slack in `enter` and `leave` is far above the rounding of
                // either.
                near = simd.max_f32s(near, simd.mul_add_e_f32s(first_plane, inverse, enter));
                far = simd.min_f32s(far, simd.mul_add_e_f32s(last_plane, inverse, leave));
            }
            S::as_mut_simd_f32s(&mut nears).0[first / S::F32_LANES] = near;
            met |= bits_of_singles(simd, simd.less_than_or_equal_f32s(near, far)) << first;
        }
        (nears, met & ((1 << WIDE) - 1))
    }
}
