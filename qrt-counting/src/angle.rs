//! The angle of an amplitude, and its multiples.

use super::CountingError;
use super::distribution::check_counts;
use super::double::{self, Double};
use super::phase::theta_of;

/// `theta = asin(sqrt(S/N)) / pi` in turns, to 104 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle(Double);

impl Angle {
    /// Returns the angle for `good` among `total` indices.
    ///
    /// # Errors
    /// An error if `total` is 0 or `good` exceeds `total`.
    pub(crate) fn from_counts(good: u64, total: u64) -> Result<Self, CountingError> {
        check_counts(good, total)?;
        Ok(Self(theta_of(good, total)))
    }

    /// Returns the angle of the shifted circuit, `asin(sine) / pi`, in [0, 1/2].
    ///
    /// `sine` is `|a - reference| / max(reference, 1 - reference)` for a = S/N. `reference` is in
    /// [0, 1].
    ///
    /// # Errors
    /// An error if `total` is 0 or `good` exceeds `total`.
    pub(crate) fn shifted(good: u64, total: u64, reference: f64) -> Result<Self, CountingError> {
        check_counts(good, total)?;
        let reference = Double::from(reference);
        let rest = Double::ONE - reference;
        let scale = if reference.hi > 0.5 { reference } else { rest };
        let part = |ids: u64| Double::from(ids).divide(Double::from(total));
        // Uses the smaller of a and 1 - a, which has the smaller absolute rounding error.
        let difference = if good <= total - good {
            part(good) - reference
        } else {
            rest - part(total - good)
        };
        let sine = difference.divide(scale);
        let sine = if sine.hi < 0.0 { -sine } else { sine };
        if sine.hi >= 1.0 {
            return Ok(Self(Double::from(0.5)));
        }
        let rest = (Double::ONE - sine) * (Double::ONE + sine);
        Ok(Self(double::theta(sine * sine, rest)))
    }

    /// `sin^2(m pi theta)` and `cos^2(m pi theta)` for m = `multiple`.
    ///
    /// Each has an error of a few units in its own last place, plus that of m 2^-100 turns in the
    /// angle. The angle needs more precision than an `f64` has; once it is folded, an `f64` is
    /// enough for its sine.
    pub(crate) fn sine_squared(self, multiple: u64) -> (f64, f64) {
        let folded = self.folded(multiple);
        let square = |turns: f64| {
            let sine = libm::sin(std::f64::consts::PI * turns);
            sine * sine
        };
        let rest = Double::from(0.5) - folded;
        (square(folded.hi), square(rest.hi))
    }

    /// theta in units of 2^-64 turns, rounded down.
    pub(crate) fn position_of(good: u64, total: u64) -> u64 {
        theta_of(good, total)
            .scale(18_446_744_073_709_551_616.0)
            .floor()
    }

    /// The largest S whose theta is at most `position`.
    ///
    /// `position` is in units of 2^-64 turns, and at most 1/2 turn. Rounding can change S by one.
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

    /// Compares with the recurrence of Chebyshev's polynomials: `sin^2` of m times the angle of a =
    /// S/N is a polynomial in a.
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
            let angle = Angle::from_counts(good, total).unwrap();
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

    /// Compares with the arc sine of `f64`, and checks cases in which the sine is exactly 0 or 1.
    #[test]
    fn shifted_angles_are_arc_sines() {
        for (good, total) in [
            (1_u64, 3_u64),
            (300, 1000),
            (0, 7),
            (7, 7),
            (1, 1 << 60),
            (5, 8),
        ] {
            let amplitude = good as f64 / total as f64;
            for reference in [0.0, 1e-9, 0.3, 0.5, 0.625, 0.999, 1.0] {
                let angle = Angle::shifted(good, total, reference).unwrap();
                let sine = (amplitude - reference).abs() / f64::max(reference, 1.0 - reference);
                for multiple in [1_u64, 2, 3, 10, 1001] {
                    let expected = libm::sin(multiple as f64 * libm::asin(sine)).powi(2);
                    let (found, rest) = angle.sine_squared(multiple);
                    let tolerance = 1e-12 * multiple as f64 / (1.0 - sine + 1e-12).sqrt();
                    assert!(
                        (found - expected).abs() < tolerance.min(1e-6),
                        "{good}/{total} - {reference}, {multiple}: {found}, {expected}"
                    );
                    assert!((found + rest - 1.0).abs() < 1e-15);
                }
            }
        }
        assert_eq!(
            Angle::shifted(5, 8, 0.625).unwrap().sine_squared(1 << 40).0,
            0.0
        );
        assert_eq!(Angle::shifted(0, 8, 1.0).unwrap().sine_squared(1).0, 1.0);
        assert!(Angle::shifted(2, 1, 0.5).is_err());
    }

    /// Checks multiples m of 2^40 and more: theta = 1/3 for S/N = 3/4, so m theta modulo 1 depends
    /// only on m modulo 3.
    #[test]
    fn large_multiples_keep_their_place_in_the_turn() {
        let angle = Angle::from_counts(3, 4).unwrap();
        for multiple in [(1_u64 << 44) + 1, (1 << 44) - 1, 3 << 42, 1 << 40] {
            let expected = if multiple % 3 == 0 { 0.0 } else { 0.75 };
            let (sine, _) = angle.sine_squared(multiple);
            assert!((sine - expected).abs() < 1e-15, "{multiple}: {sine}");
        }
    }
}
