//! Arcs, which are ranges of the angle, and the query depth that can halve them.
//!
//! The fraction of good indices after k iterations, `sin^2((2k+1) pi theta)`, determines theta only
//! where it is monotone: for `m theta` between two multiples of half a turn, m = 2k+1. These ranges
//! are its *sections*. The best measurement of an arc of angles is at the largest m that keeps the
//! whole arc within one section.
//!
//! That m is the solution of an integer problem: the largest m for which no multiple of half a turn
//! lies inside `(m low, m high)`. A search downwards can take a number of steps proportional to m
//! (around theta = 1/3, say). But the number of all suitable m in a range is a difference of two
//! sums of `floor((a i + b) / 2^63)`, which Euclid's algorithm computes in logarithmic time.
//! Bisection then finds the largest m.

use crate::estimators::turns::{HALF, amplitude, of_sine_squared};

/// Angles of `low ..= high`, in units of 2^-64 turns: `low < high <= HALF`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Arc {
    pub(super) low: u64,
    pub(super) high: u64,
}

/// The multiples of theta that a circuit can measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Multiples {
    /// 2k+1, by measuring the index after k iterations.
    Odd,
    /// All multiples: also 2k, by measuring if the state has returned.
    All,
}

impl Multiples {
    /// Step and offset of the multiples: that of index i is `step i + offset`.
    fn step_offset(self) -> (u64, u64) {
        match self {
            Self::Odd => (2, 1),
            Self::All => (1, 1),
        }
    }
}

/// The largest rounding error of an angle that is computed in `f64`, in units of 2^-64 turns.
const SLACK: u64 = 1 << 14;

/// Number of candidates that are tried one by one before the bisection.
const TRIED: u64 = 64;

impl Arc {
    /// The arc of all angles: half a turn.
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
        // Invariant: no suitable multiple in `rest ..`, and at least one in `low ..`.
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

    /// Number of the first `count` multiples with a section that holds the arc.
    ///
    /// It counts only multiples of the arc that are at most half a turn wide. For these,
    /// `floor(m low) - ceil(m high) + 2`, in half turns, is 1 or 0.
    fn fitting(self, of: Multiples, count: u64) -> i128 {
        let (step, offset) = of.step_offset();
        let floors = |angle: u64, more: u64| {
            let b = product(offset, angle) + u128::from(more);
            floor_sum(u128::from(count), product(step, angle), b) as i128
        };
        floors(self.low, 0) - floors(self.high, HALF - 1) + 2 * i128::from(count)
    }

    /// The angles of a section of `multiple` at which the fraction of good indices is in
    /// `fractions`.
    pub(super) fn of_fractions(multiple: u64, section: u64, fractions: (f64, f64)) -> Self {
        let start = u128::from(section) << 63;
        let offsets = (of_sine_squared(fractions.0), of_sine_squared(fractions.1));
        let (near, far) = if section.is_multiple_of(2) {
            offsets
        } else {
            (HALF - offsets.1, HALF - offsets.0)
        };
        let near = near.saturating_sub(SLACK);
        let far = (far + SLACK).min(HALF);
        let divisor = u128::from(multiple);
        // The slack must not extend the arc beyond the section.
        let low = ((start + u128::from(near)) / divisor).max(start.div_ceil(divisor));
        let end = start + u128::from(HALF);
        let high = (start + u128::from(far))
            .div_ceil(divisor)
            .min(end / divisor);
        let high = high.min(u128::from(HALF)) as u64;
        Self {
            low: (low as u64).min(high - 1),
            high,
        }
    }

    /// The angles of both arcs; `None` if they have fewer than two in common.
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
        // Exchanges the axes: counts the points below the line along the other axis.
        count = top / modulus;
        b = top % modulus;
        (a, modulus) = (modulus, a);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use proptest::prelude::*;

    /// The largest multiple, by trying all downwards.
    fn tried(arc: Arc, of: Multiples, from: u64, to: u64) -> Option<u64> {
        (from.max(1)..=to.min(HALF / arc.width()))
            .rev()
            .filter(|multiple| of == Multiples::All || multiple % 2 == 1)
            .find(|&multiple| arc.section(multiple).is_some())
    }

    proptest! {
        #[test]
        fn sums_of_floors_are_those_of_their_terms(
            count in 0..200_u64, a in 0..u64::MAX, b in 0..=u64::MAX,
        ) {
            let term = |i: u64| (product(a, i) + u128::from(b)) >> 63;
            let sum: u128 = (0..count).map(term).sum();
            prop_assert_eq!(floor_sum(u128::from(count), a.into(), b.into()), sum);
        }

        /// Arcs around fractions of small denominators, where few multiples are suitable, and
        /// anywhere.
        #[test]
        fn the_largest_multiple_is_found_without_trying_them_all(
            near in 0..6_usize, offset in -3.0..3.0_f64, anywhere in 0.0..1.0_f64,
            width in 2.0..13.0_f64, from in 1..3000_u64, span in 0..4000_u64,
            all in any::<bool>(),
        ) {
            let width = (HALF as f64 * libm::exp2(-width)) as u64;
            let centre = [0.0, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, anywhere][near];
            let shift = if near == 5 { 0.0 } else { offset * width as f64 };
            let low = (centre * HALF as f64 + shift).max(0.0) as u64;
            let low = low.min(HALF - width);
            let arc = Arc { low, high: low + width };
            let of = if all { Multiples::All } else { Multiples::Odd };
            let found = arc.largest_multiple(of, from, from + span);
            prop_assert_eq!(found, tried(arc, of, from, from + span));
        }

        #[test]
        fn arcs_of_shares_hold_the_angles_with_those_shares(
            angle in 1..HALF, power in 0..40_u32, low in 0.0..0.2_f64, high in 0.0..0.2_f64,
        ) {
            let multiple = (1 << power) + 1;
            let section = (product(multiple, angle) >> 63) as u64;
            let fraction = crate::estimators::turns::sine_squared(multiple.wrapping_mul(angle)).0;
            let fractions = ((fraction - low).max(0.0), (fraction + high).min(1.0));
            let arc = Arc::of_fractions(multiple, section, fractions);
            prop_assert!(arc.low <= angle && angle <= arc.high);
            prop_assert_eq!(arc.section(multiple), Some(section));
        }
    }

    /// Checks arcs around 1/3 of half a turn, where the suitable multiples are far below the limit.
    ///
    /// No multiple of 3 is suitable, and of the others those of at most 2/3 of the limit that the
    /// width sets. There can be more than 10^11 candidates above them, too many to try.
    #[test]
    fn structure_at_any_depth_is_seen() {
        let mut stream = Stream::new(1, 0, 0, 0);
        for power in 10..44 {
            let width = (HALF >> power) + stream.next_u64() % 100;
            let arc = Arc {
                low: HALF / 3 - width / 2,
                high: HALF / 3 - width / 2 + width,
            };
            let found = arc.largest_multiple(Multiples::All, 1, u64::MAX >> 8);
            let largest = found.unwrap() as f64 / libm::exp2(f64::from(power));
            assert!((largest - 2.0 / 3.0).abs() < 0.01, "{power}: {largest}");
            let odd = arc
                .largest_multiple(Multiples::Odd, 1, u64::MAX >> 8)
                .unwrap();
            assert!(odd % 2 == 1 && !odd.is_multiple_of(3) && found <= Some(odd + 4));
        }
    }
}
