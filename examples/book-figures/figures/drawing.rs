//! Small drawings in the style of [`qrt::runtime::plot`], which has logarithmic axes only.

use qrt::runtime::plot::CSS;
use std::fmt::Write as _;

/// What drawings need beyond plots.
const MORE: &str = "\
.plot .small{font-size:12px}.plot .thin{fill:none;stroke-width:1}.plot .dash{stroke-dasharray:5 4}
.plot .dots{fill:none;stroke-width:3.4;stroke-linecap:round}.plot .solid{fill:currentColor;stroke:none}
.plot .pale{fill:currentColor;fill-opacity:.22;stroke-width:1}
.plot .axis{color:var(--soft)}";

/// A drawing in the making.
pub(crate) struct Canvas {
    title: String,
    width: f64,
    height: f64,
    body: String,
}

/// Where a text's point is.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    /// An empty drawing under a title.
    pub(crate) fn new(title: &str, width: f64, height: f64) -> Self {
        let mut canvas = Self {
            title: title.to_owned(),
            width,
            height,
            body: String::new(),
        };
        canvas.text("title", [14.0, 22.0], Anchor::Start, title);
        canvas
    }

    pub(crate) fn text(&mut self, class: &str, [x, y]: [f64; 2], anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let class = if class.is_empty() {
            String::new()
        } else {
            format!(" class=\"{class}\"")
        };
        let (x, y, text) = (number(x), number(y), escaped(text));
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.body,
            "<text{class} x=\"{x}\" y=\"{y}\"{anchor}>{text}</text>"
        );
    }

    /// A text that runs upwards, about its middle.
    pub(crate) fn upright(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        let (x, y, text) = (number(x), number(y), escaped(text));
        let _ = writeln!(
            self.body,
            "<text class=\"{class}\" transform=\"translate({x} {y}) rotate(-90)\" \
             text-anchor=\"middle\">{text}</text>"
        );
    }

    pub(crate) fn path(&mut self, class: &str, d: &str) {
        let _ = writeln!(self.body, "<path class=\"{class}\" d=\"{d}\"/>");
    }

    pub(crate) fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        self.path(class, &polyline(&[from, to]));
    }

    pub(crate) fn rectangle(&mut self, class: &str, [x, y, width, height]: [f64; 4]) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        let _ = writeln!(
            self.body,
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"
        );
    }

    pub(crate) fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        let [x, y, r] = [x, y, radius].map(number);
        let _ = writeln!(
            self.body,
            "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>"
        );
    }

    /// Round dots, all in one element.
    pub(crate) fn dots(&mut self, class: &str, places: impl IntoIterator<Item = [f64; 2]>) {
        let mut d = String::new();
        for [x, y] in places {
            let _ = write!(d, "M{} {}h0", number(x), number(y));
        }
        self.path(&format!("dots {class}"), &d);
    }

    /// A vector with its head.
    pub(crate) fn arrow(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = libm::hypot(along[0], along[1]);
        let unit = along.map(|a| a / length);
        let side = |back: f64, aside: f64| {
            [
                to[0] - back * unit[0] - aside * unit[1],
                to[1] - back * unit[1] + aside * unit[0],
            ]
        };
        self.line(&format!("line {class}"), from, side(8.0, 0.0));
        let head = format!("{}z", polyline(&[to, side(11.0, 4.5), side(11.0, -4.5)]));
        self.path(&format!("solid {class}"), &head);
    }

    /// The drawing as a file; `says` is for those who cannot see it.
    pub(crate) fn finish(self, says: &str) -> String {
        let Self {
            title,
            width,
            height,
            body,
        } = self;
        let (title, says) = (escaped(&title), escaped(says));
        format!(
            "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{title}</title>\n\
             <desc>{says}</desc>\n<style>{CSS}\n{MORE}</style>\n\
             <rect class=\"page\" width=\"{width}\" height=\"{height}\"/>\n{body}</svg>\n"
        )
    }
}

/// A drawing of the library's with a description after its title.
pub(crate) fn described(svg: &str, says: &str) -> String {
    let says = escaped(says);
    svg.replacen("</title>\n", &format!("</title>\n<desc>{says}</desc>\n"), 1)
}

/// Straight from each place to the next.
pub(crate) fn polyline(places: &[[f64; 2]]) -> String {
    let mut d = String::new();
    for (k, &[x, y]) in places.iter().enumerate() {
        let letter = if k == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{letter}{} {}", number(x), number(y));
    }
    d
}

/// Two places after the point, and no more than it takes.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// A rectangle with linear axes.
pub(crate) struct Panel {
    /// Left, top, right, bottom on the drawing.
    pub(crate) edges: [f64; 4],
    /// What the left and the right edge stand for.
    pub(crate) x: [f64; 2],
    /// What the bottom and the top stand for.
    pub(crate) y: [f64; 2],
}

impl Panel {
    /// Where a point is on the drawing.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.edges;
        [
            left + (right - left) * (x - self.x[0]) / (self.x[1] - self.x[0]),
            bottom - (bottom - top) * (y - self.y[0]) / (self.y[1] - self.y[0]),
        ]
    }

    /// Axes with ticks (value, label), and what they measure.
    pub(crate) fn axes(
        &self,
        canvas: &mut Canvas,
        [x, y]: [&[(f64, String)]; 2],
        labels: [&str; 2],
    ) {
        let [left, top, right, bottom] = self.edges;
        for (value, label) in x {
            let at = self.at([*value, 0.0])[0];
            canvas.line("grid", [at, top], [at, bottom]);
            canvas.text("soft", [at, bottom + 18.0], Anchor::Middle, label);
        }
        for (value, label) in y {
            let at = self.at([0.0, *value])[1];
            canvas.line("grid", [left, at], [right, at]);
            canvas.text("soft", [left - 7.0, at + 5.0], Anchor::End, label);
        }
        let corners = [[left, top], [left, bottom], [right, bottom]];
        canvas.path("axis", &polyline(&corners));
        let middle = f64::midpoint(left, right);
        canvas.text("", [middle, bottom + 40.0], Anchor::Middle, labels[0]);
        canvas.upright("", [left - 56.0, f64::midpoint(top, bottom)], labels[1]);
    }

    /// Straight lines through points.
    pub(crate) fn curve(&self, points: impl IntoIterator<Item = [f64; 2]>) -> String {
        let places: Vec<[f64; 2]> = points.into_iter().map(|point| self.at(point)).collect();
        polyline(&places)
    }
}

/// Ticks at these values, with as many decimals.
pub(crate) fn ticks(values: impl IntoIterator<Item = f64>, decimals: usize) -> Vec<(f64, String)> {
    let tick = |value: f64| (value, minus(&format!("{value:.decimals$}")));
    values.into_iter().map(tick).collect()
}

/// A number with the sign that is as wide as a plus.
pub(crate) fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}
