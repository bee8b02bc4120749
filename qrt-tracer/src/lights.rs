//! Light sampling: at a vertex the path index also selects a point on a lamp.
//!
//! Let `x` be the vertex, `y` the point, `d = y - x`, `r = |d|`, `n` the surface's normal on the
//! viewer's side, `m` the lamp's, `q = max(0, n.d) max(0, -m.d)`, and `1 / A` the density of points
//! per area, including the probability of the lamp. A ray of the surface's own sampling has the
//! density `p` per steradian, which is `p (-m.d) / r^3` per area of the lamp. The balance heuristic
//! weights each way to find the light by its density over the sum of densities. It gives
//!
//! ```text
//! to the ray that meets the lamp:   F = p A c_m / (r^2 + p A c_m),    c_m = -m.d / r
//! to the point on the lamp:         1 - F, of W Le F / (1 - F): so W Le F again,
//! ```
//!
//! where `W = f |n.i| / p` is the weight that the surface's own sampling has in that direction. For
//! a Lambertian under the cosine map, `p = n.d / (pi r)` and `W` is the albedo: neither a square root
//! nor an angle is needed,
//!
//! ```text
//! mis          F = A q / (pi r^4 + A q)      below 1, and what a ray of its own that meets y counts
//! next-event   G = A q / (pi r^4)            and rays of its own that meet a lamp count nothing
//! ```
//!
//! A sun is a lamp at a distance of its own: see [`super::sun`].
//!
//! (Veach & Guibas 1995; Shirley, Wang & Zimmerman 1996.)

use super::geometry::StageGeometry;
use super::lamp_shapes::{DiscLamps, Shape, SphereLamps};
use super::places::Places;
use super::radiance::in_units;
use super::smooth::SmoothStage;
use super::sun::{DISTANCE, clean};
use super::vector::{self, Vector};
use super::{Arith, Coordinate, Sampled};
use glam::DVec3;
use qrt_scene::lights::{self, Cone, Lamp, LitFace, Reached};
use qrt_scene::valid::Surface;
use qrt_scene::valid::lights::MOST_PAIRS;
use qrt_scene::{Lights, Rgb};
use std::f64::consts::{FRAC_1_PI, PI};
use std::ops::Range;

/// The distance in stage units below which `r^4` has too few bits. If a lamp can be nearer, cosines
/// and distance are divided one after the other.
const NEAR: f64 = 0.3;

/// Fraction by which the bound of a sun's factor exceeds the greatest, which circuits may round up.
const SLACK: f64 = 1.0 / 64.0;

/// The lamps of a scene and the light that they send to surfaces, for all depths.
#[derive(Clone, Debug)]
pub(super) struct Lamps {
    shapes: Vec<Shape>,
    /// By lamp except the sun: its face.
    faces: Vec<u32>,
    /// By lamp: its power.
    powers: Vec<f64>,
    /// By surface and lamp.
    reached: Vec<Vec<Reached>>,
    /// By lamp and place: a bound of `q / r^4`.
    forms: Vec<Vec<f64>>,
}

impl Lamps {
    /// Collects the lamps. `surface_of` contains the surface of each face, in the order of `surfaces`. Surfaces for
    /// which `may_sample` is false sample lamps at no depth.
    /// The sun is the last lamp. None if nothing emits, or if an emitter's shape cannot be sampled; a scene
    /// that samples lamps has no emitter of that kind.
    pub(super) fn new(
        (geometry, smooth): (&StageGeometry, Option<&SmoothStage>),
        (surfaces, may_sample): (&[&Surface], impl Fn(&Surface) -> bool + Sync),
        surface_of: &[u32],
        places: &Places,
        sun: Option<&(Cone, Rgb)>,
    ) -> Option<Self> {
        let (mut shapes, mut faces, mut powers) = (vec![], vec![], vec![]);
        // Numbered as the geometry numbers its emitting faces.
        let polygons = geometry.faces.iter().filter(|face| face.emits);
        let polygons = polygons.map(|face| {
            let corners = &geometry.corners[face.label as usize];
            let lamp = match (corners, &face.disc) {
                (&[a, b, c, d], Some(_)) => Lamp::disc([a, b, c, d]),
                _ => Lamp::new(corners)?,
            };
            Some((face.label, Shape::Flat(lamp)))
        });
        let balls = geometry.balls.iter().filter(|ball| ball.emitter.is_some());
        let balls = balls.map(|ball| Some((ball.label, Shape::Round(*ball))));
        for lamp in polygons.chain(balls) {
            let (label, shape) = lamp?;
            let radiance = surfaces[surface_of[label as usize] as usize].radiance;
            powers.push(shape.area() * radiance.iter().sum::<f64>());
            shapes.push(shape);
            faces.push(label);
        }
        if let Some((cone, radiance)) = sun {
            // Over pi, as those of the other lamps: the power that arrives at the sphere around the scene.
            let lit = PI * (cone.sin * geometry.radius()).powi(2);
            powers.push(lit * radiance.iter().sum::<f64>());
            shapes.push(Shape::Far(*cone));
        }
        if shapes.is_empty() {
            return None;
        }
        let few = (geometry.faces.len() + geometry.balls.len()) * shapes.len() <= MOST_PAIRS;
        let labels = || {
            let polygons = geometry.faces.iter().map(|face| face.label);
            polygons.chain(geometry.balls.iter().map(|ball| ball.label))
        };
        let is_smooth = |label: u32| smooth.is_some_and(|smooth| smooth.is_smooth(label));
        let face_of = |label: u32| {
            if let Some(outline) = geometry.corners.get(label as usize) {
                let is_smooth = is_smooth(label);
                return LitFace::Polygon { outline, is_smooth };
            }
            let ball = &geometry.balls[label as usize - geometry.corners.len()];
            LitFace::Sphere {
                centre: ball.centre,
                radius: ball.radius,
            }
        };
        let reached = |surface: usize| {
            let all = |lamp: &u32| {
                let mine = labels().filter(|&label| surface_of[label as usize] as usize == surface);
                if few && surfaces[surface].samples_lights() {
                    lights::strongest_of(mine.map(face_of), face_of(*lamp), NEAR)
                } else {
                    Reached::UNBOUNDED
                }
            };
            faces.iter().map(all).collect()
        };
        let mut reached: Vec<Vec<Reached>> = lights::on_all_cores(surfaces.len(), 1, reached);
        let by_surface = |surface: u32, lamp: usize| {
            let surface = surface as usize;
            may_sample(surfaces[surface]).then(|| reached[surface][lamp].form)
        };
        let mut forms = places.lit_by(geometry, &faces, is_smooth, by_surface);
        if let Some((cone, _)) = sun {
            // Spheres and smooth faces have all normals.
            let of_side = |face: usize, side: f64| {
                let is_flat = face < geometry.corners.len() && !is_smooth(face as u32);
                let normal = if is_flat {
                    geometry.normal(face) * side
                } else {
                    cone.axis
                };
                far_form(cone, normal)
            };
            let mut by_surface = vec![0.0; surfaces.len()];
            for label in labels() {
                let most = [1.0, -1.0].map(|side| of_side(label as usize, side));
                let form: &mut f64 = &mut by_surface[surface_of[label as usize] as usize];
                *form = form.max(most[0]).max(most[1]);
            }
            forms.push(places.by_side(of_side, |surface| by_surface[surface as usize]));
            for (reached, form) in reached.iter_mut().zip(by_surface) {
                let is_near = false;
                reached.push(Reached { form, is_near });
            }
        }
        Some(Self {
            shapes,
            faces,
            powers,
            reached,
            forms,
        })
    }
}

/// The parameters of the sampling of lamps for the rays of one depth.
pub(super) struct LightSampling {
    /// The depth of the rays.
    pub(super) depth: usize,
    /// Sample bits of each coordinate.
    pub(super) bits: [u32; 2],
    /// The scene's `sampling.lights`.
    pub(super) mode: Lights,
}

/// The sampling of lamps at the vertices that the rays of one depth leave.
#[derive(Clone, Debug)]
pub(crate) struct LightStage<const C: usize> {
    pub(super) depth: usize,
    bits: [u32; 2],
    /// By column of the first coordinate: the lamp, and the place along its first edge.
    lamp_of: Vec<u32>,
    along: Sampled,
    /// By lamp: corner and edges; centre and two radii of a disc, also of the sun's; centre of a sphere.
    places: Vec<[f64; 9]>,
    /// By lamp: 1 if it is a triangle, else 0.
    triangles: Vec<u32>,
    /// The points of lamps that are discs, and of the sun, if there are any.
    discs: Option<DiscLamps>,
    /// The points of lamps that are spheres, if there are any.
    spheres: Option<SphereLamps>,
    /// By lamp: its normal, and the distance of its plane from the origin along the normal.
    pub(super) normals: Vec<[f64; 4]>,
    /// By lamp: area over probability and pi, times the gain.
    pub(super) areas: Vec<[f64; 1]>,
    /// By lamp: the radiance of its front, over the gain.
    pub(super) radiance: Vec<[f64; C]>,
    /// By lamp except the sun: its surface, and its face.
    surfaces: Vec<u32>,
    faces: Vec<u32>,
    /// The power of two by which the factors of small lamps are computed larger, so that fixed-point
    /// numbers have bits for them. That of the sun is its own, if there are other lamps.
    gain: f64,
    /// By lamp: the inverse of its gain.
    shrinks: Vec<[f64; 1]>,
    far: Option<FarLamp>,
    /// By face: the entry of `areas` if the face is a lamp, else 0.
    area_of_face: Vec<[f64; 1]>,
    pub(super) receivers: Receivers,
    /// By place and lamp: a bound of the factor `F` or `G`.
    factors: Vec<Vec<f64>>,
    /// The greatest of these for surfaces whose own rays do not count, and for the others, times the gain.
    most: [f64; 2],
    /// True if a lamp may be nearer than [`NEAR`].
    near: bool,
}

/// The sampling of a sun: see [`super::sun`].
#[derive(Clone, Debug)]
struct FarLamp {
    /// Its number, the last of all lamps.
    number: u32,
    /// The vector by which a point at the edge is nearer than the sun's centre, along the axis.
    sag: [f64; 3],
    gain: f64,
}

/// The properties of a surface's scattering that the sampling of lamps depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    /// True if the surface scatters.
    pub(crate) scatters: bool,
    /// True if the density of the directions that the surface samples is known.
    pub(crate) samples_lights: bool,
    /// True if the surface is a Lambertian under the cosine map, whose weight is its albedo.
    pub(crate) is_projected: bool,
}

/// The reception of lamps' light, by surface.
#[derive(Clone, Debug)]
pub(super) struct Receivers {
    /// 1 if the surface samples lamps, else 0.
    pub(super) samples: Vec<u32>,
    /// 1 if the surface's own rays that meet a lamp count, weighted; else 0.
    weighs: Vec<u32>,
    /// True if all surfaces that scatter sample lamps.
    all_sample: bool,
    /// The surfaces that weight their own rays, of those that sample lamps: all, none, or some.
    weighing: Weighing,
}

/// The surfaces whose own rays count when they meet a lamp, of those that sample lamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weighing {
    All,
    None,
    Some,
}

impl Receivers {
    /// Arguments are by surface: true if it samples lamps, if it then weights its own rays, and if it
    /// scatters.
    fn new(samples: &[bool], weighs: &[bool], scatters: &[bool]) -> Self {
        let pairs = || samples.iter().zip(weighs).filter(|(samples, _)| **samples);
        let weighing = if pairs().all(|(_, weighs)| *weighs) {
            Weighing::All
        } else if pairs().all(|(_, weighs)| !weighs) {
            Weighing::None
        } else {
            Weighing::Some
        };
        let all_sample = samples
            .iter()
            .zip(scatters)
            .all(|(s, scatters)| *s || !scatters);
        // Entries that are never read equal the others: a table with one value costs nothing.
        Self {
            samples: samples
                .iter()
                .map(|&s| u32::from(s || all_sample))
                .collect(),
            weighs: match weighing {
                Weighing::All => vec![1; weighs.len()],
                Weighing::None => vec![0; weighs.len()],
                Weighing::Some => weighs.iter().map(|&weighs| u32::from(weighs)).collect(),
            },
            all_sample,
            weighing,
        }
    }
}

impl<const C: usize> LightStage<C> {
    /// Prepares the sampling; none if no surface samples a lamp, or if there is no lamp. The
    /// `receivers` are by surface.
    pub(super) fn new(
        (lamps, places): (&Lamps, &Places),
        (radiance, sun): (&[[f64; C]], Option<[f64; C]>),
        surface_of: &[u32],
        receivers: &[Receiver],
        LightSampling { depth, bits, mode }: LightSampling,
    ) -> Option<Self> {
        let columns = lights::columns(&lamps.powers, bits[0])?;
        let all = f64::from(1_u32 << bits[0]);
        let samples: Vec<bool> = receivers.iter().map(|r| r.samples_lights).collect();
        if !samples.contains(&true) {
            return None;
        }
        let lit = lamps.shapes.iter().zip(&columns);
        let areas: Vec<f64> = lit
            .map(|(lamp, &columns)| lamp.area() * all / f64::from(columns) * FRAC_1_PI)
            .collect();
        // The factor of next-event estimation. That of `mis` never exceeds it.
        let next_event = |surface: usize| -> Vec<f64> {
            let pairs = lamps.reached[surface].iter().zip(&areas);
            // A surface that the lamp does not reach has the form 0, and so the factor 0.
            pairs.map(|(reached, area)| reached.form * area).collect()
        };
        let (mut weighs, mut near) = (vec![], false);
        // By lamp: the greatest factor at surfaces whose own rays do not count.
        let mut most = vec![0.0; areas.len()];
        for (surface, &samples) in samples.iter().enumerate() {
            let direct = next_event(surface);
            let greatest = direct.iter().copied().fold(0.0, f64::max);
            let alone = match mode {
                Lights::None | Lights::Mis => false,
                Lights::Auto => greatest <= 1.0,
                Lights::NextEvent => greatest.is_finite(),
            };
            let matte = receivers[surface].is_projected;
            let alone = alone && matte;
            if samples && alone {
                for (most, direct) in most.iter_mut().zip(direct) {
                    *most = f64::max(*most, direct);
                }
            }
            if samples && matte {
                near |= lamps.reached[surface].iter().any(|reached| reached.is_near);
            }
            weighs.push(!alone);
        }
        let factor = |place: usize| -> Vec<f64> {
            let surface = places.surface(place);
            let weighed = |(forms, area): (&Vec<f64>, &f64)| {
                let direct = forms[place] * area;
                if direct == 0.0 {
                    0.0
                } else if !receivers[surface as usize].is_projected {
                    1.0
                } else if !weighs[surface as usize] {
                    direct
                } else if direct.is_finite() {
                    direct / (1.0 + direct)
                } else {
                    1.0
                }
            };
            lamps.forms.iter().zip(&areas).map(weighed).collect()
        };
        let factors: Vec<Vec<f64>> = (0..places.len()).map(factor).collect();
        let samplers = (0..places.len()).filter(|&place| samples[places.surface(place) as usize]);
        let samplers: Vec<usize> = samplers.collect();
        let all_matte = receivers
            .iter()
            .all(|r| !r.samples_lights || r.is_projected);
        // Lamps of the scene share a gain, and the sun has its own.
        let (of_faces, all) = (lamps.faces.len(), areas.len());
        let groups = [0..of_faces, of_faces..all].into_iter();
        let groups: Vec<Range<usize>> = groups.filter(|group| !group.is_empty()).collect();
        let (mut gains, mut weighed) = (Vec::with_capacity(all), 0.0);
        for group in &groups {
            let factors = samplers
                .iter()
                .flat_map(|&place| &factors[place][group.clone()]);
            let greatest = factors.copied().fold(0.0, f64::max);
            let gain = if all_matte { gain(greatest) } else { 1.0 };
            weighed = f64::max(weighed, if gain > 1.0 { greatest * gain } else { 1.0 });
            gains.extend(group.clone().map(|_| gain));
        }
        let alone = most.iter().zip(&gains).map(|(most, gain)| most * gain);
        let most = [alone.fold(0.0, f64::max), weighed];
        let mut lamp_of = Vec::new();
        let mut starts = Vec::new();
        for (lamp, &columns) in (0..).zip(&columns) {
            starts.push(lamp_of.len() as u32);
            lamp_of.extend(std::iter::repeat_n(lamp, columns as usize));
        }
        let has_spheres = lamps
            .shapes
            .iter()
            .any(|shape| matches!(shape, Shape::Round(_)));
        let has_discs = lamps.shapes.iter().any(Shape::is_disc);
        let place = {
            let (lamp_of, columns) = (lamp_of.clone(), columns.clone());
            move |column: u32| {
                let lamp = lamp_of[column as usize] as usize;
                (f64::from(column - starts[lamp]) + 0.5) / f64::from(columns[lamp])
            }
        };
        let gained = areas.iter().zip(&gains).map(|(area, gain)| [area * gain]);
        let areas: Vec<[f64; 1]> = gained.collect();
        let mut area_of_face = vec![[0.0]; surface_of.len()];
        for (&face, &area) in lamps.faces.iter().zip(&areas) {
            area_of_face[face as usize] = area;
        }
        let far = lamps.shapes.last().and_then(|shape| match shape {
            Shape::Far(cone) => Some(FarLamp {
                number: lamps.faces.len() as u32,
                sag: clean(cone.axis * (-cone.cap * DISTANCE)).to_array(),
                gain: gains[lamps.faces.len()],
            }),
            _ => None,
        });
        let surface_of_lamp = lamps.faces.iter().map(|&face| surface_of[face as usize]);
        let surface_of_lamp: Vec<u32> = surface_of_lamp.collect();
        let scatters: Vec<bool> = receivers.iter().map(|r| r.scatters).collect();
        Some(Self {
            depth,
            bits,
            lamp_of: lamp_of.clone(),
            spheres: has_spheres.then(|| SphereLamps::new(&lamps.shapes, bits, place.clone())),
            discs: has_discs.then(|| DiscLamps::new(&lamps.shapes, bits, (lamp_of, place.clone()))),
            along: Sampled::of_index(bits[0], place),
            places: lamps.shapes.iter().map(Shape::place).collect(),
            triangles: lamps.shapes.iter().map(Shape::is_triangle).collect(),
            normals: lamps.shapes.iter().map(Shape::normal).collect(),
            areas,
            radiance: surface_of_lamp
                .iter()
                .map(|&surface| radiance[surface as usize])
                .chain(sun)
                .zip(&gains)
                .map(|(radiance, gain)| radiance.map(|c| c / gain))
                .collect(),
            shrinks: gains.iter().map(|gain| [1.0 / gain]).collect(),
            far,
            surfaces: surface_of_lamp,
            faces: lamps.faces.clone(),
            area_of_face,
            receivers: Receivers::new(&samples, &weighs, &scatters),
            factors,
            gain: gains[0],
            most,
            near,
        })
    }

    /// Converts radiance to `units`.
    pub(super) fn in_units(&mut self, units: [f64; C]) {
        in_units(&mut self.radiance, units);
    }

    /// An upper bound of the factor for the emission of `other` on a ray of this depth from `place`.
    /// `samples` is true if the surface of `place` samples lamps.
    pub(super) fn emission_bound(
        &self,
        places: &Places,
        [place, other]: [usize; 2],
        samples: bool,
    ) -> f64 {
        if !samples {
            return 1.0;
        }
        if self.receivers.weighs[places.surface(place) as usize] == 0 {
            return 0.0;
        }
        let lamps = self.faces.iter().zip(&self.surfaces);
        let lamps = lamps.zip(&self.factors[place]);
        let mine = lamps.filter(|((face, surface), _)| places.holds(other, (**face, **surface)));
        mine.map(|(_, &factor)| factor).fold(0.0, f64::max)
    }

    /// An upper bound of the factor for the light of the sun on a ray of this depth from `place`. `samples` is as
    /// in [`LightStage::emission_bound`].
    pub(super) fn sun_bound(&self, places: &Places, place: usize, samples: bool) -> f64 {
        match &self.far {
            Some(_) if samples && self.receivers.weighs[places.surface(place) as usize] == 0 => 0.0,
            Some(far) if samples => self.factors[place][far.number as usize],
            _ => 1.0,
        }
    }

    /// An upper bound of the light that a lamp adds at a place, without the weight there.
    pub(super) fn light_bound(&self, place: usize, samples: bool) -> [f64; C] {
        let mut bound = [0.0; C];
        if samples {
            let lamps = self.radiance.iter().zip(&self.factors[place]);
            for ((radiance, factor), [shrink]) in lamps.zip(&self.shrinks) {
                for (bound, radiance) in bound.iter_mut().zip(radiance) {
                    *bound = f64::max(*bound, radiance / shrink * factor);
                }
            }
        }
        bound
    }

    /// True if the emission that rays of this depth meet counts anywhere.
    pub(super) fn rays_count(&self) -> bool {
        !(self.receivers.all_sample && self.receivers.weighing == Weighing::None)
    }

    /// True if the density with which a ray of this depth was sampled is needed.
    pub(super) fn asks_for_densities(&self) -> bool {
        self.receivers.weighing != Weighing::None
    }

    /// The point on a lamp, seen from `origin`.
    #[inline(always)]
    pub(super) fn point<A: Arith>(&self, cx: &mut A, origin: &Vector<A>) -> Point<A> {
        let u = cx.coordinate(Coordinate::light_u(self.depth));
        let v = cx.coordinate(Coordinate::light_v(self.depth));
        let lamp = if self.places.len() == 1 {
            cx.index(0)
        } else {
            cx.entry(&self.lamp_of, u)
        };
        let along = cx.sampled(&self.along, u);
        let mut first = along;
        let mut second = cx.centre(v, self.bits[1]);
        if self.triangles.contains(&1) {
            let triangle = cx.entry(&self.triangles, lamp);
            let triangle = cx.is(triangle, 1);
            let beyond = math!(cx, triangle && 1.0 < first + second);
            first = math!(cx, select(beyond, 1.0 - first, first));
            second = math!(cx, select(beyond, 1.0 - second, second));
        }
        if let Some(discs) = &self.discs {
            [first, second] = discs.place(cx, [u, v], lamp, [first, second]);
        }
        let [x, y, z, ax, ay, az, bx, by, bz] = cx.rows(&self.places, lamp);
        let mut point = vector!(cx, [x, y, z] + [ax, ay, az] * first + [bx, by, bz] * second);
        let mut from = *origin;
        if let Some(far) = &self.far {
            // All vertices see the sun in the same directions.
            let is = cx.is(lamp, far.number);
            let zero = cx.real(0.0);
            let along = cx.select(is, along, zero);
            point = vector!(cx, point + constant(far.sag) * along);
            from = vector::select(cx, is, &[zero; 3], &from);
        }
        let mut normal = None;
        if let Some(spheres) = &self.spheres {
            let round = spheres.point(cx, [u, v], lamp);
            let [radius] = cx.rows(&spheres.radii, lamp);
            let own = vector!(cx, [x, y, z] + round.1 * radius);
            point = vector::select(cx, round.0, &own, &point);
            normal = Some(round);
        }
        Point {
            lamp,
            to: vector!(cx, point - from),
            normal,
        }
    }

    /// The square of the length of the vector `to` from a vertex to a point on a lamp.
    #[inline(always)]
    pub(super) fn square<A: Arith>(&self, cx: &mut A, to: &Vector<A>) -> A::Real {
        if self.far.is_some() && self.places.len() == 1 {
            return cx.real(DISTANCE * DISTANCE);
        }
        math!(cx, dot(*to, *to))
    }

    /// `F` of a Lambertian under the cosine map, or `G` if its own rays do not count; times the gain.
    #[inline(always)]
    pub(super) fn projected<A: Arith>(
        &self,
        cx: &mut A,
        surface: A::Index,
        towards: &Towards<A>,
    ) -> A::Real {
        let Towards {
            both,
            square,
            lamp,
            area,
            ..
        } = *towards;
        let (share, beside) = if self.near {
            // The product of both cosines.
            let cosines = math!(cx, div(both, square, 1.0));
            (math!(cx, cosines * area), square)
        } else {
            (math!(cx, both * area), math!(cx, square * square))
        };
        let [alone, weighed] = self.most;
        if self.receivers.weighing == Weighing::None {
            return math!(cx, div(share, beside, alone));
        }
        let own = match &self.far {
            Some(far) if far.gain != self.gain => {
                let [shrink] = cx.rows(&self.shrinks, lamp);
                math!(cx, share * shrink)
            }
            _ => self.without_gain(cx, share),
        };
        if self.receivers.weighing == Weighing::All {
            return math!(cx, div(share, beside + own, weighed));
        }
        let weighs = cx.entry(&self.receivers.weighs, surface);
        let weighs = cx.is(weighs, 1);
        let most = alone.max(weighed);
        math!(cx, div(share, beside + select(weighs, own, 0.0), most))
    }

    /// A number that was computed with the gain, without it.
    #[inline(always)]
    fn without_gain<A: Arith>(&self, cx: &mut A, value: A::Real) -> A::Real {
        if self.gain > 1.0 {
            let shrunk = cx.real(1.0 / self.gain);
            math!(cx, value * shrunk)
        } else {
            value
        }
    }

    /// `F` of a direction to a point of a lamp. `density` is that of the surface's own sampling in
    /// this direction, in units of `1 / pi` per steradian. `area` is as in [`Towards`], `cos` is the
    /// cosine at the lamp, and `square` is the square of the distance.
    #[inline(always)]
    pub(super) fn balance<A: Arith>(
        cx: &mut A,
        density: A::Real,
        [area, cos, square]: [A::Real; 3],
    ) -> A::Real {
        let share = math!(cx, density * (area * cos));
        math!(cx, div(share, square + share, 1.0))
    }

    /// The departure of a path from a vertex on `surface` to its next vertex.
    #[inline(always)]
    pub(super) fn departed<A: Arith>(
        &self,
        cx: &mut A,
        surface: A::Index,
        density: A::Real,
    ) -> Departure<A> {
        let samples = cx.entry(&self.receivers.samples, surface);
        let weighs = cx.entry(&self.receivers.weighs, surface);
        Departure {
            samples: cx.is(samples, 1),
            weighs: cx.is(weighs, 1),
            density,
        }
    }

    /// The power of two that [`LightStage::emission`] is larger by.
    pub(super) fn gain(&self) -> f64 {
        self.gain
    }

    /// The factor by which the emission that a ray meets counts, times the gain: the gain if no lamp was
    /// sampled.
    #[inline(always)]
    pub(super) fn emission<A: Arith>(
        &self,
        cx: &mut A,
        departure: &Departure<A>,
        face: A::Index,
        distance: A::Real,
        cos_theta: A::Real,
    ) -> A::Real {
        let [area] = cx.rows(&self.area_of_face, face);
        self.emission_of(cx, departure, area, distance, cos_theta)
    }

    /// The same factor, for a lamp with this `area` over probability and pi, times the gain.
    #[inline(always)]
    pub(super) fn emission_of<A: Arith>(
        &self,
        cx: &mut A,
        departure: &Departure<A>,
        area: A::Real,
        distance: A::Real,
        cos_theta: A::Real,
    ) -> A::Real {
        let cos = cx.abs(cos_theta);
        let square = math!(cx, distance * distance);
        let share = math!(cx, departure.density * (area * cos));
        let own = self.without_gain(cx, share);
        let most = self.most[1];
        let balance = math!(cx, div(share, square + own, most));
        let whole = cx.real(self.gain);
        math!(
            cx,
            select(
                departure.samples,
                select(departure.weighs, balance, 0.0),
                whole
            )
        )
    }
}

impl<const C: usize> LightStage<C> {
    /// The light of the sun, of this radiance, on a ray that meets it: all of it if no lamp was sampled.
    #[inline(always)]
    pub(super) fn sunlight<A: Arith>(
        &self,
        cx: &mut A,
        departure: &Departure<A>,
        radiance: [f64; C],
    ) -> [A::Real; C] {
        let Some(far) = &self.far else {
            return radiance.map(|radiance| cx.real(radiance));
        };
        let [area] = self.areas[far.number as usize];
        let share = cx.scale(departure.density, area / (DISTANCE * DISTANCE));
        let own = cx.scale(share, 1.0 / far.gain);
        let most = self.most[1];
        let balance = math!(cx, div(share, 1.0 + own, most));
        let factor = math!(cx, select(departure.weighs, balance, 0.0));
        radiance.map(|radiance| {
            let weighted = cx.scale(factor, radiance / far.gain);
            math!(cx, select(departure.samples, weighted, real(radiance)))
        })
    }
}

/// The bound of `q / r^4` for a sun's light on a face with this normal, as in [`Reached::form`].
fn far_form(cone: &Cone, normal: DVec3) -> f64 {
    cone.greatest_cosine(normal) * (1.0 + SLACK) / (DISTANCE * DISTANCE)
}

/// The gain of factors of which `greatest` is the greatest: 1 unless they are small.
fn gain(greatest: f64) -> f64 {
    /// The greatest factor of which coarse numbers have enough bits.
    const LARGE: f64 = 1.0 / 64.0;
    if greatest > 0.0 && greatest < LARGE {
        (-greatest.log2()).floor().exp2()
    } else {
        1.0
    }
}

/// A point on a lamp.
pub(super) struct Point<A: Arith> {
    pub(super) lamp: A::Index,
    /// From the vertex to the point; not of unit length.
    pub(super) to: Vector<A>,
    /// True if the lamp is a sphere, and then its normal; none if no lamp is.
    pub(super) normal: Option<(A::Bool, Vector<A>)>,
}

/// The way from a vertex to a point on a lamp.
pub(crate) struct Towards<A: Arith> {
    /// `d`, not of unit length.
    pub(super) to: Vector<A>,
    /// `max(0, n.d)` and `max(0, -m.d)`.
    pub(super) rise: A::Real,
    pub(super) fall: A::Real,
    /// `q`
    pub(super) both: A::Real,
    /// `r^2`
    pub(super) square: A::Real,
    pub(super) lamp: A::Index,
    /// Area over probability and pi.
    pub(super) area: A::Real,
}

/// The departure of a path's ray from a vertex, to weight the emission that the ray meets.
pub(super) struct Departure<A: Arith> {
    samples: A::Bool,
    weighs: A::Bool,
    /// The density with which the ray was sampled, in units of `1 / pi` per steradian.
    density: A::Real,
}
