//! Drawings as SVG: self-contained, without scripts, in light and dark.

mod map;

pub use super::frame::svg as frame;
pub use map::registers;

use crate::compile::Role;
use std::fmt::Write as _;

/// A drawing in the making.
#[derive(Debug)]
pub(super) struct Canvas {
    text: String,
}

/// Colours: those of Paul Tol's bright scheme for roles, which people with any colour vision can
/// tell apart, lighter on dark ground.
const STYLE: &str = "\
text{font-family:system-ui,'Segoe UI','DejaVu Sans',sans-serif;font-size:12px;fill:#1c1e21}
.title{font-size:18px;font-weight:600}.small{font-size:10.5px}.faint{fill:#667}
.mid{text-anchor:middle}.end{text-anchor:end}
.ground{fill:#fff}.box{fill:#f3f5f8;stroke:#3a4250}.undo{fill:#e6eaf0}.mark{fill:#fdf0d5}
.line{stroke:#3a4250;fill:none}.thin{stroke:#c3c9d2;fill:none}.rule{stroke:#d8dce2;fill:none}
.in-use{stroke:#1c1e21;fill:none;stroke-width:1.2}.edge{stroke:#fff;stroke-width:.4}
.dot{fill:#3a4250}.stage{fill:#dfe5ee}.stage2{fill:#eef1f6}.on{fill:#fff}
.id{fill:#4477aa}.comparator{fill:#aa3377}.work{fill:#66ccee}.scratch{fill:#b8bcc4}
.colour{fill:#ee6677}.flag{fill:#228833}
@media(prefers-color-scheme:dark){
text{fill:#e4e7eb}.faint{fill:#9aa3af}.ground{fill:#15181c}
.box{fill:#232932;stroke:#aab4c2}.undo{fill:#2d3540}.mark{fill:#4a3b17}
.line{stroke:#aab4c2}.thin{stroke:#414955}.rule{stroke:#2e343d}
.in-use{stroke:#e4e7eb}.edge{stroke:#15181c}.dot{fill:#aab4c2}.stage{fill:#2f3743}
.stage2{fill:#232932}.on{fill:#0d1013}
.id{fill:#6f9fd0}.comparator{fill:#cf6aa3}.work{fill:#4aa9c9}.scratch{fill:#5d646f}
.colour{fill:#f08a96}.flag{fill:#4fae5f}}
";

impl Canvas {
    /// An empty drawing with its ground, title (for readers and for screen readers) and a line of
    /// figures below the title.
    pub(super) fn new(width: f64, height: f64, title: &str, figures: &str) -> Self {
        let mut canvas = Self {
            text: String::new(),
        };
        let title = escape(title);
        let _ = write!(
            canvas.text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\">\n\
             <title>{title}</title>\n<style>{STYLE}</style>\n\
             <rect class=\"ground\" width=\"{width}\" height=\"{height}\"/>\n\
             <text class=\"title\" x=\"20\" y=\"30\">{title}</text>\n"
        );
        canvas.text("faint", [20.0, 50.0], figures);
        canvas
    }

    /// A text of some classes.
    pub(super) fn text(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        let (x, y, text) = (number(x), number(y), escape(text));
        let _ = writeln!(
            self.text,
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\">{text}</text>"
        );
    }

    /// A text that runs upwards, about its middle.
    pub(super) fn upright(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        let (x, y, text) = (number(x), number(y), escape(text));
        let _ = writeln!(
            self.text,
            "<text class=\"{class} mid\" transform=\"translate({x} {y}) rotate(-90)\">{text}</text>"
        );
    }

    /// A rectangle; pointing at it shows `hint`.
    pub(super) fn rectangle(&mut self, class: &str, [x, y, w, h]: [f64; 4], hint: &str) {
        let [x, y, w, h] = [x, y, w, h].map(number);
        let place =
            format!("<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"");
        let _ = if hint.is_empty() {
            writeln!(self.text, "{place}/>")
        } else {
            writeln!(self.text, "{place}><title>{}</title></rect>", escape(hint))
        };
    }

    /// A path of the data `d`.
    pub(super) fn path(&mut self, class: &str, d: &str) {
        let _ = writeln!(self.text, "<path class=\"{class}\" d=\"{d}\"/>");
    }

    /// A line.
    pub(super) fn line(&mut self, class: &str, [x, y, to_x, to_y]: [f64; 4]) {
        let [x, y, to_x, to_y] = [x, y, to_x, to_y].map(number);
        self.path(class, &format!("M{x} {y}L{to_x} {to_y}"));
    }

    /// A dot.
    pub(super) fn dot(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        let [x, y, r] = [x, y, radius].map(number);
        let _ = writeln!(
            self.text,
            "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>"
        );
    }

    /// The finished drawing.
    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// The class of a role.
pub(super) fn class(role: Role) -> &'static str {
    match role {
        Role::Id => "id",
        Role::Comparator => "comparator",
        Role::Work => "work",
        Role::Scratch => "scratch",
        Role::Colour => "colour",
        Role::Flag => "flag",
    }
}

/// Two places after the point, and no more than it takes.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A width that `text` surely fits in, in letters of 12 pixels.
pub(super) fn width_of(text: &str) -> f64 {
    7.0 * text.chars().count() as f64
}

/// The size of small letters beside others.
pub(super) const SMALL: f64 = 0.875;

fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no control characters, not even escaped.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
