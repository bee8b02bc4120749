//! Checks of a value: it must be finite, not negative, and without gain of energy.

use super::on_grid;
use super::shape::points;
use super::undefined::{situation, undefined_part};
use qrt_syntax::expr::{Expr, Variable, Variables};
use qrt_syntax::{Bsdf, Path, Problem};
use std::cell::OnceCell;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// Minimum value below zero that counts as rounding. A constant has no rounding.
const NEGATIVE: f64 = -1e-12;
/// Maximum gain of energy that counts as the quadrature's error.
const GAIN: f64 = 2e-3;

/// A direction towards the viewer, in a frame that is rotated about the surface's normal.
#[derive(Clone, Copy)]
struct Viewer {
    cos_o: f64,
    /// Length of the projection of the viewer's direction onto the surface; `towards` is its
    /// direction.
    sin_o: f64,
    towards: [f64; 2],
}

/// Returns the directions towards the viewer for which `f` may differ.
fn viewers(f: &Expr) -> Vec<Viewer> {
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
    let viewer = |cos_o: f64, turn: f64| {
        let angle = std::f64::consts::TAU * turn;
        Viewer {
            cos_o,
            sin_o: ((1.0 - cos_o) * (1.0 + cos_o)).max(0.0).sqrt(),
            towards: [libm::cos(angle), libm::sin(angle)],
        }
    };
    cosines
        .iter()
        .flat_map(|cos_o| turns.iter().map(move |turn| viewer(*cos_o, *turn)))
        .collect()
}

/// Returns the variables of `f` at a point of the square, seen by a viewer.
fn seen(at: Variables, direction: [f64; 3], viewer: Viewer) -> Variables {
    let [x, y, z] = direction;
    let along = x * viewer.towards[0] + y * viewer.towards[1];
    let cos_a = (z * viewer.cos_o - viewer.sin_o * along).clamp(-1.0, 1.0);
    Variables {
        cos_i: z.abs(),
        cos_o: viewer.cos_o,
        cos_a,
        ..at
    }
}

/// True if `f` is the same in all directions of one height.
fn is_round(f: &Expr) -> bool {
    let set = f.variables(f.root());
    !set.has_any(&[Variable::U, Variable::V, Variable::CosA])
}

/// Checks that `f` is finite and not negative at [`points`], for which the map has `directions`.
pub(super) fn value(directions: &[[f64; 3]], f: &Expr, path: &Path) -> Option<Problem> {
    let viewers = viewers(f);
    let is_constant = f.constant().is_some();
    let is_round = is_round(f);
    let mut heights = HashSet::new();
    let mut room = Vec::new();
    for (at, direction) in points().zip(directions) {
        if is_round && !heights.insert(direction[2].abs().to_bits()) {
            continue;
        }
        for viewer in &viewers {
            let at = seen(at, *direction, *viewer);
            let value = f.eval_in(&at, &mut room);
            let least = if is_constant { 0.0 } else { NEGATIVE };
            let what = if !value.is_finite() {
                let is_infinite = value.is_infinite();
                let at = situation(f, &at);
                Bsdf::Undefined { is_infinite, at }
            } else if let Some(part) = undefined_part(f, &at, &room) {
                part
            } else if value < least {
                let at = situation(f, &at);
                Bsdf::Negative { value, at }
            } else {
                continue;
            };
            return Some(Problem::new(path.clone(), what));
        }
    }
    None
}

/// Integrals over directions, as sums over the square: midpoint rules of increasing size, whose
/// samples are computed once.
#[derive(Default)]
pub(super) struct Quadrature {
    rules: [OnceCell<Vec<Sample>>; 4],
    /// The same rules with one sample a height.
    by_height: [OnceCell<Vec<Sample>>; 4],
}

/// A map and its `J |phi_z|`, the same for all calls of a quadrature.
type Mapped<'a> = (&'a [Expr; 3], &'a Expr);

#[derive(Clone)]
struct Sample {
    at: Variables,
    direction: [f64; 3],
    /// The projected solid angle `|phi_z| J du dv`.
    area: f64,
}

impl Quadrature {
    /// Returns the samples of a rule: 48 x 48 for rule 0, doubled in both directions for each
    /// further rule.
    fn rule(&self, (map, projected_jacobian): Mapped<'_>, rule: usize) -> &[Sample] {
        self.rules[rule].get_or_init(|| {
            let n = 48_u32 << rule;
            let centre = |k| (f64::from(k) + 0.5) / f64::from(n);
            let centres: Vec<f64> = (0..n).map(centre).collect();
            let sample = |row: usize, column: usize, [x, y, z, area]: [f64; 4]| Sample {
                at: Variables {
                    u: centres[row],
                    v: centres[column],
                    ..Variables::default()
                },
                direction: [x, y, z],
                area: area / f64::from(n * n),
            };
            let [x, y, z] = map;
            on_grid([x, y, z, projected_jacobian], (&centres, &centres), sample)
        })
    }

    /// Returns the samples of a rule, those of one height merged.
    fn rule_by_height(&self, of: Mapped<'_>, rule: usize) -> &[Sample] {
        self.by_height[rule].get_or_init(|| {
            let mut merged: Vec<Sample> = Vec::new();
            let mut places: HashMap<u64, usize> = HashMap::new();
            for sample in self.rule(of, rule) {
                let height = sample.direction[2].abs().to_bits();
                match places.entry(height) {
                    Entry::Occupied(place) => merged[*place.get()].area += sample.area,
                    Entry::Vacant(free) => {
                        free.insert(merged.len());
                        merged.push(sample.clone());
                    }
                }
            }
            merged
        })
    }

    /// Returns the fraction of uniform incident light that leaves towards `viewer`.
    fn albedo(&self, of: Mapped<'_>, f: &Expr, viewer: Viewer, rule: usize) -> f64 {
        let samples = if is_round(f) {
            self.rule_by_height(of, rule)
        } else {
            self.rule(of, rule)
        };
        let mut room = Vec::new();
        let light = |s: &Sample| f.eval_in(&seen(s.at, s.direction, viewer), &mut room) * s.area;
        samples.iter().map(light).sum()
    }

    /// Checks that no viewer sees more light leave than arrives: `integral f |phi_z| J du dv <= 1`.
    pub(super) fn energy(&self, of: Mapped<'_>, f: &Expr, path: &Path) -> Option<Problem> {
        let mut worst: Option<(f64, f64)> = None;
        for viewer in viewers(f) {
            if self.albedo(of, f, viewer, 0) <= 0.99 {
                continue;
            }
            // Near the limit, use finer rules until two agree.
            let (mut coarse, mut fine) =
                (self.albedo(of, f, viewer, 1), self.albedo(of, f, viewer, 2));
            if (fine - coarse).abs() > GAIN {
                (coarse, fine) = (fine, self.albedo(of, f, viewer, 3));
            }
            let gain = fine - 2.0 * (fine - coarse).abs();
            if gain > 1.0 + GAIN && worst.is_none_or(|(most, _)| fine > most) {
                worst = Some((fine, viewer.cos_o));
            }
        }
        let (albedo, cos_o) = worst?;
        let set = f.variables(f.root());
        let angles = set.contains(Variable::CosO) || set.contains(Variable::CosA);
        let at = if angles {
            vec![(Variable::CosO.name(), cos_o)]
        } else {
            Vec::new()
        };
        Some(Problem::new(path.clone(), Bsdf::GainsEnergy { albedo, at }))
    }
}
