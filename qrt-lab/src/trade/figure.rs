//! A plot of `qrt trade`, and series of its points.

use super::Band;
use super::styles::style;
use super::table::Row;
use qrt_drawing::{Drawn, Plot, Point, Series};

/// A plot and its caption.
pub(super) struct Figure {
    /// The name of the plot's file, without the extension.
    pub(super) name: &'static str,
    pub(super) plot: Plot,
    /// The caption.
    pub(super) says: &'static str,
}

fn point(x: f64, band: Band) -> Point {
    Point {
        x,
        y: band.value,
        low: band.low,
        high: band.high,
    }
}

/// A series of the error at index `error` of `rows`, over `x`.
pub(super) fn series<'a>(
    name: &str,
    rows: impl Iterator<Item = &'a Row>,
    x: impl Fn(&Row) -> f64,
    error: usize,
    drawn: Drawn,
) -> Series {
    let mut points: Vec<Point> = rows.map(|row| point(x(row), row.errors[error])).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    Series {
        name: name.to_owned(),
        points,
        drawn,
        style: style(name),
    }
}
