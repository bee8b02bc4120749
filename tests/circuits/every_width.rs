//! Tests that every number of fraction bits compiles, runs, and is as exact as its bits allow, and that
//! no register ever holds a number outside of its range.

use super::paths::{CORNER, film, inputs, number, oracle, paths};
use crate::common::scene::{from_file, written};
use proptest::prelude::*;
use qrt::circuit::{Register, Type};
use qrt::machines::{Extremes, contents_by_definition};
use qrt::runtime::path_machines::{OracleMachine, Real};
use qrt::scene::valid::ValidScene;
use std::fmt::Write;
use std::ops::RangeInclusive;

const SEED: u64 = 2;

/// Overrides for a small film.
const SMALL: [&str; 3] = ["film.width=4", "film.height=4", "comparator.bits=4"];

fn scene(name: &str, fraction_bits: u32, path_bits: u32) -> ValidScene {
    let fraction = format!("precision.fraction={fraction_bits}");
    let path_bits = format!("sampling.path_bits={path_bits}");
    let mut sets = SMALL.to_vec();
    sets.extend([&*fraction, &path_bits]);
    // Rays through one side of the block, out of another, and to the lamp.
    if name == "cornell-glass" {
        let rays = "sampling.depths=[{ bits: [10, 10] }, { bits: [10, 10] }, { bits: [10, 10] }, \
                    { bits: [10, 10] }]";
        sets.push(rays);
    }
    // Replace stools of 42 faces by four faces each. One of them is smooth, unless it is refused.
    if name == "velvet" {
        sets.extend([
            "geometry[3].mesh.obj=../tests/good_scenes/tetrahedron.obj",
            "geometry[4].mesh.obj=../tests/good_scenes/tetrahedron.obj",
        ]);
        if fraction_bits >= 6 {
            sets.push("geometry[3].mesh.smooth=180");
        }
    }
    from_file(&format!("scenes-yaml/{name}.yaml"), &sets)
}

/// Returns the number that a register's bits encode by its type.
fn held(register: &Register, bits: u64) -> i64 {
    if register.ty == Type::Scratch {
        return 0;
    }
    let unused = 64 - register.width;
    match register.ty {
        Type::Int | Type::Fixed { .. } => (bits << unused).cast_signed() >> unused,
        _ => bits.cast_signed(),
    }
}

/// Follows paths by the definition of operations. Checks that every register holds a number of its
/// interval, and that the fixed machine's colours are those of the definition. Returns the number of
/// registers with an interval, for a program that uncomputes nothing on the way.
fn fits(scene: &ValidScene, every: usize) -> Result<usize, String> {
    let oracle = &oracle(scene);
    // Each bounce rounds two constants by half a unit in the last place: a weight and a radiance.
    let bounces = scene.scene().sampling.depths.len() as i64 - 1;
    let most = (1 << oracle.fraction) + bounces;
    let machine = OracleMachine::fixed(oracle.clone(), SEED, true);
    let pixels = film(oracle);
    let traced = paths(&machine, &pixels).map_err(|defect| defect.to_string())?;
    let program = &oracle.program;
    let mut extremes = Extremes::new(program);
    let undone = program.instructions.iter().any(|step| step.inverse);
    // Registers that no operation computes any more are 0.
    let mut computed = vec![false; program.registers.len()];
    for step in &program.instructions {
        for target in program.ops[step.op as usize].targets() {
            computed[target.index()] = true;
        }
    }
    let mut proven = 0;
    for (place, pixel) in pixels.iter().enumerate() {
        let words = oracle.parameter_words(SEED, *pixel);
        for id in (0..machine.paths()).filter(|id| (*id as usize + place).is_multiple_of(every)) {
            let found = extremes.record(program, &inputs(oracle, id), &words);
            if !undone {
                proven = 0;
                for (place, register) in program.registers.iter().enumerate() {
                    let Some([low, high]) = register.range.filter(|_| computed[place]) else {
                        continue;
                    };
                    let number = held(register, found.registers[place]);
                    if !(low..=high).contains(&number) {
                        return Err(format!("{register:?}: {number} on path {id} of {pixel:?}"));
                    }
                    proven += 1;
                }
            }
            let at = place * machine.paths() as usize + id as usize;
            for (c, channel) in oracle.channels.iter().enumerate() {
                let colour = number(channel.colour, &found.registers);
                if colour != traced.colours[c][at] {
                    return Err(format!(
                        "path {id} of {pixel:?}: colour {colour} of channel {c}"
                    ));
                }
                // A colour is a fraction of its proven bound, up to rounding.
                if !(0..=most).contains(&colour) {
                    return Err(format!(
                        "path {id} of {pixel:?}: colour {colour} out of bounds"
                    ));
                }
            }
        }
    }
    // Values on the way, the intermediate registers of a scoped program included.
    for (register, [least, most]) in program.registers.iter().zip(&extremes.registers) {
        if let Some([low, high]) = register.range
            && (*least < low.min(0) || *most > high.max(0))
        {
            return Err(format!("{register:?}: held {least} to {most}"));
        }
    }
    Ok(proven)
}

fn runs(name: &str, fractions: impl IntoIterator<Item = u32>, gates: &[u32]) {
    for fraction in fractions {
        let scene = scene(name, fraction, 4);
        let oracle = oracle(&scene);
        assert_eq!(oracle.fraction, fraction);
        let proven =
            fits(&scene, 5).unwrap_or_else(|wrong| panic!("{name}, {fraction} bits: {wrong}"));
        // With fewer bits, little of the brightest path's colour is left, and few registers to compute.
        assert!(proven > 100 || fraction < 10);
        if gates.contains(&fraction) {
            let pixels = film(&oracle);
            let fixed = OracleMachine::fixed(oracle.clone(), SEED, true);
            let gates = OracleMachine::gates(oracle, SEED, true).unwrap();
            let [fixed, gates] = [fixed, gates].map(|machine| paths(&machine, &pixels).unwrap());
            assert!(fixed == gates, "{name}, {fraction} bits");
        }
    }
}

/// Every number of fraction bits that a scene may have.
const ALL: RangeInclusive<u32> = 4..=30;

/// The least, the largest, and two between.
const SOME: [u32; 4] = [4, 10, 19, 30];

#[test]
fn some_widths_run_every_material() {
    runs("cornell-box", SOME, &[4, 30]);
    runs("cornell-glass", SOME, &[10]);
    runs("cornell-ggx", SOME, &[4]);
    runs("velvet", SOME, &[10]);
}

#[test]
#[ignore = "a minute: the same as some widths do, in all 27"]
fn every_width_runs_every_material() {
    for name in ["cornell-box", "cornell-glass", "cornell-ggx", "velvet"] {
        runs(name, ALL, &[5, 7]);
    }
}

/// Returns the mean over paths and channels of the difference of fixed and real, in units of the scale.
fn width_error(name: &str, fraction: u32) -> f64 {
    let scene = scene(name, fraction, 8);
    let oracle = oracle(&scene);
    let pixels = film(&oracle);
    let fixed = OracleMachine::fixed(oracle.clone(), SEED, true);
    let fixed = paths(&fixed, &pixels).unwrap();
    let mut real: [Vec<f64>; 3] = Default::default();
    Real::new(&scene, SEED).unwrap().trace(&pixels, |block| {
        for (all, colours) in real.iter_mut().zip(block.colours) {
            all.extend_from_slice(colours);
        }
    });
    let ulp = 0.5_f64.powi(fraction as i32);
    let mut sum = 0.0;
    for c in 0..3 {
        let scale = oracle.channels[c].scale;
        for (fixed, real) in fixed.colours[c].iter().zip(&real[c]) {
            sum += (*fixed as f64 * ulp - real / scale).abs();
        }
    }
    sum / (3 * real[0].len()) as f64
}

/// Checks that E_W halves with every bit: rounding does, and so does the fraction of paths that pass an
/// edge on its other side. Four bits more should divide it by sixteen; with few paths, at least by four.
fn shrinks(name: &str) {
    let errors = [10, 14, 18, 22, 26].map(|fraction| width_error(name, fraction));
    println!("{name}: {errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1] <= 0.25 * pair[0], "{name}: {errors:?}");
    }
    assert!(errors[0] > 0.0);
}

#[test]
fn the_width_error_shrinks_with_every_bit() {
    for name in ["cornell-box", "cornell-glass", "cornell-ggx", "velvet"] {
        shrinks(name);
    }
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [-3.0..3.0, -3.0..3.0, -3.0..3.0]
}

fn material() -> impl Strategy<Value = String> {
    let share = || [0.0..=1.0_f64, 0.0..=1.0, 0.0..=1.0];
    prop_oneof![
        share().prop_map(|a| format!("lambertian: {{ albedo: {a:?} }}")),
        share().prop_map(|a| format!("mirror: {{ reflectance: {a:?} }}")),
        (1.05..2.4).prop_map(|ior: f64| format!("dielectric: {{ ior: {ior:?} }}")),
        (0.05..1.0, share()).prop_map(|(alpha, r): (f64, _)| format!(
            "ggx: {{ alpha: {alpha:?}, reflectance: {r:?} }}"
        )),
        (share(), 1.0..60.0).prop_map(|(a, exponent): ([f64; 3], f64)| {
            let [diffuse, specular] = [0.4, 0.6].map(|s| a.map(|a| s * a));
            format!(
                "phong: {{ diffuse: {diffuse:?}, specular: {specular:?}, exponent: {exponent:?} }}"
            )
        }),
        ([0.1..20.0, 0.1..20.0, 0.1..20.0], share()).prop_map(|(e, a): ([f64; 3], _)| format!(
            "emitter: {{ radiance: {e:?}, albedo: {a:?} }}"
        )),
    ]
}

prop_compose! {
    /// Generates a corner and two edges, not too far from square.
    fn quad()(
        corner in point(),
        a in point(),
        b in point(),
    ) -> [[f64; 3]; 4] {
        let plus = |p: [f64; 3], q: [f64; 3]| [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
        [corner, plus(corner, a), plus(plus(corner, a), b), plus(corner, b)]
    }
}

/// Generates a scene of a lamp and up to four quads of any materials, seen from anywhere.
fn any_scene() -> impl Strategy<Value = String> {
    let quads = prop::collection::vec((quad(), material()), 1..5);
    let circuit = ("(keep|scoped)", "(running|paper)", 4..=30_u32, 1..=3_usize);
    (quads, quad(), point(), point(), 20.0..100.0, circuit).prop_map(
        |(quads, lamp, eye, target, vfov, (uncompute, nearest, fraction, depths)): (
            _,
            _,
            _,
            _,
            f64,
            _,
        )| {
            let mut materials = "  lamp: { emitter: { radiance: [5, 4, 3] } }\n".to_owned();
            let mut geometry = format!("  - quad: {{ vertices: {lamp:?}, material: lamp }}\n");
            for (number, (vertices, material)) in quads.iter().enumerate() {
                let _ = writeln!(materials, "  m{number}: {{ {material} }}");
                let _ = writeln!(
                    geometry,
                    "  - quad: {{ vertices: {vertices:?}, material: m{number} }}"
                );
            }
            let depths = vec!["{ bits: [5, 5] }"; depths].join(", ");
            format!(
                "name: any\n\
                 camera: {{ perspective: {{ eye: {eye:?}, target: {target:?}, up: [0, 1, 0.01], \
                 vfov: {vfov:?} }} }}\n\
                 film: {{ width: 4, height: 4 }}\n\
                 materials:\n{materials}geometry:\n{geometry}\
                 sampling: {{ path_bits: 4, depths: [{depths}], lights: none }}\n\
                 precision: {{ fraction: {fraction} }}\n\
                 comparator: {{ bits: 4 }}\n\
                 circuit: {{ uncompute: {uncompute}, nearest: {nearest} }}\n"
            )
        },
    )
}

/// The brightest path meets a lamp that reflects another one. Their radiances, 6.6 and 9.7 sixteenths of the bound,
/// and the weight of 15.5 sixteenths are all rounded up.
#[test]
fn a_colour_exceeds_its_bound_by_rounding_alone() {
    let text = "name: rounded_up
camera: { perspective: { eye: [-2.3820704730630586, 0, 0], target: [0, 0, 0], up: [0, 1, 0.01], vfov: 88.84169236980921 } }
film: { width: 4, height: 4 }
materials:
  lamp: { emitter: { radiance: [5, 4, 3] } }
  reflecting: { emitter: { radiance: [3.405341369378733, 0.1, 0.1], albedo: [0.9690412912835353, 0, 0] } }
  glass: { dielectric: { ior: 1.05 } }
geometry:
  - quad:
      vertices:
        - [0, 2.1336939381219393, 1.7170213879416574]
        - [-1.098947202555276, 2.1336939381219393, 1.7170213879416574]
        - [-1.098947202555276, 2.1336939381219393, -0.8670525772845052]
        - [0, 2.1336939381219393, -0.8670525772845052]
      material: lamp
  - quad:
      vertices:
        - [1.1857517177500982, 1.6996257929873815, 1.7410709823247756]
        - [1.1857517177500982, 1.1849079612489135, 1.7410709823247756]
        - [1.1857517177500982, 1.1849079612489135, 3.93997269708636]
        - [1.1857517177500982, 1.6996257929873815, 3.93997269708636]
      material: reflecting
  - quad:
      vertices:
        - [0, 0, -1.7761506265537808]
        - [0, 0, -4.513468282327849]
        - [0, -0.6496288099128071, -4.513468282327849]
        - [0, -0.6496288099128071, -1.7761506265537808]
      material: glass
sampling: { path_bits: 4, depths: [{ bits: [5, 5] }, { bits: [5, 5] }], lights: none }
precision: { fraction: 4 }
comparator: { bits: 4 }
circuit: { uncompute: keep }
";
    let scene = written(text, &[]);
    assert_eq!(fits(&scene, 1).err(), None);
    let oracle = oracle(&scene);
    let machine = OracleMachine::fixed(oracle.clone(), SEED, true);
    let traced = paths(&machine, &film(&oracle)).unwrap();
    assert_eq!(traced.colours[0].iter().max(), Some(&17));
}

/// Checks that all registers of a scene hold numbers of their ranges. A sliver, or a camera that looks
/// along its own up vector, is not a valid scene and is skipped.
fn scene_fits(text: &str) -> Result<(), TestCaseError> {
    prop_assume!(qrt::scene::front::parse(text, "any.yaml", &[], "".as_ref()).is_ok());
    let fitting = fits(&written(text, &[]), 2);
    fitting.map(|_| ()).map_err(TestCaseError::fail)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 20,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn no_register_of_any_scene_overflows(text in any_scene()) {
        scene_fits(&text)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    #[ignore = "a minute: the same as of any scene, twenty times as many"]
    fn no_register_of_many_scenes_overflows(text in any_scene()) {
        scene_fits(&text)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn the_circuit_of_any_scene_computes_what_the_integers_do(text in any_scene()) {
        let parsed = qrt::scene::front::parse(&text, "any.yaml", &[], "".as_ref());
        prop_assume!(parsed.is_ok());
        let oracle = oracle(&written(&text, &[]));
        let pixels = film(&oracle);
        let fixed = OracleMachine::fixed(oracle.clone(), SEED, true);
        let gates = OracleMachine::gates(oracle, SEED, true);
        let gates = paths(&gates.unwrap(), &pixels);
        prop_assert_eq!(gates.unwrap(), paths(&fixed, &pixels).unwrap());
    }
}

/// Checks that the definition and the extremes agree on the last value of each register.
#[test]
fn extremes_enclose_what_is_held() {
    let oracle = oracle(&written(CORNER, &[]));
    let words = oracle.parameter_words(SEED, [1, 1]);
    let mut extremes = Extremes::new(&oracle.program);
    for id in 0..32 {
        let found = contents_by_definition(&oracle.program, &inputs(&oracle, id), &words);
        let recorded = extremes.record(&oracle.program, &inputs(&oracle, id), &words);
        assert_eq!(found, recorded);
        for (place, register) in oracle.program.registers.iter().enumerate() {
            let [least, most] = extremes.registers[place];
            assert!((least..=most).contains(&held(register, found.registers[place])));
        }
    }
}
