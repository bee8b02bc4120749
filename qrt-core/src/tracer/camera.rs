//! *Generate Ray*, for the primary ray.

use super::geometry::Geometry;
use super::intersect::{Ray, from_nowhere};
use super::vector;
use super::{Arith, Axis, Coordinate};
use crate::scene::{Camera, Film};
use glam::DVec3;

/// The camera in stage units: a ray is affine in the film position `(column + u, row + v)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraStage {
    /// Do rays start at one point (and fan out), or at many (and run parallel)?
    pub perspective: bool,
    /// What does not move with the film position: the eye, or the common direction.
    pub fixed: [f64; 3],
    /// What does, at the film's upper left corner: the direction, or the origin.
    pub corner: [f64; 3],
    /// Its change per column.
    pub column: [f64; 3],
    /// Its change per row.
    pub row: [f64; 3],
    /// Must primary directions have unit length?
    pub unit: bool,
    /// A bound on the distance of whatever a primary ray meets, in lengths of its direction.
    pub reach: f64,
}

struct Basis {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half the film's height: at distance 1, or in scene units.
    half: f64,
    perspective: bool,
}

impl Basis {
    fn new(camera: &Camera) -> Self {
        let (eye, target, up, half, perspective) = match camera {
            Camera::Perspective(c) => (
                c.eye,
                c.target,
                c.up,
                libm::tan(0.5 * c.vfov.to_radians()),
                true,
            ),
            Camera::Orthographic(c) => (c.eye, c.target, c.up, 0.5 * c.height, false),
        };
        let forward = (target - eye).normalize();
        let right = forward.cross(up.normalize()).normalize();
        Self {
            eye,
            forward,
            right,
            up: right.cross(forward),
            half,
            perspective,
        }
    }

    fn corners(&self, film: Film) -> [DVec3; 4] {
        let aspect = f64::from(film.width) / f64::from(film.height);
        let (x, y) = (self.right * (self.half * aspect), self.up * self.half);
        [y - x, y + x, -x - y, x - y]
    }
}

/// Points from which primary rays start.
pub(crate) fn reach(camera: &Camera, film: Film) -> Vec<DVec3> {
    let basis = Basis::new(camera);
    if basis.perspective {
        vec![basis.eye]
    } else {
        basis
            .corners(film)
            .iter()
            .map(|&corner| basis.eye + corner)
            .collect()
    }
}

impl CameraStage {
    /// Lowers `camera`.
    pub fn new(camera: &Camera, film: Film, geometry: &Geometry, unit: bool) -> Self {
        let basis = Basis::new(camera);
        let [upper_left, upper_right, lower_left, _] = basis.corners(film);
        let column = (upper_right - upper_left) / f64::from(film.width);
        let row = (lower_left - upper_left) / f64::from(film.height);
        let eye = (basis.eye - geometry.centre) * geometry.scale;
        // No direction is shorter than its forward part, 1.
        let starts = reach(camera, film).into_iter();
        let starts = starts.map(|start| (start - geometry.centre) * geometry.scale);
        let far = starts.map(DVec3::length).fold(0.0, f64::max) + geometry.radius();
        if basis.perspective {
            Self {
                perspective: true,
                fixed: eye.to_array(),
                corner: (basis.forward + upper_left).to_array(),
                column: column.to_array(),
                row: row.to_array(),
                unit,
                reach: far,
            }
        } else {
            Self {
                perspective: false,
                fixed: basis.forward.to_array(),
                corner: (eye + upper_left * geometry.scale).to_array(),
                column: (column * geometry.scale).to_array(),
                row: (row * geometry.scale).to_array(),
                unit: false,
                reach: far,
            }
        }
    }

    /// The primary ray of a path: the paper's *Generate Ray* over `primaryRayId`.
    #[inline(always)]
    pub(crate) fn ray<A: Arith>(&self, cx: &mut A, bits: [u32; 2]) -> Ray<A> {
        let u = cx.coordinate(Coordinate {
            depth: 0,
            axis: Axis::U,
        });
        let v = cx.coordinate(Coordinate {
            depth: 0,
            axis: Axis::V,
        });
        let u = cx.centre(u, bits[0]);
        let v = cx.centre(v, bits[1]);
        let [column, row] = cx.pixel();
        let x = cx.add(column, u);
        let y = cx.add(row, v);
        let corner = vector::constant(cx, self.corner);
        let columns = vector::constant(cx, self.column);
        let columns = vector::scale(cx, &columns, x);
        let rows = vector::constant(cx, self.row);
        let rows = vector::scale(cx, &rows, y);
        let moving = vector::add(cx, &corner, &columns);
        let moving = vector::add(cx, &moving, &rows);
        let fixed = vector::constant(cx, self.fixed);
        let from = from_nowhere(cx);
        if self.perspective {
            let direction = if self.unit {
                // The forward part alone has length 1.
                vector::normalize(cx, &moving, 1.0)
            } else {
                moving
            };
            Ray {
                origin: fixed,
                direction,
                from,
                reach: self.reach,
            }
        } else {
            Ray {
                origin: moving,
                direction: fixed,
                from,
                reach: self.reach,
            }
        }
    }
}
