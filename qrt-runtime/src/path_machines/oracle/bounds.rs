//! Rounding errors of colours near their bound.

/// Number of thresholds, out of `2^bits`, by which a colour of `fraction` bits may exceed its
/// bound: a 64th of the bound, or 16 units in the last place if these are more.
///
/// A colour is a sum of products of weights, each rounded to `fraction` bits. The example scenes do
/// not exceed their bounds at 8 to 16 bits. A refraction or a lamp too many, which is a defect,
/// adds a quarter or more.
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
