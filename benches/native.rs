//! Measures the throughput of the code that `qrt!` compiles, beside the fixed machine, which
//! executes the same program step by step.
//!
//! `cargo bench --bench native` prints, for every instruction set of this processor and scene by
//! scene, paths a second of one core by each, and their ratio. Both compute all three channels of
//! every path, and the same bits.
//!
//! It fails where a promise is broken: on the Cornell box, with AVX-512 and with AVX2, the code is
//! at least 1.5 times as fast as the interpreted program.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "common/promises.rs"]
mod promises;

use promises::Promises;
use qrt::machines::InstructionSet;
use qrt::prelude::*;
use qrt::runtime::path_machines::{Finished, NativeOracle, OracleMachine};
use std::process::ExitCode;
use std::time::Instant;

qrt! {
    scene Furnace from "scenes-yaml/furnace.yaml"
    scene Floor from "scenes-yaml/floor-and-light.yaml"
    scene CornellBox from "scenes-yaml/cornell-box.yaml"
    scene Mirror from "scenes-yaml/cornell-mirror.yaml"
}

/// Number of runs of which the best counts. The machines take turns, so that noise slows both alike.
const RUNS: usize = 40;

/// Promised ratio to the interpreted program. It is 2 on a quiet machine; the rest is allowance for other
/// processes.
const BAR: f64 = 1.5;

const PIXELS: [[u32; 2]; 4] = [[19, 37], [32, 16], [25, 50], [44, 44]];

fn main() -> ExitCode {
    println!("million paths a second of one core, all three channels; best of {RUNS} runs");
    let mut promises = Promises::new();
    for set in InstructionSet::available() {
        println!(
            "\n{:17}     ops     fixed    native   ratio",
            format!("{set:?}")
        );
        compared::<Furnace>(set, "furnace");
        compared::<Floor>(set, "floor-and-light");
        let of_box = compared::<CornellBox>(set, "cornell-box");
        compared::<Mirror>(set, "cornell-mirror");
        if matches!(set, InstructionSet::Avx512 | InstructionSet::Avx2) {
            let what = format!(
                "box: the code {of_box:.2} times as fast as the interpreted program, at least {BAR}"
            );
            promises.judge(&what, of_box >= BAR);
        }
    }
    promises.exit()
}

fn compared<C: NativeOracle>(set: InstructionSet, name: &str) -> f64 {
    let oracle = C::oracle().unwrap();
    let ops = oracle.program.ops.len();
    let oracle = std::sync::Arc::new(oracle);
    let fixed = OracleMachine::fixed_on(set, oracle.clone(), 1, false);
    let native = OracleMachine::native_on::<C>(set, oracle, 1, false);
    assert!(all(&fixed) == all(&native), "{name}: the bits differ");
    let (mut by_fixed, mut by_native) = (0.0_f64, 0.0_f64);
    for _ in 0..RUNS {
        by_fixed = by_fixed.max(speed(&fixed));
        by_native = by_native.max(speed(&native));
    }
    println!(
        "  {name:16} {ops:7}  {:8.3}  {:8.3}  {:6.2}",
        by_fixed / 1e6,
        by_native / 1e6,
        by_native / by_fixed
    );
    by_native / by_fixed
}

fn all(machine: &OracleMachine) -> Vec<i64> {
    let mut values = Vec::new();
    let finished = |found: Finished<'_>| {
        found
            .good
            .iter()
            .for_each(|good| values.extend_from_slice(good));
    };
    machine
        .trace(&PIXELS, 0..machine.paths(), finished)
        .expect("neither machine finds anything");
    values
}

/// Returns paths a second.
fn speed(machine: &OracleMachine) -> f64 {
    let started = Instant::now();
    machine
        .trace(&PIXELS, 0..machine.paths(), |found| {
            std::hint::black_box(found.good);
        })
        .expect("neither machine finds anything");
    let paths = PIXELS.len() as u64 * machine.paths();
    paths as f64 / started.elapsed().as_secs_f64()
}
