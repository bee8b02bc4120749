//! Chooses the number of strata from the colours of the paths that a run's first shots measured.

use crate::Stratum;
use crate::estimators::Device;

/// Number of good indices, and of others, that must be measured before the choice.
const ENOUGH: u64 = 6;
/// The smallest number of queries before the choice.
const FEWEST: u64 = 24;
/// The fraction of queries after which the run keeps counting the whole.
const LATEST: f64 = 1.0 / 6.0;
/// The factor by which strata must reduce the error.
pub(super) const WORTH: f64 = 1.15;
/// Number of queries that a stratum's posterior takes to find the right section of its angles.
const SEARCH: f64 = 4.0;
/// Queries times standard deviation of an amplitude a, over `sqrt(a (1 - a))`; measured.
pub(super) const FAR: f64 = 2.2;
/// Queries squared times standard deviation of an amplitude of 0 or 1; measured.
const NEAR: f64 = 0.63;

/// The number of strata to continue with, or `None` if it cannot be decided yet.
///
/// 1 means to continue with the whole. The run may use `queries` queries, of which `left` remain.
pub(super) fn decided(
    device: &Device<'_>,
    bits: u32,
    amplitude: impl Fn() -> f64,
    queries: u64,
    left: u64,
) -> Option<u32> {
    let used = queries - left;
    let measured = device.measured_paths();
    if used as f64 > LATEST * queries as f64 {
        Some(1)
    } else if used >= FEWEST && enough(measured) {
        let octaves = octaves(measured, amplitude(), bits);
        Some(choose(&octaves, bits, queries, left))
    } else {
        None
    }
}

/// True if the measured paths suffice to estimate the distribution of colours.
fn enough(measured: &[[u64; 2]]) -> bool {
    let sum = |which: usize| measured.iter().map(|found| found[which]).sum::<u64>();
    sum(0) >= ENOUGH && sum(1) >= ENOUGH
}

/// The number of strata with the smallest expected error; 1 unless it gains the factor [`WORTH`].
fn choose(octaves: &[f64], bits: u32, queries: u64, left: u64) -> u32 {
    let all = (1_u64 << bits) as f64;
    let parts = |count: u32| {
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
