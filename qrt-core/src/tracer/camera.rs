//! *Generate Ray*, for the primary ray.

use super::geometry::{Geometry, NO_PLANE};
use super::ray::{Ray, Start};
use super::{Arith, Coordinate, vector};
use glam::{DVec2, DVec3};
use qrt_scene::{Basis, Camera, Film};

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

/// Points from which primary rays start, or the corners of the area that they start from.
pub(crate) fn ray_origins(camera: &Camera, film: Film) -> Vec<DVec3> {
    let basis = Basis::new(camera);
    if basis.perspective {
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
            right,
            up,
            half,
            perspective,
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
    pub fn new(camera: &Camera, film: Film, geometry: &Geometry, unit: bool) -> Self {
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
    pub(crate) fn ray<A: Arith>(&self, cx: &mut A, bits: [u32; 2]) -> Ray<A> {
        let u = cx.coordinate(Coordinate::u(0));
        let v = cx.coordinate(Coordinate::v(0));
        let u = cx.centre(u, bits[0]);
        let v = cx.centre(v, bits[1]);
        let [column, row] = cx.pixel();
        let (x, y) = (math!(cx, column + u), math!(cx, row + v));
        let columns = vector!(cx, constant(self.column) * x);
        let rows = vector!(cx, constant(self.row) * y);
        let moving = vector!(cx, constant(self.corner) + columns + rows);
        let fixed = vector::constant(cx, self.fixed);
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
