//! OpenEXR: linear 32-bit float RGB, with the metadata as string attributes.
//!
//! Written here rather than by a library: one part, scan lines, no compression is a page of code,
//! brings no dependencies, and gives the same bytes on every run (the `exr` crate, which the tests
//! read it with, writes attributes in a hash map's order). Layout after "OpenEXR File Layout",
//! <https://openexr.com/en/latest/OpenEXRFileLayout.html>; all numbers are little-endian.

use super::metadata::{Metadata, PREFIX};
use super::{Image, Window};
use std::io::{self, Write};

const MAGIC: u32 = 20_000_630;
const VERSION: u32 = 2;
const FLOAT: i32 = 2;
/// In the order of the file: alphabetical, as the format demands.
const CHANNELS: [(u8, usize); 3] = [(b'B', 2), (b'G', 1), (b'R', 0)];
/// Primaries and white of sRGB and Rec. 709, which is what linear RGB means here: x, y of red,
/// green, blue and white.
const CHROMATICITIES: [f32; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];

/// Writes the picture. Width and height must fit i32, and every value f32.
pub(super) fn write(out: &mut impl Write, image: &Image, metadata: &Metadata) -> io::Result<()> {
    let header = header(image, metadata);
    out.write_all(&header)?;

    // Where each line stands, counted from the file's beginning.
    let line_bytes = 8 + 12 * u64::from(image.width);
    let first = header.len() as u64 + 8 * u64::from(image.height);
    for y in 0..u64::from(image.height) {
        out.write_all(&(first + y * line_bytes).to_le_bytes())?;
    }
    let top = image.window().origin[1];
    for (y, row) in (top..).zip(image.pixels.chunks_exact(image.width as usize)) {
        out.write_all(&y.to_le_bytes())?;
        out.write_all(&(12 * image.width).to_le_bytes())?;
        for (_, channel) in CHANNELS {
            for pixel in row {
                out.write_all(&(pixel[channel] as f32).to_le_bytes())?;
            }
        }
    }
    Ok(())
}

fn header(image: &Image, metadata: &Metadata) -> Vec<u8> {
    let mut channels = Vec::new();
    for (name, _) in CHANNELS {
        channels.extend([name, 0]);
        channels.extend(FLOAT.to_le_bytes());
        channels.extend([0; 4]); // not perceptually linear, and three reserved bytes
        channels.extend(1i32.to_le_bytes()); // every pixel across
        channels.extend(1i32.to_le_bytes()); // and down
    }
    channels.push(0);
    // First and last column and row, both of them inside.
    let Window { origin, film } = image.window();
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
