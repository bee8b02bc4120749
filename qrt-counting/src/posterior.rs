//! The posterior over the number of good indices, and its mean.
//!
//! The prior is uniform over S in `0 ..= N`. Up to 2^12 indices, sums go over every S. Beyond that
//! number, they go over cells: the steps between neighbouring outcomes y of the phase register.
//!
//! * *Near* an observed outcome, the sum goes cell by cell. It adds the integers one by one if
//!   there are few. Otherwise it uses Gauss-Legendre quadrature in theta, in panels as fine as B
//!   repetitions require.
//! * *Far* from all outcomes, P(y) is a smooth envelope times the square of a fast sine. With B = 1
//!   the envelope falls only with the square of the distance, so the mass beyond any number of
//!   cells matters. There the sine is averaged over a step, and the envelope is integrated over
//!   panels that grow with the distance.
//!
//! All values are logarithms relative to the likeliest S. Cells that have less than exp(-60) of the
//! likeliest are left out.

use qrt_circuit::quantum::Window;
use std::collections::BTreeSet;
use std::f64::consts::PI;

use super::distribution::{check_counts, register};
use super::double::{self, Double};
use super::error::CountingError;
use super::likelihood::{Likelihood, likeliest};
use super::phase::Phase;

/// The largest number of indices at which the sum goes over every S.
const FEW_IDS: u64 = 1 << 12;
/// Number of cells on either side of an outcome that count as near.
const NEAR: u64 = 48;
/// The largest number of integers of a far panel that are summed one by one.
const FEW_FAR: f64 = 2048.0;
/// The largest number of integers of the first or last cell that are summed one by one.
const FEW_AT_ENDS: u64 = 1024;
/// ln of the largest likelihood that is left out, relative to the likeliest.
const NEGLIGIBLE: f64 = -60.0;
/// Gauss-Legendre nodes and weights of order 8 on [-1, 1]; the other half mirrors these.
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// The posterior of S/N after outcomes of the phase register.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posterior {
    /// The posterior's mean of S/N, in [0, 1].
    pub mean: f64,
    /// The range of the likeliest values of S/N that together hold the posterior mass `content`.
    pub interval: (f64, f64),
}

/// A range of amplitudes and its part of the posterior.
struct Piece {
    low: f64,
    high: f64,
    /// Number of integers that the piece stands for.
    integers: f64,
    mass: f64,
    /// Integral of the amplitude times the mass.
    moment: f64,
}

/// The posterior mean of S/N and the interval of highest density.
///
/// The prior is uniform over S in `0 ..= N`. The interval contains S/N with probability `content`.
///
/// # Errors
///
/// As [`maximum_likelihood`](super::maximum_likelihood).
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::posterior_mean;
/// // T = 8, read as 2 in both runs: theta is about 1/4, and the posterior is symmetric about 1/2.
/// let found = posterior_mean(&[2, 2], 1 << 40, 3, Window::Rect, 0.95)?;
/// assert!((found.mean - 0.5).abs() < 1e-9);
/// assert!(found.interval.0 > 0.1 && found.interval.1 < 0.9);
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
pub fn posterior_mean(
    outcomes: &[u64],
    total: u64,
    phase_bits: u32,
    window: Window,
    content: f64,
) -> Result<Posterior, CountingError> {
    check_counts(0, total)?;
    let likelihood = Likelihood::new(outcomes, register(phase_bits, window)?)?;
    let top = likeliest(&likelihood, total)?.ln_likelihood;
    let mut integral = Integral {
        likelihood: &likelihood,
        total,
        top,
        shots: outcomes.len() as f64,
        pieces: Vec::new(),
    };
    if total <= FEW_IDS {
        integral.integers(0, total);
    } else {
        integral.cells();
    }
    Ok(summary(integral.pieces, content))
}

fn summary(mut pieces: Vec<Piece>, content: f64) -> Posterior {
    let mass: f64 = pieces.iter().map(|piece| piece.mass).sum();
    let moment: f64 = pieces.iter().map(|piece| piece.moment).sum();
    let mean = (moment / mass).clamp(0.0, 1.0);
    let density = |piece: &Piece| piece.mass / piece.integers;
    pieces.sort_by(|a, b| density(b).total_cmp(&density(a)));
    let (mut held, mut low, mut high) = (0.0, mean, mean);
    for piece in &pieces {
        if held >= content * mass {
            break;
        }
        held += piece.mass;
        (low, high) = (low.min(piece.low), high.max(piece.high));
    }
    Posterior {
        mean,
        interval: (low, high),
    }
}

struct Integral<'a> {
    likelihood: &'a Likelihood,
    total: u64,
    /// ln L of the likeliest S.
    top: f64,
    /// B, the number of outcomes.
    shots: f64,
    pieces: Vec<Piece>,
}

/// The parts of the likelihood of one outcome around a place.
struct Term {
    /// Number of shots with this outcome.
    count: f64,
    /// The squared envelopes of the outcome and of its mirror image.
    near: f64,
    far: f64,
    /// The distances of the place from both, in units of the register's size.
    below: f64,
    above: f64,
}

impl Integral<'_> {
    fn half(&self) -> u64 {
        self.likelihood.register.size() / 2
    }

    /// S/N at `steps` of the register, to the precision of an `f64`.
    fn amplitude(&self, steps: f64) -> f64 {
        let half = self.half() as f64;
        // Computes from the nearer end, to which the distance is more precise.
        if steps <= 0.5 * half {
            let sine = libm::sin(0.5 * PI * (steps / half));
            sine * sine
        } else {
            let sine = libm::sin(0.5 * PI * ((half - steps) / half));
            1.0 - sine * sine
        }
    }

    /// Number of integers S per step of the register at `steps`.
    fn density(&self, steps: f64) -> f64 {
        let half = self.half() as f64;
        let place = steps.min(half - steps) / half;
        self.total as f64 * (0.5 * PI / half) * libm::sin(PI * place)
    }

    /// The largest S whose phase is at most the grid point `cell`, and its distance to the grid
    /// point.
    ///
    /// The distance is N times the amplitude at the grid point, less S.
    fn good_below(&self, cell: u64) -> (u64, f64) {
        let theta = Double::from(cell).scale(1.0 / self.likelihood.register.size() as f64);
        let place = double::sine_squared(theta) * Double::from(self.total);
        let good = place.floor().min(self.total);
        let rest = place - Double::from(good);
        (good, rest.hi)
    }

    /// Distance in steps from the grid point `cell` to the middle between the integers on either
    /// side.
    ///
    /// Sums over the integers of neighbouring cells divide there, and so do the integrals that
    /// replace them.
    fn split(&self, cell: u64) -> f64 {
        if cell == 0 || cell == self.half() {
            return 0.0;
        }
        let (_, rest) = self.good_below(cell);
        (0.5 - rest) / self.density(cell as f64)
    }

    /// The integers of the cells `first .. last`, as a range.
    fn range(&self, first: u64, last: u64) -> std::ops::RangeInclusive<u64> {
        let low = if first == 0 {
            0
        } else {
            self.good_below(first).0 + 1
        };
        let high = if last == self.half() {
            self.total
        } else {
            self.good_below(last).0
        };
        low..=high
    }

    fn integers(&mut self, first: u64, last: u64) {
        for good in first..=last {
            let phase = Phase::from_counts(good, self.total, &self.likelihood.register);
            let mass = libm::exp(self.likelihood.at(phase) - self.top);
            let amplitude = good as f64 / self.total as f64;
            self.pieces.push(Piece {
                low: amplitude,
                high: amplitude,
                integers: 1.0,
                mass,
                moment: mass * amplitude,
            });
        }
    }

    fn cells(&mut self) {
        let half = self.half();
        let mut near = BTreeSet::new();
        for &(outcome, _) in &self.likelihood.outcomes {
            near.extend(outcome.saturating_sub(NEAR)..(outcome + NEAR).min(half));
        }
        let mut end = 0;
        for &cell in &near {
            self.far(end, cell);
            self.near(cell);
            end = cell + 1;
        }
        self.far(end, half);
    }

    /// True if the likelihood in `cell` is low enough to leave the cell out.
    fn is_negligible(&self, cell: u64) -> bool {
        let floor = self.top + NEGLIGIBLE;
        // `bound` takes cells of the window's own division. Those of the sine window are centred on
        // grid points, so two of them cover this cell.
        let neighbours = match self.likelihood.register.window {
            Window::Rect => cell..=cell,
            Window::Sine => cell..=(cell + 1).min(self.half()),
        };
        neighbours
            .into_iter()
            .all(|cell| self.likelihood.bound(cell, floor) < floor)
    }

    fn near(&mut self, cell: u64) {
        if self.is_negligible(cell) {
            return;
        }
        let panels = 3 + self.shots.sqrt().ceil() as u64;
        let range = self.range(cell, cell + 1);
        if range.is_empty() {
            return;
        }
        // At the ends of the range, a sum also differs from its integral by its slope.
        let is_end = cell == 0 || cell + 1 == self.half();
        let few = if is_end { FEW_AT_ENDS } else { 16 * panels };
        if range.end() - range.start() < few {
            self.integers(*range.start(), *range.end());
            return;
        }
        // A sum over integers exceeds its integral by half of the term at either end.
        for end in [0, self.total] {
            if range.contains(&end) {
                self.integers(end, end);
                if let Some(piece) = self.pieces.last_mut() {
                    piece.mass *= 0.5;
                    piece.moment *= 0.5;
                    piece.integers = 0.5;
                }
            }
        }
        let start = self.split(cell);
        let width = (1.0 + self.split(cell + 1) - start) / panels as f64;
        for panel in 0..panels {
            self.panel(cell, start + panel as f64 * width, width);
        }
    }

    /// Integrates over a panel of a near cell.
    fn panel(&mut self, cell: u64, start: f64, width: f64) {
        let value = |place: f64| self.likelihood.at(Phase::at(cell, place));
        // After many repetitions most of a cell is negligible.
        let is_empty =
            |fraction: f64| value(start + fraction * width) < self.top + NEGLIGIBLE - 8.0;
        if self.shots > 64.0 && [0.1, 0.5, 0.9].into_iter().all(is_empty) {
            return;
        }
        let steps = cell as f64;
        let piece = self.quadrature(steps + start, steps + start + width, |offset| {
            libm::exp(value(start + 0.5 * width + 0.5 * width * offset) - self.top)
        });
        self.pieces.push(piece);
    }

    /// Integrates over the integers between `low` and `high`; `likelihood` takes offsets in [-1,
    /// 1].
    fn quadrature(&self, low: f64, high: f64, likelihood: impl Fn(f64) -> f64) -> Piece {
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
        let (mut mass, mut moment, mut integers) = (0.0, 0.0, 0.0);
        for (node, weight) in NODES {
            for offset in [-node, node] {
                let place = middle + reach * offset;
                let count = weight * reach * self.density(place);
                let part = count * likelihood(offset);
                integers += count;
                mass += part;
                moment += part * self.amplitude(place);
            }
        }
        Piece {
            low: self.amplitude(low),
            high: self.amplitude(high),
            integers,
            mass,
            moment,
        }
    }

    /// Integrates over the cells `first .. last`, which are far from all outcomes.
    fn far(&mut self, first: u64, last: u64) {
        // Between two outcomes the bound is convex: if both ends are negligible, so is the inside.
        if first >= last || (self.is_negligible(first) && self.is_negligible(last - 1)) {
            return;
        }
        // Each end of the gap is `NEAR` cells away from an outcome, or is an end of the range.
        let mut start = first;
        while start < last {
            let left = if first == 0 {
                u64::MAX
            } else {
                start - first + NEAR
            };
            let right = if last == self.half() {
                u64::MAX
            } else {
                last - start + NEAR
            };
            // A panel is at most half as wide as the distance to the nearest outcome, from either
            // end.
            let distance = left.min(right / 2).min(self.half());
            let end = start + (distance / 2).max(1);
            let end = if end + NEAR / 2 > last { last } else { end };
            self.far_panel(start, end);
            start = end;
        }
    }

    fn far_panel(&mut self, first: u64, last: u64) {
        let range = self.range(first, last);
        if range.is_empty() {
            return;
        }
        if ((range.end() - range.start()) as f64) < FEW_FAR {
            self.integers(*range.start(), *range.end());
            return;
        }
        let (low, high) = (
            first as f64 + self.split(first),
            last as f64 + self.split(last),
        );
        let piece = self.quadrature(low, high, |offset| {
            self.average(0.5 * (low + high) + 0.5 * (high - low) * offset)
        });
        self.pieces.push(piece);
    }

    /// The likelihood around `place`, averaged over a step.
    ///
    /// Within a step the likelihood is a trigonometric polynomial whose degree is the number of
    /// repetitions. Below 32 repetitions the number of points makes the average exact.
    fn average(&self, place: f64) -> f64 {
        let register = &self.likelihood.register;
        let size = register.size() as f64;
        let terms: Vec<Term> = (self.likelihood.outcomes.iter())
            .map(|&(outcome, count)| {
                let y = outcome as f64;
                let sum = place + y;
                let near = register.envelope((place - y).abs());
                let far = if outcome == 0 || outcome == self.half() {
                    0.0
                } else {
                    register.envelope(sum.min(size - sum))
                };
                Term {
                    count,
                    near: near * near,
                    far: far * far,
                    below: (place - y) / size,
                    above: sum / size,
                }
            })
            .collect();
        let wave = |place: f64, shift: f64| {
            let wave = match register.window {
                Window::Rect => libm::sin(PI * place),
                Window::Sine => libm::cos(PI * (place + shift)),
            };
            wave * wave
        };
        let points = if self.shots < 32.0 {
            self.shots + 1.0
        } else {
            (4.0 * self.shots.sqrt()).ceil() + 8.0
        };
        let mut sum = 0.0;
        for point in 0..points as u64 {
            let place = (point as f64 + 0.5) / points;
            let ln: f64 = (terms.iter())
                .map(|term| {
                    let near = term.near * wave(place, term.below);
                    term.count * libm::log(near + term.far * wave(place, term.above))
                })
                .sum();
            sum += libm::exp(ln - self.top);
        }
        sum / points
    }
}
