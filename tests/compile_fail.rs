//! What would be a wrong circuit does not compile, and the compiler says why.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use qrt::core::codes;

const FOLDER: &str = "tests/ui";

#[test]
fn wrong_circuits_do_not_compile() {
    trybuild::TestCases::new().compile_fail(format!("{FOLDER}/*.rs"));
}

#[test]
fn every_code_of_routines_is_shown() {
    let files = std::fs::read_dir(FOLDER).unwrap();
    let texts = files.filter_map(|entry| {
        let path = entry.unwrap().path();
        let shown = path
            .extension()
            .is_some_and(|extension| extension == "stderr");
        shown.then(|| std::fs::read_to_string(path).unwrap())
    });
    let all: String = texts.collect();
    let rows = codes::TABLE
        .iter()
        .filter(|row| row.code.starts_with("QRT08"));
    let unseen: Vec<_> = rows
        .filter(|row| !all.contains(&format!("[{}]", row.code)))
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}
