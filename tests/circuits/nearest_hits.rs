//! Tests that the oracle of nearest hits marks the faces of textbook geometry, the same on integers and
//! gate by gate, and that Grover's iterate on it gives the probabilities of theory.

use super::rays::{Meeting, meetings};
use crate::common::scene::{from_file, written};
use qrt::circuit::lower;
use qrt::core::oracle::NearestOracle;
use qrt::counting::random::Stream;
use qrt::runtime::path_machines::{Answers, Candidate, NearestMachine, NearestQuery};
use qrt::runtime::search::marked_probability;
use qrt::scene::valid::ValidScene;
use qrt::tracer::{PixelClass, Stage};
use std::sync::Arc;

const SEED: u64 = 11;

fn oracle(scene: &ValidScene) -> Arc<NearestOracle> {
    Arc::new(NearestOracle::new(scene).unwrap().unwrap())
}

/// Returns `count` random paths all over the film.
fn some_rays(scene: &ValidScene, count: u64) -> Vec<NearestQuery> {
    let film = scene.scene().film;
    let mut stream = Stream::new(1, 0, 0, 0);
    let mut below = |bound: u32| (stream.uniform() * f64::from(bound)) as u32;
    let paths = 1 << scene.scene().sampling.path_bits;
    (0..count)
        .map(|_| NearestQuery {
            pixel: [below(film.width), below(film.height)],
            id: u64::from(below(paths)),
            best: None,
        })
        .collect()
}

/// Returns the tolerances of a distance and of a place, in stage units.
fn tolerance(oracle: &NearestOracle, met: &Meeting) -> [f64; 2] {
    let ulp = 1.0 / f64::from(1_u32 << oracle.fraction);
    let distance = ulp * (2.0 + 4.0 * met.distance.abs()) * (1.0 + 1.0 / met.slope);
    [
        distance,
        met.length * distance + 4.0 * ulp * (1.0 + met.distance.abs()),
    ]
}

/// Compares every face and many rays with textbook geometry, unless rounding may decide; at most the
/// fraction `doubt` of the meetings may be left out in this way.
fn marks_what_is_met(scene: &ValidScene, count: u64, doubt: f64) {
    let oracle = oracle(scene);
    let machine = NearestMachine::fixed(oracle.clone(), SEED);
    let rays = some_rays(scene, count);
    let mut answers = Answers::default();
    machine.ask(&rays, &mut answers).unwrap();
    let scale = Stage::rgb(scene, PixelClass::MayMeetLamp).geometry().scale;
    let units = f64::from(1_u32 << oracle.fraction);
    let (mut met, mut missed, mut doubtful) = (0_u64, 0_u64, 0_u64);
    for (place, ray) in rays.iter().enumerate() {
        let all = meetings(scene, scale, SEED, ray.pixel, ray.id);
        let marks = answers.marks(place);
        for (number, &mark) in marks.iter().enumerate() {
            let Some(&label) = oracle
                .labels
                .get(number)
                .filter(|_| number < oracle.faces())
            else {
                assert!(!mark, "{ray:?} meets number {number} of {}", oracle.faces());
                continue;
            };
            let meeting = all[label as usize];
            if meeting.slope < 1e-9 {
                assert!(!mark, "{ray:?} runs along face {label}");
                continue;
            }
            let [far, wide] = tolerance(&oracle, &meeting);
            let reached = meeting.distance;
            // Rounding may decide near the plane or near an edge.
            if reached.abs() <= far || meeting.margin.abs() <= wide {
                doubtful += 1;
                continue;
            }
            let should = reached > 0.0 && meeting.margin > 0.0;
            assert_eq!(mark, should, "{ray:?}, face {label}: {meeting:?}");
            if mark {
                let distance = answers.distances(place)[number] as f64 / units;
                assert!(
                    (distance - reached).abs() <= far,
                    "{ray:?}, face {label}: {distance} instead of {meeting:?}"
                );
                met += 1;
            } else {
                missed += 1;
            }
        }
    }
    println!("{met} met, {missed} missed, {doubtful} doubtful");
    assert!(met >= count / 2 && missed >= count / 2);
    assert!(
        doubtful as f64 <= doubt * (met + missed) as f64,
        "{doubtful} of {met}, {missed}"
    );
}

#[test]
fn faces_are_marked_that_textbook_geometry_says_are_met() {
    let cornell = from_file("scenes-yaml/cornell-box.yaml", &[]);
    marks_what_is_met(&cornell, 3000, 0.01);
    let blocks = from_file("tests/scenes/blocks.yaml", &[]);
    marks_what_is_met(&blocks, 3000, 0.01);
    let knot = from_file("scenes-yaml/knot.yaml", &["precision.fraction=20"]);
    marks_what_is_met(&knot, 60, 0.02);
}

/// Discs along the axes and slanted, among quads.
const DISCS: &str = "
name: discs
camera: { perspective: { eye: [0.3, 0.2, 3], target: [0, 0.1, 0], vfov: 50 } }
film: { width: 4, height: 4 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry:
  - disc: { center: [0.2, 0.1, 0], normal: [0, 0, 1], radius: 0.8, material: grey }
  - quad: { vertices: [[-1, -1, -0.5], [1, -1, -0.5], [1, 1, -0.5], [-1, 1, -0.5]], material: grey }
  - disc: { center: [0.2, 0.1, -0.4], normal: [1, -2, 2], radius: 0.8, material: grey }
  - disc: { center: [-0.6, -0.5, 0.4], normal: [-0.3, 0.2, -1], radius: 0.25, material: grey }
  - disc: { center: [0, -0.7, 0], normal: [0, 1, 0], radius: 0.75, material: grey }
sampling: { path_bits: 6, depths: [{ bits: [5, 5] }] }
precision: { fraction: 14 }
";

#[test]
fn discs_are_marked_that_textbook_geometry_says_are_met() {
    marks_what_is_met(&written(DISCS, &[]), 3000, 0.01);
}

/// One triangle in front of a skewed perspective camera.
const ONE: &str = "
name: one
camera: { perspective: { eye: [0.3, 0.2, 2], target: [0, 0.1, 0], vfov: 50 } }
film: { width: 4, height: 4 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [triangle: { vertices: [[-1, -1, 0.1], [1, -0.8, 0], [0, 1, -0.3]], material: grey }]
sampling: { path_bits: 6, depths: [{ bits: [5, 5] }] }
precision: { fraction: 10 }
";

/// Faces that overlap in one plane, a copy of one of them, two that meet in an edge, and one
/// behind.
const OVERLAPS: &str = "
name: overlaps
camera: { perspective: { eye: [0.25, 0.125, 3], target: [0, 0, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry:
  - quad: { vertices: [[-1, -1, -0.5], [1, -1, -0.5], [1, 1, -0.5], [-1, 1, -0.5]], material: grey }
  - triangle: { vertices: [[-0.8, -0.8, 0], [0.9, -0.7, 0], [0, 0.9, 0]], material: grey }
  - quad: { vertices: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]], material: grey }
  - quad: { vertices: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]], material: grey }
  - triangle: { vertices: [[-0.5, 0.3, 0.4], [0.5, 0.3, 0.4], [0, -0.6, 0.1]], material: grey }
  - triangle: { vertices: [[0.5, 0.3, 0.4], [-0.5, 0.3, 0.4], [0, 0.9, 0.7]], material: grey }
sampling: { path_bits: 6, depths: [{ bits: [5, 5] }] }
precision: { fraction: 10 }
";

/// Returns the hits of a ray, by the marks of a search without a best hit so far.
fn met(answers: &Answers, ray: usize) -> Vec<Candidate> {
    let states = answers.marks(ray).iter().zip(answers.distances(ray));
    let met = states.zip(0..).filter(|((mark, _), _)| **mark);
    met.map(|((_, &distance), primitive)| Candidate {
        distance,
        primitive,
    })
    .collect()
}

/// Checks that both machines agree on every basis state, and mark the faces before the nearest so far:
/// nearer, or equally near and earlier in the list. The gates machine refuses a circuit that does not
/// return all qubits to their values.
fn marks_what_is_nearer(scene: &ValidScene, count: u64) {
    let oracle = oracle(scene);
    let fixed = NearestMachine::fixed(oracle.clone(), SEED);
    let gates = NearestMachine::gates(oracle.clone(), SEED).unwrap();
    let mut rays = some_rays(scene, count);
    let (mut all, mut nearer, mut by_gates) = <(Answers, Answers, Answers)>::default();
    fixed.ask(&rays, &mut all).unwrap();
    gates.ask(&rays, &mut by_gates).unwrap();
    let mut dice = Stream::new(2, 0, 0, 0);
    for (place, ray) in rays.iter_mut().enumerate() {
        assert_eq!(all.marks(place), by_gates.marks(place), "{ray:?}");
        assert_eq!(all.distances(place), by_gates.distances(place), "{ray:?}");
        let met = met(&all, place);
        // Choose one of the hits, the number next to it, or a distance next to it.
        let any = (dice.uniform() * met.len() as f64) as usize;
        ray.best = met.get(any).map(|best| match place % 4 {
            0 => Candidate {
                primitive: (best.primitive + 1) % oracle.states() as u32,
                ..*best
            },
            1 => Candidate {
                distance: best.distance + 1,
                ..*best
            },
            _ => *best,
        });
    }
    fixed.ask(&rays, &mut nearer).unwrap();
    gates.ask(&rays, &mut by_gates).unwrap();
    let (mut marked, mut not_marked) = (0, 0);
    for (place, ray) in rays.iter().enumerate() {
        let before = |met: &Candidate| ray.best.is_none_or(|best| *met < best);
        let should: Vec<Candidate> = met(&all, place).into_iter().filter(before).collect();
        assert_eq!(met(&nearer, place), should, "{ray:?}");
        assert_eq!(nearer.marks(place), by_gates.marks(place), "{ray:?}");
        marked += should.len();
        not_marked += met(&all, place).len() - should.len();
    }
    println!("{marked} nearer, {not_marked} not");
    assert!(marked > 0 && not_marked > 0);
}

#[test]
fn what_is_nearer_is_marked_on_integers_and_by_gates() {
    let short = ["precision.fraction=9"];
    let scoped = ["precision.fraction=9", "circuit.uncompute=scoped"];
    for sets in [short.as_slice(), &scoped] {
        marks_what_is_nearer(&from_file("tests/scenes/blocks.yaml", sets), 500);
        marks_what_is_nearer(&from_file("scenes-yaml/cornell-box.yaml", sets), 500);
    }
    marks_what_is_nearer(&written(OVERLAPS, &[]), 500);
    marks_what_is_nearer(&written(ONE, &[]), 500);
    // More numbers than one block of lanes holds.
    marks_what_is_nearer(&from_file("scenes-yaml/knot.yaml", &short), 12);
}

#[test]
fn a_face_that_rays_run_along_is_never_met() {
    let scene = written(
        "
name: edge-on
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 4 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [quad: { vertices: [[-1, 0, -1], [-1, 0, 3], [1, 0, 3], [1, 0, -1]], material: grey }]
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }] }
",
        &[],
    );
    let oracle = oracle(&scene);
    let rays = some_rays(&scene, 200);
    let mut answers = Answers::default();
    for machine in [
        NearestMachine::fixed(oracle.clone(), SEED),
        NearestMachine::gates(oracle.clone(), SEED).unwrap(),
    ] {
        machine.ask(&rays, &mut answers).unwrap();
        assert!((0..rays.len()).all(|place| met(&answers, place).is_empty()));
    }
}

#[test]
fn of_faces_in_one_plane_the_first_listed_is_nearest() {
    let scene = written(OVERLAPS, &[]);
    let oracle = oracle(&scene);
    // The copy can never be met.
    assert_eq!(oracle.faces(), 5);
    assert!(!oracle.labels.contains(&3));
    let machine = NearestMachine::fixed(oracle.clone(), SEED);
    let rays = some_rays(&scene, 500);
    let mut answers = Answers::default();
    machine.ask(&rays, &mut answers).unwrap();
    let mut ties = 0;
    for place in 0..rays.len() {
        let met = met(&answers, place);
        let of = |label: u32| {
            met.iter()
                .find(|met| oracle.labels[met.primitive as usize] == label)
        };
        if let (Some(triangle), Some(quad)) = (of(1), of(2)) {
            assert_eq!(triangle.distance, quad.distance);
            assert!(triangle < quad);
            ties += 1;
        }
    }
    assert!(ties > 20, "{ties}");
}

#[test]
fn faces_that_meet_leave_no_gap() {
    // Every ray through the middle of the big quad meets a face, although two triangles share an edge
    // across it: there are only these and the quad behind.
    let text = "
name: seam
camera: { perspective: { eye: [0.3, 0.1, 2], target: [0, 0, 0], vfov: 20 } }
film: { width: 8, height: 8 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry:
  - triangle: { vertices: [[-1.1, -1.3, 0.2], [1.2, -1, 0], [-0.9, 1.1, -0.3]], material: grey }
  - triangle: { vertices: [[1.2, -1, 0], [1, 1.4, 0.1], [-0.9, 1.1, -0.3]], material: grey }
sampling: { path_bits: 10, depths: [{ bits: [8, 8] }] }
precision: { fraction: 8 }
";
    let scene = written(text, &[]);
    let machine = NearestMachine::fixed(oracle(&scene), SEED);
    let rays = some_rays(&scene, 40_000);
    let mut answers = Answers::default();
    machine.ask(&rays, &mut answers).unwrap();
    let (mut both, mut one) = (0, 0);
    for (place, ray) in rays.iter().enumerate() {
        match met(&answers, place).len() {
            0 => panic!("{ray:?} falls through"),
            1 => one += 1,
            _ => both += 1,
        }
    }
    // The triangles overlap by a few units of 1/256.
    assert!(both > 50 && both * 5 < one, "{both} meet both, {one} one");
}

#[test]
fn a_circuit_that_leaves_something_behind_is_refused() {
    let oracle = oracle(&written(ONE, &[]));
    let whole = oracle.whole();
    let compute = oracle.program.instructions.len();
    let parts = lower::parts(&whole, &[compute, whole.instructions.len() - compute]);
    let rays = some_rays(&written(ONE, &[]), 40);
    let ask = |parts| {
        let machine = NearestMachine::of_parts(oracle.clone(), parts, SEED).unwrap();
        machine.ask(&rays, &mut Answers::default())
    };
    ask(parts.clone()).unwrap();
    let last = parts[2].gates.len();
    for gate in (0..last).step_by(last / 20) {
        let mut tampered = parts.clone();
        tampered[2].gates.remove(gate);
        // Some gates do nothing for these few rays; the last gates are an X or a copy of the ray's path
        // index.
        if gate > last / 2 {
            assert!(
                ask(tampered).is_err(),
                "gate {gate} of {last} is not missed"
            );
        }
    }
}

/// Applies `H` to every qubit of a number.
fn hadamard(amplitudes: &mut [f64]) {
    let mut half = 1;
    while half < amplitudes.len() {
        for start in (0..amplitudes.len()).step_by(2 * half) {
            for low in start..start + half {
                let (a, b) = (amplitudes[low], amplitudes[low + half]);
                amplitudes[low] = (a + b) * 0.5_f64.sqrt();
                amplitudes[low + half] = (a - b) * 0.5_f64.sqrt();
            }
        }
        half *= 2;
    }
}

#[test]
fn iterates_of_the_circuits_signs_turn_by_the_angle_of_theory() {
    let scene = from_file("tests/scenes/blocks.yaml", &["precision.fraction=9"]);
    let oracle = oracle(&scene);
    let gates = NearestMachine::gates(oracle.clone(), SEED).unwrap();
    let rays = some_rays(&scene, 60);
    let mut answers = Answers::default();
    gates.ask(&rays, &mut answers).unwrap();
    let mut seen = std::collections::BTreeSet::new();
    for place in 0..rays.len() {
        let signs = answers.marks(place);
        let marked = signs.iter().filter(|&&sign| sign).count();
        seen.insert(marked);
        let mut amplitudes = vec![0.0; signs.len()];
        amplitudes[0] = 1.0;
        hadamard(&mut amplitudes);
        for iterations in 0..12 {
            let of = |wanted: bool| {
                let states = amplitudes.iter().zip(signs);
                let states = states.filter(move |(_, sign)| **sign == wanted);
                states.map(|(amplitude, _)| amplitude * amplitude)
            };
            let probability: f64 = of(true).sum();
            let theory = marked_probability(iterations, marked, signs.len());
            assert!(
                (probability - theory).abs() < 1e-13,
                "{marked}: {probability}, {theory}"
            );
            // All marked states are equally likely, and so are all others.
            for class in [true, false] {
                let (least, most) = of(class).fold((1.0_f64, 0.0_f64), |(least, most), p| {
                    (least.min(p), most.max(p))
                });
                assert!(most - least < 1e-13 || of(class).count() == 0);
            }
            // The oracle; then a sign flip of all states except zero, between Hadamards.
            for (amplitude, sign) in amplitudes.iter_mut().zip(signs) {
                *amplitude *= if *sign { -1.0 } else { 1.0 };
            }
            hadamard(&mut amplitudes);
            for amplitude in &mut amplitudes[1..] {
                *amplitude *= -1.0;
            }
            hadamard(&mut amplitudes);
        }
    }
    assert!(seen.len() >= 3, "{seen:?}");
}
