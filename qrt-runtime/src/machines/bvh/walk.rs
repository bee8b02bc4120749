//! One ray through the tree.

use super::packet::{Packet, unpack};
use super::{Bvh, Child, Node, WIDE};
use crate::machines::lanes::Lanes;

/// A ray, prepared.
pub(super) struct Line {
    origin: [f64; 3],
    inverse: [f64; 3],
    /// 1 where the direction is negative: which corner of a box the ray meets last.
    backwards: [usize; 3],
    /// Origin and direction along each axis and the two after it.
    turned: [[f64; 6]; 3],
    from: u64,
}

/// A face that the ray meets: its place in the geometry's faces.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) distance: f64,
    pub(super) rank: u32,
}

impl Line {
    pub(super) fn new(origin: [f64; 3], direction: [f64; 3], from: u64) -> Self {
        let turn = |k: usize| {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            let (o, d) = (origin, direction);
            [o[k], o[next], o[last], d[k], d[next], d[last]]
        };
        // A finite inverse keeps 0 * inf out of the boxes' tests.
        let inverse = |d: f64| 1.0 / if d.abs() < 1e-150 { 1e-150_f64.copysign(d) } else { d };
        Self {
            origin,
            inverse: direction.map(inverse),
            backwards: direction.map(|d| usize::from(d.is_sign_negative())),
            turned: [turn(0), turn(1), turn(2)],
            from,
        }
    }
}

/// Children still to visit, nearest last. A tree of depth `n` leaves at most `7 n` behind.
struct Stack {
    entries: [(f64, Child); Self::SIZE],
    length: usize,
}

impl Stack {
    const SIZE: usize = (WIDE - 1) * super::build::MAX_DEPTH + WIDE;
}

impl Bvh {
    /// The nearest face.
    #[inline(always)]
    pub(super) fn nearest<S: pulp::Simd>(
        &self,
        mut cx: Lanes<'_, S, 1>,
        line: &Line,
    ) -> Option<Found> {
        let mut best = Found { distance: f64::MAX, rank: u32::MAX };
        self.walk(&mut cx, line, &mut best, |packet, lane, distance, best| {
            let rank = packet.rank[lane];
            if distance < best.distance || (distance == best.distance && rank < best.rank) {
                *best = Found { distance, rank };
            }
            false
        });
        (best.rank != u32::MAX).then_some(best)
    }

    /// Does a face that emits nothing hide an emitter at `distance`?
    #[inline(always)]
    pub(super) fn hides<S: pulp::Simd>(
        &self,
        mut cx: Lanes<'_, S, 1>,
        line: &Line,
        distance: f64,
    ) -> bool {
        let mut limit = Found { distance, rank: u32::MAX };
        self.walk(&mut cx, line, &mut limit, |packet, lane, distance, limit| {
            let rank = packet.rank[lane] as usize;
            !self.emits[rank]
                && (distance < limit.distance
                    || (distance == limit.distance && self.hides_emitter[rank]))
        })
    }

    /// Visits the faces that the ray meets within `best`, until `visit` has seen enough.
    #[inline(always)]
    fn walk<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        line: &Line,
        best: &mut Found,
        visit: impl Fn(&Packet, usize, f64, &mut Found) -> bool,
    ) -> bool {
        let mut stack = Stack { entries: [(0.0, Child::Absent); Stack::SIZE], length: 0 };
        let mut next = if self.nodes.is_empty() { Child::Absent } else { Child::Node(0) };
        loop {
            match next {
                Child::Node(number) => {
                    let node = &self.nodes[number as usize];
                    next = node.open(cx, line, best.distance, &mut stack);
                    if next != Child::Absent {
                        continue;
                    }
                }
                Child::Packet(number) => {
                    let packet = &self.packets[number as usize];
                    for first in (0..WIDE).step_by(S::F64_LANES) {
                        let (hit, distances) =
                            packet.distances(cx, &line.turned, line.from, best.distance, first);
                        if cx.simd.first_true_m64s(hit) == S::F64_LANES {
                            continue;
                        }
                        for (lane, &distance) in unpack(&distances).iter().enumerate() {
                            if distance < f64::INFINITY && visit(packet, first + lane, distance, best)
                            {
                                return true;
                            }
                        }
                    }
                }
                Child::Absent => {}
            }
            // The nearest child left behind that is not beyond what was found since.
            loop {
                if stack.length == 0 {
                    return false;
                }
                stack.length -= 1;
                let (near, child) = stack.entries[stack.length];
                if near <= best.distance {
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
        let base = stack.length;
        for first in (0..WIDE).step_by(S::F64_LANES) {
            let at = first / S::F64_LANES;
            let mut near = simd.splat_f64s(0.0);
            let mut far = simd.splat_f64s(limit);
            for axis in 0..3 {
                let origin = simd.splat_f64s(line.origin[axis]);
                let inverse = simd.splat_f64s(line.inverse[axis]);
                let backwards = line.backwards[axis];
                let enter = S::as_simd_f64s(&self.boxes[backwards][axis]).0[at];
                let leave = S::as_simd_f64s(&self.boxes[1 - backwards][axis]).0[at];
                let enter = simd.mul_f64s(simd.sub_f64s(enter, origin), inverse);
                let leave = simd.mul_f64s(simd.sub_f64s(leave, origin), inverse);
                near = simd.max_f64s(near, enter);
                far = simd.min_f64s(far, leave);
            }
            let met = simd.less_than_or_equal_f64s(near, far);
            if simd.first_true_m64s(met) == S::F64_LANES {
                continue;
            }
            let near = simd.select_f64s(met, near, simd.splat_f64s(f64::INFINITY));
            for (lane, &near) in unpack(&near).iter().enumerate() {
                if near < f64::INFINITY {
                    // Insertion keeps the farthest first; there are few.
                    let mut place = stack.length;
                    while place > base && stack.entries[place - 1].0 < near {
                        stack.entries[place] = stack.entries[place - 1];
                        place -= 1;
                    }
                    stack.entries[place] = (near, self.children[first + lane]);
                    stack.length += 1;
                }
            }
        }
        if stack.length == base {
            return Child::Absent;
        }
        stack.length -= 1;
        stack.entries[stack.length].1
    }
}
