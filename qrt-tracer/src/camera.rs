//! *Generate Ray*, for the primary ray.

use super::geometry::{NO_PLANE, StageGeometry};
use super::ray::{Ray, Start};
use super::vector::Vector;
use super::{Arith, Coordinate, Sampled, vector};
use glam::{DVec2, DVec3};
use qrt_scene::lights::Cone;
use qrt_scene::{Basis, Camera, Film, Perspective, Scene};
use std::f64::consts::TAU;

/// The camera in stage units: a ray is affine in the film position `(column + u, row + v)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraStage {
    /// True if rays start at one point and fan out; false if they start at many and are parallel.
    pub perspective: bool,
    /// The part of rays that does not depend on the film position, in stage units: the eye, or the
    /// direction.
    pub fixed: [f64; 3],
    /// The part of rays that depends on the film position, at the film's upper left corner: the
    /// direction, or the origin.
    pub corner: [f64; 3],
    /// The change of `corner` per column of the film.
    pub column: [f64; 3],
    /// The change of `corner` per row of the film.
    pub row: [f64; 3],
    /// True if primary directions must have unit length.
    pub unit: bool,
    /// A bound on the distance of every hit of a primary ray, in lengths of its direction.
    pub t_max: f64,
    /// The number of the plane that primary rays leave and do not meet: the plane that the film lies
    /// on, if there is one, otherwise [`NO_PLANE`]. (An eye may be on several planes; their offsets
    /// pass exactly through it.)
    pub from: u32,
}

/// True if rays through the corners of the film, one unit long along the axis, may be longer than 1.8:
/// numbers that are known as components of unit vectors have room for 2.
pub(super) fn has_long_rays(camera: &Camera, film: Film) -> bool {
    let Camera::Perspective(camera) = camera else {
        return false;
    };
    let y = libm::tan(0.5 * camera.vfov.to_radians());
    let x = y * f64::from(film.width) / f64::from(film.height);
    1.0 + x * x + y * y > 1.8 * 1.8
}

/// A thin lens in stage units. A ray starts at a point `p` of the disc around the eye, and goes towards
/// the point at the distance `f` where all rays of its place on the film meet: with the direction `D` of
/// the pinhole's ray, whose forward part is 1, its direction is `D - p / f`.
#[derive(Clone, Debug)]
pub(crate) struct LensStage {
    /// The radius times the unit vectors to the right and upwards.
    axes: [[f64; 3]; 2],
    /// `-1 / f`
    bent: f64,
    /// The distance of the point from the eye, as a share of the radius.
    away: Sampled,
    /// Cosine and sine of its azimuth.
    azimuth: [Sampled; 2],
}

impl LensStage {
    /// The lens of `scene`, if a point on one is sampled.
    pub(crate) fn new(scene: &Scene, geometry: &StageGeometry) -> Option<Self> {
        let (lens, bits) = (scene.lens()?, scene.sampling.lens()?);
        let basis = Basis::new(&scene.camera);
        let radius = 0.5 * lens.aperture * geometry.scale;
        // Components that are only rounding errors cost a circuit products.
        let clean = |c: f64| if c.abs() < f64::EPSILON { 0.0 } else { c };
        let axis = |unit: DVec3| (unit.map(clean) * radius).to_array();
        Some(Self {
            axes: [axis(basis.right), axis(basis.up)],
            bent: -1.0 / (lens.focus * geometry.scale),
            away: Sampled::of_centre(bits[0], f64::sqrt),
            azimuth: [
                Sampled::of_centre(bits[1], |v| libm::cos(TAU * v)),
                Sampled::of_centre(bits[1], |v| libm::sin(TAU * v)),
            ],
        })
    }

    /// The point on the lens, from the eye.
    #[inline(always)]
    fn point<A: Arith>(&self, cx: &mut A) -> Vector<A> {
        let [u, v] = [
            cx.coordinate(Coordinate::lens_u()),
            cx.coordinate(Coordinate::lens_v()),
        ];
        let away = cx.sampled(&self.away, u);
        let [cos, sin] = [
            cx.sampled(&self.azimuth[0], v),
            cx.sampled(&self.azimuth[1], v),
        ];
        let (x, y) = (math!(cx, away * cos), math!(cx, away * sin));
        let [right, up] = self.axes;
        vector!(cx, constant(right) * x + constant(up) * y)
    }
}

/// Points from which primary rays start, or the corners of the area that they start from.
pub(crate) fn ray_origins(camera: &Camera, film: Film) -> Vec<DVec3> {
    let basis = Basis::new(camera);
    if let Camera::Perspective(Perspective {
        lens: Some(lens), ..
    }) = camera
    {
        let [x, y] = [basis.right, basis.up].map(|axis| axis * (0.5 * lens.aperture));
        [x + y, x - y, -x - y, y - x]
            .map(|corner| basis.eye + corner)
            .to_vec()
    } else if basis.perspective {
        vec![basis.eye]
    } else {
        basis
            .corners(film)
            .map(|corner| basis.eye + corner)
            .to_vec()
    }
}

/// The visibility of a lamp from the camera.
pub(super) enum Seen {
    /// Its front cannot be seen.
    Not,
    /// Within this convex outline on the film, in pixels.
    Within(Vec<DVec2>),
    /// It reaches behind the eye, so it may be seen anywhere.
    Anywhere,
}

/// The projection of points of the scene to the film.
pub(super) struct View {
    basis: Basis,
    film: DVec2,
}

impl View {
    pub(super) fn new(camera: &Camera, film: Film) -> Self {
        Self {
            basis: Basis::new(camera),
            film: DVec2::new(f64::from(film.width), f64::from(film.height)),
        }
    }

    /// The outline on the film of a polygon whose front, `(v1 - v0) x (v2 - v0)`, emits.
    pub(super) fn outline(&self, corners: &[DVec3]) -> Seen {
        let Basis {
            eye,
            forward,
            perspective,
            ..
        } = self.basis;
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // Only if the eye is well behind the plane, so that rounding cannot bring it in front.
        let toward = if perspective {
            (eye - corners[0]).normalize_or_zero()
        } else {
            -forward
        };
        if normal.normalize().dot(toward) < -1e-9 {
            return Seen::Not;
        }
        self.within(corners)
    }

    /// An outline on the film of a box, given by two opposite corners.
    pub(super) fn box_outline(&self, [low, high]: [DVec3; 2]) -> Seen {
        let corner =
            |bits: usize| DVec3::from_array([0, 1, 2].map(|k| [low, high][bits >> k & 1][k]));
        let corners: [DVec3; 8] = std::array::from_fn(corner);
        let Seen::Within(points) = self.within(&corners) else {
            return self.within(&corners);
        };
        let low = points.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = points
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        Seen::Within(vec![
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ])
    }

    /// The outline on the film of a square around the directions of a cone.
    pub(super) fn cone_outline(&self, cone: &Cone) -> Seen {
        /// The sine of the half angle above which the square would be too large.
        const WIDE: f64 = 0.7;
        let Basis { eye, forward, .. } = self.basis;
        if !self.basis.perspective {
            let across = (forward - cone.axis * forward.dot(cone.axis)).length();
            let sees = forward.dot(cone.axis) > 0.0 && across <= cone.sin + 1e-9;
            return if sees { Seen::Anywhere } else { Seen::Not };
        }
        if cone.sin > WIDE {
            return Seen::Anywhere;
        }
        let [x, y] = cone
            .across
            .map(|across| across * cone.sin / (1.0 - cone.cap));
        // Far from the eye in its own units, so that the sum keeps the direction.
        let far = 1.0 + eye.length();
        let corners = [x + y, x - y, -x - y, y - x];
        self.within(&corners.map(|corner| eye + (cone.axis + corner) * far))
    }

    /// The points on the film of points of the scene.
    fn within(&self, corners: &[DVec3]) -> Seen {
        let Basis {
            eye,
            forward,
            right,
            up,
            half,
            perspective,
        } = self.basis;
        let size = corners
            .iter()
            .map(|c| (*c - eye).length())
            .fold(0.0, f64::max);
        let nearest = |corner: &DVec3| (*corner - eye).dot(forward);
        if corners.iter().map(nearest).fold(f64::INFINITY, f64::min) <= 1e-6 * size {
            let behind = corners.iter().all(|c| nearest(c) < -1e-6 * size);
            return if behind { Seen::Not } else { Seen::Anywhere };
        }
        let aspect = self.film.x / self.film.y;
        let place = |corner: &DVec3| {
            let to = *corner - eye;
            let depth = if perspective { to.dot(forward) } else { 1.0 };
            let (x, y) = (to.dot(right) / depth, to.dot(up) / depth);
            let place = DVec2::new(x / (half * aspect), -y / half);
            (place + 1.0) * 0.5 * self.film
        };
        Seen::Within(corners.iter().map(place).collect())
    }
}

impl CameraStage {
    /// Makes `camera` ready for the tracer, in stage units of `geometry`.
    pub fn new(camera: &Camera, film: Film, geometry: &StageGeometry, unit: bool) -> Self {
        let basis = Basis::new(camera);
        let [upper_left, upper_right, lower_left, _] = basis.corners(film);
        let column = (upper_right - upper_left) / f64::from(film.width);
        let row = (lower_left - upper_left) / f64::from(film.height);
        let eye = (basis.eye - geometry.centre) * geometry.scale;
        // No direction is shorter than its forward part, 1.
        let starts = ray_origins(camera, film).into_iter();
        let starts = starts.map(|start| (start - geometry.centre) * geometry.scale);
        let far = starts.map(DVec3::length).fold(0.0, f64::max) + geometry.radius();
        let (perspective, scale) = (basis.perspective, geometry.scale);
        let (fixed, corner, per_pixel) = if perspective {
            (eye, basis.forward + upper_left, 1.0)
        } else {
            (basis.forward, eye + upper_left * scale, scale)
        };
        Self {
            perspective,
            fixed: fixed.to_array(),
            corner: corner.to_array(),
            column: (column * per_pixel).to_array(),
            row: (row * per_pixel).to_array(),
            unit: unit && perspective,
            t_max: far,
            from: NO_PLANE,
        }
    }

    /// The primary ray of a path: the paper's *Generate Ray* over `primaryRayId`.
    #[inline(always)]
    pub(crate) fn ray<A: Arith>(
        &self,
        cx: &mut A,
        bits: [u32; 2],
        lens: Option<&LensStage>,
    ) -> Ray<A> {
        let u = cx.coordinate(Coordinate::u(0));
        let v = cx.coordinate(Coordinate::v(0));
        let u = cx.centre(u, bits[0]);
        let v = cx.centre(v, bits[1]);
        let [column, row] = cx.pixel();
        let (x, y) = (math!(cx, column + u), math!(cx, row + v));
        let columns = vector!(cx, constant(self.column) * x);
        let rows = vector!(cx, constant(self.row) * y);
        let mut moving = vector!(cx, constant(self.corner) + columns + rows);
        let mut fixed = vector::constant(cx, self.fixed);
        if let Some(lens) = lens {
            let point = lens.point(cx);
            let bent = cx.real(lens.bent);
            fixed = vector!(cx, fixed + point);
            moving = vector!(cx, moving + point * bent);
        }
        let (origin, direction) = match (self.perspective, self.unit) {
            // The forward part alone has length 1.
            (true, true) => (fixed, vector::normalize(cx, &moving, 1.0)),
            (true, false) => (fixed, moving),
            (false, _) => (moving, fixed),
        };
        Ray {
            origin,
            direction,
            from: cx.index(self.from),
            t_max: self.t_max,
            start: Start::Camera,
        }
    }
}
