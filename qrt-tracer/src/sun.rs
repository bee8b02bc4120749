//! The light of a sun: a cone of directions with one radiance, at no finite distance.
//!
//! Lamps stand in the scene, and a sun is sampled as if it did, too: its points are
//!
//! ```text
//! D (axis (1 - u cap) + sin(a) r(u) (cos(2 pi v) across[0] + sin(2 pi v) across[1])),
//! r(u) = sqrt(u (2 - u cap) / (2 - cap)),    cap = 1 - cos(a)
//! ```
//!
//! as seen from every vertex: uniform in the solid angle of the cone with half angle `a`. `D` is above the
//! distance of any two points of the scene. The point lies on a sphere around the vertex, so the
//! cosine at the lamp is 1, and an area of `D^2` times the solid angle takes the place of the lamp's.

use super::Arith;
use super::intersect::DiscNumbers;
use super::radiance::in_units;
use super::vector::Vector;
use glam::DVec3;
use qrt_scene::Rgb;
use qrt_scene::lights::Cone;

/// The distance of a sampled point of a sun in stage units: a power of two above `2 sqrt(3)`, the diagonal of the
/// box around a scene.
pub(super) const DISTANCE: f64 = 4.0;

/// A sun prepared for the tracer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SunStage<const C: usize> {
    cone: Cone,
    radiance: [f64; C],
    /// True if primary rays may meet it.
    is_seen: bool,
}

impl<const C: usize> SunStage<C> {
    /// The sun of these channels (0 red, 1 green, 2 blue). Primary rays may meet it if it `is_seen`.
    pub(crate) fn new((cone, radiance): (Cone, Rgb), channels: [usize; C], is_seen: bool) -> Self {
        Self {
            cone: Cone {
                axis: clean(cone.axis),
                across: cone.across.map(clean),
                ..cone
            },
            radiance: channels.map(|channel| radiance[channel]),
            is_seen,
        }
    }

    /// The directions of the sun.
    pub(crate) fn cone(&self) -> &Cone {
        &self.cone
    }

    /// The radiance, per channel.
    pub(crate) fn radiance(&self) -> [f64; C] {
        self.radiance
    }

    /// True if primary rays may meet the sun.
    pub(crate) fn is_seen(&self) -> bool {
        self.is_seen
    }

    /// The irradiance of a surface that faces the sun, over pi and per channel.
    pub(crate) fn irradiance(&self) -> [f64; C] {
        self.radiance.map(|c| c * self.cone.sin.powi(2))
    }

    /// Converts radiance to `units`.
    pub(crate) fn in_units(&mut self, units: [f64; C]) {
        let mut radiance = [self.radiance];
        in_units(&mut radiance, units);
        [self.radiance] = radiance;
    }

    /// True if a unit `direction` is within the cone.
    ///
    /// The cosine of a small angle has too few bits in a register. Both coordinates across the axis are
    /// compared instead, in units of the sine of the half angle.
    #[inline(always)]
    pub(crate) fn holds<A: Arith>(&self, cx: &mut A, direction: &Vector<A>) -> A::Bool {
        let Cone {
            axis, across, sin, ..
        } = &self.cone;
        let [along, first, second] =
            [axis, &across[0], &across[1]].map(|onto| component(cx, direction, *onto));
        let ahead = math!(cx, 0.0 < along);
        let [beside, above] = [first, second].map(|part| cx.inside(-sin, part, *sin));
        let zero = cx.real(0.0);
        let disc = DiscNumbers {
            centre: [zero; 2],
            scale: [cx.real(1.0 / sin); 2],
            square: cx.real(1.0),
            most: 1.0 / sin,
        };
        let within = disc.hold(cx, [first, second]);
        math!(cx, (ahead && within) && (beside && above))
    }
}

/// The component of `direction` along a constant vector.
#[inline(always)]
fn component<A: Arith>(cx: &mut A, [x, y, z]: &Vector<A>, onto: DVec3) -> A::Real {
    math!(
        cx,
        *x * real(onto.x) + *y * real(onto.y) + *z * real(onto.z)
    )
}

/// The vector without components that are only rounding errors, which cost a circuit products.
pub(super) fn clean(vector: DVec3) -> DVec3 {
    let clean = |c: f64| if c.abs() < f64::EPSILON { 0.0 } else { c };
    DVec3::from_array(vector.to_array().map(clean))
}
