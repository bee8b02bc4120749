//! Reader of PNG pictures.

use super::png_colour::ColourChunks;
use super::{Picture, check_size, refused};
use crate::cli::failure::Failure;
use png::{BitDepth, ColorType, DecodeOptions, DecodingError, Transformations};
use qrt_runtime::disk::open_regular;
use qrt_runtime::image::Image;
use qrt_runtime::memory::Memory;
use std::io::{BufReader, Seek};
use std::path::Path;

/// Reads a PNG as the linear light, from 0 to 1, that a display shows.
///
/// # Errors
/// A file that is not PNG, has an unsupported colour space, or has transparent pixels.
pub(in crate::cli::diff) fn png(path: &Path, memory: Memory) -> Result<Picture, Failure> {
    let of_file = |error| Failure::file(path, &error);
    let failed = |error: DecodingError| match error {
        DecodingError::IoError(error) => of_file(error),
        error => refused(path, &error.to_string()),
    };
    let mut file = BufReader::new(open_regular(path).map_err(of_file)?);
    let chunks = ColourChunks::read(&mut file).map_err(of_file)?;
    let transfer = chunks.and_then(|chunks| chunks.transfer());
    file.rewind().map_err(of_file)?;
    let mut options = DecodeOptions::default();
    options.set_skip_ancillary_crc_failures(false);
    let mut decoder = png::Decoder::new_with_options(file, options);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder
        .read_info()
        .map_err(|error| match (&transfer, error) {
            // The decoder takes a `cICP` that it does not know for an error of the file system.
            (Err(why), DecodingError::IoError(_)) => refused(path, why),
            (_, error) => failed(error),
        })?;
    let transfer = transfer.map_err(|why| refused(path, &why))?;
    let (width, height) = reader.info().size();
    check_size(path, [width.into(), height.into()], memory)?;
    let size = reader.output_buffer_size();
    let size = size.ok_or_else(|| refused(path, "it is too large"))?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(failed)?;
    // Reading to the end reports a damaged end, too.
    reader.finish().map_err(failed)?;
    let samples = frame.color_type.samples();
    let wide = frame.bit_depth == BitDepth::Sixteen;
    let largest = if wide { u16::MAX } else { u16::from(u8::MAX) };
    let light: Vec<f64> = (0..=largest)
        .map(|level| transfer.light(f64::from(level) / f64::from(largest)))
        .collect();
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    let bytes = &bytes[..frame.buffer_size()];
    for pixel in bytes.chunks_exact(if wide { 2 * samples } else { samples }) {
        let level = |place: usize| {
            if wide {
                u16::from_be_bytes([pixel[2 * place], pixel[2 * place + 1]])
            } else {
                u16::from(pixel[place])
            }
        };
        let (rgb, alpha) = match frame.color_type {
            ColorType::Grayscale => ([level(0); 3], largest),
            ColorType::GrayscaleAlpha => ([level(0); 3], level(1)),
            ColorType::Rgb => ([level(0), level(1), level(2)], largest),
            ColorType::Rgba => ([level(0), level(1), level(2)], level(3)),
            ColorType::Indexed => {
                return Err(refused(path, "its colours are of a kind that is not read"));
            }
        };
        if alpha != largest {
            let why = "it has transparent pixels, and what is seen through them is not known: save it \
                       in front of a background, without transparency";
            return Err(refused(path, why));
        }
        pixels.push(rgb.map(|level| light[usize::from(level)]));
    }
    let window = None;
    Ok(Picture {
        image: Image {
            width,
            height,
            pixels,
            window,
        },
        place: None,
    })
}
