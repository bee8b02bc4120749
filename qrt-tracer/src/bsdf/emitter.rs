//! Emission: radiance from the front. An emitter reflects as a Lambertian does, or not at all.

use super::vertex::{Vertex, members};
use crate::radiance::in_units;
use crate::{Arith, vector};
use qrt_scene::valid::Surface;
use std::ops::Range;

/// The surfaces that emit, which have consecutive numbers.
#[derive(Clone, Debug)]
pub(crate) struct Emitters<const C: usize> {
    surfaces: Range<u32>,
    /// The radiance that the front of each surface emits, 0 or more.
    radiance: Vec<[f64; C]>,
}

impl<const C: usize> Emitters<C> {
    pub(crate) fn new(surfaces: &[&Surface], channels: [usize; C]) -> Self {
        let emitting = surfaces.iter().filter(|surface| surface.emits());
        let first = surfaces.iter().position(|surface| surface.emits());
        let first = first.unwrap_or(0) as u32;
        Self {
            surfaces: first..first + emitting.count() as u32,
            radiance: surfaces
                .iter()
                .map(|surface| channels.map(|c| surface.radiance[c]))
                .collect(),
        }
    }

    /// The radiance that the front of each surface emits.
    pub(crate) fn radiance(&self) -> &[[f64; C]] {
        &self.radiance
    }

    /// Converts radiance to `units`.
    pub(crate) fn in_units(&mut self, units: [f64; C]) {
        in_units(&mut self.radiance, units);
    }

    /// The paths on an emitter, if there may be any.
    #[inline(always)]
    pub(crate) fn members<A: Arith>(&self, cx: &mut A, at: &Vertex<A, C>) -> Option<A::Bool> {
        members(cx, at, &self.surfaces)
    }

    /// The light of the `members` that reaches the camera, times the `share` if there is one, which is
    /// larger by a power of two; 0 for other paths.
    #[inline(always)]
    pub(crate) fn shade<A: Arith>(
        &self,
        cx: &mut A,
        at: &Vertex<A, C>,
        members: A::Bool,
        throughput: Option<[A::Real; C]>,
        share: Option<(A::Real, f64)>,
    ) -> [A::Real; C] {
        let shows = math!(cx, members && at.front && at.alive);
        let radiance = cx.rows(&self.radiance, at.surface);
        let arriving = match throughput {
            Some(throughput) => vector::mul(cx, &throughput, &radiance),
            None => radiance,
        };
        let arriving = match share {
            Some((share, gain)) if gain > 1.0 => {
                let shrunk = cx.real(1.0 / gain);
                let arriving = vector::scale(cx, &arriving, shrunk);
                vector::scale(cx, &arriving, share)
            }
            Some((share, _)) => vector::scale(cx, &arriving, share),
            None => arriving,
        };
        let none = [cx.real(0.0); C];
        vector::select(cx, shows, &arriving, &none)
    }
}
