//! One pixel of a small scene, from the scene to the counts, by every gate of its circuit.

mod panels;

use super::{Figure, root};
use qrt::core::inspect::{Inspection, OraclePixel, grouped};
use qrt::core::oracle::Oracles;
use qrt::drawing::Canvas;
use qrt::lab::simulate::{SimulateOptions, simulate};
use qrt::runtime::path_machines::run_paths;
use qrt::runtime::render::Model;
use qrt::runtime::traced_path::trace_path_of;
use qrt::scene::front;
use qrt::scene::lights::Lamp;
use qrt::scene::sampling::{Coordinate, PathPoints, cell_centre};
use qrt::scene::valid::ValidScene;

/// The scene, and a pixel from which the card hides a part of the lamp.
const SCENE: &str = "scenes-yaml/small/shadow.yaml";
const PIXEL: [u32; 2] = [3, 5];
const SEED: u64 = 0;
/// Numbers of the card and of the lamp among the scene's polygons.
const CARD: usize = 1;
const LAMP: usize = 2;
/// Number of outcomes that are drawn.
const SHOTS: u32 = 20;

/// A path of the pixel.
struct Path {
    /// The point of the wall that the pixel sees.
    seen: [f64; 3],
    /// The point of the lamp to which that point is connected.
    lamp: [f64; 3],
    /// Red, by the circuit's integers.
    colour: f64,
    /// Number of thresholds that it exceeds in the circuit that is simulated.
    good: u64,
}

impl Path {
    /// Returns the point where the connection to the lamp crosses the plane at the depth `z`.
    fn in_plane_of(&self, z: f64) -> [f64; 3] {
        let share = (z - self.seen[2]) / (self.lamp[2] - self.seen[2]);
        [0, 1, 2].map(|i: usize| self.seen[i] + share * (self.lamp[i] - self.seen[i]))
    }
}

/// Traces all paths of the pixel.
fn traced(scene: &ValidScene, oracles: &Oracles<'_>) -> Vec<Path> {
    let points = PathPoints::new(&scene.scene().sampling).expect("points");
    let alone = oracles.of_pixel(PIXEL);
    let oracle = alone.channel(0, alone.classes().class(PIXEL));
    let program = oracle.expect("an oracle").program_at(SEED, PIXEL);
    let good = run_paths::on_fixed(&program, 0..program.paths()).expect("paths");
    let lamp = Lamp::new(&scene.polygons()[LAMP].vertices).expect("a lamp");
    let card = &scene.polygons()[CARD].vertices;
    let paths = (0..).zip(&good).map(|(id, good)| {
        let path = trace_path_of(scene, Model::Fixed, SEED, PIXEL, id).expect("a path");
        let ray = &path.rays[0];
        let hit = ray.hit.expect("the wall");
        let [u, v] = [Coordinate::light_u(1), Coordinate::light_v(1)].map(|axis| {
            let shift = points.shift(SEED, PIXEL[0], PIXEL[1], axis);
            cell_centre(points.index(axis, id, shift), points.bits(axis))
        });
        let seen = [0, 1, 2].map(|i: usize| ray.origin[i] + hit.distance * ray.direction[i]);
        let path = Path {
            seen,
            lamp: (lamp.corner + lamp.edges[0] * u + lamp.edges[1] * v).to_array(),
            colour: path.colour[0],
            good: good[0],
        };
        // The drawn connection is the circuit's: the card hides the lamp where the colour is black.
        let at = path.in_plane_of(card[0].z);
        let hidden =
            card[0].x < at[0] && at[0] < card[2].x && card[0].y < at[1] && at[1] < card[2].y;
        assert_eq!(hidden, path.good == 0, "path {id}");
        path
    });
    paths.collect()
}

/// Draws the poster.
pub(super) fn poster() -> Figure {
    let loaded = front::load(&root().join(SCENE), &[]).unwrap_or_else(|report| panic!("{report}"));
    let scene = &loaded.valid;
    let oracles = Oracles::new(scene);
    let pixel = OraclePixel {
        place: PIXEL,
        seed: SEED,
    };
    let options = SimulateOptions {
        channel: Some(0),
        shots: Some(SHOTS),
        ..SimulateOptions::default()
    };
    let run = simulate(&oracles, pixel, &options).expect("a simulation");
    let call = Inspection::of_pixel(&oracles, Some(0), pixel).expect("an inspection");
    let paths = traced(scene, &oracles);
    assert_eq!(paths.iter().map(|path| path.good).sum::<u64>(), run.good);

    let mut canvas = Canvas::new("One pixel, from the scene to the counts", 800.0, 610.0);
    panels::scene(&mut canvas, scene, &paths);
    panels::colours(&mut canvas, &paths, &run);
    panels::indices(&mut canvas, &paths, &run);
    panels::call(&mut canvas, &call, &run);
    panels::counting(&mut canvas, &run);
    panels::counts(&mut canvas, &run);
    let film = panels::film(&mut canvas, scene);

    let total = call.total();
    let drawn = run.tally();
    let drawn: Vec<String> = drawn
        .iter()
        .map(|(y, count)| format!("{y} ({count} times)"))
        .collect();
    let says = format!(
        "Six panels. 1: a wall, a card before it and a lamp, with the {} paths of pixel {},{}: {} reach \
         the lamp, the card hides it from the others. 2: the red of each path, from 0 to the scale \
         {:.3}. 3: {} indices, a path and a threshold each; {} are good. 4: one query as boxes on wires, \
         compute, one sign, uncompute: {} Toffoli, {} qubits. 5: the circuit of counting with a phase \
         register of {} qubits: {} queries, {} gates, {} qubits. 6: the distribution of the outcomes; \
         {SHOTS} were drawn, {}, and the estimate of the pixel is {:.4}. All {} pixels as dots, counted so.",
        paths.len(),
        PIXEL[0],
        PIXEL[1],
        paths.iter().filter(|path| path.good > 0).count(),
        run.scale,
        run.total,
        run.good,
        grouped(total.toffoli),
        grouped(u64::from(call.qubits)),
        run.phase_bits,
        run.report.queries,
        grouped(run.report.gates),
        run.report.qubits,
        drawn.join(" and "),
        run.scale * run.estimate.amplitude,
        film,
    );
    Figure::drawn(canvas, says)
}
