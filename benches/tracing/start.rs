//! Time before the first path of lit scenes.
//!
//! `cargo bench --bench tracing -- start` prints milliseconds, for each scene of `scenes-yaml`, with its lamps
//! sampled if it has any:
//!
//! - `command` and `unlit`: the whole command on 4 pixels with 2 paths each, the start of the process and the saving of
//!   the picture included, with and without light sampling.
//! - `file`: from the scene's file to its first path.
//! - `playground`: from the scene's text to the first path of its picture, as compiled for this machine.
//!
//! Then it does so for a lit scene of `qrt!`: from the program to the first path of its circuit, and of floating point.
//! Each figure is the least of several processes, in which nothing is known before.
//!
//! `-- start file:velvet` prints the seconds of one start alone; so do `playground:NAME`, `macro:compiled` and
//! `macro:real`.
//!
//! It fails if light sampling adds more than 10 ms to a command, or if more than 10 ms pass before the first path: 20 ms
//! where the formulas of a user-defined BSDF are checked and bounded first.

use crate::common::{Arguments, Promises};
use qrt::lab::playground::Playground;
use qrt::prelude::*;
use qrt::scene::front::{self, Files};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

#[path = "../../scenes-yaml/examples.rs"]
mod examples;

qrt! {
    scene Room {
        camera: perspective { eye: (0, 0, 3.4), target: (0, 0, 0), vfov: 40 },
        film: 4 x 4,
        material white: lambertian { albedo: (0.7, 0.7, 0.7) },
        material red: lambertian { albedo: (0.6, 0.1, 0.1) },
        material lamp: emitter { radiance: (15, 12, 8) },
        quad floor: white { (-1, -1, 1), (1, -1, 1), (1, -1, -1), (-1, -1, -1) },
        quad ceiling: white { (-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1) },
        quad back: white { (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1) },
        quad left: red { (-1, -1, 1), (-1, -1, -1), (-1, 1, -1), (-1, 1, 1) },
        quad light: lamp { (-0.3, 0.99, -0.3), (0.3, 0.99, -0.3), (0.3, 0.99, 0.3), (-0.3, 0.99, 0.3) },
        sampling { path_bits: 1 },
        depth primary { bits: (6, 6) },
        depth secondary { bits: (6, 6), light: (6, 6) },
        depth tertiary { bits: (6, 6), light: (6, 6) },
        comparator { bits: 8 },
        counting { phase_bits: 6, estimator: exact },
    }
}

/// Most seconds before the first path, and that light sampling adds.
const MOST: f64 = 0.01;
/// The example with a user-defined BSDF, and most seconds before its first path.
const OWN_BSDF: (&str, f64) = ("velvet", 0.02);

/// Runs of each kind, in turn. The least time counts: other processes only add to it.
const RUNS: usize = 25;

/// The settings of a picture of few paths.
const FEW: [&str; 4] = [
    "sampling.path_bits=1",
    "film.width=2",
    "film.height=2",
    "counting.estimator=exact",
];

pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    if let Some(start) = arguments.word() {
        println!("{}", seconds_of(start));
        return;
    }
    let mut scenes: Vec<&str> = examples::EXAMPLES.iter().map(|(name, _)| *name).collect();
    scenes.sort_unstable();
    println!("  milliseconds    command    unlit     file   playground");
    for name in scenes {
        let run = |_| {
            [
                command(name, "auto"),
                command(name, "none"),
                alone(&format!("file:{name}")),
                alone(&format!("playground:{name}")),
            ]
        };
        let runs: Vec<_> = (0..RUNS).map(run).collect();
        let [lit, unlit, file, playground] = least(&runs);
        println!(
            "  {name:16} {:8.1} {:8.1} {:8.1} {:12.1}",
            1e3 * lit,
            1e3 * unlit,
            1e3 * file,
            1e3 * playground
        );
        let added = format!("{name}: light sampling adds");
        judge(promises, &added, (lit - unlit, MOST));
        let most = if name == OWN_BSDF.0 { OWN_BSDF.1 } else { MOST };
        for (from, seconds) in [("file", file), ("playground", playground)] {
            let text = format!("{name}, {from}: the first path begins after");
            judge(promises, &text, (seconds, most));
        }
    }
    for kind in ["compiled", "real"] {
        let runs: Vec<_> = (0..RUNS)
            .map(|_| [alone(&format!("macro:{kind}"))])
            .collect();
        let [seconds] = least(&runs);
        let text = format!("qrt!, {kind}: the first path begins after");
        judge(promises, &text, (seconds, MOST));
    }
}

fn judge(promises: &mut Promises, what: &str, (seconds, most): (f64, f64)) {
    let text = format!("{what} {:.1} ms, at most {:.0}", 1e3 * seconds, 1e3 * most);
    promises.judge(&text, seconds <= most);
}

fn least<const N: usize>(runs: &[[f64; N]]) -> [f64; N] {
    let of = |kind: usize| {
        runs.iter()
            .map(|run| run[kind])
            .fold(f64::INFINITY, f64::min)
    };
    std::array::from_fn(of)
}

/// Returns the seconds of the command.
fn command(name: &str, lights: &str) -> f64 {
    let picture = std::env::temp_dir().join("qrt-bench-start.png");
    let lights = format!("sampling.lights={lights}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_qrt"));
    command.args(["render", "-q"]);
    command.arg(file(name)).arg("-o").arg(&picture);
    command.args(FEW.iter().chain([&&*lights]).flat_map(|set| ["--set", set]));
    let begun = Instant::now();
    let ended = command.status().expect("the command runs");
    let seconds = begun.elapsed().as_secs_f64();
    assert!(ended.success(), "the command refuses {name}");
    seconds
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes-yaml/{name}.yaml"))
}

/// Returns what [`seconds_of`] measures in a process of its own.
fn alone(start: &str) -> f64 {
    let itself = std::env::current_exe().expect("the bench's path");
    let mut child = Command::new(itself);
    let ran = child
        .args(["start", start])
        .stderr(Stdio::inherit())
        .output();
    let printed = ran.expect("the bench runs").stdout;
    let printed = String::from_utf8_lossy(&printed);
    let last = printed.lines().last().unwrap_or_default();
    last.parse()
        .unwrap_or_else(|_| panic!("{start}: {printed}"))
}

/// Returns the seconds up to the end of the first path.
fn seconds_of(start: &str) -> f64 {
    let (kind, name) = start.split_once(':').expect("KIND:NAME");
    let options = RenderOptions {
        crop: Some([0, 0, 1, 1]),
        quiet: true,
        ..RenderOptions::default()
    };
    let begun = Instant::now();
    match (kind, name) {
        ("file", name) => {
            let sets = FEW.into_iter().chain(["sampling.lights=auto"]);
            let sets: Vec<String> = sets.map(str::to_owned).collect();
            let loaded =
                front::load(&file(name), &sets).unwrap_or_else(|report| panic!("{report}"));
            render(&loaded.valid, &options).expect("a pixel");
        }
        ("macro", "compiled") => drop(render_compiled::<Room>(&options).expect("a pixel")),
        ("macro", "real") => drop(render(Room::scene(), &options).expect("a pixel")),
        ("playground", name) => {
            let mut scenes = examples::EXAMPLES.iter();
            let (_, text) = scenes
                .find(|(other, _)| *other == name)
                .expect("an example");
            let text = text.replace("lights: none", "lights: auto");
            let begun = Instant::now();
            let mut playground = Playground::new(&[], Files::held(examples::FILES));
            for (call, numbers) in [
                ("open", &[0.0, 1.0, 0.0, 1.0][..]),
                ("trace", &[0.0, 1.0, 0.0]),
            ] {
                let answer = playground.call(call, numbers, &text);
                assert_eq!(answer.text_of("error"), None, "{name}");
            }
            return begun.elapsed().as_secs_f64();
        }
        _ => panic!("there is no start `{start}`"),
    }
    begun.elapsed().as_secs_f64()
}
