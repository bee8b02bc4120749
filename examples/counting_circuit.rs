//! Quantum counting of a pixel, gate by gate: the paper's whole figure.
//!
//! ```sh
//! cargo run --release --example counting_circuit
//! ```
//!
//! A lamp before a coloured wall is compiled to a circuit; around it come the Grover iterate, its
//! controlled powers and the inverse Fourier transform. All of it runs on amplitudes, ancillas
//! included. Beside the measured distribution the program prints the one that `qrt render` draws
//! from, which depends only on the number of good indices.

use qrt::core::oracle::Oracle;
use qrt::counting::PhaseDistribution;
use qrt::machines::statevector::counting_of;
use qrt::prelude::*;
use qrt::runtime::path_machines::OracleMachine;
use qrt::scene::Window;
use std::sync::Arc;

const SCENE: &str = include_str!("lit-wall.yaml");

const SEED: u64 = 1;
const PIXEL: [u32; 2] = [1, 0];
const PHASE_BITS: u32 = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = parse(SCENE, "lit-wall.yaml", &[], "".as_ref())?.valid;

    // Without amplitudes, the classical machine gives each path's colour, and so S.
    let all = Arc::new(Oracle::rgb(
        &scene,
        qrt::core::oracle::OracleOptions::default(),
    )?);
    let machine = OracleMachine::fixed(all.clone(), SEED, false);
    let mut good = [0; 3];
    machine.trace(&[PIXEL], 0..machine.paths(), |paths| {
        for (good, counts) in good.iter_mut().zip(paths.good) {
            *good += counts.iter().sum::<i64>().unsigned_abs();
        }
    })?;
    let total = machine.paths() << all.comparator_bits();

    for (channel, name) in ["red", "green", "blue"].into_iter().enumerate() {
        let oracle = Oracle::new(&scene, channel, qrt::core::oracle::OracleOptions::default())?;
        let counted = counting_of(&oracle.phase(0, SEED, PIXEL)?, PHASE_BITS, Window::Sine)?;
        let report = &counted.report;
        println!(
            "{name}: {} gates in {} queries on {} qubits, {} of them in superposition;\n  \
             at most {} basis states, ancillas looked at {} times and clean; S = {} of {total}",
            report.gates,
            report.queries,
            report.qubits,
            report.superposed,
            report.most_states.unwrap_or(0),
            report.checks,
            good[channel],
        );
        let exact = PhaseDistribution::new(good[channel], total, PHASE_BITS, Window::Sine)?;
        println!("  theta~     circuit    from S");
        let size = 1 << PHASE_BITS;
        for (y, probability) in counted.distribution.iter().enumerate() {
            let known = exact.probability(y as u64);
            let bar = "#".repeat((probability * 60.0).round() as usize);
            println!("  {y:2}/{size}  {probability:10.7} {known:10.7}  {bar}");
            assert!((probability - known).abs() < 1e-12);
        }
    }
    Ok(())
}
