//! Checks that no module imports from a module above it: crates by their manifests, and the modules
//! of a crate by the names after `crate::` in their code. Tests may import from anywhere.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates, with the crates of this repository that each may use.
const CRATES: &[(&str, &[&str])] = &[
    ("qrt-circuit", &[]),
    ("qrt-syntax", &["qrt-circuit"]),
    ("qrt-scene", &["qrt-circuit", "qrt-syntax"]),
    ("qrt-tracer", &["qrt-scene", "qrt-syntax"]),
    (
        "qrt-core",
        &["qrt-circuit", "qrt-scene", "qrt-syntax", "qrt-tracer"],
    ),
    (
        "qrt-macros",
        &[
            "qrt-circuit",
            "qrt-core",
            "qrt-scene",
            "qrt-syntax",
            "qrt-tracer",
        ],
    ),
    ("drawing", &[]),
    ("qrt-machines", &["qrt-circuit"]),
    (
        "qrt-counting",
        &["qrt-circuit", "qrt-machines", "qrt-scene"],
    ),
    (
        "qrt-runtime",
        &[
            "qrt-circuit",
            "qrt-core",
            "qrt-counting",
            "qrt-drawing",
            "qrt-machines",
            "qrt-scene",
            "qrt-syntax",
            "qrt-tracer",
        ],
    ),
    (
        "qrt-lab",
        &[
            "qrt-circuit",
            "qrt-core",
            "qrt-counting",
            "qrt-drawing",
            "qrt-machines",
            "qrt-runtime",
            "qrt-scene",
            "qrt-syntax",
            "qrt-tracer",
        ],
    ),
    (
        ".",
        &[
            "qrt-circuit",
            "qrt-core",
            "qrt-counting",
            "qrt-drawing",
            "qrt-lab",
            "qrt-machines",
            "qrt-macros",
            "qrt-runtime",
            "qrt-scene",
            "qrt-syntax",
            "qrt-tracer",
        ],
    ),
    (
        "python",
        &[
            "qrt-circuit",
            "qrt-core",
            "qrt-counting",
            "qrt-lab",
            "qrt-runtime",
            "qrt-scene",
            "qrt-syntax",
        ],
    ),
];

/// Sources of a crate, and its modules, each above all those before it.
const MODULES: &[(&str, &[&str])] = &[
    (
        "qrt-syntax/src",
        &[
            "line",
            "name",
            "number",
            "path",
            "tree",
            "other_names",
            "codes",
            "kinds",
            "problem",
            "report",
            "expr",
        ],
    ),
    (
        "qrt-scene/src",
        &[
            "polygons", "lights", "scene", "schema", "sampling", "valid", "front",
        ],
    ),
    (
        "qrt-tracer/src",
        &[
            "corners",
            "polygon",
            "ball",
            "radiance",
            "sampled",
            "arith",
            "vector",
            "math",
            "geometry",
            "ray",
            "crossing",
            "ball_ray",
            "intersect",
            "convex",
            "compiled",
            "places",
            "refraction",
            "sun",
            "smooth",
            "colours",
            "sky",
            "checker",
            "camera",
            "pixel_class",
            "lamp_shapes",
            "lights",
            "bsdf",
            "lighting",
            "bound",
            "stage",
            "search",
            "paper",
            "face_table",
            "frame",
            "scalar",
        ],
    ),
    ("qrt-core/src", &["compile", "oracle", "inspect"]),
    (
        "qrt-machines/src",
        &[
            "instructions",
            "span",
            "transpose",
            "fixed",
            "gates",
            "run",
            "state",
            "statevector",
        ],
    ),
    (
        "qrt-counting/src",
        &[
            "random",
            "double",
            "elementary",
            "error",
            "kernel",
            "phase",
            "angle",
            "distribution",
            "binomial",
            "draw",
            "measured",
            "comparator",
            "strata",
            "histogram",
            "vectorized",
            "mean_signal",
            "lookup",
            "likelihood",
            "posterior",
            "amplitudes",
            "estimators",
        ],
    ),
    (
        "qrt-runtime/src",
        &[
            "named",
            "serialized",
            "memory",
            "scratch",
            "disk",
            "replace_file",
            "line_file",
            "workers",
            "image",
            "path_machines",
            "search",
            "models",
            "counted_pixels",
            "checkpoint",
            "sample",
            "plan",
            "prepared",
            "render",
            "traced_path",
            "predicates",
        ],
    ),
    (
        "qrt-lab/src",
        &[
            "shell",
            "compare",
            "count",
            "simulate",
            "draw",
            "layouts",
            "mitsuba",
            "physical",
            "playground",
            "verify",
            "inspect",
            "trade",
            "json",
        ],
    ),
    (
        "qrt-macros/src",
        &[
            "dependency",
            "surroundings",
            "generate",
            "reversible",
            "scene",
            "expand",
        ],
    ),
    ("src", &["prelude", "cli"]),
];

#[test]
fn no_crate_uses_one_above_it() {
    let mut wrong = Vec::new();
    for (name, below) in CRATES {
        let manifest = fs::read_to_string(Path::new(name).join("Cargo.toml")).unwrap();
        let sections = manifest.split("\n[").skip(1);
        for line in sections
            .filter(|section| section.starts_with("dependencies]"))
            .flat_map(str::lines)
        {
            let used = line.split([' ', '.', '=']).next().unwrap_or_default();
            if used.starts_with("qrt-") && !below.contains(&used) {
                wrong.push(format!("{name} uses {used}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_module_imports_from_one_above_it() {
    let mut wrong = BTreeSet::new();
    for (folder, order) in MODULES {
        let place = |module: &str| order.iter().position(|name| *name == module);
        for (from, imports) in imports(Path::new(folder)) {
            if place(&from).is_none() {
                wrong.insert(format!(
                    "{folder}: where is `{from}`? The table does not have it"
                ));
            }
            for (to, file) in imports {
                // A name that is not a module is an item of the crate's root.
                if place(&to) > place(&from) {
                    wrong.insert(format!("{}: `{from}` imports from `{to}`", file.display()));
                }
            }
        }
    }
    let wrong: Vec<String> = wrong.into_iter().collect();
    assert!(
        wrong.is_empty(),
        "{} arrows upwards:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Returns, by module, the names after `crate::` in its code, and their files.
fn imports(folder: &Path) -> BTreeMap<String, BTreeSet<(String, PathBuf)>> {
    let mut files = Vec::new();
    sources(folder, &mut files);
    let mut imports: BTreeMap<String, BTreeSet<(String, PathBuf)>> = BTreeMap::new();
    for file in files {
        let below = file.strip_prefix(folder).unwrap();
        let first = Path::new(below.iter().next().unwrap());
        let module = first.file_stem().unwrap().to_str().unwrap().to_owned();
        if ["lib", "main"].contains(&&*module) {
            continue;
        }
        let code = without_tests(&code(&fs::read_to_string(&file).unwrap()));
        let named = named(&code).into_iter().filter(|name| *name != module);
        let named = named.map(|name| (name, file.clone())).collect::<Vec<_>>();
        imports.entry(module).or_default().extend(named);
    }
    imports
}

/// Collects all Rust files of a folder except for tests.
pub(super) fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap();
        if name == "tests" {
            continue;
        }
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|end| end == "rs") {
            files.push(path);
        }
    }
}

/// Returns a source without comments and without the text of literals.
pub(super) fn code(source: &str) -> String {
    let mut code = String::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => rest.find("*/").map_or(rest.len(), |at| at + 2),
            '"' => quoted(rest, '"'),
            // The quote begins a character, not a lifetime.
            '\'' if rest.starts_with("'\\") || rest.chars().nth(2) == Some('\'') => {
                quoted(rest, '\'')
            }
            'r' if rest.starts_with("r#\"") => rest.find("\"#").map_or(rest.len(), |at| at + 2),
            _ => {
                code.push(first);
                first.len_utf8()
            }
        };
        rest = &rest[length..];
    }
    code
}

/// Returns the length of a literal.
fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = true;
    for (at, c) in text.char_indices() {
        if escaped {
            escaped = false;
        } else if c == quote {
            return at + 1;
        } else {
            escaped = c == '\\';
        }
    }
    text.len()
}

/// Returns code without the items behind `#[cfg(test)]`.
pub(super) fn without_tests(code: &str) -> String {
    let mut parts = code.split("#[cfg(test)]");
    let mut kept = parts.next().unwrap().to_owned();
    for part in parts {
        let mut depth = 0;
        let end = part.find(|c| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0 && (c == '}' || c == ';')
        });
        kept.push_str(&part[end.map_or(part.len(), |end| end + 1)..]);
    }
    kept
}

/// Returns the names that follow `crate::`, alone or in braces.
fn named(code: &str) -> BTreeSet<String> {
    let mut named = BTreeSet::new();
    for path in code.split("crate::").skip(1) {
        let mut depth = 0;
        let mut starts = true;
        let mut word = String::new();
        for c in path.chars() {
            if c.is_alphanumeric() || c == '_' {
                word.push(c);
                continue;
            }
            if starts && !word.is_empty() {
                named.insert(word.clone());
                starts = false;
            }
            word.clear();
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 1 => starts = true,
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    named
}

#[test]
fn imports_are_found_in_code_alone() {
    let source = r#"
        use crate::{below::{a, b}, other, third as c};
        use crate::plain::d;
        // use crate::comment::e;
        #[cfg(test)]
        mod tests { use crate::testing::f; const C: char = '}'; }
        fn g<'a>(h: &'a str) { crate::called::i("crate::text", '"', "\"crate::escaped"); }
    "#;
    let named = named(&without_tests(&code(source)));
    let expected = ["below", "called", "other", "plain", "third"];
    assert_eq!(
        named.iter().map(String::as_str).collect::<Vec<_>>(),
        expected
    );
}
