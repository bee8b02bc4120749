//! The error of estimating.

use super::pilot::{COMPARED, Pilot, Runs, SHIFTS};
use crate::estimators::{Device, Problem, Settings, estimator};
use crate::random::Stream;
use crate::render::RenderError;
use qrt_core::scene::{Counting, Estimator};
use rayon::prelude::*;
use std::sync::PoisonError;

impl Pilot<'_> {
    /// What the estimator is off by, run by run and channel by channel, and its queries of a pixel.
    pub(super) fn counted(&self, counting: &Counting) -> Result<Runs, RenderError> {
        let key = (counting.phase_bits, counting.repetitions);
        let known = || self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(runs) = known().get(&key) {
            return Ok(runs.clone());
        }
        let runs = self.count(counting)?;
        known().insert(key, runs.clone());
        Ok(runs)
    }

    fn count(&self, counting: &Counting) -> Result<Runs, RenderError> {
        if self.estimator == Estimator::Exact {
            let none = vec![vec![[0.0; 3]; self.pixels.len()]; self.draws as usize];
            return Ok((none, 0.0));
        }
        let made = estimator(self.estimator, &Settings::of(counting)?)?;
        // As many ids as the scene will have, or almost: more make no difference.
        let total = 1_u64 << (COMPARED + self.comparator_bits);
        let pixel = |(&[x, y], value): (&[u32; 2], &[f64; 3])| {
            let mut errors = vec![[0.0; 3]; self.draws as usize];
            let mut queries = 0;
            for (draw, errors) in (0_u64..).zip(&mut errors) {
                let seed = SHIFTS[2] ^ draw.wrapping_mul(0x9E37_79B9_7F4A_7C15);
                for channel in (0..3).filter(|&c| self.bound[c] > 0.0) {
                    let bound = self.bound[channel];
                    let good = (value[channel] / bound * total as f64).round() as u64;
                    let good = good.min(total);
                    let mut stream = Stream::new(seed, x, y, channel as u8);
                    let problem = Problem { good, total };
                    let mut device = Device::new(problem, self.noise, &mut stream)?;
                    let estimate = made.estimate(&mut device)?;
                    let off = estimate.amplitude - good as f64 / total as f64;
                    errors[channel] = bound * off / self.mean;
                    queries += estimate.queries;
                }
            }
            Ok((errors, queries))
        };
        let pairs = self.pixels.par_iter().zip(&self.values);
        let found = pairs.map(pixel).collect::<Result<Vec<_>, RenderError>>()?;
        let queries: u64 = found.iter().map(|(_, queries)| queries).sum();
        let by_draw = |draw: usize| found.iter().map(|(errors, _)| errors[draw]).collect();
        let errors = (0..self.draws as usize).map(by_draw).collect();
        let runs = self.draws as f64 * self.pixels.len() as f64;
        Ok((errors, queries as f64 / runs))
    }
}
