//! Tests that the machines' shortcut equals the whole oracle.
//!
//! Machines run compute and uncompute once per path, and the comparison apart: the number of a path's
//! good indices is then known without trying its comparators. Here all of it runs as one circuit on
//! every basis state (index, comparator).

use super::paths::{CORNER, inputs, number, oracle, paths};
use crate::common::scene::written;
use qrt::circuit::lower;
use qrt::core::oracle::Oracle;
use qrt::machines::{GatesMachine, PixelLanes, contents_by_definition};
use qrt::runtime::path_machines::OracleMachine;
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;

const SEED: u64 = 11;

/// Returns S of `pixels` by channel, counted from signs of the whole circuit.
fn whole(scene: &ValidScene, oracle: &Oracle, pixels: &[[u32; 2]]) -> Vec<[u64; 3]> {
    let comparators = 1_u64 << oracle.comparator_bits();
    let paths = 1_u64 << oracle.points.path_bits();
    let states: Vec<(u64, u64)> = (0..paths)
        .flat_map(|id| (0..comparators).map(move |y| (id, y)))
        .collect();
    let at = scene.scene().comparator.at;
    let mut good = vec![[0; 3]; pixels.len()];
    #[allow(clippy::needless_range_loop)] // A channel's number, not a place alone.
    for c in 0..3 {
        let circuit = lower::circuit(&oracle.whole(c));
        let machine = GatesMachine::new(&[&circuit]).unwrap();
        assert!(states.len() <= machine.lanes());
        let qubits = |register| {
            let mut inputs = circuit.inputs.iter();
            let found = inputs.find(|(id, _)| *id == register);
            found.unwrap().1.clone()
        };
        let (id, comparator) = (qubits(oracle.id), qubits(oracle.comparator));
        let held = [&id[..], &comparator].concat();
        for (place, pixel) in pixels.iter().enumerate() {
            let words = oracle.parameter_words(SEED, *pixel);
            let mut rows = machine.rows();
            let values = |of: fn(&(u64, u64)) -> u64| states.iter().map(of).collect::<Vec<_>>();
            let (ids, thresholds) = (values(|s| s.0), values(|s| s.1));
            rows.set(&id, &ids);
            rows.set(&comparator, &thresholds);
            rows.set_parameters(&[PixelLanes {
                lanes: states.len(),
                parameters: &words,
            }]);
            machine.run(0, &mut rows);
            assert_eq!(rows.dirty(&held, states.len()), None);
            let mut after = vec![0; states.len()];
            rows.get(&id, &mut after);
            assert_eq!(after, ids);
            rows.get(&comparator, &mut after);
            assert_eq!(after, thresholds);
            for (lane, (id, y)) in states.iter().enumerate() {
                let turned = rows.signs()[lane / 64] >> (lane % 64) & 1 == 1;
                let held = contents_by_definition(&oracle.program, &inputs(oracle, *id), &words);
                let colour = number(oracle.channels[c].colour, &held.registers);
                let count = number(oracle.channels[c].count, &held.registers);
                // Flipped where y < count, ...
                assert_eq!(
                    turned,
                    i128::from(*y) < i128::from(count),
                    "{id} {y} {count}"
                );
                // ... which is where the colour exceeds the threshold, (y + 1/2) / 2^c or y / 2^c.
                let half = u64::from(at == qrt::scene::ComparatorAt::Midpoints);
                let threshold = (2 * y + half) as f64 / (2 * comparators) as f64;
                let exceeds = colour as f64 / (1_u64 << oracle.fraction) as f64 > threshold;
                assert_eq!(turned, exceeds, "{id} {y} {colour}");
                good[place][c] += u64::from(turned);
            }
        }
    }
    good
}

fn is_exact(sets: &[&str]) {
    let scene = written(CORNER, sets);
    let oracle = oracle(&scene);
    let pixels = [[1, 1], [3, 2], [1, 2]];
    let good = whole(&scene, &oracle, &pixels);
    // Some indices are flipped, and some are not.
    let ids = 1 << (oracle.points.path_bits() + oracle.comparator_bits());
    for c in 0..3 {
        assert!(good.iter().any(|good| (1..ids).contains(&good[c])));
    }
    let machines = [
        OracleMachine::fixed(oracle.clone(), SEED, true),
        OracleMachine::gates(oracle.clone(), SEED, true).unwrap(),
    ];
    for machine in &machines {
        let traced = paths(machine, &pixels).unwrap();
        for (place, expected) in good.iter().enumerate() {
            let one = machine.paths() as usize;
            let sum = |c: usize| traced.good[c][place * one..][..one].iter().sum::<i64>();
            assert_eq!([0, 1, 2].map(|c| sum(c) as u64), *expected);
        }
    }
    for model in [Model::Fixed, Model::Gates] {
        let options = RenderOptions {
            seed: SEED,
            model: Some(model),
            estimator: Some(Estimator::Exact),
            ..RenderOptions::default()
        };
        let picture = render(&scene, &options).unwrap();
        assert_eq!(picture.ids, ids);
        let counted = picture.good().unwrap();
        for ([x, y], expected) in pixels.iter().zip(&good) {
            assert_eq!(counted[(y * 4 + x) as usize], *expected);
        }
    }
}

#[test]
fn with_thresholds_at_midpoints() {
    is_exact(&["comparator.at=midpoints"]);
}

#[test]
fn with_thresholds_at_edges() {
    is_exact(&["comparator.at=edges"]);
}

#[test]
fn with_scratch_returned_early() {
    is_exact(&["circuit.uncompute=scoped"]);
}

#[test]
fn with_the_papers_records() {
    is_exact(&["circuit.nearest=paper"]);
}

/// Tests one threshold for each colour, and more.
#[test]
fn with_fine_thresholds() {
    for bits in ["comparator.bits=6", "comparator.bits=8"] {
        is_exact(&[bits, "precision.fraction=6", "sampling.path_bits=3"]);
    }
}
