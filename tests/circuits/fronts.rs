//! Promises of `uncompute: auto` and of fronts, for random scenes: each circuit, gate by gate, gives the counts of
//! `keep` on integers, returns every qubit, and has the qubits and Toffolis of its cost.

use super::paths::{film, paths};
use super::random_scenes;
use crate::common::numbers::Numbers;
use crate::common::scene::from_file;
use qrt::circuit::{Gate, lower};
use qrt::core::compile::Strategy;
use qrt::core::oracle::{CallCost, Oracle, OracleOptions, Oracles, StrategyCost};
use qrt::lab::layouts;
use qrt::runtime::path_machines::OracleMachine;
use qrt::runtime::workers::Workers;
use qrt::scene::front::parse;
use qrt::scene::valid::ValidScene;
use qrt::tracer::PixelClass;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const SEED: u64 = 7;

/// Runs all paths of all pixels under each of `layouts` of channel `channel`. `name` identifies the scene in
/// messages.
fn check(scene: &ValidScene, channel: usize, layouts: &[StrategyCost], name: &str) {
    let under = |strategy| {
        let options = OracleOptions {
            strategy: Some(strategy),
            ..OracleOptions::default()
        };
        Arc::new(Oracle::new(scene, channel, options).unwrap())
    };
    let keep = under(Strategy::KEEP);
    let pixels = film(&keep);
    let expected = paths(&OracleMachine::fixed(keep, SEED, false), &pixels).unwrap();
    for layout in layouts {
        let strategy = layout.strategy;
        let oracle = under(strategy);
        let circuit = lower::circuit(&oracle.whole(0));
        let toffolis = circuit.gates.iter();
        let toffolis = toffolis.filter(|gate| matches!(gate, Gate::Ccx(..)));
        let emitted = CallCost {
            qubits: circuit.qubits.into(),
            toffoli: toffolis.count() as u64,
        };
        assert_eq!(emitted, layout.cost, "{strategy}: {name}");
        // The machine refuses a circuit that leaves garbage.
        let gates = OracleMachine::gates(oracle, SEED, false);
        let gates = gates.unwrap_or_else(|defect| panic!("{strategy}: {defect}: {name}"));
        let traced = paths(&gates, &pixels);
        let traced = traced.unwrap_or_else(|defect| panic!("{strategy}: {defect}: {name}"));
        assert!(traced == expected, "{strategy} counts otherwise: {name}");
    }
}

/// Returns the strategies that no other beats; checks that `auto` finds every seventh of them.
fn front(scene: &ValidScene, channel: usize) -> Vec<StrategyCost> {
    let workers = Workers {
        threads: NonZeroUsize::new(1),
        ..Workers::default()
    };
    let oracles = Oracles::new(scene);
    let all = oracles.layouts(oracles.name(channel, PixelClass::default()));
    let front = layouts::front(&all, &workers).unwrap();
    for layout in front.iter().step_by(7) {
        let auto = all.cheapest(layout.cost.qubits).unwrap();
        let cost = all.under(auto).unwrap().cost;
        assert_eq!(cost, layout.cost, "{auto} for {}", layout.strategy);
    }
    front
}

/// Checks the layouts of up to `scenes` random scenes, skipping invalid ones, on one thread per core.
fn random(scenes: usize, seed: u64, layouts: fn(&ValidScene, usize) -> Vec<StrategyCost>) {
    let next = AtomicUsize::new(0);
    let checked = AtomicUsize::new(0);
    let circuits = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while checked.load(Ordering::Relaxed) < scenes {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let text = random_scenes::scene(&mut Numbers(seed + number as u64));
                    // Some scenes have surfaces without area: an error, and no panic.
                    let Ok(loaded) = parse(&text, "random.yaml", &[], "".as_ref()) else {
                        continue;
                    };
                    let layouts = layouts(&loaded.valid, number % 3);
                    check(&loaded.valid, number % 3, &layouts, &text);
                    circuits.fetch_add(layouts.len(), Ordering::Relaxed);
                    checked.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
    });
    let (checked, circuits) = (checked.into_inner(), circuits.into_inner());
    println!("{checked} scenes, {circuits} circuits");
    assert!(circuits > 5 * checked, "fronts are longer");
}

#[test]
fn some_on_the_front_of_a_random_scene_count_the_same() {
    random(1, 0, |scene, channel| {
        front(scene, channel).into_iter().step_by(9).collect()
    });
}

#[test]
#[ignore = "takes half a minute"]
fn all_on_the_fronts_of_random_scenes_count_the_same() {
    random(3, 0, front);
}

#[test]
#[ignore = "takes a quarter of an hour on two cores"]
fn all_on_the_fronts_of_two_hundred_random_scenes_count_the_same() {
    random(200, 1_000_000, front);
}

#[test]
#[ignore = "takes a few minutes"]
fn so_do_all_on_the_fronts_of_three_example_scenes() {
    let small = [
        "film={ width: 3, height: 2 }",
        "sampling.path_bits=5",
        "precision.fraction=9",
        "comparator.bits=5",
    ];
    for file in ["cornell-box", "lit-box", "cornell-mirror"] {
        let scene = from_file(&format!("scenes-yaml/{file}.yaml"), &small);
        let layouts = front(&scene, 0);
        check(&scene, 0, &layouts, file);
        println!("{file}: {} circuits", layouts.len());
    }
}
