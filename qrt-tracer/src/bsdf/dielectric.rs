//! Smooth glass: two delta lobes.
//!
//! If `u` is below the Fresnel reflectance, the ray is reflected with weight 1. Otherwise it is
//! refracted and its radiance is scaled by the squared ratio of the indices and by the transmittance.

use super::vertex::Scattered;
use super::{Sample, by_surface};
use crate::{Arith, vector};
use qrt_scene::valid::{Scatter, Surface};

/// True if `scatter` is glass that keeps a part of the light which goes through it.
pub(super) fn is_coloured(scatter: &Scatter) -> bool {
    matches!(scatter, Scatter::Dielectric(glass) if glass.transmittance != [1.0; 3])
}

/// All dielectric surfaces.
#[derive(Clone, Debug)]
pub(super) struct DielectricLobe {
    /// For each surface `1 / ior` and `ior`, the index on the side opposite to the normal.
    refraction: Vec<[f64; 2]>,
    /// True if any of these surfaces has a transmittance below 1. The tint of each is then its transmittance.
    coloured: bool,
}

impl DielectricLobe {
    pub(super) fn new(surfaces: &[&Surface], coloured: bool) -> Self {
        let refraction = by_surface(surfaces, [1.0, 1.0], |scatter| match scatter {
            Scatter::Dielectric(glass) => Some([1.0 / glass.ior, glass.ior]),
            _ => None,
        });
        Self {
            refraction,
            coloured,
        }
    }

    #[inline(always)]
    pub(super) fn scatter<A: Arith, const C: usize>(
        &self,
        cx: &mut A,
        sample: &Sample<'_, A, C>,
    ) -> Scattered<A, C> {
        let at = sample.at;
        let [entering, leaving] = cx.rows(&self.refraction, at.surface);
        // n_o / n_t, from the viewer's side to the other.
        let eta = cx.select(at.front, entering, leaving);
        let cos_o = cx.abs(at.cos_theta);
        let sin_squared_o = math!(cx, 1.0 - cos_o * cos_o);
        let eta_squared = math!(cx, eta * eta);
        let cos_squared_t = math!(cx, 1.0 - eta_squared * sin_squared_o);
        let total = math!(cx, cos_squared_t <= 0.0);
        let cos_t = math!(cx, sqrt(max(cos_squared_t, 0.0)));
        let reflectance = fresnel(cx, eta, cos_o, cos_t);
        let u = sample.square.u(cx);
        let reflects = math!(cx, total || u < reflectance);
        // Mirrored: d - 2 (d.n) n. Refracted: eta d + (eta cos_o - cos_t) n on the viewer's side.
        let mirrored = math!(cx, -(at.cos_theta + at.cos_theta));
        let refracted = math!(cx, eta * cos_o - cos_t);
        let refracted = math!(cx, select(at.front, refracted, -refracted));
        let along = math!(cx, select(reflects, 1.0, eta));
        let across = math!(cx, select(reflects, mirrored, refracted));
        let direction = vector!(cx, at.arriving * along + at.normal * across);
        let direction = vector::unit(cx, &direction);
        let weight = if self.coloured {
            sample.tint.map(|tint| {
                let through = cx.mul(eta_squared, tint);
                math!(cx, select(reflects, 1.0, through))
            })
        } else {
            [math!(cx, select(reflects, 1.0, eta_squared)); C]
        };
        Scattered {
            crosses: at.smooth.is_some().then(|| cx.not(reflects)),
            direction,
            weight,
            density: cx.real(0.0),
        }
    }

    /// The greatest weight of `surface`: that of the refraction that makes radiance denser, in clear glass. A
    /// transmittance is at most 1.
    pub(super) fn weight_bound(&self, surface: u32) -> f64 {
        let [_, ior] = self.refraction[surface as usize];
        (ior * ior).max(1.0 / (ior * ior))
    }
}

/// Unpolarised Fresnel reflectance from the indices' ratio and both cosines.
#[inline(always)]
fn fresnel<A: Arith>(cx: &mut A, eta: A::Real, cos_o: A::Real, cos_t: A::Real) -> A::Real {
    let (near, far) = (math!(cx, eta * cos_o), math!(cx, eta * cos_t));
    let perpendicular = math!(cx, div(near - cos_t, near + cos_t, 1.0));
    let parallel = math!(cx, div(far - cos_o, far + cos_o, 1.0));
    math!(
        cx,
        scale(perpendicular * perpendicular + parallel * parallel, 0.5)
    )
}
