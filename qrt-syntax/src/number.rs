//! Formats numbers for display.

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

pub use qrt_circuit::grouped;

/// Formats `x` with up to six decimals, or in scientific notation with three if its magnitude is
/// below 1e-4 or at least 1e6.
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
