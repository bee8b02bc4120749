//! What a map, a Jacobian and a value must be, tested at points of the square; and bounds.

use crate::expr::{Domain, Expr, Interval, Variable, VariableSet, Variables};
use crate::report::{Path, Problem};
use crate::sampling::maps;
use std::collections::BinaryHeap;

/// How far from length 1 a direction may be.
const OFF_SPHERE: f64 = 1e-9;
/// By what part a stated Jacobian may differ from the map's.
const OFF_JACOBIAN: f64 = 1e-6;
/// Slopes that are nothing: of a map onto a line the cross product is rounding.
const FLAT: f64 = 1e-12;
/// Values of rounding's size below zero are zero.
const NEGATIVE: f64 = -1e-12;
/// The energy that a BSDF may gain by the quadrature's error.
const GAIN: f64 = 2e-3;

/// Points of the open unit interval: 52 cell centres, and the neighbourhood of both ends, where
/// maps have their poles.
fn ticks() -> Vec<f64> {
    let near = [6, 8, 10, 13, 17, 22].map(|k| f64::from(k).exp2().recip());
    let centres = (0..52).map(|i| (f64::from(i) + 0.5) / 52.0);
    let ends = near.into_iter().chain(near.into_iter().map(|x| 1.0 - x));
    centres.chain(ends).collect()
}

/// 64 x 64 points of the open unit square.
fn points() -> impl Iterator<Item = Variables> {
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

/// A number for a person.
fn short(x: f64) -> String {
    let exponent = x.abs().log10();
    if x == 0.0 || (-4.0..6.0).contains(&exponent) {
        let text = format!("{x:.6}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text.is_empty() || text == "-" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    } else {
        format!("{x:.3e}")
    }
}

fn place(at: &Variables) -> String {
    format!("u = {}, v = {}", short(at.u), short(at.v))
}

/// The map is finite, has finite slopes, stays on the sphere, and is no mere line.
pub(super) fn map(map: &[Expr; 3]) -> Option<Problem> {
    let root = Path::root().key("map");
    let slopes = map.each_ref().map(|c| Variable::SQUARE.map(|v| c.diff(v)));
    let (mut flat, mut total) = (0, 0);
    let mut flat_at = Variables::default();
    for at in points() {
        let direction = map.each_ref().map(|c| c.eval(&at));
        if let Some(i) = direction.iter().position(|c| !c.is_finite()) {
            let message = format!("this component of the map has no value at {}", place(&at));
            let finite = "it must be finite for every u and v between 0 and 1";
            return Some(Problem::new("QRT0412", root.item(i), message).help(finite));
        }
        let length = norm(direction);
        if (length - 1.0).abs() > OFF_SPHERE {
            let message = format!(
                "the map leaves the unit sphere: its length is {} at {}",
                short(length),
                place(&at)
            );
            let unit = "a direction has length 1: x^2 + y^2 + z^2 must be 1 for every u and v";
            return Some(Problem::new("QRT0411", root, message).help(unit));
        }
        let [along_u, along_v] =
            [0, 1].map(|axis| slopes.each_ref().map(|slope| slope[axis].eval(&at)));
        for i in 0..3 {
            if !(along_u[i].is_finite() && along_v[i].is_finite()) {
                let message = format!(
                    "this component of the map has no finite slope at {}",
                    place(&at)
                );
                let smooth = "the Jacobian needs its derivatives between 0 and 1";
                return Some(Problem::new("QRT0412", root.item(i), message).help(smooth));
            }
        }
        total += 1;
        if norm(cross(along_u, along_v)) <= FLAT * norm(along_u).max(norm(along_v)) {
            flat += 1;
            flat_at = at;
        }
    }
    // A line of such points is harmless, an area is not.
    if flat * 16 > total {
        let message = format!(
            "the map takes a whole area of the square to a line or a point, as around {}",
            place(&flat_at)
        );
        let both = "the direction must change with u and with v, along different ways";
        return Some(Problem::new("QRT0413", root, message).help(both));
    }
    None
}

fn norm(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A stated Jacobian is that of the map.
pub(super) fn jacobian(map: &[Expr; 3], stated: &Expr) -> Option<Problem> {
    let slopes = map.each_ref().map(|c| Variable::SQUARE.map(|v| c.diff(v)));
    let right = |at: &Variables| {
        let [along_u, along_v] =
            [0, 1].map(|axis| slopes.each_ref().map(|slope| slope[axis].eval(at)));
        norm(cross(along_u, along_v))
    };
    let off = |given: f64, right: f64| {
        let error = (given - right).abs();
        error.is_nan() || error > OFF_JACOBIAN * right.abs().max(FLAT)
    };
    let at = points().find(|at| off(stated.eval(at), right(at)))?;
    let message = format!(
        "the stated Jacobian is {} at {}, but |dphi/du x dphi/dv| = {}",
        short(stated.eval(&at)),
        place(&at),
        short(right(&at))
    );
    // Only a mistake that explains every point is named.
    let explains = |wrong: &dyn Fn(f64, f64) -> f64| {
        points().all(|at| {
            let cosine = map[2].eval(&at).abs();
            !off(stated.eval(&at), wrong(right(&at), cosine))
        })
    };
    let ratio = right(&at) / stated.eval(&at);
    let help = if explains(&|j, _| 1.0 / j) {
        "this is 1/J: a change of variables multiplies by J, it does not divide".to_owned()
    } else if explains(&|j, cosine| j * cosine) {
        "this is J |z|: the cosine is multiplied in already, J stands without it".to_owned()
    } else if explains(&|j, cosine| 1.0 / (j * cosine)) {
        "this is 1/(J |z|): write J, the solid angle per unit of the square".to_owned()
    } else if explains(&|j, _| -j) {
        "this is -J: the Jacobian is a length, not a signed area".to_owned()
    } else if ratio.is_finite() && explains(&|j, _| j / ratio) {
        format!("multiply it by {}", short(ratio))
    } else {
        format!("write `{}`, or `auto`", maps::jacobian(map))
    };
    Some(Problem::new("QRT0414", Path::root().key("jacobian"), message).help(help))
}

/// Directions towards the viewer, and turns of the surface's frame about its normal, that make a
/// difference to `f`: `(cos_o, turn)`.
fn viewers(f: &Expr) -> Vec<(f64, f64)> {
    let set = f.variables(f.root());
    let oblique = set.contains(Variable::CosA);
    let cosines: Vec<f64> = if oblique || set.contains(Variable::CosO) {
        let inner = (0..16).map(|i| (f64::from(i) + 0.5) / 16.0);
        [1e-6, 1e-3].into_iter().chain(inner).chain([1.0]).collect()
    } else {
        vec![0.5]
    };
    let turns: &[f64] = if oblique {
        &[0.0, 0.25, 0.5, 0.75]
    } else {
        &[0.0]
    };
    cosines
        .iter()
        .flat_map(|cos_o| turns.iter().map(move |turn| (*cos_o, *turn)))
        .collect()
}

/// What `f` depends on at a point of the square, seen by a viewer.
fn seen(at: Variables, direction: [f64; 3], (cos_o, turn): (f64, f64)) -> Variables {
    let [x, y, z] = direction;
    let angle = std::f64::consts::TAU * turn;
    let along = x * libm::cos(angle) + y * libm::sin(angle);
    let sin_o = ((1.0 - cos_o) * (1.0 + cos_o)).max(0.0).sqrt();
    let cos_a = (z * cos_o - sin_o * along).clamp(-1.0, 1.0);
    Variables {
        cos_i: z.abs(),
        cos_o,
        cos_a,
        ..at
    }
}

/// The value is finite and not negative.
pub(super) fn value(map: &[Expr; 3], f: &Expr, path: &Path) -> Option<Problem> {
    let viewers = viewers(f);
    let mut room = Vec::new();
    for at in points() {
        let direction = map.each_ref().map(|c| c.eval_in(&at, &mut room));
        for viewer in &viewers {
            let at = seen(at, direction, *viewer);
            let value = f.eval_in(&at, &mut room);
            if value >= NEGATIVE && value.is_finite() {
                continue;
            }
            let place = situation(f, &at);
            return Some(if value.is_finite() {
                let message = format!("the value is negative: {} at {place}", short(value));
                Problem::new("QRT0415", path.clone(), message)
                    .help("`max(0, ...)` cuts the negative part off")
            } else {
                let what = if value.is_nan() {
                    "has no value"
                } else {
                    "is infinite"
                };
                Problem::new(
                    "QRT0416",
                    path.clone(),
                    format!("the BSDF {what} at {place}"),
                )
                .help("it must be finite for every pair of directions above the surface")
            });
        }
    }
    None
}

/// The variables of `f` with their values.
fn situation(f: &Expr, at: &Variables) -> String {
    let set = f.variables(f.root());
    let shown = if set.is_empty() {
        VariableSet::SQUARE
    } else {
        set
    };
    let parts: Vec<String> = shown
        .iter()
        .map(|v| format!("{} = {}", v.name(), short(at.get(v))))
        .collect();
    parts.join(", ")
}

/// No viewer sees more light leave than arrives: `integral f |phi_z| J du dv <= 1`.
pub(super) fn energy(
    map: &[Expr; 3],
    projected_jacobian: &Expr,
    f: &Expr,
    path: &Path,
) -> Option<Problem> {
    let integral = |viewer, n: u32| {
        let mut room = Vec::new();
        let mut total = 0.0;
        for i in 0..n {
            for j in 0..n {
                let centre = |k| (f64::from(k) + 0.5) / f64::from(n);
                let at = Variables {
                    u: centre(i),
                    v: centre(j),
                    ..Variables::default()
                };
                let direction = map.each_ref().map(|c| c.eval_in(&at, &mut room));
                let area = projected_jacobian.eval_in(&at, &mut room);
                total += f.eval_in(&seen(at, direction, viewer), &mut room) * area;
            }
        }
        total / f64::from(n * n)
    };
    let mut worst: Option<(f64, (f64, f64))> = None;
    for viewer in viewers(f) {
        if integral(viewer, 48) <= 0.99 {
            continue;
        }
        // Near the limit, or so it seems: twice finer, until two agree.
        let (mut coarse, mut fine) = (integral(viewer, 96), integral(viewer, 192));
        if (fine - coarse).abs() > GAIN {
            (coarse, fine) = (fine, integral(viewer, 384));
        }
        let gain = fine - 2.0 * (fine - coarse).abs();
        if gain > 1.0 + GAIN && worst.is_none_or(|(most, _)| fine > most) {
            worst = Some((fine, viewer));
        }
    }
    let (albedo, (cos_o, _)) = worst?;
    let set = f.variables(f.root());
    let angles = set.contains(Variable::CosO) || set.contains(Variable::CosA);
    let seen = if angles {
        format!(", seen at cos_o = {}", short(cos_o))
    } else {
        String::new()
    };
    let message = format!(
        "the BSDF gains energy: {} of the light that arrives leaves{seen}",
        short(albedo)
    );
    let help = format!(
        "the integral of value * |cos_i| over all directions must not pass 1: scale the value by \
         {} or less",
        short((1e4 / albedo).floor() / 1e4)
    );
    Some(Problem::new("QRT0417", path.clone(), message).help(help))
}

/// A box, by its upper bound.
struct Candidate {
    bound: f64,
    domain: Domain,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Candidate {}
impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// An upper bound of `e`, and of 0, over the whole domain: always the box of the highest bound is
/// halved, until a value is known that is nearly as high or the effort is spent.
pub(super) fn supremum(e: &Expr) -> f64 {
    const EFFORT: usize = 4096;
    const CLOSE: f64 = 1.0 + 1e-4;
    let variables: Vec<Variable> = e.variables(e.root()).iter().collect();
    let whole = Domain::default();
    let bound = |domain: &Domain| e.range(domain).map_or(0.0, |range| range.hi.max(0.0));
    let mut heap = BinaryHeap::from([Candidate {
        bound: bound(&whole),
        domain: whole,
    }]);
    let mut reached: f64 = 0.0;
    let mut least_bound = f64::INFINITY;
    for _ in 0..EFFORT {
        let Some(Candidate {
            bound: highest,
            domain,
        }) = heap.pop()
        else {
            break;
        };
        least_bound = least_bound.min(highest);
        let width = |v: &Variable| {
            let (part, all) = (domain.get(*v), whole.get(*v));
            (part.hi - part.lo) / (all.hi - all.lo)
        };
        let widest = variables
            .iter()
            .max_by(|a, b| width(a).total_cmp(&width(b)));
        let Some(widest) = widest.filter(|_| highest > reached * CLOSE) else {
            break;
        };
        let Interval { lo, hi } = domain.get(*widest);
        let middle = lo + (hi - lo) / 2.0;
        if !(lo < middle && middle < hi) {
            break;
        }
        for half in [Interval { lo, hi: middle }, Interval { lo: middle, hi }] {
            let mut domain = domain;
            *domain.get_mut(*widest) = half;
            let centre = |v| {
                let Interval { lo, hi } = domain.get(v);
                lo + (hi - lo) / 2.0
            };
            let at = Variables {
                u: centre(Variable::U),
                v: centre(Variable::V),
                cos_i: centre(Variable::CosI),
                cos_o: centre(Variable::CosO),
                cos_a: centre(Variable::CosA),
            };
            let value = e.eval(&at);
            if value.is_finite() {
                reached = reached.max(value);
            }
            heap.push(Candidate {
                bound: bound(&domain),
                domain,
            });
        }
    }
    least_bound * (1.0 + 1e-9)
}
