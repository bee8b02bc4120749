//! Materials of the scene language for the physically based materials of mesh files.

use crate::scene::{Ggx, Material, Mirror, Rgb};
use std::ops::RangeInclusive;

/// The index of refraction of glass whose file has none.
pub(in crate::front) const GLASS: f64 = 1.5;

/// Indices of refraction that a dielectric may have.
pub(in crate::front) const IORS: RangeInclusive<f64> = 1e-3..=1e3;

/// Maximum exponent of a Phong surface.
pub(in crate::front) const MOST_EXPONENT: f64 = 1e6;

/// Maximum roughness of a metal that is taken as a mirror: its lobe is narrower than a degree.
const SMOOTH: f64 = 0.1;

/// Returns the metal that reflects `colour`. Its `roughness`, from 0 to 1, is the square root of
/// the width of the GGX distribution, as in Burley's model, which Blender and glTF use.
pub(in crate::front) fn metal(colour: Rgb, roughness: f64) -> Material {
    if roughness < SMOOTH {
        let reflectance = colour.into();
        return Mirror { reflectance }.into();
    }
    let ggx = Ggx {
        alpha: roughness * roughness,
        reflectance: colour.into(),
    };
    ggx.into()
}
