//! What series are called: beside their last points, and below the plot.

use super::labels::apart;
use super::style::{class, hollow, mark};
use super::svg::{BOTTOM, Curve, Frame, RIGHT, TOP, WIDTH, escaped};
use std::fmt::Write as _;

/// From a series' last point to its name.
const GAP: f64 = 16.0;
/// Between names, and between lines of the legend.
pub(super) const LINE: f64 = 17.0;
/// Of the legend.
pub(super) const COLUMNS: usize = 2;
pub(super) fn put_mark(svg: &mut String, number: usize, x: f64, y: f64) {
    let fill = if hollow(number) { "hollow" } else { "ink" };
    let _ = writeln!(
        svg,
        "<path class=\"mark {fill} s{}\" transform=\"translate({x:.1} {y:.1})\" d=\"{}\"/>",
        class(number),
        mark(number)
    );
}

/// The name of each series beside its last point, moved apart where they would overlap.
pub(super) fn names(svg: &mut String, frame: &Frame<'_>, curves: &[Curve<'_>]) {
    let last = |curve: &Curve<'_>| {
        curve
            .places
            .iter()
            .fold([f64::NEG_INFINITY, 0.0], |last, p| {
                if p[0] >= last[0] { [p[0], p[1]] } else { last }
            })
    };
    let wanted: Vec<f64> = curves.iter().map(|curve| frame.y(last(curve)[1])).collect();
    for (curve, y) in curves
        .iter()
        .zip(apart(&wanted, LINE, TOP + 4.0, BOTTOM - 4.0))
    {
        let [x, at] = last(curve);
        let (x, at) = (frame.x(x) + 7.0, frame.y(at));
        let _ = writeln!(
            svg,
            "<path class=\"lead\" d=\"M{x:.1} {at:.1}L{:.1} {y:.1}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            RIGHT + GAP - 4.0,
            RIGHT + GAP,
            y + 5.0,
            escaped(&curve.series.name)
        );
    }
}

/// Marks, names and slopes below the plot.
pub(super) fn legend(svg: &mut String, curves: &[Curve<'_>]) {
    let rows = curves.len().div_ceil(COLUMNS).max(1);
    for (k, curve) in curves.iter().enumerate() {
        let x = 22.0 + (WIDTH - 16.0) / COLUMNS as f64 * (k / rows) as f64;
        let y = BOTTOM + 64.0 + LINE * (k % rows) as f64;
        put_mark(svg, curve.number, x, y - 5.0);
        let slope = curve.fit.map_or_else(String::new, |fit| {
            let band = if fit.slope_band.is_finite() {
                format!(" \u{b1} {:.2}", fit.slope_band)
            } else {
                String::new()
            };
            let slope = format!("{:.2}", fit.slope).replace('-', "\u{2212}");
            format!(" <tspan class=\"soft\">slope {slope}{band}</tspan>")
        });
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{y:.1}\">{}{slope}</text>",
            x + 12.0,
            escaped(&curve.series.name)
        );
    }
}
