//! A plot as SVG: 580 units wide, which a telephone shows at some 0.75 and a page at 1.

use super::axis::Tick;
use super::legend::{COLUMNS, LINE, legend, names, put_mark};
use super::style::{CSS, class, hollow};
use super::{Axis, Drawn, Fit, Plot, Series};
use std::fmt::Write as _;

pub(super) const WIDTH: f64 = 580.0;
const LEFT: f64 = 76.0;
pub(super) const RIGHT: f64 = WIDTH - 144.0;
pub(super) const TOP: f64 = 40.0;
pub(super) const BOTTOM: f64 = TOP + 300.0;
/// Of fits drawn as curves.
const BAND_STEPS: i32 = 24;

/// Where places on the axes are on the drawing.
pub(super) struct Frame<'a> {
    plot: &'a Plot,
    x: (f64, f64),
    y: (f64, f64),
}

impl Frame<'_> {
    pub(super) fn x(&self, place: f64) -> f64 {
        LEFT + (RIGHT - LEFT) * (place - self.x.0) / (self.x.1 - self.x.0)
    }

    pub(super) fn y(&self, place: f64) -> f64 {
        BOTTOM - (BOTTOM - TOP) * (place - self.y.0) / (self.y.1 - self.y.0)
    }

    /// As [`Frame::y`], but not beyond the frame.
    fn y_within(&self, place: f64) -> f64 {
        self.y(place).clamp(TOP, BOTTOM)
    }
}

/// One series, ready to be drawn.
pub(super) struct Curve<'a> {
    pub(super) number: usize,
    pub(super) series: &'a Series,
    pub(super) places: Vec<[f64; 4]>,
    pub(super) fit: Option<Fit>,
}

pub(super) fn draw(plot: &Plot, whole: bool) -> String {
    let curves: Vec<Curve<'_>> = (plot.series.iter().enumerate())
        .map(|(number, series)| Curve {
            number,
            series,
            places: series.places(&plot.x, &plot.y),
            fit: series.fit(&plot.x, &plot.y),
        })
        .filter(|curve| !curve.places.is_empty())
        .collect();
    let places = || curves.iter().flat_map(|curve| &curve.places);
    let frame = Frame {
        plot,
        x: extent(&plot.x, places().map(|p| p[0])),
        // Error bars may leave the frame where points do not.
        y: extent(&plot.y, places().map(|p| p[1])),
    };
    let rows = curves.len().div_ceil(COLUMNS);
    let height = BOTTOM + 56.0 + LINE * rows as f64;
    let mut svg = format!(
        "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         role=\"img\">\n<title>{}</title>\n",
        escaped(&plot.title)
    );
    if whole {
        let _ = writeln!(svg, "<style>{CSS}</style>");
    }
    let _ = writeln!(
        svg,
        "<rect class=\"page\" width=\"{WIDTH}\" height=\"{height}\"/>\
         <text class=\"title\" x=\"14\" y=\"22\">{}</text>",
        escaped(&plot.title)
    );
    axes(&mut svg, &frame);
    if curves.is_empty() {
        let _ = writeln!(
            svg,
            "<text class=\"soft\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">nothing to show: \
             all values are 0</text>",
            0.5 * (LEFT + RIGHT),
            0.5 * (TOP + BOTTOM)
        );
    }
    for curve in &curves {
        band(&mut svg, &frame, curve);
    }
    for curve in &curves {
        lines(&mut svg, &frame, curve);
    }
    names(&mut svg, &frame, &curves);
    legend(&mut svg, &curves);
    svg.push_str("</svg>\n");
    svg
}

fn extent(axis: &Axis, places: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    if low > high {
        axis.range(0.0, 0.0)
    } else {
        axis.range(low, high)
    }
}

fn axes(svg: &mut String, frame: &Frame<'_>) {
    let Plot { x, y, .. } = frame.plot;
    for Tick { value, label } in x.ticks(frame.x, 9) {
        let at = frame.x(value);
        let _ = writeln!(
            svg,
            "<path class=\"grid\" d=\"M{at:.1} {TOP}V{BOTTOM}\"/>\
             <text class=\"soft\" x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
            BOTTOM + 18.0
        );
    }
    for Tick { value, label } in y.ticks(frame.y, 9) {
        let at = frame.y(value);
        let _ = writeln!(
            svg,
            "<path class=\"grid\" d=\"M{LEFT} {at:.1}H{RIGHT}\"/>\
             <text class=\"soft\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            LEFT - 7.0,
            at + 5.0
        );
    }
    let _ = writeln!(
        svg,
        "<path class=\"axis\" d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\"/>\
         <text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>\
         <text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        0.5 * (LEFT + RIGHT),
        BOTTOM + 40.0,
        escaped(&x.label),
        0.5 * (TOP + BOTTOM),
        escaped(&y.label),
    );
}

/// The outline of a fit's band at 95 %.
fn band(svg: &mut String, frame: &Frame<'_>, curve: &Curve<'_>) {
    let Some(fit) = curve.fit.filter(|fit| fit.slope_band.is_finite()) else {
        return;
    };
    let (first, last) = ends(curve);
    let steps =
        || (0..=BAND_STEPS).map(|k| first + (last - first) * f64::from(k) / f64::from(BAND_STEPS));
    let edge = |x: f64, side: f64| {
        let logarithm = frame.plot.x.logarithm(x);
        let y = fit.at(logarithm) + side * fit.band(logarithm);
        (frame.x(x), frame.y_within(unlogarithm(&frame.plot.y, y)))
    };
    let upper = steps().map(|x| edge(x, 1.0));
    let lower = steps().rev().map(|x| edge(x, -1.0));
    let outline: Vec<String> = upper
        .chain(lower)
        .map(|(x, y)| format!("{x:.1} {y:.1}"))
        .collect();
    let _ = writeln!(
        svg,
        "<path class=\"band ink s{}\" d=\"M{}z\"/>",
        class(curve.number),
        outline.join("L")
    );
}

/// From a logarithm to the base 10 back to a place.
fn unlogarithm(axis: &Axis, logarithm: f64) -> f64 {
    logarithm / axis.logarithm(1.0)
}

/// The first and the last x.
fn ends(curve: &Curve<'_>) -> (f64, f64) {
    let xs = || curve.places.iter().map(|p| p[0]);
    (
        xs().fold(f64::INFINITY, f64::min),
        xs().fold(f64::NEG_INFINITY, f64::max),
    )
}

fn lines(svg: &mut String, frame: &Frame<'_>, curve: &Curve<'_>) {
    let style = class(curve.number);
    let dashes = if hollow(curve.number) {
        " stroke-dasharray=\"6 4\""
    } else {
        ""
    };
    let mut path = String::new();
    match (curve.series.drawn, curve.fit) {
        (Drawn::Points, _) | (Drawn::Fit, None) => {}
        (Drawn::Fit, Some(fit)) => {
            let (first, last) = ends(curve);
            let y = |x: f64| {
                let y = fit.at(frame.plot.x.logarithm(x));
                frame.y_within(unlogarithm(&frame.plot.y, y))
            };
            let _ = write!(
                path,
                "M{:.1} {:.1}L{:.1} {:.1}",
                frame.x(first),
                y(first),
                frame.x(last),
                y(last)
            );
        }
        (drawn, _) => {
            for (k, p) in curve.places.iter().enumerate() {
                let (x, y) = (frame.x(p[0]), frame.y(p[1]));
                let _ = match (k, drawn) {
                    (0, _) => write!(path, "M{x:.1} {y:.1}"),
                    (_, Drawn::Steps) => write!(path, "H{x:.1}V{y:.1}"),
                    _ => write!(path, "L{x:.1} {y:.1}"),
                };
            }
        }
    }
    if !path.is_empty() {
        let _ = writeln!(svg, "<path class=\"line s{style}\"{dashes} d=\"{path}\"/>");
    }
    for p in &curve.places {
        let (x, low, high) = (frame.x(p[0]), frame.y_within(p[2]), frame.y_within(p[3]));
        if low - high > 1.0 {
            let _ = writeln!(
                svg,
                "<path class=\"bar s{style}\" d=\"M{x:.1} {low:.1}V{high:.1}\"/>"
            );
        }
        put_mark(svg, curve.number, x, frame.y(p[1]));
    }
}

/// Text that holds none of XML's own characters.
pub(super) fn escaped(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut out = String::new();
    for c in plain {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}
