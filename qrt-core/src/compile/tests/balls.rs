//! Searches of spheres as circuits: their hits against high precision, and their gates.

use super::Chance;
use super::circuit::Circuit;
use crate::compile::{BoolValue, Builder, RealValue};
use crate::oracle::Oracles;
use glam::DVec3;
use qrt_circuit::lower;
use qrt_scene::front::parse;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, NO_FACE, PixelClass, Ray, Stage, StageBall, dot};
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

/// Returns the distance of a line from the sphere's centre, and the place of its nearest point in lengths of `direction`.
fn beside(ball: &StageBall, origin: DVec3, direction: DVec3) -> (f64, f64) {
    let to = ball.centre - origin;
    let along = to.dot(direction) / direction.length_squared();
    ((to - direction * along).length(), along)
}

/// Comparison of the hits of [`RAYS`] rays with those of the same rays in high precision.
struct Compared {
    wrong: usize,
    /// Greatest distance of a wrong hit's line from the sphere's edge, in radii.
    farthest: f64,
    /// Number of rays that their rounding to the circuit's numbers moves across the edge.
    moved: usize,
    /// Errors of the distances of right hits, in radii, in increasing order.
    errors: Vec<f64>,
}

const RAYS: usize = 10_000;

/// Runs rays aimed within 1.3 radii of the centre of the first sphere.
fn compare(circuit: &Circuit, scene: &ValidScene, fraction: u32) -> Compared {
    let stage = Stage::<3>::rgb(scene, PixelClass::MayMeetLamp);
    let ball = stage.geometry().balls[0];
    let units = (1_u64 << fraction) as f64;
    let mut chance = Chance(11);
    let mut compared = Compared {
        wrong: 0,
        farthest: 0.0,
        moved: 0,
        errors: Vec::new(),
    };
    for _ in 0..RAYS {
        let mut between = |low, high| chance.between(low, high);
        let mut start = || DVec3::new(between(-0.7, 0.7), between(0.0, 0.5), between(-0.7, 0.7));
        let mut origin = start();
        while ball.outside(origin) < ball.radius {
            origin = start();
        }
        let reach = 1.3 * ball.radius;
        let aim = DVec3::from_array([(); 3].map(|()| between(-reach, reach)));
        let direction = (ball.centre + aim - origin).normalize();
        let (unrounded, _) = beside(&ball, origin, direction);
        let whole = |v: DVec3| v.to_array().map(|c| (c * units).round() as i64);
        let ([ox, oy, oz], [dx, dy, dz]) = (whole(origin), whole(direction));
        let exact = |v: [i64; 3]| DVec3::from_array(v.map(|c| c as f64 / units));
        let (origin, direction) = (exact([ox, oy, oz]), exact([dx, dy, dz]));
        let (apart, along) = beside(&ball, origin, direction);
        let expected = apart < ball.radius;
        compared.moved += usize::from((unrounded < ball.radius) != expected);
        let (face, distance) = circuit.run([ox, oy, oz, dx, dy, dz]);
        let found = face == ball.label as usize;
        if found != expected {
            compared.wrong += 1;
            compared.farthest = compared.farthest.max((apart / ball.radius - 1.0).abs());
        } else if expected {
            let half = (ball.radius * ball.radius - apart * apart).sqrt();
            let true_distance = along - half / direction.length();
            let error = (distance - true_distance).abs() / ball.radius;
            compared.errors.push(error);
        }
    }
    compared.errors.sort_by(f64::total_cmp);
    compared
}

/// A sphere may have a radius of 16 units in the last place. Its guard bits must leave products within a register.
#[test]
fn the_smallest_spheres_far_from_the_eye_have_circuits() {
    for fraction in 12..=20 {
        for units in [16.5, 24.0, 33.0] {
            // 16 scene units are one of the stage.
            let radius = 16.0 * units * f64::exp2(-f64::from(fraction));
            for eye in [[0.0, 1.0, 60.0], [0.0, 14.0, 16.0]] {
                let text = format!(
                    "name: speck\nfilm: {{ width: 1, height: 1 }}\ncamera: {{ perspective: {{ eye: {eye:?}, target: \
                     [0, 0, 0], vfov: 40 }} }}\nmaterials: {{ matte: {{ lambertian: {{ albedo: 0.5 }} }} }}\nsky: {{ \
                     radiance: 1 }}\nprecision: {{ fraction: {fraction} }}\ngeometry:\n  - quad: {{ vertices: [[-15, \
                     -12, -15], [-15, -12, 15], [15, -12, 15], [15, -12, -15]], material: matte }}\n  - sphere: {{ \
                     center: [14.5, 12, 14.5], radius: {radius}, material: matte }}\n"
                );
                let scene = parse(&text, "speck.yaml", &[], "".as_ref()).unwrap().valid;
                if let Err(error) = Oracles::new(&scene).costs() {
                    panic!("{fraction} bits, {units} units, {eye:?}: {error}");
                }
            }
        }
    }
}

/// Below 16 bits a few hits are wrong, and their lines pass so near to the edge that the last bit of a coordinate
/// decides: the rounding of a ray moves more of them across the edge.
#[test]
fn grazing_rays_meet_what_they_meet_in_high_precision() {
    let scene = field(1);
    for (fraction, most_wrong, farthest) in [(16, 0, 0.0), (14, 1, 0.0004), (12, 8, 0.002)] {
        let circuit = Circuit::nearest(&scene, fraction);
        let compared = compare(&circuit, &scene, fraction);
        let errors = &compared.errors;
        let [middle, most] = [errors.len() / 2, errors.len() * 99 / 100].map(|k| errors[k]);
        println!(
            "{fraction} bits: {} of {RAYS} wrong, at most {:.6} radii from the edge; the rays' own rounding \
             changes {}; error of the distance over the radius: median {middle:.4}, 99 % below {most:.4}",
            compared.wrong, compared.farthest, compared.moved
        );
        assert!(errors.len() > 3000);
        assert!(compared.moved > compared.wrong);
        assert!(
            compared.wrong <= most_wrong && compared.farthest <= farthest,
            "{fraction}: {} wrong, {}",
            compared.wrong,
            compared.farthest
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
    assert!(each <= 1000.0, "{each}");
}

/// The textbook's other form (Haines and others, 2019): with the centre `c` seen from the ray's start and `b = c.d`,
/// the line's point nearest to the centre is `l = b d - c`, and `h^2 = r^2 - l.l`. Returns whether the ray meets the
/// sphere, and `b`.
fn by_nearest_point<'b>(
    cx: &mut Builder<'b>,
    ray: &Ray<Builder<'b>>,
    ball: &StageBall,
) -> (BoolValue, RealValue) {
    // The greatest power of two that is at most 1 / r: only a short `l` is squared, with all its bits.
    let up = (-ball.radius.log2()).floor().exp2();
    let to = [0, 1, 2].map(|k| {
        let centre = cx.real(ball.centre[k]);
        cx.sub(centre, ray.origin[k])
    });
    let along = dot(cx, &to, &ray.direction);
    let [low, high, zero] = [-1.0, 1.0, 0.0].map(|end| cx.real(end / up));
    let mut meets = cx.less(zero, along);
    let mut left = cx.real((ball.radius * up).powi(2));
    for (to, direction) in to.into_iter().zip(ray.direction) {
        let moved = cx.mul(along, direction);
        let apart = cx.sub(moved, to);
        for (small, great) in [(low, apart), (apart, high)] {
            let within = cx.less(small, great);
            meets = cx.and(meets, within);
        }
        let apart = cx.known(apart, -1.0 / up, 1.0 / up);
        let apart = cx.scale(apart, up);
        let square = cx.mul(apart, apart);
        left = cx.sub(left, square);
    }
    let crosses = cx.less(zero, left);
    (cx.and(meets, crosses), along)
}

/// The search for the nearest sphere of a field by this form, with the place of the sphere's middle on the ray.
fn nearest_by_nearest_point(scene: &ValidScene) -> Circuit {
    let stage = Stage::<3>::rgb(scene, PixelClass::MayMeetLamp);
    let balls = stage.geometry().balls.clone();
    Circuit::new(scene, 16, |_, cx, ray| {
        let (mut nearest, mut face) = (cx.real(4.0), cx.index(NO_FACE));
        for ball in &balls {
            let (meets, along) = by_nearest_point(cx, ray, ball);
            let nearer = cx.less(along, nearest);
            let hit = cx.and(meets, nearer);
            let label = cx.index(ball.label);
            nearest = cx.select(hit, along, nearest);
            face = cx.select_index(hit, label, face);
        }
        (nearest, face)
    })
}

/// The book compares the two forms by these figures.
#[test]
fn the_form_by_the_nearest_point_takes_more_gates() {
    let each = |[few, many]: [Circuit; 2]| {
        let [few, many] = [few, many].map(|circuit| lower::toffoli(&circuit.program));
        (many - few) as f64 / (484.0 - 64.0)
    };
    let fields = [8, 22].map(field);
    let other = each(fields.each_ref().map(nearest_by_nearest_point));
    let built = each(fields.each_ref().map(|scene| Circuit::nearest(scene, 16)));
    let scene = field(1);
    let compared = compare(&nearest_by_nearest_point(&scene), &scene, 16);
    println!(
        "Toffolis a sphere: {other:.0} by the nearest point, with {} wrong hits; {built:.0} by BallPlan",
        compared.wrong
    );
    assert!(other > 1.5 * built, "{other} and {built}");
}
