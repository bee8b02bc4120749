//! Compares small circuits with cirq's results, which `benches/peers/amplitudes.py` wrote.

use super::Owned;
use super::*;
use num_complex::Complex;
use qrt_circuit::quantum::Window;
use qrt_circuit::quantum::{CountingCircuit, PhaseOracle};

const CIRQ: &str = include_str!("cirq.txt");

fn gate(words: &[&str]) -> Owned {
    let qubit = |place: usize| words[place].parse::<Qubit>().unwrap();
    match words[0] {
        "x" => Owned::X(qubit(1)),
        "h" => Owned::H(qubit(1)),
        "cx" => Owned::Cx(qubit(1), qubit(2)),
        "ccx" => Owned::Ccx(qubit(1), qubit(2), qubit(3)),
        "ry" => Owned::Ry(words[1].parse().unwrap(), qubit(2)),
        "p" => {
            let turns = Turns::new(words[1].parse().unwrap(), words[2].parse().unwrap());
            Owned::Phase(turns, (3..words.len()).map(qubit).collect())
        }
        other => panic!("{other}"),
    }
}

#[test]
fn cirq_finds_the_same_amplitudes_and_outcomes() {
    let mut lines = CIRQ.lines().map(|line| line.split(' ').collect::<Vec<_>>());
    let (mut circuits, mut countings) = (0, 0);
    let mut next = lines.next();
    while let Some(head) = next {
        let mut body = Vec::new();
        next = loop {
            match lines.next() {
                Some(line) if !["circuit", "counting"].contains(&line[0]) => body.push(line),
                other => break other,
            }
        };
        let number = |word: &str| word.parse::<f64>().unwrap();
        if head[0] == "circuit" {
            circuits += 1;
            let qubits = head[1].parse().unwrap();
            let mut dense = Dense::new(qubits).unwrap();
            let mut sparse = Sparse::new(qubits);
            let (gates, amplitudes): (Vec<_>, Vec<_>) =
                body.iter().partition(|line| line[0] != "amplitude");
            assert_eq!(amplitudes.len(), 1 << qubits);
            for line in gates {
                dense.gate(gate(line).gate()).unwrap();
                sparse.gate(gate(line).gate()).unwrap();
            }
            let register: Vec<Qubit> = (0..qubits).collect();
            let mut found = vec![Complex::new(0.0, 0.0); 1 << qubits];
            for (state, amplitude) in sparse.amplitudes(&register).unwrap() {
                found[state as usize] = amplitude;
            }
            for (state, line) in amplitudes.iter().enumerate() {
                let expected = Complex::new(number(line[1]), number(line[2]));
                assert!((dense.amplitude(state as u64) - expected).norm() < 1e-13);
                assert!((found[state] - expected).norm() < 1e-13);
            }
        } else {
            countings += 1;
            let phase_bits = head[1].parse().unwrap();
            let good: Vec<bool> = head[2].chars().map(|digit| digit == '1').collect();
            let oracle = PhaseOracle::table(good.len().ilog2(), |id| good[id as usize]).unwrap();
            let counting = CountingCircuit::new(&oracle, phase_bits, Window::Rect).unwrap();
            let expected: Vec<f64> = body.iter().map(|line| number(line[1])).collect();
            assert_eq!(expected.len(), 1 << phase_bits);
            let mut machine = Dense::new(counting.qubits()).unwrap();
            count(&mut machine, &counting, Checks::AtTheEnd).unwrap();
            let outcomes = machine.distribution(counting.phase_register()).unwrap();
            for (outcome, expected) in outcomes.iter().zip(&expected) {
                assert!(
                    (outcome - expected).abs() < 1e-12,
                    "{outcome}, not {expected}"
                );
            }
        }
    }
    assert_eq!((circuits, countings), (2, 2));
}
