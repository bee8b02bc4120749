//! Tests of exported circuits: read again and run, they are the circuits with which the scene counts.

use super::openqasm::Circuit;
use super::paths::{oracle, paths};
use crate::common::command::Folder;
use crate::common::scene::written;
use qrt::circuit::export::{Export, ExportError, ExportFormat};
use qrt::circuit::quantum::{
    CircuitPart, Conjunction, CountingCircuit, PhaseOracle, QuantumGate, Turns,
};
use qrt::counting::PhaseDistribution;
use qrt::machines::statevector::{Dense, Sparse, StateVector, fold};
use qrt::runtime::path_machines::OracleMachine;
use qrt::scene::Window;
use serde_json::Value;
use std::collections::HashSet;
use std::fs;
use std::sync::atomic::AtomicBool;

/// Returns a lamp in front of a wall, with fewer paths and comparators: 2^5 indices.
fn wall() -> String {
    let scene = include_str!("../../examples/lit-wall.yaml");
    let small = scene.replace("path_bits: 5", "path_bits: 3");
    let small = small.replace("comparator: { bits: 3 }", "comparator: { bits: 2 }");
    small + "counting: { phase_bits: 3 }\n"
}

const FORMATS: [&str; 2] = ["openqasm3", "openqasm2"];
const CHANNELS: [&str; 3] = ["r", "g", "b"];

fn folder() -> Folder {
    Folder::with("wall.yaml", &wall())
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Exports `wall.yaml` with more arguments; returns the circuit and its figures.
fn exported(folder: &Folder, arguments: &str) -> (Circuit, Value) {
    let all = format!("export wall.yaml --json -o wall.qasm {arguments}");
    let answer = folder.works(&words(&all));
    let text = String::from_utf8(folder.read("wall.qasm")).unwrap();
    (Circuit::read(&text), serde_json::from_str(&answer).unwrap())
}

/// Returns the numbers of good indices and of all indices of a pixel, by channel.
fn counts(folder: &Folder, [x, y]: [u32; 2], seed: &str) -> [[u64; 2]; 3] {
    let render = format!(
        "render wall.yaml --model fixed --estimator exact -q --seed {seed} --crop {x},{y},1,1 \
         -o wall.exr --counts wall.csv"
    );
    folder.works(&words(&render));
    let table = String::from_utf8(folder.read("wall.csv")).unwrap();
    let rows = table.lines().skip(1);
    let rows: Vec<[u64; 2]> = rows
        .map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            [cells[4], cells[5]].map(|cell| cell.parse().unwrap())
        })
        .collect();
    rows.try_into().unwrap()
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn the_counting_circuit_measures_what_counting_draws() {
    let folder = folder();
    let mut different = HashSet::new();
    for (seed, pixel) in [("0", [0, 0]), ("5", [1, 1])] {
        let [x, y] = pixel;
        let counts = counts(&folder, pixel, seed);
        for (channel, [good, total]) in CHANNELS.into_iter().zip(counts) {
            different.insert(good);
            for (format, window) in FORMATS.into_iter().zip([Window::Sine, Window::Rect]) {
                let arguments = format!(
                    "--part counting --format {format} --pixel {x},{y} --seed {seed} \
                     --channel {channel} --set counting.window={window}"
                );
                let (circuit, answer) = exported(&folder, &arguments);
                let mut machine = Sparse::new(circuit.qubits);
                circuit.run(&mut machine);
                let clean = [circuit.register("work"), circuit.register("bond")].concat();
                assert!(machine.excited(&clean).unwrap() < 1e-28);
                let outcomes = machine.distribution(&circuit.outcome).unwrap();
                let exact = PhaseDistribution::new(good, total, 3, window).unwrap();
                let exact: Vec<f64> = (0..=exact.largest_outcome())
                    .map(|y| exact.probability(y))
                    .collect();
                let off = off(&fold(&outcomes), &exact);
                assert!(off < 1e-12, "{arguments}: {off:e}");
                assert_eq!(answer["window"], window.name());
                assert_eq!(answer["queries"], 7);
            }
        }
    }
    assert!(different.len() > 3, "pixels are alike: {different:?}");
}

/// Flips the phases of the known good indices once more: the index is then the same as before the
/// oracle.
#[test]
fn the_oracle_turns_the_signs_of_the_good_ids_and_no_others() {
    let folder = folder();
    let scene = written(&wall(), &[]);
    let machine = OracleMachine::fixed(oracle(&scene), 7, true);
    let traced = paths(&machine, &[[1, 1]]).unwrap();
    for (channel, name) in CHANNELS.into_iter().enumerate() {
        let (circuit, _) = exported(&folder, &format!("--pixel 1,1 --seed 7 --channel {name}"));
        assert!(circuit.outcome.is_empty());
        let id = [circuit.register("path"), circuit.register("comparator")].concat();
        let mut machine = Sparse::new(circuit.qubits);
        let mut run = |gate| machine.gate(gate).unwrap();
        for qubit in &id {
            run(QuantumGate::H(*qubit));
        }
        circuit.run(&mut machine);
        let mut run = |gate| machine.gate(gate).unwrap();
        let mut good = 0;
        for (path, count) in traced.good[channel].iter().enumerate() {
            for comparator in 0..*count as usize {
                good += 1;
                let value = path | comparator << 3;
                let zeros = id.iter().enumerate();
                let zeros: Vec<u32> = zeros
                    .filter(|(bit, _)| value >> bit & 1 == 0)
                    .map(|(_, qubit)| *qubit)
                    .collect();
                for qubit in &zeros {
                    run(QuantumGate::X(*qubit));
                }
                run(QuantumGate::Phase {
                    turns: Turns::HALF,
                    on: &id,
                });
                for qubit in &zeros {
                    run(QuantumGate::X(*qubit));
                }
            }
        }
        for qubit in &id {
            run(QuantumGate::H(*qubit));
        }
        assert!(good > 2, "{good}");
        let all: Vec<u32> = (0..circuit.qubits).collect();
        let excited = machine.excited(&all).unwrap();
        assert!(excited < 1e-24, "{name}: {excited:e}");
    }
}

/// Compares sign by sign, the global phase included.
#[test]
fn the_iterate_is_the_circuits_own_amplitude_by_amplitude() {
    let oracle = PhaseOracle::table(3, |id| id % 3 == 1).unwrap();
    for conjunction in [Conjunction::Whole, Conjunction::Toffolis] {
        let counting = CountingCircuit::with(&oracle, 2, Window::Sine, conjunction).unwrap();
        for part in [
            CircuitPart::Oracle,
            CircuitPart::Grover,
            CircuitPart::Counting,
        ] {
            for format in [ExportFormat::OpenQasm3, ExportFormat::OpenQasm2] {
                let mut text = Vec::new();
                let export = Export::new(&counting, part, &[]).unwrap();
                let written = export.write(format, &[], &mut text);
                if part == CircuitPart::Counting && conjunction == Conjunction::Whole {
                    // A sign under four controls.
                    assert!(matches!(written, Err(ExportError::TooManyQubits(4))));
                    continue;
                }
                let tally = written.unwrap();
                let circuit = Circuit::read(&String::from_utf8(text).unwrap());
                assert_eq!(tally.qubits, export.qubits());
                assert_eq!(circuit.qubits, export.qubits());
                let mut direct = Dense::new(export.qubits()).unwrap();
                let mut read = Dense::new(export.qubits()).unwrap();
                // A different amplitude for every index: no symmetry hides a gate.
                for machine in [&mut direct, &mut read] {
                    let ids = if part == CircuitPart::Counting {
                        &[][..]
                    } else {
                        &[0.3, 1.1, 2.0]
                    };
                    for (target, angle) in ids.iter().enumerate() {
                        let target = target as u32;
                        let angle = *angle;
                        machine.gate(QuantumGate::Ry { angle, target }).unwrap();
                    }
                }
                counting.part(part, &mut |gate| direct.gate(gate)).unwrap();
                circuit.run(&mut read);
                // Qubits may have been renumbered: find the place of each in the text.
                let mut places = vec![0; circuit.qubits as usize];
                for register in export.registers() {
                    let places_of = circuit.register(&register.name);
                    for (qubit, place) in register.qubits.iter().zip(places_of) {
                        places[*qubit as usize] = place;
                    }
                }
                for state in 0..1_u64 << circuit.qubits {
                    let bits = places.iter().enumerate();
                    let there = bits
                        .map(|(qubit, place)| (state >> qubit & 1) << place)
                        .sum();
                    let off = (direct.amplitude(state) - read.amplitude(there)).norm();
                    assert!(off < 1e-14, "{part:?} {format:?} {state}: {off:e}");
                }
            }
        }
    }
}

/// In the upper half an X sets the comparator's top bit where the whole has a Hadamard.
#[test]
fn a_stratum_has_an_x_where_the_whole_has_a_hadamard() {
    let folder = folder();
    let (_, whole) = exported(&folder, "--part counting");
    let (circuit, upper) = exported(&folder, "--part counting --stratum 1/2");
    assert_eq!(whole["stratum"], Value::Null);
    assert_eq!(
        upper["stratum"],
        serde_json::json!({ "thresholds": [2, 4] })
    );
    assert_eq!(upper["registers"][1], whole["registers"][1]);
    let gates = |answer: &Value, name: &str| answer["gates"][name].as_u64().unwrap();
    // One at the beginning, and two in each of seven iterates.
    assert_eq!(gates(&upper, "h") + 1 + 2 * 7, gates(&whole, "h"));
    // The reflections have one X less for each such Hadamard, and the beginning has one more.
    assert_eq!(gates(&upper, "x") + 2 * 7, gates(&whole, "x") + 1);
    assert_eq!(circuit.tally().get("x").copied(), Some(gates(&upper, "x")));
    for (arguments, why) in [
        ("--stratum 0/2", "the oracle is the same for all strata"),
        ("--part grover --stratum 0/9", "at most 3 strata"),
        ("--part grover --stratum 2/2", "K from 0 to N - 1"),
    ] {
        let all = format!("export wall.yaml -o no.qasm {arguments}");
        let output = folder.qrt(&words(&all));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(why), "{arguments}: {said}");
    }
}

#[test]
fn the_figures_are_those_of_the_file_and_of_the_inspected_circuit() {
    let folder = folder();
    let inspected = folder.works(&["inspect", "wall.yaml", "--pixel", "1,1", "--json"]);
    let inspected: Value = serde_json::from_str(&inspected).unwrap();
    for part in ["oracle", "grover", "counting"] {
        let (circuit, answer) = exported(&folder, &format!("--part {part}"));
        assert_eq!(answer["version"], 1);
        assert_eq!(answer["part"], part);
        assert_eq!(answer["format"], "openqasm3");
        assert_eq!(answer["scene_hash"], inspected["scene_hash"]);
        assert_eq!(answer["channel"], inspected["channel"]);
        assert_eq!(answer["pixel"], serde_json::json!([1, 1]));
        assert_eq!(answer["bytes"], folder.read("wall.qasm").len());
        assert_eq!(answer["gates"], serde_json::json!(circuit.tally()));
        assert_eq!(answer["qubits"], circuit.qubits);
        let registers: Vec<Value> = circuit
            .registers
            .iter()
            .map(|(name, qubits)| serde_json::json!({ "name": name, "width": qubits.len() }))
            .collect();
        assert_eq!(answer["registers"], serde_json::json!(registers));
        let end = circuit.comments.last().unwrap();
        assert!(end.contains(" qubits, ") && end.contains(" ccx"), "{end}");
        let first = &circuit.comments[0];
        let channel = answer["channel"].as_str().unwrap();
        let about = format!(": lit-wall, {part} of channel {channel}, pixel 1,1 alone, seed 0");
        assert!(first.ends_with(&about), "{first}");
        if part == "oracle" {
            assert_eq!(answer["qubits"], inspected["qubits"]["peak"]);
            assert_eq!(answer["gates"]["ccx"], inspected["gates"]["toffoli"]);
            assert_eq!(answer["queries"], 1);
            assert!(answer["window"].is_null());
        }
    }
}

#[test]
fn the_window_is_the_estimators() {
    let folder = folder();
    for (estimator, window) in [
        ("paper", "rect"),
        ("qss", "rect"),
        ("sine", "sine"),
        ("adaptive-bayes", "sine"),
    ] {
        let arguments = format!(
            "--part counting --set counting.phase_bits=2 --set counting.estimator={estimator}"
        );
        let (circuit, answer) = exported(&folder, &arguments);
        assert_eq!(answer["window"], window, "{estimator}");
        assert_eq!(
            circuit.register("bond").len(),
            usize::from(window == "sine")
        );
    }
}

/// Checks that the circuit is that of the chosen parameters, and that the plan is printed beside it.
#[test]
fn an_asked_accuracy_chooses_the_circuit() {
    let scene = include_str!("../../examples/lit-wall.yaml").replace("path_bits: 5, ", "");
    let kept = scene
        .lines()
        .filter(|line| !line.starts_with("precision") && !line.starts_with("comparator"));
    let mut text: String = kept.flat_map(|line| [line, "\n"]).collect();
    text += "accuracy: { error: 0.3, confidence: 0.8 }\n";
    let folder = Folder::with("wall.yaml", &text);
    let (circuit, answer) = exported(&folder, "");
    let plan = &answer["plan"];
    // The plan is of the oracle that serves all pixels; the circuit has its pixel built in.
    let number = |value: &Value| value.as_u64().unwrap();
    assert!(number(&plan["toffoli"]) > number(&answer["gates"]["ccx"]));
    assert!(number(&plan["qubits"]) > number(&answer["qubits"]));
    assert_eq!(plan["path_bits"], circuit.register("path").len());
    assert_eq!(
        plan["comparator_bits"],
        circuit.register("comparator").len()
    );
    let (_, plain) = exported(&self::folder(), "");
    assert!(plain["plan"].is_null());
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_no_file() {
    use crate::common::command::signalled;
    let folder = folder();
    // The export would write 30 GB if it were not stopped.
    let long =
        "export wall.yaml --part counting --set counting.phase_bits=15 --max-gates 2000000000";
    let mut child = folder.started(&words(long));
    let partial = || {
        folder
            .names()
            .iter()
            .any(|name| name.ends_with(".qrt-partial"))
    };
    while !partial() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let (code, _, errors) = signalled(child, "-INT");
    assert_eq!(code, Some(1));
    assert!(errors.contains("error: interrupted"), "{errors}");
    assert_eq!(folder.names(), ["wall.yaml"]);
}

#[test]
fn standard_output_has_the_files_bytes() {
    let folder = folder();
    let summary = folder.works(&["export", "wall.yaml"]);
    assert_eq!(folder.names(), ["wall.qasm", "wall.yaml"]);
    let words = [
        "wall.qasm: oracle of channel r, pixel 1,1 alone; ",
        " ccx",
        " kB\n",
    ];
    assert!(words.iter().all(|word| summary.contains(word)), "{summary}");
    let output = folder.qrt(&["export", "wall.yaml", "-o", "-"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stdout, folder.read("wall.qasm"));
    let note = String::from_utf8(output.stderr).unwrap();
    assert!(
        note.starts_with("note: standard output: oracle of channel r"),
        "{note}"
    );
}

#[test]
fn what_cannot_be_exported_is_said_and_nothing_is_written() {
    let folder = folder();
    for (arguments, words) in [
        (
            &["--pixel", "3,0"][..],
            "there is no pixel 3,0 on a film of 2 x 2: x is in 0..=1, y in 0..=1",
        ),
        (&["--pixel", "0,2"], "there is no pixel 0,2"),
        (&["--pixel", "3"], "two whole numbers, such as 10,20"),
        (&["--pixel", "-1,0"], "two whole numbers, such as 10,20"),
        (&["--format", "qir"], "openqasm3"),
        (&["--part", "all"], "counting"),
        (&["--json", "-o", "-"], "name a file for the circuit"),
        (&["-o", "wall.yaml"], "used for two different things"),
        (&["--set", "precision.fraction=99"], "precision"),
        (&["--set", "budget={ qubits: 10 }"], "QRT06"),
        (&["--max-gates", "100"], "are more than --max-gates 100\n"),
        (
            &["--part", "counting", "--max-gates", "100"],
            "; one iterate alone has 20,",
        ),
        (
            &["--part", "counting", "--set", "counting.phase_bits=40"],
            "; `--set counting.phase_bits=",
        ),
    ] {
        let error = folder.fails(2, &[&["export", "wall.yaml"], arguments].concat());
        assert!(error.contains(words), "{arguments:?}: {error}");
        assert_eq!(folder.names(), ["wall.yaml"], "{arguments:?}");
    }
    let error = folder.fails(1, &["export", "wall.yaml", "-o", "none/wall.qasm"]);
    assert!(error.contains("there is no folder `none`"), "{error}");
    assert_eq!(
        fs::read_to_string(folder.path("wall.yaml")).unwrap(),
        wall()
    );
}

/// Follows the advice of the refusal.
#[test]
fn the_advised_register_is_short_enough_and_the_next_is_not() {
    let folder = folder();
    let (_, answer) = exported(&folder, "--part grover");
    let gates: u64 = answer["gates"]
        .as_object()
        .unwrap()
        .values()
        .map(|n| n.as_u64().unwrap())
        .sum();
    let run = |most: u64, bits: u32| {
        format!(
            "export wall.yaml --part counting --max-gates {most} --set counting.phase_bits={bits}"
        )
    };
    let most = 10 * gates;
    let error = folder.fails(2, &words(&run(most, 5)));
    assert!(error.contains("counting.phase_bits=3`"), "{error}");
    folder.works(&words(&run(most, 3)));
    folder.fails(2, &words(&run(most, 4)));
    // The limit is exact to the last gate.
    let said = error.split(" gates").next().unwrap();
    let all: String = said.chars().filter(char::is_ascii_digit).collect();
    let all: u64 = all.parse().unwrap();
    folder.works(&words(&run(all, 5)));
    let error = folder.fails(2, &words(&run(all - 1, 5)));
    assert!(error.contains("counting.phase_bits=4`"), "{error}");
}

#[test]
fn an_export_can_be_stopped_and_tells_how_far_it_is() {
    let oracle = PhaseOracle::table(6, |id| id % 5 == 0).unwrap();
    let counting = CountingCircuit::with(&oracle, 10, Window::Rect, Conjunction::Toffolis).unwrap();
    let export = Export::new(&counting, CircuitPart::Counting, &[("path", 4)]).unwrap();
    assert!(export.gates() > 1 << 17);
    let seen = std::cell::Cell::new(0);
    let progress = |gates| seen.set(seen.get() + gates);
    let cancel = AtomicBool::new(false);
    let told = export.with_cancel(&cancel).with_progress(&progress);
    let tally = told
        .write(
            ExportFormat::OpenQasm3,
            &["a\u{e9}\nb".to_owned()],
            &mut std::io::sink(),
        )
        .unwrap();
    assert!(seen.get() > 1 << 16 && seen.get() <= tally.gates());
    let cancel = AtomicBool::new(true);
    let stopped = told.with_cancel(&cancel);
    let stopped = stopped.write(ExportFormat::OpenQasm3, &[], &mut std::io::sink());
    assert!(matches!(stopped, Err(ExportError::Interrupted)));
}

#[test]
fn comments_stay_on_their_lines() {
    let oracle = PhaseOracle::table(2, |id| id == 2).unwrap();
    let counting = CountingCircuit::new(&oracle, 1, Window::Rect).unwrap();
    let export = Export::new(
        &counting,
        CircuitPart::Oracle,
        &[("path", 1), ("comparator", 1)],
    )
    .unwrap();
    let mut text = Vec::new();
    let comments = ["caf\u{e9}\nx work[0];".to_owned()];
    export
        .write(ExportFormat::OpenQasm2, &comments, &mut text)
        .unwrap();
    let circuit = Circuit::read(&String::from_utf8(text).unwrap());
    assert_eq!(circuit.comments[0], "caf\\u{e9}\\nx work[0];");
    let names: Vec<&str> = circuit.registers.iter().map(|(name, _)| &**name).collect();
    assert_eq!(names, ["path", "comparator", "work"]);
    let refused = Export::new(&counting, CircuitPart::Oracle, &[("path", 3)]).unwrap_err();
    assert_eq!(refused.to_string(), "parts of 3 bits in an index of 2");
}

/// Reads the circuit back and runs it: its outcomes are those that `qrt simulate` measures, with the table of the
/// pixel's own paths and with another.
#[test]
fn the_mean_phase_circuit_measures_what_theory_says() {
    let folder = folder();
    for table in ["", "--slope 1.3 --reference 0.2"] {
        let asked = format!("--pixel 1,1 --channel g --seed 3 {table}");
        let (circuit, answer) =
            exported(&folder, &format!("--part mean-phase --iterates 2 {asked}"));
        assert_eq!(answer["part"], "mean-phase");
        assert_eq!(answer["queries"], 3);
        let simulate = format!("simulate wall.yaml --mean-phase 2 --json {asked}");
        let simulated: Value = serde_json::from_str(&folder.works(&words(&simulate))).unwrap();
        let mean_phase = &answer["mean_phase"];
        assert_eq!(mean_phase["iterates"], 2);
        for key in ["slope", "reference"] {
            assert_eq!(mean_phase[key], simulated[key], "{key}");
        }
        let mut machine = Sparse::new(circuit.qubits);
        circuit.run(&mut machine);
        let found = machine.distribution(&circuit.outcome).unwrap();
        let levels = simulated["levels"].as_array().unwrap();
        for bit in [0, 1] {
            // Paths of one level are measured equally often.
            let mut of_paths: Vec<f64> = found.iter().skip(bit).step_by(2).copied().collect();
            let mut expected: Vec<f64> = Vec::new();
            for level in levels {
                let paths = level["paths"].as_u64().unwrap() as usize;
                let each = level["simulated"][bit].as_f64().unwrap() / paths as f64;
                expected.extend(std::iter::repeat_n(each, paths));
            }
            of_paths.sort_by(f64::total_cmp);
            expected.sort_by(f64::total_cmp);
            assert!(off(&of_paths, &expected) < 1e-12, "sign {bit}");
        }
    }
    for (arguments, says) in [
        ("--iterates 2", "--part mean-phase"),
        ("--part grover --slope 1", "--part mean-phase"),
        (
            "--part mean-phase --stratum 0/2",
            "--part grover or counting",
        ),
        ("--part mean-phase --slope 0", "a slope is a positive"),
        ("--part mean-phase --slope inf", "a slope is a positive"),
        ("--part mean-phase --reference 2", "a reference is a colour"),
        ("--format mitsuba --iterates 3", "--iterates"),
        ("--part mean-phase --set sampling.path_bits=30", "give both"),
        (
            "--part mean-phase --set comparator.bits=13",
            "lower `comparator.bits`",
        ),
        (
            "--part mean-phase --iterates 9000000",
            "makes it short enough",
        ),
    ] {
        let errors = folder.fails(2, &words(&format!("export wall.yaml {arguments}")));
        assert!(errors.contains(says), "{arguments}: {errors}");
    }
}
