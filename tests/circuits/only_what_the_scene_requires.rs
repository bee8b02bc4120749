//! Tests that a circuit holds the parts that its scene requires, and no others.

use crate::common::scene::written;
use qrt::circuit::{GateCircuit, Op, Program, lower};
use qrt::core::compile::{Label, Passes, StageName};
use qrt::core::oracle::{Oracle, OracleOptions};

const ROOM: &str = "
name: room
camera: { perspective: { eye: [0.5, 0.5, 3], target: [0.5, 0.5, 0], vfov: 40 } }
film: { width: 8, height: 8 }
materials:
  white: { lambertian: { albedo: [0.7, 0.6, 0.5] } }
  lamp: { emitter: { radiance: [4, 5, 6] } }
geometry:
  - quad: { vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: white }
  - quad: { vertices: [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], material: white }
  - quad: { vertices: [[0.4, 0.9, 0.4], [0.6, 0.9, 0.4], [0.6, 0.9, 0.6], [0.4, 0.9, 0.6]], material: lamp }
sampling:
  path_bits: 8
  lights: none
  depths: [{ bits: [4, 4] }, { bits: [6, 5] }, { bits: [5, 6] }]
";

fn program(text: &str) -> Program {
    let oracle = Oracle::new(&written(text, &[]), 0, OracleOptions::default()).unwrap();
    oracle.whole(0)
}

fn circuit(text: &str) -> GateCircuit {
    lower::circuit(&program(text))
}

fn changed(from: &str, to: &str) -> String {
    assert!(ROOM.contains(from), "{from}");
    ROOM.replace(from, to)
}

fn same_gates(other: &str) {
    let (room, other) = (circuit(ROOM), circuit(other));
    assert_eq!(room.gates, other.gates);
    assert_eq!(room.qubits, other.qubits);
}

#[test]
fn an_unused_material_costs_nothing() {
    let glass = "materials:\n  glass: { dielectric: { ior: 1.5 } }\n  satin: { ggx: { alpha: 0.2, reflectance: [1, 1, 1] } }\n";
    same_gates(&changed("materials:\n", glass));
}

#[test]
fn keys_that_say_what_holds_anyway_cost_nothing() {
    let keys = "
precision: { fraction: 16 }
comparator: { bits: 10, at: midpoints }
counting: { phase_bits: 30, repetitions: 7 }
circuit: { uncompute: keep, nearest: running }
";
    same_gates(&format!("{}{keys}", changed("name: room", "name: other")));
}

#[test]
fn a_second_copy_of_a_primitive_costs_nothing() {
    let copy = "  - quad: { vertices: [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], material: white }\nsampling:";
    same_gates(&changed("sampling:", copy));
}

/// Two primitives of one plane share its distance: the second costs only its edges.
#[test]
fn a_second_primitive_on_a_plane_costs_no_division() {
    let beside = "  - quad: { vertices: [[2, 0, 0], [3, 0, 0], [3, 1, 0], [2, 1, 0]], material: white }\nsampling:";
    let divisions = |text: &str| count(&program(text), |op| matches!(op, Op::Divide { .. }));
    assert_eq!(divisions(ROOM), divisions(&changed("sampling:", beside)));
    let apart = "  - quad: { vertices: [[2, 0, 0.1], [3, 0, 0.1], [3, 1, 0.1], [2, 1, 0.1]], material: white }\nsampling:";
    assert!(divisions(ROOM) < divisions(&changed("sampling:", apart)));
}

fn count(program: &Program, kind: impl Fn(&Op) -> bool) -> usize {
    program.ops.iter().filter(|op| kind(op)).count()
}

/// Text that adds a tilted quad before the sampling of a room.
const TILTED: &str = "  - quad: { vertices: [[2, 0, 0], [3, 0, 0.3], [3, 1, 0.3], [2, 1, 0]], material: white }\nsampling:";

/// Constant products serve only the film's rays (which are affine in the sample) and cos_theta.
#[test]
fn axis_aligned_walls_cost_no_constant_products() {
    let scales = |program: &Program| {
        let steps = program.instructions.iter().filter(|step| !step.inverse);
        let within = steps.filter(|step| {
            let mut block = Some(step.block);
            while let Some(at) = block {
                let at = &program.blocks[at.index()];
                if at.name == "find_intersection" {
                    return true;
                }
                block = at.parent;
            }
            false
        });
        within
            .filter(|step| {
                let op = &program.ops[step.op as usize];
                matches!(op, Op::Scale { .. } | Op::Multiples { .. })
            })
            .count()
    };
    assert_eq!(scales(&program(ROOM)), 0);
    assert!(scales(&program(&changed("sampling:", TILTED))) > 0);
}

/// Only mirrors scatter here, so only the camera's ray is sampled.
#[test]
fn a_mirror_depth_costs_no_sample_qubits() {
    let mirror = changed(
        "lambertian: { albedo: [0.7, 0.6, 0.5] }",
        "mirror: { reflectance: [0.7, 0.6, 0.5] }",
    );
    let samples = |text: &str| count(&program(text), |op| matches!(op, Op::Parity { .. }));
    assert_eq!(samples(ROOM), 6);
    assert_eq!(samples(&mirror), 2);
}

#[test]
fn no_glass_no_roots_and_no_refraction() {
    let roots = |text: &str| count(&program(text), |op| matches!(op, Op::SquareRoot { .. }));
    assert_eq!(roots(ROOM), 0);
    let glass = changed(
        "lambertian: { albedo: [0.7, 0.6, 0.5] }",
        "dielectric: { ior: 1.5 }",
    );
    assert!(roots(&glass) > 0);
}

/// A search in a scene of spheres alone has no plane, and one in a scene of planes alone no sphere.
#[test]
fn spheres_pay_for_no_plane_and_planes_for_no_sphere() {
    let balls = format!(
        "{}geometry:\n  - sphere: {{ center: [0.5, 0.5, 0.5], radius: 0.2, material: white }}\n  \
         - sphere: {{ center: [0.5, 0.9, 0.5], radius: 0.1, material: lamp }}\n{}",
        &ROOM[..ROOM.find("geometry:").unwrap()],
        &ROOM[ROOM.find("sampling:").unwrap()..]
    );
    let parts = |text: &str| {
        let stages: Vec<StageName> = program(text)
            .blocks
            .iter()
            .map(|block| Label::from_block(block).stage)
            .collect();
        let any = |is: fn(&StageName) -> bool| stages.iter().any(is);
        [
            any(|stage| matches!(stage, StageName::Plane(_))),
            any(|stage| matches!(stage, StageName::Sphere(_))),
        ]
    };
    assert_eq!(parts(ROOM), [true, false]);
    assert_eq!(parts(&balls), [false, true]);
}

/// A table over the surfaces of a path multiplies its albedos.
#[test]
fn weights_that_depend_on_materials_alone_are_tables() {
    let products = |passes: Passes| {
        let options = OracleOptions {
            passes,
            ..OracleOptions::default()
        };
        let program = Oracle::new(&written(ROOM, &[]), 0, options)
            .unwrap()
            .program;
        count(&program, |op| matches!(op, Op::Multiply { .. }))
    };
    let without = Passes {
        tabulate: false,
        ..Passes::ALL
    };
    assert!(products(Passes::ALL) < products(without));
}

/// Checks that every pass removes gates from a scene that it applies to, and that none adds any.
#[test]
fn every_pass_pays() {
    let toffoli = |passes: Passes| {
        let options = OracleOptions {
            passes,
            ..OracleOptions::default()
        };
        let room = changed("sampling:", TILTED);
        let whole = Oracle::new(&written(&room, &[]), 0, options)
            .unwrap()
            .whole(0);
        let costs = lower::tally(&whole);
        costs.iter().map(|cost| cost.toffoli).sum::<u64>()
    };
    let mut passes = Passes::NONE;
    let mut last = toffoli(passes);
    let steps: [fn(&mut Passes); 5] = [
        |p| p.share = true,
        |p| p.tabulate = true,
        |p| p.needed = true,
        |p| p.merge = true,
        |p| p.multiples = true,
    ];
    for step in steps {
        step(&mut passes);
        let now = toffoli(passes);
        assert!(now < last, "{passes:?}: {now}, was {last}");
        last = now;
    }
}

/// The paper's records cost more, and change no picture: see `models_agree`.
#[test]
fn a_running_nearest_is_cheaper_than_the_papers_records() {
    let qubits = |text: &str| circuit(text).qubits;
    let paper = format!("{ROOM}circuit: {{ nearest: paper }}\n");
    let scoped = format!("{ROOM}circuit: {{ uncompute: scoped }}\n");
    assert!(qubits(ROOM) < qubits(&paper));
    assert!(qubits(&scoped) * 10 < qubits(ROOM));
}

#[test]
fn lamps_that_cannot_be_sampled_cost_nothing() {
    let asked = "depths: [{ bits: [4, 4] }, { bits: [6, 5], light: [4, 4] }, { bits: [5, 6], light: [4, 4] }]";
    let plain = "depths: [{ bits: [4, 4] }, { bits: [6, 5] }, { bits: [5, 6] }]";
    let without = |room: &str| {
        let sampled = room.replace(plain, asked).replace("  lights: none\n", "");
        let (with, without) = (circuit(&sampled), circuit(room));
        assert_eq!(with.gates, without.gates);
        assert_eq!(with.qubits, without.qubits);
    };
    without(&changed(
        "emitter: { radiance: [4, 5, 6] }",
        "lambertian: { albedo: [0.1, 0.1, 0.1] }",
    ));
    without(&changed(
        "lambertian: { albedo: [0.7, 0.6, 0.5] }",
        "mirror: { reflectance: [0.7, 0.6, 0.5] }",
    ));
    without(&changed(
        "lambertian: { albedo: [0.7, 0.6, 0.5] }",
        "dielectric: { ior: 1.5 }",
    ));
    same_gates(&changed(plain, asked));
}

#[test]
fn where_lamps_are_all_that_counts_the_last_ray_is_not_traced() {
    let asked = changed(
        "{ bits: [6, 5] }, { bits: [5, 6] }",
        "{ bits: [6, 5], light: [5, 5] }, { bits: [5, 6], light: [5, 5] }",
    );
    let of = |lights: &str| {
        let text = asked.replace("  lights: none", &format!("  lights: {lights}"));
        let blocks = program(&text).blocks;
        let searches = blocks
            .iter()
            .filter(|block| block.name == "find_intersection");
        let shadows = blocks.iter().filter(|block| block.name == "shadow");
        (
            searches.count(),
            shadows.count(),
            circuit(&text).gates.len(),
        )
    };
    let (none, mis, alone) = (of("none"), of("mis"), of("next-event"));
    assert_eq!([none.0, mis.0, alone.0], [3, 3, 2]);
    assert_eq!([none.1, mis.1, alone.1], [0, 2, 2]);
    assert_eq!(of("auto"), alone);
    assert!(alone.2 < mis.2);
}
