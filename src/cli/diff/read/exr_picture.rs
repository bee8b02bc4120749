//! Reader of OpenEXR pictures.

use super::{Picture, PlaceInFrame, check_size, in_words, is_rec_709, refused};
use crate::cli::failure::Failure;
use crate::cli::terminal;
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::prelude::{AnyChannel, FlatSamples, read_first_flat_layer_from_file};
use qrt_runtime::disk::open_regular;
use qrt_runtime::image::Image;
use qrt_runtime::memory::Memory;
use std::path::Path;

/// Reads the radiance of an OpenEXR file: its channels R, G and B, or Y for all three.
///
/// # Errors
/// A file that is not OpenEXR, that lacks these channels, whose colours have other primaries, or that has
/// a value that is not a number.
pub(in crate::cli::diff) fn exr(path: &Path, memory: Memory) -> Result<Picture, Failure> {
    let failed = |error: ExrError| match error {
        ExrError::Io(error) => Failure::file(path, &error),
        error => refused(path, &error.to_string()),
    };
    open_regular(path).map_err(|error| Failure::file(path, &error))?;
    let headers = MetaData::read_from_file(path, false)
        .map_err(failed)?
        .headers;
    for header in &headers {
        let size = header.layer_size;
        check_size(path, [size.width() as u64, size.height() as u64], memory)?;
    }
    if headers.len() > 1 {
        terminal::note(&format!(
            "`{}` has {} parts, and the first is compared; write it alone to be sure",
            path.display(),
            headers.len()
        ));
    }
    let read = read_first_flat_layer_from_file(path).map_err(failed)?;
    let [width, height] = [read.layer_data.size.width(), read.layer_data.size.height()];
    let attributes = &read.attributes;
    if let Some(found) = attributes.chromaticities {
        let pair = |at: Vec2<f32>| [f64::from(at.x()), f64::from(at.y())];
        let found = [found.red, found.green, found.blue, found.white].map(pair);
        if !is_rec_709(found) {
            let why = format!(
                "its attribute `chromaticities` gives it other primaries than those of Rec. 709, {}: \
                 convert the picture to linear Rec. 709 (sRGB)",
                in_words(found)
            );
            return Err(refused(path, &why));
        }
    }
    let channels = Channels(&read.layer_data.channel_data.list);
    let rgb = match [channels.get("R"), channels.get("G"), channels.get("B")] {
        [Some(r), Some(g), Some(b)] => [r, g, b],
        _ if ["RY", "BY"].iter().any(|name| channels.has(name)) => {
            let why =
                "it keeps luminance and chroma, Y, RY and BY: save it with channels R, G and B";
            return Err(refused(path, why));
        }
        _ if ["X", "Z"].iter().all(|name| channels.has(name)) => {
            let why = "it keeps CIE's X, Y and Z: save it with channels R, G and B";
            return Err(refused(path, why));
        }
        _ => {
            let why = "it has no channels R, G and B of every pixel";
            [channels.get("Y").ok_or_else(|| refused(path, why))?; 3]
        }
    };
    if let Some(alpha) = channels.get("A")
        && alpha.values_as_f32().any(|value| value != 1.0)
    {
        terminal::note(&format!(
            "`{}` has transparent pixels: as OpenEXR keeps colours, they are compared as in front of \
             black, and the channel A itself is not compared",
            path.display()
        ));
    } else if channels.has("A") && channels.get("A").is_none() {
        return Err(refused(path, "its channel A is not of every pixel"));
    }
    let mut pixels = vec![[0.0; 3]; width * height];
    for (c, samples) in rgb.into_iter().enumerate() {
        for (place, (pixel, value)) in pixels.iter_mut().zip(samples.values_as_f32()).enumerate() {
            if !value.is_finite() {
                let (x, y) = (place % width, place / width);
                let name = ["R", "G", "B"][c];
                let why = format!("pixel ({x}, {y}), channel {name}, is {value}");
                return Err(refused(path, &why));
            }
            pixel[c] = f64::from(value);
        }
    }
    let display = attributes.display_window;
    let origin = read.layer_data.attributes.layer_position;
    let offset = |at: i32, from: i32| i64::from(at) - i64::from(from);
    Ok(Picture {
        image: Image {
            width: width as u32,
            height: height as u32,
            pixels,
            window: None,
        },
        place: Some(PlaceInFrame {
            origin: [
                offset(origin.x(), display.position.x()),
                offset(origin.y(), display.position.y()),
            ],
            frame: [display.size.width() as u64, display.size.height() as u64],
        }),
    })
}

/// The channels of a part.
struct Channels<'a>(&'a [AnyChannel<FlatSamples>]);

impl<'a> Channels<'a> {
    fn named(&self, name: &str) -> impl Iterator<Item = &'a AnyChannel<FlatSamples>> {
        let all = self.0.iter();
        all.filter(move |channel| channel.name.eq_case_insensitive(name))
    }

    /// Returns the samples of the channel `name` if it has one for each pixel.
    fn get(&self, name: &str) -> Option<&'a FlatSamples> {
        let whole = |sampling: Vec2<usize>| sampling.x() == 1 && sampling.y() == 1;
        let found = self.named(name).find(|channel| whole(channel.sampling));
        found.map(|channel| &channel.sample_data)
    }

    fn has(&self, name: &str) -> bool {
        self.named(name).next().is_some()
    }
}
