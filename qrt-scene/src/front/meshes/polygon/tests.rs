//! Tests that polygons keep their shape and their side.

use super::*;

#[test]
fn polygons_of_any_shape_keep_their_area() {
    // An L, an arrow, a comb, a square with a corner on its edge, one with a hole on a bridge; each
    // in three planes and both windings.
    let shapes: [(&[(i32, i32)], f64); 5] = [
        (&[(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 3.0),
        (&[(0, 0), (4, -2), (1, 0), (4, 2)], 2.0),
        (
            &[
                (0, 0),
                (5, 0),
                (5, 3),
                (4, 3),
                (4, 1),
                (3, 1),
                (3, 3),
                (2, 3),
                (2, 1),
                (1, 1),
                (1, 3),
                (0, 3),
            ],
            11.0,
        ),
        (&[(0, 0), (1, 0), (2, 0), (2, 2), (0, 2)], 4.0),
        (
            &[
                (0, 0),
                (4, 0),
                (4, 4),
                (0, 4),
                (0, 0),
                (1, 1),
                (1, 2),
                (2, 2),
                (2, 1),
                (1, 1),
            ],
            15.0,
        ),
    ];
    for (shape, expected) in shapes {
        for plane in 0..3 {
            for reversed in [false, true] {
                let mut corners: Vec<DVec3> = shape
                    .iter()
                    .map(|(x, y)| {
                        let (x, y) = (f64::from(*x), f64::from(*y));
                        [
                            DVec3::new(x, y, 1.0),
                            DVec3::new(1.0, x, y),
                            DVec3::new(y, 1.0, x),
                        ][plane]
                    })
                    .collect();
                if reversed {
                    corners.reverse();
                }
                let found = triangles(&corners).unwrap();
                assert_eq!(found.len(), corners.len() - 2);
                let normals: Vec<DVec3> = found
                    .iter()
                    .map(|triangle| {
                        let [a, b, c] = triangle.map(|corner| corners[corner]);
                        (b - a).cross(c - a)
                    })
                    .collect();
                let total: f64 = normals.iter().map(|n| n.length() / 2.0).sum();
                assert_eq!(total, expected, "{shape:?}");
                // All look to one side: the shape's own.
                let sum: DVec3 = normals.iter().sum();
                assert_eq!(sum.length() / 2.0, expected);
                let side = if reversed { -1.0 } else { 1.0 };
                assert_eq!(sum.element_sum().signum(), side);
            }
        }
    }
}

#[test]
fn a_convex_quad_is_cut_from_its_first_corner() {
    let quad = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5), DVec3::Y];
    let [a, b, c, d] = quad;
    let triangles = triangles(&quad).unwrap().into_iter();
    let triangles: Vec<_> = triangles.map(|t| t.map(|corner| quad[corner])).collect();
    assert_eq!(triangles, [[a, b, c], [a, c, d]]);
}
