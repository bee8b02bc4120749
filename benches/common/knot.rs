//! A torus knot as a mesh: a smooth closed tube of any number of triangles, the same bytes on every
//! machine.

use std::fmt::Write;

/// Radius of the torus that the knot is wound on, from its axis to the middle of its tube.
const TORUS: f64 = 0.31;
/// Radius of that tube.
const WINDING: f64 = 0.12;
/// Radius of the knot's own tube.
const TUBE: f64 = 0.065;

/// Returns a knot, as an OBJ file, that goes twice around the axis while it goes three times around the
/// tube. It has `2 * around * along` triangles that face outward, in a box of about 1 x 0.4 x 1 around the
/// y axis, resting on y = 0. `around` corners make a section of the tube, `along` sections the knot;
/// with fewer than three of either, no knot results.
pub(crate) fn torus_knot(around: u32, along: u32) -> String {
    let mut vertices = Vec::new();
    for section in 0..along {
        let t = std::f64::consts::TAU * f64::from(section) / f64::from(along);
        let (s2, c2) = libm::sincos(2.0 * t);
        let (s3, c3) = libm::sincos(3.0 * t);
        let radius = TORUS + WINDING * c3;
        let centre = [radius * c2, WINDING * s3, radius * s2];
        // The torus's normal, the knot's tangent, and the vector at right angles to both.
        let normal = [c3 * c2, s3, c3 * s2];
        let shrink = -3.0 * WINDING * s3;
        let tangent = [
            shrink * c2 - 2.0 * radius * s2,
            3.0 * WINDING * c3,
            shrink * s2 + 2.0 * radius * c2,
        ];
        let side = unit(cross(tangent, normal));
        for corner in 0..around {
            let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(around);
            let (sin, cos) = libm::sincos(angle);
            let at = |i: usize| centre[i] + TUBE * (cos * normal[i] + sin * side[i]);
            vertices.push([at(0), at(1), at(2)]);
        }
    }
    let floor = vertices.iter().map(|v| v[1]).fold(f64::INFINITY, f64::min);
    let mut text = format!(
        "# A (2, 3) torus knot of {} triangles: cargo run --example make-knot {around} {along}\n",
        2 * around * along
    );
    // Writing to a string cannot fail.
    for [x, y, z] in vertices {
        let _ = writeln!(text, "v {x:.6} {:.6} {z:.6}", y - floor);
    }
    for section in 0..along {
        for corner in 0..around {
            let vertex =
                |section: u32, corner: u32| (section % along) * around + corner % around + 1;
            let (a, b) = (vertex(section, corner), vertex(section, corner + 1));
            let (c, d) = (vertex(section + 1, corner + 1), vertex(section + 1, corner));
            let _ = writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}");
        }
    }
    text
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|x| x / length)
}
