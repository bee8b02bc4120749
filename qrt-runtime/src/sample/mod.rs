//! What the paths of a film's pixels sum to, without a picture: for those who measure errors.
//!
//! All sums are over pixels that are given, in an order that path indices decide, so that they do
//! not depend on the number of threads. Work is done on the threads of the pool that calls.

mod drawn;
mod error;
mod spread;
mod sum;
mod tally;

pub(crate) use drawn::{Countable, Drawn, Draws};
pub use error::SampleError;
pub use spread::spread;
pub(crate) use sum::Sum;
pub use tally::{Tally, counted_tallies, tallies};

use crate::machines::Real;
use crate::workers::Workers;

/// By pixel and channel, the mean of a pixel's paths.
pub type Means = Vec<[f64; 3]>;

/// The means of `pixels` over their first `2^k` paths, for each k of `bits` (ascending, none beyond
/// the machine's path bits): under the digital net, what a scene of so many path bits shows.
///
/// # Errors
/// See [`SampleError`].
pub fn prefix_means(
    real: &Real,
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
