//! Double-double numbers: 106 bits as an unevaluated sum of two `f64`.
//!
//! At T = 2^40 the distribution depends on T theta modulo 1, of which an `f64` theta has only 12
//! bits: theta itself needs more than 53 bits. The arithmetic is Dekker's (*A floating-point
//! technique for extending the available precision*, 1971). Products split their factors instead of
//! using a fused multiply-add, which is a slow call unless the build assumes the instruction.

use std::ops::{Add, Mul, Neg, Sub};

/// `hi + lo` with `|lo| <= ulp(hi) / 2`. Relative error of each operation: a few 2^-104.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Double {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

/// pi to 107 bits.
pub(crate) const PI: Double = Double {
    hi: std::f64::consts::PI,
    lo: 1.224_646_799_147_353_2e-16,
};

fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let b_part = hi - a;
    Double {
        hi,
        lo: (a - (hi - b_part)) + (b - b_part),
    }
}

fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double {
        hi,
        lo: b - (hi - a),
    }
}

fn split(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

fn two_product(a: f64, b: f64) -> Double {
    let hi = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let lo = ((a_high * b_high - hi) + a_high * b_low + a_low * b_high) + a_low * b_low;
    Double { hi, lo }
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { hi: value, lo: 0.0 }
    }
}

impl From<u64> for Double {
    /// Converts exactly: two `f64` hold any 64-bit integer.
    fn from(value: u64) -> Self {
        let high = (value >> 32) << 32;
        two_sum(high as f64, (value - high) as f64)
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = two_sum(self.hi, other.hi);
        let low = two_sum(self.lo, other.lo);
        let first = quick_two_sum(high.hi, high.lo + low.hi);
        quick_two_sum(first.hi, first.lo + low.lo)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.hi, other.hi);
        quick_two_sum(
            product.hi,
            product.lo + (self.hi * other.lo + self.lo * other.hi),
        )
    }
}

impl Double {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    pub(crate) const ONE: Self = Self { hi: 1.0, lo: 0.0 };

    /// Multiplies by `factor`; exact if `factor` is a power of two.
    pub(crate) fn scale(self, factor: f64) -> Self {
        Self {
            hi: self.hi * factor,
            lo: self.lo * factor,
        }
    }

    /// Divides by `divisor`, which is not zero.
    pub(crate) fn divide(self, divisor: Self) -> Self {
        let first = self.hi / divisor.hi;
        let rest = self - divisor * Self::from(first);
        let second = rest.hi / divisor.hi;
        let rest = rest - divisor * Self::from(second);
        quick_two_sum(first, second) + Self::from(rest.hi / divisor.hi)
    }

    fn divide_by(self, divisor: f64) -> Self {
        let first = self.hi / divisor;
        let back = two_product(first, divisor);
        quick_two_sum(first, ((self.hi - back.hi) - back.lo + self.lo) / divisor)
    }

    /// Square root of a number that is not negative.
    pub(crate) fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - two_product(root, root);
        quick_two_sum(root, rest.hi / (2.0 * root))
    }

    /// (sin, cos) of an angle of at most slightly more than pi/4, with errors of a few 2^-104.
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let square = self * self;
        let (mut sine, mut cosine) = (Self::ONE, Self::ONE);
        // Horner's scheme up to x^29 / 29! < 2^-112.
        for k in (1..=14).rev() {
            let even = f64::from(2 * k);
            sine = Self::ONE - (square * sine).divide_by(even * (even + 1.0));
            cosine = Self::ONE - (square * cosine).divide_by(even * (even - 1.0));
        }
        (self * sine, cosine)
    }

    /// The largest integer not above a number in [0, 2^64).
    pub(crate) fn floor(self) -> u64 {
        let high = self.hi.floor();
        let rest = (self.hi - high) + self.lo;
        // 2^64 - 1 has hi = 2^64, lo = -1.
        u64::try_from(high as i128 + rest.floor() as i128).unwrap_or(u64::MAX)
    }
}

/// theta = asin(sqrt(a)) / pi in [0, 1/2], for `good` = a and `bad` = 1 - a.
///
/// Takes one Newton step from the `f64` arc tangent. The step cubes its error of 2^-53 radians.
pub(crate) fn theta(good: Double, bad: Double) -> Double {
    let (sine, cosine) = (good.sqrt(), bad.sqrt());
    let mirrored = sine.hi > cosine.hi;
    let (sine, cosine) = if mirrored {
        (cosine, sine)
    } else {
        (sine, cosine)
    };
    let start = Double::from(libm::atan2(sine.hi, cosine.hi));
    let (sine0, cosine0) = start.sin_cos();
    let turns = (start + (sine * cosine0 - cosine * sine0)).divide(PI);
    if mirrored {
        Double::from(0.5) - turns
    } else {
        turns
    }
}

/// sin(pi theta)^2 for theta in [0, 1/2].
pub(crate) fn sine_squared(theta: Double) -> Double {
    let mirrored = theta.hi > 0.25;
    let turns = if mirrored {
        Double::from(0.5) - theta
    } else {
        theta
    };
    let (sine, cosine) = (turns * PI).sin_cos();
    if mirrored {
        cosine * cosine
    } else {
        sine * sine
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use astro_float_num::{BigFloat, Consts, RoundingMode};

    const P: usize = 256;
    const RM: RoundingMode = RoundingMode::ToEven;

    fn big(value: Double) -> BigFloat {
        BigFloat::from_f64(value.hi, P).add(&BigFloat::from_f64(value.lo, P), P, RM)
    }

    fn close(value: Double, expected: &BigFloat, tolerance: f64) {
        let difference = big(value).sub(expected, P, RM).abs();
        assert!(
            difference
                .cmp(&BigFloat::from_f64(tolerance, P))
                .is_some_and(|c| c <= 0),
            "{value:?} is not {expected} (off by {difference})"
        );
    }

    #[test]
    fn pi_and_integers_are_exact_to_their_last_bit() {
        let mut consts = Consts::new().unwrap();
        close(PI, &consts.pi(P, RM), 1e-32);
        for value in [
            0,
            1,
            u64::MAX,
            u64::MAX - 1,
            (1 << 62) + 1,
            0xdead_beef_1234_5679,
        ] {
            close(Double::from(value), &BigFloat::from_u64(value, P), 0.0);
            assert_eq!(Double::from(value).floor(), value);
        }
    }

    #[test]
    fn theta_and_its_inverse_hold_to_thirty_digits() {
        let mut consts = Consts::new().unwrap();
        let totals = [1, 3, 10, 4096, 999_999_999_989, (1 << 62) - 57, 1 << 62];
        for total in totals {
            for good in [
                0,
                1,
                total / 7,
                total / 3,
                total / 2,
                total - total / 5,
                total - 1,
                total,
            ] {
                let a = Double::from(good).divide(Double::from(total));
                let b = Double::from(total - good).divide(Double::from(total));
                let exact = BigFloat::from_u64(good, P)
                    .div(&BigFloat::from_u64(total, P), P, RM)
                    .sqrt(P, RM)
                    .asin(P, RM, &mut consts)
                    .div(&consts.pi(P, RM), P, RM);
                let found = theta(a, b);
                close(found, &exact, 1e-31);
                let exact = BigFloat::from_u64(good, P).div(&BigFloat::from_u64(total, P), P, RM);
                close(sine_squared(found), &exact, 1e-30);
            }
        }
    }
}
