//! The schedule: query depths and numbers of shots.

use super::Mlae;
use crate::estimators::{MAX_ITERATIONS, Noise};

/// The query depths and shots of maximum likelihood estimation on a device with known noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Schedule {
    noise: Noise,
    /// Number of bits of an index.
    bits: u32,
    /// The largest query depth that is worth measuring.
    cap: u64,
}

/// Number of iterations, and number of shots after them.
pub(super) type Planned = (u64, u64);

impl Schedule {
    pub(super) fn new(noise: Noise, bits: u32) -> Self {
        let mut schedule = Self {
            noise,
            bits,
            cap: 0,
        };
        // The information of a query grows with k (1 - d)^(2k), up to k = 1 / (2 d).
        let loss = -libm::log1p(-noise.depolarising);
        let deepest = (0.5 / loss).min(MAX_ITERATIONS as f64).max(1.0) as u64;
        // Information relative to a path's: (2k+1)^2 r^2 / k.
        let gain = (2 * deepest + 1) as f64 * schedule.intact(deepest);
        if gain * gain > deepest as f64 {
            schedule.cap = deepest;
        }
        schedule
    }

    /// The probability that a shot after `iterations` iterations is intact.
    pub(super) fn intact(&self, iterations: u64) -> f64 {
        if iterations == 0 {
            return 1.0;
        }
        self.noise.intact(iterations) * self.noise.read_rightly(self.bits)
    }

    /// Levels that take at most `queries` queries, and nearly all of them.
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
            // No level is deeper than the cap, so every query depth gets more shots.
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

    /// The next level after the planned ones, with at most `left` queries.
    ///
    /// It is about 1.5 times as deep as the deepest one, not twice: no further power of 2
    /// distinguishes two angles that are a power of 1/2 apart.
    pub(super) fn beyond(&self, deepest: u64, spent: u64, left: u64) -> Option<Planned> {
        let depth = (deepest + deepest / 2 + 1).min(self.cap);
        let shots = self.shots(depth, 0);
        if depth == 0 || depth == deepest {
            // Spends the same number of queries again, at the same query depth.
            let shots = spent.min(left) / depth.max(1);
            return (shots > 0).then_some((depth, shots));
        }
        let depth = depth.min(left / shots);
        (depth > 0).then_some((depth, shots))
    }

    /// Level 0 and up to `count` doublings, no deeper than the cap.
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

    /// Number of shots at the query depth `depth`, with `deeper` deeper ones to come.
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
