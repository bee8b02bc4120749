//! Sizes of memory on the command line, and refusals of work that would take more.

use super::failure::Failure;
use qrt_runtime::memory::MemoryError;

/// Parses a size, for example `500M`, `1.5G` or `4GiB`: units are powers of 1,024.
pub(crate) fn size(text: &str) -> Result<u64, String> {
    let refused = || format!("`{text}` is no size: write one such as 500M or 4G");
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = text[digits.len()..].to_ascii_uppercase();
    let unit = unit.trim_end_matches('B').trim_end_matches('I');
    let power = ["", "K", "M", "G", "T"]
        .iter()
        .position(|name| *name == unit);
    let power = power.ok_or_else(refused)?;
    let number: f64 = digits.parse().map_err(|_| refused())?;
    let bytes = number * libm::exp2(10.0 * power as f64);
    let fits = bytes >= 1.0 && bytes < u64::MAX as f64;
    if fits {
        Ok(bytes as u64)
    } else {
        Err(refused())
    }
}

/// Returns the refusal, with the flag that allows more memory.
pub(crate) fn refused(error: &MemoryError) -> Failure {
    Failure::Usage(format!("{error}, or allow more with --max-memory"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        for (text, bytes) in [
            ("1024", 1024),
            ("1k", 1 << 10),
            ("500M", 500 << 20),
            ("1.5G", 3 << 29),
            ("4GiB", 4 << 30),
            ("2TB", 2 << 40),
        ] {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for text in ["", "G", "-1G", "0", "1e99", "4X", "nan", "inf", "1 G G"] {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
