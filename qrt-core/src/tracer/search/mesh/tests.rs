//! Searches of meshes as circuits: their hits against `f64`, and their gates.

use super::Facing;
use crate::tracer::geometry::NO_FACE;
use crate::tracer::ray::{NearestSearch, Ray};
use crate::tracer::search::Search;
use crate::tracer::search::tests::Chance;
use crate::tracer::search::tests::circuit::Circuit;
use crate::tracer::{Arith, PixelClass, Stage};
use glam::DVec3;
use qrt_circuit::lower;
use qrt_scene::front::parse;
use qrt_scene::valid::ValidScene;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Half of the room around a mesh: a stage unit, nearly.
const HALF: f64 = 0.999;

type Triangles = Vec<[DVec3; 3]>;

/// A tube around a closed curve, of `along` times `around` quads, each of two triangles.
fn tube(along: usize, around: usize, radius: f64, curve: impl Fn(f64) -> DVec3) -> Triangles {
    let point = |i: usize, j: usize| {
        let t = TAU * (i % along) as f64 / along as f64;
        let ahead = (curve(t + 1e-4) - curve(t)).normalize();
        let across = ahead.cross(DVec3::Y).normalize();
        let (sin, cos) = (TAU * (j % around) as f64 / around as f64).sin_cos();
        curve(t) + radius * (across * cos + across.cross(ahead) * sin)
    };
    quads(along, around, point)
}

fn quads(along: usize, around: usize, point: impl Fn(usize, usize) -> DVec3) -> Triangles {
    let mut triangles = Vec::new();
    for (i, j) in (0..along * around).map(|n| (n / around, n % around)) {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| point(i, j));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    triangles
}

fn knot(along: usize, around: usize) -> Triangles {
    tube(along, around, 0.12, |t| {
        let far = 0.6 + 0.2 * (3.0 * t).cos();
        DVec3::new(
            far * (2.0 * t).cos(),
            0.25 * (3.0 * t).sin(),
            far * (2.0 * t).sin(),
        )
    })
}

fn torus(along: usize, around: usize) -> Triangles {
    tube(along, around, 0.25, |t| {
        DVec3::new(0.6 * t.cos(), 0.0, 0.6 * t.sin())
    })
}

/// A sheet of waves, open at its borders.
fn waves(side: usize) -> Triangles {
    let mut triangles = quads(side, side, |i, j| {
        let [x, z] = [i, j].map(|k| 2.0 * k as f64 / side as f64 - 1.0);
        DVec3::new(0.9 * x, 0.2 * (5.0 * x).sin() * (4.0 * z).cos(), 0.9 * z)
    });
    triangles.retain(|corners| corners[0].distance(corners[1]) < 1.0);
    triangles
}

/// A star of `points` points in `rings` rings, whose two apexes have that many faces twice.
fn star(points: usize, rings: usize) -> Triangles {
    let count = 2 * points;
    let at = |ring: usize, k: usize, side: f64| {
        let out = ring as f64 / rings as f64;
        let far = out * [0.9, 0.35][k % 2];
        let (sin, cos) = (TAU * (k % count) as f64 / count as f64).sin_cos();
        let bent = side * 0.3 * (1.0 - out * out);
        DVec3::new(far * cos + 0.03, bent, far * sin + 0.02)
    };
    let mut triangles = Triangles::new();
    for n in 0..2 * rings * count {
        let (side, ring, k) = ([1.0, -1.0][n % 2], n / 2 / count, n / 2 % count);
        let [a, b] = [at(ring, k, side), at(ring, k + 1, side)];
        let [c, d] = [at(ring + 1, k, side), at(ring + 1, k + 1, side)];
        let mut push = |[a, b, c]: [DVec3; 3]| {
            triangles.push(if side > 0.0 { [a, c, b] } else { [a, b, c] });
        };
        push([a, c, d]);
        if ring > 0 {
            push([a, d, b]);
        }
    }
    triangles
}

/// A thin ring of triangles a thousand times as long as wide.
fn needles(around: usize) -> Triangles {
    tube(3, around, 0.0095, |t| {
        DVec3::new(0.7 * t.cos(), 0.1 * t.sin(), 0.7 * t.sin())
    })
}

fn turned(triangles: Triangles) -> Triangles {
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

fn moved(triangles: Triangles, by: DVec3, scale: f64) -> Triangles {
    let moved = |corners: [DVec3; 3]| corners.map(|p| p * scale + by);
    triangles.into_iter().map(moved).collect()
}

fn scene(triangles: &Triangles) -> ValidScene {
    scene_from(triangles, DVec3::new(0.0, 3.0, 5.0))
}

fn scene_from(triangles: &Triangles, eye: DVec3) -> ValidScene {
    let eye = eye.to_array();
    let mut text = format!(
        "name: mesh\nfilm: {{ width: 1, height: 1 }}\ncamera: {{ perspective: {{ eye: {eye:?}, target: [0, \
         0.9, 0], vfov: 40 }} }}\nmaterials: {{ matte: {{ lambertian: {{ albedo: 0.5 }} }} }}\ngeometry:\n",
    );
    // A room around the mesh: rays start within its walls.
    for (axis, side) in (0..6).map(|k| (k / 2, [HALF, -HALF][k % 2])) {
        let corner = |a: f64, b: f64| {
            let mut corner = [0.0; 3];
            corner[axis] = side;
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (a, b);
            corner
        };
        let corners = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)];
        let corners = corners.map(|(a, b)| corner(a, b));
        writeln!(
            text,
            "  - quad: {{ vertices: {corners:?}, material: matte }}"
        )
        .unwrap();
    }
    for corners in triangles {
        let corners = corners.map(|p| p.to_array());
        writeln!(
            text,
            "  - triangle: {{ vertices: {corners:?}, material: matte }}"
        )
        .unwrap();
    }
    parse(&text, "mesh.yaml", &[], "".as_ref()).unwrap().valid
}

fn circuit(scene: &ValidScene, fraction: u32) -> Circuit {
    Circuit::new(scene, fraction, |search, cx, ray, nearest| {
        let all = cx.truth(true);
        let hit = search.nearest(cx, ray, all);
        let none = cx.index(NO_FACE);
        nearest.distance = hit.distance;
        nearest.face = cx.select_index(hit.found, hit.face, none);
    })
}

/// The distance of a face's plane along a ray.
fn far(corners: &[DVec3], origin: DVec3, direction: DVec3) -> f64 {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    (corners[0] - origin).dot(normal) / direction.dot(normal)
}

/// The nearest of the triangles that a ray meets.
fn nearest(faces: &[Vec<DVec3>], origin: DVec3, direction: DVec3) -> Option<usize> {
    let hits = faces.iter().enumerate().filter_map(|(face, corners)| {
        super::lines::met_front(corners, origin, direction)?;
        let distance = far(corners, origin, direction);
        (distance > 0.0).then_some((face, distance))
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
    let faces = &geometry.corners;
    let circuit = circuit(&scene, fraction);
    let units = (1_u64 << fraction) as f64;
    let search = Search::new(&stage, 1.0 / units);
    assert!(
        search.surfaces.mesh.faces.len() + 6 == faces.len(),
        "{name}"
    );
    let open = search
        .surfaces
        .mesh
        .faces
        .first()
        .is_none_or(|face| face.facing == Facing::Both);
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
        let aimed = &faces[6 + (chance.next() * (none - 6) as f64) as usize];
        let [a, b, c] = [aimed[0], aimed[1], aimed[2]];
        let weights = [(); 3].map(|()| chance.next() + 1e-3);
        let sum: f64 = weights.iter().sum();
        let aim = if at_corners {
            a
        } else {
            (a * weights[0] + b * weights[1] + c * weights[2]) / sum
        };
        let within =
            !open && super::lines::encloses(faces[6..].iter().map(|f| &f[..]), origin, 0.0);
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
            let expected = expected.map_or(9.0, |face| far(&faces[face], origin, direction));
            outcomes.passed += usize::from(distance > expected + 0.02);
        }
    }
    let toffoli = lower::toffoli(&circuit.program);
    println!(
        "{:?} {name}: {} faces, {} Toffolis a face; {outcomes:?}",
        search.surfaces.mesh.size(),
        faces.len(),
        toffoli / faces.len() as u64
    );
    outcomes
}

#[test]
fn rays_meet_the_faces_that_they_meet_in_f64() {
    // The second one stands in the first one's hole, and touches it.
    let two = [
        torus(16, 8),
        moved(torus(16, 8), DVec3::new(0.01, 0.0, 0.0), 0.4),
    ]
    .concat();
    let meshes: [(&str, Triangles); 10] = [
        ("knot", knot(48, 6)),
        ("finer knot", knot(96, 8)),
        ("torus", torus(16, 8)),
        ("torus, fronts inwards", turned(torus(16, 8))),
        ("waves", waves(14)),
        ("waves from below", turned(waves(14))),
        ("star", star(15, 6)),
        ("needles", needles(48)),
        ("two tori", two),
        (
            "small torus",
            moved(torus(12, 6), DVec3::new(0.3, 0.2, 0.1), 0.2),
        ),
    ];
    for (name, triangles) in &meshes {
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
    let circuit = Circuit::new(&scene, 16, |search, cx, ray, nearest| {
        let ray = Ray {
            direction: ray.direction.map(|part| cx.scale(part, LONGER)),
            t_max: 1.0,
            ..*ray
        };
        let (none, all) = (cx.index(0), cx.truth(true));
        let hidden = search.occluded(cx, &ray, none, all);
        let (hides, far) = (cx.index(1), cx.index(0));
        nearest.face = cx.select_index(hidden, hides, far);
        nearest.distance = ray.direction[0];
    });
    let stage = Stage::<3>::rgb(&scene, PixelClass::MayMeetLamp);
    let faces = &stage.geometry().corners[6..];
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
                super::lines::met_front(&face, origin, direction).is_some()
                    && -slack < at
                    && at < 1.0 + slack
            })
        };
        let inside = super::lines::encloses(faces.iter().map(|f| &f[..]), origin, 1e-3)
            || super::lines::encloses(faces.iter().map(|f| &f[..]), to, 1e-3);
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
    let circuit = Circuit::new(&scene, 16, |_, cx, ray, nearest| {
        let marked = [(false, 3), (true, 2), (true, 7)];
        let marked = marked.map(|(holds, number)| (cx.truth(holds), number));
        let (none, all) = (cx.index(NO_FACE), cx.encode(&marked, 2));
        let (found, face) = all[1];
        nearest.face = cx.select_index(found, face, none);
        nearest.distance = ray.direction[0];
    });
    assert_eq!(circuit.run([0; 6]).0, 7);
}

#[test]
fn a_camera_on_a_face_does_not_search_it() {
    let faces = waves(14);
    let eye = faces[40].iter().sum::<DVec3>() / 3.0;
    let with_eye = |eye: DVec3| {
        let stage = Stage::<3>::rgb(&scene_from(&faces, eye), PixelClass::MayMeetLamp);
        let search = Search::new(&stage, 1.0 / 65_536.0);
        let label = 6 + 40;
        [&search.camera, &search.surfaces].map(|plan| plan.mesh.labels().any(|own| own == label))
    };
    assert_eq!(with_eye(eye), [false, true]);
    assert_eq!(with_eye(eye + 0.01 * DVec3::Y), [true, true]);
}

/// A prism over a polygon that crosses itself: closed, of a volume above 0, and met from behind first.
#[test]
fn surfaces_that_cross_themselves_have_no_outer_side() {
    let rim = [[-1.0, -0.6], [1.0, 1.0], [1.0, -1.0], [-1.0, 0.6]];
    let at = |k: usize, z: f64| DVec3::new(rim[k % 4][0], rim[k % 4][1], z);
    let mut outlines = vec![
        vec![at(0, 1.0), at(1, 1.0), at(2, 1.0)],
        vec![at(0, 1.0), at(2, 1.0), at(3, 1.0)],
        vec![at(2, -1.0), at(1, -1.0), at(0, -1.0)],
        vec![at(3, -1.0), at(2, -1.0), at(0, -1.0)],
    ];
    outlines.extend((0..4).map(|k| vec![at(k, -1.0), at(k + 1, -1.0), at(k + 1, 1.0), at(k, 1.0)]));
    let side = |outlines: &[Vec<DVec3>]| {
        let outlines: Vec<&[DVec3]> = outlines.iter().map(Vec::as_slice).collect();
        super::lines::outer_side(&outlines)
    };
    assert_eq!(side(&outlines), None);
    let of = |triangles: Triangles| {
        let outlines: Vec<Vec<DVec3>> = triangles.iter().map(|face| face.to_vec()).collect();
        side(&outlines)
    };
    assert_eq!(of(knot(48, 6)), of(torus(16, 8)));
    assert_eq!(
        of(turned(torus(16, 8))),
        of(torus(16, 8)).map(|front| !front)
    );
    assert!(of(torus(16, 8)).is_some());
}
