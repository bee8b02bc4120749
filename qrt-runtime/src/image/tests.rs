#![cfg(all(feature = "exr", feature = "png"))]

use super::*;
use crate::scratch::Scratch;
use exr::meta::attribute::AttributeValue;
use exr::prelude as openexr;
use proptest::prelude::*;
use std::fs;

const PNG: Encoding = Encoding::Png { exposure: 0.0 };

fn metadata() -> Metadata {
    let mut metadata = Metadata::new();
    for (key, value) in [
        ("version", "0.1.0"),
        ("scene", "Würfel aus Glas, 立方体"),
        ("empty", ""),
        ("an_exactly_27_byte_long-key", "two\nlines"),
    ] {
        metadata.set(key, value).unwrap();
    }
    metadata
}

fn gradient(width: u32, height: u32) -> Image {
    let pixel = |x: u32, y: u32| {
        [
            f64::from(x) / 7.0,
            f64::from(y) / 3.0,
            f64::from(x * y) * 1e-6,
        ]
    };
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| pixel(x, y)))
        .collect();
    Image {
        width,
        height,
        pixels,
        window: None,
    }
}

fn decode_png(path: &Path) -> (png::OutputInfo, Vec<u8>, Option<png::SrgbRenderingIntent>) {
    let file = std::io::BufReader::new(fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut levels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut levels).unwrap();
    (info, levels, reader.info().srgb)
}

#[test]
fn a_png_shows_rows_from_the_top_in_srgb() {
    let folder = Scratch::new();
    let path = folder.path("p.png");
    // The levels for 0, 0.5, 1, 0.18, 0.001, 0.0031308 by hand from the closed form: 12.92 * 0.001
    // * 255 = 3.29; 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354; for 0.18, 0.4613.
    let pixels = vec![
        [0.0, 0.5, 1.0],
        [0.18, 0.001, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, 0.5],
    ];
    let image = Image {
        width: 2,
        height: 2,
        pixels,
        window: None,
    };
    assert_eq!(save(&path, &image, &metadata(), PNG).unwrap(), 0);
    let (info, levels, srgb) = decode_png(&path);
    assert_eq!(
        (info.width, info.height, info.bit_depth),
        (2, 2, png::BitDepth::Eight)
    );
    assert_eq!(levels, [0, 188, 255, 118, 3, 0, 255, 0, 0, 0, 0, 188]);
    assert_eq!(srgb, Some(png::SrgbRenderingIntent::Perceptual));
    let mut read = read_png_metadata(&path).unwrap();
    for (key, value) in metadata().iter() {
        assert_eq!(read.get(key), Some(value));
        read.set(key, "").unwrap();
    }
    assert_eq!(read.iter().count(), metadata().iter().count());
}

#[test]
fn exposure_counts_in_stops_and_clipped_pixels_are_counted() {
    let folder = Scratch::new();
    let path = folder.path("p.png");
    let pixels = vec![
        [0.25, 0.125, 0.5],
        [0.26, 0.6, 3.0],
        [-1.0, 0.0, 0.0],
        [0.0; 3],
    ];
    let image = Image {
        width: 4,
        height: 1,
        pixels,
        window: None,
    };
    let save = |exposure| {
        let clipped = save(&path, &image, &metadata(), Encoding::Png { exposure }).unwrap();
        (clipped, decode_png(&path).1)
    };
    let (clipped, levels) = save(1.0);
    assert_eq!(clipped, 2);
    assert_eq!(levels[..3], [188, 137, 255]);
    assert_eq!(levels[6..], [0; 6]);
    assert_eq!(save(0.0).0, 2);
    assert_eq!(save(-10.0).0, 1);
    // 2^1000 times 3 is infinite and is clipped; 0 stays black.
    let (clipped, levels) = save(1000.0);
    assert_eq!((clipped, &levels[9..]), (3, &[0; 3][..]));
    assert_eq!(save(-1000.0).1, [0; 12]);
}

fn decode_exr(path: &Path) -> (Image, Vec<(String, Vec<u8>)>) {
    let read = openexr::read_first_rgba_layer_from_file(
        path,
        |size, _| Image {
            width: size.x() as u32,
            height: size.y() as u32,
            pixels: vec![[0.0; 3]; size.area()],
            window: None,
        },
        |image, at, (r, g, b, _): (f32, f32, f32, f32)| {
            image.pixels[at.y() * image.width as usize + at.x()] = [r, g, b].map(f64::from);
        },
    )
    .unwrap();
    let attributes = read
        .layer_data
        .attributes
        .other
        .iter()
        .filter_map(|(name, value)| {
            let AttributeValue::Text(text) = value else {
                return None;
            };
            Some((name.to_string(), text.as_slice().to_vec()))
        });
    (read.layer_data.channel_data.pixels, attributes.collect())
}

#[test]
fn an_exr_keeps_radiance_and_another_reader_finds_all_of_it() {
    let folder = Scratch::new();
    let path = folder.path("p.exr");
    let mut image = gradient(5, 3);
    image.pixels[7] = [1e-12, -2.0, 1e12];
    assert_eq!(save(&path, &image, &metadata(), Encoding::Exr).unwrap(), 0);
    let (read, mut attributes) = decode_exr(&path);
    for pixel in &mut image.pixels {
        *pixel = pixel.map(|value| f64::from(value as f32));
    }
    assert_eq!(read, image);
    attributes.sort();
    let mut expected: Vec<(String, Vec<u8>)> = metadata()
        .iter()
        .map(|(k, v)| (format!("qrt:{k}"), v.into()))
        .collect();
    expected.sort();
    assert_eq!(attributes, expected);
}

#[test]
fn an_exr_says_where_it_was_cut_out() {
    let folder = Scratch::new();
    let path = folder.path("p.exr");
    let window = |origin, film| Some(CropWindow { origin, film });
    for (window, position, display) in [
        (None, (0, 0), (5, 3)),
        (window([2, 7], [13, 11]), (2, 7), (13, 11)),
        (window([8, 8], [13, 11]), (8, 8), (13, 11)),
    ] {
        let image = Image {
            window,
            ..gradient(5, 3)
        };
        save(&path, &image, &metadata(), Encoding::Exr).unwrap();
        assert_eq!(decode_exr(&path).0.pixels.len(), 15);
        let read = openexr::read_all_flat_layers_from_file(&path).unwrap();
        let layer = &read.layer_data[0];
        assert_eq!((layer.size.x(), layer.size.y()), (5, 3));
        let at = layer.attributes.layer_position;
        assert_eq!((at.x(), at.y()), position);
        let shown = read.attributes.display_window;
        assert_eq!((shown.position.x(), shown.position.y()), (0, 0));
        assert_eq!((shown.size.x(), shown.size.y()), display);
        // The scan lines are numbered from the top of the window.
        let (found, expected) = (decode_exr(&path).0, gradient(5, 3));
        let rounded = |pixel: &[f64; 3]| pixel.map(|value| f64::from(value as f32));
        let expected: Vec<_> = expected.pixels.iter().map(rounded).collect();
        assert_eq!(found.pixels, expected);
    }
    for outside in [window([9, 8], [13, 11]), window([u32::MAX, 0], [13, 11])] {
        let image = Image {
            window: outside,
            ..gradient(5, 3)
        };
        let error = save(&path, &image, &metadata(), Encoding::Exr).unwrap_err();
        assert!(matches!(error, ImageError::Shape { .. }));
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let folder = Scratch::new();
    for (name, encoding) in [("a.png", PNG), ("a.exr", Encoding::Exr)] {
        let [first, second] = [0, 1].map(|_| {
            save(&folder.path(name), &gradient(17, 9), &metadata(), encoding).unwrap();
            fs::read(folder.path(name)).unwrap()
        });
        assert_eq!(first, second);
    }
}

#[test]
fn a_value_that_no_file_can_hold_is_refused_and_nothing_is_written() {
    let folder = Scratch::new();
    let mut image = gradient(4, 3);
    for (value, encoding, expected) in [
        (
            f64::NAN,
            PNG,
            "pixel (2, 1), channel g, is NaN, which is no radiance",
        ),
        (
            f64::INFINITY,
            PNG,
            "pixel (2, 1), channel g, is inf, which is no radiance",
        ),
        (
            f64::NAN,
            Encoding::Exr,
            "pixel (2, 1), channel g, is NaN, which is no radiance",
        ),
        (
            -1e39,
            Encoding::Exr,
            "pixel (2, 1), channel g, is -1e39: EXR's 32-bit floats end at 3.4028235e38",
        ),
    ] {
        image.pixels[6][1] = value;
        let error = save(&folder.path("p"), &image, &metadata(), encoding).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }
    for (width, height) in [(0, 0), (0, 12), (4, 4), (1 << 31, 1), (u32::MAX, u32::MAX)] {
        image = Image {
            width,
            height,
            pixels: vec![[0.0; 3]; 12],
            window: None,
        };
        let error = save(&folder.path("p"), &image, &metadata(), PNG).unwrap_err();
        assert!(matches!(error, ImageError::Shape { .. }));
    }
    assert!(folder.names().is_empty());
}

#[test]
fn a_missing_feature_is_refused_with_the_words_for_the_manifest() {
    let refused = ImageError::Feature { feature: "exr" };
    assert_eq!(
        refused.to_string(),
        "qrt was built without its feature `exr`, and writes no .exr: write \
         `features = [\"exr\"]` in the line of qrt in Cargo.toml"
    );
}

#[test]
fn a_name_or_exposure_that_cannot_be_is_known_beforehand() {
    let of = |name: &str, exposure| Encoding::for_path(Path::new(name), exposure);
    assert_eq!(of("A.PNG", None).unwrap(), PNG);
    assert_eq!(of("a.b/c.exr", None).unwrap(), Encoding::Exr);
    for name in [
        "picture",
        "picture.jpg",
        "a.png/picture",
        ".png",
        "",
        "picture.",
    ] {
        let message = of(name, None).unwrap_err().to_string();
        assert!(
            message.ends_with("end its name in `.png` or `.exr`"),
            "{message}"
        );
    }
    for exposure in [f64::NAN, f64::INFINITY, 1000.5, -1e9] {
        let error = of("a.png", Some(exposure)).unwrap_err();
        assert!(matches!(error, ImageError::Exposure { .. }));
    }
    assert!(matches!(
        of("a.exr", Some(0.0)),
        Err(ImageError::ExposureOfExr)
    ));
}

#[test]
fn keys_that_a_format_would_refuse_are_refused_at_once() {
    let mut metadata = Metadata::new();
    for key in ["", "a b", "ä", "an_exactly_28_byte_long-key_", "a:b", "a\0"] {
        assert!(
            matches!(metadata.set(key, ""), Err(ImageError::Key { .. })),
            "{key}"
        );
    }
    assert!(matches!(
        metadata.set("key", "a\0b"),
        Err(ImageError::Value { .. })
    ));
    metadata.set("key", "old").unwrap();
    metadata.set("key", "new").unwrap();
    assert_eq!(metadata.iter().collect::<Vec<_>>(), [("key", "new")]);
}

#[test]
fn reading_what_is_no_png_is_an_error() {
    let folder = Scratch::new();
    let path = folder.path("p.png");
    assert!(matches!(
        read_png_metadata(&path),
        Err(ImageError::Io { .. })
    ));
    save(&path, &gradient(8, 8), &metadata(), PNG).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(
            read_png_metadata(&path).is_err(),
            "{length} of {} bytes",
            whole.len()
        );
    }
}

#[test]
fn counts_are_a_table_with_exact_numbers() {
    let folder = Scratch::new();
    let path = folder.path("c.csv");
    let count = Count {
        x: 3,
        y: 1,
        channel: 2,
        value: 0.1,
        good: None,
        total: 4096,
        scale: 17.0,
    };
    let counted = Count {
        good: Some(24),
        value: 1.0 / 3.0,
        channel: 0,
        ..count
    };
    write_counts(&path, [count, counted]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "x,y,channel,value,good,total,scale\n\
         3,1,b,1.0000000000000001e-1,,4096,1.7000000000000000e1\n\
         3,1,r,3.3333333333333331e-1,24,4096,1.7000000000000000e1\n"
    );
    let error = write_counts(
        &path,
        [Count {
            value: f64::NAN,
            ..count
        }],
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "pixel (3, 1), channel b, is NaN, which is no radiance"
    );
    assert!(fs::read_to_string(&path).unwrap().ends_with("e1\n"));
}

proptest! {
    #[test]
    fn a_count_reads_back_to_the_same_bits(value: f64, scale: f64) {
        prop_assume!(value.is_finite() && scale.is_finite());
        let count = Count { x: 0, y: 0, channel: 1, value, good: Some(0), total: 1, scale };
        let line = count.to_string();
        let fields: Vec<&str> = line.split(',').collect();
        prop_assert_eq!(fields[3].parse::<f64>().unwrap().to_bits(), value.to_bits());
        prop_assert_eq!(fields[6].parse::<f64>().unwrap().to_bits(), scale.to_bits());
    }
}
