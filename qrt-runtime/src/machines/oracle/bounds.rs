//! Rounding errors of colours near their bound.

/// Thresholds beyond the bound that are no fault, out of `2^bits`, for colours of `fraction` bits: a
/// sixty-fourth of the bound, or sixteen units in the last place where these are more.
///
/// A colour is a sum of products of weights, each rounded to `fraction` bits. The example scenes exceed
/// their bounds by nothing at 8 to 16 bits; a refraction or a lamp too many adds a fourth or more.
pub(super) fn slack(bits: u32, fraction: u32) -> i64 {
    let most = 1_i64 << bits;
    let ulps = (16 << bits) >> fraction;
    (most >> 6).max(ulps).max(1)
}

#[cfg(test)]
mod tests {
    use super::slack;

    #[test]
    fn coarse_numbers_may_be_further_off() {
        assert_eq!(slack(10, 16), 16);
        assert_eq!(slack(10, 4), 1024);
        assert_eq!(slack(2, 16), 1);
        assert_eq!(slack(30, 30), 1 << 24);
    }
}
