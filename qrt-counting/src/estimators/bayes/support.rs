//! The points that hold a posterior: a grid of angles, from coarse to fine, or integers.

use crate::Angle;
use crate::elementary::{fifth_root, sincos};
use crate::estimators::turns::amplitude;
use crate::vectorized::vectorized;

/// Number of points of a panel.
pub(super) const LANES: usize = 8;
/// Level of the first grid: 2^3 panels over [0, 1/2].
const FIRST_LEVEL: u32 = 4;
/// Level of the finest grid: points 2^-60 turns apart, at odd multiples of 2^-61.
const LAST_LEVEL: u32 = 57;
/// The largest number of integers that are held one by one.
const FEW_INTEGERS: f64 = 128.0;

/// The distribution of S before the first shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prior {
    /// Every S is equally likely.
    Even,
    /// S = 0 and S = N are far likelier than any other S: the fraction a of good indices has the
    /// density `(a (1 - a))^(POWER - 1)`.
    Ends,
}

/// The power of [`Prior::Ends`]. After Q queries without a good index the posterior mean is about
/// `2/Q^2` times this power. Measured on pixels with light sampling, four parts of a comparator have 0.6 of their
/// error with the even prior (a power of 1), and 0.9 of their error with a power of 0.3.
const POWER: f64 = 0.1;

/// Points at angles theta, in units of 2^-64 turns.
///
/// In this unit `m theta` modulo a turn is a wrapping product, which is exact for every m.
#[derive(Clone, Debug)]
pub(super) enum Support {
    /// Midpoints of equal cells. A panel is [`LANES`] cells; panels without mass are left out.
    Grid {
        /// A panel is 2^-level turns wide.
        level: u32,
        /// Numbers of the panels, in ascending order.
        panels: Vec<u64>,
    },
    /// Pairs of each S that is left and its theta.
    Integers(Vec<(u64, u64)>),
}

impl Support {
    /// All points that `total` indices allow.
    pub(super) fn whole(total: u64) -> Self {
        let grid = Self::Grid {
            level: FIRST_LEVEL,
            panels: (0..1 << (FIRST_LEVEL - 1)).collect(),
        };
        grid.integers(total).unwrap_or(grid)
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Grid { panels, .. } => panels.len() * LANES,
            Self::Integers(integers) => integers.len(),
        }
    }

    /// The distance between neighbouring points of a grid, in radians of `pi theta`.
    pub(super) fn step(&self) -> Option<f64> {
        match self {
            Self::Grid { level, .. } => Some(radians(cell(*level))),
            Self::Integers(_) => None,
        }
    }

    pub(super) fn position(&self, index: usize) -> u64 {
        match self {
            Self::Grid { level, panels } => {
                let lane = (index % LANES) as u64;
                panels[index / LANES] << (64 - level) | (2 * lane + 1) << (60 - level)
            }
            Self::Integers(integers) => integers[index].1,
        }
    }

    /// The fraction of good indices at the lower and the upper end of a point's cell.
    pub(super) fn ends(&self, index: usize, total: u64) -> (f64, f64) {
        match self {
            Self::Grid { level, .. } => {
                let (middle, half) = (self.position(index), cell(*level) / 2);
                (amplitude(middle - half), amplitude(middle + half))
            }
            Self::Integers(integers) => {
                let fraction = integers[index].0 as f64 / total as f64;
                (fraction, fraction)
            }
        }
    }

    /// The fraction of good indices at a point.
    pub(super) fn amplitude(&self, index: usize, total: u64) -> f64 {
        match self {
            Self::Grid { .. } => amplitude(self.position(index)),
            Self::Integers(integers) => integers[index].0 as f64 / total as f64,
        }
    }

    /// Ranges of points without a gap, as indices of their first and last points.
    pub(super) fn runs(&self) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        let neighbours = |before: usize, after: usize| match self {
            Self::Grid { panels, .. } => panels[before / LANES] + 1 == panels[after / LANES],
            Self::Integers(integers) => integers[before].0 + 1 == integers[after].0,
        };
        let width = self.width();
        for first in (0..self.len()).step_by(width) {
            let last = first + width - 1;
            match runs.last_mut() {
                Some(run) if neighbours(run.1, first) => run.1 = last,
                _ => runs.push((first, last)),
            }
        }
        runs
    }

    /// The least distance between neighbouring points, in radians; infinite for a single one.
    pub(super) fn least_distance(&self) -> f64 {
        match self {
            Self::Grid { level, .. } => radians(cell(*level)),
            Self::Integers(integers) => (integers.windows(2))
                .map(|pair| radians(pair[1].1 - pair[0].1))
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// Number of points that are kept or dropped together.
    pub(super) fn width(&self) -> usize {
        match self {
            Self::Grid { .. } => LANES,
            Self::Integers(_) => 1,
        }
    }

    /// Drops the panels, or integers, whose entry in `kept` is false.
    pub(super) fn retain(&mut self, kept: &[bool]) {
        let mut index = 0..kept.len();
        let mut keep = || index.next().is_some_and(|index| kept[index]);
        match self {
            Self::Grid { panels, .. } => panels.retain(|_| keep()),
            Self::Integers(integers) => integers.retain(|_| keep()),
        }
    }

    /// The support without the points at which `keep` is false, and `2^finer` times as fine.
    ///
    /// A panel stays if `keep` is true at any of its points. If few integers are left, the result
    /// is these integers.
    pub(super) fn refined(&self, keep: impl Fn(usize) -> bool, finer: u32, total: u64) -> Self {
        match self {
            Self::Integers(integers) => Self::Integers(
                (integers.iter().enumerate())
                    .filter(|&(index, _)| keep(index))
                    .map(|(_, &integer)| integer)
                    .collect(),
            ),
            Self::Grid { level, panels } => {
                let finer = finer.min(LAST_LEVEL - level);
                let kept = (panels.iter().enumerate())
                    .filter(|&(index, _)| (index * LANES..(index + 1) * LANES).any(&keep));
                let panels = kept
                    .flat_map(|(_, &panel)| panel << finer..(panel + 1) << finer)
                    .collect();
                let grid = Self::Grid {
                    level: level + finer,
                    panels,
                };
                grid.integers(total).unwrap_or(grid)
            }
        }
    }

    /// A prior's mass at each point, up to a common factor.
    pub(super) fn prior(&self, prior: Prior, total: u64) -> Vec<f64> {
        match prior {
            Prior::Even => self.even(),
            Prior::Ends => self.ends_likeliest(total),
        }
    }

    fn ends_likeliest(&self, total: u64) -> Vec<f64> {
        match self {
            Self::Integers(integers) => {
                let n = total as f64;
                let end = libm::pow(0.5, POWER) / POWER * n;
                let mass = |&(good, _): &(u64, u64)| {
                    let (good, bad) = (good as f64, (total - good) as f64);
                    if good == 0.0 || bad == 0.0 {
                        end
                    } else {
                        libm::pow(good / n * bad, POWER - 1.0) * n
                    }
                };
                integers.iter().map(mass).collect()
            }
            Self::Grid { level, panels } => {
                // In the angle, the density is the sine to this power, -4/5.
                let slope = 2.0 * POWER - 1.0;
                let to_slope = |sine: f64| {
                    let square = fifth_root(sine) * fifth_root(sine);
                    1.0 / (square * square)
                };
                let mut prior = Vec::with_capacity(panels.len() * LANES);
                vectorized(
                    #[inline(always)]
                    || self.turns(1, |_, sine| prior.extend(sine.map(to_slope))),
                );
                // Ratio of the first cell's mass to that of its midpoint.
                let end = libm::exp2(slope) / (2.0 * POWER);
                if panels.first() == Some(&0) {
                    prior[0] *= end;
                }
                if panels.last() == Some(&((1 << (level - 1)) - 1)) {
                    let last = prior.len() - 1;
                    prior[last] *= end;
                }
                prior
            }
        }
    }

    /// The even prior: uniform over the integers; on a grid, uniform in the fraction of good
    /// indices.
    fn even(&self) -> Vec<f64> {
        match self {
            Self::Integers(integers) => vec![1.0; integers.len()],
            Self::Grid { level, panels } => {
                let mut prior = Vec::new();
                self.turns(1, |_, sine| prior.extend_from_slice(sine));
                // A density that rises from 0 has an integral below its midpoint sum, by h^2/24 of
                // its slope (Euler and Maclaurin). That is a twelfth of the first cell.
                let end = 11.0 / 12.0;
                if panels.first() == Some(&0) {
                    prior[0] *= end;
                }
                if panels.last() == Some(&((1 << (level - 1)) - 1)) {
                    let last = prior.len() - 1;
                    prior[last] *= end;
                }
                prior
            }
        }
    }

    /// `pi theta` at every point, minus that at the first.
    pub(super) fn places(&self, places: &mut Vec<f64>) {
        places.clear();
        let first = self.position(0);
        match self {
            Self::Integers(integers) => {
                places.extend((integers.iter()).map(|&(_, theta)| radians(theta - first)));
            }
            Self::Grid { level, panels } => {
                let step = radians(cell(*level));
                for &panel in panels {
                    let start = radians((panel - panels[0]) << (64 - level));
                    places.extend((0..LANES).map(|lane| start + step * lane as f64));
                }
            }
        }
    }

    /// `cos(2 m pi theta)` at every point.
    pub(super) fn cosines(&self, multiple: u64, cosines: &mut Vec<f64>) {
        cosines.clear();
        match self {
            Self::Integers(integers) => cosines.extend(
                (integers.iter()).map(|&(_, theta)| turned(theta.wrapping_mul(multiple)).0),
            ),
            Self::Grid { panels, .. } => {
                cosines.resize(panels.len() * LANES, 0.0);
                let mut panels = cosines.as_chunks_mut().0.iter_mut();
                vectorized(
                    #[inline(always)]
                    || {
                        self.turns(multiple, |cosines, _| {
                            if let Some(panel) = panels.next() {
                                *panel = *cosines;
                            }
                        });
                    },
                );
            }
        }
    }

    /// Passes `cos(2 m pi theta)` and `sin(2 m pi theta)` of each panel of a grid to `panel_of`.
    #[inline(always)]
    fn turns(&self, multiple: u64, mut panel_of: impl FnMut(&[f64; LANES], &[f64; LANES])) {
        let Self::Grid { level, panels } = self else {
            return;
        };
        // The turns from a panel's first point to each of its points.
        let (mut lane_cosines, mut lane_sines) = ([1.0; LANES], [0.0; LANES]);
        let (step_cosine, step_sine) = turned(multiple.wrapping_mul(cell(*level)));
        for lane in 1..LANES {
            let (x, y) = (lane_cosines[lane - 1], lane_sines[lane - 1]);
            lane_cosines[lane] = x * step_cosine - y * step_sine;
            lane_sines[lane] = x * step_sine + y * step_cosine;
        }
        for panels in panels.chunks(LANES) {
            let (mut firsts, mut c, mut s) = ([0_u64; LANES], [0.0; LANES], [0.0; LANES]);
            firsts[..panels.len()].copy_from_slice(panels);
            for lane in 0..LANES {
                let first = firsts[lane] << (64 - level) | 1 << (60 - level);
                (c[lane], s[lane]) = turned(first.wrapping_mul(multiple));
            }
            for (x, y) in c.into_iter().zip(s).take(panels.len()) {
                let (mut cosines, mut sines) = ([0.0; LANES], [0.0; LANES]);
                for lane in 0..LANES {
                    cosines[lane] = x * lane_cosines[lane] - y * lane_sines[lane];
                    sines[lane] = x * lane_sines[lane] + y * lane_cosines[lane];
                }
                panel_of(&cosines, &sines);
            }
        }
    }

    /// The integers on this grid, if they are few.
    fn integers(&self, total: u64) -> Option<Self> {
        let Self::Grid { level, panels } = self else {
            return None;
        };
        let width = 64 - level;
        let n = total as f64;
        let mut few = 0.0;
        for &(first, last) in &self.runs() {
            let low = radians(panels[first / LANES] << width);
            let high = radians((panels[last / LANES] + 1) << width);
            few += 1.0 + n * libm::sin(high - low) * libm::sin(high + low);
            if few > FEW_INTEGERS {
                return None;
            }
        }
        let mut integers = Vec::new();
        for &(first, last) in &self.runs() {
            // Rounding may put an integer on the wrong side of an end: includes one more on either
            // side.
            let low = Angle::count_below(panels[first / LANES] << width, total).saturating_sub(1);
            let high = Angle::count_below((panels[last / LANES] + 1) << width, total) + 1;
            for good in low..=high.min(total) {
                if integers.last().is_none_or(|&(last, _)| last < good) {
                    integers.push((good, Angle::position_of(good, total)));
                }
            }
        }
        Some(Self::Integers(integers))
    }
}

/// The distance between points, in units of 2^-64 turns.
fn cell(level: u32) -> u64 {
    1 << (61 - level)
}

/// `pi theta`, for theta in units of 2^-64 turns.
pub(super) fn radians(position: u64) -> f64 {
    position as f64 * (std::f64::consts::PI / 18_446_744_073_709_551_616.0)
}

/// Cosine and sine of an angle in units of 2^-64 turns.
#[inline(always)]
pub(super) fn turned(turn: u64) -> (f64, f64) {
    // The angle is signed, so that small angles of either sign keep their precision.
    let angle = (turn as i64) as f64 * (std::f64::consts::TAU / 18_446_744_073_709_551_616.0);
    let (sine, cosine) = sincos(angle);
    (cosine, sine)
}
