//! Geometry of rays: a path, the edges of a face, and a point on a lamp.

use super::{Figure, cornell, scene};
use qrt::drawing::{Canvas, Panel, polyline};
use qrt::runtime::render::Model;
use qrt::runtime::traced_path::trace_path_of;
use qrt::tracer::StageGeometry;

/// Draws a path of the Cornell box, from the side.
pub(super) fn path() -> Figure {
    let scene = cornell(&["film={ width: 16, height: 16 }", "sampling.path_bits=12"]);
    // Search for the first path that meets two of floor and walls, and then the lamp.
    let found = (0..16_u32 * 16).find_map(|pixel| {
        (0..1_u64 << 12).find_map(|id| {
            let place = [pixel % 16, 8 + pixel / 16 % 8];
            let path = trace_path_of(&scene, Model::Real, 0, place, id).ok()?;
            let hits: Vec<_> = path.rays.iter().filter_map(|ray| ray.hit).collect();
            let ends = hits.len() == 3 && hits[2].name == "lamp" && hits[1].name != hits[0].name;
            ends.then_some((place, id, path))
        })
    });
    let (pixel, id, path) = found.expect("a lit path");
    let mut canvas = Canvas::new("A path of three rays, from the side", 660.0, 330.0);
    // z to the right, y up; the eye is far to the left and is drawn nearer.
    let panel = Panel {
        edges: [150.0, 40.0, 420.0, 310.0],
        x: [0.0, 559.2],
        y: [0.0, 548.8],
    };
    let at = |p: [f64; 3]| panel.at([p[2], p[1]]);
    for polygon in scene.polygons() {
        let corners: Vec<[f64; 2]> = polygon
            .vertices
            .iter()
            .map(|v| at([v.x, v.y, v.z]))
            .collect();
        canvas.path("grid", &format!("{}z", polyline(&corners)));
    }
    canvas.path(
        "axis",
        &polyline(&[[0.0, 548.8], [559.2, 548.8], [559.2, 0.0], [0.0, 0.0]].map(|p| panel.at(p))),
    );
    let lamp = [[227.0, 548.3], [332.0, 548.3]].map(|p| panel.at(p));
    canvas.line("line s4", lamp[0], lamp[1]);
    canvas.text("", [lamp[1][0] + 8.0, lamp[1][1] + 18.0], "lamp");
    let mut from = [24.0, panel.at([0.0, 273.0])[1]];
    canvas.circle("solid s0", from, 5.0);
    canvas.text("", [14.0, from[1] - 12.0], "eye");
    let mut labels = Vec::new();
    for (k, ray) in path.rays.iter().enumerate() {
        let Some(hit) = ray.hit else { continue };
        let place = [0, 1, 2].map(|i: usize| ray.origin[i] + hit.distance * ray.direction[i]);
        let to = at(place);
        canvas.arrow("s0", from, to);
        let middle = [0.6 * from[0] + 0.4 * to[0], 0.6 * from[1] + 0.4 * to[1]];
        canvas.text(
            "soft",
            [middle[0] + 6.0, middle[1] - 6.0],
            &format!("ray {k}"),
        );
        canvas.circle("solid s1", to, 4.0);
        labels.push(format!("ray {k} meets `{}`", hit.name));
        from = to;
    }
    let notes = [
        "at each hit: what it emits,",
        "times the weights W so far",
        "",
        "colour = Lₑ(hit₀) +",
        "Lₑ(hit₁) W₀ +",
        "Lₑ(hit₂) W₀ W₁",
    ];
    for (k, note) in notes.iter().enumerate() {
        canvas.text(
            if k < 2 { "soft small" } else { "small" },
            [432.0, 130.0 + 19.0 * k as f64],
            note,
        );
    }
    let says = format!(
        "Path {id} of pixel ({}, {}) of the Cornell box of 16 x 16 pixels, as the tracer follows it, \
         seen from the side: {}. Its red is {:.3}.",
        pixel[0],
        pixel[1],
        labels.join(", "),
        path.colour[0]
    );
    Figure::drawn(canvas, says)
}

/// A parallelogram and a triangle on one plane.
const FACES: &str = "
name: faces
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 1, height: 1 }
materials: { white: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry:
  - quad: { vertices: [[-4, -1, 0], [-2, -1.4, 0], [-1, 1, 0], [-3, 1.4, 0]], material: white }
  - triangle: { vertices: [[1, -1.4, 0], [4, -0.8, 0], [2, 1.4, 0]], material: white }
";

/// Draws half-plane edge tests.
pub(super) fn edges() -> Figure {
    let scene = scene(FACES, "faces.yaml");
    let geometry = StageGeometry::new(scene.polygons(), scene.balls(), |_| false, &[]);
    let mut canvas = Canvas::new(
        "A face is where all edge tests of its plane pass",
        580.0,
        300.0,
    );
    let names = ["parallelogram: two tests", "triangle: three tests"];
    let mut told = Vec::new();
    for (k, face) in geometry.faces.iter().enumerate() {
        let corners = &geometry.corners[face.label as usize];
        let [low, high] = [f64::min, f64::max].map(|pick| {
            let of = |f: fn([f64; 2]) -> f64| {
                corners
                    .iter()
                    .map(|c| f([c.x, c.y]))
                    .reduce(pick)
                    .unwrap_or(0.0)
            };
            [of(|p| p[0]), of(|p| p[1])]
        });
        let room = 0.35 * (high[0] - low[0]).max(high[1] - low[1]);
        let left = 20.0 + 284.0 * k as f64;
        let (middle, half) = (
            [0, 1].map(|i| f64::midpoint(low[i], high[i])),
            0.5 * (high[0] - low[0]).max(high[1] - low[1]) + room,
        );
        let panel = Panel {
            edges: [left, 62.0, left + 256.0, 62.0 + 220.0],
            x: [
                middle[0] - half * 256.0 / 220.0,
                middle[0] + half * 256.0 / 220.0,
            ],
            y: [middle[1] - half, middle[1] + half],
        };
        canvas.text("", [left, 52.0], names[k]);
        canvas.rectangle("thin axis", [left, 62.0, 256.0, 220.0]);
        for (number, test) in face.edge_tests.iter().enumerate() {
            let class = format!("s{number}");
            let [a, b] = test.form;
            let form = |p: [f64; 2]| a * p[0] + b * p[1];
            // The part of the panel in which the test passes.
            let [left, right] = panel.x;
            let [bottom, top] = panel.y;
            let whole = vec![[left, bottom], [right, bottom], [right, top], [left, top]];
            let above = cut(&whole, |p| form(p) - test.low);
            let inside = cut(&above, |p| test.high - form(p));
            let outline: Vec<[f64; 2]> = inside.iter().map(|p| panel.at(*p)).collect();
            canvas.path(
                &format!("band {class}"),
                &format!("{}z", polyline(&outline)),
            );
            for bound in [test.low, test.high] {
                if let Some(ends) = clipped(&panel, [a, b], bound) {
                    canvas.line(
                        &format!("thin {class}"),
                        panel.at(ends[0]),
                        panel.at(ends[1]),
                    );
                }
            }
        }
        let outline: Vec<[f64; 2]> = corners.iter().map(|c| panel.at([c.x, c.y])).collect();
        canvas.path("wire", &format!("{}z", polyline(&outline)));
        let finite = face
            .edge_tests
            .iter()
            .map(|t| usize::from(t.low.is_finite()) + usize::from(t.high.is_finite()))
            .sum::<usize>();
        told.push(format!(
            "{} tests with {finite} edges",
            face.edge_tests.len()
        ));
    }
    let says = format!(
        "Faces on one plane, from the tracer's own edge tests. Each test says that a sum of two \
         coordinates of the point lies between two bounds, and passes in a strip, drawn in one colour. \
         The parallelogram: {}; the triangle: {}. The face is where all strips meet.",
        told[0], told[1]
    );
    Figure::drawn(canvas, says)
}

/// Returns the part of a polygon where a linear form is not negative.
fn cut(polygon: &[[f64; 2]], form: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for (k, from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let [start, end] = [form(*from), form(to)];
        if start >= 0.0 {
            kept.push(*from);
        }
        if (start >= 0.0) != (end >= 0.0) {
            let t = start / (start - end);
            kept.push([0, 1].map(|i: usize| from[i] + t * (to[i] - from[i])));
        }
    }
    kept
}

/// Returns the part of the line a x + b y = bound that is in a panel.
fn clipped(panel: &Panel, [a, b]: [f64; 2], bound: f64) -> Option<[[f64; 2]; 2]> {
    let square = a * a + b * b;
    let start = [a * bound / square, b * bound / square];
    let along = [-b, a];
    let at = |t: f64| [0, 1].map(|i: usize| start[i] + t * along[i]);
    let mut ends = [f64::NEG_INFINITY, f64::INFINITY];
    for (i, range) in [panel.x, panel.y].into_iter().enumerate() {
        if along[i] != 0.0 {
            let crossed = range.map(|edge| (edge - start[i]) / along[i]);
            ends[0] = ends[0].max(crossed[0].min(crossed[1]));
            ends[1] = ends[1].min(crossed[0].max(crossed[1]));
        }
    }
    (bound.is_finite() && ends[0] < ends[1]).then(|| ends.map(at))
}

/// Draws a vertex that is connected to a point on a lamp.
pub(super) fn lamp() -> Figure {
    let mut canvas = Canvas::new("The same light, found in two ways", 650.0, 280.0);
    let (x, y) = ([190.0, 236.0], [360.0, 70.0]);
    canvas.line("axis", [30.0, x[1]], [330.0, x[1]]);
    canvas.text("soft", [30.0, x[1] + 20.0], "surface, albedo ρ");
    canvas.line("line s4", [290.0, y[1]], [430.0, y[1]]);
    canvas.text("soft", [438.0, y[1] + 5.0], "lamp: area A, radiance Lₑ");
    canvas.arrow("axis", x, [x[0], x[1] - 78.0]);
    canvas.text("", [x[0] - 18.0, x[1] - 66.0], "n");
    canvas.arrow("axis", y, [y[0], y[1] + 60.0]);
    canvas.text("", [y[0] + 8.0, y[1] + 54.0], "m");
    canvas.line("thin s2 dash", x, y);
    canvas.text("", [270.0, 178.0], "d = y − x, r = |d|");
    canvas.arrow("s0", x, [316.0, y[1] + 3.0]);
    canvas.arrow("s0", x, [90.0, 120.0]);
    canvas.text("", [52.0, 112.0], "a ray");
    canvas.text("", [218.0, 86.0], "a ray that");
    canvas.text("", [218.0, 103.0], "meets it");
    canvas.circle("solid s1", x, 4.0);
    canvas.text("", [x[0] + 8.0, x[1] + 20.0], "x");
    canvas.circle("solid s1", y, 4.0);
    canvas.text("", [y[0] + 6.0, y[1] - 8.0], "y");
    canvas.text("small soft", [400.0, 150.0], "dashed: the connection,");
    canvas.text("small soft", [400.0, 167.0], "which counts W Lₑ F");
    canvas.text("small soft", [400.0, 190.0], "the ray that meets y");
    canvas.text("small soft", [400.0, 207.0], "counts W Lₑ F, too");
    let says = "A vertex x of a path with normal n, and a point y of a lamp with normal m. A dashed \
                line connects x with y; two rays leave x, of which one meets the lamp by chance. Under \
                the balance heuristic the connection and the ray to the same point count the same."
        .to_owned();
    Figure::drawn(canvas, says)
}
