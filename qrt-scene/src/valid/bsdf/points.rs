//! Points that are hit: the box that they lie in, and those of them at which a value is checked.

use crate::lights::Lamp;
use crate::scene::Bsdf;
use crate::valid::{Ball, Polygon};
use glam::DVec3;
use qrt_syntax::expr::{Domain, Expr, Interval, Variable};
use qrt_syntax::{Bsdf as Fault, Problem, What};
use std::f64::consts::TAU;

/// Maximum number of points at which a value is checked.
pub(super) const MOST: usize = 16;
/// Share of the box's extent by which its bounds are moved outwards, for points that rounding moves out
/// of it.
const MARGIN: f64 = 1e-3;
/// Multiples of the powers of `1/g`, for `g^3 = g + 1`, modulo 1 fill a square evenly.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The box around all faces of one surface, in units of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The corner with the least coordinates.
    pub least: DVec3,
    /// The corner with the greatest.
    pub greatest: DVec3,
}

impl Extent {
    /// The box that holds the origin alone: that of a surface without faces.
    pub const ORIGIN: Self = Self {
        least: DVec3::ZERO,
        greatest: DVec3::ZERO,
    };

    /// The whole domain of a value: all directions, and the points of the box, some of its extent
    /// around it included.
    pub fn domain(self) -> Domain {
        let mut domain = Domain::default();
        let around = MARGIN * (self.greatest - self.least).max_element();
        for (axis, variable) in Variable::POINT.into_iter().enumerate() {
            *domain.get_mut(variable) = Interval {
                lo: self.least[axis] - around,
                hi: self.greatest[axis] + around,
            };
        }
        domain
    }
}

/// The faces of one surface: the box around them, and some of their points.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// The box around all of them.
    pub extent: Extent,
    /// At most 16 of their points: those with the least and the greatest coordinates first.
    points: Vec<DVec3>,
}

impl Faces {
    /// No face.
    pub const NONE: Self = Self {
        extent: Extent::ORIGIN,
        points: Vec::new(),
    };

    /// The faces of a surface, among all that it has.
    pub(in crate::valid) fn new(polygons: &[&Polygon], balls: &[&Ball]) -> Self {
        let outermost = polygons.iter().flat_map(|polygon| outermost(polygon));
        let outermost = outermost.chain(balls.iter().flat_map(|ball| {
            DVec3::AXES
                .into_iter()
                .flat_map(|axis| [-axis, axis].map(|axis| ball.centre + axis * ball.radius))
        }));
        let outermost: Vec<DVec3> = outermost.collect();
        let extreme = |axis: usize, sign: f64| {
            let places = outermost.iter().copied();
            places.max_by(|a, b| (sign * a[axis]).total_cmp(&(sign * b[axis])))
        };
        let sides = (0..3).flat_map(|axis| [-1.0, 1.0].map(|sign| extreme(axis, sign)));
        let mut points: Vec<DVec3> = sides.flatten().collect();
        let (Some(&[x, _, y, _, z, _]), Some(&[_, to_x, _, to_y, _, to_z])) =
            (points.first_chunk(), points.first_chunk())
        else {
            return Self::NONE;
        };
        let extent = Extent {
            least: DVec3::new(x.x, y.y, z.z),
            greatest: DVec3::new(to_x.x, to_y.y, to_z.z),
        };
        let count = polygons.len() + balls.len();
        let inside = MOST - points.len();
        points.extend((0..inside).map(|number| {
            let shares = STEPS.map(|step| ((number + 1) as f64 * step).fract());
            let face = number * count / inside;
            match face.checked_sub(polygons.len()) {
                None => inner(polygons[face], shares),
                Some(ball) => on_sphere(balls[ball], shares),
            }
        }));
        Self { extent, points }
    }
}

/// Points of a polygon or a disc among which are those with its least and greatest coordinates.
fn outermost(polygon: &Polygon) -> Vec<DVec3> {
    if !polygon.disc {
        return polygon.outline().to_vec();
    }
    let disc = Lamp::disc(polygon.vertices);
    let radius = disc.edges[0].length();
    let along = DVec3::AXES.map(|axis| axis - disc.normal * axis.dot(disc.normal));
    let ends = along.map(|along| along.normalize_or_zero() * radius);
    ends.into_iter()
        .flat_map(|end| [disc.corner - end, disc.corner + end])
        .collect()
}

/// The point of a polygon or a disc that has these shares of its square.
fn inner(polygon: &Polygon, [s, t]: [f64; 2]) -> DVec3 {
    let [a, b, c, d] = polygon.vertices;
    if polygon.disc {
        let disc = Lamp::disc([a, b, c, d]);
        let (sine, cosine) = libm::sincos(TAU * t);
        return disc.corner + (disc.edges[0] * cosine + disc.edges[1] * sine) * s.sqrt();
    }
    a.lerp(b, s).lerp(d.lerp(c, s), t)
}

/// The point of a sphere that has these shares of a square.
fn on_sphere(ball: &Ball, [s, t]: [f64; 2]) -> DVec3 {
    let height = 1.0 - 2.0 * s;
    let across = (1.0 - height * height).max(0.0).sqrt();
    let (sine, cosine) = libm::sincos(TAU * t);
    ball.centre + DVec3::new(across * cosine, across * sine, height) * ball.radius
}

/// True if a formula of the value may read the point that is hit: a name in it is `x`, `y` or `z`.
pub(in crate::valid) fn reads_point(bsdf: &Bsdf) -> bool {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let names = bsdf
        .value
        .iter()
        .flat_map(|text| text.split(|c| !is_name(c)));
    let mut names = names.filter(|name| name.len() == 1);
    names.any(|name| Variable::POINT.iter().any(|axis| axis.name() == name))
}

/// The values of a BSDF at one point that is hit.
pub(super) struct Hit {
    /// Its coordinates that a value reads, with their names.
    at: Vec<(&'static str, f64)>,
    /// The values there, as functions of directions alone.
    pub(super) values: Vec<Expr>,
}

impl Hit {
    /// Adds the point to a problem that one of its values has.
    pub(super) fn placed(&self, mut problem: Problem) -> Problem {
        if let What::Bsdf(
            Fault::Negative { at, .. }
            | Fault::Undefined { at, .. }
            | Fault::UndefinedPart { at, .. }
            | Fault::GainsEnergy { at, .. },
        ) = &mut problem.what
        {
            at.extend(&self.at);
        }
        problem
    }
}

/// The values at points of `faces`: at one if no value reads the point, or if there is no face.
pub(super) fn hits(values: &[Expr], faces: &Faces) -> Vec<Hit> {
    let asked = |axis: &Variable| {
        let mut sets = values.iter().map(|value| value.variables(value.root()));
        sets.any(|set| set.contains(*axis))
    };
    let axes: Vec<usize> = (0..3).filter(|&k| asked(&Variable::POINT[k])).collect();
    let points = faces.points.iter().copied();
    let mut distinct: Vec<Vec<(Variable, f64)>> = Vec::new();
    for point in points.chain(faces.points.is_empty().then_some(DVec3::ZERO)) {
        let point = axes
            .iter()
            .map(|&axis| (Variable::POINT[axis], point[axis]));
        let point = point.collect();
        if !distinct.contains(&point) {
            distinct.push(point);
        }
    }
    let hit = |point: Vec<(Variable, f64)>| {
        let value = |value: &Expr| {
            point.iter().fold(value.clone(), |value, &(axis, at)| {
                let number = Expr::number(at);
                number.map_or(value.clone(), |number| value.substitute(axis, &number))
            })
        };
        let values = values.iter().map(value);
        Hit {
            values: if point.is_empty() {
                values.collect()
            } else {
                values.map(|value| value.simplify()).collect()
            },
            at: point.iter().map(|&(axis, at)| (axis.name(), at)).collect(),
        }
    };
    distinct.into_iter().map(hit).collect()
}
