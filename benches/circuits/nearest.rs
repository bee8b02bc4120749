//! Queries to find primary hits by quantum search, over the number of faces P.
//!
//! `cargo bench --bench circuits -- nearest` prints, for scenes of 4 to 1,024 faces (parallelograms
//! askew before a perspective camera; rectangles along the axes before an orthographic one, as in
//! Alves 2019) and for example scenes, mean queries a ray
//!
//! * of a search without a first guess, and of one whose guess is the hit of the path before it
//!   or, with one path a pixel, the hit of the pixel beside it,
//! * relative to P, the queries of a test of every face, and relative to sqrt(P),
//! * relative to 22.5 sqrt(N) + 1.4 (log2 N)^2, after which Durr & Hoyer (1996) have found the minimum
//!   with probability 1/2;
//!
//! the rays whose nearest face was missed, beside the bound on their fraction; Toffolis and qubits
//! of a query; and the fitted exponents. It fails where a promise is broken.

use crate::common::growth::{chance, fit, quads};
use crate::common::{Arguments, Promises};
use qrt::core::oracle::NearestOracle;
use qrt::runtime::path_machines::{NearestMachine, PathRun, PrimaryHits};
use qrt::runtime::search::{FoundHits, Guess, Method, Rounds};
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// Failure probability delta of a ray's search.
const FAILURE: f64 = 1e-3;

/// Number of paths traced per pixel.
const PATHS: usize = 16;

/// Width and height in pixels of the traced part in the middle of the film.
const SIDE: u32 = 16;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    println!("a search fails with probability {FAILURE} at most");
    for (name, text) in [
        ("askew", quads as fn(u32) -> String),
        ("along the axes", rectangles),
    ] {
        println!("\nfaces {name}");
        header();
        let faces = (2..=10).map(|log| 1 << log);
        let rows: Vec<Row> = faces
            .map(|faces| Row::new(&parsed(&text(faces)), PATHS))
            .collect();
        for row in &rows {
            row.print();
        }
        for (which, guess) in ["random", "coherent"].into_iter().zip(0..) {
            let points = rows.iter().map(|row| [row.faces, row.queries[guess]]);
            let fit = fit(points);
            let within = (0.45..=0.55).contains(&fit.slope);
            let text = format!(
                "{name}, {which}: queries ~ P^{:.3}, up to {:.0} %",
                fit.slope,
                100.0 * fit.residual
            );
            promises.judge(&text, within);
        }
        judge(&rows, name, promises);
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scenes = ["cornell-box", "cornell-mirror", "floor-and-light", "knot"];
    for (paths, name) in [
        (PATHS, "example scenes"),
        (1, "example scenes, one path a pixel"),
    ] {
        println!("\n{name}");
        header();
        let rows = scenes.map(|scene| {
            let path = root.join("scenes-yaml").join(format!("{scene}.yaml"));
            // The search is compared with a row of planes that is not uncomputed plane by plane.
            let keep = ["circuit.uncompute=keep".to_owned()];
            let row = Row::new(&front::load(&path, &keep).unwrap().valid, paths);
            row.print();
            row
        });
        judge(&rows, name, promises);
        let coherent = rows.iter().all(|row| row.queries[1] < row.queries[0]);
        promises.judge(&format!("{name}: guesses save queries"), coherent);
    }
}

fn judge(rows: &[Row], name: &str, promises: &mut Promises) {
    let bound = rows.iter().all(|row| row.queries[0] < row.durr_hoyer);
    promises.judge(
        &format!("{name}: fewer queries than Durr & Hoyer's bound"),
        bound,
    );
    for (which, guess) in ["random", "coherent"].into_iter().zip(0..) {
        let missed: u64 = rows.iter().map(|row| row.missed[guess]).sum();
        let rays: u64 = rows.iter().map(|row| row.rays).sum();
        // Allow four standard deviations of the number of misses.
        let mean = FAILURE * rays as f64;
        let text = format!("{name}, {which}: {missed} of {rays} rays missed, {mean:.0} allowed");
        promises.judge(&text, missed as f64 <= mean + 4.0 * mean.sqrt());
    }
}

struct Row {
    faces: f64,
    states: usize,
    rays: u64,
    /// Mean queries of a ray, without a first guess and with one.
    queries: [f64; 2],
    /// Number of rays for which the search found another face than the nearest.
    missed: [u64; 2],
    durr_hoyer: f64,
    toffoli: u64,
    qubits: u32,
}

impl Row {
    fn new(scene: &ValidScene, paths: usize) -> Self {
        let oracle = Arc::new(NearestOracle::new(scene).unwrap().unwrap());
        let (faces, states) = (oracle.faces(), oracle.states());
        let (cost, qubits) = oracle.cost();
        let film = scene.scene().film;
        let from = |length: u32| {
            let side = SIDE.min(length);
            let first = (length - side) / 2;
            first..first + side
        };
        let pixels = from(film.height).flat_map(|y| from(film.width).map(move |x| [x, y]));
        let runs: Vec<PathRun> = pixels
            .map(|pixel| PathRun {
                pixel,
                first: 0,
                count: paths,
            })
            .collect();
        let rays = runs.len() * paths;
        let find = |method: Method| {
            let machine = NearestMachine::fixed(oracle.clone(), 0);
            let (mut hits, mut queries) = (vec![0; rays], vec![0; runs.len()]);
            let hits_of = FoundHits::new(machine, method, 0);
            hits_of.find(&runs, &mut hits, &mut queries).unwrap();
            (hits, queries.iter().sum::<u64>() as f64 / rays as f64)
        };
        let (nearest, all) = find(Method::Exhaustive);
        assert_eq!(all, faces as f64);
        let rounds = Rounds::new(states, faces, FAILURE).unwrap();
        let found = [Guess::Random, Guess::Coherent]
            .map(|guess| find(Method::Grover(rounds.clone(), guess)));
        let log = (states as f64).log2();
        Self {
            faces: faces as f64,
            states,
            rays: rays as u64,
            queries: found.each_ref().map(|(_, queries)| *queries),
            missed: found.each_ref().map(|(hits, _)| {
                let pairs = hits.iter().zip(&nearest);
                pairs.filter(|(hit, nearest)| hit != nearest).count() as u64
            }),
            durr_hoyer: 22.5 * (states as f64).sqrt() + 1.4 * log * log,
            toffoli: cost.toffoli,
            qubits,
        }
    }

    fn print(&self) {
        let [random, coherent] = self.queries;
        println!(
            "{:>6}{:>7}{random:>10.1}{coherent:>10.1}{:>9.2}{:>9.2}{:>8.3}{:>10.1}{:>8}{:>8}\
             {:>10}{:>9}",
            self.faces,
            self.states,
            random / self.faces.sqrt(),
            coherent / self.faces.sqrt(),
            coherent / self.faces,
            self.durr_hoyer,
            self.missed[0],
            self.missed[1],
            self.toffoli,
            self.qubits,
        );
    }
}

fn header() {
    println!(
        "{:>6}{:>7}{:>10}{:>10}{:>18}{:>8}{:>10}{:>16}{:>10}{:>9}",
        "P",
        "N",
        "random",
        "coherent",
        "over sqrt(P)",
        "over P",
        "D & H",
        "missed",
        "Toffolis",
        "qubits"
    );
}

fn parsed(text: &str) -> ValidScene {
    front::parse(text, "scene.yaml", &[], "".as_ref())
        .unwrap()
        .valid
}

/// Returns a scene of rectangles along the axes, all facing an orthographic camera that looks along -z.
fn rectangles(count: u32) -> String {
    let mut text = String::from(
        "name: rectangles\n\
         camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }\n\
         film: { width: 16, height: 16 }\n\
         materials: { grey: { lambertian: { albedo: [0.7, 0.6, 0.5] } } }\n\
         geometry:\n",
    );
    let mut draw = chance(7);
    for _ in 0..count {
        let [x, y, z] = [0.8 * draw(), 0.8 * draw(), 0.9 * draw()];
        let [width, height] = [0.2 + 0.1 * draw(), 0.2 + 0.1 * draw()];
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[s, t]| {
            let (x, y) = (x + s * width, y + t * height);
            format!("[{x:.5}, {y:.5}, {z:.5}]")
        });
        let corners = corners.join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  - quad: {{ vertices: [{corners}], material: grey }}"
        );
    }
    text.push_str("sampling: { path_bits: 8, depths: [{ bits: [8, 8] }] }\n");
    text
}
