//! A scene prepared for the tracer.

use super::ball_ray::Round;
use super::bsdf::{Emitters, ScatterStage, rank};
use super::camera::{self, CameraStage, LensStage};
use super::checker::Checkers;
use super::colours::ColourStage;
use super::geometry::StageGeometry;
use super::lights::{Lamps, LightSampling, LightStage};
use super::pixel_class::{PixelClass, PixelClasses};
use super::places::Places;
use super::ray::{self, Ray};
use super::refraction::Refraction;
use super::sky::SkyStage;
use super::smooth::SmoothStage;
use super::sun::SunStage;
use super::{Arith, bound};
use glam::DVec3;
use qrt_scene::valid::{Scatter, Surface, ValidScene};
use qrt_scene::{DepthSampling, Map, Material};
use std::collections::HashSet;

/// The relative amount by which rounding may take a path's colour over its bound.
const ROUNDING: f64 = 1e-12;

/// Fraction of the greatest radiance below which a bound is rounding: the lamp faces away.
const FACING_AWAY: f64 = 1e-9;

/// A scene prepared for the tracer, for `C` colour channels that share their paths.
#[derive(Clone, Debug)]
pub struct Stage<const C: usize> {
    pub(crate) geometry: StageGeometry,
    pub(crate) camera: CameraStage,
    pub(crate) lens: Option<LensStage>,
    /// Sample bits of the primary ray.
    pub(crate) film_bits: [u32; 2],
    /// The scene's surfaces in the stage's order, by their indices in the scene.
    order: Vec<usize>,
    /// The number of the surface of each face.
    pub(crate) surface_of: Vec<u32>,
    /// By face: the centre of its sphere and the inverse of the radius; zeros for a polygon. Empty
    /// without spheres.
    pub(crate) balls: Vec<[f64; 4]>,
    /// The normals of smooth faces, if there are any.
    pub(crate) smooth: Option<SmoothStage>,
    /// The choice among the colours of surfaces that have two.
    pub(crate) checkers: Option<Checkers>,
    /// The tints of faces, if any face has colours at its vertices.
    pub(crate) colours: Option<ColourStage<C>>,
    /// True if a surface's value reads the point that is hit.
    pub(crate) reads_point: bool,
    pub(crate) emitters: Emitters<C>,
    /// The light of directions in which nothing stands.
    pub(crate) sky: Option<SkyStage<C>>,
    /// The lamp that is infinitely far away.
    pub(crate) sun: Option<SunStage<C>>,
    /// Surfaces below this number scatter nothing.
    pub(crate) black: u32,
    /// The scattering towards each ray except the first.
    pub(crate) scatters: Vec<ScatterStage<C>>,
    /// A bound on the distance between two points of the geometry.
    pub(crate) t_max: f64,
    /// The points where primary rays start, or the corners of the area that they start from. In stage
    /// units.
    pub(crate) starts: Vec<DVec3>,
    /// The numbers of the planes on which all primary rays start: they meet none of these.
    pub(crate) starts_on: Vec<u32>,
    /// By face: true if paths may go on beyond it.
    pub(crate) transmits: Vec<bool>,
    /// True if emission counts at the primary hit.
    pub(crate) direct: bool,
    /// True if the last ray is searched for every hit, and not for emitters alone.
    pub(crate) every_hit: bool,
    bound: [f64; C],
    limit: [f64; C],
}

/// The value of a material that takes numbers too wide for a register.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WideValue {
    /// The material's name.
    pub material: String,
    /// The kind of the material, such as `bsdf`.
    pub kind: &'static str,
    /// The key of the value in the material, such as `value`.
    pub key: &'static str,
}

impl Stage<3> {
    /// All three channels at once, in the order red, green, blue, for pixels of `class`.
    pub fn rgb(scene: &ValidScene, class: PixelClass) -> Self {
        Self::new(scene, [0, 1, 2], class)
    }
}

impl<const C: usize> Stage<C> {
    /// The given channels (0 red, 1 green, 2 blue), for any pixel.
    pub fn of_any_pixel(scene: &ValidScene, channels: [usize; C]) -> Self {
        Self::new(scene, channels, PixelClass::default())
    }

    /// The given channels (0 red, 1 green, 2 blue), for pixels of `class`.
    pub fn new(scene: &ValidScene, channels: [usize; C], class: PixelClass) -> Self {
        let written = scene.scene();
        let depths = &written.sampling.depths;
        let used = used(scene);
        let mut order: Vec<usize> = (0..scene.surfaces().len()).filter(|&s| used[s]).collect();
        order.sort_by_key(|&surface| sort_key(&scene.surfaces()[surface]));
        let surfaces: Vec<&Surface> = order.iter().map(|&s| &scene.surfaces()[s]).collect();
        let mut place = vec![0; scene.surfaces().len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new as u32;
        }
        let black = surfaces.iter().filter(|s| rank(&s.scatter) == 0).count() as u32;
        let starts = camera::ray_origins(&written.camera, written.film);
        let emits = |surface: u32| scene.surfaces()[surface as usize].emits();
        let mut geometry = StageGeometry::new(scene.polygons(), scene.balls(), emits, &starts);
        let written_surfaces = scene.surface_of_faces();
        let surface_of: Vec<u32> = written_surfaces.map(|s| place[s as usize]).collect();
        let checked: Vec<_> = surfaces.iter().map(|surface| surface.checker()).collect();
        let checkers = Checkers::new(&geometry, scene.polygons(), &surface_of, &checked);
        let reads_point = surfaces.iter().any(|surface| match &surface.scatter {
            Scatter::Custom(bsdf) => bsdf.reads_point(),
            _ => false,
        });
        let emitters = Emitters::new(&surfaces, channels);
        let sky = written
            .sky
            .as_ref()
            .and_then(|sky| SkyStage::new(sky, channels));
        let sun = scene.sun();
        if sun.is_some() {
            geometry.add_sun();
        }
        let sampling = &written.sampling;
        let lit = (0..depths.len()).any(|depth| sampling.light(depth).is_some());
        let transmits = |surface: &u32| surfaces[*surface as usize].transmits();
        let transmits: Vec<bool> = surface_of.iter().map(transmits).collect();
        let smooth = SmoothStage::new(&geometry, scene.smooth_faces());
        let of_surfaces = (&*surfaces, &*surface_of);
        let colours = ColourStage::new(&geometry, scene.coloured_faces(), of_surfaces, channels);
        let starts = geometry.staged(&starts);
        let (places, lamps) = if lit {
            let number = geometry.emitters as usize;
            let of = (&*surface_of, surfaces.len());
            let places = Places::sides(&geometry, of, &transmits, &starts, number);
            // Without a density of its own, a user-defined BSDF may have that of a depth's map.
            let has_map = (1..depths.len())
                .any(|depth| sampling.light(depth).is_some() && depths[depth].map != Map::Auto);
            let may_sample = |surface: &Surface| {
                surface.samples_lights() || has_map && matches!(surface.scatter, Scatter::Custom(_))
            };
            let lamps = Lamps::new(
                (&geometry, smooth.as_ref()),
                (&surfaces, may_sample),
                &surface_of,
                &places,
                sun.as_ref(),
            );
            (places, lamps)
        } else {
            (Places::surfaces(surfaces.len()), None)
        };
        let direct = class == PixelClass::MayMeetLamp;
        let sees_sun = direct && PixelClasses::see_sun(scene);
        let sun = sun.map(|sun| SunStage::new(sun, channels, sees_sun));
        let squares = depths.iter().skip(1).map(|depth| (depth.bits, depth.map));
        let squares = squares.collect::<HashSet<_>>().len();
        let mut scatters: Vec<ScatterStage<C>> = Vec::with_capacity(depths.len());
        for (depth, written) in depths.iter().enumerate().skip(1) {
            let same =
                |other: &DepthSampling| (other.bits, other.map) == (written.bits, written.map);
            let mut scatter = if let Some(other) = depths[1..depth].iter().position(same) {
                scatters[other].at_depth(depth)
            } else {
                let square = (written.bits, written.map);
                ScatterStage::new(&surfaces, channels, depth, square, squares, &geometry)
            };
            if let Some(colours) = &colours {
                scatter.paint(colours.greatest(surfaces.len(), &surface_of));
            }
            if let (Some(lamps), Some(bits)) = (&lamps, sampling.light(depth)) {
                let asked = LightSampling {
                    depth,
                    bits,
                    mode: sampling.lights,
                };
                let radiance = (emitters.radiance(), sun.as_ref().map(SunStage::radiance));
                let numbers = 0..surfaces.len() as u32;
                let receivers: Vec<_> = numbers.map(|surface| scatter.receiver(surface)).collect();
                let lights =
                    LightStage::new((lamps, &places), radiance, &surface_of, &receivers, asked);
                scatter.sample_lights(lights);
            }
            scatters.push(scatter);
        }
        let reflects = smooth.is_some()
            || surfaces
                .iter()
                .any(|surface| matches!(surface.scatter, Scatter::Mirror(_)));
        let unit = scatters.iter().any(|scatter| scatter.asks_for_angles)
            || sky.as_ref().is_some_and(SkyStage::asks_for_directions)
            || !geometry.balls.is_empty()
            || sees_sun
            || sun.is_some() && reflects
            || reflects && camera::has_long_rays(&written.camera, written.film);
        let refraction = Refraction::new(&geometry, &surfaces, &surface_of, &starts);
        let bound = {
            let of = |refraction| {
                let sky = sky.as_ref().map_or([0.0; C], SkyStage::most);
                let sun = sun.as_ref().map_or([0.0; C], SunStage::radiance);
                bound::colour(
                    &places,
                    (emitters.radiance(), sky, sun),
                    &scatters,
                    [direct, sees_sun],
                    refraction,
                )
            };
            let plain = of(None);
            if refraction.is_of_any() {
                let by_solids = of(Some(&refraction));
                std::array::from_fn(|c| by_solids[c].min(plain[c]))
            } else {
                plain
            }
        };
        let sunlight = sun.as_ref().map_or([0.0; C], SunStage::irradiance);
        let limit = limit(bound, emitters.radiance(), sunlight);
        let balls = ball_rows(&geometry);
        let mut camera = CameraStage::new(&written.camera, written.film, &geometry, unit);
        let starts_on = geometry.planes_through(&starts);
        let lens = LensStage::new(written, &geometry);
        if camera.perspective && lens.is_none() {
            geometry.pass_through(camera.fixed);
        } else if let Some(&plane) = starts_on.first() {
            camera.from = plane;
        }
        Self {
            camera,
            lens,
            order,
            film_bits: depths.first().map_or([0, 0], |primary| primary.bits),
            surface_of,
            balls,
            smooth,
            checkers,
            colours,
            reads_point,
            emitters,
            every_hit: sky.is_some() || sun.is_some(),
            sky,
            sun,
            black,
            scatters,
            starts,
            starts_on,
            transmits,
            direct,
            bound,
            limit,
            t_max: 2.0 * geometry.radius(),
            geometry,
        }
    }

    /// The same stage with radiances in units of the bound, so no colour exceeds 1, up to rounding.
    /// [`Stage::bound`] and [`Stage::limit`] stay in the scene's units.
    pub fn relative(mut self) -> Self {
        self.emitters.in_units(self.bound);
        if let Some(sky) = &mut self.sky {
            sky.in_units(self.bound);
        }
        if let Some(sun) = &mut self.sun {
            sun.in_units(self.bound);
        }
        for scatter in &mut self.scatters {
            if let Some(lights) = &mut scatter.lights {
                lights.in_units(self.bound);
            }
        }
        self
    }

    /// The hit on `face` as one on a sphere, in a scene that has spheres.
    #[inline(always)]
    pub(super) fn round<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        distance: A::Real,
        face: A::Index,
    ) -> Option<Round<A>> {
        if self.balls.is_empty() {
            return None;
        }
        let point = ray::point_at(cx, ray, distance);
        let first = self.geometry.corners.len() as u32;
        Some(Round::new(cx, (first, &self.balls), face, point))
    }

    /// The same stage, whose last rays are searched for every hit. Colours stay the same.
    pub fn with_every_hit(mut self) -> Self {
        self.every_hit = true;
        self
    }

    /// The same stage, whose primary rays have directions of unit length.
    pub fn with_unit_directions(mut self) -> Self {
        self.camera.unit = self.camera.perspective;
        self
    }

    /// Number of rays of a path that are traced. This excludes the last ray if lamps are sampled and rays
    /// that meet them count nothing.
    pub fn traced_rays(&self) -> usize {
        if self.sky.is_some() {
            return self.depths();
        }
        let last = self.scatters.last();
        let lights = last.and_then(|scatter| scatter.lights.as_ref());
        self.depths() - usize::from(lights.is_some_and(|lights| !lights.rays_count()))
    }

    /// D, the number of rays on a path: one more than the bounces.
    pub fn depths(&self) -> usize {
        self.scatters.len() + 1
    }

    /// The tightest proven bound on a path's colour, per channel, in the scene's units: the colour
    /// scale, in the paper `2^b`.
    pub fn bound(&self) -> [f64; C] {
        self.bound
    }

    /// The greatest colour of a path within [`Stage::bound`] after rounding. It is per channel, in the
    /// scene's units.
    ///
    /// The bound and a colour multiply the same numbers in different orders. If the bound excludes a lamp
    /// because it faces away, rounding may leave a trace of its light.
    pub fn limit(&self) -> [f64; C] {
        self.limit
    }

    /// The density with which the rays of `depth` that leave `face` (by its label) are sampled. It is per
    /// steradian around `incoming`. Other ways to sample light are weighted against it. Directions are of
    /// unit length, in the frame whose z axis is the normal on the side of `outgoing`.
    ///
    /// None if no formula of the direction gives it: for the primary rays, for surfaces that reflect
    /// nothing or to single directions, and for a user-defined map without a stated density.
    pub fn density<A: Arith>(
        &self,
        cx: &mut A,
        depth: usize,
        face: u32,
        outgoing: &[A::Real; 3],
        incoming: &[A::Real; 3],
    ) -> Option<A::Real> {
        let scatter = self.scatters.get(depth.checked_sub(1)?)?;
        let surface = self.surface_of[face as usize];
        scatter.density(cx, surface, outgoing, incoming)
    }

    /// By surface: the user's expression or number that its weight is computed from, if it may take numbers
    /// of any size.
    pub fn values(&self, scene: &ValidScene) -> Vec<Option<WideValue>> {
        let value = |&surface: &usize| {
            let (name, material) = scene.scene().materials.get(surface)?;
            let (kind, key) = match material {
                Material::Phong(_) => ("phong", "exponent"),
                Material::Bsdf(_) => ("bsdf", "value"),
                _ => return None,
            };
            let material = name.clone();
            Some(WideValue {
                material,
                kind,
                key,
            })
        };
        self.order.iter().map(value).collect()
    }

    /// The smallest cells of a checker: the index of their surface in the scene, and their edge in stage units.
    /// `None` if there are no checkers.
    pub fn smallest_cell(&self) -> Option<(usize, f64)> {
        let (number, edge) = self.checkers.as_ref()?.smallest();
        Some((self.order[number], edge))
    }

    /// The least radius of curvature of a smooth face: the face's label, and the radius in stage units. `None` if
    /// there are no smooth faces.
    pub fn least_smooth_radius(&self) -> Option<(usize, f64)> {
        self.smooth.as_ref().and_then(SmoothStage::least_radius)
    }

    /// The least width over which a tint changes by 1: the face's label, and the width in stage units. `None` if no
    /// face has colours at its vertices.
    pub fn least_tint_width(&self) -> Option<(usize, f64)> {
        self.colours.as_ref().and_then(ColourStage::least_width)
    }

    /// By label: the unit normal of a polygon's front; zeros for a sphere.
    pub fn normals(&self) -> &[[f64; 3]] {
        &self.geometry.normals
    }

    /// The unit normal of a polygon's front, by its label; zeros for a sphere.
    pub fn normal(&self, face: usize) -> [f64; 3] {
        self.geometry.normals[face]
    }

    /// The camera, whose rays are in the geometry's units.
    pub fn camera(&self) -> &CameraStage {
        &self.camera
    }

    /// The primary ray of each path. It reads the sample coordinates of depth 0 and the pixel from `cx`.
    #[inline(always)]
    pub fn primary_ray<A: Arith>(&self, cx: &mut A) -> Ray<A> {
        self.camera.ray(cx, self.film_bits, self.lens.as_ref())
    }

    /// The points where primary rays start, or the corners of the area that they start from. In stage units.
    pub fn starts(&self) -> &[DVec3] {
        &self.starts
    }

    /// A bound on the distance between two points of the geometry, in stage units.
    pub fn t_max(&self) -> f64 {
        self.t_max
    }

    /// The faces, made ready for intersection.
    pub fn geometry(&self) -> &StageGeometry {
        &self.geometry
    }
}

/// The bound plus the amount that rounding may add, given the radiance of each emitter and the irradiance of the sun
/// over pi.
fn limit<const C: usize>(bound: [f64; C], radiance: &[[f64; C]], irradiance: [f64; C]) -> [f64; C] {
    std::array::from_fn(|c| {
        let most = radiance
            .iter()
            .map(|row| row[c])
            .fold(irradiance[c], f64::max);
        bound[c] * (1.0 + ROUNDING) + FACING_AWAY * most
    })
}

/// By face: the centre and the inverse of the radius of its sphere, or zeros; empty without spheres.
fn ball_rows(geometry: &StageGeometry) -> Vec<[f64; 4]> {
    if geometry.balls.is_empty() {
        return Vec::new();
    }
    let polygons = geometry.corners.iter().map(|_| [0.0; 4]);
    let balls = geometry.balls.iter();
    let balls = balls.map(|b| [b.centre.x, b.centre.y, b.centre.z, 1.0 / b.radius]);
    polygons.chain(balls).collect()
}

/// By surface: true if some face has it. Unused surfaces cost nothing.
fn used(scene: &ValidScene) -> Vec<bool> {
    let mut used = vec![false; scene.surfaces().len()];
    for surface in scene.surface_of_faces() {
        used[surface as usize] = true;
    }
    used
}

/// The key that sorts surfaces by lobe, with emitters (which are black or Lambertian) next to each other.
fn sort_key(surface: &Surface) -> (u32, bool) {
    let (rank, emits) = (rank(&surface.scatter), surface.emits());
    (rank, emits == (rank == 0))
}
