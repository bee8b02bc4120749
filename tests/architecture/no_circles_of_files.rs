//! Tests that no files of a crate import each other in a circle. A module and one that contains it do not count: the
//! outer declares the inner, and the inner may use its types. Re-exports are not followed: a circle by way of a parent's
//! `pub use` is not found.

use super::rooms_import_downwards::{code, sources, without_tests};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

const CRATES: &[&str] = &[
    "drawing/src",
    "qrt-circuit/src",
    "qrt-core/src",
    "qrt-counting/src",
    "qrt-machines/src",
    "qrt-macros/src",
    "qrt-runtime/src",
    "qrt-scene/src",
    "src",
];

/// The path of a module in its crate; the root's is empty.
type Module = Vec<String>;

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut circles = Vec::new();
    for folder in CRATES {
        let mut files = Vec::new();
        sources(Path::new(folder), &mut files);
        let modules = modules(Path::new(folder), files);
        let imports: BTreeMap<&Module, BTreeSet<Module>> = modules
            .iter()
            .map(|(module, text)| (module, imports(module, text, &modules)))
            .collect();
        for circle in self::circles(&imports) {
            circles.push(format!("{folder}: {}", circle.join(", ")));
        }
    }
    assert!(circles.is_empty(), "{circles:#?}");
}

/// The code of each module, without its tests.
fn modules(folder: &Path, files: Vec<PathBuf>) -> BTreeMap<Module, String> {
    let files = files.into_iter().filter(|file| {
        let name = file.file_stem().unwrap().to_str().unwrap();
        !name.ends_with("_tests") && !file.iter().any(|part| part == "snapshots")
    });
    files
        .map(|file| {
            let below = file.strip_prefix(folder).unwrap().with_extension("");
            let mut module: Module = below
                .iter()
                .map(|part| part.to_str().unwrap().to_owned())
                .collect();
            module.pop_if(|last| ["mod", "lib", "main"].contains(&&**last));
            let text = fs::read_to_string(&file).unwrap();
            (module, without_tests(&code(&text)))
        })
        .collect()
}

/// The modules that a module's `use` declarations name, without those around it and in it.
fn imports(from: &Module, text: &str, modules: &BTreeMap<Module, String>) -> BTreeSet<Module> {
    let declarations = text.split("use ").skip(1);
    let declarations = declarations.filter_map(|rest| rest.split_once(';'));
    let paths = declarations.flat_map(|(declaration, _)| expanded(declaration.trim()));
    let modules = paths.filter_map(|path| named(from, &path, modules));
    modules
        .filter(|to| !to.starts_with(from) && !from.starts_with(to))
        .collect()
}

/// The paths of a `use` declaration, without braces.
fn expanded(path: &str) -> Vec<String> {
    let Some((start, list)) = path.split_once('{') else {
        return vec![path.to_owned()];
    };
    let list = list.trim_end().strip_suffix('}').unwrap_or(list);
    let mut depth = 0;
    let parts = list.split(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    let parts = parts.map(str::trim).filter(|part| !part.is_empty());
    parts
        .flat_map(|part| expanded(&format!("{}{part}", start.trim())))
        .collect()
}

/// The innermost module on a path in module `from`.
fn named(from: &Module, path: &str, modules: &BTreeMap<Module, String>) -> Option<Module> {
    let mut parts = path.split("::").map(str::trim).peekable();
    let mut module = match *parts.peek()? {
        "crate" => Module::new(),
        "self" | "super" => from.clone(),
        first => {
            let inner = [from.as_slice(), &[first.to_owned()]].concat();
            return modules.contains_key(&inner).then_some(inner);
        }
    };
    while let Some(part) = parts.next_if(|part| ["crate", "self", "super"].contains(part)) {
        if part == "super" {
            module.pop();
        }
    }
    for part in parts {
        module.push(part.to_owned());
        if !modules.contains_key(&module) {
            module.pop();
            break;
        }
    }
    modules.contains_key(&module).then_some(module)
}

/// Groups of modules each of which reaches all others of its group.
fn circles(imports: &BTreeMap<&Module, BTreeSet<Module>>) -> Vec<Vec<String>> {
    let reached = |from: &Module| {
        let mut seen = BTreeSet::new();
        let mut pending = vec![from];
        while let Some(module) = pending.pop() {
            for next in imports.get(module).into_iter().flatten() {
                if seen.insert(next) {
                    pending.push(next);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&Module, BTreeSet<&Module>> = imports
        .keys()
        .map(|module| (*module, reached(module)))
        .collect();
    let mut found = BTreeSet::new();
    for (module, others) in &reached {
        if others.contains(module) {
            let group = others
                .iter()
                .filter(|other| reached[**other].contains(module));
            found.insert(group.map(|module| module.join("/")).collect::<Vec<_>>());
        }
    }
    found.into_iter().collect()
}

#[test]
fn a_circle_is_found_and_a_child_is_none() {
    let texts = [
        ("a", "use super::b::{self, c::X};"),
        ("b", "use crate::c;"),
        ("b/c", "use super::Y; use crate::d::Z;"),
        ("c", "use crate::a::{W, V as U};"),
        ("d", "use std::fmt;"),
    ];
    let modules: BTreeMap<Module, String> = texts
        .iter()
        .map(|(path, text)| {
            let module = path.split('/').map(str::to_owned).collect();
            (module, (*text).to_owned())
        })
        .collect();
    let imports = modules
        .iter()
        .map(|(module, text)| (module, imports(module, text, &modules)))
        .collect();
    assert_eq!(circles(&imports), [["a", "b", "c"]]);
}
