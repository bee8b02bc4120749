//! A few spheres that are tried together.

use super::FACES;
use super::approach::{Lines, MOST_RAYS};
use super::packet::{indices, reals};
use super::walk::Search;
use crate::path_machines::lanes::{Lanes, lanes};
use crate::path_machines::masks::bits;
use qrt_tracer::{Arith, BallRay, NO_PLANE, Ray, StageGeometry, Start};

/// Spheres: constants side by side. An absent sphere has a centre that makes every comparison false.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct BallPacket {
    centre: [[f64; FACES]; 3],
    /// The squares of the radii.
    square: [f64; FACES],
    /// The numbers that stand for the spheres as starts of rays.
    number: [u64; FACES],
    /// The spheres' places, after those of all faces.
    rank: [u32; FACES],
}

impl BallPacket {
    /// Creates the packet of the spheres `ranks`, at most [`FACES`].
    pub(super) fn new(geometry: &StageGeometry, ranks: &[u32]) -> Self {
        let mut packet = Self {
            centre: [[f64::NAN; FACES]; 3],
            square: [0.0; FACES],
            number: [u64::MAX; FACES],
            rank: [u32::MAX; FACES],
        };
        for (lane, &rank) in ranks.iter().enumerate() {
            let ball = &geometry.balls[rank as usize - geometry.faces.len()];
            for (column, centre) in packet.centre.iter_mut().zip(ball.centre.to_array()) {
                column[lane] = centre;
            }
            packet.square[lane] = ball.radius * ball.radius;
            packet.number[lane] = u64::from(ball.number);
            packet.rank[lane] = rank;
        }
        packet
    }

    /// Passes to `search` the spheres that the ray in `lane` meets within its limit, and returns true as
    /// soon as the search needs no more.
    #[inline(always)]
    pub(super) fn show<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        lines: &Lines,
        lane: usize,
        search: &mut impl Search,
    ) -> bool {
        for first in (0..FACES).step_by(S::F64_LANES) {
            let (hit, distances) = self.distances(cx, (lines, lane), search.limit(), first);
            let mut left = bits(cx.simd, hit) & ((1 << FACES) - 1);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let rank = self.rank[first + lane];
                if search.meet(rank, lanes::<_, f64>(&distances)[lane]) {
                    return true;
                }
            }
        }
        false
    }

    /// Returns the spheres that the ray in `lane` meets within `limit`, beginning at sphere `first`, and
    /// their distances.
    #[inline(always)]
    fn distances<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        (lines, lane): (&Lines, usize),
        limit: f64,
        first: usize,
    ) -> (S::m64s, [S::f64s; 1]) {
        let simd = cx.simd;
        let real = |column| [reals(simd, column, first)];
        let numbers = indices(simd, &self.number, first);
        let lane = lane % MOST_RAYS;
        let (o, d) = (&lines.origin, &lines.direction);
        let ray = Ray::<Lanes<'_, S, 1>> {
            origin: [0, 1, 2].map(|axis| cx.real(o[axis][lane])),
            direction: [0, 1, 2].map(|axis| cx.real(d[axis][lane])),
            from: cx.index(NO_PLANE),
            t_max: f64::INFINITY,
            start: Start::Surface,
        };
        let left = [simd.equal_u64s(numbers, simd.splat_u64s(lines.from[lane]))];
        let centre = [0, 1, 2].map(|axis| real(&self.centre[axis]));
        let balls = BallRay::new(cx, &ray);
        let (meets, distance) = balls.nearest_of(cx, &centre, real(&self.square), left);
        let limit = cx.real(limit);
        let near = cx.less_equal(distance, limit);
        (cx.and(meets, near)[0], distance)
    }
}
