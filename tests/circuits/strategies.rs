//! Tests that a circuit computes the same and returns every qubit under every strategy, and that
//! `uncompute: auto` finds the cheapest that fits.

use super::paths::{CORNER, film, paths};
use crate::common::command::Folder;
use crate::common::scene::{from_file, written};
use qrt::circuit::{Gate, lower};
use qrt::core::compile::Strategy;
use qrt::core::oracle::{CallCost, Oracle, OracleOptions, Oracles, StrategyCost, call_cost};
use qrt::runtime::path_machines::OracleMachine;
use qrt::scene::valid::ValidScene;
use qrt::tracer::PixelClass;
use std::collections::HashSet;
use std::sync::Arc;

/// Checks that all paths of all pixels by gates, which refuse a circuit that leaves garbage, are the
/// same as under `keep`.
fn agree(scene: &ValidScene, strategies: &[Strategy]) {
    let under = |strategy| {
        let options = OracleOptions {
            strategy: Some(strategy),
            ..OracleOptions::default()
        };
        Arc::new(Oracle::rgb(scene, options).unwrap())
    };
    let keep = under(Strategy::KEEP);
    let pixels = film(&keep);
    let expected = paths(&OracleMachine::fixed(keep, 3, true), &pixels).unwrap();
    for &strategy in strategies {
        let oracle = under(strategy);
        let fixed = paths(&OracleMachine::fixed(oracle.clone(), 3, true), &pixels).unwrap();
        assert!(fixed == expected, "{strategy} changes a path");
        let gates = OracleMachine::gates(oracle, 3, true);
        let gates = gates.unwrap_or_else(|defect| panic!("{strategy}: {defect}"));
        let traced = paths(&gates, &pixels);
        let traced = traced.unwrap_or_else(|defect| panic!("{strategy}: {defect}"));
        assert!(traced == fixed, "{strategy}: the models differ");
    }
}

#[test]
fn every_strategy_computes_the_same() {
    let all = Strategy::all();
    assert_eq!(all.len(), 641);
    // The last one pebbles.
    let some: Vec<Strategy> = all.into_iter().rev().step_by(7).collect();
    agree(&written(CORNER, &[]), &some);
}

/// In these scenes the oracles of all pixels, and of one alone, have few enough operations for an exact answer. The
/// former load the pixel's position, and add to it in place.
#[test]
fn pebbled_circuits_have_the_fewest_qubits_of_all() {
    for (name, fewest) in [
        ("edge", [16, 15]),
        ("lit-wall", [25, 11]),
        ("mirror", [21, 15]),
        ("slanted", [18, 18]),
    ] {
        let scene = from_file(&format!("scenes-yaml/small/{name}.yaml"), &[]);
        assert_eq!(
            OracleOptions::default().strategy(&scene),
            Ok(Strategy::PEBBLED)
        );
        agree(&scene, &[Strategy::PEBBLED]);
        let oracles = Oracles::new(&scene);
        let class = oracles.classes().class([1, 0]);
        let (film, pixel) = (oracles.name(0, class), oracles.of_pixel([1, 0]));
        let both = [oracles.layouts(film), pixel.layouts(pixel.name(0, class))];
        for (layouts, fewest) in both.iter().zip(fewest) {
            let qubits = |strategy| layouts.call(strategy).unwrap().qubits;
            let all = Strategy::all().into_iter().map(qubits).min();
            assert_eq!(
                (all, qubits(Strategy::PEBBLED)),
                (Some(fewest), fewest),
                "{name}"
            );
            let auto = layouts.cheapest(1).unwrap();
            assert_eq!(qubits(auto), fewest, "{name}: {auto}");
        }
    }
}

#[test]
fn so_do_those_of_auto_in_an_example_scene() {
    let small = [
        "film={ width: 3, height: 2 }",
        "sampling.path_bits=5",
        "precision.fraction=9",
        "comparator.bits=5",
    ];
    let scene = from_file("scenes-yaml/lit-box.yaml", &small);
    let oracles = Oracles::new(&scene);
    let all = oracles.layouts(oracles.name(0, PixelClass::default()));
    let keep = all.under(Strategy::KEEP).unwrap().cost.qubits;
    let strategies = (1..7).map(|half| all.cheapest(keep >> half).unwrap());
    let strategies: Vec<Strategy> = strategies.collect();
    assert_eq!(strategies.iter().collect::<HashSet<_>>().len(), 6);
    agree(&scene, &strategies);
}

/// Returns the scene with paths of one ray.
fn one_ray(scene: &ValidScene) -> ValidScene {
    let mut parameters = scene.parameters();
    parameters.sampling.depths.truncate(1);
    scene.with_parameters(parameters).unwrap()
}

#[test]
fn auto_is_the_cheapest_that_fits() {
    let scene = written(CORNER, &[]);
    let oracles = Oracles::new(&scene);
    let (name, keep) = StrategyCost::of_most_expensive(&oracles, Strategy::KEEP).unwrap();
    let channel = name.channel;
    let all = oracles.layouts(oracles.name(channel, PixelClass::default()));
    let calls = Strategy::all()
        .into_iter()
        .map(|strategy| (all.call(strategy).unwrap(), strategy));
    let front = CallCost::front(calls.collect());
    assert_eq!(front[0], (keep.cost, keep.strategy));
    assert!(front.len() > 20);
    for place in (1..front.len()).step_by(3) {
        // The qubits that it needs, and one fewer than the next cheaper strategy needs.
        for qubits in [front[place].0.qubits, front[place - 1].0.qubits - 1] {
            let budget = format!("budget.qubits={qubits}");
            let scene = written(CORNER, &["circuit.uncompute=auto", &budget]);
            let oracle = Oracle::new(&scene, channel, OracleOptions::default()).unwrap();
            assert_eq!(call_cost(&[oracle]), front[place].0, "{budget}");
        }
    }
    // If no strategy fits, the error names the least number of qubits.
    let scene = written(CORNER, &["circuit.uncompute=auto", "budget.qubits=1"]);
    let oracle = Oracle::new(&scene, channel, OracleOptions::default()).unwrap();
    assert_eq!(call_cost(&[oracle]).qubits, front.last().unwrap().0.qubits);
    // The cached strategy of a scene is not used for the scene with other parameters.
    let written_for = |qubits: u64| {
        let budget = format!("budget.qubits={qubits}");
        written(CORNER, &["circuit.uncompute=auto", &budget])
    };
    let short = one_ray(&written(CORNER, &[]));
    let (_, keep) = StrategyCost::of_most_expensive(&Oracles::new(&short), Strategy::KEEP).unwrap();
    let scene = written_for(keep.cost.qubits);
    let strategy = |scene: &ValidScene| OracleOptions::default().strategy(scene).unwrap();
    let found = strategy(&scene);
    assert!(found != Strategy::KEEP && found == strategy(&scene));
    assert_eq!(strategy(&one_ray(&scene)), Strategy::KEEP);
    assert_eq!(strategy(&scene.clone()), found);
    // Without a budget, nothing is uncomputed early.
    let scene = written(CORNER, &["circuit.uncompute=auto"]);
    assert_eq!(
        OracleOptions::default().strategy(&scene),
        Ok(Strategy::KEEP)
    );
}

/// Two rays, of which the second rises by a constant and leans by a table: whether a plane is ahead of the ray,
/// and at which distance, are tables. It took 302 Toffolis on 255 qubits when both were divisions.
#[test]
fn distances_of_tabulated_directions_are_tables() {
    let text = "
name: tiny
camera: { orthographic: { eye: [0, 0, 0.9], target: [0, 0, 0], up: [0, 1, 0], height: 1 } }
film: { width: 1, height: 1 }
materials:
  wall: { lambertian: { albedo: [0.5, 0.5, 0.5] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: wall }
  - quad: { vertices: [[0, -1, 1], [0, 1, 1], [1, 1, 1], [1, -1, 1]], material: lamp }
sampling: { path_bits: 4, depths: [{ bits: [2, 2] }, { bits: [2, 2] }], lights: none }
precision: { fraction: 4 }
comparator: { bits: 1 }
";
    for (sets, most) in [
        (&[][..], [100, 120]),
        (
            &["sampling.depths=[{ bits: [0, 0] }, { bits: [2, 2] }]"],
            [68, 80],
        ),
    ] {
        let scene = written(text, sets);
        let costs = [0, 1, 2].map(|channel| {
            let oracle = Oracle::new(&scene, channel, OracleOptions::default()).unwrap();
            call_cost(&[oracle])
        });
        for cost in costs {
            assert!(
                cost.toffoli <= most[0] && cost.qubits <= most[1],
                "{cost:?}"
            );
        }
        agree(&scene, &[Strategy::KEEP, Strategy::SCOPED]);
    }
}

/// The rows of the front of the box that the book shows: qubits, and the fewest Toffolis within them.
#[test]
fn the_front_of_the_box_is_that_of_the_book() {
    let scene = from_file("scenes-yaml/cornell-box.yaml", &[]);
    let oracles = Oracles::new(&scene);
    let all = oracles.layouts(oracles.most_expensive().unwrap().name);
    for (qubits, toffoli) in [
        (39_010, 69_124),
        (19_510, 107_118),
        (9_302, 130_324),
        (4_929, 183_100),
        (2_425, 290_084),
        (1_685, 365_460),
        (1_022, 804_804),
        (810, 1_236_556),
        (527, 2_068_150),
        (492, 2_630_696),
    ] {
        let cost = all.under(all.cheapest(qubits).unwrap()).unwrap().cost;
        assert_eq!((cost.qubits, cost.toffoli), (qubits, toffoli));
    }
}

/// Runs the box as it is, on fewer qubits than the rays and hits of a path alone had under `keep`: two
/// pixels, all of their paths.
#[test]
fn the_box_fits_into_five_hundred_qubits() {
    let sets = ["circuit.uncompute=auto", "budget.qubits=500"];
    let scene = from_file("scenes-yaml/cornell-box.yaml", &sets);
    let under = |strategy| {
        let options = OracleOptions {
            strategy,
            ..OracleOptions::default()
        };
        Arc::new(Oracle::new(&scene, 0, options).unwrap())
    };
    let pixels = [[32, 4], [20, 50]];
    let keep = OracleMachine::fixed(under(Some(Strategy::KEEP)), 3, false);
    let expected = paths(&keep, &pixels).unwrap();
    let oracle = under(None);
    let circuit = lower::circuit(&oracle.whole(0));
    let toffolis = circuit.gates.iter();
    let toffolis = toffolis
        .filter(|gate| matches!(gate, Gate::Ccx(..)))
        .count() as u64;
    let emitted = [circuit.qubits.into(), toffolis];
    assert!(emitted[0] <= 500 && toffolis <= 3_000_000, "{emitted:?}");
    let cost = call_cost(&[Oracle::clone(&oracle)]);
    assert_eq!(emitted, [cost.qubits, cost.toffoli]);
    let gates = OracleMachine::gates(oracle, 3, false).unwrap();
    let traced = paths(&gates, &pixels).unwrap();
    assert!(traced == expected && expected.good[0].iter().any(|good| *good > 0));
}

#[test]
fn the_command_lists_the_front_and_tells_the_least() {
    let folder = Folder::new();
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/scenes-yaml/floor-and-light.yaml"
    );
    let front = folder.works(&["inspect", file, "--pareto", "--json"]);
    let front: serde_json::Value = serde_json::from_str(&front).unwrap();
    let front = front["front"].as_array().unwrap();
    let qubits = |place: usize| front[place]["qubits"].as_u64().unwrap();
    assert!(front.len() > 5 && qubits(0) > 2 * qubits(front.len() - 1));
    // Ghosts save only where something is uncomputed early, and never more than that costs.
    let ands = |line: &serde_json::Value, key: &str| line[key].as_u64().unwrap();
    let keep = ands(&front[0], "and_measured");
    assert_eq!(ands(&front[0], "estimated_and_with_ghosts"), keep);
    let mut fewer = 0;
    for line in front {
        let ghosts = ands(line, "estimated_and_with_ghosts");
        let measured = ands(line, "and_measured");
        assert!((keep..=measured).contains(&ghosts), "{line}");
        fewer += usize::from(ghosts < measured);
    }
    assert!(3 * fewer > front.len(), "{fewer} of {}", front.len());
    // The command prints the chosen strategy.
    let budget = format!("budget.qubits={}", qubits(3));
    let sets = ["--set", "circuit.uncompute=auto", "--set", &budget];
    let told = folder.works(&[&["inspect", file][..], &sets].concat());
    let chosen = front[3]["strategy"].as_str().unwrap();
    assert!(
        told.contains(&format!("uncompute auto ({chosen}), nearest")),
        "{told}"
    );
    let least = qubits(front.len() - 1);
    let auto = [
        "--set",
        "circuit.uncompute=auto",
        "--set",
        "budget.qubits=30",
    ];
    let said = folder.fails(2, &[&["inspect", file][..], &auto].concat());
    let told = said.contains("QRT0601") && said.contains("no way to lay it out needs fewer");
    assert!(told, "{said}");
    let number = said
        .split(" qubits, ")
        .next()
        .and_then(|text| text.rsplit(' ').next());
    let number: u64 = number.unwrap().replace(',', "").parse().unwrap();
    assert_eq!(number, least);
}
