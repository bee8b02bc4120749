//! Pictures of any program: PNG and OpenEXR.

use crate::cli::failure::Failure;
use exr::error::Error as ExrError;
use exr::meta::MetaData;
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use png::{ColorType, DecodingError, Transformations};
use qrt_runtime::disk::open_regular;
use qrt_runtime::image::{Image, linear_of_srgb};
use qrt_runtime::memory::Memory;
use std::io::BufReader;
use std::path::Path;

/// Why a file is no picture.
fn refused(path: &Path, why: &str) -> Failure {
    Failure::Job(format!("`{}`: {why}", path.display()))
}

fn check_size(path: &Path, size: [u64; 2], memory: Memory) -> Result<(), Failure> {
    let kept = memory.keep_compared(size);
    kept.map_err(|error| Failure::Usage(format!("`{}`: {error}", path.display())))
}

/// What a display shows of a PNG, as linear light from 0 to 1.
///
/// # Errors
/// No PNG, or one with transparent pixels.
pub(super) fn png(path: &Path, memory: Memory) -> Result<Image, Failure> {
    let failed = |error: DecodingError| match error {
        DecodingError::IoError(error) => Failure::file(path, &error),
        error => refused(path, &error.to_string()),
    };
    let file = open_regular(path).map_err(|error| Failure::file(path, &error))?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = reader.info().size();
    check_size(path, [width.into(), height.into()], memory)?;
    let size = reader.output_buffer_size();
    let size = size.ok_or_else(|| refused(path, "it is too large"))?;
    let mut levels = vec![0; size];
    let frame = reader.next_frame(&mut levels).map_err(failed)?;
    let samples = frame.color_type.samples();
    let light: Vec<f64> = (0..=255)
        .map(|level| linear_of_srgb(f64::from(level) / 255.0))
        .collect();
    let mut pixels = Vec::with_capacity(levels.len() / samples);
    for pixel in levels[..frame.buffer_size()].chunks_exact(samples) {
        let (rgb, alpha) = match (frame.color_type, pixel) {
            (ColorType::Grayscale, &[y]) => ([y; 3], 255),
            (ColorType::GrayscaleAlpha, &[y, alpha]) => ([y; 3], alpha),
            (ColorType::Rgba, &[r, g, b, alpha]) => ([r, g, b], alpha),
            (ColorType::Rgb, &[r, g, b]) => ([r, g, b], 255),
            _ => return Err(refused(path, "its colours are of a kind that is not read")),
        };
        if alpha != 255 {
            let why = "it has transparent pixels, and what is seen through them is not known";
            return Err(refused(path, why));
        }
        pixels.push(rgb.map(|level| light[usize::from(level)]));
    }
    Ok(Image {
        width,
        height,
        pixels,
        window: None,
    })
}

/// The radiance in an OpenEXR file: its channels R, G and B, or Y for all three.
///
/// # Errors
/// No OpenEXR, one without these channels, or with a value that is no number.
pub(super) fn exr(path: &Path, memory: Memory) -> Result<Image, Failure> {
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
    let read = read_first_flat_layer_from_file(path).map_err(failed)?;
    let layer = read.layer_data;
    let channel = |name: &str| -> Option<&FlatSamples> {
        let mut all = layer.channel_data.list.iter();
        let whole = |sampling: exr::math::Vec2<usize>| sampling.x() == 1 && sampling.y() == 1;
        all.find(|channel| channel.name.eq_case_insensitive(name) && whole(channel.sampling))
            .map(|channel| &channel.sample_data)
    };
    let rgb = match [channel("R"), channel("G"), channel("B")] {
        [Some(r), Some(g), Some(b)] => [r, g, b],
        _ => [channel("Y").ok_or_else(|| refused(path, "it has no channels R, G and B"))?; 3],
    };
    let [width, height] = [layer.size.width(), layer.size.height()];
    let mut pixels = vec![[0.0; 3]; width * height];
    for (c, samples) in rgb.into_iter().enumerate() {
        for (place, (pixel, value)) in pixels.iter_mut().zip(samples.values_as_f32()).enumerate() {
            if !value.is_finite() {
                let (x, y) = (place % width, place / width);
                let why = format!(
                    "pixel ({x}, {y}), channel {}, is {value}",
                    ["R", "G", "B"][c]
                );
                return Err(refused(path, &why));
            }
            pixel[c] = f64::from(value);
        }
    }
    Ok(Image {
        width: width as u32,
        height: height as u32,
        pixels,
        window: None,
    })
}
