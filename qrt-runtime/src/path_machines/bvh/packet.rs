//! A few faces that are tried together.

use super::FACES;
use super::approach::{Lines, MOST_RAYS};
use super::walk::Search;
use crate::path_machines::lanes::{Lanes, lanes};
use crate::path_machines::masks::bits;
use qrt_tracer::{Arith, AxisPermuted, DiscNumbers, StageGeometry, cross, weighted};

/// Largest number of edges of a face.
const EDGES: usize = 4;

/// Faces with one main axis: constants side by side, in the order in which they are read. An
/// absent face has a plane that no ray crosses.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    /// The plane's form and offset.
    form: [[f64; FACES]; 2],
    offset: [f64; FACES],
    plane: [u64; FACES],
    /// Per edge, `a x + b y >= low`.
    edges: [[[f64; FACES]; 3]; EDGES],
    /// The faces' places in [`StageGeometry::faces`].
    rank: [u32; FACES],
    /// Number of edges of the face that has the most.
    most_edges: u32,
    /// The tests of discs, if the packet has any.
    discs: Option<Box<DiscColumns>>,
}

/// The tests of discs, by face: see [`DiscTest`](qrt_tracer::DiscTest). Numbers of another face make its
/// test true for every point.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct DiscColumns {
    /// The forms of both edge tests.
    forms: [[[f64; FACES]; 2]; 2],
    centre: [[f64; FACES]; 2],
    scale: [[f64; FACES]; 2],
    square: [f64; FACES],
}

impl DiscColumns {
    /// The tests of the faces `ranks`; none if no face is a disc.
    fn new(geometry: &StageGeometry, ranks: &[u32]) -> Option<Box<Self>> {
        let mut columns = Box::new(Self {
            forms: [[[0.0; FACES]; 2]; 2],
            centre: [[0.0; FACES]; 2],
            scale: [[0.0; FACES]; 2],
            square: [f64::INFINITY; FACES],
        });
        let mut has_disc = false;
        for (lane, &rank) in ranks.iter().enumerate() {
            let face = &geometry.faces[rank as usize];
            let Some(disc) = &face.disc else {
                continue;
            };
            has_disc = true;
            for k in 0..2 {
                let form = face.edge_tests[k].form;
                (columns.forms[k][0][lane], columns.forms[k][1][lane]) = (form[0], form[1]);
                columns.centre[k][lane] = disc.centre[k];
                columns.scale[k][lane] = disc.scale[k];
            }
            columns.square[lane] = disc.square;
        }
        has_disc.then_some(columns)
    }

    /// The faces, beginning at face `first`, whose tests `point` passes.
    #[inline(always)]
    fn hold<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        first: usize,
        point: [[S::f64s; 1]; 2],
    ) -> [S::m64s; 1] {
        let simd = cx.simd;
        let real = |column| [reals(simd, column, first)];
        let numbers = DiscNumbers::<Lanes<'_, S, 1>> {
            centre: [real(&self.centre[0]), real(&self.centre[1])],
            scale: [real(&self.scale[0]), real(&self.scale[1])],
            square: real(&self.square),
            most: 0.0,
        };
        let values = [0, 1].map(|k| {
            let form = [real(&self.forms[k][0]), real(&self.forms[k][1])];
            weighted(cx, form, point)
        });
        numbers.hold(cx, values)
    }
}

/// Returns the plane of each face, in the order of [`StageGeometry::faces`].
pub(super) fn planes_of_faces(geometry: &StageGeometry) -> Vec<u32> {
    let mut planes = vec![0; geometry.faces.len()];
    for (number, plane) in geometry.planes.iter().enumerate() {
        planes[plane.faces.clone()].fill(number as u32);
    }
    planes
}

/// Loads a register of a column from face `first` on. If the register has more lanes than there are
/// faces, the remaining lanes have no meaning.
#[inline(always)]
pub(super) fn reals<S: pulp::Simd>(simd: S, column: &[f64; FACES], first: usize) -> S::f64s {
    if S::F64_LANES > FACES {
        simd.partial_load_f64s(column)
    } else {
        S::as_simd_f64s(column).0[first / S::F64_LANES]
    }
}

/// The same for integers.
#[inline(always)]
pub(super) fn indices<S: pulp::Simd>(simd: S, column: &[u64; FACES], first: usize) -> S::u64s {
    if S::F64_LANES > FACES {
        simd.partial_load_u64s(column)
    } else {
        S::as_simd_u64s(column).0[first / S::F64_LANES]
    }
}

impl Packet {
    /// Creates the packet of the faces `ranks`, at most [`FACES`], which share a main axis.
    pub(super) fn new(geometry: &StageGeometry, planes: &[u32], ranks: &[u32]) -> Self {
        let everywhere = [[0.0; FACES], [0.0; FACES], [f64::NEG_INFINITY; FACES]];
        let mut packet = Self {
            // A face whose cos_theta is NaN is never ahead.
            form: [[f64::NAN; FACES]; 2],
            offset: [0.0; FACES],
            edges: [everywhere; EDGES],
            most_edges: 0,
            discs: DiscColumns::new(geometry, ranks),
            plane: [u64::MAX; FACES],
            rank: [u32::MAX; FACES],
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
                // The value of the negated form is exactly the negated value, so one kind of
                // comparison is enough.
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

    /// Passes to `search` the faces that the ray in `lane` meets within its limit, and returns true
    /// as soon as the search needs no more. `axis` is the faces' main axis.
    #[inline(always)]
    pub(super) fn show<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        axis: u8,
        lines: &Lines,
        lane: usize,
        search: &mut impl Search,
    ) -> bool {
        for first in (0..FACES).step_by(S::F64_LANES) {
            let (hit, distances) = self.distances(cx, axis, (lines, lane), search.limit(), first);
            let mut left = bits(cx.simd, hit) & ((1 << FACES) - 1);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if search.meet(self.rank[first + lane], lanes::<_, f64>(&distances)[lane]) {
                    return true;
                }
            }
        }
        false
    }

    /// Returns the faces that the ray in `lane` meets within `limit`, beginning at face `first`,
    /// and their distances.
    #[inline(always)]
    fn distances<S: pulp::Simd>(
        &self,
        cx: &mut Lanes<'_, S, 1>,
        axis: u8,
        (lines, lane): (&Lines, usize),
        limit: f64,
        first: usize,
    ) -> (S::m64s, [S::f64s; 1]) {
        let simd = cx.simd;
        let real = |column| [reals(simd, column, first)];
        let axis = usize::from(axis) % 3;
        let lane = lane % MOST_RAYS;
        let (o, d) = (&lines.origin, &lines.direction);
        let ray = AxisPermuted::<Lanes<'_, S, 1>> {
            origin: cx.real(o[axis][lane]),
            direction: cx.real(d[axis][lane]),
            origin_across: [cx.real(o[axis + 1][lane]), cx.real(o[axis + 2][lane])],
            direction_across: [cx.real(d[axis + 1][lane]), cx.real(d[axis + 2][lane])],
            t_max: f64::INFINITY,
        };
        let form = [real(&self.form[0]), real(&self.form[1])];
        let crossing = cross(cx, form, real(&self.offset), &ray);
        let limit = cx.real(limit);
        let near = cx.less_equal(crossing.distance, limit);
        let mut hit = cx.and(crossing.ahead, near);
        let left = [cx.simd.equal_u64s(
            indices(simd, &self.plane, first),
            cx.simd.splat_u64s(lines.from[lane]),
        )];
        let other = cx.not(left);
        hit = cx.and(hit, other);
        // Triangles are by far the most frequent, and a branch costs more than an edge.
        let count = if self.most_edges > 3 { EDGES } else { 3 };
        for edge in &self.edges[..count] {
            let form = [real(&edge[0]), real(&edge[1])];
            let value = weighted(cx, form, crossing.point);
            let inside = cx.less_equal(real(&edge[2]), value);
            hit = cx.and(hit, inside);
        }
        if let Some(discs) = &self.discs {
            let within = discs.hold(cx, first, crossing.point);
            hit = cx.and(hit, within);
        }
        (hit[0], crossing.distance)
    }
}
