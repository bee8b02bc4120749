//! Tests of the paper's whole figure for a scene: Hadamards, controlled powers of the Grover iterate with
//! every gate and ancilla of the scene's oracle, and the inverse Fourier transform give the same
//! distribution as counting by draws, which uses S alone.

use super::paths::{oracle, paths};
use crate::common::scene::written;
use qrt::circuit::quantum::{CircuitPart, Conjunction, CountingCircuit, QuantumGate};
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::counting::amplitudes::{reduced, subspace};
use qrt::counting::{PhaseDistribution, Stratum};
use qrt::machines::statevector::{Checks, Sparse, StateVector, count, counting_of, fold};
use qrt::runtime::path_machines::OracleMachine;
use qrt::scene::Window;
use qrt::scene::valid::ValidScene;

/// A coloured wall, and a lamp behind the camera that lights it: 2 x 2 pixels of 2^4 paths of two
/// rays.
pub(crate) const WALL: &str = "\
name: wall
camera: { perspective: { eye: [0.2, 0.1, 2], target: [0, 0, 0], up: [0, 1, 0], vfov: 60 } }
film: { width: 2, height: 2 }
materials:
  wall: { lambertian: { albedo: [0.9, 0.6, 0.3] } }
  lamp: { emitter: { radiance: [2, 3, 4] } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: wall }
  - quad: { vertices: [[-3, -3, 3], [-3, 2, 3], [3, 2, 3], [3, -3, 3]], material: lamp }
sampling:
  path_bits: 4
  lights: none
  depths: [{ bits: [3, 3] }, { bits: [3, 3] }]
precision: { fraction: 6 }
comparator: { bits: 2 }
";

const SEED: u64 = 5;
const PIXELS: [[u32; 2]; 3] = [[0, 0], [1, 0], [1, 1]];

fn closed(good: u64, total: u64, phase_bits: u32, window: Window) -> Vec<f64> {
    let exact = PhaseDistribution::new(good, total, phase_bits, window).unwrap();
    (0..=exact.largest_outcome())
        .map(|y| exact.probability(y))
        .collect()
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

/// Returns, by pixel and channel, the good indices (path below, comparator above) on the fixed machine.
fn tables(scene: &ValidScene) -> Vec<[Vec<bool>; 3]> {
    let oracle = oracle(scene);
    let machine = OracleMachine::fixed(oracle.clone(), SEED, true);
    let traced = paths(&machine, &PIXELS).unwrap();
    let one = machine.paths() as usize;
    let comparators = 0..1_i64 << oracle.comparator_bits();
    let table = |pixel: usize, channel: usize| {
        let counts = &traced.good[channel][pixel * one..][..one];
        let of = |y| counts.iter().map(move |count| y < *count);
        comparators.clone().flat_map(of).collect()
    };
    (0..PIXELS.len())
        .map(|pixel| [0, 1, 2].map(|channel| table(pixel, channel)))
        .collect()
}

fn is_the_distribution(sets: &[&str], phase_bits: u32) {
    let scene = written(WALL, sets);
    let together = oracle(&scene);
    let apart = [0, 1, 2].map(|c| Oracle::new(&scene, c, OracleOptions::default()).unwrap());
    let mut different = std::collections::HashSet::new();
    for (pixel, tables) in PIXELS.iter().zip(tables(&scene)) {
        for (channel, table) in tables.iter().enumerate() {
            let total = table.len() as u64;
            let good = table.iter().filter(|good| **good).count() as u64;
            different.insert(good);
            for window in [Window::Rect, Window::Sine] {
                // A channel's own oracle, and its part of the oracle of all channels.
                let (oracle, number) = match window {
                    Window::Rect => (&apart[channel], 0),
                    Window::Sine => (&*together, channel),
                };
                let oracle = oracle.phase(number, SEED, *pixel).unwrap();
                let counted = counting_of(&oracle, phase_bits, window).unwrap();
                let exact = closed(good, total, phase_bits, window);
                let others = [
                    exact.clone(),
                    reduced(table, phase_bits, window).unwrap(),
                    subspace(good, total, phase_bits, window).unwrap(),
                ];
                for other in others {
                    let off = off(&counted.distribution, &other);
                    assert!(off < 1e-12, "{pixel:?} {channel} {window:?}: {off:e}");
                }
                let report = counted.report;
                assert_eq!(report.queries, (1 << phase_bits) - 1);
                // The ancillas are checked once before and once after each query, and at the end.
                assert_eq!(report.checks, report.queries + 2);
                assert!(report.qubits > 200 + report.superposed, "{report:?}");
                assert!(report.most_states.unwrap() <= 1 << report.superposed);
                assert!((report.norm - 1.0).abs() < 1e-12 && report.dropped < 1e-25);
            }
        }
    }
    assert!(
        different.len() > 3,
        "all pixels look the same: {different:?}"
    );
}

#[test]
fn gives_the_distribution_that_is_drawn_from() {
    is_the_distribution(&[], 5);
}

#[test]
fn gives_it_too_where_work_is_uncomputed_early() {
    is_the_distribution(&["circuit.uncompute=scoped", "comparator.at=edges"], 3);
}

#[test]
fn gives_it_too_where_lamps_are_sampled() {
    for lights in ["next-event", "mis"] {
        let lights = format!("sampling.lights={lights}");
        let depths = "sampling.depths=[{ bits: [3, 3] }, { bits: [3, 3], light: [3, 3] }]";
        is_the_distribution(&[depths, &lights], 3);
    }
}

/// With the comparator's top bits fixed, the circuit counts the good indices of a stratum.
#[test]
fn gives_the_distribution_of_every_stratum() {
    let scene = written(WALL, &[]);
    let oracle = oracle(&scene);
    let (path_bits, bits, phase_bits) = (4, 2, 4);
    let window = Window::Sine;
    for (pixel, tables) in PIXELS.iter().zip(tables(&scene)) {
        let phase = oracle.phase(0, SEED, *pixel).unwrap();
        for strata in 2..=3 {
            for stratum in Stratum::halving(strata, bits) {
                let (fixed, lowest) = stratum.fixed_bits(bits);
                let comparator = &phase.index()[path_bits..];
                let fixed = &comparator[fixed.start as usize..fixed.end as usize];
                let (ones, zeros) = fixed.split_at(usize::from(lowest));
                let phase = phase.clone().with_fixed(zeros, ones).unwrap();
                let counting = CountingCircuit::new(&phase, phase_bits, window).unwrap();
                let mut machine = Sparse::new(counting.qubits());
                let counted = count(&mut machine, &counting, Checks::EveryQuery).unwrap();
                let within = stratum.thresholds();
                let within =
                    (within.start as usize) << path_bits..(within.end as usize) << path_bits;
                let table = &tables[0][within];
                let good = table.iter().filter(|good| **good).count() as u64;
                let exact = closed(good, table.len() as u64, phase_bits, window);
                let off = off(&counted.distribution, &exact);
                assert!(off < 1e-12, "{pixel:?} {stratum:?}: {off:e}");
                let mut gates = 0;
                let all = counting.part(CircuitPart::Counting, &mut |_| {
                    gates += 1;
                    Ok::<(), std::convert::Infallible>(())
                });
                all.unwrap();
                assert_eq!(gates, counting.gates(CircuitPart::Counting));
            }
        }
        let gone = phase.superposed().to_vec();
        assert!(phase.clone().with_fixed(&gone, &[]).is_err());
        assert!(phase.clone().with_fixed(&gone[..1], &gone[..1]).is_err());
    }
}

/// O_0 flips the phases of all states except `|0...0>`. If it flips that of `|0...0>` alone, counting
/// gives the indices that are *not* good.
#[test]
fn counts_the_others_where_the_reflection_has_the_other_sign() {
    let scene = written(WALL, &[]);
    let oracle = Oracle::new(&scene, 0, OracleOptions::default()).unwrap();
    let table = &tables(&scene)[0][0];
    let (total, phase_bits) = (table.len() as u64, 4);
    let good = table.iter().filter(|good| **good).count() as u64;
    assert!(good != total - good);
    let oracle = oracle.phase(0, SEED, PIXELS[0]).unwrap();
    let counting = CountingCircuit::new(&oracle, phase_bits, Window::Rect).unwrap();
    let mut machine = Sparse::new(counting.qubits());
    counting
        .part(CircuitPart::Counting, &mut |gate| match gate {
            // Only the gates that correct the sign are Zs on a qubit of the phase register.
            QuantumGate::Phase { on: [qubit], .. } if counting.phase_register().contains(qubit) => {
                Ok(())
            }
            gate => machine.gate(gate),
        })
        .unwrap();
    let found = fold(&machine.distribution(counting.phase_register()).unwrap());
    assert!(off(&found, &closed(good, total, phase_bits, Window::Rect)) > 0.05);
    let others = closed(total - good, total, phase_bits, Window::Rect);
    assert!(off(&found, &others) < 1e-12);
}

/// A phase register adds the logarithm of its size to the qubits of an oracle.
#[test]
fn has_a_qubit_more_for_twice_the_size() {
    let oracle = Oracle::new(&written(WALL, &[]), 0, OracleOptions::default()).unwrap();
    let oracle = oracle.phase(0, SEED, PIXELS[0]).unwrap();
    let iterate = CountingCircuit::new(&oracle, 1, Window::Rect)
        .unwrap()
        .qubits()
        - 1;
    for phase_bits in 1..=30 {
        for (window, bond) in [(Window::Rect, 0), (Window::Sine, 1)] {
            let counting = CountingCircuit::new(&oracle, phase_bits, window).unwrap();
            assert_eq!(counting.qubits(), iterate + phase_bits + bond);
            assert_eq!(counting.queries(), (1 << phase_bits) - 1);
        }
    }
    // Grover's reflection uses the oracle's own ancillas.
    assert_eq!(iterate, oracle.qubits());
}

/// Uses gates with no more than two controls, through the oracle's own ancillas.
#[test]
fn may_be_written_without_many_controls() {
    let scene = written(WALL, &[]);
    let oracle = Oracle::new(&scene, 2, OracleOptions::default()).unwrap();
    let table = &tables(&scene)[1][2];
    let good = table.iter().filter(|good| **good).count() as u64;
    let oracle = oracle.phase(0, SEED, PIXELS[1]).unwrap();
    let whole = CountingCircuit::new(&oracle, 4, Window::Sine).unwrap();
    let toffolis = CountingCircuit::with(&oracle, 4, Window::Sine, Conjunction::Toffolis).unwrap();
    assert_eq!(whole.qubits(), toffolis.qubits());
    let mut machine = Sparse::new(toffolis.qubits());
    let counted = count(&mut machine, &toffolis, Checks::EveryQuery).unwrap();
    let exact = closed(good, table.len() as u64, 4, Window::Sine);
    assert!(off(&counted.distribution, &exact) < 1e-12);
    assert_eq!(counted.report.gates, toffolis.gates(CircuitPart::Counting));
}

#[test]
fn has_no_fourth_channel() {
    let oracle = Oracle::new(&written(WALL, &[]), 0, OracleOptions::default()).unwrap();
    let refused = oracle.phase(1, SEED, [0, 0]).unwrap_err();
    assert_eq!(refused.to_string(), "the oracle has no channel 1");
}
