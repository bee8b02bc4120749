//! Power laws fitted by least squares, with confidence intervals.

/// The power law `y = 10^at_mean (x / 10^mean)^slope`.
///
/// It is fitted to log10 y over log10 x by least squares, with equal weights of all points.
///
/// ```
/// use qrt_drawing::Fit;
/// let fit = Fit::from_points([(0.0, 1.0), (1.0, 0.0), (2.0, -1.0)]).unwrap();
/// assert_eq!((fit.slope, fit.slope_band), (-1.0, 0.0));
/// assert_eq!(fit.at(5.0), -4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The exponent: the slope of log10 y over log10 x.
    pub slope: f64,
    /// Half the width of the slope's 95 % interval (Student's t); infinite for two points.
    pub slope_band: f64,
    /// Root mean square of the residuals of log10 y.
    pub residual: f64,
    /// The mean of the points' log10 x.
    mean: f64,
    /// log10 y of the line at the mean.
    at_mean: f64,
    /// Number of fitted points.
    count: f64,
    /// Sum of squares of log10 x about its mean.
    spread: f64,
    /// `t s`: Student's quantile times the residual standard deviation of log10 y.
    reach: f64,
}

impl Fit {
    /// Fits points (log10 x, log10 y). `None` if there are fewer than two different x.
    pub fn from_points(points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let count = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
        let product: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        // Also false if there are no points: the spread of none is 0.
        let distinct = spread > 1e-12;
        if !distinct {
            return None;
        }
        let slope = product / spread;
        let left: f64 = points
            .iter()
            .map(|p| (p.1 - y - slope * (p.0 - x)).powi(2))
            .sum();
        let freedom = points.len() - 2;
        let reach = if freedom == 0 {
            f64::INFINITY
        } else {
            student(freedom) * (left / freedom as f64).sqrt()
        };
        Some(Self {
            slope,
            slope_band: reach / spread.sqrt(),
            residual: (left / count).sqrt(),
            mean: x,
            at_mean: y,
            count,
            spread,
            reach,
        })
    }

    /// Returns log10 y of the line at log10 x = `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.at_mean + self.slope * (x - self.mean)
    }

    /// Returns half the width of the line's 95 % interval at log10 x = `x`.
    pub(crate) fn band(&self, x: f64) -> f64 {
        let off = x - self.mean;
        self.reach * (1.0 / self.count + off * off / self.spread).sqrt()
    }
}

/// Returns the 97.5 % quantile of Student's t.
///
/// It is tabulated up to 12 degrees of freedom. Beyond, it is the expansion of Cornish and Fisher
/// (Abramowitz & Stegun 26.7.5), with an error below 1e-4.
fn student(freedom: usize) -> f64 {
    const TABLE: [f64; 12] = [
        12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010,
        2.1788,
    ];
    if let Some(&quantile) = TABLE.get(freedom.wrapping_sub(1)) {
        return quantile;
    }
    let n = freedom as f64;
    let x = 1.959_963_985_f64;
    let (x3, x5) = (x.powi(3), x.powi(5));
    let x7 = x.powi(7);
    x + (x3 + x) / (4.0 * n)
        + (5.0 * x5 + 16.0 * x3 + 3.0 * x) / (96.0 * n * n)
        + (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / (384.0 * n * n * n)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with the quantiles of printed tables.
    #[test]
    fn students_quantiles_are_the_tabulated_ones() {
        for (freedom, quantile) in [
            (1, 12.706),
            (8, 2.306),
            (13, 2.160),
            (20, 2.086),
            (60, 2.000),
        ] {
            assert!((student(freedom) - quantile).abs() < 6e-4, "{freedom}");
        }
    }

    /// Compares with Anscombe's first set (*Graphs in Statistical Analysis*, 1973): y = 3.00 +
    /// 0.500 x, with a standard error of the slope of 0.118.
    #[test]
    fn a_published_regression_is_reproduced() {
        let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
        let y = [
            8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68,
        ];
        let fit = Fit::from_points(x.into_iter().zip(y)).unwrap();
        assert!((fit.slope - 0.500).abs() < 5e-4);
        assert!((fit.at(0.0) - 3.00).abs() < 5e-3);
        assert!((fit.slope_band / 2.2622 - 0.118).abs() < 5e-4);
        // The band is narrowest at the mean: t s / sqrt(n), with s = 1.2366.
        let narrowest = 2.2622 * 1.2366 / 11.0_f64.sqrt();
        assert!((fit.band(9.0) - narrowest).abs() < 1e-3);
        assert!(fit.band(4.0) > fit.band(9.0));
    }

    #[test]
    fn a_line_needs_two_places() {
        assert_eq!(Fit::from_points([]), None);
        assert_eq!(Fit::from_points([(1.0, 2.0), (1.0, 3.0)]), None);
        let two = Fit::from_points([(1.0, 2.0), (2.0, 3.0)]).unwrap();
        assert_eq!((two.slope, two.slope_band), (1.0, f64::INFINITY));
    }
}
