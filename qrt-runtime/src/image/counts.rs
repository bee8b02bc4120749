//! The counts behind a picture, as CSV.

use super::ImageError;
use crate::replace_file::replace_file;
use std::fmt;
use std::io::{self, Write};
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
    /// Good indices, S; the real model counts none.
    pub good: Option<u64>,
    /// N, the number of all indices.
    pub total: u64,
    /// Radiance of S = N.
    pub scale: f64,
}

/// Writes `x,y,channel,value,good,total,scale`, a line for each count, all or nothing. Radiances
/// have 17 significant digits, which name an f64 exactly.
///
/// # Errors
/// What the file system says, or [`ImageError::NotFinite`].
pub fn write_counts(
    path: &Path,
    counts: impl IntoIterator<Item = Count>,
) -> Result<(), ImageError> {
    let result = replace_file(path, |out| {
        writeln!(out, "x,y,channel,value,good,total,scale")?;
        for count in counts {
            let Count {
                x,
                y,
                channel,
                value,
                ..
            } = count;
            if !value.is_finite() || !count.scale.is_finite() {
                let value = if value.is_finite() {
                    count.scale
                } else {
                    value
                };
                return Err(Failure::Image(ImageError::NotFinite {
                    x,
                    y,
                    channel,
                    value,
                }));
            }
            writeln!(out, "{count}")?;
        }
        Ok(())
    });
    result.map_err(|failure| match failure {
        Failure::Io(source) => ImageError::Io {
            path: path.to_path_buf(),
            source,
        },
        Failure::Image(error) => error,
    })
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

enum Failure {
    Io(io::Error),
    Image(ImageError),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
