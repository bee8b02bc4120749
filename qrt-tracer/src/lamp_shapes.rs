//! Shapes of lamps, and the sampling of points on them.

use super::ball::StageBall;
use super::sun::{DISTANCE, clean};
use super::vector::Vector;
use super::{Arith, Sampled};
use glam::DVec3;
use qrt_scene::lights::{Cone, Lamp};
use std::f64::consts::{PI, TAU};

/// The shape of a lamp.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Flat(Lamp),
    Round(StageBall),
    /// A sun.
    Far(Cone),
}

impl Shape {
    /// Its area; for a sun, that of its directions on the sphere of sampled points.
    pub(super) fn area(&self) -> f64 {
        match self {
            Self::Flat(lamp) => lamp.area,
            Self::Round(ball) => 4.0 * PI * ball.radius * ball.radius,
            Self::Far(cone) => cone.solid_angle() * DISTANCE * DISTANCE,
        }
    }

    /// 1 for a triangle, else 0.
    pub(super) fn is_triangle(&self) -> u32 {
        match self {
            Self::Flat(lamp) => u32::from(lamp.triangle),
            Self::Round(_) | Self::Far(_) => 0,
        }
    }

    /// True for a disc, and for a sun, whose directions end on a cap above a disc.
    pub(super) fn is_disc(&self) -> bool {
        match self {
            Self::Flat(lamp) => lamp.disc,
            Self::Round(_) => false,
            Self::Far(_) => true,
        }
    }

    /// Corner and edges; centre and two radii of a disc, also of the sun's; centre of a sphere.
    pub(super) fn place(&self) -> [f64; 9] {
        let (corner, edges) = match self {
            Self::Flat(lamp) => (lamp.corner, lamp.edges),
            Self::Round(ball) => (ball.centre, [DVec3::ZERO; 2]),
            Self::Far(cone) => (
                clean(cone.axis) * DISTANCE,
                cone.across
                    .map(|across| clean(across) * (cone.sin * DISTANCE)),
            ),
        };
        let [a, b] = edges.map(|edge| edge.to_array());
        let c = corner.to_array();
        [c[0], c[1], c[2], a[0], a[1], a[2], b[0], b[1], b[2]]
    }

    /// The normal, and its product with the corner; 0 for a sphere.
    pub(super) fn normal(&self) -> [f64; 4] {
        let lamp = match self {
            Self::Flat(lamp) => lamp,
            Self::Round(_) => return [0.0; 4],
            // The sun faces every vertex, at the same distance.
            Self::Far(_) => return [0.0, 0.0, 0.0, -DISTANCE],
        };
        // A component of an axis-aligned normal that is only a rounding error becomes 0.
        let n = clean(lamp.normal).to_array();
        [n[0], n[1], n[2], lamp.normal.dot(lamp.corner)]
    }
}

/// The sampling of points on lamps that are discs, uniform by area and one-to-one: the square of the distance
/// from the centre and the azimuth are uniform. Both coordinates are tables; a concentric map (Shirley & Chiu
/// 1997) would need a quotient of them. The points of a sun are uniform on the cap: see [`super::sun`].
#[derive(Clone, Debug)]
pub(super) struct DiscLamps {
    /// By lamp: 1 if it is a disc, else 0.
    is: Vec<u32>,
    /// Distance from the centre, in radii.
    distance: Sampled,
    /// Cosine and sine of the azimuth.
    azimuth: [Sampled; 2],
}

impl DiscLamps {
    /// The lamp of each column, and its `place` along the lamp.
    pub(super) fn new(
        shapes: &[Shape],
        bits: [u32; 2],
        (lamp_of, place): (Vec<u32>, impl Fn(u32) -> f64 + Send + Sync + 'static),
    ) -> Self {
        let cap = |shape: &Shape| match shape {
            Shape::Far(cone) => cone.cap,
            _ => 0.0,
        };
        let caps: Vec<f64> = shapes.iter().map(cap).collect();
        let distance = move |column: u32| {
            let (place, cap) = (place(column), caps[lamp_of[column as usize] as usize]);
            (place * (2.0 - place * cap) / (2.0 - cap)).sqrt()
        };
        Self {
            is: shapes
                .iter()
                .map(|shape| u32::from(shape.is_disc()))
                .collect(),
            distance: Sampled::of_index(bits[0], distance),
            azimuth: azimuth(bits[1]),
        }
    }

    /// The factors of the lamp's two edges: those of a disc's radii, or else `others`.
    #[inline(always)]
    pub(super) fn place<A: Arith>(
        &self,
        cx: &mut A,
        [u, v]: [A::Index; 2],
        lamp: A::Index,
        others: [A::Real; 2],
    ) -> [A::Real; 2] {
        let is = cx.entry(&self.is, lamp);
        let is = cx.is(is, 1);
        let distance = cx.sampled(&self.distance, u);
        [0, 1].map(|k| {
            let part = cx.sampled(&self.azimuth[k], v);
            math!(cx, select(is, distance * part, others[k]))
        })
    }
}

/// Cosine and sine of the azimuth, by a sample coordinate of `bits` bits.
fn azimuth(bits: u32) -> [Sampled; 2] {
    [
        Sampled::of_centre(bits, |v| libm::cos(TAU * v)),
        Sampled::of_centre(bits, |v| libm::sin(TAU * v)),
    ]
}

/// The sampling of points on lamps that are spheres, uniform by area. The height on a sphere and the
/// azimuth are uniform (Archimedes).
#[derive(Clone, Debug)]
pub(super) struct SphereLamps {
    /// By lamp: 1 if it is a sphere, else 0.
    is: Vec<u32>,
    /// By lamp: its radius; 0 for a polygon.
    pub(super) radii: Vec<[f64; 1]>,
    /// Height and distance from the axis, of a unit normal.
    height: Sampled,
    across: Sampled,
    /// Cosine and sine of the azimuth.
    azimuth: [Sampled; 2],
}

impl SphereLamps {
    /// `place` is that of each column along its lamp.
    pub(super) fn new(
        shapes: &[Shape],
        bits: [u32; 2],
        place: impl Fn(u32) -> f64 + Clone + Send + Sync + 'static,
    ) -> Self {
        let radius = |shape: &Shape| match shape {
            Shape::Flat(_) | Shape::Far(_) => 0.0,
            Shape::Round(ball) => ball.radius,
        };
        let heights = place.clone();
        Self {
            is: shapes.iter().map(|s| u32::from(radius(s) > 0.0)).collect(),
            radii: shapes.iter().map(|shape| [radius(shape)]).collect(),
            height: Sampled::of_index(bits[0], move |column| 1.0 - 2.0 * heights(column)),
            across: Sampled::of_index(bits[0], move |column| {
                let place = place(column);
                2.0 * (place * (1.0 - place)).sqrt()
            }),
            azimuth: azimuth(bits[1]),
        }
    }

    /// Returns whether the lamp is a sphere, and its normal at the sampled point.
    #[inline(always)]
    pub(super) fn point<A: Arith>(
        &self,
        cx: &mut A,
        [u, v]: [A::Index; 2],
        lamp: A::Index,
    ) -> (A::Bool, Vector<A>) {
        let is = cx.entry(&self.is, lamp);
        let is = cx.is(is, 1);
        let height = cx.sampled(&self.height, u);
        let across = cx.sampled(&self.across, u);
        let [cos, sin] = [
            cx.sampled(&self.azimuth[0], v),
            cx.sampled(&self.azimuth[1], v),
        ];
        (
            is,
            [math!(cx, across * cos), math!(cx, across * sin), height],
        )
    }
}
