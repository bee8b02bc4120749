//! Tests that wrong circuits do not compile: one short program per rule in `ui/`, each with the
//! compiler's message beside it. After a deliberate change of a message,
//! `TRYBUILD=overwrite cargo test -p qrt-compile-fail` writes them again.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod helps;

use qrt::syntax::codes;
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

/// Names of the generated code and of qrt's sources, and the compiler's words of a bound in them.
const FOREIGN: [&str; 14] = [
    "required by",
    "required for",
    "::qrt::",
    "Handed",
    "Caller",
    "Recorded",
    "Recorder",
    "Reversible<",
    "HostRef",
    "Undetermined",
    "Itself",
    "$crate",
    "$WORKSPACE",
    "the trait `",
];

/// Programs whose messages show such names, and why.
const SHOW_FOREIGN_NAMES: [(&str, &str); 8] = [
    (
        "compiled_field_of_another_scene",
        "the author calls a method with a bound, and the compiler names the bound",
    ),
    ("compiled_register_is_changed", TYPE_OF_A_REGISTER),
    ("compiled_register_leaves_within", TYPE_OF_A_REGISTER),
    ("predicate_changes_the_path", TYPE_OF_A_REGISTER),
    (
        "predicate_of_no_scene",
        "the trait is one of the prelude, and the compiler names it",
    ),
    ("predicate_register_of_another_width", TYPE_OF_A_REGISTER),
    (
        "reversible_argument_in_an_authors_macro",
        "the function's path is unknown there, so each of its functions has all calls, and one type is named",
    ),
    (
        "reversible_computed_width_for_a_constant",
        "a register whose width is computed has any format, as its parameter's type says",
    ),
];

/// The reason where the language refuses a call in plain Rust by its arguments' types.
const TYPE_OF_A_REGISTER: &str = "the compiler shows the type of a register, which is documented";

#[test]
fn messages_show_names_of_the_author_alone() {
    // The compiler's drawings have underscores, too.
    let is_generated = |rest: &str| rest.starts_with(char::is_alphabetic);
    let names = |text: &str| {
        FOREIGN.iter().any(|name| text.contains(name)) || text.split("__").skip(1).any(is_generated)
    };
    let mut shown: Vec<String> = messages()
        .filter_map(|(program, text)| names(&text).then_some(program))
        .collect();
    shown.sort();
    assert_eq!(shown, SHOW_FOREIGN_NAMES.map(|(program, _)| program));
}

/// Programs that the compiler refuses beside the macro, for one cause, and why.
const REFUSED_TWICE: [(&str, &str); 1] = [(
    "reversible_does_not_parse",
    "the compiler reads a function before its attribute does, repairs what it cannot read, and does not say so",
)];

#[test]
fn the_compiler_adds_nothing_to_an_error_of_the_macros() {
    let is_own = |error: &str| error.contains("[QRT");
    let twice = |text: &str| {
        let errors = format!("\n{text}");
        let own: Vec<bool> = errors.split("\nerror").skip(1).map(is_own).collect();
        own.contains(&true) && own.contains(&false)
    };
    let mut refused: Vec<String> = messages()
        .filter_map(|(program, text)| twice(&text).then_some(program))
        .collect();
    refused.sort();
    assert_eq!(refused, REFUSED_TWICE.map(|(program, _)| program));
}

/// Returns the names of all programs, with the compiler's messages.
fn messages() -> impl Iterator<Item = (String, String)> {
    std::fs::read_dir("ui").unwrap().filter_map(|entry| {
        let path = entry.unwrap().path();
        let is_message = path.extension().is_some_and(|end| end == "stderr");
        let program = path.file_stem().unwrap().to_str().unwrap().to_owned();
        is_message.then(|| (program, std::fs::read_to_string(&path).unwrap()))
    })
}

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
