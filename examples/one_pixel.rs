//! One pixel from a routine of ten lines to a count: `cargo run --release --example one_pixel`.
//!
//! A point of a floor looks up to a ceiling of eight cells, of which a lamp fills four. Eight paths
//! in three bits are traced by gates, compared with four thresholds, marked by a sign, amplified,
//! and counted. The chapter "One pixel, from nothing" of the book shows this program in pieces.

// ANCHOR: uses
use qrt::circuit::quantum::{
    CircuitPart, CountingCircuit, GroverIterate, PhaseOracle, QuantumGate, Window,
};
use qrt::circuit::{Gate, GateCircuit, lower};
use qrt::counting::maximum_likelihood;
use qrt::counting::random::Stream;
use qrt::machines::statevector::{Sparse, StateVector, fold};
use qrt::prelude::*;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;
// ANCHOR_END: uses

// ANCHOR: trace
/// Adds the light of the ray into cell `path` of the ceiling to `colour`: 0 to 3.
#[reversible]
fn trace(path: &UInt<3>, colour: &mut UInt<2>) {
    let mut lit: Bool = false;
    // The lamp fills the cells 3 to 6.
    within! { lit ^= (path >= 3) & (path < 7); }
    apply! {
        if lit {
            colour += 3;
            // Light at a slant is spread over more of the floor.
            if path == 5 { colour -= 1; }
            if path == 6 { colour -= 2; }
        }
    }
}
// ANCHOR_END: trace

// ANCHOR: colours
/// The colours of all paths, one after another, as a classical program traces them.
pub(crate) fn colours() -> Outcome<Vec<u64>> {
    let program = trace_program(Style::InPlace);
    let paths: Vec<[u64; 2]> = (0..8).map(|path| [path, 0]).collect();
    let traced = run::on_gates(&program, &paths)?;
    Ok(traced.iter().map(|state| state[1]).collect())
}
// ANCHOR_END: colours

// ANCHOR: mark
/// Flips `good` if the path is brighter than threshold number `y`.
#[reversible]
fn mark(path: &UInt<3>, y: &UInt<2>, good: &mut Bool) {
    let mut colour: UInt<2> = 0;
    within! { trace(&path, &mut colour); }
    apply! { good ^= y < colour; }
}

/// For each of the 32 indices, true if it is good: first all paths for threshold 0, and so on.
pub(crate) fn good() -> Outcome<Vec<bool>> {
    let indices: Vec<[u64; 3]> = (0..32).map(|index| [index & 7, index >> 3, 0]).collect();
    let marked = run::on_gates(&mark_program(Style::InPlace), &indices)?;
    Ok(marked.iter().map(|state| state[2] == 1).collect())
}
// ANCHOR_END: mark

// ANCHOR: oracle
/// The phase oracle: mark, a Z on the mark, and all of it backwards.
pub(crate) fn oracle() -> Outcome<PhaseOracle> {
    let program = mark_program(Style::InPlace);
    let compute = lower::circuit(&program);
    let uncompute = lower::circuit(&program.inverse());
    let qubits = |input: usize| {
        let mut held = compute.inputs.iter();
        let found = held.find(|(register, _)| *register == program.inputs[input]);
        found.map_or(vec![], |(_, qubits)| qubits.clone())
    };
    let flip = GateCircuit {
        gates: vec![Gate::Z(qubits(2)[0])],
        ..GateCircuit::default()
    };
    let index = [qubits(0), qubits(1)].concat();
    Ok(PhaseOracle::new(&compute, &flip, &uncompute, index, &[])?)
}

/// The amplitudes of all 32 indices after Hadamards and one call of the oracle.
pub(crate) fn signs(oracle: &PhaseOracle) -> Outcome<Vec<f64>> {
    let mut machine = Sparse::new(oracle.qubits());
    for qubit in oracle.superposed() {
        machine.gate(QuantumGate::H(*qubit))?;
    }
    oracle.apply(None, &mut |gate| machine.gate(gate))?;
    // Only the sign is left: every other qubit is zero again.
    assert!(machine.excited(&oracle.ancillas())? < 1e-12);
    amplitudes(&mut machine, oracle)
}

/// The real amplitudes of the 32 indices.
fn amplitudes(machine: &mut Sparse, oracle: &PhaseOracle) -> Outcome<Vec<f64>> {
    let mut all = vec![0.0; 32];
    for (index, amplitude) in machine.amplitudes(oracle.superposed())? {
        all[index as usize] = amplitude.re;
    }
    Ok(all)
}
// ANCHOR_END: oracle

// ANCHOR: grover
/// The amplitudes after `iterates` iterates: sign, then reflection about the mean.
pub(crate) fn amplified(oracle: &PhaseOracle, iterates: u32) -> Outcome<Vec<f64>> {
    let iterate = GroverIterate::new(oracle);
    let mut machine = Sparse::new(iterate.qubits());
    for qubit in oracle.superposed() {
        machine.gate(QuantumGate::H(*qubit))?;
    }
    for _ in 0..iterates {
        iterate.apply(None, &mut |gate| machine.gate(gate))?;
    }
    amplitudes(&mut machine, oracle)
}
// ANCHOR_END: grover

// ANCHOR: count
/// Bits of the phase register: T = 32, and so 31 queries.
pub(crate) const PHASE_BITS: u32 = 5;

/// The probability of each outcome y = 0 to 16 of the phase register, and one that is drawn.
pub(crate) fn count(oracle: &PhaseOracle, seed: u64) -> Outcome<(Vec<f64>, u64)> {
    let counting = CountingCircuit::new(oracle, PHASE_BITS, Window::Sine)?;
    let mut machine = Sparse::new(counting.qubits());
    counting.part(CircuitPart::Counting, &mut |gate| machine.gate(gate))?;
    let register = counting.phase_register();
    let outcomes = fold(&machine.distribution(register)?);
    let y = machine.measure(register, Stream::new(seed, 0, 0, 0).uniform())?;
    Ok((outcomes, y.min(32 - y)))
}
// ANCHOR_END: count

// ANCHOR: report
/// The result of each step, one line each.
pub(crate) fn report() -> Outcome<Vec<String>> {
    let mut lines = Vec::new();
    let colours = colours()?;
    let mean = colours.iter().sum::<u64>() as f64 / 8.0;
    lines.push(format!("colours {colours:?}, mean {mean}"));

    let good = good()?;
    let s = good.iter().filter(|good| **good).count();
    let pixel = |good: f64| 4.0 * good / 32.0;
    lines.push(format!(
        "{s} of 32 indices are good: the pixel is {}",
        pixel(s as f64)
    ));

    let oracle = oracle()?;
    let (qubits, gates) = (oracle.qubits(), oracle.gates());
    lines.push(format!("one query: {gates} gates on {qubits} qubits"));
    let signs = signs(&oracle)?;
    let turned = signs.iter().map(|amplitude| *amplitude < 0.0);
    assert!(turned.eq(good.iter().copied()));

    for iterates in 0..4 {
        let found = amplified(&oracle, iterates)?;
        let found = found.iter().zip(&good).filter(|(_, good)| **good);
        let probability: f64 = found.map(|(amplitude, _)| amplitude * amplitude).sum();
        let percent = 100.0 * probability;
        lines.push(format!(
            "after {iterates} iterates a good index is read with {percent:.1} %"
        ));
    }

    for seed in 1..=3 {
        let (_, y) = count(&oracle, seed)?;
        let likeliest = maximum_likelihood(&[y], 32, PHASE_BITS, Window::Sine)?.good;
        let value = pixel(likeliest as f64);
        lines.push(format!(
            "31 queries read {y}: likeliest {likeliest} good, pixel {value}"
        ));
    }
    Ok(lines)
}

fn main() -> Outcome<()> {
    for line in report()? {
        println!("{line}");
    }
    Ok(())
}
// ANCHOR_END: report
