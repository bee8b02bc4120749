//! GGX with separable Smith masking, and Fresnel 1 or, for metal, Schlick's approximation.
//!
//! ```text
//! f = reflectance D(h) G1(i) G1(o) / (4 cos_i cos_o)
//! D(h) = a^2 / (pi (cos_h^2 (a^2 - 1) + 1)^2)
//! G1(w) = 2 cos / (cos + sqrt(cos^2 + a^2 sin^2))
//! ```
//!
//! (Walter et al. 2007.) Its own map samples the distribution of visible normals by spherical caps
//! (Dupuy & Benyoub 2023), with the density `D(h) G1(o) / (4 cos_o)` of directions. So the map's
//! Jacobian cancels all but the masking of the sampled direction: `W = reflectance G1(i)`. The
//! reflectance of metal depends on the angle between `o` and `h`.

use super::map::DepthMap;
use super::mirror::schlick;
use super::vertex::{Scattered, to_scene};
use super::{Mapped, Sample, Square, Way, by_surface};
use crate::Arith;
use crate::vector::{self, Vector};
use qrt_scene::valid::{Scatter, Surface};
use std::f64::consts::{FRAC_1_PI, PI};

/// All GGX surfaces: they differ in their tint, the reflectance, and in roughness.
#[derive(Clone, Debug)]
pub(super) struct GgxLobe {
    /// The roughness alpha of each surface, above 0 and at most 1.
    roughness: Vec<[f64; 1]>,
    /// The least roughness of these surfaces.
    least_alpha: f64,
    /// True if these surfaces are metal, whose reflectance grows with the angle.
    is_metal: bool,
    /// True if the lobe samples by its own map.
    pub(super) has_map: bool,
}

impl GgxLobe {
    pub(super) fn new(surfaces: &[&Surface], square: &Square, is_metal: bool) -> Self {
        let roughness = by_surface(surfaces, [1.0], |scatter| match scatter {
            Scatter::Ggx(ggx) if !is_metal => Some([ggx.alpha]),
            Scatter::Metal(metal) if is_metal && metal.alpha > 0.0 => Some([metal.alpha]),
            _ => None,
        });
        Self {
            least_alpha: roughness
                .iter()
                .fold(1.0, |least, [alpha]| least.min(*alpha)),
            roughness,
            is_metal,
            has_map: !square.map.replaces(),
        }
    }

    #[inline(always)]
    pub(super) fn scatter<A: Arith, const C: usize>(
        &self,
        cx: &mut A,
        sample: &Sample<'_, A, C>,
    ) -> Scattered<A, C> {
        let outgoing = &sample.outgoing;
        let [alpha] = cx.rows(&self.roughness, sample.at.surface);
        let (incoming, factor) = if self.has_map {
            self.visible_normal(cx, alpha, outgoing, sample.square)
        } else {
            let Mapped { direction, factor } = sample.mapped;
            let value = value(cx, alpha, outgoing, &direction, self.least_alpha);
            (direction, math!(cx, scale(value, PI) * factor))
        };
        let tint = self.reflectance(cx, sample.tint, outgoing, &incoming);
        let weight = vector::scale(cx, &tint, factor);
        let direction = to_scene(cx, sample.at, &incoming);
        let density = if !sample.asks_for_density {
            cx.real(0.0)
        } else if self.has_map {
            let density = self.density(cx, sample.at.surface, outgoing, &incoming);
            cx.scale(density, PI)
        } else {
            sample.square.map.own_density(cx, &incoming)
        };
        Scattered {
            crosses: None,
            direction,
            weight,
            density,
        }
    }

    /// The density of directions by the lobe's own map: `D(h) G1(o) / (4 cos_o)`, per steradian.
    pub(super) fn density<A: Arith>(
        &self,
        cx: &mut A,
        surface: A::Index,
        outgoing: &Vector<A>,
        incoming: &Vector<A>,
    ) -> A::Real {
        let [alpha] = cx.rows(&self.roughness, surface);
        let half = vector!(cx, *outgoing + *incoming);
        let [d, alpha_squared] = distribution(cx, alpha, &half, self.least_alpha);
        let root = smith_root(cx, outgoing[2], alpha_squared);
        let most = self.least_alpha.powi(-3);
        // No visible normal points below the surface; directions may.
        let density = math!(cx, scale(div(d, outgoing[2] + root, most), 0.5));
        math!(cx, select(0.0 < half[2], density, 0.0))
    }

    /// The part of a lamp's light that goes to the viewer, for a white surface.
    #[inline(always)]
    pub(super) fn light<A: Arith>(&self, cx: &mut A, surface: A::Index, way: &Way<A>) -> A::Real {
        let [alpha] = cx.rows(&self.roughness, surface);
        if self.has_map {
            let density = self.density(cx, surface, &way.outgoing, &way.incoming);
            let balance = way.balance(cx, density);
            let alpha_squared = math!(cx, alpha * alpha);
            let masking = masking(cx, way.incoming[2], alpha_squared);
            math!(cx, masking * balance)
        } else {
            let value = value(cx, alpha, &way.outgoing, &way.incoming, self.least_alpha);
            math!(cx, scale(value, PI) * way.mapped * way.balance)
        }
    }

    /// The reflectance from `incoming` to `outgoing`, of surfaces with this `tint`. The cosine between a direction
    /// and the half vector is `sqrt((1 + i.o) / 2)`.
    #[inline(always)]
    pub(super) fn reflectance<A: Arith, const C: usize>(
        &self,
        cx: &mut A,
        tint: [A::Real; C],
        outgoing: &Vector<A>,
        incoming: &Vector<A>,
    ) -> [A::Real; C] {
        if !self.is_metal {
            return tint;
        }
        let [x, y, z] = vector::mul(cx, outgoing, incoming);
        let squared = math!(cx, scale(1.0 + (x + y + z), 0.5));
        let cos = math!(cx, sqrt(known(max(squared, 0.0), 0.0, 1.0)));
        schlick(cx, tint, cos)
    }

    /// The greatest weight of `surface`. Under a depth's map it is
    ///
    /// ```text
    /// pi f F = pi reflectance D F / ((cos_i + r_i) (cos_o + r_o)),   r = sqrt(cos^2 + a^2 sin^2) >= a
    /// ```
    ///
    /// with the map's factor F, and D is at most `1 / (pi a^2)`. Under the cosine map F is 1. Under the
    /// uniform map F is `2 cos_i`, and `cos_i / (cos_i + r_i)` is at most 1/2.
    pub(super) fn weight_bound(&self, surface: u32, reflectance: f64, map: &DepthMap) -> f64 {
        let reflectance = if self.is_metal { 1.0 } else { reflectance };
        let [alpha] = self.roughness[surface as usize];
        if self.has_map {
            reflectance
        } else if map.is_projected() {
            reflectance / alpha.powi(4)
        } else {
            reflectance / alpha.powi(3)
        }
    }

    /// The direction sampled by visible normals, and its `G1`, which is 0 below the surface.
    #[inline(always)]
    fn visible_normal<A: Arith>(
        &self,
        cx: &mut A,
        alpha: A::Real,
        outgoing: &Vector<A>,
        square: &Square,
    ) -> (Vector<A>, A::Real) {
        let u = square.u(cx);
        let [cos, sin] = square.azimuth(cx);
        let longest = self.least_alpha.recip();
        let (x, y) = (
            math!(cx, alpha * outgoing[0]),
            math!(cx, alpha * outgoing[1]),
        );
        let warped = vector::normalize(cx, &[x, y, outgoing[2]], longest);
        // A point of the cap: u chooses its height.
        let z = math!(cx, (1.0 - u) * (1.0 + warped[2]) - warped[2]);
        let radius = math!(cx, sqrt(max(1.0 - z * z, 0.0)));
        let (x, y) = (math!(cx, radius * cos), math!(cx, radius * sin));
        let half = vector!(cx, [x, y, z] + warped);
        let (x, y) = (math!(cx, alpha * half[0]), math!(cx, alpha * half[1]));
        // If the cap's point is opposite to the viewer, the half vector vanishes. Near that point, a
        // coarse machine may leave the normal shorter than 1.
        let normal = vector::normalize(cx, &[x, y, half[2]], 16.0 * longest);
        let incoming = vector!(cx, mirror(*outgoing, normal));
        let alpha_squared = math!(cx, alpha * alpha);
        let masking = masking(cx, incoming[2], alpha_squared);
        (incoming, masking)
    }
}

/// Smith's `G1` of a direction of this cosine: 0 below the surface.
#[inline(always)]
fn masking<A: Arith>(cx: &mut A, cos: A::Real, alpha_squared: A::Real) -> A::Real {
    let root = smith_root(cx, cos, alpha_squared);
    let sum = math!(cx, cos + root);
    let masking = math!(cx, div(cos + cos, sum, 2.0));
    math!(cx, select(0.0 < cos, masking, 0.0))
}

/// `sqrt(cos^2 + alpha^2 sin^2)`, the root in Smith's `G1`.
#[inline(always)]
fn smith_root<A: Arith>(cx: &mut A, cos: A::Real, alpha_squared: A::Real) -> A::Real {
    let cos_squared = math!(cx, cos * cos);
    math!(
        cx,
        sqrt(cos_squared + alpha_squared * max(1.0 - cos_squared, 0.0))
    )
}

/// `D` of the half vector, by its sine: at most `1 / (pi alpha^2)`; and `alpha^2`.
#[inline(always)]
fn distribution<A: Arith>(
    cx: &mut A,
    alpha: A::Real,
    half: &Vector<A>,
    least_alpha: f64,
) -> [A::Real; 2] {
    let [xx, yy, zz] = vector::mul(cx, half, half);
    let across = math!(cx, xx + yy);
    let sin_squared = math!(cx, div(across, across + zz, 1.0));
    let alpha_squared = math!(cx, alpha * alpha);
    // cos^2 (a^2 - 1) + 1, without the cancellation that small alphas would suffer.
    let shape = math!(cx, alpha_squared + sin_squared * (1.0 - alpha_squared));
    let most = least_alpha.powi(-2);
    let d = math!(cx, div(alpha_squared, shape * shape, most));
    [cx.scale(d, FRAC_1_PI), alpha_squared]
}

/// `f` without its reflectance, for directions above the surface. No `alpha` is below
/// `least_alpha`.
#[inline(always)]
pub(super) fn value<A: Arith>(
    cx: &mut A,
    alpha: A::Real,
    outgoing: &Vector<A>,
    incoming: &Vector<A>,
    least_alpha: f64,
) -> A::Real {
    let half = vector!(cx, *outgoing + *incoming);
    let [d, alpha_squared] = distribution(cx, alpha, &half, least_alpha);
    let root_i = smith_root(cx, incoming[2], alpha_squared);
    let root_o = smith_root(cx, outgoing[2], alpha_squared);
    let most = least_alpha.powi(-4);
    math!(
        cx,
        div(d, (incoming[2] + root_i) * (outgoing[2] + root_o), most)
    )
}
