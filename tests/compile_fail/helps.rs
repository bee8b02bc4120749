//! Tests that what the help of an error says is taken when it is written: the programs of `ui` with
//! their helps applied compile.

#[path = "path_helps.rs"]
mod path_helps;
#[path = "reversible_helps.rs"]
mod reversible_helps;
#[path = "scene_helps.rs"]
mod scene_helps;

use std::fmt::Write as _;
use std::path::Path;

/// A program, and the texts that its helps replace.
type Applied = (&'static str, &'static [(&'static str, &'static str)]);

/// Codes of helps that are not to be written as they are.
const PLACEHOLDERS: [&str; 2] = ["(x,y,z)", "rgb(r,g,b)"];

/// Codes of helps that name two ways, of which the program takes the other one.
const OTHER_WAYS: [(&str, &str); 17] = [
    (
        "qrt_attribute_without_brackets",
        "pubsceneNamefrom\"scene.yaml\"",
    ),
    ("qrt_empty", "pubsceneNamefrom\"scene.yaml\""),
    ("qrt_not_a_scene", "pubsceneNamefrom\"scene.yaml\""),
    ("qrt_scene_without_a_name", "pubsceneNamefrom\"scene.yaml\""),
    ("reversible_argument_by_value", "&muta"),
    ("reversible_arguments", "#[reversible(crate=library::qrt)]"),
    ("reversible_array_of_unknown_length", "[UInt<8>;N]"),
    ("reversible_array_of_unknown_length", "constN:usize"),
    ("reversible_loop_over_a_register", "foriin(0"),
    ("reversible_loop_over_an_iterator", "foriin(0"),
    ("reversible_loop_over_pairs", "foriin(0"),
    ("reversible_parameter_is_a_number", "&mutUInt<8>"),
    ("reversible_parameter_is_a_number", "constN:u32"),
    ("reversible_self_by_value", "&self"),
    ("reversible_width_is_no_constant", "UInt<W>"),
    ("reversible_width_is_no_constant", "constW:u32"),
    // The scratch register that the help names has another format in the program.
    ("reversible_zero_of_a_parameter", "letmutt:UInt<8>=0;"),
];

/// Returns the codes in backticks of all helps of a program, as far as they are complete.
fn helped(name: &str) -> Vec<String> {
    let shown = std::fs::read_to_string(format!("ui/{name}.stderr")).unwrap();
    let says = |line: &&str| line.contains("help: write") && !line.contains("such as");
    let helps = shown.lines().filter(says);
    let codes = helps.flat_map(|line| line.split('`').skip(1).step_by(2));
    let parts = codes.map(|code| code.split("..").next().unwrap_or_default());
    let parts = parts.map(|part| squeezed(part).trim_end_matches(['{', '(']).to_owned());
    parts
        .filter(|part| part.len() > 1 && part.contains(char::is_alphanumeric))
        .filter(|part| !PLACEHOLDERS.contains(&part.as_str()))
        .collect()
}

fn squeezed(text: &str) -> String {
    text.chars()
        .filter(|letter| !letter.is_whitespace())
        .collect()
}

/// Returns a program with its helps applied.
fn applied(name: &str, edits: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string(format!("ui/{name}.rs")).unwrap();
    for (from, to) in edits {
        assert_eq!(text.matches(from).count(), 1, "{name}: {from}\n{text}");
        text = text.replace(from, to);
    }
    let written = squeezed(&text);
    for code in helped(name) {
        let is_other = OTHER_WAYS.contains(&(name, code.as_str()));
        assert!(
            written.contains(&code) != is_other,
            "{name} says `{code}`, and this is written:\n{text}"
        );
    }
    text
}

/// Returns the message of the compiler that is alone where all helps are taken.
fn alone(path: &Path) -> String {
    let path = path.display();
    format!(
        "\
error: type `the_rest_is_right` should have an upper camel case name
 --> {path}:3:8
  |
3 | struct the_rest_is_right;
  |        ^^^^^^^^^^^^^^^^^ help: convert the identifier to upper camel case: `TheRestIsRight`
  |
note: the lint level is defined here
 --> {path}:2:9
  |
2 | #![deny(non_camel_case_types)]
  |         ^^^^^^^^^^^^^^^^^^^^
"
    )
}

/// Every program is in one of the two lists of its family, and all that are applied are one program.
#[test]
fn helps_are_taken_when_they_are_written() {
    let lists = [
        (
            "reversible",
            reversible_helps::APPLIED,
            &reversible_helps::NOT_APPLIED[..],
        ),
        ("qrt", scene_helps::APPLIED, &scene_helps::NOT_APPLIED[..]),
        (
            "compiled",
            path_helps::COMPILED,
            &path_helps::COMPILED_NOT_APPLIED[..],
        ),
        (
            "predicate",
            path_helps::PREDICATES,
            &path_helps::PREDICATES_NOT_APPLIED[..],
        ),
    ];
    // A lint is denied that is reported where types and borrows are right, too: with this error alone, they are. So
    // nothing need be built. Assertions about a function's own constants are not reached, which are known in a
    // build alone.
    let mut all = String::from(
        "#![allow(unused, deprecated)]\n#![deny(non_camel_case_types)]\nstruct the_rest_is_right;\n\n",
    );
    let families: Vec<&str> = lists.iter().map(|(family, ..)| *family).collect();
    let others = programs("").into_iter();
    let others = others.filter(|name| !families.iter().any(|family| name.starts_with(family)));
    assert_eq!(others.collect::<Vec<_>>(), [""; 0]);
    for (family, applied_here, not_applied) in lists {
        let mut listed: Vec<&str> = applied_here.iter().map(|(name, _)| *name).collect();
        listed.extend(not_applied.iter().map(|(name, _)| *name));
        listed.sort_unstable();
        assert_eq!(programs(family), listed);
        for (name, edits) in applied_here {
            let name = format!("{family}_{name}");
            let text = applied(&name, edits).replace("\nfn main()", "\npub fn main()");
            writeln!(all, "mod {name} {{\n{text}}}\n").unwrap();
        }
    }
    all += "fn main() {}\n";
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("helps.rs");
    std::fs::write(&path, all).unwrap();
    std::fs::write(path.with_extension("stderr"), alone(&path)).unwrap();
    super::put_scenes_beside_the_programs();
    trybuild::TestCases::new().compile_fail(path);
}

/// Returns the names of the programs of a family, without `family_` before them; all names without a family.
fn programs(family: &str) -> Vec<String> {
    let mut named: Vec<String> = Vec::new();
    for entry in std::fs::read_dir("ui").unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let name = name
            .strip_prefix(family)
            .map(|name| name.trim_start_matches('_'));
        if let (Some(name), true) = (name, path.extension().is_some_and(|end| end == "rs")) {
            named.push(name.to_owned());
        }
    }
    named.sort();
    named
}
