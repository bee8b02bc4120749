//! Plots on logarithmic axes.

mod axis;
mod draw;
mod fit;
mod labels;
mod series;
#[cfg(test)]
mod tests;

pub use axis::{Axis, Scale};
pub use fit::Fit;
pub use series::{Drawn, Point, Series};

use crate::Canvas;

/// A plot on logarithmic axes.
///
/// It is a title, two [`Axis`] and any number of [`Series`]: points with error bars, which
/// may be joined, or have a power law fitted to them ([`Fit`]), drawn with its confidence band.
/// Each series is named where it ends and in the legend; it has a colour and a shape of its own, so
/// that it is told apart in print, too. What a logarithm has no place for (zero, infinity, NaN) is
/// left out.
///
/// ```
/// use qrt_drawing::{Axis, Drawn, Plot, Series};
/// let points = [(10.0, 0.31), (100.0, 0.1), (1000.0, 0.032)];
/// let plot = Plot {
///     title: "Error of an average".to_owned(),
///     x: Axis::log("queries"),
///     y: Axis::log("error"),
///     series: vec![Series::of("Monte Carlo", points, Drawn::Fit)],
/// };
/// let svg = plot.draw().svg();
/// assert!(svg.starts_with("<svg") && svg.contains("slope \u{2212}0.49"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What it shows, for those who cannot see it, too.
    pub title: String,
    /// From left to right.
    pub x: Axis,
    /// The axis that points upwards.
    pub y: Axis,
    /// What is drawn, the first one in the first style.
    pub series: Vec<Series>,
}

impl Plot {
    /// The plot as a drawing.
    pub fn draw(&self) -> Canvas {
        draw::plot(self)
    }
}
