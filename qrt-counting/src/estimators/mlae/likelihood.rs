//! The likelihood of each angle, given the measurements.
//!
//! With h_j good indices among n_j after k_j iterations, m_j = 2 k_j + 1,
//!
//! ```text
//! L(theta) = sum_j h_j ln p_j + (n_j - h_j) ln(1 - p_j),
//! p_j = r_j sin^2(m_j pi theta) + (1 - r_j) sin^2(pi theta),
//! ```
//!
//! where r_j is the probability that a shot is intact. Without noise each term is concave between
//! two multiples of half a turn of `m_j theta`, because the logarithms of sine and cosine are. L is
//! therefore concave between two angles if no term crosses a multiple between them.
//!
//! Terms are relative to their largest value, at `p = h/n`. They are never positive, and
//! differences between likely angles keep their digits for any number of shots.

use crate::binomial::{deviance, ln_probability};
use crate::estimators::turns::{HALF, sine_squared};

/// The measurements after one number of iterations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// m = 2k + 1.
    pub(super) multiple: u64,
    pub(super) hits: u64,
    pub(super) shots: u64,
    /// r, the probability that a shot is intact.
    pub(super) intact: f64,
}

/// A fraction and its complement to 1, each to its own precision.
type Fraction = (f64, f64);

impl Level {
    /// `h ln p + (n - h) ln q`, minus its largest value.
    fn term(&self, (p, _): Fraction) -> f64 {
        let (hits, shots) = (self.hits as f64, self.shots as f64);
        let difference = hits - shots * p;
        -deviance(hits, difference) - deviance(shots - hits, -difference)
    }

    fn mixed(&self, ideal: Fraction, any: Fraction) -> Fraction {
        let lost = 1.0 - self.intact;
        (
            self.intact * ideal.0 + lost * any.0,
            self.intact * ideal.1 + lost * any.1,
        )
    }

    fn fraction(&self, angle: u64, any: Fraction) -> Fraction {
        self.mixed(sine_squared(self.multiple.wrapping_mul(angle)), any)
    }

    /// An upper bound of the term over angles in `low ..= high`.
    ///
    /// `any` are the fractions of good indices among all at `low` and at `high`.
    fn bound(&self, low: u64, high: u64, any: (Fraction, Fraction)) -> f64 {
        let (least, most) = self.ideal_range(low, high);
        let least = self.mixed(least, any.0);
        let most = self.mixed(most, any.1);
        let (hits, shots) = (self.hits as f64, self.shots as f64);
        // The term rises up to p = h/n and falls from there.
        if hits <= shots * least.0 {
            self.term(least)
        } else if hits >= shots * most.0 {
            self.term(most)
        } else {
            0.0
        }
    }

    /// The smallest and the largest `(sin^2, cos^2)` of the multiple over angles in `low ..= high`.
    fn ideal_range(&self, low: u64, high: u64) -> (Fraction, Fraction) {
        let width = u128::from(self.multiple) * u128::from(high - low);
        let start = self.multiple.wrapping_mul(low);
        let end = u128::from(start) + width;
        let half = u128::from(HALF);
        let crosses =
            |multiple: u128| u128::from(start) <= multiple * half && multiple * half <= end;
        let zero = crosses(0) || crosses(2);
        let one = crosses(1) || crosses(3);
        if width >= half || (zero && one) {
            return ((0.0, 1.0), (1.0, 0.0));
        }
        let first = sine_squared(start);
        let last = sine_squared(self.multiple.wrapping_mul(high));
        let (least, most) = if first.0 <= last.0 {
            (first, last)
        } else {
            (last, first)
        };
        (
            if zero { (0.0, 1.0) } else { least },
            if one { (1.0, 0.0) } else { most },
        )
    }

    /// The derivative of the term with respect to the angle in radians.
    fn slope(&self, angle: u64) -> f64 {
        let any = sine_squared(angle);
        let (p, q) = self.fraction(angle, any);
        let double = |(sine, cosine): Fraction, positive: bool| {
            let product = 2.0 * (sine * cosine).sqrt();
            if positive { product } else { -product }
        };
        let phase = self.multiple.wrapping_mul(angle);
        let own = double(sine_squared(phase), phase < HALF);
        let all = double(any, true);
        let change = self.intact * self.multiple as f64 * own + (1.0 - self.intact) * all;
        let difference = self.hits as f64 - self.shots as f64 * p;
        if difference == 0.0 {
            0.0
        } else {
            difference / (p * q) * change
        }
    }

    /// ln of the probability of the hits.
    fn ln_probability(&self, angle: u64) -> f64 {
        let (p, q) = self.fraction(angle, sine_squared(angle));
        if p <= 0.0 || q <= 0.0 {
            return self.term((p, q));
        }
        ln_probability(self.shots as f64, p, self.hits as f64)
    }

    /// The angle inside `low .. high`, near its middle, at which this level's fraction has a
    /// turning point.
    fn turning_point(&self, low: u64, high: u64) -> Option<u64> {
        let multiple = u128::from(self.multiple);
        let half = u128::from(HALF);
        let section = |angle: u64| multiple * u128::from(angle) / half;
        let (first, last) = (
            section(low) + 1,
            (multiple * u128::from(high)).div_ceil(half),
        );
        if first >= last {
            return None;
        }
        let middle = u128::midpoint(first, last);
        let angle = (middle * half / multiple) as u64;
        (low < angle && angle < high).then_some(angle)
    }

    /// True if the fractions under different angles differ enough to matter.
    fn tells(&self) -> bool {
        self.shots as f64 * self.intact * self.intact > 1e-3
    }
}

/// All measurements of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Likelihood {
    levels: Vec<Level>,
}

impl Likelihood {
    pub(super) fn add(&mut self, level: Level) {
        self.levels.push(level);
    }

    /// The angle at which to cut `low .. high`: a turning point of the shallowest level with one
    /// inside.
    ///
    /// The result is `None` if the range is within one section of every level.
    pub(super) fn cut(&self, low: u64, high: u64) -> Option<u64> {
        let mut telling = self.levels.iter().filter(|level| level.tells());
        telling.find_map(|level| level.turning_point(low, high))
    }

    /// True if L is concave between turning points.
    pub(super) fn is_concave(&self) -> bool {
        self.levels.iter().all(|level| level.intact >= 1.0)
    }

    /// L, relative to its largest value under arbitrary fractions.
    pub(super) fn at(&self, angle: u64) -> f64 {
        let any = sine_squared(angle);
        self.levels
            .iter()
            .map(|level| level.term(level.fraction(angle, any)))
            .sum()
    }

    /// The derivative of L with respect to pi theta.
    pub(super) fn slope(&self, angle: u64) -> f64 {
        self.levels.iter().map(|level| level.slope(angle)).sum()
    }

    /// An upper bound of L over angles in `low ..= high`.
    pub(super) fn bound(&self, low: u64, high: u64) -> f64 {
        let any = (sine_squared(low), sine_squared(high));
        self.levels
            .iter()
            .map(|level| level.bound(low, high, any))
            .sum()
    }

    /// ln of the probability of all measurements.
    pub(super) fn ln_probability(&self, angle: u64) -> f64 {
        self.levels
            .iter()
            .map(|level| level.ln_probability(angle))
            .sum()
    }

    /// Numbers of good indices and shots, if all shots were paths.
    pub(super) fn paths(&self) -> Option<(u64, u64)> {
        match self.levels[..] {
            [level] if level.multiple == 1 => Some((level.hits, level.shots)),
            _ => None,
        }
    }

    /// Number of bits to which to find an angle within a section, so that its error is far below
    /// the statistical one.
    pub(super) fn digits(&self) -> u32 {
        let most = self.levels.iter().map(|level| level.shots).max();
        20 + most.unwrap_or(1).ilog2() / 2
    }
}
