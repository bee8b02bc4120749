//! `qcoin`: the quantum coin method.

use super::abrams_williams::most_for;
use super::clopper_pearson::clopper_pearson;
use super::coin::{Coin, intersection, most_queries};
use super::{AmplitudeEstimator, Device, Estimate, EstimatorError, Noise, Settings};
use crate::binomial;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};
use std::sync::LazyLock;

/// A step is the last one if the remaining queries do not suffice for this number of equal steps:
/// for itself and the next step, which takes twice the queries.
const LAST: u64 = 3;

/// `qcoin`: the quantum coin method (Shimada & Hachisuka, *Quantum coin method for numerical
/// integration*, Computer Graphics Forum 39(6), 2020), a hybrid of classical and quantum steps
/// after Abrams & Williams.
///
/// The first step tosses a coin that shows heads with probability a, L times: these are classical
/// paths. The fraction of heads gives an interval for a. Every further step tosses L coins of
/// [`Device::shifted`], with an end of the interval as reference. They take twice the queries of
/// the step before, and each step halves the interval. K steps take at most `L (2^K - 1)` queries.
///
/// *Parameters.* After each step the estimator takes a to be within pi/8 of the estimate in the
/// coin's angle `m omega`. (To first order, these are the authors' limits, `sin(pi/2^(k+1))/2`
/// after step k. The authors always shift by the lower end, and by f - E itself. Here the end
/// nearer to 1/2 and the full scale of f - E save up to half of a step's queries.) L is the
/// smallest number with which the limits of all steps hold, except with half of the failure
/// probability. K is as large as the queries allow. With known noise the limits are
/// Clopper-Pearson's, for the same half of the failure probability. The authors leave L to
/// experiment: with their 4 tosses, there are a for which a step misses as often as not. The last
/// step uses all remaining queries for tosses.
///
/// Interval: the Clopper-Pearson interval of the last step's tosses, for the other half of the
/// failure probability, within the limits. The coverage is at least the requested confidence for
/// every S. If an error is requested, steps follow until the interval's half-width is at most that
/// error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantumCoin {
    settings: Settings,
    tosses: u64,
}

impl QuantumCoin {
    pub(super) fn new(settings: &Settings) -> Self {
        let failure = 0.5 * (1.0 - settings.confidence);
        let mut tosses = 1;
        while tosses < settings.queries
            && f64::from(steps(settings.queries, tosses)) * step_fails(tosses) > failure
        {
            tosses += 1;
        }
        Self {
            settings: *settings,
            tosses,
        }
    }

    /// L, the number of tosses of a step.
    pub fn tosses(&self) -> u64 {
        self.tosses
    }
}

impl AmplitudeEstimator for QuantumCoin {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let Settings {
            queries,
            confidence,
            known_noise,
            ..
        } = self.settings;
        let start = device.usage();
        let failure = 0.5 * (1.0 - confidence);
        let error = self.settings.error.unwrap_or(0.0);
        let deepest = most_queries(known_noise);
        let steps = steps(queries, self.tosses);
        // With a requested error, the run may stop after any step, so each step's interval has its
        // part of the failure probability. Otherwise the queries alone determine the last step.
        let each = failure / f64::from(if error > 0.0 { steps } else { 1 });
        let enough = most_for(error, each, self.tosses);

        let mut left = queries;
        let paths = if left / LAST < self.tosses {
            left
        } else {
            self.tosses
        };
        let hits = device.paths(paths);
        left -= paths;
        let mut amplitude = hits as f64 / paths as f64;
        let mut interval = clopper_pearson(hits, paths, each);
        let middle = libm::asin(amplitude.sqrt());
        let at = |angle: f64| libm::sin(angle.clamp(0.0, FRAC_PI_2)).powi(2);
        let mut limits = (at(middle - FRAC_PI_8), at(middle + FRAC_PI_8));
        for step in 2..=steps {
            if left == 0 || 0.5 * (interval.1 - interval.0) <= error {
                break;
            }
            let mut coin = Coin::new(limits, deepest.min(enough));
            let mut shots = self.tosses;
            if coin.queries == deepest {
                shots = shots.max(coin.tosses_for(error, each, known_noise, device.total()));
            }
            let cost = coin.queries.saturating_mul(shots);
            let last = step == steps || left / LAST < cost;
            if last {
                coin = coin.with_queries(coin.queries.min(left / self.tosses).max(1));
                shots = left / coin.queries;
            }
            let tosses = coin.toss(device, shots, known_noise)?;
            left = if last { 0 } else { left - cost };
            interval = intersection(limits, coin.interval(&tosses, each));
            amplitude = coin.estimate(&tosses).clamp(interval.0, interval.1);
            let found = if known_noise == Noise::NONE {
                coin.around(&tosses, FRAC_PI_8)
            } else {
                coin.interval(&tosses, failure / f64::from(steps))
            };
            limits = intersection(limits, found);
        }
        Ok(device.estimate(start, amplitude, interval, confidence))
    }
}

/// The largest number of steps of `tosses` tosses each, the first with one query per toss.
///
/// Queries per toss double from step to step, except for rounding. They may stay the same once,
/// where the reference passes 1/2.
fn steps(queries: u64, tosses: u64) -> u32 {
    u64::BITS - (queries / tosses).leading_zeros() + 2
}

/// An upper bound of the probability that L tosses put the fraction of heads off by more than pi/8.
///
/// The deviation is in the angle of the fraction, and the bound holds for every probability of
/// heads. From 65 tosses on it is Chernoff's, with the Kullback-Leibler divergence bounded from
/// below by that of Bhattacharyya, `-2 ln cos(pi/8)`.
fn step_fails(tosses: u64) -> f64 {
    static FEW: LazyLock<Vec<f64>> = LazyLock::new(|| (0..=64).map(worst_angle).collect());
    match FEW.get(tosses as usize) {
        Some(&few) => few,
        None => 2.0 * libm::exp(2.0 * tosses as f64 * libm::log(libm::cos(FRAC_PI_8))),
    }
}

/// The same bound for few tosses, by summation.
///
/// With heads at an angle x in [0, pi/2], k is too low if its angle is below x - pi/8, and too high
/// if its angle is above x + pi/8. The probability of too low a k falls with x, and that of too
/// high a k grows. On a piece between the angles at which a k joins, the values at its two ends
/// therefore bound the sum.
fn worst_angle(tosses: u64) -> f64 {
    const PIECES: usize = 8;
    if tosses == 0 {
        return 1.0;
    }
    let n = tosses as f64;
    let angle = |k: u64| libm::asin((k as f64 / n).sqrt());
    let mut ends: Vec<f64> = (0..=tosses)
        .flat_map(|k| [angle(k) - FRAC_PI_8, angle(k) + FRAC_PI_8])
        .filter(|end| (0.0..=FRAC_PI_2).contains(end))
        .chain([0.0, FRAC_PI_2])
        .collect();
    ends.sort_by(f64::total_cmp);
    let mut worst = 0.0;
    for pair in ends.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let few = (0..=tosses)
            .filter(|&k| angle(k) < middle - FRAC_PI_8)
            .count() as u64;
        let many = (0..=tosses)
            .filter(|&k| angle(k) > middle + FRAC_PI_8)
            .count() as u64;
        let at = |i: usize| pair[0] + (pair[1] - pair[0]) * i as f64 / PIECES as f64;
        for piece in 0..PIECES {
            // The `many` largest k are those with fewer than `many` tails.
            let below = tail(tosses, few, at(piece));
            let above = tail(tosses, many, FRAC_PI_2 - at(piece + 1));
            worst = f64::max(worst, below + above);
        }
    }
    worst.min(1.0)
}

/// The probability of fewer than `below` heads in `tosses` tosses at an angle x.
fn tail(tosses: u64, below: u64, x: f64) -> f64 {
    let p = libm::sin(x).powi(2);
    if p <= 0.0 || p >= 1.0 {
        let certain = p <= 0.0 && below > 0 || below > tosses;
        return f64::from(u8::from(certain));
    }
    (0..below)
        .map(|k| libm::exp(binomial::ln_probability(tosses as f64, p, k as f64)))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the bound with exact probabilities on a fine grid of angles.
    #[test]
    fn steps_fail_as_often_as_the_worst_angle_says() {
        for tosses in [1_u64, 2, 4, 9, 16, 25, 64] {
            let n = tosses as f64;
            let mut worst = 0.0;
            for i in 1..4000 {
                let x = FRAC_PI_2 * f64::from(i) / 4000.0;
                let off = |k: &u64| (libm::asin((*k as f64 / n).sqrt()) - x).abs() > FRAC_PI_8;
                let p = libm::sin(x).powi(2);
                let fails: f64 = (0..=tosses)
                    .filter(off)
                    .map(|k| libm::exp(binomial::ln_probability(n, p, k as f64)))
                    .sum();
                worst = f64::max(worst, fails);
            }
            let bound = step_fails(tosses);
            assert!(bound >= worst, "{tosses}: {bound}, {worst}");
            assert!(bound <= 1.4 * worst, "{tosses}: {bound}, {worst}");
        }
        // The failure here is four tosses without heads, at an angle just above pi/8.
        assert!(step_fails(4) > libm::cos(FRAC_PI_8).powi(8));
        assert!(step_fails(65) > step_fails(64) && step_fails(65) < 1e-4);
    }
}
