//! Checks that each name that the prelude exports is used in an example that `cargo test --doc`
//! runs: beside its export, or in its own documentation. Checks that a crate of `.ci` shadows each name.

use std::path::Path;

/// Returns the groups of exports of `prelude.rs`: their names, and the documentation without
/// included files.
fn exports(prelude: &str) -> Vec<(Vec<String>, String)> {
    let (mut docs, mut path, mut found) = (String::new(), String::new(), Vec::new());
    for line in prelude.lines() {
        if let Some(doc) = line.strip_prefix("///") {
            docs.push_str(doc);
            docs.push('\n');
        } else if !line.starts_with("//!") && !line.starts_with("#[doc") {
            path.push_str(line.trim());
        }
        let Some(whole) = path
            .strip_prefix("pub use ")
            .and_then(|path| path.strip_suffix(';'))
        else {
            continue;
        };
        let names = match whole.split_once('{') {
            Some((_, names)) => names.trim_end_matches('}'),
            None => whole.rsplit("::").next().unwrap(),
        };
        let names = names
            .split(',')
            .map(str::trim)
            .filter(|name| !name.is_empty());
        found.push((
            names.map(str::to_owned).collect(),
            std::mem::take(&mut docs),
        ));
        path.clear();
    }
    found
}

/// Returns the code of all listings that are run.
fn examples(docs: &str) -> String {
    // `None` outside of a listing; in one, true if it is run.
    let (mut listing, mut code) = (None, String::new());
    for line in docs.lines().map(str::trim) {
        if let Some(language) = line.strip_prefix("```") {
            listing = match listing {
                None => Some(matches!(language, "" | "rust")),
                Some(_) => None,
            };
        } else if listing == Some(true) {
            code.push_str(line);
            code.push('\n');
        }
    }
    code
}

fn has_word(code: &str, word: &str) -> bool {
    let inside = |c: char| c.is_alphanumeric() || c == '_';
    code.split(|c| !inside(c)).any(|found| found == word)
}

#[test]
fn all_that_the_prelude_exports_has_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap();
    let exports = exports(&text("src/prelude.rs"));
    let count: usize = exports.iter().map(|(names, _)| names.len()).sum();
    assert!(count > 40, "{exports:?}");
    // The macros have their own documentation.
    let macros = [
        ("qrt", "src/scene_macro.md"),
        ("reversible", "src/reversible.md"),
    ];
    let mut lacking = Vec::new();
    for (names, docs) in &exports {
        for name in names {
            let own = macros.iter().find(|(known, _)| known == name);
            let code = examples(&own.map_or_else(|| docs.clone(), |(_, file)| text(file)));
            if !has_word(&code, name) {
                lacking.push(name);
            }
        }
    }
    assert!(lacking.is_empty(), "no example that runs: {lacking:?}");
}

/// Types, traits, variants and functions of std's prelude of edition 2024, and `Debug`.
const OF_STD: &str = "AsMut AsRef AsyncFn AsyncFnMut AsyncFnOnce Box Clone Copy Debug Default \
    DoubleEndedIterator Drop Eq Err ExactSizeIterator Extend Fn FnMut FnOnce From FromIterator Future Into \
    IntoFuture IntoIterator Iterator None Ok Option Ord PartialEq PartialOrd Result Send Sized Some String Sync \
    ToOwned ToString TryFrom TryInto Unpin Vec align_of align_of_val drop size_of size_of_val";

#[test]
fn a_crate_of_ci_shadows_all_names_of_the_preludes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap();
    let shadowed = text(".ci/newcomer/shadowed/main.rs");
    let exports = exports(&text("src/prelude.rs"));
    let own = exports.iter().flat_map(|(names, _)| names);
    // The crate calls the two macros.
    let own = own.filter(|name| !matches!(name.as_str(), "qrt" | "reversible"));
    let all = own.map(String::as_str).chain(OF_STD.split_whitespace());
    let lacking: Vec<&str> = all.filter(|name| !has_word(&shadowed, name)).collect();
    assert!(lacking.is_empty(), "not shadowed: {lacking:?}");
}

#[test]
fn what_has_no_example_is_found() {
    let prelude = "//! What it takes.\n\n/// ```\n/// b();\n/// ```\npub use a::b;\n\
                   pub use a::c::{D, E,\n    f};\n";
    let found = exports(prelude);
    assert_eq!(found[0].0, ["b"]);
    assert!(has_word(&examples(&found[0].1), "b"));
    assert_eq!(found[1].0, ["D", "E", "f"]);
    assert_eq!(examples(&found[1].1), "");
    assert_eq!(examples("```text\nnothing\n```\n```\na()\n```\n"), "a()\n");
    assert!(!has_word("about()", "b"));
}
