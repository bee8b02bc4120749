//! Eight faces, tried at once.

use super::WIDE;
use super::walk::{Line, Search};
use crate::machines::lanes::Lanes;
use pulp::bytemuck;
use qrt_core::tracer::{Arith, AxisPermuted, Geometry, cross, weighted};

/// Edges of a face, at most.
const EDGES: usize = 4;

/// Eight faces with one main axis: constants side by side, in the order in which they are read. An
/// absent face has a plane that no ray crosses.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    /// The plane's form and offset.
    form: [[f64; WIDE]; 2],
    offset: [f64; WIDE],
    plane: [u64; WIDE],
    /// Per edge, `a x + b y >= low`.
    edges: [[[f64; WIDE]; 3]; EDGES],
    /// The faces' places in [`Geometry::faces`].
    rank: [u32; WIDE],
    /// Edges of the face that has most.
    most_edges: u32,
}

/// By place in [`Geometry::faces`]: the face's plane.
pub(super) fn planes_of_faces(geometry: &Geometry) -> Vec<u32> {
    let mut planes = vec![0; geometry.faces.len()];
    for (number, plane) in geometry.planes.iter().enumerate() {
        planes[plane.faces.clone()].fill(number as u32);
    }
    planes
}

impl Packet {
    /// The faces `ranks`, at most eight, which share a main axis.
    pub(super) fn new(geometry: &Geometry, planes: &[u32], ranks: &[u32]) -> Self {
        let everywhere = [[0.0; WIDE], [0.0; WIDE], [f64::NEG_INFINITY; WIDE]];
        let mut packet = Self {
            // A face whose cos_theta is NaN is never ahead.
            form: [[f64::NAN; WIDE]; 2],
            offset: [0.0; WIDE],
            edges: [everywhere; EDGES],
            most_edges: 0,
            plane: [u64::MAX; WIDE],
            rank: [u32::MAX; WIDE],
        };
        for (lane, &rank) in ranks.iter().enumerate() {
            let number = planes[rank as usize];
            let plane = &geometry.planes[number as usize];
            packet.form[0][lane] = plane.form[0];
            packet.form[1][lane] = plane.form[1];
            packet.offset[lane] = plane.offset;
            packet.plane[lane] = u64::from(number);
            packet.rank[lane] = rank;
            let mut edge = 0;
            for edge_test in &geometry.faces[rank as usize].edge_tests {
                // The negated form has the negated value exactly, so that one comparison serves.
                let sides = [(1.0, edge_test.low), (-1.0, -edge_test.high)];
                for (sign, low) in sides.into_iter().filter(|(_, low)| low.is_finite()) {
                    let constants = [sign * edge_test.form[0], sign * edge_test.form[1], low];
                    for (column, constant) in packet.edges[edge].iter_mut().zip(constants) {
                        column[lane] = constant;
                    }
                    edge += 1;
                }
            }
            packet.most_edges = packet.most_edges.max(edge as u32);
        }
        packet
    }

    /// Shows `search` the faces that the ray meets within its limit, until it has seen enough;
    /// tells whether it has. `axis` is the faces' main axis.
    #[inline(always)]
    pub(super) fn show<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        axis: u8,
        line: &Line,
        search: &mut impl Search,
    ) -> bool {
        for first in (0..WIDE).step_by(S::F64_LANES) {
            let (hit, distances) = self.distances(cx, axis, line, search.limit(), first);
            let mut left = bits(cx.simd, hit);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if search.meet(self.rank[first + lane], unpack(&distances)[lane]) {
                    return true;
                }
            }
        }
        false
    }

    /// Which faces the ray meets within `limit`, beginning at face `first`, and their distances.
    #[inline(always)]
    fn distances<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        axis: u8,
        line: &Line,
        limit: f64,
        first: usize,
    ) -> (S::m64s, S::f64s) {
        let at = first / S::F64_LANES;
        let real = |column: &[f64; WIDE]| [S::as_simd_f64s(column).0[at]];
        let index = |column: &[u64; WIDE]| [S::as_simd_u64s(column).0[at]];
        let axis = usize::from(axis) % 3;
        let (o, d) = (&line.origin, &line.direction);
        let ray = AxisPermuted::<Lanes<'_, S, 1>> {
            origin: cx.real(o[axis]),
            direction: cx.real(d[axis]),
            origin_across: [cx.real(o[axis + 1]), cx.real(o[axis + 2])],
            direction_across: [cx.real(d[axis + 1]), cx.real(d[axis + 2])],
            reach: f64::INFINITY,
        };
        let form = [real(&self.form[0]), real(&self.form[1])];
        let crossing = cross(cx, form, real(&self.offset), &ray);
        let limit = cx.real(limit);
        let near = cx.less_equal(crossing.distance, limit);
        let mut hit = cx.and(crossing.ahead, near);
        if !cx.any(hit) {
            return (hit[0], crossing.distance[0]);
        }
        let left = [cx
            .simd
            .equal_u64s(index(&self.plane)[0], cx.simd.splat_u64s(line.from))];
        let other = cx.not(left);
        hit = cx.and(hit, other);
        for edge in &self.edges[..self.most_edges as usize] {
            let form = [real(&edge[0]), real(&edge[1])];
            let value = weighted(cx, form, crossing.point);
            let inside = cx.less_equal(real(&edge[2]), value);
            hit = cx.and(hit, inside);
        }
        (hit[0], crossing.distance[0])
    }
}

/// The lanes of a register as a slice.
#[inline(always)]
fn unpack<T: bytemuck::Pod>(register: &T) -> &[f64] {
    bytemuck::cast_slice(std::slice::from_ref(register))
}

/// The lanes in which `mask` holds, as bits.
#[inline(always)]
pub(super) fn bits<S: pulp::Simd>(simd: S, mask: S::m64s) -> u32 {
    if size_of::<S::m64s>() == 1 {
        // A mask register, or the truth value of a single lane.
        return u32::from(bytemuck::bytes_of(&mask)[0]);
    }
    let flags = simd.select_u64s(mask, simd.splat_u64s(1), simd.splat_u64s(0));
    let flags: &[u64] = bytemuck::cast_slice(std::slice::from_ref(&flags));
    let mut bits = 0;
    for (lane, &flag) in flags.iter().enumerate() {
        bits |= (flag as u32) << lane;
    }
    bits
}
