//! The frame in a terminal: wires run down, so that depths need lines, not columns.

use super::Frame;
use crate::syntax::grouped;
use std::fmt::Write as _;

/// Columns that a drawing fills at most, where that can be.
const COLUMNS: usize = 100;
/// Of a wire: the line and the way to the next; the narrower where it must be.
const WIRE: [usize; 2] = [4, 3];

/// The drawing of a frame. A dot reads a wire, a block computes it or, in an inverse, returns it to
/// zero; at the end of a box's line stand its Toffolis. Where the wires of all depths are more than fit, those of a depth are drawn as
/// one.
pub fn text(frame: &Frame) -> String {
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
        // The last wire, that of the work, is everybody's: no lines lead to it.
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

/// Names and qubits of the wires, each hanging from the line of its own. Widths are those of the
/// boxes' names, of the way from wire to wire, and of the costs.
fn heads(out: &mut String, frame: &Frame, columns: &[Vec<usize>], [label, way, cost]: [usize; 3]) {
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

/// Name and qubits of a wire, or of those of a depth.
fn head(frame: &Frame, column: &[usize]) -> String {
    let qubits: u64 = column.iter().map(|&wire| frame.wires[wire].qubits).sum();
    let wire = &frame.wires[column[0]];
    let name = match (column.len(), wire.depth) {
        (2.., Some(depth)) => format!("depth {depth}"),
        _ => wire.name.clone(),
    };
    format!("\u{250c} {name}: {}", grouped(qubits))
}

/// The wires of a depth together, where the first of them is.
fn by_depth(frame: &Frame) -> Vec<Vec<usize>> {
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
