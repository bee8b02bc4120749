//! All figures of the book. Each comes from the library's own code or from a measured table in
//! `book/data`.

mod call;
mod circuits;
mod comparator;
mod counting;
mod furnace;
mod gates;
mod geometry;
mod grover;
mod mean_phase;
mod measured;
pub(crate) mod pictures;
mod pixel;
mod plates;
mod points;
mod poster;

use qrt::drawing::Canvas;
use qrt::runtime::image::{Encoding, Image, Metadata, save};
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use std::path::{Path, PathBuf};

/// A finished figure.
pub(crate) struct Figure {
    pub(crate) body: Body,
    /// Description of the figure, with its numbers.
    pub(crate) says: String,
}

/// Content of a figure's file.
pub(crate) enum Body {
    Svg(String),
    /// A picture for a PNG, and its exposure in stops.
    Picture(Image, f64),
}

impl Figure {
    fn drawn(mut canvas: Canvas, says: String) -> Self {
        canvas.describe(&says);
        let body = Body::Svg(canvas.svg());
        Self { body, says }
    }

    /// Writes the figure; the metadata of a picture name the command that makes it.
    pub(crate) fn write(&self, file: &Path) {
        match &self.body {
            Body::Svg(svg) => std::fs::write(file, svg).expect("the figure is written"),
            Body::Picture(image, exposure) => {
                let mut metadata = Metadata::new();
                let from = "cargo run --release --example book-figures";
                metadata.set("made-by", from).expect("a key");
                let exposure = *exposure;
                save(file, image, &metadata, Encoding::Png { exposure }).expect("it is written");
            }
        }
    }
}

/// A function that makes a figure.
pub(crate) type Make = fn() -> Figure;

/// All figures, by the names of their files.
pub(crate) const ALL: [(&str, Make); 48] = [
    ("first-picture.png", pictures::first),
    ("noise-strip.png", pictures::noise),
    ("counted-strip.png", pictures::counted),
    ("cornell-box-gates.png", pictures::gates),
    ("materials.png", pictures::materials),
    ("smooth.png", pictures::smooth),
    ("light-strip.png", pictures::lights),
    ("circuit-garbage.svg", gates::garbage),
    ("circuit-flip.svg", gates::flip),
    ("circuit-kickback.svg", gates::kickback),
    ("circuit-fourier.svg", gates::fourier),
    ("circuit-grover.svg", gates::iterate),
    ("circuit-counting.svg", gates::counting),
    ("path.svg", geometry::path),
    ("edge-tests.svg", geometry::edges),
    ("light-sample.svg", geometry::lamp),
    ("furnace.svg", furnace::depths),
    ("oracle-call.svg", call::animated),
    ("counting-ends.svg", counting::ends),
    ("poster.svg", poster::poster),
    ("pixel-paths.svg", pixel::paths),
    ("pixel-oracle.svg", pixel::oracle),
    ("pixel-indices.svg", pixel::indices),
    ("pixel-amplified.svg", pixel::amplified),
    ("pixel-counted.svg", pixel::counted),
    ("counting-distribution.svg", counting::distribution),
    ("counting-windows.svg", counting::windows),
    ("counting-tail.svg", counting::tail),
    ("posterior.svg", counting::posteriors),
    ("grover-plane.svg", grover::plane),
    ("grover-sign.svg", grover::sign),
    ("hemisphere-lattice.svg", points::hemispheres),
    ("net-and-lattice.svg", points::projections),
    ("lattice-dimension.svg", plates::dimensions),
    ("comparator.svg", comparator::errors),
    ("circuit-big-picture.svg", circuits::frame),
    ("registers.svg", circuits::registers),
    ("cost-growth.svg", circuits::growth),
    ("width.svg", circuits::width),
    ("truncation.svg", measured::truncation),
    ("estimators-error.svg", measured::estimators_error),
    ("estimators-rmse.svg", measured::estimators_rmse),
    ("estimators-pixels.svg", measured::estimators_pixels),
    ("mean-phase-fringe.svg", mean_phase::fringe),
    ("mean-phase-errors.svg", mean_phase::errors),
    ("rivals.svg", measured::rivals),
    ("trade.svg", measured::trade),
    ("trade-parts.svg", measured::parts),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the folder of the figures.
pub(crate) fn folder() -> PathBuf {
    root().join("book/src/figures")
}

/// Returns the style of a name, so that it has the same colour in all figures.
fn style(name: &str) -> usize {
    qrt::lab::trade::style(name).unwrap_or_else(|| panic!("`{name}` has no style"))
}

/// Loads the Cornell box of the example scenes, with overrides.
fn cornell(sets: &[&str]) -> ValidScene {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let file = root().join("scenes-yaml/cornell-box.yaml");
    let loaded = front::load(&file, &sets).unwrap_or_else(|report| panic!("{report}"));
    loaded.valid
}

/// Parses a scene from a text.
fn scene(text: &str, name: &str) -> ValidScene {
    let parsed = front::parse(text, name, &[], root());
    parsed.unwrap_or_else(|report| panic!("{report}")).valid
}
