//! SVG drawings under construction.

use crate::escape::escaped;
use crate::palette::style_sheet;
use std::fmt::Write as _;

/// A drawing under construction: SVG elements, each with classes of [`crate::style_sheet`].
#[derive(Clone, Debug)]
pub struct Canvas {
    title: String,
    /// The description for readers who cannot see the drawing.
    says: String,
    width: f64,
    height: f64,
    large: bool,
    body: String,
}

/// Ratio of the font size of class `small` to the default size, on large drawings.
pub const SMALL: f64 = 0.875;

impl Canvas {
    /// Creates an empty drawing with a title. It is as wide as its page allows.
    pub fn new(title: &str, width: f64, height: f64) -> Self {
        let mut canvas = Self::empty(title, width, height);
        canvas.text("title", [14.0, 22.0], title);
        canvas
    }

    /// Creates an empty drawing for a page of its own, with a title and a line of figures. The page
    /// shows it at its own size, however large.
    pub fn large(title: &str, width: f64, height: f64, figures: &str) -> Self {
        let mut canvas = Self::empty(title, width, height);
        canvas.large = true;
        canvas.text("title", [20.0, 30.0], title);
        canvas.text("soft", [20.0, 50.0], figures);
        canvas
    }

    fn empty(title: &str, width: f64, height: f64) -> Self {
        Self {
            title: title.to_owned(),
            says: String::new(),
            width,
            height,
            large: false,
            body: String::new(),
        }
    }

    /// Sets the description for readers who cannot see the drawing.
    pub fn describe(&mut self, says: &str) {
        says.clone_into(&mut self.says);
    }

    // Writing to a string cannot fail.
    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{element}");
    }

    /// Adds a text at a point, in units of the drawing.
    pub fn text(&mut self, class: &str, at: [f64; 2], text: &str) {
        self.text_and(class, at, text, "");
    }

    /// Adds a text, followed by `aside` in the soft colour.
    pub(crate) fn text_and(&mut self, class: &str, at: [f64; 2], text: &str, aside: &str) {
        let ([x, y], class, text) = (at.map(number), classes(class), escaped(text));
        if aside.is_empty() {
            self.push(format_args!(
                "<text{class} x=\"{x}\" y=\"{y}\">{text}</text>"
            ));
        } else {
            let aside = escaped(aside);
            self.push(format_args!(
                "<text{class} x=\"{x}\" y=\"{y}\">{text} <tspan class=\"soft\">{aside}</tspan></text>"
            ));
        }
    }

    /// Adds a text that runs upwards, centred on `at`.
    pub fn upright(&mut self, class: &str, at: [f64; 2], text: &str) {
        let ([x, y], text) = (at.map(number), escaped(text));
        let class = classes(&format!("{class} mid"));
        self.push(format_args!(
            "<text{class} transform=\"translate({x} {y}) rotate(-90)\">{text}</text>"
        ));
    }

    /// Adds a path with the path data `d`.
    pub fn path(&mut self, class: &str, d: &str) {
        self.push(format_args!("<path class=\"{class}\" d=\"{d}\"/>"));
    }

    /// Adds a path with the path data `d`, whose origin is moved to `at`.
    pub(crate) fn path_at(&mut self, class: &str, at: [f64; 2], d: &str) {
        let [x, y] = at.map(number);
        self.push(format_args!(
            "<path class=\"{class}\" transform=\"translate({x} {y})\" d=\"{d}\"/>"
        ));
    }

    /// Adds a line between two points.
    pub fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        self.path(class, &polyline(&[from, to]));
    }

    /// Adds a rectangle. `place` is its left, top, width and height.
    pub fn rectangle(&mut self, class: &str, place: [f64; 4]) {
        self.hinted(class, place, "");
    }

    /// Adds a rectangle as [`Canvas::rectangle`] does. Pointing at it shows `hint`.
    pub fn hinted(&mut self, class: &str, place: [f64; 4], hint: &str) {
        let [x, y, w, h] = place.map(number);
        let end = if hint.is_empty() {
            "/>".to_owned()
        } else {
            format!("><title>{}</title></rect>", escaped(hint))
        };
        self.push(format_args!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"{end}"
        ));
    }

    /// Adds a circle with a centre and a radius.
    pub fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        let [x, y, r] = [x, y, radius].map(number);
        self.push(format_args!(
            "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>"
        ));
    }

    /// Adds round dots, all in one element.
    pub fn dots(&mut self, class: &str, places: impl IntoIterator<Item = [f64; 2]>) {
        let mut d = String::new();
        for [x, y] in places.into_iter().map(|at| at.map(number)) {
            let _ = write!(d, "M{x} {y}h0");
        }
        self.path(&format!("dots {class}"), &d);
    }

    /// Adds an arrow with its head at `to`.
    pub fn arrow(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
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

    /// Returns the drawing as a file of its own.
    pub fn svg(&self) -> String {
        self.finished(&format!("<style>{}</style>\n", style_sheet()))
    }

    /// Returns the drawing as a part of a page whose styles include [`crate::style_sheet`].
    pub fn inline_svg(&self) -> String {
        self.finished("")
    }

    fn finished(&self, style: &str) -> String {
        let (title, body) = (escaped(&self.title), &self.body);
        let [width, height] = [self.width, self.height].map(number);
        let size = format!("width=\"{width}\" height=\"{height}\"");
        let (class, own_size) = if self.large {
            ("drawing large", format!(" {size}"))
        } else {
            ("drawing", String::new())
        };
        let says = match escaped(&self.says) {
            none if none.is_empty() => none,
            says => format!("<desc>{says}</desc>\n"),
        };
        format!(
            "<svg class=\"{class}\" xmlns=\"http://www.w3.org/2000/svg\" \
             viewBox=\"0 0 {width} {height}\"{own_size} role=\"img\">\n<title>{title}</title>\n\
             {says}{style}<rect class=\"page\" {size}/>\n{body}</svg>\n"
        )
    }
}

/// Returns the `class` attribute, or nothing if there are no classes.
fn classes(class: &str) -> String {
    match class.trim() {
        "" => String::new(),
        class => format!(" class=\"{class}\""),
    }
}

/// Returns the path data of straight lines from each place to the next.
pub fn polyline(places: &[[f64; 2]]) -> String {
    let mut d = String::new();
    for (k, [x, y]) in places.iter().map(|place| place.map(number)).enumerate() {
        let letter = if k == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{letter}{x} {y}");
    }
    d
}

/// Formats a number with at most two decimals, and without trailing zeros.
///
/// ```
/// assert_eq!([2.0, 0.125, -0.001].map(qrt_drawing::number), ["2", "0.12", "0"]);
/// ```
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

/// Returns a width in which `text` certainly fits, in letters of 12 pixels.
pub fn text_width(text: &str) -> f64 {
    7.0 * text.chars().count() as f64
}
