//! The user-defined BSDF: expressions for a value and a map, which [`qrt_scene::valid::bsdf`] has
//! checked.

use super::vertex::{Scattered, cos_to_mirror, to_scene};
use super::{Sample, Square, Way};
use crate::compiled::{Angles, Compiled};
use crate::vector::{self, Vector};
use crate::{Arith, StageGeometry};
use qrt_scene::valid::CustomBsdf;
use qrt_scene::valid::bsdf::weight_bound;
use qrt_syntax::expr::{Domain, Expr, Interval, Variable};
use std::f64::consts::PI;

/// One surface with a user-defined BSDF, for one depth.
#[derive(Clone, Debug)]
pub(super) struct CustomLobe<const C: usize> {
    /// `phi`, unless the depth's map replaces it.
    pub(super) direction: Option<Compiled>,
    /// For a sampled direction: the weights of the channels, and last the density per steradian, if
    /// the user stated it.
    weight: Compiled,
    /// For any direction: `value cos_i` by channel, and last the density; or, if the depth's map
    /// replaces the user's, `pi value`.
    towards: Compiled,
    states_density: bool,
    /// The greatest weight per channel.
    pub(super) weight_bound: [f64; C],
    pub(super) asks_for_angles: bool,
}

/// The largest number of roots: the channels and a density.
const ROOTS: usize = 4;

impl<const C: usize> CustomLobe<C> {
    pub(super) fn new(
        bsdf: &CustomBsdf,
        channels: [usize; C],
        square: &Square,
        geometry: &StageGeometry,
    ) -> Self {
        const { assert!(C < ROOTS) };
        let asks = |variables: [Variable; 2]| {
            let mut sets = bsdf.value.iter().map(|value| value.variables(value.root()));
            sets.any(|set| variables.iter().any(|variable| set.contains(*variable)))
        };
        // A value in `u` and `v` is meaningful only under its own map.
        let replaced = square.map.replaces() && !asks(Variable::SQUARE);
        let (map, projected, bound) = if replaced {
            let (map, projected) = (&square.map.directions, &square.map.projected_jacobian);
            let bound = weight_bound((map, projected), &bsdf.value, bsdf.extent);
            (map, projected, bound)
        } else {
            (&bsdf.map, &bsdf.projected_jacobian, bsdf.weight_bound)
        };
        let density = bsdf.pdf.as_ref().filter(|_| !replaced);
        let pi = Expr::number(PI).filter(|_| replaced);
        let factor = pi.unwrap_or_else(|| Expr::variable(Variable::CosI));
        let staged = channels.map(|c| staged(&bsdf.value[c], geometry));
        let of_channels = |by: &Expr| staged.each_ref().map(|value| (value * by).simplify());
        let domain = staged_domain(bsdf, geometry);
        let (weights, towards) = (of_channels(projected), of_channels(&factor));
        let with_density = |values: &'_ [Expr; C], cos_i: Option<&Expr>| {
            let roots: Vec<&Expr> = values.iter().chain(density).collect();
            Compiled::new(&roots, (square.bits, square.most_stored), cos_i, domain)
        };
        let [x, y, z] = map;
        Self {
            direction: (!replaced).then(|| {
                let bits = (square.bits, square.most_stored);
                Compiled::new(&[x, y, z], bits, None, Domain::default())
            }),
            weight: with_density(&weights, Some(z)),
            towards: with_density(&towards, None),
            states_density: density.is_some(),
            weight_bound: channels.map(|channel| bound[channel]),
            asks_for_angles: asks([Variable::CosO, Variable::CosA]) || density.is_some(),
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
        let angles = angles(cx, outgoing, &incoming, sample.at.point);
        let values: [A::Real; ROOTS] = self.weight.evaluate(cx, depth, Some(angles));
        let direction = to_scene(cx, sample.at, &incoming);
        let density = if !sample.asks_for_density {
            cx.real(0.0)
        } else if self.states_density {
            cx.scale(values[C], PI)
        } else {
            // The density of the depth's map. It is not used if the lobe samples by its own map.
            sample.square.map.own_density(cx, &incoming)
        };
        let asks = sample.at.smooth.is_some();
        Scattered {
            crosses: asks.then(|| math!(cx, incoming[2] < 0.0)),
            direction,
            weight: channels(&values),
            density,
        }
    }

    /// True if the density of the sampled directions is known.
    pub(super) fn has_density(&self) -> bool {
        self.direction.is_none() || self.states_density
    }

    /// The density of directions that the user stated, if any.
    #[inline(always)]
    pub(super) fn density<A: Arith>(
        &self,
        cx: &mut A,
        depth: usize,
        outgoing: &Vector<A>,
        incoming: &Vector<A>,
    ) -> Option<A::Real> {
        let angles = angles(cx, outgoing, incoming, None);
        let values: [A::Real; ROOTS] = self.towards.evaluate(cx, depth, Some(angles));
        self.states_density.then_some(values[C])
    }

    /// The part of a lamp's light that goes to the viewer.
    #[inline(always)]
    pub(super) fn light<A: Arith>(&self, cx: &mut A, depth: usize, way: &Way<A>) -> [A::Real; C] {
        let angles = angles(cx, &way.outgoing, &way.incoming, way.point);
        let values: [A::Real; ROOTS] = self.towards.evaluate(cx, depth, Some(angles));
        let mut towards = channels(&values);
        if !self.states_density {
            let factor = math!(cx, way.mapped * way.balance);
            return vector::scale(cx, &towards, factor);
        }
        let density = values[C];
        // W F = value cos_i A c / (r^2 + p A c). It never exceeds the bound of the weight, for any
        // density.
        let [area, cos, square] = way.lamp;
        let area = math!(cx, scale(area * cos, PI));
        let both = math!(cx, square + density * area);
        for (towards, &bound) in towards.iter_mut().zip(&self.weight_bound) {
            *towards = math!(cx, div(*towards * area, both, bound));
        }
        towards
    }
}

/// The first values, one for each channel.
#[inline(always)]
fn channels<R: Copy, const C: usize>(values: &[R; ROOTS]) -> [R; C] {
    let mut channels = [values[0]; C];
    channels.copy_from_slice(&values[..C]);
    channels
}

/// Returns a value in which the point that is hit is in stage units.
fn staged(value: &Expr, geometry: &StageGeometry) -> Expr {
    let unit = Expr::number(geometry.scale.recip());
    let centre = geometry.centre.to_array().map(Expr::number);
    let axes = Variable::POINT.into_iter().zip(centre);
    axes.fold(value.clone(), |value, (axis, centre)| {
        let (Some(unit), Some(centre)) = (&unit, centre) else {
            return value;
        };
        let scaled = unit * &Expr::variable(axis);
        value.substitute(axis, &(&centre + &scaled))
    })
}

/// The domain of a staged value.
fn staged_domain(bsdf: &CustomBsdf, geometry: &StageGeometry) -> Domain {
    let mut domain = bsdf.extent.domain();
    for (axis, variable) in Variable::POINT.into_iter().enumerate() {
        let Interval { lo, hi } = domain.get(variable);
        let staged = |at: f64| (at - geometry.centre[axis]) * geometry.scale;
        *domain.get_mut(variable) = Interval {
            lo: staged(lo),
            hi: staged(hi),
        };
    }
    domain
}

/// The angles between the viewer's direction and a sampled one, with the point that is hit.
#[inline(always)]
fn angles<A: Arith>(
    cx: &mut A,
    outgoing: &Vector<A>,
    incoming: &Vector<A>,
    point: Option<Vector<A>>,
) -> Angles<A::Real> {
    let cos_i = cx.abs(incoming[2]);
    let cos_a = cos_to_mirror(cx, incoming, outgoing);
    Angles {
        cos_i: cx.cosine(cos_i),
        cos_o: cx.cosine(outgoing[2]),
        cos_a: cx.cosine(cos_a),
        point: point.unwrap_or_else(|| [cx.real(0.0); 3]),
    }
}
