//! Scattering: from a hit to the next ray of the path and its weight `W = f(i, o) |n.i| J`.
//!
//! Each material's lobe has a file, with the range of its parameters, the sampling of directions, their weights
//! and their density, and the greatest weight, from which the colour scale is proven. Directions are in the
//! local frame, whose z axis is the normal on the viewer's side. For each depth, directions are computed for
//! every lobe that the scene has, and for no others; each path then selects its own.

mod custom;
mod dielectric;
mod emitter;
mod ggx;
mod lambertian;
mod map;
mod mirror;
mod phong;
#[cfg(test)]
mod tests;
mod vertex;

pub(crate) use emitter::Emitters;
pub(crate) use vertex::{Painted, SmoothHit, Vertex, members};

use super::lights::{LightStage, Receiver, Towards};
use super::vector::{self, Vector};
use super::{Arith, Coordinate, Sampled, StageGeometry, TracerPart, Work};
use custom::CustomLobe;
use dielectric::DielectricLobe;
use ggx::GgxLobe;
use map::{DepthMap, Mapped};
use phong::PhongLobe;
use qrt_scene::valid::{Scatter, Surface};
use qrt_scene::{Map, Reflectance, Rgb};
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::sync::Arc;
use vertex::{Scattered, local_outgoing};

/// The lobe of a surface, or of consecutive surfaces that differ only in tables, for one depth.
#[derive(Clone, Debug)]
enum Lobe<const C: usize> {
    Lambertian,
    Mirror,
    Dielectric(DielectricLobe),
    /// GGX, of Fresnel 1 or of rough metal.
    Ggx(GgxLobe),
    /// Smooth metal.
    Metal,
    Phong(PhongLobe<C>),
    Custom(CustomLobe<C>),
}

impl<const C: usize> Lobe<C> {
    /// True if the lobe belongs to one surface, and has no tables by surface.
    fn is_of_one(&self) -> bool {
        match self {
            Self::Lambertian | Self::Mirror | Self::Metal | Self::Dielectric(_) | Self::Ggx(_) => {
                false
            }
            Self::Phong(_) | Self::Custom(_) => true,
        }
    }

    /// True if the lobe reads the viewer's direction in the local frame.
    fn asks_for_outgoing(&self) -> bool {
        match self {
            Self::Lambertian | Self::Mirror | Self::Metal | Self::Dielectric(_) => false,
            Self::Ggx(_) | Self::Phong(_) | Self::Custom(_) => true,
        }
    }

    /// True if the lobe takes directions from the depth's map ([`Sample::mapped`]).
    fn uses_map(&self) -> bool {
        match self {
            Self::Lambertian => true,
            Self::Mirror | Self::Metal | Self::Dielectric(_) => false,
            Self::Ggx(lobe) => !lobe.has_map,
            Self::Phong(lobe) => !lobe.has_map,
            Self::Custom(lobe) => lobe.direction.is_none(),
        }
    }

    /// True if the lobe reads the cosine of the arriving ray, which then must have unit length.
    fn asks_for_angles(&self) -> bool {
        match self {
            // A mirror keeps the length of a direction.
            Self::Lambertian | Self::Mirror => false,
            Self::Metal | Self::Dielectric(_) | Self::Ggx(_) | Self::Phong(_) => true,
            Self::Custom(lobe) => lobe.asks_for_angles,
        }
    }
}

/// The rank of a lobe in the order in which surfaces are sorted; black is first.
pub(crate) fn rank(scatter: &Scatter) -> u32 {
    match scatter {
        Scatter::Black => 0,
        Scatter::Lambertian(_) => 1,
        Scatter::Mirror(_) => 2,
        Scatter::Dielectric(_) => 3,
        Scatter::Ggx(_) => 4,
        Scatter::Phong(_) => 5,
        Scatter::Custom(_) => 6,
        Scatter::Metal(metal) if metal.alpha == 0.0 => 7,
        Scatter::Metal(_) => 8,
    }
}

/// Most table entries that are stored for all lobes and depths of a stage: 256 MB.
const MOST_STORED: usize = 1 << 25;

/// The largest number of tables of a surface's lobe.
fn tables(scatter: &Scatter) -> usize {
    match scatter {
        Scatter::Phong(_) => 3,
        Scatter::Custom(bsdf) => {
            let values = bsdf.map.iter().chain(&bsdf.value).chain(&bsdf.pdf);
            let all = values.chain([&bsdf.projected_jacobian]);
            // One table per three nodes: a coordinate, its function, and the operation with another.
            all.map(|value| value.nodes().len().div_ceil(3)).sum()
        }
        _ => 0,
    }
}

/// The factor of a weight that is looked up by surface. `coloured` tells whether any glass has one.
fn tint(surface: &Surface, coloured: bool) -> Reflectance {
    match &surface.scatter {
        Scatter::Dielectric(glass) if coloured => glass.transmittance.into(),
        _ => surface.tint().copied().unwrap_or([0.0; 3].into()),
    }
}

/// The factor of the weight of each of `surfaces`, or the two of a checker.
pub(crate) fn tints(surfaces: &[&Surface]) -> Vec<Reflectance> {
    let coloured = surfaces.iter().any(|s| dielectric::is_coloured(&s.scatter));
    surfaces.iter().map(|s| tint(s, coloured)).collect()
}

/// The greatest factor in each channel.
pub(crate) fn greatest(tint: &Reflectance) -> Rgb {
    let colours = tint.colours().iter();
    colours.fold([0.0; 3], |most, colour| {
        std::array::from_fn(|c| f64::max(most[c], colour[c]))
    })
}

/// One depth's square of samples, which all its lobes share.
#[derive(Clone, Debug)]
struct Square {
    depth: usize,
    bits: [u32; 2],
    /// Most index bits of a stored table.
    most_stored: u32,
    map: Arc<DepthMap>,
    /// Cosine and sine of `2 pi v`.
    azimuth: [Sampled; 2],
}

impl Square {
    /// The cell centre of `u`.
    #[inline(always)]
    fn u<A: Arith>(&self, cx: &mut A) -> A::Real {
        let u = cx.coordinate(Coordinate::u(self.depth));
        cx.centre(u, self.bits[0])
    }

    /// Cosine and sine of the azimuth `2 pi v`.
    #[inline(always)]
    fn azimuth<A: Arith>(&self, cx: &mut A) -> [A::Real; 2] {
        let v = cx.coordinate(Coordinate::v(self.depth));
        let [cos, sin] = &self.azimuth;
        [cx.sampled(cos, v), cx.sampled(sin, v)]
    }
}

/// The input of a path's lobe.
struct Sample<'a, A: Arith, const C: usize> {
    at: &'a Vertex<A, C>,
    square: &'a Square,
    /// The direction by the depth's map; zeros unless a lobe uses it.
    mapped: Mapped<A::Real>,
    /// The viewer's direction in the local frame; zeros unless a lobe reads it.
    outgoing: Vector<A>,
    /// The surface's [`tint`].
    tint: [A::Real; C],
    /// True if [`Scattered::density`] is requested.
    asks_for_density: bool,
}

/// The scattering towards one depth's ray, prepared for the tracer.
#[derive(Clone, Debug)]
pub(crate) struct ScatterStage<const C: usize> {
    square: Square,
    /// The factor of the weight of each surface, per channel; then, if any has two, the second of
    /// each.
    tint: Arc<[[f64; C]]>,
    /// The greatest factor of each surface, per channel: on any of its faces.
    greatest: Arc<[[f64; C]]>,
    /// The surfaces that scatter, with their lobes; depths with one square share them.
    lobes: Arc<[(Range<u32>, Lobe<C>)]>,
    /// True if any lobe uses the depth's map.
    uses_map: bool,
    /// True if any lobe reads angles to the arriving ray.
    pub(crate) asks_for_angles: bool,
    /// The sampling of lamps at the vertices that the ray leaves, if there is any.
    pub(crate) lights: Option<LightStage<C>>,
}

impl<const C: usize> ScatterStage<C> {
    /// Prepares the scattering towards the ray of `depth`. `surfaces` are sorted by [`rank`]. `squares` is the
    /// number of different sample squares of all depths.
    pub(crate) fn new(
        surfaces: &[&Surface],
        channels: [usize; C],
        depth: usize,
        (bits, map): ([u32; 2], Map),
        squares: usize,
        geometry: &StageGeometry,
    ) -> Self {
        let tables: usize = surfaces
            .iter()
            .map(|surface| tables(&surface.scatter))
            .sum();
        let each = MOST_STORED / (tables * squares).max(1);
        let square = Square {
            depth,
            bits,
            most_stored: each.max(1).ilog2(),
            map: Arc::new(DepthMap::new(map, bits)),
            azimuth: [
                Sampled::of_centre(bits[1], |v| libm::cos(TAU * v)),
                Sampled::of_centre(bits[1], |v| libm::sin(TAU * v)),
            ],
        };
        let pick = |rgb: Rgb| channels.map(|channel| rgb[channel]);
        let coloured = surfaces.iter().any(|s| dielectric::is_coloured(&s.scatter));
        let mut lobes: Vec<(Range<u32>, Lobe<C>)> = Vec::new();
        for (number, surface) in (0..).zip(surfaces) {
            if let Some((run, lobe)) = lobes.last_mut()
                && !lobe.is_of_one()
                && rank(&surfaces[run.start as usize].scatter) == rank(&surface.scatter)
            {
                run.end = number + 1;
                continue;
            }
            let lobe = match &surface.scatter {
                Scatter::Black => continue,
                Scatter::Lambertian(_) => Lobe::Lambertian,
                Scatter::Mirror(_) => Lobe::Mirror,
                Scatter::Dielectric(_) => Lobe::Dielectric(DielectricLobe::new(surfaces, coloured)),
                Scatter::Ggx(_) => Lobe::Ggx(GgxLobe::new(surfaces, &square, false)),
                Scatter::Metal(metal) if metal.alpha == 0.0 => Lobe::Metal,
                Scatter::Metal(_) => Lobe::Ggx(GgxLobe::new(surfaces, &square, true)),
                Scatter::Phong(phong) => Lobe::Phong(PhongLobe::new(phong, pick, &square)),
                Scatter::Custom(bsdf) => {
                    Lobe::Custom(CustomLobe::new(bsdf, channels, &square, geometry))
                }
            };
            lobes.push((number..number + 1, lobe));
        }
        let tints = tints(surfaces);
        let first = |tint: &Reflectance| tint.colours().first().copied().unwrap_or_default();
        let last = |tint: &Reflectance| tint.colours().last().copied().unwrap_or_default();
        let mut rows: Vec<[f64; C]> = tints.iter().map(|tint| pick(first(tint))).collect();
        if tints.iter().any(|tint| tint.checker().is_some()) {
            rows.extend(tints.iter().map(|tint| pick(last(tint))));
        }
        Self {
            tint: rows.into(),
            greatest: tints.iter().map(|tint| pick(greatest(tint))).collect(),
            uses_map: lobes.iter().any(|(_, lobe)| lobe.uses_map()),
            asks_for_angles: lobes.iter().any(|(_, lobe)| lobe.asks_for_angles()),
            lobes: lobes.into(),
            lights: None,
            square,
        }
    }

    /// The same for another depth, whose square has the same bits and the same map. It samples no lamps yet.
    pub(crate) fn at_depth(&self, depth: usize) -> Self {
        let square = Square {
            depth,
            ..self.square.clone()
        };
        Self {
            square,
            lights: None,
            ..self.clone()
        }
    }

    /// Sets the sampling of lamps at the vertices that the ray leaves.
    pub(crate) fn sample_lights(&mut self, lights: Option<LightStage<C>>) {
        // The cosines at a ray's ends are read from its direction, which then must have unit length.
        self.lights = lights;
    }

    /// Sets the greatest factor of each surface, in a scene with coloured faces.
    pub(crate) fn paint(&mut self, greatest: Vec<[f64; C]>) {
        self.greatest = greatest.into();
    }

    /// The factor of the weight at a vertex, per channel.
    #[inline(always)]
    fn tint<A: Arith>(&self, cx: &mut A, at: &Vertex<A, C>) -> [A::Real; C] {
        let Some(painted) = &at.painted else {
            return cx.rows(&self.tint, at.tint);
        };
        let Some(checkered) = painted.checkered else {
            return painted.tint;
        };
        let of_surface = cx.rows(&self.tint, at.tint);
        vector::select(cx, checkered, &of_surface, &painted.tint)
    }

    /// The greatest weight of surface `number` towards this depth; 0 where nothing scatters.
    pub(crate) fn weight_bound(&self, number: u32) -> [f64; C] {
        let factor = self.square.map.factor_bound();
        let tint = self.greatest[number as usize];
        match self.lobe(number) {
            None => [0.0; C],
            Some(Lobe::Lambertian) => tint.map(|albedo| albedo * factor),
            Some(Lobe::Mirror) => tint,
            // Schlick's formula goes from the tint to 1.
            Some(Lobe::Metal) => [1.0; C],
            Some(Lobe::Dielectric(lobe)) => [lobe.weight_bound(number); C],
            Some(Lobe::Ggx(lobe)) => {
                tint.map(|tint| lobe.weight_bound(number, tint, &self.square.map))
            }
            Some(Lobe::Phong(lobe)) => lobe.weight_bound(factor),
            Some(Lobe::Custom(lobe)) => lobe.weight_bound,
        }
    }

    /// As [`ScatterStage::weight_bound`], for light from a point on a lamp, which all parts of a lobe may see.
    pub(crate) fn light_weight_bound(&self, number: u32) -> [f64; C] {
        match self.lobe(number) {
            Some(Lobe::Phong(lobe)) => lobe.light_weight_bound(self.square.map.factor_bound()),
            None
            | Some(
                Lobe::Lambertian
                | Lobe::Mirror
                | Lobe::Metal
                | Lobe::Dielectric(_)
                | Lobe::Ggx(_)
                | Lobe::Custom(_),
            ) => self.weight_bound(number),
        }
    }

    /// The density per steradian with which surface `number` samples directions around `incoming`. Over a part
    /// of the square that the map takes to directions one to one it is `1 / J`; it is summed over these parts.
    /// None for delta lobes, for maps that no formula inverts, and for surfaces that scatter nothing: light that
    /// is sampled in another way cannot be weighted against these.
    pub(crate) fn density<A: Arith>(
        &self,
        cx: &mut A,
        number: u32,
        outgoing: &Vector<A>,
        incoming: &Vector<A>,
    ) -> Option<A::Real> {
        let lobe = self.lobe(number)?;
        if lobe.uses_map() {
            return Some(self.square.map.density(cx, incoming));
        }
        match lobe {
            Lobe::Lambertian | Lobe::Mirror | Lobe::Metal | Lobe::Dielectric(_) => None,
            Lobe::Ggx(lobe) => {
                let number = cx.index(number);
                Some(lobe.density(cx, number, outgoing, incoming))
            }
            Lobe::Phong(lobe) => {
                let [base, lobe] = lobe.densities(cx, outgoing, incoming);
                Some(cx.add(base, lobe))
            }
            Lobe::Custom(lobe) => lobe.density(cx, self.square.depth, outgoing, incoming),
        }
    }

    /// True if surface `number` scatters.
    fn scatters(&self, number: u32) -> bool {
        self.lobe(number).is_some()
    }

    /// True if the density of the directions that surface `number` samples is known.
    pub(crate) fn samples_lights(&self, number: u32) -> bool {
        match self.lobe(number) {
            None | Some(Lobe::Mirror | Lobe::Metal | Lobe::Dielectric(_)) => false,
            Some(Lobe::Lambertian | Lobe::Ggx(_) | Lobe::Phong(_)) => true,
            Some(Lobe::Custom(lobe)) => lobe.has_density(),
        }
    }

    /// True if surface `number` is a Lambertian under the cosine map, whose weight is its albedo.
    fn is_projected(&self, number: u32) -> bool {
        self.square.map.is_projected() && matches!(self.lobe(number), Some(Lobe::Lambertian))
    }

    /// The properties of surface `number` that the sampling of lamps depends on.
    pub(crate) fn receiver(&self, number: u32) -> Receiver {
        Receiver {
            scatters: self.scatters(number),
            samples_lights: self.samples_lights(number),
            is_projected: self.is_projected(number),
        }
    }

    /// True if lobes have to compute their density.
    fn asks_for_densities(&self) -> bool {
        self.lights
            .as_ref()
            .is_some_and(LightStage::asks_for_densities)
    }

    /// The part of the light of a point on a lamp that goes to the viewer, in units of the lamp's radiance.
    #[inline(always)]
    pub(crate) fn light<A: Arith>(
        &self,
        cx: &mut A,
        at: &Vertex<A, C>,
        towards: &Towards<A>,
        lights: &LightStage<C>,
    ) -> Lit<A, C> {
        let tint = self.tint(cx, at);
        let (zero, one) = (cx.real(0.0), cx.real(1.0));
        let projected = self.square.map.is_projected();
        let (mut lit, mut way) = (None, None);
        for (surfaces, lobe) in &*self.lobes {
            match lobe {
                Lobe::Mirror | Lobe::Metal | Lobe::Dielectric(_) => {}
                Lobe::Lambertian if projected => {
                    if let Some(mask) = members(cx, at, surfaces) {
                        let factor = lights.projected(cx, at.surface, towards);
                        choose(cx, &mut lit, mask, Lit::new(tint, factor));
                    }
                }
                Lobe::Lambertian => {
                    let way = way.get_or_insert_with(|| Way::new(cx, at, towards, &self.square));
                    if let Some(mask) = members(cx, at, surfaces) {
                        let factor = math!(cx, way.mapped * way.balance);
                        choose(cx, &mut lit, mask, Lit::new(tint, factor));
                    }
                }
                Lobe::Ggx(lobe) => {
                    let way = way.get_or_insert_with(|| Way::new(cx, at, towards, &self.square));
                    if let Some(mask) = members(cx, at, surfaces) {
                        let factor = lobe.light(cx, at.surface, way);
                        let tint = lobe.reflectance(cx, tint, &way.outgoing, &way.incoming);
                        choose(cx, &mut lit, mask, Lit::new(tint, factor));
                    }
                }
                Lobe::Phong(lobe) => {
                    let way = way.get_or_insert_with(|| Way::new(cx, at, towards, &self.square));
                    if let Some(mask) = members(cx, at, surfaces) {
                        cx.of_surface(Some(surfaces.start));
                        let weight = lobe.light(cx, way);
                        cx.of_surface(None);
                        choose(cx, &mut lit, mask, Lit::new(weight, one));
                    }
                }
                Lobe::Custom(lobe) => {
                    let way = way.get_or_insert_with(|| Way::new(cx, at, towards, &self.square));
                    if lobe.has_density()
                        && let Some(mask) = members(cx, at, surfaces)
                    {
                        cx.of_surface(Some(surfaces.start));
                        let weight = lobe.light(cx, self.square.depth, way);
                        cx.of_surface(None);
                        choose(cx, &mut lit, mask, Lit::new(weight, one));
                    }
                }
            }
        }
        lit.unwrap_or(Lit::new(tint, zero))
    }

    /// The lobe of surface `number`; none if it is black.
    fn lobe(&self, number: u32) -> Option<&Lobe<C>> {
        let mut lobes = self.lobes.iter();
        let (_, lobe) = lobes.find(|(surfaces, _)| surfaces.contains(&number))?;
        Some(lobe)
    }

    /// The next direction and weight of every path that scatters; arbitrary for the others.
    #[inline(always)]
    fn scatter<A: Arith>(&self, cx: &mut A, at: &Vertex<A, C>) -> Scattered<A, C> {
        let square = &self.square;
        let zero = cx.real(0.0);
        let mut sample = Sample {
            at,
            square,
            mapped: Mapped {
                direction: [zero; 3],
                factor: zero,
            },
            outgoing: [zero; 3],
            tint: self.tint(cx, at),
            asks_for_density: self.asks_for_densities(),
        };
        if self.uses_map {
            // Read here, so that the coordinates belong to the ray and not to this part of it alone.
            let _ = cx.coordinate(Coordinate::u(square.depth));
            let _ = cx.coordinate(Coordinate::v(square.depth));
            cx.enter(TracerPart::Sample);
            sample.mapped = square.map.sample(cx, square.depth);
            cx.leave();
        }
        let (mut chosen, mut asked) = (None, false);
        for (surfaces, lobe) in &*self.lobes {
            if !asked && lobe.asks_for_outgoing() {
                sample.outgoing = local_outgoing(cx, at);
                asked = true;
            }
            let Some(mask) = members(cx, at, surfaces) else {
                continue;
            };
            cx.of_surface(lobe.is_of_one().then_some(surfaces.start));
            let new = match lobe {
                Lobe::Lambertian => lambertian::scatter(cx, &sample),
                Lobe::Mirror => mirror::scatter(cx, &sample),
                Lobe::Metal => mirror::scatter_by_angle(cx, &sample),
                Lobe::Dielectric(lobe) => lobe.scatter(cx, &sample),
                Lobe::Ggx(lobe) => lobe.scatter(cx, &sample),
                Lobe::Phong(lobe) => lobe.scatter(cx, &sample),
                Lobe::Custom(lobe) => lobe.scatter(cx, &sample),
            };
            cx.of_surface(None);
            choose(cx, &mut chosen, mask, new);
        }
        chosen.unwrap_or(Scattered {
            crosses: None,
            direction: at.arriving,
            weight: [zero; C],
            density: zero,
        })
    }
}

/// The next direction and weight of the paths at a vertex: see [`ScatterStage::scatter`].
pub(crate) struct Scattering<'a, A: Arith, const C: usize> {
    pub(crate) scatter: &'a ScatterStage<C>,
    pub(crate) at: &'a Vertex<A, C>,
}

impl<A: Arith, const C: usize> Work<A> for Scattering<'_, A, C> {
    type Output = Scattered<A, C>;

    #[inline(always)]
    fn run(self, cx: &mut A) -> Self::Output {
        self.scatter.scatter(cx, self.at)
    }
}

/// The result of a lobe for the paths on its surfaces.
trait OfLobe<A: Arith>: Sized {
    /// Returns `self` where `mask` holds, `other` elsewhere.
    fn select(self, cx: &mut A, mask: A::Bool, other: Self) -> Self;
}

/// Replaces `chosen` by `new` where `mask` holds. The first candidate needs no selection.
#[inline(always)]
fn choose<A: Arith, T: OfLobe<A>>(cx: &mut A, chosen: &mut Option<T>, mask: A::Bool, new: T) {
    *chosen = Some(match chosen.take() {
        None => new,
        Some(old) => new.select(cx, mask, old),
    });
}

impl<A: Arith, const C: usize> OfLobe<A> for Scattered<A, C> {
    #[inline(always)]
    fn select(self, cx: &mut A, mask: A::Bool, other: Self) -> Self {
        let crosses = match (self.crosses, other.crosses) {
            (None, None) => None,
            (own, other) => {
                let stays = cx.truth(false);
                Some(cx.select_truth(mask, own.unwrap_or(stays), other.unwrap_or(stays)))
            }
        };
        Self {
            crosses,
            direction: vector::select(cx, mask, &self.direction, &other.direction),
            weight: vector::select(cx, mask, &self.weight, &other.weight),
            density: cx.select(mask, self.density, other.density),
        }
    }
}

/// The part of a lamp's light that goes to the viewer: weight times factor.
pub(crate) struct Lit<A: Arith, const C: usize> {
    /// By channel.
    pub(crate) weight: [A::Real; C],
    /// Common to all channels.
    pub(crate) factor: A::Real,
}

impl<A: Arith, const C: usize> Lit<A, C> {
    #[inline(always)]
    fn new(weight: [A::Real; C], factor: A::Real) -> Self {
        Self { weight, factor }
    }
}

impl<A: Arith, const C: usize> OfLobe<A> for Lit<A, C> {
    #[inline(always)]
    fn select(self, cx: &mut A, mask: A::Bool, other: Self) -> Self {
        Self {
            weight: vector::select(cx, mask, &self.weight, &other.weight),
            factor: cx.select(mask, self.factor, other.factor),
        }
    }
}

/// The way to a point on a lamp, for lobes that read angles.
struct Way<A: Arith> {
    /// The unit direction to the point, in the local frame.
    incoming: Vector<A>,
    /// The viewer's direction in the local frame.
    outgoing: Vector<A>,
    /// Area over probability and pi, the cosine at the lamp, the square of the distance.
    lamp: [A::Real; 3],
    /// The weight of a white Lambertian, by the depth's map.
    mapped: A::Real,
    /// The balance heuristic, by the depth's map.
    balance: A::Real,
    /// The point that is lit.
    point: Option<Vector<A>>,
}

impl<A: Arith> Way<A> {
    #[inline(always)]
    fn new<const C: usize>(
        cx: &mut A,
        at: &Vertex<A, C>,
        towards: &Towards<A>,
        square: &Square,
    ) -> Self {
        let length = math!(cx, sqrt(towards.square));
        let mut unit = towards.to;
        for component in &mut unit {
            *component = math!(cx, div(*component, length, 1.0));
        }
        let incoming = [
            math!(cx, known(dot(unit, at.tangent), -1.0, 1.0)),
            math!(cx, known(dot(unit, at.bitangent), -1.0, 1.0)),
            math!(cx, div(towards.rise, length, 1.0)),
        ];
        let cos = math!(cx, div(towards.fall, length, 1.0));
        let lamp = [towards.area, cos, towards.square];
        let density = square.map.density(cx, &incoming);
        let density = cx.scale(density, PI);
        Self {
            outgoing: local_outgoing(cx, at),
            lamp,
            mapped: square.map.factor(cx, &incoming),
            balance: LightStage::<1>::balance(cx, density, lamp),
            point: at.point,
            incoming,
        }
    }

    /// The balance heuristic of a lobe with `density` per steradian.
    #[inline(always)]
    fn balance(&self, cx: &mut A, density: A::Real) -> A::Real {
        let density = cx.scale(density, PI);
        LightStage::<1>::balance(cx, density, self.lamp)
    }
}

/// A table by surface: its `value`, or `other` if it has none.
fn by_surface<T: Copy>(
    surfaces: &[&Surface],
    other: T,
    value: impl Fn(&Scatter) -> Option<T>,
) -> Vec<T> {
    let row = |surface: &&Surface| value(&surface.scatter).unwrap_or(other);
    surfaces.iter().map(row).collect()
}
