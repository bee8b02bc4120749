//! Checks that a map covers each direction that its material reflects to exactly once.
//!
//! The light that a surface scatters is an integral over directions, and a path samples it as one
//! over the square:
//!
//! `integral g(omega) |omega_z| domega = integral g(phi) |phi_z| J du dv`
//!
//! for every function `g`, if and only if phi covers directions once. Both sides are compared for
//! the value times functions that are local in height and azimuth. Their quotient is the number of
//! times that the directions around a place are covered. Where the value is zero, nothing needs to
//! be covered. A path's weight is `value |phi_z| J`, so no integrand is harder to integrate than a
//! path's weight.
//!
//! A value that depends on u or v is known only in directions that the map reaches. If all channels
//! depend on u or v, their map may leave directions out, which are then black, but must cover none
//! more than once.

use super::on_grid;
use qrt_syntax::expr::{Expr, Variable, Variables};
use qrt_syntax::{Bsdf, Path, Problem};
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// Number of heights, from the horizon to the pole, and of azimuths of the places around which both
/// sides are compared.
const HEIGHTS: usize = 16;
const TURNS: usize = 12;
/// Number of places, on both sides of the surface.
const PLACES: usize = 2 * (HEIGHTS + 1) * TURNS;
/// Maximum relative deviation of the whole, and of the part around a place.
const OFF_WHOLE: f64 = 5e-3;
const OFF_PLACE: f64 = 0.1;
/// Minimum share of the whole for a place to be checked.
const LEAST: f64 = 1e-5;
/// Minimum share of a map's weight on a side of the surface for the map to count as reaching that
/// side.
const SIDE: f64 = 1e-4;
/// Points per side of the square, by rule; a finer rule follows if a coarser leaves a doubt.
const RULES: [u32; 4] = [96, 192, 384, 768];
/// Number of heights at which the value is tabulated, from below to above.
const ROWS: usize = 1024;
/// Number of heights in the integrals of the tabulated value.
const STEPS: usize = 16 * ROWS;

/// Checks that `map` covers the directions that `values` reflect to. The values are finite and not
/// negative. `cells` caches the cells of the map for other values.
pub(super) fn check(
    map: &[Expr; 3],
    projected_jacobian: &Expr,
    cells: &OnceCell<Vec<Cell>>,
    values: &[Expr],
) -> Option<Problem> {
    let of_directions = |value: &&Expr| {
        let asked = value.variables(value.root());
        !Variable::SQUARE.iter().any(|&axis| asked.contains(axis))
    };
    let known: Vec<&Expr> = values.iter().filter(of_directions).collect();
    let all_known = known.len() == values.len();
    let asked = Asked::from_values(&known);
    let both = (asked.everywhere && !all_known).then(|| Asked::from_values(&[]));
    let mut asked = [Some(asked), both].into_iter().flatten();
    asked.find_map(|asked| compared(map, projected_jacobian, cells, &asked))
}

/// Checks the coverage for one integrand, `asked`.
fn compared(
    map: &[Expr; 3],
    projected_jacobian: &Expr,
    cells: &OnceCell<Vec<Cell>>,
    asked: &Asked,
) -> Option<Problem> {
    let path = Path::root().key("map");
    let mut coarser: Vec<Covered> = Vec::new();
    for points in RULES {
        let finer;
        let cells = if points == RULES[0] {
            cells.get_or_init(|| cells_of(map, projected_jacobian, points))
        } else {
            finer = cells_of(map, projected_jacobian, points);
            &finer
        };
        let covered = Covered::from_cells(cells, asked);
        let Some(found) = covered.worst(asked) else {
            return Some(Problem::new(path, Bsdf::OnlyBelow));
        };
        if found.within(0.5) {
            return None;
        }
        // A deviation that two finer rules do not change is the map's own. A single finer rule may
        // leave it unchanged by chance, if a narrow lobe gets few points; the last rule does not.
        let same = |coarse: &Covered| found.agrees(&coarse.deviation(asked, found.place));
        let is_last = points == RULES[RULES.len() - 1];
        let known = coarser.len().checked_sub(if is_last { 1 } else { 2 });
        let same = known.is_some_and(|first| coarser[first..].iter().all(same));
        if same && !found.within(1.0) {
            return Some(Problem::new(path, found.problem()));
        }
        coarser.push(covered);
    }
    None
}

/// The coverage of the directions around a place, and of all directions, as multiples of one.
#[derive(Clone, Copy)]
struct Deviation {
    place: usize,
    times: f64,
    whole: f64,
}

impl Deviation {
    /// True if both deviations are at most `part` of the allowed ones.
    fn within(&self, part: f64) -> bool {
        (self.whole - 1.0).abs() <= part * OFF_WHOLE && (self.times - 1.0).abs() <= part * OFF_PLACE
    }

    fn agrees(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64, off: f64| (a - b).abs() <= 0.25 * (a - 1.0).abs().max(off);
        near(self.whole, other.whole, OFF_WHOLE) && near(self.times, other.times, OFF_PLACE)
    }

    fn problem(&self) -> Bsdf {
        let &Self {
            place,
            times,
            whole,
        } = self;
        let around = direction(place);
        if times > 1.0 {
            Bsdf::CoversTwice {
                around,
                times,
                whole,
            }
        } else {
            Bsdf::LeavesOut {
                around,
                times,
                whole,
            }
        }
    }
}

/// The direction in the middle of a place.
fn direction(number: usize) -> [f64; 3] {
    let (side, ring) = (
        number / ((HEIGHTS + 1) * TURNS),
        number / TURNS % (HEIGHTS + 1),
    );
    // The outermost rings are one half only: take its middle.
    let height = (ring as f64).clamp(0.5, HEIGHTS as f64 - 0.5) / HEIGHTS as f64;
    let azimuth = (number % TURNS) as f64 / TURNS as f64 * TAU;
    let radius = (1.0 - height * height).sqrt();
    let z = if side == 0 { height } else { -height };
    [radius * libm::cos(azimuth), radius * libm::sin(azimuth), z]
}

/// The integrand as a function of directions, and its integrals.
struct Asked {
    /// The integrand by height from -1 to 1; constant unless `everywhere`.
    rows: Vec<f64>,
    /// True if the values define where light is reflected to, independently of the map.
    everywhere: bool,
    /// Its integrals around the places.
    places: Vec<f64>,
}

impl Asked {
    /// Creates the integrand of values that depend on directions alone. It is constant if none of
    /// them reflects light.
    fn from_values(known: &[&Expr]) -> Self {
        let is_turned = |value: &Expr| value.variables(value.root()).contains(Variable::CosA);
        let turned: Vec<bool> = known.iter().map(|value| is_turned(value)).collect();
        let row = |row: usize| -> f64 {
            let z = 2.0 * row as f64 / ROWS as f64 - 1.0;
            let values = known.iter().zip(&turned);
            values.map(|(value, turned)| mean(value, *turned, z)).sum()
        };
        let mut rows: Vec<f64> = (0..=ROWS / 2).map(row).collect();
        if turned.contains(&true) {
            rows.extend((ROWS / 2 + 1..=ROWS).map(row));
        } else {
            // The same above as below.
            rows.extend_from_within(..ROWS / 2);
            rows[ROWS / 2 + 1..].reverse();
        }
        let sum: f64 = rows.iter().sum();
        let everywhere = sum > 0.0 && sum.is_finite();
        if !everywhere {
            rows = vec![1.0; ROWS + 1];
        }
        let mut asked = Self {
            rows,
            everywhere,
            places: Vec::with_capacity(PLACES),
        };
        let mut all = [0.0; PLACES / TURNS];
        for step in 0..STEPS {
            let z = (2.0 * step as f64 + 1.0) / STEPS as f64 - 1.0;
            let light = asked.at(z) * z.abs() * TAU * 2.0 / STEPS as f64 / TURNS as f64;
            for (ring, part) in rings(z) {
                all[ring] += part * light;
            }
        }
        // The integrand does not depend on azimuth, so the places of a ring have equal integrals.
        for ring in all {
            asked.places.extend([ring; TURNS]);
        }
        asked
    }

    fn at(&self, z: f64) -> f64 {
        let place = f64::midpoint(z.clamp(-1.0, 1.0), 1.0) * ROWS as f64;
        let row = (place as usize).min(ROWS - 1);
        let part = place - row as f64;
        self.rows[row] * (1.0 - part) + self.rows[row + 1] * part
    }
}

/// Returns the value at height `z`, averaged over some viewers, one in the mirror direction.
///
/// `is_turned` is true if the value depends on the angle between both directions.
fn mean(value: &Expr, is_turned: bool, z: f64) -> f64 {
    let sine = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let mut room = Vec::new();
    let mut sum = 0.0;
    for cos_o in [z.abs(), 1.0, 0.9, 0.6, 0.3, 0.1] {
        let sin_o = ((1.0 - cos_o) * (1.0 + cos_o)).max(0.0).sqrt();
        let mut seen = 0.0;
        for (number, turn) in [1.0, 0.0, -1.0].into_iter().enumerate() {
            let at = Variables {
                cos_i: z.abs(),
                cos_o,
                cos_a: (z * cos_o + turn * sine * sin_o).clamp(-1.0, 1.0),
                ..Variables::default()
            };
            if is_turned || number == 0 {
                seen = value.eval_in(&at, &mut room).max(0.0);
            }
            sum += seen;
        }
    }
    sum / 18.0
}

/// Returns the two rings that `z` belongs to, each with its share; the shares sum to 1.
fn rings(z: f64) -> [(usize, f64); 2] {
    let first = if z < 0.0 { HEIGHTS + 1 } else { 0 };
    let place = z.abs().min(1.0) * HEIGHTS as f64;
    let ring = (place as usize).min(HEIGHTS - 1);
    let part = place - ring as f64;
    [(first + ring, 1.0 - part), (first + ring + 1, part)]
}

/// The image of a cell of the square under the map.
pub(super) struct Cell {
    z: f64,
    /// The azimuth, in [`TURNS`].
    turn: f64,
    /// The projected solid angle `|phi_z| J du dv`.
    area: f64,
}

/// Returns the cells of a rule of `points` points per side.
fn cells_of(map: &[Expr; 3], projected_jacobian: &Expr, points: u32) -> Vec<Cell> {
    // Points are dense where maps have their poles.
    let tick = |i: u32| {
        let s = (f64::from(i) + 0.5) / f64::from(points);
        let t = s * s * s * (10.0 - s * (15.0 - 6.0 * s));
        let rate = 30.0 * s * s * (1.0 - s) * (1.0 - s);
        (t, rate / f64::from(points))
    };
    let ticks: Vec<(f64, f64)> = (0..points).map(tick).collect();
    let places: Vec<f64> = ticks.iter().map(|tick| tick.0).collect();
    let cell = |row: usize, column: usize, [x, y, z, area]: [f64; 4]| Cell {
        z,
        turn: (libm::atan2(y, x) / TAU).rem_euclid(1.0) * TURNS as f64,
        area: area * ticks[row].1 * ticks[column].1,
    };
    let [x, y, z] = map;
    on_grid([x, y, z, projected_jacobian], (&places, &places), cell)
}

/// The coverage of a map, by place and by side.
struct Covered {
    places: Vec<f64>,
    /// `|phi_z| J`, above and below.
    sides: [f64; 2],
}

impl Covered {
    fn from_cells(cells: &[Cell], asked: &Asked) -> Self {
        let mut places = vec![0.0; PLACES];
        let mut sides = [0.0; 2];
        for &Cell { z, turn, area } in cells {
            sides[usize::from(z < -1e-9)] += area;
            let light = asked.at(z) * area;
            let place = (turn as usize).min(TURNS - 1);
            let part = turn - place as f64;
            for (ring, share) in rings(z) {
                let row = &mut places[ring * TURNS..(ring + 1) * TURNS];
                row[place] += light * share * (1.0 - part);
                row[(place + 1) % TURNS] += light * share * part;
            }
        }
        Self { places, sides }
    }

    /// Number of places to be covered: those of the sides that the map reaches. `None` if it does
    /// not reach the upper side.
    fn demanded(&self) -> Option<usize> {
        let all = self.sides[0] + self.sides[1];
        match self.sides.map(|side| side > SIDE * all) {
            [false, true] => None,
            [_, false] => Some(PLACES / 2),
            [true, true] => Some(PLACES),
        }
    }

    /// Returns the deviation where the map is most wrong; `None` if it reaches only directions
    /// below the surface.
    fn worst(&self, asked: &Asked) -> Option<Deviation> {
        let places = self.demanded()?;
        let whole: f64 = asked.places[..places].iter().sum();
        let counts = |&place: &usize| {
            let (covered, asks) = (self.places[place], asked.places[place]);
            asks > LEAST * whole && (asked.everywhere || covered > asks)
        };
        // Of several places that are equally wrong, take the one with the most light.
        let off = |place: usize| {
            let off = (self.places[place] - asked.places[place]).abs();
            let off = (off / asked.places[place]).min(1.0) + 1e-3 * off / whole;
            // Rounding errors must not decide between places, so round.
            (1e9 * off).round()
        };
        let place = (0..places).filter(counts);
        let place = place.max_by(|&a, &b| off(a).total_cmp(&off(b)));
        Some(self.deviation(asked, place.unwrap_or(0)))
    }

    fn deviation(&self, asked: &Asked, place: usize) -> Deviation {
        let places = self.demanded().unwrap_or(PLACES);
        let sum = |places: &[f64]| places.iter().sum::<f64>();
        let least = if asked.everywhere { 0.0 } else { 1.0 };
        Deviation {
            place,
            times: (self.places[place] / asked.places[place]).max(least),
            whole: (sum(&self.places[..places]) / sum(&asked.places[..places])).max(least),
        }
    }
}

#[cfg(test)]
mod tests;
