//! The series of points that a plot draws.

use super::{Axis, Fit};

/// A point, with the ends of its error bar.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub low: f64,
    pub high: f64,
}

/// What is drawn through the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The points alone, without a line.
    Points,
    /// Lines from each to the next.
    Joined,
    /// The power law that fits them best, with its band at 95 %.
    Fit,
    /// What none of the points is better than in both: from each level right to the next.
    Steps,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What they are called.
    pub name: String,
    /// The points, from left to right.
    pub points: Vec<Point>,
    /// What is drawn through them.
    pub drawn: Drawn,
    /// The style of its colour and marks, below [`crate::STYLES`], where the same thing has it in
    /// other plots, too; none for that of its place in the plot.
    pub style: Option<usize>,
}

impl Series {
    /// A series of points without error bars.
    pub fn of(name: &str, points: impl IntoIterator<Item = (f64, f64)>, drawn: Drawn) -> Self {
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

    /// The same in a style of its own, wherever it stands in a plot.
    #[must_use]
    pub fn styled(mut self, style: usize) -> Self {
        self.style = Some(style);
        self
    }

    /// What of it has a place on the axes: (x, y, low, high) as places. The ends of an error bar
    /// that have none end at the point.
    pub(super) fn places(&self, x: &Axis, y: &Axis) -> Vec<[f64; 4]> {
        let place = |point: &Point| {
            let at = y.place(point.y)?;
            let end = |value| y.place(value).unwrap_or(at);
            Some([x.place(point.x)?, at, end(point.low), end(point.high)])
        };
        self.points.iter().filter_map(place).collect()
    }

    /// The power law, if one is asked for and there are points enough.
    pub(super) fn fit(&self, x: &Axis, y: &Axis) -> Option<Fit> {
        let places = self.places(x, y);
        let logarithms = places
            .iter()
            .map(|[px, py, ..]| (x.logarithm(*px), y.logarithm(*py)));
        (self.drawn == Drawn::Fit)
            .then(|| Fit::of(logarithms))
            .flatten()
    }
}
