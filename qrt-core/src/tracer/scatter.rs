//! Scattering: from a hit to the next ray of the path and its weight `W = f(i, o) |n.i| J`.
//!
//! All directions of a depth are computed for the materials that the scene has, and for no
//! others; each path then selects its own.

use super::microfacet;
use super::phong::PhongStage;
use super::sampled::{Angles, Compiled};
use super::vector::{self, Vector};
use super::{Arith, Axis, Coordinate, Part, Sampled};
use crate::expr::{Expr, Variable};
use crate::sampling::maps;
use crate::scene::{Map, Rgb};
use crate::valid::bsdf::weight_bound;
use crate::valid::{CustomBsdf, Scatter, Surface};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// A run of consecutive surfaces of one kind.
pub(crate) type Kind = Range<u32>;

/// What scatters towards one depth's ray, made ready.
#[derive(Clone, Debug)]
pub(crate) struct ScatterStage<const C: usize> {
    depth: usize,
    bits: [u32; 2],
    /// `phi` and `J |phi_z| / pi` of the depth's own map: the cosine map under `auto`.
    map: Compiled,
    /// The greatest `J |phi_z| / pi` of that map.
    factor_bound: f64,
    channels: [usize; C],
    /// Does the depth's map replace the materials' own?
    replaces: bool,
    azimuth: [Sampled; 2],
    lambertian: Kind,
    mirror: Kind,
    dielectric: Kind,
    ggx: Kind,
    /// By surface: albedo or reflectance of the channels; black elsewhere.
    tint: Vec<[f64; C]>,
    /// By surface: `1 / ior`, `ior` of a dielectric.
    refraction: Vec<[f64; 2]>,
    /// By surface: `alpha` of a GGX.
    roughness: Vec<[f64; 1]>,
    /// The least of them.
    least_alpha: f64,
    phong: Vec<(u32, PhongStage<C>)>,
    custom: Vec<(u32, CustomStage)>,
    /// Does any surface ask for the viewer's direction in the local frame?
    local: bool,
    /// Does any surface take its direction from `map`?
    uses_map: bool,
}

/// A custom BSDF, made ready for one depth.
#[derive(Clone, Debug)]
struct CustomStage {
    /// `phi`, unless the depth's map replaces it.
    direction: Option<Compiled>,
    /// Weights of the channels.
    weight: Compiled,
    /// The greatest weight, in red, green and blue.
    bound: Rgb,
}

/// Where a path stands when it scatters.
pub(crate) struct Vertex<A: Arith> {
    /// The direction in which the path arrived.
    pub(crate) arriving: Vector<A>,
    pub(crate) tangent: Vector<A>,
    pub(crate) bitangent: Vector<A>,
    pub(crate) normal: Vector<A>,
    /// `arriving.normal`
    pub(crate) slope: A::Real,
    /// Does the viewer see the front?
    pub(crate) front: A::Bool,
    pub(crate) surface: A::Index,
    /// The paths still wanted.
    pub(crate) alive: A::Bool,
}

/// A sampled direction, in the scene's frame, and its weight per channel.
pub(crate) struct Scattered<A: Arith, const C: usize> {
    pub(crate) direction: Vector<A>,
    pub(crate) weight: [A::Real; C],
}

/// Kinds in the order in which surfaces are sorted.
pub(crate) fn rank(scatter: &Scatter) -> u32 {
    match scatter {
        Scatter::Black => 0,
        Scatter::Lambertian { .. } => 1,
        Scatter::Mirror { .. } => 2,
        Scatter::Dielectric { .. } => 3,
        Scatter::Ggx { .. } => 4,
        Scatter::Phong { .. } => 5,
        Scatter::Custom(_) => 6,
    }
}

impl<const C: usize> ScatterStage<C> {
    /// `surfaces` are grouped by kind; the new ray is that of `depth`.
    pub(crate) fn new(
        surfaces: &[&Surface],
        channels: [usize; C],
        depth: usize,
        bits: [u32; 2],
        map: Map,
    ) -> Self {
        let pick = |rgb: Rgb| channels.map(|channel| rgb[channel]);
        let run = |kind: u32| {
            let is = |surface: &&Surface| rank(&surface.scatter) == kind;
            let start = surfaces.iter().position(is).unwrap_or(0);
            let count = surfaces.iter().copied().filter(is).count();
            start as u32..(start + count) as u32
        };
        let replaces = map != Map::Auto;
        let builtin = maps::builtin(map);
        let projected = maps::projected_jacobian(&builtin);
        let own = Compiled::new(
            &[&builtin[0], &builtin[1], &builtin[2], &over_pi(&projected)],
            bits,
            None,
        );
        let mut phong = Vec::new();
        let mut custom = Vec::new();
        for (number, surface) in surfaces.iter().enumerate() {
            match &surface.scatter {
                Scatter::Phong {
                    diffuse,
                    specular,
                    exponent,
                } => phong.push((
                    number as u32,
                    PhongStage::new(*diffuse, *specular, *exponent, channels, bits[0]),
                )),
                Scatter::Custom(bsdf) => {
                    // A value written in `u` and `v` has a meaning under its own map alone.
                    let bound_to_map = bsdf.value.iter().any(asks_for_square);
                    let replaced = replaces && !bound_to_map;
                    let replacement = replaced.then_some((&builtin, &projected));
                    custom.push((
                        number as u32,
                        CustomStage::new(bsdf, replacement, channels, bits),
                    ));
                }
                _ => {}
            }
        }
        let ggx = run(4);
        let local = !ggx.is_empty() || !phong.is_empty() || !custom.is_empty();
        let maps_of_their_own = !replaces && phong.iter().all(|(_, phong)| phong.has_map());
        let uses_map = !run(1).is_empty() || (local && !maps_of_their_own);
        Self {
            depth,
            bits,
            map: own,
            factor_bound: if map == Map::UniformHemisphere {
                2.0
            } else {
                1.0
            },
            channels,
            replaces,
            azimuth: [
                Sampled::of_centre(bits[1], |v| libm::cos(TAU * v)),
                Sampled::of_centre(bits[1], |v| libm::sin(TAU * v)),
            ],
            lambertian: run(1),
            mirror: run(2),
            dielectric: run(3),
            ggx,
            tint: surfaces
                .iter()
                .map(|surface| pick(tint(&surface.scatter)))
                .collect(),
            refraction: surfaces
                .iter()
                .map(|surface| match surface.scatter {
                    Scatter::Dielectric { ior } => [1.0 / ior, ior],
                    _ => [1.0, 1.0],
                })
                .collect(),
            roughness: surfaces
                .iter()
                .map(|surface| match surface.scatter {
                    Scatter::Ggx { alpha, .. } => [alpha],
                    _ => [1.0],
                })
                .collect(),
            least_alpha: surfaces
                .iter()
                .filter_map(|surface| match surface.scatter {
                    Scatter::Ggx { alpha, .. } => Some(alpha),
                    _ => None,
                })
                .fold(1.0, f64::min),
            phong,
            custom,
            local,
            uses_map,
        }
    }

    /// The greatest weight of surface `number` in channel `c` towards this depth.
    pub(crate) fn weight_bound(&self, surfaces: &[&Surface], number: u32, c: usize) -> f64 {
        let tint = self.tint[number as usize][c];
        match &surfaces[number as usize].scatter {
            Scatter::Black => 0.0,
            Scatter::Lambertian { .. } => tint * self.factor_bound,
            Scatter::Dielectric { ior } => (ior * ior).max(1.0 / (ior * ior)),
            Scatter::Ggx { alpha, .. } if self.replaces => {
                // pi f: D is at most 1 / (pi alpha^2), and the masking's denominator at least
                // alpha^2; both at once at grazing angles.
                tint * self.factor_bound / alpha.powi(4)
            }
            Scatter::Mirror { .. } | Scatter::Ggx { .. } => tint,
            Scatter::Phong { .. } => self
                .phong
                .iter()
                .filter(|(surface, _)| *surface == number)
                .map(|(_, phong)| {
                    if self.replaces || !phong.has_map() {
                        PI * phong.value_bound()[c] * self.factor_bound
                    } else {
                        phong.bound()[c]
                    }
                })
                .fold(0.0, f64::max),
            Scatter::Custom(_) => self
                .custom
                .iter()
                .filter(|(surface, _)| *surface == number)
                .map(|(_, custom)| custom.bound[self.channels[c]])
                .fold(0.0, f64::max),
        }
    }

    /// The next direction and weight of every path that scatters; anything for the others.
    #[inline(always)]
    pub(crate) fn scatter<A: Arith>(&self, cx: &mut A, at: &Vertex<A>) -> Scattered<A, C> {
        let mut chosen: Option<Scattered<A, C>> = None;
        let tint = cx.rows(&self.tint, at.surface);
        let mapped = if self.uses_map {
            // Asked for here, so that they belong to the ray and not to this part of it alone.
            for axis in [Axis::U, Axis::V] {
                let depth = self.depth;
                let _ = cx.coordinate(Coordinate { depth, axis });
            }
            cx.enter(Part::Sample);
            let [x, y, z, factor] = self.map.evaluate(cx, self.depth, None);
            cx.leave();
            Some(([x, y, z], factor))
        } else {
            None
        };
        if let (Some((incoming, factor)), Some(mask)) = (mapped, members(cx, at, &self.lambertian))
        {
            let direction = to_scene(cx, at, &incoming);
            let weight = match self.map.constant(3) {
                Some(1.0) => tint,
                _ => vector::scale(cx, &tint, factor),
            };
            choose(cx, &mut chosen, mask, Scattered { direction, weight });
        }
        if let Some(mask) = members(cx, at, &self.mirror) {
            let mirrored = vector::mirror(cx, &at.arriving, &at.normal);
            let direction = vector::neg(cx, &mirrored);
            let direction = unit(cx, &direction);
            choose(
                cx,
                &mut chosen,
                mask,
                Scattered {
                    direction,
                    weight: tint,
                },
            );
        }
        if let Some(mask) = members(cx, at, &self.dielectric) {
            let scattered = self.dielectric(cx, at);
            choose(cx, &mut chosen, mask, scattered);
        }
        if !self.local {
            return chosen.unwrap_or_else(|| nothing(cx, at));
        }
        let local = LocalFrame::new(cx, at);
        if let Some(mask) = members(cx, at, &self.ggx) {
            let (incoming, value) = self.ggx(cx, at, &local, mapped);
            let weight = vector::scale(cx, &tint, value);
            let direction = to_scene(cx, at, &incoming);
            choose(cx, &mut chosen, mask, Scattered { direction, weight });
        }
        for (surface, phong) in &self.phong {
            if let Some(mask) = members(cx, at, &(*surface..surface + 1)) {
                let (incoming, weight) = self.phong(cx, phong, &local, mapped);
                let direction = to_scene(cx, at, &incoming);
                choose(cx, &mut chosen, mask, Scattered { direction, weight });
            }
        }
        for (surface, custom) in &self.custom {
            if let Some(mask) = members(cx, at, &(*surface..surface + 1)) {
                let incoming = match (&custom.direction, mapped) {
                    (Some(own), _) => own.evaluate(cx, self.depth, None),
                    (None, Some((incoming, _))) => incoming,
                    (None, None) => at.normal,
                };
                let angles = Angles {
                    cos_o: local.outgoing[2],
                    cos_a: local.cos_a(cx, &incoming),
                };
                let weight = custom.weight.evaluate(cx, self.depth, Some(angles));
                let direction = to_scene(cx, at, &incoming);
                choose(cx, &mut chosen, mask, Scattered { direction, weight });
            }
        }
        chosen.unwrap_or_else(|| nothing(cx, at))
    }

    #[inline(always)]
    fn azimuth<A: Arith>(&self, cx: &mut A) -> [A::Real; 2] {
        let v = cx.coordinate(Coordinate {
            depth: self.depth,
            axis: Axis::V,
        });
        [
            cx.sampled(&self.azimuth[0], v),
            cx.sampled(&self.azimuth[1], v),
        ]
    }

    /// Smooth glass: `u` below the Fresnel reflectance reflects, else the ray is refracted and
    /// its radiance scaled by the squared ratio of the indices.
    #[inline(always)]
    fn dielectric<A: Arith>(&self, cx: &mut A, at: &Vertex<A>) -> Scattered<A, C> {
        let (zero, one) = (cx.real(0.0), cx.real(1.0));
        let [entering, leaving] = cx.rows(&self.refraction, at.surface);
        // n_o / n_t, from the viewer's side to the other.
        let eta = cx.select(at.front, entering, leaving);
        let cos_o = cx.abs(at.slope);
        let square = cx.mul(cos_o, cos_o);
        let sin_squared = cx.sub(one, square);
        let eta_squared = cx.mul(eta, eta);
        let bent = cx.mul(eta_squared, sin_squared);
        let rest = cx.sub(one, bent);
        let total = cx.less_equal(rest, zero);
        let rest = cx.max(rest, zero);
        let cos_t = cx.sqrt(rest);
        let reflectance = fresnel(cx, eta, cos_o, cos_t);
        let u = cx.coordinate(Coordinate {
            depth: self.depth,
            axis: Axis::U,
        });
        let u = cx.centre(u, self.bits[0]);
        let below = cx.less(u, reflectance);
        let reflects = cx.or(total, below);
        // Mirrored: d - 2 (d.n) n. Refracted: eta d + (eta cos_o - cos_t) n on the viewer's side.
        let twice = cx.add(at.slope, at.slope);
        let mirrored = cx.neg(twice);
        let push = cx.mul(eta, cos_o);
        let push = cx.sub(push, cos_t);
        let other = cx.neg(push);
        let refracted = cx.select(at.front, push, other);
        let along = cx.select(reflects, one, eta);
        let across = cx.select(reflects, mirrored, refracted);
        let forward = vector::scale(cx, &at.arriving, along);
        let sideways = vector::scale(cx, &at.normal, across);
        let direction = vector::add(cx, &forward, &sideways);
        let direction = unit(cx, &direction);
        let weight = cx.select(reflects, one, eta_squared);
        Scattered {
            direction,
            weight: [weight; C],
        }
    }

    #[inline(always)]
    fn ggx<A: Arith>(
        &self,
        cx: &mut A,
        at: &Vertex<A>,
        local: &LocalFrame<A>,
        mapped: Option<(Vector<A>, A::Real)>,
    ) -> (Vector<A>, A::Real) {
        let [alpha] = cx.rows(&self.roughness, at.surface);
        if let (true, Some((incoming, factor))) = (self.replaces, mapped) {
            let value = microfacet::value(cx, alpha, &local.outgoing, &incoming, self.least_alpha);
            let value = cx.scale(value, PI);
            (incoming, cx.mul(value, factor))
        } else {
            let u = cx.coordinate(Coordinate {
                depth: self.depth,
                axis: Axis::U,
            });
            let u = cx.centre(u, self.bits[0]);
            let azimuth = self.azimuth(cx);
            microfacet::sample(cx, alpha, &local.outgoing, u, azimuth, self.least_alpha)
        }
    }

    #[inline(always)]
    fn phong<A: Arith>(
        &self,
        cx: &mut A,
        phong: &PhongStage<C>,
        local: &LocalFrame<A>,
        mapped: Option<(Vector<A>, A::Real)>,
    ) -> (Vector<A>, [A::Real; C]) {
        if let (true, Some((incoming, factor))) = (self.replaces || !phong.has_map(), mapped) {
            let cos_a = local.cos_a(cx, &incoming);
            let value = phong.value(cx, cos_a);
            let factor = cx.scale(factor, PI);
            (incoming, vector::scale(cx, &value, factor))
        } else {
            let u = cx.coordinate(Coordinate {
                depth: self.depth,
                axis: Axis::U,
            });
            let azimuth = self.azimuth(cx);
            phong.sample(cx, &local.outgoing, u, azimuth)
        }
    }
}

impl CustomStage {
    fn new<const C: usize>(
        bsdf: &CustomBsdf,
        replacement: Option<(&[Expr; 3], &Expr)>,
        channels: [usize; C],
        bits: [u32; 2],
    ) -> Self {
        let own = (&bsdf.map, &bsdf.projected_jacobian);
        let (map, projected) = replacement.unwrap_or(own);
        let bound = match replacement {
            Some((map, projected)) => weight_bound(map, projected, &bsdf.value),
            None => bsdf.weight_bound,
        };
        let weights = channels.map(|channel| (&bsdf.value[channel] * projected).simplify());
        let weights: Vec<&Expr> = weights.iter().collect();
        Self {
            direction: replacement
                .is_none()
                .then(|| Compiled::new(&[&map[0], &map[1], &map[2]], bits, None)),
            weight: Compiled::new(&weights, bits, Some(&map[2])),
            bound,
        }
    }
}

/// The viewer's direction in the frame whose z axis is the normal on the viewer's side.
struct LocalFrame<A: Arith> {
    outgoing: Vector<A>,
}

impl<A: Arith> LocalFrame<A> {
    #[inline(always)]
    fn new(cx: &mut A, at: &Vertex<A>) -> Self {
        let x = vector::dot(cx, &at.arriving, &at.tangent);
        let y = vector::dot(cx, &at.arriving, &at.bitangent);
        let z = cx.abs(at.slope);
        Self {
            outgoing: [cx.neg(x), cx.neg(y), z],
        }
    }

    /// `incoming.mirror(outgoing)`
    #[inline(always)]
    fn cos_a(&self, cx: &mut A, incoming: &Vector<A>) -> A::Real {
        let x = cx.mul(incoming[0], self.outgoing[0]);
        let y = cx.mul(incoming[1], self.outgoing[1]);
        let z = cx.mul(incoming[2], self.outgoing[2]);
        let across = cx.add(x, y);
        cx.sub(z, across)
    }
}

/// Does the value depend on the sample's place in the unit square?
fn asks_for_square(value: &Expr) -> bool {
    let variables = value.variables(value.root());
    variables.contains(Variable::U) || variables.contains(Variable::V)
}

fn over_pi(projected: &Expr) -> Expr {
    match Expr::number(PI) {
        Some(pi) => (projected / &pi).simplify(),
        None => projected.clone(),
    }
}

fn tint(scatter: &Scatter) -> Rgb {
    match scatter {
        Scatter::Lambertian { albedo: tint }
        | Scatter::Mirror { reflectance: tint }
        | Scatter::Ggx {
            reflectance: tint, ..
        } => *tint,
        _ => [0.0; 3],
    }
}

/// Unpolarised Fresnel reflectance from the indices' ratio and both cosines.
#[inline(always)]
pub(crate) fn fresnel<A: Arith>(
    cx: &mut A,
    eta: A::Real,
    cos_o: A::Real,
    cos_t: A::Real,
) -> A::Real {
    let a = cx.mul(eta, cos_o);
    let b = cx.mul(eta, cos_t);
    let top = cx.sub(a, cos_t);
    let bottom = cx.add(a, cos_t);
    let across = cx.div(top, bottom, 1.0);
    let top = cx.sub(b, cos_o);
    let bottom = cx.add(b, cos_o);
    let along = cx.div(top, bottom, 1.0);
    let across = cx.mul(across, across);
    let along = cx.mul(along, along);
    let sum = cx.add(across, along);
    cx.scale(sum, 0.5)
}

/// The paths on a surface of this kind, if there may be any.
#[inline(always)]
pub(crate) fn members<A: Arith>(cx: &mut A, at: &Vertex<A>, kind: &Kind) -> Option<A::Bool> {
    if kind.is_empty() {
        return None;
    }
    let mut mask = cx.below(at.surface, kind.end);
    if kind.start > 0 {
        let before = cx.below(at.surface, kind.start);
        let from = cx.not(before);
        mask = cx.and(mask, from);
    }
    let wanted = cx.and(mask, at.alive);
    cx.possible(wanted).then_some(mask)
}

/// Takes `new` where `mask` holds. The first candidate needs no choice.
#[inline(always)]
fn choose<A: Arith, const C: usize>(
    cx: &mut A,
    chosen: &mut Option<Scattered<A, C>>,
    mask: A::Bool,
    new: Scattered<A, C>,
) {
    *chosen = Some(match chosen.take() {
        None => new,
        Some(old) => Scattered {
            direction: vector::select(cx, mask, &new.direction, &old.direction),
            weight: vector::select(cx, mask, &new.weight, &old.weight),
        },
    });
}

#[inline(always)]
fn nothing<A: Arith, const C: usize>(cx: &mut A, at: &Vertex<A>) -> Scattered<A, C> {
    let zero = cx.real(0.0);
    Scattered {
        direction: at.arriving,
        weight: [zero; C],
    }
}

/// From the local frame to the scene's: `x T + y B + z N` on the viewer's side.
#[inline(always)]
fn to_scene<A: Arith>(cx: &mut A, at: &Vertex<A>, local: &Vector<A>) -> Vector<A> {
    let under = cx.neg(local[2]);
    let height = cx.select(at.front, local[2], under);
    let local = [local[0], local[1], height];
    [
        along(cx, at, &local, 0),
        along(cx, at, &local, 1),
        along(cx, at, &local, 2),
    ]
}

/// One component of `x T + y B + h N`.
#[inline(always)]
fn along<A: Arith>(cx: &mut A, at: &Vertex<A>, local: &Vector<A>, axis: usize) -> A::Real {
    cx.enter(Part::Component(axis));
    let x = cx.mul(at.tangent[axis], local[0]);
    let y = cx.mul(at.bitangent[axis], local[1]);
    let z = cx.mul(at.normal[axis], local[2]);
    let flat = cx.add(x, y);
    let sum = cx.add(flat, z);
    let sum = cx.known(sum, -1.0, 1.0);
    cx.leave();
    sum
}

/// A direction of unit length, up to rounding.
#[inline(always)]
fn unit<A: Arith>(cx: &mut A, a: &Vector<A>) -> Vector<A> {
    [
        cx.known(a[0], -1.0, 1.0),
        cx.known(a[1], -1.0, 1.0),
        cx.known(a[2], -1.0, 1.0),
    ]
}
