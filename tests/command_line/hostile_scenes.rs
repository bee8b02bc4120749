//! Tests of hostile scenes in a gigabyte of memory: each is refused or becomes a picture; none crashes the
//! process or runs without end.
#![cfg(unix)]

use crate::common::command::Folder;
use crate::common::numbers::Numbers;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const SCENE: &str = "name: strange
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 3 }
materials:
  grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: grey }
  - mesh: { obj: any.obj, material: lamp }
sampling: { path_bits: 4, depths: [{ bits: [2, 2] }, { bits: [2, 2] }], lights: none }
";

/// Numbers and words that replace others.
const VALUES: [&str; 32] = [
    "0",
    "-1",
    "1e308",
    "1e-308",
    "-1e-320",
    "4294967295",
    "4294967296",
    "65536",
    "18446744073709551616",
    "0x10",
    "1e999",
    ".nan",
    ".inf",
    "-0.0",
    "~",
    "''",
    "[]",
    "{}",
    "[[[[]]]]",
    "*a",
    "&a 1",
    "true",
    "1/0",
    "any.obj",
    "/dev/zero",
    "../any.obj",
    "grey",
    "lamp",
    "[1, 2]",
    "{ a: b }",
    "\u{1b}[2J",
    "!!binary 1",
];

/// Returns a scene and its mesh.
fn hostile(numbers: &mut Numbers) -> (Vec<u8>, Vec<u8>) {
    let mut mesh = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    let mut text = SCENE.to_owned();
    for _ in 0..=numbers.below(3) {
        let large = 1 << numbers.below(20);
        match numbers.below(12) {
            // A large number of primitives.
            0 => {
                text = text.replace(
                    "geometry:\n",
                    &format!(
                        "geometry:\n{}",
                        "  - &m mesh: { obj: any.obj, material: lamp }\n".repeat(large / 64)
                    ),
                );
            }
            1 => text.extend(["more: ", &"[".repeat(large), &"]".repeat(large)]),
            2 => text.extend(["more: [", &"&a [*a, *a, 1], ".repeat(large / 4), "]"]),
            // Replace one occurrence only: two would multiply in the square.
            3 => text = text.replacen("strange", &"strange".repeat(large), 1),
            4 => mesh += &"f 1 2 3\nf 2 3 4\n".repeat(large),
            5 => mesh.extend(["f", &" 1 2 3".repeat(large), "\n"]),
            6 => mesh += &"v 1 2 3\n".repeat(large),
            7 => {
                let (material, libraries) = ("x".repeat(large), "any.obj ".repeat(large / 8));
                mesh.extend(["usemtl ", &material, "\nmtllib ", &libraries, "\n"]);
            }
            // Films of different sizes, one of them too large for a gigabyte.
            8 => {
                let side = [1, 64, 65_536, 4_294_967_295_u64][numbers.below(4)];
                text = text.replace(
                    "width: 4, height: 3",
                    &format!("width: {side}, height: {side}"),
                );
                if side == 64 {
                    text = text.replace("path_bits: 4", "path_bits: 1");
                }
            }
            9 => {
                let bits = numbers.below(14);
                text = text.replace("path_bits: 4", &format!("path_bits: {bits}"));
            }
            // Replace a digit by another value.
            _ => {
                let words: Vec<(usize, &str)> =
                    text.match_indices(|c: char| c.is_ascii_digit()).collect();
                let (at, _) = words[numbers.below(words.len())];
                let value = VALUES[numbers.below(VALUES.len())];
                // Films and paths of any size may take any time, which is no fault, so they stay.
                let line = text[..at].rfind('\n').map_or(0, |line| line + 1);
                if !text[line..].starts_with("film") && !text[line..].starts_with("sampling") {
                    text.replace_range(at..=at, value);
                }
            }
        }
    }
    let (mut text, mut mesh) = (text.into_bytes(), mesh.into_bytes());
    for bytes in [&mut text, &mut mesh] {
        if numbers.below(4) == 0 {
            let at = numbers.below(bytes.len());
            bytes[at] = numbers.below(256) as u8;
        }
    }
    (text, mesh)
}

fn survive(scenes: u64, first: u64) {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_qrt");
    let (mut refused, mut drawn, mut longest) = (0, 0, Duration::ZERO);
    for number in first..first + scenes {
        let (text, mesh) = hostile(&mut Numbers(number));
        fs::write(folder.path("s.yaml"), &text).unwrap();
        fs::write(folder.path("any.obj"), &mesh).unwrap();
        let model = ["real", "fixed", "gates"][(number % 3) as usize];
        let arguments = format!("render s.yaml --quiet --model {model} -o s.png");
        let start = Instant::now();
        let output = Command::new("sh")
            .args([
                "-c",
                &format!("ulimit -v 1000000; exec timeout 100 {program} {arguments}"),
            ])
            .current_dir(folder.path(""))
            .stdin(Stdio::null())
            .output()
            .unwrap();
        longest = longest.max(start.elapsed());
        let errors = String::from_utf8_lossy(&output.stderr);
        let shown: String = errors.chars().take(500).collect();
        match output.status.code() {
            Some(0) => {
                fs::remove_file(folder.path("s.png")).unwrap();
                drawn += 1;
            }
            Some(2) if errors.starts_with("error") || errors.starts_with("warning") => refused += 1,
            other => panic!("scene {number} under {model}: {other:?}: {shown}"),
        }
        assert!(!errors.contains('\u{1b}'), "scene {number}: {shown}");
        assert_eq!(folder.names(), ["any.obj", "s.yaml"], "scene {number}");
    }
    println!("{refused} refused and {drawn} drawn, in at most {longest:.1?} each");
    assert!(refused > scenes / 10 && drawn > scenes / 10);
}

#[test]
fn forty_hostile_scenes_do_no_harm() {
    survive(40, 0);
}

#[test]
#[ignore = "takes two minutes"]
fn a_thousand_hostile_scenes_do_no_harm() {
    survive(1000, 1000);
}
