//! Compares the time of counting with that of tracing, at an error of one percent.
//!
//! `cargo bench --bench one_percent` requests an error of 1 % of the mean for the Cornell box with
//! probability 95 %, takes the parameters that the planner chooses, and renders a film of 8 x 8
//! pixels with and without counting; `-- 64` renders all 64 x 64, which takes ten minutes. Times
//! are those of the processor, where the system reports them. Fails if drawing measurements and
//! estimating from them take longer than tracing the paths.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use qrt_runtime::plan::plan;
use qrt_runtime::render::{Options, Rendered, render};
use qrt_scene::Estimator;
use qrt_scene::front::parse;
use std::path::Path;

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml");
    let text = std::fs::read_to_string(folder.join("cornell-box.yaml")).unwrap();
    // A scene that requests an accuracy must not set the parameters that the planner chooses.
    let chosen = ["  path_bits", "comparator:", "counting:"];
    let kept = text
        .lines()
        .filter(|line| !chosen.iter().any(|key| line.starts_with(key)));
    let text: String = kept.flat_map(|line| [line, "\n"]).collect();
    let text = text + "accuracy: { error: 0.01, confidence: 0.95 }\n";
    // Cargo adds `--bench`.
    let side = std::env::args().skip(1).find(|word| word != "--bench");
    let side: u64 = side.map_or(8, |side| side.parse().expect("pixels of a side"));
    let sets = [format!("film={{ width: {side}, height: {side} }}")];
    let scene = parse(&text, "box.yaml", &sets, &folder).unwrap().valid;
    let options = Options::default();
    let plan = plan(&scene, &options.planning()).unwrap().unwrap();
    print!("{}", plan.figures);

    let run = |estimator: Option<Estimator>| -> (f64, Rendered) {
        let options = Options {
            estimator,
            plan: Some(&plan),
            ..Options::default()
        };
        let before = processor_seconds();
        let rendered = render(&scene, &options).unwrap();
        let spent = processor_seconds().zip(before);
        let wall = rendered.seconds;
        (
            spent.map_or(wall, |(after, before)| after - before),
            rendered,
        )
    };
    let (traced, _) = run(Some(Estimator::Exact));
    let (both, counted) = run(None);
    let counting = both - traced;
    println!(
        "{}: {traced:.2} s of tracing, {counting:.2} s of counting, {} queries a pixel",
        counted.estimator,
        counted.total_queries() / u128::from(side * side)
    );
    assert!(counting < traced, "counting takes longer than tracing");
}

/// Returns the seconds that all cores together have worked on this process, where the system reports them:
/// other processes do not count.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The command's name, in parentheses, may hold spaces.
    let fields = stat.rsplit_once(')')?.1.split_whitespace();
    let ticks: Vec<u64> = fields.skip(11).take(2).flat_map(str::parse).collect();
    let [user, system] = ticks[..] else {
        return None;
    };
    // Linux reports hundredths of a second to all programs, whatever its own clock.
    Some((user + system) as f64 / 100.0)
}
