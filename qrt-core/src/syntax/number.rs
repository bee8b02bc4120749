//! Numbers as they are shown.

/// The shortest text that reads back as `value`.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return ".nan".into();
    }
    if value.is_infinite() {
        return if value > 0.0 {
            ".inf".into()
        } else {
            "-.inf".into()
        };
    }
    let mut text = format!("{value:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}

/// `1234567` as `1,234,567`.
///
/// ```
/// assert_eq!(qrt_core::syntax::grouped(1_234_567), "1,234,567");
/// assert_eq!(qrt_core::syntax::grouped(12), "12");
/// ```
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3 + 1);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Six decimals for a person, or three where they would not do.
pub(crate) fn rounded(x: f64) -> String {
    let exponent = x.abs().log10();
    if x == 0.0 || (-4.0..6.0).contains(&exponent) {
        let text = format!("{x:.6}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text.is_empty() || text == "-" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    } else {
        format!("{x:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        for (number, text) in [
            (0, "0"),
            (999, "999"),
            (1000, "1,000"),
            (u64::MAX, "18,446,744,073,709,551,615"),
        ] {
            assert_eq!(grouped(number), text);
        }
    }

    #[test]
    fn numbers_are_the_shortest_that_read_back() {
        for (value, text) in [
            (1.0, "1"),
            (0.1, "0.1"),
            (1e-12, "1e-12"),
            (-2.5, "-2.5"),
            (1e22, "1e22"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
