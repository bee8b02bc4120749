//! Tests of the mean-phase circuit for a scene: every gate of its oracles and reflections, with all
//! ancillas, gives the outcomes that the levels of the paths alone predict.

use super::openqasm::Circuit;
use super::paths::{oracle, paths};
use super::the_counting_circuit::WALL;
use crate::common::scene::written;
use qrt::circuit::export::{Export, ExportFormat};
use qrt::circuit::quantum::{
    Conjunction, LevelPhases, MeanPhaseCircuit, PhaseOracle, QuantumError, Turns,
};
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::counting::{Histogram, mean_phase_probabilities};
use qrt::machines::statevector::{Sparse, StateVector};
use qrt::runtime::path_machines::OracleMachine;
use std::convert::Infallible;

const SEED: u64 = 5;
const PIXELS: [[u32; 2]; 2] = [[0, 0], [1, 1]];

/// The probabilities of all values of the path index and, above it, the sign qubit, and the number of
/// gates.
fn run(circuit: &MeanPhaseCircuit<'_>) -> (Vec<f64>, u64) {
    let mut machine = Sparse::new(circuit.qubits());
    let mut gates = 0;
    circuit
        .apply(&mut |gate| {
            gates += 1;
            machine.gate(gate)
        })
        .unwrap();
    assert!(machine.excited(&circuit.ancillas()).unwrap() < 1e-28);
    let mut register = circuit.oracle().superposed().to_vec();
    register.push(circuit.sign());
    (machine.distribution(&register).unwrap(), gates)
}

/// Compares the circuit of a phase oracle, iterate by iterate, with the prediction of its paths'
/// levels.
fn is_predicted(oracle: &PhaseOracle, levels: &[u64], phases: LevelPhases) {
    let mut histogram = Histogram::new(phases.level_bits());
    histogram.add_all(levels.iter().copied());
    let all: Vec<(u64, u64)> = histogram.levels().collect();
    for (k, basis) in [(0, 0), (1, 1), (1, -2), (2, -3), (3, 5), (5, -4), (8, 2)] {
        let turns = Turns::new(basis, 4);
        let radians = turns.as_f64() * std::f64::consts::TAU;
        let predicted = mean_phase_probabilities(&all, phases, k, radians);
        for conjunction in [Conjunction::Whole, Conjunction::Toffolis] {
            let circuit = MeanPhaseCircuit::with(oracle, phases, (k, turns), conjunction).unwrap();
            let (found, gates) = run(&circuit);
            assert_eq!(gates, circuit.gates());
            assert_eq!(circuit.queries(), if k == 0 { 0 } else { k + 1 });
            for (path, level) in levels.iter().enumerate() {
                let place = all.iter().position(|(other, _)| other == level).unwrap();
                for bit in [0, 1] {
                    let share = predicted[place][bit] / all[place].1 as f64;
                    let off = (found[path + bit * levels.len()] - share).abs();
                    assert!(off < 1e-13, "k = {k}, path {path}, {bit}: off by {off}");
                }
            }
        }
    }
}

#[test]
fn its_outcomes_are_those_of_the_levels() {
    let mut different = std::collections::HashSet::new();
    for sets in [
        &[][..],
        &["circuit.uncompute=scoped"],
        &["comparator.bits=3"],
    ] {
        let scene = written(WALL, sets);
        let together = oracle(&scene);
        let bits = together.comparator_bits();
        let machine = OracleMachine::fixed(together.clone(), SEED, true);
        let traced = paths(&machine, &PIXELS).unwrap();
        let one = machine.paths() as usize;
        for (place, pixel) in PIXELS.into_iter().enumerate() {
            for channel in 0..3 {
                let counts = &traced.good[channel][place * one..][..one];
                let levels: Vec<u64> = counts.iter().map(|count| count.cast_unsigned()).collect();
                different.insert(levels.clone());
                let (slope, reference) = [(1.2, 0.2), (0.3, 0.0), (4.0, 0.55)][channel];
                let phases = LevelPhases::new(slope, reference, bits, 7).unwrap();
                // A channel's part of the oracle of all, and its own oracle.
                let own = Oracle::new(&scene, channel, OracleOptions::default()).unwrap();
                let part = if place == 0 {
                    together.level_phases(channel, SEED, pixel, &phases)
                } else {
                    own.level_phases(0, SEED, pixel, &phases)
                };
                is_predicted(&part.unwrap(), &levels, phases);
            }
        }
    }
    assert!(different.len() > 4, "there is little to tell apart");
}

/// The table and the turns cost little beside the oracle, which is called without a comparator.
#[test]
fn it_costs_little_beside_the_colours() {
    let scene = include_str!("../../scenes-yaml/cornell-box.yaml");
    let scene = written(scene, &["comparator.bits=10"]);
    let oracle = Oracle::new(&scene, 1, OracleOptions::default()).unwrap();
    let bits = oracle.comparator_bits();
    let phases = LevelPhases::new(3.0, 0.1, bits, 20).unwrap();
    let toffolis = |oracle: &PhaseOracle| {
        let mut toffolis = 0_u64;
        let counted = oracle.apply(None, &mut |gate| {
            toffolis += u64::from(matches!(gate, qrt::circuit::quantum::QuantumGate::Ccx(..)));
            Ok::<(), Infallible>(())
        });
        counted.unwrap();
        toffolis
    };
    let pixel = [30, 40];
    let mean = oracle.level_phases(0, SEED, pixel, &phases).unwrap();
    let counted = oracle.phase(0, SEED, pixel).unwrap();
    assert_eq!(mean.signs(), 20);
    assert_eq!(mean.superposed().len() as u32, oracle.points.path_bits());
    let (mean, counted) = (toffolis(&mean), toffolis(&counted));
    assert!(mean < counted + counted / 100, "{mean} and {counted}");
}

/// Reads both texts of an exported circuit back, gate by gate, and runs them.
#[test]
fn what_is_exported_is_what_runs() {
    let scene = written(WALL, &[]);
    let oracle = oracle(&scene);
    let phases = LevelPhases::new(1.2, 0.2, oracle.comparator_bits(), 6).unwrap();
    let made = oracle.level_phases(1, SEED, [1, 1], &phases).unwrap();
    let turns = (3, Turns::new(-3, 4));
    let circuit = MeanPhaseCircuit::with(&made, phases, turns, Conjunction::Toffolis).unwrap();
    let (expected, _) = run(&circuit);
    let export = Export::mean_phase(&circuit, &[("path", 4)]).unwrap();
    for format in [ExportFormat::OpenQasm3, ExportFormat::OpenQasm2] {
        let mut text = Vec::new();
        let counts = export.write(format, &[], &mut text).unwrap();
        let read = Circuit::read(&String::from_utf8(text).unwrap());
        assert_eq!(read.gates.len() as u64, counts.gates());
        assert_eq!(read.qubits, circuit.qubits());
        let mut machine = Sparse::new(read.qubits);
        read.run(&mut machine);
        // Bit 0 of the outcome is the sign, which is the highest bit of `expected`.
        let mut measured = read.outcome.clone();
        measured.rotate_left(1);
        let found = machine.distribution(&measured).unwrap();
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-13);
        }
    }
    let other = Export::mean_phase(&circuit, &[("path", 5)]);
    assert!(other.is_err());
}

#[test]
fn other_numbers_of_bits_are_refused() {
    let oracle = oracle(&written(WALL, &[]));
    let refused = |level_bits, channel| {
        let phases = LevelPhases::new(1.0, 0.5, level_bits, 8).unwrap();
        oracle.level_phases(channel, SEED, [0, 0], &phases)
    };
    assert_eq!(refused(3, 0), Err(QuantumError::LevelBits));
    assert_eq!(refused(2, 3), Err(QuantumError::NoChannel(3)));
    let phases = |bits| LevelPhases::new(1.0, 0.5, 2, bits).unwrap();
    let made = oracle.level_phases(0, SEED, [0, 0], &phases(8)).unwrap();
    let circuit = MeanPhaseCircuit::new(&made, phases(9), 1, Turns::HALF);
    let signs = QuantumError::PhaseSigns { signs: 8, bits: 9 };
    assert_eq!(circuit.err(), Some(signs));
    for (slope, reference) in [(0.0, 0.5), (-1.0, 0.5), (f64::NAN, 0.5), (1.0, 1.1)] {
        let phases = LevelPhases::new(slope, reference, 2, 8);
        assert_eq!(phases, Err(QuantumError::Slope));
    }
    for (level_bits, bits) in [(13, 8), (2, 1), (2, 52)] {
        let phases = LevelPhases::new(1.0, 0.5, level_bits, bits);
        assert_eq!(phases, Err(QuantumError::LevelBits));
    }
}
