//! The user's own BSDF: a value and a map, by expressions that [`crate::valid::bsdf`] has checked.

use super::vertex::{Scattered, cos_to_mirror, to_scene};
use super::{Sample, Square};
use crate::expr::{Expr, Variable};
use crate::tracer::Arith;
use crate::tracer::compiled::{Angles, Compiled};
use crate::valid::CustomBsdf;
use crate::valid::bsdf::weight_bound;

/// One surface with a BSDF of the author's own, for one depth.
#[derive(Clone, Debug)]
pub(super) struct CustomLobe<const C: usize> {
    /// `phi`, unless the depth's map replaces it. Of its density, `1 / J(u, v)`, the square tells,
    /// but no formula of the direction.
    pub(super) direction: Option<Compiled>,
    /// Weights of the channels.
    weight: Compiled,
    /// The greatest weight per channel.
    pub(super) weight_bound: [f64; C],
    pub(super) asks_for_angles: bool,
}

impl<const C: usize> CustomLobe<C> {
    pub(super) fn new(bsdf: &CustomBsdf, channels: [usize; C], square: &Square) -> Self {
        let asks = |variables: [Variable; 2]| {
            let mut sets = bsdf.value.iter().map(|value| value.variables(value.root()));
            sets.any(|set| variables.iter().any(|variable| set.contains(*variable)))
        };
        // A value written in `u` and `v` has a meaning under its own map alone.
        let replaced = square.map.replaces() && !asks(Variable::SQUARE);
        let (map, projected, bound) = if replaced {
            let (map, projected) = (&square.map.directions, &square.map.projected_jacobian);
            (map, projected, weight_bound(map, projected, &bsdf.value))
        } else {
            (&bsdf.map, &bsdf.projected_jacobian, bsdf.weight_bound)
        };
        let weights = channels.map(|channel| (&bsdf.value[channel] * projected).simplify());
        let weights: Vec<&Expr> = weights.iter().collect();
        let [x, y, z] = map;
        Self {
            direction: (!replaced).then(|| Compiled::new(&[x, y, z], square.bits, None)),
            weight: Compiled::new(&weights, square.bits, Some(z)),
            weight_bound: channels.map(|channel| bound[channel]),
            asks_for_angles: asks([Variable::CosO, Variable::CosA]),
        }
    }

    #[inline(always)]
    pub(super) fn scatter<A: Arith>(
        &self,
        cx: &mut A,
        sample: &Sample<'_, A, C>,
    ) -> Scattered<A, C> {
        let outgoing = &sample.outgoing;
        let depth = sample.square.depth;
        let incoming = match &self.direction {
            Some(own) => own.evaluate(cx, depth, None),
            None => sample.mapped.direction,
        };
        let angles = Angles {
            cos_o: outgoing[2],
            cos_a: cos_to_mirror(cx, &incoming, outgoing),
        };
        let weight = self.weight.evaluate(cx, depth, Some(angles));
        let direction = to_scene(cx, sample.at, &incoming);
        Scattered { direction, weight }
    }
}
