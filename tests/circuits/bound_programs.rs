//! Tests of a scene's program with a pixel built in: it computes the same as the scene's oracle in that
//! pixel, on every machine, uncomputed, and as exported text.

use crate::common::scene::written;
use qrt::circuit::export::ExportFormat;
use qrt::circuit::{Contents, Gate, Op, Operand, RegisterId};
use qrt::core::oracle::{BoundProgram, Oracle, OracleOptions};
use qrt::runtime::path_machines::{OracleMachine, run_paths};
use std::collections::BTreeMap;
use std::sync::Arc;

const SEED: u64 = 5;

/// Returns scenes with narrow registers, and pixels of them.
fn scenes() -> [(Oracle, [[u32; 2]; 3]); 2] {
    let small = ["comparator.bits=4", "sampling.path_bits=5"];
    let of = |text: &str, more: &[&str]| {
        let scene = written(text, &[&small, more].concat());
        Oracle::rgb(&scene, OracleOptions::default()).unwrap()
    };
    // Pixels in a wall, at an edge, in the lamp; and scopes that are uncomputed and computed again.
    let blocks = include_str!("../scenes/blocks.yaml");
    let scoped = include_str!("../scenes/scoped.yaml");
    [
        (
            of(blocks, &["precision.fraction=8"]),
            [[2, 3], [9, 8], [11, 10]],
        ),
        (
            of(scoped, &["precision.fraction=8"]),
            [[0, 0], [3, 4], [7, 2]],
        ),
    ]
}

/// Returns the counts of the scene's own oracle in a pixel, by path and channel.
fn counted(machine: &OracleMachine, pixel: [u32; 2]) -> Vec<Vec<u64>> {
    let mut paths = Vec::new();
    let taken = machine.trace(&[pixel], 0..machine.paths(), |run| {
        for place in 0..run.good[0].len() {
            paths.push(run.good.map(|good| good[place].cast_unsigned()).to_vec());
        }
    });
    taken.unwrap();
    paths
}

#[test]
fn they_compute_what_the_scene_does_in_their_pixel() {
    let mut differ = false;
    for (oracle, pixels) in scenes() {
        let shared = Arc::new(oracle.clone());
        let fixed = OracleMachine::fixed(shared.clone(), SEED, false);
        let gates = OracleMachine::gates(shared, SEED, false).unwrap();
        for pixel in pixels {
            let bound = oracle.program_at(SEED, pixel);
            assert!(bound.parameters.is_empty());
            assert!(!bound.ops.iter().any(|op| matches!(op, Op::Load { .. })));
            let expected = counted(&fixed, pixel);
            assert_eq!(expected.len() as u64, bound.paths());
            differ |= expected.iter().any(|path| *path != expected[0]);
            assert_eq!(counted(&gates, pixel), expected);
            let all = 0..bound.paths();
            assert_eq!(
                run_paths::on_definition(&bound, all.clone()).unwrap(),
                expected
            );
            assert_eq!(run_paths::on_fixed(&bound, all.clone()).unwrap(), expected);
            assert_eq!(run_paths::on_gates(&bound, all).unwrap(), expected);
        }
    }
    assert!(differ, "every path has the same colour");
}

#[test]
fn their_inverses_leave_nothing() {
    for (oracle, pixels) in scenes() {
        let bound = oracle.program_at(SEED, pixels[1]);
        let inverse = bound.inverse();
        for path in 0..bound.paths() {
            let mut contents = Contents::new(&bound, &[path, 3], &[]);
            for instruction in &bound.instructions {
                contents.follow(&bound, *instruction).unwrap();
            }
            assert!(contents.registers.iter().filter(|bits| **bits != 0).count() > 2);
            for instruction in &inverse.instructions {
                contents.follow(&inverse, *instruction).unwrap();
            }
            let mut left = contents.registers.clone();
            left[oracle.id.index()] ^= path;
            left[oracle.comparator.index()] ^= 3;
            assert!(left.iter().all(|bits| *bits == 0), "path {path}");
        }
    }
}

/// Runs a text of X, CNOT and Toffoli on a path; returns the contents of all registers by name.
fn followed(text: &str, path: u64) -> BTreeMap<&str, u64> {
    let mut qubits: BTreeMap<&str, Vec<bool>> = BTreeMap::new();
    for line in text.lines().skip(2).filter(|line| !line.starts_with("//")) {
        let (word, rest) = line.trim_end_matches(';').split_once(' ').unwrap();
        if let Some(size) = word.strip_prefix("qubit[") {
            let size: usize = size.trim_end_matches(']').parse().unwrap();
            let bit = |place: usize| rest == "id" && path >> place & 1 == 1;
            qubits.insert(rest, (0..size).map(bit).collect());
            continue;
        }
        let on = rest.split(", ").map(|qubit| {
            let (name, place) = qubit.split_once('[').unwrap();
            (name, place.trim_end_matches(']').parse::<usize>().unwrap())
        });
        let on: Vec<(&str, usize)> = on.collect();
        let controls = ["x", "cx", "ccx"].iter().position(|known| *known == word);
        assert_eq!(
            controls.map(|controls| controls + 1),
            Some(on.len()),
            "{line}"
        );
        let (&(name, place), controls) = on.split_last().unwrap();
        if controls.iter().all(|&(name, place)| qubits[name][place]) {
            qubits.get_mut(name).unwrap()[place] ^= true;
        }
    }
    let number = |bits: Vec<bool>| {
        let places = bits.iter().take(64).enumerate();
        places.map(|(place, &bit)| u64::from(bit) << place).sum()
    };
    qubits
        .into_iter()
        .map(|(name, bits)| (name, number(bits)))
        .collect()
}

fn written_as_text(bound: &BoundProgram) -> String {
    let mut text = Vec::new();
    let tally = bound.write(ExportFormat::OpenQasm3, &mut text).unwrap();
    let mut gates = 0;
    bound.each_gate(|gate| {
        assert!(!matches!(gate, Gate::Load { .. }));
        gates += 1;
    });
    assert_eq!(tally.gates(), gates);
    assert_eq!(bound.circuit().gates.len() as u64, gates);
    String::from_utf8(text).unwrap()
}

#[test]
fn their_texts_say_the_same() {
    let [(oracle, pixels), _] = scenes();
    for pixel in pixels {
        let bound = oracle.program_at(SEED, pixel);
        let text = written_as_text(&bound);
        let about = format!("// pixel {}, {}; seed {SEED}\n", pixel[0], pixel[1]);
        assert!(text.contains(&about));
        let expected = run_paths::on_fixed(&bound, 0..bound.paths()).unwrap();
        for (path, expected) in (0..).zip(&expected).step_by(7) {
            let contents = followed(&text, path);
            let mut registers = vec![0; bound.registers.len()];
            for channel in &oracle.channels {
                if let Operand::Word(word) = channel.count {
                    let RegisterId(id) = word.register;
                    let name = &bound.registers[id as usize].name;
                    registers[id as usize] = contents[name.replace(['.', '\''], "_").as_str()];
                }
            }
            assert_eq!(
                &bound.good(&registers),
                expected,
                "path {path} of {pixel:?}"
            );
        }
    }
}
