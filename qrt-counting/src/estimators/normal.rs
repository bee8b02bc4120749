//! Quantiles of the normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// The z with `P(Z > z) = tail` of a standard normal number, 0 < tail <= 1/2.
///
/// Uses Winitzki's approximation of the error function's inverse, then Newton's iteration in the
/// logarithm of the tail, which is concave.
pub(super) fn normal_quantile(tail: f64) -> f64 {
    // The constants are 2/(pi c) and 1/c, with Winitzki's c = 0.147.
    let inside = 4.0 * tail * (1.0 - tail);
    let half = 4.330_746_750_799_873 + 0.5 * libm::log(inside);
    let root = (half * half - 6.802_721_088_435_374 * libm::log(inside)).sqrt();
    let mut z = (2.0 * (root - half)).max(0.0).sqrt();
    for _ in 0..4 {
        let there = 0.5 * libm::erfc(z * FRAC_1_SQRT_2);
        let density = libm::exp(-0.5 * z * z) / TAU.sqrt();
        z += there / density * libm::log(there / tail);
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with tables: 50 %, 10 %, 5 %, 2.5 %, 0.5 %, 5 sigma and 8 sigma.
    #[test]
    fn quantiles_are_those_of_tables() {
        for (tail, z) in [
            (0.5, 0.0),
            (0.1, 1.281_551_565_544_600_5),
            (0.05, 1.644_853_626_951_472_6),
            (0.025, 1.959_963_984_540_054),
            (0.005, 2.575_829_303_548_901),
            (2.866_515_718_791_939e-7, 5.0),
            (6.220_960_574_271_785e-16, 8.0),
        ] {
            let found = normal_quantile(tail);
            assert!((found - z).abs() < 1e-12, "{tail}: {found}");
        }
    }
}
