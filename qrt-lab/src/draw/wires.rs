//! A small circuit, gate by gate: one wire for each qubit, time to the right.

use qrt_circuit::Qubit;
use qrt_circuit::quantum::{QuantumGate, Turns};
use qrt_drawing::{Canvas, minus, text_width};

/// The distance between wires, and between the centres of gates, in units of the drawing.
const ROW: f64 = 36.0;
const COLUMN: f64 = 38.0;
/// The side of a gate's box.
const SIDE: f64 = 26.0;
/// The y coordinate of the first wire, below the title.
const TOP: f64 = 62.0;
/// The smallest width of a drawing, so that letters in small circuits are as large as in other
/// drawings.
const WIDTH: f64 = 580.0;

/// A drawing of a small circuit's gates, in the order in which they run.
///
/// Qubit k is wire k, counted from the top. Each gate is as far to the left as its wires allow, but
/// not to the left of the beginning of its part.
///
/// ```
/// use qrt_circuit::quantum::QuantumGate::{Cx, H};
/// use qrt_lab::draw::Wires;
///
/// let mut wires = Wires::new(&[("index", "id"), ("flag", "flag")]);
/// wires.gate(H(0));
/// wires.gate(Cx(0, 1));
/// let svg = wires.draw("A copy").svg();
/// assert!(svg.contains(">H</text>") && svg.contains(">index</text>"));
/// ```
#[derive(Clone, Debug)]
pub struct Wires {
    /// The name of each wire, and the palette class for the colour of its contents.
    names: Vec<(String, String)>,
    items: Vec<Item>,
    /// The first free column of each wire.
    free: Vec<usize>,
    /// The name and the first column of each part; the last part is the current one.
    parts: Vec<(String, usize)>,
}

/// A gate in its column.
#[derive(Clone, Debug)]
struct Item {
    column: usize,
    columns: usize,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// The controls, and the target.
    Flip(Vec<Qubit>, Qubit),
    /// A label in a box.
    Boxed(String, Qubit),
    /// The qubits that have a dot, and the phase in turns, or an empty text for half a turn.
    Phase(Vec<Qubit>, String),
    /// A global phase.
    Global(String),
    /// A box over neighbouring wires, and its control if it has one.
    Block(String, [Qubit; 2], Option<Qubit>),
    Measure(Qubit),
}

impl Wires {
    /// Creates a circuit without gates. `names` holds the name of each qubit and the class of a
    /// colour of [`qrt_drawing::style_sheet`] for its contents (`id`, `comparator`, `flag`,
    /// `colour`, `work`), or an empty class.
    pub fn new(names: &[(&str, &str)]) -> Self {
        let owned = |(name, class): &(&str, &str)| ((*name).to_owned(), (*class).to_owned());
        Self {
            names: names.iter().map(owned).collect(),
            items: Vec::new(),
            free: vec![0; names.len()],
            parts: Vec::new(),
        }
    }

    /// Begins a part: later gates belong to it, and its name is written below them.
    pub fn part(&mut self, name: &str) {
        let next = self.columns();
        self.free.fill(next);
        self.parts.push((name.to_owned(), next));
    }

    /// Number of columns, with room for all gates and for the name of the last part.
    fn columns(&self) -> usize {
        let gates = self.free.iter().max().copied().unwrap_or(0);
        let named = self.parts.last().map_or(0, |(name, first)| {
            first + (text_width(name) / COLUMN).ceil() as usize
        });
        gates.max(named)
    }

    /// Adds a gate. A gate with a qubit beyond the wires is left out.
    pub fn gate(&mut self, gate: QuantumGate<'_>) {
        let mut qubits = Vec::new();
        gate.qubits(|qubit| qubits.push(qubit));
        let kind = match gate {
            QuantumGate::X(target) => Kind::Flip(Vec::new(), target),
            QuantumGate::Cx(control, target) => Kind::Flip(vec![control], target),
            QuantumGate::Ccx(a, b, target) => Kind::Flip(vec![a, b], target),
            QuantumGate::H(target) => Kind::Boxed("H".to_owned(), target),
            QuantumGate::Ry { target, .. } => Kind::Boxed("R".to_owned(), target),
            QuantumGate::Phase { turns, on: [] } => Kind::Global(factor(turns)),
            QuantumGate::Phase { turns, on: [one] } if turns == Turns::HALF => {
                Kind::Boxed("Z".to_owned(), *one)
            }
            QuantumGate::Phase { turns, on: [one] } => Kind::Boxed(fraction(turns), *one),
            QuantumGate::Phase { turns, on } if turns == Turns::HALF => {
                Kind::Phase(on.to_vec(), String::new())
            }
            QuantumGate::Phase { turns, on } => Kind::Phase(on.to_vec(), fraction(turns)),
        };
        self.put(kind, &qubits, 1);
    }

    /// Adds a named box over the wires from the first to the last. The box stands for gates that
    /// are not drawn. If `control` is set, a dot on that wire controls the box.
    pub fn block(&mut self, name: &str, wires: [Qubit; 2], control: Option<Qubit>) {
        let all: Vec<Qubit> = wires.into_iter().chain(control).collect();
        let width = text_width(name) + 14.0;
        let columns = (width / COLUMN).ceil().max(1.0) as usize;
        self.put(Kind::Block(name.to_owned(), wires, control), &all, columns);
    }

    /// Adds a measurement of a qubit.
    pub fn measure(&mut self, qubit: Qubit) {
        self.put(Kind::Measure(qubit), &[qubit], 1);
    }

    /// Puts a gate into the first column in which all wires between its outermost qubits are free.
    fn put(&mut self, kind: Kind, qubits: &[Qubit], columns: usize) {
        let all = self.free.len();
        let first = qubits.iter().min().map_or(0, |q| *q as usize);
        let last = qubits.iter().max().map_or(all, |q| *q as usize + 1);
        let Some(between) = self.free.get_mut(first..last) else {
            return;
        };
        let column = between.iter().max().copied().unwrap_or(0);
        between.fill(column + columns);
        self.items.push(Item {
            column,
            columns,
            kind,
        });
    }

    /// Draws the circuit under a title.
    pub fn draw(&self, title: &str) -> Canvas {
        let names = self.names.iter().map(|(name, _)| text_width(name));
        let left = names.fold(30.0, f64::max) + 40.0;
        let columns = self.columns().max(1);
        let right = left + COLUMN * columns as f64 + 12.0;
        let bottom = TOP + ROW * self.names.len() as f64 - 8.0;
        let parts = if self.parts.is_empty() { 0.0 } else { 26.0 };
        let width = (right + 14.0)
            .max(1.35 * text_width(title) + 28.0)
            .max(WIDTH);
        let mut canvas = Canvas::new(title, width, bottom + parts + 8.0);
        for (wire, (name, class)) in self.names.iter().enumerate() {
            let y = row(wire as Qubit);
            if !class.is_empty() {
                canvas.rectangle(class, [left - 18.0, y - 5.0, 10.0, 10.0]);
            }
            canvas.text("end", [left - 24.0, y + 5.0], name);
            canvas.line("wire", [left - 4.0, y], [right, y]);
        }
        for item in &self.items {
            let middle = item.column as f64 + item.columns as f64 / 2.0;
            draw_item(&mut canvas, item, left + COLUMN * middle);
        }
        for (place, (name, first)) in self.parts.iter().enumerate() {
            let next = self.parts.get(place + 1);
            let last = next.map_or(columns, |(_, column)| *column);
            let [from, to] = [*first, last].map(|column| left + COLUMN * column as f64);
            let class = if place % 2 == 0 { "stage" } else { "stage2" };
            canvas.rectangle(class, [from + 1.0, bottom, to - from - 2.0, 20.0]);
            let middle = f64::midpoint(from, to);
            canvas.text("small mid", [middle, bottom + 14.0], name);
        }
        canvas
    }
}

fn row(wire: Qubit) -> f64 {
    TOP + ROW * f64::from(wire)
}

fn draw_item(canvas: &mut Canvas, item: &Item, x: f64) {
    match &item.kind {
        Kind::Flip(controls, target) => {
            joined(canvas, x, controls.iter().chain([target]).copied());
            for control in controls {
                canvas.circle("dot", [x, row(*control)], 4.5);
            }
            let y = row(*target);
            canvas.circle("box", [x, y], 10.0);
            canvas.line("wire", [x - 10.0, y], [x + 10.0, y]);
            canvas.line("wire", [x, y - 10.0], [x, y + 10.0]);
        }
        Kind::Boxed(name, target) => {
            let flips = name == "Z";
            let class = if flips { "box flip" } else { "box" };
            let width = SIDE.max(text_width(name) + 8.0);
            let y = row(*target);
            canvas.rectangle(class, [x - width / 2.0, y - SIDE / 2.0, width, SIDE]);
            canvas.text("mid", [x, y + 5.0], name);
        }
        Kind::Phase(on, turns) => {
            joined(canvas, x, on.iter().copied());
            for qubit in on {
                canvas.circle("dot", [x, row(*qubit)], 4.5);
            }
            if let Some(first) = on.iter().min().filter(|_| !turns.is_empty()) {
                canvas.text("small", [x + 4.0, row(*first) + 18.0], turns);
            }
        }
        Kind::Global(factor) => canvas.text("soft mid", [x, TOP - 18.0], factor),
        Kind::Block(name, [first, last], control) => {
            if let Some(control) = control {
                joined(canvas, x, [*first, *last, *control].into_iter());
                canvas.circle("dot", [x, row(*control)], 4.5);
            }
            let (top, bottom) = (row(*first) - SIDE / 2.0, row(*last) + SIDE / 2.0);
            let width = COLUMN * item.columns as f64 - 10.0;
            canvas.rectangle("box", [x - width / 2.0, top, width, bottom - top]);
            canvas.text("mid", [x, f64::midpoint(top, bottom) + 5.0], name);
        }
        Kind::Measure(qubit) => {
            let y = row(*qubit);
            canvas.rectangle("box", [x - SIDE / 2.0, y - SIDE / 2.0, SIDE, SIDE]);
            let [from, to] = [x - 8.0, x + 8.0];
            let low = y + 6.0;
            canvas.path("wire", &format!("M{from} {low}A8 8 0 0 1 {to} {low}"));
            canvas.line("wire", [x, low], [x + 6.0, y - 8.0]);
        }
    }
}

/// Draws the line that joins the qubits of a gate.
fn joined(canvas: &mut Canvas, x: f64, qubits: impl Iterator<Item = Qubit>) {
    let ends = qubits.fold(None, |ends: Option<[Qubit; 2]>, qubit| {
        let [first, last] = ends.unwrap_or([qubit; 2]);
        Some([first.min(qubit), last.max(qubit)])
    });
    if let Some([first, last]) = ends.filter(|[first, last]| first < last) {
        canvas.line("wire", [x, row(first)], [x, row(last)]);
    }
}

/// Formats turns as a fraction: `−1/8`.
fn fraction(turns: Turns) -> String {
    let size = 1_u64 << turns.bits();
    minus(&format!("{}/{size}", turns.numerator()))
}

/// Formats a global phase for the text above the wires.
fn factor(turns: Turns) -> String {
    if turns == Turns::HALF {
        minus("× (-1)")
    } else {
        format!("× {} turn", fraction(turns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_circuit::quantum::QuantumGate::{Ccx, Cx, H, Phase, X};
    use qrt_circuit::quantum::{GroverIterate, PhaseOracle};

    fn named(count: usize) -> Wires {
        Wires::new(&vec![("q", "id"); count])
    }

    #[test]
    fn gates_stand_behind_all_that_their_wires_have_before() {
        let mut wires = named(3);
        for gate in [H(0), H(2), Cx(0, 2), X(1), Ccx(0, 1, 2)] {
            wires.gate(gate);
        }
        let columns: Vec<usize> = wires.items.iter().map(|item| item.column).collect();
        // The CNOT's line crosses wire 1, so the X takes the next column.
        assert_eq!(columns, [0, 0, 1, 2, 3]);
        wires.part("next");
        wires.gate(H(1));
        assert_eq!(wires.items.last().map(|item| item.column), Some(4));
    }

    #[test]
    fn every_gate_of_an_iterate_is_drawn() {
        let oracle = PhaseOracle::polynomial(3, vec![vec![0, 2]]).unwrap();
        let iterate = GroverIterate::new(&oracle);
        let mut wires = named(3);
        iterate
            .apply(None, &mut |gate| {
                wires.gate(gate);
                Ok::<(), std::convert::Infallible>(())
            })
            .unwrap();
        assert_eq!(wires.items.len() as u64, iterate.gates(false));
        let svg = wires.draw("G").svg();
        assert_eq!(svg.matches(">H</text>").count(), 6);
        // Each qubit has two Xs; the signs of O_f and O_0 have dots on two and on three qubits.
        assert_eq!(svg.matches("class=\"box\" cx").count(), 6);
        assert_eq!(svg.matches("class=\"dot\"").count(), 5);
        assert!(svg.contains("\u{d7} (\u{2212}1)"));
    }

    #[test]
    fn phases_are_told_in_turns() {
        let mut wires = named(2);
        let turns = Turns::new(-1, 3);
        wires.gate(Phase { turns, on: &[0, 1] });
        wires.gate(Phase { turns, on: &[1] });
        let svg = wires.draw("a < b").svg();
        assert_eq!(svg.matches("\u{2212}1/8").count(), 2);
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN"));
        // A gate on a qubit that is not there must not panic.
        wires.gate(H(7));
        assert_eq!(wires.items.len(), 2);
    }
}
