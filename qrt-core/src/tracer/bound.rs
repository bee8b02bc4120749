//! The bound on a path's colour: the colour scale of the comparator, in the paper `2^b`.
//!
//! The tighter it is, the larger the fraction of good basis states that a pixel has, and the fewer
//! queries an estimate needs. With `L_1 = max Le`, a path of `k` rays carries at most
//! `L_k = max over surfaces of (Le + W L_{k-1})`, where `W` bounds the weight at that depth.

use super::bsdf::ScatterStage;

/// An upper bound of the colour of every path, per channel.
pub(crate) fn colour<const C: usize>(
    radiance: &[[f64; C]],
    scatters: &[ScatterStage<C>],
) -> [f64; C] {
    // The greatest by channel, of rows by surface.
    let greatest = |rows: &mut dyn Iterator<Item = [f64; C]>| {
        rows.fold([0.0; C], |most, row| {
            std::array::from_fn(|c| f64::max(most[c], row[c]))
        })
    };
    let most = greatest(&mut radiance.iter().copied());
    // From the last vertex back to the first.
    scatters.iter().rev().fold(most, |beyond, scatter| {
        greatest(&mut radiance.iter().enumerate().map(|(surface, emitted)| {
            let weight = scatter.weight_bound(surface as u32);
            std::array::from_fn(|c| emitted[c] + weight[c] * beyond[c])
        }))
    })
}
