//! Many runs of one estimator.

use super::problems::Problems;
use qrt::counting::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use qrt::counting::random::Stream;
use qrt::drawing::Fit;
use qrt::scene::{Counting, Estimator, Window};
use std::fmt;
use std::time::Instant;

/// An estimator with the queries of B runs of the counting circuit with T = 2^bits.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    pub(crate) name: Estimator,
    pub(crate) bits: u32,
    pub(crate) repetitions: u32,
}

/// The outcome of one run.
#[derive(Clone, Copy)]
pub(crate) struct Outcome {
    /// The estimate less the truth.
    pub(crate) error: f64,
    pub(crate) truth: f64,
    pub(crate) queries: u64,
    pub(crate) held: bool,
    pub(crate) confidence: f64,
}

/// Statistics of many runs with the same settings.
pub(crate) struct Point {
    /// Queries that the run may use. `queries` is the mean of those that it used.
    pub(crate) asked: u64,
    pub(crate) queries: f64,
    pub(crate) rmse: f64,
    pub(crate) q95: f64,
    seconds: f64,
}

impl Run {
    pub(crate) fn settings(&self) -> Settings {
        let counting = Counting {
            phase_bits: self.bits,
            repetitions: self.repetitions,
            window: Window::Sine,
            estimator: Some(self.name),
            strata: None,
            error: None,
        };
        Settings::from_counting(&counting).unwrap()
    }

    /// Makes `runs` runs on all cores. Each has its own random numbers, whatever thread it is on.
    pub(crate) fn outcomes(
        &self,
        runs: u32,
        problem: impl Fn(u32) -> CountingProblem + Sync,
    ) -> Vec<Outcome> {
        let estimator = estimator(self.name, &self.settings()).unwrap();
        let one = |run: u32| {
            let problem = problem(run);
            let key = u64::from(self.bits) << 8 | self.name as u64;
            let mut stream = Stream::new(key, run, self.repetitions, 0);
            let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
            let found = estimator.estimate(&mut device).unwrap();
            let truth = problem.good as f64 / problem.total as f64;
            let (low, high) = found.interval;
            // Rounding of the interval's ends is no failure.
            let rounding = 4.0 * f64::EPSILON;
            Outcome {
                error: found.amplitude - truth,
                truth,
                queries: found.queries,
                held: low - rounding <= truth && truth <= high + rounding,
                confidence: found.confidence,
            }
        };
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|t| {
                    let one = &one;
                    scope.spawn(move || {
                        let share = t * runs / threads..(t + 1) * runs / threads;
                        share.map(one).collect::<Vec<_>>()
                    })
                })
                .collect();
            let joined = workers.into_iter().map(|worker| worker.join().unwrap());
            joined.flatten().collect()
        })
    }

    pub(crate) fn point(&self, problems: &Problems, runs: u32) -> Point {
        let begin = Instant::now();
        let outcomes = self.outcomes(runs, |run| problems.problem(run, runs));
        let threads = std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
        let seconds = begin.elapsed().as_secs_f64() * threads / f64::from(runs);
        let n = f64::from(runs);
        let mut errors: Vec<f64> = outcomes.iter().map(|outcome| outcome.error.abs()).collect();
        Point {
            asked: self.settings().queries,
            queries: outcomes.iter().map(|o| o.queries as f64 / n).sum(),
            rmse: errors.iter().map(|e| e * e / n).sum::<f64>().sqrt(),
            q95: quantile_95(&mut errors),
            seconds,
        }
    }
}

impl fmt::Display for Point {
    /// Writes a line of the CSV file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{},{:.1},{:e},{:e},{:e}",
            self.asked, self.queries, self.rmse, self.q95, self.seconds
        )
    }
}

/// Returns the slopes of the RMSE and of the 95th-percentile error over the used queries.
pub(crate) fn slopes(points: &[Point]) -> (f64, f64) {
    let of = |value: fn(&Point) -> f64| {
        let logarithms = points.iter().map(|p| (p.queries.ln(), value(p).ln()));
        Fit::from_points(logarithms).expect("several queries").slope
    };
    (of(|p| p.rmse), of(|p| p.q95))
}

/// Returns the geometric mean of queries times 95th-percentile error, of points of at least `from` queries.
pub(crate) fn cost(points: &[Point], from: u64) -> f64 {
    let known = points.iter().filter(|point| point.asked >= from);
    let costs: Vec<f64> = known.map(|p| (p.queries * p.q95).ln()).collect();
    (costs.iter().sum::<f64>() / costs.len() as f64).exp()
}

/// Returns a row of the Markdown table.
pub(crate) fn row(points: &[Point]) -> String {
    let (rmse, q95) = slopes(points);
    let rmses = range(points.iter().map(|p| p.queries * p.rmse));
    let costs = range(points.iter().map(|p| p.queries * p.q95));
    let last = points.last().map_or(0.0, |p| p.seconds * 1e6);
    format!(
        "| {:.2} - {:.2} | {rmse:.2} | {:.2} - {:.2} | {q95:.2} | {last:.0} |",
        rmses.0, rmses.1, costs.0, costs.1
    )
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, 0.0), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Returns the 95th percentile of `values`. Sorts them.
pub(crate) fn quantile_95(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(values.len() * 19).div_ceil(20) - 1]
}
