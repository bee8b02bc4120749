//! Tests that wrong circuits do not compile: one short program per rule in `ui/`, each with the
//! compiler's message beside it. After a deliberate change of a message,
//! `TRYBUILD=overwrite cargo test -p qrt-compile-fail` writes them again.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod helps;

use qrt::scene::syntax::codes;
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn wrong_programs_do_not_compile() {
    put_scenes_beside_the_programs();
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}

/// Copies the scenes and meshes of the programs to the folder at which `qrt!` looks for files. trybuild compiles
/// the programs as a package of their own, whose manifest is there.
fn put_scenes_beside_the_programs() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let package = target.join("tests/trybuild/qrt-compile-fail");
    std::fs::create_dir_all(package.join("scenes")).unwrap();
    for (own, there) in [
        ("faulty.yaml", "scenes/faulty.yaml"),
        ("lit.yaml", "scenes/lit.yaml"),
        ("outside.obj", "scenes/outside.obj"),
        ("triangle.obj", "scenes/triangle.obj"),
        // By the names that helps have.
        ("lit.yaml", "scene.yaml"),
        ("triangle.obj", "mesh.obj"),
        ("triangle.obj", "knot"),
    ] {
        std::fs::copy(Path::new("ui/scenes").join(own), package.join(there)).unwrap();
    }
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

#[test]
fn no_place_has_two_errors() {
    let mut doubled = Vec::new();
    for entry in std::fs::read_dir("ui").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "stderr") {
            let text = format!("\n{}", std::fs::read_to_string(&path).unwrap());
            let errors = text.split("\nerror").skip(1);
            let place = |error: &str| Some(error.split_once("--> ")?.1.lines().next()?.to_owned());
            let places: Vec<_> = errors.filter_map(place).collect();
            let distinct: BTreeSet<_> = places.iter().collect();
            if places.is_empty() || distinct.len() < places.len() {
                doubled.push(path);
            }
        }
    }
    assert!(doubled.is_empty(), "{doubled:?}");
}

fn is_of_macros(code: &str) -> bool {
    code.starts_with("QRT07") || code.starts_with("QRT08")
}
