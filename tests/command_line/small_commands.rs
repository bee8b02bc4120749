//! Tests of `qrt new`, `schema`, `completions`, and of properties of every command.

use crate::common::command::Folder;
use qrt::prelude::{RenderOptions, render};
use qrt::runtime::path_machines::Real;
use qrt::runtime::sample::{prefix_means, radiance, spread};
use qrt::runtime::workers::Workers;
use std::fs;
use std::process::Stdio;

const COMMANDS: [&str; 12] = [
    "render",
    "merge",
    "inspect",
    "count",
    "verify",
    "trade",
    "export",
    "diff",
    "new",
    "playground",
    "schema",
    "completions",
];

#[test]
fn a_new_scene_renders_and_says_its_name() {
    let folder = Folder::new();
    let said = folder.works(&["new", "box"]);
    assert!(said.contains("qrt render box.yaml"), "{said}");
    folder.works(&["render", "box.yaml"]);
    assert_eq!(folder.names(), ["box.png", "box.yaml"]);
    // Any name of the scene works.
    for (name, file) in [
        ("other.yaml", "other.yaml"),
        ("v1.2", "v1.2.yaml"),
        ("a \"b\": 'c' # ü", "a \"b\": 'c' # ü.yaml"),
        ("true", "true.yaml"),
        ("42", "42.yaml"),
    ] {
        folder.works(&["new", name]);
        let scene = qrt::prelude::load(&folder.path(file), &[]).unwrap().valid;
        assert_eq!(scene.scene().name, file.strip_suffix(".yaml").unwrap());
    }
}

#[test]
fn a_new_small_scene_is_simulated_by_the_command_that_it_names() {
    let folder = Folder::new();
    let said = folder.works(&["new", "first edge", "--small"]);
    assert!(
        said.contains("`qrt simulate --pixel 1,0 'first edge.yaml'`"),
        "{said}"
    );
    let simulated = folder.works(&["simulate", "--pixel", "1,0", "first edge.yaml"]);
    assert!(
        simulated.starts_with("first edge: channel r of pixel 1,0"),
        "{simulated}"
    );
    // Its first comment says how many qubits that takes.
    let text = String::from_utf8(folder.read("first edge.yaml")).unwrap();
    let qubits = simulated
        .lines()
        .nth(1)
        .unwrap()
        .split_once(" qubits")
        .unwrap()
        .0;
    assert!(text.contains(&format!("\n# {qubits} qubits.")), "{text}");
}

/// The error is too small to be seen: an RMSE of a fiftieth of the mean, against sixteen times the paths.
#[test]
fn the_first_picture_of_a_new_scene_is_one_to_show() {
    let folder = Folder::new();
    folder.works(&["new", "box"]);
    let scene = |sets: &[String]| qrt::prelude::load(&folder.path("box.yaml"), sets).unwrap();
    let scene = [&[][..], &["sampling.path_bits=12".to_owned()]].map(|sets| scene(sets).valid);
    let shown = render(&scene[0], &RenderOptions::default()).unwrap().image;
    let limit = Real::new(&scene[1], 1).unwrap();
    let pixels = spread([shown.width, shown.height], 256);
    let limit = prefix_means(&limit, &pixels, &[12], &Workers::default()).unwrap();
    let squares = pixels.iter().zip(&limit[0]).map(|([x, y], limit)| {
        let shown = shown.pixels[(y * shown.width + x) as usize];
        let pairs = shown.iter().zip(limit);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / 3.0
    });
    let error = (squares.sum::<f64>() / 256.0).sqrt() / radiance(&limit[0]);
    assert!(error < 0.02, "{error}");
    // The picture is neither black nor overexposed.
    let mean = radiance(&shown.pixels);
    assert!((0.2..0.6).contains(&mean), "{mean}");
}

#[test]
fn a_new_scene_replaces_nothing_unless_told() {
    let folder = Folder::with("box.yaml", "mine");
    assert!(folder.fails(2, &["new", "box"]).contains("--force"));
    assert_eq!(folder.read("box.yaml"), b"mine");
    folder.works(&["new", "box", "--force"]);
    assert_ne!(folder.read("box.yaml"), b"mine");
    let error = folder.fails(1, &["new", "none/box"]);
    assert!(
        error.contains("`none/box.yaml`: there is no folder `none`"),
        "{error}"
    );
    assert!(folder.fails(2, &["new", ".."]).contains("names no file"));
    assert_eq!(folder.names(), ["box.yaml"]);
}

#[test]
fn the_schema_is_the_scene_formats() {
    let text = Folder::new().works(&["schema"]);
    assert_eq!(text, qrt::scene::schema::text());
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(schema["properties"]["camera"].is_object());
}

#[test]
fn completions_name_every_command() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.works(&["completions", shell]);
        for command in COMMANDS {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    assert!(folder.fails(2, &["completions", "cmd"]).contains("bash"));
}

#[test]
fn help_and_version_are_there() {
    let folder = Folder::new();
    let version = folder.works(&["--version"]);
    assert_eq!(version, format!("qrt {}\n", env!("CARGO_PKG_VERSION")));
    assert!(folder.fails(2, &[]).contains("Usage: qrt <COMMAND>"));
    for command in COMMANDS {
        let help = folder.works(&[command, "--help"]);
        assert!(help.contains("Examples:"), "{command}");
        assert!(
            help.lines().all(|line| line.chars().count() <= 100),
            "{help}"
        );
    }
}

#[test]
fn readers_that_go_away_are_no_failure() {
    let folder = Folder::new();
    folder.works(&["new", "box"]);
    let render = ["render", "box.yaml", "--crop", "0,0,2,2"];
    for arguments in [
        &render[..],
        &["schema"],
        &["completions", "bash"],
        &["count", "--good", "3", "--total", "9", "--phase-bits", "12"],
        &["render", "--help"],
        &["export", "box.yaml", "-o", "-"],
    ] {
        let mut command = folder.command(arguments);
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {errors}");
        assert!(errors.is_empty(), "{arguments:?}: {errors}");
    }
    // A closed standard error causes no panic, either.
    for arguments in [
        &["render", "none.yaml"][..],
        &["render", "box.yaml", "--crop", "999,0,1,1"],
    ] {
        let mut child = folder
            .command(arguments)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(2), "{arguments:?}");
    }
    assert!(fs::metadata(folder.path("box.png")).is_ok());
}
