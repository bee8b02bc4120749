//! One ray through the tree.

use super::packet::bits;
use super::{Bvh, Child, Node, WIDE};
use crate::machines::lanes::Lanes;

/// A ray with what the boxes' tests need of it, computed once.
#[derive(Clone, Copy)]
pub(super) struct Line {
    /// Along x, y, z, x, y, so that those from any axis on are neighbours.
    pub(super) origin: [f64; 5],
    pub(super) direction: [f64; 5],
    /// Of each component of the direction.
    pub(super) inverse: [f64; 3],
    /// A box's plane is at the distance `plane inverse + start`.
    pub(super) start: [f64; 3],
    /// By axis: whether the direction is negative.
    pub(super) backwards: [bool; 3],
    pub(super) from: u64,
}

/// A face that the ray meets: its place in the geometry's faces.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) distance: f64,
    pub(super) rank: u32,
}

impl Found {
    pub(super) const NONE: Self = Self {
        distance: f64::MAX,
        rank: u32::MAX,
    };
}

impl Line {
    #[inline(always)]
    pub(super) fn new([x, y, z]: [f64; 3], direction: [f64; 3], from: u64) -> Self {
        let [dx, dy, dz] = direction;
        // A finite inverse keeps 0 * inf out of the boxes' tests.
        let inverse = |d: f64| {
            1.0 / if d.abs() < 1e-100 {
                1e-100_f64.copysign(d)
            } else {
                d
            }
        };
        let inverse = [inverse(dx), inverse(dy), inverse(dz)];
        Self {
            origin: [x, y, z, x, y],
            direction: [dx, dy, dz, dx, dy],
            inverse,
            start: [-x * inverse[0], -y * inverse[1], -z * inverse[2]],
            backwards: direction.map(f64::is_sign_negative),
            from,
        }
    }
}

/// Children still to visit with the distances of their boxes, nearest last.
pub(super) type Stack = Vec<(f64, Child)>;

/// What a walk looks for. (A trait and not a closure: see [`crate::machines::lanes`].)
pub(super) trait Search {
    /// Nothing beyond this distance matters.
    fn limit(&self) -> f64;
    /// The ray meets face `rank` at `distance`: whether the search has seen enough.
    fn meet(&mut self, rank: u32, distance: f64) -> bool;
}

/// The nearest face; of equally near ones the first.
pub(super) struct NearestFace {
    pub(super) best: Found,
}

impl Default for NearestFace {
    fn default() -> Self {
        Self { best: Found::NONE }
    }
}

impl Search for NearestFace {
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

/// Any face that hides an emitter.
struct Hides<'a> {
    bvh: &'a Bvh,
    distance: f64,
}

impl Search for Hides<'_> {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.distance
    }
    #[inline(always)]
    fn meet(&mut self, rank: u32, distance: f64) -> bool {
        let rank = rank as usize;
        let hides = distance < self.distance || self.bvh.hides_emitter[rank];
        hides && !self.bvh.emits[rank]
    }
}

/// Any face before the end of a ray on an emitting face, one length of its direction away.
struct Blocks<'a> {
    bvh: &'a Bvh,
    lamp: u32,
}

impl Search for Blocks<'_> {
    #[inline(always)]
    fn limit(&self) -> f64 {
        // Faces in the emitter's plane are met at its end, up to rounding.
        1.0 + 1e-6
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

/// A walk of one ray, to be run as a function of its own: it has the registers to itself, and is
/// compiled apart from the tracer.
struct Walk<'a, S, T> {
    bvh: &'a Bvh,
    cx: Lanes<'a, S, 1>,
    line: &'a Line,
    stack: &'a mut Stack,
    search: &'a mut T,
    enough: &'a mut bool,
}

#[inline(never)]
fn apart<S: pulp::Simd, T: Search>(walk: Walk<'_, S, T>) {
    walk.cx.simd.vectorize(walk);
}

impl<S: pulp::Simd, T: Search> pulp::WithSimd for Walk<'_, S, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: pulp::Simd>(mut self, _: U) {
        *self.enough = self
            .bvh
            .walk(&mut self.cx, self.line, self.stack, self.search);
    }
}

impl Bvh {
    /// Whether a face that emits nothing hides an emitter at `distance`.
    #[inline(always)]
    pub(super) fn hides<S: pulp::Simd>(
        &self,
        cx: Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
        distance: f64,
    ) -> bool {
        let bvh = self;
        self.finds(cx, line, stack, &mut Hides { bvh, distance })
    }

    /// Whether a face stands between the start of the ray and its end on emitting face `lamp`.
    #[inline(always)]
    pub(super) fn blocks<S: pulp::Simd>(
        &self,
        cx: Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
        lamp: u32,
    ) -> bool {
        let bvh = self;
        self.finds(cx, line, stack, &mut Blocks { bvh, lamp })
    }

    /// Whether `search` sees enough.
    #[inline(always)]
    fn finds<S: pulp::Simd>(
        &self,
        cx: Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
        search: &mut impl Search,
    ) -> bool {
        let mut enough = false;
        apart(Walk {
            bvh: self,
            cx,
            line,
            stack,
            search,
            enough: &mut enough,
        });
        enough
    }

    /// Shows `search` the faces that the ray meets within its limit, until it has seen enough;
    /// tells whether it has.
    #[inline(always)]
    pub(super) fn walk<S: pulp::Simd, T: Search>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
        search: &mut T,
    ) -> bool {
        stack.clear();
        let mut next = if self.nodes.is_empty() {
            Child::Absent
        } else {
            Child::Node(0)
        };
        loop {
            match next {
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    next = node.open(cx, line, search.limit(), stack);
                    if next != Child::Absent {
                        continue;
                    }
                }
                Child::Packet(number, axis) => {
                    let packet = &self.packets[number as usize];
                    if packet.show(cx, axis, line, search) {
                        return true;
                    }
                }
                Child::Absent => {}
            }
            // The nearest child on the stack that is not beyond what was found since.
            loop {
                let Some((near, child)) = stack.pop() else {
                    return false;
                };
                if near <= search.limit() {
                    next = child;
                    break;
                }
            }
        }
    }
}

impl Node {
    /// Pushes the children that the ray meets within `limit`, but for the nearest, which it
    /// returns.
    #[inline(always)]
    fn open<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        line: &Line,
        limit: f64,
        stack: &mut Stack,
    ) -> Child {
        let simd = cx.simd;
        let mut nears = [0.0; WIDE];
        let mut left = 0;
        for first in (0..WIDE).step_by(S::F64_LANES) {
            let at = first / S::F64_LANES;
            let mut near = simd.splat_f64s(0.0);
            let mut far = simd.splat_f64s(limit);
            for axis in 0..3 {
                let inverse = simd.splat_f64s(line.inverse[axis]);
                let start = simd.splat_f64s(line.start[axis]);
                let backwards = usize::from(line.backwards[axis]);
                let enter = S::as_simd_f64s(&self.boxes[backwards][axis]).0[at];
                let leave = S::as_simd_f64s(&self.boxes[1 - backwards][axis]).0[at];
                // Fused or not: the boxes' margins are far above either's rounding.
                let enter = simd.mul_add_e_f64s(enter, inverse, start);
                let leave = simd.mul_add_e_f64s(leave, inverse, start);
                near = simd.max_f64s(near, enter);
                far = simd.min_f64s(far, leave);
            }
            S::as_mut_simd_f64s(&mut nears).0[at] = near;
            left |= bits(simd, simd.less_than_or_equal_f64s(near, far)) << first;
        }
        if left == 0 {
            return Child::Absent;
        }
        // One child, by far the most frequent, takes no detour over the stack.
        let lane = left.trailing_zeros() as usize % WIDE;
        left &= left - 1;
        let mut nearest = (nears[lane], self.children[lane]);
        let base = stack.len();
        while left != 0 {
            let lane = left.trailing_zeros() as usize % WIDE;
            left &= left - 1;
            let mut other = (nears[lane], self.children[lane]);
            if other.0 < nearest.0 {
                std::mem::swap(&mut other, &mut nearest);
            }
            // Insertion keeps the farthest first; there are few.
            let mut place = stack.len();
            stack.push(other);
            while place > base && stack[place - 1].0 < other.0 {
                stack.swap(place - 1, place);
                place -= 1;
            }
        }
        nearest.1
    }
}
