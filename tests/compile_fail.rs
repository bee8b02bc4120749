//! What would be a wrong circuit does not compile: one short program a rule in `tests/ui`, each
//! with the compiler's words beside it. After a deliberate change of the words,
//! `QRT_BLESS=1 cargo test --test compile_fail` writes them anew.
//!
//! The programs are independent, so the compiler reads all of them at once, as modules of one: that
//! takes seconds, one at a time takes minutes. Those of which it then says something else (it may
//! stop before it checks types, and names modules) are compiled alone.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use qrt::core::syntax::codes;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

const FOLDER: &str = "tests/ui";

fn programs() -> Vec<PathBuf> {
    let entries = fs::read_dir(FOLDER).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut programs: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect();
    programs.sort();
    programs
}

/// What the compiler says of the programs in a file, by their paths; `-` stands for `source`.
fn said(file: &Path, source: &str) -> BTreeMap<PathBuf, String> {
    let test = std::env::current_exe().unwrap();
    let libraries = test.parent().unwrap();
    let mut compiler = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()))
        .arg(file)
        .args(["--edition=2024", "--crate-type=bin", "--emit=metadata"])
        .args(["--error-format=json", "--diagnostic-width=140"])
        .arg("-o")
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("programs.rmeta"))
        .arg("-L")
        .arg(libraries)
        .arg("--extern")
        .arg(format!("qrt={}", library(libraries).display()))
        // `qrt!` looks for files beside the manifest.
        .env("CARGO_MANIFEST_DIR", fs::canonicalize(FOLDER).unwrap())
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let written = compiler.stdin.take().unwrap().write_all(source.as_bytes());
    written.unwrap();
    let output = compiler.wait_with_output().unwrap();
    assert!(!output.status.success(), "wrong programs compile");
    let mut said: BTreeMap<PathBuf, String> = BTreeMap::new();
    for line in String::from_utf8(output.stderr).unwrap().lines() {
        let message: Value = serde_json::from_str(line).expect(line);
        if let Some(program) = program(&message) {
            let said = said.entry(program).or_default();
            said.push_str(&normalised(message["rendered"].as_str().unwrap()));
        }
    }
    said
}

/// qrt as this test links it: the newest of those that cargo has built.
fn library(folder: &Path) -> PathBuf {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let built = paths.filter(|path| {
        let name = path.file_stem().unwrap().to_str().unwrap();
        name.starts_with("libqrt-") && path.extension().is_some_and(|end| end == "rlib")
    });
    built
        .max_by_key(|path| path.metadata().unwrap().modified().unwrap())
        .expect("qrt is built")
}

/// The program that a message is about, unless it is about all of them.
fn program(message: &Value) -> Option<PathBuf> {
    let spans = message["spans"].as_array().unwrap();
    let mut span = spans.iter().find(|span| span["is_primary"] == true)?;
    while !span["file_name"].as_str()?.starts_with(FOLDER) {
        span = &span["expansion"]["span"];
    }
    Some(PathBuf::from(span["file_name"].as_str()?))
}

/// A message without what depends on where other files have their lines.
fn normalised(rendered: &str) -> String {
    let mut outside = false;
    let mut text = String::new();
    for line in rendered.trim_end().lines() {
        let mut line = line.trim_end().to_owned();
        let bare = line.trim_start();
        if let Some(place) = bare.strip_prefix("--> ") {
            outside = place.contains(".rs:") && !place.starts_with(FOLDER);
            if outside {
                let file = place.split(':').next().unwrap();
                line.truncate(line.find(place).unwrap() + file.len());
            }
        } else if bare.len() == line.len() && !bare.starts_with(|c: char| c.is_ascii_digit()) {
            outside = false;
        }
        if let Some((number, rest)) = line.split_once('|').filter(|_| outside) {
            line = format!("{}|{rest}", " ".repeat(number.len()));
        }
        writeln!(text, "{line}").unwrap();
    }
    text.push('\n');
    text
}

/// Whether that is what stands beside the program, wherever numbers of lines begin.
fn is_shown(program: &Path, said: &str) -> bool {
    let shown = fs::read_to_string(program.with_extension("stderr")).unwrap_or_default();
    let lines = |text: &str| -> Vec<String> {
        let lines = text.trim_end().lines();
        lines.map(|line| line.trim().to_owned()).collect()
    };
    shown.contains("error") && lines(&shown) == lines(said)
}

/// Compiles each program alone: those of which something else is said than what stands beside them,
/// with what is said.
fn wrong(programs: &[PathBuf]) -> Vec<String> {
    let queue = Mutex::new(programs.iter());
    let wrong = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().unwrap().next();
                    let Some(program) = next else { return };
                    let said = said(program, "").remove(program).unwrap_or_default();
                    if !is_shown(program, &said) {
                        if std::env::var_os("QRT_BLESS").is_some() {
                            let text = format!("{}\n", said.trim_end());
                            fs::write(program.with_extension("stderr"), text).unwrap();
                        }
                        let mut wrong = wrong.lock().unwrap();
                        wrong.push(format!("{}:\n{said}", program.display()));
                    }
                }
            });
        }
    });
    wrong.into_inner().unwrap()
}

#[test]
fn wrong_programs_do_not_compile() {
    let programs = programs();
    let mut source = String::from("fn main() {}\n");
    for program in &programs {
        let name = program.file_stem().unwrap().to_str().unwrap();
        writeln!(source, "#[path = \"{}\"]\nmod {name};", program.display()).unwrap();
    }
    let said = said(Path::new("-"), &source);
    let is_told = |program: &&PathBuf| is_shown(program, said.get(*program).map_or("", |all| all));
    let (told, others): (Vec<_>, Vec<_>) = programs.iter().partition(is_told);
    assert!(
        told.len() > 9 * others.len() || std::env::var_os("QRT_BLESS").is_some(),
        "{others:?} differ"
    );
    let others: Vec<PathBuf> = others.into_iter().cloned().collect();
    let wrong = wrong(&others);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// That other programs are compiled beside them changes nothing.
#[test]
#[ignore = "minutes: starts the compiler for each program"]
fn wrong_programs_do_not_compile_alone() {
    let wrong = wrong(&programs());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_of_the_macros_is_shown_by_some_program() {
    let mut all = String::new();
    for entry in fs::read_dir(FOLDER).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "stderr") {
            all += &fs::read_to_string(&path).unwrap();
            // None is left of a program that is gone.
            assert!(path.with_extension("rs").exists(), "{}", path.display());
        }
    }
    let is_of_macros = |code: &str| code.starts_with("QRT07") || code.starts_with("QRT08");
    let unseen: Vec<_> = codes::TABLE
        .iter()
        .filter(|row| is_of_macros(row.code) && !all.contains(&format!("[{}]", row.code)))
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}
