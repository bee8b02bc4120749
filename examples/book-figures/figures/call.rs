//! One call of an oracle, stage by stage: the registers in use, and the signs of the basis states.
//!
//! The drawing contains all steps. Without a fragment it shows the whole call; with the fragment
//! `#s5` it shows the state after the fifth stage. A script of the book goes through the steps.

use super::{Body, Figure, scene};
use qrt::core::inspect::{CallDiagram, CallPart, grouped};
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::drawing::{Canvas, minus};
use qrt::runtime::path_machines::OracleMachine;
use std::fmt::Write as _;
use std::sync::Arc;

/// The pixel, and the seed of its shifts.
const PIXEL: [u32; 2] = [1, 0];
const SEED: u64 = 1;
/// Position of the table, and the size of its cells.
const LEFT: f64 = 142.0;
const TOP: f64 = 96.0;
const CELL: [f64; 2] = [25.0, 24.0];

/// Returns the number of thresholds that each path exceeds.
fn counts() -> Vec<i64> {
    let scene = scene(include_str!("../../lit-wall.yaml"), "lit-wall.yaml");
    let oracle = Arc::new(Oracle::rgb(&scene, OracleOptions::default()).expect("an oracle"));
    let machine = OracleMachine::fixed(oracle, SEED, true);
    let mut counts = Vec::new();
    let traced = machine.trace(&[PIXEL], 0..machine.paths(), |paths| {
        counts.extend_from_slice(paths.good[0]);
    });
    traced.expect("paths");
    counts
}

/// Returns the colour class of a wire, by the role of its register.
fn class(name: &str) -> &'static str {
    match name {
        "id" => "id",
        "comparator" => "comparator",
        "colour" => "colour",
        "flag" => "flag",
        "work" => "scratch",
        _ => "work",
    }
}

pub(super) fn animated() -> Figure {
    let scene = scene(include_str!("../../lit-wall.yaml"), "lit-wall.yaml");
    let inspection = super::circuits::inspected(&scene);
    let frame = CallDiagram::new(&inspection);
    let stages = inspection.stages();
    let counts = counts();
    let good: i64 = counts.iter().sum();
    let (boxes, wires) = (frame.boxes.len(), frame.wires.len());
    let bottom = TOP + CELL[1] * wires as f64;
    let mut canvas = Canvas::new(
        "One call of the oracle, stage by stage",
        682.0,
        bottom + 150.0,
    );
    let column = |k: usize| LEFT + CELL[0] * k as f64;
    for part in CallPart::ALL {
        let of = |b: &&qrt::core::inspect::DiagramBox| b.part == part;
        let first = frame.boxes.iter().position(|b| b.part == part).unwrap_or(0);
        let count = frame.boxes.iter().filter(of).count();
        let width = CELL[0] * count as f64;
        canvas.rectangle("stage", [column(first) + 1.0, 40.0, width - 2.0, 20.0]);
        let name = if part == CallPart::Flip {
            "flip"
        } else {
            part.name()
        };
        canvas.text("small mid", [column(first) + width / 2.0, 54.0], name);
    }
    for (row, wire) in frame.wires.iter().enumerate() {
        let y = TOP + CELL[1] * row as f64;
        let name = if wire.name == "id" {
            "path index"
        } else {
            &wire.name
        };
        canvas.text("end", [LEFT - 52.0, y + 16.0], name);
        canvas.text(
            "small soft end",
            [LEFT - 10.0, y + 16.0],
            &grouped(wire.qubits),
        );
        let held = frame.held(row);
        for k in 0..boxes {
            let inputs = wire.input || held.contains(&k);
            let touched = frame.boxes[k].writes.contains(&row);
            let place = [column(k) + 1.0, y + 1.0, CELL[0] - 2.0, CELL[1] - 2.0];
            if inputs || touched {
                canvas.rectangle(&format!("{} cell c{}", class(&wire.name), k + 1), place);
            } else {
                canvas.rectangle("box faint", place);
            }
        }
    }
    canvas.text("small soft end", [LEFT - 10.0, TOP - 10.0], "qubits");
    for k in 0..boxes {
        canvas.text(
            &format!("small mid num n{}", k + 1),
            [column(k) + CELL[0] / 2.0, TOP - 10.0],
            &(k + 1).to_string(),
        );
    }
    // The line of text: the label of the whole call, or of a step.
    let line = bottom + 24.0;
    canvas.text(
        "step t0",
        [14.0, line],
        "All steps at once: what is held, from the stage that computes it to its inverse.",
    );
    for (k, item) in frame.boxes.iter().enumerate() {
        let mark = if item.inverse { "†" } else { "" };
        let end = stages[k].instructions.end;
        let in_use = inspection
            .in_use
            .get(end.saturating_sub(1))
            .copied()
            .unwrap_or(0);
        let text = format!(
            "{}. {}{mark}: {} Toffoli; {} qubits in use",
            k + 1,
            item.name,
            grouped(item.cost.toffoli),
            grouped(u64::from(in_use))
        );
        canvas.text(&format!("step t{}", k + 1), [14.0, line], &text);
    }
    // The signs of all basis states: paths from the left, thresholds from below.
    let flip = frame
        .boxes
        .iter()
        .position(|b| b.part == CallPart::Flip && b.writes.is_empty());
    let flip = flip.unwrap_or(boxes / 2) + 1;
    let (left, top, side) = (LEFT, bottom + 40.0, 12.0);
    for (path, count) in counts.iter().enumerate() {
        for y in 0..8_i64 {
            let at = [left + side * path as f64, top + side * (7 - y) as f64];
            let place = [at[0], at[1], side - 2.0, side - 2.0];
            canvas.rectangle("box", place);
            if y < *count {
                canvas.rectangle("minus", place);
            }
        }
    }
    canvas.text("end", [LEFT - 10.0, top + 16.0], "signs of the");
    canvas.text("end", [LEFT - 10.0, top + 33.0], "256 indices");
    canvas.text(
        "small soft end",
        [LEFT - 10.0, top + 56.0],
        &format!("orange: {}", minus("-1")),
    );
    let total = inspection.total();
    let says = format!(
        "One call of the oracle of a lamp before a wall, pixel ({}, {}), red: {boxes} stages on {wires} \
         bundles of qubits, {} Toffoli. Coloured cells are bundles that hold something during a stage: \
         they fill during compute, stage {flip} flips the signs of {good} of 256 indices, and they empty \
         again. The grid below has the signs, 32 paths by 8 thresholds.",
        PIXEL[0],
        PIXEL[1],
        grouped(total.toffoli)
    );
    canvas.describe(&says);
    Figure {
        body: Body::Svg(stepped(&canvas.svg(), boxes, flip)),
        says,
    }
}

/// Returns the drawing with its steps: rules that show a part of it for each fragment.
fn stepped(svg: &str, boxes: usize, flip: usize) -> String {
    let mut rules = String::from(
        ".drawing .faint{opacity:.35}.drawing .step{opacity:0}.drawing .t0{opacity:1}\
         .drawing .minus{fill:#b3500a}\
         @media (prefers-color-scheme:dark){.drawing .minus{fill:#f0883e}}",
    );
    let mut marks = String::new();
    for k in 0..=boxes {
        let _ = write!(marks, "<g id=\"s{k}\"/>");
        // Writing to a string cannot fail.
        let _ = write!(
            rules,
            "#s{k}:target~.t0{{opacity:0}}#s{k}:target~.t{k}{{opacity:1}}\
             #s{k}:target~.cell{{opacity:.12}}#s{k}:target~.c{k}{{opacity:1}}\
             #s{k}:target~.n{k}{{font-weight:700}}"
        );
        if k < flip {
            let _ = write!(rules, "#s{k}:target~.minus{{opacity:0}}");
        }
    }
    let svg = svg.replacen("</style>\n", &format!("{rules}</style>\n{marks}"), 1);
    assert!(svg.contains(&marks));
    svg
}
