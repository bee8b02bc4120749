//! Compares both searches of spheres with the roots of each sphere's quadratic equation, along paths
//! through random scenes: spheres apart, overlapping, nested, cut by polygons, with the eye inside.

use super::*;

/// Distances below which a difference is rounding: spheres that are met, and starts on a surface.
const NEAR: f64 = 1e-6;

/// The nearest hit of a ray by solving the equations of all spheres, after the faces of `polygons`.
/// None if the answer is within rounding of another.
#[allow(clippy::option_option)] // Unknown, or known to be nothing.
fn solved(stage: &Stage<3>, ray: &Ray<Scalar>) -> Option<Option<(u32, f64)>> {
    let geometry = stage.geometry();
    let origin = DVec3::from(ray.origin);
    let direction = DVec3::from(ray.direction);
    let square = direction.length_squared();
    let mut best: Option<(u32, f64)> = None;
    let mut second = f64::INFINITY;
    let mut meet = |label: u32, t: f64| {
        let nearest = best.map_or(f64::INFINITY, |(_, t)| t);
        if t < nearest {
            second = nearest;
            best = Some((label, t));
        } else {
            second = second.min(t);
        }
    };
    for ball in &geometry.balls {
        let offset = origin - ball.centre;
        let half = offset.dot(direction);
        let rest = offset.length_squared() - ball.radius * ball.radius;
        let determinant = half * half - square * rest;
        if determinant.abs() < NEAR * square * ball.radius * ball.radius {
            return None;
        }
        if determinant < 0.0 {
            continue;
        }
        let left = ray.from == ball.number;
        if !left && rest.abs() < NEAR || left && half.abs() < NEAR {
            return None;
        }
        for root in [-determinant.sqrt(), determinant.sqrt()] {
            let t = (root - half) / square;
            if t > if left { NEAR } else { 0.0 } {
                meet(ball.label, t);
            }
        }
    }
    for number in 0..geometry.faces.len() {
        let (meets, t) = geometry.meet(&mut Scalar::default(), number, ray);
        if meets {
            meet(geometry.faces[number].label, t);
        }
    }
    let nearest = best.map_or(f64::INFINITY, |(_, t)| t);
    (second - nearest > NEAR || nearest.is_infinite()).then_some(best)
}

/// A random scene of spheres on a floor, with a lamp above and a wall that cuts some of them.
fn random_scene(chance: &mut Chance) -> Stage<3> {
    let mut text = String::from(
        "name: spheres\nfilm: { width: 16, height: 16 }\nmaterials:\n  \
         matte: { lambertian: { albedo: [0.5, 0.5, 0.5] } }\n  glass: { dielectric: { ior: 1.5 } }\n  \
         lamp: { emitter: { radiance: [1, 1, 1] } }\ngeometry:\n  \
         - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: matte }\n  \
         - quad: { vertices: [[-1, 3, -1], [1, 3, -1], [1, 3, 1], [-1, 3, 1]], material: lamp }\n",
    );
    if chance.next() < 0.5 {
        text.push_str(
            "  - quad: { vertices: [[-1, -1, 0], [1, -1, 0.2], [1, 2, 0.2], [-1, 2, 0]], \
             material: matte }\n",
        );
    }
    let count = 1 + (chance.next() * 6.0) as usize;
    let mut first = (DVec3::ZERO, 1.0);
    for number in 0..count {
        let radius = 2.0_f64.powf(chance.between(-4.0, 0.0));
        let mut at = DVec3::from_array([(); 3].map(|()| chance.between(-1.5, 1.5)));
        at.y += 1.5;
        // Some spheres are within another, or around it.
        if number > 0 && chance.next() < 0.25 {
            at = first.0 + 0.3 * first.1 * chance.direction();
        }
        first = (at, radius);
        let material = if chance.next() < 0.4 {
            "glass"
        } else {
            "matte"
        };
        let at = at.to_array();
        writeln!(
            text,
            "  - sphere: {{ center: {at:?}, radius: {radius}, material: {material} }}"
        )
        .unwrap();
    }
    let eye = if chance.next() < 0.2 {
        (first.0 + 0.2 * first.1 * chance.direction()).to_array()
    } else {
        [0.3, 1.5, chance.between(4.0, 40.0)]
    };
    writeln!(
        text,
        "camera: {{ perspective: {{ eye: {eye:?}, target: [0.1, 1.2, -3], vfov: 30 }} }}\n\
         sampling: {{ depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4] }}], lights: none }}"
    )
    .unwrap();
    staged(&text)
}

fn unit(ray: &Ray<Scalar>) -> Ray<Scalar> {
    Ray {
        direction: DVec3::from(ray.direction).normalize().to_array(),
        ..*ray
    }
}

/// An ulp so small that rounding a centre moves no hit by the `NEAR` that the tests allow.
const FINE_ULP: f64 = 1.0 / (1_u64 << 36) as f64;

#[test]
fn searches_of_spheres_solve_their_equations() {
    let mut chance = Chance(7);
    let (mut rays, mut on_spheres, mut shadows, mut inside) = (0, 0, [0, 0], 0);
    for scene in 0..200 {
        let stage = random_scene(&mut chance);
        let geometry = stage.geometry();
        let search = Search::new(&stage, FINE_ULP);
        let cx = &mut Scalar::default();
        for _ in 0..100 {
            let mut ray = unit(&camera_ray(&stage, &mut chance));
            for _ in 0..5 {
                let Some(expected) = solved(&stage, &ray) else {
                    break;
                };
                let simple = geometry.nearest(cx, &ray, true);
                let found = search.nearest(cx, &ray, true);
                for (what, hit) in [("loop", &simple), ("search", &found)] {
                    let told = hit.found.then_some((hit.face, hit.distance));
                    let same = match (told, expected) {
                        (Some((face, t)), Some((known, distance))) => {
                            face == known && (t - distance).abs() < 1e-6 * (1.0 + distance)
                        }
                        (None, None) => true,
                        _ => false,
                    };
                    assert!(
                        same,
                        "scene {scene}: {what} {told:?}, solved {expected:?}, {:?} {:?} from {}\n{geometry:?}",
                        ray.origin, ray.direction, ray.from
                    );
                }
                rays += 1;
                let Some((face, distance)) = expected else {
                    break;
                };
                let point = DVec3::from(ray.origin) + distance * DVec3::from(ray.direction);
                let first = geometry.corners.len() as u32;
                let normal = match face.checked_sub(first) {
                    Some(ball) => {
                        let ball = &geometry.balls[ball as usize];
                        on_spheres += 1;
                        let normal = (point - ball.centre) / ball.radius;
                        let front = normal.dot(ray.direction.into()) < 0.0;
                        assert_eq!(found.front, Some(front), "scene {scene}: {ball:?}");
                        inside += usize::from(!front);
                        normal
                    }
                    None => DVec3::from(stage.normal(face as usize)),
                };
                let viewer = -normal.dot(ray.direction.into()).signum() * normal;
                let mut direction = chance.direction();
                direction *= direction.dot(viewer).signum();
                if stage.transmits[face as usize] && chance.next() < 0.7 {
                    direction = -direction;
                }
                ray = Ray {
                    origin: point.to_array(),
                    direction: direction.to_array(),
                    from: geometry.plane_of[face as usize],
                    t_max: stage.t_max,
                    start: Start::Surface,
                };
                // A shadow ray, whose direction has any length.
                let end = [chance.between(-1.0, 1.0), chance.between(-1.0, 1.0)];
                let scaled = (DVec3::new(end[0], 3.0, end[1]) - geometry.centre) * geometry.scale;
                let shadow = Ray {
                    direction: (scaled - point).to_array(),
                    t_max: 1.0,
                    ..ray
                };
                let Some(blocked) = solved(&stage, &shadow) else {
                    continue;
                };
                if viewer.dot(shadow.direction.into()) <= 0.0 {
                    continue;
                }
                let at_end = |c: &[DVec3]| (c[0].y - scaled.y).abs() < NEAR;
                let lamp = geometry.corners.iter().position(at_end);
                let expected =
                    blocked.is_some_and(|(face, t)| t < 1.0 - NEAR && Some(face as usize) != lamp);
                let simple = geometry.occluded(cx, &shadow, 0, true);
                let found = search.occluded(cx, &shadow, 0, true);
                assert_eq!(
                    [simple, found],
                    [expected; 2],
                    "scene {scene}: {blocked:?} {geometry:?}"
                );
                shadows[usize::from(expected)] += 1;
            }
        }
    }
    assert!(
        rays > 20_000
            && on_spheres > 8000
            && inside > 1000
            && shadows[0] > 1000
            && shadows[1] > 1000,
        "{rays} rays, {on_spheres} on spheres, {inside} of these within, {shadows:?} shadows"
    );
}
