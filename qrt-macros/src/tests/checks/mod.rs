//! Tests that no check of the macros can be removed unnoticed. A program of `tests/compile_fail/ui` reaches each
//! place in the source that reports an error. The errors of a program are those in the file beside
//! it, which the compiler must show.

mod program;
mod source;

use program::Program;
use source::places;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::panic::Location;
use std::path::{Path, PathBuf};

/// A file below `src`, and a line of it.
type Place = (String, usize);

/// An error: the place in the source that reported it, its code if it has one, and its words.
struct Report {
    place: Place,
    code: String,
    message: String,
}

thread_local! {
    /// Reports of this test alone: other tests run in threads of their own.
    static REPORTS: RefCell<Vec<Report>> = const { RefCell::new(Vec::new()) };
    /// The program whose macros run. Tokens know their file in the compiler alone.
    static FILE: RefCell<Option<PathBuf>> = const { RefCell::new(None) };
}

/// Returns the file of the program whose macros run.
pub(crate) fn file() -> Option<PathBuf> {
    FILE.with_borrow(Clone::clone)
}

/// Records a report.
pub(crate) fn reached(place: &Location<'_>, code: &str, message: &str) {
    let (_, file) = place.file().rsplit_once("src/").unwrap();
    let report = Report {
        place: (file.to_owned(), place.line() as usize),
        code: code.to_owned(),
        message: message.to_owned(),
    };
    REPORTS.with_borrow_mut(|reports| reports.push(report));
}

/// Collects the Rust files of a folder, and of the folders within.
fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_check_is_failed_by_some_program() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/compile_fail/ui");
    let mut programs = Vec::new();
    rust_files(&folder, &mut programs);
    let mut missed = places();
    assert!(missed.len() > 150, "{} places", missed.len());
    let mut wrong = Vec::new();
    for path in &programs {
        REPORTS.take();
        let program = Program { folder: &folder };
        FILE.set(Some(path.clone()));
        program.run(fs::read_to_string(path).unwrap().parse().unwrap());
        FILE.set(None);
        let shown = fs::read_to_string(path.with_extension("stderr")).unwrap();
        let mut said = BTreeSet::new();
        for report in REPORTS.take() {
            let Report {
                place,
                code,
                message,
            } = report;
            missed.remove(&place);
            // The codes of a faulty file are in its own report.
            let words = match code.as_str() {
                "" => message,
                code if shown.contains(&format!("error[{code}]")) => message,
                code => format!("{message} [{code}]"),
            };
            if !shown.contains(&words) {
                wrong.push(format!("{} lacks: {words}", path.display()));
            }
            said.insert(words);
        }
        let errors = shown
            .lines()
            .filter_map(|line| line.strip_prefix("error: "));
        // Other errors are the compiler's own, including those about warnings, which it is made to
        // deny.
        let warns = |error: &str| error.starts_with("use of deprecated constant");
        let told = |error: &str| error.contains(" [QRT") || shown.contains("error[QRT");
        let own = |error: &&str| told(error) && !warns(error);
        for error in errors.filter(own).filter(|error| !said.contains(*error)) {
            wrong.push(format!("{} is not told: {error}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(missed.is_empty(), "no program reaches {missed:#?}");
}
