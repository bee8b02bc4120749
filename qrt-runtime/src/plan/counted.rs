//! The error of estimating amplitudes.

use super::PlanError;
use super::pilot::{COMPARED, Pilot, Runs, SHIFTS};
use crate::sample::{Countable, Draws, PixelEstimates};
use qrt_counting::LevelCounts;
use qrt_scene::{Counting, Estimator};
use std::sync::PoisonError;

impl Pilot<'_> {
    /// The errors of the estimator, by run, pixel and channel, and its mean queries of a pixel, by
    /// channel.
    pub(super) fn counted(&self, counting: &Counting) -> Result<Runs, PlanError> {
        let error = counting.error.map(f64::to_bits);
        let key = (counting.phase_bits, counting.repetitions, error);
        let known = || self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(runs) = known().get(&key) {
            return Ok(runs.clone());
        }
        let runs = self.count(counting)?;
        known().insert(key, runs.clone());
        Ok(runs)
    }

    fn count(&self, counting: &Counting) -> Result<Runs, PlanError> {
        if self.estimator == Estimator::Exact {
            let none = vec![vec![[0.0; 3]; self.pixels.len()]; self.draws as usize];
            return Ok((none, [0.0; 3]));
        }
        // About the number of indices that the scene will have; more would not change the errors.
        let total = 1_u64 << (COMPARED + self.comparator_bits);
        let good_of = |(value, bounds): (&[f64; 3], &[f64; 3])| -> [u64; 3] {
            std::array::from_fn(|c| match bounds[c] {
                0.0 => 0,
                bound => ((value[c] / bound * total as f64).round() as u64).min(total),
            })
        };
        // The levels are known only for these 2^COMPARED paths. Their mean differs a little from
        // the best known value, but the errors of estimating the two are alike.
        let good: Vec<[u64; 3]> = if self.levels.is_empty() {
            self.values.iter().zip(&self.bounds).map(good_of).collect()
        } else {
            let good = |levels: &[LevelCounts; 3]| levels.each_ref().map(LevelCounts::good);
            self.levels.iter().map(good).collect()
        };
        let draws = Draws {
            counting,
            scales: &self.bounds,
            noise: self.noise,
            seed: SHIFTS[2],
            count: self.draws,
            total,
        };
        let countable = if self.levels.is_empty() {
            Countable::Whole(&good)
        } else {
            Countable::Levels(&self.levels)
        };
        let found = draws.draw(&self.pixels, &countable)?;
        let by_draw = |draw: usize| {
            let pixels = found.iter().zip(&good).zip(&self.bounds);
            let off = |((drawn, good), bound): ((&PixelEstimates, &[u64; 3]), &[f64; 3])| {
                std::array::from_fn(|c| {
                    let off = drawn.amplitudes[draw][c] - good[c] as f64 / total as f64;
                    bound[c] * off / self.mean
                })
            };
            pixels.map(off).collect()
        };
        let errors = (0..self.draws as usize).map(by_draw).collect();
        let runs = self.draws as f64 * self.pixels.len() as f64;
        let queries = std::array::from_fn(|c| {
            let queries: u64 = found.iter().map(|drawn| drawn.queries[c]).sum();
            queries as f64 / runs
        });
        Ok((errors, queries))
    }
}
