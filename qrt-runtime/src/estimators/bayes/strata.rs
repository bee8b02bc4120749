//! The comparator in parts, each counted by itself.
//!
//! With the comparator's top bits fixed, the good indices of a [`Stratum`] are counted alone:
//!
//! ```text
//! S/N = sum_k w_k a_k,    w_k the fraction of thresholds, a_k of good indices of stratum k.
//! ```
//!
//! After Q_k queries a_k is off by some `sqrt(a_k (1 - a_k)) / Q_k`, and the errors of strata add
//! in squares. With `x_k = w_k sqrt(a_k (1 - a_k))` the best split is `Q_k ~ x_k^(2/3)`, and so
//!
//! ```text
//! error ~ (sum_k x_k^(2/3))^(3/2) / Q,
//! ```
//!
//! for the whole at once `sqrt(a (1 - a)) / Q`. Where paths' colours are small against their bound,
//! the lowest stratum has all of S and a small width, and the others are empty; where each path is
//! all or nothing, all strata are alike and nothing is won.
//!
//! # How queries are split
//!
//! Each stratum has a posterior of its own, and the next shot is made in the one with the largest
//! `w_k^2 Var(a_k) / Q_k`. At the best split that is the same in all: with variances that fall as
//! `1/Q_k^2`, it is what one more query takes off the variance of the sum. So the split follows from
//! what is measured, and an empty stratum is left as soon as it is known to be.
//!
//! Strata are often empty or full, and each has its own posterior. With a prior uniform in every
//! `a_k`, what empty strata are overestimated by would add up, and be the largest part of the error;
//! theirs is [`Prior::Ends`]. Intervals are those of a uniform prior nonetheless.
//!
//! # How many strata
//!
//! Unless that is asked for, the whole is counted as ever until enough indices are measured. Each
//! shot measures one, and the colour of its path says how colours are spread; from these follow all
//! `a_k`, roughly, and the error that each number of strata would have. If one is better by
//! [`WORTH`] with the queries that are left, what is known is given up and the run begins anew with
//! strata; if not, it goes on, and is the same, query by query, as without strata.

use super::Goal;
use super::posterior::Posterior;
use super::run::{Depths, Run};
use super::support::Prior;
use crate::counting::Stratum;
use crate::estimators::device::Usage;
use crate::estimators::{CountedStratum, Device, Estimate, EstimatorError};

/// Good indices, and others, that must have been measured before the number of strata is decided.
const ENOUGH: u64 = 6;
/// Queries before that, at the least.
const FEWEST: u64 = 24;
/// The fraction of queries after which it is not decided any more.
const LATEST: f64 = 1.0 / 6.0;
/// By what factor strata must make the error smaller.
const WORTH: f64 = 1.15;
/// Queries that a stratum's posterior takes to find the right section of its angles.
const SEARCH: f64 = 4.0;
/// Queries times deviation of an amplitude a, over `sqrt(a (1 - a))`; measured.
const FAR: f64 = 2.2;
/// Queries squared times deviation of an amplitude of 0 or 1; measured.
const NEAR: f64 = 0.63;
/// A stratum, and what is known of it.
struct Part<'a> {
    stratum: Stratum,
    /// The fraction of thresholds.
    width: f64,
    run: Run<'a>,
    /// Of the stratum's contribution to the whole.
    variance: f64,
    good_ids: u64,
}

/// One run: of the whole, of as many strata as are asked for, or as seem best.
pub(super) fn estimate(
    goal: &Goal,
    depths: Depths,
    device: &mut Device<'_>,
) -> Result<Estimate, EstimatorError> {
    let start = device.usage();
    let bits = device.comparator_bits();
    if let (Some(bits), Some(strata @ 2..)) = (bits, goal.strata) {
        return in_strata(goal, depths, device, start, bits, strata);
    }
    let latest = (LATEST * goal.queries as f64) as u64;
    let mut undecided = bits.filter(|_| goal.strata.is_none());
    let mut whole = Run::new(goal, depths, device.total(), Prior::Even);
    let mut left = goal.queries;
    while left > 0 && !goal.is_reached(&whole.posterior) {
        left -= whole.step(device, left)?;
        let Some(bits) = undecided else {
            continue;
        };
        if whole.used > latest {
            undecided = None;
        } else if whole.used >= FEWEST && enough(device.measured_paths()) {
            undecided = None;
            let strata = choose(device, &whole.posterior, bits, goal.queries, left);
            if strata > 1 {
                return in_strata(goal, depths, device, start, bits, strata);
            }
        }
    }
    Ok(whole
        .posterior
        .sharpened()
        .estimate(device, start, goal.confidence))
}

/// Whether the paths that were measured tell how colours are spread.
fn enough(measured: &[[u64; 2]]) -> bool {
    let sum = |which: usize| measured.iter().map(|found| found[which]).sum::<u64>();
    sum(0) >= ENOUGH && sum(1) >= ENOUGH
}

/// The number of strata with which the rest of the queries promises the smallest error.
fn choose(device: &Device<'_>, known: &Posterior, bits: u32, queries: u64, left: u64) -> u32 {
    let octaves = octaves(device.measured_paths(), known.mean_amplitude(), bits);
    let all = (1_u64 << bits) as f64;
    let parts = |count: u32| {
        let octaves = &octaves;
        Stratum::halving(count, bits).map(move |stratum| {
            let length = stratum.length() as f64;
            let good: f64 = octaves[stratum.octaves()].iter().sum();
            (length / all, (good / length).clamp(0.0, 1.0))
        })
    };
    let alone = variance(parts(1), queries as f64);
    let best = (2..=bits + 1)
        .map(|count| {
            let left = left as f64 - SEARCH * f64::from(count);
            (variance(parts(count), left), count)
        })
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match best {
        Some((variance, count)) if variance * WORTH * WORTH < alone => count,
        _ => 1,
    }
}

/// By octave, how many of its thresholds a path exceeds on average, as far as measured paths tell:
/// by length of their counts in bits, those of good indices and of others.
///
/// A path with a count of x came up with a weight of `good x/(a C) + others (C - x)/((1 - a) C)`,
/// for so many good and other indices that were measured; x is taken to be in the middle of those
/// of its length.
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

/// The variance to expect of strata of these widths and amplitudes after so many queries, split as
/// well as can be.
///
/// After Q queries a stratum has `(FAR x / Q)^2 + (NEAR w / Q^2)^2`: the first term is that of an
/// amplitude far from 0 and 1, the second that of one so near that it may be there. A query more
/// takes as much off in each stratum if Q is about
/// `(2 (FAR x)^2 / l)^(1/3) + (4 (NEAR w)^2 / l)^(1/5)`, with the same l in all.
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
    // With u = l^(-1/15): far u^5 + near u^3 = Q, which bends upwards: either term alone gives a u that
    // is too large, and Newton's steps come from there.
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

/// Counts `strata` strata one by one, with the queries that are left since `start`.
fn in_strata(
    goal: &Goal,
    depths: Depths,
    device: &mut Device<'_>,
    start: Usage,
    bits: u32,
    strata: u32,
) -> Result<Estimate, EstimatorError> {
    let all = (1_u64 << bits) as f64;
    let paths = device.total() >> bits;
    let mut parts: Vec<Part<'_>> = Stratum::halving(strata, bits)
        .map(|stratum| Part {
            stratum,
            width: stratum.length() as f64 / all,
            run: Run::new(goal, depths, paths * stratum.length(), Prior::Ends),
            variance: 0.0,
            good_ids: 0,
        })
        .collect();
    parts.iter_mut().for_each(Part::look);
    let mut left = goal.queries - (device.usage().queries - start.queries);
    while left > 0 {
        let gain = |part: &Part<'_>| part.variance / part.run.used.max(1) as f64;
        let Some(part) = (parts.iter_mut()).max_by(|a, b| gain(a).total_cmp(&gain(b))) else {
            break;
        };
        if part.variance <= 0.0 {
            break;
        }
        let before = device.usage().good_ids;
        left -= device.within(part.stratum, |device| part.run.step(device, left))??;
        part.good_ids += device.usage().good_ids - before;
        part.look();
        if let Some(error) = goal.error
            && parts.iter().map(|part| part.variance).sum::<f64>() < error * error
        {
            let (_, (low, high)) = sum(&parts, goal.confidence);
            if high - low <= 2.0 * error {
                break;
            }
        }
    }
    for part in &mut parts {
        part.run.posterior = part.run.posterior.clone().sharpened();
    }
    let (amplitude, interval) = sum(&parts, goal.confidence);
    for part in &parts {
        device.report(CountedStratum {
            stratum: part.stratum,
            amplitude: part.width * part.run.posterior.mean_amplitude(),
            good_ids: part.good_ids,
            queries: part.run.used,
        });
    }
    let candidates = parts.iter().map(|part| part.run.posterior.candidates());
    let known = parts.iter().map(|part| part.run.posterior.likeliest());
    Ok(Estimate {
        good: known.map(|found| found.map(|(good, _)| good)).sum(),
        candidates: candidates.max(),
        strata: parts.len() as u32,
        ..device.estimate(start, amplitude, interval, goal.confidence)
    })
}

impl Part<'_> {
    /// Takes note of what is known after a shot.
    fn look(&mut self) {
        self.variance = if self.run.is_over() {
            0.0
        } else {
            self.width * self.width * self.run.posterior.amplitude_variance()
        };
    }
}

/// The amplitude of the whole, and its interval.
///
/// Each stratum's own interval may fail with one n-th of the failure probability: with few queries
/// intervals fail by a wrong section of angles, and each of n strata may. On either side distances
/// to their ends add in squares, for the strata are measured independently of one another; but
/// where an interval ends at 0 or 1, they add up: what is not there at all is overestimated in all
/// strata at once.
fn sum(parts: &[Part<'_>], confidence: f64) -> (f64, (f64, f64)) {
    let confidence = 1.0 - (1.0 - confidence) / parts.len() as f64;
    let (mut amplitude, mut squares, mut sums) = (0.0, [0.0; 2], [0.0; 2]);
    for part in parts {
        let mean = part.run.posterior.mean_amplitude();
        amplitude += part.width * mean;
        let (low, high) = part.run.posterior.interval(confidence);
        let sides = [(mean - low, low <= 0.0), (high - mean, high >= 1.0)];
        for (side, (distance, is_end)) in sides.into_iter().enumerate() {
            let distance = part.width * distance.max(0.0);
            if is_end {
                sums[side] += distance;
            } else {
                squares[side] += distance * distance;
            }
        }
    }
    let amplitude = f64::clamp(amplitude, 0.0, 1.0);
    let [below, above] = [0, 1].map(|side| sums[side] + f64::sqrt(squares[side]));
    let interval = ((amplitude - below).max(0.0), (amplitude + above).min(1.0));
    (amplitude, interval)
}
