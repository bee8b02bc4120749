//! The series of points that a plot draws.

use super::{Fit, PlotAxis};

/// A point, with the ends of its error bar.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub low: f64,
    pub high: f64,
}

/// The line drawn through the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The points alone, without a line.
    Points,
    /// Straight lines from each point to the next.
    Joined,
    /// The best-fitting power law, with its 95 % band.
    Fit,
    /// The staircase of a Pareto front: from each point horizontally to the x of the next, then
    /// vertically to it.
    Steps,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The name of the series.
    pub name: String,
    /// The points, from left to right.
    pub points: Vec<Point>,
    /// The line drawn through the points.
    pub drawn: Drawn,
    /// The style of its colour and marks, below [`crate::STYLES`]. It gives the same series the
    /// same style in several plots. `None` is the style of its position in the plot.
    pub style: Option<usize>,
}

impl Series {
    /// Creates a series of points without error bars.
    pub fn new(name: &str, points: impl IntoIterator<Item = (f64, f64)>, drawn: Drawn) -> Self {
        let bare = |(x, y)| Point {
            x,
            y,
            low: y,
            high: y,
        };
        Self {
            name: name.to_owned(),
            points: points.into_iter().map(bare).collect(),
            drawn,
            style: None,
        }
    }

    /// Sets a style, which then does not depend on the position in a plot.
    #[must_use]
    pub fn styled(mut self, style: usize) -> Self {
        self.style = Some(style);
        self
    }

    /// Returns the points that have a place on the axes: (x, y, low, high) as places. An end of an
    /// error bar that has no place is put at the point.
    pub(super) fn places(&self, x: &PlotAxis, y: &PlotAxis) -> Vec<[f64; 4]> {
        let place = |point: &Point| {
            let at = y.place(point.y)?;
            let end = |value| y.place(value).unwrap_or(at);
            Some([x.place(point.x)?, at, end(point.low), end(point.high)])
        };
        self.points.iter().filter_map(place).collect()
    }

    /// Fits the power law, if `drawn` is [`Drawn::Fit`] and there are enough points.
    pub(super) fn fit(&self, x: &PlotAxis, y: &PlotAxis) -> Option<Fit> {
        let places = self.places(x, y);
        let logarithms = places
            .iter()
            .map(|[px, py, ..]| (x.logarithm(*px), y.logarithm(*py)));
        (self.drawn == Drawn::Fit)
            .then(|| Fit::from_points(logarithms))
            .flatten()
    }
}
