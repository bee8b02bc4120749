//! Searches of spheres as circuits: their hits against high precision, and their gates.

use super::Chance;
use super::circuit::Circuit;
use glam::DVec3;
use qrt_circuit::lower;
use qrt_scene::front::parse;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{PixelClass, Stage};
use std::fmt::Write;

/// A field of `side * side` small spheres of radius 1/80 of the stage's half extent, each moved a
/// little, and two larger ones far apart, which set the stage.
fn field(side: i32) -> ValidScene {
    let mut chance = Chance(3);
    let mut text = String::from(
        "name: field\nfilm: { width: 1, height: 1 }\ncamera: { perspective: { eye: [0, 8, 15], target: \
         [0, 0, 0], vfov: 40 } }\nmaterials: { matte: { lambertian: { albedo: 0.5 } } }\ngeometry:\n",
    );
    for (x, z) in (0..side * side).map(|n| (n % side - side / 2, n / side - side / 2)) {
        // A single one is well away from the origin.
        let away = if side == 1 { 7.0 } else { 0.0 };
        let at = [
            f64::from(x) + away + 0.8 * chance.next(),
            0.2,
            f64::from(z) - away + 0.8 * chance.next(),
        ];
        writeln!(
            text,
            "  - sphere: {{ center: {at:?}, radius: 0.2, material: matte }}"
        )
        .unwrap();
    }
    // These set the size of the stage: 16 scene units are one of its units.
    text.push_str(
        "  - sphere: { center: [-14.5, 0, -14.5], radius: 1, material: matte }\n  \
         - sphere: { center: [14.5, 0, 14.5], radius: 1, material: matte }\n",
    );
    parse(&text, "field.yaml", &[], "".as_ref()).unwrap().valid
}

/// Rays aimed within 1.3 radii of a small sphere's centre: a few hits are wrong, and their lines pass so
/// near to the edge that the last bit of a coordinate decides.
#[test]
fn grazing_rays_meet_what_they_meet_in_high_precision() {
    let scene = field(1);
    for (fraction, most_wrong, farthest) in [(16, 3, 0.0002), (14, 20, 0.005), (12, 60, 0.03)] {
        let circuit = Circuit::nearest(&scene, fraction);
        let stage = Stage::<3>::rgb(&scene, PixelClass::MayMeetLamp);
        let ball = stage.geometry().balls[0];
        let units = (1_u64 << fraction) as f64;
        let mut chance = Chance(11);
        let (mut wrong, mut worst, mut met): (usize, f64, usize) = (0, 0.0, 0);
        let mut errors = Vec::new();
        for _ in 0..10_000 {
            let mut between = |low, high| chance.between(low, high);
            let origin = DVec3::new(between(-0.7, 0.7), between(0.0, 0.5), between(-0.7, 0.7));
            let reach = 1.3 * ball.radius;
            let aim = DVec3::from_array([(); 3].map(|()| between(-reach, reach)));
            let direction = (ball.centre + aim - origin).normalize();
            let whole = |v: DVec3| v.to_array().map(|c| (c * units).round() as i64);
            let ([ox, oy, oz], [dx, dy, dz]) = (whole(origin), whole(direction));
            let exact = |v: [i64; 3]| DVec3::from_array(v.map(|c| c as f64 / units));
            let (origin, direction) = (exact([ox, oy, oz]), exact([dx, dy, dz]));
            let to = ball.centre - origin;
            let along = to.dot(direction) / direction.length_squared();
            let apart = (to - direction * along).length();
            let expected = apart < ball.radius;
            let (face, distance) = circuit.run([ox, oy, oz, dx, dy, dz]);
            let found = face == ball.label as usize;
            if found != expected {
                wrong += 1;
                worst = worst.max((apart / ball.radius - 1.0).abs());
            } else if expected {
                met += 1;
                let half = (ball.radius * ball.radius - apart * apart).sqrt();
                let true_distance = along - half / direction.length();
                errors.push((distance - true_distance).abs() / ball.radius);
            }
        }
        errors.sort_by(f64::total_cmp);
        let [middle, most] = [errors.len() / 2, errors.len() * 99 / 100].map(|k| errors[k]);
        println!(
            "{fraction} bits: {wrong} of 10000 wrong, at most {worst:.4} radii from the edge; error of the \
             distance over the radius: median {middle:.4}, 99 % below {most:.4}"
        );
        assert!(met > 3000);
        assert!(
            wrong <= most_wrong && worst <= farthest,
            "{fraction}: {wrong} wrong, {worst}"
        );
    }
}

/// Products with the constants of all spheres share their sums.
#[test]
fn a_sphere_of_a_long_chain_takes_few_gates() {
    let few = Circuit::nearest(&field(8), 16);
    let many = Circuit::nearest(&field(22), 16);
    let [few, many] = [&few, &many].map(|circuit| lower::toffoli(&circuit.program));
    let each = (many - few) as f64 / (484.0 - 64.0);
    println!("{many} Toffolis for 484 spheres: {each:.0} each");
    assert!(each <= 1200.0, "{each}");
}
