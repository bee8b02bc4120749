//! Tests that wrong circuits do not compile: one short program per rule in `ui/`, each with the
//! compiler's message beside it. After a deliberate change of a message,
//! `TRYBUILD=overwrite cargo test -p qrt-compile-fail` writes them again.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod helps;

use qrt::scene::syntax::codes;
use std::path::Path;

#[test]
fn wrong_programs_do_not_compile() {
    // trybuild compiles the programs as a package of their own, and `qrt!` looks for files beside its
    // manifest.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let scenes = target.join("tests/trybuild/qrt-compile-fail/scenes");
    std::fs::create_dir_all(&scenes).unwrap();
    for scene in ["faulty.yaml", "lit.yaml", "outside.obj", "triangle.obj"] {
        let own = Path::new("ui/scenes").join(scene);
        std::fs::copy(own, scenes.join(scene)).unwrap();
    }
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}

#[test]
fn every_code_of_the_macros_is_shown_by_some_program() {
    let mut all = String::new();
    for entry in std::fs::read_dir("ui").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "stderr") {
            all += &std::fs::read_to_string(&path).unwrap();
        }
        // No message may remain of a program that is gone.
        assert!(
            path.is_dir() || path.with_extension("rs").exists(),
            "{}",
            path.display()
        );
    }
    let unseen: Vec<_> = codes::TABLE
        .iter()
        .filter(|row| is_of_macros(row.code) && !all.contains(&format!("[{}]", row.code)))
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}

/// Programs that the language refuses by the types of registers, without a message of qrt's: changing a shared
/// reference, keeping a reference, and a register of another width.
const OF_THE_LANGUAGE: [&str; 5] = [
    "compiled_id_changes_within",
    "compiled_register_is_changed",
    "compiled_register_leaves_within",
    "predicate_changes_the_path",
    "predicate_register_of_another_width",
];

#[test]
fn every_error_has_a_help_line() {
    let mut without = Vec::new();
    for entry in std::fs::read_dir("ui").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "stderr") {
            let text = std::fs::read_to_string(&path).unwrap();
            let errors = format!("\n{text}");
            let mut errors = errors.split("\nerror").skip(1);
            if !errors.all(|error| error.contains("help: ")) {
                without.push(path.file_stem().unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    without.sort();
    assert_eq!(without, OF_THE_LANGUAGE);
}

fn is_of_macros(code: &str) -> bool {
    code.starts_with("QRT07") || code.starts_with("QRT08")
}
