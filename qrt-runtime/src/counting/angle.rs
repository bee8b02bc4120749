//! The angle of an amplitude, and its multiples.

use super::CountingError;
use super::distribution::{check_counts, theta_of};
use super::double::{self, Double};

/// `theta = asin(sqrt(S/N)) / pi` in turns, to 104 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle(Double);

impl Angle {
    /// # Errors
    /// No ids, or more good ids than ids.
    pub(crate) fn of(good: u64, total: u64) -> Result<Self, CountingError> {
        check_counts(good, total)?;
        Ok(Self(theta_of(good, total)))
    }

    /// `sin^2(m pi theta)` and `cos^2(m pi theta)`, each to its own precision: absolute errors are
    /// below `m 2^-100`.
    pub(crate) fn sine_squared(self, multiple: u64) -> (f64, f64) {
        let folded = self.folded(multiple);
        let sine = double::sine_squared(folded);
        let cosine = double::sine_squared(Double::from(0.5) - folded);
        (sine.hi.clamp(0.0, 1.0), cosine.hi.clamp(0.0, 1.0))
    }

    /// theta in units of 2^-64 turns, rounded down.
    pub(crate) fn position_of(good: u64, total: u64) -> u64 {
        theta_of(good, total)
            .scale(18_446_744_073_709_551_616.0)
            .floor()
    }

    /// The largest S whose theta is at most `position`, in units of 2^-64 turns and at most 1/2;
    /// within one, where a rounding decides.
    pub(crate) fn count_below(position: u64, total: u64) -> u64 {
        let theta = Double::from(position).scale(1.0 / 18_446_744_073_709_551_616.0);
        (double::sine_squared(theta) * Double::from(total))
            .floor()
            .min(total)
    }

    /// m theta, folded onto [0, 1/2]: sin^2 has period 1 and is even.
    fn folded(self, multiple: u64) -> Double {
        let turns = self.0 * Double::from(multiple);
        let whole = Double::from(turns.floor());
        let rest = turns - whole;
        if rest.hi > 0.5 {
            Double::ONE - rest
        } else {
            rest
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Multiples of the angle by the recurrence of Chebyshev's polynomials, in integers modulo
    /// nothing: `sin^2` of m times the angle of a = S/N is a polynomial of a.
    #[test]
    fn multiples_are_those_of_chebyshev() {
        for (good, total) in [
            (1, 3),
            (300, 1000),
            (1, 1 << 20),
            (999, 1000),
            (1, 2),
            (0, 5),
            (5, 5),
        ] {
            let angle = Angle::of(good, total).unwrap();
            // cos(2 m x) from cos(2 x) = 1 - 2a.
            let step = 1.0 - 2.0 * good as f64 / total as f64;
            let (mut before, mut now) = (1.0, step);
            for multiple in 1..40 {
                let (sine, cosine) = angle.sine_squared(multiple);
                assert!(
                    (sine - 0.5 * (1.0 - now)).abs() < 1e-12,
                    "{good}/{total} {multiple}"
                );
                assert!((sine + cosine - 1.0).abs() < 1e-15);
                (before, now) = (now, 2.0 * step * now - before);
            }
        }
    }

    /// 2^40 turns of 1/3: theta = 1/3 for S/N = 3/4, so m theta depends on m modulo 3 alone.
    #[test]
    fn large_multiples_keep_their_place_in_the_turn() {
        let angle = Angle::of(3, 4).unwrap();
        for multiple in [(1_u64 << 44) + 1, (1 << 44) - 1, 3 << 42, 1 << 40] {
            let expected = if multiple % 3 == 0 { 0.0 } else { 0.75 };
            let (sine, _) = angle.sine_squared(multiple);
            assert!((sine - expected).abs() < 1e-15, "{multiple}: {sine}");
        }
    }
}
