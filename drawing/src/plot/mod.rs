//! Plots on logarithmic axes.

mod axis;
mod draw;
mod fit;
mod labels;
mod series;
#[cfg(test)]
mod tests;

pub use axis::{PlotAxis, Scale};
pub use fit::Fit;
pub use series::{Drawn, Point, Series};

use crate::Canvas;

/// A plot on logarithmic axes.
///
/// It has a title, two [`PlotAxis`] and any number of [`Series`]: points with error bars. The plot
/// can join the points, or fit a power law to them ([`Fit`]) and draw its confidence band. Each
/// series has its name where it ends and in the legend. It has a colour and a shape of its own, so
/// that it can be distinguished in print, too. Values without a logarithm (zero, infinity, NaN) are
/// left out.
///
/// ```
/// use qrt_drawing::{PlotAxis, Drawn, Plot, Series};
/// let points = [(10.0, 0.31), (100.0, 0.1), (1000.0, 0.032)];
/// let plot = Plot {
///     title: "Error of an average".to_owned(),
///     x: PlotAxis::log("queries"),
///     y: PlotAxis::log("error"),
///     series: vec![Series::new("Monte Carlo", points, Drawn::Fit)],
/// };
/// let svg = plot.draw().svg();
/// assert!(svg.starts_with("<svg") && svg.contains("slope \u{2212}0.49"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The title, which also describes the plot to readers who cannot see it.
    pub title: String,
    /// The horizontal axis, from left to right.
    pub x: PlotAxis,
    /// The vertical axis, upwards.
    pub y: PlotAxis,
    /// The series to draw, the first one in the first style.
    pub series: Vec<Series>,
}

impl Plot {
    /// Draws the plot.
    pub fn draw(&self) -> Canvas {
        draw::plot(self)
    }
}
