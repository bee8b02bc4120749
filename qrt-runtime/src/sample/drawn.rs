//! Estimates of pixels, drawn several times.

use qrt_counting::LevelCounts;
use qrt_counting::estimators::{
    AmplitudeEstimator, CountingProblem, Device, EstimatorError, Noise, Settings, estimator,
};
use qrt_counting::random::Stream;
use qrt_scene::Counting;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Runs of an estimator on the channels of pixels.
pub struct Draws<'a> {
    /// The block `counting` of the scene.
    pub counting: &'a Counting,
    /// The scale of colours, by pixel and channel. If it is 0, nothing is counted, and the
    /// amplitude is 0.
    pub scales: &'a [[f64; 3]],
    /// The noise of the device.
    pub noise: Noise,
    /// The key of the first draw; the keys of the others follow from it.
    pub seed: u64,
    /// Number of draws of each channel.
    pub count: u64,
    /// N, the number of indices of a channel.
    pub total: u64,
}

/// An estimator for each scale. There are few scales: one for each channel and class of pixels.
type Estimators = BTreeMap<u64, Box<dyn AmplitudeEstimator + Send + Sync>>;

/// The counts of good indices of pixels, by channel.
pub enum Countable<'a> {
    /// S, the number of good indices.
    Whole(&'a [[u64; 3]]),
    /// The levels of paths, for estimators that may read the colours of measured paths.
    Levels(&'a [[LevelCounts; 3]]),
}

impl Countable<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Whole(good) => good.len(),
            Self::Levels(good) => good.len(),
        }
    }
}

/// The estimates that were drawn for one pixel.
pub struct PixelEstimates {
    /// The estimated amplitudes, by draw and channel.
    pub amplitudes: Vec<[f64; 3]>,
    /// The queries of all draws together, by channel.
    pub queries: [u64; 3],
}

impl Draws<'_> {
    /// Draws the estimates of all `pixels`. [`scales`](Self::scales) and `good` have an entry for each.
    ///
    /// # Errors
    /// If the estimator cannot count these indices.
    ///
    /// # Panics
    /// If there are fewer scales than pixels with counts.
    pub fn draw(
        &self,
        pixels: &[[u32; 2]],
        good: &Countable<'_>,
    ) -> Result<Vec<PixelEstimates>, EstimatorError> {
        let mut estimators = Estimators::new();
        let counted = self.scales.iter().flatten().filter(|&&scale| scale > 0.0);
        for &scale in counted {
            if let Entry::Vacant(entry) = estimators.entry(scale.to_bits()) {
                let settings = Settings::of_channel(self.counting, scale)?;
                entry.insert(estimator(self.counting.estimator(), &settings)?);
            }
        }
        let pairs = pixels.par_iter().zip(0..good.len());
        pairs
            .map(|(pixel, place)| self.pixel(*pixel, good, place, &estimators))
            .collect()
    }

    fn pixel(
        &self,
        [x, y]: [u32; 2],
        good: &Countable<'_>,
        place: usize,
        estimators: &Estimators,
    ) -> Result<PixelEstimates, EstimatorError> {
        let scales = self.scales[place].map(f64::to_bits);
        let estimators = scales.map(|scale| estimators.get(&scale));
        let mut amplitudes = vec![[0.0; 3]; self.count as usize];
        let mut queries = [0; 3];
        for (draw, amplitudes) in (0_u64..).zip(&mut amplitudes) {
            let seed = self.seed ^ draw.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            for (channel, estimator) in estimators.into_iter().enumerate() {
                let Some(estimator) = estimator else {
                    continue;
                };
                let mut stream = Stream::new(seed, x, y, channel as u8);
                let mut device = match good {
                    Countable::Whole(good) => {
                        let problem = CountingProblem {
                            good: good[place][channel],
                            total: self.total,
                        };
                        Device::new(problem, self.noise, &mut stream)?
                    }
                    Countable::Levels(levels) if self.counting.estimator().reads_levels() => {
                        Device::of_levels(&levels[place][channel], self.noise, &mut stream)?
                    }
                    Countable::Levels(levels) => {
                        let octaves = levels[place][channel].octaves();
                        Device::of_octaves(&octaves, self.noise, &mut stream)?
                    }
                };
                let estimate = estimator.estimate(&mut device)?;
                amplitudes[channel] = estimate.amplitude;
                queries[channel] += estimate.queries;
            }
        }
        Ok(PixelEstimates {
            amplitudes,
            queries,
        })
    }
}
