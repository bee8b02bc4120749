//! Radiance in other units.

/// Converts radiance to `units`, except in channels whose unit is 0.
pub(crate) fn in_units<const C: usize>(radiance: &mut [[f64; C]], units: [f64; C]) {
    for radiance in radiance {
        for (value, unit) in radiance.iter_mut().zip(units) {
            if unit > 0.0 {
                *value /= unit;
            }
        }
    }
}
