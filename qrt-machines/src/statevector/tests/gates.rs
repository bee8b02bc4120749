//! Compares gates with their matrices.

use super::Owned;
use super::*;
use crate::InstructionSet;
use num_complex::Complex;
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

type Matrix = Vec<Vec<Complex<f64>>>;

/// The gate's matrix on its own qubits, the first of which is bit 0.
fn own_matrix(gate: &Owned) -> (Vec<Qubit>, Matrix) {
    let real = |rows: &[&[f64]]| -> Matrix {
        let row = |row: &&[f64]| row.iter().map(|x| Complex::new(*x, 0.0)).collect();
        rows.iter().map(row).collect()
    };
    let permutation = |to: &[usize]| -> Matrix {
        let mut matrix = vec![vec![Complex::new(0.0, 0.0); to.len()]; to.len()];
        for (from, to) in to.iter().enumerate() {
            matrix[*to][from] = Complex::new(1.0, 0.0);
        }
        matrix
    };
    match gate {
        Owned::X(t) => (vec![*t], permutation(&[1, 0])),
        Owned::Cx(a, t) => (vec![*a, *t], permutation(&[0, 3, 2, 1])),
        Owned::Ccx(a, b, t) => (vec![*a, *b, *t], permutation(&[0, 1, 2, 7, 4, 5, 6, 3])),
        Owned::H(t) => {
            let r = FRAC_1_SQRT_2;
            (vec![*t], real(&[&[r, r], &[r, -r]]))
        }
        Owned::Ry(angle, t) => {
            let (s, c) = (angle / 2.0).sin_cos();
            (vec![*t], real(&[&[c, -s], &[s, c]]))
        }
        Owned::Phase(turns, on) => {
            let size = 1 << on.len();
            let mut matrix = permutation(&(0..size).collect::<Vec<_>>());
            matrix[size - 1][size - 1] = Complex::cis(TAU * turns.as_f64());
            (on.clone(), matrix)
        }
    }
}

/// Applies the gate to all qubits, by its definition: identity on the others.
fn apply(gate: &Owned, state: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let (qubits, matrix) = own_matrix(gate);
    let inside = |index: usize| {
        let bits = qubits.iter().enumerate();
        bits.fold(0, |own, (place, q)| own | (index >> q & 1) << place)
    };
    let outside = |index: usize| qubits.iter().fold(index, |index, q| index & !(1 << q));
    (0..state.len())
        .map(|row| {
            let columns = (0..state.len()).filter(|column| outside(*column) == outside(row));
            columns
                .map(|column| matrix[inside(row)][inside(column)] * state[column])
                .sum()
        })
        .collect()
}

const QUBITS: u32 = 7;

fn gate(qubits: u32) -> impl Strategy<Value = Owned> {
    let distinct = Just((0..qubits).collect::<Vec<Qubit>>()).prop_shuffle();
    (0..10, distinct, -9.0..9.0, 0..5_usize).prop_map(move |(kind, q, angle, many)| match kind {
        0 => Owned::X(q[0]),
        1 => Owned::Cx(q[0], q[1]),
        2 => Owned::Ccx(q[0], q[1], q[2]),
        3 => Owned::Ry(angle, q[0]),
        4 | 5 => Owned::Phase(Turns::HALF, q[..many].to_vec()),
        6 => Owned::Phase(Turns::new((angle * 100.0) as i64, 7), q[..many].to_vec()),
        _ => Owned::H(q[0]),
    })
}

/// Random gates, with runs of Hadamards among them.
fn circuit(qubits: u32, most: usize) -> impl Strategy<Value = Vec<Owned>> {
    let run = Just((0..qubits).collect::<Vec<Qubit>>()).prop_shuffle();
    let run = (run, 1..=qubits as usize)
        .prop_map(|(q, many)| q[..many].iter().map(|q| Owned::H(*q)).collect());
    let piece = prop_oneof![
        1 => run,
        4 => proptest::collection::vec(gate(qubits), 1..4)
    ];
    proptest::collection::vec(piece, 0..most).prop_map(|pieces: Vec<Vec<Owned>>| pieces.concat())
}

fn sparse_amplitudes(machine: &mut Sparse, qubits: u32) -> Vec<Complex<f64>> {
    let mut all = vec![Complex::new(0.0, 0.0); 1 << qubits];
    let register: Vec<Qubit> = (0..qubits).collect();
    for (state, amplitude) in machine.amplitudes(&register).unwrap() {
        assert_eq!(all[state as usize], Complex::new(0.0, 0.0), "a state twice");
        all[state as usize] = amplitude;
    }
    all
}

fn dense_amplitudes(machine: &mut Dense) -> Vec<Complex<f64>> {
    let states = 0..1 << machine.qubits();
    states.map(|state| machine.amplitude(state)).collect()
}

fn near(a: &[Complex<f64>], b: &[Complex<f64>]) {
    for (state, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((a - b).norm() < 1e-13, "{state}: {a}, not {b}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn gates_are_their_matrices(gates in circuit(QUBITS, 12)) {
        let mut state = vec![Complex::new(0.0, 0.0); 1 << QUBITS];
        state[0] = Complex::new(1.0, 0.0);
        for gate in &gates {
            state = apply(gate, &state);
        }
        let mut bits = None;
        for set in InstructionSet::available() {
            let mut dense = Dense::new(QUBITS).unwrap().with_instructions(set);
            let mut sparse = Sparse::new(QUBITS).with_instructions(set);
            for gate in &gates {
                dense.gate(gate.gate()).unwrap();
                sparse.gate(gate.gate()).unwrap();
            }
            let found = [dense_amplitudes(&mut dense), sparse_amplitudes(&mut sparse, QUBITS)];
            for found in &found {
                near(found, &state);
            }
            prop_assert!((dense.norm().unwrap() - 1.0).abs() < 1e-13);
            prop_assert!((sparse.norm().unwrap() - 1.0).abs() < 1e-13);
            // The same bits with every instruction set.
            prop_assert_eq!(bits.get_or_insert_with(|| found.clone()), &found);
        }
    }

    #[test]
    fn the_inverse_gates_backwards_lead_back(gates in circuit(9, 20), start in 0..1_u64 << 9) {
        let mut dense = Dense::new(9).unwrap();
        let mut sparse = Sparse::new(9);
        let prepare = (0..9).filter(|q| start >> q & 1 == 1).map(Owned::X);
        let there: Vec<Owned> = prepare.chain(gates.iter().cloned()).collect();
        for gate in there.iter().chain(gates.iter().rev().map(Owned::inverse).collect::<Vec<_>>().iter()) {
            dense.gate(gate.gate()).unwrap();
            sparse.gate(gate.gate()).unwrap();
        }
        for state in 0..1 << 9 {
            let expected = f64::from(u8::from(state == start));
            prop_assert!((dense.amplitude(state) - expected).norm() < 1e-13);
        }
        let all = sparse_amplitudes(&mut sparse, 9);
        prop_assert!((all[start as usize] - 1.0).norm() < 1e-13);
    }
}

/// In a register larger than a chunk, all cases occur: targets and controls within a chunk and
/// beyond.
#[test]
fn large_registers_are_like_small_ones() {
    let qubits = 18;
    let mut dice = Dice(3);
    let mut dense = Dense::new(qubits).unwrap();
    let mut sparse = Sparse::new(qubits);
    let mut pick = |most: u64| (dice.word() % most) as u32;
    // Few enough states that the sparse machine computes them in another way.
    for round in 0..400 {
        let mut q: Vec<Qubit> = (0..qubits).collect();
        for place in 0..6 {
            q.swap(
                place,
                place + pick(u64::from(qubits) - place as u64) as usize,
            );
        }
        let gate = match pick(12) {
            0 => Owned::X(q[0]),
            1..=3 => Owned::Cx(q[0], q[1]),
            4..=6 => Owned::Ccx(q[0], q[1], q[2]),
            7 => Owned::Ry(f64::from(pick(100)), q[0]),
            8 if round % 4 == 0 => Owned::H(q[0]),
            8..=10 => Owned::Phase(
                Turns::new(i64::from(pick(16)), 4),
                q[..=pick(4) as usize].to_vec(),
            ),
            _ if round % 16 == 0 => Owned::H(q[0]),
            _ => Owned::Cx(q[1], q[0]),
        };
        dense.gate(gate.gate()).unwrap();
        sparse.gate(gate.gate()).unwrap();
    }
    // A run of Hadamards within and beyond.
    for q in [17, 2, 15, 9, 16] {
        dense.gate(QuantumGate::H(q)).unwrap();
        sparse.gate(QuantumGate::H(q)).unwrap();
    }
    let register: Vec<Qubit> = (0..qubits).collect();
    let mut left = 0.0;
    for (state, amplitude) in sparse.amplitudes(&register).unwrap() {
        let other = dense.amplitude(state);
        assert!(
            (other - amplitude).norm() < 1e-13,
            "{state:x}: {other}, not {amplitude}"
        );
        left += other.norm_sqr();
    }
    assert!((left - 1.0).abs() < 1e-12 && (dense.norm().unwrap() - 1.0).abs() < 1e-12);
    let some = [17, 3, 9, 12, 0];
    let both = [dense.distribution(&some), sparse.distribution(&some)].map(Result::unwrap);
    for (a, b) in both[0].iter().zip(&both[1]) {
        assert!((a - b).abs() < 1e-13);
    }
}

#[test]
fn threads_change_no_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut dense = Dense::new(17).unwrap();
            let mut sparse = Sparse::new(17);
            for q in (0..17).chain(0..9) {
                for gate in [
                    Owned::H(q),
                    Owned::Phase(Turns::new(3, 5), vec![q, (q + 5) % 17]),
                    Owned::Ry(f64::from(q), (q + 3) % 17),
                    Owned::Ccx(q, (q + 1) % 17, (q + 2) % 17),
                ] {
                    dense.gate(gate.gate()).unwrap();
                    sparse.gate(gate.gate()).unwrap();
                }
            }
            let register: Vec<Qubit> = (0..17).collect();
            (
                dense_amplitudes(&mut dense),
                sparse.amplitudes(&register).unwrap(),
                sparse.norm().unwrap(),
            )
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn measuring_leaves_what_was_read() {
    let mut counts = [0_u64; 4];
    for shot in 0..400 {
        let uniform = (Dice(5 + shot).word() >> 11) as f64 / 2_f64.powi(53);
        // |00> and |11> entangled with a third qubit; amplitudes cos(1/2), sin(1/2).
        let gates = [Owned::Ry(1.0, 0), Owned::Cx(0, 1), Owned::H(2)];
        let mut dense = Dense::new(3).unwrap();
        let mut sparse = Sparse::new(3);
        for gate in &gates {
            dense.gate(gate.gate()).unwrap();
            sparse.gate(gate.gate()).unwrap();
        }
        let machines: [&mut dyn StateVector; 2] = [&mut dense, &mut sparse];
        let mut read = Vec::new();
        for machine in machines {
            assert!(machine.sample(&[0, 1], uniform).unwrap() % 3 == 0);
            let value = machine.measure(&[0, 1], uniform).unwrap();
            assert!((machine.norm().unwrap() - 1.0).abs() < 1e-14);
            let after = machine.distribution(&[1, 0]).unwrap();
            assert!((after[value as usize] - 1.0).abs() < 1e-14);
            assert!((machine.excited(&[2]).unwrap() - 0.5).abs() < 1e-14);
            read.push(value);
        }
        assert_eq!(read[0], read[1]);
        counts[read[0] as usize] += 1;
        assert_eq!(sparse.states().unwrap(), 2);
    }
    let expected = (0.5_f64).sin().powi(2);
    let deviation = (expected * (1.0 - expected) / 400.0).sqrt();
    assert!((counts[3] as f64 / 400.0 - expected).abs() < 4.0 * deviation);
}

#[test]
fn what_cannot_be_is_refused() {
    let most = Dense::MOST_QUBITS;
    let refused = Dense::new(most + 1).unwrap_err();
    let expected = StateVectorError::TooManyQubits {
        qubits: most + 1,
        most,
    };
    assert_eq!(refused, expected);
    let on = [0, 1, 0];
    let bad = [
        QuantumGate::X(3),
        QuantumGate::Cx(1, 1),
        QuantumGate::Ccx(0, 1, 0),
        QuantumGate::H(9),
        QuantumGate::Ry {
            angle: 1.0,
            target: 3,
        },
        QuantumGate::Ry {
            angle: f64::NAN,
            target: 0,
        },
        QuantumGate::Phase {
            turns: Turns::HALF,
            on: &on,
        },
    ];
    let (mut dense, mut sparse) = (Dense::new(3).unwrap(), Sparse::new(3));
    for gate in bad {
        let refused = dense.gate(gate).unwrap_err();
        assert_eq!(
            format!("{refused:?}"),
            format!("{:?}", sparse.gate(gate).unwrap_err())
        );
    }
    assert!(dense.distribution(&[0, 0]).is_err() && sparse.distribution(&[3]).is_err());

    let mut sparse = Sparse::new(40);
    sparse.most = 1000;
    for q in 0..12 {
        sparse.gate(QuantumGate::H(q)).unwrap();
    }
    let expected = StateVectorError::TooManyStates {
        states: 4096,
        most: 1000,
    };
    assert_eq!(sparse.states(), Err(expected));
    let wide: Vec<Qubit> = (0..40).collect();
    assert!(matches!(
        Sparse::new(40).distribution(&wide),
        Err(StateVectorError::RegisterTooWide { .. })
    ));
}

/// The state of a small angle is dropped if the bound says so, and its probability is accounted
/// for.
#[test]
fn what_is_dropped_is_accounted_for() {
    let angle = 2e-3;
    let run = |bound: f64| {
        let mut sparse = Sparse::new(70);
        sparse.bound = bound;
        let gate = QuantumGate::Ry { angle, target: 66 };
        sparse.gate(gate).unwrap();
        (
            sparse.states().unwrap(),
            sparse.dropped(),
            sparse.norm().unwrap(),
        )
    };
    assert_eq!(run(Sparse::ROUNDING).0, 2);
    let (states, dropped, norm) = run(2e-3);
    assert_eq!(states, 1);
    assert!((dropped - 1e-3_f64.sin().powi(2)).abs() < 1e-20);
    assert!((norm + dropped - 1.0).abs() < 1e-15);
    // No state is left to be measured.
    let mut sparse = Sparse::new(1);
    sparse.bound = 1.0;
    sparse.gate(QuantumGate::H(0)).unwrap();
    let nothing = sparse.measure(&[0], 0.5);
    assert_eq!(nothing, Err(StateVectorError::NoStates));
}
