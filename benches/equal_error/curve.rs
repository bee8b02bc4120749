//! Error against time.

/// Error and cost of a number of samples a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) samples: u64,
    /// Root mean square error over the mean.
    pub(crate) error: f64,
    pub(crate) seconds: f64,
}

/// A renderer's points, in the order of samples.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<Point>,
}

impl Curve {
    /// Returns the seconds to an error, between points on logarithmic axes: where the error falls below it
    /// for good. `None` if it never does, or if no point lies above it.
    pub(crate) fn seconds_to(&self, error: f64) -> Option<f64> {
        let above = self.points.iter().rposition(|point| point.error > error)?;
        let (a, b) = (self.points[above], self.points.get(above + 1)?);
        let part = (a.error / error).ln() / (a.error / b.error).ln();
        Some(a.seconds * (b.seconds / a.seconds).powf(part))
    }
}
