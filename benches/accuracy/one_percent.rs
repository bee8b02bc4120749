//! Compares the time of counting with that of tracing, at an error of one percent.
//!
//! `cargo bench --bench accuracy -- one_percent` requests an error of 1 % of the mean for the
//! Cornell box with probability 95 %, takes the parameters that the planner chooses, and renders a
//! film of 8 x 8 pixels with and without counting; `64` behind the name renders all
//! 64 x 64, which takes ten minutes. Times are those of the processor, where the system reports them. Fails if drawing
//! measurements and estimating from them take longer than tracing the paths.

use crate::common::{Arguments, Promises, processor};
use qrt_runtime::Prepared;
use qrt_runtime::memory::Memory;
use qrt_runtime::plan::plan;
use qrt_runtime::render::{RenderOptions, Rendered};
use qrt_scene::Estimator;
use qrt_scene::front::parse;
use std::path::Path;

pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml");
    let text = std::fs::read_to_string(folder.join("cornell-box.yaml")).unwrap();
    // A scene that requests an accuracy must not set the parameters that the planner chooses.
    let chosen = ["  path_bits", "comparator:", "counting:"];
    let kept = text
        .lines()
        .filter(|line| !chosen.iter().any(|key| line.starts_with(key)));
    let text: String = kept.flat_map(|line| [line, "\n"]).collect();
    let text = text + "accuracy: { error: 0.01, confidence: 0.95 }\n";
    let side = arguments.word();
    let side: u64 = side.map_or(8, |side| side.parse().expect("pixels of a side"));
    let sets = [format!("film={{ width: {side}, height: {side} }}")];
    let scene = parse(&text, "box.yaml", &sets, &folder).unwrap().valid;
    let options = RenderOptions::default();
    let plan = plan(&scene, &options.planning()).unwrap().unwrap();
    print!("{}", plan.figures);
    let prepared = Prepared::with_plan(&scene, Some(plan), Memory::default());

    let measured = |estimator: Option<Estimator>| -> (f64, Rendered) {
        let options = RenderOptions {
            estimator,
            ..RenderOptions::default()
        };
        let before = processor::seconds();
        let rendered = prepared.render(&options).unwrap().0;
        (processor::seconds() - before, rendered)
    };
    let (traced, _) = measured(Some(Estimator::Exact));
    let (both, counted) = measured(None);
    let counting = both - traced;
    println!(
        "{}: {traced:.2} s of tracing, {counting:.2} s of counting, {} queries a pixel",
        counted.estimator,
        counted.total_queries() / u128::from(side * side)
    );
    promises.judge(
        &format!("counting takes {counting:.2} s, less than the {traced:.2} s of tracing"),
        counting < traced,
    );
}
