//! Measures the throughput of the fixed machine, and of the gates machine on the same scenes.
//!
//! `cargo bench --bench machines -- fixed` prints, scene by scene, the operations of a path of all
//! three channels and the gates of its circuit; paths a second of the fixed machine on one core and
//! on all, and the nanoseconds that an operation takes a path; paths a second of the gates machine
//! (compute, read, uncompute, check every qubit; the flips are tested once a scene, not path by
//! path, and are left out); and the ratio of the fixed machine's throughput to that on one core.
//! Meshes have few triangles.
//!
//! It fails where a promise is broken: on the Cornell box the fixed machine is at least five times
//! as fast as the gates machine. The part `gates` and the bench `tracing` measure throughput by
//! itself.

use crate::common::scenes::CIRCUITS;
use crate::common::{Arguments, Promises, load, mesh};
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::machines::{GatesMachine, PixelLanes};
use qrt::runtime::path_machines::{OracleCircuits, OracleMachine};
use qrt::scene::valid::ValidScene;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Number of runs, each of a few milliseconds, of which the best counts: noise only ever slows, and time
/// in which another process runs must not count.
const RUNS: usize = 40;

/// Promised ratio of the throughput to the gates machine's.
const BAR: f64 = 5.0;

/// Positions of the pixels, in a film of 32 columns.
const PIXELS: [[u32; 2]; 4] = [[9, 17], [16, 8], [12, 25], [22, 22]];

const SETS: [&str; 3] = ["film.width=32", "film.height=32", "sampling.path_bits=12"];

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    println!("million paths a second, all three channels; best of {RUNS} runs");
    println!(
        "                      ops   gates   fixed: one  {cores:2} threads  ns an op | gates: one   ratio"
    );
    let sets = SETS.map(String::from);
    let scenes = CIRCUITS.iter().map(|name| {
        let scene = load::load(root, &format!("scenes-yaml/{name}.yaml"), &sets);
        (*name, scene)
    });
    let knot = mesh::mesh(root, mesh::CLOSE, [3, 6], 12);
    let mut of_box = 0.0;
    for (name, scene) in scenes.chain([("knot of 36", knot)]) {
        let ratio = compared(name, &scene, cores);
        if name == "cornell-box" {
            of_box = ratio;
        }
    }
    println!();
    let what = format!("box: fixed {of_box:.1} times as fast as gates, at least {BAR}");
    promises.judge(&what, of_box >= BAR);
}

/// Prints the throughput of both machines on a scene; returns the ratio of the fixed one to the gates.
fn compared(name: &str, scene: &ValidScene, cores: usize) -> f64 {
    let oracle =
        Oracle::rgb(scene, OracleOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    let oracle = Arc::new(oracle);
    let fixed = OracleMachine::fixed(oracle.clone(), 1, false);
    let parts = OracleCircuits::new(&oracle);
    let machine =
        GatesMachine::new(&[&parts.compute, &parts.uncompute]).expect("gates of its own qubits");
    let ops = oracle.program.ops.len();
    let (mut one, mut all, mut gates) = (0.0_f64, 0.0_f64, 0.0_f64);
    // The machines take turns, so that noise slows all of them alike.
    for _ in 0..RUNS {
        one = one.max(fixed_speed(&fixed, 1));
        gates = gates.max(gates_speed(&oracle, &parts, &machine));
        all = all.max(fixed_speed(&fixed, cores));
    }
    println!(
        "  {name:16} {ops:7} {:8}    {:8.3}    {:8.3}  {:8.4} |   {:8.4}  {:6.1}",
        machine.len(0) + machine.len(1),
        one / 1e6,
        all / 1e6,
        1e9 / (one * ops as f64),
        gates / 1e6,
        one / gates,
    );
    one / gates
}

/// Returns paths a second of `threads` threads.
fn fixed_speed(machine: &OracleMachine, threads: usize) -> f64 {
    let started = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let finished = |found: qrt::runtime::path_machines::Finished<'_>| {
                    std::hint::black_box(found.good);
                };
                let traced = machine.trace(&PIXELS, 0..machine.paths(), finished);
                traced.expect("the fixed machine finds nothing");
            });
        }
    });
    let paths = threads as u64 * PIXELS.len() as u64 * machine.paths();
    paths as f64 / started.elapsed().as_secs_f64()
}

/// Returns paths a second of one thread.
fn gates_speed(oracle: &Oracle, parts: &OracleCircuits, machine: &GatesMachine) -> f64 {
    let outputs = &parts.compute.outputs;
    let (_, id) = outputs
        .iter()
        .find(|(register, _)| *register == oracle.id)
        .expect("the id stays");
    let counts: Vec<_> = oracle
        .channels
        .iter()
        .filter_map(|channel| match channel.count {
            qrt::circuit::Operand::Word(word) => outputs
                .iter()
                .find(|(register, _)| *register == word.register),
            qrt::circuit::Operand::Constant(_) => None,
        })
        .collect();
    let words = oracle.parameter_words(1, PIXELS[0]);
    let spans = [PixelLanes {
        lanes: machine.lanes(),
        parameters: &words,
    }];
    let ids: Vec<u64> = (0..machine.lanes() as u64).collect();
    let mut values = vec![0; machine.lanes()];
    let mut rows = machine.rows();
    let blocks = 2_000_000 / (machine.len(0) + machine.len(1)) + 1;
    let started = Instant::now();
    for _ in 0..blocks {
        rows.set(id, &ids);
        rows.set_parameters(&spans);
        machine.run(0, &mut rows);
        for (_, qubits) in &counts {
            rows.get(qubits, &mut values);
            std::hint::black_box(&mut values);
        }
        machine.run(1, &mut rows);
        assert_eq!(rows.dirty(id, machine.lanes()), None, "all is undone");
    }
    (blocks * machine.lanes()) as f64 / started.elapsed().as_secs_f64()
}
