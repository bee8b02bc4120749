//! The search for the largest likelihood, and for all angles that are not far below it.
//!
//! The search divides angles from coarse to fine. It cuts a range at a turning point of the
//! shallowest level that has one inside, and goes on with the part with the largest upper bound. A
//! part within one section of every level is a *peak*: there L is concave, and bisection of the
//! slope finds its maximum. The search drops only parts whose bound is below the best peak by more
//! than the requested reach, so it misses no peak, for any number of levels. With enough shots at
//! each level, few parts are alive at a time.

use super::likelihood::Likelihood;
use crate::estimators::turns::HALF;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The largest number of parts that the search examines. Parts that are still undecided then count
/// as possible. Runs without noise need some hundreds.
const MOST_PARTS: usize = 20_000;

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// The likeliest angle.
    pub(super) angle: u64,
    /// The smallest angle at which the likelihood is at most `reach` below its largest value.
    pub(super) low: u64,
    /// The largest angle at which the likelihood is at most `reach` below its largest value.
    pub(super) high: u64,
    /// Number of separate ranges of these angles.
    pub(super) ranges: u32,
}

/// Angles of `low ..= high`, and an upper bound of L over them.
#[derive(Clone, Copy, Debug)]
struct AngleRange {
    low: u64,
    high: u64,
    bound: f64,
}

impl Ord for AngleRange {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound
            .total_cmp(&other.bound)
            .then(other.low.cmp(&self.low))
    }
}

impl PartialOrd for AngleRange {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for AngleRange {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for AngleRange {}

/// A local maximum, and the part `low ..= high` in which it is the largest value.
#[derive(Clone, Copy, Debug)]
struct Peak {
    low: u64,
    high: u64,
    angle: u64,
    /// L at `low`, `angle` and `high`.
    values: [f64; 3],
}

/// Finds the largest value of `likelihood`, and all angles at which it is at most `reach` less.
pub(super) fn search(likelihood: &Likelihood, reach: f64) -> Found {
    let part = |low: u64, high: u64| AngleRange {
        low,
        high,
        bound: likelihood.bound(low, high),
    };
    let mut parts = BinaryHeap::from([part(0, HALF)]);
    let mut peaks: Vec<Peak> = Vec::new();
    let mut best = f64::NEG_INFINITY;
    let mut looked = 0;
    while let Some(mut next) = parts.pop() {
        if next.bound < best - reach {
            break;
        }
        if looked > MOST_PARTS {
            parts.push(next);
            break;
        }
        // Descends to a peak through the better halves, so that bounds soon have a value to compare
        // with.
        while next.bound >= best - reach {
            looked += 1;
            let Some(cut) = likelihood.cut(next.low, next.high) else {
                for peak in peaks_of(likelihood, next.low, next.high) {
                    best = best.max(peak.values[1]);
                    peaks.push(peak);
                }
                break;
            };
            let halves = [part(next.low, cut), part(cut, next.high)];
            next = halves[0].max(halves[1]);
            parts.push(halves[0].min(halves[1]));
        }
    }
    peaks.retain(|peak| peak.values[1] >= best - reach);
    let undecided = parts
        .into_iter()
        .filter(|part| part.bound >= best - reach)
        .map(|part| (part.low, part.high))
        .collect();
    summary(likelihood, &peaks, undecided, best - reach)
}

/// The peaks of a part without turning points: one, if L is concave there.
///
/// With noise the part is divided further, evenly, so that its few peaks are separate.
fn peaks_of(likelihood: &Likelihood, low: u64, high: u64) -> impl Iterator<Item = Peak> {
    let pieces = if likelihood.is_concave() { 1 } else { 8 };
    let ends = move |i: u64| {
        let inside = u128::from(high - low) * u128::from(i) / u128::from(pieces);
        low + inside as u64
    };
    (0..pieces)
        .map(move |i| (ends(i), ends(i + 1)))
        .filter(|(low, high)| low < high)
        .map(|(low, high)| peak_of(likelihood, low, high))
}

fn peak_of(likelihood: &Likelihood, low: u64, high: u64) -> Peak {
    let turn = bisect(low, high, likelihood.digits(), |angle| {
        likelihood.slope(angle) > 0.0
    });
    let [first, middle, last] = [low, turn, high].map(|angle| likelihood.at(angle));
    // The maximum may be at an end of all angles, or of a piece.
    let (angle, value) = if middle >= first.max(last) {
        (turn, middle)
    } else if first >= last {
        (low, first)
    } else {
        (high, last)
    };
    Peak {
        low,
        high,
        angle,
        values: [first, value, last],
    }
}

/// The angle at which `low .. high` changes from `holds` to its opposite, to 2^-`digits` of the
/// width.
fn bisect(low: u64, high: u64, digits: u32, holds: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..digits {
        if high - low <= 1 {
            break;
        }
        let middle = low + (high - low) / 2;
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low + (high - low) / 2
}

/// Combines the peaks and the undecided parts; `least` is the smallest L that counts.
fn summary(
    likelihood: &Likelihood,
    peaks: &[Peak],
    undecided: Vec<(u64, u64)>,
    least: f64,
) -> Found {
    let digits = likelihood.digits();
    let inside = |angle: u64| likelihood.at(angle) >= least;
    let best = peaks
        .iter()
        .max_by(|a, b| (a.values[1].total_cmp(&b.values[1])).then(b.angle.cmp(&a.angle)));
    let low_end = |peak: &Peak| {
        if peak.values[0] >= least {
            peak.low
        } else {
            bisect(peak.low, peak.angle, digits, |angle| !inside(angle))
        }
    };
    let high_end = |peak: &Peak| {
        if peak.values[2] >= least {
            peak.high
        } else {
            bisect(peak.angle, peak.high, digits, inside)
        }
    };
    // Ranges touch if a cut lies within one. Otherwise the angles between range and cut do not
    // count.
    let mut ranges: Vec<(u64, u64)> = undecided;
    ranges.extend(peaks.iter().map(|peak| (low_end(peak), high_end(peak))));
    ranges.sort_unstable();
    let (separate, end) = ranges.iter().fold((0, None), |(count, end), &(low, high)| {
        let apart = end.is_none_or(|end| low > end);
        (count + u32::from(apart), end.max(Some(high)))
    });
    Found {
        angle: best.map_or(0, |peak| peak.angle),
        low: ranges.first().map_or(0, |range| range.0),
        high: end.unwrap_or(HALF),
        ranges: separate,
    }
}
