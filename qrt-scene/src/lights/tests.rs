use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn square(corner: [f64; 3], u: [f64; 3], v: [f64; 3]) -> [DVec3; 4] {
    let (a, u, v) = (DVec3::from(corner), DVec3::from(u), DVec3::from(v));
    [a, a + u, a + u + v, a + v]
}

/// A floor below a lamp: `q / r^4` is greatest right below it, `1 / h^2`.
#[test]
fn a_floor_below_a_lamp_is_lit_most_right_below() {
    for height in [0.5, 1.0, 3.0] {
        let lamp = square([-0.1, height, -0.1], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2]);
        assert!(Lamp::new(&lamp).unwrap().normal.y < 0.0);
        let floor = square([-4.0, 0.0, -4.0], [0.0, 0.0, 8.0], [8.0, 0.0, 0.0]);
        let reached = strongest(&[&floor[..]], false, &lamp, 1.01 * height);
        let exact = 1.0 / (height * height);
        assert!(
            reached.form >= exact && reached.form <= 1.2 * exact,
            "{reached:?}"
        );
        assert!(reached.is_near);
        assert!(!strongest(&[&floor[..]], false, &lamp, 0.99 * height).is_near);
        // From behind nothing arrives.
        let mut turned = lamp;
        turned.reverse();
        let dark = strongest(&[&floor[..]], false, &turned, 1.0);
        assert_eq!(dark, Reached::NOTHING);
    }
}

#[test]
fn what_touches_a_lamp_has_no_bound_and_what_lies_in_its_plane_is_not_lit() {
    let lamp = square([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let wall = square([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let reached = strongest(&[&wall[..]], false, &lamp, 1.0);
    assert_eq!(reached.form, f64::INFINITY);
    let beside = square([2.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let reached = strongest(&[&beside[..]], false, &lamp, 1.0);
    assert_eq!(reached, Reached::NOTHING);
}

/// Returns the greatest `q / r^4` of `cells^4` pairs of points on a parallelogram and a lamp.
fn greatest_of_grid(face: &[DVec3], lamp: &[DVec3], cells: usize) -> f64 {
    let (receiver, lit) = (Lamp::new(face).unwrap(), Lamp::new(lamp).unwrap());
    let mut most: f64 = 0.0;
    for cell in 0..cells.pow(4) {
        let of = |k: u32| (cell / cells.pow(k) % cells) as f64 / (cells - 1) as f64;
        let x = receiver.corner + receiver.edges[0] * of(0) + receiver.edges[1] * of(1);
        let (u, mut v) = (of(2), of(3));
        if lit.triangle {
            v *= 1.0 - u;
        }
        let d = lit.corner + lit.edges[0] * u + lit.edges[1] * v - x;
        let q = receiver.normal.dot(d).abs() * (-lit.normal.dot(d)).max(0.0);
        most = most.max(q / d.length_squared().powi(2));
    }
    most
}

#[test]
fn no_pair_of_points_exceeds_the_bound() {
    let lamp = [
        DVec3::new(0.2, 1.0, 0.1),
        DVec3::new(0.5, 1.1, 0.0),
        DVec3::new(0.3, 0.9, 0.6),
    ];
    let faces = [
        square([-1.0, 0.0, -1.0], [2.0, 0.1, 0.0], [0.0, 0.0, 2.0]),
        square([-1.0, 0.0, -1.0], [0.0, 0.3, 2.0], [0.3, 0.6, 0.0]),
    ];
    for face in &faces {
        for lit in [&lamp[..], &[lamp[0], lamp[2], lamp[1]]] {
            let reached = strongest(&[&face[..]], false, lit, 1.0);
            let most = greatest_of_grid(face, lit, 24);
            assert!(most <= reached.form, "{most} {reached:?}");
            assert!(reached.form <= 1.1 * most, "{most} {reached:?}");
        }
    }
}

/// A wall beside a lamp is lit most at some distance from it, where neither height is at its greatest.
#[test]
fn a_thousand_pairs_of_parts_bound_a_wall_beside_a_lamp() {
    let lamp = square([-0.3, 0.99, -0.2], [0.6, 0.0, 0.0], [0.0, 0.0, 0.4]);
    for across in [0.7, 1.0, 2.0] {
        let wall = square([across, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]);
        let most = greatest_of_grid(&wall, &lamp, 32);
        let bound = strongest_form(&wall, false, &lamp, 1000);
        assert!(bound >= most && bound <= 1.06 * most, "{most} {bound}");
    }
}

fn points() -> impl Strategy<Value = Vec<DVec3>> {
    // Some are near each other, some far away.
    let coordinate = || prop_oneof![-1.0..1.0, -0.01..0.01, -30.0..30.0];
    let point = [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from);
    prop::collection::vec(point, 6)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    /// However early a search ends, its bound holds.
    #[test]
    fn no_pair_of_points_exceeds_the_bound_of_few_pairs(
        corners in points(),
        shift in prop_oneof![Just(0.0), -1e6..1e6],
        pairs in 1_usize..40,
        places in prop::collection::vec([0.0..1.0, 0.0..1.0], 16),
    ) {
        // Far from the origin, coordinates are rounded.
        let corners: Vec<DVec3> = corners.into_iter().map(|corner| corner + shift).collect();
        let (face, lamp) = corners.split_at(3);
        let [n, m] = [face, lamp].map(|of| (of[1] - of[0]).cross(of[2] - of[0]).normalize_or_zero());
        let bounds = [false, true].map(|is_smooth| strongest_form(face, is_smooth, lamp, pairs));
        let at = |of: &[DVec3], [u, v]: [f64; 2]| {
            let root = f64::sqrt(u);
            of[0] * (1.0 - root) + of[1] * (root * (1.0 - v)) + of[2] * (root * v)
        };
        for x in &places {
            for y in &places {
                let d = at(lamp, *y) - at(face, *x);
                let r = d.length();
                let given = (-m.dot(d)).max(0.0) / r.powi(3);
                let [flat, smooth] = [n.dot(d).abs() / r * given, given];
                // Heights here are rounded, too.
                let rounding = 1e-14 * (30.0 + f64::abs(shift)) / r + 1e-9;
                prop_assert!(flat <= bounds[0] + rounding / r / r, "{flat} {bounds:?}");
                prop_assert!(smooth <= bounds[1] + rounding / r / r, "{smooth} {bounds:?}");
            }
        }
    }
}

#[test]
fn every_lamp_has_a_column_and_the_powers_decide_the_rest() {
    for bits in 0..8 {
        for lamps in 1..=(1_usize << bits) {
            let powers: Vec<f64> = (0..lamps).map(|k| 1.0 + (k * k) as f64).collect();
            let total: f64 = powers.iter().sum();
            let given = columns(&powers, bits).unwrap();
            assert_eq!(given.iter().sum::<u32>(), 1 << bits);
            assert!(given.iter().all(|&columns| columns > 0));
            for (power, &columns) in powers.iter().zip(&given) {
                let exact = power / total * f64::from(1 << bits);
                assert!(f64::from(columns) < exact + 1.0 || columns == 1);
            }
        }
    }
    assert_eq!(columns(&[], 4), None);
}

#[test]
fn triangles_and_parallelograms_are_lamps_and_other_quads_are_not() {
    let quad = square([1.0, 2.0, 3.0], [0.5, 0.0, 0.0], [0.25, 2.0, 0.0]);
    let lamp = Lamp::new(&quad).unwrap();
    assert!((lamp.area - 1.0).abs() < 1e-15 && !lamp.triangle);
    let half = Lamp::new(&quad[..3]).unwrap();
    assert!((half.area - 0.5).abs() < 1e-15 && half.triangle);
    let mut kite = quad;
    kite[2].x += 0.1;
    assert_eq!(Lamp::new(&kite), None);
}

/// The greatest cosine, against directions all over a cone; its solid angle, against that of a cap.
#[test]
fn a_cone_bounds_the_cosines_of_its_directions() {
    for angle in [0.001, 0.53, 40.0, 120.0, 179.9] {
        let cone = Cone::new(DVec3::new(2.0, -3e-9, 1.0) * 1e-200, angle).unwrap();
        let half = (0.5 * angle).to_radians();
        let solid = TAU * 2.0 * (0.5 * half).sin().powi(2);
        assert!((cone.solid_angle() / solid - 1.0).abs() < 1e-12);
        let [x, y] = cone.across;
        for pair in [x.dot(y), x.dot(cone.axis), y.dot(cone.axis)] {
            assert!(pair.abs() < 1e-15, "{cone:?}");
        }
        let within = |k: i32| {
            // Points of a spiral over the cap.
            let part = f64::from(k) / 4000.0;
            let (sin, cos) = (half * part.sqrt()).sin_cos();
            let (up, right) = (2.4 * f64::from(k)).sin_cos();
            cone.axis * cos + (x * right + y * up) * sin
        };
        for normal in [
            cone.axis,
            -cone.axis,
            x,
            DVec3::Y,
            DVec3::new(-0.6, 0.0, 0.8),
            DVec3::new(0.6, 0.0, -0.8),
        ] {
            let most = cone.greatest_cosine(normal);
            let found = (0..=4000).map(|k| within(k).dot(normal));
            let found = found.fold(0.0, f64::max);
            assert!(found <= most + 1e-12, "{angle}, {normal}: {found}, {most}");
            assert!(
                most - found < 0.05 * half.sin() + 1e-12,
                "{angle}, {normal}: {found}, {most}"
            );
        }
    }
    assert_eq!(Cone::new(DVec3::ZERO, 1.0), None);
}
