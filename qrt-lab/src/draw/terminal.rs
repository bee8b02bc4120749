//! The frame in a terminal: wires run down, so that more depths need more lines, not more columns.

use qrt_core::inspect::{CallDiagram, grouped};
use std::fmt::Write as _;

/// The largest width of a drawing, in columns, if the frame can be drawn that narrow.
const COLUMNS: usize = 100;
/// Columns from one wire to the next; the second if the first is too wide.
const WIRE: [usize; 2] = [4, 3];

/// Draws a frame as text. A dot marks a wire that a box reads. A block marks a wire that a box
/// computes or, in an inverse, returns to zero. Each box's line ends with its Toffoli count. If the
/// wires of all depths don't fit, the wires of each depth are drawn as one.
pub fn frame_text(frame: &CallDiagram) -> String {
    let names = frame.boxes.iter().map(|b| b.name.chars().count() + 2);
    let label = names.max().unwrap_or(0);
    let costs = frame.boxes.iter().map(|b| grouped(b.cost.toffoli).len());
    let cost = costs.max().unwrap_or(0).max("Toffoli".len());
    let singly: Vec<Vec<usize>> = (0..frame.wires.len()).map(|wire| vec![wire]).collect();
    let fits = |columns: &[Vec<usize>]| {
        let fits = |way: &usize| {
            let heads = columns
                .iter()
                .enumerate()
                .map(|(n, column)| way * n + head(frame, column).chars().count());
            let rows = way * columns.len() + cost;
            label + 2 + heads.fold(rows, usize::max) <= COLUMNS
        };
        WIRE.into_iter().find(fits)
    };
    let columns = match fits(&singly) {
        Some(_) => singly,
        None => by_depth(frame),
    };
    let way = fits(&columns).unwrap_or(WIRE[1]) - 1;

    let mut out = String::new();
    heads(&mut out, frame, &columns, [label, way, cost]);
    for (place, item) in frame.boxes.iter().enumerate() {
        let mark = if item.inverse { "\u{2020}" } else { "" };
        let name = format!("{}{mark}", item.name);
        let _ = write!(out, "{name:<label$}  ");
        let touched = |column: &Vec<usize>| {
            column
                .iter()
                .any(|wire| item.reads.contains(wire) || item.writes.contains(wire))
        };
        // Every box may use the last wire, the work wire, so no lines lead to it.
        let others = &columns[..columns.len() - 1];
        let first = others.iter().position(touched);
        let last = others.iter().rposition(touched);
        for (n, column) in columns.iter().enumerate() {
            let writes = column.iter().any(|wire| item.writes.contains(wire));
            let held = column.iter().any(|&wire| {
                let held = frame.held(wire);
                held.contains(&place) || held.contains(&(place + 1))
            });
            let within = first.is_some_and(|first| first < n) && last.is_some_and(|last| n < last);
            let sign = match (writes, touched(column), within, held) {
                (true, ..) => '\u{2588}',
                (_, true, ..) => '\u{25cf}',
                (_, _, true, true) => '\u{253c}',
                (_, _, true, false) => '\u{2500}',
                (_, _, false, true) => '\u{2502}',
                _ => ' ',
            };
            let on = first.is_some_and(|first| first <= n) && last.is_some_and(|last| n < last);
            let line = if on { "\u{2500}" } else { " " };
            let _ = write!(out, "{sign}{}", line.repeat(way));
        }
        let _ = writeln!(out, "{:>cost$}", grouped(item.cost.toffoli));
    }
    out
}

/// Writes the names and qubits of the wires, each at the top of its own line. `label` is the width
/// of the boxes' names, `way` the distance from wire to wire, and `cost` the width of the costs.
fn heads(
    out: &mut String,
    frame: &CallDiagram,
    columns: &[Vec<usize>],
    [label, way, cost]: [usize; 3],
) {
    for (n, column) in columns.iter().enumerate() {
        let _ = write!(out, "{:label$}  ", "");
        for _ in 0..n {
            let _ = write!(out, "\u{2502}{:1$}", "", way);
        }
        let _ = writeln!(out, "{}", head(frame, column));
    }
    let _ = write!(out, "{:label$}  ", "");
    for _ in columns {
        let _ = write!(out, "\u{2502}{:1$}", "", way);
    }
    let _ = writeln!(out, "{:>cost$}", "Toffoli");
}

/// Formats the name and qubits of a wire, or of all wires of a depth.
fn head(frame: &CallDiagram, column: &[usize]) -> String {
    let qubits: u64 = column.iter().map(|&wire| frame.wires[wire].qubits).sum();
    let wire = &frame.wires[column[0]];
    let name = match (column.len(), wire.depth) {
        (2.., Some(depth)) => format!("depth {depth}"),
        _ => wire.name.clone(),
    };
    format!("\u{250c} {name}: {}", grouped(qubits))
}

/// Groups the wires of each depth, at the place of the first of them.
fn by_depth(frame: &CallDiagram) -> Vec<Vec<usize>> {
    let mut columns: Vec<Vec<usize>> = Vec::new();
    for (place, wire) in frame.wires.iter().enumerate() {
        match columns.last_mut() {
            Some(column) if wire.depth.is_some() && frame.wires[column[0]].depth == wire.depth => {
                column.push(place);
            }
            _ => columns.push(vec![place]),
        }
    }
    columns
}
