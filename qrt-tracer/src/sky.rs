//! The light of directions in which nothing stands.

use super::Arith;
use super::radiance::in_units;
use super::vector::Vector;
use qrt_scene::Sky;

/// A sky prepared for the tracer: the radiance `horizon + max(0, d.up) rise` of a unit direction `d`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SkyStage<const C: usize> {
    horizon: [f64; C],
    zenith: [f64; C],
    up: [f64; 3],
}

impl<const C: usize> SkyStage<C> {
    /// The sky of these channels (0 red, 1 green, 2 blue); none if it is black.
    pub(crate) fn new(sky: &Sky, channels: [usize; C]) -> Option<Self> {
        let [horizon, zenith] = sky
            .gradient()
            .map(|end| channels.map(|channel| end[channel]));
        // Components that are only rounding errors cost a circuit products.
        let clean = |c: f64| if c.abs() < f64::EPSILON { 0.0 } else { c };
        sky.shines().then_some(Self {
            horizon,
            zenith,
            up: sky.upwards().to_array().map(clean),
        })
    }

    /// The greatest radiance, per channel.
    pub(crate) fn most(&self) -> [f64; C] {
        std::array::from_fn(|c| self.horizon[c].max(self.zenith[c]))
    }

    /// True if the radiance depends on the direction, which then must have unit length.
    pub(crate) fn asks_for_directions(&self) -> bool {
        self.horizon != self.zenith
    }

    /// Converts radiance to `units`.
    pub(crate) fn in_units(&mut self, units: [f64; C]) {
        let mut ends = [self.horizon, self.zenith];
        in_units(&mut ends, units);
        [self.horizon, self.zenith] = ends;
    }

    /// The radiance of a direction, per channel.
    #[inline(always)]
    pub(crate) fn radiance<A: Arith>(&self, cx: &mut A, direction: &Vector<A>) -> [A::Real; C] {
        let mut radiance = [cx.real(0.0); C];
        if !self.asks_for_directions() {
            for (radiance, &horizon) in radiance.iter_mut().zip(&self.horizon) {
                *radiance = cx.real(horizon);
            }
            return radiance;
        }
        let [x, y, z] = *direction;
        let height = math!(
            cx,
            x * real(self.up[0]) + y * real(self.up[1]) + z * real(self.up[2])
        );
        let height = math!(cx, known(max(height, 0.0), 0.0, 1.0));
        let ends = self.horizon.iter().zip(&self.zenith);
        for (radiance, (&horizon, &zenith)) in radiance.iter_mut().zip(ends) {
            *radiance = math!(cx, real(horizon) + height * real(zenith - horizon));
        }
        radiance
    }
}
