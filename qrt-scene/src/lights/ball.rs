//! Bounds for faces of which one is a sphere: `q / r^4` is at most `1 / r^2`, and the distance of
//! the two faces is known.

use super::bound::{Reached, strongest};
use glam::DVec3;

/// A face that gives or receives light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LitFace<'a> {
    /// A convex polygon.
    Polygon {
        /// The corners; `(v1 - v0) x (v2 - v0)` is the front.
        outline: &'a [DVec3],
        /// True if it is shaded by interpolated normals. It emits as a flat polygon does.
        is_smooth: bool,
    },
    /// A sphere, whose front is outside.
    Sphere {
        /// The centre.
        centre: DVec3,
        /// The radius.
        radius: f64,
    },
}

/// Returns bounds over all points of the faces of a `surface` and all points of a `lamp`. A distance below
/// `near_by` is near.
pub fn strongest_of<'a>(
    surface: impl Iterator<Item = LitFace<'a>>,
    lamp: LitFace<'_>,
    near_by: f64,
) -> Reached {
    let (mut flat, mut smooth) = (Vec::new(), Vec::new());
    let mut most = Reached::NOTHING;
    let mut join = |other: Reached| {
        most.form = most.form.max(other.form);
        most.is_near |= other.is_near;
    };
    for face in surface {
        match (face, lamp) {
            (_, LitFace::Sphere { .. }) | (LitFace::Sphere { .. }, _) => {
                join(near(face, lamp, near_by));
            }
            (LitFace::Polygon { outline, is_smooth }, _) => {
                let faces = if is_smooth { &mut smooth } else { &mut flat };
                faces.push(outline);
            }
        }
    }
    if let LitFace::Polygon { outline: lamp, .. } = lamp {
        for (faces, is_smooth) in [(flat, false), (smooth, true)] {
            if !faces.is_empty() {
                join(strongest(&faces, is_smooth, lamp, near_by));
            }
        }
    }
    most
}

/// Returns the bounds that follow from the distance of two faces, of which one is a sphere.
fn near(face: LitFace<'_>, lamp: LitFace<'_>, near_by: f64) -> Reached {
    let is_dark = match (face, lamp) {
        // A sphere shines outwards alone, so it does not light itself.
        (_, LitFace::Sphere { .. }) if face == lamp => true,
        (LitFace::Sphere { centre, radius }, LitFace::Polygon { outline: lamp, .. }) => {
            let normal = (lamp[1] - lamp[0])
                .cross(lamp[2] - lamp[0])
                .normalize_or_zero();
            normal.dot(centre - lamp[0]) + radius <= 0.0
        }
        // The surface is within the sphere, whose light goes outwards.
        (LitFace::Polygon { outline, .. }, LitFace::Sphere { centre, radius }) => outline
            .iter()
            .all(|corner| corner.distance(centre) < radius),
        (
            LitFace::Sphere {
                centre: a,
                radius: r,
            },
            LitFace::Sphere {
                centre: b,
                radius: big,
            },
        ) => a.distance(b) + r < big,
        (LitFace::Polygon { .. }, LitFace::Polygon { .. }) => false,
    };
    if is_dark {
        return Reached::NOTHING;
    }
    // Rounded down, so that the bound stays an upper one.
    let distance = distance(face, lamp) * (1.0 - 1e-12);
    if distance <= 0.0 {
        return Reached::UNBOUNDED;
    }
    let bound = 1.0 / (distance * distance);
    Reached {
        form: bound,
        is_near: bound > near_by.powi(-2),
    }
}

/// A lower bound of the distance of two faces, of which one is a sphere; not above 0 if they may
/// touch.
fn distance(a: LitFace<'_>, b: LitFace<'_>) -> f64 {
    match (a, b) {
        (
            LitFace::Sphere {
                centre: a,
                radius: r,
            },
            LitFace::Sphere {
                centre: b,
                radius: s,
            },
        ) => {
            let apart = a.distance(b);
            (apart - r - s).max((r - s).abs() - apart)
        }
        (LitFace::Polygon { outline, .. }, LitFace::Sphere { centre, radius })
        | (LitFace::Sphere { centre, radius }, LitFace::Polygon { outline, .. }) => {
            let far = outline.iter().map(|corner| corner.distance(centre));
            let within = radius - far.fold(0.0, f64::max);
            (polygon_distance(outline, centre) - radius).max(within)
        }
        (LitFace::Polygon { .. }, LitFace::Polygon { .. }) => 0.0,
    }
}

/// The distance of a point from a convex polygon.
pub fn polygon_distance(outline: &[DVec3], point: DVec3) -> f64 {
    let triangles = (2..outline.len()).map(|k| [outline[0], outline[k - 1], outline[k]]);
    let distances = triangles.map(|triangle| closest(triangle, point).distance(point));
    distances.fold(f64::INFINITY, f64::min)
}

/// The point of a triangle that is closest to `point` (Ericson, Real-Time Collision Detection, 5.1.5).
fn closest([a, b, c]: [DVec3; 3], point: DVec3) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let normal = ab.cross(ac);
    let along = |start: DVec3, edge: DVec3| {
        let t = (point - start).dot(edge) / edge.length_squared();
        start + edge * t.clamp(0.0, 1.0)
    };
    let edges = [(a, ab), (b, c - b), (c, a - c)];
    let is_inside = |(start, edge): (DVec3, DVec3)| normal.cross(edge).dot(point - start) >= 0.0;
    if edges.into_iter().all(is_inside) {
        let unit = normal.normalize_or_zero();
        return point - unit * unit.dot(ap);
    }
    let points = edges.map(|(start, edge)| along(start, edge));
    let [first, others @ ..] = points;
    let nearer = |best: DVec3, other: DVec3| {
        if other.distance(point) < best.distance(point) {
            other
        } else {
            best
        }
    };
    others.into_iter().fold(first, nearer)
}

#[cfg(test)]
mod tests {
    use super::{LitFace, polygon_distance, strongest_of};
    use glam::DVec3;

    const SQUARE: [DVec3; 4] = [
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(-1.0, 1.0, 0.0),
    ];

    /// Shines on [`SQUARE`] from above, at a slant.
    const LAMP: [DVec3; 4] = [
        DVec3::new(-0.5, -0.5, 1.5),
        DVec3::new(-0.5, 0.5, 1.5),
        DVec3::new(0.5, 0.5, 2.5),
        DVec3::new(0.5, -0.5, 2.5),
    ];

    #[test]
    fn a_polygons_distance_is_that_of_its_nearest_point() {
        for (point, expected) in [
            (DVec3::new(0.3, -0.4, 2.0), 2.0),
            (DVec3::new(4.0, 0.5, 4.0), 5.0),
            (DVec3::new(3.0, 4.0, 6.0), 7.0),
            (DVec3::new(0.0, 0.0, 0.0), 0.0),
        ] {
            assert!(
                (polygon_distance(&SQUARE, point) - expected).abs() < 1e-12,
                "{point}"
            );
        }
    }

    /// The form at random points of two faces never exceeds its bound, and comes within a factor of
    /// the bound for small spheres face to face.
    #[test]
    fn no_form_exceeds_its_bound() {
        let polygon = |outline, is_smooth| LitFace::Polygon { outline, is_smooth };
        let ball = |z: f64, radius: f64| LitFace::Sphere {
            centre: DVec3::new(0.2, 0.1, z),
            radius,
        };
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut point = |face: LitFace<'_>| match face {
            LitFace::Polygon {
                outline: square,
                is_smooth,
            } => {
                let edges = [square[1] - square[0], square[3] - square[0]];
                let point = square[0] + edges[0] * random() + edges[1] * random();
                // A smooth face has any normal, so also that to the lamp.
                let normal = edges[0].cross(edges[1]).normalize();
                (point, (!is_smooth).then_some(normal))
            }
            LitFace::Sphere { centre, radius } => {
                let z = 2.0 * random() - 1.0;
                let (sin, cos) = (std::f64::consts::TAU * random()).sin_cos();
                let across = (1.0 - z * z).sqrt();
                let normal = DVec3::new(across * cos, across * sin, z);
                (centre + normal * radius, Some(normal))
            }
        };
        for (surface, lamp) in [
            (polygon(&SQUARE, false), ball(2.0, 0.5)),
            (ball(2.0, 0.5), polygon(&SQUARE, false)),
            (ball(2.0, 0.5), ball(0.0, 0.25)),
            (polygon(&SQUARE, true), ball(2.0, 0.5)),
            (polygon(&SQUARE, true), polygon(&LAMP, false)),
        ] {
            let bound = strongest_of([surface].into_iter(), lamp, 1.0).form;
            let mut greatest: f64 = 0.0;
            for _ in 0..20_000 {
                let ((x, n), (y, m)) = (point(surface), point(lamp));
                let d = y - x;
                let (n, m) = (n.unwrap_or(d.normalize()), m.unwrap_or_default());
                let q = n.dot(d).abs() * (-m.dot(d)).max(0.0);
                greatest = greatest.max(q / d.length_squared().powi(2));
            }
            assert!(
                greatest <= bound && bound < 2.0 * greatest,
                "{greatest} {bound}"
            );
        }
        let behind = strongest_of([ball(-2.0, 0.5)].into_iter(), polygon(&SQUARE, false), 1.0);
        assert_eq!(behind.form, 0.0);
        let touching = strongest_of([ball(0.5, 0.5)].into_iter(), polygon(&SQUARE, false), 1.0);
        assert_eq!(touching.form, f64::INFINITY);
    }
}
