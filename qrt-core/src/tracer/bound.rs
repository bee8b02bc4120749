//! The bound on a path's colour: the colour scale of the comparator, in the paper `2^b`.
//!
//! The tighter it is, the larger the share of good ids that a pixel has, and the fewer queries
//! an estimate needs. With `L_1 = max Le`, a path of `k` rays carries at most
//! `L_k = max over surfaces of (Le + W L_{k-1})`, where `W` bounds the weight at that depth.

use super::scatter::ScatterStage;
use crate::valid::Surface;

/// Per channel, an upper bound of the colour of every path.
pub(crate) fn colour<const C: usize>(
    surfaces: &[&Surface],
    radiance: &[[f64; C]],
    scatters: &[ScatterStage<C>],
) -> [f64; C] {
    std::array::from_fn(|c| {
        let most = radiance
            .iter()
            .map(|radiance| radiance[c])
            .fold(0.0, f64::max);
        // From the last vertex back to the first.
        scatters.iter().rev().fold(most, |beyond, scatter| {
            (0..surfaces.len())
                .map(|s| radiance[s][c] + scatter.weight_bound(surfaces, s as u32, c) * beyond)
                .fold(0.0, f64::max)
        })
    })
}
