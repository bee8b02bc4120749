//! What an estimator says of pixels, drawn several times.

use crate::estimators::{AmplitudeEstimator, Device, EstimatorError, Noise, Problem};
use crate::random::Stream;
use rayon::prelude::*;

/// Runs of an estimator on the channels of pixels.
pub(crate) struct Draws<'a> {
    pub(crate) estimator: &'a (dyn AmplitudeEstimator + Send + Sync),
    pub(crate) noise: Noise,
    /// Keys the first draw; the others have keys that follow from it.
    pub(crate) seed: u64,
    /// Draws of each channel.
    pub(crate) count: u64,
    /// By channel, whether anything is to be counted: its amplitude is 0 if not.
    pub(crate) counted: [bool; 3],
    /// N, the number of indices of a channel.
    pub(crate) total: u64,
}

/// The estimates that were drawn of a pixel.
pub(crate) struct Drawn {
    /// The estimated amplitudes, by draw and channel.
    pub(crate) amplitudes: Vec<[f64; 3]>,
    /// The queries of all draws and channels together.
    pub(crate) queries: u64,
}

impl Draws<'_> {
    /// By pixel, what is drawn; `good` are S by pixel and channel.
    pub(crate) fn of(
        &self,
        pixels: &[[u32; 2]],
        good: &[[u64; 3]],
    ) -> Result<Vec<Drawn>, EstimatorError> {
        let pairs = pixels.par_iter().zip(good);
        pairs
            .map(|(pixel, good)| self.pixel(*pixel, good))
            .collect()
    }

    fn pixel(&self, [x, y]: [u32; 2], good: &[u64; 3]) -> Result<Drawn, EstimatorError> {
        let mut amplitudes = vec![[0.0; 3]; self.count as usize];
        let mut queries = 0;
        for (draw, amplitudes) in (0_u64..).zip(&mut amplitudes) {
            let seed = self.seed ^ draw.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            for channel in (0..3).filter(|&c| self.counted[c]) {
                let mut stream = Stream::new(seed, x, y, channel as u8);
                let problem = Problem {
                    good: good[channel],
                    total: self.total,
                };
                let mut device = Device::new(problem, self.noise, &mut stream)?;
                let estimate = self.estimator.estimate(&mut device)?;
                amplitudes[channel] = estimate.amplitude;
                queries += estimate.queries;
            }
        }
        Ok(Drawn {
            amplitudes,
            queries,
        })
    }
}
