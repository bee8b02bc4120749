//! The page of error codes.

use super::markdown::{plain, sentence, wrapped};
use super::reports;
use qrt::syntax::codes::{self, Code, TABLE};
use std::fmt::Write as _;

/// Groups of codes by their first characters, with titles and descriptions.
const GROUPS: [(&str, &str, &str); 14] = [
    (
        "QRT010",
        "Reading the file",
        "The file as text, before anything in it is understood.",
    ),
    (
        "QRT011",
        "Aliases, depth, size",
        "YAML that is valid, but that a scene has no use for.",
    ),
    (
        "QRT012",
        "Keys and types",
        "The structure of a scene: which keys there are, and what kind of value each takes.",
    ),
    (
        "QRT02",
        "Values and names",
        "Values that are of the right kind, but cannot be meant.",
    ),
    (
        "QRT030 QRT0310 QRT0311",
        "Geometry",
        "Primitives, after meshes have been placed.",
    ),
    (
        "QRT0319 QRT032 QRT033 QRT034 QRT035",
        "Mesh files",
        "Wavefront OBJ files and their MTL libraries, PLY and glTF files. Reports name the place in the \
         mesh file.",
    ),
    (
        "QRT040",
        "Expressions",
        "The formulas of a BSDF of your own.",
    ),
    (
        "QRT041 QRT042",
        "Maps and BSDFs",
        "What the formulas of a BSDF say, once they can be read.",
    ),
    (
        "QRT05",
        "Paths and accuracy",
        "How many paths there are, how long they are, and how they find lamps.",
    ),
    (
        "QRT06",
        "The circuit",
        "Found when the scene is compiled: by `qrt inspect`, `qrt verify`, `qrt render` under \
         `--model fixed` or `gates`, and `qrt!`.",
    ),
    (
        "QRT070 QRT071",
        "`qrt!`: entries, constants, loops",
        "The form of a scene in Rust's tokens. The compiler underlines the tokens.",
    ),
    (
        "QRT072 QRT073",
        "`qrt!`: materials and attributes",
        "More of the macro's own rules.",
    ),
    (
        "QRT080 QRT081 QRT082 QRT083",
        "`#[reversible]`",
        "What would have no inverse, or leave something behind.",
    ),
    (
        "QRT09",
        "Overrides",
        "The option `--set` of the command line.",
    ),
];

const HEAD: &str = "\
# Error codes

qrt reports all faults of a scene together. A report has the fault's place, its code, which stays
the same from version to version, and what to write instead. This page lists all codes. Each entry
has the meaning, the correction, and an example report from qrt's own tests.

Reports about scenes begin with `error[QRT0120]`. Those of the macros come from the Rust compiler,
with the code at the end of the first line. A code's place on this page has its own address: append
`#QRT0120` to it.

";

/// Returns the whole page.
pub(crate) fn page() -> String {
    let mut page = HEAD.to_owned();
    let in_group =
        |group: &str, row: &Code| group.split(' ').any(|start| row.code.starts_with(start));
    for (group, title, _) in GROUPS {
        let rows: Vec<&Code> = TABLE.iter().filter(|row| in_group(group, row)).collect();
        let (first, last) = (rows[0].code, rows[rows.len() - 1].code);
        writeln!(page, "- [{title}](#{first}): {first} to {last}").unwrap();
    }
    let reports = reports::all();
    let mut count = 0;
    for (group, title, about) in GROUPS {
        write!(page, "\n## {title}\n\n{}", wrapped(about, "", "")).unwrap();
        for row in TABLE.iter().filter(|row| in_group(group, row)) {
            let Code {
                code,
                title,
                advice,
            } = row;
            write!(
                page,
                "\n<a id=\"{code}\"></a>\n### {code}: {}\n\n",
                plain(title)
            )
            .unwrap();
            page += &wrapped(&sentence(&plain(advice)), "", "");
            match reports.get(*code) {
                Some(report) => write!(page, "\n```text\n{report}\n```\n").unwrap(),
                None => page += "\nNo file is known that gets it.\n",
            }
            count += 1;
        }
    }
    assert_eq!(count, TABLE.len(), "every code is in one group");
    page
}

#[test]
fn every_code_but_two_has_a_report() {
    let reports = reports::all();
    let without: Vec<&str> = TABLE
        .iter()
        .map(|row| row.code)
        .filter(|code| !reports.contains_key(*code))
        .collect();
    // The OBJ library refuses none of our files, and this build reads glTF.
    let codes = [codes::OBJ_REFUSED, codes::GLTF_FEATURE];
    assert_eq!(without, codes);
    for (code, report) in reports {
        assert!(
            report.contains(code) && report.lines().count() < 30,
            "{report}"
        );
    }
}
