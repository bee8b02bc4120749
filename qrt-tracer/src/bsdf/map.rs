//! The map of a depth, from its sample square to directions. Surfaces use it if they have no map of
//! their own, or if it replaces theirs.

use crate::Arith;
use crate::compiled::Compiled;
use crate::sampled::KEPT_BITS;
use crate::vector::Vector;
use qrt_scene::Map;
use qrt_scene::sampling::maps;
use qrt_syntax::expr::{Domain, Expr};
use std::f64::consts::{FRAC_1_PI, PI};

/// A depth's map, the cosine map under `auto`.
#[derive(Clone, Debug)]
pub(super) struct DepthMap {
    map: Map,
    /// `phi` and `J |phi_z| / pi`.
    compiled: Compiled,
    /// `phi`.
    pub(super) directions: [Expr; 3],
    /// `J |phi_z|`.
    pub(super) projected_jacobian: Expr,
}

/// A sample of the map.
#[derive(Clone, Copy)]
pub(super) struct Mapped<R> {
    /// The sampled direction in the local frame.
    pub(super) direction: [R; 3],
    /// `J |phi_z| / pi`: the weight of a white Lambertian.
    pub(super) factor: R,
}

impl DepthMap {
    pub(super) fn new(map: Map, bits: [u32; 2]) -> Self {
        let directions = maps::builtin(map);
        let projected_jacobian = maps::projected_jacobian(&directions);
        let factor = match Expr::number(PI) {
            Some(pi) => (&projected_jacobian / &pi).simplify(),
            None => projected_jacobian.clone(),
        };
        let [x, y, z] = &directions;
        Self {
            map,
            compiled: Compiled::new(
                &[x, y, z, &factor],
                (bits, KEPT_BITS),
                None,
                Domain::default(),
            ),
            directions,
            projected_jacobian,
        }
    }

    /// True if it replaces the maps that materials have of their own.
    pub(super) fn replaces(&self) -> bool {
        match self.map {
            Map::Auto => false,
            Map::CosineHemisphere | Map::UniformHemisphere => true,
        }
    }

    /// The greatest [`Mapped::factor`].
    pub(super) fn factor_bound(&self) -> f64 {
        match self.map {
            Map::Auto | Map::CosineHemisphere => 1.0,
            Map::UniformHemisphere => 2.0,
        }
    }

    /// True if [`Mapped::factor`] is always 1.
    pub(super) fn is_projected(&self) -> bool {
        self.compiled.constant(3) == Some(1.0)
    }

    #[inline(always)]
    pub(super) fn sample<A: Arith>(&self, cx: &mut A, depth: usize) -> Mapped<A::Real> {
        let [x, y, z, factor] = self.compiled.evaluate(cx, depth, None);
        let direction = [x, y, z];
        Mapped { direction, factor }
    }

    /// [`Mapped::factor`] at `incoming`.
    #[inline(always)]
    pub(super) fn factor<A: Arith>(&self, cx: &mut A, incoming: &Vector<A>) -> A::Real {
        match self.map {
            Map::Auto | Map::CosineHemisphere => cx.real(1.0),
            Map::UniformHemisphere => cx.scale(incoming[2], 2.0),
        }
    }

    /// `pi / J` at `incoming`, a direction that the map sampled.
    #[inline(always)]
    pub(super) fn own_density<A: Arith>(&self, cx: &mut A, incoming: &Vector<A>) -> A::Real {
        match self.map {
            Map::Auto | Map::CosineHemisphere => incoming[2],
            Map::UniformHemisphere => cx.real(0.5),
        }
    }

    /// `1 / J` at `incoming`, and 0 below the surface.
    #[inline(always)]
    pub(super) fn density<A: Arith>(&self, cx: &mut A, incoming: &Vector<A>) -> A::Real {
        let cos_i = incoming[2];
        match self.map {
            Map::Auto | Map::CosineHemisphere => math!(cx, scale(max(cos_i, 0.0), FRAC_1_PI)),
            Map::UniformHemisphere => {
                math!(cx, select(0.0 < cos_i, real(0.5 * FRAC_1_PI), 0.0))
            }
        }
    }
}
