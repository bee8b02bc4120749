use super::compile::Wiring;
use super::patterns::PATTERNS;
use super::*;
use crate::PixelLanes;
use proptest::prelude::*;
use qrt_circuit::{Gate, Parameter, Qubit};

/// One state, on which gates run one by one.
#[derive(Clone, PartialEq, Debug)]
struct State {
    qubits: Vec<bool>,
    negative: bool,
}

impl State {
    fn run(&mut self, gates: &[Gate], parameters: &[u64]) {
        let q = &mut self.qubits;
        for gate in gates {
            match *gate {
                Gate::X(t) => q[t as usize] ^= true,
                Gate::Cx(a, t) => q[t as usize] ^= q[a as usize],
                Gate::Ccx(a, b, t) => q[t as usize] ^= q[a as usize] && q[b as usize],
                Gate::Load {
                    parameter,
                    bit,
                    target,
                } => q[target as usize] ^= parameters[parameter as usize] >> bit & 1 == 1,
                Gate::Z(t) => self.negative ^= q[t as usize],
            }
        }
    }
}

fn circuit(gates: Vec<Gate>, qubits: u32) -> GateCircuit {
    let word = |width| Parameter {
        name: String::new(),
        width,
    };
    GateCircuit {
        gates,
        qubits,
        parameters: vec![word(3), word(1)],
        ..GateCircuit::default()
    }
}

const QUBITS: u32 = 10;

fn gate() -> impl Strategy<Value = Gate> {
    let distinct = Just((0..QUBITS).collect::<Vec<Qubit>>()).prop_shuffle();
    (0..8, distinct, 0..3_u32).prop_map(|(kind, q, bit)| match kind {
        0 => Gate::X(q[0]),
        1 | 2 => Gate::Cx(q[0], q[1]),
        3 | 4 => Gate::Ccx(q[0], q[1], q[2]),
        5 => Gate::Z(q[0]),
        6 => Gate::Load {
            parameter: 0,
            bit,
            target: q[0],
        },
        _ => Gate::Load {
            parameter: 1,
            bit: 0,
            target: q[0],
        },
    })
}

/// Any gates, with patterns among them.
fn gates() -> impl Strategy<Value = Vec<Gate>> {
    let names = || Just((0..QUBITS).collect::<Vec<Qubit>>()).prop_shuffle();
    let pattern = (0..PATTERNS.len(), names()).prop_map(|(number, q)| {
        let q = |place: &Qubit| q[*place as usize];
        let gates = PATTERNS[number].gates.iter().map(|gate| match gate {
            Gate::Cx(a, t) => Gate::Cx(q(a), q(t)),
            Gate::Ccx(a, b, t) => Gate::Ccx(q(b), q(a), q(t)),
            gate => *gate,
        });
        gates.collect::<Vec<_>>()
    });
    let piece = prop_oneof![pattern, proptest::collection::vec(gate(), 1..3)];
    proptest::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat())
}

/// Checks all states of the qubits, in 4 pixels; in shorter rows, the states that fit.
fn check(gates: &[Gate], set: InstructionSet) {
    let circuit = circuit(gates.to_vec(), QUBITS);
    let machine = GatesMachine::new(&[&circuit])
        .unwrap()
        .with_instructions(set);
    assert_eq!(machine.lanes(), LANES);
    for words in rows::LENGTHS {
        check_lanes(gates, &machine.clone().with_words(words), set);
    }
}

fn check_lanes(gates: &[Gate], machine: &GatesMachine, set: InstructionSet) {
    let lanes = machine.lanes();
    let mut rows = machine.rows();
    let qubits: Vec<Qubit> = (0..QUBITS).collect();
    let states = 1 << QUBITS;
    let contents: Vec<u64> = (0..lanes as u64).map(|lane| 5 * lane % states).collect();
    let span = lanes / 4;
    let words: Vec<[u64; 2]> = (0..4).map(|pixel| [3 * pixel % 8, pixel / 2]).collect();
    let spans = words.iter().map(|words| PixelLanes {
        lanes: span,
        parameters: words,
    });
    rows.set(&qubits, &contents);
    rows.set_parameters(&spans.collect::<Vec<_>>());
    machine.run(0, &mut rows);
    let mut after = vec![0; lanes];
    rows.get(&qubits, &mut after);
    for lane in 0..lanes {
        let mut state = State {
            qubits: (0..QUBITS).map(|q| contents[lane] >> q & 1 == 1).collect(),
            negative: false,
        };
        state.run(gates, &words[lane / span]);
        let expected = state.qubits.iter().rev();
        let expected = expected.fold(0, |sum, bit| 2 * sum + u64::from(*bit));
        assert_eq!(after[lane], expected, "lane {lane}, {set:?}");
        let negative = rows.signs()[lane / 64] >> (lane % 64) & 1 == 1;
        assert_eq!(negative, state.negative, "lane {lane}, {set:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_gate_is_executed_in_every_lane(gates in gates()) {
        for set in InstructionSet::available() {
            check(&gates, set);
        }
    }

    #[test]
    fn what_is_set_is_read_back(values in proptest::collection::vec(any::<u64>(), 1..LANES)) {
        let machine = GatesMachine::new(&[&circuit(Vec::new(), 70)]).unwrap();
        let mut rows = machine.rows();
        let qubits: Vec<Qubit> = (3..67).rev().collect();
        rows.set(&qubits, &values);
        let mut read = vec![0; values.len()];
        rows.get(&qubits, &mut read);
        prop_assert_eq!(&read, &values);
        let mut all = vec![0; LANES];
        rows.get(&qubits, &mut all);
        prop_assert!(all[values.len()..].iter().all(|v| v == values.last().unwrap()));
    }
}

#[test]
fn each_pattern_is_recognised_and_does_what_its_gates_do() {
    for (number, pattern) in PATTERNS.iter().enumerate() {
        let wiring = Wiring::new(&[&circuit(Vec::new(), QUBITS)]);
        let code = wiring.compile(pattern.gates);
        assert_eq!(compile::parts(code.unwrap()[0]), (number, 1));
        for set in InstructionSet::available() {
            check(pattern.gates, set);
        }
    }
}

#[test]
fn a_qubit_left_behind_is_found_in_its_lane() {
    // Qubit 2 keeps the conjunction of 0 and 1.
    let gates = vec![Gate::Ccx(0, 1, 2), Gate::Cx(0, 1)];
    let machine = GatesMachine::new(&[&circuit(gates, 3)]).unwrap();
    let mut rows = machine.rows();
    rows.set(&[0], &[1, 1, 0, 1]);
    rows.set(&[1], &[0, 0, 1, 1]);
    machine.run(0, &mut rows);
    let left = Some(Dirty { qubit: 2, lane: 3 });
    assert_eq!(rows.dirty(&[0, 1], LANES), left);
    assert_eq!(rows.dirty(&[0, 1], 3), None);
    assert_eq!(rows.dirty(&[0, 1, 2], LANES), None);
    assert_eq!(rows.dirty(&[0], LANES), Some(Dirty { qubit: 1, lane: 0 }));
    rows.clear();
    assert_eq!(rows.dirty(&[], LANES), None);
}

#[test]
fn parts_of_a_circuit_run_on_the_same_rows() {
    let add = circuit(
        vec![
            Gate::Cx(0, 1),
            Gate::Load {
                parameter: 1,
                bit: 0,
                target: 1,
            },
        ],
        2,
    );
    let flag = circuit(vec![Gate::Z(1)], 2);
    let machine = GatesMachine::new(&[&add, &flag]).unwrap();
    let mut rows = machine.rows();
    rows.set(&[0], &[0, 1, 0, 1]);
    let spans = [[0, 0], [0, 1]];
    let spans = spans.each_ref().map(|parameters| PixelLanes {
        lanes: 2,
        parameters,
    });
    rows.set_parameters(&spans);
    for part in [0, 1, 0] {
        machine.run(part, &mut rows);
    }
    assert_eq!(rows.signs()[0] & 0xf, 0b0110);
    assert_eq!(rows.dirty(&[0], LANES), None);
}

#[test]
fn a_gate_that_is_none_is_refused() {
    let missing = Gate::Load {
        parameter: 1,
        bit: 1,
        target: 0,
    };
    for gate in [
        Gate::X(2),
        Gate::Cx(1, 1),
        Gate::Ccx(0, 1, 0),
        Gate::Z(2),
        missing,
    ] {
        let fine = circuit(vec![Gate::X(1)], 2);
        let circuit = circuit(vec![Gate::X(0), gate], 2);
        let refused = GatesMachine::new(&[&fine, &circuit]).unwrap_err();
        assert_eq!(
            refused,
            InvalidGate {
                circuit: 1,
                gate: 1
            }
        );
    }
}

#[test]
fn blocks_come_in_order() {
    let machine = GatesMachine::new(&[&circuit(vec![Gate::Cx(0, 1)], 2)]).unwrap();
    let sums = machine.blocks(9, |rows, block| {
        rows.clear();
        rows.set(&[0], &[block as u64]);
        machine.run(0, rows);
        let mut value = [0];
        rows.get(&[0, 1], &mut value);
        value[0]
    });
    assert_eq!(sums, [0, 3, 0, 3, 0, 3, 0, 3, 0]);
}

#[test]
fn rows_of_many_qubits_are_shorter() {
    let lanes = |qubits| {
        let machine = GatesMachine::new(&[&circuit(Vec::new(), qubits)]).unwrap();
        assert_eq!(machine.rows().signs().len() * 64, machine.lanes());
        machine.lanes()
    };
    assert_eq!([40_000, 80_000, 150_000].map(lanes), [2048, 1024, 512]);
}

#[test]
fn gates_made_anew_run_on_what_fits_into_some_memory() {
    let at_once = |qubits| {
        let machine = GatesMachine::new(&[&circuit(Vec::new(), qubits)]).unwrap();
        let machine = machine.for_many_rows(128 << 20);
        let rows = machine.rows_at_once(128 << 20);
        let bytes = (qubits as usize + 5) * machine.lanes() / 8;
        assert!(rows == 1 || (bytes * rows <= 128 << 20 && bytes * (rows + 1) > 128 << 20));
        (machine.lanes(), rows)
    };
    assert_eq!(at_once(10_000), (2048, 52));
    assert_eq!(at_once(600_000), (512, 3));
    assert_eq!(at_once(12_000_000), (256, 1));
    // Each of several rows runs all gates.
    let machine = GatesMachine::new(&[&circuit(Vec::new(), 3)]).unwrap();
    let mut rows = [machine.rows(), machine.rows()];
    for (value, rows) in rows.iter_mut().enumerate() {
        rows.set(&[0, 1], &[3 * value as u64]);
    }
    let template = machine
        .template(&[Gate::Ccx(2, 0, 1), Gate::X(2)], 3)
        .unwrap();
    let mut queue = Queue::default();
    machine.queue(&template, &[1, 2, 0], &mut queue);
    assert_eq!(queue.len(), 2);
    machine.run_queued(&mut queue, &mut rows);
    assert!(queue.is_empty());
    let values = rows.map(|rows| {
        let mut value = [0];
        rows.get(&[0, 1, 2], &mut value);
        value[0]
    });
    assert_eq!(values, [0b001, 0b110]);
    let refused = machine.template(&[Gate::X(0), Gate::Cx(1, 1)], 3);
    assert_eq!(refused.unwrap_err().gate, 1);
    assert!(machine.template(&[Gate::X(3)], 3).is_err());
}

/// A template uses the machine's signs and parameters, wherever its qubits are and however long the
/// rows.
#[test]
fn a_template_flips_the_machines_signs_and_reads_its_parameters() {
    let machine = GatesMachine::new(&[&circuit(Vec::new(), 9)]).unwrap();
    let short = machine.clone().for_many_rows(0);
    assert_eq!([machine.lanes(), short.lanes()], [2048, 256]);
    let load = |bit, target| Gate::Load {
        parameter: 0,
        bit,
        target,
    };
    let gates = [
        load(0, 0),
        load(1, 1),
        Gate::Z(1),
        Gate::X(0),
        Gate::X(2),
        Gate::Ccx(0, 1, 2),
        Gate::Cx(2, 3),
        Gate::Cx(0, 3),
    ];
    for machine in [machine, short] {
        let mut rows = [machine.rows()];
        rows[0].set_parameters(&[PixelLanes {
            lanes: 1,
            parameters: &[0b10, 0],
        }]);
        let template = machine.template(&gates, 4).unwrap();
        let mut queue = Queue::default();
        machine.queue(&template, &[7, 4, 0, 8], &mut queue);
        machine.run_queued(&mut queue, &mut rows);
        let mut value = [0];
        rows[0].get(&[7, 4, 0, 8], &mut value);
        assert_eq!((value[0], rows[0].signs()[0] & 1), (0b1011, 1));
    }
}
