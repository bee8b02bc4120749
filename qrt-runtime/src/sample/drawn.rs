//! What an estimator says of pixels, drawn several times.

use crate::counting::Octaves;
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

/// What there is to be counted of pixels, by channel.
pub(crate) enum Countable<'a> {
    /// S.
    Whole(&'a [[u64; 3]]),
    /// How paths exceed thresholds, where strata may be counted one by one.
    Octaves(&'a [[Octaves; 3]]),
}

impl Countable<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Whole(good) => good.len(),
            Self::Octaves(good) => good.len(),
        }
    }
}

/// The estimates that were drawn of a pixel.
pub(crate) struct Drawn {
    /// The estimated amplitudes, by draw and channel.
    pub(crate) amplitudes: Vec<[f64; 3]>,
    /// The queries of all draws and channels together.
    pub(crate) queries: u64,
}

impl Draws<'_> {
    /// By pixel, what is drawn.
    pub(crate) fn of(
        &self,
        pixels: &[[u32; 2]],
        good: &Countable<'_>,
    ) -> Result<Vec<Drawn>, EstimatorError> {
        let pairs = pixels.par_iter().zip(0..good.len());
        pairs
            .map(|(pixel, place)| self.pixel(*pixel, good, place))
            .collect()
    }

    fn pixel(
        &self,
        [x, y]: [u32; 2],
        good: &Countable<'_>,
        place: usize,
    ) -> Result<Drawn, EstimatorError> {
        let mut amplitudes = vec![[0.0; 3]; self.count as usize];
        let mut queries = 0;
        for (draw, amplitudes) in (0_u64..).zip(&mut amplitudes) {
            let seed = self.seed ^ draw.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            for channel in (0..3).filter(|&c| self.counted[c]) {
                let mut stream = Stream::new(seed, x, y, channel as u8);
                let mut device = match good {
                    Countable::Whole(good) => {
                        let problem = Problem {
                            good: good[place][channel],
                            total: self.total,
                        };
                        Device::new(problem, self.noise, &mut stream)?
                    }
                    Countable::Octaves(octaves) => {
                        Device::of_octaves(&octaves[place][channel], self.noise, &mut stream)?
                    }
                };
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
