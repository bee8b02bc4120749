//! Maximum likelihood over the number of good indices.
//!
//! The paper's estimator takes B outcomes and a uniform prior over the N+1 values of theta_S, and
//! returns the likeliest S. It maximises `L(S) = sum_y c_y ln P(y | theta_S)`, where c_y is the
//! number of occurrences of y, in logarithms throughout. If P is zero (theta_S is on the grid, but
//! not at y), L is negative infinity and S is excluded.
//!
//! # Finding the maximum without trying every S
//!
//! For the rectangular window, in the amplitude s = sin^2(pi theta) and with p = sin^2(pi y/T),
//!
//! ```text
//! P(y) = sin^2(pi T theta)/T^2 * 2 (s + p - 2 s p)/(s - p)^2,
//! ```
//!
//! and sin^2(pi T theta) is a polynomial in s with its zeros on the grid. One pair of these zeros
//! cancels against each outcome's poles. L is therefore a sum of logarithms of linear functions of
//! s with non-negative weights, and concave in every cell between neighbouring grid points. Across
//! a gap without outcomes, from cell to cell at a fixed place within them, L is convex (sums of
//! log-convex csc^2). The search therefore walks outwards from every observed outcome, in both
//! directions, until an upper bound of L over the cell falls below the best value found. Within a
//! cell it maximises one smooth function and tries the integers beside its maximum. If cells are
//! narrower than the distance between integers, the walk goes from integer to integer instead.
//!
//! The sine window's factors have zeros of their own, about half a step off the grid, and each
//! outcome has slightly different ones. The cells of this window are the steps around grid points.
//! The search cuts each cell at the zeros of all outcomes. Between these zeros L is concave, except
//! for the effect of folding, and the search follows every peak that it finds on a grid. The bound
//! falls with the fourth power of the distance, so the walk is short here, too.

use std::collections::{BTreeMap, HashSet};

use qrt_circuit::quantum::Window;

use super::distribution::{check_counts, ln_probability, register};
use super::double::{self, Double};
use super::error::CountingError;
use super::kernel::Register;
use super::phase::Phase;

/// The largest number of integers of a cell that are tried one by one, and of steps of a climb.
const FEW: u64 = 24;
/// Number of grid steps between two zeros in the search for the sine window's peaks.
const PLACES: usize = 8;
/// Distance of two zeros, in steps of the register, below which a peak between them is unlikely.
const SLIVER: f64 = 1.0 / 16.0;

/// The likeliest number of good indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaximumLikelihood {
    /// S. Among values that are equally likely to the last bit, it is the one farthest from N/2,
    /// and of two equally far the smaller. Counting the bad indices instead therefore mirrors the
    /// answer.
    pub good: u64,
    /// ln of the probability of the outcomes, in their order, given S.
    pub ln_likelihood: f64,
}

/// Returns the number of good indices among `total` under which `outcomes` are likeliest.
///
/// `outcomes` are folded, `0 ..= T/2`, and in any order.
///
/// # Errors
///
/// No outcomes, an outcome beyond T/2, no indices, a register out of range, or outcomes that no
/// number of good indices could have given.
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::maximum_likelihood;
/// // T = 8: outcome 2 is theta = 1/4, half of the indices.
/// assert_eq!(maximum_likelihood(&[2, 2, 2], 1000, 3, Window::Rect)?.good, 500);
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
pub fn maximum_likelihood(
    outcomes: &[u64],
    total: u64,
    phase_bits: u32,
    window: Window,
) -> Result<MaximumLikelihood, CountingError> {
    check_counts(0, total)?;
    let likelihood = Likelihood::new(outcomes, register(phase_bits, window)?)?;
    likeliest(&likelihood, total)
}

/// Returns the likeliest S, as [`maximum_likelihood`] does.
pub(super) fn likeliest(
    likelihood: &Likelihood,
    total: u64,
) -> Result<MaximumLikelihood, CountingError> {
    Search::new(likelihood, total).maximize()
}

/// ln of the probability of `outcomes`, in their order, given `good` of `total` indices.
///
/// The result is negative infinity if the probability is zero.
///
/// # Errors
///
/// As [`maximum_likelihood`], and `good` above `total`.
pub fn ln_likelihood(
    outcomes: &[u64],
    good: u64,
    total: u64,
    phase_bits: u32,
    window: Window,
) -> Result<f64, CountingError> {
    check_counts(good, total)?;
    let likelihood = Likelihood::new(outcomes, register(phase_bits, window)?)?;
    Ok(likelihood.at(Phase::from_counts(good, total, &likelihood.register)))
}

/// The largest number of indices that [`posterior`] accepts.
const MAX_POSTERIOR_IDS: u64 = 1 << 24;

/// P(S | outcomes) for S = 0 ..= `total` and a uniform prior: N+1 numbers that sum to 1.
///
/// The function adds logarithms, so that no number of outcomes underflows.
///
/// # Errors
///
/// As [`maximum_likelihood`], and more than 2^24 indices.
///
/// ```
/// use qrt_circuit::quantum::Window;
/// use qrt_counting::posterior;
/// // T = 4, read as 1: half of the four indices, or, less likely, one or three of them.
/// let posterior = posterior(&[1], 4, 2, Window::Rect)?;
/// assert_eq!(posterior[0], 0.0);
/// assert!(posterior[2] > posterior[1]);
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
pub fn posterior(
    outcomes: &[u64],
    total: u64,
    phase_bits: u32,
    window: Window,
) -> Result<Vec<f64>, CountingError> {
    check_counts(0, total)?;
    if total > MAX_POSTERIOR_IDS {
        return Err(CountingError::TooManyIds {
            total,
            most: MAX_POSTERIOR_IDS,
        });
    }
    let likelihood = Likelihood::new(outcomes, register(phase_bits, window)?)?;
    let mut values: Vec<f64> = (0..=total)
        .map(|good| likelihood.at(Phase::from_counts(good, total, &likelihood.register)))
        .collect();
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return Err(CountingError::ImpossibleOutcomes);
    }
    for value in &mut values {
        *value = libm::exp(*value - largest);
    }
    let sum: f64 = values.iter().sum();
    for value in &mut values {
        *value /= sum;
    }
    Ok(values)
}

/// ln of the probability of outcomes, as a function of the phase.
pub(super) struct Likelihood {
    pub(super) register: Register,
    /// Pairs of an outcome and its number of occurrences, the most frequent first.
    pub(super) outcomes: Vec<(u64, f64)>,
}

impl Likelihood {
    pub(super) fn new(outcomes: &[u64], register: Register) -> Result<Self, CountingError> {
        let largest = register.size() / 2;
        let mut counts = BTreeMap::new();
        for &outcome in outcomes {
            if outcome > largest {
                return Err(CountingError::OutcomeOutOfRange { outcome, largest });
            }
            *counts.entry(outcome).or_insert(0_u64) += 1;
        }
        if counts.is_empty() {
            return Err(CountingError::NoOutcomes);
        }
        let mut outcomes: Vec<_> = counts.into_iter().map(|(y, c)| (y, c as f64)).collect();
        outcomes.sort_by(|a, b| b.1.total_cmp(&a.1));
        Ok(Self { register, outcomes })
    }

    pub(super) fn at(&self, phase: Phase) -> f64 {
        self.outcomes
            .iter()
            .map(|&(y, c)| c * ln_probability(&self.register, phase, y))
            .sum()
    }

    /// An upper bound of L over `cell`, from its distances to the outcomes and to their mirror
    /// images.
    ///
    /// The sum stops as soon as it is below `floor`.
    pub(super) fn bound(&self, cell: u64, floor: f64) -> f64 {
        let size = self.register.size();
        let mut bound = 0.0;
        for &(y, count) in &self.outcomes {
            let (near, far) = match self.register.window {
                Window::Rect => {
                    let near = if y <= cell { cell - y } else { y - cell - 1 };
                    (near as f64, (y + cell).min(size - y - cell - 1) as f64)
                }
                Window::Sine => {
                    let far = (y + cell).min(size - y - cell);
                    (y.abs_diff(cell) as f64 - 0.5, far as f64 - 0.5)
                }
            };
            let near = self.register.envelope(near.max(0.0));
            let far = if y == 0 || y == size / 2 {
                0.0
            } else {
                self.register.envelope(far.max(0.0))
            };
            bound += count * libm::log((near * near + far * far).min(1.0));
            if bound < floor {
                break;
            }
        }
        bound
    }
}

struct Search<'a> {
    likelihood: &'a Likelihood,
    total: u64,
    best: MaximumLikelihood,
    /// B, the number of outcomes.
    shots: f64,
    visited: HashSet<u64>,
}

impl<'a> Search<'a> {
    fn new(likelihood: &'a Likelihood, total: u64) -> Self {
        let best = MaximumLikelihood {
            good: 0,
            ln_likelihood: f64::NEG_INFINITY,
        };
        let shots = likelihood.outcomes.iter().map(|&(_, count)| count).sum();
        Self {
            likelihood,
            total,
            best,
            shots,
            visited: HashSet::new(),
        }
    }

    fn maximize(mut self) -> Result<MaximumLikelihood, CountingError> {
        let last = self.last_cell();
        for &(outcome, _) in &self.likelihood.outcomes {
            // No cell lies above T/2. The cells below the outcome belong to the second walk.
            let mut cell = (outcome <= last).then_some(outcome);
            while let Some(current) = cell {
                cell = self.step(current, true);
            }
            let mut cell = outcome.checked_sub(1);
            while let Some(current) = cell {
                cell = self.step(current, false);
            }
        }
        if self.best.ln_likelihood == f64::NEG_INFINITY {
            return Err(CountingError::ImpossibleOutcomes);
        }
        Ok(self.best)
    }

    fn last_cell(&self) -> u64 {
        let half = self.likelihood.register.size() / 2;
        match self.likelihood.register.window {
            Window::Rect => half - 1,
            Window::Sine => half,
        }
    }

    /// The ends of `cell`, in steps relative to the grid point of the same number.
    fn ends(&self, cell: u64) -> (f64, f64) {
        match self.likelihood.register.window {
            Window::Rect => (0.0, 1.0),
            Window::Sine => (
                if cell == 0 { 0.0 } else { -0.5 },
                if cell == self.last_cell() { 0.0 } else { 0.5 },
            ),
        }
    }

    /// Searches one cell. Returns the next cell in the same direction, or `None` if the walk ends.
    fn step(&mut self, cell: u64, upwards: bool) -> Option<u64> {
        if self.visited.contains(&cell) {
            return None;
        }
        let floor = self.best.ln_likelihood;
        if self.likelihood.bound(cell, floor) < floor {
            return None;
        }
        self.visited.insert(cell);
        let (low, high) = self.ends(cell);
        // Includes one integer beyond either end, so that rounding cannot lose one.
        let first = self.good_at(cell, low);
        let last = self.good_at(cell, high).saturating_add(1).min(self.total);
        if last - first <= FEW {
            for good in first..=last {
                self.consider(good);
            }
        } else {
            // Tries the ends of the whole range: `consider` prefers them if rounding causes a tie.
            if first == 0 {
                self.consider(0);
            }
            if last == self.total {
                self.consider(last);
            }
            // A tenth of the distance between integers is fine enough.
            let tolerance = (0.1 / (last - first) as f64).max(1e-10);
            let slack = 0.01 * self.shots;
            for (remainder, value) in self.peaks(cell, low, high, tolerance) {
                if value + slack >= self.best.ln_likelihood {
                    self.climb(self.good_at(cell, remainder));
                }
            }
        }
        // If the neighbouring cells hold no integer, the walk goes on to the first cell that does.
        if upwards {
            let next = (cell + 1).max(self.cell_of(last).min(self.last_cell()));
            (cell < self.last_cell()).then_some(next)
        } else {
            Some(cell.checked_sub(1)?.min(self.cell_of(first)))
        }
    }

    /// The largest S whose phase is at most `cell + remainder` steps.
    fn good_at(&self, cell: u64, remainder: f64) -> u64 {
        let steps = Double::from(cell) + Double::from(remainder);
        let theta = steps.scale(1.0 / self.likelihood.register.size() as f64);
        (double::sine_squared(theta) * Double::from(self.total))
            .floor()
            .min(self.total)
    }

    fn cell_of(&self, good: u64) -> u64 {
        let phase = Phase::from_counts(good, self.total, &self.likelihood.register);
        match self.likelihood.register.window {
            Window::Rect if phase.offset < 0.0 => phase.cell - 1,
            _ => phase.cell,
        }
    }

    fn consider(&mut self, good: u64) -> bool {
        let phase = Phase::from_counts(good, self.total, &self.likelihood.register);
        let value = self.likelihood.at(phase);
        let better = value > self.best.ln_likelihood;
        let rank = |good: u64| (good.min(self.total - good), good);
        if better || (value == self.best.ln_likelihood && rank(good) < rank(self.best.good)) {
            self.best = MaximumLikelihood {
                good,
                ln_likelihood: value,
            };
        }
        better
    }

    /// Considers the integers on either side of a peak, and further ones while they improve.
    fn climb(&mut self, good: u64) {
        self.consider(good);
        let above = (good + 1).min(self.total);
        if self.consider(above) {
            self.climb_from(above, |good| good.checked_add(1));
        } else {
            self.climb_from(good, |good| good.checked_sub(1));
        }
    }

    /// Considers further integers from `good` on while they improve, at most `FEW`.
    ///
    /// If more of them would improve, neighbours differ by rounding only.
    fn climb_from(&mut self, mut good: u64, step: impl Fn(u64) -> Option<u64>) {
        for _ in 0..FEW {
            match step(good).filter(|&next| next <= self.total) {
                Some(next) if self.consider(next) => good = next,
                _ => break,
            }
        }
    }

    /// Places and values of the peaks of L in the cell, at least of the highest one.
    fn peaks(&self, cell: u64, low: f64, high: f64, tolerance: f64) -> Vec<(f64, f64)> {
        let value = |remainder: f64| {
            let value = self.likelihood.at(Phase::at(cell, remainder));
            if value == f64::NEG_INFINITY {
                f64::MIN
            } else {
                value
            }
        };
        if self.likelihood.register.window == Window::Rect {
            return vec![maximise(value, low, high, tolerance)];
        }
        let mut edges = self.zeros(cell, low, high);
        edges.extend([low, high]);
        edges.sort_by(f64::total_cmp);
        let mut peaks = Vec::new();
        for pair in edges.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            if high - low < SLIVER {
                // Between zeros this close, the likelihood exceeds its value in the middle by at
                // most a factor of 4 per shot, if all other factors change little.
                let middle = 0.5 * (low + high);
                if value(middle) + 2.0 * self.shots >= self.best.ln_likelihood {
                    peaks.push(maximise(
                        value,
                        low,
                        high,
                        tolerance.min(0.1 * (high - low)),
                    ));
                }
                continue;
            }
            // Folding may leave several peaks, so the search follows all that show on a grid.
            let place = |i: usize| low + (high - low) * i as f64 / PLACES as f64;
            let values: Vec<f64> = (0..=PLACES).map(|i| value(place(i))).collect();
            for i in 0..=PLACES {
                let (left, right) = (i.saturating_sub(1), (i + 1).min(PLACES));
                if values[i] >= values[left] && values[i] >= values[right] {
                    peaks.push(maximise(value, place(left), place(right), tolerance));
                }
            }
        }
        peaks
    }

    /// The sine window's zeros in a cell: `y +- (k + 1/2) T/(T+1)`, k = 1, 2, ..., around every
    /// outcome y.
    ///
    /// Except for the effect of folding, L is concave between these zeros.
    fn zeros(&self, cell: u64, low: f64, high: f64) -> Vec<f64> {
        let size = self.likelihood.register.size() as f64;
        let ratio = size / (size + 1.0);
        let mut zeros = Vec::new();
        for &(y, _) in &self.likelihood.outcomes {
            let distance = cell.abs_diff(y) as f64;
            let first = ((distance - 0.5) / ratio - 0.5).floor().max(1.0) as u64;
            for k in first..first + 3 {
                let steps = (k as f64 + 0.5) * ratio - distance;
                let zero = if cell < y { -steps } else { steps };
                if low < zero && zero < high {
                    zeros.push(zero);
                }
            }
        }
        zeros
    }
}

/// Maximises a unimodal function by Brent's method; returns the place and the value.
///
/// The method (*Algorithms for minimization without derivatives*, 1973, chapter 5) fits parabolas,
/// and takes golden sections where a parabola fails.
fn maximise(value: impl Fn(f64) -> f64, mut low: f64, mut high: f64, tolerance: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let mut best = low + GOLDEN * (high - low);
    let (mut second, mut third) = (best, best);
    let mut best_value = value(best);
    let (mut second_value, mut third_value) = (best_value, best_value);
    let (mut step, mut before_last) = (0.0_f64, 0.0_f64);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if (best - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        let mut parabolic = false;
        if before_last.abs() > tolerance {
            let r = (best - second) * (best_value - third_value);
            let q = (best - third) * (best_value - second_value);
            let p = (best - third) * q - (best - second) * r;
            let q = 2.0 * (q - r);
            let (p, q) = if q > 0.0 { (-p, q) } else { (p, -q) };
            // An infinite or undefined parabola makes these comparisons false: a golden section
            // follows.
            parabolic = p.abs() < (0.5 * q * before_last).abs()
                && p > q * (low - best)
                && p < q * (high - best);
            if parabolic {
                before_last = step;
                step = p / q;
                let next = best + step;
                if next - low < 2.0 * tolerance || high - next < 2.0 * tolerance {
                    step = tolerance.copysign(middle - best);
                }
            }
        }
        if !parabolic {
            before_last = if best < middle {
                high - best
            } else {
                low - best
            };
            step = GOLDEN * before_last;
        }
        let next = best
            + if step.abs() >= tolerance {
                step
            } else {
                tolerance.copysign(step)
            };
        let next_value = value(next);
        if next_value >= best_value {
            if next < best {
                high = best;
            } else {
                low = best;
            }
            (third, third_value) = (second, second_value);
            (second, second_value) = (best, best_value);
            (best, best_value) = (next, next_value);
        } else {
            if next < best {
                low = next;
            } else {
                high = next;
            }
            if next_value >= second_value || second == best {
                (third, third_value) = (second, second_value);
                (second, second_value) = (next, next_value);
            } else if next_value >= third_value || third == best || third == second {
                (third, third_value) = (next, next_value);
            }
        }
    }
    (best, best_value)
}
