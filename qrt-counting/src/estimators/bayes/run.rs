//! A Bayesian run that can be suspended after any shot and resumed.

use super::posterior::Posterior;
use super::support::Prior;
use super::{Goal, depth};
use crate::estimators::{Device, EstimatorError, MAX_ITERATIONS};

/// The rule that chooses query depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Depths {
    /// From the posterior: see [`super::AdaptiveBayes`].
    Adaptive,
    /// At random from a growing range: see [`super::RandomDepth`].
    Random {
        /// The end of the range.
        range: f64,
        /// Number of shots made.
        shots: u64,
    },
}

impl Depths {
    /// Random query depths, before the first shot.
    pub(super) const RANDOM: Self = Self::Random {
        range: 1.0,
        shots: 0,
    };
}

/// The factor by which the range of random query depths grows with each shot.
const GROWTH: f64 = 1.09;

/// A run in progress.
#[derive(Clone, Debug)]
pub(super) struct Run<'a> {
    goal: &'a Goal,
    depths: Depths,
    pub(super) posterior: Posterior,
    /// Number of queries used.
    pub(super) used: u64,
}

impl<'a> Run<'a> {
    /// Creates a run over `total` indices, before its first shot.
    pub(super) fn new(goal: &'a Goal, depths: Depths, total: u64, before: Prior) -> Self {
        Self {
            goal,
            depths,
            posterior: Posterior::new(total, goal.noise, before),
            used: 0,
        }
    }

    /// True if S is known.
    pub(super) fn is_over(&self) -> bool {
        Goal::is_known(&self.posterior)
    }

    /// Measures `paths` random paths, and returns the number of queries used.
    pub(super) fn sample(
        &mut self,
        device: &mut Device<'_>,
        paths: u64,
    ) -> Result<u64, EstimatorError> {
        let good = device.iterated(0, paths)?;
        self.posterior.observe(0, good, paths - good);
        self.used += paths;
        Ok(paths)
    }

    /// Makes the next measurement, of at most `left` queries, and returns the number of queries
    /// used.
    ///
    /// `left` is at least one.
    pub(super) fn step(
        &mut self,
        device: &mut Device<'_>,
        left: u64,
    ) -> Result<u64, EstimatorError> {
        let (iterations, shots) = match &mut self.depths {
            Depths::Adaptive => {
                let plan = depth::choose(&mut self.posterior, &self.goal.noise, left);
                (plan.iterations, plan.shots)
            }
            Depths::Random { range, shots } => {
                let most = (MAX_ITERATIONS as f64).min(2.0 * depth::useful(&self.goal.noise));
                let limit = most.min(self.posterior.deepest()).min(left as f64);
                let held_back = *range > limit;
                let deepest = range.min(limit) as u64;
                // The upper half of the product of 64 random bits and a range below 2^45 is
                // uniform.
                let draw = u128::from(device.stream().next_u64()) * u128::from(deepest + 1);
                let iterations = (draw >> 64) as u64;
                // If the range must not grow, the number of shots grows instead.
                let batch = if held_back && *range > most {
                    (*shots as f64 * (GROWTH - 1.0)) as u64
                } else {
                    1
                };
                let batch = batch.clamp(1, left / iterations.max(1));
                *shots += batch;
                if !held_back {
                    *range *= GROWTH;
                }
                (iterations, batch)
            }
        };
        let good = device.iterated(iterations, shots)?;
        self.posterior.observe(iterations, good, shots - good);
        let queries = shots * iterations.max(1);
        self.used += queries;
        Ok(queries)
    }
}
