//! One polygon prepared for intersection: its plane, its shading frame and its edges as half-plane tests.

use glam::{DVec2, DVec3};
use qrt_scene::polygons::main_axis;
use std::cmp::Ordering;
use std::ops::Range;

/// The eye is on a plane if it is nearer than this, in stage units and relative to 1 plus its height.
const ON_PLANE: f64 = 1.0 / (1_u64 << 46) as f64;

/// `low <= a p[axis + 1] + b p[axis + 2] <= high`, for a point of a plane with main axis `axis`
/// (axes are counted cyclically). The greater of `|a|`, `|b|` is 1; a bound may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeTest {
    /// The coefficients `a` and `b`.
    pub form: [f64; 2],
    /// The least value of the form inside; may be -infinity.
    pub low: f64,
    /// The greatest value of the form inside; may be infinity.
    pub high: f64,
}

/// The test that a point of a disc's plane is within the circle: `u^2 + v^2 <= square`.
///
/// Let `w` be the values of the forms of the disc's two [edge tests](EdgeTest), those of the square around it.
/// Then `u = (w[0] - centre[0]) scale[0]` and `v = (w[1] - centre[1]) scale[1]`. Neither exceeds 1 within
/// the square, so circuits square numbers of few bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscTest {
    /// The values of both forms at the centre.
    pub centre: [f64; 2],
    /// The factors that take both half widths of the square to one length in `(1/2, 1]`. One is a power of
    /// two, and both are for an axis-aligned plane: a product with it costs a circuit nothing.
    pub scale: [f64; 2],
    /// The square of that length.
    pub square: f64,
}

/// The tests of points on a face's plane: a point within the face passes all.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    pub(super) edge_tests: Vec<EdgeTest>,
    /// The circle of a disc, whose square the edge tests bound.
    pub(super) disc: Option<Box<DiscTest>>,
}

impl Outline {
    /// True if every point passes.
    pub(super) fn is_open(&self) -> bool {
        self.edge_tests.is_empty() && self.disc.is_none()
    }
}

/// The plane `p[axis] + a p[axis + 1] + b p[axis + 2] = offset` (axes are counted cyclically), and
/// the faces on it. Neither `|a|` nor `|b|` exceeds 1; an axis-aligned plane has zeros, which cost
/// a circuit nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// The main axis: that of the normal's greatest component.
    pub axis: usize,
    /// The coefficients `a` and `b`.
    pub form: [f64; 2],
    /// The plane's offset along its main axis, in stage units.
    pub offset: f64,
    /// The range of [`StageGeometry::faces`](super::StageGeometry::faces) that lies on the plane.
    pub faces: Range<usize>,
    /// The numbers of its emitting faces: they are counted in the order of
    /// [`StageGeometry::faces`](super::StageGeometry::faces).
    pub emitters: Range<u32>,
    /// True if all corners of the scene are on one side of the plane or on it. Nothing on the plane then
    /// stands between two points of the scene.
    pub outermost: bool,
}

impl Plane {
    /// The offset of the plane of this form through `point`, computed as the tracer does. The difference
    /// from [`Plane::offset`] is then exactly zero.
    pub(super) fn height(&self, point: [f64; 3]) -> f64 {
        let [along, first, second] = [0, 1, 2].map(|k| point[(self.axis + k) % 3]);
        let [a, b] = self.form;
        along + (a * first + b * second)
    }

    /// True if the plane passes through `point`, within rounding.
    pub(super) fn passes(&self, point: [f64; 3]) -> bool {
        let height = self.height(point);
        (self.offset - height).abs() <= ON_PLANE * (1.0 + height.abs())
    }

    /// Compares planes by main axis, tilt and offset.
    ///
    /// Of each axis, planes with a positive `a + b` come first, and those with a negative one last; the
    /// steepest come first among each. The order decides between planes that a ray meets at one point. It
    /// also decides how long values live in a circuit that uncomputes parts early: of the orders that were
    /// tried, this one has the smallest circuits of the Cornell box.
    pub(super) fn cmp_tilt(&self, other: &Self) -> Ordering {
        let key = |plane: &Self| {
            let [a, b] = plane.form;
            let side = f64::from(u8::from(a + b < 0.0)) - f64::from(u8::from(a + b > 0.0));
            [side, -(a.abs() + b.abs()), a, b, plane.offset]
        };
        let pairs = key(self).into_iter().zip(key(other));
        // -0 and 0 are one coefficient.
        let by_numbers = pairs.map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
        by_numbers.fold(self.axis.cmp(&other.axis), Ordering::then)
    }
}

/// A face's frame: tangents, normal (the front) and centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceFrame {
    /// The unit tangent, orthogonal to the normal.
    pub tangent: DVec3,
    /// The unit bitangent, orthogonal to both others.
    pub bitangent: DVec3,
    /// The unit normal, along `(v1 - v0) x (v2 - v0)`.
    pub normal: DVec3,
    /// The mean of the corners, in stage units.
    pub centre: DVec3,
}

impl FaceFrame {
    /// The frame with this normal whose [row](FaceFrame::row) is `row`.
    pub(super) fn new(normal: [f64; 3], row: &[f64; 9]) -> Self {
        let part = |k: usize| DVec3::new(row[k], row[k + 1], row[k + 2]);
        Self {
            tangent: part(0),
            bitangent: part(3),
            normal: normal.into(),
            centre: part(6),
        }
    }

    /// The tangent, the bitangent and the centre.
    pub(super) fn row(&self) -> [f64; 9] {
        let (t, b, c) = (self.tangent, self.bitangent, self.centre);
        [t.x, t.y, t.z, b.x, b.y, b.z, c.x, c.y, c.z]
    }
}

pub(super) fn plane_of(corners: &[DVec3], frame: &FaceFrame) -> Plane {
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

pub(super) fn frame(corners: &[DVec3]) -> FaceFrame {
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
    FaceFrame {
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

/// The tests of a disc in the square with these `corners`, on a plane with main axis `axis`.
pub(super) fn disc_tests(
    corners: &[DVec3],
    axis: usize,
    tolerance: f64,
) -> (Vec<EdgeTest>, DiscTest) {
    let flat = |p: DVec3| DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| flat(corners[k]));
    // Means over opposite edges: rounding of single corners nearly cancels.
    let centre = (a + b + c + d) * 0.25;
    let radii = [(b - a + c - d) * 0.25, (d - a + c - b) * 0.25];
    // The form that is constant along the other radius.
    let form = |k: usize| {
        let across = radii[1 - k].perp();
        let main = if across.x.abs() >= across.y.abs() {
            across.x
        } else {
            across.y
        };
        // A coefficient that is only a rounding error becomes 0.
        let clean = |c: f64| if c.abs() < f64::EPSILON { 0.0 } else { c };
        let form = across / main;
        DVec2::new(clean(form.x), clean(form.y))
    };
    let forms = [form(0), form(1)];
    let middle = forms.map(|form| form.dot(centre));
    let half = [0, 1].map(|k| forms[k].dot(radii[k]).abs());
    let tests = [0, 1].map(|k| {
        let reach = half[k] + 2.0 * tolerance;
        EdgeTest {
            form: forms[k].to_array(),
            low: middle[k] - reach,
            high: middle[k] + reach,
        }
    });
    (tests.to_vec(), disc_test(middle, half))
}

/// The test of a disc around `centre`, whose square has these half widths `half`.
fn disc_test(centre: [f64; 2], half: [f64; 2]) -> DiscTest {
    /// Greatest relative difference of half widths that counts as rounding.
    const SAME: f64 = 1e-12;
    let (_, exponent) = libm::frexp(half[1]);
    let second = libm::ldexp(1.0, -exponent);
    let is_same = (half[0] - half[1]).abs() <= SAME * half[1];
    let first = if is_same {
        second
    } else {
        second * (half[1] / half[0])
    };
    DiscTest {
        centre,
        scale: [first, second],
        square: (half[1] * second) * (half[1] * second),
    }
}
