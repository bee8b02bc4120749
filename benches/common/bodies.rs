//! Convex bodies of a few faces, above a floor and below a lamp.

use std::fmt::Write;

type Point = [f64; 3];

/// A convex body.
#[derive(Clone, Copy)]
pub(crate) enum Solid {
    /// Six quads.
    Cube,
    /// Twenty triangles.
    Icosahedron,
    /// The convex hull of the corners of an icosahedron and of the middles of its edges, moved onto
    /// its sphere: eighty triangles.
    Hull,
}

fn on_sphere(p: Point) -> Point {
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / length)
}

fn icosahedron() -> Vec<Vec<Point>> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let signs = [
        (1.0, golden),
        (1.0, -golden),
        (-1.0, golden),
        (-1.0, -golden),
    ];
    let corners = signs.map(|(a, b)| [[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    let corners = corners.concat();
    // Edges are 2 long, and all other pairs of corners are farther apart.
    let near = |a: &Point, b: &Point| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        square < 4.1
    };
    let mut faces = Vec::new();
    for (i, a) in corners.iter().enumerate() {
        for (j, b) in corners.iter().enumerate().skip(i + 1) {
            for c in &corners[j + 1..] {
                if near(a, b) && near(b, c) && near(a, c) {
                    faces.push([*a, *b, *c].map(on_sphere).to_vec());
                }
            }
        }
    }
    faces
}

fn cube() -> Vec<Vec<Point>> {
    let side = |axis: usize, at: f64| {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corner = |[s, t]: [f64; 2]| {
            let mut corner = [0.0; 3];
            corner[axis] = at;
            corner[(axis + 1) % 3] = s;
            corner[(axis + 2) % 3] = t;
            on_sphere(corner)
        };
        corners.map(corner).to_vec()
    };
    let axes = (0..3).flat_map(|axis| [side(axis, -1.0), side(axis, 1.0)]);
    axes.collect()
}

impl Solid {
    fn faces(self) -> Vec<Vec<Point>> {
        match self {
            Self::Cube => cube(),
            Self::Icosahedron => icosahedron(),
            Self::Hull => {
                let split = |face: Vec<Point>| {
                    let [a, b, c] = [face[0], face[1], face[2]];
                    let middle = |p: Point, q: Point| on_sphere([0, 1, 2].map(|k| p[k] + q[k]));
                    let [x, y, z] = [middle(a, b), middle(b, c), middle(c, a)];
                    [[a, x, z], [x, b, y], [z, y, c], [x, y, z]].map(|face| face.to_vec())
                };
                icosahedron().into_iter().flat_map(split).collect()
            }
        }
    }

    /// Returns its number of faces.
    pub(crate) fn count(self) -> usize {
        self.faces().len()
    }
}

/// Returns a floor, a lamp and, between them, a body turned so that no face is level; paths of three rays.
pub(crate) fn scene(solid: Option<Solid>) -> String {
    let mut text = String::from(
        "name: body\n\
         camera: { perspective: { eye: [0, 1, -4], target: [0, 1, 0], vfov: 40 } }\n\
         film: { width: 16, height: 16 }\n\
         materials:\n  \
           grey: { lambertian: { albedo: [0.7, 0.6, 0.5] } }\n  \
           lamp: { emitter: { radiance: [4, 4, 4] } }\n\
         geometry:\n  \
           - quad: { vertices: [[-1, 2.5, -1], [1, 2.5, -1], [1, 2.5, 1], [-1, 2.5, 1]], \
         material: lamp }\n  \
           - quad: { vertices: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: grey }\n",
    );
    let turned = |[x, y, z]: Point| {
        let (sin, cos) = 0.5_f64.sin_cos();
        let (x, z) = (cos * x + sin * z, cos * z - sin * x);
        let (sin, cos) = 0.3_f64.sin_cos();
        let (x, y) = (cos * x + sin * y, cos * y - sin * x);
        [0.5 * x, 1.0 + 0.5 * y, 0.5 * z]
    };
    for face in solid.map(Solid::faces).into_iter().flatten() {
        let kind = if face.len() == 3 { "triangle" } else { "quad" };
        let corners = face.into_iter().map(turned);
        let corners = corners.map(|[x, y, z]| format!("[{x:.12}, {y:.12}, {z:.12}]"));
        let corners = corners.collect::<Vec<_>>().join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  - {kind}: {{ vertices: [{corners}], material: grey }}"
        );
    }
    let depths = ["{ bits: [8, 8] }"; 3].join(", ");
    let _ = writeln!(
        text,
        "sampling: {{ path_bits: 14, depths: [{depths}], lights: none }}\ncomparator: {{ bits: 12 }}"
    );
    text
}
