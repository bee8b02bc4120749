//! Which query depths are measured, and how often.

use super::Mlae;
use crate::estimators::{MAX_ITERATIONS, Noise};

/// The query depths and shots of maximum likelihood estimation on a device with known noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Schedule {
    noise: Noise,
    /// Bits of an index.
    bits: u32,
    /// The deepest that is worth measuring.
    cap: u64,
}

/// Iterations, and shots after as many.
pub(super) type Planned = (u64, u64);

impl Schedule {
    pub(super) fn new(noise: Noise, bits: u32) -> Self {
        let mut schedule = Self {
            noise,
            bits,
            cap: 0,
        };
        // The information of a query grows with k (1 - d)^(2k): up to k = 1 / (2 d).
        let loss = -libm::log1p(-noise.depolarising);
        let deepest = (0.5 / loss).min(MAX_ITERATIONS as f64).max(1.0) as u64;
        // Relative to a path's: (2k+1)^2 r^2 / k.
        let gain = (2 * deepest + 1) as f64 * schedule.intact(deepest);
        if gain * gain > deepest as f64 {
            schedule.cap = deepest;
        }
        schedule
    }

    /// The probability that a shot after `iterations` is intact.
    pub(super) fn intact(&self, iterations: u64) -> f64 {
        if iterations == 0 {
            return 1.0;
        }
        self.noise.intact(iterations) * self.noise.read_rightly(self.bits)
    }

    /// What takes at most `queries`, and nearly all of them.
    pub(super) fn levels(&self, queries: u64) -> Vec<Planned> {
        let mut levels = vec![(0, queries)];
        loop {
            let more = self.doubling(levels.len() as u32);
            if more.len() == levels.len() || cost(&more) > u128::from(queries) {
                break;
            }
            levels = more;
        }
        let deepest = levels.last().map_or(0, |level| level.0);
        let spent = cost(&levels);
        let left = (u128::from(queries) - spent) as u64;
        if deepest == self.cap && deepest > 0 {
            // No deeper: more shots at every query depth.
            let factor = u128::from(queries) / spent;
            for level in &mut levels {
                level.1 = (u128::from(level.1) * factor) as u64;
            }
        } else if deepest > 0 {
            let depth = (left / self.shots(deepest, 0))
                .min(2 * deepest)
                .min(self.cap);
            if depth > 0 {
                levels.push((depth, left / depth));
            }
        }
        levels
    }

    /// The next level, where the planned ones did not suffice: at most `left` queries.
    ///
    /// Half as deep again, and not twice: two angles that are a power of 1/2 apart look the same
    /// to all powers of 2 beyond.
    pub(super) fn beyond(&self, deepest: u64, spent: u64, left: u64) -> Option<Planned> {
        let depth = (deepest + deepest / 2 + 1).min(self.cap);
        let shots = self.shots(depth, 0);
        if depth == 0 || depth == deepest {
            // As much again, at the same query depth.
            let shots = spent.min(left) / depth.max(1);
            return (shots > 0).then_some((depth, shots));
        }
        let depth = depth.min(left / shots);
        (depth > 0).then_some((depth, shots))
    }

    /// Level 0 and `count` doublings, as far as they are of use.
    fn doubling(&self, count: u32) -> Vec<Planned> {
        let depth = |level: u32| if level == 0 { 0 } else { 1_u64 << (level - 1) };
        let last = (0..=count.min(60))
            .rev()
            .find(|&level| depth(level) <= self.cap)
            .unwrap_or(0);
        (0..=last)
            .map(|level| (depth(level), self.shots(depth(level), last - level)))
            .collect()
    }

    /// Shots at a query depth, with so many deeper ones to come.
    fn shots(&self, depth: u64, deeper: u32) -> u64 {
        let intact = self.intact(depth);
        let shots = (Mlae::SHOTS + Mlae::MORE_SHOTS * u64::from(deeper)) as f64;
        (shots / (intact * intact)).ceil() as u64
    }
}

fn cost(levels: &[Planned]) -> u128 {
    levels
        .iter()
        .map(|&(depth, shots)| u128::from(depth.max(1)) * u128::from(shots))
        .sum()
}
