//! Constants, exactly as they are written.

/// `units * 2^-fraction`, with the fewest fraction bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Constant {
    pub(super) units: i64,
    pub(super) fraction: u32,
}

/// The reason why decimal digits are not an exact constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Inexact {
    /// No number of fraction bits is enough: the constant has no last bit.
    Never,
    /// The constant needs more bits than a number can have.
    TooLong,
}

impl Constant {
    /// Reads decimal digits, with an optional point and exponent.
    pub(super) fn read(digits: &str) -> Result<Self, Inexact> {
        let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
        let exponent: i32 = exponent.parse().map_err(|_| Inexact::TooLong)?;
        let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let part = part.trim_end_matches('0');
        let all: i128 = format!("{whole}{part}")
            .parse()
            .map_err(|_| Inexact::TooLong)?;
        let mut places = part.len() as i32 - exponent;
        let mut number = all;
        while places < 0 {
            number = number.checked_mul(10).ok_or(Inexact::TooLong)?;
            places += 1;
        }
        // A division by 10 divides by 2 and by 5, and fifths have no last bit.
        for _ in 0..places {
            if number % 5 != 0 {
                return Err(Inexact::Never);
            }
            number /= 5;
        }
        let mut fraction = places.cast_unsigned();
        while fraction > 0 && number % 2 == 0 {
            number /= 2;
            fraction -= 1;
        }
        let units = i64::try_from(number).map_err(|_| Inexact::TooLong)?;
        if fraction > 62 {
            return Err(Inexact::TooLong);
        }
        Ok(Self { units, fraction })
    }
}

/// Number of bits of a number, its sign included if it is negative.
pub(super) fn bits(number: i128) -> i64 {
    let size = if number < 0 { !number } else { number };
    let bits = i64::from(128 - size.leading_zeros());
    if number < 0 { bits + 1 } else { bits.max(1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact_or_refused() {
        let read = |digits| Constant::read(digits).map(|c| (c.units, c.fraction));
        assert_eq!(read("0.25"), Ok((1, 2)));
        assert_eq!(read("3"), Ok((3, 0)));
        assert_eq!(read("2.50"), Ok((5, 1)));
        assert_eq!(read("125e-3"), Ok((1, 3)));
        assert_eq!(read("1.5e1"), Ok((15, 0)));
        assert_eq!(read("0.1"), Err(Inexact::Never));
        assert_eq!(read("9223372036854775807"), Ok((i64::MAX, 0)));
        assert_eq!(read("9223372036854775808"), Err(Inexact::TooLong));
        assert_eq!(read("99999999999999999999"), Err(Inexact::TooLong));
    }

    #[test]
    fn bits_include_the_sign() {
        let all = [0, 1, 2, 255, 256, -1, -128, -129].map(bits);
        assert_eq!(all, [1, 1, 2, 8, 9, 1, 8, 9]);
    }
}
