//! Searches of meshes as circuits: their hits against `f64`, and their gates.

use super::Chance;
use super::circuit::Circuit;
use glam::DVec3;
use qrt_circuit::lower;
use qrt_scene::lights::polygon_distance;
use qrt_tracer::{Arith, NO_FACE, PixelClass, Ray, Stage};
use shapes::{HALF, Triangles, meshes, moved, scene, torus};

// All of these are searched by their edges, as a test of the tracer says.
#[path = "../../../../qrt-tracer/src/search/mesh/tests/shapes.rs"]
mod shapes;

/// True if the line passes all edges of the face on one side.
fn meets(outline: &[DVec3], origin: DVec3, direction: DVec3) -> bool {
    let mut signs = [false; 2];
    for (k, &a) in outline.iter().enumerate() {
        let b = outline[(k + 1) % outline.len()];
        let side = direction.dot((a - origin).cross(b - origin));
        signs[0] |= side < 0.0;
        signs[1] |= side > 0.0;
    }
    signs[0] != signs[1]
}

/// True if the closed surface encloses the point, or is `near` it.
fn encloses(faces: &[&[DVec3]], point: DVec3, near: f64) -> bool {
    let direction = DVec3::new(0.615_234_917, 0.493_817_263, 0.614_327_811).normalize();
    let ahead =
        |face: &&&[DVec3]| meets(face, point, direction) && far(face, point, direction) > 0.0;
    faces
        .iter()
        .any(|face| polygon_distance(face, point) <= near)
        || faces.iter().filter(ahead).count() % 2 == 1
}

/// The distance of a face's plane along a ray.
fn far(corners: &[DVec3], origin: DVec3, direction: DVec3) -> f64 {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    (corners[0] - origin).dot(normal) / direction.dot(normal)
}

/// The nearest of the triangles that a ray meets.
fn nearest(faces: &[&[DVec3]], origin: DVec3, direction: DVec3) -> Option<usize> {
    let hits = faces.iter().enumerate().filter_map(|(face, corners)| {
        let distance = far(corners, origin, direction);
        let met = meets(corners, origin, direction) && distance > 0.0;
        met.then_some((face, distance))
    });
    let hits = hits.min_by(|a, b| a.1.total_cmp(&b.1));
    hits.map(|(face, _)| face)
}

/// The outcomes of rays against a mesh.
#[derive(Debug, Default)]
struct Outcomes {
    rays: usize,
    hits: usize,
    /// Another face than in `f64`, which a ray within a few units of this one meets.
    neighbours: usize,
    /// Another face or none, although all rays around agree.
    wrong: usize,
    /// Of these, those that pass through a face and meet one behind it.
    passed: usize,
}

/// Shoots `rays` at a mesh, at points of its faces or at its corners.
fn shoot(
    name: &str,
    triangles: &Triangles,
    fraction: u32,
    rays: usize,
    at_corners: bool,
) -> Outcomes {
    let scene = scene(triangles);
    let stage = Stage::<3>::rgb(&scene, PixelClass::MayMeetLamp);
    let geometry = stage.geometry();
    let faces: &Vec<&[DVec3]> = &geometry.corners.iter().collect();
    let circuit = Circuit::nearest(&scene, fraction);
    let units = (1_u64 << fraction) as f64;
    let open = name.starts_with("waves");
    let mut chance = Chance(11);
    let mut outcomes = Outcomes::default();
    let none = faces.len();
    for _ in 0..rays {
        let [x, y, z] = [(); 3].map(|()| chance.between(-HALF, HALF));
        let mut origin = DVec3::new(x, y, z);
        let any = 6 + (chance.next() * (none - 6) as f64) as usize;
        if chance.next() < 0.3 {
            // From a face, a little above it.
            let [a, b, c] = [faces[any][0], faces[any][1], faces[any][2]];
            origin = (a + b + c) / 3.0 + 0.01 * (b - a).cross(c - a).normalize();
        }
        let aimed = faces[6 + (chance.next() * (none - 6) as f64) as usize];
        let [a, b, c] = [aimed[0], aimed[1], aimed[2]];
        let weights = [(); 3].map(|()| chance.next() + 1e-3);
        let sum: f64 = weights.iter().sum();
        let aim = if at_corners {
            a
        } else {
            (a * weights[0] + b * weights[1] + c * weights[2]) / sum
        };
        let within = !open && encloses(&faces[6..], origin, 0.0);
        if aim.distance(origin) < 0.02 || within {
            continue;
        }
        let direction = (aim - origin).normalize();
        let whole = |v: DVec3| v.to_array().map(|c| (c * units).round() as i64);
        let ([ox, oy, oz], [dx, dy, dz]) = (whole(origin), whole(direction));
        let exact = |v: [i64; 3]| DVec3::from_array(v.map(|c| c as f64 / units));
        let (origin, direction) = (exact([ox, oy, oz]), exact([dx, dy, dz]));
        let (face, distance) = circuit.run([ox, oy, oz, dx, dy, dz]);
        let found = (face < none).then_some(face);
        let expected = nearest(faces, origin, direction);
        outcomes.rays += 1;
        outcomes.hits += usize::from(expected.is_some());
        if found == expected {
            continue;
        }
        let around = (0..1000).any(|_| {
            let mut off =
                || DVec3::from_array([(); 3].map(|()| 16.0 / units * (2.0 * chance.next() - 1.0)));
            nearest(faces, origin + off(), direction + off()) == found
        });
        if around {
            outcomes.neighbours += 1;
        } else {
            outcomes.wrong += 1;
            let expected = expected.map_or(9.0, |face| far(faces[face], origin, direction));
            outcomes.passed += usize::from(distance > expected + 0.02);
        }
    }
    let toffoli = lower::toffoli(&circuit.program);
    println!(
        "{name}: {} faces, {} Toffolis a face; {outcomes:?}",
        faces.len(),
        toffoli / faces.len() as u64
    );
    outcomes
}

#[test]
fn rays_meet_the_faces_that_they_meet_in_f64() {
    for (name, triangles) in &meshes() {
        for at_corners in [false, true] {
            let rays = if at_corners { 500 } else { 1000 };
            let outcomes = shoot(name, triangles, 16, rays, at_corners);
            assert!(outcomes.hits > rays / 2, "{name}: {outcomes:?}");
            assert_eq!(outcomes.passed, 0, "{name}: {outcomes:?}");
            // A needle is 80 units in the last place wide.
            if !at_corners && *name != "needles" {
                assert!(outcomes.wrong <= 2, "{name}: {outcomes:?}");
                assert!(outcomes.neighbours <= rays / 100, "{name}: {outcomes:?}");
            }
        }
    }
}

#[test]
fn shadows_fall_as_in_f64_from_near_and_far() {
    // Directions are four times the inputs: longer than the distance at which a unit direction's ray ends.
    const LONGER: f64 = 4.0;
    let scene = scene(&moved(torus(12, 6), DVec3::new(0.5, 0.5, 0.5), 0.5));
    let circuit = Circuit::new(&scene, 16, |search, cx, ray| {
        let ray = Ray {
            direction: ray.direction.map(|part| cx.scale(part, LONGER)),
            t_max: 1.0,
            ..*ray
        };
        let (none, all) = (cx.index(0), cx.truth(true));
        let hidden = search.occluded(cx, &ray, none, all);
        let (hides, far) = (cx.index(1), cx.index(0));
        (ray.direction[0], cx.select_index(hidden, hides, far))
    });
    let stage = Stage::<3>::rgb(&scene, PixelClass::MayMeetLamp);
    let faces: &Vec<&[DVec3]> = &stage.geometry().corners.iter().skip(6).collect();
    let units = 65_536.0;
    let mut chance = Chance(3);
    let mut point = || DVec3::from_array([(); 3].map(|()| chance.between(-HALF, HALF)));
    let (mut hidden, mut lit, mut long) = (0, 0, 0);
    for _ in 0..4_000 {
        let (from, to) = (point(), point());
        let whole = |v: DVec3| v.to_array().map(|c| (c * units).round() as i64);
        let ([ox, oy, oz], [dx, dy, dz]) = (whole(from), whole((to - from) / LONGER));
        let exact = |v: [i64; 3]| DVec3::from_array(v.map(|c| c as f64 / units));
        let (origin, direction) = (exact([ox, oy, oz]), LONGER * exact([dx, dy, dz]));
        // Rays that pass near an edge, or end near a face, may fall on either side.
        let of = |grown: f64| {
            faces.iter().any(|face| {
                let middle = face.iter().sum::<DVec3>() / face.len() as f64;
                let face: Vec<DVec3> = face
                    .iter()
                    .map(|p| middle + (*p - middle) * grown)
                    .collect();
                let at = far(&face, origin, direction);
                let slack = 0.01 * (grown - 1.0);
                meets(&face, origin, direction) && -slack < at && at < 1.0 + slack
            })
        };
        let inside = encloses(faces, origin, 4e-3) || encloses(faces, to, 4e-3);
        if inside || of(1.02) != of(0.98) {
            continue;
        }
        let (found, _) = circuit.run([ox, oy, oz, dx, dy, dz]);
        assert_eq!(found == 1, of(1.0), "{origin} {direction}");
        hidden += usize::from(of(1.0));
        lit += usize::from(!of(1.0));
        long += usize::from(of(1.0) && direction.length() > 2.2);
    }
    assert!(
        hidden > 50 && lit > 1_000 && long > 5,
        "{hidden} {lit} {long}"
    );
}

#[test]
fn a_face_that_is_met_on_all_paths_is_found() {
    let scene = scene(&torus(12, 6));
    let circuit = Circuit::new(&scene, 16, |_, cx, ray| {
        let marked = [(false, 3), (true, 2), (true, 7)];
        let marked = marked.map(|(holds, number)| (cx.truth(holds), number));
        let (none, all) = (cx.index(NO_FACE), cx.encode(&marked, 2));
        let (found, face) = all[1];
        (ray.direction[0], cx.select_index(found, face, none))
    });
    assert_eq!(circuit.run([0; 6]).0, 7);
}
