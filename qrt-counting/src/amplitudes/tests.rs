//! Tests that four models of counting agree with the closed form.

use super::*;
use crate::PhaseDistribution;
use crate::random::Stream;
use qrt_circuit::quantum::{
    CircuitPart, Conjunction, CountingCircuit, PhaseOracle, QuantumGate, Window,
};
use qrt_machines::statevector::{Checks, Dense, Sparse, StateVector, count, fold};

const WINDOWS: [Window; 2] = [Window::Rect, Window::Sine];

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

fn agree(a: &[f64], b: &[f64], what: &str) {
    let off = off(a, b);
    assert!(off < 1e-12, "{what}: {off:e}");
}

/// A random truth table with `good` good indices.
fn table(bits: u32, good: usize, seed: u64) -> Vec<bool> {
    let mut stream = Stream::new(seed, 0, 0, 0);
    let mut table: Vec<bool> = (0..1 << bits).map(|id| id < good).collect();
    for place in (1..table.len()).rev() {
        table.swap(place, (stream.next_u64() % (place as u64 + 1)) as usize);
    }
    table
}

fn run<M: StateVector>(counting: &CountingCircuit<'_>, mut machine: M) -> Vec<f64> {
    let counted = count(&mut machine, counting, Checks::EveryQuery).unwrap();
    assert!((counted.report.norm - 1.0).abs() < 1e-12);
    assert_eq!(counted.report.gates, counting.gates(CircuitPart::Counting));
    counted.distribution
}

#[test]
fn all_models_agree() {
    let sizes = [
        (1, 1),
        (1, 5),
        (2, 3),
        (3, 4),
        (4, 4),
        (5, 2),
        (5, 5),
        (6, 3),
    ];
    for (place, (bits, phase_bits)) in sizes.into_iter().enumerate() {
        let total = 1_u64 << bits;
        let mut goods = vec![0, 1, total / 2, total - 1, total];
        goods.push((total * 3 + 4) / 7);
        goods.dedup();
        for good in goods {
            let table = table(bits, good as usize, 100 * place as u64 + good);
            let oracle = PhaseOracle::table(bits, |id| table[id as usize]).unwrap();
            for window in WINDOWS {
                let what = format!("S = {good} of {total}, t = {phase_bits}, {window:?}");
                let exact = closed(good, total, phase_bits, window);
                for conjunction in [Conjunction::Whole, Conjunction::Toffolis] {
                    let counting =
                        CountingCircuit::with(&oracle, phase_bits, window, conjunction).unwrap();
                    let dense = Dense::new(counting.qubits()).unwrap();
                    agree(&run(&counting, dense), &exact, &format!("dense, {what}"));
                    let sparse = Sparse::new(counting.qubits());
                    agree(&run(&counting, sparse), &exact, &format!("sparse, {what}"));
                }
                let found = reduced(&table, phase_bits, window).unwrap();
                agree(&found, &exact, &format!("reduced, {what}"));
                let found = subspace(good, total, phase_bits, window).unwrap();
                agree(&found, &exact, &format!("subspace, {what}"));
            }
        }
    }
}

/// Larger sizes, for the models that have no ancillas; for the plane, numbers of indices that are
/// not powers of two.
#[test]
fn large_models_agree() {
    for (bits, phase_bits) in [(10, 10), (3, 14), (13, 4), (11, 7)] {
        let total = 1_u64 << bits;
        for good in [1, total / 3, total - 2] {
            let table = table(bits, good as usize, good);
            for window in WINDOWS {
                let what = format!("S = {good} of {total}, t = {phase_bits}, {window:?}");
                let exact = closed(good, total, phase_bits, window);
                let found = reduced(&table, phase_bits, window).unwrap();
                agree(&found, &exact, &format!("reduced, {what}"));
            }
        }
    }
    for (good, total) in [
        (1, 3),
        (0, 1),
        (1, 1),
        (5, 1 << 40),
        (1_000_003, 1 << 62),
        (77, 1000),
    ] {
        for phase_bits in [1, 2, 11, 18] {
            for window in WINDOWS {
                let what = format!("S = {good} of {total}, t = {phase_bits}, {window:?}");
                let exact = closed(good, total, phase_bits, window);
                let found = subspace(good, total, phase_bits, window).unwrap();
                agree(&found, &exact, &format!("subspace, {what}"));
            }
        }
    }
}

/// If O_0 turns the sign of `|0...0>` alone, the circuit counts the other indices: N - S.
#[test]
fn the_sign_of_the_reflection_matters() {
    let (bits, phase_bits, good) = (5, 5, 9);
    let total = 1_u64 << bits;
    let table = table(bits, good as usize, 1);
    let oracle = PhaseOracle::table(bits, |id| table[id as usize]).unwrap();
    for window in WINDOWS {
        let counting = CountingCircuit::new(&oracle, phase_bits, window).unwrap();
        let mut dense = Dense::new(counting.qubits()).unwrap();
        let mut sparse = Sparse::new(counting.qubits());
        let mut left_out = 0;
        counting
            .part(CircuitPart::Counting, &mut |gate| {
                // A Z on a counting qubit corrects O_0's sign, and no other gate is a Z on a
                // counting qubit.
                if let QuantumGate::Phase { on: [qubit], .. } = gate
                    && counting.phase_register().contains(qubit)
                {
                    left_out += 1;
                    return Ok(());
                }
                dense.gate(gate)?;
                sparse.gate(gate)
            })
            .unwrap();
        assert_eq!(left_out, counting.queries());
        let right = closed(good, total, phase_bits, window);
        let others = closed(total - good, total, phase_bits, window);
        let machines: [&mut dyn StateVector; 2] = [&mut dense, &mut sparse];
        for machine in machines {
            let found = fold(&machine.distribution(counting.phase_register()).unwrap());
            assert!(off(&found, &right) > 0.1, "the sign does not matter");
            agree(&found, &others, "N - S");
        }
    }
}

/// An oracle that leaves garbage in an ancilla is detected: after the first query, or at the end.
#[test]
fn what_an_oracle_leaves_behind_is_found() {
    use qrt_circuit::{Gate, GateCircuit};
    let circuit = |gates: &[Gate]| GateCircuit {
        gates: gates.to_vec(),
        qubits: 4,
        ..GateCircuit::default()
    };
    let compute = circuit(&[Gate::Ccx(0, 1, 2), Gate::Cx(1, 3)]);
    let uncompute = circuit(&[Gate::Ccx(0, 1, 2)]);
    let flip = circuit(&[Gate::Z(2)]);
    let oracle = PhaseOracle::new(&compute, &flip, &uncompute, vec![0, 1], &[]).unwrap();
    let counting = CountingCircuit::new(&oracle, 3, Window::Rect).unwrap();
    for checks in [Checks::EveryQuery, Checks::AtTheEnd] {
        let found = count(&mut Sparse::new(counting.qubits()), &counting, checks);
        let Err(StateVectorError::Dirty { qubit, probability }) = found else {
            panic!("{found:?}");
        };
        assert_eq!(qubit, 3);
        assert!(probability > 0.1);
    }
}

#[test]
fn sizes_are_refused_by_name() {
    let size = AmplitudesError::TableSize(3);
    assert_eq!(reduced(&[true; 3], 4, Window::Rect), Err(size));
    assert_eq!(
        reduced(&[], 4, Window::Rect),
        Err(AmplitudesError::TableSize(0))
    );
    for bits in [0, 25] {
        let expected = |most| Err(AmplitudesError::PhaseBits { bits, most });
        assert_eq!(reduced(&[true], bits, Window::Rect), expected(20));
        assert_eq!(subspace(1, 2, bits, Window::Rect), expected(24));
    }
    assert!(subspace(3, 2, 4, Window::Rect).is_err());
    assert!(subspace(0, 0, 4, Window::Rect).is_err());
}
