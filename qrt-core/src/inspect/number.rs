//! Numbers where space is short.

/// `1234567` as `1.23 M`: three digits, where space is short.
pub(super) fn short(number: u64) -> String {
    let units = [
        (1_000_000_000_000, "T"),
        (1_000_000_000, "G"),
        (1_000_000, "M"),
        (1000, "k"),
    ];
    let Some(&(size, unit)) = units.iter().find(|&&(size, _)| number >= size) else {
        return number.to_string();
    };
    let value = number as f64 / size as f64;
    let places = if value < 9.995 {
        2
    } else {
        usize::from(value < 99.95)
    };
    format!("{value:.places$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_have_three_digits() {
        for (number, text) in [
            (0, "0"),
            (999, "999"),
            (1000, "1.00 k"),
            (12_345, "12.3 k"),
            (999_949, "1000 k"),
            (5_600_000_000, "5.60 G"),
        ] {
            assert_eq!(short(number), text);
        }
    }
}
