//! Primary rays and their hits, computed independently: in scene units, by textbook geometry.

use qrt::scene::Camera;
use qrt::scene::sampling::{Coordinate, PathPoints};
use qrt::scene::valid::ValidScene;

type V = [f64; 3];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn add(a: V, b: V, s: f64) -> V {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}

/// Position of a ray relative to a polygon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// The distance to the polygon's plane, in stage units of the ray's direction.
    pub(crate) distance: f64,
    /// Distance inside the polygon's edges, in stage units; negative outside.
    pub(crate) margin: f64,
    /// Speed at which the ray nears the plane, in the plane's main coordinate: the divisor of the
    /// distance.
    pub(crate) slope: f64,
    /// Length of the direction.
    pub(crate) length: f64,
}

/// Computes the position of a path's ray relative to all polygons of the scene. One unit of the scene is
/// `scale` stage units.
pub(crate) fn meetings(
    scene: &ValidScene,
    scale: f64,
    seed: u64,
    pixel: [u32; 2],
    id: u64,
) -> Vec<Meeting> {
    let written = scene.scene();
    let points = PathPoints::new(&written.sampling).unwrap();
    let at = |axis: usize| {
        let coordinate = [Coordinate::u(0), Coordinate::v(0)][axis];
        let shift = points.shift(seed, pixel[0], pixel[1], coordinate);
        let cells = f64::from(1_u32 << points.bits(coordinate));
        (f64::from(points.index(coordinate, id, shift)) + 0.5) / cells
    };
    let (width, height) = (
        f64::from(written.film.width),
        f64::from(written.film.height),
    );
    let x = (2.0 * (f64::from(pixel[0]) + at(0)) / width - 1.0) * width / height;
    let y = 1.0 - 2.0 * (f64::from(pixel[1]) + at(1)) / height;
    let (eye, target, up, half, perspective) = match &written.camera {
        Camera::Perspective(c) => (
            c.eye,
            c.target,
            c.up,
            (c.vfov.to_radians() / 2.0).tan(),
            true,
        ),
        Camera::Orthographic(c) => (c.eye, c.target, c.up, c.height / 2.0, false),
    };
    let (eye, target, up) = (eye.to_array(), target.to_array(), up.to_array());
    let forward = unit(sub(target, eye));
    let right = unit(cross(forward, unit(up)));
    let up = cross(right, forward);
    let moved = |from: V| add(add(from, right, half * x), up, half * y);
    let (origin, direction) = if perspective {
        (eye, moved(forward))
    } else {
        (moved(eye), forward)
    };
    let polygons = scene.polygons().iter();
    polygons
        .map(|polygon| {
            let corners = &polygon.vertices[..polygon.corners as usize];
            let corners: Vec<V> = corners.iter().map(|c| [c.x, c.y, c.z]).collect();
            let normal = if let [a, b, c, d] = corners[..] {
                cross(sub(c, a), sub(d, b))
            } else {
                cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
            };
            let normal = unit(normal);
            let slope = dot(direction, normal);
            let distance = dot(sub(corners[0], origin), normal) / slope;
            let point = add(origin, direction, distance);
            let margin = (0..corners.len()).map(|k| {
                let edge = sub(corners[(k + 1) % corners.len()], corners[k]);
                dot(sub(point, corners[k]), unit(cross(normal, edge)))
            });
            let mut margin = margin.fold(f64::INFINITY, f64::min);
            if polygon.disc {
                let middle = add([0.0; 3], add(corners[0], corners[2], 1.0), 0.5);
                let across = sub(corners[1], corners[0]);
                let radius = 0.5 * dot(across, across).sqrt();
                let away = sub(point, middle);
                margin = radius - dot(away, away).sqrt();
            }
            let main = normal.map(f64::abs).into_iter().fold(0.0, f64::max);
            Meeting {
                distance: distance * scale,
                margin: margin * scale,
                slope: (slope / main).abs(),
                length: dot(direction, direction).sqrt(),
            }
        })
        .collect()
}
