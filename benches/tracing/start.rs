//! Time before the first path of lit scenes.
//!
//! `cargo bench --bench tracing -- start` runs the command on 4 pixels with 2 paths each, for each scene of
//! `scenes-yaml` that has a lamp to sample: once with its lamps sampled and once without. It prints the least
//! milliseconds of both, the start of the process included. Bounds on the light of connections are all that
//! light sampling adds.
//!
//! It fails if light sampling adds more than 10 ms to a scene's start.

use crate::common::{Arguments, Promises};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Most seconds that light sampling adds to a scene's start.
const MOST: f64 = 0.01;

/// Runs of each command, in turn. The least time counts: other processes only add to it.
const RUNS: usize = 25;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml");
    let entries = std::fs::read_dir(&folder).expect("the example scenes are there");
    let paths = entries.map(|entry| entry.expect("the folder is read").path());
    let mut scenes: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|end| end == "yaml"))
        .collect();
    scenes.sort();
    println!("  milliseconds       lit    unlit");
    for scene in scenes {
        let name = scene.file_stem().unwrap_or_default().to_string_lossy();
        let pairs = (0..RUNS).map(|_| {
            let [lit, unlit] = ["auto", "none"].map(|lights| started(&scene, lights));
            Some([lit?, unlit?])
        });
        // Some scenes have no lamp that could be sampled, or no rays after the camera's.
        let Some(pairs) = pairs.collect::<Option<Vec<_>>>() else {
            println!("  {name:16} is drawn in one of both ways only");
            continue;
        };
        let least = |of: usize| {
            pairs
                .iter()
                .map(|pair| pair[of])
                .fold(f64::INFINITY, f64::min)
        };
        let [lit, unlit] = [least(0), least(1)];
        println!("  {name:16} {:7.1}  {:7.1}", 1e3 * lit, 1e3 * unlit);
        let text = format!(
            "{name}: light sampling adds {:.1} ms before the first path, at most {:.0}",
            1e3 * (lit - unlit),
            1e3 * MOST
        );
        promises.judge(&text, lit - unlit <= MOST);
    }
}

/// Returns the seconds of the command, or nothing if it refuses the scene.
fn started(scene: &Path, lights: &str) -> Option<f64> {
    let picture = std::env::temp_dir().join("qrt-bench-start.png");
    let lights = format!("sampling.lights={lights}");
    let sets = [
        &lights,
        "sampling.path_bits=1",
        "film.width=2",
        "film.height=2",
        "counting.estimator=exact",
    ];
    let mut command = Command::new(env!("CARGO_BIN_EXE_qrt"));
    command.arg("render").arg(scene).arg("-o").arg(&picture);
    command.args(sets.iter().flat_map(|set| ["--set", set]));
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let begun = Instant::now();
    let ended = command.status().expect("the command runs");
    let seconds = begun.elapsed().as_secs_f64();
    ended.success().then_some(seconds)
}
