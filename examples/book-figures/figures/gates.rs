//! Small circuits, gate by gate. Each is run on amplitudes as it is drawn.

use super::Figure;
use qrt::circuit::quantum::QuantumGate::{self, Ccx, Cx, H, Phase, X};
use qrt::circuit::quantum::{
    CircuitPart, CountingCircuit, GroverIterate, PhaseOracle, Turns, Window,
};
use qrt::lab::draw::Wires;
use qrt::machines::statevector::{Dense, StateVector, StateVectorError};

/// Returns the real amplitudes of a register after `gates`.
fn amplitudes(qubits: u32, gates: &[QuantumGate<'_>]) -> Result<Vec<f64>, StateVectorError> {
    let mut machine = Dense::new(qubits)?;
    for gate in gates {
        machine.gate(*gate)?;
    }
    Ok((0..1_u64 << qubits)
        .map(|j| machine.amplitude(j).re)
        .collect())
}

/// Draws the effect of a copy that is not uncomputed.
pub(super) fn garbage() -> Figure {
    let mut wires = Wires::new(&[("qubit", "id"), ("ancilla", "work")]);
    let gates = [H(0), Cx(0, 1), Cx(0, 1), H(0)];
    let names = ["superposed", "copied", "undone", "back"];
    for (gate, name) in gates.iter().zip(names) {
        wires.part(name);
        wires.gate(*gate);
    }
    let clean = amplitudes(2, &gates).expect("a state")[0];
    let dirty = amplitudes(2, &[H(0), Cx(0, 1), H(0)]).expect("a state");
    let says = format!(
        "A Hadamard, a CNOT that copies the qubit into an ancilla, the same CNOT, which uncomputes \
         the copy, and a Hadamard. The qubit then reads 0 with probability {:.2}. Without the second \
         CNOT it does with {:.2}.",
        clean * clean,
        dirty[0] * dirty[0] + dirty[2] * dirty[2]
    );
    Figure::drawn(wires.draw("A copy, and its end"), says)
}

/// Names and classes of the index's qubits and the flag.
const INDEX_AND_FLAG: [(&str, &str); 3] = [
    ("index, bit 0", "id"),
    ("index, bit 1", "id"),
    ("flag", "flag"),
];

/// Returns the signs of the four indices, and asserts that the flag is zero in all.
fn signs(gates: &[QuantumGate<'_>]) -> String {
    let found = amplitudes(3, gates).expect("a state");
    assert!(found[4..].iter().all(|amplitude| amplitude.abs() < 1e-12));
    let signs = found[..4]
        .iter()
        .map(|amplitude| if *amplitude < 0.0 { "-" } else { "+" });
    signs.collect()
}

/// Draws a phase oracle that flips the phase by Z.
pub(super) fn flip() -> Figure {
    let mut wires = Wires::new(&INDEX_AND_FLAG);
    let z = Phase {
        turns: Turns::HALF,
        on: &[2],
    };
    let gates = [H(0), H(1), Ccx(0, 1, 2), z, Ccx(0, 1, 2)];
    for (names, part) in [
        ("superpose", &gates[..2]),
        ("compute", &gates[2..3]),
        ("flip", &gates[3..4]),
        ("uncompute", &gates[4..]),
    ] {
        staged(&mut wires, names, part);
    }
    let says = format!(
        "Two index qubits and a flag: Hadamards, a Toffoli that computes their AND into the flag, a Z \
         on the flag, and the Toffoli again. Signs of the indices 0 to 3 afterwards: {}; the flag is \
         zero.",
        signs(&gates)
    );
    Figure::drawn(wires.draw("Compute, flip, uncompute"), says)
}

/// Draws the same oracle with phase kickback.
pub(super) fn kickback() -> Figure {
    let mut wires = Wires::new(&INDEX_AND_FLAG);
    let gates = [H(0), H(1), X(2), H(2), Ccx(0, 1, 2), H(2), X(2)];
    for (name, part) in [
        ("prepare", &gates[..4]),
        ("compute", &gates[4..5]),
        ("put back", &gates[5..]),
    ] {
        staged(&mut wires, name, part);
    }
    let says = format!(
        "The same signs by phase kickback: the flag is prepared as (|0> - |1>)/sqrt(2) by X and H, \
         one Toffoli flips it, and H and X put it back. Signs of the indices 0 to 3: {}.",
        signs(&gates)
    );
    Figure::drawn(wires.draw("Phase kickback"), says)
}

/// Adds `gates` as a part with the name `name`.
fn staged(wires: &mut Wires, name: &str, gates: &[QuantumGate<'_>]) {
    wires.part(name);
    for gate in gates {
        wires.gate(*gate);
    }
}

/// Draws phase estimation of 3/8 with three bits: the wave, and the inverse Fourier transform.
pub(super) fn fourier() -> Figure {
    let mut wires = Wires::new(&[
        ("phase, bit 0", "solid s5"),
        ("phase, bit 1", "solid s5"),
        ("phase, bit 2", "solid s5"),
    ]);
    let mut machine = Dense::new(3).expect("a machine");
    let mut both = |wires: &mut Wires, gate: QuantumGate<'_>| {
        wires.gate(gate);
        machine.gate(gate).expect("a gate");
    };
    wires.part("a wave of 3/8 turns a step");
    for qubit in 0..3 {
        both(&mut wires, H(qubit));
        both(
            &mut wires,
            Phase {
                turns: Turns::new(3 << qubit, 3),
                on: &[qubit],
            },
        );
    }
    wires.part("reverse");
    for gate in [Cx(0, 2), Cx(2, 0), Cx(0, 2)] {
        both(&mut wires, gate);
    }
    wires.part("inverse Fourier transform");
    for qubit in 0..3 {
        for below in 0..qubit {
            let turns = Turns::new(-1, qubit - below + 1);
            both(
                &mut wires,
                Phase {
                    turns,
                    on: &[below, qubit],
                },
            );
        }
        both(&mut wires, H(qubit));
    }
    wires.part("read");
    let read = machine.distribution(&[0, 1, 2]).expect("a distribution");
    let likeliest = (0..8)
        .max_by(|a, b| read[*a].total_cmp(&read[*b]))
        .unwrap_or(0);
    for qubit in 0..3 {
        wires.measure(qubit);
    }
    let says = format!(
        "Three qubits: Hadamards and phases make a wave whose phase grows by 3/8 turns a step; three \
         CNOTs reverse the register; Hadamards and phases of -1/4 and -1/8 turns on pairs are the \
         inverse Fourier transform. The register reads {likeliest} with probability {:.3}.",
        read[likeliest]
    );
    Figure::drawn(wires.draw("A wave, and what reads its frequency"), says)
}

/// Draws Grover's iterate.
pub(super) fn iterate() -> Figure {
    const NAMES: [(&str, &str); 3] = [
        ("index, bit 0", "id"),
        ("index, bit 1", "id"),
        ("index, bit 2", "id"),
    ];
    let oracle = PhaseOracle::polynomial(3, vec![vec![0, 2]]).expect("an oracle");
    let iterate = GroverIterate::new(&oracle);
    let mut machine = Dense::new(3).expect("a machine");
    let mut wires = Wires::new(&NAMES);
    for qubit in 0..3 {
        machine.gate(H(qubit)).expect("a gate");
    }
    let all = iterate.gates(false);
    let (flip, last) = (oracle.gates(), all - 3);
    let mut place = 0;
    let applied = iterate.apply(None, &mut |gate| {
        for (start, name) in [(0, "O_f"), (flip, "H"), (flip + 3, "O_0"), (last, "H")] {
            if place == start {
                wires.part(name);
            }
        }
        place += 1;
        wires.gate(gate);
        machine.gate(gate)
    });
    applied.expect("gates");
    let found = machine.distribution(&[0, 1, 2]).expect("a distribution");
    let good: f64 = (0..8).filter(|j| j & 5 == 5).map(|j| found[j]).sum();
    let says = format!(
        "One iterate G on three index qubits, {all} gates: the sign of the oracle, whose good indices \
         have bits 0 and 2 set (S = 2 of N = 8); Hadamards; O_0, which is a sign on all three between \
         Xs and a factor of -1; Hadamards. After it a good index is measured with probability \
         {good:.3}, where it was 0.250."
    );
    Figure::drawn(
        wires.draw("Grover's iterate G = H O₀ H O_f, gate by gate"),
        says,
    )
}

/// Draws the whole counting circuit, in boxes.
pub(super) fn counting() -> Figure {
    const BITS: u32 = 3;
    let oracle = PhaseOracle::polynomial(3, vec![vec![0, 2]]).expect("an oracle");
    let counting = CountingCircuit::new(&oracle, BITS, Window::Rect).expect("a circuit");
    let mut wires = Wires::new(&[
        ("index", "id"),
        ("phase, bit 0", "solid s5"),
        ("phase, bit 1", "solid s5"),
        ("phase, bit 2", "solid s5"),
    ]);
    wires.part("prepare");
    for qubit in 0..=BITS {
        wires.gate(H(qubit));
    }
    wires.part("7 queries, each under a control");
    for bit in 0..BITS {
        let name = ["G", "G²", "G⁴"][bit as usize];
        wires.block(name, [0, 0], Some(bit + 1));
    }
    wires.part("read");
    wires.block("F†", [1, BITS], None);
    for bit in 1..=BITS {
        wires.measure(bit);
    }
    let mut machine = Dense::new(counting.qubits()).expect("a machine");
    counting
        .part(CircuitPart::Counting, &mut |gate| machine.gate(gate))
        .expect("gates");
    let read = machine
        .distribution(counting.phase_register())
        .expect("a distribution");
    let [first, second] = [1, 7].map(|y| read[y]);
    let says = format!(
        "The counting circuit with a phase register of three bits: Hadamards; the iterate G once, \
         twice and four times under the control of bits 0, 1 and 2, which are {} queries; the inverse \
         Fourier transform; a measurement. With S = 2 of N = 8 the register reads 1 with probability \
         {first:.3} and 7, which means the same, with {second:.3}.",
        counting.queries()
    );
    Figure::drawn(wires.draw("Quantum counting: phase estimation of G"), says)
}
