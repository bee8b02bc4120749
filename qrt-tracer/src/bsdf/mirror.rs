//! A mirror, on both sides: a delta lobe, whose weight is its reflectance, at most 1. That of metal grows with the
//! angle to the normal.

use super::Sample;
use super::vertex::Scattered;
use crate::{Arith, vector};

/// Schlick's approximation of Fresnel's reflectance, from that along the normal: `r + (1 - r) (1 - cos)^5`.
#[inline(always)]
pub(super) fn schlick<A: Arith, const C: usize>(
    cx: &mut A,
    reflectance: [A::Real; C],
    cos: A::Real,
) -> [A::Real; C] {
    let rest = math!(cx, known(max(1.0 - cos, 0.0), 0.0, 1.0));
    let squared = math!(cx, rest * rest);
    let fifth = math!(cx, squared * squared * rest);
    reflectance.map(|reflectance| math!(cx, reflectance + fifth * (1.0 - reflectance)))
}

/// The lobe of smooth metal.
#[inline(always)]
pub(super) fn scatter_by_angle<A: Arith, const C: usize>(
    cx: &mut A,
    sample: &Sample<'_, A, C>,
) -> Scattered<A, C> {
    let scattered = scatter(cx, sample);
    let cos = cx.abs(sample.at.cos_theta);
    Scattered {
        weight: schlick(cx, sample.tint, cos),
        ..scattered
    }
}

#[inline(always)]
pub(super) fn scatter<A: Arith, const C: usize>(
    cx: &mut A,
    sample: &Sample<'_, A, C>,
) -> Scattered<A, C> {
    let direction = vector!(cx, -mirror(sample.at.arriving, sample.at.normal));
    Scattered {
        crosses: None,
        direction: vector::unit(cx, &direction),
        weight: sample.tint,
        density: cx.real(0.0),
    }
}
