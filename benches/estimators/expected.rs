//! Expected figures of each estimator, and their sources.

use super::problems::Problems;
use super::runs::{Point, cost, slopes};
use crate::common::Promises;
use qrt::scene::Estimator;

/// Expected figures of an estimator.
pub(crate) struct Expected {
    /// B, the runs of the counting circuit; the queries of the others follow from it too.
    pub(crate) repetitions: u32,
    /// Slope of the root mean square error, and its tolerance.
    rmse_slope: Option<(f64, f64)>,
    /// Slope of the 95th-percentile error, and its tolerance.
    q95_slope: Option<(f64, f64)>,
    /// Known range of queries times 95th-percentile error, for amplitudes spread evenly and [`KNOWN_FROM`]
    /// queries or more. It is kept if the geometric mean is within a fifth of the range.
    cost: Option<(f64, f64)>,
    /// True if the errors have a heavy tail, so that the mean square needs many runs.
    heavy: bool,
}

/// Least number of queries for which figures are known: with fewer, all methods still look for the right
/// section of the angles.
const KNOWN_FROM: u64 = 500;

const LINEAR: Option<(f64, f64)> = Some((-1.0, 0.1));

impl Expected {
    pub(crate) fn of(name: Estimator) -> Self {
        let unknown = Self {
            repetitions: 1,
            rmse_slope: None,
            q95_slope: None,
            cost: None,
            heavy: false,
        };
        match name {
            // 0.41/sqrt(n), and 1.96 deviations of at most 1/2.
            Estimator::MonteCarlo => Self {
                rmse_slope: Some((-0.5, 0.03)),
                q95_slope: Some((-0.5, 0.03)),
                ..unknown
            },
            // One outcome is off by x steps with a probability of about 1/x^2: the tail dominates the mean
            // square, 1/T, and any quantile is a number of steps. Others measured 3.9 to 4.8 (one outcome,
            // 95 %).
            Estimator::Paper => Self {
                rmse_slope: Some((-0.5, 0.07)),
                q95_slope: LINEAR,
                cost: Some((3.9, 4.8)),
                heavy: true,
                ..unknown
            },
            // Three outcomes, posterior mean: others measured 5.0.
            Estimator::PosteriorMean => Self {
                repetitions: 3,
                cost: Some((5.0, 5.0)),
                ..unknown
            },
            // Others measured 2.3 to 2.5, T = 64 to 256; RMSE pi sqrt(a (1 - a))/T (Luis & Perina 1996).
            Estimator::Sine => Self {
                rmse_slope: LINEAR,
                q95_slope: LINEAR,
                cost: Some((2.3, 2.5)),
                ..unknown
            },
            // Others measured 1.6 to 1.8, 512 queries; at most 2.0 is promised.
            Estimator::AdaptiveBayes => Self {
                rmse_slope: LINEAR,
                q95_slope: LINEAR,
                cost: Some((1.6, 1.8)),
                ..unknown
            },
            // Others measured 1.9 to 2.9.
            Estimator::RandomDepth => Self {
                q95_slope: LINEAR,
                cost: Some((1.9, 2.9)),
                ..unknown
            },
            // Others measured 3.7 to 3.9 (16 shots at each query depth).
            Estimator::Mlae => Self {
                rmse_slope: Some((-1.0, 0.15)),
                q95_slope: LINEAR,
                cost: Some((3.7, 3.9)),
                ..unknown
            },
            // Others measured 4.1 to 4.4 (20 shots at once). A failure is as likely at the first query
            // depth as at the last, so the mean square does not have this slope.
            Estimator::Iqae => Self {
                q95_slope: Some((-1.0, 0.15)),
                cost: Some((4.1, 4.4)),
                ..unknown
            },
            // No figure in this unit is known. With ratios of at least 3 and few queries, the first query
            // depths still affect the slopes.
            Estimator::Miqae => Self {
                rmse_slope: Some((-1.0, 0.15)),
                q95_slope: Some((-1.0, 0.2)),
                ..unknown
            },
            // 3.99/error for the requested error (Rall & Fuller 2022); 95 % of the runs are within it or
            // better.
            Estimator::Chebyshev => Self {
                q95_slope: Some((-1.0, 0.15)),
                cost: Some((3.0, 3.99)),
                ..unknown
            },
            _ => unknown,
        }
    }

    pub(crate) fn runs(&self, quick: bool) -> u32 {
        match (quick, self.heavy) {
            (true, _) => 2000,
            (false, true) => 400_000,
            (false, false) => 12_288,
        }
    }
}

/// The promises, and whether each was kept.
#[derive(Default)]
pub(crate) struct Verdicts(Vec<(bool, String)>);

impl Verdicts {
    pub(crate) fn keep(&mut self, kept: bool, promise: String) {
        self.0.push((kept, promise));
    }

    /// Judges all promises, behind the tables that they are about.
    pub(crate) fn finish(&self, promises: &mut Promises) {
        println!();
        for (kept, promise) in &self.0 {
            promises.judge(promise, *kept);
        }
    }

    /// Judges slopes and costs. On pixels, which are mostly dark, only the slopes of some estimators are
    /// known; with few runs, the tolerance grows by at least 0.2.
    pub(crate) fn judge(
        &mut self,
        name: Estimator,
        expected: &Expected,
        problems: &Problems,
        points: &[Point],
        quick: bool,
    ) {
        // At amplitudes of a few thousandths the first rounds of methods that narrow an angle down
        // from the whole quarter turn find nothing: up to some hundred queries their error is the
        // amplitude itself, then it falls more steeply (or, in mlae's tail, more slowly) than later. On
        // pixels the table shows their figures, and their slopes are not judged.
        let at_once = [
            Estimator::MonteCarlo,
            Estimator::Paper,
            Estimator::Sine,
            Estimator::AdaptiveBayes,
        ];
        if !matches!(problems, Problems::Even) && !at_once.contains(&name) {
            return;
        }
        let on = problems.name();
        let (rmse, q95) = slopes(points);
        let slopes = [
            ("RMSE", rmse, expected.rmse_slope),
            ("q95", q95, expected.q95_slope),
        ];
        for (what, slope, known) in slopes {
            if let Some((known, off)) = known {
                let off = if quick { off.max(0.2) + 0.2 } else { off };
                self.keep(
                    (slope - known).abs() <= off,
                    format!("{name}, {on}: slope of the {what} {slope:.3}, {known} +- {off}"),
                );
            }
        }
        if let (Some((low, high)), Problems::Even) = (expected.cost, problems) {
            let cost = cost(points, KNOWN_FROM);
            self.keep(
                0.8 * low <= cost && cost <= 1.2 * high,
                format!("{name}: queries times q95 {cost:.2}, known {low} to {high}"),
            );
        }
        if name == Estimator::AdaptiveBayes && matches!(problems, Problems::Even) {
            let within = points.iter().filter(|p| p.asked >= 255);
            let most = within.map(|p| p.queries * p.q95).fold(0.0, f64::max);
            self.keep(
                most <= 2.0,
                format!("{name}: queries times q95 {most:.2}, at most 2"),
            );
        }
    }
}
