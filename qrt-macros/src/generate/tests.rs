#![allow(clippy::unwrap_used)]

use super::*;

const SMALL: &str = "
name: lit-floor
camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  sky: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
  - quad: { vertices: [[-9, 5, -9], [9, 5, -9], [9, 5, 9], [-9, 5, 9]], material: sky }
sampling: { path_bits: 2, depths: [{ bits: [1, 1] }, { bits: [2, 2] }] }
precision: { fraction: 8 }
comparator: { bits: 4 }
";

fn small(more: &str) -> ValidScene {
    let text = format!("{SMALL}{more}");
    qrt_core::front::parse(&text, "small.yaml", &[], "".as_ref())
        .unwrap_or_else(|report| panic!("{report}"))
        .valid
}

/// Text as `rustfmt` writes it.
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

/// After a deliberate change, `QRT_BLESS=1 cargo test -p qrt-macros` writes the text anew.
#[test]
fn the_code_of_a_small_scene_is_as_it_was() {
    for (file, more) in [
        ("small.rs", ""),
        ("small_scoped.rs", "circuit: { uncompute: scoped }"),
    ] {
        let code = formatted(&text("LitFloor", "pub", "", &small(more)).unwrap());
        let path = format!(
            "{}/src/generate/snapshots/{file}",
            env!("CARGO_MANIFEST_DIR")
        );
        if std::env::var_os("QRT_BLESS").is_some() {
            std::fs::write(&path, &code).unwrap();
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            expected == code,
            "{file} differs: see QRT_BLESS in the test"
        );
    }
}

#[test]
fn a_budget_is_held_when_the_scene_is_compiled() {
    let problems = text(
        "LitFloor",
        "pub",
        "",
        &small("budget: { toffoli: 10, qubits: 5 }"),
    );
    let problems = problems.unwrap_err();
    let codes: Vec<_> = problems
        .iter()
        .map(qrt_core::syntax::Problem::code)
        .collect();
    assert_eq!(codes, ["QRT0601", "QRT0602"]);
}
