//! The panels of the poster.

use super::{CARD, LAMP, PIXEL, Path, SHOTS};
use qrt::core::inspect::{Inspection, grouped};
use qrt::drawing::{Canvas, polyline};
use qrt::lab::simulate::Simulation;
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::valid::ValidScene;
use std::f64::consts::PI;

/// Left edges of the columns of panels, their width, and the top edges of the rows.
const COLUMNS: [f64; 3] = [14.0, 282.0, 550.0];
const WIDTH: f64 = 236.0;
const ROWS: [f64; 2] = [58.0, 334.0];

/// Begins a panel: its heading, and notes below it.
fn begin(
    canvas: &mut Canvas,
    [column, row]: [usize; 2],
    heading: &str,
    notes: &[&str],
) -> [f64; 2] {
    let [left, top] = [COLUMNS[column], ROWS[row]];
    canvas.text("title", [left, top], heading);
    for (k, note) in notes.iter().enumerate() {
        canvas.text("small soft", [left, top + 18.0 + 15.0 * k as f64], note);
    }
    [left, top + 24.0 + 15.0 * notes.len() as f64]
}

/// Draws the scene in oblique projection, with all paths of the pixel.
pub(super) fn scene(canvas: &mut Canvas, scene: &ValidScene, paths: &[Path]) {
    let notes = [
        "a wall of 8 × 8 pixels, a card before",
        "it, a lamp above: one pixel's paths",
    ];
    let [left, top] = begin(canvas, [0, 0], "1  Scene", &notes);
    let at = |[x, y, z]: [f64; 3]| {
        [
            left + 144.0 + 39.0 * (x - 0.38 * z),
            top + 92.0 - 39.0 * (y - 0.3 * z),
        ]
    };
    for k in 0..=8 {
        let place = f64::from(k) / 2.0 - 2.0;
        canvas.line("grid", at([place, -2.0, 0.0]), at([place, 2.0, 0.0]));
        canvas.line("grid", at([-2.0, place, 0.0]), at([2.0, place, 0.0]));
    }
    let [x, y] = [
        f64::from(PIXEL[0]) / 2.0 - 2.0,
        1.5 - f64::from(PIXEL[1]) / 2.0,
    ];
    let corner = at([x, y + 0.5, 0.0]);
    canvas.rectangle("pale s0", [corner[0], corner[1], 19.5, 19.5]);
    let middle = [x + 0.25, y + 0.25];
    canvas.arrow(
        "s0",
        at([middle[0], middle[1], 3.4]),
        at([middle[0], middle[1], 0.1]),
    );
    canvas.text("small", at([middle[0] - 0.9, middle[1] + 0.1, 3.4]), "eye");
    for path in paths {
        if path.good > 0 {
            canvas.line("thin s4", at(path.seen), at(path.lamp));
        } else {
            let end = path.in_plane_of(scene.polygons()[CARD].vertices[0].z);
            canvas.line("thin s1", at(path.seen), at(end));
        }
    }
    for (polygon, class, name, aside) in [
        (CARD, "pale s1", "card", [-34.0, 16.0]),
        (LAMP, "pale s4", "lamp", [6.0, -2.0]),
    ] {
        let corners: Vec<[f64; 2]> = scene.polygons()[polygon]
            .vertices
            .iter()
            .map(|v| at(v.to_array()))
            .collect();
        canvas.path(class, &format!("{}z", polyline(&corners)));
        let corner = corners[2];
        canvas.text("small", [corner[0] + aside[0], corner[1] + aside[1]], name);
    }
}

/// Draws the colours of all paths as bars.
pub(super) fn colours(canvas: &mut Canvas, paths: &[Path], run: &Simulation) {
    let count = paths.len().to_string();
    let notes = [
        &*format!(
            "path index of {} qubits: {count} paths at once,",
            run.path_bits
        ),
        "each a colour in fixed point",
    ];
    let [left, top] = begin(canvas, [1, 0], "2  Paths in superposition", &notes);
    let (left, bottom, tall) = (left + 36.0, top + 166.0, 160.0);
    for (share, label) in [(0.0, "0".to_owned()), (1.0, format!("{:.2}", run.scale))] {
        let y = bottom - tall * share;
        canvas.line("grid", [left, y], [left + 196.0, y]);
        canvas.text("small soft end", [left - 6.0, y + 4.0], &label);
    }
    canvas.upright("small soft", [left - 10.0, bottom - tall / 2.0], "red");
    for (id, path) in paths.iter().enumerate() {
        let (x, height) = (
            left + 2.0 + 12.0 * id as f64,
            tall * path.colour / run.scale,
        );
        if path.good > 0 {
            canvas.rectangle("pale s4", [x, bottom - height, 10.0, height]);
        } else {
            canvas.line("thin s1", [x, bottom - 1.0], [x + 10.0, bottom - 1.0]);
        }
    }
    canvas.text(
        "small soft mid",
        [left + 98.0, bottom + 16.0],
        "path 0 to 15",
    );
}

/// Draws the good indices.
pub(super) fn indices(canvas: &mut Canvas, paths: &[Path], run: &Simulation) {
    let notes = [
        "is the path brighter than a threshold?",
        &*format!("good: S = {} of N = {}", run.good, run.total),
    ];
    let [left, top] = begin(canvas, [2, 0], "3  A sum becomes a count", &notes);
    let (left, top, side) = (left + 36.0, top + 6.0, 10.0);
    let thresholds = run.total as usize / paths.len();
    canvas.upright("small soft", [left - 10.0, top + 80.0], "threshold");
    for (id, path) in paths.iter().enumerate() {
        for y in 0..thresholds {
            let class = if (y as u64) < path.good {
                "pale s1"
            } else {
                "box"
            };
            let place = [
                left + 12.0 * id as f64 + 2.0,
                top + side * (thresholds - 1 - y) as f64,
            ];
            canvas.rectangle(class, [place[0], place[1], 10.0, side - 2.0]);
        }
    }
    canvas.text("small soft mid", [left + 98.0, top + 176.0], "path 0 to 15");
}

/// Draws one query as boxes on wires.
pub(super) fn call(canvas: &mut Canvas, call: &Inspection, run: &Simulation) {
    let total = call.total();
    let notes = [
        "compute, flip the sign, uncompute:",
        &*format!(
            "{} Toffoli, {} qubits",
            grouped(total.toffoli),
            grouped(u64::from(call.qubits))
        ),
    ];
    let [left, top] = begin(canvas, [0, 1], "4  One query", &notes);
    let work = call.qubits - run.path_bits - run.comparator_bits;
    let wires = [
        ("path", run.path_bits),
        ("threshold", run.comparator_bits),
        ("work", work),
    ];
    let y = |k: usize| top + 30.0 + 44.0 * k as f64;
    for (k, (name, qubits)) in wires.iter().enumerate() {
        canvas.line("wire", [left + 68.0, y(k)], [left + WIDTH, y(k)]);
        canvas.text("small", [left, y(k)], name);
        canvas.text(
            "small soft",
            [left, y(k) + 14.0],
            &format!("{qubits} qubits"),
        );
    }
    for (x, class, name) in [
        (72.0, "box", "trace, compare"),
        (182.0, "box undo", "undo both"),
    ] {
        canvas.rectangle(class, [left + x, y(0) - 18.0, 46.0, 124.0]);
        canvas.upright("small", [left + x + 27.0, y(1)], name);
    }
    canvas.rectangle("box flip", [left + 138.0, y(2) - 15.0, 30.0, 30.0]);
    canvas.text("mid", [left + 153.0, y(2) + 5.0], "Z");
    canvas.text(
        "small soft mid",
        [left + 153.0, y(2) + 34.0],
        "the signs stay,",
    );
    canvas.text(
        "small soft mid",
        [left + 153.0, y(2) + 49.0],
        "all work is zero again",
    );
}

/// Draws the circuit of counting.
pub(super) fn counting(canvas: &mut Canvas, run: &Simulation) {
    let notes = [
        &*format!("Grover's iterate G, {} queries:", run.report.queries),
        &*format!(
            "{} gates, {} qubits",
            grouped(run.report.gates),
            run.report.qubits
        ),
    ];
    let [left, top] = begin(canvas, [1, 1], "5  Turn, and read the angle", &notes);
    let names = ["G", "G²", "G⁴", "G⁸", "G¹⁶", "G³²"];
    assert_eq!(names.len(), run.phase_bits as usize);
    let y = |k: usize| top + 24.0 + 23.0 * k as f64;
    canvas.text("small", [left, y(0) + 4.0], "index");
    canvas.text("small", [left, y(1) + 4.0], "phase");
    canvas.text(
        "small soft",
        [left, y(1) + 19.0],
        &format!("{} qubits", run.phase_bits),
    );
    for k in 0..=names.len() {
        canvas.line("wire", [left + 54.0, y(k)], [left + WIDTH, y(k)]);
    }
    for (k, name) in names.iter().enumerate() {
        let x = left + 66.0 + 23.0 * k as f64;
        canvas.line("wire", [x, y(0)], [x, y(k + 1)]);
        canvas.circle("dot", [x, y(k + 1)], 3.4);
        canvas.rectangle("box", [x - 10.5, y(0) - 12.0, 21.0, 24.0]);
        canvas.text("small mid", [x, y(0) + 4.0], name);
    }
    let tall = y(names.len()) - y(1) + 18.0;
    canvas.rectangle("box undo", [left + 200.0, y(1) - 9.0, 26.0, tall]);
    canvas.text("mid", [left + 213.0, y(3) + 17.0], "F†");
}

/// Draws the distribution of the outcomes, and those that were drawn.
pub(super) fn counts(canvas: &mut Canvas, run: &Simulation) {
    let notes = [
        &*format!("{SHOTS} runs read y = T θ, sin² πθ = S/N;"),
        &*format!(
            "estimate {:.4}, exact {:.4}",
            run.scale * run.estimate.amplitude,
            run.scale * run.amplitude()
        ),
    ];
    let [left, top] = begin(canvas, [2, 1], "6  Counts", &notes);
    let (bottom, tall) = (top + 78.0, 66.0);
    let tally = run.tally();
    canvas.line("axis", [left, bottom], [left + WIDTH, bottom]);
    for outcome in run.outcomes.iter().take(11) {
        let x = left + 2.0 + 21.5 * outcome.y as f64;
        let height = tall * outcome.simulated / 0.8;
        if height >= 0.5 {
            canvas.rectangle("pale s5", [x, bottom - height, 17.0, height]);
        }
        canvas.text(
            "small soft mid",
            [x + 8.5, bottom + 14.0],
            &outcome.y.to_string(),
        );
        if let Some(count) = tally.get(&outcome.y) {
            canvas.text(
                "small mid",
                [x + 8.5, bottom - height - 4.0],
                &format!("{count}×"),
            );
        }
    }
    let steps = 2.0 * (run.outcomes.len() - 1) as f64;
    let theta = libm::asin(run.amplitude().sqrt()) / PI;
    let x = left + 10.5 + 21.5 * steps * theta;
    canvas.line("thin s1 dash", [x, bottom - 0.6 * tall], [x, bottom]);
}

/// Draws the picture of all pixels as dots whose areas are their radiances in red; returns the
/// number of pixels.
pub(super) fn film(canvas: &mut Canvas, scene: &ValidScene) -> usize {
    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let image = render(scene, &options).expect("a picture").image;
    let reds: Vec<f64> = image.pixels.iter().map(|pixel| pixel[0]).collect();
    let most = reds.iter().copied().fold(0.0, f64::max);
    let ([left, top], side) = ([COLUMNS[2], ROWS[1] + 158.0], 12.0);
    for (k, red) in reds.iter().enumerate() {
        let [x, y] = [k % image.width as usize, k / image.width as usize];
        let at = [
            left + side * (x as f64 + 0.5),
            top + side * (y as f64 + 0.5),
        ];
        let radius = 0.5 * side * (red / most).sqrt();
        if radius > 0.2 {
            canvas.circle("solid s4", at, radius);
        }
    }
    let [x, y] = PIXEL.map(|place| side * f64::from(place));
    canvas.rectangle("in-use", [left + x, top + y, side, side]);
    for (k, line) in ["all 64 pixels,", "counted so: red,", "as areas of dots"]
        .iter()
        .enumerate()
    {
        canvas.text(
            "small soft",
            [left + 112.0, top + 42.0 + 15.0 * k as f64],
            line,
        );
    }
    reds.len()
}
