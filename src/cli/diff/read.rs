//! Reads pictures of any program: PNG and OpenEXR.

mod exr_picture;
mod png_colour;
mod png_picture;

pub(super) use exr_picture::exr;
pub(super) use png_picture::png;

use crate::cli::failure::Failure;
use qrt_runtime::image::Image;
use qrt_runtime::memory::Memory;
use std::path::Path;

/// A picture that was read.
pub(super) struct Picture {
    pub(super) image: Image,
    /// Position of the pixels in the display window; `None` if the format has no windows.
    pub(super) place: Option<PlaceInFrame>,
}

/// The data window of an OpenEXR file within its display window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlaceInFrame {
    /// Column and row of the top left pixel, counted from the display window's top left corner.
    pub(super) origin: [i64; 2],
    /// Width and height of the display window.
    pub(super) frame: [u64; 2],
}

/// Returns the error that refuses a file as a picture.
fn refused(path: &Path, why: &str) -> Failure {
    Failure::Job(format!("`{}`: {why}", path.display()))
}

fn check_size(path: &Path, size: [u64; 2], memory: Memory) -> Result<(), Failure> {
    let kept = memory.keep_compared(size);
    kept.map_err(|error| Failure::Usage(format!("`{}`: {error}", path.display())))
}

/// Largest difference of a chromaticity from one of Rec. 709 that still counts as rounding.
const ROUNDING: f64 = 1e-3;
/// Primaries and white of sRGB and Rec. 709: x, y of red, green, blue and white.
const REC_709: [[f64; 2]; 4] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];

/// True if red, green, blue and white are those of sRGB and Rec. 709.
fn is_rec_709(found: [[f64; 2]; 4]) -> bool {
    let found = found.iter().flatten();
    let pairs = found.zip(REC_709.iter().flatten());
    pairs.fold(true, |all, (a, b)| all && (a - b).abs() <= ROUNDING)
}

/// Describes chromaticities in words.
fn in_words(chromaticities: [[f64; 2]; 4]) -> String {
    let names = ["red", "green", "blue", "white"].into_iter();
    let each = names.zip(chromaticities);
    let each = each.map(|(name, [x, y])| format!("{name} ({x:.4}, {y:.4})"));
    each.collect::<Vec<_>>().join(", ")
}
