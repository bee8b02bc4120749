//! The bound on a path's colour: the colour scale of the comparator, in the paper `2^b`.
//!
//! A tighter bound gives a pixel a larger fraction of good basis states, so that an estimate needs
//! fewer queries. Let `B_k(s)` be a bound on the light that a path carries from its vertex `k` at the
//! place `s`, without the emission there. Let `W` be the weight, `F(s, t)` the factor by which the
//! emission of `t` counts on a ray from `s`, and `N(s)` the light that a lamp adds if it is sampled at
//! `s`:
//!
//! ```text
//! B_k(s) = N(s) + W(s) max over t that s sees of (F(s, t) Le(t) + B_{k+1}(t))
//! ```
//!
//! Beside the places, `s` sees the sky, whose light counts wholly, and before it the sun, whose light counts as
//! that of a lamp. If no lamp is sampled, `N` is 0 and `F` is 1. A path from the camera carries at most the greatest
//! `B_0` of the places that the camera sees, plus `Le` if the path may meet a lamp directly. Places
//! are those of [`Places`]: sides of faces, or surfaces.

use super::bsdf::ScatterStage;
use super::places::Places;
use super::refraction::Refraction;

/// An upper bound of the colour of every path, per channel, given the radiance of each surface, the
/// greatest of the sky, and that of the sun. It includes the emission at the primary hit only if `direct`, and the
/// sun where primary rays meet nothing only if `sees_sun`. If there is a `refraction`, its bound replaces the weights
/// of the glass surfaces for which it holds.
pub(crate) fn colour<const C: usize>(
    places: &Places,
    (radiance, sky, sun): (&[[f64; C]], [f64; C], [f64; C]),
    scatters: &[ScatterStage<C>],
    [direct, sees_sun]: [bool; 2],
    refraction: Option<&Refraction>,
) -> [f64; C] {
    let emitted = |place: usize| &radiance[places.surface(place) as usize];
    let mut beyond = vec![[0.0; C]; places.len()];
    // From the last vertex back to the first.
    for scatter in scatters.iter().rev() {
        let at = |place: usize| {
            let surface = places.surface(place);
            let mut weight = scatter.weight_bound(surface);
            if refraction.is_some_and(|refraction| refraction.is_of(surface)) {
                weight = [1.0; C];
            }
            let samples = scatter.samples_lights(surface);
            let lights = scatter.lights.as_ref();
            let counts = lights.map_or(1.0, |l| l.sun_bound(places, place, samples));
            let mut most: [f64; C] = std::array::from_fn(|c| sky[c] + counts * sun[c]);
            for other in places.next(place) {
                let factor =
                    lights.map_or(1.0, |l| l.emission_bound(places, [place, other], samples));
                for (most, (emitted, after)) in most
                    .iter_mut()
                    .zip(emitted(other).iter().zip(&beyond[other]))
                {
                    *most = f64::max(*most, emitted * factor + after);
                }
            }
            let light = lights.map_or([0.0; C], |l| l.light_bound(place, samples));
            let reflected = scatter.light_weight_bound(surface);
            std::array::from_fn(|c| light[c] * reflected[c] + weight[c] * most[c])
        };
        beyond = (0..places.len()).map(at).collect();
    }
    let mut bound = sky;
    if sees_sun {
        bound = std::array::from_fn(|c| sky[c] + sun[c]);
    }
    for place in places.first() {
        for ((bound, beyond), emitted) in bound.iter_mut().zip(beyond[place]).zip(emitted(place)) {
            let emitted = if direct { *emitted } else { 0.0 };
            *bound = f64::max(*bound, beyond + emitted);
        }
    }
    bound.map(|bound| bound * refraction.map_or(1.0, Refraction::most))
}
