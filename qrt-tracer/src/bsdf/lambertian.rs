//! Matte, on both sides: `f = albedo / pi`.
//!
//! Directions come from the depth's map, and the density is the map's. Under the cosine map
//! `cos_i J = pi`, and the weight is the albedo, at most 1. Under another map it is at most the
//! albedo times the map's greatest factor.

use super::Sample;
use super::vertex::{Scattered, to_scene};
use crate::{Arith, vector};

#[inline(always)]
pub(super) fn scatter<A: Arith, const C: usize>(
    cx: &mut A,
    sample: &Sample<'_, A, C>,
) -> Scattered<A, C> {
    let direction = to_scene(cx, sample.at, &sample.mapped.direction);
    let weight = if sample.square.map.is_projected() {
        sample.tint
    } else {
        vector::scale(cx, &sample.tint, sample.mapped.factor)
    };
    let density = if sample.asks_for_density {
        sample.square.map.own_density(cx, &sample.mapped.direction)
    } else {
        cx.real(0.0)
    };
    Scattered {
        crosses: None,
        direction,
        weight,
        density,
    }
}
