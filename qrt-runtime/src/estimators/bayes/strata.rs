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
//! [`choice::WORTH`] with the queries that are left, what is known is given up and the run begins
//! anew with strata; if not, it goes on, and is the same, query by query, as without strata.

use super::run::{Depths, Run};
use super::support::Prior;
use super::{Goal, choice};
use crate::counting::Stratum;
use crate::estimators::device::Usage;
use crate::estimators::{CountedStratum, Device, Estimate, EstimatorError};

/// The fraction of its mean that an amplitude, or what it lacks to 1, is at least for its posterior
/// to be nearly symmetric.
const RESOLVED: f64 = 0.25;

/// A stratum, and what is known of it.
struct StratumRun<'a> {
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
    let mut undecided = bits.filter(|_| goal.strata.is_none());
    let mut whole = Run::new(goal, depths, device.total(), Prior::Even);
    let mut left = goal.queries;
    while left > 0 && !goal.is_reached(&whole.posterior) {
        left -= whole.step(device, left)?;
        let Some(bits) = undecided else {
            continue;
        };
        let amplitude = || whole.posterior.mean_amplitude();
        if let Some(strata) = choice::decided(device, bits, amplitude, goal.queries, left) {
            undecided = None;
            if strata > 1 {
                return in_strata(goal, depths, device, start, bits, strata);
            }
        }
    }
    Ok(whole.posterior.sharpened().estimate(device, start, goal))
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
    let mut parts: Vec<StratumRun<'_>> = Stratum::halving(strata, bits)
        .map(|stratum| StratumRun {
            stratum,
            width: stratum.length() as f64 / all,
            run: Run::new(goal, depths, paths * stratum.length(), Prior::Ends),
            variance: 0.0,
            good_ids: 0,
        })
        .collect();
    parts.iter_mut().for_each(StratumRun::look);
    let mut left = goal.queries - (device.usage().queries - start.queries);
    while left > 0 {
        let gain = |part: &StratumRun<'_>| part.variance / part.run.used.max(1) as f64;
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

impl StratumRun<'_> {
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
/// Each stratum's interval may fail with its n-th part of the failure probability, for each of n may
/// have come to a wrong section of angles. On either side distances to the ends of strata's intervals add in squares, for the strata are
/// measured independently of one another. But those of strata that may be empty or full, or almost,
/// add up: their posteriors are so skewed that all means may be off to the same side, and what was
/// not met in any of them is missing in all at once.
fn sum(parts: &[StratumRun<'_>], confidence: f64) -> (f64, (f64, f64)) {
    let confidence = 1.0 - (1.0 - confidence) / parts.len() as f64;
    let (mut amplitude, mut squares, mut sums) = (0.0, [0.0; 2], [0.0; 2]);
    for part in parts {
        let mean = part.run.posterior.mean_amplitude();
        amplitude += part.width * mean;
        let (low, high) = part.run.posterior.interval(confidence);
        let skewed = low < RESOLVED * mean || 1.0 - high < RESOLVED * (1.0 - mean);
        for (side, distance) in [mean - low, high - mean].into_iter().enumerate() {
            let distance = part.width * distance.max(0.0);
            if skewed {
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
