//! One polygon prepared for intersection: its plane, its shading frame and its edges as half-plane tests.

use super::geometry::{EdgeTest, Frame, Plane};
use glam::{DVec2, DVec3};
use qrt_scene::polygons::main_axis;

pub(super) fn plane_of(corners: &[DVec3], frame: &Frame) -> Plane {
    let axis = main_axis(frame.normal);
    let scaled = frame.normal / frame.normal[axis];
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    // Remove rounding errors: coefficients that should be 0 after a rotation by a multiple of 90 degrees,
    // and coefficients above 1 where two components are equal.
    let form = [scaled[next], scaled[last]];
    let form = form.map(|c| {
        if c.abs() < f64::EPSILON {
            0.0
        } else {
            c.clamp(-1.0, 1.0)
        }
    });
    let heights = corners
        .iter()
        .map(|c| c[axis] + form[0] * c[next] + form[1] * c[last]);
    Plane {
        axis,
        form,
        offset: heights.sum::<f64>() / corners.len() as f64,
        faces: 0..0,
        emitters: 0..0,
        outermost: false,
    }
}

pub(super) fn frame(corners: &[DVec3]) -> Frame {
    let (a, b, c) = (corners[0], corners[1], corners[2]);
    // For a quad the diagonals give the same direction and no corner is preferred.
    let normal = match corners.get(3) {
        Some(&d) => (c - a).cross(d - b),
        None => (b - a).cross(c - a),
    };
    let unit = normal.normalize();
    let axis = main_axis(unit);
    let normal = unit
        .map(|c| if c.abs() < f64::EPSILON { 0.0 } else { c })
        .normalize();
    // A tangent along a coordinate axis where the plane allows it: fewer products.
    let away = match axis {
        0 => DVec3::Y,
        1 => DVec3::Z,
        _ => DVec3::X,
    };
    let tangent = (away - normal * normal.dot(away)).normalize();
    let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
    Frame {
        tangent,
        bitangent: normal.cross(tangent),
        normal,
        centre,
    }
}

/// The test of the edge with these `ends`: a point passes if it is on the side of the `centre`, in the
/// plane's projection along its main axis.
pub(super) fn edge_test(ends: [DVec3; 2], axis: usize, centre: DVec3, tolerance: f64) -> EdgeTest {
    let flat = |p: DVec3| DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    let [start, end] = ends.map(flat);
    let across = (end - start).perp();
    let main = if across.x.abs() >= across.y.abs() {
        across.x
    } else {
        across.y
    };
    let form = across / main;
    let edge = 0.5 * (form.dot(start) + form.dot(end));
    let spread = 0.5 * (form.dot(start) - form.dot(end)).abs();
    let reach = 2.0 * tolerance + spread;
    let (low, high) = if form.dot(flat(centre)) >= edge {
        (edge - reach, f64::INFINITY)
    } else {
        (f64::NEG_INFINITY, edge + reach)
    };
    EdgeTest {
        form: form.to_array(),
        low,
        high,
    }
}

/// The half-plane tests of the edges. Parallel edges share one.
pub(super) fn edge_tests(
    corners: &[DVec3],
    axis: usize,
    centre: DVec3,
    tolerance: f64,
) -> Vec<EdgeTest> {
    let mut edge_tests: Vec<EdgeTest> = Vec::with_capacity(3);
    for (i, &start) in corners.iter().enumerate() {
        let end = corners[(i + 1) % corners.len()];
        let new = edge_test([start, end], axis, centre, tolerance);
        let parallel = |edge_test: &&mut EdgeTest| {
            let pairs = edge_test.form.into_iter().zip(new.form);
            pairs.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
        };
        match edge_tests.iter_mut().find(parallel) {
            Some(edge_test) => {
                edge_test.low = edge_test.low.max(new.low);
                edge_test.high = edge_test.high.min(new.high);
            }
            None => edge_tests.push(new),
        }
    }
    edge_tests
}
