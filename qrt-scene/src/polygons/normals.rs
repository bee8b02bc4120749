//! Normals of the corners of triangles, for smooth shading.

use glam::DVec3;
use std::cmp::Ordering;

/// Maximum number of pairs of triangles with a common corner that are compared for a scene.
pub(crate) const MOST_PAIRS: u64 = 1 << 28;

/// Returns the unit normals of the corners of each of the `triangles`.
///
/// The normal of a corner is the mean over the triangles that share the corner and for which `joined`
/// holds, weighted by their angles there (Thürmer & Wüthrich, Computing Vertex Normals from Polygonal
/// Facets, 1998). The arguments of `joined` are the numbers of two triangles and their unit normals. The
/// number of compared pairs is taken from `pairs_left`.
///
/// # Errors
/// The greatest number of triangles at one corner, if too few pairs are left.
pub(crate) fn mean_normals(
    triangles: &[[DVec3; 3]],
    pairs_left: &mut u64,
    joined: impl Fn([usize; 2], [DVec3; 2]) -> bool,
) -> Result<Vec<[DVec3; 3]>, usize> {
    let own: Vec<DVec3> = triangles.iter().map(unit_normal).collect();
    let corner = |number: u32| (number as usize / 3, number as usize % 3);
    let point = |number: u32| {
        let (triangle, corner) = corner(number);
        triangles[triangle][corner].to_array()
    };
    let mut order: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    // Numbers that are equal, such as 0 and -0, are one corner.
    order.sort_unstable_by(|&a, &b| {
        let pairs = point(a).into_iter().zip(point(b));
        let by_point = pairs.map(|(a, b)| a.partial_cmp(&b).unwrap_or(Ordering::Equal));
        by_point
            .fold(Ordering::Equal, Ordering::then)
            .then(a.cmp(&b))
    });
    let shared = || order.chunk_by(|&a, &b| point(a) == point(b));
    let sizes = shared().map(<[u32]>::len);
    let pairs: u64 = sizes.clone().map(|size| (size as u64).pow(2)).sum();
    *pairs_left = match pairs_left.checked_sub(pairs) {
        Some(left) => left,
        None => return Err(sizes.max().unwrap_or(0)),
    };
    let mut normals: Vec<[DVec3; 3]> = own.iter().map(|&own| [own; 3]).collect();
    for here in shared() {
        let weights: Vec<f64> = here
            .iter()
            .map(|&number| {
                let (triangle, corner) = corner(number);
                angle(&triangles[triangle], corner)
            })
            .collect();
        for &number in here {
            let (triangle, corner_of) = corner(number);
            let mut sum = DVec3::ZERO;
            for (&other, weight) in here.iter().zip(&weights) {
                let (other, _) = corner(other);
                if other == triangle || joined([triangle, other], [own[triangle], own[other]]) {
                    sum += own[other] * *weight;
                }
            }
            // Faces that look in all directions have no mean.
            normals[triangle][corner_of] = sum.try_normalize().unwrap_or(own[triangle]);
        }
    }
    Ok(normals)
}

/// Returns the unit normal of a triangle's front; 0 if it has no area.
pub(crate) fn unit_normal(&[a, b, c]: &[DVec3; 3]) -> DVec3 {
    // The lengths of edges are taken out first, so that nothing over- or underflows.
    let across = (b - a)
        .normalize_or_zero()
        .cross((c - a).normalize_or_zero());
    across.normalize_or_zero()
}

/// The angle of a triangle at one of its corners, in radians.
fn angle(triangle: &[DVec3; 3], corner: usize) -> f64 {
    let [next, last] = [1, 2].map(|k| triangle[(corner + k) % 3] - triangle[corner]);
    let cos = next.normalize_or_zero().dot(last.normalize_or_zero());
    libm::acos(cos.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::{MOST_PAIRS, mean_normals};
    use glam::DVec3;

    /// The twelve triangles of a cube, whose diagonals end at different corners.
    fn cube() -> Vec<[DVec3; 3]> {
        let mut triangles = Vec::new();
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                let at = |u: f64, v: f64| {
                    let mut point = [0.0; 3];
                    point[axis] = side;
                    point[(axis + 1) % 3] = u;
                    point[(axis + 2) % 3] = v;
                    DVec3::from_array(point)
                };
                let mut quad = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
                if side == 0.0 {
                    quad.reverse();
                }
                let [a, b, c, d] = quad;
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        triangles
    }

    #[test]
    fn corners_of_a_cube_look_away_from_its_centre() {
        let cube = cube();
        let normals = mean_normals(&cube, &mut { MOST_PAIRS }, |_, _| true).unwrap();
        for (triangle, normals) in cube.iter().zip(&normals) {
            for (corner, normal) in triangle.iter().zip(normals) {
                // Weighted by angles, both triangles of a face count as the face.
                let away = (*corner - DVec3::splat(0.5)).normalize();
                assert!((away - *normal).length() < 1e-12, "{corner} {normal}");
            }
        }
        let sharp = mean_normals(&cube, &mut { MOST_PAIRS }, |_, [a, b]| a.dot(b) > 0.5).unwrap();
        for (triangle, normals) in cube.iter().zip(&sharp) {
            assert_eq!(*normals, [super::unit_normal(triangle); 3]);
        }
    }

    #[test]
    fn a_corner_of_very_many_triangles_is_refused() {
        let fan = |count: u32| -> Vec<[DVec3; 3]> {
            let rim = |k: u32| DVec3::new(1.0, f64::from(k), 0.0);
            (0..count)
                .map(|k| [DVec3::ZERO, rim(k), rim(k + 1)])
                .collect()
        };
        assert_eq!(
            mean_normals(&fan(20_000), &mut { MOST_PAIRS }, |_, _| true),
            Err(20_000)
        );
        let normals = mean_normals(&fan(2_000), &mut { MOST_PAIRS }, |_, _| true).unwrap();
        assert!(normals.iter().all(|normals| *normals == [DVec3::Z; 3]));
    }
}
