//! Tests of names with special characters of shells, of standard output, and of files with long names.

use crate::common::command::Folder;
use serde_json::Value;
use std::fs::{self, File};
use std::process::{Command, Stdio};

const BOX: &str = include_str!("../scenes/box.yaml");

const NAMES: &str = r#"
name: names
camera: { orthographic: { eye: [0, 0, 1], target: [0, 0, 0], height: 1 } }
film: { width: 2, height: 1 }
materials:
  a.b: { emitter: { radiance: [1, 1, 1] } }
  "c=d[0]": { emitter: { radiance: [1, 1, 1] } }
  'e"f\': { emitter: { radiance: [1, 1, 1] } }
  plain: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: a.b }
sampling: { path_bits: 2 }
"#;

/// Runs a line in a shell, in this folder, where `qrt` is the command.
fn in_shell(folder: &Folder, line: &str) -> (bool, String) {
    let script = format!("qrt() {{ {} \"$@\"; }}; {line}", env!("CARGO_BIN_EXE_qrt"));
    let mut command = Command::new("sh");
    command.args(["-c", &script]).current_dir(folder.path("."));
    let output = command.stdin(Stdio::null()).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.success(), errors)
}

/// Returns the text between the last two backticks.
fn quoted(text: &str) -> &str {
    text.rsplit('`').nth(1).unwrap()
}

#[test]
#[cfg(unix)]
fn the_command_that_new_suggests_is_one_that_a_shell_runs() {
    for name in [
        "box", "a b", "it's", "-y", "--", "$HOME", "a;b", "*", "\u{e4}", "sub/-y",
    ] {
        let folder = Folder::new();
        fs::create_dir(folder.path("sub")).unwrap();
        let said = folder.works(&["new", "--", name]);
        let line = quoted(&said);
        let crop = line.replacen("qrt render", "qrt render --crop 0,0,1,1 -q -o p.png", 1);
        assert_ne!(crop, line, "{said}");
        let (worked, errors) = in_shell(&folder, &crop);
        assert!(worked && folder.path("p.png").exists(), "{crop}: {errors}");
    }
}

#[test]
fn commands_of_other_programs_are_quoted_too() {
    let folder = Folder::with("a b.yaml", BOX);
    let said = folder.works(&["export", "a b.yaml", "--format", "mitsuba", "-o", "a b.xml"]);
    assert!(
        said.contains("mitsuba -m scalar_rgb 'a b.xml' -D"),
        "{said}"
    );
    let said = folder.works(&["export", "a b.yaml", "--format", "mitsuba", "-o=-b.xml"]);
    assert!(said.contains("mitsuba -m scalar_rgb ./-b.xml -D"), "{said}");
}

#[test]
fn set_reaches_any_name_in_quotation_marks() {
    let folder = Folder::with("names.yaml", NAMES);
    let mean = |set: &str| {
        let exact = [
            "render",
            "names.yaml",
            "--estimator",
            "exact",
            "-o",
            "n.exr",
            "-q",
        ];
        folder.works(&[&exact[..], &["--stats", "-", "--set", set]].concat())
    };
    let stats: Value =
        serde_json::from_str(&mean("materials.\"a.b\".emitter.radiance=[3, 3, 3]")).unwrap();
    assert_eq!(stats["mean_rgb"], serde_json::json!([3.0, 3.0, 3.0]));
    for set in [
        "materials.\"c=d[0]\".emitter.radiance=[3, 3, 3]",
        "materials.\"e\\\"f\\\\\".emitter.radiance=[3, 3, 3]",
        "materials.\"plain\".emitter.radiance[0]=3",
        "materials.'a.b'.emitter.radiance=[3, 3, 3]",
        "materials.'it''s'={ mirror: { reflectance: [1, 1, 1] } }",
        "\"materials\" . \"plain\" .emitter.radiance = [3, 3, 3]",
        "materials.\"new.one\"={ mirror: { reflectance: [1, 1, 1] } }",
        "name=\"a=b.c\"",
    ] {
        folder.works(&[
            "render",
            "names.yaml",
            "-q",
            "--crop",
            "0,0,1,1",
            "--set",
            set,
        ]);
    }
    for (set, says) in [
        (
            "materials.\"a.b.emitter.radiance=3",
            "this quotation mark is not closed",
        ),
        (
            "materials.\"a.b\"emitter.radiance=3",
            "a key is missing here",
        ),
        ("materials.\"a.b\"", "an override is written key=value"),
        ("materials.\"no.ne\".emitter.radiance=-3", "no.ne"),
        ("\"", "this quotation mark is not closed"),
        ("\"\\", "this quotation mark is not closed"),
        ("a.\"b\\\"=3", "this quotation mark is not closed"),
        ("'=1", "this quotation mark is not closed"),
        ("materials.'a''=1", "this quotation mark is not closed"),
    ] {
        let errors = folder.fails(2, &["render", "names.yaml", "--set", set]);
        assert!(errors.contains(says), "{set}: {errors}");
    }
}

#[test]
fn a_value_that_set_takes_away_is_told_so() {
    let folder = Folder::with("box.yaml", BOX);
    for set in [
        "comparator=~",
        "comparator=null",
        "comparator = ~ # none",
        "film.width=~",
        "new=~",
    ] {
        let errors = folder.fails(2, &["inspect", "box.yaml", "--set", set]);
        assert!(
            errors.contains("an override cannot take a key away"),
            "{set}: {errors}"
        );
        assert!(!errors.contains("qrt new"), "{set}: {errors}");
    }
    for set in ["counting=", "counting= "] {
        let errors = folder.fails(2, &["inspect", "box.yaml", "--set", set]);
        assert!(
            errors.contains("the value is missing here"),
            "{set}: {errors}"
        );
    }
}

#[test]
fn counts_and_stats_go_to_standard_output_alone() {
    let folder = Folder::with("box.yaml", BOX);
    let render = ["render", "box.yaml", "-o", "p.png"];
    folder.works(&[&render[..], &["--counts", "c.csv", "--stats", "s.json"]].concat());
    let output = folder.qrt(&[&render[..], &["--counts", "-"]].concat());
    assert_eq!(output.stdout, folder.read("c.csv"));
    // The summary of the picture goes to standard error.
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("p.png: 13 x 11 pixels")
    );
    let stats = folder.works(&[&render[..], &["--stats=-"]].concat());
    let stats: Value = serde_json::from_str(&stats).unwrap();
    let kept: Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
    assert_eq!(stats["oracle_queries"], kept["oracle_queries"]);
    folder.works(&["render", "box.yaml", "--portion", "0/1", "-o", "part"]);
    let merged = folder.works(&["merge", "part", "-o", "m.png", "--counts", "-"]);
    assert_eq!(merged.into_bytes(), folder.read("c.csv"));
    let errors = folder.fails(
        2,
        &[&render[..], &["--counts", "-", "--stats", "-"]].concat(),
    );
    assert!(errors.contains("two different things"), "{errors}");
    for more in [
        &["inspect", "box.yaml", "--registers"][..],
        &["inspect", "box.yaml", "--logical-counts"],
    ] {
        let errors = folder.fails(2, &[more, &["-"]].concat());
        assert!(errors.contains("`./-`"), "{errors}");
    }
    assert!(
        !folder.names().contains(&"-".to_owned()),
        "{:?}",
        folder.names()
    );
}

/// Names of 255 bytes, the longest of Linux's file systems, in letters of one byte and of several.
#[test]
fn pictures_with_the_longest_names_are_written_and_gone_on_with() {
    let folder = Folder::with("box.yaml", BOX);
    let long = |letter: &str, bytes: usize| {
        let mut name = letter.repeat((bytes - 4) / letter.len());
        name += &"x".repeat(bytes - 4 - name.len());
        name + ".png"
    };
    for (letter, bytes) in [
        ("a", 226),
        ("a", 227),
        ("a", 243),
        ("a", 244),
        ("a", 254),
        ("\u{20ac}", 255),
    ] {
        let name = long(letter, bytes);
        assert_eq!(name.len(), bytes);
        folder.works(&["render", "box.yaml", "-q", "-o", &name]);
        assert_eq!(
            folder.names(),
            [&*name, "box.yaml"]
                .map(str::to_owned)
                .as_slice()
                .iter()
                .cloned()
                .collect::<std::collections::BTreeSet<_>>()
                .into_iter()
                .collect::<Vec<_>>()
        );
        fs::remove_file(folder.path(&name)).unwrap();
    }
    let errors = folder.fails(1, &["render", "box.yaml", "-q", "-o", &long("a", 256)]);
    assert!(errors.contains("name too long"), "{errors}");
    assert_eq!(folder.names(), ["box.yaml"]);
}

/// No user, root included, can create a file in `/sys`.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_takes_no_files_is_named() {
    let folder = Folder::with("box.yaml", BOX);
    for command in [
        &["render", "box.yaml", "-o", "/sys/p.png"][..],
        &["render", "box.yaml", "--counts", "/sys/c.csv"],
        &["export", "box.yaml", "-o", "/sys/p.qasm"],
        &["new", "/sys/scene"],
        &["trade", "box.yaml", "--quick", "-o", "/sys"],
    ] {
        let errors = folder.fails(1, command);
        assert!(errors.contains("folder `/sys`"), "{command:?}: {errors}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn output_that_cannot_be_written_is_a_failure_of_every_command() {
    let folder = Folder::with("box.yaml", BOX);
    folder.works(&["render", "box.yaml", "-q", "-o", "p.png"]);
    folder.works(&["render", "box.yaml", "-q", "-o", "part", "--portion", "0/1"]);
    for command in [
        "--help",
        "--version",
        "help",
        "help render",
        "render --help",
        "render -h",
        "render box.yaml",
        "render box.yaml -q --counts -",
        "render box.yaml -q --stats -",
        "render box.yaml --portion 0/1 -o other",
        "merge part -o m.png",
        "inspect box.yaml",
        "inspect box.yaml --json",
        "inspect box.yaml --circuit -",
        "count --good 3 --total 8 --phase-bits 3",
        "count --good 3 --total 8 --phase-bits 3 --json",
        "verify box.yaml --pixels 1",
        "export box.yaml",
        "export box.yaml -o -",
        "export box.yaml --json",
        "export box.yaml --format mitsuba",
        "diff p.png p.png",
        "diff p.png p.png --json",
        "new other",
        "schema",
        "completions bash",
        "playground",
    ] {
        let mut full = folder.command(&command.split(' ').collect::<Vec<_>>());
        full.stdout(File::options().write(true).open("/dev/full").unwrap());
        let output = full.output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{command}: {errors}");
        assert!(errors.contains("No space left"), "{command}: {errors}");
    }
    assert!(folder.works(&["--help"]).contains("Usage: qrt"));
    assert!(folder.works(&["--version"]).starts_with("qrt "));
}
