//! Polygons that have nothing in common but corners.

use glam::DVec3;

/// Distances below this count as rounding.
const MARGIN: f64 = 1e-12;

/// True if a plane is found with `a` on one side and `b` on the other, and one of them touches it
/// at most in the corners and the edge that they share. False proves nothing.
///
/// The normal of a separating plane of convex polygons is that of one of them, or normal to an edge
/// within the plane of one of them, or normal to an edge of each (the separating axis theorem).
pub(super) fn share_corners_alone(a: &[DVec3], b: &[DVec3]) -> bool {
    let edges =
        |p: &[DVec3]| -> Vec<DVec3> { (0..p.len()).map(|k| p[(k + 1) % p.len()] - p[k]).collect() };
    let normal = |p: &[DVec3]| (p[1] - p[0]).cross(p[2] - p[0]);
    let (edges_a, edges_b) = (edges(a), edges(b));
    let (normal_a, normal_b) = (normal(a), normal(b));
    let within_a = edges_a.iter().map(|edge| edge.cross(normal_a));
    let within_b = edges_b.iter().map(|edge| edge.cross(normal_b));
    let across = edges_a
        .iter()
        .flat_map(|edge| edges_b.iter().map(|other| edge.cross(*other)));
    [normal_a, normal_b]
        .into_iter()
        .chain(within_a)
        .chain(within_b)
        .chain(across)
        .filter_map(DVec3::try_normalize)
        .any(|axis| separates(axis, a, b) || separates(-axis, a, b))
}

/// True if a plane normal to `axis` has `a` below it and `b` above it, one of them strictly except
/// for shared corners.
fn separates(axis: DVec3, a: &[DVec3], b: &[DVec3]) -> bool {
    let heights = |p: &[DVec3], other: &[DVec3], shared: bool| -> Vec<f64> {
        let corners = p.iter().filter(|corner| other.contains(corner) == shared);
        corners.map(|corner| axis.dot(*corner)).collect()
    };
    let most = |heights: &[f64]| heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = |heights: &[f64]| heights.iter().copied().fold(f64::INFINITY, f64::min);
    let shared = heights(a, b, true);
    let (below, above) = (heights(a, b, false), heights(b, a, false));
    if shared.is_empty() {
        return most(&below) + MARGIN < least(&above);
    }
    // Where one of them touches the plane in shared corners alone, the other may lie in it.
    let tiny = 0.25 * MARGIN;
    let (low, high) = (least(&shared), most(&shared));
    let below_touches = most(&below) + MARGIN < low && high <= least(&above) + tiny;
    let above_touches = high + MARGIN < least(&above) && most(&below) <= low + tiny;
    high - low <= tiny && (below_touches || above_touches)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 3]; 3]) -> Vec<DVec3> {
        corners.map(DVec3::from_array).to_vec()
    }

    #[test]
    fn neighbours_are_told_from_faces_that_cross_or_fold() {
        let base = triangle([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let apart = [
            // On the other side of an edge: flat, steep, and folded by almost half a turn.
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 1.0]],
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.2, 0.01]],
            // At a corner alone.
            [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
            [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]],
            // Beside it, and above it.
            [[2.0, 0.0, -1.0], [2.0, 1.0, 1.0], [2.0, 0.0, 1.0]],
            [[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 1.0, 0.1]],
        ];
        for other in apart.map(triangle) {
            assert!(share_corners_alone(&base, &other), "{other:?}");
            assert!(share_corners_alone(&other, &base), "{other:?}");
        }
        let common = [
            // Folded onto it, across it, through a corner of it, touching its middle.
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.2, 0.0]],
            [[0.2, 0.2, -1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]],
            [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.5, 0.5, -1.0]],
            [[0.2, 0.2, 0.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]],
        ];
        for other in common.map(triangle) {
            assert!(!share_corners_alone(&base, &other), "{other:?}");
        }
    }
}
