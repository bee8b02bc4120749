//! Checks of a map and its Jacobian at points of the square.

use super::undefined::undefined_part;
use crate::sampling::maps;
use glam::DVec3;
use qrt_syntax::expr::{Expr, OnGrid, Variable, Variables};
use qrt_syntax::{Bsdf, Mistake, Path, Problem};

/// Maximum deviation of a direction's length from 1.
const OFF_SPHERE: f64 = 1e-9;
/// Maximum relative deviation of a stated Jacobian from the map's.
const OFF_JACOBIAN: f64 = 1e-6;
/// Maximum length of a cross product, relative to the product of the lengths, that counts as
/// rounding: the partial derivatives are parallel.
const PARALLEL: f64 = 1e-10;

const CENTRES: usize = 52;

/// Points of the open unit interval: 52 cell centres, and the neighbourhood of both ends, where
/// maps have their poles.
pub(super) fn ticks() -> Vec<f64> {
    let near = [6, 8, 10, 13, 17, 22].map(|k| f64::from(k).exp2().recip());
    let centres = (0..CENTRES).map(|i| (i as f64 + 0.5) / CENTRES as f64);
    let ends = near.into_iter().chain(near.into_iter().map(|x| 1.0 - x));
    centres.chain(ends).collect()
}

/// 64 x 64 points of the open unit square.
pub(super) fn points() -> impl Iterator<Item = Variables> {
    let ticks = ticks();
    let row = ticks.clone();
    row.into_iter().flat_map(move |u| {
        let column = ticks.clone();
        column.into_iter().map(move |v| Variables {
            u,
            v,
            ..Variables::default()
        })
    })
}

/// The partial derivatives of a map with respect to u and to v.
struct Slopes([[Expr; 2]; 3]);

impl Slopes {
    fn from_map(map: &[Expr; 3]) -> Self {
        Self(map.each_ref().map(|c| Variable::SQUARE.map(|v| c.diff(v))))
    }

    fn at(&self, at: &Variables, room: &mut Vec<f64>) -> [DVec3; 2] {
        let mut along = |axis: usize| self.0.each_ref().map(|slope| slope[axis].eval_in(at, room));
        [along(0).into(), along(1).into()]
    }
}

/// Checks that the map is finite, has finite partial derivatives, stays on the sphere and does not
/// collapse to a line.
pub(super) fn map(map: &[Expr; 3]) -> Option<Problem> {
    let root = Path::root().key("map");
    let ticks = ticks();
    let slopes = Slopes::from_map(map);
    let prepared = |expr| OnGrid::new(expr, &ticks);
    let mut components = map.each_ref().map(prepared);
    let [mut along_u, mut along_v] =
        [0, 1].map(|axis: usize| slopes.0.each_ref().map(|slope| prepared(&slope[axis])));
    let mut flat = Vec::new();
    for &u in &ticks {
        for grid in [&mut components, &mut along_u, &mut along_v]
            .into_iter()
            .flatten()
        {
            grid.set_u(u);
        }
        for (column, &v) in ticks.iter().enumerate() {
            let at = [u, v];
            let mut direction = [0.0; 3];
            for (i, component) in components.iter_mut().enumerate() {
                direction[i] = component.value(column);
                let what = if direction[i].is_finite() {
                    let at = Variables {
                        u,
                        v,
                        ..Variables::default()
                    };
                    undefined_part(&map[i], &at, component.values())
                } else {
                    Some(Bsdf::NoDirection { at })
                };
                if let Some(what) = what {
                    return Some(Problem::new(root.item(i), what));
                }
            }
            let off = DVec3::from(direction).length() - 1.0;
            if off.abs() > OFF_SPHERE {
                return Some(Problem::new(root, Bsdf::OffSphere { off, at }));
            }
            let [along_u, along_v] = [&mut along_u, &mut along_v]
                .map(|slopes| DVec3::from(slopes.each_mut().map(|slope| slope.value(column))));
            for i in 0..3 {
                if !(along_u[i].is_finite() && along_v[i].is_finite()) {
                    return Some(Problem::new(root.item(i), Bsdf::NoSlope { at }));
                }
            }
            let area = along_u.cross(along_v).length();
            let is_flat = area <= PARALLEL * along_u.length() * along_v.length();
            flat.push((is_flat, at));
        }
    }
    // A line of flat points is harmless, an area is not: four adjacent flat cells are an area.
    let side = flat.len().isqrt();
    let is_flat = |i: usize, j: usize| flat[i * side + j].0;
    for i in 1..CENTRES {
        for j in 1..CENTRES {
            if is_flat(i, j) && is_flat(i - 1, j) && is_flat(i, j - 1) && is_flat(i - 1, j - 1) {
                let around = flat[i * side + j].1;
                return Some(Problem::new(root, Bsdf::Flat { around }));
            }
        }
    }
    None
}

/// Returns the map's Jacobian as a function of the point: the solid angle per unit of the square.
pub(super) fn solid_angle(map: &[Expr; 3]) -> impl Fn(&Variables) -> f64 {
    let slopes = Slopes::from_map(map);
    move |at| {
        let [along_u, along_v] = slopes.at(at, &mut Vec::new());
        along_u.cross(along_v).length()
    }
}

/// Checks that a stated Jacobian is that of the map.
pub(super) fn jacobian(map: &[Expr; 3], stated: &Expr) -> Option<Problem> {
    let right = solid_angle(map);
    let off = |given: f64, right: f64| {
        let error = (given - right).abs();
        error.is_nan() || error > OFF_JACOBIAN * right.abs().max(f64::MIN_POSITIVE)
    };
    let mut room = Vec::new();
    let mut at = None;
    for point in points() {
        let given = stated.eval_in(&point, &mut room);
        if off(given, right(&point)) {
            at = Some(point);
            break;
        }
        if let Some(what) = undefined_part(stated, &point, &room) {
            return Some(Problem::new(Path::root().key("jacobian"), what));
        }
    }
    let at = at?;
    // Only a mistake that explains every point is named.
    let explains = |wrong: &dyn Fn(f64, f64) -> f64| {
        points().all(|at| {
            let cosine = map[2].eval(&at).abs();
            !off(stated.eval(&at), wrong(right(&at), cosine))
        })
    };
    let ratio = right(&at) / stated.eval(&at);
    let mistake = if explains(&|j, _| 1.0 / j) {
        Mistake::Inverse
    } else if explains(&|j, cosine| j * cosine) {
        Mistake::WithCosine
    } else if explains(&|j, cosine| 1.0 / (j * cosine)) {
        Mistake::InverseWithCosine
    } else if explains(&|j, _| -j) {
        Mistake::Negative
    } else if ratio.is_finite() && explains(&|j, _| j / ratio) {
        Mistake::Factor(ratio)
    } else {
        let right = maps::jacobian(map);
        if right.written_nodes() <= 60 {
            Mistake::Other {
                right: right.to_string(),
            }
        } else {
            Mistake::Unlike
        }
    };
    let what = Bsdf::WrongJacobian {
        stated: stated.eval(&at),
        right: right(&at),
        at: [at.u, at.v],
        mistake,
    };
    Some(Problem::new(Path::root().key("jacobian"), what))
}
