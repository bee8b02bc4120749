//! What would be a wrong circuit does not compile: one short program a rule in `tests/ui`, each
//! with the compiler's words beside it. After a deliberate change of the words,
//! `TRYBUILD=overwrite cargo test --test compile_fail -- --include-ignored` writes them anew.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use qrt::core::syntax::codes;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The programs, in order, each with the codes that the compiler's words name.
fn programs() -> BTreeMap<PathBuf, Vec<String>> {
    let entries = fs::read_dir("tests/ui").unwrap();
    let words = entries.map(|entry| entry.unwrap().path());
    let words = words.filter(|path| path.extension().is_some_and(|end| end == "stderr"));
    words
        .map(|path| {
            let text = fs::read_to_string(&path).unwrap();
            let codes = text.split("[QRT").skip(1);
            let codes = codes.map(|rest| format!("QRT{}", &rest[..4])).collect();
            (path.with_extension("rs"), codes)
        })
        .collect()
}

/// Compiles the programs as a package of their own, beside whose manifest `qrt!` looks for files.
fn compile(programs: impl IntoIterator<Item = PathBuf>) {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let scenes = target.join("tests/trybuild/qrt/scenes");
    fs::create_dir_all(&scenes).unwrap();
    for scene in ["faulty.yaml", "lit.yaml", "triangle.obj"] {
        fs::copy(Path::new("tests/ui/scenes").join(scene), scenes.join(scene)).unwrap();
    }
    let cases = trybuild::TestCases::new();
    for program in programs {
        cases.compile_fail(program);
    }
}

/// One program for each code: the first that shows it.
#[test]
fn wrong_programs_of_every_code_do_not_compile() {
    let mut seen: Vec<String> = Vec::new();
    compile(programs().into_iter().filter_map(|(program, codes)| {
        let new = codes.iter().any(|code| !seen.contains(code));
        seen.extend(codes);
        new.then_some(program)
    }));
}

#[test]
#[ignore = "takes two minutes; `.ci/run` does, and the macros' unit tests hold all words against them"]
fn wrong_programs_do_not_compile() {
    compile(programs().into_keys());
}

#[test]
fn every_code_of_the_macros_is_shown_by_some_program() {
    // None is left of a program that is gone.
    let programs = programs();
    for program in programs.keys() {
        assert!(program.exists(), "{}", program.display());
    }
    let shown = |code: &str| programs.values().flatten().any(|known| known == code);
    let unseen: Vec<_> = codes::TABLE
        .iter()
        .filter(|row| is_of_macros(row.code) && !shown(row.code))
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}

fn is_of_macros(code: &str) -> bool {
    code.starts_with("QRT07") || code.starts_with("QRT08")
}
