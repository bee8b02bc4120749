//! Tests that verification finds wrong circuits.
//!
//! Verification is only as good as the faults that it finds. These tests tamper with circuits in every
//! way in which a compiler could get them wrong. An independent simulation, which shares no code with
//! the machines, runs each of them on every path of the scene. Verification must refuse exactly those
//! circuits that are wrong on one of them, and for the right reason.

use super::paths::simulator::{States, qubits};
use super::paths::{CORNER, film, inputs, number, oracle, paths, word};
use crate::common::scene::written;
use qrt::circuit::{Gate, GateCircuit, Op, Operand, Qubit, lower};
use qrt::core::oracle::Oracle;
use qrt::counting::random::Stream;
use qrt::lab::verify::{VerifyOptions, VerifyReport, verify, verify_parts};
use qrt::machines::contents_by_definition;
use qrt::runtime::path_machines::{Defect, OracleCircuits, OracleMachine};
use qrt::runtime::render::Model;
use qrt::scene::valid::ValidScene;
use std::sync::Arc;

const SEED: u64 = 3;

struct Checked {
    scene: ValidScene,
    oracle: Arc<Oracle>,
    parts: OracleCircuits,
    pixels: Vec<[u32; 2]>,
    /// Results of the untouched circuit: colour and count of every path, by channel.
    right: [Vec<[i64; 2]>; 3],
}

/// Result of a simulated circuit.
#[derive(Debug, PartialEq, Eq)]
enum Simulated {
    /// Some qubit does not have its value from before.
    NotUndone,
    /// Number of (path, channel) pairs with another colour or count.
    Wrong(u64),
    Right,
}

impl Checked {
    fn new(sets: &[&str]) -> Self {
        let scene = written(CORNER, sets);
        let oracle = oracle(&scene);
        let mut checked = Self {
            parts: OracleCircuits::new(&oracle),
            pixels: film(&oracle),
            scene,
            oracle,
            right: Default::default(),
        };
        let mut states = checked.states();
        states.run(&checked.parts.compute.gates);
        checked.right = checked.computed(&states);
        checked
    }

    /// Returns the states before the first gate.
    fn states(&self) -> States {
        States::new(&self.oracle, &self.parts.compute, SEED, &self.pixels)
    }

    fn computed(&self, states: &States) -> [Vec<[i64; 2]>; 3] {
        [0, 1, 2].map(|c| {
            let channel = &self.oracle.channels[c];
            let colours = states.numbers(&self.parts.compute, channel.colour);
            let counts = states.numbers(&self.parts.compute, channel.count);
            let counts = counts.into_iter().map(|n| self.oracle.good(n) as i64);
            colours
                .into_iter()
                .zip(counts)
                .map(|(a, b)| [a, b])
                .collect()
        })
    }

    fn simulated(&self, parts: &OracleCircuits) -> Simulated {
        let mut states = self.states();
        let before = states.qubits.clone();
        states.run(&parts.compute.gates);
        let computed = self.computed(&states);
        states.run(&parts.uncompute.gates);
        if states.qubits != before {
            return Simulated::NotUndone;
        }
        let pairs = computed.iter().flatten().zip(self.right.iter().flatten());
        match pairs.filter(|(is, was)| is != was).count() {
            0 => Simulated::Right,
            n => Simulated::Wrong(n as u64),
        }
    }

    /// Verifies all pixels with `parts`.
    fn verified(&self, parts: OracleCircuits) -> VerifyReport {
        let options = VerifyOptions {
            pixels: u64::MAX,
            seed: SEED,
            ..VerifyOptions::default()
        };
        verify_parts(&self.scene, &self.oracle, parts, &options).unwrap()
    }

    /// Asserts that verification agrees with simulation; returns the result of the simulation.
    fn agree(&self, parts: OracleCircuits) -> Simulated {
        let simulated = self.simulated(&parts);
        let report = self.verified(parts);
        match simulated {
            Simulated::Right => assert!(report.holds(), "{report:?}"),
            // A wrong colour may exceed its bound: then verification compares no others.
            Simulated::Wrong(_) if matches!(report.defect, Some(Defect::OutOfBounds { .. })) => {
                assert!(!report.holds());
            }
            Simulated::Wrong(n) => {
                assert_eq!((report.mismatched, &report.defect), (n, &None));
                assert!(!report.holds() && !report.mismatches.is_empty());
            }
            Simulated::NotUndone => assert!(
                matches!(
                    report.defect,
                    Some(Defect::Dirty { .. } | Defect::Id { .. })
                ),
                "{report:?}"
            ),
        }
        simulated
    }

    /// Returns the circuits with `compute` in place of compute, and its inverse as uncompute.
    fn mirrored(&self, compute: Vec<Gate>) -> OracleCircuits {
        let mut parts = self.parts.clone();
        // Each gate is its own inverse.
        parts.uncompute.gates = compute.iter().rev().copied().collect();
        parts.compute.gates = compute;
        parts
    }
}

/// Draws `count` numbers below `below` from the seed `key`.
fn drawn(key: u64, count: usize, below: usize) -> Vec<usize> {
    let mut stream = Stream::new(key, 0, 0, 0);
    (0..count)
        .map(|_| (stream.uniform() * below as f64) as usize)
        .collect()
}

#[test]
fn an_untouched_circuit_passes() {
    for sets in [
        &[][..],
        &["circuit.uncompute=scoped"],
        &["circuit.nearest=paper"],
    ] {
        let checked = Checked::new(sets);
        assert_eq!(checked.agree(checked.parts.clone()), Simulated::Right);
        let mirror = checked.mirrored(checked.parts.compute.gates.clone());
        assert_eq!(checked.agree(mirror), Simulated::Right);
        let options = VerifyOptions {
            pixels: 5,
            seed: SEED,
            ..VerifyOptions::default()
        };
        assert!(verify(&checked.scene, &options).unwrap().holds());
    }
}

/// A permutation without one of its steps is another permutation, on every state on which the step
/// acts. A missing gate is therefore found if, and only if, it ever acts.
#[test]
fn a_gate_missing_from_uncompute_is_caught_if_it_ever_acts() {
    for sets in [&[][..], &["circuit.uncompute=scoped"]] {
        let checked = Checked::new(sets);
        let gates = &checked.parts.uncompute.gates;
        let mut states = checked.states();
        states.run(&checked.parts.compute.gates);
        let acts: Vec<bool> = gates
            .iter()
            .map(|gate| states.gate(*gate).iter().any(|flips| *flips != 0))
            .collect();
        let mut caught = 0;
        for place in drawn(1, 60, gates.len()) {
            let mut parts = checked.parts.clone();
            parts.uncompute.gates.remove(place);
            let simulated = checked.agree(parts);
            assert_eq!(simulated == Simulated::NotUndone, acts[place]);
            caught += usize::from(acts[place]);
        }
        assert!(caught > 30, "{caught}");
    }
}

#[test]
fn a_dirty_qubit_is_named_with_its_path() {
    let checked = Checked::new(&[]);
    // The last gate that writes to a bit of the colour's register: without it, the bit is not uncomputed.
    let colour = word(checked.oracle.channels[0].colour).unwrap();
    let mut held = checked.parts.compute.outputs.iter();
    let of_colour = &held.find(|(id, _)| *id == colour.register).unwrap().1;
    let gates = &checked.parts.uncompute.gates;
    let mut named = 0;
    for qubit in of_colour {
        let place = gates.iter().position(|g| qubits(*g).last() == Some(qubit));
        let mut parts = checked.parts.clone();
        parts.uncompute.gates.remove(place.unwrap());
        if checked.agree(parts.clone()) == Simulated::Right {
            continue;
        }
        let Some(Defect::Dirty {
            register,
            pixel,
            id,
            dirty,
        }) = checked.verified(parts).defect
        else {
            continue;
        };
        assert!(checked.pixels.contains(&pixel) && id < 32);
        if dirty.qubit == *qubit {
            assert_eq!(register, "colour.r");
            named += 1;
        }
    }
    assert!(named > 0);
}

#[test]
fn neighbouring_gates_in_the_wrong_order_are_caught_if_it_ever_matters() {
    let checked = Checked::new(&["circuit.uncompute=scoped"]);
    let gates = &checked.parts.uncompute.gates;
    // Neighbours whose order matters, because one writes a qubit that the other reads.
    let ordered: Vec<usize> = (1..gates.len())
        .filter(|&place| {
            let [one, other] = [gates[place - 1], gates[place]].map(qubits);
            let reads = |all: &[Qubit], target| all[..all.len() - 1].contains(target);
            reads(&other, one.last().unwrap()) != reads(&one, other.last().unwrap())
        })
        .collect();
    let mut caught = 0;
    for k in drawn(2, 60, ordered.len()) {
        let mut parts = checked.parts.clone();
        parts.uncompute.gates.swap(ordered[k] - 1, ordered[k]);
        caught += usize::from(checked.agree(parts) == Simulated::NotUndone);
    }
    assert!(caught > 30, "{caught}");
}

/// A circuit that uncomputes its own mistakes leaves every qubit clean, but computes a wrong result.
#[test]
fn a_lost_carry_is_caught_though_all_qubits_return_to_zero() {
    let checked = Checked::new(&[]);
    let compute = &checked.parts.compute;
    let steps = checked.oracle.program.instructions.iter();
    let adders: Vec<usize> = steps
        .zip(&compute.ranges)
        .filter(|(step, _)| {
            let op = &checked.oracle.program.ops[step.op as usize];
            matches!(op, Op::Add { .. }) && !step.inverse
        })
        .flat_map(|(_, range)| range.clone())
        .filter(|&place| matches!(compute.gates[place], Gate::Ccx(..)))
        .collect();
    let mut caught = 0;
    for k in drawn(4, 60, adders.len()) {
        let mut gates = compute.gates.clone();
        gates.remove(adders[k]);
        let simulated = checked.agree(checked.mirrored(gates));
        assert_ne!(simulated, Simulated::NotUndone);
        caught += usize::from(simulated != Simulated::Right);
    }
    println!("of 60 lost carries {caught} change a path, and are caught");
    assert!(caught > 10, "{caught}");
}

#[test]
fn a_wrong_table_entry_is_caught_if_it_changes_a_path() {
    let checked = Checked::new(&[]);
    let oracle = &checked.oracle;
    let fixed = OracleMachine::fixed(oracle.clone(), SEED, true);
    let right = paths(&fixed, &checked.pixels).unwrap();
    let mut entries = Vec::new();
    for (place, op) in oracle.program.ops.iter().enumerate() {
        if let Op::Table { columns, .. } = op {
            for (column, values) in columns.iter().enumerate() {
                entries.extend((0..values.len()).map(|entry| [place, column, entry]));
            }
        }
    }
    let (mut caught, mut harmless) = (0, 0);
    for k in drawn(5, 40, entries.len()) {
        let [place, column, entry] = entries[k];
        let mut wrong = Oracle::clone(oracle);
        let program = &mut wrong.program;
        if let Op::Table { columns, .. } = &mut program.ops[place] {
            let mut changed = columns.to_vec();
            let mut values = changed[column].to_vec();
            values[entry] ^= 1 << (k % 3);
            changed[column] = values.into();
            *columns = changed.into();
        }
        // The garbage of another table may be wider.
        let op = &program.ops[place];
        let width = lower::scratch_width(op, |id| program.width(id));
        if let Some(scratch) = op.scratch() {
            program.registers[scratch.index()].width = width;
        }
        // Count the differences by the definition of operations, one path after another.
        let mut differ = 0;
        for (number_of, pixel) in checked.pixels.iter().enumerate() {
            let words = oracle.parameter_words(SEED, *pixel);
            for id in 0..32 {
                let held = contents_by_definition(&wrong.program, &inputs(oracle, id), &words);
                let at = number_of * 32 + id as usize;
                for c in 0..3 {
                    let colour = number(oracle.channels[c].colour, &held.registers);
                    let count = number(oracle.channels[c].count, &held.registers);
                    let good = oracle.good(count) as i64;
                    differ +=
                        u64::from([colour, good] != [right.colours[c][at], right.good[c][at]]);
                }
            }
        }
        let report = checked.verified(OracleCircuits::new(&wrong));
        assert_eq!((report.mismatched, &report.defect), (differ, &None));
        assert_eq!(report.holds(), differ == 0);
        if differ == 0 {
            harmless += 1;
        } else {
            caught += 1;
        }
    }
    println!("of 40 wrong entries {caught} change a path, and are caught; {harmless} do not");
    assert!(caught > 3, "{caught}");
}

/// Tries all colours and comparators, so that nothing is left to chance.
#[test]
fn every_gate_missing_from_a_comparison_is_caught() {
    let checked = Checked::new(&[]);
    for channel in 0..3 {
        for place in 0..checked.parts.flips[channel].gates.len() {
            let mut parts = checked.parts.clone();
            let gate = parts.flips[channel].gates.remove(place);
            let built = OracleMachine::of_parts(checked.oracle.clone(), parts.clone(), SEED, false);
            match built.map(|_| ()) {
                Err(Defect::Flip { .. } | Defect::Dirty { .. } | Defect::Compared { .. }) => {}
                other => panic!("channel {channel}: gate {place}, {gate:?}: {other:?}"),
            }
            if place % 16 == 0 {
                assert!(!checked.verified(parts).holds());
            }
        }
    }
}

/// A qubit of another register may be zero on every state on which a comparison is tried, and nonzero
/// when it runs.
#[test]
fn a_comparison_on_a_qubit_that_holds_something_is_caught() {
    let checked = Checked::new(&[]);
    let held = checked.parts.compute.outputs.iter();
    let count = word(checked.oracle.channels[1].count).unwrap();
    let others = held.filter(|(id, _)| ![count.register, checked.oracle.comparator].contains(id));
    for (register, places) in others.step_by(20) {
        let mut parts = checked.parts.clone();
        let gates = &mut parts.flips[1].gates;
        let target = gates.iter().find_map(|gate| qubits(*gate).last().copied());
        // Two equal gates change nothing.
        let gate = Gate::Cx(places[0], target.unwrap());
        gates.splice(0..0, [gate, gate]);
        let defect = checked.verified(parts).defect;
        let name = &checked.oracle.program.registers[register.index()].name;
        assert_eq!(
            defect,
            Some(Defect::Foreign {
                channel: 1,
                qubit: places[0],
                register: name.clone()
            })
        );
    }
}

#[test]
fn a_gate_that_is_none_is_refused() {
    let checked = Checked::new(&[]);
    let beyond = checked.parts.compute.qubits;
    for gate in [
        Gate::Cx(1, 1),
        Gate::Ccx(0, 2, 2),
        Gate::X(beyond),
        Gate::Load {
            parameter: 1 << 20,
            bit: 0,
            target: 0,
        },
    ] {
        let mut parts = checked.parts.clone();
        parts.compute.gates.insert(100, gate);
        let report = checked.verified(parts);
        assert!(matches!(report.defect, Some(Defect::Gate(_))), "{report:?}");
    }
}

/// Returns the gate with another qubit, or `None` for a missing gate.
fn mutated(gate: Gate, kind: usize, other: Qubit) -> Option<Gate> {
    let mut places = qubits(gate);
    let place = match kind {
        0 => return None,
        // The target.
        1 => places.len() - 1,
        // A control, where there is one.
        _ => 0,
    };
    places[place] = other;
    if places[..places.len() - 1].contains(places.last()?) {
        return None;
    }
    Some(match (gate, &places[..]) {
        (Gate::X(_), [t]) => Gate::X(*t),
        (Gate::Cx(..), [a, t]) => Gate::Cx(*a, *t),
        (Gate::Ccx(..), [a, b, t]) => Gate::Ccx(*a, *b, *t),
        (Gate::Load { parameter, bit, .. }, [t]) => Gate::Load {
            parameter,
            bit,
            target: *t,
        },
        _ => return None,
    })
}

/// The hardest case: compute is wrong in one gate, and uncompute mirrors exactly that.
#[test]
fn one_wrong_gate_that_is_undone_is_caught_if_it_changes_a_path() {
    const MUTATIONS: usize = 120;
    for (key, sets) in [&[][..], &["circuit.uncompute=scoped"]]
        .into_iter()
        .enumerate()
    {
        let checked = Checked::new(sets);
        let GateCircuit { gates, qubits, .. } = &checked.parts.compute;
        let places = drawn(6 + key as u64, MUTATIONS, gates.len());
        let others = drawn(8 + key as u64, MUTATIONS, *qubits as usize);
        let (mut caught, mut undone) = (0, 0);
        for (k, (place, other)) in places.into_iter().zip(others).enumerate() {
            let mut compute = gates.clone();
            match mutated(gates[place], k % 3, other as Qubit) {
                Some(gate) => compute[place] = gate,
                None => drop(compute.remove(place)),
            }
            match checked.agree(checked.mirrored(compute)) {
                Simulated::Right => {}
                Simulated::Wrong(_) => caught += 1,
                Simulated::NotUndone => undone += 1,
            }
        }
        // A mirrored circuit always uncomputes itself.
        assert_eq!(undone, 0);
        println!(
            "{sets:?}: of {MUTATIONS} mutations {caught} change a path, and all of these are caught"
        );
        assert!(caught > MUTATIONS / 4, "{caught}");
    }
}

/// Counts that are read as four times their value are those of colours beyond their bound.
#[test]
fn a_colour_beyond_its_bound_is_noticed_by_every_machine() {
    let scene = written(CORNER, &[]);
    let mut wrong = (*oracle(&scene)).clone();
    for channel in &mut wrong.channels {
        if let Operand::Word(word) = &mut channel.count {
            word.shift += 2;
        }
    }
    let (pixels, wrong) = (film(&wrong), Arc::new(wrong));
    let ids = 0..1 << wrong.points.path_bits();
    let machines = [
        OracleMachine::fixed(Arc::clone(&wrong), SEED, false),
        OracleMachine::gates(Arc::clone(&wrong), SEED, false).unwrap(),
    ];
    let found = machines.map(|machine| machine.trace(&pixels, ids.clone(), |_| {}));
    for found in &found {
        let Err(Defect::OutOfBounds { count, most, .. }) = found else {
            panic!("{found:?}");
        };
        assert!(count > most, "{count} {most}");
    }
    assert_eq!(found[0], found[1]);
    let parts = OracleCircuits::new(&wrong);
    let options = VerifyOptions {
        pixels: pixels.len() as u64,
        seed: SEED,
        ..VerifyOptions::default()
    };
    let report = verify_parts(&scene, &wrong, parts, &options).unwrap();
    assert!(!report.holds());
    assert!(matches!(report.defect, Some(Defect::OutOfBounds { .. })));
    assert_eq!(report.defect_model, Some(Model::Fixed));
}
