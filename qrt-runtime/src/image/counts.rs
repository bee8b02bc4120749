//! Writes the counts of a picture's channels as CSV.

use super::ImageError;
use crate::replace_file::replace_file;
use std::fmt;
use std::io::Write;
use std::path::Path;

/// One channel of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Count {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// 0, 1, 2: r, g, b.
    pub channel: usize,
    /// The channel's value: linear radiance, at least 0.
    pub value: f64,
    /// Number of good indices, S; `None` in the real model, which counts none.
    pub good: Option<u64>,
    /// N, the number of all indices.
    pub total: u64,
    /// The radiance that S = N stands for.
    pub scale: f64,
}

/// Writes `x,y,channel,value,good,total,scale` and a line for each count, all or nothing. Radiances
/// have 17 significant digits, which identify an f64 exactly.
///
/// # Errors
/// If the file system fails, or [`ImageError::NotFinite`].
pub fn write_counts(
    path: &Path,
    counts: impl IntoIterator<Item = Count>,
) -> Result<(), ImageError> {
    replace_file(path, |out| write_counts_to(out, counts)).map_err(|error| error.at(path))
}

/// Writes counts as [`write_counts`] does, to any writer.
///
/// # Errors
/// An error of `out`, as [`ImageError::Write`], or [`ImageError::NotFinite`].
///
/// ```
/// use qrt_runtime::image::{Count, write_counts_to};
/// let count = Count { x: 2, y: 0, channel: 1, value: 0.25, good: Some(4), total: 16, scale: 1.0 };
/// let mut text = Vec::new();
/// write_counts_to(&mut text, [count])?;
/// assert_eq!(
///     String::from_utf8_lossy(&text),
///     "x,y,channel,value,good,total,scale\n\
///      2,0,g,2.5000000000000000e-1,4,16,1.0000000000000000e0\n",
/// );
/// # Ok::<(), qrt_runtime::image::ImageError>(())
/// ```
pub fn write_counts_to(
    mut out: impl Write,
    counts: impl IntoIterator<Item = Count>,
) -> Result<(), ImageError> {
    writeln!(out, "x,y,channel,value,good,total,scale")?;
    for count in counts {
        let Count {
            x,
            y,
            channel,
            value,
            scale,
            ..
        } = count;
        if let Some(value) = [value, scale].into_iter().find(|value| !value.is_finite()) {
            return Err(ImageError::NotFinite {
                x,
                y,
                channel,
                value,
            });
        }
        writeln!(out, "{count}")?;
    }
    Ok(())
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            x,
            y,
            channel,
            value,
            good,
            total,
            scale,
        } = self;
        let channel = super::channel_name(*channel);
        write!(f, "{x},{y},{channel},{value:.16e},")?;
        if let Some(good) = good {
            write!(f, "{good}")?;
        }
        write!(f, ",{total},{scale:.16e}")
    }
}
