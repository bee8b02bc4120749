//! A perfect mirror, on both sides: a delta lobe, whose weight is its reflectance, at most 1.

use super::Sample;
use super::vertex::Scattered;
use crate::tracer::{Arith, vector};

#[inline(always)]
pub(super) fn scatter<A: Arith, const C: usize>(
    cx: &mut A,
    sample: &Sample<'_, A, C>,
) -> Scattered<A, C> {
    let direction = vector!(cx, -mirror(sample.at.arriving, sample.at.normal));
    Scattered {
        direction: vector::unit(cx, &direction),
        weight: sample.tint,
        density: cx.real(0.0),
    }
}
