//! The modified Phong lobe beside a Lambertian base.
//!
//! ```text
//! f = diffuse / pi + specular (n + 2) / (2 pi) max(0, cos_a)^n
//! ```
//!
//! Its own map divides the unit square along `u`: `m` of the `2^bits` columns sample the base by
//! the cosine map, the rest sample the lobe about the mirrored viewer by a power map. Each part's
//! Jacobian cancels the factor that shaped it: `W = diffuse / p` on the base, and
//! `W = specular (n + 2) / (n + 1) cos_i / (1 - p)` on the lobe, with `p = m / 2^bits` exactly. The
//! density of directions is the parts' sum, `p cos_i / pi + (1 - p) (n + 1) / (2 pi) cos_a^n`.

use super::vertex::{Scattered, cos_to_mirror, to_scene};
use super::{Sample, Square, Way};
use crate::compiled::integer_power;
use crate::vector::{self, Vector};
use crate::{Arith, Coordinate, Sampled};
use qrt_scene::{Phong, Rgb};
use std::f64::consts::{FRAC_1_PI, PI};

/// One Phong surface, for one depth. In each channel, diffuse + specular is at most 1.
#[derive(Clone, Debug)]
pub(super) struct PhongLobe<const C: usize> {
    diffuse: [f64; C],
    specular: [f64; C],
    exponent: f64,
    /// True if the lobe samples by its own map. One column cannot hold two parts.
    pub(super) has_map: bool,
    /// p, the base's fraction of the columns.
    base_fraction: f64,
    /// 1 on the lobe's columns, 0 on the base's.
    on_lobe: Sampled,
    /// Sine and cosine of the angle to the lobe's (or the base's) axis.
    sin: Sampled,
    cos: Sampled,
    /// Weights: of the base, and of the lobe before its `cos_i`.
    base_weight: [f64; C],
    lobe_weight: [f64; C],
}

impl<const C: usize> PhongLobe<C> {
    pub(super) fn new(phong: &Phong, pick: impl Fn(Rgb) -> [f64; C], square: &Square) -> Self {
        let (base, lobe) = (
            phong.diffuse.iter().sum::<f64>(),
            phong.specular.iter().sum::<f64>(),
        );
        let (bits, exponent) = (square.bits[0], phong.exponent);
        let columns = 1_u64 << bits;
        let one_column = bits == 0 && base > 0.0 && lobe > 0.0;
        let split = if lobe == 0.0 || one_column {
            columns
        } else if base == 0.0 {
            0
        } else {
            // Each part has at least one column, even if its fraction is near 0: without one it
            // would vanish.
            let split = base / (base + lobe) * columns as f64;
            (split.round() as u64).clamp(1, columns - 1)
        };
        let p = split as f64 / columns as f64;
        let gain = (exponent + 2.0) / (exponent + 1.0);
        // Height and radius on the unit sphere about the axis, by column.
        let height = move |column: u32| {
            let column = u64::from(column);
            if column < split {
                let u = (column as f64 + 0.5) / split as f64;
                (1.0 - u).sqrt()
            } else {
                let u = ((column - split) as f64 + 0.5) / (columns - split) as f64;
                libm::pow(1.0 - u, 1.0 / (exponent + 1.0))
            }
        };
        let radius = move |column: u32| {
            let cos = height(column);
            ((1.0 - cos) * (1.0 + cos)).sqrt()
        };
        let (diffuse, specular) = (pick(phong.diffuse), pick(phong.specular));
        let most = square.most_stored;
        Self {
            diffuse,
            specular,
            exponent,
            has_map: !square.map.replaces() && !one_column,
            base_fraction: p,
            on_lobe: Sampled::stored(bits, most, move |c| f64::from(u64::from(c) >= split)),
            sin: Sampled::stored(bits, most, radius),
            cos: Sampled::stored(bits, most, height),
            base_weight: diffuse.map(|kd| if p > 0.0 { kd / p } else { 0.0 }),
            lobe_weight: specular.map(|ks| if p < 1.0 { ks * gain / (1.0 - p) } else { 0.0 }),
        }
    }

    /// `max(0, cos_a)^n`, with the cosine clamped to 1: a power of a cosine above 1 would grow.
    #[inline(always)]
    fn power<A: Arith>(&self, cx: &mut A, cos_a: A::Real) -> A::Real {
        let cos = math!(cx, min(max(cos_a, 0.0), 1.0));
        if self.exponent.fract() == 0.0 && self.exponent <= 4096.0 {
            integer_power(cx, cos, self.exponent as u32)
        } else {
            math!(cx, pow(cos, real(self.exponent)))
        }
    }

    /// `f`, per channel.
    #[inline(always)]
    pub(super) fn value<A: Arith>(&self, cx: &mut A, cos_a: A::Real) -> [A::Real; C] {
        let power = self.power(cx, cos_a);
        let norm = 0.5 * (self.exponent + 2.0);
        let mut value = [power; C];
        for ((value, &kd), &ks) in value.iter_mut().zip(&self.diffuse).zip(&self.specular) {
            *value = math!(cx, scale(real(kd) + scale(power, ks * norm), FRAC_1_PI));
        }
        value
    }

    /// The direction by the lobe's own map, in the local frame, and its weight.
    #[inline(always)]
    fn divided<A: Arith>(
        &self,
        cx: &mut A,
        outgoing: &Vector<A>,
        square: &Square,
    ) -> (Vector<A>, [A::Real; C]) {
        let u = cx.coordinate(Coordinate::u(square.depth));
        let [cos, sin] = square.azimuth(cx);
        let radius = cx.sampled(&self.sin, u);
        let height = cx.sampled(&self.cos, u);
        let flag = cx.sampled(&self.on_lobe, u);
        let on_lobe = math!(cx, 0.0 < flag);
        let about_axis = [math!(cx, radius * cos), math!(cx, radius * sin), height];
        // The half-turn about the bisector of the normal and the mirrored viewer r takes one to
        // the other: w -> w.(r + z) / (1 + r_z) (r + z) - w. r_z > 0, so nothing is singular.
        let [x, y, z] = *outgoing;
        let bisector = [cx.neg(x), cx.neg(y), math!(cx, 1.0 + z)];
        let about_mirror = vector!(
            cx,
            bisector * div(dot(about_axis, bisector), bisector[2], 2.0) - about_axis
        );
        let direction = vector::select(cx, on_lobe, &about_mirror, &about_axis);
        let cos_i = math!(cx, max(about_mirror[2], 0.0));
        let mut weight = [cos_i; C];
        let parts = self.base_weight.iter().zip(&self.lobe_weight);
        for (weight, (&base, &lobe)) in weight.iter_mut().zip(parts) {
            *weight = math!(cx, select(on_lobe, scale(cos_i, lobe), real(base)));
        }
        (direction, weight)
    }

    /// The densities with which the own map's base and lobe sample directions.
    pub(super) fn densities<A: Arith>(
        &self,
        cx: &mut A,
        outgoing: &Vector<A>,
        incoming: &Vector<A>,
    ) -> [A::Real; 2] {
        let p = self.base_fraction;
        let cos_a = cos_to_mirror(cx, incoming, outgoing);
        let power = self.power(cx, cos_a);
        let lobe = (1.0 - p) * (self.exponent + 1.0) * 0.5 * FRAC_1_PI;
        [
            math!(cx, scale(max(incoming[2], 0.0), p * FRAC_1_PI)),
            cx.scale(power, lobe),
        ]
    }

    #[inline(always)]
    pub(super) fn scatter<A: Arith>(
        &self,
        cx: &mut A,
        sample: &Sample<'_, A, C>,
    ) -> Scattered<A, C> {
        let outgoing = &sample.outgoing;
        let mut density = cx.real(0.0);
        let (incoming, weight) = if self.has_map {
            let (incoming, weight) = self.divided(cx, outgoing, sample.square);
            if sample.asks_for_density {
                let parts = self.densities(cx, outgoing, &incoming);
                let u = cx.coordinate(Coordinate::u(sample.square.depth));
                let on_lobe = cx.sampled(&self.on_lobe, u);
                density = math!(cx, scale(select(0.0 < on_lobe, parts[1], parts[0]), PI));
            }
            (incoming, weight)
        } else {
            let incoming = sample.mapped.direction;
            let cos_a = cos_to_mirror(cx, &incoming, outgoing);
            let value = self.value(cx, cos_a);
            let factor = cx.scale(sample.mapped.factor, PI);
            if sample.asks_for_density {
                density = sample.square.map.own_density(cx, &incoming);
            }
            (incoming, vector::scale(cx, &value, factor))
        };
        let direction = to_scene(cx, sample.at, &incoming);
        Scattered {
            crosses: None,
            direction,
            weight,
            density,
        }
    }

    /// The part of a lamp's light that goes to the viewer. Each part of the own map is weighted by
    /// itself, as its rays are.
    #[inline(always)]
    pub(super) fn light<A: Arith>(&self, cx: &mut A, way: &Way<A>) -> [A::Real; C] {
        if !self.has_map {
            let cos_a = cos_to_mirror(cx, &way.incoming, &way.outgoing);
            let value = self.value(cx, cos_a);
            let factor = math!(cx, scale(way.mapped * way.balance, PI));
            return vector::scale(cx, &value, factor);
        }
        let [base, lobe] = self.densities(cx, &way.outgoing, &way.incoming);
        let base = way.balance(cx, base);
        let lobe = way.balance(cx, lobe);
        let lobe = math!(cx, lobe * way.incoming[2]);
        let mut weight = [lobe; C];
        let parts = self.base_weight.iter().zip(&self.lobe_weight);
        for (weight, (&of_base, &of_lobe)) in weight.iter_mut().zip(parts) {
            *weight = math!(cx, scale(base, of_base) + scale(lobe, of_lobe));
        }
        weight
    }

    /// As [`Self::weight_bound`], for the light of a lamp, which both parts of the own map reflect.
    pub(super) fn light_weight_bound(&self, factor: f64) -> [f64; C] {
        if !self.has_map {
            return self.weight_bound(factor);
        }
        std::array::from_fn(|c| self.base_weight[c] + self.lobe_weight[c])
    }

    /// The greatest weights. Under the own map, that of the greater part; under the depth's map,
    /// `pi f` times the map's factor.
    pub(super) fn weight_bound(&self, factor: f64) -> [f64; C] {
        std::array::from_fn(|c| {
            if self.has_map {
                self.base_weight[c].max(self.lobe_weight[c])
            } else {
                let lobe = self.specular[c] * 0.5 * (self.exponent + 2.0);
                PI * ((self.diffuse[c] + lobe) * FRAC_1_PI) * factor
            }
        })
    }
}
