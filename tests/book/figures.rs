//! Checks that the book's figures are those that the library draws today.

#![allow(dead_code, reason = "the example prints what figures show")]

#[path = "../../examples/book-figures/figures/mod.rs"]
mod generators;

use generators::pictures::{by_gates, gates_crop};
use generators::{ALL, Body, Figure, folder};
use qrt::runtime::render::Model;
use std::collections::BTreeSet;
use std::path::Path;

/// Remedy for a figure that differs.
const AGAIN: &str = "run `cargo run --release --example book-figures`";
/// Picture by the gates machine, which would take too long here.
const GATES: &str = "cornell-box-gates.png";
/// Limit on a figure's size: it is a part of a page that is read over a network.
const MOST_BYTES: u64 = 100_000;

/// Returns the size, the colour type and the samples of a PNG file.
fn decoded(file: &Path) -> (u32, u32, Vec<u8>) {
    let open = std::fs::File::open(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let decoder = png::Decoder::new(std::io::BufReader::new(open));
    let mut reader = decoder.read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut samples).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    (info.width, info.height, samples)
}

/// Returns the fault of a figure's file, if there is one.
fn wrong(name: &str, figure: &Figure) -> Option<String> {
    let file = folder().join(name);
    match &figure.body {
        Body::Svg(svg) => {
            let found = match std::fs::read_to_string(&file) {
                Ok(found) => found,
                Err(error) => return Some(format!("{name}: {error}")),
            };
            let mut lines = svg.lines().zip(found.lines()).zip(1..);
            let differs = lines.find(|((made, found), _)| made != found);
            (*svg != found).then(|| match differs {
                Some(((made, found), line)) => {
                    format!("{name}, line {line}:\n  found {found}\n  made  {made}")
                }
                None => format!("{name}: one is longer"),
            })
        }
        Body::Picture(..) => {
            let made = std::env::temp_dir().join(format!("qrt-{}-{name}", std::process::id()));
            figure.write(&made);
            let same = file.is_file() && decoded(&made) == decoded(&file);
            std::fs::remove_file(&made).unwrap();
            (!same).then(|| format!("{name}: other pixels"))
        }
    }
}

fn compared(of: impl Fn(&str) -> bool) {
    let asked = ALL
        .into_iter()
        .filter(|(name, _)| of(name) && *name != GATES);
    let wrong: Vec<String> = asked
        .filter_map(|(name, make)| wrong(name, &make()))
        .collect();
    assert!(wrong.is_empty(), "{AGAIN}:\n{}", wrong.join("\n"));
}

fn is_picture(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|e| e == "png")
}

#[test]
fn drawings_and_plots_are_made_again_byte_by_byte() {
    compared(|name| !is_picture(name));
}

#[test]
fn pictures_are_made_again_pixel_by_pixel() {
    compared(is_picture);
}

/// Makes the gates machine's picture by the fixed machine, and a part of it by gates.
#[test]
fn the_picture_by_gates_is_made_again() {
    let figure = by_gates(Model::Fixed);
    let wrong = wrong(GATES, &figure);
    assert!(wrong.is_none(), "{AGAIN}: {}", wrong.unwrap());
    let Body::Picture(whole, _) = figure.body else {
        panic!("a picture")
    };
    let [part, same] = gates_crop(&whole);
    assert_eq!(part, same);
}

#[test]
fn every_figure_has_a_generator_and_is_small() {
    let known: BTreeSet<String> = ALL.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(known.len(), ALL.len(), "a name comes twice");
    let mut found = BTreeSet::new();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let bytes = entry.metadata().unwrap().len();
        assert!(bytes < MOST_BYTES, "{name} has {bytes} bytes");
        found.insert(name);
    }
    let without: Vec<_> = found.difference(&known).collect();
    assert!(without.is_empty(), "no generator makes {without:?}");
    let missing: Vec<_> = known.difference(&found).collect();
    assert!(missing.is_empty(), "{missing:?} are missing: {AGAIN}");
}

/// Drawings follow the reader's colour scheme, and describe themselves to readers who cannot see them.
#[test]
fn drawings_have_both_colour_schemes_a_title_and_a_description() {
    for (name, _) in ALL.iter().filter(|(name, _)| !is_picture(name)) {
        let text = std::fs::read_to_string(folder().join(name)).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let root = document.root_element();
        assert_eq!(root.tag_name().name(), "svg", "{name}");
        for part in ["title", "desc"] {
            let found = root
                .children()
                .find(|child| child.has_tag_name(("http://www.w3.org/2000/svg", part)));
            let text = found.and_then(|child| child.text()).unwrap_or_default();
            assert!(text.len() > 10, "{name} has no {part}");
        }
        let dark = "(prefers-color-scheme:dark)";
        assert!(
            text.replace(": ", ":").contains(dark),
            "{name} is light only"
        );
    }
}
