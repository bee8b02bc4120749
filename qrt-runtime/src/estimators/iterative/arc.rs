//! Ranges of the angle, and the depth at which they can be halved.
//!
//! The share of good ids after k iterations, `sin^2((2k+1) pi theta)`, tells theta only where it is
//! monotone: `m theta` between two multiples of half a turn, m = 2k+1. Those are its *sections*. An
//! arc of angles is measured best at the largest m that keeps the whole arc within one section.
//!
//! To find it is a problem of integers: the largest m for which no multiple of half a turn lies
//! inside `(m low, m high)`. Tried downwards, that can take as many steps as m is large (around
//! theta = 1/3, say). But the number of all m in a range that will do is a difference of two sums of
//! `floor((a i + b) / 2^63)`, which Euclid's algorithm adds up in logarithmic time; so the largest is
//! found by bisection.

use crate::estimators::turns::{HALF, amplitude, of_sine_squared};

/// Angles of `low ..= high`, in units of 2^-64 turns: `low < high <= HALF`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Arc {
    pub(super) low: u64,
    pub(super) high: u64,
}

/// Which multiples of theta a circuit can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Multiples {
    /// 2k+1, by measuring the id after k iterations.
    Odd,
    /// All: 2k also, by measuring whether the state has returned.
    All,
}

impl Multiples {
    /// The multiple of index i, `step i + offset`.
    fn step_offset(self) -> (u64, u64) {
        match self {
            Self::Odd => (2, 1),
            Self::All => (1, 1),
        }
    }
}

/// What rounding may take from an angle that comes out of an `f64`, in units of 2^-64 turns.
const SLACK: u64 = 1 << 14;

/// Candidates that are tried one by one, before they are counted.
const TRIED: u64 = 64;

impl Arc {
    /// All angles.
    pub(super) const ALL: Self = Self { low: 0, high: HALF };

    pub(super) fn width(self) -> u64 {
        self.high - self.low
    }

    /// S/N at both ends.
    pub(super) fn amplitudes(self) -> (f64, f64) {
        (amplitude(self.low), amplitude(self.high))
    }

    /// Half the distance of the amplitudes at both ends.
    pub(super) fn error(self) -> f64 {
        let (low, high) = self.amplitudes();
        0.5 * (high - low)
    }

    /// The section of `multiple` that holds the whole arc, counted from zero.
    pub(super) fn section(self, multiple: u64) -> Option<u64> {
        let first = product(multiple, self.low) >> 63;
        let inside = product(multiple, self.high) <= (first + 1) << 63;
        inside.then_some(first as u64)
    }

    /// The largest multiple in `from ..= to` with a section that holds the whole arc.
    pub(super) fn largest_multiple(self, of: Multiples, from: u64, to: u64) -> Option<u64> {
        let (step, offset) = of.step_offset();
        let to = to.min(HALF / self.width());
        if to < from.max(offset) {
            return None;
        }
        let first = (from.max(offset) - offset).div_ceil(step);
        let end = (to - offset) / step + 1;
        let mut rest = end;
        while rest > first && end - rest < TRIED {
            rest -= 1;
            let multiple = step * rest + offset;
            if self.section(multiple).is_some() {
                return Some(multiple);
            }
        }
        // Invariant: none in `rest ..`, and one in `low ..`.
        let all = self.fitting(of, rest);
        let mut low = first;
        if all == self.fitting(of, low) {
            return None;
        }
        while rest - low > 1 {
            let middle = low + (rest - low) / 2;
            if self.fitting(of, middle) < all {
                low = middle;
            } else {
                rest = middle;
            }
        }
        Some(step * low + offset)
    }

    /// How many of the first `count` multiples have a section that holds the arc. Counts only
    /// multiples of the arc that are at most half a turn wide: of those, `floor(m low) -
    /// ceil(m high) + 2`, in half turns, is 1 or 0.
    fn fitting(self, of: Multiples, count: u64) -> i128 {
        let (step, offset) = of.step_offset();
        let floors = |angle: u64, more: u64| {
            let b = product(offset, angle) + u128::from(more);
            floor_sum(u128::from(count), product(step, angle), b) as i128
        };
        floors(self.low, 0) - floors(self.high, HALF - 1) + 2 * i128::from(count)
    }

    /// The angles of a section of `multiple` at which the share of good ids is in `shares`.
    pub(super) fn of_shares(multiple: u64, section: u64, shares: (f64, f64)) -> Self {
        let start = u128::from(section) << 63;
        let offsets = (of_sine_squared(shares.0), of_sine_squared(shares.1));
        let (near, far) = if section.is_multiple_of(2) {
            offsets
        } else {
            (HALF - offsets.1, HALF - offsets.0)
        };
        let near = near.saturating_sub(SLACK);
        let far = (far + SLACK).min(HALF);
        let divisor = u128::from(multiple);
        let low = (start + u128::from(near)) / divisor;
        let high = (start + u128::from(far)).div_ceil(divisor);
        let high = high.min(u128::from(HALF)) as u64;
        Self {
            low: (low as u64).min(high - 1),
            high,
        }
    }

    /// The angles of both; none if they have less than two in common.
    pub(super) fn intersection(self, other: Self) -> Option<Self> {
        let low = self.low.max(other.low);
        let high = self.high.min(other.high);
        (low < high).then_some(Self { low, high })
    }
}

fn product(a: u64, b: u64) -> u128 {
    u128::from(a) * u128::from(b)
}

/// The sum of `floor((a i + b) / 2^63)` over `0 <= i < count`.
fn floor_sum(mut count: u128, mut a: u128, mut b: u128) -> u128 {
    let mut modulus = u128::from(HALF);
    let mut sum = 0;
    loop {
        if a >= modulus {
            sum += count * count.saturating_sub(1) / 2 * (a / modulus);
            a %= modulus;
        }
        if b >= modulus {
            sum += count * (b / modulus);
            b %= modulus;
        }
        let top = a * count + b;
        if top < modulus {
            return sum;
        }
        // Columns become rows: points below the line are counted along the other axis.
        count = top / modulus;
        b = top % modulus;
        (a, modulus) = (modulus, a);
    }
}
