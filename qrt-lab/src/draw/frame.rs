//! The frame as a drawing: time runs to the right, with boxes on the wires.

use qrt_core::compile::StageName;
use qrt_core::inspect::{CallDiagram, CallPart, DiagramBox, Inspection, grouped};
use qrt_drawing::{Canvas, SMALL, text_width};

/// The distance between wires, in units of the drawing.
const ROW: f64 = 34.0;
/// The distance between the centres of boxes.
const COLUMN: f64 = 50.0;
/// The width of a box.
const BOX: f64 = 36.0;
/// The height of a box beyond its outermost wires, on each side.
const RIM: f64 = 13.0;
/// The x coordinate where the wires begin; their names are to the left.
const LEFT: f64 = 170.0;
const TOP: f64 = 112.0;

/// Draws the frame of an inspected call of the scene called `scene`.
///
/// A dot marks a wire that a box reads. A square marks a wire that a box computes or, on a darker
/// box, returns to zero. A wire that a box does not use is thin within the box. The numbers below
/// the boxes are their Toffoli counts.
pub fn frame(inspection: &Inspection, scene: &str) -> Canvas {
    let frame = CallDiagram::new(inspection);
    let total = inspection.total();
    let right = LEFT + COLUMN * frame.boxes.len() as f64 + 30.0;
    let bottom = TOP + ROW * frame.wires.len() as f64;
    let title = format!("{scene}: one oracle call, {}", inspection.which_briefly());
    let figures = format!(
        "{} qubits, {} Toffoli, {} AND measured, Toffoli depth {}",
        grouped(u64::from(inspection.qubits)),
        grouped(total.toffoli),
        grouped(total.and_measured),
        grouped(inspection.toffoli_depth),
    );
    let width = right
        .max(text_width(&figures) + 40.0)
        .max(40.0 + 1.6 * text_width(&title));
    let mut canvas = Canvas::large(&title, width, bottom + 58.0, &figures);
    legend(&mut canvas);
    for wire in 0..frame.wires.len() {
        draw_wire(&mut canvas, &frame, wire, right);
    }
    for (place, item) in frame.boxes.iter().enumerate() {
        draw_box(&mut canvas, &frame, place, item);
        let x = column(place);
        canvas.text("small mid", [x, bottom + 12.0], &short(item.cost.toffoli));
    }
    canvas.text("small end soft", [LEFT - 12.0, bottom + 12.0], "Toffoli");
    parts(&mut canvas, &frame, bottom + 26.0);
    canvas
}

fn column(place: usize) -> f64 {
    LEFT + COLUMN * (place as f64 + 0.5)
}

fn row(wire: usize) -> f64 {
    TOP + ROW * (wire as f64 + 0.5) - 10.0
}

fn legend(canvas: &mut Canvas) {
    let y = 76.0;
    canvas.circle("dot", [28.0, y], 3.5);
    canvas.text("small", [38.0, y + 4.0], "read");
    canvas.rectangle("dot", [76.0, y - 4.0, 8.0, 8.0]);
    canvas.text(
        "small",
        [90.0, y + 4.0],
        "computed, or returned to zero by an inverse (\u{2020})",
    );
}

fn draw_wire(canvas: &mut Canvas, frame: &CallDiagram, wire: usize, right: f64) {
    let y = row(wire);
    let Some(item) = frame.wires.get(wire) else {
        return;
    };
    canvas.text("end", [LEFT - 64.0, y + 4.0], &item.name);
    canvas.text("small end", [LEFT - 16.0, y + 4.0], &grouped(item.qubits));
    let start = LEFT - 10.0;
    canvas.line("grid", [start, y], [right - 10.0, y]);
    let held = frame.held(wire);
    let from = if item.input {
        start
    } else {
        column(held.start.saturating_sub(1))
    };
    let to = if item.input {
        right - 10.0
    } else {
        column(held.end.saturating_sub(1))
    };
    canvas.line("wire", [from, y], [to, y]);
    // The slash that marks a bundle of qubits.
    let slash = LEFT - 4.0;
    canvas.line("wire", [slash - 3.0, y + 5.0], [slash + 3.0, y - 5.0]);
}

fn draw_box(canvas: &mut Canvas, frame: &CallDiagram, place: usize, item: &DiagramBox) {
    let x = column(place);
    let touched = |wire: usize| item.reads.contains(&wire) || item.writes.contains(&wire);
    let work = frame.wires.len() - 1;
    let first = (0..work).find(|&wire| touched(wire));
    let last = (0..work).rfind(|&wire| touched(wire));
    if let (Some(first), Some(last)) = (first, last) {
        let (top, bottom) = (row(first) - RIM, row(last) + RIM);
        let class = if item.stage == StageName::Flip {
            "box flip"
        } else if item.inverse {
            "box undo"
        } else {
            "box"
        };
        let mark = if item.inverse { "\u{2020}" } else { "" };
        let name = format!("{}{mark}", item.name);
        let hint = format!(
            "{name}: {} Toffoli, {} AND measured, {} CNOT, {} X",
            grouped(item.cost.toffoli),
            grouped(item.cost.and_measured),
            grouped(item.cost.cnot),
            grouped(item.cost.x)
        );
        let left = x - BOX / 2.0;
        canvas.hinted(class, [left, top, BOX, bottom - top], &hint);
        for wire in first..=last {
            if !touched(wire) {
                let y = row(wire);
                canvas.line("grid", [left + 1.0, y], [left + BOX - 1.0, y]);
            }
        }
        let middle = f64::midpoint(top, bottom);
        if text_width(&name) < BOX - 4.0 {
            canvas.text("mid", [x, middle + 4.0], &name);
        } else {
            let height = bottom - top - 4.0;
            let brief = brief(&name);
            let (size, label) = match text_width(&name) {
                width if width <= height => ("", &name),
                width if width * SMALL <= height => ("small", &name),
                _ => ("small", &brief),
            };
            canvas.upright(size, [x + 4.0, middle], label);
        }
    }
    for &wire in &item.reads {
        canvas.circle("dot", [x - BOX / 2.0, row(wire)], 3.5);
    }
    for &wire in &item.writes {
        // The square is at the edge where the wire's value begins or, for an inverse, ends.
        let edge = match (wire == work, item.inverse) {
            (true, _) => x,
            (_, false) => x + BOX / 2.0,
            (_, true) => x - BOX / 2.0,
        };
        canvas.rectangle("dot", [edge - 4.0, row(wire) - 4.0, 8.0, 8.0]);
    }
}

/// Shortens `Find Intersection 0` to `Find 0`.
fn brief(name: &str) -> String {
    let mut words = name.split(' ');
    let first = words.next().unwrap_or_default();
    match words.next_back() {
        Some(last) => format!("{first} {last}"),
        None => first.to_owned(),
    }
}

/// Draws bars with the names of the parts.
fn parts(canvas: &mut Canvas, frame: &CallDiagram, y: f64) {
    for part in CallPart::ALL {
        let first = frame.boxes.iter().position(|b| b.part == part);
        let last = frame.boxes.iter().rposition(|b| b.part == part);
        if let (Some(first), Some(last)) = (first, last) {
            let (left, right) = (column(first) - BOX / 2.0, column(last) + BOX / 2.0);
            canvas.rectangle("stage", [left, y, right - left, 18.0]);
            let cost: u64 = frame.boxes[first..=last]
                .iter()
                .map(|b| b.cost.toffoli)
                .sum();
            let long = format!("{}: {} Toffoli", part.name(), grouped(cost));
            let texts = [long, part.name().to_owned()];
            let fits = texts.iter().find(|text| text_width(text) <= right - left);
            if let Some(text) = fits {
                canvas.text("small mid", [f64::midpoint(left, right), y + 13.0], text);
            }
        }
    }
}

/// Formats `1234567` as `1.23 M`: three digits, for places with little space.
fn short(number: u64) -> String {
    let units = [
        (1_000_000_000_000, "T"),
        (1_000_000_000, "G"),
        (1_000_000, "M"),
        (1000, "k"),
    ];
    let Some(&(size, unit)) = units.iter().find(|&&(size, _)| number >= size) else {
        return number.to_string();
    };
    let value = number as f64 / size as f64;
    let places = if value < 9.995 {
        2
    } else {
        usize::from(value < 99.95)
    };
    format!("{value:.places$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_have_three_digits() {
        for (number, text) in [
            (0, "0"),
            (999, "999"),
            (1000, "1.00 k"),
            (12_345, "12.3 k"),
            (999_949, "1000 k"),
            (5_600_000_000, "5.60 G"),
        ] {
            assert_eq!(short(number), text);
        }
    }
}
