//! Chooses a run's way from the colours of the paths that its first shots measured.

use super::super::FAR;
use crate::Stratum;
use crate::estimators::Device;

/// Number of good indices, and of others, that must be measured before the choice.
const ENOUGH: u64 = 6;
/// The smallest number of queries before the choice.
const FEWEST: u64 = 24;
/// The fraction of queries after which the run keeps counting the whole.
const LATEST: f64 = 1.0 / 6.0;
/// The factor by which another way must reduce the error of counting the whole.
pub(super) const WORTH: f64 = 1.15;
/// The factor of the mean phase's expected variance by which strata must beat it, so that a run does not take it after
/// its first paths.
const EARLY: f64 = 1.4;
/// The factor by which the mean phase must have less expected variance than strata later, from the paths that
/// counting has measured: in dark pixels, whose few bright paths the mean phase has yet to find, it has up to 1.6 times
/// the expected error, and strata have the expected one.
const LATE: f64 = 2.25;
/// Number of queries that a stratum's posterior takes to find the right section of its angles.
const SEARCH: f64 = 4.0;
/// Queries squared times standard deviation of an amplitude of 0 or 1; measured.
const NEAR: f64 = 0.63;

/// A way to continue a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// Counting the whole comparator, as before.
    Whole,
    /// Counting this number of strata, at least 2.
    Strata(u32),
    /// The mean-phase circuit.
    MeanPhase,
}

/// True if enough indices are measured to choose a way.
///
/// The run may use `queries` queries, of which `left` remain.
pub(super) fn is_due(device: &Device<'_>, queries: u64, left: u64) -> bool {
    queries - left >= FEWEST && enough(device.measured_paths())
}

/// True if it is too late in the run to choose another way than [`Way::Whole`].
pub(super) fn is_late(queries: u64, left: u64) -> bool {
    (queries - left) as f64 > LATEST * queries as f64
}

/// True if the measured paths suffice to estimate the distribution of colours.
fn enough(measured: &[[u64; 2]]) -> bool {
    let sum = |which: usize| measured.iter().map(|found| found[which]).sum::<u64>();
    sum(0) >= ENOUGH && sum(1) >= ENOUGH
}

/// The expected variances of a run's ways, from the paths that it has measured.
pub(super) struct Outlook {
    /// The mean number of thresholds of each octave that a path exceeds.
    octaves: Vec<f64>,
    /// Bits of the comparator.
    bits: u32,
}

impl Outlook {
    /// The outlook of a run that has measured the paths of `device`, of S/N `amplitude`.
    pub(super) fn new(device: &Device<'_>, bits: u32, amplitude: f64) -> Self {
        let octaves = octaves(device.measured_paths(), amplitude, bits);
        Self { octaves, bits }
    }

    /// The outlook of a run that has drawn paths of these levels at random, each as often as the number beside it says.
    pub(super) fn of_random(
        levels: &(impl Iterator<Item = (u64, u64)> + Clone),
        bits: u32,
    ) -> Self {
        let paths: u64 = levels.clone().map(|(_, times)| times).sum();
        let exceeded = |octave: u32| {
            let (start, end) = ((1_u64 << octave) >> 1, 1_u64 << octave);
            let cut = |(level, times): (u64, u64)| (level.clamp(start, end) - start) * times;
            levels.clone().map(cut).sum::<u64>() as f64 / paths as f64
        };
        Self {
            octaves: (0..=bits).map(exceeded).collect(),
            bits,
        }
    }

    /// The expected variance of `count` strata after `queries` queries.
    fn of_strata(&self, count: u32, queries: f64) -> f64 {
        let all = (1_u64 << self.bits) as f64;
        let parts = Stratum::halving(count, self.bits).map(|stratum| {
            let length = stratum.length() as f64;
            let good: f64 = self.octaves[stratum.octaves()].iter().sum();
            (length / all, (good / length).clamp(0.0, 1.0))
        });
        variance(parts, queries)
    }

    /// The number of strata, at least 2, of the smallest expected variance after `left` queries, and this variance.
    fn best_strata(&self, left: u64) -> Option<(f64, u32)> {
        let counts = (2..=self.bits + 1).map(|count| {
            let queries = left as f64 - SEARCH * f64::from(count);
            (self.of_strata(count, queries), count)
        });
        counts.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// True unless strata are clearly better than the mean phase, whose expected variance is `mean_phase`.
    ///
    /// From the few paths before a run's first circuit, strata look better than they are: they must have less variance by
    /// the factor [`EARLY`].
    pub(super) fn allows_mean_phase(&self, left: u64, mean_phase: f64) -> bool {
        let strata = self.best_strata(left);
        strata.is_none_or(|(variance, _)| mean_phase <= variance * EARLY)
    }

    /// The way with the smallest expected error, if it is smaller by the factor [`WORTH`] than that of the whole.
    ///
    /// The run may use `queries` queries, of which `left` remain. `mean_phase` is the expected variance of the mean
    /// phase, infinite if it cannot be run. It counts [`LATE`] times.
    pub(super) fn choose(
        &self,
        by_strata: bool,
        (queries, left): (u64, u64),
        mean_phase: f64,
    ) -> Way {
        let alone = self.of_strata(1, queries as f64);
        let strata = by_strata.then(|| self.best_strata(left)).flatten();
        let strata = strata.map(|(variance, count)| (variance, Way::Strata(count)));
        let ways = strata
            .into_iter()
            .chain([(mean_phase * LATE, Way::MeanPhase)]);
        match ways.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((variance, way)) if variance * WORTH * WORTH < alone => way,
            _ => Way::Whole,
        }
    }
}

/// The mean number of thresholds of each octave that a path exceeds, estimated from measured paths.
///
/// `measured` has the numbers of good indices and of others, by the length in bits of their paths'
/// counts. Let `good` and `others` be their sums. A path with a count of x has been measured with a
/// weight of `good x/(a C) + others (C - x)/((1 - a) C)`. The estimate takes x in the middle of the
/// counts of its length.
fn octaves(measured: &[[u64; 2]], amplitude: f64, bits: u32) -> Vec<f64> {
    let all = (1_u64 << bits) as f64;
    let [good, others] = [0, 1].map(|which| {
        let sum: u64 = measured.iter().map(|found| found[which]).sum();
        sum as f64
    });
    let middle = |length: usize| match length {
        0 => 0.0,
        _ if length > bits as usize => all,
        _ => 0.75 * (1_u64 << length) as f64 - 0.5,
    };
    let fraction = |(length, found): (usize, &[u64; 2])| {
        let x = middle(length) / all;
        let weight = good * x / amplitude + others * (1.0 - x) / (1.0 - amplitude);
        if weight > 0.0 {
            (found[0] + found[1]) as f64 / weight
        } else {
            0.0
        }
    };
    let paths: Vec<f64> = measured.iter().enumerate().map(fraction).collect();
    let sum: f64 = paths.iter().sum();
    let exceeded = |octave: u32| {
        let start = ((1_u64 << octave) >> 1) as f64;
        let end = (1_u64 << octave) as f64;
        let cut =
            |(length, paths): (usize, &f64)| paths * (middle(length).clamp(start, end) - start);
        paths.iter().enumerate().map(cut).sum::<f64>() / sum
    };
    (0..=bits).map(exceeded).collect()
}

/// The expected variance of `strata` after `queries` queries, at the best split among them.
///
/// Each stratum is a width w and an amplitude a. With x = `w sqrt(a (1 - a))`, its variance after Q
/// queries is `(FAR x / Q)^2 + (NEAR w / Q^2)^2`. The first term is that of an amplitude far from 0
/// and 1, the second that of an amplitude that may be 0 or 1. One more query reduces the variance
/// of every stratum equally if Q is about `(2 (FAR x)^2 / l)^(1/3) + (4 (NEAR w)^2 / l)^(1/5)`,
/// with the same l in all.
fn variance(strata: impl Iterator<Item = (f64, f64)> + Clone, queries: f64) -> f64 {
    if queries < 1.0 {
        return f64::INFINITY;
    }
    let terms = |(width, a): (f64, f64)| {
        let (far, near) = (FAR * width * (a * (1.0 - a)).sqrt(), NEAR * width);
        (far * far, near * near)
    };
    let shares = |(far, near): (f64, f64)| {
        let near = libm::pow(4.0 * near, 0.2);
        (libm::cbrt(2.0 * far), near)
    };
    let (mut far, mut near) = (0.0, 0.0);
    for stratum in strata.clone() {
        let (f, n) = shares(terms(stratum));
        (far, near) = (far + f, near + n);
    }
    // With u = l^(-1/15): far u^5 + near u^3 = Q. The left side is convex, and either term alone
    // gives a u that is too large. Newton's steps start there.
    let mut u = libm::pow(queries / far, 0.2).min(libm::cbrt(queries / near));
    for _ in 0..20 {
        let (square, cube) = (u * u, u * u * u);
        let value = far * square * cube + near * cube - queries;
        let next = u - value / (5.0 * far * square * square + 3.0 * near * square);
        if (u - next).abs() < 1e-3 * u {
            break;
        }
        u = next;
    }
    let total = strata.map(|stratum| {
        let (far, near) = terms(stratum);
        let (f, n) = shares((far, near));
        let queries = f * libm::pow(u, 5.0) + n * libm::pow(u, 3.0);
        let square = 1.0 / (queries * queries);
        far * square + near * square * square
    });
    total.sum()
}
