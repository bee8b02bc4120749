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
    let lamps = 0..places.len() as u32;
    let lamps: Vec<u32> = lamps
        .filter(|&place| *emitted(place as usize) != [0.0; C])
        .collect();
    let mut beyond = vec![[0.0; C]; places.len()];
    // From the last vertex back to the first.
    for scatter in scatters.iter().rev() {
        let greatest = |after: &mut dyn Iterator<Item = usize>| {
            let most = |most: [f64; C], place: usize| {
                std::array::from_fn(|c| f64::max(most[c], beyond[place][c]))
            };
            after.fold([0.0; C], most)
        };
        let greatest_of_all = greatest(&mut (0..places.len()));
        let at = |place: usize| {
            let surface = places.surface(place);
            let mut weight = scatter.weight_bound(surface);
            if refraction.is_some_and(|refraction| refraction.is_of(surface)) {
                weight = [1.0; C];
            }
            let samples = scatter.samples_lights(surface);
            let lights = scatter.lights.as_ref();
            let counts = lights.map_or(1.0, |l| l.sun_bound(places, place, samples));
            let next = places.next(place);
            let after = if next.len() == places.len() || greatest_of_all == [0.0; C] {
                greatest_of_all
            } else {
                greatest(&mut next.iter().map(|&other| other as usize))
            };
            let mut most: [f64; C] =
                std::array::from_fn(|c| f64::max(sky[c] + counts * sun[c], after[c]));
            for &lamp in lamps.iter().filter(|lamp| next.binary_search(lamp).is_ok()) {
                let lamp = lamp as usize;
                let factor = lights.map_or(1.0, |lights| {
                    lights.emission_bound(places, [place, lamp], samples)
                });
                let (emitted, after) = (emitted(lamp), &beyond[lamp]);
                most = std::array::from_fn(|c| f64::max(most[c], emitted[c] * factor + after[c]));
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

#[cfg(test)]
mod tests {
    use crate::{PixelClass, Stage};

    /// A floor, half of it matte, below a lamp whose front looks up.
    fn floor_behind_a_lamp(material: &str, map: &str, lights: &str) -> [f64; 3] {
        let text = format!(
            "name: behind
camera: {{ perspective: {{ eye: [0, 1, -3], target: [0, 0, 0], vfov: 30 }} }}
film: {{ width: 2, height: 2 }}
materials:
  floor: {material}
  matte: {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }}
  lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}
geometry:
  - quad: {{ vertices: [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], material: floor }}
  - quad: {{ vertices: [[1, 0, -1], [1, 0, 1], [3, 0, 1], [3, 0, -1]], material: matte }}
  - quad: {{ vertices: [[-1, 3, -1], [-1, 3, 1], [1, 3, 1], [1, 3, -1]], material: lamp }}
sampling:
  path_bits: 10
  depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4], map: {map}, light: [4, 4] }}]
  lights: {lights}
"
        );
        let read = qrt_scene::front::parse(&text, "behind.yaml", &[], "".as_ref());
        let scene = read.unwrap_or_else(|report| panic!("{report}")).valid;
        Stage::rgb(&scene, PixelClass::MeetsNoLamp).bound()
    }

    #[test]
    fn surfaces_behind_a_lamp_gain_nothing_where_lamps_are_sampled() {
        let map =
            r#"map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"], value: 0.15"#;
        let with_density = format!("{{ bsdf: {{ {map}, pdf: \"cos_i/pi\" }} }}");
        let without_density = format!("{{ bsdf: {{ {map} }} }}");
        let matte = "{ lambertian: { albedo: [0.5, 0.5, 0.5] } }";
        let rough = "{ ggx: { alpha: 0.5, reflectance: [0.5, 0.5, 0.5] } }";
        for (material, map) in [
            (matte, "auto"),
            (matte, "uniform-hemisphere"),
            (rough, "auto"),
            (&with_density, "auto"),
            (&without_density, "cosine-hemisphere"),
            (&without_density, "uniform-hemisphere"),
        ] {
            let bound = floor_behind_a_lamp(material, map, "mis");
            assert_eq!(bound, [0.0; 3], "{material} {map}");
        }
        // Rays of the surface's own map count the lamp, whose sides are not told apart.
        let bound = floor_behind_a_lamp(&without_density, "auto", "auto");
        assert!(bound[0] > 0.0, "{bound:?}");
    }
}
