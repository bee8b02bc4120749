//! Tests that no files of a crate import each other in a circle. A module and one that contains it do not count: the
//! outer declares the inner, and the inner may use its types. Re-exports are followed to the file
//! that defines the name: `use super::X` is an import of the sibling from which the parent has `X`.

use super::rooms_import_downwards::{code, sources, without_tests};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

const CRATES: &[&str] = &[
    "drawing/src",
    "qrt-circuit/src",
    "qrt-core/src",
    "qrt-counting/src",
    "qrt-lab/src",
    "qrt-machines/src",
    "qrt-macros/src",
    "qrt-runtime/src",
    "qrt-scene/src",
    "qrt-syntax/src",
    "qrt-tracer/src",
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

/// The modules that a module's `use` declarations name, and those that define the names, without
/// those around the module and in it.
fn imports(from: &Module, text: &str, modules: &BTreeMap<Module, String>) -> BTreeSet<Module> {
    let mut found = BTreeSet::new();
    for path in paths(text) {
        if let Some((module, name)) = named(from, &path, modules) {
            if let Some(name) = name {
                found.extend(definition(&module, &name, modules, 0));
            }
            found.insert(module);
        }
    }
    found.retain(|to| !to.starts_with(from) && !from.starts_with(to));
    found
}

/// The paths of all `use` declarations of a text, without braces.
fn paths(text: &str) -> Vec<String> {
    let declarations = text.split("use ").skip(1);
    let declarations = declarations.filter_map(|rest| rest.split_once(';'));
    let paths = declarations.flat_map(|(declaration, _)| expanded(declaration.trim()));
    paths.collect()
}

/// Most re-exports of a name, one of the other.
const MOST_STEPS: u32 = 8;

/// The module that defines the name that `module` imports or re-exports as `name`; `None` if
/// `module` has no such declaration, so that the name is its own.
fn definition(
    module: &Module,
    name: &str,
    modules: &BTreeMap<Module, String>,
    steps: u32,
) -> Option<Module> {
    assert!(
        steps < MOST_STEPS,
        "{module:?} re-exports {name} in a circle"
    );
    let follow = |from: &Module, name: &str| {
        definition(from, name, modules, steps + 1).unwrap_or_else(|| from.clone())
    };
    let mut all = Vec::new();
    for path in paths(&modules[module]) {
        let (path, alias) = match path.split_once(" as ") {
            Some((path, alias)) => (path.trim(), Some(alias.trim())),
            None => (path.trim(), None),
        };
        let last = path.rsplit("::").next()?;
        if alias.unwrap_or(last) == name {
            let (to, rest) = named(module, path, modules)?;
            return Some(rest.map_or(to.clone(), |rest| follow(&to, &rest)));
        }
        if last == "*" {
            let globbed = named(module, path.trim_end_matches("::*"), modules);
            all.extend(globbed.and_then(|(to, rest)| rest.is_none().then_some(to)));
        }
    }
    if defines(&modules[module], name) {
        return None;
    }
    let below = all
        .iter()
        .filter(|to| *to != module && to.starts_with(module));
    let mut found = below.filter_map(|to| {
        let own = defines(&modules[to], name).then(|| to.clone());
        own.or_else(|| definition(to, name, modules, steps + 1))
    });
    found.next()
}

/// True if a text defines an item of that name.
fn defines(text: &str, name: &str) -> bool {
    const ITEMS: [&str; 7] = ["struct", "enum", "trait", "type", "fn", "const", "static"];
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    let mut before = "";
    words.any(|word| {
        let found = word == name && ITEMS.contains(&before);
        before = word;
        found
    })
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

/// The innermost module on a path in module `from`, and the name in it that the path continues
/// with, if there is one.
fn named(
    from: &Module,
    path: &str,
    modules: &BTreeMap<Module, String>,
) -> Option<(Module, Option<String>)> {
    let path = path.split(" as ").next()?;
    let mut parts = path.split("::").map(str::trim).peekable();
    let mut module = match *parts.peek()? {
        "crate" => Module::new(),
        "self" | "super" => from.clone(),
        first => {
            let inner = [from.as_slice(), &[first.to_owned()]].concat();
            modules.contains_key(&inner).then_some(())?;
            from.clone()
        }
    };
    while let Some(part) = parts.next_if(|part| ["crate", "self", "super"].contains(part)) {
        if part == "super" {
            module.pop();
        }
    }
    let mut name = None;
    for part in parts {
        module.push(part.to_owned());
        if !modules.contains_key(&module) {
            module.pop();
            name = (part != "self" && part != "*").then(|| part.to_owned());
            break;
        }
    }
    modules.contains_key(&module).then_some((module, name))
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
    assert_eq!(circles_of(&texts), [["a", "b", "c"]]);
}

#[test]
fn a_circle_by_way_of_re_exports_is_found() {
    // `a` takes Y from the parent, which has it from `b`; `b` takes X from the parent, which has it
    // under another name.
    let texts = [
        (
            "",
            "mod a; mod b; mod d; pub use a::X as W; pub use b::*; pub use d::{Z, V};",
        ),
        ("a", "use super::Y; use super::V; pub struct X;"),
        ("b", "mod c; pub(crate) use c::Y;"),
        ("b/c", "use crate::W; pub struct Y;"),
        ("d", "use crate::T; pub struct Z; pub struct V;"),
    ];
    assert_eq!(circles_of(&texts), [["a", "b/c"]]);
}

fn circles_of(texts: &[(&str, &str)]) -> Vec<Vec<String>> {
    let modules: BTreeMap<Module, String> = texts
        .iter()
        .map(|(path, text)| {
            let parts = path.split('/').filter(|part| !part.is_empty());
            (parts.map(str::to_owned).collect(), (*text).to_owned())
        })
        .collect();
    let imports = modules
        .iter()
        .map(|(module, text)| (module, imports(module, text, &modules)))
        .collect();
    circles(&imports)
}
