#![allow(clippy::unwrap_used)]

use super::*;
use qrt_core::oracle::OracleCost;
use qrt_tracer::PixelClass;

/// One of the smallest scenes whose circuit has every kind of part: two rays, a search that meets
/// or misses, a register that a scope copies out, tables, words of a pixel, and a place in the
/// layout with an offset.
const SMALL: &str = "
name: lamp
camera: { perspective: { eye: [0, 0, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 2, height: 2 }
materials:
  floor: { lambertian: { albedo: [0.5, 0.5, 0.5] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: floor }
  - quad: { vertices: [[0, -9, 3], [0, 9, 3], [9, 9, 3], [9, -9, 3]], material: lamp }
sampling: { path_bits: 2, depths: [{ bits: [1, 1] }, { bits: [2, 1] }], lights: none }
precision: { fraction: 6 }
comparator: { bits: 2 }
circuit: { uncompute: scoped }
";

/// Returns labels, as if the macro had named the scene's primitives.
fn labels() -> [Option<String>; 2] {
    ["ground", "sky"].map(|label| Some(label.to_owned()))
}

fn small(more: &str) -> ValidScene {
    parsed(&format!("{SMALL}{more}"))
}

fn parsed(text: &str) -> ValidScene {
    qrt_scene::front::parse(text, "small.yaml", &[], "".as_ref())
        .unwrap_or_else(|report| panic!("{report}"))
        .valid
}

/// Returns text as `rustfmt` formats it.
fn formatted(text: &str) -> String {
    use std::io::Write as _;
    use std::process::{Command, Stdio};
    let mut rustfmt = Command::new("rustfmt")
        .args(["--edition", "2024"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    rustfmt
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let output = rustfmt.wait_with_output().unwrap();
    assert!(output.status.success(), "rustfmt cannot read:\n{text}");
    String::from_utf8(output.stdout).unwrap()
}

/// After a deliberate change, `QRT_BLESS=1 cargo test -p qrt-macros` writes the text again.
#[test]
fn the_code_of_a_small_scene_is_as_it_was() {
    let code = formatted(&text("Lamp", "pub", "", (&labels(), &small(""))).unwrap());
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/src/generate/snapshots/small.rs"
    );
    if std::env::var_os("QRT_BLESS").is_some() {
        std::fs::write(path, &code).unwrap();
    }
    let expected = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        expected == code,
        "small.rs differs: see QRT_BLESS in the test"
    );
}

/// The same formats as in the types that the snapshot has.
#[test]
fn the_documentation_of_a_scene_lists_the_formats_of_its_paths() {
    let about = about(&small(""));
    assert!(about.contains("for `path.ray0` to `path.ray1`"), "{about}");
    for row in [
        "| `path.ray0.origin.x`, `.y`, `.z` | `Fixed<7, 2>` |",
        "| `path.ray0.normal.x`, `.y`, `.z` | `Fixed<2, 6>` |",
        "| `path.ray0.material` | `UInt<2>` |",
    ] {
        assert!(about.contains(row), "{about}");
    }
}

/// For the box within 500 qubits, some 30,000 statements become 5,000.
#[test]
fn what_a_circuit_of_few_qubits_repeats_is_written_once() {
    let box_ = include_str!("../../../scenes-yaml/cornell-box.yaml");
    let few = format!("{box_}\ncircuit: {{ uncompute: auto }}\nbudget: {{ qubits: 500 }}\n");
    let code = text("Box", "pub", "", (&[], &parsed(&few))).unwrap();
    let code = &code[code.find("fn repeated_0<").unwrap()..];
    let [computed, undone] = [" = __m.", "__m.undo("].map(|call| code.matches(call).count());
    assert!(computed + undone < 5_000, "{computed} {undone}");
}

/// The small scene folds them, so this test takes a wider scene with a slanted lamp.
#[test]
fn directions_and_origins_in_registers_are_vectors_of_signed_places_with_offsets() {
    let wide = SMALL
        .replace(
            "[0, -9, 3], [0, 9, 3], [9, 9, 3], [9, -9, 3]",
            "[-9, -9, 9], [-9, 9, 7], [9, 9, 7], [9, -9, 9]",
        )
        .replace("{ bits: [2, 1] }", "{ bits: [4, 4] }")
        .replace("scoped", "keep");
    let code = formatted(&text("Lamp", "pub", "", (&labels(), &parsed(&wide))).unwrap());
    for kind in [
        "direction: Vector {",
        ".negated()",
        ".plus([",
        "ValuePlace::Number {",
    ] {
        assert!(code.contains(kind), "{kind}");
    }
}

#[test]
fn a_budget_is_held_when_the_scene_is_compiled() {
    let problems = text(
        "Lamp",
        "pub",
        "",
        (&labels(), &small("budget: { toffoli: 10, qubits: 5 }")),
    );
    let problems = problems.unwrap_err();
    let codes: Vec<_> = problems.iter().map(qrt_syntax::Problem::code).collect();
    assert_eq!(codes, ["QRT0601", "QRT0602"]);
}

/// For the box whose lamp is sampled, the oracles of pixels that see no lamp have more Toffolis
/// than the oracles that the code is generated from.
#[test]
fn a_budget_is_held_by_the_oracles_of_all_pixels() {
    let lit = include_str!("../../../scenes-yaml/lit-box.yaml");
    let scene = parsed(lit);
    let own = Oracles::new(&scene)
        .costs_of(PixelClass::default())
        .unwrap();
    let most = OracleCost::most_expensive(own).unwrap().call.toffoli;
    let tight = parsed(&format!("{lit}\nbudget: {{ toffoli: {most} }}\n"));
    let problems = text("Box", "pub", "", (&[], &tight)).unwrap_err();
    let codes: Vec<_> = problems.iter().map(Problem::code).collect();
    assert_eq!(codes, ["QRT0602"]);
}
