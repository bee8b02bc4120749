//! Angles as integers: multiples of 2^-64 turns.
//!
//! With S/N = sin^2(pi theta), theta in [0, 1/2] turns is an integer in `0 ..= 2^63`. A multiple of
//! it, modulo a turn, is a wrapping product, which is exact for any number of iterations. The 64
//! bits give theta to 5e-20 turns, and the phase after 2^44 iterations to 1e-6 turns.

use std::f64::consts::PI;

/// Half a turn: theta if all indices are good.
pub(super) const HALF: u64 = 1 << 63;

/// Factor from theta in units of 2^-64 turns to `pi theta` in radians.
const RADIANS: f64 = PI / 18_446_744_073_709_551_616.0;

/// `(sin^2, cos^2)` of pi times an angle, given modulo a turn.
pub(super) fn sine_squared(angle: u64) -> (f64, f64) {
    let folded = angle.min(angle.wrapping_neg());
    let mirrored = folded > HALF / 2;
    let small = if mirrored { HALF - folded } else { folded };
    let (sine, cosine) = libm::sincos(small as f64 * RADIANS);
    if mirrored {
        (cosine * cosine, sine * sine)
    } else {
        (sine * sine, cosine * cosine)
    }
}

/// The amplitude S/N of an angle in `0 ..= HALF`.
pub(super) fn amplitude(angle: u64) -> f64 {
    sine_squared(angle).0.clamp(0.0, 1.0)
}

/// The angle in `0 ..= HALF` whose sine squared is `sine`, precise to 2^-50 turns.
pub(super) fn of_sine_squared(sine: f64) -> u64 {
    let radians = libm::atan2(sine.max(0.0).sqrt(), (1.0 - sine).max(0.0).sqrt());
    ((radians / RADIANS) as u64).min(HALF)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_amplitudes_are_inverses() {
        for i in 0..=1000 {
            let a = f64::from(i) / 1000.0;
            assert!((amplitude(of_sine_squared(a)) - a).abs() < 4e-16, "{a}");
        }
        assert_eq!((of_sine_squared(0.0), of_sine_squared(1.0)), (0, HALF));
        assert_eq!((amplitude(0), amplitude(HALF)), (0.0, 1.0));
        // 1/6 of a turn is 30 degrees of the sine's argument.
        assert!((amplitude(HALF / 3) - 0.25).abs() < 1e-15);
    }

    #[test]
    fn phases_repeat_after_a_turn_and_mirror_at_half() {
        for angle in [1_u64, 12345, HALF / 3, HALF / 2, HALF - 7] {
            let (sine, cosine) = sine_squared(angle);
            assert_eq!(sine_squared(angle.wrapping_neg()), (sine, cosine));
            assert!((sine + cosine - 1.0).abs() < 4e-16);
            let (mirrored, other) = sine_squared(HALF - angle);
            assert!((mirrored - cosine).abs() < 4e-16 && (other - sine).abs() < 4e-16);
        }
    }
}
