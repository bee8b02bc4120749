//! Meshes of many kinds in a room, for tests of their search here, and of its circuits in `qrt-core`.

use glam::DVec3;
use qrt_scene::front::parse;
use qrt_scene::valid::ValidScene;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Half of the room around a mesh: a stage unit, nearly.
pub(super) const HALF: f64 = 0.999;

pub(super) type Triangles = Vec<[DVec3; 3]>;

/// A tube around a closed curve, of `along` times `around` quads, each of two triangles.
pub(super) fn tube(
    along: usize,
    around: usize,
    radius: f64,
    curve: impl Fn(f64) -> DVec3,
) -> Triangles {
    let point = |i: usize, j: usize| {
        let t = TAU * (i % along) as f64 / along as f64;
        let ahead = (curve(t + 1e-4) - curve(t)).normalize();
        let across = ahead.cross(DVec3::Y).normalize();
        let (sin, cos) = (TAU * (j % around) as f64 / around as f64).sin_cos();
        curve(t) + radius * (across * cos + across.cross(ahead) * sin)
    };
    quads(along, around, point)
}

pub(super) fn quads(
    along: usize,
    around: usize,
    point: impl Fn(usize, usize) -> DVec3,
) -> Triangles {
    let mut triangles = Vec::new();
    for (i, j) in (0..along * around).map(|n| (n / around, n % around)) {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| point(i, j));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    triangles
}

pub(super) fn knot(along: usize, around: usize) -> Triangles {
    tube(along, around, 0.12, |t| {
        let far = 0.6 + 0.2 * (3.0 * t).cos();
        DVec3::new(
            far * (2.0 * t).cos(),
            0.25 * (3.0 * t).sin(),
            far * (2.0 * t).sin(),
        )
    })
}

pub(super) fn torus(along: usize, around: usize) -> Triangles {
    tube(along, around, 0.25, |t| {
        DVec3::new(0.6 * t.cos(), 0.0, 0.6 * t.sin())
    })
}

/// A sheet of waves, open at its borders.
pub(super) fn waves(side: usize) -> Triangles {
    let mut triangles = quads(side, side, |i, j| {
        let [x, z] = [i, j].map(|k| 2.0 * k as f64 / side as f64 - 1.0);
        DVec3::new(0.9 * x, 0.2 * (5.0 * x).sin() * (4.0 * z).cos(), 0.9 * z)
    });
    triangles.retain(|corners| corners[0].distance(corners[1]) < 1.0);
    triangles
}

/// A star of `points` points in `rings` rings, whose two apexes have that many faces twice.
pub(super) fn star(points: usize, rings: usize) -> Triangles {
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
pub(super) fn needles(around: usize) -> Triangles {
    tube(3, around, 0.0095, |t| {
        DVec3::new(0.7 * t.cos(), 0.1 * t.sin(), 0.7 * t.sin())
    })
}

pub(super) fn turned(triangles: Triangles) -> Triangles {
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

pub(super) fn moved(triangles: Triangles, by: DVec3, scale: f64) -> Triangles {
    let moved = |corners: [DVec3; 3]| corners.map(|p| p * scale + by);
    triangles.into_iter().map(moved).collect()
}

pub(super) fn scene(triangles: &Triangles) -> ValidScene {
    scene_from(triangles, DVec3::new(0.0, 3.0, 5.0))
}

pub(super) fn scene_from(triangles: &Triangles, eye: DVec3) -> ValidScene {
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

/// The meshes by name.
pub(super) fn meshes() -> [(&'static str, Triangles); 10] {
    // The second one stands in the first one's hole, and touches it.
    let two = [
        torus(16, 8),
        moved(torus(16, 8), DVec3::new(0.01, 0.0, 0.0), 0.4),
    ]
    .concat();
    [
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
    ]
}
