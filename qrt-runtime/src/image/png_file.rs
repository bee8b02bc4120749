//! PNG: 8-bit sRGB, with the metadata as text chunks.

use super::metadata::{Metadata, PREFIX};
use super::{Image, ImageError, srgb};
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::Path;

/// Writes the picture, each value multiplied by `scale`, and returns the number of clipped pixels.
pub(super) fn write(
    out: impl Write,
    image: &Image,
    metadata: &Metadata,
    scale: f64,
) -> Result<u64, png::EncodingError> {
    let mut clipped = 0;
    let mut levels = Vec::with_capacity(3 * image.pixels.len());
    for pixel in &image.pixels {
        let encoded = pixel.map(|value| srgb::level(value * scale));
        levels.extend(encoded.map(|(level, _)| level));
        clipped += u64::from(encoded.iter().any(|&(_, clipped)| clipped));
    }
    let mut encoder = png::Encoder::new(out, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (key, value) in metadata.iter() {
        let keyword = format!("{PREFIX}{key}");
        // tEXt is Latin-1, and every program reads it; iTXt is UTF-8.
        if value.is_ascii() {
            encoder.add_text_chunk(keyword, value.to_owned())?;
        } else {
            encoder.add_itxt_chunk(keyword, value.to_owned())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&levels)?;
    writer.finish()?;
    Ok(clipped)
}

/// Reads the metadata of a PNG written by qrt.
///
/// # Errors
/// If the file cannot be read or is not a PNG.
pub fn read_png_metadata(path: &Path) -> Result<Metadata, ImageError> {
    let io = |source| ImageError::Io {
        path: path.to_path_buf(),
        source,
    };
    let decode = |e: png::DecodingError| ImageError::Decode {
        path: path.to_path_buf(),
        reason: e.to_string(),
    };
    let decoder = png::Decoder::new(BufReader::new(File::open(path).map_err(io)?));
    let mut reader = decoder.read_info().map_err(decode)?;
    reader.finish().map_err(decode)?;
    let info = reader.info();
    let mut metadata = Metadata::new();
    let latin1 = info.uncompressed_latin1_text.iter();
    let mut found: Vec<(&str, String)> = latin1
        .map(|chunk| (chunk.keyword.as_str(), chunk.text.clone()))
        .collect();
    for chunk in &info.utf8_text {
        found.push((&chunk.keyword, chunk.get_text().map_err(decode)?));
    }
    for (keyword, text) in found {
        if let Some(key) = keyword.strip_prefix(PREFIX) {
            metadata.set(key, text)?;
        }
    }
    Ok(metadata)
}
