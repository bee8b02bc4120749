//! Panels with linear axes.

use crate::canvas::{Canvas, polyline};

/// A rectangle with linear axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Left, top, right, bottom on the drawing.
    pub edges: [f64; 4],
    /// Values of x at the left and the right edge.
    pub x: [f64; 2],
    /// Values of y at the bottom and the top edge.
    pub y: [f64; 2],
}

impl Panel {
    /// Returns the place of a point on the drawing.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.edges;
        [
            left + (right - left) * (x - self.x[0]) / (self.x[1] - self.x[0]),
            bottom - (bottom - top) * (y - self.y[0]) / (self.y[1] - self.y[0]),
        ]
    }

    /// Adds axes with ticks (value, label) and with the labels of the axes.
    pub fn axes(&self, canvas: &mut Canvas, [x, y]: [&[(f64, String)]; 2], labels: [&str; 2]) {
        let [left, top, right, bottom] = self.edges;
        for (value, label) in x {
            let at = self.at([*value, 0.0])[0];
            canvas.line("grid", [at, top], [at, bottom]);
            canvas.text("soft mid", [at, bottom + 18.0], label);
        }
        for (value, label) in y {
            let at = self.at([0.0, *value])[1];
            canvas.line("grid", [left, at], [right, at]);
            canvas.text("soft end", [left - 7.0, at + 5.0], label);
        }
        let corners = [[left, top], [left, bottom], [right, bottom]];
        canvas.path("axis", &polyline(&corners));
        let middle = f64::midpoint(left, right);
        canvas.text("mid", [middle, bottom + 40.0], labels[0]);
        canvas.upright("", [left - 60.0, f64::midpoint(top, bottom)], labels[1]);
    }

    /// Returns the path data of straight lines through points.
    pub fn curve(&self, points: impl IntoIterator<Item = [f64; 2]>) -> String {
        let places: Vec<[f64; 2]> = points.into_iter().map(|point| self.at(point)).collect();
        polyline(&places)
    }
}

/// Returns ticks at `values`, labelled with `decimals` decimals.
pub fn ticks(values: impl IntoIterator<Item = f64>, decimals: usize) -> Vec<(f64, String)> {
    let tick = |value: f64| (value, minus(&format!("{value:.decimals$}")));
    values.into_iter().map(tick).collect()
}

/// Replaces hyphens by the minus sign, which is as wide as a plus.
pub fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}
