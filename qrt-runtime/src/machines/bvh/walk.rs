//! One ray through the tree.

use super::packet::{bits, unpack};
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
        let inverse = |d: f64| {
            1.0 / if d.abs() < 1e-150 {
                1e-150_f64.copysign(d)
            } else {
                d
            }
        };
        Self {
            origin,
            inverse: direction.map(inverse),
            backwards: direction.map(|d| usize::from(d.is_sign_negative())),
            turned: [turn(0), turn(1), turn(2)],
            from,
        }
    }
}

/// Children still to visit with the distances of their boxes, nearest last.
pub(super) type Stack = Vec<(f64, Child)>;

/// What a walk looks for. (A trait and not a closure: see [`crate::machines::lanes`].)
trait Search {
    /// Nothing beyond this distance matters.
    fn limit(&self) -> f64;
    /// The ray meets face `rank` at `distance`: has the search seen enough?
    fn meet(&mut self, rank: u32, distance: f64) -> bool;
}

/// The nearest face; of equally near ones the first.
struct NearestFace {
    best: Found,
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

/// A walk, to be run as a function of its own: it has the registers to itself, and is compiled
/// apart from the tracer.
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
    /// The nearest face.
    #[inline(always)]
    pub(super) fn nearest<S: pulp::Simd>(
        &self,
        cx: Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
    ) -> Option<Found> {
        let mut search = NearestFace {
            best: Found {
                distance: f64::MAX,
                rank: u32::MAX,
            },
        };
        apart(Walk {
            bvh: self,
            cx,
            line,
            stack,
            search: &mut search,
            enough: &mut false,
        });
        (search.best.rank != u32::MAX).then_some(search.best)
    }

    /// Does a face that emits nothing hide an emitter at `distance`?
    #[inline(always)]
    pub(super) fn hides<S: pulp::Simd>(
        &self,
        cx: Lanes<'_, S, 1>,
        line: &Line,
        stack: &mut Stack,
        distance: f64,
    ) -> bool {
        let mut search = Hides {
            bvh: self,
            distance,
        };
        let mut enough = false;
        apart(Walk {
            bvh: self,
            cx,
            line,
            stack,
            search: &mut search,
            enough: &mut enough,
        });
        enough
    }

    /// Shows `search` the faces that the ray meets within its limit, until it has seen enough;
    /// tells whether it has.
    #[inline(always)]
    fn walk<S: pulp::Simd, T: Search>(
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
                Child::Packet(number) => {
                    let packet = &self.packets[number as usize];
                    for first in (0..WIDE).step_by(S::F64_LANES) {
                        let limit = search.limit();
                        let (hit, distances) =
                            packet.distances(cx, &line.turned, line.from, limit, first);
                        let mut left = bits(cx.simd, hit);
                        while left != 0 {
                            let lane = left.trailing_zeros() as usize;
                            left &= left - 1;
                            let rank = packet.rank[first + lane];
                            if search.meet(rank, unpack(&distances)[lane]) {
                                return true;
                            }
                        }
                    }
                }
                Child::Absent => {}
            }
            // The nearest child left behind that is not beyond what was found since.
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
        let base = stack.len();
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
            let mut left = bits(simd, met);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let near = unpack(&near)[lane];
                // Insertion keeps the farthest first; there are few.
                let mut place = stack.len();
                stack.push((near, self.children[first + lane]));
                while place > base && stack[place - 1].0 < near {
                    stack.swap(place - 1, place);
                    place -= 1;
                }
            }
        }
        if stack.len() == base {
            return Child::Absent;
        }
        stack.pop().map_or(Child::Absent, |(_, child)| child)
    }
}
