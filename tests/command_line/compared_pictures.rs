//! Tests that `qrt diff` reads everything in a picture that decides its colours, or reports what it does not read.

use crate::common::command::Folder;
use exr::meta::attribute::Chromaticities;
use png::{BitDepth, ColorType};
use serde_json::Value;
use std::fs;

/// Returns a chunk of a PNG file.
fn chunk(kind: [u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [&kind[..], data].concat();
    let length = (data.len() as u32).to_be_bytes();
    let check = crc32fast::hash(&body).to_be_bytes();
    [&length[..], &body, &check].concat()
}

/// Number of bytes of the signature and of IHDR.
const HEAD: usize = 8 + 25;

/// Returns a PNG of one row with `chunks` behind its IHDR.
fn png(kind: ColorType, depth: BitDepth, row: &[u8], width: u32, chunks: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, 1);
    encoder.set_color(kind);
    encoder.set_depth(depth);
    if kind == ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 200, 100, 50]);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(row).unwrap();
    writer.finish().unwrap();
    let rest = bytes.split_off(HEAD);
    [bytes, chunks.concat(), rest].concat()
}

/// Returns a PNG of two grey pixels with the levels `levels`.
fn grey(levels: [u8; 2], chunks: &[Vec<u8>]) -> Vec<u8> {
    png(ColorType::Grayscale, BitDepth::Eight, &levels, 2, chunks)
}

fn srgb(level: f64) -> f64 {
    if level <= 0.04045 {
        level / 12.92
    } else {
        ((level + 0.055) / 1.055).powf(2.4)
    }
}

fn gamma(value: u32) -> Vec<u8> {
    chunk(*b"gAMA", &value.to_be_bytes())
}

fn primaries(red_x: u32) -> Vec<u8> {
    let numbers = [31270, 32900, red_x, 33000, 30000, 60000, 15000, 6000];
    chunk(*b"cHRM", &numbers.map(u32::to_be_bytes).concat())
}

fn intent() -> Vec<u8> {
    chunk(*b"sRGB", &[0])
}

fn profile() -> Vec<u8> {
    chunk(*b"iCCP", b"Display P3\0\0none of zlib's")
}

fn points(transfer: u8) -> Vec<u8> {
    chunk(*b"cICP", &[1, transfer, 0, 1])
}

/// Returns the mean of a picture's channels in linear light, as `qrt diff` reports it.
fn mean(folder: &Folder, name: &str) -> [f64; 3] {
    let told = folder.works(&["diff", name, name, "--json"]);
    let told: Value = serde_json::from_str(&told).unwrap();
    [0, 1, 2].map(|c| told["reference_mean_rgb"][c].as_f64().unwrap())
}

#[test]
fn levels_become_light_as_their_file_says() {
    let folder = Folder::new();
    let level = 100.0 / 255.0;
    let power = |exponent: f64| f64::powf(level, exponent);
    for (chunks, expected) in [
        (vec![], srgb(level)),
        (vec![intent()], srgb(level)),
        // A gamma of 0.45455, which some files have for sRGB, is taken as 1/2.2 exactly.
        (vec![gamma(45455)], power(100_000.0 / 45455.0)),
        (vec![gamma(100_000)], level),
        (vec![gamma(50_000), primaries(64000)], power(2.0)),
        (vec![primaries(64010)], srgb(level)),
        (vec![points(13)], srgb(level)),
        (vec![points(8)], level),
        (vec![points(4)], power(2.2)),
        (vec![points(5)], power(2.8)),
        // PNG, third edition, 4.3: cICP before iCCP before sRGB before gAMA and cHRM.
        (vec![points(8), profile(), intent(), gamma(50_000)], level),
        (vec![gamma(50_000), primaries(70000), intent()], srgb(level)),
    ] {
        fs::write(folder.path("a.png"), grey([100, 100], &chunks)).unwrap();
        for found in mean(&folder, "a.png") {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}

#[test]
fn colours_that_are_not_read_are_refused_by_name() {
    let folder = Folder::new();
    fs::write(folder.path("plain.png"), grey([1, 2], &[])).unwrap();
    for (chunks, says) in [
        (
            vec![primaries(68000)],
            &["`cHRM`", "red (0.6800, 0.3300)", "to sRGB"][..],
        ),
        (vec![primaries(68000), gamma(45455)], &["`cHRM`"]),
        (vec![profile()], &["ICC profile, `Display P3`", "to sRGB"]),
        (vec![profile(), intent(), gamma(45455)], &["ICC profile"]),
        (
            vec![chunk(*b"cICP", &[9, 16, 0, 1])],
            &["`cICP`", "primaries 9, transfer 16"],
        ),
        (
            vec![chunk(*b"cICP", &[1, 13, 1, 1])],
            &["`cICP`", "matrix 1"],
        ),
        (
            vec![chunk(*b"cICP", &[1, 13, 0, 2])],
            &["`cICP`", "full range 2"],
        ),
        (
            vec![chunk(*b"cICP", &[1, 13, 0, 0])],
            &["`cICP`", "full range 0"],
        ),
        (
            vec![chunk(*b"cICP", &[1, 1, 0, 1]), intent()],
            &["`cICP`", "transfer 1"],
        ),
        (vec![chunk(*b"cICP", &[1, 13])], &["`cICP` is damaged"]),
        (vec![gamma(0)], &["`gAMA` is damaged"]),
        (vec![chunk(*b"gAMA", &[1])], &["`gAMA` is damaged"]),
        (vec![chunk(*b"cHRM", &[1])], &["`cHRM` is damaged"]),
        (vec![chunk(*b"sRGB", &[9])], &["`sRGB` is damaged"]),
        (
            vec![gamma(45455), gamma(100_000)],
            &["`gAMA` is there twice"],
        ),
        (
            vec![chunk(*b"acTL", &[0, 0, 0, 1, 0, 0, 0, 0])],
            &["animated"],
        ),
    ] {
        fs::write(folder.path("a.png"), grey([1, 2], &chunks)).unwrap();
        for names in [["a.png", "plain.png"], ["plain.png", "a.png"]] {
            let errors = folder.fails(1, &["diff", names[0], names[1]]);
            assert!(errors.contains("`a.png`"), "{errors}");
            assert!(says.iter().all(|says| errors.contains(says)), "{errors}");
        }
    }
    // A chunk behind the pixels, and one with a wrong checksum.
    let mut late = grey([1, 2], &[]);
    late.splice(late.len() - 12..late.len() - 12, gamma(100_000));
    fs::write(folder.path("a.png"), late).unwrap();
    let errors = folder.fails(1, &["diff", "a.png", "plain.png"]);
    assert!(
        errors.contains("`gAMA` stands behind the pixels"),
        "{errors}"
    );
    let mut broken = gamma(100_000);
    *broken.last_mut().unwrap() ^= 1;
    fs::write(folder.path("a.png"), grey([1, 2], &[broken])).unwrap();
    let errors = folder.fails(1, &["diff", "a.png", "plain.png"]);
    assert!(errors.contains("CRC"), "{errors}");
}

/// A level is a fraction of the largest level of its depth.
#[test]
fn every_depth_and_kind_of_png_is_read_to_its_last_bit() {
    let folder = Folder::new();
    let check = |bytes: Vec<u8>, expected: [f64; 3]| {
        fs::write(folder.path("a.png"), bytes).unwrap();
        let found = mean(&folder, "a.png");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    };
    for (depth, row, level) in [
        (BitDepth::One, &[0b1000_0000][..], 1.0),
        (BitDepth::Two, &[0b0100_0000], 1.0 / 3.0),
        (BitDepth::Four, &[0b0111_0000], 7.0 / 15.0),
        (BitDepth::Eight, &[77], 77.0 / 255.0),
        (
            BitDepth::Sixteen,
            &[0x12, 0x34],
            f64::from(0x1234) / 65535.0,
        ),
    ] {
        check(
            png(ColorType::Grayscale, depth, row, 1, &[]),
            [srgb(level); 3],
        );
    }
    let wide = [0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc, 0xff, 0xff];
    let expected = [0x1234, 0x5678, 0x9abc].map(|level| srgb(f64::from(level) / 65535.0));
    check(
        png(ColorType::Rgb, BitDepth::Sixteen, &wide[..6], 1, &[]),
        expected,
    );
    check(
        png(ColorType::Rgba, BitDepth::Sixteen, &wide, 1, &[]),
        expected,
    );
    let narrow = [200, 100, 50].map(|level| srgb(f64::from(level) / 255.0));
    check(
        png(ColorType::Indexed, BitDepth::Two, &[0b0100_0000], 1, &[]),
        narrow,
    );
    // The two pictures differ only in the last of 16 bits.
    for (name, last) in [("a.png", 0x34), ("b.png", 0x35)] {
        let bytes = png(
            ColorType::Grayscale,
            BitDepth::Sixteen,
            &[0x12, last],
            1,
            &[gamma(100_000)],
        );
        fs::write(folder.path(name), bytes).unwrap();
    }
    let told = folder.works(&["diff", "a.png", "b.png", "--json"]);
    let told: Value = serde_json::from_str(&told).unwrap();
    assert!((told["rmse"].as_f64().unwrap() - 1.0 / 65535.0).abs() < 1e-12);
}

#[test]
fn transparency_of_any_kind_is_refused_where_it_shows() {
    let folder = Folder::new();
    let plain = png(ColorType::Grayscale, BitDepth::Eight, &[9], 1, &[]);
    fs::write(folder.path("plain.png"), plain).unwrap();
    let wide = [0, 1, 0, 2, 0, 3, 0xff, 0xfe];
    for bytes in [
        png(ColorType::Rgba, BitDepth::Sixteen, &wide, 1, &[]),
        png(ColorType::Rgba, BitDepth::Eight, &[1, 2, 3, 254], 1, &[]),
        png(
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            &[1, 254],
            1,
            &[],
        ),
        png(
            ColorType::Grayscale,
            BitDepth::Eight,
            &[9],
            1,
            &[chunk(*b"tRNS", &[0, 9])],
        ),
        png(
            ColorType::Grayscale,
            BitDepth::Sixteen,
            &[1, 9],
            1,
            &[chunk(*b"tRNS", &[1, 9])],
        ),
    ] {
        fs::write(folder.path("a.png"), bytes).unwrap();
        let errors = folder.fails(1, &["diff", "plain.png", "a.png"]);
        assert!(errors.contains("transparent pixels"), "{errors}");
    }
    let opaque = png(
        ColorType::Grayscale,
        BitDepth::Eight,
        &[9],
        1,
        &[chunk(*b"tRNS", &[0, 8])],
    );
    fs::write(folder.path("a.png"), opaque).unwrap();
    folder.works(&["diff", "plain.png", "a.png"]);
}

/// Attributes of an OpenEXR file besides its pixels.
#[derive(Clone, Copy, Default)]
struct Told {
    chromaticities: Option<[f32; 8]>,
    /// The first pixel of the data window. `display` is the display window.
    origin: [i32; 2],
    display: Option<([i32; 2], [usize; 2])>,
}

fn exr_of(folder: &Folder, name: &str, channels: &[(&str, f32)], told: Told) {
    use exr::prelude::*;
    let size = Vec2(2, 1);
    let list = channels
        .iter()
        .map(|(name, value)| AnyChannel::new(*name, FlatSamples::F32(vec![*value; 2])));
    let attributes = LayerAttributes {
        layer_position: Vec2(told.origin[0], told.origin[1]),
        ..LayerAttributes::default()
    };
    let channels = AnyChannels::sort(list.collect());
    let layer = Layer::new(size, attributes, Encoding::UNCOMPRESSED, channels);
    let ([x, y], [width, height]) = told.display.unwrap_or((told.origin, [2, 1]));
    let window = IntegerBounds::new(Vec2(x, y), Vec2(width, height));
    let mut attributes = ImageAttributes::new(window);
    attributes.chromaticities =
        told.chromaticities
            .map(|[a, b, c, d, e, f, g, h]| Chromaticities {
                red: Vec2(a, b),
                green: Vec2(c, d),
                blue: Vec2(e, f),
                white: Vec2(g, h),
            });
    let image = Image::empty(attributes).with_layer(layer);
    image.write().to_file(folder.path(name)).unwrap();
}

const RGB: [(&str, f32); 3] = [("R", 0.5), ("G", 0.25), ("B", 2.0)];

#[test]
fn primaries_of_openexr_are_those_of_rec_709_or_refused() {
    let folder = Folder::new();
    exr_of(&folder, "plain.exr", &RGB, Told::default());
    let rec_709 = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];
    let aces = [0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767];
    let other_white = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3457, 0.3585];
    let with = |chromaticities| Told {
        chromaticities: Some(chromaticities),
        ..Told::default()
    };
    exr_of(&folder, "a.exr", &RGB, with(rec_709));
    folder.works(&["diff", "plain.exr", "a.exr"]);
    for other in [aces, other_white, [f32::NAN; 8]] {
        exr_of(&folder, "a.exr", &RGB, with(other));
        let errors = folder.fails(1, &["diff", "plain.exr", "a.exr"]);
        for says in ["`a.exr`", "`chromaticities`", "white (", "convert"] {
            assert!(errors.contains(says), "{errors}");
        }
    }
}

#[test]
fn channels_of_openexr_that_change_its_colours_are_named() {
    let folder = Folder::new();
    let none = Told::default();
    exr_of(&folder, "plain.exr", &RGB, none);
    let with = |more: &[(&'static str, f32)]| [&RGB[..], more].concat();
    let noted = |name: &str| {
        let output = folder.qrt(&["diff", "plain.exr", name]);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    exr_of(&folder, "a.exr", &with(&[("A", 1.0)]), none);
    assert_eq!(noted("a.exr"), "");
    exr_of(&folder, "a.exr", &with(&[("A", 0.5)]), none);
    let note = noted("a.exr");
    assert!(note.contains("`a.exr` has transparent pixels"), "{note}");
    assert!(note.contains("in front of black"), "{note}");
    exr_of(&folder, "a.exr", &with(&[("depth.Z", 0.5)]), none);
    assert_eq!(noted("a.exr"), "");
    exr_of(
        &folder,
        "a.exr",
        &[("Y", 0.5), ("RY", 0.1), ("BY", 0.1)],
        none,
    );
    let errors = folder.fails(1, &["diff", "plain.exr", "a.exr"]);
    assert!(errors.contains("luminance and chroma"), "{errors}");
    exr_of(
        &folder,
        "a.exr",
        &["X", "Y", "Z"].map(|name| (name, 0.5)),
        none,
    );
    let errors = folder.fails(1, &["diff", "plain.exr", "a.exr"]);
    assert!(errors.contains("CIE's X, Y and Z"), "{errors}");
}

#[test]
fn windows_of_openexr_that_differ_are_refused() {
    let folder = Folder::new();
    let told = |origin, display| Told {
        origin,
        display: Some(display),
        ..Told::default()
    };
    let frame = |x, y| ([x, y], [8, 8]);
    exr_of(&folder, "a.exr", &RGB, told([3, 4], frame(0, 0)));
    // The same place in a frame whose coordinates start elsewhere.
    exr_of(&folder, "b.exr", &RGB, told([-7, 4], frame(-10, 0)));
    folder.works(&["diff", "a.exr", "b.exr"]);
    for (other, says) in [
        (told([3, 5], frame(0, 0)), "at (3, 5) of 8 x 8 pixels"),
        (told([3, 4], frame(1, 0)), "at (2, 4) of 8 x 8 pixels"),
        (told([3, 4], ([0, 0], [9, 8])), "at (3, 4) of 9 x 8 pixels"),
    ] {
        exr_of(&folder, "b.exr", &RGB, other);
        let errors = folder.fails(2, &["diff", "a.exr", "b.exr"]);
        assert!(errors.contains("at (3, 4) of 8 x 8 pixels"), "{errors}");
        assert!(errors.contains(says), "{errors}");
    }
}
