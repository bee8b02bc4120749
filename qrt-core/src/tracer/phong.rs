//! The modified Phong lobe beside a Lambertian base.
//!
//! ```text
//! f = diffuse / pi + specular (n + 2) / (2 pi) max(0, cos_a)^n
//! ```
//!
//! Its own map divides the unit square along `u`: `m` of the `2^bits` columns sample the base by
//! the cosine map, the rest sample the lobe about the mirrored viewer by a power map. Each part's
//! Jacobian cancels the factor that shaped it: `W = diffuse / p` on the base, and
//! `W = specular (n + 2) / (n + 1) cos_i / (1 - p)` on the lobe, with `p = m / 2^bits` exactly.

use super::sampled::integer_power;
use super::vector::{self, Vector};
use super::{Arith, Sampled};
use crate::scene::Rgb;

/// A Phong surface, made ready for one depth.
#[derive(Clone, Debug)]
pub(crate) struct PhongStage<const C: usize> {
    diffuse: [f64; C],
    specular: [f64; C],
    exponent: f64,
    lobes: Lobes<C>,
    /// One column cannot hold two lobes: then there is no own map.
    one_column: bool,
}

#[derive(Clone, Debug)]
struct Lobes<const C: usize> {
    /// 1 on the lobe's columns, 0 on the base's.
    on_lobe: Sampled,
    /// Sine and cosine of the angle to the lobe's (or the base's) axis.
    sin: Sampled,
    cos: Sampled,
    /// Weights: of the base, and of the lobe before its `cos_i`.
    base: [f64; C],
    lobe: [f64; C],
}

impl<const C: usize> PhongStage<C> {
    pub(crate) fn new(
        diffuse: Rgb,
        specular: Rgb,
        exponent: f64,
        channels: [usize; C],
        bits: u32,
    ) -> Self {
        let pick = |rgb: Rgb| channels.map(|channel| rgb[channel]);
        let (base, lobe) = (diffuse.iter().sum::<f64>(), specular.iter().sum::<f64>());
        let columns = 1_u64 << bits;
        let share = base / (base + lobe);
        let one_column = bits == 0 && base > 0.0 && lobe > 0.0;
        let split = if lobe == 0.0 || one_column {
            columns
        } else if base == 0.0 {
            0
        } else {
            // A share near 0 or 1 still leaves each lobe a column: without one it would vanish.
            ((share * columns as f64).round() as u64).clamp(1, columns - 1)
        };
        let lobes = {
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
            Lobes {
                on_lobe: Sampled::of_index(bits, move |c| f64::from(u64::from(c) >= split)),
                sin: Sampled::of_index(bits, radius),
                cos: Sampled::of_index(bits, height),
                base: pick(diffuse).map(|kd| if p > 0.0 { kd / p } else { 0.0 }),
                lobe: pick(specular).map(|ks| if p < 1.0 { ks * gain / (1.0 - p) } else { 0.0 }),
            }
        };
        Self {
            diffuse: pick(diffuse),
            specular: pick(specular),
            exponent,
            lobes,
            one_column,
        }
    }

    /// Does the surface bring a map of its own at this depth?
    pub(crate) fn has_map(&self) -> bool {
        !self.one_column
    }

    /// The greatest weight, per channel, under the own map.
    pub(crate) fn bound(&self) -> [f64; C] {
        std::array::from_fn(|c| self.lobes.base[c].max(self.lobes.lobe[c]))
    }

    /// The greatest value of `f`, per channel.
    pub(crate) fn value_bound(&self) -> [f64; C] {
        std::array::from_fn(|c| {
            (self.diffuse[c] + self.specular[c] * 0.5 * (self.exponent + 2.0))
                * std::f64::consts::FRAC_1_PI
        })
    }

    /// `f`, per channel.
    #[inline(always)]
    pub(crate) fn value<A: Arith>(&self, cx: &mut A, cos_a: A::Real) -> [A::Real; C] {
        let zero = cx.real(0.0);
        let cos = cx.max(cos_a, zero);
        let power = if self.exponent.fract() == 0.0 && self.exponent <= 4096.0 {
            integer_power(cx, cos, self.exponent as u32)
        } else {
            let exponent = cx.real(self.exponent);
            cx.pow(cos, exponent)
        };
        let norm = 0.5 * (self.exponent + 2.0);
        let mut value = [zero; C];
        for ((value, &kd), &ks) in value.iter_mut().zip(&self.diffuse).zip(&self.specular) {
            let lobe = cx.scale(power, ks * norm);
            let base = cx.real(kd);
            let sum = cx.add(base, lobe);
            *value = cx.scale(sum, std::f64::consts::FRAC_1_PI);
        }
        value
    }

    /// The sampled direction in the local frame, and its weight, by the own map.
    #[inline(always)]
    pub(crate) fn sample<A: Arith>(
        &self,
        cx: &mut A,
        outgoing: &Vector<A>,
        u: A::Index,
        [cos, sin]: [A::Real; 2],
    ) -> (Vector<A>, [A::Real; C]) {
        let lobes = &self.lobes;
        let (zero, one) = (cx.real(0.0), cx.real(1.0));
        let radius = cx.sampled(&lobes.sin, u);
        let height = cx.sampled(&lobes.cos, u);
        let flag = cx.sampled(&lobes.on_lobe, u);
        let on_lobe = cx.less(zero, flag);
        let x = cx.mul(radius, cos);
        let y = cx.mul(radius, sin);
        let about_axis = [x, y, height];
        // The half-turn about the bisector of the normal and the mirrored viewer r takes one to
        // the other: w -> w.(r + z) / (1 + r_z) (r + z) - w. r_z > 0, so nothing is singular.
        let x = cx.neg(outgoing[0]);
        let y = cx.neg(outgoing[1]);
        let z = cx.add(one, outgoing[2]);
        let bisector = [x, y, z];
        let along = vector::dot(cx, &about_axis, &bisector);
        let factor = cx.div(along, z, 2.0);
        let scaled = vector::scale(cx, &bisector, factor);
        let turned = vector::sub(cx, &scaled, &about_axis);
        let direction = vector::select(cx, on_lobe, &turned, &about_axis);
        let cos_i = cx.max(turned[2], zero);
        let mut weight = [zero; C];
        for ((weight, &base), &lobe) in weight.iter_mut().zip(&lobes.base).zip(&lobes.lobe) {
            let lobe = cx.scale(cos_i, lobe);
            let base = cx.real(base);
            *weight = cx.select(on_lobe, lobe, base);
        }
        (direction, weight)
    }
}
