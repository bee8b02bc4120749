//! Pictures and their files.
//!
//! A picture holds linear radiance. EXR stores it unchanged, in 32-bit floats. PNG stores it for
//! display: multiplied by `2^exposure`, through the sRGB curve, in 8 bits. The metadata of both
//! record how the picture was made. Both are written whole or not at all. Each is a feature of this
//! crate, `exr` and `png`; without the feature, pictures of that kind are refused.

mod counts;
#[cfg(feature = "exr")]
mod exr_file;
mod metadata;
#[cfg(feature = "png")]
mod png_file;
mod srgb;
#[cfg(test)]
mod tests;

pub use counts::{Count, write_counts, write_counts_to};
pub use metadata::Metadata;
#[cfg(feature = "png")]
pub use png_file::read_png_metadata;
pub use srgb::decode as linear_of_srgb;

use crate::replace_file::replace_file;
use std::io;
use std::path::{Path, PathBuf};

/// A picture in linear RGB (sRGB primaries), row by row from the top, each row from the left.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<[f64; 3]>,
    /// The picture's place in a larger one, if it is a crop. EXR stores the place (as `dataWindow`
    /// within `displayWindow`), PNG does not.
    pub window: Option<CropWindow>,
}

/// The place of a picture in a larger one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropWindow {
    /// Column and row of the picture's top left pixel in the larger picture.
    pub origin: [u32; 2],
    /// Width and height of the larger picture.
    pub film: [u32; 2],
}

/// A further value of each pixel, for EXR.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The channel's name in the file, like `depth.Z`: 1 to 31 bytes, no NUL, and not R, G or B.
    pub name: String,
    /// The values row by row from the top, each row from the left.
    pub values: Vec<f64>,
}

/// The path of a picture: any path. Without the features `png` and `exr` no picture can be written,
/// and a path to write one to does not compile.
///
/// With only one of the two features, a path of the other format compiles. The path is a value, whose
/// ending the compiler does not see. [`Encoding::for_path`] then returns
/// [`ImageError::Feature`].
#[cfg_attr(
    not(any(feature = "exr", feature = "png")),
    diagnostic::on_unimplemented(
        message = "qrt was built without its features `png` and `exr`, and writes no pictures",
        label = "the path of a picture",
        note = "help: write `features = [\"png\"]`, `[\"exr\"]` or both in the line of qrt in \
                Cargo.toml"
    )
)]
pub trait PicturePath: AsRef<Path> {}

#[cfg(any(feature = "exr", feature = "png"))]
impl<T: AsRef<Path> + ?Sized> PicturePath for T {}

/// The file format of a picture. Each is a feature of the crate with that name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// 8-bit sRGB of radiance times `2^exposure`.
    #[allow(missing_docs)]
    Png { exposure: f64 },
    /// Linear 32-bit float RGB.
    Exr,
}

impl Encoding {
    /// Returns the encoding for the name of a picture, so that a wrong name is an error before the
    /// picture is rendered. `exposure` is in stops, by default 0.
    ///
    /// # Errors
    /// If the name ends neither in `.png` nor in `.exr`, the exposure is beyond 1,000 stops, an
    /// exposure is set for EXR, which has none, or the feature for that format is off.
    ///
    /// ```
    /// use qrt_runtime::image::Encoding;
    /// let encoding = Encoding::for_path("box.png", Some(1.5))?;
    /// assert_eq!(encoding, Encoding::Png { exposure: 1.5 });
    /// assert!(Encoding::for_path("box.jpg", None).is_err());
    /// # Ok::<(), qrt_runtime::image::ImageError>(())
    /// ```
    #[cfg_attr(
        not(any(feature = "png", feature = "exr")),
        allow(
            clippy::needless_pass_by_value,
            reason = "no type is a path of a picture then"
        )
    )]
    pub fn for_path(path: impl PicturePath, exposure: Option<f64>) -> Result<Self, ImageError> {
        Self::for_name(path.as_ref(), exposure)
    }

    /// As [`Encoding::for_path`], also in a build without pictures.
    pub(crate) fn for_name(path: &Path, exposure: Option<f64>) -> Result<Self, ImageError> {
        let extension = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        let encoding = match (
            extension.as_deref().and_then(std::ffi::OsStr::to_str),
            exposure,
        ) {
            (Some("png"), None) => Ok(Self::Png { exposure: 0.0 }),
            (Some("png"), Some(exposure)) if exposure.abs() <= 1000.0 => Ok(Self::Png { exposure }),
            (Some("png"), Some(exposure)) => Err(ImageError::Exposure { exposure }),
            (Some("exr"), None) => Ok(Self::Exr),
            (Some("exr"), Some(_)) => Err(ImageError::ExposureOfExr),
            _ => Err(ImageError::Extension {
                path: path.to_path_buf(),
            }),
        }?;
        match encoding {
            Self::Png { .. } if cfg!(feature = "png") => Ok(encoding),
            Self::Exr if cfg!(feature = "exr") => Ok(encoding),
            other => Err(other.left_out()),
        }
    }

    /// An error that the feature for this format is off.
    fn left_out(self) -> ImageError {
        ImageError::Feature {
            feature: match self {
                Self::Png { .. } => "png",
                Self::Exr => "exr",
            },
        }
    }
}

/// Writes a picture, all or nothing, and returns the number of pixels that the encoding clipped.
/// PNG clips those with a channel that doesn't round to a level from 0 to 255; EXR clips none.
///
/// # Errors
/// See [`ImageError`]. No value is changed silently: a value that is not finite, or too large for
/// EXR's 32 bits, is an error.
///
/// ```
/// use qrt_runtime::image::{Encoding, Image, Metadata, save};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.png", std::process::id()));
/// let image = Image { width: 2, height: 1, pixels: vec![[0.0, 0.5, 1.0], [0.2, 0.2, 17.0]], window: None };
/// let clipped = save(&path, &image, &Metadata::new(), Encoding::for_path(&path, None)?)?;
/// assert_eq!(clipped, 1);
/// # std::fs::remove_file(path).ok();
/// # Ok::<(), qrt_runtime::image::ImageError>(())
/// ```
pub fn save(
    path: &Path,
    image: &Image,
    metadata: &Metadata,
    encoding: Encoding,
) -> Result<u64, ImageError> {
    save_layers(path, image, &[], metadata, encoding)
}

/// Writes a picture as [`save`] does, with further values of each pixel, which only EXR can store.
///
/// # Errors
/// As [`save`]; also if there are layers for PNG, or if a layer has another size, an invalid name,
/// the name of another channel, or a value that is not finite or too large.
pub fn save_layers(
    path: &Path,
    image: &Image,
    layers: &[Layer],
    metadata: &Metadata,
    encoding: Encoding,
) -> Result<u64, ImageError> {
    let mut clipped = 0;
    replace_file(path, |out| {
        clipped = write_to(out, image, layers, metadata, encoding)?;
        Ok(())
    })
    .map_err(|error: ImageError| error.at(path))?;
    Ok(clipped)
}

/// Writes a picture to any writer, as [`save_layers`] does to a file: to a buffer, a socket, or a
/// part of another file. On an error, bytes that were already written stay written.
///
/// # Errors
/// As [`save_layers`]; an error of `out` is [`ImageError::Write`].
///
/// ```
/// use qrt_runtime::image::{Encoding, Image, Metadata, write_to};
/// let image = Image { width: 1, height: 1, pixels: vec![[0.0, 0.5, 1.0]], window: None };
/// let mut bytes = Vec::new();
/// write_to(&mut bytes, &image, &[], &Metadata::new(), Encoding::Png { exposure: 0.0 })?;
/// assert_eq!(&bytes[1..4], b"PNG");
/// # Ok::<(), qrt_runtime::image::ImageError>(())
/// ```
#[cfg_attr(
    not(all(feature = "exr", feature = "png")),
    allow(unused, reason = "each kind of pictures uses what it needs")
)]
pub fn write_to(
    mut out: impl io::Write,
    image: &Image,
    layers: &[Layer],
    metadata: &Metadata,
    encoding: Encoding,
) -> Result<u64, ImageError> {
    image.check(encoding)?;
    check_layers(image, layers, encoding)?;
    let written: io::Result<u64> = match encoding {
        #[cfg(feature = "png")]
        Encoding::Png { exposure } => {
            let scale = libm::exp2(exposure);
            png_file::write(out, image, metadata, scale).map_err(|error| match error {
                png::EncodingError::IoError(error) => error,
                other => io::Error::other(other),
            })
        }
        #[cfg(feature = "exr")]
        Encoding::Exr => exr_file::write(&mut out, image, layers, metadata).map(|()| 0),
        #[cfg(not(all(feature = "exr", feature = "png")))]
        other => return Err(other.left_out()),
    };
    Ok(written?)
}

fn check_layers(image: &Image, layers: &[Layer], encoding: Encoding) -> Result<(), ImageError> {
    let mut names = vec!["R", "G", "B"];
    for Layer { name, values } in layers {
        let reason = if encoding != Encoding::Exr {
            Some("only .exr keeps layers")
        } else if !(1..=31).contains(&name.len()) || name.contains('\0') {
            Some("its name has 1 to 31 bytes and no NUL")
        } else if names.contains(&name.as_str()) {
            Some("there is a channel of this name")
        } else if values.len() != image.pixels.len() {
            Some("it has another number of pixels than the picture")
        } else if values.iter().any(|value| !(*value as f32).is_finite()) {
            Some("a value of it is no 32-bit float")
        } else if u64::from(image.width) * 4 * (layers.len() as u64 + 3) > (1 << 31) - 1 {
            Some("a line of so many channels is too long")
        } else {
            None
        };
        if let Some(reason) = reason {
            return Err(ImageError::Layer {
                name: name.clone(),
                reason,
            });
        }
        names.push(name);
    }
    Ok(())
}

impl Image {
    /// Returns the window of the picture, or a window of its own size if it is not a crop.
    fn window(&self) -> CropWindow {
        self.window.unwrap_or(CropWindow {
            origin: [0, 0],
            film: [self.width, self.height],
        })
    }

    fn check(&self, encoding: Encoding) -> Result<(), ImageError> {
        let &Self {
            width,
            height,
            ref pixels,
            ..
        } = self;
        let CropWindow { origin, film } = self.window();
        // The largest size that PNG and EXR can store.
        let largest = (1 << 31) - 1;
        let shape =
            (1..=largest).contains(&width)
                && (1..=largest).contains(&height)
                && u64::from(width) * u64::from(height) == pixels.len() as u64
                && width.checked_mul(12).is_some()
                && film.into_iter().all(|side| side <= largest)
                && [width, height].into_iter().zip(origin).zip(film).all(
                    |((size, first), whole)| {
                        first.checked_add(size).is_some_and(|end| end <= whole)
                    },
                );
        if !shape {
            return Err(ImageError::Shape {
                width,
                height,
                pixels: pixels.len(),
            });
        }
        for (i, pixel) in pixels.iter().enumerate() {
            for (channel, &value) in pixel.iter().enumerate() {
                let x = (i % width as usize) as u32;
                let y = (i / width as usize) as u32;
                if !value.is_finite() {
                    return Err(ImageError::NotFinite {
                        x,
                        y,
                        channel,
                        value,
                    });
                }
                if encoding == Encoding::Exr && (value as f32).is_infinite() {
                    return Err(ImageError::TooLarge {
                        x,
                        y,
                        channel,
                        value,
                    });
                }
            }
        }
        Ok(())
    }
}

fn channel_name(channel: usize) -> &'static str {
    ["r", "g", "b"].get(channel).copied().unwrap_or("?")
}

/// An error of writing or reading a picture.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum ImageError {
    /// The name ends neither in `.png` nor in `.exr`.
    #[error(
        "`{}` does not say which kind of picture it is: end its name in `.png` or `.exr`",
        .path.display()
    )]
    Extension { path: PathBuf },
    /// The picture has a format whose feature is off.
    #[error(
        "qrt was built without its feature `{feature}`, and writes no .{feature}: write \
         `features = [\"{feature}\"]` in the line of qrt in Cargo.toml"
    )]
    Feature { feature: &'static str },
    /// The exposure is not a number of stops between -1,000 and 1,000.
    #[error("an exposure of {exposure} stops; it must lie between -1000 and 1000")]
    Exposure { exposure: f64 },
    /// An exposure is set for EXR, which is linear.
    #[error(
        "an EXR picture keeps linear radiance and has no exposure: leave it out, or write a `.png`"
    )]
    ExposureOfExr,
    /// A side is 0 or too long, the pixels don't fill the picture, or it does not fit into its
    /// window.
    #[error("a picture of {width} x {height} cannot be made of {pixels} pixels")]
    Shape {
        width: u32,
        height: u32,
        pixels: usize,
    },
    /// A value is NaN or infinite.
    #[error(
        "pixel ({x}, {y}), channel {}, is {value}, which is no radiance",
        channel_name(*.channel)
    )]
    NotFinite {
        x: u32,
        y: u32,
        channel: usize,
        value: f64,
    },
    /// A value is too large for a 32-bit float.
    #[error(
        "pixel ({x}, {y}), channel {}, is {value:e}: EXR's 32-bit floats end at {:e}",
        channel_name(*.channel), f32::MAX
    )]
    TooLarge {
        x: u32,
        y: u32,
        channel: usize,
        value: f64,
    },
    /// The key of metadata is not valid.
    #[error("`{key}` is no key of metadata: 1 to 27 ASCII letters, digits, `_` or `-`")]
    Key { key: String },
    /// The value of metadata is not valid.
    #[error("the value of `{key}` contains a NUL or is larger than 2 GiB")]
    Value { key: String },
    /// The layer cannot be stored.
    #[error("layer `{name}`: {reason}")]
    Layer { name: String, reason: &'static str },
    /// The file system failed.
    #[error("`{}`: {source}", .path.display())]
    Io { path: PathBuf, source: io::Error },
    /// The writer of the picture or the counts failed.
    #[error("{0}")]
    Write(#[from] io::Error),
    /// The file cannot be read as a picture.
    #[error("`{}`: {reason}", .path.display())]
    Decode { path: PathBuf, reason: String },
}

impl ImageError {
    /// Adds the path to an error of the writer; returns other errors unchanged.
    fn at(self, path: &Path) -> Self {
        let path = path.to_path_buf();
        match self {
            Self::Write(source) => Self::Io { path, source },
            other => other,
        }
    }
}
