//! Tests that the circuit computes the same as the integers: in every example scene, on every path of
//! every pixel, bit for bit, with every ancilla returned to zero (the gates machine refuses any other
//! circuit), for each way to find the nearest face. The time of uncomputation changes no path.

use super::paths::{Paths, film, oracle, paths};
use crate::common::scene::from_file;
use qrt::circuit::Gate;
use qrt::runtime::path_machines::OracleMachine;

/// A film of 8 x 8 pixels with 2^4 paths each.
const FILM: [&str; 3] = ["film.width=8", "film.height=8", "sampling.path_bits=4"];

/// Overrides for short numbers, whose circuit is built quickly.
const SHORT: [&str; 2] = ["precision.fraction=8", "comparator.bits=6"];

/// Compares the models with numbers and comparators of the scene's own width.
fn agrees_at_full_width(file: &str, sets: &[&str]) {
    let oracle = oracle(&from_file(file, &[&FILM[..], sets].concat()));
    let pixels = film(&oracle);
    let fixed = paths(&OracleMachine::fixed(oracle.clone(), 5, true), &pixels).unwrap();
    let gates = OracleMachine::gates(oracle, 5, true);
    let gates = gates.unwrap_or_else(|defect| panic!("{file}: {defect}"));
    let traced = paths(&gates, &pixels);
    let traced = traced.unwrap_or_else(|defect| panic!("{file}: {defect}"));
    assert!(traced == fixed, "{file}: the models differ");
}

fn agrees(file: &str, sets: &[&str]) {
    let mut lit = Vec::new();
    for nearest in ["running", "paper"] {
        let mut known: Option<Paths> = None;
        for uncompute in ["keep", "scoped"] {
            let circuit = format!("circuit={{ uncompute: {uncompute}, nearest: {nearest} }}");
            let scene = from_file(file, &[&FILM[..], &SHORT, sets, &[&circuit]].concat());
            let oracle = oracle(&scene);
            let pixels = film(&oracle);
            let fixed = OracleMachine::fixed(oracle.clone(), 7, true);
            let fixed = paths(&fixed, &pixels).unwrap();
            let gates = OracleMachine::gates(oracle, 7, true);
            let gates = gates.unwrap_or_else(|defect| panic!("{file}, {circuit}: {defect}"));
            let traced = paths(&gates, &pixels);
            let traced = traced.unwrap_or_else(|defect| panic!("{file}, {circuit}: {defect}"));
            assert!(traced == fixed, "{file}, {circuit}: the models differ");
            let compute = &gates.parts().unwrap().compute.gates;
            assert!(compute.iter().any(|gate| matches!(gate, Gate::Ccx(..))));
            let known = known.get_or_insert_with(|| fixed.clone());
            assert!(*known == fixed, "{file}: {circuit} changes a path");
        }
        let paths = known.unwrap();
        assert_eq!(paths.good[0].len(), 64 << 4);
        lit.push(
            paths.colours[0]
                .iter()
                .filter(|colour| **colour > 0)
                .count(),
        );
    }
    // Black pictures would agree trivially.
    let paths = 64 << 4;
    assert!(
        lit.iter().all(|lit| *lit > 10),
        "{file}: of {paths} paths, {lit:?} are lit"
    );
}

#[test]
fn of_the_cornell_box() {
    agrees("scenes-yaml/cornell-box.yaml", &[]);
}

/// Samples lamps, alone and beside rays that meet one.
#[test]
fn of_sampled_lamps() {
    let depth = "{ bits: [5, 5], light: [4, 4] }";
    let depths = format!("sampling.depths=[{{ bits: [6, 6] }}, {depth}, {depth}]");
    for lights in ["sampling.lights=auto", "sampling.lights=mis"] {
        agrees("scenes-yaml/cornell-box.yaml", &[&depths, lights]);
    }
    // Materials that need angles; a lamp of two faces, one of them a triangle.
    agrees("tests/good_scenes/lamps.yaml", &[]);
}

#[test]
fn of_the_cornell_box_with_a_mirror() {
    agrees("scenes-yaml/cornell-mirror.yaml", &[]);
}

#[test]
fn of_the_cornell_box_with_glass() {
    agrees("scenes-yaml/cornell-glass.yaml", &[]);
}

#[test]
fn of_the_cornell_box_with_copper_and_plastic() {
    agrees("scenes-yaml/cornell-ggx.yaml", &[]);
}

#[test]
fn of_the_floor_under_a_light() {
    agrees("scenes-yaml/floor-and-light.yaml", &[]);
}

#[test]
fn of_the_furnace() {
    agrees("scenes-yaml/furnace.yaml", &[]);
}

/// Replaces a mesh of 1,536 faces by four faces.
const MESH: [&str; 1] = ["geometry[2].mesh.obj=../tests/good_scenes/tetrahedron.obj"];

/// Replaces stools of 42 faces by four faces each.
const STOOLS: [&str; 2] = [
    "geometry[3].mesh.obj=../tests/good_scenes/tetrahedron.obj",
    "geometry[4].mesh.obj=../tests/good_scenes/tetrahedron.obj",
];

#[test]
fn of_the_mesh() {
    agrees("scenes-yaml/knot.yaml", &MESH);
}

#[test]
fn of_smooth_meshes() {
    // The normals of its corners are as far from those of its faces as they may be.
    agrees(
        "scenes-yaml/knot.yaml",
        &[MESH[0], "geometry[2].mesh.smooth=180"],
    );
    let [first, second] = STOOLS;
    let smooth = "geometry[3].mesh.smooth=180";
    agrees("scenes-yaml/velvet.yaml", &[first, second, smooth]);
}

#[test]
fn of_coloured_meshes() {
    let sets = [
        "geometry[2].mesh.obj=../tests/good_scenes/coloured.obj",
        "geometry[2].mesh.colors=vertices",
    ];
    agrees("scenes-yaml/knot.yaml", &sets);
    agrees(
        "scenes-yaml/knot.yaml",
        &[sets[0], sets[1], "geometry[2].mesh.smooth=180"],
    );
}

#[test]
fn of_a_bsdf_of_ones_own() {
    agrees("scenes-yaml/velvet.yaml", &STOOLS);
}

#[test]
fn of_the_cornell_box_at_full_width() {
    agrees_at_full_width("scenes-yaml/cornell-box.yaml", &[]);
}

#[test]
#[ignore = "a minute: wider numbers in the circuits that are compared above"]
fn of_every_other_scene_at_full_width() {
    for (file, sets) in [
        ("scenes-yaml/cornell-mirror.yaml", &[][..]),
        ("scenes-yaml/cornell-glass.yaml", &[]),
        ("scenes-yaml/cornell-ggx.yaml", &[]),
        ("scenes-yaml/floor-and-light.yaml", &[]),
        ("scenes-yaml/furnace.yaml", &[]),
        ("scenes-yaml/knot.yaml", &MESH),
        ("scenes-yaml/velvet.yaml", &STOOLS),
        ("tests/scenes/box.yaml", &[LATTICE]),
    ] {
        agrees_at_full_width(file, sets);
    }
}

/// Overrides for path indices that are the coordinates themselves, side by side.
const LATTICE: &str = "sampling={ sequence: product-lattice, path_bits: 4, \
                       depths: [{ bits: [1, 1] }, { bits: [1, 1] }] }";

#[test]
fn of_the_product_lattice() {
    agrees("tests/scenes/box.yaml", &[LATTICE]);
}
