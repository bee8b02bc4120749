//! Colours at the vertices of meshes: tints that are interpolated over a face.
//!
//! The tint of a hit at `p`, its albedo or reflectance, is `m + g . (p - c)` per channel, with the face's centre `c`,
//! the tint `m` there and a gradient `g` by face. On the face's plane two coordinates are enough: those along the axes
//! after the plane's main axis. This affine function is the surface's tint times the given colour at each corner, so the
//! corners bound it. Rounding may take it beyond: it is cut off at 0 and at the face's greatest.
//!
//! If any face has colours, one table has the tints of all faces, with gradients of 0 for the others. The tint of a
//! surface with a checker still comes from the table of surfaces.

use super::bsdf::{Painted, greatest, tints};
use super::crossing::{across, weighted};
use super::geometry::StageGeometry;
use super::polygon::FaceFrame;
use super::smooth::{SLACK, barycentric_gradients, extent};
use super::vector::{self, Vector, components};
use super::{Arith, Work};
use glam::{DVec2, DVec3};
use qrt_scene::polygons::main_axis;
use qrt_scene::valid::{ColouredFace, Surface};

/// The interpolated tints of a scene.
#[derive(Clone, Debug)]
pub(crate) struct ColourStage<const C: usize> {
    /// By channel and face: the tint at the centre, its change along the two axes after the main one, and its greatest
    /// value.
    rows: [Vec<[f64; 4]>; C],
    /// By face: the main axis of its plane. That of a face without colours does not matter.
    axes: Vec<u32>,
    /// By face: 1 if its surface has a checker; none if there is no checker.
    checkered: Option<Vec<u32>>,
    /// False if all gradients are 0.
    varies: bool,
    /// A bound on the distance along each axis of a hit on a coloured face from the face's centre.
    reach: f64,
}

impl<const C: usize> ColourStage<C> {
    /// Prepares the colours of `faces`; `None` if there are no coloured faces. `surface_of` is by face.
    pub(super) fn new(
        geometry: &StageGeometry,
        faces: &[ColouredFace],
        (surfaces, surface_of): (&[&Surface], &[u32]),
        channels: [usize; C],
    ) -> Option<Self> {
        if faces.is_empty() {
            return None;
        }
        let tints = tints(surfaces);
        let plain = |&surface: &u32, channel: usize| {
            let tint = &tints[surface as usize];
            let most = greatest(tint)[channel];
            [most, 0.0, 0.0, most]
        };
        let mut rows = channels.map(|channel| -> Vec<[f64; 4]> {
            surface_of.iter().map(|s| plain(s, channel)).collect()
        });
        let main = |polygon: usize| main_axis(geometry.normal(polygon)) as u32;
        // One axis for all faces costs a circuit nothing.
        let mut axes = vec![main(faces[0].polygon); surface_of.len()];
        let mut reach: f64 = 0.0;
        for &ColouredFace { polygon, colours } in faces {
            let corners = &geometry.corners[polygon];
            reach = reach.max(extent(corners, geometry.frame(polygon).centre));
            axes[polygon] = main(polygon);
            for (rows, channel) in rows.iter_mut().zip(channels) {
                let [most, ..] = rows[polygon];
                let values = colours.map(|colour| most * colour[channel]);
                rows[polygon] = row(corners, values, &geometry.frame(polygon));
            }
        }
        let has_checker = |&surface: &u32| surfaces[surface as usize].checker().is_some();
        let checkered = surface_of.iter().any(has_checker);
        let checkered =
            checkered.then(|| surface_of.iter().map(|s| has_checker(s).into()).collect());
        let is_flat = |row: &[f64; 4]| row[1..3] == [0.0; 2];
        Some(Self {
            varies: !rows.iter().flatten().all(is_flat),
            rows,
            axes,
            checkered,
            reach: reach + SLACK,
        })
    }

    /// By surface: the greatest tint of its faces, per channel.
    pub(super) fn greatest(&self, surfaces: usize, surface_of: &[u32]) -> Vec<[f64; C]> {
        let mut greatest = vec![[0.0; C]; surfaces];
        for (face, &surface) in surface_of.iter().enumerate() {
            let most = &mut greatest[surface as usize];
            for (most, rows) in most.iter_mut().zip(&self.rows) {
                *most = f64::max(*most, rows[face][3]);
            }
        }
        greatest
    }

    /// The least distance over which the tint of a face changes by 1, in stage units, and the face.
    pub(crate) fn least_width(&self) -> Option<(usize, f64)> {
        let widths = self.rows.iter().flat_map(|rows| {
            let width = |row: &[f64; 4]| 1.0 / DVec2::new(row[1], row[2]).length();
            rows.iter().map(width).enumerate()
        });
        widths.min_by(|(_, a), (_, b)| a.total_cmp(b))
    }
}

/// A hit on `face` at `point`.
pub(super) struct ColouredHit<'a, A: Arith, const C: usize> {
    pub(super) colours: &'a ColourStage<C>,
    pub(super) face: A::Index,
    pub(super) point: &'a Vector<A>,
    /// The centre of the face; of a sphere any point.
    pub(super) centre: Vector<A>,
}

impl<A: Arith, const C: usize> Work<A> for ColouredHit<'_, A, C> {
    type Output = Painted<A, C>;

    #[inline(always)]
    fn run(self, cx: &mut A) -> Painted<A, C> {
        let Self { colours, face, .. } = self;
        let offset = colours.varies.then(|| {
            let axis = cx.entry(&colours.axes, face);
            let axis = [cx.is(axis, 0), cx.is(axis, 1)];
            let apart = vector::sub(cx, self.point, &self.centre);
            let [u, v] = across(cx, axis, &apart);
            let reach = colours.reach;
            [cx.known(u, -reach, reach), cx.known(v, -reach, reach)]
        });
        let checkered = colours.checkered.as_ref().map(|checkered| {
            let checkered = cx.entry(checkered, face);
            cx.is(checkered, 1)
        });
        Painted {
            tint: tint(cx, colours, face, offset),
            checkered,
        }
    }
}

/// The tint at an `offset` from the centre of `face`, per channel.
#[inline(always)]
fn tint<A: Arith, const N: usize>(
    cx: &mut A,
    colours: &ColourStage<N>,
    face: A::Index,
    offset: Option<[A::Real; 2]>,
) -> [A::Real; N] {
    let zero = [cx.real(0.0); N];
    components!(zero, k => channel(cx, &colours.rows[k], face, offset))
}

/// The tint in one channel, of these `rows`: at an `offset` from the centre, or at the centre.
#[inline(always)]
fn channel<A: Arith>(
    cx: &mut A,
    rows: &[[f64; 4]],
    face: A::Index,
    offset: Option<[A::Real; 2]>,
) -> A::Real {
    let [middle, along_u, along_v, most] = cx.rows(rows, face);
    let Some(offset) = offset else {
        return middle;
    };
    let change = weighted(cx, [along_u, along_v], offset);
    math!(cx, max(min(middle + change, most), 0.0))
}

/// The row of [`ColourStage::rows`] of the triangle with these `corners` and this `frame`, with `values` at the
/// corners.
fn row(corners: &[DVec3], values: [f64; 3], frame: &FaceFrame) -> [f64; 4] {
    let [second, third] = barycentric_gradients(corners);
    let gradient = second * (values[1] - values[0]) + third * (values[2] - values[0]);
    let middle = values[0] + gradient.dot(frame.centre - corners[0]);
    let axis = main_axis(frame.normal);
    // On the plane, a multiple of the normal changes nothing.
    let flat = gradient - frame.normal * (gradient[axis] / frame.normal[axis]);
    let [u, v] = [flat[(axis + 1) % 3], flat[(axis + 2) % 3]];
    [middle, u, v, values.into_iter().fold(0.0, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::frame;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn a_row_has_the_given_tints_at_the_corners(
            corners in [point(), point(), point()],
            values in [0.0..1.0_f64, 0.0..1.0, 0.0..1.0],
        ) {
            let [a, b, c] = corners;
            prop_assume!((b - a).cross(c - a).length() > 0.01);
            let frame = frame(&corners);
            let [middle, u, v, most] = row(&corners, values, &frame);
            let axis = main_axis(frame.normal);
            for (corner, value) in corners.into_iter().zip(values) {
                let offset = corner - frame.centre;
                let found = middle + u * offset[(axis + 1) % 3] + v * offset[(axis + 2) % 3];
                prop_assert!((found - value).abs() < 1e-10, "{found}, not {value}");
                prop_assert!(value <= most);
            }
            prop_assert!((middle - values.iter().sum::<f64>() / 3.0).abs() < 1e-10);
        }
    }
}
