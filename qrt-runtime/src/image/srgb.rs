//! The display transform: linear light to the 8-bit levels of sRGB (IEC 61966-2-1).

/// The sRGB transfer function: linear 0 to 1 to encoded 0 to 1.
#[cfg(any(test, feature = "png"))]
pub(super) fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The inverse of the sRGB transfer function: an encoded level from 0 to 1, as in PNG, to linear
/// light from 0 to 1 (IEC 61966-2-1).
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// The 8-bit level nearest to a linear value, and true if the value is clipped: if its nearest
/// level would be below 0 or above 255.
#[cfg(any(test, feature = "png"))]
pub(super) fn level(linear: f64) -> (u8, bool) {
    let level = libm::floor(encode(linear) * 255.0 + 0.5);
    (
        level.clamp(0.0, 255.0) as u8,
        !(0.0..=255.0).contains(&level),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_and_every_boundary_between_levels_is_right() {
        for l in 0..=255u8 {
            let linear = decode(f64::from(l) / 255.0);
            // The standard's rounded constants leave the two branches 3e-8 apart.
            assert!(
                (encode(linear) * 255.0 - f64::from(l)).abs() < 1e-5,
                "level {l}"
            );
            assert_eq!(level(linear), (l, false));
            if l < 255 {
                let boundary = decode((f64::from(l) + 0.5) / 255.0);
                assert_eq!(level(boundary - 1e-8), (l, false));
                assert_eq!(level(boundary + 1e-8), (l + 1, false));
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_clipped_and_said_to_be() {
        assert_eq!(level(1.0 + 1e-12), (255, false));
        assert_eq!(level(1.01), (255, true));
        assert_eq!(level(f64::INFINITY), (255, true));
        assert_eq!(level(-1e-12), (0, false));
        assert_eq!(level(-0.01), (0, true));
        assert_eq!(level(1e-300), (0, false));
    }
}
