//! The bound on a path's colour: the colour scale of the comparator, in the paper `2^b`.
//!
//! The tighter it is, the larger the fraction of good basis states that a pixel has, and the fewer
//! queries an estimate needs. Let `B_k(s)` bound what a path carries from its vertex `k`, at the place
//! `s`, without what is emitted there, `W` the weight, `F(s, t)` the factor by which the emission of
//! `t` counts of a ray from `s`, and `N(s)` what a lamp adds that is sampled there:
//!
//! ```text
//! B_k(s) = N(s) + W(s) max over t that s sees of (F(s, t) Le(t) + B_{k+1}(t))
//! ```
//!
//! Where no lamp is sampled `N` is 0 and `F` is 1. A path from the camera carries at most the
//! greatest `B_0` of what the camera sees, and with `Le` where it may meet a lamp at once. Places are
//! those of [`Places`]: sides of faces, or surfaces.

use super::bsdf::ScatterStage;
use super::geometry::Geometry;
use super::places::Places;
use crate::valid::{Scatter, Surface};
use glam::DVec3;
use std::collections::HashMap;

/// An upper bound of the colour of every path, per channel; without what the primary ray meets
/// emit, unless `direct`. `refraction` replaces the weights of glass by 1, if it is known: see
/// [`refraction`].
pub(crate) fn colour<const C: usize>(
    places: &Places,
    radiance: &[[f64; C]],
    scatters: &[ScatterStage<C>],
    direct: bool,
    refraction: Option<f64>,
) -> [f64; C] {
    let emitted = |place: usize| &radiance[places.surface(place) as usize];
    let mut beyond = vec![[0.0; C]; places.len()];
    // From the last vertex back to the first.
    for scatter in scatters.iter().rev() {
        let at = |place: usize| {
            let surface = places.surface(place);
            let mut weight = scatter.weight_bound(surface);
            if refraction.is_some() && scatter.is_glass(surface) {
                weight = [1.0; C];
            }
            let samples = scatter.samples_lights(surface);
            let lights = scatter.lights.as_ref();
            let mut most = [0.0; C];
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
    let mut bound = [0.0; C];
    for place in places.first() {
        for ((bound, beyond), emitted) in bound.iter_mut().zip(beyond[place]).zip(emitted(place)) {
            let emitted = if direct { *emitted } else { 0.0 };
            *bound = f64::max(*bound, beyond + emitted);
        }
    }
    bound.map(|bound| bound * refraction.unwrap_or(1.0))
}

/// The greatest product of the weights of all refractions of a path that does not start within
/// glass; none unless every piece of glass is closed and its normals all point out of it, or all
/// into it.
///
/// Radiance is scaled by the squared ratio of the indices. A path that enters a closed piece must
/// leave it before it enters again: the factors of its surface alternate, each the inverse of the
/// next. What is left over is that of the piece in which the path ends.
pub(crate) fn refraction(
    geometry: &Geometry,
    surfaces: &[&Surface],
    surface_of: &[u32],
    starts: &[DVec3],
) -> Option<f64> {
    let mut product = 1.0;
    for (number, surface) in (0..).zip(surfaces) {
        let Scatter::Dielectric(glass) = &surface.scatter else {
            continue;
        };
        let mine = || {
            let labels = geometry.faces.iter().map(|face| face.label as usize);
            let mine = labels.filter(|&label| surface_of[label] == number);
            mine.map(|label| &*geometry.corners[label])
        };
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in mine().flatten() {
            (low, high) = (low.min(*corner), high.max(*corner));
        }
        let within = |start: &DVec3| start.cmpge(low).all() && start.cmple(high).all();
        if !is_closed(mine()) || starts.iter().any(within) {
            return None;
        }
        // Within, the factor is 1 / ior^2.
        product *= (1.0 / (glass.ior * glass.ior)).max(1.0);
    }
    Some(product)
}

/// Whether each edge of the polygons is one of exactly two of them, which go along it in opposite
/// directions.
fn is_closed<'a>(polygons: impl Iterator<Item = &'a [DVec3]>) -> bool {
    let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
    let key = |corner: DVec3| (corner + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut ways = HashMap::new();
    for polygon in polygons {
        for (k, &start) in polygon.iter().enumerate() {
            let (start, end) = (key(start), key(polygon[(k + 1) % polygon.len()]));
            *ways.entry([start, end]).or_insert(0) += 1;
            *edges.entry([start.min(end), start.max(end)]).or_insert(0) += 1;
        }
    }
    edges.values().all(|&count| count == 2) && ways.values().all(|&count| count == 1)
}
