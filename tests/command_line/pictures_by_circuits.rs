//! Tests of `qrt render --model fixed|gates` from the outside.

use crate::common::command::Folder;
use serde_json::Value;

const BOX: &str = include_str!("../scenes/box.yaml");

/// Overrides for a scene so small that every gate of every path takes a second or two.
const SMALL: [&str; 6] = [
    "--set",
    "sampling.path_bits=6",
    "--crop",
    "3,3,4,4",
    "--set",
    "comparator.bits=8",
];

fn render(folder: &Folder, model: &str, more: &[&str]) -> String {
    let name = format!("{model}.csv");
    let arguments = [
        &["render", "box.yaml", "--model", model, "--counts", &name][..],
        &["--stats", "stats.json"],
        &SMALL,
        more,
    ];
    folder.works(&arguments.concat());
    String::from_utf8(folder.read(&name)).unwrap()
}

fn columns(csv: &str) -> Vec<(f64, Option<u64>, u64, f64)> {
    csv.lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            (
                fields[3].parse().unwrap(),
                (!fields[4].is_empty()).then(|| fields[4].parse().unwrap()),
                fields[5].parse().unwrap(),
                fields[6].parse().unwrap(),
            )
        })
        .collect()
}

#[test]
fn both_machines_make_one_picture_near_the_real_one() {
    let folder = Folder::with("box.yaml", BOX);
    let exact = ["--estimator", "exact"];
    let fixed = render(&folder, "fixed", &exact);
    assert_eq!(fixed, render(&folder, "gates", &exact));
    let stats: Value = serde_json::from_slice(&folder.read("stats.json")).unwrap();
    assert_eq!(stats["model"], "gates");
    let real = columns(&render(&folder, "real", &exact));
    let fixed = columns(&fixed);
    assert_eq!(fixed.len(), 16 * 3);
    for ((value, good, total, scale), (close, none, _, _)) in fixed.into_iter().zip(real) {
        let good = good.unwrap();
        assert_eq!(value, scale * (good as f64 / total as f64));
        // The tolerance is half a step of the comparator, and a path or two with other hits.
        assert!((value - close).abs() <= scale * (0.5 / 256.0 + 1.0 / 64.0));
        assert_eq!((none, total), (None, 64 << 8));
    }
}

#[test]
fn counting_draws_from_what_the_circuit_counted() {
    let folder = Folder::with("box.yaml", BOX);
    let sine = ["--estimator", "sine"];
    let counted = columns(&render(&folder, "fixed", &sine));
    let exact = columns(&render(&folder, "fixed", &["--estimator", "exact"]));
    let differ = counted.iter().zip(&exact).filter(|(a, b)| a.0 != b.0);
    assert!(differ.count() > 10);
    for (counted, exact) in counted.iter().zip(&exact) {
        assert_eq!(counted.1, exact.1);
    }
}

#[test]
fn threads_tiles_and_interruptions_change_no_byte() {
    let folder = Folder::with("box.yaml", BOX);
    let all = render(&folder, "gates", &["--threads", "1"]);
    assert_eq!(all, render(&folder, "gates", &["--threads", "3"]));
    assert_eq!(all, render(&folder, "gates", &["--resume"]));
}

/// Returns the width and height of a PNG, and its 8-bit sRGB.
pub(super) fn decoded(bytes: Vec<u8>) -> ([u32; 2], Vec<u8>) {
    let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    assert_eq!(info.bit_depth, png::BitDepth::Eight);
    ([info.width, info.height], pixels)
}

/// The README's pictures have 256 x 256 pixels, are neither dark nor bright, and the first is that of the gates.
#[test]
fn the_gallery_is_as_the_readme_says() {
    let gallery = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/gallery");
    let read = |name: &str| decoded(std::fs::read(gallery.join(name)).unwrap());
    let mut pictures = 0;
    for entry in std::fs::read_dir(&gallery).unwrap() {
        let path = entry.unwrap().path();
        if path.extension() != Some("png".as_ref()) {
            continue;
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        let (size, pixels) = read(name);
        assert_eq!(size, [256, 256], "{name}");
        let mean = pixels.iter().map(|&value| f64::from(value)).sum::<f64>() / pixels.len() as f64;
        assert!((30.0..200.0).contains(&mean), "{name}: {mean}");
        pictures += 1;
    }
    assert!(pictures > 9, "{pictures}");
    let folder = Folder::new();
    let lit = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes-yaml/lit-box.yaml");
    let crop = [120, 96, 6, 4];
    let [left, top, width, height] = crop;
    folder.works(&[
        "render",
        lit,
        "-o",
        "part.png",
        "--crop",
        &format!("{left},{top},{width},{height}"),
        "--model",
        "gates",
        "--estimator",
        "exact",
        "--exposure",
        "1",
        "--set",
        "sampling.path_bits=6",
    ]);
    let (size, part) = decoded(folder.read("part.png"));
    assert_eq!(size, [width, height]);
    let (_, whole) = read("lit-box-gates.png");
    let rows = (top..top + height).map(|y| {
        let first = 3 * (256 * y + left) as usize;
        &whole[first..first + 3 * width as usize]
    });
    assert_eq!(part, rows.collect::<Vec<_>>().concat());
}

/// The README's picture of the shadow is that of complete counting circuits, each pixel 32 x 32 times.
#[test]
#[ignore = "takes a minute"]
fn the_gallerys_shadow_is_what_the_circuits_count() {
    let folder = Folder::new();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = root.join("scenes-yaml/small/shadow.yaml");
    folder.works(&["simulate", scene.to_str().unwrap(), "--film", "shadow.png"]);
    let (size, small) = decoded(folder.read("shadow.png"));
    assert_eq!(size, [8, 8]);
    let shown = std::fs::read(root.join("docs/gallery/shadow-simulated.png")).unwrap();
    let (size, shown) = decoded(shown);
    assert_eq!(size, [256, 256]);
    for (place, pixel) in shown.chunks(3).enumerate() {
        let [x, y] = [place % 256 / 32, place / 256 / 32];
        let first = 3 * (8 * y + x);
        assert_eq!(pixel, &small[first..first + 3], "pixel {x},{y}");
    }
}
