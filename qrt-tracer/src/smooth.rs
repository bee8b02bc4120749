//! Smooth shading: normals that are interpolated over a face.
//!
//! The normal at a hit `p` is `n = m + G (p - c)`, with the face's centre `c`, the normal `m` there and a
//! matrix `G` by face, over its length: an affine function that has the given normals at the corners.
//!
//! The face itself stays flat. Its own normal decides where a ray meets it, which side is seen, and where
//! the path may go on:
//!
//! * A viewer behind the interpolated normal, as there are at silhouettes, sees the face's own normal.
//! * A path whose next direction is on one side of the face and on the other side of the normal ends
//!   there, and so does the light of a lamp. Without this rule light would leak into solids. PBRT 3 has
//!   the same rule for materials that are not mirrors or glass (`BSDF::f`).
//!
//! A sampled direction thus weighs as much as on a flat face, or nothing. The light of a point on a lamp is
//! bounded without the cosine at the surface, so with sampled lamps the bound on a path's colour may be
//! greater than that of flat faces.

use super::geometry::StageGeometry;
use super::vector::{self, Vector};
use super::{Arith, Work};
use glam::{DMat3, DVec3};
use qrt_scene::valid::{LEAST_NORMAL, SmoothFace};

/// The interpolated normals of a scene.
#[derive(Clone, Debug)]
pub(crate) struct SmoothStage {
    /// By face: 1 if its normal is interpolated, else 0.
    is_smooth: Vec<u32>,
    /// By face: the normal at the centre, its change along x, y and z, and the centre; zeros for a flat
    /// face.
    rows: Vec<[f64; 15]>,
    /// A bound on the distance along each axis of a hit on a smooth face from the face's centre.
    reach: f64,
}

/// A bound on the rounding of a hit, in stage units.
pub(super) const SLACK: f64 = 1.0 / 32.0;

impl SmoothStage {
    /// Prepares the normals of `faces`; `None` if there are no smooth faces.
    pub(super) fn new(geometry: &StageGeometry, faces: &[SmoothFace]) -> Option<Self> {
        if faces.is_empty() {
            return None;
        }
        let number = geometry.corners.len() + geometry.balls.len();
        let (mut is_smooth, mut rows) = (vec![0; number], vec![[0.0; 15]; number]);
        let mut reach: f64 = 0.0;
        for &SmoothFace { polygon, normals } in faces {
            let centre = geometry.frame(polygon).centre;
            let corners = &geometry.corners[polygon];
            is_smooth[polygon] = 1;
            rows[polygon] = row(corners, normals, centre);
            reach = reach.max(extent(corners, centre));
        }
        Some(Self {
            is_smooth,
            rows,
            reach: reach + SLACK,
        })
    }

    /// The least radius of curvature of a smooth face, in stage units, and its face: a normal changes by
    /// about the distance over this radius.
    pub(crate) fn least_radius(&self) -> Option<(usize, f64)> {
        let radius = |row: &[f64; 15]| {
            let changes = row[3..12].chunks(3).map(DVec3::from_slice);
            1.0 / changes.map(DVec3::length).fold(0.0, f64::max)
        };
        let radii = self.rows.iter().map(radius).enumerate();
        radii.min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// True if the normal of `face` is interpolated.
    pub(super) fn is_smooth(&self, face: u32) -> bool {
        self.is_smooth[face as usize] == 1
    }
}

/// A hit on `face` at `point`, with the face's own normal.
pub(super) struct FlatHit<'a, A: Arith> {
    pub(super) face: A::Index,
    pub(super) point: Vector<A>,
    /// The direction in which the path arrived.
    pub(super) arriving: Vector<A>,
    /// True if the viewer sees the front of the face.
    pub(super) front: A::Bool,
    /// The face's own normal.
    pub(super) normal: Vector<A>,
    /// The dot product of the arriving direction and `normal`.
    pub(super) cos_theta: A::Real,
    pub(super) smooth: &'a SmoothStage,
}

/// The normal of a hit, in a scene that has smooth faces.
pub(super) struct Interpolated<A: Arith> {
    /// True if the face is smooth.
    pub(super) is: A::Bool,
    /// The interpolated normal, or the face's own.
    pub(super) normal: Vector<A>,
    /// The dot product of the arriving direction and `normal`.
    pub(super) cos_theta: A::Real,
}

impl<A: Arith> Work<A> for FlatHit<'_, A> {
    type Output = Interpolated<A>;

    #[inline(always)]
    fn run(self, cx: &mut A) -> Interpolated<A> {
        let Self { face, smooth, .. } = self;
        let is = cx.entry(&smooth.is_smooth, face);
        let is = cx.is(is, 1);
        let row = cx.rows(&smooth.rows, face);
        let [.., gx, gy, gz] = row;
        let (offset, reach) = (vector!(cx, self.point - [gx, gy, gz]), smooth.reach);
        let offset = [
            cx.known(offset[0], -reach, reach),
            cx.known(offset[1], -reach, reach),
            cx.known(offset[2], -reach, reach),
        ];
        let bent = [
            component(cx, &row, &offset, 0),
            component(cx, &row, &offset, 1),
            component(cx, &row, &offset, 2),
        ];
        // Rounding may shorten a normal.
        let normal = vector::normalize(cx, &bent, 2.0 / LEAST_NORMAL);
        let cos = math!(cx, known(dot(self.arriving, normal), -1.0, 1.0));
        let faces_viewer = math!(cx, select_truth(self.front, cos < 0.0, 0.0 < cos));
        let takes = cx.and(is, faces_viewer);
        Interpolated {
            is,
            normal: vector::select(cx, takes, &normal, &self.normal),
            cos_theta: cx.select(takes, cos, self.cos_theta),
        }
    }
}

/// One component of the interpolated normal, before it has unit length.
#[inline(always)]
fn component<A: Arith>(
    cx: &mut A,
    row: &[A::Real; 15],
    offset: &Vector<A>,
    axis: usize,
) -> A::Real {
    let change = [row[3 + axis], row[6 + axis], row[9 + axis]];
    math!(cx, known(row[axis] + dot(change, *offset), -1.0, 1.0))
}

/// The greatest distance along an axis of one of `corners` from the `centre`.
pub(super) fn extent(corners: &[DVec3], centre: DVec3) -> f64 {
    let extents = corners.iter().map(|&c| (c - centre).abs().max_element());
    extents.fold(0.0, f64::max)
}

/// The gradients of the barycentric coordinates of the second and the third of a triangle's `corners`, along its
/// plane.
pub(super) fn barycentric_gradients(corners: &[DVec3]) -> [DVec3; 2] {
    let [a, b, c] = [corners[0], corners[1], corners[2]];
    let across = (b - a).cross(c - a);
    let square = across.length_squared();
    [(c - a).cross(across) / square, across.cross(b - a) / square]
}

/// The row of [`SmoothStage::rows`] of the triangle with these `corners`, with `normals` there.
fn row(corners: &[DVec3], normals: [DVec3; 3], centre: DVec3) -> [f64; 15] {
    let gradients = barycentric_gradients(corners);
    let steps = [normals[1] - normals[0], normals[2] - normals[0]];
    let column = |axis: usize| steps[0] * gradients[0][axis] + steps[1] * gradients[1][axis];
    let change = DMat3::from_cols(column(0), column(1), column(2));
    let middle = normals[0] + change * (centre - corners[0]);
    let mut row = [0.0; 15];
    middle.write_to_slice(&mut row);
    change.write_cols_to_slice(&mut row[3..]);
    centre.write_to_slice(&mut row[12..]);
    row
}
