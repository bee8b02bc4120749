//! Counts the comparator in parts, each on its own.
//!
//! With the comparator's top bits fixed, a circuit counts the good indices of a [`Stratum`] alone:
//!
//! ```text
//! S/N = sum_k w_k a_k,    w_k the fraction of thresholds, a_k of good indices of stratum k.
//! ```
//!
//! After Q_k queries the error of a_k is about `sqrt(a_k (1 - a_k)) / Q_k`, and the errors of
//! strata add in squares. With `x_k = w_k sqrt(a_k (1 - a_k))` the best split is `Q_k ~ x_k^(2/3)`,
//! with
//!
//! ```text
//! error ~ (sum_k x_k^(2/3))^(3/2) / Q,
//! ```
//!
//! as opposed to `sqrt(a (1 - a)) / Q` for the whole at once. If paths' colours are small against
//! their bound, the lowest stratum has all of S and a small width, and the others are empty. If
//! each path is all or nothing, all strata are alike and there is no gain.
//!
//! # How queries are split
//!
//! Each stratum has a posterior of its own. The next shot is in the stratum with the largest
//! `w_k^2 Var(a_k) / Q_k`. At the best split this value is the same in all strata: with variances
//! that fall as `1/Q_k^2`, it is the amount that one more query takes off the variance of the sum.
//! The split therefore follows from the outcomes, and a stratum gets no more shots once it is known
//! to be empty.
//!
//! Strata are often empty or full, and each has its own posterior. With a prior uniform in every
//! `a_k`, the overestimates of empty strata would add up and be the largest part of the error. The
//! prior of strata is therefore [`Prior::Ends`]. Their intervals are still those of a uniform
//! prior.

use super::super::Goal;
use super::super::run::{Depths, Run};
use super::super::support::Prior;
use crate::Stratum;
use crate::estimators::device::Usage;
use crate::estimators::{CountedStratum, Device, Estimate, EstimatorError};

/// A posterior is nearly symmetric if the lower end of its interval is at least this fraction of
/// its mean, and likewise the upper end, measured from 1.
const RESOLVED: f64 = 0.25;

/// A stratum and the run that counts it.
struct StratumRun<'a> {
    stratum: Stratum,
    /// The stratum's fraction of all thresholds.
    width: f64,
    run: Run<'a>,
    /// Variance of the stratum's contribution to the whole.
    variance: f64,
    good_ids: u64,
}

/// Counts `strata` strata, each on its own, with the queries that remain since `start`.
pub(super) fn estimate(
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
    /// Updates the variance after a shot.
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
/// Each stratum's interval has an n-th part of the failure probability, because each of the n
/// strata may have ended at a wrong section of angles. On either side, the distances to the ends of
/// strata's intervals add in squares, because the strata are measured independently. The distances
/// of strata that may be empty or full, or almost, add linearly: their posteriors are so skewed
/// that all means may be off to the same side, and good indices that none of them has measured are
/// missing in all at once.
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
