//! Measures of the difference between two pictures.

mod flip;
#[cfg(test)]
mod tests;

pub use flip::{ErrorMap, PIXELS_PER_DEGREE, flip_of_display, flip_of_radiance};

use qrt_runtime::image::Image;

/// Added to the square of the reference so that the relative error of a dark pixel stays finite, as
/// in most papers on rendering.
const DARK: f64 = 0.01;

/// The error that two pictures have different sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the pictures have {} x {} and {} x {} pixels, and those of the same size can be compared",
    .sizes[0][0], .sizes[0][1], .sizes[1][0], .sizes[1][1])]
pub struct SizesDiffer {
    /// Width and height of the reference and of the test picture, in pixels.
    pub sizes: [[u32; 2]; 2],
}

/// Errors of a picture against a reference, in the units of their pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureDifference {
    /// The root of the mean squared difference, over pixels and channels.
    pub rmse: f64,
    /// The root of the mean squared difference of red, green and blue, over pixels.
    pub rmse_rgb: [f64; 3],
    /// The mean over pixels and channels of `(test - reference)^2 / (reference^2 + 0.01)`.
    pub relative_mse: f64,
    /// The mean difference, test minus reference, of red, green and blue. Noise averages out of it.
    pub bias_rgb: [f64; 3],
    /// The mean of the reference's red, green and blue.
    pub reference_mean: [f64; 3],
    /// The largest absolute difference of a channel.
    pub greatest: f64,
}

/// Compares two pictures pixel by pixel.
///
/// # Errors
/// If the sizes differ.
///
/// ```
/// use qrt_lab::compare::difference;
/// use qrt_runtime::image::Image;
/// let image = |pixels: Vec<[f64; 3]>| Image { width: 2, height: 1, pixels, window: None };
/// let reference = image(vec![[0.0; 3], [1.0; 3]]);
/// let found = difference(&reference, &image(vec![[0.0; 3], [1.5, 1.0, 1.0]]))?;
/// assert_eq!(found.rmse_rgb, [0.125f64.sqrt(), 0.0, 0.0]);
/// assert_eq!(found.relative_mse, 0.25 / 1.01 / 6.0);
/// # Ok::<(), qrt_lab::compare::SizesDiffer>(())
/// ```
pub fn difference(reference: &Image, test: &Image) -> Result<PictureDifference, SizesDiffer> {
    same_size(reference, test)?;
    let pixels = reference.pixels.len().max(1) as f64;
    let (mut squares, mut bias, mut mean) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let (mut relative, mut greatest) = (0.0, 0.0f64);
    for (reference, test) in reference.pixels.iter().zip(&test.pixels) {
        for channel in 0..3 {
            let difference = test[channel] - reference[channel];
            squares[channel] += difference * difference;
            bias[channel] += difference;
            mean[channel] += reference[channel];
            relative += difference * difference / (reference[channel] * reference[channel] + DARK);
            greatest = greatest.max(difference.abs());
        }
    }
    Ok(PictureDifference {
        rmse: libm::sqrt(squares.iter().sum::<f64>() / (3.0 * pixels)),
        rmse_rgb: squares.map(|sum| libm::sqrt(sum / pixels)),
        relative_mse: relative / (3.0 * pixels),
        bias_rgb: bias.map(|sum| sum / pixels),
        reference_mean: mean.map(|sum| sum / pixels),
        greatest,
    })
}

fn same_size(reference: &Image, test: &Image) -> Result<(), SizesDiffer> {
    let sizes = [reference, test].map(|image| [image.width, image.height]);
    if sizes[0] == sizes[1] {
        Ok(())
    } else {
        Err(SizesDiffer { sizes })
    }
}
