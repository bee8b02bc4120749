//! Compiles a user-defined BSDF to one that can be traced, or reports all problems with it.
//!
//! The map `phi(u, v)` gives i, the direction towards the light, in the local frame whose z is the
//! normal on the viewer's side (`z < 0`: the path goes through). The value is `f(i, o)` with o
//! towards the viewer, and a path's weight is
//!
//! `W = f |phi_z| J`, `J = |dphi/du x dphi/dv|`,
//!
//! see [`crate::sampling::maps`]. The checks sample a fixed set of points of the open square, and some
//! points of the faces where the value depends on the point that is hit. The bound of the weight is
//! proven by interval arithmetic, over the box of the faces.

use super::CustomBsdf;
use crate::sampling::maps;
use crate::scene::{Bsdf, Jacobian, Rgb};
use qrt_circuit::Cores;
use qrt_syntax::expr::{Domain, Expr, OnGrid, Variable};
use qrt_syntax::{Bsdf as Fault, Path, Problem};
use std::cell::OnceCell;
use std::rc::Rc;

mod bound;
mod coverage;
mod light;
mod pdf;
mod points;
mod reciprocity;
mod shape;
#[cfg(test)]
mod tests;
mod undefined;

pub(in crate::valid) use points::reads_point;
pub use points::{Extent, Faces};
use points::{Hit, hits};

/// Reads and checks a BSDF of `faces`, at whose points a value is checked that reads the point that is
/// hit. Paths of problems are relative to it: `map[0]`, `jacobian`, `value[2]`.
///
/// Codes: those of [`Expr::parse`] for each formula, and `QRT0410` not one or three values,
/// `QRT0411` a map that leaves the unit sphere, `QRT0412` a map or a derivative without a finite
/// value, `QRT0413` a map of whole areas to points or lines, `QRT0414` a Jacobian that is not the
/// map's, `QRT0415` a negative value, `QRT0416` a value that is not finite, `QRT0417` a BSDF that
/// gains energy, `QRT0418` a weight without a bound, `QRT0419` a map that reaches directions more
/// than once, `QRT0420` a density that is not the map's, `QRT0421` a map that leaves out directions
/// that the value reflects to.
pub fn compile(bsdf: &Bsdf, faces: &Faces) -> Result<CustomBsdf, Vec<Problem>> {
    compile_with(bsdf, faces, &mut KnownMap::default())
}

/// Minimum work of checking one BSDF, in evaluated nodes of expressions: 0.5 ms.
const LEAST_WORK: u64 = 1 << 18;
/// Number of points of the square and of the quadrature at which a value is evaluated per viewer.
const VALUES: u64 = 6400;
/// Number of points at which a map and quantities derived from it are evaluated.
const MAPPED: u64 = 1 << 17;
/// Work that takes at most about a minute, and a tenth of it for most BSDFs, whose parts read few variables.
const MINUTE: u64 = 1 << 35;
/// Maximum time of checking the BSDFs of a scene, in minutes.
pub(super) const MOST_MINUTES: u64 = 10;

/// Returns the estimated time of checking `bsdf` after `last`, in minutes. A map equal to that of
/// `last` takes no time.
pub(super) fn minutes(bsdf: &Bsdf, last: Option<&Bsdf>) -> f64 {
    // A node takes at least a byte, and most take two.
    let nodes = |text: &String| text.len() as u64 / 2;
    let viewers = |text: &String| match text {
        text if text.contains(Variable::CosA.name()) => 76,
        text if text.contains(Variable::CosO.name()) => 19,
        _ => 1,
    };
    let hits = if reads_point(bsdf) {
        points::MOST as u64
    } else {
        1
    };
    let values = bsdf
        .value
        .iter()
        .map(|text| nodes(text) * viewers(text) * VALUES * hits);
    let known = last.is_some_and(|last| last.map == bsdf.map);
    let maps = bsdf.map.iter().filter(|_| !known);
    let maps = maps.map(|text| nodes(text) * MAPPED);
    let work = LEAST_WORK + values.sum::<u64>() + maps.sum::<u64>();
    work as f64 / MINUTE as f64
}

/// A cache of the last BSDF's map and its checks: materials of one scene mostly share one map.
#[derive(Default)]
pub(super) struct KnownMap(Option<([Expr; 3], Rc<MapChecks>)>);

/// The results of checking a map, shared by all values.
struct MapChecks {
    /// The problem of the map by itself, if it has one.
    problem: Option<Problem>,
    /// `J |phi_z|`.
    projected_jacobian: Expr,
    /// The map's directions at [`shape::points`].
    directions: OnceCell<Vec<[f64; 3]>>,
    /// The samples of the map for sums over the square.
    quadrature: light::Quadrature,
    /// The cells of the map under the first rule of the coverage check.
    cells: OnceCell<Vec<coverage::Cell>>,
}

impl MapChecks {
    fn new(map: &[Expr; 3]) -> Self {
        let problem = shape::map(map);
        let projected_jacobian = match problem {
            None => {
                let plain = maps::projected_jacobian(map);
                let square = Domain::default();
                let bounded = |weight: &Expr| bound::supremum(weight, &square).is_finite();
                let other = (!bounded(&plain)).then(|| maps::projected_jacobian_by_azimuth(map));
                other.filter(bounded).unwrap_or(plain)
            }
            // A placeholder: a map with a problem needs no Jacobian.
            Some(_) => map[2].clone(),
        };
        Self {
            problem,
            quadrature: light::Quadrature::default(),
            projected_jacobian,
            directions: OnceCell::new(),
            cells: OnceCell::new(),
        }
    }

    fn directions(&self, map: &[Expr; 3]) -> &[[f64; 3]] {
        self.directions.get_or_init(|| {
            let ticks = shape::ticks();
            on_grid(map.each_ref(), (&ticks, &ticks), |_, _, direction| {
                direction
            })
        })
    }
}

impl KnownMap {
    fn checks(&mut self, map: &[Expr; 3]) -> Rc<MapChecks> {
        match &self.0 {
            Some((known, checks)) if known == map => Rc::clone(checks),
            _ => {
                let checks = Rc::new(MapChecks::new(map));
                self.0 = Some((map.clone(), Rc::clone(&checks)));
                checks
            }
        }
    }
}

/// Returns what `at` makes of each point: of its row, its column and the values of `parts` there.
fn on_grid<T, const N: usize>(
    parts: [&Expr; N],
    (rows, columns): (&[f64], &[f64]),
    at: impl Fn(usize, usize, [f64; N]) -> T,
) -> Vec<T> {
    let mut grids = parts.map(|part| OnGrid::new(part, columns));
    let mut all = Vec::with_capacity(rows.len() * columns.len());
    for (row, &u) in rows.iter().enumerate() {
        for grid in &mut grids {
            grid.set_u(u);
        }
        for column in 0..columns.len() {
            let values = grids.each_mut().map(|grid| grid.value(column));
            all.push(at(row, column, values));
        }
    }
    all
}

/// Compiles as [`compile`] does, with the cached checks of the previous BSDF's map.
pub(super) fn compile_with(
    bsdf: &Bsdf,
    faces: &Faces,
    known: &mut KnownMap,
) -> Result<CustomBsdf, Vec<Problem>> {
    let mut problems = Vec::new();
    let root = Path::root();
    let mut read = |text: &str, path: &Path, allowed: &[Variable]| {
        Expr::parse(text, allowed)
            .map_err(|found| {
                problems.extend(found.into_iter().map(|problem| problem.below(path)));
            })
            .ok()
    };
    let [x, y, z] =
        [0, 1, 2].map(|i| read(&bsdf.map[i], &root.key("map").item(i), &Variable::SQUARE));
    let stated = match &bsdf.jacobian {
        Jacobian::Auto => None,
        Jacobian::Stated(text) => Some(read(text, &root.key("jacobian"), &Variable::SQUARE)),
    };
    let values: Vec<Option<Expr>> = bsdf
        .value
        .iter()
        .enumerate()
        .map(|(i, text)| read(text, &root.key("value").item(i), &Variable::ALL))
        .collect();
    let pdf = bsdf
        .pdf
        .as_ref()
        .map(|text| read(text, &root.key("pdf"), &Variable::ANGLES));
    if !matches!(values.len(), 1 | 3) {
        let count = values.len();
        problems.push(Problem::new(root.key("value"), Fault::Channels { count }));
    }
    let (Some(x), Some(y), Some(z)) = (x, y, z) else {
        return Err(problems);
    };
    let map = [x, y, z];
    let checks = known.checks(&map);
    problems.extend(checks.problem.clone());
    if !problems.is_empty() {
        return Err(problems);
    }
    let by_map = &checks.projected_jacobian;
    let projected_jacobian = match &stated {
        None => by_map.clone(),
        Some(None) => return Err(problems),
        Some(Some(jacobian)) => {
            problems.extend(shape::jacobian(&map, jacobian));
            (jacobian * &map[2].abs()).simplify()
        }
    };
    let values: Vec<Expr> = values.into_iter().flatten().collect();
    let before = problems.len();
    let hits = hits(&values, faces);
    let mut covers_wrong = false;
    for hit in &hits {
        covers_wrong = check_values(&map, &checks, hit, &mut problems);
        if problems.len() > before {
            break;
        }
    }
    let pdf = match pdf {
        Some(None) => return Err(problems),
        Some(Some(pdf)) => {
            if !covers_wrong {
                problems.extend(pdf::check(&map, &hits[0].values, &pdf));
            }
            Some(pdf.simplify())
        }
        None => None,
    };
    let value = match &values[..] {
        [grey] => [grey.clone(), grey.clone(), grey.clone()],
        [r, g, b] => [r.clone(), g.clone(), b.clone()],
        _ => return Err(problems),
    };
    if !problems.is_empty() {
        return Err(problems);
    }
    let weight_bound = weight_bound((&map, &projected_jacobian), &value, faces.extent);
    for (i, bound) in weight_bound.iter().enumerate().take(values.len()) {
        if !bound.is_finite() {
            let path = root.key("value").item(i);
            problems.push(Problem::new(path, Fault::Unbounded));
        }
    }
    if problems.is_empty() {
        // Clamp a value that may be negative, by rounding or at points that the check has missed.
        let value = value.map(|f| {
            let f = f.simplify();
            if bound::may_be_negative(&f, &faces.extent.domain()) {
                f.positive().simplify()
            } else {
                f
            }
        });
        Ok(CustomBsdf {
            map,
            projected_jacobian,
            value,
            weight_bound,
            pdf,
            extent: faces.extent,
        })
    } else {
        Err(problems)
    }
}

/// Checks the values that a BSDF has at one point that is hit. Returns true if the map covers directions
/// wrongly.
fn check_values(
    map: &[Expr; 3],
    checks: &MapChecks,
    hit: &Hit,
    problems: &mut Vec<Problem>,
) -> bool {
    let by_map = &checks.projected_jacobian;
    let path = |i: usize| Path::root().key("value").item(i);
    let placed = |problem: Problem| hit.placed(problem);
    let before = problems.len();
    for (i, f) in hit.values.iter().enumerate() {
        problems.extend(light::value(checks.directions(map), f, &path(i)).map(placed));
    }
    if problems.len() > before {
        return false;
    }
    if let Some(wrong) = coverage::check(map, by_map, &checks.cells, &hit.values) {
        problems.push(wrong);
        return true;
    }
    // A map with wrong coverage would falsify the energy, so the energy is not checked then.
    // The map's own Jacobian is used here, since a stated one may be wrong.
    let quadrature = &checks.quadrature;
    for (i, f) in hit.values.iter().enumerate() {
        problems.extend(quadrature.energy((map, by_map), f, &path(i)).map(placed));
    }
    false
}

/// Returns warnings about the values of a BSDF, which are not errors but probably unintended:
/// `QRT0422` a value that is not reciprocal. Paths are relative to the BSDF.
pub fn warnings(values: &[Expr], faces: &Faces) -> Vec<Problem> {
    let path = Path::root().key("value");
    let hits = hits(values, faces);
    let found = hits[0]
        .values
        .iter()
        .enumerate()
        .filter_map(|(i, f)| reciprocity::check(f, &path.item(i)));
    found.collect()
}

/// An upper bound, per channel, of `value * projected_jacobian` over u and v in (0, 1), cos_o in
/// [0, 1], cos_a in [-1, 1] and points of `extent`, with cos_i = |phi_z|: infinite if none can be
/// shown.
///
/// The bound is proven up to rounding of the weight itself, for which a relative 1e-9 is added. Use
/// it also if a scene replaces a BSDF's own map.
pub fn weight_bound(
    (map, projected_jacobian): (&[Expr; 3], &Expr),
    value: &[Expr; 3],
    extent: Extent,
) -> Rgb {
    let domain = extent.domain();
    let first = [0, 1, 2].map(|i| (0..i).find(|j| value[*j] == value[i]).unwrap_or(i));
    let distinct: Vec<usize> = (0..3).filter(|&i| first[i] == i).collect();
    let found = Cores::All.map(&distinct, 1, |&i| {
        bound::supremum(&weight(map, projected_jacobian, &value[i]), &domain)
    });
    let mut bounds: Rgb = [0.0; 3];
    for (i, bound) in distinct.into_iter().zip(found) {
        bounds[i] = bound;
    }
    first.map(|i| bounds[i])
}

/// Returns the weight `value * projected_jacobian` as one expression, with `|phi_z|` in place of
/// cos_i. Common factors then cancel: `0.1/cos_i` under the uniform map is a constant.
///
/// ```
/// use qrt_syntax::expr::{Expr, Variable};
/// use qrt_scene::{Map, sampling::maps, valid::bsdf};
/// let map = maps::builtin(Map::UniformHemisphere);
/// let value = Expr::parse("0.5/pi/cos_i", &Variable::ALL).unwrap();
/// let weight = bsdf::weight(&map, &maps::projected_jacobian(&map), &value);
/// assert_eq!(weight.constant(), Some(1.0));
/// ```
pub fn weight(map: &[Expr; 3], projected_jacobian: &Expr, value: &Expr) -> Expr {
    let value = value.substitute(Variable::CosI, &map[2].abs());
    (&value * projected_jacobian).simplify()
}
