//! Sums over the paths of a film's pixels without a picture, for measuring errors.
//!
//! Each function sums over a list of pixels. The order of a sum follows from path indices, so the
//! sums do not depend on the number of threads. The work runs on the threads of the caller's pool.

mod drawn;
mod error;
mod spread;
mod sum;
mod tally;

pub use drawn::{Countable, Draws, PixelEstimates};
pub use error::SampleError;
pub use spread::spread;
pub use sum::Sum;
pub use tally::{Tally, tallies};

use crate::path_machines::PathMachine;
use crate::workers::Workers;

/// The mean of a pixel's paths, by pixel and channel.
pub type Means = Vec<[f64; 3]>;

/// The means of `pixels` over their first `2^k` paths, for each k of `bits` (ascending, none beyond
/// the machine's path bits). Under the digital net, these are the pixels of a scene with k path
/// bits.
///
/// # Errors
/// See [`SampleError`].
pub fn prefix_means(
    real: &dyn PathMachine,
    pixels: &[[u32; 2]],
    bits: &[u32],
    workers: &Workers<'_>,
) -> Result<Vec<Means>, SampleError> {
    let mut sums = vec![[0.0; 3]; pixels.len()];
    let mut first = 0;
    let mut means = Vec::with_capacity(bits.len());
    for &bits in bits {
        let paths = 1_u64 << bits;
        for (sum, tally) in sums
            .iter_mut()
            .zip(tallies(real, pixels, first..paths, &[], workers)?)
        {
            for (sum, more) in sum.iter_mut().zip(tally.colour) {
                *sum += more;
            }
        }
        first = paths;
        means.push(
            sums.iter()
                .map(|sum| sum.map(|s| s / paths as f64))
                .collect(),
        );
    }
    Ok(means)
}

/// The mean over pixels and channels.
pub fn radiance(means: &[[f64; 3]]) -> f64 {
    let sum: f64 = means.iter().flatten().sum();
    sum / (3 * means.len()).max(1) as f64
}
