//! Rounding, sine, cosine, arctangent and fifth root, by arithmetic and square roots alone.
//!
//! A loop of these over many numbers runs in vector registers, several times as fast as calls of
//! `libm`, and gives the same bits on every machine.

use std::f64::consts::{FRAC_1_PI, TAU};

/// Added to a number and taken off again, this rounds it.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
/// The part of a whole turn that [`TAU`] lacks.
const REST_OF_TAU: f64 = 2.449_293_598_294_706_4e-16;
/// Coefficients of `sin(x)/x` in powers of x squared.
const SINE: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];
/// Coefficients of `(1 - cos(x))/x^2` in powers of x squared.
const COSINE: [f64; 8] = [
    1.0 / 2.0,
    -1.0 / 24.0,
    1.0 / 720.0,
    -1.0 / 40_320.0,
    1.0 / 3_628_800.0,
    -1.0 / 479_001_600.0,
    1.0 / 87_178_291_200.0,
    -1.0 / 20_922_789_888_000.0,
];
/// Coefficients of `atan(x)/x` in powers of x squared.
const ARCTANGENT: [f64; 11] = [
    1.0,
    -1.0 / 3.0,
    1.0 / 5.0,
    -1.0 / 7.0,
    1.0 / 9.0,
    -1.0 / 11.0,
    1.0 / 13.0,
    -1.0 / 15.0,
    1.0 / 17.0,
    -1.0 / 19.0,
    1.0 / 21.0,
];

#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let mut sum = coefficients[N - 1];
    for coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + coefficient;
    }
    sum
}

/// The integer nearest to a number below 2^51; half way, the even one.
#[inline(always)]
pub(crate) fn round(x: f64) -> f64 {
    (x + ROUNDING) - ROUNDING
}

/// Sine and cosine of an angle in radians, to 2e-15 and 2e-16 of the angle; at most 2^50 turns.
#[inline(always)]
pub(crate) fn sincos(angle: f64) -> (f64, f64) {
    let turns = round(angle * (0.5 * FRAC_1_PI));
    // A quarter of the angle is at most pi/4.
    let quarter = 0.25 * ((angle - turns * TAU) - turns * REST_OF_TAU);
    let square = quarter * quarter;
    let sine = quarter * polynomial(&SINE, square);
    // 1 minus the cosine keeps its precision through both doublings.
    let below = square * polynomial(&COSINE, square);
    let (sine, below) = (2.0 * sine * (1.0 - below), 2.0 * sine * sine);
    (2.0 * sine * (1.0 - below), 1.0 - 2.0 * sine * sine)
}

/// Arctangent of a number of at most 1e150, to 1e-15 of it.
#[inline(always)]
pub(crate) fn arctangent(tangent: f64) -> f64 {
    // The tangent of half the angle; that of an eighth is at most 0.2.
    let half = |tangent: f64| tangent / (1.0 + (1.0 + tangent * tangent).sqrt());
    let eighth = half(half(half(tangent)));
    8.0 * eighth * polynomial(&ARCTANGENT, eighth * eighth)
}

/// Fifth root of a positive number, to 1e-12 of it.
#[inline(always)]
pub(crate) fn fifth_root(x: f64) -> f64 {
    // A fifth of the exponent and, roughly, the root of the significand: to 4 %.
    let mut root = f64::from_bits(x.to_bits() / 5 + (0.8 * 1022.955 * (1_u64 << 52) as f64) as u64);
    for _ in 0..2 {
        // Halley's iteration triples the number of right digits.
        let square = root * root;
        let power = square * square * root;
        root *= (4.0 * power + 6.0 * x) / (6.0 * power + 4.0 * x);
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_agree_with_libm() {
        for n in -40_000..=40_000_i32 {
            let x = f64::from(n) * 7.3e-3;
            let (sine, cosine) = sincos(x);
            let (right_sine, right_cosine) = libm::sincos(x);
            let most = 2e-15 + 2e-16 * x.abs();
            assert!((sine - right_sine).abs() < most, "sin {x}: {sine}");
            assert!((cosine - right_cosine).abs() < most, "cos {x}: {cosine}");
            let tangent = f64::from(n) * f64::from(n).abs() * 1e-6;
            let (angle, right) = (arctangent(tangent), libm::atan(tangent));
            assert!(
                (angle - right).abs() <= 1e-15 * right.abs(),
                "atan {tangent}: {angle}"
            );
        }
    }

    #[test]
    fn large_angles_are_as_precise_as_they_are_held() {
        for n in 1..1_000 {
            let x = 0.37 * libm::exp2(0.05 * f64::from(n));
            let (sine, cosine) = sincos(x);
            let (right_sine, right_cosine) = libm::sincos(x);
            let most = 2e-15 + 2e-16 * x;
            assert!((sine - right_sine).abs() < most, "sin {x}: {sine}");
            assert!((cosine - right_cosine).abs() < most, "cos {x}: {cosine}");
        }
    }

    #[test]
    fn fifth_roots_agree_with_libm() {
        for n in 0..=4_000 {
            let x = libm::exp2(-0.015 * f64::from(n));
            let (root, right) = (fifth_root(x), libm::pow(x, 0.2));
            assert!((root - right).abs() <= 1e-12 * right, "{x}: {root}");
        }
    }

    #[test]
    fn small_angles_keep_their_precision() {
        for exponent in 1..300 {
            let x = libm::exp2(-f64::from(exponent));
            let near = |value: f64, right: f64| (value - right).abs() <= 1e-15 * right.abs();
            assert!(near(sincos(x).0, libm::sin(x)), "sin 2^-{exponent}");
            assert!(near(arctangent(x), libm::atan(x)), "atan 2^-{exponent}");
        }
    }
}
