//! OpenEXR: linear 32-bit float RGB and further layers, with the metadata as string attributes.
//!
//! This module writes the file itself instead of using a library. One part with scan lines and
//! without compression is a page of code, brings no dependencies, and gives the same bytes on every
//! run. The `exr` crate, with which the tests read the file, writes attributes in a hash map's
//! order. The layout follows "OpenEXR File Layout",
//! <https://openexr.com/en/latest/OpenEXRFileLayout.html>; all numbers are little-endian.

use super::metadata::{Metadata, PREFIX};
use super::{CropWindow, Image, Layer};
use std::io::{self, Write};

const MAGIC: u32 = 20_000_630;
const VERSION: u32 = 2;
const FLOAT: i32 = 2;
/// Primaries and white of sRGB and Rec. 709, those of linear RGB in this crate: x, y of red, green,
/// blue and white.
const CHROMATICITIES: [f32; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];

/// One channel of the file.
enum Channel<'a> {
    /// A channel of the picture: 0 red, 1 green, 2 blue.
    Colour(usize),
    Layer(&'a [f64]),
}

/// Writes the picture. The bytes of a line must fit into an i32, and every value into an f32.
pub(super) fn write(
    out: &mut impl Write,
    image: &Image,
    layers: &[Layer],
    metadata: &Metadata,
) -> io::Result<()> {
    // The format requires the channels in alphabetical order.
    let colours = ["R", "G", "B"].into_iter().enumerate();
    let mut channels: Vec<(&str, Channel<'_>)> = colours
        .map(|(c, name)| (name, Channel::Colour(c)))
        .collect();
    let others = layers.iter();
    channels.extend(others.map(|layer| (layer.name.as_str(), Channel::Layer(&layer.values))));
    channels.sort_by_key(|(name, _)| *name);
    let names: Vec<&str> = channels.iter().map(|(name, _)| *name).collect();
    let header = header(image, &names, metadata);
    out.write_all(&header)?;

    // The offset of each line from the beginning of the file.
    let data_bytes = 4 * channels.len() as u32 * image.width;
    let line_bytes = 8 + u64::from(data_bytes);
    let first = header.len() as u64 + 8 * u64::from(image.height);
    for y in 0..u64::from(image.height) {
        out.write_all(&(first + y * line_bytes).to_le_bytes())?;
    }
    let top = image.window().origin[1];
    let width = image.width as usize;
    for (number, y) in (top..top + image.height).enumerate() {
        out.write_all(&y.to_le_bytes())?;
        out.write_all(&data_bytes.to_le_bytes())?;
        let row = number * width..(number + 1) * width;
        for (_, channel) in &channels {
            for place in row.clone() {
                let value = match channel {
                    Channel::Colour(channel) => image.pixels[place][*channel],
                    Channel::Layer(values) => values[place],
                };
                out.write_all(&(value as f32).to_le_bytes())?;
            }
        }
    }
    Ok(())
}

fn header(image: &Image, names: &[&str], metadata: &Metadata) -> Vec<u8> {
    let mut channels = Vec::new();
    for name in names {
        channels.extend(name.as_bytes());
        channels.push(0);
        channels.extend(FLOAT.to_le_bytes());
        channels.extend([0; 4]); // not perceptually linear, and three reserved bytes
        channels.extend(1i32.to_le_bytes()); // every pixel across
        channels.extend(1i32.to_le_bytes()); // and down
    }
    channels.push(0);
    // The first and the last column and row, both inclusive.
    let CropWindow { origin, film } = image.window();
    let window = |[x, y]: [u32; 2], [width, height]: [u32; 2]| -> Vec<u8> {
        let corners = [x, y, x + width - 1, y + height - 1];
        corners.iter().flat_map(|v| v.to_le_bytes()).collect()
    };
    let data = window(origin, [image.width, image.height]);
    let chromaticities: Vec<u8> = CHROMATICITIES
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();

    let mut header = Vec::new();
    header.extend(MAGIC.to_le_bytes());
    header.extend(VERSION.to_le_bytes());
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        header.extend(name.as_bytes());
        header.push(0);
        header.extend(kind.as_bytes());
        header.push(0);
        header.extend((value.len() as u32).to_le_bytes());
        header.extend(value);
    };
    attribute("channels", "chlist", &channels);
    attribute("chromaticities", "chromaticities", &chromaticities);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &data);
    attribute("displayWindow", "box2i", &window([0, 0], film));
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    for (key, value) in metadata.iter() {
        attribute(&format!("{PREFIX}{key}"), "string", value.as_bytes());
    }
    header.push(0);
    header
}
