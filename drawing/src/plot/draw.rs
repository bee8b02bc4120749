//! Drawings of plots. A plot is 580 units wide, and wider if a name or the title needs more. A
//! telephone shows 580 units at a scale of about 0.75, a page at 1.

use super::labels::apart;
use super::{Drawn, Fit, Plot, PlotAxis, Series};
use crate::canvas::{Canvas, number, polyline};
use crate::palette::{hollow, mark, series as class};
use crate::panel::{Panel, minus};
use std::fmt::Write as _;

const WIDTH: f64 = 580.0;
const LEFT: f64 = 76.0;
const RIGHT: f64 = WIDTH - 144.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = TOP + 300.0;
/// Number of steps of a band's outline.
const BAND_STEPS: i32 = 24;
/// Distance from the panel's right edge to the names of series.
const GAP: f64 = 16.0;
/// Distance between names, and between lines of the legend.
const LINE: f64 = 17.0;
/// Upper bounds on the average width of a letter, of names and of the title: those of DejaVu Sans.
const LETTER: f64 = 8.4;
const TITLE_LETTER: f64 = 8.6;
/// Left end of the title.
const TITLE_LEFT: f64 = 14.0;
/// Number of columns of the legend.
const COLUMNS: usize = 2;

/// One series, ready to be drawn.
struct Curve<'a> {
    number: usize,
    series: &'a Series,
    places: Vec<[f64; 4]>,
    fit: Option<Fit>,
}

impl Curve<'_> {
    /// Returns the first and the last x.
    fn ends(&self) -> [f64; 2] {
        let xs = || self.places.iter().map(|p| p[0]);
        [
            xs().fold(f64::INFINITY, f64::min),
            xs().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// Returns the last point.
    fn last(&self) -> [f64; 2] {
        let before = [f64::NEG_INFINITY, 0.0];
        self.places.iter().fold(
            before,
            |last, p| {
                if p[0] >= last[0] { [p[0], p[1]] } else { last }
            },
        )
    }
}

pub(super) fn plot(plot: &Plot) -> Canvas {
    let curves: Vec<Curve<'_>> = (plot.series.iter().enumerate())
        .map(|(number, series)| Curve {
            number: series.style.unwrap_or(number),
            series,
            places: series.places(&plot.x, &plot.y),
            fit: series.fit(&plot.x, &plot.y),
        })
        .filter(|curve| !curve.places.is_empty())
        .collect();
    let places = || curves.iter().flat_map(|curve| &curve.places);
    let panel = Panel {
        edges: [LEFT, TOP, RIGHT, BOTTOM],
        x: plot.x.range(places().map(|p| p[0])),
        // The range covers the points; error bars may leave the panel.
        y: plot.y.range(places().map(|p| p[1])),
    };
    let rows = curves.len().div_ceil(COLUMNS);
    let mut canvas = Canvas::new(
        &plot.title,
        width(plot, &curves),
        BOTTOM + 56.0 + LINE * rows as f64,
    );
    let (x, y) = (plot.x.ticks(panel.x, 9), plot.y.ticks(panel.y, 9));
    panel.axes(&mut canvas, [&x, &y], [&plot.x.label, &plot.y.label]);
    if curves.is_empty() {
        let middle = [f64::midpoint(LEFT, RIGHT), f64::midpoint(TOP, BOTTOM)];
        canvas.text("soft mid", middle, "nothing to show: all values are 0");
    }
    let drawing = Drawing { plot, panel };
    for curve in &curves {
        drawing.band(&mut canvas, curve);
    }
    for curve in &curves {
        drawing.lines(&mut canvas, curve);
    }
    drawing.names(&mut canvas, &curves);
    legend(&mut canvas, &curves);
    canvas
}

/// Returns the width that shows the title and all names beside the panel in full.
fn width(plot: &Plot, curves: &[Curve<'_>]) -> f64 {
    let letters = |text: &str| text.chars().count() as f64;
    let names = curves.iter().map(|curve| letters(&curve.series.name));
    let names = names.map(|name| RIGHT + GAP + LETTER * name + 2.0);
    let title = TITLE_LEFT + TITLE_LETTER * letters(&plot.title);
    names.fold(WIDTH.max(title), f64::max)
}

struct Drawing<'a> {
    plot: &'a Plot,
    panel: Panel,
}

impl Drawing<'_> {
    /// Returns a place on the drawing, clamped to the panel above and below.
    fn within(&self, place: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.panel.at(place);
        [x, y.clamp(TOP, BOTTOM)]
    }

    /// Returns the point of a fit at `x`, `bands` times its 95 % band above its line.
    fn fitted(&self, fit: &Fit, x: f64, bands: f64) -> [f64; 2] {
        let logarithm = self.plot.x.logarithm(x);
        let off = if bands == 0.0 {
            0.0
        } else {
            bands * fit.band(logarithm)
        };
        self.within([x, unlogarithm(&self.plot.y, fit.at(logarithm) + off)])
    }

    /// Draws a fit's band.
    fn band(&self, canvas: &mut Canvas, curve: &Curve<'_>) {
        let Some(fit) = curve.fit.filter(|fit| fit.slope_band.is_finite()) else {
            return;
        };
        let [first, last] = curve.ends();
        let steps = || {
            let step = |k| first + (last - first) * f64::from(k) / f64::from(BAND_STEPS);
            (0..=BAND_STEPS).map(step)
        };
        let upper = steps().map(|x| self.fitted(&fit, x, 1.0));
        let lower = steps().rev().map(|x| self.fitted(&fit, x, -1.0));
        let outline = polyline(&upper.chain(lower).collect::<Vec<_>>());
        canvas.path(
            &format!("band {}", class(curve.number)),
            &format!("{outline}z"),
        );
    }

    fn lines(&self, canvas: &mut Canvas, curve: &Curve<'_>) {
        let style = class(curve.number);
        let points = || curve.places.iter().map(|p| self.panel.at([p[0], p[1]]));
        let path = match (curve.series.drawn, curve.fit) {
            (Drawn::Points, _) | (Drawn::Fit, None) => String::new(),
            (Drawn::Fit, Some(fit)) => polyline(&curve.ends().map(|x| self.fitted(&fit, x, 0.0))),
            (Drawn::Joined, _) => polyline(&points().collect::<Vec<_>>()),
            (Drawn::Steps, _) => {
                let mut path = String::new();
                for [x, y] in points().map(|at| at.map(number)) {
                    let _ = match &*path {
                        "" => write!(path, "M{x} {y}"),
                        _ => write!(path, "H{x}V{y}"),
                    };
                }
                path
            }
        };
        if !path.is_empty() {
            let dash = if hollow(curve.number) { " dash" } else { "" };
            canvas.path(&format!("line {style}{dash}"), &path);
        }
        for (p, at) in curve.places.iter().zip(points()) {
            let [low, high] = [p[2], p[3]].map(|end| self.within([p[0], end]));
            if low[1] - high[1] > 1.0 {
                canvas.line(&format!("bar {style}"), low, high);
            }
            put_mark(canvas, curve.number, at);
        }
    }

    /// Draws the name of each series beside its last point. Names that would overlap are moved
    /// apart.
    fn names(&self, canvas: &mut Canvas, curves: &[Curve<'_>]) {
        let last: Vec<[f64; 2]> = curves.iter().map(|c| self.panel.at(c.last())).collect();
        let wanted: Vec<f64> = last.iter().map(|at| at[1]).collect();
        let heights = apart(&wanted, LINE, TOP + 4.0, BOTTOM - 4.0);
        for ((curve, [x, at]), y) in curves.iter().zip(last).zip(heights) {
            canvas.line("lead", [x + 7.0, at], [RIGHT + GAP - 4.0, y]);
            canvas.text("", [RIGHT + GAP, y + 5.0], &curve.series.name);
        }
    }
}

/// Converts a base-10 logarithm back to a place.
fn unlogarithm(axis: &PlotAxis, logarithm: f64) -> f64 {
    logarithm / axis.logarithm(1.0)
}

fn put_mark(canvas: &mut Canvas, number: usize, at: [f64; 2]) {
    let hollow = if hollow(number) { " hollow" } else { "" };
    canvas.path_at(&format!("mark {}{hollow}", class(number)), at, mark(number));
}

/// Draws the legend: marks, names and slopes below the plot.
fn legend(canvas: &mut Canvas, curves: &[Curve<'_>]) {
    let rows = curves.len().div_ceil(COLUMNS).max(1);
    for (k, curve) in curves.iter().enumerate() {
        let x = 22.0 + (WIDTH - 16.0) / COLUMNS as f64 * (k / rows) as f64;
        let y = BOTTOM + 64.0 + LINE * (k % rows) as f64;
        put_mark(canvas, curve.number, [x, y - 5.0]);
        let slope = curve.fit.map_or_else(String::new, |fit| {
            let slope = minus(&format!("slope {:.2}", fit.slope));
            match fit.slope_band {
                band if band.is_finite() => format!("{slope} \u{b1} {band:.2}"),
                _ => slope,
            }
        });
        canvas.text_and("", [x + 12.0, y], &curve.series.name, &slope);
    }
}
