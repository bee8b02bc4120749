//! Cost of a path tracer as a circuit, its growth, and the time of the compiler.
//!
//! `cargo bench --bench circuits -- oracle` prints, for the oracle of a channel O_f (compute,
//! compare, flip, uncompute) of the worst channel, each at the scene's own widths:
//!
//! * seconds from scene to program and from program to gates, for every example scene, the knot
//!   with fewer triangles;
//! * gates, qubits and Toffoli depth of the Cornell box, by strategy;
//! * the savings of each of the compiler's passes;
//! * Toffolis and qubits over the number of quads P, rays D, path bits log2 R, comparator bits
//!   log2 C and fraction bits w, each with the exponent of a power of it that fits best, and the
//!   fraction of the cost by which that misses (root mean square);
//! * Toffolis a face of convex bodies: a cube, an icosahedron and a hull of 80 faces;
//! * the front of the box: the strategies that no other beats in qubits and in Toffolis, each beside the
//!   cost under `keep` when every plane was tested for every ray; and the growth with P, D and w of the
//!   cheapest within 5,000 and within 2,000 qubits, and of the one with the fewest;
//! * the cost of sampled lamps: the box with them, relative to the box without.
//!
//! It fails where a promise is broken: bounds on the cost of the box, on the exponents of growth, on the
//! Toffolis of a face of a convex body, on the cost of sampled lamps, and on the time in which
//! `uncompute: auto` finds the cheapest strategy that fits, as a fraction of that of finding the front.

use crate::common::bodies::Solid;
use crate::common::growth::{fit, quads};
use crate::common::scenes::CIRCUITS;
use crate::common::{Arguments, Promises, bodies, load, mesh};
use qrt::circuit::lower::{self, Cost};
use qrt::core::compile::{Passes, Strategy};
use qrt::core::oracle::{Oracle, OracleOptions, Oracles, StrategyCost};
use qrt::lab::layouts;
use qrt::runtime::workers::Workers;
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use qrt::tracer::PixelClass;
use std::ops::RangeInclusive;
use std::path::Path;
use std::time::Instant;

/// Toffolis of the box's oracle under `uncompute: keep`: promised, and aimed at.
const TOFFOLIS: [u64; 2] = [85_000, 67_000];

/// Qubits of the box's oracle under `uncompute: scoped`: promised, and aimed at.
const QUBITS: [u64; 2] = [1_500, 500];

/// Number of qubits, and the most Toffolis that the box may take within it.
const WITHIN: [[u64; 2]; 3] = [[5_000, 200_000], [2_000, 500_000], [500, 5_000_000]];

/// Promised time of `auto` to find the cheapest that fits, as a fraction of that of finding all of the front.
const AUTO: f64 = 0.75;

/// Toffolis and qubits of the box under `keep` when every plane was tested for every ray.
const ALL_PLANES: [u64; 2] = [160_912, 87_280];

/// Promised ratio of the box's Toffolis with sampled lamps to those without.
const LIT: f64 = 1.9;

/// Convex bodies, and the Toffolis of each of their faces when every face was tested by its plane and
/// its edges: at most half may remain.
const BODIES: [(&str, Solid, u64); 3] = [
    ("cube", Solid::Cube, 12_253),
    ("icosahedron", Solid::Icosahedron, 10_833),
    ("hull of 80 faces", Solid::Hull, 10_554),
];

/// Range of an exponent that should be 1.
const LINEAR: RangeInclusive<f64> = 0.9..=1.1;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    seconds(root);
    let [keep, scoped] = strategies(root);
    passes(root);
    let rules = growth(root);
    let faces = faces(root);
    let (front, seconds) = pareto(root);
    let lit = lit(root);

    println!();
    for (what, is, [bar, aim]) in [
        ("Toffolis of the box, keep", keep, TOFFOLIS),
        ("qubits of the box, scoped", scoped, QUBITS),
    ] {
        promises.judge(
            &format!("{what}: {is}, at most {bar} (aim {aim})"),
            is <= bar,
        );
    }
    for [qubits, bar] in WITHIN {
        let toffoli = cheapest(&front, qubits).map_or(u64::MAX, |layout| layout.cost.toffoli);
        promises.judge(
            &format!("Toffolis of the box within {qubits} qubits: {toffoli}, at most {bar}"),
            toffoli <= bar,
        );
        let (auto, part) = auto(root, qubits);
        let part = part / seconds;
        promises.judge(
            &format!("auto finds that in {part:.2} of the front's time, at most {AUTO}"),
            auto.cost.toffoli == toffoli && part <= AUTO,
        );
    }
    promises.judge(
        &format!("the box with sampled lamps by the box without: {lit:.2}, at most {LIT}"),
        lit <= LIT,
    );
    for (what, rule) in rules {
        promises.judge(what, rule);
    }
    for ((what, _, before), toffoli) in BODIES.into_iter().zip(faces) {
        promises.judge(
            &format!("Toffolis a face of a {what}: {toffoli}, at most half of {before}"),
            2 * toffoli <= before,
        );
    }
}

/// Measured costs of an oracle.
struct Measured {
    cost: Cost,
    qubits: u64,
    depth: u64,
}

fn load(root: &Path, name: &str, sets: &[&str]) -> ValidScene {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    load::load(root, &format!("scenes-yaml/{name}.yaml"), &sets)
}

fn oracle(scene: &ValidScene, channel: usize, passes: Passes) -> Oracle {
    let options = OracleOptions {
        passes,
        ..OracleOptions::default()
    };
    Oracle::new(scene, channel, options).unwrap_or_else(|error| panic!("{error}"))
}

fn cost(oracle: &Oracle) -> Cost {
    lower::tally(&oracle.whole(0)).into_iter().sum()
}

/// Returns the oracle of the channel with the most Toffolis.
fn worst(scene: &ValidScene, passes: Passes) -> (Oracle, Cost) {
    let all = (0..3).map(|channel| {
        let oracle = oracle(scene, channel, passes);
        let cost = cost(&oracle);
        (oracle, cost)
    });
    all.max_by_key(|(_, cost)| cost.toffoli)
        .expect("there are three channels")
}

fn measured((oracle, cost): &(Oracle, Cost)) -> Measured {
    let circuit = lower::circuit(&oracle.whole(0));
    Measured {
        cost: *cost,
        qubits: u64::from(circuit.qubits),
        depth: lower::depth(&circuit),
    }
}

/// Prints the times of the compiler.
fn seconds(root: &Path) {
    println!("seconds: scene to program | program to gates; what comes of it; the first channel");
    let knot = mesh::mesh(root, mesh::CLOSE, [3, 6], 12);
    let scenes = CIRCUITS.iter().map(|name| (*name, load(root, name, &[])));
    for (name, scene) in scenes.chain([("knot of 36", knot)]) {
        let started = Instant::now();
        let oracle = oracle(&scene, 0, Passes::ALL);
        let built = started.elapsed().as_secs_f64();
        let circuit = lower::circuit(&oracle.whole(0));
        let lowered = started.elapsed().as_secs_f64() - built;
        println!(
            "  {name:16} {built:7.3} | {lowered:7.3}   {:6} operations {:9} gates",
            oracle.program.ops.len(),
            circuit.gates.len(),
        );
    }
}

/// Prints the costs of the box; returns its Toffolis under `keep` and its qubits under `scoped`.
fn strategies(root: &Path) -> [u64; 2] {
    let width = oracle(&load(root, "cornell-box", &[]), 0, Passes::ALL).fraction;
    println!(
        "\nCornell box, D = 3, 16 quads, w = {width}, R = 2^14, C = 2^12: one O_f, worst channel"
    );
    println!(
        "                   Toffoli  measured ANDs     CNOT        X  qubits    depth  Toffoli x qubits"
    );
    let mut bars = [0; 2];
    for uncompute in ["keep", "scoped"] {
        for nearest in ["running", "paper"] {
            let sets = [
                format!("circuit.uncompute={uncompute}"),
                format!("circuit.nearest={nearest}"),
            ];
            let scene = load(root, "cornell-box", &[&sets[0], &sets[1]]);
            let Measured {
                cost,
                qubits,
                depth,
            } = measured(&worst(&scene, Passes::ALL));
            println!(
                "  {uncompute:6} {nearest:7} {:9}      {:9} {:8} {:8}  {qubits:6} {depth:8}          {:8.2e}",
                cost.toffoli,
                cost.and_measured,
                cost.cnot,
                cost.x,
                (cost.toffoli * qubits) as f64,
            );
            match (uncompute, nearest) {
                ("keep", "running") => bars[0] = cost.toffoli,
                ("scoped", "running") => bars[1] = qubits,
                _ => {}
            }
        }
    }
    bars
}

/// Prints the cost of the box with more and more passes.
fn passes(root: &Path) {
    println!("\nCornell box, pass by pass: Toffolis, and of those before");
    let scene = load(root, "cornell-box", &[]);
    let mut passes = Passes::NONE;
    let mut before = None;
    for name in ["none", "share", "tabulate", "needed", "merge", "multiples"] {
        match name {
            "share" => passes.share = true,
            "tabulate" => passes.tabulate = true,
            "needed" => passes.needed = true,
            "merge" => passes.merge = true,
            "multiples" => passes.multiples = true,
            _ => {}
        }
        let (_, Cost { toffoli, .. }) = worst(&scene, passes);
        let share = before.map_or(100.0, |before| 100.0 * toffoli as f64 / before as f64);
        println!("  + {name:9} {toffoli:9}  {share:6.1} %");
        before = Some(toffoli);
    }
}

/// Prints the growth of the cost, and returns the promises about it, each with whether it holds.
fn growth(root: &Path) -> [(&'static str, bool); 4] {
    let set = |key: &str, value: u32| load(root, "cornell-box", &[&format!("{key}={value}")]);
    let grown = |what: &str, sizes: &[u32], scene: &dyn Fn(u32) -> ValidScene| {
        grown(what, sizes, Strategy::KEEP, scene)
    };
    println!("\nhow one O_f grows (first channel, keep)");
    let sizes = [4, 8, 16, 32, 64, 128];
    let generated = |count| generated(root, count);
    let faces = grown("quads P, D = 3", &sizes, &generated).fitted(4..=128);
    let sizes = [1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24];
    let depths = grown("rays D, of the box", &sizes, &|depth| rays(root, depth));
    // The first ray is the cheapest: a straight line, but not through zero. After many rays, the light
    // that another can add rounds to zero, and the compiler drops it.
    depths.fitted(2..=8);
    let depths = depths.fitted(8..=24);
    let sizes = [4, 8, 12, 16, 20, 24];
    let paths = grown("path bits log2 R, of the box", &sizes, &|bits| {
        set("sampling.path_bits", bits)
    });
    let paths = paths.fitted(4..=24);
    let sizes = [2, 4, 8, 12, 16, 20, 24];
    let thresholds = grown("comparator bits log2 C, of the box", &sizes, &|bits| {
        set("comparator.bits", bits)
    });
    let thresholds = thresholds.fitted(2..=24);
    let sizes = [6, 10, 14, 16, 18, 22, 26, 30];
    let fractions = grown("fraction bits w, of the box", &sizes, &|bits| {
        set("precision.fraction", bits)
    });
    fractions.fitted(6..=30);
    [
        (
            "Toffolis over quads: exponent in 0.9..1.1",
            LINEAR.contains(&faces),
        ),
        (
            "Toffolis over rays, from 8 on: exponent in 0.9..1.1",
            LINEAR.contains(&depths),
        ),
        ("Toffolis over path bits: exponent at most 1", paths <= 1.0),
        (
            "Toffolis over comparator bits: exponent at most 1",
            thresholds <= 1.0,
        ),
    ]
}

/// Prints the costs of convex bodies; returns the Toffolis a face of each.
fn faces(root: &Path) -> [u64; 3] {
    let toffoli = |solid: Option<Solid>| {
        let parsed = front::parse(&bodies::scene(solid), "body.yaml", &[], root);
        let scene = parsed.unwrap_or_else(|report| panic!("{report}")).valid;
        cost(&oracle(&scene, 0, Passes::ALL)).toffoli
    };
    println!("\nconvex bodies above a floor (first channel, keep): Toffolis, and a face");
    let alone = toffoli(None);
    println!("  none             {alone:9}");
    BODIES.map(|(what, solid, before)| {
        let all = toffoli(Some(solid));
        let face = (all - alone) / solid.count() as u64;
        println!("  {what:16} {all:9}  {face:6}  ({before} by planes and edges)");
        face
    })
}

/// Returns a scene of `count` quads.
fn generated(root: &Path, count: u32) -> ValidScene {
    let parsed = front::parse(&quads(count), "quads.yaml", &[], root);
    parsed.unwrap_or_else(|report| panic!("{report}")).valid
}

/// Returns the box, with paths of `depth` rays.
fn rays(root: &Path, depth: u32) -> ValidScene {
    let depths = vec!["{ bits: [10, 10] }"; depth as usize].join(", ");
    load(
        root,
        "cornell-box",
        &[&format!("sampling.depths=[{depths}]")],
    )
}

/// Returns the layout that `auto` finds for the box within `qubits` qubits, and the seconds of the search.
fn auto(root: &Path, qubits: u64) -> (StrategyCost, f64) {
    let scene = load(root, "cornell-box", &[]);
    let started = Instant::now();
    let oracles = Oracles::new(&scene);
    let all = oracles.layouts(oracles.name(0, PixelClass::default()));
    let strategy = all.cheapest(qubits);
    let seconds = started.elapsed().as_secs_f64();
    let layout = strategy.and_then(|strategy| all.under(strategy));
    (layout.unwrap_or_else(|error| panic!("{error}")), seconds)
}

/// Prints the front of the box, and the growth of some of its strategies; returns it with the seconds taken.
fn pareto(root: &Path) -> (Vec<StrategyCost>, f64) {
    let scene = load(root, "cornell-box", &[]);
    let started = Instant::now();
    let oracles = Oracles::new(&scene);
    let all = oracles.layouts(oracles.name(0, PixelClass::default()));
    let front = layouts::front(&all, &Workers::default());
    let front = front.unwrap_or_else(|error| panic!("{error}"));
    let seconds = started.elapsed().as_secs_f64();
    let [toffoli, qubits] = ALL_PLANES;
    println!(
        "\nfront of the box (first channel), in {seconds:.1} s; by {toffoli} Toffolis on {qubits} qubits"
    );
    for layout in &front {
        println!(
            "  {:6} qubits {:9} Toffoli {:9} measured ANDs  {:6.3} and {:6.3} times  {}",
            layout.cost.qubits,
            layout.cost.toffoli,
            layout.and_measured,
            layout.cost.qubits as f64 / qubits as f64,
            layout.cost.toffoli as f64 / toffoli as f64,
            layout.strategy,
        );
    }
    let fewest = front.iter().min_by_key(|layout| layout.cost.qubits);
    let [most, some, _] = WITHIN.map(|[qubits, _]| cheapest(&front, qubits));
    for layout in [most, some, fewest].into_iter().flatten() {
        let strategy = layout.strategy;
        println!("\nhow that grows which undoes: {strategy}");
        grown("quads P, D = 3", &[4, 16, 64], strategy, &|count| {
            generated(root, count)
        })
        .fitted(4..=64);
        grown("rays D, of the box", &[2, 4, 8], strategy, &|depth| {
            rays(root, depth)
        })
        .fitted(2..=8);
        grown(
            "fraction bits w, of the box",
            &[10, 16, 24],
            strategy,
            &|bits| {
                load(
                    root,
                    "cornell-box",
                    &[&format!("precision.fraction={bits}")],
                )
            },
        )
        .fitted(10..=24);
    }
    (front, seconds)
}

/// Returns the cheapest layout within `qubits` qubits.
fn cheapest(front: &[StrategyCost], qubits: u64) -> Option<&StrategyCost> {
    let within = front.iter().filter(|layout| layout.cost.qubits <= qubits);
    within.min_by_key(|layout| layout.cost.toffoli)
}

/// Returns the ratio of the box's Toffolis with sampled lamps to those without, with the same bits.
fn lit(root: &Path) -> f64 {
    let light = "{ bits: [10, 10], light: [8, 8] }";
    let depths = format!("sampling.depths=[{{ bits: [10, 10] }}, {light}, {light}]");
    let toffoli = |sets: &[&str]| {
        let (_, cost) = worst(&load(root, "cornell-box", sets), Passes::ALL);
        cost.toffoli
    };
    let [with, without] = [toffoli(&[&depths, "sampling.lights=auto"]), toffoli(&[])];
    println!("\nthe box with sampled lamps: {with} Toffolis, without: {without}");
    with as f64 / without as f64
}

/// Costs of a family of scenes: size, Toffolis and qubits.
struct Grown(Vec<[f64; 3]>);

/// Measures and prints the costs of a family of scenes.
fn grown(
    what: &str,
    sizes: &[u32],
    strategy: Strategy,
    scene: &dyn Fn(u32) -> ValidScene,
) -> Grown {
    println!("  {what}");
    let costs = sizes.iter().map(|&size| {
        let scene = scene(size);
        let oracles = Oracles::new(&scene);
        let layout = oracles
            .layouts(oracles.name(0, PixelClass::default()))
            .under(strategy);
        let cost = layout.unwrap_or_else(|error| panic!("{error}")).cost;
        let (toffoli, qubits) = (cost.toffoli, cost.qubits);
        println!("    {size:4}  {toffoli:9} Toffoli  {qubits:7} qubits");
        [f64::from(size), toffoli as f64, qubits as f64]
    });
    Grown(costs.collect())
}

impl Grown {
    /// Fits powers to the costs of the sizes in `sizes` and prints them; returns the Toffolis' exponent.
    fn fitted(&self, sizes: RangeInclusive<u32>) -> f64 {
        let within = |cost: &&[f64; 3]| sizes.contains(&(cost[0] as u32));
        let [toffolis, qubits] = [1, 2].map(|i| {
            let costs = self.0.iter().filter(within);
            fit(costs.map(|cost| [cost[0], cost[i]]))
        });
        println!(
            "    {:2}..{:<3} exponents {:.3} (residual {:.1} %) and {:.3} ({:.1} %)",
            sizes.start(),
            sizes.end(),
            toffolis.slope,
            100.0 * toffolis.residual,
            qubits.slope,
            100.0 * qubits.residual,
        );
        toffolis.slope
    }
}
